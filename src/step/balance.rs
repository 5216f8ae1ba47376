//! The residual of a step, `R(u)` of docs/theory.md, eq. 1 (with inertia eq. 6): the sum of the terms of the scene, and its tangent, at a
//! trial state.

use super::grid::Grid;
use super::problem::Problem;
use super::scene::Scene;
use super::state::State;
use super::unknowns::{Buffers, Evaluation};
use crate::error::Result;
use crate::profile::{Activity, timed};
use crate::term::{Assembly, Role, Source, Trial, Works};
use crate::time_integration::GeneralisedAlpha;

/// The sum of all terms but inertia at the last converged step, and the norm of the largest of them.
///
/// # Errors
/// When the converged state is inadmissible on the restored grid.
pub fn static_force<const D: usize>(problem: &Problem<D>, grid: &mut Grid<D>) -> Result<Evaluation<D>> {
    let (mut own, mut sum) = (Vec::new(), Evaluation::default());
    timed(Activity::Assembly, || {
        add_terms(problem, grid, &at_start(problem), false, &|role| role != Role::Inertia, (&mut own, &[]), &mut sum)
    })?;
    if problem.state.ramp.is_kept() {
        let held = grid.dofs.on_blocks(&problem.state.ramp.force);
        sum.force.iter_mut().zip(held.iter().flatten()).for_each(|(f, held)| *f += held);
    }
    Ok(sum)
}

/// The converged state with the loads of the beginning of the step.
fn at_start<'a, const D: usize>(problem: &Problem<'a, D>) -> Trial<'a, D> {
    Trial {
        pressure: &problem.state.pressure,
        converged_pressure: &problem.state.pressure,
        phase: problem.phase,
        time: problem.from,
        reduction: problem.scene.phases[problem.phase].reduction_at(problem.from),
        inverse_dt: problem.span().rate(),
        geometry: problem.state.geometry(),
        ..Trial::at_rest(problem.converged(), problem.converged())
    }
}

/// The work of the loads of the beginning of a step along `way` (m), one entry an equation.
///
/// # Errors
/// As [`static_force`].
pub fn works_at_start<const D: usize>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &State<D>,
    way: &[f64],
) -> Result<Works> {
    let problem = Problem::at_rest(scene, state);
    let (mut own, mut sum) = (Vec::new(), Evaluation::default());
    add_terms(
        &problem,
        grid,
        &at_start(&problem),
        false,
        &|role| matches!(role, Role::External | Role::Restoring),
        (&mut own, way),
        &mut sum,
    )?;
    Ok(sum.work)
}

/// The kinetic energy (kJ) of a velocity (m/s) of the nodes, by the mass of the equations of motion.
///
/// # Errors
/// None that a converged state has.
pub fn kinetic<const D: usize>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &State<D>,
    velocity: &[[f64; D]],
) -> Result<f64> {
    let problem = Problem::at_rest(scene, state);
    let (mut own, mut way, mut sum) = (Vec::new(), Vec::new(), Evaluation::default());
    by_equation(grid, |n| velocity[n as usize], &mut way);
    let trial = Trial { acceleration: velocity, ..at_start(&problem) };
    add_terms(&problem, grid, &trial, false, &|role| role == Role::Inertia, (&mut own, &way), &mut sum)?;
    Ok(0.5 * sum.work.of(Source::Inertia))
}

/// The force (kN, one entry an equation) of inertia against an acceleration (m/s²) of the nodes, by the mass of the equations of motion.
///
/// # Errors
/// None that a converged state has.
pub fn inertia<const D: usize>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &State<D>,
    acceleration: &[[f64; D]],
) -> Result<Vec<f64>> {
    let problem = Problem::at_rest(scene, state);
    let (mut own, mut sum) = (Vec::new(), Evaluation::default());
    let trial = Trial { acceleration, ..at_start(&problem) };
    add_terms(&problem, grid, &trial, false, &|role| role == Role::Inertia, (&mut own, &[]), &mut sum)?;
    Ok(sum.force)
}

/// A field of displacements or velocities, one entry an equation of these.
pub fn by_equation<const D: usize>(grid: &Grid<D>, value: impl Fn(u32) -> [f64; D], out: &mut Vec<f64>) {
    out.clear();
    out.extend(grid.dofs.node.iter().flat_map(|&n| grid.dofs.value(n, &value)));
}

