//! Newton's method for one step, with a backtracking line search.

use super::grid::{Family, Grid};
use super::scene::Scene;
use super::state::State;
use super::unknowns::Unknowns;
use crate::error::{Error, Result};
use crate::profile::{Activity, timed};
use crate::stencil::cell_size;
use crate::system::Method;
use crate::term::{Assembly, Role, Trial};
use crate::time_integration::GeneralisedAlpha;

/// Sufficient decrease of the residual for a step length `s`: by a factor `1 − ARMIJO · s`.
const ARMIJO: f64 = 1e-4;
/// Halvings of the step length before the best one is taken.
const BACKTRACKS: i32 = 6;
/// Line searches that may end without a decrease before the step is given up.
const STALLED: usize = 4;
/// Shares by which the diagonal of the tangent is raised where its steps go astray (Levenberg 1944).
const LEAST_DAMPING: f64 = 1e-4;
const MOST_DAMPING: f64 = 0.2;
/// Halvings of an accepted step length from which its tangent is not to be trusted so far.
const ASTRAY: i32 = 3;
/// Full steps that may raise the residual before the iteration returns to its best state.
const WATCH: usize = 3;
/// Share of the residual from which on a full step may have gone too far, and of the work that it may leave.
const WORTH: f64 = 0.25;
const LEVEL: f64 = 0.5;
/// States looked at for a length that leaves less work, and the least share of a bracket that the next goes into it.
const LEVELS: usize = 5;
const INWARDS: f64 = 0.1;
/// Directions from a guess that hold hats together.
const HELD: usize = 3;
/// Largest relative residual that the linear systems of an iteration are solved to.
const LOOSEST: f64 = 1e-3;
/// A residual this small relative to the forces that balance is rounding.
const ROUNDING: f64 = 1e-14;

/// What is to be solved.
pub struct Problem<'a, const D: usize> {
    pub scene: &'a Scene<D>,
    pub state: &'a State<D>,
    /// Displacement (m) of the nodes that the iteration begins with, if not the converged one.
    pub guess: Option<&'a [[f64; D]]>,
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

/// A converged step.
pub struct Solution<const D: usize> {
    /// Displacement of the nodes (m) since the last restoration.
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

/// Vectors that the iterations of all steps use.
#[derive(Default)]
pub struct Buffers<const D: usize> {
    now: Evaluation<D>,
    trial: Evaluation<D>,
    best: Unknowns<D>,
    delta: Vec<f64>,
    /// What `delta` balances in the linear system (kN).
    wanted: Vec<f64>,
    gap: Vec<f64>,
    fixed: Vec<bool>,
    /// The equations whose diagonal is raised where steps go astray: those of nodes that no structure has. Empty
    /// until then.
    damped: Vec<bool>,
    /// The residual of one term.
    own: Vec<f64>,
    between: Vec<[f64; D]>,
    acceleration: Vec<[f64; D]>,
    /// As [`Trial::held`].
    held: bool,
}

/// A state and its residual.
struct Evaluation<const D: usize> {
    at: Unknowns<D>,
    force: Vec<f64>,
    applied: [f64; D],
    /// Norm of the largest term on the displacements: what the residual is measured against.
    scale: f64,
}

impl<const D: usize> Default for Evaluation<D> {
    fn default() -> Self {
        Self { at: Unknowns::default(), force: Vec::new(), applied: [0.0; D], scale: 0.0 }
    }
}

/// Solves a step.
///
/// # Errors
/// An analysis error that says why when the iteration does not converge: the caller takes a smaller step.
pub fn solve<const D: usize>(problem: &Problem<D>, grid: &mut Grid<D>) -> Result<Solution<D>> {
    let buffers = std::mem::take(&mut grid.buffers);
    let mut newton = Newton::new(problem, grid, buffers);
    let solution = newton.solve();
    let Newton { grid, buffers, .. } = newton;
    grid.buffers = buffers;
    solution
}

/// The iteration.
struct Newton<'a, const D: usize> {
    problem: &'a Problem<'a, D>,
    grid: &'a mut Grid<D>,
    buffers: Buffers<D>,
    /// Whether the matrix of the grid is the tangent of the state at hand.
    tangent: bool,
    /// A force (kN) below which nothing counts.
    floor: f64,
    /// Relative residuals so far; the last is that of the state at hand.
    history: Vec<f64>,
    method: Method,
    /// The residual (kN) to beat, and how many iterations have not.
    target: f64,
    relaxed: usize,
    /// Whether every iteration must lessen the residual: set when full steps have failed to.
    strict: bool,
    stalled: usize,
    /// Length of the last trial step, in those of `δ`.
    length: f64,
    /// Share by which the diagonal of the tangent is raised: not zero while its steps go astray.
    damping: f64,
    /// Why the last trial state that was not admissible is not.
    refused: Option<Error>,
}

