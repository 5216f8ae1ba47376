//! A run: the phases of a scene from the first state, or a checkpoint, to the end, with everything it writes.
//!
//! | in the output folder | what |
//! |---|---|
//! | `results/frame-000123.mpmf` | the state at the times of output |
//! | `history.csv` | a row a step |
//! | `solve.log` | what every step did |
//! | `checkpoints/` | what `--resume` continues from, after every step |
//!
//! The checkpoint of a step is written while the next one is solved.

mod boundary;
pub mod checkpoint;
mod ending;
mod record;
mod surface;

pub use ending::Until;
pub use record::{Field, Quantity, Watch, WatchedOn};
pub use surface::Acting;

use crate::error::{Error, Result};
use crate::io::atomic;
use crate::io::background::Background;
use crate::io::checkpoint::{Checkpoints, Fingerprint};
use crate::io::frame::{self, Frame};
use crate::io::history::{History, Log};
use crate::kinematics::Kinematics;
use crate::profile::{Activity, timed};
use crate::step::{Controller, Limits, Scene, Simulation, State};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Jobs that may wait for the writer: the frame and the checkpoint of a step.
const QUEUE: usize = 2;

/// What a run writes, and where.
#[derive(Clone, Debug)]
pub struct Outputs {
    pub folder: PathBuf,
    pub fields: Vec<Field>,
    pub watches: Vec<Watch>,
    /// What ends each phase before its time.
    pub until: Vec<Vec<Until>>,
    /// What acts on the surface of the material, where that is shown.
    pub surface: Option<Acting>,
    /// Tells whether a checkpoint belongs to the case.
    pub fingerprint: Fingerprint,
}

impl Outputs {
    pub fn results(&self) -> PathBuf {
        self.folder.join("results")
    }
}

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

