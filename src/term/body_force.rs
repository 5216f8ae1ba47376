//! Weight of the material: `−Σ_q ρ_q w_q N_I g`, times a load factor in the phase's time, summed over the points that the internal force is summed over.
//!
//! It has the same points and weights as the internal force, so that errors of the quadrature cancel in equilibrium.

use super::{Assembly, Frame, Role, Source, Term, Trial, scatter_cells};
use crate::error::Result;
use crate::interpolation::CellPoints;
use crate::kinematics::Kinematics;
use crate::system::Local;
use crate::time_value::TimeValue;
use std::marker::PhantomData;

/// Gravity on the material.
pub struct BodyForce<K, const D: usize> {
    /// Acceleration of gravity (m/s²).
    gravity: [f64; D],
    /// The factor on it in each phase.
    factors: Vec<TimeValue>,
    kinematics: PhantomData<K>,
}

impl<K, const D: usize> BodyForce<K, D> {
    /// `factors[i]` scales `gravity` in phase `i`.
    pub fn new(gravity: [f64; D], factors: Vec<TimeValue>) -> Self {
        Self { gravity, factors, kinematics: PhantomData }
    }
}

impl<const D: usize, K: Kinematics<D>> Term<D> for BodyForce<K, D> {
    fn source(&self) -> Source {
        Source::Gravity
    }

    fn role(&self) -> Role {
        Role::External
    }

    fn factor(&self, phase: usize) -> Option<&TimeValue> {
        self.factors.get(phase)
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let factor = self.factors[trial.phase].at(trial.time);
        let load = self.gravity.map(|g| -factor * g);
        scatter_cells(
            frame,
            |cell_points: &CellPoints, local: &mut Local| {
                for entries in frame.interpolation.entries::<K>(cell_points) {
                    let p = entries.point;
                    let mass = frame.points.mass[p] / frame.points.initial_volume[p] * entries.weight;
                    for (i, n) in entries.value.iter().enumerate() {
                        for d in 0..D {
                            local.vector[i * D + d] += mass * n * load[d];
                        }
                    }
                }
                Ok(())
            },
            &mut Assembly { force: out.force, tangent: None, workspace: out.workspace },
        )
    }
}
