//! Modified Cam-Clay with associated flow (Roscoe & Burland 1968), in Kirchhoff stress and Hencky strain as Borja &
//! Tamagnini (1998), *Cam-Clay plasticity, part III*, Comput. Methods Appl. Mech. Engng 155, 73–95:
//!
//! ```text
//! q²/M² + p (p − p_c) ≤ 0,    p_c = p_c0 e^(ε_pv/Λ),    Λ = λ* − κ*
//! ```
//!
//! with `p` and the plastic volume strain `ε_pv` positive in compression, `q = √(3 J₂)`, and `M` the same in all directions of
//! shear. Elasticity is Hencky's with moduli that do not change: they stand for `κ*`, the slope of unloading at the stress of
//! interest, `K = p/κ*`. Cohesion there is none; in tension the surface shrinks to nothing.
//!
//! The return is implicit, and one unknown, the plastic volume strain `x` of the step, decides all the others:
//! `p = p_tr − K x`, `p_c = p_cn e^(x/Λ)`, `q` by the yield surface, and
//!
//! ```text
//! h(x) = 6G/M² x q − (q_tr − q)(2p − p_c) = 0
//! ```
//!
//! which is `x = Δγ (2p − p_c)` and `q = q_tr/(1 + 6G Δγ/M²)`. The root lies between the trial state, or where that is beyond a
//! tip the return along the axis, and the critical state `2p = p_c`: on the wet side the surface grows, on the dry one it shrinks.

use super::{Elasticity, Kind, Model, Moduli, Parameter, Parameters, Profile, Response, State, equivalent_plastic};
use crate::error::{Error, Result};
use std::sync::Arc;

/// Yield within this fraction of `p_c` counts as elastic, so that a returned state is.
const TOLERANCE: f64 = 1e-12;
/// Least preconsolidation pressure, over the first one, that a step begins with.
const LEAST: f64 = 1e-12;
/// Least logarithm of the factor on it in a step.
const LOWEST: f64 = -60.0;
/// Iterations of a search that halving ends.
const ITERATIONS: usize = 200;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CamClay {
    elasticity: Elasticity,
    /// M (-).
    slope: f64,
    /// p_c0 (kPa).
    preconsolidation: Profile,
    /// Λ (-).
    compressibility: f64,
}

/// The entry of the model list.
pub const KIND: Kind = Kind {
    name: "cam_clay",
    keeps_volume: false,
    parameters: &[
        Parameter::YOUNG,
        Parameter::POISSON,
        Parameter {
            name: "critical_slope",
            unit: "-",
            required: true,
            varies: false,
            meaning: "M, q over p at the critical state",
        },
        Parameter {
            name: "preconsolidation",
            unit: "kPa",
            required: true,
            varies: true,
            meaning: "largest mean pressure that the soil bears without plastic strain at first",
        },
        Parameter {
            name: "plastic_compressibility",
            unit: "-",
            required: true,
            varies: false,
            meaning: "slopes of virgin compression less of unloading, in logarithms of volume and pressure",
        },
    ],
    build,
    examples: &[
        &[
            ("young", 5000.0),
            ("poisson", 0.3),
            ("critical_slope", 1.0),
            ("preconsolidation", 100.0),
            ("plastic_compressibility", 0.1),
        ],
        &[
            ("young", 2000.0),
            ("poisson", 0.2),
            ("critical_slope", 1.3),
            ("preconsolidation", 20.0),
            ("plastic_compressibility", 0.05),
        ],
    ],
};

fn build(parameters: &Parameters) -> Result<Arc<dyn Model>> {
    Ok(Arc::new(CamClay::new(
        parameters.elasticity()?,
        parameters.number("critical_slope")?,
        parameters.profile("preconsolidation")?,
        parameters.number("plastic_compressibility")?,
    )?))
}

/// The trial state of a return, and the size of the surface before it.
struct Trial {
    moduli: Moduli,
    slope: f64,
    compressibility: f64,
    /// p_tr and q_tr (kPa).
    pressure: f64,
    shear: f64,
    /// p_cn (kPa).
    size: f64,
}

impl Trial {
    fn pressure_at(&self, x: f64) -> f64 {
        self.pressure - self.moduli.bulk() * x
    }

    fn size_at(&self, x: f64) -> f64 {
        self.size * (x / self.compressibility).max(LOWEST).exp()
    }

