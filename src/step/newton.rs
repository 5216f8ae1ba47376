//! Newton's method for one step (docs/theory.md, section 14, eq. 14).

mod acceptable;
mod begin;
mod near;
mod search;

use super::balance::evaluate;
use super::family::Family;
use super::free;
use super::grid::Grid;
use super::problem::{Problem, Solution};
use super::scene::Scene;
use super::unknowns::{Buffers, Evaluation};
use crate::contact::Sides;
use crate::error::{Error, Result};
use crate::mesh::cell_size;
use crate::system::{Method, is_singular};
use crate::term::Frozen;

/// Largest relative residual that the linear systems of an iteration are solved to.
const LOOSEST: f64 = 1e-3;
/// Smallest relative residual that they are solved to.
const TIGHTEST: f64 = 1e-10;
/// Part (-) of the square of the last reduction to which they are solved (Eisenstat & Walker 1996).
const FORCING: f64 = 0.1;
/// The stiffening (-) of soil with friction, once a tangent has been singular, over what is left (-) of the residual since.
const FOLLOWING: f64 = 8.0;
/// No more stiffening (-) than this then.
const MOST_FOLLOWING: f64 = 0.3;
/// How many times as many iterations a step may take then, and one of soil with friction that follows a prescribed motion, or where half the step
/// left the same residual.
const LONGER: usize = 2;
/// Where an iteration leaves less than this part (-) of the residual, the factor of the last tangent preconditions the next one.
const NEAR: f64 = 0.1;
/// Least scale of the residual, relative to the stiffness of a mean cell: below it there are no forces to be in balance.
const FLOOR: f64 = 1e-6;
/// A residual this small relative to the largest term is rounding.
const ROUNDING: f64 = 1e-12;

/// Solves a step.
///
/// # Errors
/// An analysis error that says why when the iteration does not converge: the caller takes a smaller step.
pub fn solve<const D: usize>(problem: &Problem<D>, grid: &mut Grid<D>) -> Result<Solution<D>> {
    let buffers = std::mem::take(&mut grid.buffers);
    let mut newton = Newton::new(problem, grid, buffers);
    let solution = newton.solve();
    let least = newton.history[newton.before..].iter().copied().fold(f64::NAN, f64::min);
    let Newton { grid, buffers, .. } = newton;
    grid.buffers = buffers;
    grid.buffers.least = least;
    solution
}

/// Whether soil with friction follows what is prescribed, without inertia, under loads that do not change. Under loads that do, and in the first step of a
/// phase, it may be beyond its limit, and an iteration over larger residuals would come to another equilibrium.
fn follows<const D: usize>(problem: &Problem<D>) -> bool {
    let held = problem.integration.is_some() || !problem.state.ramp.force.is_empty();
    !held && problem.from > 0.0 && problem.scene.follows(problem.phase)
}

/// The iteration.
struct Newton<'a, const D: usize> {
    problem: &'a Problem<'a, D>,
    grid: &'a mut Grid<D>,
    buffers: Buffers<D>,
    /// Whether the matrix of the grid is the tangent of the current state.
    tangent: bool,
    /// Least scale (kN) of the residual.
    floor: f64,
    /// Relative residuals so far; the last is that of the current state.
    history: Vec<f64>,
    /// The number of them before the iteration last began: from the predicted state, or anew from the converged one.
    before: usize,
    method: Method,
    /// Whether soil with friction follows what is prescribed: residuals may rise then.
    follows: bool,
    /// Whether a residual within the acceptable tolerance ends the step where no iteration comes closer; the least
    /// one so far, and how many residuals there were when it was found.
    accepts: bool,
    nearest: Option<(f64, usize)>,
    /// Whether the next direction is that of an elastic step.
    elastic: bool,
    /// Residuals (kN) of the states accepted so far.
    recent: Vec<f64>,
    /// The residual (kN) on the right of eq. 14, and how many full steps in a row the watchdog has accepted that did not reduce it.
    target: f64,
    relaxed: usize,
    /// Whether every iteration must reduce the residual, without watchdog: once that has failed, and in quasi-static steps with contact, whose status
    /// may change during a full step.
    strict: bool,
    /// How many backtracking searches in a row have not reduced the residual.
    stalled: usize,
    /// Whether prescribed displacements are not reached, so that their forces are part of the right-hand side.
    unreached: bool,
    /// Length of the last trial step, in those of `δ`.
    length: f64,
    /// Fraction (-) by which the diagonal of the tangent is raised (Levenberg).
    damping: f64,
    /// The relative residual where a tangent was singular: from then on soil with friction is stiffened in proportion to what is left of it.
    singular: Option<f64>,
    /// An iteration beyond this norm of the displacements (m) is on its way to another equilibrium.
    farthest: f64,
    /// The error of the last inadmissible trial state.
    refused: Option<Error>,
}

