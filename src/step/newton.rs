//! Newton's method for one step, with a backtracking line search.

use super::grid::Grid;
use super::scene::Scene;
use crate::error::{Error, Result};
use crate::points::Points;
use crate::profile::{Activity, timed};
use crate::quadrature::Weighing;
use crate::stencil::cell_size;
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
    pub weighing: &'a Weighing<D>,
    /// State of the nodes at the last converged step.
    pub converged: &'a [[f64; D]],
    pub velocity: &'a [[f64; D]],
    pub acceleration: &'a [[f64; D]],
    pub phase: usize,
    /// Time (s) in the phase at the beginning and the end of the step.
    pub from: f64,
    pub to: f64,
    /// Increment (m) of the displacements that are given, `None` where free. One entry an equation.
    pub given: &'a [Option<f64>],
    /// Present in dynamic analysis.
    pub integration: Option<GeneralisedAlpha>,
}

/// A converged step.
pub struct Solution<const D: usize> {
    /// Displacement of the nodes (m) since the last restoration.
    pub displacement: Vec<[f64; D]>,
    /// Residual (kN), one entry an equation: zero where free, the force of the support where given.
    pub residual: Vec<f64>,
    /// Relative residuals, the first before the first iteration.
    pub history: Vec<f64>,
    /// Resultant (kN) of the applied forces, weighted in time as the step does.
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
    u: Vec<[f64; D]>,
    now: Evaluation<D>,
    /// A force (kN) below which nothing counts.
    floor: f64,
    /// Relative residuals so far; the last is that of `u`.
    history: Vec<f64>,
    method: Method,
    /// The best state so far, the residual (kN) to beat, and how many iterations have not.
    best: Vec<[f64; D]>,
    target: f64,
    relaxed: usize,
    /// Whether every iteration must lessen the residual: set when full steps have failed to.
    strict: bool,
    stalled: usize,
}

impl<'a, const D: usize> Newton<'a, D> {
    fn begin(problem: &'a Problem<'a, D>, grid: &'a mut Grid<D>) -> Result<Self> {
        let u = problem.converged.to_vec();
        let now = evaluate(problem, grid, &u)?;
        let floor = floor(problem, grid);
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
            u,
            now,
            floor,
        };
        newton.note();
        Ok(newton)
    }

    /// The residual (kN).
    fn size(&self, evaluation: &Evaluation<D>) -> f64 {
        norm_free(&evaluation.force, &self.fixed)
    }

    /// Notes the residual of the state at hand, relative to the largest of the terms that balance in it.
    fn note(&mut self) {
        self.history.push(self.size(&self.now) / self.now.scale.max(self.floor));
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
            applied: self.now.applied,
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
            self.target = norm_free(&delta, &self.fixed);
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
                self.accept(u, now);
                return Ok(());
            }
            if !self.strict && self.relaxed < WATCH {
                self.relaxed += 1;
                (self.u, self.now) = (u, now);
                self.note();
                return Ok(());
            }
        }
        if !self.strict && self.relaxed > 0 {
            self.strict = true;
            let best = self.best.clone();
            self.now = evaluate(self.problem, self.grid, &best)?;
            self.u = best;
            self.note();
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
                    self.accept(u, now);
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
            Some((u, now, _)) if self.stalled <= STALLED => {
                self.accept(u, now);
                Ok(())
            }
            _ => Err(self.failure("the line search finds no smaller residual")),
        }
    }

    /// The state at a step length, if it is admissible.
    fn attempt(&mut self, delta: &[f64], length: f64) -> Option<(Vec<[f64; D]>, Evaluation<D>, f64)> {
        let u = moved(self.problem, self.grid, &self.u, delta, length);
        let now = evaluate(self.problem, self.grid, &u).ok()?;
        let size = self.size(&now);
        size.is_finite().then_some((u, now, size))
    }

    fn better(&self, size: f64, length: f64) -> bool {
        size <= (1.0 - ARMIJO * length) * self.target || size <= self.problem.scene.numerics.tolerance * self.floor
    }

    fn accept(&mut self, u: Vec<[f64; D]>, now: Evaluation<D>) {
        self.best.clone_from(&u);
        (self.u, self.now) = (u, now);
        (self.target, self.relaxed) = (self.size(&self.now), 0);
        self.note();
    }

    fn failure(&self, why: &str) -> Error {
        Error::analysis(
            "Newton",
            format!("{why} (residual {:.1e} after {} iterations)", self.error(), self.history.len() - 1),
            "take smaller steps (step.min) or refine the mesh",
        )
    }
}

/// A force (kN) below which nothing counts: rounding in stresses of the order of the stiffness, on the sides of a
/// typical cell, which are four times its volume over its diagonal (in axisymmetry those of its ring).
fn floor<const D: usize>(problem: &Problem<D>, grid: &Grid<D>) -> f64 {
    let cells = grid.stencil.patches.iter().map(|patch| cell_size(&problem.scene.mesh, patch.cell as usize));
    let volume: f64 = problem.points.initial_volume.iter().sum();
    let side = 4.0 * volume / cells.sum::<f64>();
    1e-6 * problem.scene.stiffness_scale * side * (problem.given.len() as f64).sqrt()
}

/// The sum of all terms but inertia at the last converged step.
///
/// # Errors
/// When the converged state is inadmissible on the restored grid.
pub fn static_force<const D: usize>(problem: &Problem<D>, grid: &mut Grid<D>) -> Result<Vec<f64>> {
    let trial = Trial {
        displacement: problem.converged,
        between: problem.converged,
        alpha_f: 0.0,
        converged: problem.converged,
        acceleration: &[],
        acceleration_slope: 0.0,
        phase: problem.phase,
        time: problem.from,
    };
    sum_terms(problem, grid, &trial, None, |role| role != Role::Inertia).map(|sum| sum.force)
}

/// The residual for a displacement at the end of the step, and with it the tangent in the matrix of the grid.
fn evaluate<const D: usize>(problem: &Problem<D>, grid: &mut Grid<D>, u: &[[f64; D]]) -> Result<Evaluation<D>> {
    let mut between = Vec::new();
    let mut acceleration = Vec::new();
    if let Some(integration) = &problem.integration {
        between = blend(u, problem.converged, integration.alpha_f);
        acceleration = weighted_acceleration(problem, integration, u);
    }
    let alpha_f = problem.integration.map_or(0.0, |i| i.alpha_f);
    let trial = Trial {
        displacement: u,
        between: if problem.integration.is_some() { &between } else { u },
        alpha_f,
        converged: problem.converged,
        acceleration: &acceleration,
        acceleration_slope: problem.integration.map_or(0.0, |i| i.slope()),
        phase: problem.phase,
        time: (1.0 - alpha_f) * problem.to + alpha_f * problem.from,
    };
    let dynamic = problem.integration.is_some();
    let mut matrix = std::mem::take(&mut grid.motion.matrix);
    matrix.clear();
    let sum = sum_terms(problem, grid, &trial, Some(&mut matrix), |role| dynamic || role != Role::Inertia);
    grid.motion.matrix = matrix;
    sum
}

/// `(1 − α) u + α u_n`.
fn blend<const D: usize>(u: &[[f64; D]], converged: &[[f64; D]], alpha: f64) -> Vec<[f64; D]> {
    let one = |(u, c): (&[f64; D], &[f64; D])| std::array::from_fn(|d| (1.0 - alpha) * u[d] + alpha * c[d]);
    u.iter().zip(converged).map(one).collect()
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
    let frame = grid.frame(&problem.scene.mesh, problem.points, problem.weighing);
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
