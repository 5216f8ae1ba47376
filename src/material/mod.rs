//! Material models: pure functions from elastic trial strain to stress, tangent and new state.
//!
//! All work in principal axes of the elastic trial left Cauchy–Green tensor with Hencky strains
//! `ε_A = ½ ln b_A` and Kirchhoff stresses `τ_A`: the return maps are those of small strain theory.

/// A parameter that may vary with depth: `top + gradient · max(0, datum − y)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    /// Value at the height `datum` and above.
    pub top: f64,
    /// Growth per metre below `datum`.
    pub gradient: f64,
    /// Height y [m] at which the growth begins.
    pub datum: f64,
}

impl Profile {
    pub fn constant(value: f64) -> Self {
        Self { top: value, gradient: 0.0, datum: 0.0 }
    }

    /// The value at height `y` [m].
    pub fn at(&self, y: f64) -> f64 {
        self.top + self.gradient * (self.datum - y).max(0.0)
    }
}

/// What a model remembers at a point from step to step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct State {
    /// Accumulated equivalent plastic strain [-].
    pub plastic_strain: f64,
}

/// The answer of a model, in principal axes, in the order of the trial strains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Response {
    /// Kirchhoff stress [kPa], tension positive.
    pub stress: [f64; 3],
    /// `∂τ_A/∂ε_B` of the stress with respect to the elastic trial strain [kPa].
    pub tangent: [[f64; 3]; 3],
    /// Elastic Hencky strain after the return [-].
    pub elastic_strain: [f64; 3],
    pub state: State,
    /// Whether the point yielded.
    pub yielding: bool,
}

/// A material model.
pub trait Model: Send + Sync {
    /// The response at a point seeded at height `y` [m] to the elastic trial Hencky strains.
    fn respond(&self, y: f64, trial: &[f64; 3], state: &State) -> Response;

    /// Young's modulus [kPa] at height `y`: the scale of penalties and tolerances.
    fn young(&self, y: f64) -> f64;

    /// Elastic principal strain of a principal Kirchhoff stress.
    fn elastic_strain(&self, y: f64, stress: &[f64; 3]) -> [f64; 3];

    /// Whether the tangent is symmetric in every state (associated flow).
    fn symmetric(&self) -> bool;
}
