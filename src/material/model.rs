//! What a material model answers to, and what it may be asked.

use super::elasticity::{Elasticity, Moduli};
use super::spectral;
use crate::error::Result;
use crate::tensor::Symmetric;
use std::ops::RangeInclusive;
use std::sync::Arc;

/// An internal variable of a model: a quantity that a point carries from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Variable {
    pub name: &'static str,
    pub unit: &'static str,
    pub kind: VariableKind,
    /// Its first value, see [`Model::begin`]; of a tensor its normal components.
    pub initial: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum VariableKind {
    Scalar,
    /// A symmetric tensor that turns with the material, by the rotation of each step.
    Tensor,
}

impl Variable {
    /// Numbers that a point carries of it; those of a tensor are in the order of [`Symmetric`].
    pub fn components(&self) -> usize {
        match self.kind {
            VariableKind::Scalar => 1,
            VariableKind::Tensor => 6,
        }
    }
}

/// The state of a point as a step begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<'a> {
    /// Accumulated equivalent plastic strain (-): the sum of `√(⅔ Δε_p:Δε_p)` over the steps, `Δε_p` the
    /// plastic Hencky strain of a step with its volumetric part.
    pub plastic_strain: f64,
    /// The internal variables one after the other, in the order of [`Model::internal_variables`], perhaps with padding that has
    /// no meaning at the end; empty stands for the initial values.
    pub internal: &'a [f64],
    /// Steps a second (1/s): one over the size of the step in hand, 0 where time plays no part.
    pub inverse_dt: f64,
    /// The strength over that of the model's parameters (-): 1, or the value of a field ([`super::RandomStrength`]). A model multiplies those
    /// of its parameters by it that [`Model::reduced`] divides.
    pub strength: f64,
    /// Part (-) of the elastic tangent that is added to that of a yielding point of a model with friction ([`Model::has_friction`]), for the
    /// directions of Newton's method; the stress is as without.
    pub stiffening: f64,
}

impl State<'_> {
    /// The first internal variable; of initial values, 0.
    pub fn first_variable(&self) -> f64 {
        self.internal.first().copied().unwrap_or(0.0)
    }
}

/// Nothing has happened yet, and the strength is that of the parameters.
impl Default for State<'_> {
    fn default() -> Self {
        Self { plastic_strain: 0.0, internal: &[], inverse_dt: 0.0, strength: 1.0, stiffening: 0.0 }
    }
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
    /// Accumulated equivalent plastic strain (-).
    pub plastic_strain: f64,
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
            plastic_strain: state.plastic_strain,
            yielding: false,
        }
    }
}

/// The tangent `a_ijkl` (kPa) in three dimensions: row (i, j), column (k, l) in the order xx, xy, xz, yx, …
pub type SolidTangent = [[f64; 9]; 9];

/// The response of a point in the axes of space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spatial<T> {
    /// Kirchhoff stress (kPa), tension positive.
    pub kirchhoff: Symmetric,
    /// Elastic left Cauchy–Green tensor (-) after the return.
    pub elastic: Symmetric,
    /// `a_ijkl = C_ijkl − τ_il δ_jk` (kPa).
    pub tangent: T,
    /// Accumulated equivalent plastic strain (-).
    pub plastic_strain: f64,
    /// Whether the point yielded.
    pub yielding: bool,
}

/// A material model: isotropic, in principal values, with scalar internal variables.
pub trait Model: Send + Sync {
    /// The response at a point seeded at height `y` (m) to the elastic trial Hencky strains. `internal` holds the internal
    /// variables at the beginning of the step, and when the model has responded those at its end.
    fn respond(&self, y: f64, trial: &[f64; 3], state: &State, internal: &mut [f64]) -> Response;

    /// How far principal Kirchhoff stresses, in any order, lie outside the yield surface at height `y` in a state, at
    /// rest, as a stress (kPa); negative inside.
    fn yield_excess(&self, y: f64, stress: &[f64; 3], state: &State) -> f64;

    /// Its internal variables.
    fn internal_variables(&self) -> &[Variable] {
        &[]
    }

    /// Gives the internal variables of a point seeded at height `y` their first values.
    fn begin(&self, _y: f64, internal: &mut [f64]) {
        let mut left = internal;
        for variable in self.internal_variables() {
            let (own, rest) = left.split_at_mut(variable.components());
            own.fill(0.0);
            own.iter_mut().take(3).for_each(|value| *value = variable.initial);
            left = rest;
        }
    }

    /// Whether principal Cauchy stresses (kPa), in any order, are at a limit of tension at height `y` in a state; never without one.
    fn is_at_tension_limit(&self, _y: f64, _stress: &[f64; 3], _state: &State) -> bool {
        false
    }

    /// The elastic part, which is isotropic; where that depends on the pressure, what stands for it wherever one stiffness is asked for.
    fn elasticity(&self) -> &Elasticity;

    /// Whether the tangent with respect to the strain is symmetric in every state (associated flow).
    fn symmetric(&self) -> bool;

    /// The shear strength (kPa) at height `y` in a state, at rest: `s_u`, `σ_y/√3`, `c`, in Modified Cam-Clay that of the
    /// critical state in simple shear without drainage. Infinite without yield.
    fn shear_strength(&self, y: f64, state: &State) -> f64;

    /// Whether the strength grows with the pressure from next to nothing: such soil is far weaker beside its stiffness near a free surface than
    /// clay, and bears nothing at the apex of its yield surface.
    fn has_friction(&self) -> bool {
        false
    }

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

/// Whether a Kirchhoff stress at height `y` is more than a model bears in a state, at rest.
pub fn is_beyond_yield(model: &dyn Model, y: f64, stress: &Symmetric, state: &State) -> bool {
    let stress = spectral::roots(stress);
    let unit = stress.iter().fold(model.shear_strength(y, state), |most, s| most.max(s.abs()));
    model.yields() && model.yield_excess(y, &stress, state) > BEYOND * unit
}

/// How far below a limit (-), in the strength or the stress, a stress is at it: what fitted fields are off.
pub(super) const AT: f64 = 1e-3;

/// What a point does at principal stresses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Plasticity {
    Elastic,
    /// At the yield surface.
    Plastic,
    /// At a limit of tension.
    Tension,
}

impl Plasticity {
    /// Of a Cauchy stress at height `y` (m) in a state, given the volume ratio (-).
    pub fn of(model: &dyn Model, y: f64, stress: &Symmetric, volume_ratio: f64, state: &State) -> Self {
        let stress = spectral::roots(stress);
        let kirchhoff = stress.map(|s| volume_ratio * s);
        let unit = kirchhoff.iter().fold(model.shear_strength(y, state), |most, s| most.max(s.abs()));
        if model.is_at_tension_limit(y, &stress, state) {
            Self::Tension
        } else if model.yields() && model.yield_excess(y, &kirchhoff, state) >= -AT * unit {
            Self::Plastic
        } else {
            Self::Elastic
        }
    }
}

/// Numbers that a point carries of the internal variables of a model.
pub fn internal_count(model: &dyn Model) -> usize {
    model.internal_variables().iter().map(Variable::components).sum()
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
