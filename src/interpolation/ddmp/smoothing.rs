//! Smoothed gradients at the nodes: what each cell sees of its neighbours.
//!
//! `G_a = Σ_c W_c g_c(a) / Σ_c W_c` over the cells with points that have the node `a`: their own gradients there,
//! weighted by volume. A field that is quadratic on quadratic cells has its own gradient everywhere, which
//! smoothing then keeps.

use super::blend::{share, smoothed_nodes};
use crate::interpolation::Extension;
use crate::mesh::Mesh;
use crate::mesh::shape::{self, MAX_NODES};
use rayon::prelude::*;

/// The gradients of a cell's functions at its smoothing nodes, node by node.
fn own_gradients<const D: usize>(mesh: &Mesh<D>, cell: usize) -> Vec<[f64; D]> {
    let (kind, nodes) = (mesh.cells.kind[cell], mesh.cells.nodes(cell));
    let (x, mut n) = (mesh.coordinates(cell), [0.0; MAX_NODES]);
    let mut gradients = vec![[0.0; D]; smoothed_nodes(kind) * nodes.len()];
    for (row, xi) in gradients.chunks_exact_mut(nodes.len()).zip(kind.node_coordinates()) {
        shape::map(kind, &x[..nodes.len()], xi, &mut n, row);
    }
    gradients
}

/// Marks a node that the cell at hand does not act on.
const ABSENT: u32 = u32::MAX;

/// The functions of all cells: for each smoothing node `a` and direction `j` the combination
/// `(G_aI − g_aI)·e_j` of nodal values. `volume` is that of the cells with points, zero for the others; cells in
/// `active` without points act on the same nodes as if they had some, so that they can take them up.
pub fn extension<const D: usize>(mesh: &Mesh<D>, active: &[bool], volume: &[f64]) -> Extension {
    let around = mesh.cells_at_nodes(|c| active[c]);
    let own: Vec<Vec<[f64; D]>> = (0..mesh.cells.len())
        .into_par_iter()
        .map(|c| if volume[c] > 0.0 { own_gradients(mesh, c) } else { Vec::new() })
        .collect();
    let total = |node: u32| -> f64 { around[node as usize].iter().map(|&c| weight(mesh, c, node, volume)).sum() };
    let total: Vec<f64> = (0..mesh.nodes.len() as u32).into_par_iter().map(total).collect();
    let scratch = || vec![ABSENT; mesh.nodes.len()];
    let cell = |place: &mut Vec<u32>, c: usize| {
        let mut nodes = Vec::new();
        if active[c] {
            gather_nodes(mesh, &around, c, place, &mut nodes);
        }
        let mut rows = Vec::new();
        if volume[c] > 0.0 {
            rows = combinations(mesh, &around, c, volume, &own, &total, place, nodes.len());
        }
        for &n in &nodes {
            place[n as usize] = ABSENT;
        }
        (nodes, rows)
    };
    let cells: Vec<(Vec<u32>, Vec<f64>)> =
        (0..mesh.cells.len()).into_par_iter().with_min_len(64).map_init(scratch, cell).collect();
    let mut extension = Extension { node_start: vec![0], row_start: vec![0], ..Extension::default() };
    (extension.node_count, extension.share_start, extension.gradient_start) = (mesh.nodes.len(), vec![0], vec![0]);
    for (c, (nodes, rows)) in cells.into_iter().enumerate() {
        if volume[c] > 0.0 {
            let smoothed = &mesh.cells.nodes(c)[..smoothed_nodes(mesh.cells.kind[c])];
            let share = |&n: &u32| weight(mesh, c as u32, n, volume) / total[n as usize];
            extension.share.extend(smoothed.iter().map(share));
            extension.gradient.extend(own[c].iter().flatten());
        }
        extension.share_start.push(extension.share.len() as u32);
        extension.gradient_start.push(extension.gradient.len() as u32);
        extension.node.extend(nodes);
        extension.combination.extend(rows);
        extension.node_start.push(extension.node.len() as u32);
        extension.row_start.push(extension.combination.len() as u32);
    }
    extension
}

/// What a cell weighs at its node; zero where it does not smooth there.
fn weight<const D: usize>(mesh: &Mesh<D>, cell: u32, node: u32, volume: &[f64]) -> f64 {
    let c = cell as usize;
    let kind = mesh.cells.kind[c];
    match mesh.cells.nodes(c).iter().position(|&n| n == node) {
        Some(a) if a < smoothed_nodes(kind) => share(kind, a) * volume[c],
        _ => 0.0,
    }
}

/// The nodes that a cell acts on, its own first; `place` says where each stands.
fn gather_nodes<const D: usize>(
    mesh: &Mesh<D>,
    around: &[Vec<u32>],
    c: usize,
    place: &mut [u32],
    nodes: &mut Vec<u32>,
) {
    let own = mesh.cells.nodes(c);
    let mut take = |n: u32| {
        if place[n as usize] == ABSENT {
            place[n as usize] = nodes.len() as u32;
            nodes.push(n);
        }
    };
    own.iter().for_each(|&n| take(n));
    for &a in &own[..smoothed_nodes(mesh.cells.kind[c])] {
        for &other in &around[a as usize] {
            if smoothed_nodes(mesh.cells.kind[other as usize]) > 0 {
                mesh.cells.nodes(other as usize).iter().for_each(|&n| take(n));
            }
        }
    }
}

/// The rows of a cell that acts on `count` nodes.
#[expect(clippy::too_many_arguments, reason = "the cell and its surroundings")]
fn combinations<const D: usize>(
    mesh: &Mesh<D>,
    around: &[Vec<u32>],
    c: usize,
    volume: &[f64],
    own: &[Vec<[f64; D]>],
    total: &[f64],
    place: &[u32],
    count: usize,
) -> Vec<f64> {
    let smoothed = &mesh.cells.nodes(c)[..smoothed_nodes(mesh.cells.kind[c])];
    let mut rows = vec![0.0; smoothed.len() * D * count];
    for ((a, &node), rows) in smoothed.iter().enumerate().zip(rows.chunks_exact_mut(D * count)) {
        let mut add = |cell: usize, a: usize, factor: f64| {
            let nodes = mesh.cells.nodes(cell);
            for (&n, gradient) in nodes.iter().zip(&own[cell][a * nodes.len()..]) {
                for d in 0..D {
                    rows[d * count + place[n as usize] as usize] += factor * gradient[d];
                }
            }
        };
        add(c, a, -1.0);
        for &other in &around[node as usize] {
            let weight = weight(mesh, other, node, volume);
            if weight > 0.0
                && let Some(b) = mesh.cells.nodes(other as usize).iter().position(|&n| n == node)
            {
                add(other as usize, b, weight / total[node as usize]);
            }
        }
    }
    rows
}
