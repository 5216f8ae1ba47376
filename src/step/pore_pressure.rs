//! Projection of the pore pressure from the points at a grid reset (docs/theory.md, section 11, *Grid reset*).

use super::nodal_fit::{self, Filled};
use crate::kinematics::Kinematics;
use crate::points::Points;
use crate::term::Porous;

/// Projects the pressures (kPa) of the nodes from the points of all `cells` that are in regions with water.
pub fn gather<const D: usize, K: Kinematics<D>>(cells: &[Filled<D>], porous: &[Option<Porous>], field: &mut [f64]) {
    let value = |points: &Points<D>, p: usize| points.by_material(p, porous).map(|_| points.pore_pressure[p]);
    nodal_fit::fit::<D, K>(cells, value, field);
}
