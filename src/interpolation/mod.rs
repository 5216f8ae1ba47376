//! The interpolation from nodes to points: nodes, values and gradients of each point, computed at each grid reset.
//!
//! A scheme (a [`Basis`], one file each) fills the flat arrays; everything downstream reads them and never asks which
//! scheme made them. Points are grouped by cell: points of a cell share its nodes.

mod basis;
mod bspline;
mod composite;
mod cpdi;
mod cpdi2;
mod ddmp;
mod domain;
mod entries;
mod extension;
mod fill;
mod gimp;
mod group;
mod jumps;
mod mpm;
mod support;

pub use basis::{Basis, Domains, First, Located, Reset};
pub use bspline::BSpline;
pub use composite::Composite;
pub use cpdi::Cpdi;
pub use cpdi2::Cpdi2;
pub use ddmp::Ddmp;
pub use entries::{CellPoints, Coefficients, Entries, Interpolation};
pub use extension::Extension;
pub use fill::{PartlyFilled, integrate, partly_filled_cells};
pub use gimp::Gimp;
pub use group::Place;
pub use jumps::{Jump, Jumps};
pub use mpm::Mpm;
pub use support::{MAX_FUNCTIONS, Support, reach_beyond_cells};

use crate::kinematics::Kinematics;
use crate::mesh::Mesh;

/// The schemes that a case can have.
pub const SCHEMES: &[&dyn Basis<2>] =
    &[&Mpm, &Ddmp, &Gimp::UNIFORM, &Gimp::STRETCHED, &Cpdi, &Cpdi2, &Composite, &BSpline];

impl<const D: usize> Interpolation<D> {
    /// Fills in what points in `cell` at the parametric coordinates `xi`, given per point, see by a scheme. `active`
    /// marks the cells of the grid. The weights are for the caller to write.
    pub fn fill<K: Kinematics<D>>(
        &mut self,
        basis: &dyn Basis<D>,
        mesh: &Mesh<D>,
        cell: &[u32],
        xi: &[[f64; 3]],
        active: &[bool],
    ) {
        basis.fill(&Located::new::<K>(mesh, active, cell, xi), self);
    }
}
