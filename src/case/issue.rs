//! Mistakes in a case.

use super::locate::{At, Path};

/// A mistake in the case, at an entry of it.
#[derive(Clone, Debug)]
pub struct Issue {
    pub path: Path,
    pub at: At,
    pub problem: String,
    pub remedy: String,
    /// Whether the entry is a key that does not belong there: without it the rest can still be read.
    pub unknown: bool,
    /// The key that was probably meant by an unknown one.
    pub meant: Option<String>,
}

impl Issue {
    pub fn new(path: &Path, at: At, problem: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self { path: path.clone(), at, problem: problem.into(), remedy: remedy.into(), unknown: false, meant: None }
    }
}

/// Mistakes that are looked for.
pub const MOST_FOUND: usize = 10_000;
