//! Warnings among the lines of the log.

/// What a line begins with that the user is told, too, at once and at the end of the run.
pub const WARNING: &str = "warning: ";
