//! The unknowns of a step, ordered as in the state, and the vectors that the iterations reuse.

use crate::term::{Frozen, Works};

/// Displacement of the nodes and, where there is one, the pressure field.
#[derive(Default)]
pub struct Unknowns<const D: usize> {
    /// Displacement of the nodes (m) since the last grid reset.
    pub displacement: Vec<[f64; D]>,
    /// As [`super::State::pressure`] (kPa).
    pub pressure: Vec<f64>,
    /// Under linear constraints the increment (m) of the controls since the last converged step, one entry an equation of displacements;
    /// else empty.
    pub controls: Vec<f64>,
}

impl<const D: usize> Unknowns<D> {
    pub fn set(&mut self, displacement: &[[f64; D]], pressure: &[f64]) {
        self.displacement.clear();
        self.displacement.extend_from_slice(displacement);
        self.pressure.clear();
        self.pressure.extend_from_slice(pressure);
        self.controls.clear();
    }

    pub fn clone_from(&mut self, other: &Self) {
        self.set(&other.displacement, &other.pressure);
        self.controls.extend_from_slice(&other.controls);
    }
}

/// A state and its residual.
pub struct Evaluation<const D: usize> {
    pub at: Unknowns<D>,
    pub force: Vec<f64>,
    pub applied: [f64; D],
    /// Norm (kN) of the largest term in the equations of the displacements: the scale of the residual.
    pub scale: f64,
    /// The work of the terms along the displacement since the last converged step.
    pub work: Works,
}

impl<const D: usize> Default for Evaluation<D> {
    fn default() -> Self {
        Self { at: Unknowns::default(), force: Vec::new(), applied: [0.0; D], scale: 0.0, work: Works::default() }
    }
}

/// Vectors that the iterations of all steps use.
#[derive(Default)]
pub struct Buffers<const D: usize> {
    pub now: Evaluation<D>,
    pub trial: Evaluation<D>,
    pub best: Unknowns<D>,
    /// Whether smaller steps are in vain, so that what is less sure than Newton's method may end the step; the state with the least residual.
    pub in_vain: bool,
    /// Whether half the step has left the same residual.
    pub is_alike: bool,
    pub nearest: Unknowns<D>,
    /// Whether the last iteration began with the predicted state.
    pub predicted: bool,
    pub delta: Vec<f64>,
    /// The right-hand side (kN) of the linear system for `delta`.
    pub wanted: Vec<f64>,
    pub gap: Vec<f64>,
    pub fixed: Vec<bool>,
    /// The equations whose diagonal is raised by damping: those of nodes of no structure in contact. Empty until needed.
    pub damped: Vec<bool>,
    /// The residual of one term.
    pub own: Vec<f64>,
    /// The displacement (m) since the last converged step, one entry an equation.
    pub way: Vec<f64>,
    pub between: Vec<[f64; D]>,
    pub acceleration: Vec<[f64; D]>,
    pub ahead: Vec<[f64; D]>,
    /// As [`crate::term::Trial::frozen`].
    pub frozen: Frozen,
    /// The least relative residual (-) of the last iteration; not a number where that had none.
    pub least: f64,
    /// As [`crate::material::State::stiffening`].
    pub stiffening: f64,
}
