//! Ctrl-C and its like: work that can be stopped in an orderly way looks at [`stop`], all other work ends at once.
//!
//! The closing of the terminal stays ignored where it was at the start: `nohup` goes on.

use crate::error::{Error, Result};
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use std::fs;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::thread;

/// The exit status of a program that its user has stopped.
const STOPPED: i32 = 130;

static STOP: AtomicBool = AtomicBool::new(false);

/// How many pieces of work look at `STOP`.
static LOOKING: AtomicUsize = AtomicUsize::new(0);

/// Set by a first signal while something holds a [`Caught`].
pub fn stop() -> &'static AtomicBool {
    &STOP
}

/// While this lives, a first signal sets [`stop`] and a second one ends the program.
pub struct Caught(());

/// Catches Ctrl-C, a polite kill and the closing of the terminal.
///
/// # Errors
/// Machine: signals that cannot be caught.
pub fn catch() -> Result<Caught> {
    static STARTED: OnceLock<std::result::Result<(), String>> = OnceLock::new();
    LOOKING.fetch_add(1, Ordering::SeqCst);
    let caught = Caught(());
    match STARTED.get_or_init(start) {
        Ok(()) => Ok(caught),
        Err(e) => Err(Error::machine("signals", format!("Ctrl-C cannot be caught: {e}"), "run in another terminal")),
    }
}

impl Drop for Caught {
    fn drop(&mut self) {
        LOOKING.fetch_sub(1, Ordering::SeqCst);
    }
}

fn start() -> std::result::Result<(), String> {
    let hang_up = (ignored() & 1 << (SIGHUP - 1) == 0).then_some(SIGHUP);
    let wanted = [SIGINT, SIGTERM].into_iter().chain(hang_up);
    let mut signals = Signals::new(wanted).map_err(|e| e.to_string())?;
    thread::Builder::new()
        .spawn(move || {
            for _ in signals.forever() {
                if LOOKING.load(Ordering::SeqCst) == 0 || STOP.swap(true, Ordering::SeqCst) {
                    std::process::exit(STOPPED);
                }
            }
        })
        .map(drop)
        .map_err(|e| e.to_string())
}

/// The signals that the process ignores, a bit each; none where the system does not say.
fn ignored() -> u64 {
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}
