//! The weights and gradients of points, patch by patch.

use super::reach::Reach;
use crate::kinematics::{Gradient, Kinematics};
use crate::mesh::Mesh;
use crate::mesh::shape::MAX_NODES;
use std::sync::Arc;

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
    /// Local functions: the nodes of the cell, and what else a scheme forms gradients with.
    pub function_count: u32,
    /// Where the values of the first point begin; those of each point follow node by node.
    pub(super) first_value: usize,
    /// Where the gradients of the first point begin; those of each point follow function by function.
    pub(super) first_gradient: usize,
}

/// Weights and gradients of all points, on the reference configuration: the grid as last restored.
#[derive(Clone, Debug, Default)]
pub struct Stencil<const D: usize> {
    /// Ascending by cell.
    pub patches: Vec<Patch>,
    /// Point numbers, grouped by patch, ascending in each.
    pub points: Vec<u32>,
    /// `N_I(x_p)` (-).
    pub(super) value: Vec<f64>,
    /// `∇N_I(x_p)` (1/m).
    pub(super) gradient: Vec<[f64; D]>,
    /// Radius of the points (m), in the order of `points`; empty without hoop strain.
    pub(super) radius: Vec<f64>,
    /// What the points weigh in integrals (m³), as volume when seeded, in the order of `points`.
    pub weight: Vec<f64>,
    /// Where the gradients of a cell reach beyond its own nodes; absent where they do not.
    pub reach: Option<Arc<Reach>>,
}

/// The arrays of one patch, to be filled.
pub(super) struct Slot<'a, const D: usize> {
    pub(super) patch: &'a Patch,
    pub(super) value: &'a mut [f64],
    pub(super) gradient: &'a mut [[f64; D]],
    pub(super) radius: &'a mut [f64],
}

/// The entries of one point.
#[derive(Clone, Copy)]
pub struct Entries<'a, const D: usize> {
    /// The number of the point.
    pub point: usize,
    /// What the point weighs in integrals (m³), as volume when seeded.
    pub weight: f64,
    /// `N_I` for the nodes of the cell; other functions have no value.
    pub value: &'a [f64],
    pub(super) gradient: &'a [[f64; D]],
    /// `1 / r`, zero without hoop strain.
    pub(super) hoop: f64,
}

impl<const D: usize> Stencil<D> {
    /// The numbers of the points of a patch.
    pub fn points(&self, patch: &Patch) -> &[u32] {
        &self.points[patch.first_point as usize..(patch.first_point + patch.point_count) as usize]
    }

    /// The entries of the points of a patch, in order.
    pub fn entries<K: Kinematics<D>>(&self, patch: &Patch) -> impl Iterator<Item = Entries<'_, D>> {
        let first = patch.first_point as usize;
        let (nodes, functions) = (patch.node_count as usize, patch.function_count as usize);
        (0..patch.point_count as usize).map(move |k| {
            let (value, gradient) = (patch.first_value + k * nodes, patch.first_gradient + k * functions);
            Entries {
                point: self.points[first + k] as usize,
                weight: self.weight[first + k],
                value: &self.value[value..value + nodes],
                gradient: &self.gradient[gradient..gradient + functions],
                hoop: if K::HOOP { 1.0 / self.radius[first + k] } else { 0.0 },
            }
        })
    }
}

impl<const D: usize> Stencil<D> {
    /// Gives the points their weights (m³), by number.
    pub fn weigh(&mut self, weight: &[f64]) {
        for (own, &p) in self.weight.iter_mut().zip(&self.points) {
            *own = weight[p as usize];
        }
    }

    /// The arrays of each patch, so that patches can be filled in parallel.
    pub(super) fn slots(&mut self) -> Vec<Slot<'_, D>> {
        let mut slots = Vec::with_capacity(self.patches.len());
        let (mut value, mut gradient) = (&mut self.value[..], &mut self.gradient[..]);
        let mut radius = &mut self.radius[..];
        for patch in &self.patches {
            let (v, g, r);
            (v, value) = value.split_at_mut((patch.point_count * patch.node_count) as usize);
            (g, gradient) = gradient.split_at_mut((patch.point_count * patch.function_count) as usize);
            let radii = radius.len().min(patch.point_count as usize);
            (r, radius) = radius.split_at_mut(radii);
            slots.push(Slot { patch, value: v, gradient: g, radius: r });
        }
        slots
    }

    /// The coefficients of the patch's functions for a field on the nodes.
    #[inline]
    pub fn gather(&self, mesh: &Mesh<D>, patch: &Patch, field: &[[f64; D]]) -> [[f64; D]; MAX_NODES] {
        let nodes = mesh.cells.nodes(patch.cell as usize);
        if let Some(reach) = &self.reach {
            return reach.gather(patch.cell, nodes.len(), field);
        }
        let mut local = [[0.0; D]; MAX_NODES];
        for (local, &n) in local.iter_mut().zip(nodes) {
            *local = field[n as usize];
        }
        local
    }
}

impl<const D: usize> Entries<'_, D> {
    /// The gradient of function `i` of the patch.
    pub fn gradient(&self, i: usize) -> Gradient<D> {
        Gradient { g: self.gradient[i], hoop: self.value.get(i).map_or(0.0, |n| self.hoop * n) }
    }

    /// The number of functions, values or none.
    pub fn functions(&self) -> usize {
        self.gradient.len()
    }
}
