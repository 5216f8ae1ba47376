//! The weights and gradients of points, cell by cell.

use super::extension::Extension;
use super::support::{MAX_FUNCTIONS, Support};
use crate::kinematics::{Gradient, Kinematics};
use crate::mesh::Mesh;
use crate::tensor::Tensor;
use std::ops::Deref;
use std::sync::Arc;

/// The points of one cell and the nodes they act on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellPoints {
    /// The cell, and with it the nodes and the coupling.
    pub cell: u32,
    /// The points: `Interpolation::points[first_point..first_point + point_count]`.
    pub first_point: u32,
    pub point_count: u32,
    /// The nodes of the cell itself.
    pub shape_count: u32,
    /// The nodes that the points act on, those of the cell first: [`Interpolation::nodes`].
    pub node_count: u32,
    /// Number of local functions: one for each of those nodes, and further functions that a scheme needs for its gradients.
    pub function_count: u32,
    /// Where the values of the first point begin; those of each point follow node by node.
    pub(super) first_value: usize,
    /// Where the gradients of the first point begin; those of each point follow function by function.
    pub(super) first_gradient: usize,
    /// Where the shape functions of the first point begin, if they are kept apart.
    pub(super) first_shape: usize,
}

/// Weights and gradients of all points, on the reference configuration: the grid as last restored.
#[derive(Clone, Debug, Default)]
pub struct Interpolation<const D: usize> {
    /// Ascending by cell.
    pub filled: Vec<CellPoints>,
    /// Point numbers, grouped by cell, ascending in each.
    pub points: Vec<u32>,
    /// `N_I(x_p)` (-).
    pub(super) value: Vec<f64>,
    /// `∇N_I(x_p)` (1/m).
    pub(super) gradient: Vec<[f64; D]>,
    /// The gradients that strains are taken with (1/m), in the order of `gradient`; empty where they are those.
    pub(super) strain_gradient: Vec<[f64; D]>,
    /// The shape functions of the cells themselves (-) and their gradients (1/m), point by point; empty where they are the first ones
    /// of the above.
    pub(super) shape: Vec<f64>,
    pub(super) shape_gradient: Vec<[f64; D]>,
    /// Radius of the points (m), in the order of `points`; empty without hoop strain.
    pub(super) radius: Vec<f64>,
    /// Integration weights (m³) in the configuration at seeding, in the order of `points`.
    pub weight: Vec<f64>,
    /// The extended support of the gradients, beyond the nodes coupled in the matrix; `None` for schemes without one.
    pub extension: Option<Arc<Extension>>,
    /// The nodes that the points of each cell act on; absent where they are those of the cell.
    pub support: Option<Arc<Support>>,
}

/// The arrays of one cell, to be filled.
pub(super) struct Slot<'a, const D: usize> {
    pub(super) cell_points: &'a CellPoints,
    pub(super) value: &'a mut [f64],
    pub(super) gradient: &'a mut [[f64; D]],
    /// Empty where strains are taken with `gradient`.
    pub(super) strain_gradient: &'a mut [[f64; D]],
    /// Empty where the shape functions of the cell are not kept apart.
    pub(super) shape: &'a mut [f64],
    pub(super) shape_gradient: &'a mut [[f64; D]],
    pub(super) radius: &'a mut [f64],
}

/// The entries of one point.
#[derive(Clone, Copy)]
pub struct Entries<'a, const D: usize> {
    /// The number of the point.
    pub point: usize,
    /// Integration weight (m³) in the configuration at seeding.
    pub weight: f64,
    /// `N_I` for the nodes that the point acts on; other functions have no value.
    pub value: &'a [f64],
    /// The shape functions of the cell itself (-), in which fields that are continuous from cell to cell by themselves are given, and
    /// their gradients (1/m).
    pub shape: &'a [f64],
    pub shape_gradient: &'a [[f64; D]],
    pub(super) gradient: &'a [[f64; D]],
    /// The gradients that strains are taken with, where these are others.
    pub(super) strain_gradient: Option<&'a [[f64; D]]>,
    /// `1 / r`, zero without hoop strain.
    pub(super) hoop: f64,
}

