//! Newton's method for one step, with a backtracking line search.

use super::grid::Grid;
use super::scene::Scene;
use crate::error::{Error, Result};
use crate::points::Points;
use crate::profile::{Activity, timed};
use crate::system::{Matrix, Method};
use crate::term::{Assembly, Role, Trial};
use crate::time_integration::GeneralisedAlpha;

/// Sufficient decrease of the residual for a step length `s`: by a factor `1 − ARMIJO · s`.
const ARMIJO: f64 = 1e-4;
/// Halvings of the step length before the best one is taken.
const BACKTRACKS: usize = 6;
/// Iterations that may end without a decrease before the step is given up.
const STALLED: usize = 4;
/// A residual this small relative to the forces that balance is rounding.
const ROUNDING: f64 = 1e-14;

/// What is to be solved.
pub struct Problem<'a, const D: usize> {
    pub scene: &'a Scene<D>,
    pub points: &'a Points<D>,
    /// State of the nodes at the last converged step.
    pub converged: &'a [[f64; D]],
    pub velocity: &'a [[f64; D]],
    pub acceleration: &'a [[f64; D]],
    pub phase: usize,
    /// Time [s] in the phase at the beginning and the end of the step.
    pub from: f64,
    pub to: f64,
    /// Increment [m] of the displacements that are given, `None` where free. One entry an equation.
    pub given: &'a [Option<f64>],
    /// Present in dynamic analysis.
    pub integration: Option<GeneralisedAlpha>,
}

/// A converged step.
pub struct Solution<const D: usize> {
    /// Displacement of the nodes [m] since the last restoration.
    pub displacement: Vec<[f64; D]>,
    /// Residual [kN], one entry an equation: zero where free, the force of the support where given.
    pub residual: Vec<f64>,
    /// Relative residuals, the first before the first iteration.
    pub history: Vec<f64>,
    /// Resultant [kN] of the applied forces, weighted in time as the step does.
    pub applied: [f64; D],
    pub method: Method,
}

/// The residual at a trial state.
struct Evaluation<const D: usize> {
    force: Vec<f64>,
    applied: [f64; D],
    /// Norm of the largest term: what the residual is measured against.
    scale: f64,
}

/// Solves a step.
///
/// # Errors
/// An analysis error that says why when the iteration does not converge: the caller takes a smaller step.
pub fn solve<const D: usize>(problem: &Problem<D>, grid: &mut Grid<D>) -> Result<Solution<D>> {
    let numerics = &problem.scene.numerics;
    let equations = grid.motion.pattern.len();
    let fixed: Vec<bool> = problem.given.iter().map(Option::is_some).collect();
    let (before, applied_before) = force_before(problem, grid)?;
    let mut u = problem.converged.to_vec();
    let mut now = evaluate(problem, grid, &u, &before, true)?;
    let mut scale = now.scale.max(floor(problem.scene, equations));
    let mut history = vec![norm_free(&now.force, &fixed) / scale];
    let mut method = Method::Cholesky;
    let mut stalled = 0;
    for iteration in 0..=numerics.max_iterations {
        let gap: Vec<f64> = gaps(problem, grid, &u);
        let error = norm_free(&now.force, &fixed) / scale;
        let closed = gap.iter().all(|g| *g == 0.0);
        if closed && (error <= ROUNDING || (iteration > 0 && error <= numerics.tolerance)) {
            let applied = std::array::from_fn(|d| now.applied[d] + applied_before[d]);
            return Ok(Solution { displacement: u, residual: now.force, history, applied, method });
        }
        if iteration == numerics.max_iterations {
            break;
        }
        // K δ = −R with δ given where the displacement is.
        let mut delta: Vec<f64> = now.force.iter().map(|r| -r).collect();
        let motion = &mut grid.motion;
        let diagonal = motion.matrix.scale(&motion.pattern);
        motion.matrix.constrain(&motion.pattern, &fixed, &gap, diagonal, &mut delta);
        let wanted = norm_free(&delta, &fixed) / scale;
        method = motion.solver.solve(&motion.pattern, &motion.matrix, &mut delta)?;

        let mut length = 1.0;
        let mut best: Option<(f64, f64)> = None;
        let mut accepted = None;
        for _ in 0..=BACKTRACKS {
            let trial = moved(problem, grid, &u, &delta, length);
            if let Ok(next) = evaluate(problem, grid, &trial, &before, true) {
                scale = scale.max(next.scale);
                let size = norm_free(&next.force, &fixed) / scale;
                if size.is_finite() {
                    if size <= (1.0 - ARMIJO * length) * wanted || size <= numerics.tolerance {
                        accepted = Some((trial, next, size));
                        break;
                    }
                    if best.is_none_or(|(b, _)| size < b) {
                        best = Some((size, length));
                    }
                }
            }
            length *= 0.5;
        }
        let (trial, next, size) = match (accepted, best) {
            (Some(accepted), _) => {
                stalled = 0;
                accepted
            }
            (None, Some((size, length))) if stalled < STALLED => {
                // No decrease along the whole direction: take the least and hope for a better tangent.
                stalled += 1;
                let trial = moved(problem, grid, &u, &delta, length);
                let next = evaluate(problem, grid, &trial, &before, true)?;
                (trial, next, size)
            }
            (None, best) => {
                let why = match best {
                    None => "every trial state turns a material point inside out",
                    Some(_) => "the line search finds no smaller residual",
                };
                return Err(not_converged(&history, why));
            }
        };
        u = trial;
        now = next;
        history.push(size);
    }
    Err(not_converged(&history, "too many iterations"))
}

