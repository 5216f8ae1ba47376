//! `mpm solve`: from `mesh.msh` and `points.vtu` to results, history, log and checkpoints.

use super::args::StageArgs;
use super::print::{Outcome, note, print};
use super::stage::{Inputs, Stage};
use super::{mesh, seed, signals};
use crate::case::raw::Product;
use crate::case::scene::{self, Begin};
use crate::case::{Loaded, start};
use crate::error::{Error, Kind, Result, plain_lines};
use crate::io::checkpoint::Checkpoints;
use crate::io::hash;
use crate::io::phase_state::{self, End};
use crate::io::points_vtu::{self, Seeded};
use crate::io::provenance::{Origin, Record};
use crate::io::run_folder::{RunFolder, STAGE, Standing};
use crate::points::Points;
use crate::profile::{self, Activity};
use crate::reading;
use crate::run::{self, Ended, Progress};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::path::PathBuf;
use std::time::{Duration, Instant};

#[derive(clap::Args, Clone)]
pub struct Args {
    #[command(flatten)]
    pub stage: StageArgs,
    #[command(flatten)]
    pub start: Start,
}

/// What becomes of a run that was not finished.
#[derive(clap::Args, Clone, Copy)]
pub struct Start {
    /// Continue from the newest checkpoint, if there is one
    #[arg(long)]
    pub resume: bool,
    /// Begin anew, and give up a run that could be continued
    #[arg(long, conflicts_with = "resume")]
    pub fresh: bool,
}

pub fn run(args: &Args) -> Outcome {
    work(&Stage::open(&args.stage)?, args.start)
}

/// Whether the results are there and would come out the same.
///
/// # Errors
/// A `mesh.msh` or `points.vtu` that cannot be read.
pub fn is_current(stage: &Stage) -> Result<bool> {
    Ok(inputs(stage)?.are_current(stage.folder(), &stage.runs().main.outputs()?))
}

/// Whether there is a run of this very case that was not finished, with a checkpoint to continue from.
///
/// # Errors
/// Files that cannot be read.
pub fn can_resume(stage: &Stage) -> Result<bool> {
    let files = files(stage);
    if !files.iter().all(|file| file.exists()) {
        return Ok(false);
    }
    let run = stage.fingerprint(&files)?;
    let runs = stage.runs();
    Ok(runs.unfinished()?.is_some_and(|folder| Checkpoints::new(folder.checkpoints(), run).can_resume()))
}

/// Solves, with progress on a terminal and plain lines elsewhere.
///
/// Results that are there stay until the run is finished; one that could be continued is given up only by request.
pub fn work(stage: &Stage, start: Start) -> Outcome {
    stage.lock()?;
    let mesh = mesh::read(stage)?;
    let Seeded { points, regions, source } = points_vtu::read::<2>(&stage.points())?;
    let run = stage.fingerprint(&files(stage))?;
    let origin = Origin { run, mesh: hash::file(&stage.mesh(), "run `mpm mesh` first")? };
    if start.resume {
        check_checkpoints(stage, origin)?;
    }
    if let Some(start) = stage.loaded.source.start() {
        check_start(&start.end, origin.mesh, &points)?;
    }
    let foreign = |problem| Err(vec![Error::input(stage.points().display(), problem, "run `mpm seed` again")]);
    let expected = seed::source(stage)?;
    if regions != mesh.regions || source.mesh != expected.mesh {
        return foreign("its points were seeded in another mesh.msh");
    }
    if source.case != expected.case {
        return foreign("its points were seeded for other entries of the case (regions, materials, initial state)");
    }
    let inputs = inputs(stage)?;
    stage.prepare()?;
    let Some((folder, mut record)) = choose(stage, start, origin, &inputs)? else {
        return print("solve: the run is finished, there is nothing to continue\n");
    };
    record.write(folder.path())?;
    // A first Ctrl-C (or SIGTERM) ends the run after the step in hand, a second one at once.
    let _caught = signals::catch()?;
    let began = Instant::now();
    let mut meter = Meter::new();
    let Loaded { case, source } = &stage.loaded;
    let ends = start::ends(source.tree(), source.start(), [origin.mesh, phase_state::hash_of(&points)]);
    let begin = Begin { origin, ends, start: source.start(), resume: start.resume };
    let ended = scene::solve(case, mesh, points, &folder, begin, signals::stop(), &mut |p| meter.show(&p));
    meter.finish();
    // What an analysis that could not go on took is told, too; one that never began took nothing.
    let told = match &ended {
        Err(e) if e.kind != Kind::Analysis => Ok(()),
        ended => print(&summary(began.elapsed(), matches!(ended, Ok(Ended::Done)))),
    };
    tell_earlier(&folder);
    match &ended {
        Ok(Ended::Done) => record.finish(folder.path(), &folder.outputs()?)?,
        Ok(Ended::Stopped) => record.interrupt("stopped by the user"),
        Err(e) => record.interrupt(&e.to_string()),
    }
    record.write(folder.path())?;
    if !stage.runs().settle(&folder)? {
        let (results, beside) = (stage.folder().display(), folder.path().display());
        note(&format!("{results}: the earlier results are as they were; what this run has is in {beside}"));
    }
    match ended? {
        Ended::Stopped => {
            let remedy = "continue it with `--resume`";
            Err(vec![Error::interrupted("the run was stopped after the step in hand", remedy)])
        }
        Ended::Done => told,
    }
}

