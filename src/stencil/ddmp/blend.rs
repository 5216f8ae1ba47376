//! How smoothed gradients are blended into a cell.
//!
//! A cell adds to its own gradients `Σ_a ψ_a(x) (G_a − g_a)`: at each smoothing node `a` the smoothed gradient
//! in place of its own one. On the edges `ψ_a` is the shape function `S_a`, so that the sum is continuous; inside
//! it is free up to bubbles `b p_k`, with `b` zero on the edges.

use crate::mesh::shape::{self, CellKind, MAX_NODES, rule};
use nalgebra::{Matrix4, Vector4};
use std::sync::LazyLock;

/// Most smoothing nodes of a cell.
pub const MAX_SMOOTHED: usize = 8;
/// Most polynomials that a blend is made orthogonal to.
const MAX_TESTS: usize = 4;

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

/// The polynomials `p_k`: what the cell's own strains are made of, or as much of that as bubbles can serve.
fn tests(kind: CellKind, xi: &[f64; 3]) -> Vector4<f64> {
    let [x, y, _] = *xi;
    match kind {
        CellKind::T6 => Vector4::new(1.0 - x - y, x, y, 0.0),
        CellKind::Q4 => Vector4::new(1.0, x, y, 0.0),
        CellKind::Q9 => Vector4::new(1.0, x, y, x * y),
        _ => Vector4::new(1.0, 0.0, 0.0, 0.0),
    }
}

fn test_count(kind: CellKind) -> usize {
    match kind {
        CellKind::T6 | CellKind::Q4 => 3,
        CellKind::Q9 => MAX_TESTS,
        _ => 1,
    }
}

/// Means over the parametric domain of a kind.
struct Means {
    /// Of `b p_k p_l`; the unit matrix beyond the polynomials of the kind.
    gram: Matrix4<f64>,
    /// Of `S_a p_k`.
    shape: [Vector4<f64>; MAX_SMOOTHED],
    /// Of `(1 − b) S_a`.
    blend: [f64; MAX_SMOOTHED],
    /// Quadrature points with weights, bubble and shape functions.
    points: Vec<([f64; 3], f64, f64, [f64; MAX_NODES])>,
}

impl Means {
    fn of(kind: CellKind) -> Self {
        let rule = rule(kind, 6);
        let measure: f64 = rule.iter().map(|(_, w)| w).sum();
        let mut means = Self {
            gram: Matrix4::zeros(),
            shape: [Vector4::zeros(); MAX_SMOOTHED],
            blend: [0.0; MAX_SMOOTHED],
            points: Vec::with_capacity(rule.len()),
        };
        for (xi, weight) in rule {
            let (b, p, share) = (bubble(kind, &xi), tests(kind, &xi), weight / measure);
            let mut n = [0.0; MAX_NODES];
            kind.values(&xi, &mut n);
            means.gram += share * b * p * p.transpose();
            for a in 0..smoothed_nodes(kind) {
                means.shape[a] += share * n[a] * p;
                means.blend[a] += share * (1.0 - b) * n[a];
            }
            means.points.push((xi, weight, b, n));
        }
        for k in test_count(kind)..MAX_TESTS {
            means.gram[(k, k)] = 1.0;
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

/// The blend `ψ_a = (1 − b) S_a + c_a b` for points that weigh their volume. Its integral over the cell is the
/// cell's volume times [`share`], so that smoothing moves no force from one cell to another on the whole:
/// `∫∇̄N = ∫∇N`. In straight plane cells that needs no `c_a`.
pub struct ByVolume {
    kind: CellKind,
    amount: [f64; MAX_SMOOTHED],
}

impl ByVolume {
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

/// The least quality of a cell's points as a quadrature of bubbles, relative to the exact integrals.
const LEAST_QUALITY: f64 = 0.01;

/// The blend `ψ_a = S_a + b Σ_k c_ak p_k` for points with weights `w` that integrate well: orthogonal in them,
/// `Σ_p w_p ψ_a p_k = 0`, to the polynomials of the kind. What the weights make of a polynomial stress is then
/// what they make of it with the cell's own gradients, and strains only gain energy by the smoothing.
pub struct Orthogonal {
    coefficients: [Vector4<f64>; MAX_SMOOTHED],
}

/// What an orthogonal blend needs of a point.
#[derive(Clone, Copy, Debug, Default)]
pub struct Seen {
    bubble: f64,
    tests: Vector4<f64>,
}

impl Seen {
    pub fn new(kind: CellKind, xi: &[f64; 3]) -> Self {
        Self { bubble: bubble(kind, xi), tests: tests(kind, xi) }
    }
}

impl Orthogonal {
    /// The blend for the points of a cell: what they see, their weights and the shape functions there. Where they
    /// are too few or too ill placed, the one that is orthogonal in the exact integral.
    pub fn new<'a>(kind: CellKind, points: impl Iterator<Item = (Seen, f64, &'a [f64])>) -> Self {
        let means = means(kind);
        let (mut gram, mut shape, mut volume) = (Matrix4::zeros(), [Vector4::zeros(); MAX_SMOOTHED], 0.0);
        for (Seen { bubble, tests }, weight, n) in points {
            volume += weight;
            gram += weight * bubble * tests * tests.transpose();
            for (shape, n) in shape.iter_mut().zip(n) {
                *shape += weight * n * tests;
            }
        }
        for k in test_count(kind)..MAX_TESTS {
            gram[(k, k)] = volume;
        }
        let good = volume > 0.0 && (gram - LEAST_QUALITY * volume * means.gram).cholesky().is_some();
        let (gram, shape) = if good { (gram, &shape) } else { (means.gram, &means.shape) };
        let coefficients = match gram.cholesky() {
            Some(factor) => shape.map(|shape| -factor.solve(&shape)),
            None => [Vector4::zeros(); MAX_SMOOTHED],
        };
        Self { coefficients }
    }

    /// `ψ_a − S_a` at a point.
    pub fn correction(&self, a: usize, seen: &Seen) -> f64 {
        seen.bubble * self.coefficients[a].dot(&seen.tests)
    }
}