fn not_converged(history: &[f64], why: &str) -> Error {
    let last = history.last().copied().unwrap_or(f64::NAN);
    Error::analysis(
        "Newton",
        format!("{why} (residual {last:.1e} after {} iterations)", history.len() - 1),
        "take smaller steps (step.min) or refine the mesh",
    )
}

/// A force [kN] below which nothing counts: rounding in stresses of the order of the stiffness.
fn floor<const D: usize>(scene: &Scene<D>, equations: usize) -> f64 {
    1e-6 * scene.stiffness_scale * scene.cell_face() * (equations as f64).sqrt()
}

/// `α_f F_n` of the generalised-α method, zero in quasi-static analysis, and the resultant of what is applied.
fn force_before<const D: usize>(problem: &Problem<D>, grid: &mut Grid<D>) -> Result<(Vec<f64>, [f64; D])> {
    match problem.integration {
        Some(integration) => static_force(problem, grid, integration.alpha_f),
        None => Ok((vec![0.0; grid.motion.pattern.len()], [0.0; D])),
    }
}

/// The sum of all terms but inertia at the last converged step, times `weight`, and the resultant of what is
/// applied.
///
/// # Errors
/// When the converged state is inadmissible on the restored grid.
pub fn static_force<const D: usize>(
    problem: &Problem<D>,
    grid: &mut Grid<D>,
    weight: f64,
) -> Result<(Vec<f64>, [f64; D])> {
    let trial = Trial {
        displacement: problem.converged,
        converged: problem.converged,
        acceleration: &[],
        acceleration_slope: 0.0,
        phase: problem.phase,
        time: problem.from,
        weight,
    };
    let evaluation = sum_terms(problem, grid, &trial, None, |role| role != Role::Inertia)?;
    Ok((evaluation.force, evaluation.applied))
}

/// The residual, and with it the tangent in the matrix of the grid.
fn evaluate<const D: usize>(
    problem: &Problem<D>,
    grid: &mut Grid<D>,
    u: &[[f64; D]],
    before: &[f64],
    tangent: bool,
) -> Result<Evaluation<D>> {
    let acceleration = match problem.integration {
        Some(integration) => weighted_acceleration(problem, &integration, u),
        None => Vec::new(),
    };
    let trial = Trial {
        displacement: u,
        converged: problem.converged,
        acceleration: &acceleration,
        acceleration_slope: problem.integration.map_or(0.0, |i| i.slope()),
        phase: problem.phase,
        time: problem.to,
        weight: problem.integration.map_or(1.0, |i| 1.0 - i.alpha_f),
    };
    let dynamic = problem.integration.is_some();
    let mut matrix = std::mem::take(&mut grid.motion.matrix);
    matrix.clear();
    let tangent = tangent.then_some(&mut matrix);
    let sum = sum_terms(problem, grid, &trial, tangent, |role| dynamic || role != Role::Inertia);
    grid.motion.matrix = matrix;
    let mut evaluation = sum?;
    evaluation.scale = evaluation.scale.max(norm(before));
    for (f, b) in evaluation.force.iter_mut().zip(before) {
        *f += b;
    }
    Ok(evaluation)
}