/// Refuses to continue a run of another case, before anything is written.
fn check_checkpoints(stage: &Stage, origin: Origin) -> Result<()> {
    let runs = stage.runs();
    let run = runs.unfinished()?.unwrap_or(&runs.main);
    Checkpoints::new(run.checkpoints(), origin.run).latest().map(drop)
}

/// The folder of the run and its record; none where the run that was to be continued is finished.
fn choose(stage: &Stage, start: Start, origin: Origin, inputs: &Inputs) -> Result<Option<(RunFolder, Record)>> {
    let runs = stage.runs();
    let unfinished = runs.unfinished()?;
    match unfinished {
        Some(run) if start.resume && run.has_checkpoints()? => {
            let mut record = run.record().unwrap_or_else(|| inputs.begin());
            record.go_on();
            return Ok(Some((run.clone(), record)));
        }
        Some(run) if !start.fresh && Checkpoints::new(run.checkpoints(), origin.run).can_resume() => {
            return Err(Error::input(
                run.path().display(),
                "a run of this case was not finished, and can be continued",
                "continue it with `--resume`, or begin anew with `--fresh`",
            ));
        }
        None if start.resume && runs.main.standing()? == Standing::Finished && runs.main.has_checkpoints()? => {
            if let Some(place) = runs.main.changed()? {
                let remedy = "begin anew with `--fresh`";
                return Err(Error::input(place.display(), "it is not as the run left it", remedy));
            }
            let loaded = Checkpoints::new(runs.main.checkpoints(), origin.run).latest()?;
            return Ok(match (loaded, runs.main.record()) {
                // The last checkpoint is damaged: what came after the one before is done again.
                (Some(loaded), Some(mut record)) if !loaded.warnings.is_empty() => {
                    record.go_on();
                    Some((runs.main.clone(), record))
                }
                _ => None,
            });
        }
        _ => {}
    }
    Ok(Some((runs.start()?.clone(), inputs.begin())))
}

fn inputs(stage: &Stage) -> Result<Inputs> {
    stage.inputs(STAGE, Product::Results, &files(stage))
}

/// The files that the run is made from.
fn files(stage: &Stage) -> Vec<PathBuf> {
    let start = stage.loaded.source.start().map(|start| start.path.clone());
    [stage.mesh(), stage.points()].into_iter().chain(start).collect()
}

/// Refuses a mesh and points that are not those of the run that the case goes on from.
fn check_start(end: &End, mesh: u64, points: &Points<2>) -> Result<()> {
    let what = if end.mesh != hash::text(mesh) {
        ("mesh", "make the `.geo` and `mesh` of the case those of that run, or solve it again with this mesh")
    } else if end.points != hash::text(phase_state::hash_of(points)) {
        ("points", "make `regions` those of that run, or solve it again with these points")
    } else {
        return Ok(());
    };
    let problem = format!("the run that the case goes on from had another {}", what.0);
    Err(Error::input(start::KEY, problem, what.1))
}

