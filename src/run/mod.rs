//! A run: the phases of a scene from the first state, or a checkpoint, to the end, with everything it writes.
//!
//! | in the output folder | what |
//! |---|---|
//! | `results/frame-000123.mpmf` | the state at the times of output |
//! | `history.csv` | a row a step |
//! | `energy.csv` | the balance of energy, a row a step |
//! | `solve.log` | what every step did |
//! | `phases/` | the states at the ends of phases, which other runs may begin with |
//! | `checkpoints/` | what `--resume` continues from, after every step |
//!
//! The checkpoint of a step is written while the next one is solved.

mod accepted;
mod boundary;
mod bypassed;
pub mod checkpoint;
mod ending;
mod energy;
pub mod fields;
mod foreign;
mod internal_variables;
mod jump;
mod measured;
mod outputs;
mod outside;
mod record;
mod surface;
mod swelling;
mod values;
mod voids;
mod warning;
mod watch;
mod written;

pub use ending::Until;
pub use internal_variables::InternalVariable;
pub use outputs::Outputs;
pub use record::{Force, Side};
pub use surface::Acting;
pub use warning::WARNING;
pub use watch::{Place, Quantity, Watch, WatchedOn};

use crate::error::{Error, Kind, Result};
use crate::io::background::Background;
use crate::io::checkpoint::Checkpoints;
use crate::io::frame::{self, Frame};
use crate::io::hash;
use crate::io::history::{History, Log};
use crate::io::phase_state;
use crate::io::run_folder::RunFolder;
use crate::kinematics::Kinematics;
use crate::profile::{Activity, timed};
use crate::reading;
use crate::step::{Controller, Scene, Simulation, State};
use bypassed::Bypassed;
use foreign::{AFRESH, foreign};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use warning::Told;
use written::Written;

/// Jobs that may wait for the writer: the frame and the checkpoint of a step.
const QUEUE: usize = 2;

/// How far a run has come.
#[derive(Clone, Copy, Debug)]
pub struct Progress<'a> {
    pub phase: &'a str,
    /// Time (s) done and in all, over all phases.
    pub time: f64,
    pub end: f64,
    pub step: u64,
    /// A message worth a line of its own: a halving, a warning.
    pub note: Option<&'a str>,
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ended {
    Done,
    /// Stopped from outside; `--resume` continues.
    Stopped,
}

/// What a run begins with.
#[derive(Clone, Debug)]
pub struct First<const D: usize> {
    /// The state before the first step of all, with the points as seeded.
    pub seeded: State<D>,
    /// That in which the run begins in its place, where it goes on from another one.
    pub after: Option<State<D>>,
}

impl<const D: usize> From<State<D>> for First<D> {
    fn from(seeded: State<D>) -> Self {
        Self { seeded, after: None }
    }
}

