//! Where the material ends: its surface within the cells, reconstructed from the material points.
//!
//! A [`Contour`] makes a level set at the nodes from the points, along which cells are cut ([`positive`]). [`Geometry`] is what
//! does not change of a grid. Where it holds, a [`MarkerFront`] of markers that move with the grid is better than the contour, and where none does, one that smooths it: [`Distance`] makes the level set. Loads and pictures
//! take the surface as polylines, the [`ActiveBoundary`], of which structures [`Cover`] parts. [`Voids`] are empty cells where there was soil.

pub mod boundary;
mod contour;
mod cover;
mod distance;
#[cfg(test)]
mod fixture;
mod front;
mod geometry;
mod layers;
mod loops;
pub mod moments;
mod path;
mod split;
mod straight;
mod voids;

pub use boundary::{ActiveBoundary, Behind, NO_REGION, Piece, place};
pub use contour::{Contour, HIGHEST};
pub use cover::{Cover, join, open};
pub use distance::Distance;
pub use front::{ContactStatus, Lost, MarkerFront};
pub use geometry::Geometry;
pub use layers::visit_layers;
pub use moments::CellFrame;
pub use path::Path;
pub use split::{positive, triangles};
pub use straight::Triangles;
pub use voids::{News, Void, Voids, lies_near};