    /// Where `weight · p − p_c`, which falls as `x` grows, is zero: the critical state for 2, the tip for 1.
    fn meets(&self, weight: f64) -> f64 {
        let (mut low, mut high) = (
            ((self.pressure - self.size) / self.moduli.bulk()).min(0.0),
            (self.pressure / self.moduli.bulk()).max(0.0),
        );
        let value = |x: f64| weight * self.pressure_at(x) - self.size_at(x);
        bisect(&mut low, &mut high, |x| {
            let slope = -weight * self.moduli.bulk() - self.size_at(x) / self.compressibility;
            (value(x), slope)
        })
    }

    /// q (kPa) on the yield surface.
    fn shear_at(&self, x: f64) -> f64 {
        let p = self.pressure_at(x);
        self.slope * (p * (self.size_at(x) - p)).max(0.0).sqrt()
    }

    /// The plastic volume strain of the step.
    fn volume(&self) -> f64 {
        let wet = 2.0 * self.pressure > self.size;
        let critical = self.meets(2.0);
        let start = if wet && self.pressure > self.size {
            self.meets(1.0)
        } else {
            (self.pressure / self.moduli.bulk()).min(0.0)
        };
        let rigidity = 6.0 * self.moduli.shear / self.slope.powi(2);
        // Negative at the lower end, positive at the upper one: h on the wet side, −h on the dry.
        let h = |x: f64| {
            let (p, size, q) = (self.pressure_at(x), self.size_at(x), self.shear_at(x));
            rigidity * x * q - (self.shear - q) * (2.0 * p - size)
        };
        let (mut low, mut high) = (start.min(critical), start.max(critical));
        bisect(&mut low, &mut high, |x| (-h(x), f64::NAN))
    }
}

/// The zero of a function that is not negative at `low` and not positive at `high`, by Newton's method with the slope that it
/// gives where that stays between them, and by halves.
fn bisect(low: &mut f64, high: &mut f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut x = 0.5 * (*low + *high);
    for _ in 0..ITERATIONS {
        let (value, slope) = f(x);
        if value >= 0.0 {
            *low = x
        } else {
            *high = x
        }
        let newton = x - value / slope;
        let next = if newton > *low && newton < *high { newton } else { 0.5 * (*low + *high) };
        if next == x || value == 0.0 {
            break;
        }
        x = next;
    }
    x
}

impl CamClay {
    /// # Errors
    /// Names the parameter that is out of range, at the datum of the preconsolidation pressure.
    pub fn new(elasticity: Elasticity, slope: f64, preconsolidation: Profile, compressibility: f64) -> Result<Self> {
        for (name, value) in [("critical_slope", slope), ("plastic_compressibility", compressibility)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::input(name, format!("{value} is not positive"), "give a value above 0"));
            }
        }
        let model = Self { elasticity, slope, preconsolidation, compressibility };
        model.check(preconsolidation.datum)?;
        Ok(model)
    }

    /// p_c (kPa) as a step begins.
    fn size(&self, y: f64, state: &State) -> f64 {
        self.preconsolidation.at(y) * (state.memory / self.compressibility).exp().max(LEAST)
    }

    /// The yield function over p_c (kPa).
    fn excess(&self, p: f64, q: f64, size: f64) -> f64 {
        ((q / self.slope).powi(2) + p * (p - size)) / size
    }
}