impl<const D: usize> Interpolation<D> {
    /// The points of a cell by its number; `None` without any.
    pub fn of_cell(&self, cell: u32) -> Option<&CellPoints> {
        let found = self.filled.binary_search_by_key(&cell, |cell_points| cell_points.cell).ok()?;
        Some(&self.filled[found])
    }

    /// The numbers of the points in a cell by its number.
    pub fn points_in(&self, cell: u32) -> &[u32] {
        self.of_cell(cell).map_or(&[], |cell_points| self.points(cell_points))
    }

    /// The numbers of the points of a cell.
    pub fn points(&self, cell_points: &CellPoints) -> &[u32] {
        &self.points[cell_points.first_point as usize..(cell_points.first_point + cell_points.point_count) as usize]
    }

    /// The entries of the points of a cell, in order.
    #[inline]
    pub fn entries<K: Kinematics<D>>(&self, cell_points: &CellPoints) -> impl Iterator<Item = Entries<'_, D>> {
        let first = cell_points.first_point as usize;
        let (nodes, functions) = (cell_points.node_count as usize, cell_points.function_count as usize);
        let shapes = cell_points.shape_count as usize;
        (0..cell_points.point_count as usize).map(move |k| {
            let (value, gradient) = (cell_points.first_value + k * nodes, cell_points.first_gradient + k * functions);
            let strain_gradient = self.strain_gradient.get(gradient..gradient + functions);
            let (value, gradient) = (&self.value[value..value + nodes], &self.gradient[gradient..gradient + functions]);
            let (shape, shape_gradient) = if self.shape.is_empty() {
                (&value[..shapes], &gradient[..shapes])
            } else {
                let own = cell_points.first_shape + k * shapes;
                (&self.shape[own..own + shapes], &self.shape_gradient[own..own + shapes])
            };
            Entries {
                point: self.points[first + k] as usize,
                weight: self.weight[first + k],
                value,
                shape,
                shape_gradient,
                gradient,
                strain_gradient,
                hoop: if K::HOOP { 1.0 / self.radius[first + k] } else { 0.0 },
            }
        })
    }
}

impl<const D: usize> Interpolation<D> {
    /// Whether strains are taken with other gradients than forces act through.
    pub fn strains_apart(&self) -> bool {
        !self.strain_gradient.is_empty()
    }

    /// Gives the points their weights (m³), by number.
    pub fn weigh(&mut self, weight: &[f64]) {
        for (own, &p) in self.weight.iter_mut().zip(&self.points) {
            *own = weight[p as usize];
        }
    }

    /// The arrays of each cell, so that cells can be filled in parallel.
    pub(super) fn slots(&mut self) -> Vec<Slot<'_, D>> {
        let mut slots = Vec::with_capacity(self.filled.len());
        let (mut value, mut gradient) = (&mut self.value[..], &mut self.gradient[..]);
        let mut strain_gradient = &mut self.strain_gradient[..];
        let (mut shape, mut shape_gradient) = (&mut self.shape[..], &mut self.shape_gradient[..]);
        let mut radius = &mut self.radius[..];
        for cell_points in &self.filled {
            let (v, g, strain, s, sg, r);
            (v, value) = value.split_at_mut((cell_points.point_count * cell_points.node_count) as usize);
            (g, gradient) = gradient.split_at_mut((cell_points.point_count * cell_points.function_count) as usize);
            (strain, strain_gradient) = strain_gradient.split_at_mut(strain_gradient.len().min(g.len()));
            let shapes = shape.len().min((cell_points.point_count * cell_points.shape_count) as usize);
            (s, shape) = shape.split_at_mut(shapes);
            (sg, shape_gradient) = shape_gradient.split_at_mut(shapes);
            let radii = radius.len().min(cell_points.point_count as usize);
            (r, radius) = radius.split_at_mut(radii);
            slots.push(Slot {
                cell_points,
                value: v,
                gradient: g,
                strain_gradient: strain,
                shape: s,
                shape_gradient: sg,
                radius: r,
            });
        }
        slots
    }

    /// The nodes that the points of a cell act on, those of the cell first.
    #[inline]
    pub fn nodes<'a>(&'a self, mesh: &'a Mesh<D>, cell: u32) -> &'a [u32] {
        self.support.as_ref().map_or_else(|| mesh.cells.nodes(cell as usize), |support| support.nodes(cell))
    }

    /// The coefficients of the cell's functions for a field on the nodes.
    #[inline(always)]
    pub fn gather(&self, mesh: &Mesh<D>, cell_points: &CellPoints, field: &[[f64; D]]) -> Coefficients<D> {
        let nodes = self.nodes(mesh, cell_points.cell);
        let mut local = Coefficients { values: [[0.0; D]; MAX_FUNCTIONS], count: cell_points.function_count as usize };
        match &self.extension {
            Some(extension) => extension.gather(cell_points.cell, nodes.len(), field, &mut local.values),
            None => local.values.iter_mut().zip(nodes).for_each(|(local, &n)| *local = field[n as usize]),
        }
        local
    }
}