impl<'a, const D: usize> Newton<'a, D> {
    fn new(problem: &'a Problem<'a, D>, grid: &'a mut Grid<D>, mut buffers: Buffers<D>) -> Self {
        buffers.fixed.clear();
        buffers.fixed.extend(problem.given.iter().map(Option::is_some));
        problem.begin(grid, &mut buffers.now.at, problem.converged());
        buffers.best.clone_from(&buffers.now.at);
        buffers.damped.clear();
        let floor = floor(problem, grid);
        let strict = !problem.scene.interfaces.is_empty() && problem.integration.is_none();
        let follows = follows(problem);
        let accepts = follows && buffers.in_vain;
        Self {
            problem,
            grid,
            buffers,
            tangent: false,
            floor,
            history: Vec::new(),
            before: 0,
            method: Method::Cholesky,
            follows,
            accepts,
            nearest: None,
            elastic: false,
            recent: Vec::new(),
            target: f64::INFINITY,
            relaxed: 0,
            strict,
            stalled: 0,
            unreached: false,
            length: 0.0,
            damping: 0.0,
            singular: None,
            farthest: f64::INFINITY,
            refused: None,
        }
    }

    fn solve(&mut self) -> Result<Solution<D>> {
        if let Err(error) = self.iterate()
            && !self.take_acceptable()?
        {
            let strict = (std::mem::take(&mut self.history), self.before);
            if self.follows || !self.buffers.in_vain || !self.may_rise() || self.iterate_near().is_err() {
                (self.history, self.before) = strict;
                return Err(error);
            }
        }
        let now = &mut self.buffers.now;
        let at = std::mem::take(&mut now.at);
        Ok(Solution {
            displacement: at.displacement,
            pressure: at.pressure,
            residual: std::mem::take(&mut now.force),
            history: std::mem::take(&mut self.history),
            follows: follows(self.problem),
            applied: now.applied,
            work: now.work,
            method: self.method,
        })
    }

    fn iterate(&mut self) -> Result<()> {
        self.begin()?;
        loop {
            if self.converged() {
                return Ok(());
            }
            if self.farthest < f64::INFINITY && self.way() > self.farthest {
                return Err(self.failure("astray"));
            }
            match self.direction() {
                // A body that lifted off in a state on trial is free, and the system singular.
                Err(_) if self.is_on_trial() => self.return_to_best()?,
                other => other.and_then(|()| self.search())?,
            }
        }
    }

    /// Goes back to the converged state.
    fn restart(&mut self) {
        self.buffers.frozen = Frozen::Not;
        self.problem.begin(self.grid, &mut self.buffers.now.at, self.problem.converged());
        self.buffers.best.clone_from(&self.buffers.now.at);
        (self.target, self.damping, self.stalled, self.singular) = (f64::INFINITY, 0.0, 0, None);
        self.recent.clear();
        self.before = self.history.len();
    }

    /// The part of its elastic stiffness (-) that soil with friction keeps in the next tangent as it yields: that of the damping, or, once a tangent has
    /// been singular, in proportion to the residual. Inertia does without.
    fn stiffening(&self) -> f64 {
        match self.singular {
            _ if self.elastic => 1.0,
            _ if self.problem.integration.is_some() => 0.0,
            Some(first) => (FOLLOWING * self.error() / first).min(MOST_FOLLOWING),
            None => self.damping,
        }
    }

