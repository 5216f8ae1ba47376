//! What each material point sees of the grid: nodes, weights and gradients, filled once a restoration.
//!
//! A scheme (one file each) fills the flat arrays; everything downstream reads them and never asks which
//! scheme made them. Points are grouped in *patches* that share their nodes: the points of a cell.

mod fill;
mod jumps;
mod mpm;

pub use fill::{SoftCell, cell_size, integrate, soft_cells};
pub use jumps::{Jump, Jumps};
pub use mpm::fill as fill_mpm;

use crate::kinematics::{Gradient, Kinematics};

/// The points of one cell and the nodes they act on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// The cell, and with it the nodes and the clique.
    pub cell: u32,
    /// The points: `Stencil::points[first_point..first_point + point_count]`.
    pub first_point: u32,
    pub point_count: u32,
    /// Nodes of the cell.
    pub node_count: u32,
    /// Where the entries of the first point begin; those of each point follow node by node.
    first_entry: usize,
}

/// Weights and gradients of all points, on the reference configuration: the grid as last restored.
#[derive(Clone, Debug, Default)]
pub struct Stencil<const D: usize> {
    /// Ascending by cell.
    pub patches: Vec<Patch>,
    /// Point numbers, grouped by patch, ascending in each.
    pub points: Vec<u32>,
    /// `N_I(x_p)` (-).
    value: Vec<f64>,
    /// `∇N_I(x_p)` (1/m).
    gradient: Vec<[f64; D]>,
    /// Radius of the points (m), in the order of `points`; empty without hoop strain.
    radius: Vec<f64>,
}

/// The entries of one point.
#[derive(Clone, Copy)]
pub struct Entries<'a, const D: usize> {
    /// The number of the point.
    pub point: usize,
    /// `N_I` for the nodes of the patch.
    pub value: &'a [f64],
    gradient: &'a [[f64; D]],
    /// `1 / r`, zero without hoop strain.
    hoop: f64,
}

impl<const D: usize> Stencil<D> {
    /// The numbers of the points of a patch.
    pub fn points(&self, patch: &Patch) -> &[u32] {
        &self.points[patch.first_point as usize..(patch.first_point + patch.point_count) as usize]
    }

    /// The entries of the points of a patch, in order.
    pub fn entries<K: Kinematics<D>>(&self, patch: &Patch) -> impl Iterator<Item = Entries<'_, D>> {
        let (first, count) = (patch.first_point as usize, patch.node_count as usize);
        let begin = patch.first_entry;
        (0..patch.point_count as usize).map(move |k| {
            let range = begin + k * count..begin + (k + 1) * count;
            Entries {
                point: self.points[first + k] as usize,
                value: &self.value[range.clone()],
                gradient: &self.gradient[range],
                hoop: if K::HOOP { 1.0 / self.radius[first + k] } else { 0.0 },
            }
        })
    }
}

impl<const D: usize> Entries<'_, D> {
    /// The gradient of node `i` of the patch.
    pub fn gradient(&self, i: usize) -> Gradient<D> {
        Gradient { g: self.gradient[i], hoop: self.hoop * self.value[i] }
    }
}
