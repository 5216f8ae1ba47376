//! Whether the material points of a cell determine what they bring to its nodes.
//!
//! The mass of the points, `Σ_p N_I N_J`, is singular where they are fewer than the nodes, and nearly so where they crowd in a part of the cell. The
//! velocities of the nodes are then anything that fits the points there, and what is small at the points may be large elsewhere.

use crate::mesh::Mesh;
use crate::mesh::shape::{CellKind, MAX_NODES, rule};
use rayon::prelude::*;

/// A cell is determined if its points weigh each field on the nodes with more than this share of what points everywhere would.
const LEAST: f64 = 0.01;

type Form = [[f64; MAX_NODES]; MAX_NODES];

/// The mean of `N_I N_J` over places, given with the shares of their weights.
fn mean(kind: CellKind, places: impl Iterator<Item = ([f64; 3], f64)>) -> Form {
    let (mut form, mut n, count) = ([[0.0; MAX_NODES]; MAX_NODES], [0.0; MAX_NODES], kind.node_count());
    for (xi, share) in places {
        kind.values(&xi, &mut n);
        for i in 0..count {
            for j in 0..count {
                form[i][j] += share * n[i] * n[j];
            }
        }
    }
    form
}

/// The cells with points that do not determine a field on their nodes, ascending: given the cell and the parametric coordinates of each point.
pub fn undetermined<const D: usize>(mesh: &Mesh<D>, cell: &[u32], parametric: &[[f64; 3]]) -> Vec<u32> {
    let mut order: Vec<usize> = (0..cell.len()).collect();
    order.sort_by_key(|&p| cell[p]);
    let of_cell: Vec<&[usize]> = order.chunk_by(|&p, &q| cell[p] == cell[q]).collect();
    let lacks = |own: &&[usize]| {
        let own_places: Vec<[f64; 3]> = own.iter().map(|&p| parametric[p]).collect();
        let c = cell[own[0]];
        (!determine(mesh.cells.kind[c as usize], &own_places)).then_some(c)
    };
    of_cell.par_iter().with_min_len(64).filter_map(lacks).collect()
}

/// Whether points at `parametric` coordinates determine a field on the nodes of a cell.
fn determine(kind: CellKind, parametric: &[[f64; 3]]) -> bool {
    let count = kind.node_count();
    if parametric.len() < count {
        return false;
    }
    let share = 1.0 / parametric.len() as f64;
    let mut form = mean(kind, parametric.iter().map(|xi| (*xi, share)));
    let all = rule(kind, 2 * kind.order());
    let whole: f64 = all.iter().map(|(_, weight)| weight).sum();
    let of_cell = mean(kind, all.iter().map(|(xi, weight)| (*xi, weight / whole)));
    for (row, of_cell) in form.iter_mut().zip(&of_cell) {
        row.iter_mut().zip(of_cell).for_each(|(value, of_cell)| *value -= LEAST * of_cell);
    }
    is_positive(&mut form, count)
}

/// Whether the first rows and columns of a symmetric form are positive definite, by Gauss's elimination.
fn is_positive(form: &mut Form, count: usize) -> bool {
    for k in 0..count {
        if form[k][k] <= 0.0 {
            return false;
        }
        for i in k + 1..count {
            let factor = form[i][k] / form[k][k];
            for j in k + 1..count {
                form[i][j] -= factor * form[k][j];
            }
        }
    }
    true
}
