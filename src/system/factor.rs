//! LLᵀ and LDLᵀ factors of symmetric matrices, whole or by halves.

use super::dissection::Dissection;
use super::whole::Whole;
use super::{Matrix, Pattern};
use crate::error::Result;

/// Equations from which on two halves are faster: on two threads the templates `anchor`, `footing` and `penetration`, with 3000 to 9000 equations, take 5 to
/// 25 % less time; on one thread they take as long as in one piece, or up to 6 % longer.
const MANY: usize = 2_000;

/// A factor of the symmetric part of the matrices of one pattern.
pub enum Factor {
    Whole(Box<Whole>),
    Dissection(Box<Dissection>),
}

impl Factor {
    /// Orders the equations and factorises symbolically; `places` as for [`super::Solver::new`].
    ///
    /// # Errors
    /// A machine error when memory does not suffice.
    pub fn new<const D: usize>(pattern: &Pattern, places: &[[f64; D]]) -> Result<Self> {
        let halves = if pattern.len() < MANY { None } else { Dissection::new(pattern, places)? };
        Ok(match halves {
            Some(halves) => Self::Dissection(Box::new(halves)),
            None => Self::Whole(Box::new(Whole::new(pattern)?)),
        })
    }

    /// Numeric factorisation, LLᵀ or LDLᵀ: the least pivot, relative to the diagonal entry it began as; `None` where it
    /// breaks down. A pivot is about the rounding unit where the equations before it already determine its own.
    pub fn factorize(&mut self, pattern: &Pattern, matrix: &Matrix, llt: bool) -> Option<f64> {
        match self {
            Self::Whole(whole) => whole.factorize(pattern, matrix, llt),
            Self::Dissection(halves) => halves.factorize(matrix, llt),
        }
    }

    /// Applies the inverse in place; `llt` as in the factorisation before.
    pub fn solve(&mut self, x: &mut [f64], llt: bool) {
        match self {
            Self::Whole(whole) => whole.solve(x, llt),
            Self::Dissection(halves) => halves.solve(x, llt),
        }
    }
}