    /// The residual of the current state, and its tangent where wanted.
    fn evaluate(&mut self, tangent: bool) -> Result<()> {
        self.buffers.stiffening = self.stiffening();
        let mut now = std::mem::take(&mut self.buffers.now);
        let result = evaluate(self.problem, self.grid, &mut self.buffers, &mut now, tangent);
        self.buffers.now = now;
        self.tangent = tangent;
        result
    }

    /// The residual (kN).
    fn size(&self, evaluation: &Evaluation<D>) -> f64 {
        norm_free(&evaluation.force, &self.buffers.fixed)
    }

    /// Appends the residual of the current state, relative to the largest term in it, to the history.
    fn note(&mut self) {
        self.history.push(self.size(&self.buffers.now) / self.buffers.now.scale.max(self.floor));
    }

    fn error(&self) -> f64 {
        self.history.last().copied().unwrap_or(f64::NAN)
    }

    /// The relative residual to reach. A state that the iteration begins with passes only where it is exact.
    fn tolerance(&self) -> f64 {
        if self.history.len() > self.before + 1 { self.problem.scene.numerics.tolerance } else { ROUNDING }
    }

    fn converged(&mut self) -> bool {
        self.problem.gaps(self.grid, &self.buffers.now.at, &mut self.buffers.gap);
        self.buffers.gap.iter().all(|g| *g == 0.0) && self.error() <= self.tolerance()
    }

    /// `K δ = −R`, where δ of a prescribed displacement is what is left to it, as the last call of [`Newton::converged`] found.
    fn direction(&mut self) -> Result<()> {
        // Sand that yields everywhere has residuals in proportion to the step: a smaller one is as hard.
        let longer = if self.follows || self.singular.is_some() || self.buffers.is_alike { LONGER } else { 1 };
        if self.at_rest() || self.history.len() > longer * self.problem.scene.numerics.max_iterations {
            return Err(self.failure("too many iterations"));
        }
        if !self.tangent {
            self.evaluate(true)?;
        }
        self.tangent = false;
        let Buffers { now, delta, wanted, gap, fixed, damped, .. } = &mut self.buffers;
        delta.clear();
        delta.extend(now.force.iter().map(|r| -r));
        if self.damping > 0.0 && damped.is_empty() {
            damped_equations(self.problem.scene, self.grid, damped);
        }
        let motion = &mut self.grid.motion;
        if self.damping > 0.0 {
            motion.matrix.dampen(&motion.pattern, damped, self.damping);
        }
        let diagonal = motion.matrix.scale(&motion.pattern);
        motion.matrix.constrain(&motion.pattern, fixed, gap, diagonal, delta);
        wanted.clone_from(delta);
        // The forces of prescribed displacements that are not reached yet are part of the right-hand side, not of the residual.
        self.unreached = gap.iter().any(|g| *g != 0.0);
        if self.target.is_infinite() || self.unreached {
            self.target = norm_free(wanted, fixed);
        }
        let (pattern, matrix) = (&motion.pattern, &motion.matrix);
        let near = matches!(self.history[..], [.., before, last] if last < NEAR * before);
        let tolerance = forcing(&self.history, self.problem.scene.numerics.tolerance);
        let method = if !matrix.matrix_free.is_empty() {
            motion.solver.solve_matrix_free(pattern, matrix, tolerance, delta)
        } else if near && self.method == Method::Iterative {
            motion.solver.solve_near(pattern, matrix, tolerance, delta)
        } else {
            motion.solver.solve_to(pattern, matrix, tolerance, delta)
        };
        // The tangent of soil that flows may resist no motion at all.
        if method.as_ref().is_err_and(is_singular) && self.singular.is_none() && self.problem.integration.is_none() {
            self.singular = Some(self.error());
            return self.direction();
        }
        let Problem { scene, state, integration, .. } = self.problem;
        let position = |n: u32| {
            let from = state.at_reset(scene, n);
            std::array::from_fn(|d| from[d] + now.at.displacement[n as usize][d])
        };
        self.method = match method {
            Err(error) if integration.is_none() => Err(free::name(error, scene, state, self.grid, fixed, &position)),
            method => method,
        }?;
        Ok(())
    }

