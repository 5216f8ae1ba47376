//! `mpm solve`: from `mesh.msh` and `points.vtu` to results, history, log and checkpoints.

use super::stage::{Stage, Stamp};
use super::{Outcome, StageArgs, mesh, print, signals};
use crate::case::scene;
use crate::error::{Error, Kind, Result};
use crate::io::points_vtu;
use crate::profile::{self, Activity};
use crate::run::{Ended, Progress};
use indicatif::{ProgressBar, ProgressStyle};
use std::io::IsTerminal;
use std::time::{Duration, Instant};

/// The entries of the case that results depend on, beside those that shaped the points.
const KEYS: [&str; 11] = [
    "geometry",
    "regions",
    "materials",
    "contacts",
    "supports",
    "gravity",
    "water",
    "drained_surface",
    "numerics",
    "phases",
    "output",
];

#[derive(clap::Args, Clone)]
pub struct Args {
    #[command(flatten)]
    pub stage: StageArgs,
    /// Continue from the newest checkpoint, if there is one
    #[arg(long)]
    pub resume: bool,
}

pub fn run(args: &Args) -> Outcome {
    work(&Stage::open(&args.stage)?, args.resume)
}

/// Whether the results are there and would come out the same.
///
/// # Errors
/// A `mesh.msh` or `points.vtu` that cannot be read.
pub fn is_current(stage: &Stage) -> Result<bool> {
    Ok(stamp(stage)?.is_current(&[stage.history()]))
}

/// Solves, with progress on a terminal and plain lines elsewhere.
pub fn work(stage: &Stage, resume: bool) -> Outcome {
    let case = &stage.loaded.case;
    let mesh = mesh::read(stage)?;
    let (points, regions) = points_vtu::read::<2>(&stage.points())?;
    if regions != mesh.regions {
        let remedy = "run `mpm seed` again";
        return Err(vec![Error::input(stage.points().display(), "its regions are not those of mesh.msh", remedy)]);
    }
    let stamp = stamp(stage)?;
    let fingerprint = stage.fingerprint(&KEYS, &[stage.mesh(), stage.points()])?;
    stage.prepare()?;
    // A first Ctrl-C (or SIGTERM) ends the run after the step in hand, a second one at once.
    let _caught = signals::catch()?;
    let start = Instant::now();
    let mut meter = Meter::new();
    let folder = stage.folder();
    let ended = scene::solve(case, mesh, points, folder, fingerprint, resume, signals::stop(), &mut |p| meter.show(&p));
    meter.finish();
    // What an analysis that could not go on took is told, too; one that never began took nothing.
    let told = match &ended {
        Err(e) if e.kind != Kind::Analysis => Ok(()),
        ended => print(&summary(start.elapsed(), matches!(ended, Ok(Ended::Done)))),
    };
    let ended = ended?;
    told?;
    match ended {
        Ended::Stopped => {
            Err(vec![Error::interrupted("the run was stopped after the step in hand", "continue it with `--resume`")])
        }
        Ended::Done => {
            stamp.write(&[stage.history()])?;
            Ok(())
        }
    }
}

fn stamp(stage: &Stage) -> Result<Stamp> {
    stage.stamp("solve", &KEYS, &[stage.mesh(), stage.points()])
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
    format!(
        "{} {all:.2} s: {}, other {}; material, within assembly, {}\n",
        if done { "solved in" } else { "ended after" },
        shares.join(", "),
        percent((all - booked).max(0.0)),
        percent(profile::material_seconds())
    )
}

/// Seconds between lines where there is no terminal.
const INTERVAL: f64 = 10.0;

/// Shows how far a run has come.
struct Meter {
    bar: Option<ProgressBar>,
    start: Instant,
    /// When a line is due, and the time (s) of the run when it was taken up.
    due: f64,
    from: Option<f64>,
}

impl Meter {
    fn new() -> Self {
        let bar = std::io::stderr().is_terminal().then(|| {
            let style = ProgressStyle::with_template("{bar:40} {percent:>3} % {msg}");
            ProgressBar::new(1000).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
        });
        Self { bar, start: Instant::now(), due: INTERVAL, from: None }
    }

    fn show(&mut self, p: &Progress) {
        let from = *self.from.get_or_insert(p.time);
        let elapsed = self.start.elapsed().as_secs_f64();
        let left = if p.time > from { elapsed * (p.end - p.time) / (p.time - from) } else { f64::NAN };
        let left = if left.is_finite() { format!(", about {left:.0} s left") } else { String::new() };
        let line = format!("step {}, {} t = {:.4} of {} s{left}", p.step, p.phase, p.time, p.end);
        match (&self.bar, p.note) {
            (Some(bar), Some(note)) => bar.println(note),
            (Some(bar), None) => {
                bar.set_position((1000.0 * p.time / p.end) as u64);
                bar.set_message(line);
            }
            (None, Some(note)) => super::note(note),
            (None, None) if elapsed >= self.due => {
                self.due = elapsed + INTERVAL;
                super::note(&line);
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