impl<'a, const D: usize> Newton<'a, D> {
    fn new(problem: &'a Problem<'a, D>, grid: &'a mut Grid<D>, mut buffers: Buffers<D>) -> Self {
        buffers.fixed.clear();
        buffers.fixed.extend(problem.given.iter().map(Option::is_some));
        buffers.now.at.set(problem.converged, problem.pressure);
        buffers.best.clone_from(&buffers.now.at);
        buffers.damped.clear();
        let floor = floor(problem, grid);
        Self {
            problem,
            grid,
            buffers,
            tangent: false,
            floor,
            history: Vec::new(),
            method: Method::Cholesky,
            target: f64::INFINITY,
            relaxed: 0,
            // Hats touch or part on the way of a full step, and what follows is no better for it.
            strict: !problem.scene.pairs.is_empty() && problem.integration.is_none(),
            stalled: 0,
            length: 0.0,
            damping: 0.0,
            refused: None,
        }
    }

    fn solve(&mut self) -> Result<Solution<D>> {
        self.begin()?;
        while !self.converged() {
            self.direction()?;
            self.search()?;
        }
        let now = &mut self.buffers.now;
        let at = std::mem::take(&mut now.at);
        Ok(Solution {
            displacement: at.displacement,
            pressure: at.pressure,
            residual: std::mem::take(&mut now.force),
            history: std::mem::take(&mut self.history),
            applied: now.applied,
            method: self.method,
        })
    }

    /// The state that the iteration begins with.
    fn begin(&mut self) -> Result<()> {
        if let Some(guess) = self.problem.guess {
            self.buffers.now.at.set(guess, self.problem.pressure);
            if self.set_out().is_ok() {
                return Ok(());
            }
            self.history.clear();
            self.buffers.held = false;
            self.buffers.now.at.set(self.problem.converged, self.problem.pressure);
            self.buffers.best.clone_from(&self.buffers.now.at);
            (self.target, self.damping, self.stalled) = (f64::INFINITY, 0.0, 0);
        }
        self.evaluate(true)?;
        self.note();
        Ok(())
    }

    /// The first iterations from a guess. It leaves hats a little apart that bear in the end; nothing holds the soil beneath
    /// them then, and what the tangent says flies through the structure. The directions hold such hats
    /// together until one is worth its full length.
    fn set_out(&mut self) -> Result<()> {
        self.evaluate(false)?;
        self.note();
        for _ in 0..HELD {
            if self.converged() {
                break;
            }
            let size = self.size(&self.buffers.now);
            self.buffers.held = true;
            self.direction()?;
            self.buffers.held = false;
            self.target = self.target.max(size);
            self.search()?;
            if self.length == 1.0 {
                break;
            }
        }
        Ok(())
    }