/// The residual of a state at the end of the step and, where wanted, the tangent in the matrix of the grid.
///
/// # Errors
/// Analysis, where the state is inadmissible: an inverted material point, a return map without a root.
pub fn evaluate<const D: usize>(
    problem: &Problem<D>,
    grid: &mut Grid<D>,
    buffers: &mut Buffers<D>,
    state: &mut Evaluation<D>,
    tangent: bool,
) -> Result<()> {
    let at = std::mem::take(&mut state.at);
    let Buffers { own, way, between, acceleration, ahead, frozen, stiffening, .. } = buffers;
    let (u, before) = (&at.displacement, problem.converged());
    by_equation(grid, |n| std::array::from_fn(|d| u[n as usize][d] - before[n as usize][d]), way);
    if let Some(integration) = &problem.integration {
        blend(u, problem.converged(), integration.alpha_f, between);
        weighted_acceleration(problem, integration, u, acceleration);
        go_ahead(integration, (u, problem.converged()), (problem.velocity, problem.acceleration), ahead);
    }
    let dynamic = problem.integration.is_some();
    let alpha_f = problem.integration.map_or(0.0, |i| i.alpha_f);
    let trial = Trial {
        displacement: u,
        between: if dynamic { between } else { u },
        alpha_f,
        converged: problem.converged(),
        geometry: problem.state.geometry(),
        pressure: &at.pressure,
        converged_pressure: &problem.state.pressure,
        flow_time: problem.flow_time,
        acceleration,
        acceleration_slope: problem.integration.map_or(0.0, |i| i.slope()),
        contact_weight: problem.integration.map_or(1.0, |i| i.impulse()),
        ahead: if dynamic { ahead } else { &[] },
        ahead_slope: problem.integration.map_or(0.0, |i| 0.5 * i.gamma / i.beta),
        phase: problem.phase,
        time: (1.0 - alpha_f) * problem.to + alpha_f * problem.from,
        reduction: problem.scene.phases[problem.phase].reduction_at(problem.to),
        frozen: *frozen,
        inverse_dt: problem.span().rate(),
        stiffening: *stiffening,
    };
    let result = timed(Activity::Assembly, || {
        add_terms(problem, grid, &trial, tangent, &|role| dynamic || role != Role::Inertia, (own, way), state)
    });
    state.at = at;
    if !problem.unresolved.is_empty() {
        state.force.iter_mut().zip(problem.unresolved).for_each(|(f, unresolved)| *f += unresolved);
        state.work.add(Source::Inertia, problem.unresolved, way);
    }
    let held = held_back(problem, grid);
    state.force.iter_mut().zip(&held).for_each(|(f, held)| *f += held);
    if dynamic && !held.is_empty() {
        state.work.add(Source::Load, &held, way);
        for (block, _) in grid.dofs.forces() {
            state.applied.iter_mut().zip(&held[D * block..]).for_each(|(applied, f)| *applied -= f);
        }
    }
    result
}

/// The part of the unbalanced force that is still held ([`super::UnbalancedRamp`]; kN, by equation), zero where the displacement is given; empty of none.
fn held_back<const D: usize>(problem: &Problem<D>, grid: &Grid<D>) -> Vec<f64> {
    let ramp = &problem.state.ramp;
    let share = ramp.share(problem.to);
    if share == 0.0 {
        return Vec::new();
    }
    let held = grid.dofs.on_blocks(&ramp.force);
    let force = held.iter().flatten().zip(problem.given);
    force.map(|(held, given)| if given.is_none() { share * held } else { 0.0 }).collect()
}

