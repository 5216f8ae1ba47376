//! Linear systems: the pattern of the unknowns, the assembly into it and the sparse solution.
//!
//! Unknowns come in *blocks* (the displacement components of a node, say); terms assemble dense matrices
//! over *couplings* of blocks (the nodes of a cell, say). The pattern is the union of the couplings; it and
//! its symbolic factorisation stay fixed until the couplings change. Under linear constraints the nodes of a coupling are combinations of
//! its blocks ([`LinearConstraints`]).

mod accuracy;
mod assembly;
mod constraints;
mod dissection;
mod factor;
mod iterative;
mod lu;
mod pattern;
mod scatter;
mod separator;
mod solver;
mod supernodes;
mod whole;

pub use accuracy::is_singular;
pub use assembly::{Matrix, MatrixFree};
pub use constraints::{LinearConstraints, Rows};
pub use pattern::{Connectivity, Pattern};
pub use scatter::{Local, Workspace, scatter};
pub use solver::{Method, Solver};

#[cfg(test)]
mod tests;
