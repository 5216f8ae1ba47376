//! Contact with soil in steps with inertia: an impulse at the beginning of the step (docs/theory.md, section 5, *Contact*).

use super::grid::Grid;
use super::mass::accelerations;
use super::problem::Solution;
use super::scene::Scene;
use super::state::State;
use crate::contact::Motion;
use crate::error::Result;
use crate::kinematics::Kinematics;
use crate::term::{Trial, contact_answer};
use crate::time_integration::GeneralisedAlpha;

/// The force (kN, one entry an equation) of contact with soil that acts as an impulse in a step with inertia; empty where nothing touches.
pub fn force<const D: usize>(scene: &Scene<D>, grid: &Grid<D>, trial: &Trial<D>) -> Vec<f64> {
    let mut sum = Vec::new();
    for constraint in grid.constraints.iter().filter(|constraint| !constraint.condition.looks_ahead) {
        let condition = &constraint.condition;
        let law = scene.interfaces[constraint.interface as usize].sides().laws.at(trial.phase);
        let (answer, Motion { turn, .. }) = contact_answer(law, scene.levels.as_ref(), constraint, trial);
        if answer.pressure == 0.0 && answer.shear == 0.0 {
            continue;
        }
        sum.resize(grid.motion.pattern.len(), 0.0);
        for (k, (t, &node)) in condition.by_tangent.iter().zip(&condition.nodes).enumerate() {
            let (n, lever) = (condition.normal(k, turn), condition.curvature * answer.moment);
            for d in 0..D {
                if let Some(equation) = grid.dofs.displacement(node, d) {
                    let by_arc = lever * condition.by_arc[k][d];
                    sum[equation] += condition.area * (answer.pressure * n[d] + answer.shear * t[d] + by_arc);
                }
            }
        }
    }
    sum
}

/// The acceleration of the nodes (m/s²) by contact alone in a converged step of `dt` (s); empty where nothing touches. The residual of the `solution`
/// has the force with its weight in the equations ([`Trial::contact_weight`]) and becomes that of the force itself, as supports bear it.
///
/// # Errors
/// An analysis error when the mass is singular.
pub fn release<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &State<D>,
    solution: &mut Solution<D>,
    dt: f64,
) -> Result<Vec<[f64; D]>> {
    let integration = GeneralisedAlpha::new(scene.numerics.spectral_radius, dt);
    let trial = Trial {
        phase: state.phase,
        time: state.phase_time + (1.0 - integration.alpha_f) * dt,
        reduction: scene.phases[state.phase].reduction_at(state.phase_time + dt),
        ..Trial::at_rest(&solution.displacement, &state.displacement)
    };
    let force = force(scene, grid, &trial);
    if force.is_empty() {
        return Ok(Vec::new());
    }
    let more = integration.impulse() - 1.0;
    solution.residual.iter_mut().zip(&force).for_each(|(residual, force)| *residual += more * force);
    let against: Vec<f64> = force.iter().map(|force| -force).collect();
    accelerations::<D, K>(scene, grid, state, &against)
}
