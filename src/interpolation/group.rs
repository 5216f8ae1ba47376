//! Filling the functions of points, grouped by their cells.

use super::{CellPoints, Interpolation, Located, MAX_FUNCTIONS, Support};
use crate::mesh::Mesh;
use crate::mesh::shape;
use rayon::prelude::*;
use std::sync::Arc;

/// A place in a cell, and the nodes that a point there acts on.
pub struct Place<'a, const D: usize> {
    pub mesh: &'a Mesh<D>,
    /// The number of the point.
    pub point: usize,
    pub cell: usize,
    /// The nodes, those of the cell first.
    pub nodes: &'a [u32],
    /// The shape functions of the cell (-) and their gradients (1/m).
    pub shape: &'a [f64],
    pub shape_gradient: &'a [[f64; D]],
}

impl<const D: usize> Place<'_, D> {
    /// Its coordinates (m) on the grid as it was reset.
    pub fn position(&self) -> [f64; D] {
        let nodes = self.mesh.cells.nodes(self.cell);
        let term = |d| nodes.iter().zip(self.shape).map(move |(&n, shape)| shape * self.mesh.nodes[n as usize][d]);
        std::array::from_fn(|d| term(d).sum())
    }
}

impl<const D: usize> Interpolation<D> {
    /// Gives each point the shape functions of its cell, with room for the gradients of `extra(cell)` further functions.
    pub fn fill_shapes(&mut self, points: &Located<D>, extra: impl Fn(usize) -> usize) {
        let mesh = points.mesh;
        (self.extension, self.support) = (None, None);
        self.group(points, |c| {
            let nodes = mesh.cells.nodes(c).len();
            [nodes, nodes + extra(c)]
        });
        self.shape.clear();
        self.shape_gradient.clear();
        let numbers = std::mem::take(&mut self.points);
        self.slots().into_par_iter().for_each(|slot| {
            let x = mesh.coordinates(slot.cell_points.cell as usize);
            let kind = mesh.cells.kind[slot.cell_points.cell as usize];
            let (count, stride) = (slot.cell_points.node_count as usize, slot.cell_points.function_count as usize);
            for k in 0..slot.cell_points.point_count as usize {
                let point = numbers[slot.cell_points.first_point as usize + k] as usize;
                let n = &mut slot.value[k * count..(k + 1) * count];
                let gradient = &mut slot.gradient[k * stride..k * stride + count];
                shape::map(kind, &x[..count], &points.xi[point], n, gradient);
                if points.hoop {
                    slot.radius[k] = n.iter().zip(&x).map(|(n, x)| n * x[0]).sum();
                }
            }
        });
        self.points = numbers;
    }

    /// Gives each point a function for each node in `support`: `functions` writes their values (-) and gradients (1/m) at a place.
    ///
    /// # Panics
    /// Where a cell has more than 64 nodes to act on.
    pub fn fill_support(
        &mut self,
        points: &Located<D>,
        support: Support,
        functions: impl Fn(&Place<D>, &mut [f64], &mut [[f64; D]]) + Sync,
    ) {
        let mesh = points.mesh;
        let support = Arc::new(support);
        (self.extension, self.support) = (None, Some(support.clone()));
        self.group(points, |c| [support.nodes(c as u32).len(); 2]);
        let last = self.filled.last();
        let shapes = last.map_or(0, |p| p.first_shape + (p.point_count * p.shape_count) as usize);
        self.shape.clear();
        self.shape.resize(shapes, 0.0);
        self.shape_gradient.clear();
        self.shape_gradient.resize(shapes, [0.0; D]);
        let numbers = std::mem::take(&mut self.points);
        self.slots().into_par_iter().for_each(|slot| {
            let x = mesh.coordinates(slot.cell_points.cell as usize);
            let cell = slot.cell_points.cell as usize;
            let (own, count) = (slot.cell_points.shape_count as usize, slot.cell_points.node_count as usize);
            for k in 0..slot.cell_points.point_count as usize {
                let point = numbers[slot.cell_points.first_point as usize + k] as usize;
                let xi = points.xi[point];
                let n = &mut slot.shape[k * own..(k + 1) * own];
                let gradient = &mut slot.shape_gradient[k * own..(k + 1) * own];
                shape::map(mesh.cells.kind[cell], &x[..own], &xi, n, gradient);
                if points.hoop {
                    slot.radius[k] = n.iter().zip(&x).map(|(n, x)| n * x[0]).sum();
                }
                let nodes = support.nodes(slot.cell_points.cell);
                let place = Place { mesh, point, cell, nodes, shape: n, shape_gradient: gradient };
                let range = k * count..(k + 1) * count;
                functions(&place, &mut slot.value[range.clone()], &mut slot.gradient[range]);
            }
        });
        self.points = numbers;
    }

    /// Groups the points by cell and makes room for what they see, given the numbers of nodes and of functions in a cell.
    fn group(&mut self, points: &Located<D>, counts: impl Fn(usize) -> [usize; 2]) {
        let (mesh, cell) = (points.mesh, points.cell);
        let mut count = vec![0u32; mesh.cells.len() + 1];
        for &c in cell {
            count[c as usize + 1] += 1;
        }
        self.filled.clear();
        let (mut first_value, mut first_gradient, mut first_shape) = (0, 0, 0);
        for c in 0..mesh.cells.len() {
            let points = count[c + 1];
            count[c + 1] += count[c];
            if points > 0 {
                let [node_count, function_count] = counts(c).map(|n| n as u32);
                assert!(function_count as usize <= MAX_FUNCTIONS, "cell {c} has {function_count} functions");
                let (shape_count, first_point) = (mesh.cells.nodes(c).len() as u32, count[c]);
                self.filled.push(CellPoints {
                    cell: c as u32,
                    first_point,
                    point_count: points,
                    shape_count,
                    node_count,
                    function_count,
                    first_value,
                    first_gradient,
                    first_shape,
                });
                first_value += (points * node_count) as usize;
                first_gradient += (points * function_count) as usize;
                first_shape += (points * shape_count) as usize;
            }
        }
        self.value.clear();
        self.value.resize(first_value, 0.0);
        self.gradient.clear();
        self.gradient.resize(first_gradient, [0.0; D]);
        self.strain_gradient.clear();
        self.radius.clear();
        if points.hoop {
            self.radius.resize(cell.len(), 0.0);
        }
        self.weight.resize(cell.len(), 0.0);
        self.points.clear();
        self.points.resize(cell.len(), 0);
        for (p, &c) in cell.iter().enumerate() {
            self.points[count[c as usize] as usize] = p as u32;
            count[c as usize] += 1;
        }
    }
}