/// Runs a scene.
///
/// It begins with the state in `first`; with `resume` the newest checkpoint takes its place, if there
/// is one. `stop` is polled between steps.
///
/// # Errors
/// `Analysis` when the analysis cannot go on (what was written stays), `Input` when a checkpoint does not
/// belong to the case, `Machine` when something cannot be written.
pub fn run<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    first: impl Into<First<D>>,
    outputs: &Outputs,
    resume: bool,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress),
) -> Result<Ended> {
    let checkpoints = Checkpoints::new(outputs.folder.checkpoints(), outputs.origin.run);
    let loaded = if resume { checkpoints.latest()? } else { None };
    let First { seeded, after } = first.into();
    let mut tell = |state: &State<D>, note: Option<&str>| {
        let phase = scene.phases.get(state.phase).map_or("done", |p| p.name.as_str());
        // Phases may have ended before their time.
        let left: f64 = scene.phases.iter().skip(state.phase).map(|p| p.duration).sum();
        let end = state.time + left - state.phase_time;
        progress(Progress { phase, time: state.time, end, step: state.step, note });
    };
    let (state, written) = match loaded {
        Some(mut loaded) => {
            let written = Written::take(&mut loaded.store)?;
            let state = checkpoint::take(loaded.store, scene, &seeded)?;
            for warning in &loaded.warnings {
                tell(&state, Some(warning));
            }
            (state, Some(written))
        }
        None => {
            let first = after.unwrap_or(seeded);
            if resume {
                tell(&first, Some("there is no checkpoint to continue from: the run begins afresh"));
            }
            (first, None)
        }
    };
    let begins = written.is_none();
    let mut files = Files::open(scene, outputs, checkpoints, &state, written)?;
    for warning in &outputs.warnings {
        tell(&state, Some(warning));
        if begins {
            files.log.line(warning)?;
        }
    }
    let mut simulation = Simulation::<D, K>::new(scene, state)?;
    tell(&simulation.state, None);
    if begins {
        record::of_reset(&simulation.state).try_for_each(|line| files.log.line(&line))?;
    }
    voids::begin(scene, &mut simulation.state);
    let mut bypassed = Bypassed::default();
    // Of a run that goes on.
    let log = if begins { String::new() } else { reading::text(&outputs.folder.log()).unwrap_or_default() };
    let mut told = Told::of(&log);
    if simulation.state.frames == 0 {
        files.frame(scene, &mut simulation.state)?;
    }
    while let Some(phase) = scene.phases.get(simulation.state.phase) {
        // The largest step may have been lowered since the checkpoint.
        let wanted = simulation.state.step_size.min(phase.step.max);
        let mut controller = Controller::new(phase.step, phase.stops.clone(), wanted);
        let number = simulation.state.phase;
        let until = outputs.until.get(number).map_or(&[][..], |until| until);
        let mut stays = false;
        bypassed.begin(scene, &simulation.state, outputs.surface.as_ref());
        if simulation.state.phase_time == 0.0 {
            jump::watch(scene, &mut simulation.state);
            let resets = simulation.state.restorations;
            let begun = simulation.begin_phase();
            let begun = begun.and_then(|notes| Ok((notes, ending::is_met_at_first(until, &mut simulation)?)));
            let notes;
            (notes, stays) = match begun {
                Ok(begun) => begun,
                Err(error) => return Err(files.fail(scene, &mut simulation.state, error)?),
            };
            let of_reset = record::of_reset(&simulation.state).filter(|_| simulation.state.restorations > resets);
            for note in notes.into_iter().chain(of_reset.collect::<Vec<_>>()) {
                tell(&simulation.state, Some(&note));
                files.log.line(&note)?;
            }
        }
        while simulation.state.phase == number {
            if stop.load(Ordering::Relaxed) {
                files.close()?;
                return Ok(Ended::Stopped);
            }
            let report = match simulation.advance(&mut controller) {
                Ok(report) => report,
                Err(error) if ending::falls(phase, &simulation.state, &controller) => {
                    let state = &mut simulation.state;
                    let note = ending::switch_to_dynamics(phase, state, &mut controller, &error);
                    jump::watch(scene, state);
                    tell(state, Some(&note));
                    files.log.line(&note)?;
                    continue;
                }
                Err(error) if ending::found_failure(phase, &simulation.state, &controller) => {
                    let state = &mut simulation.state;
                    let failed = phase.reduction_at(state.phase_time + controller.size(state.phase_time));
                    let note = format!("{}; it failed by: {error}", ending::safety(phase, state, Some(failed)));
                    tell(state, Some(&note));
                    timed(Activity::Output, || {
                        files.log.line(&ending::curve(phase, state))?;
                        files.history.again(record::NO_EQUILIBRIUM, failed)?;
                        files.end_early(scene, state, &note)
                    })?;
                    break;
                }
                Err(error) => {
                    let error = ending::in_time(error, scene, phase, &simulation.state);
                    return Err(files.fail(scene, &mut simulation.state, error)?);
                }
            };
            let still = match ending::is_still(until, &mut simulation, &report) {
                Ok(still) => still,
                Err(error) => return Err(files.fail(scene, &mut simulation.state, error)?),
            };
            let state = &mut simulation.state;
            state.step_size = controller.wanted;
            for reason in &report.halvings {
                tell(state, Some(&format!("step halved: {reason}")));
            }
            let written = timed(Activity::Output, || {
                let empty = files.step::<K>(scene, state, &report)?;
                if let Some(warning) = jump::found(scene, state) {
                    tell(state, Some(&warning));
                    files.log.line(&warning)?;
                }
                let met = ending::met::<D, K>(until, &outputs.watches, scene, state, &report)
                    .or_else(|| stays.then(|| ending::at_first(phase)))
                    .or_else(|| still.then(|| ending::at_rest(phase, &report)));
                let ends = met.is_some() || controller.next_stop(state.phase_time).is_none();
                let mut warnings = empty;
                warnings.extend(bypassed.found(scene, state, &report, outputs.surface.as_ref()));
                warnings.extend(swelling::found(scene, state));
                warnings.extend(outside::found(scene, state));
                warnings.extend(energy::found(scene, state, &report, ends));
                warnings.extend(accepted::found(scene, state, &report));
                for warning in warnings.iter().filter(|warning| told.is_new(warning)) {
                    tell(state, Some(warning));
                    files.log.line(warning)?;
                }
                for line in voids::found(scene, state, &report) {
                    if line.starts_with(WARNING) {
                        tell(state, Some(&line));
                    }
                    files.log.line(&line)?;
                }
                if let Some(note) = met.filter(|_| controller.next_stop(state.phase_time).is_some()) {
                    tell(state, Some(&note));
                    return files.end_early(scene, state, &note);
                }
                if let Some(note) = ending::switch_to_quasi_static(phase, until, state, &report, &mut controller) {
                    tell(state, Some(&note));
                    files.log.line(&note)?;
                    jump::watch(scene, state);
                    state.step_size = controller.wanted;
                }
                if controller.stop_at(state.phase_time).is_some_and(|s| s.frame) {
                    files.frame(scene, state)?;
                }
                if controller.next_stop(state.phase_time).is_none() {
                    if phase.search.is_some() {
                        let note = ending::safety(phase, state, None);
                        tell(state, Some(&note));
                        files.log.line(&ending::curve(phase, state))?;
                        files.log.line(&note)?;
                    }
                    files.end_of_phase(state)?;
                    state.next_phase(scene);
                }
                files.checkpoint(state)
            });
            match written {
                // A value that is not finite.
                Err(error) if error.kind == Kind::Analysis => return Err(files.fail(scene, state, error)?),
                written => written?,
            }
            tell(state, None);
        }
    }
    files.close()?;
    Ok(Ended::Done)
}

