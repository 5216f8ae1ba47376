//! What each material point sees of the grid: nodes, weights and gradients, filled once a restoration.
//!
//! A scheme (one file each) fills the flat arrays; everything downstream reads them and never asks which
//! scheme made them. Points are grouped in *patches* that share their nodes: the points of a cell.

mod ddmp;
mod entries;
mod fill;
mod jumps;
mod mpm;
mod reach;

pub use ddmp::smooths;
pub use entries::{Entries, Patch, Stencil};
pub use fill::{PartlyFilled, integrate, partly_filled_cells};
pub use jumps::{Jump, Jumps};
pub use reach::Reach;

use crate::kinematics::Kinematics;
use crate::mesh::Mesh;

/// How gradients at the points are formed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scheme {
    /// Those of the cell's own shape functions.
    Mpm,
    /// Smoothed between cells.
    Ddmp,
}

impl<const D: usize> Stencil<D> {
    /// Fills the stencil for points in `cell` at the parametric coordinates `xi`, given per point. `active`
    /// marks the cells of the grid. The weights are for the caller to write.
    pub fn fill<K: Kinematics<D>>(
        &mut self,
        scheme: Scheme,
        mesh: &Mesh<D>,
        cell: &[u32],
        xi: &[[f64; 3]],
        active: &[bool],
    ) {
        match scheme {
            Scheme::Mpm => mpm::fill::<D, K>(self, mesh, cell, xi),
            Scheme::Ddmp => ddmp::fill::<D, K>(self, mesh, cell, xi, active),
        }
        self.weight.resize(self.points.len(), 0.0);
    }
}
