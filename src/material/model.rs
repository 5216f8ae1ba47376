//! What a material model answers to, and what it may be asked.

use super::elasticity::{Elasticity, Moduli};
use crate::error::Result;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// What a model remembers at a point from step to step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    /// Accumulated equivalent plastic strain (-): the sum of `√(⅔ Δε_p:Δε_p)` over the steps, `Δε_p` the
    /// plastic Hencky strain of a step with its volumetric part.
    pub plastic_strain: f64,
    /// What hardens or softens the model, 0 at first: its own quantity, if [`Model::remembers`].
    pub memory: f64,
    /// Steps a second (1/s), which is no memory but comes along: one over the size of the step in hand, 0 where time plays no
    /// part.
    pub inverse_dt: f64,
}

/// The answer of a model, in principal axes, in the order of the trial strains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Kirchhoff stress (kPa), tension positive.
    pub stress: [f64; 3],
    /// `∂τ_A/∂ε_B` of the stress with respect to the elastic trial strain (kPa).
    pub tangent: [[f64; 3]; 3],
    /// Elastic Hencky strain after the return (-).
    pub elastic_strain: [f64; 3],
    pub state: State,
    /// Whether the point yielded.
    pub yielding: bool,
}

impl Response {
    /// The response of a point that does not yield.
    pub fn elastic(moduli: &Moduli, trial: &[f64; 3], state: &State) -> Self {
        Self {
            stress: moduli.stress(trial),
            tangent: moduli.tangent(),
            elastic_strain: *trial,
            state: *state,
            yielding: false,
        }
    }
}

/// A material model.
pub trait Model: Send + Sync {
    /// The response at a point seeded at height `y` (m) to the elastic trial Hencky strains.
    fn respond(&self, y: f64, trial: &[f64; 3], state: &State) -> Response;

    /// The elastic part; where that depends on the pressure, what stands for it wherever one stiffness is asked for.
    fn elasticity(&self) -> &Elasticity;

    /// Whether the tangent is symmetric in every state (associated flow).
    fn symmetric(&self) -> bool;

    /// Whether the model needs [`State::memory`].
    fn remembers(&self) -> bool {
        false
    }

    /// How far principal Kirchhoff stresses, in any order, lie outside the yield surface at height `y` in a state, at
    /// rest, as a stress (kPa); negative inside.
    fn yield_excess(&self, y: f64, stress: &[f64; 3], state: &State) -> f64;

    /// The shear strength (kPa) at height `y` in a state, at rest: `s_u`, `σ_y/√3`, `c`, in Modified Cam-Clay that of the
    /// critical state in simple shear without drainage. Infinite without yield.
    fn shear_strength(&self, y: f64, state: &State) -> f64;

    /// Whether there is a limit to the stress.
    fn yields(&self) -> bool {
        self.shear_strength(0.0, &State::default()).is_finite()
    }

    /// Whether the parameters are in range at height `y`; a profile is linear below its datum, so the
    /// lowest point of a region answers for the region.
    ///
    /// # Errors
    /// Names the parameter and its value.
    fn check(&self, y: f64) -> Result<()>;

    /// The same material with its strengths divided by `factor` (-): `c`, `tan φ`, `σ_t`, `s_u`, the yield stress, `M`. An
    /// angle of dilation stays, as far as it is not above that of friction; with that of friction it remains equal to it.
    fn reduced(&self, factor: f64) -> Arc<dyn Model>;

    /// Young's modulus (kPa) at height `y`: the scale of penalties and tolerances.
    fn young(&self, y: f64) -> f64 {
        self.elasticity().young(y)
    }

    /// Mean Kirchhoff stress (kPa) of an elastic volume strain.
    fn mean_stress(&self, y: f64, volume_strain: f64) -> f64 {
        self.elasticity().at(y).bulk() * volume_strain
    }

    /// Bulk modulus (kPa) at a mean Kirchhoff stress (kPa).
    fn bulk_modulus(&self, y: f64, _mean: f64) -> f64 {
        self.elasticity().at(y).bulk()
    }

    /// Principal Kirchhoff stress of an elastic principal strain.
    fn elastic_stress(&self, y: f64, strain: &[f64; 3]) -> [f64; 3] {
        self.elasticity().at(y).stress(strain)
    }

    /// What an elastic principal strain stores (kPa), energy for each volume when seeded.
    fn elastic_energy(&self, y: f64, strain: &[f64; 3]) -> f64 {
        self.elasticity().at(y).energy(strain)
    }

    /// Elastic principal strain of a principal Kirchhoff stress, the inverse of [`Model::elastic_stress`].
    fn elastic_strain(&self, y: f64, stress: &[f64; 3]) -> [f64; 3] {
        self.elasticity().at(y).strain(stress)
    }
}

/// How far beyond yield (-), in the strength or the stress, a stress is told of.
const BEYOND: f64 = 1e-3;

/// Whether principal Kirchhoff stresses at height `y` are more than a model bears in a state, at rest.
pub fn is_beyond_yield(model: &dyn Model, y: f64, stress: &[f64; 3], state: &State) -> bool {
    let unit = stress.iter().fold(model.shear_strength(y, state), |most, s| most.max(s.abs()));
    model.yields() && model.yield_excess(y, stress, state) > BEYOND * unit
}

/// Poisson's ratios (-) that soil has.
const POISSON: RangeInclusive<f64> = 0.0..=0.45;

/// What is said of those of soil beyond.
pub fn on_poisson(ratio: f64) -> String {
    let (least, most) = (POISSON.start(), POISSON.end());
    format!(
        "is {ratio:.2}, below {least} or above {most}; a `reference_pressure` that follows the pressure in the ground keeps it near `poisson`"
    )
}

/// Poisson's ratio (-) of a model at height `y` and the principal Kirchhoff stresses, where no soil has such a one and the model has it by its stress.
pub fn odd_poisson(model: &dyn Model, y: f64, stress: &[f64; 3]) -> Option<f64> {
    let bulk = model.bulk_modulus(y, stress.iter().sum::<f64>() / 3.0);
    let ratio = model.elasticity().at(y).poisson_beside(bulk);
    // With moduli that are constant it is that given, but for the last bits.
    let given = model.elasticity().poisson();
    (!POISSON.contains(&ratio) && (ratio - given).abs() > 1e-6).then_some(ratio)
}

/// Equivalent `√(⅔ ε:ε)` of a principal plastic strain increment.
pub(super) fn equivalent_plastic(increment: &[f64; 3]) -> f64 {
    let [a, b, c] = increment;
    (2.0 / 3.0 * (a * a + b * b + c * c)).sqrt()
}
