//! Modified Cam-Clay with associated flow (Roscoe & Burland 1968), in Kirchhoff stress and Hencky strain as Borja &
//! Tamagnini (1998), *Cam-Clay plasticity, part III*, Comput. Methods Appl. Mech. Engng 155, 73–95:
//!
//! ```text
//! q²/M² + p (p − p_c) ≤ 0,    p_c = p_c0 e^(ε_pv/Λ),    Λ = λ̂ − κ̂
//! ```
//!
//! with `p` and the plastic volume strain `ε_pv` positive in compression, `q = √(3 J₂)`, and `M` the same in all directions of
//! shear. Cohesion there is none; in tension the surface shrinks to nothing. `λ̂ = λ*/(1 − λ*)` and `κ̂ = κ*/(1 − κ*)`: a line
//! `ε = λ* ln p` in the Cauchy pressure, whose slope a case gives, is one of slope `λ̂` in the Kirchhoff pressure, `e^−ε` times as large.
//!
//! Elasticity is Hencky's, with a bulk modulus that is constant, or `p/κ̂` of a line of [`Swelling`]. The shear modulus of a point is
//! constant, which leaves pressure and shear apart from each other in one convex energy: every stress has its elastic strain, and the
//! undrained stress paths are those of the literature. One in proportion to the pressure does work in closed cycles (Zytynski et al.
//! 1978) unless the pressure depends on shear too; as Borja, Tamagnini & Amorosi (1997) have it no strain then carries
//! `q/p > √(3G/2K)`, 0.83 for a Poisson's ratio of 0.3. With swelling, `G` follows from Poisson's ratio and `K` at a reference pressure.
//! These two are the model's [`Elasticity`], what stands for it wherever one stiffness is asked for.
//!
//! The return is implicit, and one unknown, the plastic volume strain `x` of the step, decides all the others:
//! `p = p(ε_tr − x)`, `p_tr − K x` where `K` is constant, `p_c = p_cn e^(x/Λ)`, `q` by the yield surface, and
//!
//! ```text
//! h(x) = 6G/M² x q − (q_tr − q)(2p − p_c) = 0
//! ```
//!
//! which is `x = Δγ (2p − p_c)` and `q = q_tr/(1 + 6G Δγ/M²)`. The root lies between the trial state, or where that is beyond a
//! tip the return along the axis, and the critical state `2p = p_c`: on the wet side the surface grows, on the dry one it shrinks.

mod bulk;
mod parameters;

pub use bulk::Swelling;
pub use parameters::KIND;

use super::model::equivalent_plastic;
use super::{Elasticity, Model, Moduli, Profile, Response, State, Variable, VariableKind};
use crate::error::{Error, Result};
use bulk::Bulk;
use std::sync::Arc;

/// Yield within this fraction of `p_c` counts as elastic, so that a returned state is.
const TOLERANCE: f64 = 1e-12;
/// Least preconsolidation pressure, over the first one, that a step begins with.
const LEAST: f64 = 1e-12;
/// Least logarithm of the factor on it in a step.
const LOWEST: f64 = -60.0;
/// Iterations of a search that halving ends.
const ITERATIONS: usize = 200;

const VARIABLES: [Variable; 1] =
    [Variable { name: "plastic_volume_strain", unit: "-", kind: VariableKind::Scalar, initial: 0.0 }];

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CamClay {
    elasticity: Elasticity,
    /// What the bulk modulus follows in place of `elasticity`.
    swelling: Option<Swelling>,
    /// M (-).
    slope: f64,
    /// p_c0 (kPa).
    preconsolidation: Profile,
    /// Λ (-).
    compressibility: f64,
}

/// The trial state of a return, and the size of the surface before it.
struct Trial {
    bulk: Bulk,
    /// G (kPa).
    rigidity: f64,
    slope: f64,
    compressibility: f64,
    /// Volume strain (-), positive in compression.
    strain: f64,
    /// p_tr and q_tr (kPa).
    pressure: f64,
    shear: f64,
    /// p_cn (kPa).
    size: f64,
}

impl Trial {
    fn pressure_at(&self, x: f64) -> f64 {
        self.bulk.relaxed(self.pressure, self.strain, x)
    }