/// Adds up the terms of the wanted roles, and their work along `way` (m), one entry an equation.
fn add_terms<const D: usize>(
    problem: &Problem<D>,
    grid: &mut Grid<D>,
    trial: &Trial<D>,
    tangent: bool,
    wanted: &dyn Fn(Role) -> bool,
    (own, way): (&mut Vec<f64>, &[f64]),
    sum: &mut Evaluation<D>,
) -> Result<()> {
    let mut workspace = std::mem::take(&mut grid.workspace);
    let mut matrix = std::mem::take(&mut grid.motion.matrix);
    if tangent {
        matrix.clear();
    }
    let scene = problem.scene;
    let (equations, of_nodes) = (grid.motion.pattern.len(), grid.dofs.displacements());
    sum.force.clear();
    sum.force.resize(equations, 0.0);
    (sum.applied, sum.scale, sum.work) = ([0.0; D], 0.0, Works::default());
    own.resize(equations, 0.0);
    let soil = grid.frame(&scene.mesh, problem.state);
    let elements = grid.elements.as_ref().map(|elements| grid.frame_of_elements(scene, elements, problem.state));
    let of_elements = scene.fem.iter().flat_map(|fem| &fem.terms).zip(elements.iter().cycle());
    let terms = scene.terms.iter().map(|term| (term, &soil)).chain(of_elements);
    let mut result = Ok(());
    for (term, frame) in terms.filter(|(term, _)| wanted(term.role())) {
        own.fill(0.0);
        // Loads on a geometry that is held do not change with the trial state.
        let held = trial.geometry.filter(|_| term.role() == Role::External);
        let tangent = (tangent && held.is_none()).then_some(&mut matrix);
        let mut out = Assembly { force: own, tangent, workspace: &mut workspace };
        let at = held.map_or(*trial, |geometry| Trial { displacement: geometry, between: geometry, ..*trial });
        result = term.assemble(frame, &at, &mut out);
        if result.is_err() {
            break;
        }
        sum.scale = sum.scale.max(norm(&own[..of_nodes]));
        sum.work.add(term.source(), own, way);
        for (f, o) in sum.force.iter_mut().zip(own.iter()) {
            *f += o;
        }
        if matches!(term.role(), Role::External | Role::Restoring) {
            for (block, _) in grid.dofs.forces() {
                for (applied, f) in sum.applied.iter_mut().zip(&own[D * block..]) {
                    *applied -= f;
                }
            }
        }
    }
    grid.workspace = workspace;
    grid.motion.matrix = matrix;
    result
}

/// `(1 − α) u + α u_n`: the positions at which the stress acts (docs/theory.md, eq. 7).
fn blend<const D: usize>(u: &[[f64; D]], converged: &[[f64; D]], alpha: f64, out: &mut Vec<[f64; D]>) {
    let one = |(u, c): (&[f64; D], &[f64; D])| std::array::from_fn(|d| (1.0 - alpha) * u[d] + alpha * c[d]);
    out.clear();
    out.extend(u.iter().zip(converged).map(one));
}

fn weighted_acceleration<const D: usize>(
    problem: &Problem<D>,
    integration: &GeneralisedAlpha,
    u: &[[f64; D]],
    out: &mut Vec<[f64; D]>,
) {
    let at = |n: usize| {
        std::array::from_fn(|d| {
            let (v, a) = (problem.velocity[n][d], problem.acceleration[n][d]);
            integration.weighted(a, integration.acceleration(u[n][d] - problem.converged()[n][d], v, a))
        })
    };
    out.clear();
    out.extend((0..u.len()).map(at));
    for (&(n, d), end) in problem.driven.into_iter().flatten() {
        let n = n as usize;
        out[n][d] = integration.weighted(problem.acceleration[n][d], end.acceleration);
    }
}

/// The displacement (m) of the nodes in half a step after this one, `½ Δt v`, with the velocity (eq. 5) at its end: for contact between
/// bodies with inertia (docs/theory.md, section 13, *Two bodies*). `u` and `from` are the displacements (m) at its end and start.
pub fn go_ahead<const D: usize>(
    integration: &GeneralisedAlpha,
    (u, from): (&[[f64; D]], &[[f64; D]]),
    (velocity, acceleration): (&[[f64; D]], &[[f64; D]]),
    out: &mut Vec<[f64; D]>,
) {
    let at = |n: usize| {
        std::array::from_fn(|d| {
            let (v, a) = (velocity[n][d], acceleration[n][d]);
            0.5 * integration.dt * integration.velocity(v, a, integration.acceleration(u[n][d] - from[n][d], v, a))
        })
    };
    out.clear();
    out.extend((0..u.len()).map(at));
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}
