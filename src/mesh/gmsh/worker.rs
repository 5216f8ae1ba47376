//! Gmsh in a process of its own: what it executes, writes, eats or breaks stays there.
//!
//! The parent starts the program again as `mpm gmsh-worker` and sends a [`Request`] on its standard input, a line of
//! JSON; the child answers a line for the names of the groups and, once the parent has agreed to them, one for the mesh.
//! Where it ends otherwise, by a crash, a limit or Ctrl-C, the parent says why.

use super::{Groups, Options, sandbox, script};
use crate::error::{Error, Result};
use rustix::process::{Pid, Signal, kill_process_group};
use serde::{Deserialize, Serialize};
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::thread;
use std::time::{Duration, Instant};

/// The hidden subcommand that calls [`serve`].
pub const COMMAND: &str = "gmsh-worker";

/// How Gmsh is started, and what it may use.
#[derive(Clone, Copy, Debug)]
pub struct Worker<'a> {
    /// The program with the subcommand [`COMMAND`].
    pub program: &'a Path,
    /// The longest time of the process (s).
    pub seconds: u64,
    /// The most memory of the process (bytes).
    pub memory: u64,
    /// The most memory that the analysis of the mesh may take (bytes).
    pub analysis: u64,
    /// Refuse statements that execute or write.
    pub filter: bool,
    /// Take from the process all files but those of the geometry, where the kernel can.
    pub sandbox: bool,
    /// Set when the user stops the program.
    pub stop: &'a AtomicBool,
    /// Tells the user that there is no sandbox though there should be.
    pub warn: fn(&str),
}

#[derive(Serialize, Deserialize)]
struct Request {
    parent: u32,
    geo: PathBuf,
    options: Options,
    /// The mesh to write; without it the names of the groups alone are wanted.
    out: Option<PathBuf>,
    files: Vec<PathBuf>,
    sandbox: bool,
    memory: u64,
    analysis: u64,
}

#[derive(Serialize, Deserialize)]
enum Answer {
    /// The kernel takes no rights from the process.
    Unconfined,
    Groups(Groups),
    Meshed,
    /// An error: its exit status, place, problem and remedy.
    Failed(u8, String, String, String),
}

/// Most bytes of what Gmsh prints that are kept for a message.
const MOST_OUTPUT: u64 = 1 << 16;

/// Most bytes of an answer.
const MOST_ANSWER: u64 = 1 << 26;

const UNCONFINED: &str = "this kernel has no Landlock, so Gmsh reads the .geo with all of your rights; mesh the files of strangers in a container";

/// How often the parent looks whether it is to stop.
const TICK: Duration = Duration::from_millis(50);

/// How long the last answer of a process that has ended may take on a busy machine.
const LAST: Duration = Duration::from_secs(5);