    /// The residual of the state at hand, and its tangent where wanted.
    fn evaluate(&mut self, tangent: bool) -> Result<()> {
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

    /// Notes the residual of the state at hand, relative to the largest of the terms that balance in it.
    fn note(&mut self) {
        self.history.push(self.size(&self.buffers.now) / self.buffers.now.scale.max(self.floor));
    }

    fn error(&self) -> f64 {
        self.history.last().copied().unwrap_or(f64::NAN)
    }

    fn tolerance(&self) -> f64 {
        if self.history.len() > 1 { self.problem.scene.numerics.tolerance } else { ROUNDING }
    }

    fn converged(&mut self) -> bool {
        gaps(self.problem, self.grid, &self.buffers.now.at, &mut self.buffers.gap);
        self.buffers.gap.iter().all(|g| *g == 0.0) && self.error() <= self.tolerance()
    }

    /// `K δ = −R` with δ given where the displacement is, as the last call of [`Newton::converged`] found.
    fn direction(&mut self) -> Result<()> {
        if self.history.len() > self.problem.scene.numerics.max_iterations {
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
        if self.target.is_infinite() {
            // Displacements still to be given unbalance the system beyond the residual at hand.
            self.target = norm_free(delta, fixed);
        }
        wanted.clone_from(delta);
        let (pattern, matrix) = (&motion.pattern, &motion.matrix);
        self.method = if matrix.beyond.is_empty() {
            motion.solver.solve(pattern, matrix, delta)?
        } else {
            let tolerance = forcing(&self.history, self.problem.scene.numerics.tolerance);
            motion.solver.solve_beyond(pattern, matrix, tolerance, delta)?
        };
        Ok(())
    }

    /// Whether the next full step will end the iteration, if it converges as the last ones did: its tangent is then
    /// not worth its time.
    fn near_the_end(&self) -> bool {
        let [.., before, last] = self.history[..] else { return false };
        last < before && last * (last / before).powi(2) < self.tolerance()
    }

    /// Goes along `δ`. A full step is taken even if the residual grows, for a few iterations on trial:
    /// bending structures converge so, and only so. If that does not pay, the iteration returns to its best
    /// state and from then on backtracks until the residual falls (a watchdog, Chamberlain et al. 1982). A step that lessens
    /// the residual little and goes beyond where it does no more work is shortened to about there (Matthies & Strang 1979):
    /// where soil yields or hats part, iterations would else go to and fro.
    fn search(&mut self) -> Result<()> {
        let with_tangent = !self.near_the_end();
        if let Some(size) = self.attempt(1.0, with_tangent) {
            let better = self.better(size, 1.0);
            if (better || self.strict) && size > WORTH * self.target && self.too_far() {
                return if self.level() { Ok(()) } else { self.backtrack() };
            }
            if better {
                self.damping = if self.damping > LEAST_DAMPING { 0.1 * self.damping } else { 0.0 };
                self.accept(with_tangent);
                return Ok(());
            }
            if !self.strict && self.relaxed < WATCH {
                self.relaxed += 1;
                self.take(with_tangent);
                return Ok(());
            }
        }
        if !self.strict && self.relaxed > 0 {
            self.strict = true;
            self.buffers.now.at.clone_from(&self.buffers.best);
            self.evaluate(true)?;
            self.note();
            return Ok(());
        }
        self.backtrack()
    }

    /// The work (kJ) of a force along `δ`, that of what is given and of pressures left out.
    fn work(&self, force: &[f64]) -> f64 {
        let of_nodes = D * self.grid.node.len();
        let each = force.iter().zip(&self.buffers.delta).zip(&self.buffers.fixed).take(of_nodes);
        each.map(|((f, d), fixed)| if *fixed { 0.0 } else { f * d }).sum()
    }

    /// Whether the residual does work against the rest of the way at the trial state.
    fn too_far(&self) -> bool {
        let before = self.work(&self.buffers.wanted);
        before > 0.0 && self.work(&self.buffers.trial.force) > LEVEL * before
    }

    /// Shortens the full step to where the residual does little work along `δ`, by regula falsi with halved ends
    /// (Dowell & Jarratt 1971); false where that does not lessen the residual.
    fn level(&mut self) -> bool {
        let first = -self.work(&self.buffers.wanted);
        let (mut low, mut high) = ((0.0, first), (1.0, self.work(&self.buffers.trial.force)));
        for _ in 0..LEVELS {
            let (whole, root) = (high.0 - low.0, low.1 / (low.1 - high.1));
            let length = low.0 + whole * root.clamp(INWARDS, 1.0 - INWARDS);
            let Some(size) = self.attempt(length, false) else { return false };
            let work = self.work(&self.buffers.trial.force);
            if work.abs() <= -LEVEL * first {
                let better = self.better(size, length);
                if better {
                    self.accept(false);
                }
                return better;
            }
            if work < 0.0 {
                (low, high.1) = ((length, work), 0.5 * high.1);
            } else {
                (high, low.1) = ((length, work), 0.5 * low.1);
            }
        }
        false
    }

    /// Raises the diagonal more from here on; false where it is raised enough.
    fn dampen(&mut self) -> bool {
        let more = (10.0 * self.damping).max(LEAST_DAMPING);
        let can = more <= MOST_DAMPING;
        if can {
            self.damping = more;
        }
        can
    }

    /// Halves the step length until the residual falls; takes the least one a few times where it never does.
    fn backtrack(&mut self) -> Result<()> {
        let mut least: Option<(f64, f64)> = None;
        for halvings in 1..=BACKTRACKS {
            let length = 0.5f64.powi(halvings);
            if let Some(size) = self.attempt(length, false) {
                if self.better(size, length) {
                    self.stalled = 0;
                    if halvings >= ASTRAY {
                        self.dampen();
                    }
                    self.accept(false);
                    return Ok(());
                }
                if least.is_none_or(|(other, _)| size < other) {
                    least = Some((size, length));
                }
            }
        }
        // A direction that leads nowhere at any length: the next, from the same state, is shorter and turned downhill.
        if self.dampen() {
            return Ok(());
        }
        let Some((_, length)) = least else {
            let why = self.refused.take().map_or("no trial state is admissible".to_string(), |error| {
                format!("no trial state is admissible: {} {}", error.place, error.problem)
            });
            return Err(self.failure(&why));
        };
        self.stalled += 1;
        if self.stalled <= STALLED && self.attempt(length, true).is_some() {
            self.accept(true);
            return Ok(());
        }
        Err(self.failure("the line search finds no smaller residual"))
    }

    /// The residual (kN) of the trial state at a step length, if it is admissible.
    fn attempt(&mut self, length: f64, tangent: bool) -> Option<f64> {
        self.length = length;
        let mut trial = std::mem::take(&mut self.buffers.trial);
        trial.at.clone_from(&self.buffers.now.at);
        trial.at.advance(self.problem, self.grid, &self.buffers.delta, length);
        let done = evaluate(self.problem, self.grid, &mut self.buffers, &mut trial, tangent);
        let size = self.size(&trial);
        self.buffers.trial = trial;
        match done {
            Ok(()) => size.is_finite().then_some(size),
            Err(error) => {
                self.refused = Some(error);
                None
            }
        }
    }

    fn better(&self, size: f64, length: f64) -> bool {
        size <= (1.0 - ARMIJO * length) * self.target || size <= self.problem.scene.numerics.tolerance * self.floor
    }

    /// Makes the trial state the one at hand; `tangent` where the matrix of the grid is its tangent.
    fn take(&mut self, tangent: bool) {
        let Buffers { now, trial, .. } = &mut self.buffers;
        std::mem::swap(now, trial);
        self.tangent = tangent;
        self.note();
    }

    fn accept(&mut self, tangent: bool) {
        self.take(tangent);
        let Buffers { now, best, .. } = &mut self.buffers;
        best.clone_from(&now.at);
        (self.target, self.relaxed) = (self.size(&self.buffers.now), 0);
    }

    fn failure(&self, why: &str) -> Error {
        Error::analysis(
            "Newton",
            format!("{why} (residual {:.1e} after {} iterations)", self.error(), self.history.len() - 1),
            "take smaller steps (step.min) or refine the mesh",
        )
    }
}

/// The relative residual to solve an iteration to: as the residual fell in the one before, squared (Eisenstat & Walker
/// 1996), which keeps the convergence of Newton's method, but no more than the end of the iteration asks for.
fn forcing(history: &[f64], tolerance: f64) -> f64 {
    let last = history.last().copied().unwrap_or(1.0);
    let enough = 0.1 * tolerance / last;
    let quadratic = match history {
        [.., before, last] => 0.1 * (last / before).powi(2),
        _ => LOOSEST,
    };
    quadratic.max(enough).clamp(1e-10, LOOSEST)
}

/// Which equations of nodes are damped. A structure as a whole may have no more to hold it than soil that flows: a share of
/// its own stiffness would be a far stiffer hold on it, and its balance would come in tiny steps.
fn damped_equations<const D: usize>(scene: &Scene<D>, grid: &Grid<D>, out: &mut Vec<bool>) {
    out.extend(grid.node.iter().flat_map(|&n| [(n as usize) < scene.mesh_nodes(); D]));
    let Some(fem) = &scene.fem else { return };
    for c in fem.deforming() {
        if scene.pairs.iter().any(|pair| pair.structure() == fem.mesh.cells.region[c]) {
            for &n in fem.mesh.cells.nodes(c) {
                let block = grid.block[n as usize] as usize;
                out.iter_mut().skip(D * block).take(D).for_each(|damped| *damped = false);
            }
        }
    }
}

/// A force (kN) below which nothing counts: rounding in stresses of the order of the stiffness, on the sides of a
/// typical cell, which are four times its volume over its diagonal (in axisymmetry those of its ring).
fn floor<const D: usize>(problem: &Problem<D>, grid: &Grid<D>) -> f64 {
    let (mut volume, mut size) = (0.0, 0.0);
    for Family { mesh, stencil, points, .. } in grid.families(problem.scene, problem.state) {
        volume += stencil.points.iter().map(|&p| points.initial_volume[p as usize]).sum::<f64>();
        size += stencil.patches.iter().map(|patch| cell_size(mesh, patch.cell as usize)).sum::<f64>();
    }
    let side = 4.0 * volume / size;
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
        pressure: problem.pressure,
        converged_pressure: problem.pressure,
        flow_time: 0.0,
        acceleration: &[],
        acceleration_slope: 0.0,
        phase: problem.phase,
        time: problem.from,
        reduction: problem.scene.phases[problem.phase].reduction_at(problem.from),
        held: false,
        per_second: 0.0,
    };
    let (mut own, mut sum) = (Vec::new(), Evaluation::default());
    timed(Activity::Assembly, || {
        add_terms(problem, grid, &trial, false, &|role| role != Role::Inertia, &mut own, &mut sum)
    })?;
    Ok(sum.force)
}

/// The residual of a state at the end of the step and, where wanted, the tangent in the matrix of the grid.
fn evaluate<const D: usize>(
    problem: &Problem<D>,
    grid: &mut Grid<D>,
    buffers: &mut Buffers<D>,
    state: &mut Evaluation<D>,
    tangent: bool,
) -> Result<()> {
    let at = std::mem::take(&mut state.at);
    let Buffers { own, between, acceleration, held, .. } = buffers;
    let u = &at.displacement;
    if let Some(integration) = &problem.integration {
        blend(u, problem.converged, integration.alpha_f, between);
        weighted_acceleration(problem, integration, u, acceleration);
    }
    let dynamic = problem.integration.is_some();
    let alpha_f = problem.integration.map_or(0.0, |i| i.alpha_f);
    let trial = Trial {
        displacement: u,
        between: if dynamic { between } else { u },
        alpha_f,
        converged: problem.converged,
        pressure: &at.pressure,
        converged_pressure: problem.pressure,
        flow_time: problem.flow_time,
        acceleration,
        acceleration_slope: problem.integration.map_or(0.0, |i| i.slope()),
        phase: problem.phase,
        time: (1.0 - alpha_f) * problem.to + alpha_f * problem.from,
        reduction: problem.scene.phases[problem.phase].reduction_at(problem.to),
        held: *held,
        per_second: 1.0 / (problem.to - problem.from),
    };
    let result = timed(Activity::Assembly, || {
        add_terms(problem, grid, &trial, tangent, &|role| dynamic || role != Role::Inertia, own, state)
    });
    state.at = at;
    result
}

/// Adds up the terms of the wanted roles.
fn add_terms<const D: usize>(
    problem: &Problem<D>,
    grid: &mut Grid<D>,
    trial: &Trial<D>,
    tangent: bool,
    wanted: &dyn Fn(Role) -> bool,
    own: &mut Vec<f64>,
    sum: &mut Evaluation<D>,
) -> Result<()> {
    let mut workspace = std::mem::take(&mut grid.workspace);
    let mut matrix = std::mem::take(&mut grid.motion.matrix);
    if tangent {
        matrix.clear();
    }
    let scene = problem.scene;
    let (equations, of_nodes) = (grid.motion.pattern.len(), D * grid.node.len());
    sum.force.clear();
    sum.force.resize(equations, 0.0);
    (sum.applied, sum.scale) = ([0.0; D], 0.0);
    own.resize(equations, 0.0);
    let soil = grid.frame(&scene.mesh, problem.state);
    let elements = grid.elements.as_ref().map(|elements| grid.frame_of_elements(scene, elements, problem.state));
    let of_elements = scene.fem.iter().flat_map(|fem| &fem.terms).zip(elements.iter().cycle());
    let terms = scene.terms.iter().map(|term| (term, &soil)).chain(of_elements);
    let mut result = Ok(());
    for (term, frame) in terms.filter(|(term, _)| wanted(term.role())) {
        own.fill(0.0);
        let mut out = Assembly { force: own, tangent: tangent.then_some(&mut matrix), workspace: &mut workspace };
        result = term.assemble(frame, trial, &mut out);
        if result.is_err() {
            break;
        }
        sum.scale = sum.scale.max(norm(&own[..of_nodes]));
        for (f, o) in sum.force.iter_mut().zip(own.iter()) {
            *f += o;
        }
        if term.role() == Role::External {
            // What turns a body is a moment.
            let forces =
                own[..of_nodes].chunks_exact(D).zip(&grid.node).filter(|(_, n)| scene.turned_by(**n).is_none());
            for (force, _) in forces {
                for (applied, f) in sum.applied.iter_mut().zip(force) {
                    *applied -= f;
                }
            }
        }
    }
    grid.workspace = workspace;
    grid.motion.matrix = matrix;
    result
}

/// `(1 − α) u + α u_n`.
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
            integration.weighted(a, integration.acceleration(u[n][d] - problem.converged[n][d], v, a))
        })
    };
    out.clear();
    out.extend((0..u.len()).map(at));
}

/// What is missing to the given displacements and pore pressures, in the unit of the unknowns, one entry an equation.
fn gaps<const D: usize>(problem: &Problem<D>, grid: &Grid<D>, at: &Unknowns<D>, out: &mut Vec<f64>) {
    let of_nodes = D * grid.node.len();
    let gap = |(e, given): (usize, &Option<f64>)| {
        given.map_or(0.0, |increment| {
            if e >= of_nodes {
                let unknown = grid.carrier[e - of_nodes] as usize;
                let missing = problem.pressure[unknown] + increment - at.pressure[unknown];
                return missing / problem.scene.pressure_unit.unwrap_or(1.0);
            }
            let (n, d) = (grid.node[e / D] as usize, e % D);
            problem.converged[n][d] + increment - at.displacement[n][d]
        })
    };
    out.clear();
    out.extend(problem.given.iter().enumerate().map(gap));
}

fn norm(x: &[f64]) -> f64 {
    x.iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn norm_free(x: &[f64], fixed: &[bool]) -> f64 {
    x.iter().zip(fixed).map(|(x, fixed)| if *fixed { 0.0 } else { x * x }).sum::<f64>().sqrt()
}
