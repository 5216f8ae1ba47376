//! A side of a cell on the boundary of the mesh, and the way back to it.

use super::{Mesh, cell_size};
use crate::geometry::{Line, at, nearest};

/// A side of a cell as a straight line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side<const D: usize> {
    /// Its ends (m).
    pub ends: Line<D>,
    /// The diagonal (m) of the cell.
    pub size: f64,
}

impl<const D: usize> Side<D> {
    /// Side `side` of `cell`.
    pub fn of(mesh: &Mesh<D>, (cell, side): (u32, u8)) -> Self {
        const { assert!(D == 2, "sides are lines in the plane only") };
        let nodes = mesh.cells.nodes(cell as usize);
        let (_, facets) = mesh.cells.kind[cell as usize].facets();
        let facet = &facets[side as usize];
        let ends = [facet[0], facet[1]].map(|i| mesh.nodes[nodes[i] as usize]);
        Self { ends, size: cell_size(mesh, cell as usize) }
    }

    /// The place on it that is nearest to `x` (m), and how far (m) that is; none where it is more than the part `farthest` (-) of its cell.
    pub fn nearest(&self, x: &[f64; D], farthest: f64) -> Option<([f64; D], f64)> {
        let (share, distance) = nearest(x, &self.ends);
        (distance <= farthest * self.size).then(|| (at(&self.ends, share), distance))
    }
}
