//! What is said of files of a run that do not belong to it.

use crate::error::Error;

/// What helps.
pub(super) const AFRESH: &str = "start the analysis afresh, with --fresh in place of --resume";

/// The error of a checkpoint whose arrays do not fit the scene.
pub(super) fn foreign(what: &str) -> Error {
    Error::input("checkpoint", format!("{what} does not fit the mesh and the points"), AFRESH)
}
