//! Dual-domain material point gradients: continuous over the edges of cells.
//!
//! `∇̄N_I = ∇N_I + Σ_a ψ_a(x) (G_aI − g_aI)`, with the cell's own gradients `g_a = ∇N(x_a)` at its nodes and the
//! smoothed ones `G_a` there (`smoothing`), blended by `ψ_a` (`blend`). After Zhang, Ma & Giguere (2011), with
//! `ψ_a = (1 − α) S_a`; the smoothing functions are the cell's own, which keeps the order of quadratic cells. The
//! smoothing adds, for each node `a` and direction `j`, one function without value and with the gradient
//! `ψ_a e_j` to those of a cell. Hoop strain stays `N_I / r`.

mod blend;
mod smoothing;

use super::{Basis, Interpolation, Located};
use crate::mesh::shape::CellKind;
use blend::{Blend, smoothed_nodes};
use rayon::prelude::*;
use std::sync::Arc;

/// The scheme.
#[derive(Clone, Copy, Debug)]
pub struct Ddmp;

impl<const D: usize> Basis<D> for Ddmp {
    fn name(&self) -> &'static str {
        "ddmp"
    }

    fn takes(&self, kind: CellKind) -> bool {
        smoothed_nodes(kind) > 0
    }

    fn of_points(&self) -> Option<&'static str> {
        Some("smooths gradients at the material points")
    }

    fn without_pore_water(&self) -> Option<&'static str> {
        Some("does not smooth the gradient of pore pressures yet")
    }

    fn fill(&self, points: &Located<D>, interpolation: &mut Interpolation<D>) {
        smooth(points, interpolation);
    }
}

/// Fills in the shape functions and, behind their gradients, those of the functions that smooth them.
fn smooth<const D: usize>(at: &Located<D>, interpolation: &mut Interpolation<D>) {
    let mesh = at.mesh;
    interpolation.fill_shapes(at, |c| D * smoothed_nodes(mesh.cells.kind[c]));
    let kinds: Vec<CellKind> =
        interpolation.filled.iter().map(|cell_points| mesh.cells.kind[cell_points.cell as usize]).collect();
    let blends: Vec<(Blend, f64)> = interpolation
        .filled
        .par_iter()
        .zip(&kinds)
        .map(|(cell_points, &kind)| {
            let x = mesh.coordinates(cell_points.cell as usize);
            Blend::new(kind, &x[..kind.node_count()], at.measure)
        })
        .collect();
    let mut volume = vec![0.0; mesh.cells.len()];
    for (cell_points, (_, v)) in interpolation.filled.iter().zip(&blends) {
        volume[cell_points.cell as usize] = *v;
    }
    let points = std::mem::take(&mut interpolation.points);
    interpolation.slots().into_par_iter().zip(&blends).for_each(|(slot, (blend, _))| {
        let (own, all) = (slot.cell_points.node_count as usize, slot.cell_points.function_count as usize);
        let numbers = &points[slot.cell_points.first_point as usize..];
        for ((n, gradient), &p) in slot.value.chunks_exact(own).zip(slot.gradient.chunks_exact_mut(all)).zip(numbers) {
            let psi = blend.at(&at.xi[p as usize], n);
            write::<D>(&mut gradient[own..], |a| psi[a]);
        }
    });
    interpolation.points = points;
    interpolation.extension = Some(Arc::new(smoothing::extension(mesh, at.active, &volume)));
}

/// The gradients `ψ_a e_j` of the functions beyond the cell's nodes.
fn write<const D: usize>(gradients: &mut [[f64; D]], psi: impl Fn(usize) -> f64) {
    for (a, gradients) in gradients.chunks_exact_mut(D).enumerate() {
        let psi = psi(a);
        for (j, gradient) in gradients.iter_mut().enumerate() {
            *gradient = [0.0; D];
            gradient[j] = psi;
        }
    }
}

#[cfg(test)]
mod tests;
