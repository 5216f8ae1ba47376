//! How full the cells are, and integrals over whole cells.

use super::Interpolation;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::shape::{self, MAX_NODES, rule};
use crate::points::Points;

/// A cell that takes part in the solution without being full of material points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PartlyFilled {
    pub cell: u32,
    /// `1 − Σ V_p / V_cell`, in (0, 1].
    pub emptiness: f64,
}

/// Emptiness below which a cell counts as full: rounding, and the last percent that compression frees.
const FULL: f64 = 0.01;

/// The cells among those marked in `active` that are not full.
pub fn partly_filled_cells<const D: usize, K: Kinematics<D>>(
    mesh: &Mesh<D>,
    interpolation: &Interpolation<D>,
    points: &Points<D>,
    active: &[bool],
) -> Vec<PartlyFilled> {
    let mut held = vec![0.0; mesh.cells.len()];
    for cell_points in &interpolation.filled {
        for &p in interpolation.points(cell_points) {
            held[cell_points.cell as usize] += points.volume(p as usize);
        }
    }
    let partly_filled = |c: usize| {
        if !active[c] {
            return None;
        }
        let volume = || integrate::<D, K>(mesh, c, |_, _, _| {});
        let emptiness = if held[c] > 0.0 { 1.0 - held[c] / volume() } else { 1.0 };
        (emptiness > FULL).then_some(PartlyFilled { cell: c as u32, emptiness })
    };
    (0..mesh.cells.len()).filter_map(partly_filled).collect()
}

/// Calls `f(weight, N, ∇N)` at the quadrature points of a cell and returns the sum of the weights, its volume.
pub fn integrate<const D: usize, K: Kinematics<D>>(
    mesh: &Mesh<D>,
    cell: usize,
    mut f: impl FnMut(f64, &[f64], &[[f64; D]]),
) -> f64 {
    let (kind, x) = (mesh.cells.kind[cell], mesh.coordinates(cell));
    let (mut n, mut gradient) = ([0.0; MAX_NODES], [[0.0; D]; MAX_NODES]);
    let count = kind.node_count();
    let mut volume = 0.0;
    for (xi, weight) in rule(kind, 2 * kind.order()) {
        let det = shape::map(kind, &x[..count], &xi, &mut n, &mut gradient);
        let mut centre = [0.0; D];
        for (n, x) in n.iter().zip(&x).take(count) {
            for d in 0..D {
                centre[d] += n * x[d];
            }
        }
        let weight = weight * det * K::measure(&centre);
        f(weight, &n[..count], &gradient[..count]);
        volume += weight;
    }
    volume
}