impl Worker<'_> {
    /// The names of the physical groups of `geo`, which is not meshed.
    ///
    /// # Errors
    /// Input: as [`super::groups`]; statements that the filter refuses; a process that crashes or meets a limit.
    pub fn groups(&self, geo: &Path, options: &Options) -> Result<Groups> {
        let mut session = self.start(geo, options, None)?;
        session.groups()
    }

    /// Meshes `geo` into `out`, whose folder is the only one that the process can write, once `agree` has nothing to say
    /// against the names of the groups.
    ///
    /// # Errors
    /// Those of `agree`; as [`super::generate`] and [`Self::groups`].
    pub fn mesh(
        &self,
        geo: &Path,
        options: &Options,
        out: &Path,
        agree: impl FnOnce(&Groups) -> std::result::Result<(), Vec<Error>>,
    ) -> std::result::Result<(), Vec<Error>> {
        let mut session = self.start(geo, options, Some(out))?;
        agree(&session.groups()?)?;
        session.go_on()?;
        match session.answer()? {
            Answer::Meshed => Ok(()),
            _ => Err(session.astray().into()),
        }
    }

    fn start<'a>(&'a self, geo: &'a Path, options: &Options, out: Option<&Path>) -> Result<Session<'a>> {
        super::files::check_readable(geo)?;
        let files = if self.filter { script::sources(geo)?.files } else { vec![geo.to_owned()] };
        let mut command = Command::new(self.program);
        command.arg(COMMAND).stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).process_group(0);
        if self.sandbox {
            let home = out.and_then(Path::parent).unwrap_or(Path::new("/nonexistent"));
            let libraries = std::env::var_os("LD_LIBRARY_PATH");
            command
                .env_clear()
                .envs(libraries.map(|path| ("LD_LIBRARY_PATH", path)))
                .env("HOME", home)
                .env("TMPDIR", home);
        }
        let mut child =
            command.spawn().map_err(|error| unstartable(self.program, &format!("it cannot be started: {error}")))?;
        let output = child.stderr.take().map(|pipe| {
            thread::spawn(move || {
                let (mut kept, mut pipe) = (Vec::new(), BufReader::new(pipe));
                // What does not fit is read and dropped, so that the process can go on.
                let _ = pipe.by_ref().take(MOST_OUTPUT).read_to_end(&mut kept);
                let _ = io::copy(&mut pipe, &mut io::sink());
                String::from_utf8_lossy(&kept).into_owned()
            })
        });
        let (send, answers) = channel();
        let stdout = child.stdout.take();
        thread::spawn(move || {
            let Some(stdout) = stdout else { return };
            let mut lines = BufReader::new(stdout.take(MOST_ANSWER));
            let mut line = String::new();
            while lines.read_line(&mut line).is_ok_and(|length| length > 0) {
                if send.send(std::mem::take(&mut line)).is_err() {
                    return;
                }
            }
        });
        let due = Instant::now() + Duration::from_secs(self.seconds);
        let mut session = Session { worker: self, geo, child, answers, output, due };
        let request = Request {
            parent: std::process::id(),
            geo: geo.to_owned(),
            options: options.clone(),
            out: out.map(Path::to_owned),
            files,
            sandbox: self.sandbox,
            memory: self.memory,
            analysis: self.analysis,
        };
        let request =
            serde_json::to_string(&request).map_err(|error| Error::input(geo.display(), error, "rename it"))?;
        session.send(&request)?;
        Ok(session)
    }
}

fn unstartable(program: &Path, problem: &str) -> Error {
    Error::machine(program.display(), problem, "install the program again")
}

/// A process at work; it is killed when this is dropped.
struct Session<'a> {
    worker: &'a Worker<'a>,
    geo: &'a Path,
    child: Child,
    answers: Receiver<String>,
    output: Option<thread::JoinHandle<String>>,
    due: Instant,
}

impl Session<'_> {
    fn send(&mut self, line: &str) -> Result<()> {
        let sent = self.child.stdin.as_mut().map(|stdin| writeln!(stdin, "{line}"));
        match sent {
            Some(Ok(())) => Ok(()),
            // The process has ended: how, its status tells.
            _ => Err(self.ended()),
        }
    }

    fn go_on(&mut self) -> Result<()> {
        self.send("go on")
    }

    fn groups(&mut self) -> Result<Groups> {
        match self.answer()? {
            Answer::Groups(groups) => Ok(groups),
            _ => Err(self.astray()),
        }
    }

    fn astray(&self) -> Error {
        unstartable(self.worker.program, "it is of another version than the one that runs")
    }

    /// The next answer of the process, after a warning where the kernel takes no rights from it.
    fn answer(&mut self) -> Result<Answer> {
        match self.next()? {
            Answer::Unconfined => (self.worker.warn)(UNCONFINED),
            answer => return Ok(answer),
        }
        self.next()
    }

    fn next(&mut self) -> Result<Answer> {
        let line = loop {
            match self.answers.recv_timeout(TICK) {
                Ok(line) => break line,
                Err(RecvTimeoutError::Disconnected) => return Err(self.ended()),
                Err(RecvTimeoutError::Timeout) => (),
            }
            if self.worker.stop.load(Ordering::Relaxed) {
                return Err(Error::interrupted("Gmsh was stopped", "start the program again"));
            }
            if Instant::now() > self.due {
                return Err(self.too_slow());
            }
            // Its last answer may still be on the way. A program that the .geo has started may keep the pipe open.
            if matches!(self.child.try_wait(), Ok(Some(_))) {
                break self.answers.recv_timeout(LAST).map_err(|_| self.ended())?;
            }
        };
        match serde_json::from_str(&line) {
            Ok(Answer::Failed(status, place, problem, remedy)) => Err(match status {
                3 => Error::machine(place, problem, remedy),
                _ => Error::input(place, problem, remedy),
            }),
            Ok(answer) => Ok(answer),
            Err(_) => Err(self.astray()),
        }
    }

    fn too_slow(&self) -> Error {
        Error::input(
            self.geo.display(),
            format!("Gmsh was stopped after {} s, the limit of its time", self.worker.seconds),
            "look for a loop without end or mesh coarser, or allow more with --mesh-timeout SECONDS",
        )
    }

    /// Why the process has ended without an answer.
    fn ended(&mut self) -> Error {
        let status = self.child.wait().ok();
        let output = self.output.take().and_then(|output| output.join().ok()).unwrap_or_default();
        let signal = status.as_ref().and_then(ExitStatusExt::signal);
        let place = self.geo.display();
        let gib = self.worker.memory as f64 / f64::from(1 << 30);
        let last = output.lines().rev().find(|line| !line.trim().is_empty()).unwrap_or_default();
        let said: String = last.chars().filter(|c| !c.is_control()).take(200).collect();
        if output.contains("bad_alloc") || output.contains("memory allocation") {
            return Error::input(
                place,
                format!("Gmsh needs more than {gib:.1} GiB of memory, its limit"),
                "mesh coarser, or allow more with --mesh-memory GIB",
            );
        }
        match signal {
            Some(signal) => Error::input(
                place,
                format!("Gmsh crashed (signal {signal}){}{said}", if said.is_empty() { "" } else { ": " }),
                format!("correct or simplify the file, or allow more memory than {gib:.1} GiB with --mesh-memory GIB"),
            ),
            None if status.is_some_and(|status: ExitStatus| status.success()) => Error::input(
                place,
                "Gmsh ended before the mesh was made, by a statement such as Exit",
                "take out the statement that ends the program",
            ),
            None => Error::input(
                place,
                format!("Gmsh ended without an answer{}{said}", if said.is_empty() { "" } else { ": " }),
                "open the file in Gmsh to see where; correct or simplify it",
            ),
        }
    }
}

