//! The time step: the page to read first (docs/theory.md, section 4).
//!
//! Each step has the three phases of the material point method. *Initialise* restores the grid where that is due, locates the
//! points on it and maps their motion to its nodes. *Lagrange* solves the equations of motion on the grid,
//! implicitly. *Convect* moves the points with the grid and gives them its motion and the converged state.
//!
//! To *restore* the grid is the word of the reference for a grid reset: its nodes go back to their first positions.

mod balance;
mod boundary_projection;
mod change;
mod contact;
mod control;
mod distortion;
mod drainage;
mod driven;
mod driven_work;
mod energies;
mod equilibrate;
mod facing;
mod family;
mod fem;
mod free;
mod ghost_faces;
mod grid;
mod impulse;
mod inflow;
mod leaving;
mod mass;
mod materials;
mod momentum;
mod new_points;
mod newton;
mod nodal_fit;
mod obstacles;
mod outflow;
pub mod overlap;
mod placement;
mod pore_pressure;
mod predictor;
mod pressure;
mod problem;
mod ramp;
mod relax;
mod removal;
mod report;
mod restore;
mod rigid;
mod scalars;
mod scene;
mod search;
mod start;
mod state;
mod traced;
mod transfer;
mod unbalanced;
mod unknowns;
mod water;
mod work;

pub use change::{Change, Material};
pub use contact::Resultant;
pub use control::Controller;
pub use energies::{Energies, ITEMS, Item, Side};
pub use ghost_faces::has_room_for_penalties;
pub use grid::Grid;
pub use problem::Solution;
pub use ramp::UnbalancedRamp;
pub use report::Report;
pub use scene::{
    FARTHEST, Fem, Fixed, Inflow, Numerics, Outflow, Phase, Placement, Prescribed, Removal, Restore, Scene, Search,
    Soil, StepSize, Stop, Water,
};
pub use search::kink;
pub use state::{Span, State};
pub use water::Balance;
pub use work::energy_of_fall;

use crate::error::{Kind, Result};
use crate::kinematics::Kinematics;
use crate::profile::{Activity, timed};
use problem::Problem;
use start::Start;
use std::marker::PhantomData;
use transfer::Answers;

/// The result of [`Simulation::lagrange`]: with inertia, the velocity and acceleration of the nodes at the start; and the solution.
type Lagrange<const D: usize> = (Option<Start<D>>, Solution<D>);

/// A step that is found, and what it makes of points and energies.
struct Complete<const D: usize> {
    /// As [`Lagrange`].
    start: Option<Start<D>>,
    solution: Solution<D>,
    answers: Answers,
    /// The acceleration of the nodes by contact alone; empty without.
    by_contact: Vec<[f64; D]>,
    energies: Energies,
}

/// What the beginning of a step came to.
struct Begun {
    /// Whether another reset would change nothing: the grid was just reset or nothing has moved on it, or it is never reset.
    fresh: bool,
    /// Whether the equilibrium after the reset was not found.
    unbalanced: bool,
}

/// A run: the scene, its state, and the grid that follows from both.
pub struct Simulation<'a, const D: usize, K> {
    pub scene: &'a Scene<D>,
    pub state: State<D>,
    grid: Grid<D>,
    kinematics: PhantomData<K>,
}

impl<'a, const D: usize, K: Kinematics<D>> Simulation<'a, D, K> {
    /// Starts from a state: the first one or one from a checkpoint.
    ///
    /// # Errors
    /// When a point lies outside the grid, or memory does not suffice.
    pub fn new(scene: &'a Scene<D>, mut state: State<D>) -> Result<Self> {
        let first = state.restorations == 0;
        let grid = if first { Grid::first::<K>(scene, &mut state)? } else { Grid::new::<K>(scene, &state)? };
        Ok(Self { scene, state, grid, kinematics: PhantomData })
    }

