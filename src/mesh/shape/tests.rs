//! One property test for all shapes.

use super::*;

/// Points inside each parametric domain, away from symmetric places.
fn samples(kind: CellKind) -> Vec<[f64; 3]> {
    let raw = [[0.11, 0.23, 0.0], [0.57, 0.31, 0.0], [0.05, 0.9, 0.0], [1.0 / 3.0, 0.2, 0.0]];
    raw.iter().map(|p| if kind.is_simplex() { *p } else { [2.0 * p[0] - 1.0, 1.0 - 2.0 * p[1], 0.0] }).collect()
}

#[test]
fn nodal_delta_partition_of_unity_and_gradients() {
    for kind in CellKind::ALL {
        let count = kind.node_count();
        let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
        for (i, xi) in kind.node_coordinates().iter().enumerate() {
            kind.values(xi, &mut n);
            for (j, &value) in n[..count].iter().enumerate() {
                assert!((value - f64::from(i == j)).abs() < 1e-15, "{kind:?} N{j} at node {i}");
            }
        }
        for xi in samples(kind) {
            kind.values(&xi, &mut n);
            kind.derivatives(&xi, &mut dn);
            assert!((n[..count].iter().sum::<f64>() - 1.0).abs() < 1e-14, "{kind:?}");
            for d in 0..kind.dimension() {
                assert!(dn[..count].iter().map(|g| g[d]).sum::<f64>().abs() < 1e-14, "{kind:?}");
                let h = 1e-6;
                let (mut up, mut down) = (xi, xi);
                up[d] += h;
                down[d] -= h;
                let (mut nu, mut nd) = ([0.0; MAX_NODES], [0.0; MAX_NODES]);
                kind.values(&up, &mut nu);
                kind.values(&down, &mut nd);
                for i in 0..count {
                    let difference = (nu[i] - nd[i]) / (2.0 * h);
                    assert!((difference - dn[i][d]).abs() < 1e-8, "{kind:?} dN{i}/d{d}");
                }
            }
        }
    }
}

#[test]
fn a_linear_field_has_its_exact_gradient_in_a_distorted_cell() {
    for kind in CellKind::ALL.into_iter().filter(|k| k.dimension() == 2) {
        let x: Vec<[f64; 2]> = kind
            .node_coordinates()
            .iter()
            .map(|p| [2.0 + 1.3 * p[0] + 0.2 * p[1] + 0.05 * p[0] * p[1], -1.0 + 0.1 * p[0] + 0.9 * p[1]])
            .collect();
        for xi in samples(kind) {
            let (mut n, mut grad) = ([0.0; MAX_NODES], [[0.0; 2]; MAX_NODES]);
            let det = map(kind, &x, &xi, &mut n, &mut grad);
            assert!(det > 0.0);
            let field = |x: &[f64; 2]| 3.0 + 2.0 * x[0] - 5.0 * x[1];
            let mut g = [0.0; 2];
            for (i, x) in x.iter().enumerate() {
                for d in 0..2 {
                    g[d] += grad[i][d] * field(x);
                }
            }
            assert!((g[0] - 2.0).abs() < 1e-12 && (g[1] + 5.0).abs() < 1e-12, "{kind:?} {g:?}");
        }
    }
}

#[test]
fn quadrature_integrates_its_degree() {
    for kind in CellKind::ALL.into_iter().filter(|k| k.dimension() > 0) {
        for degree in 0..=6usize {
            for a in 0..=degree {
                let b = if kind.dimension() == 2 { degree - a } else { 0 };
                let sum: f64 =
                    rule(kind, degree).iter().map(|(xi, w)| w * xi[0].powi(a as i32) * xi[1].powi(b as i32)).sum();
                let factorial = |n: usize| (1..=n).map(|k| k as f64).product::<f64>();
                let side = |n: usize| if n.is_multiple_of(2) { 2.0 / (n as f64 + 1.0) } else { 0.0 };
                let exact = match kind.dimension() {
                    1 => side(a),
                    _ if kind.is_simplex() => factorial(a) * factorial(b) / factorial(a + b + 2),
                    _ => side(a) * side(b),
                };
                assert!((sum - exact).abs() < 1e-14, "{kind:?} degree {degree}: {sum} against {exact}");
            }
        }
    }
}

#[test]
fn depth_names_the_facet_that_limits() {
    assert_eq!(CellKind::T6.depth(&[0.4, -0.1, 0.0]), (-0.1, 0));
    assert_eq!(CellKind::T6.depth(&[-0.2, 0.5, 0.0]).1, 2);
    assert_eq!(CellKind::T3.depth(&[0.7, 0.7, 0.0]).1, 1);
    assert_eq!(CellKind::Q9.depth(&[1.5, 0.0, 0.0]), (-0.25, 1));
    assert_eq!(CellKind::Q4.depth(&[-0.5, 0.0, 0.0]), (0.25, 3));
}

#[test]
fn inverse_of_small_matrices() {
    let a = [[2.0, 1.0, 0.5], [-1.0, 3.0, 0.2], [0.3, -0.7, 1.5]];
    let (b, det) = invert(&a);
    let m = nalgebra::Matrix3::from_fn(|i, j| a[i][j]);
    assert!((det - m.determinant()).abs() < 1e-14);
    let product = m * nalgebra::Matrix3::from_fn(|i, j| b[i][j]);
    assert!((product - nalgebra::Matrix3::identity()).norm() < 1e-14);
}
