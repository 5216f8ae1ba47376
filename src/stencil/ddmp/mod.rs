//! Dual-domain material point gradients: continuous over the edges of cells.
//!
//! `∇̄N_I = ∇N_I + Σ_a ψ_a(x) (G_aI − g_aI)`, with the cell's own gradients `g_a = ∇N(x_a)` at its nodes and the
//! smoothed ones `G_a` there (`smoothing`), blended by `ψ_a` (`blend`). After Zhang, Ma & Giguere (2011), with
//! `ψ_a = (1 − α) S_a`; the smoothing functions are the cell's own, which keeps the order of quadratic cells. The
//! smoothing adds, for each node `a` and direction `j`, one function without value and with the gradient
//! `ψ_a e_j` to those of a cell. Hoop strain stays `N_I / r`.

mod blend;
mod smoothing;

use super::{Basis, Located, Stencil};
use crate::mesh::shape::{CellKind, MAX_NODES};
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

    fn is_of_places(&self) -> bool {
        false
    }

    fn fill(&self, points: &Located<D>, stencil: &mut Stencil<D>) {
        smooth(points, stencil);
    }
}

/// Fills in the shape functions and, behind their gradients, those of the functions that smooth them.
fn smooth<const D: usize>(at: &Located<D>, stencil: &mut Stencil<D>) {
    let mesh = at.mesh;
    stencil.fill_shapes(at, |c| D * smoothed_nodes(mesh.cells.kind[c]));
    let kinds: Vec<CellKind> = stencil.patches.iter().map(|patch| mesh.cells.kind[patch.cell as usize]).collect();
    let blends: Vec<(Blend, f64)> = stencil
        .patches
        .par_iter()
        .zip(&kinds)
        .map(|(patch, &kind)| {
            let nodes = mesh.cells.nodes(patch.cell as usize);
            let mut x = [[0.0; D]; MAX_NODES];
            for (x, &n) in x.iter_mut().zip(nodes) {
                *x = mesh.nodes[n as usize];
            }
            Blend::new(kind, &x[..nodes.len()], at.measure)
        })
        .collect();
    let mut volume = vec![0.0; mesh.cells.len()];
    for (patch, (_, v)) in stencil.patches.iter().zip(&blends) {
        volume[patch.cell as usize] = *v;
    }
    let points = std::mem::take(&mut stencil.points);
    stencil.slots().into_par_iter().zip(&blends).for_each(|(slot, (blend, _))| {
        let (own, all) = (slot.patch.node_count as usize, slot.patch.function_count as usize);
        let numbers = &points[slot.patch.first_point as usize..];
        for ((n, gradient), &p) in slot.value.chunks_exact(own).zip(slot.gradient.chunks_exact_mut(all)).zip(numbers) {
            let psi = blend.at(&at.xi[p as usize], n);
            write::<D>(&mut gradient[own..], |a| psi[a]);
        }
    });
    stencil.points = points;
    stencil.reach = Some(Arc::new(smoothing::reach(mesh, at.active, &volume)));
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