/// Runs a scene.
///
/// `first` is the state before the first step; with `resume` the newest checkpoint takes its place, if there
/// is one. `stop` is polled between steps.
///
/// # Errors
/// `Analysis` when the analysis cannot go on (what was written stays), `Input` when a checkpoint does not
/// belong to the case, `Machine` when something cannot be written.
pub fn run<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    first: State<D>,
    outputs: &Outputs,
    resume: bool,
    stop: &AtomicBool,
    progress: &mut dyn FnMut(Progress),
) -> Result<Ended> {
    let checkpoints = Checkpoints::new(outputs.folder.join("checkpoints"), outputs.fingerprint);
    let loaded = if resume { checkpoints.latest()? } else { None };
    let end: f64 = scene.phases.iter().map(|p| p.duration).sum();
    let mut tell = |state: &State<D>, note: Option<&str>| {
        let phase = scene.phases.get(state.phase).map_or("done", |p| p.name.as_str());
        progress(Progress { phase, time: state.time, end, step: state.step, note });
    };
    let state = match loaded {
        Some(loaded) => {
            let state = checkpoint::take(loaded.store, scene, &first)?;
            for warning in &loaded.warnings {
                tell(&state, Some(warning));
            }
            state
        }
        None => {
            if resume {
                tell(&first, Some("there is no checkpoint to continue from: the run begins afresh"));
            }
            first
        }
    };
    let mut files = Files::open(scene, outputs, checkpoints, &state)?;
    let mut simulation = Simulation::<D, K>::new(scene, state)?;
    if simulation.state.step == 0 && simulation.state.frames == 0 {
        files.frame(scene, &mut simulation.state)?;
    }
    while let Some(phase) = scene.phases.get(simulation.state.phase) {
        let limits = Limits { least: phase.least_step, largest: phase.largest_step };
        // The largest step may have been lowered since the checkpoint.
        let wanted = simulation.state.step_size.min(limits.largest);
        let mut controller = Controller::new(limits, phase.stops.clone(), wanted);
        if simulation.state.phase_time == 0.0 {
            let notes = match simulation.notes() {
                Ok(notes) => notes,
                Err(error) => return Err(files.fail(scene, &mut simulation.state, error)?),
            };
            for note in notes {
                tell(&simulation.state, Some(&note));
                files.log.line(&note)?;
            }
        }
        let number = simulation.state.phase;
        while simulation.state.phase == number {
            if stop.load(Ordering::Relaxed) {
                files.close()?;
                return Ok(Ended::Stopped);
            }
            let report = match simulation.advance(&mut controller) {
                Ok(report) => report,
                Err(error) if ending::falls(phase, &simulation.state, &controller) => {
                    let state = &mut simulation.state;
                    let note = ending::let_fall(phase, state, &mut controller, &error);
                    tell(state, Some(&note));
                    files.note(state, &note)?;
                    continue;
                }
                Err(error) if ending::found_failure(phase, &simulation.state, &controller) => {
                    let state = &mut simulation.state;
                    let failed = phase.reduction_at(state.phase_time + controller.size(state.phase_time));
                    let note = format!("{}; it failed by: {error}", ending::safety(phase, state, Some(failed)));
                    tell(state, Some(&note));
                    timed(Activity::Output, || {
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
            let state = &mut simulation.state;
            state.step_size = controller.wanted;
            for reason in &report.halvings {
                tell(state, Some(&format!("step halved: {reason}")));
            }
            timed(Activity::Output, || {
                files.step(scene, state, &report)?;
                let until = outputs.until.get(number).map_or(&[][..], |until| until);
                let met = ending::met(until, &outputs.watches, scene, state, &report);
                if let Some(note) = met.filter(|_| controller.next_stop(state.phase_time).is_some()) {
                    tell(state, Some(&note));
                    return files.end_early(scene, state, &note);
                }
                if let Some(note) = ending::let_rest(phase, until, state, &report, &mut controller) {
                    tell(state, Some(&note));
                    files.note(state, &note)?;
                    state.step_size = controller.wanted;
                }
                if controller.stop_at(state.phase_time).is_some_and(|s| s.frame) {
                    files.frame(scene, state)?;
                }
                if controller.next_stop(state.phase_time).is_none() {
                    if phase.search.is_some() {
                        let note = ending::safety(phase, state, None);
                        tell(state, Some(&note));
                        files.note(state, &note)?;
                    }
                    state.next_phase(scene);
                }
                files.checkpoint(state)
            })?;
            tell(state, None);
        }
    }
    files.close()?;
    Ok(Ended::Done)
}

/// The open files of a run.
struct Files<'a> {
    outputs: &'a Outputs,
    checkpoints: Checkpoints,
    history: History,
    log: Log,
    writer: Background,
    /// The step of the last frame handed to the writer.
    framed: Option<u64>,
}

impl<'a> Files<'a> {
    fn open<const D: usize>(
        scene: &Scene<D>,
        outputs: &'a Outputs,
        checkpoints: Checkpoints,
        state: &State<D>,
    ) -> Result<Self> {
        let folder: &Path = &outputs.folder;
        atomic::prepare_folder(folder)?;
        let columns = record::columns(scene, &outputs.watches);
        let (history, log) = (folder.join("history.csv"), folder.join("solve.log"));
        let (history, log) = if state.step > 0 {
            (History::resume(&history, &columns, state.rows)?, Log::resume(&log, state.log_lines)?)
        } else {
            checkpoints.clear()?;
            let mut log = Log::create(&log)?;
            for line in record::heading(scene, &state.points) {
                log.line(&line)?;
            }
            (History::create(&history, &columns)?, log)
        };
        let (results, frames) = (outputs.results(), usize::try_from(state.frames).unwrap_or(usize::MAX));
        frame::prepare(&results, frames)?;
        // One that is gone is no reason not to go on.
        let last = frames.checked_sub(1).and_then(|last| Frame::read(&frame::path(&results, last)).ok());
        let framed = last.map(|frame| frame.step);
        Ok(Self { outputs, checkpoints, history, log, writer: Background::start(QUEUE)?, framed })
    }

    /// Notes a converged step, once the checkpoint of the step before is written: a kill loses the step in hand,
    /// and the one before it only in the moment in which its checkpoint is being written.
    fn step<const D: usize>(
        &mut self,
        scene: &Scene<D>,
        state: &mut State<D>,
        report: &crate::step::Report<D>,
    ) -> Result<()> {
        self.writer.flush()?;
        for line in record::log_lines(scene, state, report) {
            self.log.line(&line)?;
        }
        self.history.row(&record::row(scene, &self.outputs.watches, state, report))?;
        (state.rows, state.log_lines) = (self.history.rows(), self.log.lines());
        Ok(())
    }

    /// Writes a line into the log.
    fn note<const D: usize>(&mut self, state: &mut State<D>, note: &str) -> Result<()> {
        self.log.line(note)?;
        state.log_lines = self.log.lines();
        Ok(())
    }

    /// Ends a phase before its time, with the reason, in the last converged state.
    fn end_early<const D: usize>(&mut self, scene: &Scene<D>, state: &mut State<D>, note: &str) -> Result<()> {
        self.note(state, note)?;
        state.rows = self.history.rows();
        if self.framed != Some(state.step) {
            self.frame(scene, state)?;
        }
        state.next_phase(scene);
        self.checkpoint(state)
    }

    /// Hands a frame to the writer.
    fn frame<const D: usize>(&mut self, scene: &Scene<D>, state: &mut State<D>) -> Result<()> {
        let frame = record::frame(scene, state, self.outputs);
        let (folder, index) = (self.outputs.results(), state.frames as usize);
        state.frames += 1;
        self.framed = Some(state.step);
        self.writer.submit(move || frame.write(&folder, index))
    }

    /// Hands a frame of the last converged step to the writer, unless it has it: what an analysis that cannot go
    /// on came to. No checkpoint knows of it, so a run that continues writes over it.
    fn last_frame<const D: usize>(&mut self, scene: &Scene<D>, state: &mut State<D>) -> Result<()> {
        if self.framed == Some(state.step) { Ok(()) } else { self.frame(scene, state) }
    }

    /// Ends an analysis that cannot go on, and hands its error back.
    fn fail<const D: usize>(mut self, scene: &Scene<D>, state: &mut State<D>, error: Error) -> Result<Error> {
        self.log.line(&format!("the analysis ends here: {error}"))?;
        self.last_frame(scene, state)?;
        self.close()?;
        Ok(error)
    }

    /// Hands a checkpoint to the writer.
    fn checkpoint<const D: usize>(&mut self, state: &State<D>) -> Result<()> {
        let (checkpoints, step, store) = (self.checkpoints.clone(), state.step, checkpoint::store(state));
        self.writer.submit(move || checkpoints.save(step, store))
    }

    /// Waits for the writer.
    fn close(self) -> Result<()> {
        timed(Activity::Output, || self.writer.close())
    }
}

/// The error of a checkpoint whose arrays do not fit the scene.
fn foreign(what: &str) -> Error {
    Error::input(
        "checkpoint",
        format!("{what} does not fit the mesh and the points"),
        "start the analysis afresh, without --resume",
    )
}
