//! Integration weights of the material points: their volumes, or weights fitted to the part of each cell that
//! is filled, so that polynomials are integrated exactly there.

mod dual;
mod fit;
mod least;

#[cfg(test)]
mod tests;

pub use fit::{Degree, Fitter, MOMENTS};
