//! Mistakes in a case.

use super::locate::{At, Path};
use crate::error::shown;
use serde_json::Value;

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

/// What a value is, in words.
pub fn describe(value: &Value) -> String {
    match value {
        Value::Null => "nothing".into(),
        Value::Bool(b) => b.to_string(),
        Value::Number(n) => format!("the number {n}"),
        Value::String(s) => format!("the text `{}`", shown(s)),
        Value::Array(_) => "a list".into(),
        Value::Object(_) => "a block of entries".into(),
    }
}

/// Mistakes that are looked for.
pub const MOST_FOUND: usize = 10_000;