    /// Where the pressure is `pressure`.
    fn at_pressure(&self, pressure: f64) -> f64 {
        self.bulk.relaxing(self.pressure, self.strain, pressure)
    }

    fn size_at(&self, x: f64) -> f64 {
        self.size * (x / self.compressibility).max(LOWEST).exp()
    }

    /// Where `weight · p − p_c`, which falls as `x` grows, is zero: the critical state for 2, the tip for 1.
    fn meets(&self, weight: f64) -> f64 {
        let (mut low, mut high) = (self.at_pressure(self.size).min(0.0), self.at_pressure(0.0).max(0.0));
        let excess = |x: f64| {
            let (p, size) = (self.pressure_at(x), self.size_at(x));
            let (fall, growth) = (weight * self.bulk.modulus(p), size / self.compressibility);
            match self.bulk {
                Bulk::Constant(_) => (weight * p - size, -fall - growth),
                // Both are exponential, so that their logarithms are straight lines.
                Bulk::Swelling { .. } if p > 0.0 => {
                    ((weight * p / size).ln(), -fall / (weight * p) - 1.0 / self.compressibility)
                }
                Bulk::Swelling { .. } => (f64::NEG_INFINITY, f64::NAN),
            }
        };
        bisect(&mut low, &mut high, self.last_bits(), excess)
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
        let start = if wet && self.pressure > self.size { self.meets(1.0) } else { self.at_pressure(0.0).min(0.0) };
        let rigidity = 6.0 * self.rigidity / self.slope.powi(2);
        // Negative at the lower end, positive at the upper one: h on the wet side, −h on the dry.
        let h = |x: f64| {
            let (p, size, q) = (self.pressure_at(x), self.size_at(x), self.shear_at(x));
            let normal = 2.0 * p - size;
            let value = rigidity * x * q - (self.shear - q) * normal;
            let slope = match self.bulk {
                // By halves.
                Bulk::Constant(_) => f64::NAN,
                Bulk::Swelling { .. } => {
                    let (fall, growth) = (-self.bulk.modulus(p), size / self.compressibility);
                    let rise = 0.5 * self.slope.powi(2) * (fall * (size - p) + p * (growth - fall)) / q;
                    rigidity * (q + x * rise) + rise * normal - (self.shear - q) * (2.0 * fall - growth)
                }
            };
            (-value, -slope)
        };
        let (mut low, mut high) = (start.min(critical), start.max(critical));
        bisect(&mut low, &mut high, self.last_bits(), h)
    }

    /// What the pressure does not feel of a plastic volume strain, where its search may stop; 0 where it goes on to the last bit.
    fn last_bits(&self) -> f64 {
        match self.bulk {
            Bulk::Constant(_) => 0.0,
            Bulk::Swelling { .. } => 2.0 * f64::EPSILON * self.strain.abs(),
        }
    }
}

/// The zero of a function that is not negative at `low` and not positive at `high`, by Newton's method with the slope that it
/// gives where that stays between them and is less than half as long as the step before, and by halves, for along an exponential Newton's
/// steps stay as long as they are; one below `tolerance` is the last.
fn bisect(low: &mut f64, high: &mut f64, tolerance: f64, f: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut x = 0.5 * (*low + *high);
    let mut before = *high - *low;
    for _ in 0..ITERATIONS {
        let (value, slope) = f(x);
        if value >= 0.0 {
            *low = x
        } else {
            *high = x
        }
        let newton = x - value / slope;
        if slope.is_finite() && (newton - x).abs() < tolerance {
            return newton.clamp(*low, *high);
        }
        let shrinks = newton > *low && newton < *high && (newton - x).abs() < 0.5 * before;
        let next = if shrinks { newton } else { 0.5 * (*low + *high) };
        if next == x || value == 0.0 {
            break;
        }
        before = (next - x).abs();
        x = next;
    }
    x
}

impl CamClay {
    /// Clay of constant moduli.
    ///
    /// # Errors
    /// Names the parameter that is out of range, at the datum of the preconsolidation pressure.
    pub fn new(elasticity: Elasticity, slope: f64, preconsolidation: Profile, compressibility: f64) -> Result<Self> {
        Self { elasticity, swelling: None, slope, preconsolidation, compressibility }.in_range()
    }