/// The open files of a run.
struct Files<'a, const D: usize> {
    outputs: &'a Outputs,
    checkpoints: Checkpoints,
    history: History,
    energy: History,
    log: Log,
    writer: Background,
    /// The hashes of the frames that the writer has written.
    frames: Arc<Mutex<Vec<u64>>>,
    /// The step of the last frame handed to the writer.
    framed: Option<u64>,
}

impl<'a, const D: usize> Files<'a, D> {
    fn open(
        scene: &Scene<D>,
        outputs: &'a Outputs,
        checkpoints: Checkpoints,
        state: &State<D>,
        written: Option<Written>,
    ) -> Result<Self> {
        let folder = &outputs.folder;
        let columns = record::columns(scene, &outputs.watches);
        let of_energy = record::energy_columns();
        let (history, energy, log) = (folder.history(), folder.energy(), folder.log());
        let (history, energy, log, frames) = match written {
            Some(Written { history: rows, energy: balances, log: lines, frames }) => {
                check_frames(folder, &frames, state.frames)?;
                let history = History::resume(&history, &columns, rows)?;
                (history, History::resume(&energy, &of_energy, balances)?, Log::resume(&log, lines)?, frames)
            }
            None => {
                checkpoints.clear()?;
                phase_state::begin(&folder.phases())?;
                let mut log = Log::create(&log)?;
                for line in record::heading(scene, &state.points) {
                    log.line(&line)?;
                }
                (History::create(&history, &columns)?, History::create(&energy, &of_energy)?, log, Vec::new())
            }
        };
        frame::prepare(&folder.results(), frames.len())?;
        let last = frames.len().checked_sub(1).map(|last| Frame::read(&frame::path(&folder.results(), last)));
        let framed = last.transpose()?.map(|frame| frame.step);
        let frames = Arc::new(Mutex::new(frames));
        Ok(Self { outputs, checkpoints, history, energy, log, writer: Background::start(QUEUE)?, frames, framed })
    }

