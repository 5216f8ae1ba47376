//! How well a linear system must be solved, and what is said where it cannot be.

use crate::error::Error;

/// Relative residual beyond which a solution is refused.
pub(super) const ACCEPTED: f64 = 1e-8;
/// A pivot this small beside the diagonal entry it began as is rounding. A body free to move leaves at most
/// 1e-14; all the cases of the repository, and ν = 0.499999, more than 1e-6.
pub(super) const SINGULAR: f64 = 1e-12;

/// What is said of a singular system.
const OF_SINGULAR: &str = "the system is singular";

/// Whether an error is that of a singular system.
pub fn is_singular(error: &Error) -> bool {
    error.problem == OF_SINGULAR
}

pub(super) fn singular() -> Error {
    Error::analysis("linear solver", OF_SINGULAR, "take smaller steps")
}

pub(super) fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

pub(super) fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
