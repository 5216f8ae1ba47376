//! Contact with soil in steps with inertia: an impulse at the beginning of the step (docs/theory.md, section 5, *Contact*).

use super::balance::{evaluate, inertia};
use super::family::System;
use super::grid::Grid;
use super::mass::accelerations;
use super::problem::{Problem, Solution};
use super::scene::Scene;
use super::start::Start;
use super::state::State;
use crate::contact::{Answer, Penalty};
use crate::error::Result;
use crate::kinematics::Kinematics;
use crate::term::{PlacedConstraint, Trial, contact_answer};
use crate::time_integration::GeneralisedAlpha;

/// The force (kN, one entry an equation) of contact with soil that acts as an impulse in a step with inertia, in a state; empty where nothing touches.
pub fn force<const D: usize>(scene: &Scene<D>, grid: &Grid<D>, trial: &Trial<D>) -> Vec<f64> {
    sum(grid, |constraint| {
        let law = scene.interfaces[constraint.interface as usize].sides().laws.at(trial.phase);
        let (answer, motion) = contact_answer(law, scene.levels.as_ref(), constraint, trial);
        (answer, motion.turn)
    })
}

/// The same as the last step left it, in the constraints of the next one.
pub fn held<const D: usize>(grid: &Grid<D>) -> Vec<f64> {
    sum(grid, |constraint| {
        let Penalty { pressure, shear, .. } = constraint.condition.penalty;
        (Answer { pressure, shear, ..Answer::default() }, 0.0)
    })
}

/// The sum of what contact nodes answer with a turn of their normal (rad).
fn sum<const D: usize>(grid: &Grid<D>, answer: impl Fn(&PlacedConstraint<D>) -> (Answer, f64)) -> Vec<f64> {
    let mut sum = Vec::new();
    for constraint in grid.constraints.iter().filter(|constraint| !constraint.condition.looks_ahead) {
        let condition = &constraint.condition;
        let (answer, turn) = answer(constraint);
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

/// The acceleration of the nodes (m/s²) by contact alone in a converged step, eq. (6a); empty where nothing touches. The residual of the `solution` has
/// the force with its weight in the equations ([`Trial::contact_weight`]) and becomes that of the force itself, as supports bear it.
///
/// # Errors
/// An analysis error when the system is singular.
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
    let resisting = Problem { integration: integration.resisting(), ..*problem };
    resolved::<D, K>(&resisting, grid, (&solution.displacement, &solution.pressure), &force)
}

/// Adds what contact that is there does to the motion with which a step begins. The first acceleration is that of all forces; that of a step is
/// without contact.
///
/// # Errors
/// An analysis error when the system is singular.
pub fn begin<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &State<D>,
    (start, given): (&mut Start<D>, &[Option<f64>]),
    dt: f64,
) -> Result<()> {
    let integration = GeneralisedAlpha::new(scene.numerics.spectral_radius, dt);
    let resisting = integration.resisting();
    if state.moving && resisting.is_none() {
        return Ok(());
    }
    let force = held(grid);
    if force.is_empty() {
        return Ok(());
    }
    let problem = Problem::step(scene, state, Some(&*start), given, dt);
    let at_start = Problem { to: problem.from, integration: resisting, ..problem };
    let by_contact = resolved::<D, K>(&at_start, grid, (&state.displacement, &state.pressure), &force)?;
    if resisting.is_some() {
        let more = integration.impulse() - 1.0;
        let mut unresolved = inertia(scene, grid, state, &by_contact)?;
        unresolved.iter_mut().zip(&force).zip(given).for_each(|((inertia, force), given)| {
            *inertia = if given.is_none() { more * (force - *inertia) } else { 0.0 };
        });
        start.unresolved = unresolved;
    }
    if !state.moving {
        let own = start.acceleration.iter_mut().zip(&by_contact);
        own.for_each(|(own, by)| *own = std::array::from_fn(|d| own[d] - by[d]));
    }
    Ok(())
}

/// The acceleration of the nodes (m/s²) by a force (kN, one entry an equation), eq. (6a), `at` a displacement and pressure. The time integration of the
/// problem is that of what resists; without one it is the mass.
fn resolved<const D: usize, K: Kinematics<D>>(
    problem: &Problem<D>,
    grid: &mut Grid<D>,
    at: (&[[f64; D]], &[f64]),
    force: &[f64],
) -> Result<Vec<[f64; D]>> {
    let Some(slope) = problem.integration.as_ref().map(GeneralisedAlpha::slope) else {
        let against: Vec<f64> = force.iter().map(|force| -force).collect();
        return accelerations::<D, K>(problem.scene, grid, problem.state, &against);
    };
    let moved = matrix_without_contact(problem, grid, at).and_then(|()| solve(problem, grid, force.to_vec()))?;
    let mut acceleration = vec![[0.0; D]; problem.scene.displacements()];
    for d in 0..D {
        let of_nodes: Vec<f64> = (0..grid.dofs.node.len()).map(|block| slope * moved[block * D + d]).collect();
        grid.dofs.write(&of_nodes, d, &mut acceleration);
    }
    Ok(acceleration)
}

/// Makes the matrix of the grid that of a step at a displacement and pressure, without what contact resists.
fn matrix_without_contact<const D: usize>(
    problem: &Problem<D>,
    grid: &mut Grid<D>,
    (displacement, pressure): (&[[f64; D]], &[f64]),
) -> Result<()> {
    let mut buffers = std::mem::take(&mut grid.buffers);
    let mut now = std::mem::take(&mut buffers.now);
    now.at.set(displacement, pressure);
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
