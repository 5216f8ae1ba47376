//! The plain material point method: a point sees the shape functions of its cell.

use super::{Patch, Stencil};
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::shape::{self, MAX_NODES};
use rayon::prelude::*;

/// Fills `stencil` for points in `cell` at the parametric coordinates `xi`, given per point.
pub fn fill<const D: usize, K: Kinematics<D>>(stencil: &mut Stencil<D>, mesh: &Mesh<D>, cell: &[u32], xi: &[[f64; 3]]) {
    fill_with::<D, K>(stencil, mesh, cell, xi, |_| 0);
    stencil.reach = None;
}

/// As [`fill`], with room for the gradients of `extra(cell)` further functions in each cell.
pub fn fill_with<const D: usize, K: Kinematics<D>>(
    stencil: &mut Stencil<D>,
    mesh: &Mesh<D>,
    cell: &[u32],
    xi: &[[f64; 3]],
    extra: impl Fn(usize) -> usize,
) {
    group(stencil, mesh, cell, extra);
    let last = stencil.patches.last();
    let values = last.map_or(0, |p| p.first_value + (p.point_count * p.node_count) as usize);
    let gradients = last.map_or(0, |p| p.first_gradient + (p.point_count * p.function_count) as usize);
    stencil.value.clear();
    stencil.value.resize(values, 0.0);
    stencil.gradient.clear();
    stencil.gradient.resize(gradients, [0.0; D]);
    stencil.radius.clear();
    if K::HOOP {
        stencil.radius.resize(stencil.points.len(), 0.0);
    }
    let points = std::mem::take(&mut stencil.points);
    stencil.slots().into_par_iter().for_each(|slot| {
        let cell = slot.patch.cell as usize;
        let (count, stride) = (slot.patch.node_count as usize, slot.patch.function_count as usize);
        let mut x = [[0.0; D]; MAX_NODES];
        for (x, &n) in x.iter_mut().zip(mesh.cells.nodes(cell)) {
            *x = mesh.nodes[n as usize];
        }
        for k in 0..slot.patch.point_count as usize {
            let point = points[slot.patch.first_point as usize + k] as usize;
            let n = &mut slot.value[k * count..(k + 1) * count];
            let grad = &mut slot.gradient[k * stride..k * stride + count];
            shape::map(mesh.cells.kind[cell], &x[..count], &xi[point], n, grad);
            if K::HOOP {
                slot.radius[k] = n.iter().zip(&x).map(|(n, x)| n * x[0]).sum();
            }
        }
    });
    stencil.points = points;
}

/// Groups the points by cell.
fn group<const D: usize>(stencil: &mut Stencil<D>, mesh: &Mesh<D>, cell: &[u32], extra: impl Fn(usize) -> usize) {
    let mut count = vec![0u32; mesh.cells.len() + 1];
    for &c in cell {
        count[c as usize + 1] += 1;
    }
    stencil.patches.clear();
    let (mut first_value, mut first_gradient) = (0, 0);
    for c in 0..mesh.cells.len() {
        let points = count[c + 1];
        count[c + 1] += count[c];
        if points > 0 {
            let node_count = mesh.cells.nodes(c).len() as u32;
            let function_count = node_count + extra(c) as u32;
            let first_point = count[c];
            stencil.patches.push(Patch {
                cell: c as u32,
                first_point,
                point_count: points,
                node_count,
                function_count,
                first_value,
                first_gradient,
            });
            first_value += (points * node_count) as usize;
            first_gradient += (points * function_count) as usize;
        }
    }
    stencil.points.clear();
    stencil.points.resize(cell.len(), 0);
    for (p, &c) in cell.iter().enumerate() {
        stencil.points[count[c as usize] as usize] = p as u32;
        count[c as usize] += 1;
    }
}