/// Adds up the terms of the wanted roles.
fn sum_terms<const D: usize>(
    problem: &Problem<D>,
    grid: &mut Grid<D>,
    trial: &Trial<D>,
    mut tangent: Option<&mut Matrix>,
    wanted: impl Fn(Role) -> bool,
) -> Result<Evaluation<D>> {
    timed(Activity::Assembly, || add_terms(problem, grid, trial, &mut tangent, &wanted))
}

fn add_terms<const D: usize>(
    problem: &Problem<D>,
    grid: &mut Grid<D>,
    trial: &Trial<D>,
    tangent: &mut Option<&mut Matrix>,
    wanted: &dyn Fn(Role) -> bool,
) -> Result<Evaluation<D>> {
    let mut workspace = std::mem::take(&mut grid.workspace);
    let frame = grid.frame(&problem.scene.mesh, problem.points);
    let equations = frame.pattern.len();
    let mut sum = Evaluation { force: vec![0.0; equations], applied: [0.0; D], scale: 0.0 };
    let mut own = vec![0.0; equations];
    let mut result = Ok(());
    for term in problem.scene.terms.iter().filter(|t| wanted(t.role())) {
        own.fill(0.0);
        let mut out = Assembly { force: &mut own, tangent: tangent.as_deref_mut(), workspace: &mut workspace };
        result = term.assemble(&frame, trial, &mut out);
        if result.is_err() {
            break;
        }
        sum.scale = sum.scale.max(norm(&own));
        for (e, (f, o)) in sum.force.iter_mut().zip(&own).enumerate() {
            *f += o;
            if term.role() == Role::External {
                sum.applied[e % D] -= o;
            }
        }
    }
    grid.workspace = workspace;
    result.map(|()| sum)
}

fn weighted_acceleration<const D: usize>(
    problem: &Problem<D>,
    integration: &GeneralisedAlpha,
    u: &[[f64; D]],
) -> Vec<[f64; D]> {
    let at = |n: usize| {
        std::array::from_fn(|d| {
            let (v, a) = (problem.velocity[n][d], problem.acceleration[n][d]);
            integration.weighted(a, integration.acceleration(u[n][d] - problem.converged[n][d], v, a))
        })
    };
    (0..u.len()).map(at).collect()
}

/// What is missing to the given displacements, one entry an equation.
fn gaps<const D: usize>(problem: &Problem<D>, grid: &Grid<D>, u: &[[f64; D]]) -> Vec<f64> {
    let gap = |(e, given): (usize, &Option<f64>)| {
        given.map_or(0.0, |increment| {
            let (n, d) = (grid.node[e / D] as usize, e % D);
            problem.converged[n][d] + increment - u[n][d]
        })
    };
    problem.given.iter().enumerate().map(gap).collect()
}

/// `u + length · δ`; a full step lands on the given displacements to the last bit.
fn moved<const D: usize>(
    problem: &Problem<D>,
    grid: &Grid<D>,
    u: &[[f64; D]],
    delta: &[f64],
    length: f64,
) -> Vec<[f64; D]> {
    let mut moved = u.to_vec();
    for (e, delta) in delta.iter().enumerate() {
        let (n, d) = (grid.node[e / D] as usize, e % D);
        match problem.given[e] {
            Some(increment) if length == 1.0 => moved[n][d] = problem.converged[n][d] + increment,
            _ => moved[n][d] += length * delta,
        }
    }
    moved
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn norm_free(x: &[f64], fixed: &[bool]) -> f64 {
    x.iter().zip(fixed).map(|(x, fixed)| if *fixed { 0.0 } else { x * x }).sum::<f64>().sqrt()
}
