//! What subcommands print, and end with.

use crate::error::{Error, plain_lines};
use crate::run::WARNING;
use std::collections::BTreeSet;
use std::io::{self, Write};
use std::sync::{Mutex, PoisonError};

/// What went wrong, and all of it.
pub type Outcome = Result<(), Vec<Error>>;

/// Prints to standard output, without what a terminal would obey; a reader that has gone (`| head`) is no error.
///
/// # Errors
/// Standard output that cannot be written, such as a full disk behind it.
pub fn print(text: &str) -> Outcome {
    let mut out = io::stdout().lock();
    match out.write_all(plain_lines(text).as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => {
            Err(vec![Error::machine("standard output", e, "make room, or send it elsewhere")])
        }
        _ => Ok(()),
    }
}

/// Prints a line on standard error, where progress and notes go; nobody may be listening. Warnings and notes on a case are told once by a
/// process: the stages of `mpm run` look at the same one.
pub fn note(text: &str) {
    static TOLD: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());
    let is_new = || TOLD.lock().unwrap_or_else(PoisonError::into_inner).insert(text.to_string());
    if !(text.starts_with(WARNING) || text.starts_with("note: ")) || is_new() {
        let _ = writeln!(io::stderr(), "{}", plain_lines(text));
    }
}
