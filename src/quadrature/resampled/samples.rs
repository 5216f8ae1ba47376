//! The integration points of a grid.

use crate::points::Points;

/// The integration points of a grid.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Samples<const D: usize> {
    /// Ascending by cell. Their volume when seeded is that which they stand for over their `J`; they have no motion of their own.
    pub points: Points<D>,
    /// Parametric coordinates in their cells.
    pub parametric: Vec<[f64; 3]>,
    /// Velocity (m/s) and acceleration (m/s²) as fitted to those of the material points, until these are mapped to the nodes; empty without motion.
    pub motion: Vec<[[f64; D]; 2]>,
    /// The cells outside the surface, ascending, whose integration points are the material points.
    pub outside: Vec<u32>,
}
