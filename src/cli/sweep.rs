//! `mpm sweep`: a case for every combination of the values of some of its entries, and one table of their results.
//!
//! Each run is an `mpm run` in a process of its own, so that one that fails or is killed harms no other. What is finished is not
//! done again, what was interrupted goes on from its last checkpoint.

mod axes;
mod table;

use super::args::{CaseArgs, StageArgs};
use super::print::{Outcome, note, print};
use super::signals;
use super::solve;
use super::stage::Stage;
use crate::case;
use crate::error::{Error, Result};
use crate::io::{atomic, lock::Lock, sweep_table};
use crate::reading;
use axes::{Axis, Run};
use rustix::process::{Pid, Signal, getppid, kill_process, set_parent_process_death_signal};
use std::collections::HashSet;
use std::fs::File;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;
use std::time::{Duration, Instant};

#[derive(clap::Args)]
pub struct Args {
    /// A case.yaml, or the folder that holds one
    case: PathBuf,
    /// An entry of the case and its values, e.g. contacts[0].adhesion_factor=0,0.5,1; several give all combinations
    #[arg(required = true, value_name = "PATH=V1,V2,…")]
    axes: Vec<String>,
    /// Override an entry of the case in all runs
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
    /// The folder of the runs and the table [default: sweep/ beside the case]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// Runs at a time [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    jobs: Option<u16>,
    /// Threads of a run [default: the cores divided by the runs at a time]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Begin those runs anew that were not finished
    #[arg(long)]
    fresh: bool,
    /// Print the names of the runs, and do nothing else
    #[arg(long, conflicts_with_all = ["table", "only"])]
    list: bool,
    /// Write the table of what is there, and run nothing
    #[arg(long, conflicts_with = "only")]
    table: bool,
    /// Do this run alone, and write no table; may be repeated
    #[arg(long, value_name = "RUN")]
    only: Vec<String>,
}

/// How often ended runs and signals are looked for.
const TICK: Duration = Duration::from_millis(50);

pub fn run(args: &Args) -> Outcome {
    // In other commands this thread is one of the pool. Here it only waits for the runs: they would wait for it, on one core for ever.
    let _ = rayon::ThreadPoolBuilder::new().build_global();
    let sweep = Sweep::new(args)?;
    if args.list {
        let names: Vec<&str> = sweep.runs.iter().map(|run| run.name.as_str()).collect();
        return print(&format!("{}\n", names.join("\n")));
    }
    atomic::refuse_link(&sweep.folder)?;
    if !args.only.is_empty() {
        return sweep.all(&sweep.named(&args.only)?);
    }
    sweep.check()?;
    atomic::prepare_folder(&sweep.folder)?;
    let _lock = Lock::take(&sweep.folder)?;
    sweep_table::refuse_others(&sweep.path_of_table())?;
    let outcome = if args.table { Ok(()) } else { sweep.all(&sweep.runs.iter().collect::<Vec<_>>()) };
    match (outcome, sweep.table()) {
        (Err(mut errors), Err(of_table)) => {
            errors.extend(of_table);
            Err(errors)
        }
        (outcome, table) => outcome.and(table),
    }
}

/// Ends this process when the one with the number `parent` ends, which started it.
///
/// # Errors
/// Interrupted: it has ended already. Machine: a system that cannot do so.
pub fn end_with(parent: u32) -> Result<()> {
    set_parent_process_death_signal(Some(Signal::KILL)).map_err(|e| {
        Error::machine("the sweep", format!("its runs cannot be tied to it: {e}"), "run them by `mpm run`")
    })?;
    match getppid().map(|pid| pid.as_raw_nonzero().get()) {
        Some(number) if u32::try_from(number) == Ok(parent) => Ok(()),
        _ => Err(Error::interrupted("the sweep has ended", "start it again")),
    }
}

struct Sweep<'a> {
    args: &'a Args,
    axes: Vec<Axis>,
    runs: Vec<Run>,
    folder: PathBuf,
}

impl<'a> Sweep<'a> {
    fn new(args: &'a Args) -> Result<Self> {
        let axes = axes::parse(&args.axes)?;
        let runs = axes::combinations(&axes)?;
        let beside = if args.case.is_dir() { Some(args.case.as_path()) } else { args.case.parent() };
        let folder = args.output.clone().unwrap_or_else(|| beside.unwrap_or(Path::new("")).join("sweep"));
        // A slash at its end would lead through a link.
        let folder = folder.components().collect();
        Ok(Self { args, axes, runs, folder })
    }

    /// The runs of these names.
    fn named(&self, names: &[String]) -> Result<Vec<&Run>> {
        let find = |name: &String| {
            self.runs.iter().find(|run| run.name == *name).ok_or_else(|| {
                let problem = "there is no run of this name";
                Error::input(format!("--only {name}"), problem, "`--list` prints the names")
            })
        };
        names.iter().map(find).collect()
    }

    /// Holds every run against the rules of a case, before any begins.
    fn check(&self) -> Outcome {
        let mut told = HashSet::new();
        let mut mistakes = Vec::new();
        for run in &self.runs {
            for mistake in case::load(&self.args.case, &self.overrides(run)).err().into_iter().flatten() {
                if told.insert(mistake.to_string()) {
                    mistakes.push(mistake);
                }
            }
        }
        if mistakes.is_empty() { Ok(()) } else { Err(mistakes) }
    }

    fn overrides(&self, run: &Run) -> Vec<String> {
        let values = self.axes.iter().zip(&run.values).map(|(axis, value)| format!("{}={value}", axis.path));
        self.args.overrides.iter().cloned().chain(values).collect()
    }

