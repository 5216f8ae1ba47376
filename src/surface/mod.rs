//! Where the material ends: its surface within the cells, reconstructed from the material points.
//!
//! A [`Contour`] makes a level set at the nodes from the points; [`Active`] cuts the cells along it and says how much
//! of each holds material, with the [`moments`] of that part. [`Geometry`] is what both need of a grid.

mod active;
mod contour;
#[cfg(test)]
mod fixture;
mod geometry;
pub mod moments;
mod split;

pub use active::{Active, Filling};
pub use contour::Contour;
pub use geometry::Geometry;