    /// Begins a phase: removes the soil that goes and places that which comes. Returns notes on it: the soil that comes, materials that change in it,
    /// prescribed displacements and loads that act on no material.
    ///
    /// # Errors
    /// When memory does not suffice, and where a structure comes back into soil, or soil into a structure.
    pub fn begin_phase(&mut self) -> Result<Vec<String>> {
        let Some(phase) = self.scene.phases.get(self.state.phase) else { return Ok(Vec::new()) };
        let goes = removal::remove::<D, K>(self.scene, &mut self.grid, &mut self.state)?;
        let placed = placement::place::<D, K>(self.scene, &mut self.grid, &mut self.state)?;
        if goes || !placed.is_empty() {
            self.initialise(false)?;
            if self.state.moving {
                transfer::motion_to_grid::<D, K>(self.scene, &mut self.grid, &mut self.state)?;
            }
            unbalanced::hold_over_phase(self.scene, &mut self.grid, &mut self.state)?;
        }
        if phase.dynamic
            && !self.scene.absorbing.is_empty()
            && self.state.ramp.force.is_empty()
            && self.state.phase_time == 0.0
        {
            self.find_loads_and_contacts()?;
            unbalanced::keep_reactions(self.scene, &mut self.grid, &mut self.state)?;
        }
        overlap::on_return(self.scene, &self.state)?;
        if self.scene.terms.iter().any(|term| term.sees_open_boundary()) {
            match self.find_loads_and_contacts() {
                // The next step reports an error of the analysis.
                Err(error) if error.kind != Kind::Analysis => return Err(error),
                _ => {}
            }
        }
        let out = |n: &u32| !self.grid.dofs.has(*n);
        let idle = phase.prescribed.iter().filter(|p| p.fixed.nodes.iter().all(out));
        let frame = self.grid.frame(&self.scene.mesh, &self.state);
        let loads = self.scene.terms.iter().filter_map(|term| {
            let idle = term.idle_load(&frame, &self.state.displacement, self.state.phase)?;
            Some(format!("warning: phase `{}`: {idle}", phase.name))
        });
        let notes = idle.filter_map(|p| {
            let place = self.scene.origin(*p.fixed.nodes.first()?);
            let axis = ["x", "y", "z"][p.fixed.component];
            Some(format!(
                "warning: phase `{}`: the displacement prescribed in {axis} near {place:.3?} m meets no material: it does nothing until some comes \
                 within two cells; move a rigid structure with a contact in place of a curve",
                phase.name
            ))
        });
        let changes = materials::notes::<D, K>(self.scene, &self.state);
        Ok(placed.into_iter().chain(changes).chain(notes).chain(loads).collect())
    }

    /// Whether the phase is dynamic and nothing will move in it any more: with no more kinetic energy than `kinetic` (kJ), and in equilibrium under
    /// all of its loads to come but for the fraction `part` (-) of the largest force.
    ///
    /// # Errors
    /// When memory does not suffice.
    pub fn stays_at_rest(&mut self, part: f64, kinetic: f64) -> Result<bool> {
        if !self.scene.phases.get(self.state.phase).is_some_and(|phase| phase.dynamic) {
            return Ok(false);
        }
        let found = self
            .find_loads_and_contacts()
            .and_then(|()| unbalanced::stays_at_rest(self.scene, &mut self.grid, &self.state, [part, kinetic]));
        match found {
            // The next step reports an error of the analysis.
            Err(error) if error.kind == Kind::Analysis => Ok(false),
            found => found,
        }
    }

    /// One time step of the size that `controller` wants. It is tried with the predictor first; a step that fails is tried again on a
    /// reset grid, or without the predictor, and is then halved until it converges.
    ///
    /// # Errors
    /// When a point left the grid, the step falls below the least one, or memory does not suffice.
    pub fn advance(&mut self, controller: &mut Controller) -> Result<Report<D>> {
        if self.begins_search() {
            return self.begin_search(controller);
        }
        let before = self.state.restorations;
        let mut begun = timed(Activity::Transfer, || self.initialise(false))?;
        let mut predict = true;
        let (dt, complete) = loop {
            let dt = controller.size(self.state.phase_time);
            self.grid.buffers.in_vain = controller.in_vain(dt);
            self.grid.buffers.is_alike = controller.is_alike();
            let predictor = std::mem::take(&mut predict).then(|| predictor::extrapolated(&self.state, dt)).flatten();
            let found = self
                .lagrange(dt, predictor.as_deref())
                .and_then(|found| self.stays_within(found))
                .and_then(|found| self.stands(dt, found));
            let complete = found.and_then(|found| timed(Activity::Transfer, || self.complete(dt, found)));
            match complete {
                Ok(complete) => break (dt, complete),
                Err(error) if error.kind == Kind::Analysis => {
                    if !begun.fresh {
                        // Reset a deformed grid before the step is halved.
                        let resets = self.state.restorations;
                        match timed(Activity::Transfer, || self.initialise(true)) {
                            Ok(anew) => begun = anew,
                            // The points fit no reset grid, but a smaller step may be found on this one.
                            Err(left) if left.kind == Kind::Analysis && self.state.restorations == resets => {
                                controller.halve(dt, left, self.grid.buffers.least)?;
                            }
                            Err(error) => return Err(error),
                        }
                    } else if predictor.is_none() || !self.grid.buffers.predicted {
                        // The iteration without the predictor has been tried.
                        let least = self.grid.buffers.least;
                        unbalanced::hold(self.scene, &mut self.grid, &mut self.state, dt)?;
                        controller.halve(dt, error, least)?;
                    }
                }
                // Other errors, such as too little memory, do not depend on the size of the step.
                Err(error) => return Err(error),
            }
        };
        self.note_search(dt, &complete.solution);
        if self.scene.numerics.restore == Restore::Never {
            // A smaller step would come to the same place.
            self.keeps_within(&complete.solution)?;
        }
        let easy = if complete.solution.follows { self.scene.numerics.max_iterations } else { control::EASY };
        let mut report = timed(Activity::Transfer, || self.convect(dt, complete));
        report.restored = self.state.restorations > before;
        report.unbalanced = begun.unbalanced;
        report.halvings = controller.accept(dt, report.iterations() <= easy);
        Ok(report)
    }