    /// Clay that swells along a line; the shear modulus is that of Poisson's ratio `poisson` (-) at the reference pressure of the line,
    /// or at its least pressure where that is more.
    ///
    /// # Errors
    /// As [`CamClay::new`].
    pub fn with_swelling(
        swelling: Swelling,
        poisson: f64,
        slope: f64,
        preconsolidation: Profile,
        compressibility: f64,
    ) -> Result<Self> {
        let reference = swelling.reference();
        reference.positive_at("reference_pressure", reference.datum)?;
        // What is wrong then is Poisson's ratio.
        Elasticity::new(reference, poisson)?;
        let per_pressure = 3.0 * (1.0 - 2.0 * poisson) / swelling.slope();
        let young = reference.scaled(per_pressure);
        young.positive_at("swelling", young.datum)?;
        let elasticity = Elasticity::new(young, poisson)?.at_least(per_pressure * swelling.least());
        Self { elasticity, swelling: Some(swelling), slope, preconsolidation, compressibility }.in_range()
    }

    /// This one, if its parameters are in range.
    fn in_range(self) -> Result<Self> {
        for (name, value) in [("critical_slope", self.slope), ("plastic_compressibility", self.compressibility)] {
            if !(value > 0.0 && value.is_finite()) {
                return Err(Error::input(name, format!("{value} is not positive"), "give a value above 0"));
            }
        }
        self.check(self.preconsolidation.datum)?;
        Ok(self)
    }

    /// The law of the bulk modulus at height `y` (m), `moduli` those of the elasticity there.
    fn bulk(&self, y: f64, moduli: &Moduli) -> Bulk {
        match self.swelling {
            None => Bulk::Constant(moduli.bulk()),
            Some(swelling) => swelling.at(self.preconsolidation.at(y)),
        }
    }

    /// p_c (kPa) after a plastic volume strain.
    fn size(&self, y: f64, strain: f64) -> f64 {
        self.preconsolidation.at(y) * (strain / self.compressibility).exp().max(LEAST)
    }

    /// M (-) in a state.
    fn slope(&self, state: &State) -> f64 {
        self.slope * state.strength
    }

    /// The yield function over p_c (kPa), given M.
    fn excess(slope: f64, p: f64, q: f64, size: f64) -> f64 {
        ((q / slope).powi(2) + p * (p - size)) / size
    }
}

impl Model for CamClay {
    fn respond(&self, y: f64, trial: &[f64; 3], state: &State, internal: &mut [f64]) -> Response {
        let moduli = self.elasticity.at(y);
        let volumetric = trial[0] + trial[1] + trial[2];
        let e = trial.map(|x| x - volumetric / 3.0);
        let norm = (e[0] * e[0] + e[1] * e[1] + e[2] * e[2]).sqrt();
        let (bulk, shear, before) = (self.bulk(y, &moduli), moduli.shear, internal[0]);
        let t = Trial {
            bulk,
            rigidity: shear,
            slope: self.slope(state),
            compressibility: self.compressibility,
            strain: -volumetric,
            pressure: bulk.pressure(-volumetric),
            shear: 2.0 * shear * 1.5f64.sqrt() * norm,
            size: self.size(y, before),
        };
        if Self::excess(t.slope, t.pressure, t.shear, t.size) <= TOLERANCE * t.size {
            return match bulk {
                Bulk::Constant(_) => Response::elastic(&moduli, trial, state),
                Bulk::Swelling { .. } => {
                    let now = Moduli { lambda: bulk.modulus(t.pressure) - 2.0 / 3.0 * shear, shear };
                    let stress = e.map(|x| 2.0 * shear * x - t.pressure);
                    Response { stress, ..Response::elastic(&now, trial, state) }
                }
            };
        }
        let x = t.volume();
        let (p, size) = (t.pressure_at(x), t.size_at(x));
        if size <= LEAST * self.preconsolidation.at(y) {
            // Nothing is left of the surface.
            internal[0] = self.compressibility * LEAST.ln();
            return Response {
                stress: [0.0; 3],
                tangent: [[0.0; 3]; 3],
                elastic_strain: [0.0; 3],
                plastic_strain: state.plastic_strain + equivalent_plastic(trial),
                yielding: true,
            };
        }
        let bulk = bulk.modulus(p);
        let normal = 2.0 * p - size;
        let m = t.slope.powi(2);
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
        let elastic_strain = match self.swelling {
            None => moduli.strain(&stress),
            Some(_) => e.map(|x| kept * x - t.bulk.strain(p) / 3.0),
        };
        let plastic = std::array::from_fn(|k| trial[k] - elastic_strain[k]);
        internal[0] = before.max(self.compressibility * LEAST.ln()) + x;
        Response {
            stress,
            tangent,
            elastic_strain,
            plastic_strain: state.plastic_strain + equivalent_plastic(&plastic),
            yielding: true,
        }
    }