/// The wall time and where it went, whether the run is `done` or came to an end before.
fn summary(elapsed: Duration, done: bool) -> String {
    let all = elapsed.as_secs_f64();
    let percent = |seconds: f64| format!("{:.0} %", 100.0 * seconds / all);
    // Without contact there is none to speak of.
    let spent = |a: &&Activity| **a != Activity::Contact || profile::seconds(**a) > 0.0;
    let share = |&a: &Activity| format!("{} {}", format!("{a:?}").to_lowercase(), percent(profile::seconds(a)));
    let shares: Vec<String> = Activity::ALL.iter().filter(spent).map(share).collect();
    let booked: f64 = Activity::ALL.iter().map(|&a| profile::seconds(a)).sum();
    let system = profile::largest_system().map_or_else(String::new, |(equations, entries)| {
        format!("; largest system {equations} equations, {entries:.1} nonzeros a row")
    });
    format!(
        "{} {all:.2} s: {}, other {}; material, within assembly, {}{system}\n",
        if done { "solved in" } else { "ended after" },
        shares.join(", "),
        percent((all - booked).max(0.0)),
        percent(profile::material_seconds())
    )
}

/// Tells the warnings of the run that were those of a process before.
fn tell_earlier(folder: &RunFolder) {
    let Ok(log) = reading::text(&folder.log()) else { return };
    log.lines().filter(|line| line.starts_with(run::WARNING)).for_each(note);
}

/// Seconds between lines where there is no terminal.
const INTERVAL: f64 = 10.0;

/// The seconds that a run may still take, given those since this process went on with it and its times (s) then, now and at its end: what
/// was done before says nothing of this machine.
fn left(elapsed: f64, [from, now, end]: [f64; 3]) -> Option<f64> {
    (now > from).then(|| elapsed * (end - now) / (now - from))
}

/// Shows how far a run has come.
struct Meter {
    bar: Option<ProgressBar>,
    start: Instant,
    /// When a line is due.
    due: f64,
    /// When this process began with its first step, and at which time (s) of the run.
    from: Option<(Instant, f64)>,
}

impl Meter {
    fn new() -> Self {
        // A terminal that cannot go back to the beginning of a line gets plain lines, too.
        let can_draw = std::io::stderr().is_terminal() && std::env::var_os("TERM").is_none_or(|term| term != "dumb");
        let bar = can_draw.then(|| {
            let style = ProgressStyle::with_template("{bar:40} {percent:>3} % {msg}");
            ProgressBar::new(1000).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
        });
        Self { bar, start: Instant::now(), due: INTERVAL, from: None }
    }

    fn show(&mut self, p: &Progress) {
        let (begun, from) = *self.from.get_or_insert_with(|| (Instant::now(), p.time));
        let elapsed = self.start.elapsed().as_secs_f64();
        let left = left(begun.elapsed().as_secs_f64(), [from, p.time, p.end]);
        let left = left.map_or_else(String::new, |left| format!(", about {left:.0} s left"));
        // The end is a sum of durations.
        let end = format!("{:.4}", p.end);
        let end = end.trim_end_matches('0').trim_end_matches('.');
        let line = format!("step {}, {} t = {:.4} of {end} s{left}", p.step, p.phase, p.time);
        match (&self.bar, p.note) {
            (Some(bar), Some(line)) => bar.suspend(|| note(line)),
            (Some(bar), None) => {
                bar.set_position((1000.0 * p.time / p.end) as u64);
                bar.set_message(plain_lines(&line).into_owned());
            }
            (None, Some(line)) => note(line),
            (None, None) if elapsed >= self.due => {
                self.due = elapsed + INTERVAL;
                note(&line);
            }
            (None, None) => {}
        }
    }

    fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::left;

    #[test]
    fn what_is_left_is_told_by_the_work_of_this_process() {
        // Continued at 6 s of 10: 1 s more took 5 s.
        assert_eq!(left(5.0, [6.0, 7.0, 10.0]), Some(15.0));
        assert_eq!(left(5.0, [0.0, 7.5, 10.0]), Some(5.0 / 3.0));
        assert_eq!(left(5.0, [6.0, 6.0, 10.0]), None);
    }
}