impl Drop for Session<'_> {
    fn drop(&mut self) {
        if let Some(group) = i32::try_from(self.child.id()).ok().and_then(Pid::from_raw) {
            // Also what a .geo has started; that all may have ended is no error.
            let _ = kill_process_group(group, Signal::KILL);
        }
        let _ = self.child.wait();
    }
}

/// The child's side: reads a request from standard input and answers on standard output.
///
/// # Errors
/// Machine: no request, or nobody who reads the answer.
pub fn serve() -> Result<()> {
    let broken =
        |problem: String| Error::machine("standard input", problem, "this command is for mpm itself: use `mpm mesh`");
    // What Gmsh prints must not get between the answers.
    let answers = rustix::io::dup(rustix::stdio::stdout()).map_err(|error| broken(error.to_string()))?;
    rustix::stdio::dup2_stdout(rustix::stdio::stderr()).map_err(|error| broken(error.to_string()))?;
    let mut answers = File::from(answers);
    let mut lines = io::stdin().lock().lines();
    let mut line = || lines.next().and_then(std::result::Result::ok);
    let request = line().ok_or_else(|| broken("there is no request".into()))?;
    let request: Request = serde_json::from_str(&request).map_err(|error| broken(error.to_string()))?;
    let mut answer = |answer: Answer| {
        let text = serde_json::to_string(&answer).unwrap_or_default();
        writeln!(answers, "{text}").map_err(|error| broken(error.to_string()))
    };
    match work(&request, &mut answer, &mut || line().is_some()) {
        Ok(()) => answer(Answer::Meshed),
        Err(error) => answer(Answer::Failed(error.exit_status(), error.place, error.problem, error.remedy)),
    }
}

/// Does what is asked. It answers with the names of the groups, and waits whether the parent `agrees` to them and wants the mesh.
fn work(
    request: &Request,
    answer: &mut dyn FnMut(Answer) -> Result<()>,
    agrees: &mut dyn FnMut() -> bool,
) -> Result<()> {
    let failed =
        |error: &dyn std::fmt::Display| Error::machine("Gmsh", error, "see `ulimit -a` and docs/reference/geo.md");
    sandbox::limit(request.parent, request.memory).map_err(|error| failed(&error))?;
    if request.sandbox {
        let folder = request.out.as_deref().and_then(Path::parent);
        if !sandbox::enter(&request.files, folder).map_err(|error| failed(&error))? {
            answer(Answer::Unconfined)?;
        }
    }
    match &request.out {
        None => answer(Answer::Groups(super::groups(&request.geo, &request.options)?)),
        Some(out) => {
            let mut agree = |groups| answer(Answer::Groups(groups)).map(|()| agrees());
            super::generate(&request.geo, &request.options, out, request.analysis, &mut agree)
        }
    }
}
