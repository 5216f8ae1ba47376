//! Second derivatives of the shape functions, in the cell and in space.

use super::{CellKind, MAX_NODES, invert};

impl CellKind {
    /// Second derivatives with respect to `xi` into `ddn[..node_count]`, `[j][k]` that by `ξ_j` and `ξ_k`.
    ///
    /// No shape function of order two is of more than second degree in any one coordinate, so that a central difference of
    /// first derivatives is exact whatever its step; with one of 1 nothing is lost to rounding. In third order the
    /// difference over twice the step takes off what the cubes leave: `f′ = (8 Δ₁ − Δ₂)/12`, `Δ_h = f(h) − f(−h)`.
    pub fn second_derivatives(self, xi: &[f64; 3], ddn: &mut [[[f64; 3]; 3]]) {
        let count = self.node_count();
        ddn[..count].fill([[0.0; 3]; 3]);
        // Steps, and weights of the differences over them.
        let steps: &[[f64; 2]] = if self.order() > 2 { &[[1.0, 2.0 / 3.0], [2.0, -1.0 / 12.0]] } else { &[[1.0, 0.5]] };
        for k in 0..self.dimension() {
            for [step, weight] in steps {
                let (mut above, mut below) = ([[0.0; 3]; MAX_NODES], [[0.0; 3]; MAX_NODES]);
                let (mut plus, mut minus) = (*xi, *xi);
                plus[k] += step;
                minus[k] -= step;
                self.derivatives(&plus, &mut above);
                self.derivatives(&minus, &mut below);
                for (ddn, (above, below)) in ddn[..count].iter_mut().zip(above.iter().zip(&below)) {
                    for j in 0..self.dimension() {
                        ddn[j][k] += weight * (above[j] - below[j]);
                    }
                }
            }
        }
    }
}

/// Spatial gradients (1/m) and second derivatives (1/m²) of the shape functions at `xi` of a cell with nodes at
/// `x`, one entry a node; returns the determinant of `∂x/∂ξ`, without a positive one of which they mean nothing.
///
/// `∂²N/∂x² = J⁻ᵀ (∂²N/∂ξ² − Σ_i ∂N/∂x_i ∂²x_i/∂ξ²) J⁻¹`, by differentiating `∂N/∂ξ = Jᵀ ∂N/∂x` once more.
pub fn map_second<const D: usize>(
    kind: CellKind,
    x: &[[f64; D]],
    xi: &[f64; 3],
    grad: &mut [[f64; D]],
    second: &mut [[[f64; D]; D]],
) -> f64 {
    let (mut dn, mut ddn) = ([[0.0; 3]; MAX_NODES], [[[0.0; 3]; 3]; MAX_NODES]);
    kind.derivatives(xi, &mut dn);
    kind.second_derivatives(xi, &mut ddn);
    let mut jacobian = [[0.0; D]; D];
    let mut curvature = [[[0.0; D]; D]; D];
    for ((x, dn), ddn) in x.iter().zip(&dn).zip(&ddn) {
        for i in 0..D {
            for j in 0..D {
                jacobian[i][j] += x[i] * dn[j];
                for k in 0..D {
                    curvature[i][j][k] += x[i] * ddn[j][k];
                }
            }
        }
    }
    let (inverse, determinant) = invert(&jacobian);
    for n in 0..x.len() {
        for j in 0..D {
            grad[n][j] = (0..D).map(|k| dn[n][k] * inverse[k][j]).sum();
        }
        let mut own = [[0.0; D]; D];
        for j in 0..D {
            for k in 0..D {
                own[j][k] = ddn[n][j][k] - (0..D).map(|i| grad[n][i] * curvature[i][j][k]).sum::<f64>();
            }
        }
        for a in 0..D {
            for b in 0..D {
                let pairs = (0..D).flat_map(|j| (0..D).map(move |k| (j, k)));
                second[n][a][b] = pairs.map(|(j, k)| inverse[j][a] * own[j][k] * inverse[k][b]).sum();
            }
        }
    }
    determinant
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shape::map;

    /// In cells with curved sides: against differences of the gradients, and of a linear field none at all.
    #[test]
    fn second_derivatives_in_space_are_those_of_the_gradients() {
        for kind in CellKind::ALL {
            match kind.dimension() {
                2 => check(kind, |[a, b, _]| {
                    [2.0 + 1.3 * a + 0.2 * b + 0.05 * a * b + 0.04 * b * b, -1.0 + 0.1 * a + 0.9 * b - 0.06 * a * a]
                }),
                3 => check(kind, |[a, b, c]| {
                    [
                        1.3 * a + 0.2 * b + 0.05 * a * c + 0.04 * b * b,
                        0.1 * a + 0.9 * b - 0.06 * a * a + 0.03 * c * c,
                        0.1 * b + 1.1 * c - 0.05 * a * b,
                    ]
                }),
                _ => {}
            }
        }
    }

    fn check<const D: usize>(kind: CellKind, bend: impl Fn([f64; 3]) -> [f64; D]) {
        let x: Vec<[f64; D]> = kind.node_coordinates().iter().map(|p| bend(*p)).collect();
        let xi = [0.31, 0.22, if D == 3 { 0.17 } else { 0.0 }];
        let count = x.len();
        let (mut n, mut grad, mut second) = ([0.0; MAX_NODES], [[0.0; D]; MAX_NODES], [[[0.0; D]; D]; MAX_NODES]);
        let determinant = map_second(kind, &x, &xi, &mut grad, &mut second);
        let mut same = grad;
        assert!((determinant - map(kind, &x, &xi, &mut n, &mut same)).abs() < 1e-14);
        let mut dn = [[0.0; 3]; MAX_NODES];
        kind.derivatives(&xi, &mut dn);
        let mut jacobian = [[0.0; D]; D];
        for (i, row) in jacobian.iter_mut().enumerate() {
            *row = std::array::from_fn(|j| (0..count).map(|a| x[a][i] * dn[a][j]).sum());
        }
        let (inverse, _) = invert(&jacobian);
        let h = 1e-5;
        let gradients = |k: usize, by: f64| {
            let (mut n, mut at, mut g) = ([0.0; MAX_NODES], xi, [[0.0; D]; MAX_NODES]);
            at[k] += by;
            map(kind, &x, &at, &mut n, &mut g);
            g
        };
        let slopes: [_; D] = std::array::from_fn(|k| [gradients(k, h), gradients(k, -h)]);
        for a in 0..count {
            assert!((0..D).all(|d| (grad[a][d] - same[a][d]).abs() < 1e-13));
            for (i, j) in (0..D).flat_map(|i| (0..D).map(move |j| (i, j))) {
                let slope = |k: usize| (slopes[k][0][a][i] - slopes[k][1][a][i]) / (2.0 * h);
                let difference: f64 = (0..D).map(|k| slope(k) * inverse[k][j]).sum();
                let error = (second[a][i][j] - difference).abs();
                assert!(error < 1e-8, "{kind:?}, node {a}, {i}{j}: {error:.1e}");
                let field = |x: &[f64; D]| 3.0 * x[0] - 2.0 * x[1] + x[D - 1];
                let linear: f64 = (0..count).map(|b| second[b][i][j] * field(&x[b])).sum();
                assert!(linear.abs() < 1e-12, "{kind:?}: {linear:.1e}");
            }
        }
    }
}