    fn yield_excess(&self, y: f64, stress: &[f64; 3], state: &State) -> f64 {
        let [a, b, c] = stress;
        let q = (0.5 * ((a - b).powi(2) + (b - c).powi(2) + (c - a).powi(2))).sqrt();
        Self::excess(self.slope(state), -(a + b + c) / 3.0, q, self.size(y, state.first_variable()))
    }

    fn elasticity(&self) -> &Elasticity {
        &self.elasticity
    }

    fn mean_stress(&self, y: f64, volume_strain: f64) -> f64 {
        -self.bulk(y, &self.elasticity.at(y)).pressure(-volume_strain)
    }

    fn bulk_modulus(&self, y: f64, mean: f64) -> f64 {
        self.bulk(y, &self.elasticity.at(y)).modulus(-mean)
    }

    fn elastic_stress(&self, y: f64, strain: &[f64; 3]) -> [f64; 3] {
        let moduli = self.elasticity.at(y);
        if self.swelling.is_none() {
            return moduli.stress(strain);
        }
        let volumetric = strain[0] + strain[1] + strain[2];
        let mean = self.mean_stress(y, volumetric);
        strain.map(|e| mean + 2.0 * moduli.shear * (e - volumetric / 3.0))
    }

    fn elastic_strain(&self, y: f64, stress: &[f64; 3]) -> [f64; 3] {
        let moduli = self.elasticity.at(y);
        if self.swelling.is_none() {
            return moduli.strain(stress);
        }
        let mean = (stress[0] + stress[1] + stress[2]) / 3.0;
        let volumetric = -self.bulk(y, &moduli).strain(-mean);
        stress.map(|s| volumetric / 3.0 + (s - mean) / (2.0 * moduli.shear))
    }

    fn elastic_energy(&self, y: f64, strain: &[f64; 3]) -> f64 {
        let moduli = self.elasticity.at(y);
        if self.swelling.is_none() {
            return moduli.energy(strain);
        }
        let volumetric = strain[0] + strain[1] + strain[2];
        let deviatoric: f64 = strain.iter().map(|e| (e - volumetric / 3.0).powi(2)).sum();
        self.bulk(y, &moduli).energy(-volumetric) + moduli.shear * deviatoric
    }

    fn symmetric(&self) -> bool {
        false
    }

    fn internal_variables(&self) -> &[Variable] {
        &VARIABLES
    }

    fn shear_strength(&self, y: f64, state: &State) -> f64 {
        // q = M p at p = p_c/2, where yield does not change the volume; in simple shear it is √3 times the shear stress.
        self.slope(state) * 0.5 * self.size(y, state.first_variable()) / 3f64.sqrt()
    }

    fn reduced(&self, factor: f64) -> Arc<dyn Model> {
        Arc::new(Self { slope: self.slope / factor, ..*self })
    }

    fn check(&self, y: f64) -> Result<()> {
        // The reference may be the preconsolidation.
        self.preconsolidation.positive_at("preconsolidation", y)?;
        match self.swelling {
            None => self.elasticity.check(y),
            Some(swelling) => swelling.reference().positive_at("reference_pressure", y),
        }
    }
}

#[cfg(test)]
mod tests;