    fn out(&self, run: &Run) -> PathBuf {
        self.folder.join(&run.name)
    }

    /// The output folder of a run, with its case.
    fn stage(&self, run: &Run) -> std::result::Result<Stage, Vec<Error>> {
        let case = CaseArgs { case: self.args.case.clone(), overrides: self.overrides(run) };
        Stage::open(&StageArgs { case, output: Some(self.out(run)), threads: None })
    }

    /// Does `runs`, several at a time.
    fn all(&self, runs: &[&Run]) -> Outcome {
        atomic::prepare_folder(&self.folder)?;
        let cores = thread::available_parallelism().map_or(1, usize::from);
        let jobs = self.args.jobs.map_or(cores, usize::from).min(runs.len());
        let threads = self.args.threads.map_or((cores / jobs).max(1), usize::from);
        let _caught = signals::catch()?;
        let (next, ended) = (AtomicUsize::new(0), AtomicUsize::new(0));
        let errors = Mutex::new(Vec::new());
        let fail = |error: Vec<Error>| errors.lock().unwrap_or_else(|e| e.into_inner()).extend(error);
        let work = || {
            while let Some(run) = runs.get(next.fetch_add(1, Ordering::SeqCst)) {
                if stopped() {
                    return;
                }
                let begin = Instant::now();
                let how = match self.one(run, threads) {
                    Ok(()) => "finished".to_owned(),
                    Err(error) => {
                        let how = error.first().map_or_else(String::new, |e| e.problem.clone());
                        fail(error);
                        how
                    }
                };
                let (done, seconds) = (ended.fetch_add(1, Ordering::SeqCst) + 1, begin.elapsed().as_secs_f64());
                // The table and the exit status say the same.
                note(&format!("[{done}/{}] {}: {how}, {seconds:.1} s", runs.len(), run.name));
            }
        };
        thread::scope(|scope| {
            for _ in 0..jobs {
                scope.spawn(work);
            }
        });
        let errors = errors.into_inner().unwrap_or_else(|e| e.into_inner());
        match (stopped(), errors.is_empty()) {
            (true, _) => Err(vec![Error::interrupted("the sweep was stopped", "the same command continues it")]),
            (false, true) => Ok(()),
            (false, false) => Err(errors),
        }
    }

    /// Does a run, or what is left of it. Its process is tied to this thread.
    fn one(&self, run: &Run, threads: usize) -> Outcome {
        let program = std::env::current_exe()
            .map_err(|e| Error::machine("mpm", format!("its own file is not found: {e}"), "install it again"))?;
        let log = self.folder.join(format!("{}.log", run.name));
        atomic::remove(&log)?;
        let file = File::create_new(&log).map_err(|e| atomic::unwritable(&log, &e))?;
        let copy = file.try_clone().map_err(|e| atomic::unwritable(&log, &e))?;
        let mut command = Command::new(program);
        command.arg("run").arg(&self.args.case).arg("-o").arg(self.out(run));
        command.args(self.overrides(run).iter().flat_map(|entry| ["--set", entry]));
        command.arg("--threads").arg(threads.to_string()).arg("--end-with").arg(std::process::id().to_string());
        if self.args.fresh {
            command.arg("--fresh");
        } else if solve::can_resume(&self.stage(run)?)? {
            command.arg("--resume");
        }
        // In a group of its own, so that Ctrl-C comes once: through this process.
        let started = command.process_group(0).stdout(file).stderr(copy).spawn();
        let mut child = started.map_err(|e| Error::machine("mpm", format!("it cannot be started: {e}"), ""))?;
        let status = wait(&mut child).map_err(|e| Error::machine("mpm", e, ""))?;
        outcome(&run.name, status, &log)
    }

    fn path_of_table(&self) -> PathBuf {
        self.folder.join(sweep_table::FILE)
    }

    /// Writes the table of all runs.
    fn table(&self) -> Outcome {
        let mut rows = Vec::new();
        for run in &self.runs {
            rows.push(table::Row::read(run, &self.stage(run)?)?);
        }
        let path = self.path_of_table();
        let text = table::csv(&self.axes, &rows)?;
        atomic::write(&path, |out| out.write_all(&text))?;
        let done = rows.iter().filter(|row| row.is_finished()).count();
        print(&format!("{}: {done} of {} runs are finished\n", path.display(), rows.len()))
    }
}

fn stopped() -> bool {
    signals::stop().load(Ordering::SeqCst)
}

/// Waits for a process; a first signal to this one is passed on to it once.
fn wait(child: &mut Child) -> std::io::Result<ExitStatus> {
    let mut told = false;
    loop {
        if let Some(status) = child.try_wait()? {
            return Ok(status);
        }
        if stopped() && !told {
            told = true;
            if let Some(pid) = i32::try_from(child.id()).ok().and_then(Pid::from_raw) {
                // Where it has just ended there is nobody to tell.
                let _ = kill_process(pid, Signal::TERM);
            }
        }
        thread::sleep(TICK);
    }
}

/// What the exit status of a run and the last error in its log say.
fn outcome(name: &str, status: ExitStatus, log: &Path) -> Outcome {
    if status.success() {
        return Ok(());
    }
    let text = reading::text(log).unwrap_or_default();
    let said = text.lines().rev().find_map(|line| line.strip_prefix("error: "));
    let problem = said.map_or_else(|| format!("it ended with {status}"), str::to_owned);
    let remedy = format!("see {}", log.display());
    Err(vec![match status.code() {
        Some(1) => Error::analysis(name, problem, remedy),
        Some(2) => Error::input(name, problem, remedy),
        Some(130) => Error::interrupted(problem, remedy),
        _ => Error::machine(name, problem, remedy),
    }])
}
