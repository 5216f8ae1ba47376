//! How smoothed gradients are blended into a cell.
//!
//! A cell adds to its own gradients `Σ_a ψ_a(x) (G_a − g_a)`: at each smoothing node `a` the smoothed gradient
//! in place of its own one. On the edges `ψ_a` is the shape function `S_a`, so that the sum is continuous.

use crate::mesh::shape::{self, CellKind, MAX_NODES, rule};
use std::sync::LazyLock;

/// Most smoothing nodes of a cell.
pub const MAX_SMOOTHED: usize = 8;

/// The nodes of a cell at which gradients are smoothed, its first ones: those on its edges. None where the kind
/// has no smoothing: such cells keep their own gradients.
pub fn smoothed_nodes(kind: CellKind) -> usize {
    match kind {
        CellKind::T3 => 3,
        CellKind::T6 => 6,
        CellKind::Q4 => 4,
        CellKind::Q9 => 8,
        _ => 0,
    }
}

/// One in the middle of the cell, zero on its edges.
fn bubble(kind: CellKind, xi: &[f64; 3]) -> f64 {
    if kind.is_simplex() {
        27.0 * xi[0] * xi[1] * (1.0 - xi[0] - xi[1])
    } else {
        (1.0 - xi[0] * xi[0]) * (1.0 - xi[1] * xi[1])
    }
}

/// Means over the parametric domain of a kind.
struct Means {
    /// Of `(1 − b) S_a`.
    blend: [f64; MAX_SMOOTHED],
    /// Quadrature points with weights, bubble and shape functions.
    points: Vec<([f64; 3], f64, f64, [f64; MAX_NODES])>,
}

impl Means {
    fn of(kind: CellKind) -> Self {
        let rule = rule(kind, 6);
        let measure: f64 = rule.iter().map(|(_, w)| w).sum();
        let mut means = Self { blend: [0.0; MAX_SMOOTHED], points: Vec::with_capacity(rule.len()) };
        for (xi, weight) in rule {
            let (b, share) = (bubble(kind, &xi), weight / measure);
            let mut n = [0.0; MAX_NODES];
            kind.values(&xi, &mut n);
            for a in 0..smoothed_nodes(kind) {
                means.blend[a] += share * (1.0 - b) * n[a];
            }
            means.points.push((xi, weight, b, n));
        }
        means
    }
}

static MEANS: LazyLock<[Means; CellKind::ALL.len()]> = LazyLock::new(|| CellKind::ALL.map(Means::of));

fn means(kind: CellKind) -> &'static Means {
    &MEANS[kind as usize]
}

/// The share of a cell's volume with which it enters the smoothed gradient of its node `a`.
pub fn share(kind: CellKind, a: usize) -> f64 {
    means(kind).blend[a]
}

/// The blend `ψ_a = (1 − b) S_a + c_a b` of a cell. Its integral over the cell is the
/// cell's volume times [`share`], so that smoothing moves no force from one cell to another on the whole:
/// `∫∇̄N = ∫∇N`. In straight plane cells that needs no `c_a`.
pub struct Blend {
    kind: CellKind,
    amount: [f64; MAX_SMOOTHED],
}

impl Blend {
    /// The blend of a cell with nodes at `x`, where volumes weigh `measure`. Returns the cell's volume too.
    pub fn new<const D: usize>(kind: CellKind, x: &[[f64; D]], measure: impl Fn(&[f64; D]) -> f64) -> (Self, f64) {
        let means = means(kind);
        let (mut n, mut gradient) = ([0.0; MAX_NODES], [[0.0; D]; MAX_NODES]);
        let (mut volume, mut bubble, mut integral) = (0.0, 0.0, [0.0; MAX_SMOOTHED]);
        for (xi, weight, b, _) in &means.points {
            let det = shape::map(kind, x, xi, &mut n, &mut gradient);
            let place = std::array::from_fn(|d| n.iter().zip(x).map(|(n, x)| n * x[d]).sum());
            let dv = weight * det * measure(&place);
            volume += dv;
            bubble += dv * b;
            for (integral, n) in integral.iter_mut().zip(&n) {
                *integral += dv * (1.0 - b) * n;
            }
        }
        let amount = std::array::from_fn(|a| (means.blend[a] * volume - integral[a]) / bubble);
        (Self { kind, amount }, volume)
    }

    /// `ψ_a` at a point with the shape functions `n`.
    pub fn at(&self, xi: &[f64; 3], n: &[f64]) -> [f64; MAX_SMOOTHED] {
        let b = bubble(self.kind, xi);
        std::array::from_fn(|a| n.get(a).map_or(0.0, |n| (1.0 - b) * n + self.amount[a] * b))
    }
}
