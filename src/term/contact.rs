//! Contact: `−Σ_k A_k (p_k ∂g_k/∂u + τ_k ∂s_k/∂u)` over the contact nodes of an interface, `p_k`, `τ_k` by its law from the mean gap
//! `g_k` and slip `s_k` at the end of the step (theory, Contact).
//!
//! Within a step the slip is linear in the displacements and the gap quadratic at most, so that the tangent is exact and Newton's method
//! ends at a fixed set of contact nodes that touch, stick or slide.

use super::water_levels::WaterLevels;
use super::{Assembly, Frame, Frozen, PlacedConstraint, Source, Term, Trial};
use crate::contact::{Answer, Law, Laws, Motion};
use crate::error::Result;
use crate::system::Local;

/// The contact of one interface.
pub struct Contact {
    /// The number of the interface in the scene.
    interface: u32,
    laws: Laws,
    /// The levels of the water, where those outside and in the pores differ.
    levels: Option<WaterLevels>,
}

impl Contact {
    pub fn new(interface: u32, laws: impl Into<Laws>, levels: Option<WaterLevels>) -> Self {
        Self { interface, laws: laws.into(), levels }
    }
}

/// What a contact node answers to the displacements of a trial state.
pub fn answer<const D: usize>(
    law: &Law,
    levels: Option<&WaterLevels>,
    constraint: &PlacedConstraint<D>,
    trial: &Trial<D>,
) -> (Answer, Motion) {
    let since = |n: u32| {
        let (now, before) = (&trial.displacement[n as usize], &trial.converged[n as usize]);
        std::array::from_fn(|d| now[d] - before[d])
    };
    let mut motion = constraint.condition.measure(since);
    if !trial.ahead.is_empty() && constraint.condition.looks_ahead {
        motion = constraint.condition.ahead(motion, trial.ahead);
    }
    let law = law.reduced(trial.reduction);
    let beyond =
        levels.zip(constraint.condition.wet).map_or(0.0, |(levels, x)| levels.beyond(trial.phase, trial.time, x));
    let penalty = constraint.condition.penalty.in_water(beyond);
    let spots = &constraint.condition.spots;
    let first = constraint.initially_closed && law.friction > 0.0;
    match trial.frozen {
        Frozen::Not => {}
        Frozen::Smooth if first => {
            return (Law { friction: 0.0, ..law }.frozen(&penalty, spots, &motion, false), motion);
        }
        _ if constraint.initially_closed || penalty.pressure > 0.0 => {
            return (law.frozen(&penalty, spots, &motion, first), motion);
        }
        _ => {}
    }
    (law.respond_over(&penalty, spots, &motion, trial.ahead_slope), motion)
}

impl<const D: usize> Term<D> for Contact {
    fn source(&self) -> Source {
        Source::Contact
    }

    fn symmetric(&self) -> bool {
        self.laws.symmetric()
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let law = self.laws.at(trial.phase);
        let compute = |constraint: &PlacedConstraint<D>, local: &mut Local| {
            if constraint.interface != self.interface {
                return Ok(());
            }
            let condition = &constraint.condition;
            let (answer, Motion { turn, ahead_turn, .. }) = answer(law, self.levels.as_ref(), constraint, trial);
            let [weight, ahead_slope] =
                if condition.looks_ahead { [1.0, trial.ahead_slope] } else { [trial.contact_weight, 0.0] };
            let area = weight * condition.area;
            let (pressure, shear) = (area * answer.pressure, area * answer.shear);
            let moment = area * condition.curvature * answer.moment;
            for (k, &at) in constraint.place.iter().enumerate() {
                let normal = condition.normal(k, turn);
                for d in 0..D {
                    local.vector[at as usize * D + d] -=
                        pressure * normal[d] + shear * condition.by_tangent[k][d] + moment * condition.by_arc[k][d];
                }
            }
            if local.matrix.is_empty() {
                return Ok(());
            }
            let [nn, tn, tt] =
                [answer.pressure_by_gap, answer.shear_by_gap, answer.shear_by_slip].map(|slope| area * slope);
            let bend = |slope: f64| area * condition.curvature * slope;
            let [nc, tc, cn] = [answer.pressure_by_turn, answer.shear_by_turn, answer.moment_by_gap].map(bend);
            let cc = condition.curvature * (bend(answer.moment_by_turn) + pressure);
            for (a, &i) in constraint.place.iter().enumerate() {
                let normal = condition.normal(a, turn);
                for (b, &j) in constraint.place.iter().enumerate() {
                    // Of the gap half a step later.
                    let (normal_b, arc) = (condition.normal(b, turn), condition.by_arc[b]);
                    let other: [f64; D] =
                        std::array::from_fn(|d| (1.0 + ahead_slope) * normal_b[d] + ahead_turn * arc[d]);
                    for d in 0..D {
                        let (n, t, c) = (normal[d], condition.by_tangent[a][d], condition.by_arc[a][d]);
                        let entry = (i as usize * D + d) * local.size + j as usize * D;
                        for e in 0..D {
                            let (m, s, o) = (other[e], condition.by_tangent[b][e], arc[e]);
                            local.matrix[entry + e] -=
                                (nn * n + tn * t + cn * c) * m + tt * t * s + (nc * n + tc * t + cc * c) * o;
                        }
                    }
                }
            }
            Ok(())
        };
        let coupling = |constraint: &PlacedConstraint<D>| constraint.coupling as usize;
        out.scatter(frame.pattern, frame.constraints, coupling, compute)
    }
}
