//! What the integrals of a step are sums over: integration points of the cells, or the material points with their volumes.
//!
//! Weights are determined at a grid reset and hold until the next one. The material points keep mass and momentum between resets; the integration points
//! have masses of their own, which agree with them in sum.

#[cfg(test)]
pub mod fixture;
mod resampled;
mod strip;
mod surface;
mod volumes;

pub use resampled::{Around, Count, Fit, Held, Place, Renewed, Resampled, Rings, Samples};
pub use strip::Strip;
pub use surface::Bounded;
pub use volumes::Volumes;

use crate::interpolation::{Interpolation, PartlyFilled};
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::points::Points;
use crate::surface::{ActiveBoundary, ContactStatus, MarkerFront};

/// What the points of a restored grid weigh, and what follows from where they lie.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Weights<const D: usize> {
    /// The points that integrals are summed over, where these are not the material points.
    pub samples: Option<Samples<D>>,
    /// What each of the points that integrals are summed over weighs (m³), as volume when seeded.
    pub weight: Vec<f64>,
    /// Cells that take part and are not full, ascending.
    pub partly_filled: Vec<PartlyFilled>,
    /// Cells with points that are cut or have too few points to stand alone, ascending: their faces take a penalty.
    pub ill_conditioned: Vec<u32>,
    /// The boundary of the material; empty where nothing needs it.
    pub boundary: ActiveBoundary,
    /// The level set that the cells were cut along, one value a node; empty where they were not, or nothing needs the boundary.
    pub level_set: Vec<f64>,
    pub tally: Tally,
    /// Why the surface is followed no longer, where it ceased to be in this restoration.
    pub lost_front: Option<String>,
    /// Notes on this restoration: points that were put back onto supports that they had got beyond, domains of points that were replaced.
    pub notes: Vec<String>,
    /// A warning of points that were projected to the boundary where nothing holds them.
    pub beyond: Option<String>,
    /// The material points as they are to be from this restoration on, where some are split or merged.
    pub renewed: Option<Renewed<D>>,
}

/// A grid that is being restored: the points are found on it and `interpolation` is filled.
pub struct Restored<'a, const D: usize> {
    pub mesh: &'a Mesh<D>,
    pub locator: &'a Locator<D>,
    pub points: &'a Points<D>,
    /// Parametric coordinates of the points in their cells.
    pub parametric: &'a [[f64; 3]],
    pub interpolation: &'a Interpolation<D>,
    /// The cells of the grid.
    pub active: &'a [bool],
    /// The grid as it was restored before, on which `displacement` began.
    pub before: (&'a Mesh<D>, &'a Locator<D>),
    /// The boundaries of structures that touch the material, as polylines with the structure on their left.
    pub outlines: &'a [Vec<[f64; D]>],
    /// The contact status of each piece of these at the end of the last step.
    pub contact: &'a [Vec<ContactStatus>],
    /// Whether the nodes are not where the first shape of the grid has them.
    pub relaxed: bool,
    /// Soil that enters the model in this restoration: the strips that it fills, and how many of the last points are its.
    pub entering: (&'a [Strip<D>], usize),
    /// Displacement (m) of the nodes since the restoration before; `None` in the first one.
    pub displacement: Option<&'a [[f64; D]]>,
}

/// How the integration points of the cells came out; zeros where integrals are sums over the material points.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Tally {
    /// Cells to whose points a linear function is fitted, and a constant.
    pub linear: u32,
    pub constant: u32,
    /// Integration points that take the state of a material point, for no model answers to that which is fitted.
    pub taken: u32,
    /// The volume (m³) of the material points and that of the integration points.
    pub point_volume: f64,
    pub volume: f64,
    /// Material points that were split and merged.
    pub population: Count,
}

/// A rule for the weights of points.
pub trait Quadrature<const D: usize>: Send + Sync {
    /// Weighs the points of a restored grid. `front` is the surface of the material as followed so far, for rules
    /// that need it.
    fn weigh(&self, grid: &Restored<D>, front: &mut Option<MarkerFront>) -> Weights<D>;
}

/// Soil of which a part is taken away.
pub trait Parting<const D: usize>: Send + Sync {
    /// Ends the surface at what is left. The points are found on the reset grid `mesh`, of whose cells some are `active`.
    fn part(&self, mesh: (&Mesh<D>, &Locator<D>), points: &Points<D>, active: &[bool], front: &mut MarkerFront);
}

/// Soil that has come into a region.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Placed<const D: usize> {
    /// The number of the region.
    pub region: u16,
    /// Places (m) of its points, their volumes (m³) and their cells.
    pub position: Vec<[f64; D]>,
    pub volumes: Vec<f64>,
    pub cell: Vec<u32>,
    /// The volume (m³) of all of it, that of the region as drawn, and the part of the first that is outside that.
    pub volume: f64,
    pub drawn: f64,
    pub beside: f64,
}

/// Parts (-) of a cell that are rounding.
pub const NOWHERE: f64 = 1e-12;

/// Soil that comes into regions.
pub trait Placing<const D: usize>: Send + Sync {
    /// The soil of each region, and the surface around it and the soil that is there. The points are found on the reset grid `mesh`, at parametric places
    /// in its cells.
    fn place(
        &self,
        mesh: (&Mesh<D>, &Locator<D>),
        points: (&Points<D>, &[[f64; 3]]),
        front: &mut Option<MarkerFront>,
    ) -> Vec<Placed<D>>;
}
