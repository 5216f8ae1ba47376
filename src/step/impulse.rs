//! Contact with soil in steps with inertia: an impulse at the beginning of the step (docs/theory.md, section 5, *Contact*).

use super::balance::evaluate;
use super::family::System;
use super::grid::Grid;
use super::mass::accelerations;
use super::problem::{Problem, Solution};
use super::scene::Scene;
use crate::contact::Motion;
use crate::error::Result;
use crate::kinematics::Kinematics;
use crate::term::{Trial, contact_answer};

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

/// The acceleration of the nodes (m/s²) by contact alone in a converged step; empty where nothing touches. It is that of what the body resists an
/// impulse with ([`crate::time_integration::GeneralisedAlpha::resisting`]). The residual of the `solution` has the force with its weight in the equations
/// ([`Trial::contact_weight`]) and becomes that of the force itself, as supports bear it.
///
/// # Errors
/// An analysis error when the mass is singular.
pub fn release<const D: usize, K: Kinematics<D>>(
    problem: &Problem<D>,
    grid: &mut Grid<D>,
    solution: &mut Solution<D>,
) -> Result<Vec<[f64; D]>> {
    let Problem { scene, state, .. } = *problem;
    let Some(integration) = problem.integration else { return Ok(Vec::new()) };
    let trial = Trial {
        phase: problem.phase,
        time: (1.0 - integration.alpha_f) * problem.to + integration.alpha_f * problem.from,
        reduction: scene.phases[problem.phase].reduction_at(problem.to),
        ..Trial::at_rest(&solution.displacement, &state.displacement)
    };
    let force = force(scene, grid, &trial);
    if force.is_empty() {
        return Ok(Vec::new());
    }
    let more = integration.impulse() - 1.0;
    solution.residual.iter_mut().zip(&force).for_each(|(residual, force)| *residual += more * force);
    let Some(resisting) = integration.resisting() else {
        let against: Vec<f64> = force.iter().map(|force| -force).collect();
        return accelerations::<D, K>(scene, grid, state, &against);
    };
    let moved = matrix_without_contact(&Problem { integration: Some(resisting), ..*problem }, grid, solution)
        .and_then(|()| solve(problem, grid, force))?;
    let mut acceleration = vec![[0.0; D]; scene.displacements()];
    for d in 0..D {
        let of_nodes: Vec<f64> =
            (0..grid.dofs.node.len()).map(|block| resisting.slope() * moved[block * D + d]).collect();
        grid.dofs.write(&of_nodes, d, &mut acceleration);
    }
    Ok(acceleration)
}

/// Makes the matrix of the grid that of a step in its converged state, without what contact resists.
fn matrix_without_contact<const D: usize>(
    problem: &Problem<D>,
    grid: &mut Grid<D>,
    solution: &Solution<D>,
) -> Result<()> {
    let mut buffers = std::mem::take(&mut grid.buffers);
    let mut now = std::mem::take(&mut buffers.now);
    now.at.set(&solution.displacement, &solution.pressure);
    let constraints = std::mem::take(&mut grid.constraints);
    let result = evaluate(problem, grid, &mut buffers, &mut now, true);
    grid.constraints = constraints;
    buffers.now = now;
    grid.buffers = buffers;
    result
}

/// What a force (kN, one entry an equation) moves that the matrix of the grid resists; nothing where the displacement is given.
fn solve<const D: usize>(problem: &Problem<D>, grid: &mut Grid<D>, mut force: Vec<f64>) -> Result<Vec<f64>> {
    let System { pattern, matrix, solver } = &mut grid.motion;
    let fixed: Vec<bool> = problem.given.iter().map(Option::is_some).collect();
    let diagonal = matrix.scale(pattern);
    matrix.constrain(pattern, &fixed, &vec![0.0; fixed.len()], diagonal, &mut force);
    if matrix.matrix_free.is_empty() {
        solver.solve(pattern, matrix, &mut force)?;
    } else {
        solver.solve_matrix_free(pattern, matrix, problem.scene.numerics.tolerance, &mut force)?;
    }
    Ok(force)
}
