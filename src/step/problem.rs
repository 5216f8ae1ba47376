//! A step as an equation, and its solution.

use super::grid::Grid;
use super::scene::Scene;
use super::state::State;
use super::unknowns::Unknowns;
use crate::dofs::Dof;
use crate::system::Method;
use crate::time_integration::GeneralisedAlpha;

/// What is to be solved.
pub struct Problem<'a, const D: usize> {
    pub scene: &'a Scene<D>,
    pub state: &'a State<D>,
    /// Displacement (m) of the nodes that the iteration begins with, if not the converged one.
    pub predictor: Option<&'a [[f64; D]]>,
    /// State of the nodes at the last converged step.
    pub converged: &'a [[f64; D]],
    /// The pressure field (kPa) there; empty without one.
    pub pressure: &'a [f64],
    pub velocity: &'a [[f64; D]],
    pub acceleration: &'a [[f64; D]],
    pub phase: usize,
    /// Time (s) in the phase at the beginning and the end of the step.
    pub from: f64,
    pub to: f64,
    /// Increment (m, kPa) of the displacements and pore pressures that are given, `None` where free. One entry an equation.
    pub given: &'a [Option<f64>],
    /// Present in dynamic analysis.
    pub integration: Option<GeneralisedAlpha>,
    /// Time (s) that water flows for.
    pub flow_time: f64,
}

impl<'a, const D: usize> Problem<'a, D> {
    /// A problem at the last converged state, without prescribed increments and inertia.
    pub fn at_rest(scene: &'a Scene<D>, state: &'a State<D>) -> Self {
        Self {
            scene,
            state,
            predictor: None,
            converged: &state.displacement,
            pressure: &state.pressure,
            velocity: &state.velocity,
            acceleration: &state.acceleration,
            phase: state.phase,
            from: state.phase_time,
            to: state.phase_time,
            given: &[],
            integration: None,
            flow_time: 0.0,
        }
    }

    /// Adds `length · δ`, one entry an equation, to the unknowns; a full step reaches the prescribed values to the last bit.
    pub fn advance(&self, grid: &Grid<D>, at: &mut Unknowns<D>, delta: &[f64], length: f64) {
        for (equation, (delta, given)) in delta.iter().zip(self.given).enumerate() {
            let (value, converged, scale) = match grid.dofs.dof(equation) {
                Dof::Displacement { node, component } => {
                    (&mut at.displacement[node][component], self.converged[node][component], 1.0)
                }
                Dof::Pressure(place) => (&mut at.pressure[place], self.pressure[place], self.scene.unit(place)),
            };
            match given {
                Some(increment) if length == 1.0 => *value = converged + increment,
                _ => *value += length * scale * delta,
            }
        }
    }
}

/// A converged step.
pub struct Solution<const D: usize> {
    /// Displacement of the nodes (m) since the last grid reset.
    pub displacement: Vec<[f64; D]>,
    /// The pressure field (kPa); empty without one.
    pub pressure: Vec<f64>,
    /// Residual (kN), one entry an equation: zero where free, the force of the support where given.
    pub residual: Vec<f64>,
    /// Relative residuals, the first before the first iteration.
    pub history: Vec<f64>,
    /// Resultant (kN) of the applied forces, weighted in time as the step does.
    pub applied: [f64; D],
    pub method: Method,
}
