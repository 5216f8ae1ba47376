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
const BACKTRACKS: i32 = 6;
/// Line searches that may end without a decrease before the step is given up.
const STALLED: usize = 4;
/// Full steps that may raise the residual before the iteration returns to its best state.
const WATCH: usize = 3;
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
    let mut newton = Newton::begin(problem, grid)?;
    while !newton.converged() {
        let delta = newton.direction()?;
        newton.search(&delta)?;
    }
    Ok(newton.solution())
}

/// The iteration.
struct Newton<'a, const D: usize> {
    problem: &'a Problem<'a, D>,
    grid: &'a mut Grid<D>,
    /// Equations whose displacement is given.
    fixed: Vec<bool>,
    /// The part of the residual from the beginning of the step, and what is applied in it.
    before: Vec<f64>,
    applied_before: [f64; D],
    u: Vec<[f64; D]>,
    now: Evaluation<D>,
    /// What residuals are measured against [kN].
    scale: f64,
    /// Relative residuals so far; the last is that of `u`, or of the system solved next where displacements
    /// that are still to be given add to it.
    history: Vec<f64>,
    method: Method,
    /// The best state so far, the residual to beat, and how many iterations have not.
    best: Vec<[f64; D]>,
    target: f64,
    relaxed: usize,
    /// Whether every iteration must lessen the residual: set when full steps have failed to.
    strict: bool,
    stalled: usize,
}

impl<'a, const D: usize> Newton<'a, D> {
    fn begin(problem: &'a Problem<'a, D>, grid: &'a mut Grid<D>) -> Result<Self> {
        let (before, applied_before) = force_before(problem, grid)?;
        let u = problem.converged.to_vec();
        let now = evaluate(problem, grid, &u, &before)?;
        let scale = now.scale.max(floor(problem.scene, before.len()));
        let mut newton = Self {
            fixed: problem.given.iter().map(Option::is_some).collect(),
            history: Vec::new(),
            method: Method::Cholesky,
            best: u.clone(),
            target: f64::INFINITY,
            relaxed: 0,
            strict: false,
            stalled: 0,
            problem,
            grid,
            before,
            applied_before,
            u,
            now,
            scale,
        };
        let first = newton.size(&newton.now);
        newton.history.push(first);
        Ok(newton)
    }

    /// The relative residual.
    fn size(&self, evaluation: &Evaluation<D>) -> f64 {
        norm_free(&evaluation.force, &self.fixed) / self.scale
    }

    fn error(&self) -> f64 {
        self.history.last().copied().unwrap_or(f64::NAN)
    }

    fn converged(&self) -> bool {
        let closed = gaps(self.problem, self.grid, &self.u).iter().all(|g| *g == 0.0);
        let tolerance = if self.history.len() > 1 { self.problem.scene.numerics.tolerance } else { ROUNDING };
        closed && self.error() <= tolerance
    }

    fn solution(self) -> Solution<D> {
        Solution {
            displacement: self.u,
            residual: self.now.force,
            history: self.history,
            applied: std::array::from_fn(|d| self.now.applied[d] + self.applied_before[d]),
            method: self.method,
        }
    }

    /// `K δ = −R` with δ given where the displacement is.
    fn direction(&mut self) -> Result<Vec<f64>> {
        if self.history.len() > self.problem.scene.numerics.max_iterations {
            return Err(self.failure("too many iterations"));
        }
        let gap = gaps(self.problem, self.grid, &self.u);
        let mut delta: Vec<f64> = self.now.force.iter().map(|r| -r).collect();
        let motion = &mut self.grid.motion;
        let diagonal = motion.matrix.scale(&motion.pattern);
        motion.matrix.constrain(&motion.pattern, &self.fixed, &gap, diagonal, &mut delta);
        if self.target.is_infinite() {
            // Displacements still to be given unbalance the system beyond the residual at hand.
            self.target = norm_free(&delta, &self.fixed) / self.scale;
        }
        self.method = motion.solver.solve(&motion.pattern, &motion.matrix, &mut delta)?;
        Ok(delta)
    }

    /// Goes along `delta`. A full step is taken even if the residual grows, for a few iterations on trial:
    /// bending structures converge so, and only so. If that does not pay, the iteration returns to its best
    /// state and from then on backtracks until the residual falls (a watchdog, Chamberlain et al. 1982).
    fn search(&mut self, delta: &[f64]) -> Result<()> {
        let full = self.attempt(delta, 1.0);
        if let Some((u, now, size)) = full {
            if self.better(size, 1.0) {
                self.accept(u, now, size);
                return Ok(());
            }
            if !self.strict && self.relaxed < WATCH {
                self.relaxed += 1;
                (self.u, self.now) = (u, now);
                self.history.push(size);
                return Ok(());
            }
        }
        if !self.strict && self.relaxed > 0 {
            self.strict = true;
            let best = self.best.clone();
            let now = evaluate(self.problem, self.grid, &best, &self.before)?;
            let size = self.size(&now);
            (self.u, self.now) = (best, now);
            self.history.push(size);
            return Ok(());
        }
        self.backtrack(delta)
    }

    /// Halves the step length until the residual falls; takes the least one a few times where it never does.
    fn backtrack(&mut self, delta: &[f64]) -> Result<()> {
        let mut least: Option<(f64, f64)> = None;
        for halvings in 1..=BACKTRACKS {
            let length = 0.5f64.powi(halvings);
            if let Some((u, now, size)) = self.attempt(delta, length) {
                if self.better(size, length) {
                    self.stalled = 0;
                    self.accept(u, now, size);
                    return Ok(());
                }
                if least.is_none_or(|(other, _)| size < other) {
                    least = Some((size, length));
                }
            }
        }
        let Some((_, length)) = least else {
            return Err(self.failure("every trial state turns a material point inside out"));
        };
        self.stalled += 1;
        match self.attempt(delta, length) {
            Some((u, now, size)) if self.stalled <= STALLED => {
                self.accept(u, now, size);
                Ok(())
            }
            _ => Err(self.failure("the line search finds no smaller residual")),
        }
    }

    /// The state at a step length, if it is admissible.
    fn attempt(&mut self, delta: &[f64], length: f64) -> Option<(Vec<[f64; D]>, Evaluation<D>, f64)> {
        let u = moved(self.problem, self.grid, &self.u, delta, length);
        let now = evaluate(self.problem, self.grid, &u, &self.before).ok()?;
        self.scale = self.scale.max(now.scale);
        let size = self.size(&now);
        size.is_finite().then_some((u, now, size))
    }

    fn better(&self, size: f64, length: f64) -> bool {
        size <= (1.0 - ARMIJO * length) * self.target || size <= self.problem.scene.numerics.tolerance
    }

    fn accept(&mut self, u: Vec<[f64; D]>, now: Evaluation<D>, size: f64) {
        self.best.clone_from(&u);
        (self.u, self.now) = (u, now);
        (self.target, self.relaxed) = (size, 0);
        self.history.push(size);
    }

    fn failure(&self, why: &str) -> Error {
        Error::analysis(
            "Newton",
            format!("{why} (residual {:.1e} after {} iterations)", self.error(), self.history.len() - 1),
            "take smaller steps (step.min) or refine the mesh",
        )
    }
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
    let sum = sum_terms(problem, grid, &trial, Some(&mut matrix), |role| dynamic || role != Role::Inertia);
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