impl Model for CamClay {
    fn respond(&self, y: f64, trial: &[f64; 3], state: &State) -> Response {
        let moduli = self.elasticity.at(y);
        let volumetric = trial[0] + trial[1] + trial[2];
        let e = trial.map(|x| x - volumetric / 3.0);
        let norm = (e[0] * e[0] + e[1] * e[1] + e[2] * e[2]).sqrt();
        let (bulk, shear) = (moduli.bulk(), moduli.shear);
        let t = Trial {
            moduli,
            slope: self.slope,
            compressibility: self.compressibility,
            pressure: -bulk * volumetric,
            shear: 2.0 * shear * 1.5f64.sqrt() * norm,
            size: self.size(y, state),
        };
        if self.excess(t.pressure, t.shear, t.size) <= TOLERANCE * t.size {
            return Response::elastic(&moduli, trial, state);
        }
        let x = t.volume();
        let (p, size) = (t.pressure_at(x), t.size_at(x));
        if size <= LEAST * self.preconsolidation.at(y) {
            // Nothing is left of the surface.
            let memory = self.compressibility * LEAST.ln();
            let plastic_strain = state.plastic_strain + equivalent_plastic(trial);
            let state = State { plastic_strain, memory, ..*state };
            return Response {
                stress: [0.0; 3],
                tangent: [[0.0; 3]; 3],
                elastic_strain: [0.0; 3],
                state,
                yielding: true,
            };
        }
        let normal = 2.0 * p - size;
        let m = self.slope.powi(2);
        // Δγ from q, which is on the surface then, or near the tips, where q² is a small difference, from the flow along p.
        let near_tip = !(p > 0.05 * size && p < 0.95 * size);
        let multiplier = if near_tip { x / normal } else { (t.shear / t.shear_at(x) - 1.0) * m / (6.0 * shear) };
        let shrink = 1.0 + 6.0 * shear * multiplier / m;
        let q = t.shear / shrink;
        let kept = 1.0 / shrink;

        // d(x, Δγ) by the trial volume strain (compression) and by q_tr/3G.
        let j = [
            [1.0 + multiplier * (2.0 * bulk + size / self.compressibility), -normal],
            [-normal * bulk - p * size / self.compressibility, -2.0 * (q / m).powi(2) * 6.0 * shear / shrink],
        ];
        let right = [[-2.0 * bulk * multiplier, 0.0], [normal * bulk, 2.0 * q / m * 3.0 * shear / shrink]];
        let det = j[0][0] * j[1][1] - j[0][1] * j[1][0];
        let solve = |k: usize| {
            let (a, b) = (-right[0][k], -right[1][k]);
            [(a * j[1][1] - j[0][1] * b) / det, (j[0][0] * b - j[1][0] * a) / det]
        };
        let (by_volume, by_shear) = (solve(0), solve(1));
        let fall = -6.0 * shear * q / (m * shrink);
        let (pv, ps) = (bulk * (1.0 - by_volume[0]), -bulk * by_shear[0]);
        let (qv, qs) = (fall * by_volume[1], 3.0 * shear / shrink + fall * by_shear[1]);

        let third = (2.0f64 / 3.0).sqrt();
        let n = if norm > 0.0 { e.map(|x| x / norm) } else { [0.0; 3] };
        let g = 2.0 * shear * kept;
        let tangent = std::array::from_fn(|a| {
            std::array::from_fn(|b| {
                let identity = if a == b { 1.0 } else { 0.0 };
                pv - ps * third * n[b] - qv * third * n[a]
                    + third * third * (qs - 1.5 * g) * n[a] * n[b]
                    + g * (identity - 1.0 / 3.0)
            })
        });
        let stress = e.map(|x| g * x - p);
        let elastic_strain = moduli.strain(&stress);
        let plastic = std::array::from_fn(|k| trial[k] - elastic_strain[k]);
        Response {
            stress,
            tangent,
            elastic_strain,
            state: State {
                plastic_strain: state.plastic_strain + equivalent_plastic(&plastic),
                memory: state.memory.max(self.compressibility * LEAST.ln()) + x,
                ..*state
            },
            yielding: true,
        }
    }

    fn elasticity(&self) -> &Elasticity {
        &self.elasticity
    }

    fn symmetric(&self) -> bool {
        false
    }

    fn remembers(&self) -> bool {
        true
    }

    fn yield_excess(&self, y: f64, stress: &[f64; 3], state: &State) -> f64 {
        let [a, b, c] = stress;
        let q = (0.5 * ((a - b).powi(2) + (b - c).powi(2) + (c - a).powi(2))).sqrt();
        self.excess(-(a + b + c) / 3.0, q, self.size(y, state))
    }

    fn strength(&self, y: f64) -> f64 {
        0.25 * self.slope * self.preconsolidation.at(y)
    }

    fn reduced(&self, factor: f64) -> Arc<dyn Model> {
        Arc::new(Self { slope: self.slope / factor, ..*self })
    }

    fn check(&self, y: f64) -> Result<()> {
        self.elasticity.check(y)?;
        self.preconsolidation.positive_at("preconsolidation", y)
    }
}

#[cfg(test)]
mod tests;