    /// The position (m), as the step begins, of the node with the largest residual: in a diverging state the node may have left the grid.
    fn worst(&self) -> Option<[f64; D]> {
        let size = |b: usize| {
            let of_node = D * b..D * (b + 1);
            let free = of_node.filter(|&e| !self.buffers.fixed[e]);
            free.map(|e| self.buffers.now.force[e].powi(2)).sum::<f64>()
        };
        let blocks = 0..self.grid.dofs.node.len().min(self.buffers.now.force.len() / D);
        let n = self.grid.dofs.node[blocks.max_by(|&a, &b| size(a).total_cmp(&size(b)))?];
        let from = self.problem.state.at_reset(self.problem.scene, n);
        Some(std::array::from_fn(|d| from[d] + self.problem.converged()[n as usize][d]))
    }

    fn failure(&self, why: &str) -> Error {
        let place = self.worst().map_or(String::new(), |x| format!(", most near {x:.3?} m"));
        Error::analysis(
            "Newton",
            format!("{why} (residual {:.1e} after {} iterations{place})", self.error(), self.history.len() - 1),
            "take smaller steps (step.min) or refine the mesh",
        )
    }
}

/// The relative residual of the linear solution (inexact Newton): a part of the square of the last reduction (Eisenstat & Walker 1996), which preserves
/// the convergence of Newton's method. Where that would reach the `tolerance`, nothing but rounding is left: what a step leaves the momentum loses.
fn forcing(history: &[f64], tolerance: f64) -> f64 {
    let last = history.last().copied().unwrap_or(1.0);
    let quadratic = match history {
        [.., before, last] => FORCING * (last / before).powi(2),
        _ => LOOSEST,
    };
    let part = if quadratic * last <= tolerance { ROUNDING / last } else { quadratic };
    part.clamp(TIGHTEST, LOOSEST)
}

/// Which equations of nodes are damped: not those of finite elements in contact. Only soil that flows may support a structure; a fraction of the
/// structure's own stiffness would be far stiffer, and it would approach its equilibrium in tiny steps.
fn damped_equations<const D: usize>(scene: &Scene<D>, grid: &Grid<D>, out: &mut Vec<bool>) {
    out.extend(grid.dofs.node.iter().flat_map(|&n| [scene.body_of(n).is_none(); D]));
    let Some(fem) = &scene.fem else { return };
    for c in fem.deforming() {
        let region = fem.mesh.cells.region[c];
        let is_side = |sides: &Sides| sides.structure == region || sides.against == Some(region);
        if scene.interfaces.iter().any(|interface| is_side(interface.sides())) {
            for &n in fem.mesh.cells.nodes(c) {
                let block = grid.dofs.block[n as usize] as usize;
                out.iter_mut().skip(D * block).take(D).for_each(|damped| *damped = false);
            }
        }
    }
}

/// The least scale (kN) of the residual: 10⁻⁶ of the largest confined modulus on the side of a mean cell (in axisymmetry of its ring), times
/// the root of the number of equations. The side is taken as four times the volume over the diagonal.
fn floor<const D: usize>(problem: &Problem<D>, grid: &Grid<D>) -> f64 {
    let (mut volume, mut size) = (0.0, 0.0);
    for Family { mesh, interpolation, points, .. } in grid.integrated(problem.scene, problem.state) {
        volume += interpolation.points.iter().map(|&p| points.initial_volume[p as usize]).sum::<f64>();
        size += interpolation.filled.iter().map(|cell_points| cell_size(mesh, cell_points.cell as usize)).sum::<f64>();
    }
    let side = 4.0 * volume / size;
    FLOOR * problem.scene.stiffness_scale * side * (problem.given.len() as f64).sqrt()
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn norm_free(x: &[f64], fixed: &[bool]) -> f64 {
    x.iter().zip(fixed).map(|(x, fixed)| if *fixed { 0.0 } else { x * x }).sum::<f64>().sqrt()
}
