//! The unbalanced force at the start of a phase, and on a reset grid (docs/theory.md, section 14): it is ramped down ([`UnbalancedRamp`]) where
//! the first step fails.

use super::balance::static_force;
use super::grid::Grid;
use super::problem::Problem;
use super::ramp::{KEPT, UnbalancedRamp};
use super::report::Motion;
use super::scene::{Fixed, Scene};
use super::state::State;
use crate::error::Result;

/// Begins to ramp the unbalanced force, if there is one, after a step of the size `dt` (s) that failed, the first of a phase or on a grid just reset.
///
/// # Errors
/// When the state is inadmissible on the restored grid.
pub fn hold<const D: usize>(scene: &Scene<D>, grid: &mut Grid<D>, state: &mut State<D>, dt: f64) -> Result<()> {
    let phase = &scene.phases[state.phase];
    let looks_for_failure = phase.auto || phase.search.is_some();
    let begins = state.phase_time == 0.0;
    let deformed = state.displacement.iter().flatten().any(|u| *u != 0.0);
    if looks_for_failure || state.dynamic(scene) || (deformed && !begins) || !state.ramp.force.is_empty() {
        return Ok(());
    }
    // What a step may leave is none of the loads that a ramp is for.
    let numerics = &scene.numerics;
    let ignored = if scene.follows(state.phase) {
        numerics.tolerance.max(numerics.acceptable_tolerance)
    } else {
        numerics.tolerance
    };
    let from = state.phase_time;
    // The loads of a phase come with its first step.
    let loaded = if begins { dt } else { from };
    if let Some(force) = to_hold(scene, grid, state, (loaded, ignored))? {
        state.ramp = UnbalancedRamp { force, from, until: from + dt };
    }
    Ok(())
}

/// Holds what removed soil bore and the weight of placed soil, and takes that off evenly until the end of the phase: without inertia, and where the
/// phase is not to find out by itself whether there is an equilibrium.
///
/// # Errors
/// When the state is inadmissible on the reset grid.
pub fn hold_over_phase<const D: usize>(scene: &Scene<D>, grid: &mut Grid<D>, state: &mut State<D>) -> Result<()> {
    let phase = &scene.phases[state.phase];
    if phase.dynamic || phase.auto || phase.search.is_some() {
        return Ok(());
    }
    if let Some(force) = to_hold(scene, grid, state, (0.0, scene.numerics.tolerance))? {
        state.ramp = UnbalancedRamp { force, from: 0.0, until: phase.duration };
    }
    Ok(())
}

/// Keeps what has held the boundaries that waves leave through, as the first phase with inertia begins.
///
/// # Errors
/// When the state is inadmissible.
pub fn keep_reactions<const D: usize>(scene: &Scene<D>, grid: &mut Grid<D>, state: &mut State<D>) -> Result<()> {
    let Some(all) = to_hold(scene, grid, state, (0.0, 0.0))? else { return Ok(()) };
    let mut force = vec![[0.0; D]; all.len()];
    for Fixed { nodes, component } in &scene.absorbing {
        nodes.iter().for_each(|&n| force[n as usize][*component] = all[n as usize][*component]);
    }
    state.ramp = UnbalancedRamp { force, from: 0.0, until: KEPT };
    Ok(())
}

/// The forces `−R₀` (kN) that balance the state under the loads at the time `to` (s) of the phase, by node; `None` where they are the part `ignored` (-) of
/// the largest force at most.
///
/// # Errors
/// When the state is inadmissible on the restored grid.
pub fn to_hold<const D: usize>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &State<D>,
    (to, ignored): (f64, f64),
) -> Result<Option<Vec<[f64; D]>>> {
    let Unbalanced { force, scale } = unbalanced(&Problem { to, ..Problem::at_rest(scene, state) }, grid)?;
    if norm(&force) <= ignored * scale {
        return Ok(None);
    }
    let force = grid.dofs.on_nodes(&force);
    Ok(Some(force.into_iter().map(|f| f.map(|f| -f)).collect()))
}

/// The unbalanced force of a state without inertia.
struct Unbalanced<const D: usize> {
    /// By block (kN), zero where the displacement is given.
    force: Vec<[f64; D]>,
    /// Norm of the largest term (kN).
    scale: f64,
}

/// The unbalanced force `R₀` of the last converged state, under the loads at the start of `problem`.
fn unbalanced<const D: usize>(problem: &Problem<D>, grid: &mut Grid<D>) -> Result<Unbalanced<D>> {
    let now = static_force(problem, grid)?;
    let by_block = now.force.chunks_exact(D).take(grid.dofs.node.len());
    let mut force: Vec<[f64; D]> = by_block.map(|f| std::array::from_fn(|d| f[d])).collect();
    for fixed in problem.scene.fixed(problem.phase) {
        for equation in fixed.nodes.iter().filter_map(|&n| grid.dofs.displacement(n, fixed.component)) {
            force[equation / D][fixed.component] = 0.0;
        }
    }
    Ok(Unbalanced { force, scale: now.scale })
}

fn norm<const D: usize>(force: &[[f64; D]]) -> f64 {
    force.iter().flatten().map(|f| f * f).sum::<f64>().sqrt()
}

/// Whether a dynamic phase begins at rest and stays so: nothing moves, no displacement is prescribed, no water flows, and under the loads of
/// every time of the phase the unbalanced force is no more than the fraction `part` (-) of the largest force.
///
/// # Errors
/// When the state is inadmissible.
pub fn stays_at_rest<const D: usize>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &State<D>,
    [part, kinetic]: [f64; 2],
) -> Result<bool> {
    let phase = &scene.phases[state.phase];
    if phase.flows || phase.moves() || phase.by_formula || Motion::of(state).kinetic > kinetic {
        return Ok(false);
    }
    let now = state.phase_time;
    let to_come = phase.times().filter(|time| *time > now);
    for time in std::iter::once(now).chain(to_come) {
        let problem = Problem { from: time, to: time, ..Problem::at_rest(scene, state) };
        let Unbalanced { force, scale } = unbalanced(&problem, grid)?;
        if norm(&force) > part * scale {
            return Ok(false);
        }
    }
    Ok(true)
}