    /// Points to grid: resets the grid where that is due or `forced`.
    fn initialise(&mut self, forced: bool) -> Result<Begun> {
        let (scene, state) = (self.scene, &mut self.state);
        work::begin(scene, &mut self.grid, state)?;
        let moved = state.displacement.iter().flatten().any(|&u| u != 0.0);
        let held = !state.search_geometry.is_empty();
        let restore = match scene.numerics.restore {
            _ if held => false,
            _ if inflow::is_due(scene, state) || self.grid.has_outflow(scene, state) => true,
            Restore::EveryStep => true,
            Restore::Never => false,
            Restore::Quality { least, stretch } => {
                moved
                    && (forced
                        || distortion::exceeds(scene, state, &self.grid, least, stretch)
                        || distortion::closes(scene, state, &self.grid)
                        || obstacles::meets::<D, K>(scene, state, &self.grid))
            }
        };
        if restore {
            self.grid.restore::<K>(scene, state)?;
        }
        materials::project_pressure::<D, K>(scene, &self.grid, state);
        self.find_loads_and_contacts()?;
        let (scene, state) = (self.scene, &mut self.state);
        let begins = state.dynamic(scene) && !state.moving;
        if state.dynamic(scene) && (restore || !state.moving) {
            transfer::motion_to_grid::<D, K>(scene, &mut self.grid, state)?;
        }
        match (begins, restore) {
            (true, _) => work::note_motion(scene, &mut self.grid, state)?,
            (false, true) => work::note(scene, &mut self.grid, state, Item::Resets)?,
            (false, false) => {}
        }
        let mut unbalanced = false;
        if let Some(last) = state.balanced.filter(|_| restore && moved) {
            unbalanced = equilibrate::equilibrate(scene, &mut self.grid, state, last)?;
            work::note(scene, &mut self.grid, state, Item::Equilibration)?;
        }
        Ok(Begun { fresh: restore || !moved || held || scene.numerics.restore == Restore::Never, unbalanced })
    }

    /// Finds on the grid what a step depends on and the converged state alone tells: the material that forces act on, and the contacts.
    fn find_loads_and_contacts(&mut self) -> Result<()> {
        self.grid.loaded = traced::loaded(self.scene, &self.state);
        timed(Activity::Contact, || contact::begin::<D, K>(self.scene, &mut self.grid, &mut self.state))
    }

    /// Solves the step on the grid (eq. 1; with inertia eq. 6).
    fn lagrange(&mut self, dt: f64, predictor: Option<&[[f64; D]]>) -> Result<Lagrange<D>> {
        let (scene, state) = (self.scene, &self.state);
        let dynamic = state.dynamic(scene);
        let given = grid::given_increments(scene, state, &self.grid, dt);
        let mut start = if dynamic { Some(Start::of::<K>(scene, &mut self.grid, state, &given, dt)?) } else { None };
        if let Some(start) = &mut start {
            impulse::begin::<D, K>(scene, &mut self.grid, state, (start, &given), dt)?;
        }
        let problem = Problem { predictor, ..Problem::step(scene, state, start.as_ref(), &given, dt) };
        let solution = newton::solve(&problem, &mut self.grid)?;
        Ok((start, solution))
    }

    /// Rejects a solution that takes material across a side that holds it.
    fn keeps_within(&self, solution: &Solution<D>) -> Result<()> {
        let ends = solution.displacement.iter().zip(&self.state.displacement);
        let increment: Vec<[f64; D]> = ends.map(|(now, before)| std::array::from_fn(|d| now[d] - before[d])).collect();
        obstacles::check::<D, K>(self.scene, &self.state, &self.grid, &increment)
    }

    /// Rejects a solution that takes material across a side that holds it, which smaller steps may find; on a grid that is never reset
    /// they come to the same place.
    fn stays_within(&self, found: Lagrange<D>) -> Result<Lagrange<D>> {
        if self.scene.numerics.restore != Restore::Never {
            self.keeps_within(&found.1)?;
        }
        Ok(found)
    }

