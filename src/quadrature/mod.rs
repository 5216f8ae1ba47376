//! Integration weights of the material points: their volumes, or weights fitted to the part of each cell that
//! is filled, so that polynomials are integrated exactly there.
//!
//! Weights are found when the grid is restored and hold until it is again. Mass and momentum stay with the
//! points.

mod cells;
mod dual;
mod fit;
mod fitted;
mod least;
mod resampled;
mod surface;
mod volumes;

#[cfg(test)]
mod tests;

pub use fit::{Degree, Fitter, MOMENTS};
pub use fitted::Fitted;
pub use resampled::{Resampled, Samples};
pub use surface::Bounded;
pub use volumes::Volumes;

use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::points::Points;
use crate::stencil::{SoftCell, Stencil};
use crate::surface::{ActiveBoundary, Front};

/// What the points of a restored grid weigh, and what follows from where they lie.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Weighing<const D: usize> {
    /// The points that integrals are summed over, where these are not the material points.
    pub samples: Option<Samples<D>>,
    /// What each of the points that integrals are summed over weighs (m³), as volume when seeded.
    pub weight: Vec<f64>,
    /// By cell, ascending, what is added to the gradients of its nodes (1/m) at all its points, so that a
    /// uniform stress exerts the forces it must where no weights do that; few cells need it.
    pub shift: Vec<(u32, Vec<[f64; D]>)>,
    /// Cells that take part and are not full, ascending.
    pub soft: Vec<SoftCell>,
    /// Cells with points that are cut or too poor in points to stand alone, ascending: their faces take a penalty.
    pub poor: Vec<u32>,
    /// The boundary of the material; empty where nothing needs it.
    pub boundary: ActiveBoundary,
    /// The level set that the cells were cut along, one value a node; empty where they were not, or nothing needs the boundary.
    pub level_set: Vec<f64>,
    pub tally: Tally,
    /// Why the surface is followed no longer, where it ceased to be in this restoration.
    pub lost_front: Option<String>,
    /// What points were put back onto supports that they had got beyond, in this restoration.
    pub put_back: Option<String>,
}

/// A grid that is being restored: the points are found on it and `stencil` is filled.
pub struct Restored<'a, const D: usize> {
    pub mesh: &'a Mesh<D>,
    pub locator: &'a Locator<D>,
    pub points: &'a Points<D>,
    /// Parametric coordinates of the points in their cells.
    pub parametric: &'a [[f64; 3]],
    pub stencil: &'a Stencil<D>,
    /// The cells of the grid.
    pub taking_part: &'a [bool],
    /// The grid as it was restored before, on which `displacement` began.
    pub before: (&'a Mesh<D>, &'a Locator<D>),
    /// The boundaries of structures that touch the material, as polylines with the structure on their left.
    pub outlines: &'a [Vec<[f64; D]>],
    /// Whether the nodes are not where the first shape of the grid has them.
    pub relaxed: bool,
    /// Displacement (m) of the nodes since the restoration before; `None` in the first one.
    pub displacement: Option<&'a [[f64; D]]>,
}

/// How the weights of the cells came out.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// Cells with weights that integrate quadratic polynomials, linear ones and constants; by volume alone.
    pub quadratic: u32,
    pub linear: u32,
    pub constant: u32,
    pub volume: u32,
    /// `Σ V_p` of the points and the volume that the weights stand for (m³).
    pub point_volume: f64,
    pub fitted_volume: f64,
    /// `Σ V_p / Σ w − 1` (-) of the cell inside the material in which it is farthest from zero: points crowd
    /// (positive) or thin out there.
    pub drift: f64,
}

/// A rule for the weights of points.
pub trait Quadrature<const D: usize>: Send + Sync {
    /// Weighs the points of a restored grid. `front` is the surface of the material as followed so far, for rules
    /// that need it.
    fn weigh(&self, grid: &Restored<D>, front: &mut Option<Front>) -> Weighing<D>;
}
