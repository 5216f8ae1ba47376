//! The plain material point method: a point sees the shape functions of its cell.

use super::{Patch, Stencil};
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::shape::{self, MAX_NODES};
use rayon::prelude::*;

/// Fills `stencil` for points in `cell` at the parametric coordinates `xi`, given per point.
pub fn fill<const D: usize, K: Kinematics<D>>(stencil: &mut Stencil<D>, mesh: &Mesh<D>, cell: &[u32], xi: &[[f64; 3]]) {
    group(stencil, mesh, cell);
    let entries = stencil.patches.last().map_or(0, |p| p.first_entry + (p.point_count * p.function_count) as usize);
    stencil.value.clear();
    stencil.value.resize(entries, 0.0);
    stencil.gradient.clear();
    stencil.gradient.resize(entries, [0.0; D]);
    stencil.radius.clear();
    if K::HOOP {
        stencil.radius.resize(stencil.points.len(), 0.0);
    }
    // One slice of each array a patch, so that the patches can be filled in parallel.
    let mut slots = Vec::with_capacity(stencil.patches.len());
    let (mut value, mut gradient) = (&mut stencil.value[..], &mut stencil.gradient[..]);
    let mut radius = &mut stencil.radius[..];
    for patch in &stencil.patches {
        let count = (patch.point_count * patch.function_count) as usize;
        let (v, g);
        (v, value) = value.split_at_mut(count);
        (g, gradient) = gradient.split_at_mut(count);
        let r;
        (r, radius) = radius.split_at_mut(if K::HOOP { patch.point_count as usize } else { 0 });
        slots.push((patch, v, g, r));
    }
    let points = &stencil.points;
    slots.into_par_iter().for_each(|(patch, value, gradient, radius)| {
        let cell = patch.cell as usize;
        let count = patch.function_count as usize;
        let mut x = [[0.0; D]; MAX_NODES];
        for (x, &n) in x.iter_mut().zip(mesh.cells.nodes(cell)) {
            *x = mesh.nodes[n as usize];
        }
        for k in 0..patch.point_count as usize {
            let point = points[patch.first_point as usize + k] as usize;
            let range = k * count..(k + 1) * count;
            let (n, grad) = (&mut value[range.clone()], &mut gradient[range]);
            shape::map(mesh.cells.kind[cell], &x[..count], &xi[point], n, grad);
            if K::HOOP {
                radius[k] = n.iter().zip(&x).map(|(n, x)| n * x[0]).sum();
            }
        }
    });
}

/// Groups the points by cell.
fn group<const D: usize>(stencil: &mut Stencil<D>, mesh: &Mesh<D>, cell: &[u32]) {
    let mut count = vec![0u32; mesh.cells.len() + 1];
    for &c in cell {
        count[c as usize + 1] += 1;
    }
    stencil.patches.clear();
    let mut first_entry = 0;
    for c in 0..mesh.cells.len() {
        let points = count[c + 1];
        count[c + 1] += count[c];
        if points > 0 {
            let function_count = mesh.cells.nodes(c).len() as u32;
            let first_point = count[c];
            stencil.patches.push(Patch {
                cell: c as u32,
                first_point,
                point_count: points,
                function_count,
                first_entry,
            });
            first_entry += (points * function_count) as usize;
        }
    }
    stencil.points.clear();
    stencil.points.resize(cell.len(), 0);
    for (p, &c) in cell.iter().enumerate() {
        stencil.points[count[c as usize] as usize] = p as u32;
        count[c as usize] += 1;
    }
}