    /// What a solution of a step of `dt` (s) makes of points and energies, which is not yet written.
    ///
    /// # Errors
    /// Analysis: a point has no answer to it, or it creates energy.
    fn complete(&mut self, dt: f64, (start, mut solution): Lagrange<D>) -> Result<Complete<D>> {
        let (scene, grid, state) = (self.scene, &mut self.grid, &self.state);
        let answers = transfer::answers(scene, grid, state, &solution, dt)?;
        let done = work::Done::of(scene, grid, state, (&solution, start.as_ref()), answers.dissipated(), dt)?;
        let (mut by_contact, mut kinetic) = (Vec::new(), 0.0);
        if let Some(start) = &start {
            let given = grid::given_increments(scene, state, grid, dt);
            let problem = Problem::step(scene, state, Some(start), &given, dt);
            by_contact = impulse::release::<D, K>(&problem, grid, &mut solution)?;
            let velocity = transfer::end_velocity(scene, state, (start, &by_contact), &solution.displacement, dt);
            kinetic = balance::kinetic(scene, grid, state, &velocity)?;
        }
        let held = [kinetic, transfer::stored_after(scene, state, &answers)];
        let energies = done.close(state.energies.unwrap_or_default(), &solution.residual, held, state.in_play)?;
        Ok(Complete { start, solution, answers, by_contact, energies })
    }

    /// Grid to points (eq. 12): the converged solution becomes the state.
    fn convect(&mut self, dt: f64, complete: Complete<D>) -> Report<D> {
        let (scene, state) = (self.scene, &mut self.state);
        let Complete { start, mut solution, answers, by_contact, energies } = complete;
        (state.energies, state.in_play) = (Some(energies), state.in_play.max(energies.in_play()));
        rigid::follow(scene, state, &mut solution.displacement);
        grid::move_whole_curves(scene, state, &self.grid, dt, &mut solution.displacement);
        let mut momentum = report::Motion::of(state).linear;
        let content = water::content(scene, state);
        let drained = water::through_surfaces(scene, &self.grid, state, &solution, dt);
        let mut contacts =
            timed(Activity::Contact, || contact::commit(scene, &self.grid, state, (&solution, start.as_ref()), dt));
        let strained = transfer::commit::<D, K>(state, answers);
        let water = water::balance(scene, &self.grid, state, &content, &solution, drained);
        transfer::move_points::<D, K>(scene, &self.grid, state, &solution.displacement);
        if let Some(start) = &start {
            let impulse = start.impulse::<K>(scene, &self.grid, state);
            momentum = std::array::from_fn(|d| momentum[d] + impulse[d]);
            let moved = &solution.displacement;
            transfer::motion_to_points::<D, K>(scene, &self.grid, state, (start, &by_contact), moved, dt);
        }
        let traced = traced::increments(scene, state, &solution.displacement);
        state.increment.resize(solution.displacement.len(), [0.0; D]);
        let ends = solution.displacement.iter().zip(&state.displacement);
        for ((travel, increment), (now, before)) in state.travel.iter_mut().zip(&mut state.increment).zip(ends) {
            for d in 0..D {
                increment[d] = now[d] - before[d];
                travel[d] += increment[d];
            }
        }
        for (n, own) in traced {
            let n = n as usize;
            state.travel[n] = std::array::from_fn(|d| state.travel[n][d] - state.increment[n][d] + own[d]);
        }
        if dt > 0.0 {
            state.last_step = dt;
        }
        let balanced = start.is_none() && !scene.phases[state.phase].flows && dt > 0.0;
        state.balanced =
            balanced.then_some(Span { phase: state.phase, from: state.phase_time, to: state.phase_time + dt });
        state.displacement.clone_from(&solution.displacement);
        state.pressure.clone_from(&solution.pressure);
        if start.is_some() {
            state.moving = true;
            rigid::motion_to_points(scene, state);
        }
        timed(Activity::Contact, || contact::project_out(scene, state, &mut contacts));
        state.commit_bars(scene);
        inflow::count(scene, state, dt);
        state.step += 1;
        state.time += dt;
        state.phase_time += dt;
        if state.ramp.share(state.phase_time) == 0.0 {
            state.ramp = UnbalancedRamp::default();
        }
        let report =
            Report { contacts, water, strained, ..Report::new(scene, state, &self.grid, dt, solution, &momentum) };
        state.reaction.clone_from(&report.reaction);
        state.peak = state.peak.max(report.motion.kinetic);
        report
    }
}