    /// Notes a converged step, once the checkpoint of the step before is written: a kill loses the step in hand,
    /// and the one before it only in the moment in which its checkpoint is being written.
    /// Returns the warnings of what has no value.
    fn step<K: Kinematics<D>>(
        &mut self,
        scene: &Scene<D>,
        state: &State<D>,
        report: &crate::step::Report<D>,
    ) -> Result<Vec<String>> {
        self.writer.flush()?;
        for line in record::log_lines(scene, state, report) {
            self.log.line(&line)?;
        }
        self.energy.row(&record::energy_row(state))?;
        let row = record::row::<D, K>(scene, &self.outputs.watches, state, report);
        self.history.row(&row)?;
        Ok(measured::found(&self.outputs.watches, &row, state.time))
    }

    /// Ends a phase before its time, with the reason, in the last converged state.
    fn end_early(&mut self, scene: &Scene<D>, state: &mut State<D>, note: &str) -> Result<()> {
        self.log.line(note)?;
        self.last_frame(scene, state)?;
        self.end_of_phase(state)?;
        state.next_phase(scene);
        self.checkpoint(state)
    }

    /// Hands the state at the end of a phase to the writer, before the next one begins.
    fn end_of_phase(&mut self, state: &State<D>) -> Result<()> {
        let Some(Some(end)) = self.outputs.ends.get(state.phase).cloned() else { return Ok(()) };
        let (folder, number) = (self.outputs.folder.phases(), state.phase);
        let store = checkpoint::put(phase_state::store(), state)?;
        self.writer.submit(move || phase_state::save(&folder, number, &end, store))
    }

    /// Hands a frame to the writer.
    fn frame(&mut self, scene: &Scene<D>, state: &mut State<D>) -> Result<()> {
        let frame =
            record::frame(scene, state, &self.outputs.fields, self.outputs.origin, self.outputs.surface.as_ref());
        let (folder, frames, index) = (self.outputs.folder.results(), Arc::clone(&self.frames), state.frames as usize);
        state.frames += 1;
        self.framed = Some(state.step);
        self.writer.submit(move || {
            let hash = frame.write(&folder, index)?;
            frames.lock().unwrap_or_else(PoisonError::into_inner).push(hash);
            Ok(())
        })
    }

    /// Hands a frame of the last converged step to the writer, unless it has it. At the end of an analysis that cannot go on no checkpoint
    /// knows of it, so a run that continues writes over it.
    fn last_frame(&mut self, scene: &Scene<D>, state: &mut State<D>) -> Result<()> {
        if self.framed == Some(state.step) { Ok(()) } else { self.frame(scene, state) }
    }

    /// Ends an analysis that cannot go on, and hands its error back.
    fn fail(mut self, scene: &Scene<D>, state: &mut State<D>, error: Error) -> Result<Error> {
        self.log.line(&format!("the analysis ends here: {error}"))?;
        self.last_frame(scene, state)?;
        self.close()?;
        Ok(error)
    }

    /// Hands a checkpoint to the writer.
    fn checkpoint(&mut self, state: &State<D>) -> Result<()> {
        let (checkpoints, step, mut store) =
            (self.checkpoints.clone(), state.step, checkpoint::put(Checkpoints::store(), state)?);
        let (history, energy, log) = (self.history.mark(), self.energy.mark(), self.log.mark());
        let frames = Arc::clone(&self.frames);
        self.writer.submit(move || {
            // The frames before it are written by now.
            let frames = frames.lock().unwrap_or_else(PoisonError::into_inner).clone();
            Written { history, energy, log, frames }.put(&mut store);
            checkpoints.save(step, store)
        })
    }

    /// Waits for the writer.
    fn close(self) -> Result<()> {
        timed(Activity::Output, || self.writer.close())
    }
}

/// Refuses frames that are not those that the run wrote.
fn check_frames(folder: &RunFolder, known: &[u64], count: u64) -> Result<()> {
    if known.len() as u64 != count {
        return Err(foreign("its list of frames"));
    }
    let paths: Vec<_> = (0..known.len()).map(|index| frame::path(&folder.results(), index)).collect();
    let hashes = hash::files(&paths, AFRESH)?;
    match hashes.iter().zip(known).position(|(hash, known)| hash != known) {
        Some(i) => Err(Error::input(paths[i].display(), "was changed after it was written", AFRESH)),
        None => Ok(()),
    }
}