/// A coefficient for each function of a cell.
pub struct Coefficients<const D: usize> {
    values: [[f64; D]; MAX_FUNCTIONS],
    count: usize,
}

impl<const D: usize> Deref for Coefficients<D> {
    type Target = [[f64; D]];

    #[inline]
    fn deref(&self) -> &[[f64; D]] {
        &self.values[..self.count]
    }
}

impl<const D: usize> Entries<'_, D> {
    /// The gradient of function `i` of the cell that forces act through.
    pub fn gradient(&self, i: usize) -> Gradient<D> {
        self.with_hoop(i, self.gradient[i])
    }

    /// The gradient of function `i` of the cell that strains are taken with: [`Entries::gradient`] in most schemes.
    pub fn strain_gradient(&self, i: usize) -> Gradient<D> {
        self.with_hoop(i, self.strain_gradient.unwrap_or(self.gradient)[i])
    }

    /// Whether strains are taken with other gradients than forces act through.
    pub fn strains_apart(&self) -> bool {
        self.strain_gradient.is_some()
    }

    fn with_hoop(&self, i: usize, g: [f64; D]) -> Gradient<D> {
        Gradient { g, hoop: self.value.get(i).map_or(0.0, |n| self.hoop * n) }
    }

    /// As [`Entries::deformation`], by the gradients that forces act through.
    pub fn deformation_of_forces<K: Kinematics<D>>(&self, u: &[[f64; D]]) -> Tensor {
        let mut f = Tensor::identity();
        for (i, u) in u.iter().enumerate().take(self.functions()) {
            K::deform(&mut f, u, &self.gradient(i));
        }
        f
    }

    /// The gradients that strains are taken with, on the grid deformed by the inverse of `inverse`, in a buffer; `forces`, those that
    /// forces act through, where they are the same.
    #[inline]
    pub fn strains<'b, K: Kinematics<D>>(
        &self,
        forces: &'b [Gradient<D>],
        inverse: &Tensor,
        buffer: &'b mut Vec<Gradient<D>>,
    ) -> &'b [Gradient<D>] {
        if !self.strains_apart() {
            return forces;
        }
        buffer.clear();
        buffer.extend((0..forces.len()).map(|i| K::push_forward(&self.strain_gradient(i), inverse)));
        buffer
    }

    /// `I + Σ u ⊗ ∇N`, given the coefficients of the functions.
    #[inline]
    pub fn deformation<K: Kinematics<D>>(&self, u: &[[f64; D]]) -> Tensor {
        let mut f = Tensor::identity();
        for (i, u) in u.iter().enumerate().take(self.functions()) {
            K::deform(&mut f, u, &self.strain_gradient(i));
        }
        f
    }

    /// The number of functions, values or none.
    pub fn functions(&self) -> usize {
        self.gradient.len()
    }
}
