//! What subcommands print, and end with.

use crate::error::{Error, plain_lines};
use std::io::{self, Write};

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

/// Prints a line on standard error, where progress and notes go; nobody may be listening.
pub fn note(text: &str) {
    let _ = writeln!(io::stderr(), "{}", plain_lines(text));
}
