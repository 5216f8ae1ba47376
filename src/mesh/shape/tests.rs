//! One property test for all shapes.

use super::*;

/// Points inside each parametric domain, away from symmetric places.
fn samples(kind: CellKind) -> Vec<[f64; 3]> {
    let raw = match kind.dimension() {
        3 => [[0.11, 0.23, 0.37], [0.57, 0.31, 0.08], [0.05, 0.2, 0.7], [1.0 / 3.0, 0.2, 0.1]],
        _ => [[0.11, 0.23, 0.0], [0.57, 0.31, 0.0], [0.05, 0.9, 0.0], [1.0 / 3.0, 0.2, 0.0]],
    };
    let in_box =
        |p: [f64; 3]| [2.0 * p[0] - 1.0, 1.0 - 2.0 * p[1], if kind.dimension() == 3 { 2.0 * p[2] - 1.0 } else { 0.0 }];
    raw.map(|p| if kind.is_simplex() { p } else { in_box(p) }).to_vec()
}

/// The kinds of cells of a mesh.
fn cells() -> impl Iterator<Item = CellKind> {
    CellKind::ALL.into_iter().filter(|k| k.dimension() >= 2)
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
    for kind in cells() {
        if kind.dimension() == 2 {
            linear_field(kind, |p| {
                [2.0 + 1.3 * p[0] + 0.2 * p[1] + 0.05 * p[0] * p[1], -1.0 + 0.1 * p[0] + 0.9 * p[1]]
            });
        } else {
            linear_field(kind, |p| {
                let [a, b, c] = *p;
                [
                    2.0 + 1.3 * a + 0.2 * b + 0.05 * a * c,
                    0.1 * a + 0.9 * b - 0.06 * b * c,
                    0.2 * a + 1.1 * c + 0.03 * a * b,
                ]
            });
        }
    }
}

fn linear_field<const D: usize>(kind: CellKind, bend: impl Fn(&[f64; 3]) -> [f64; D]) {
    let x: Vec<[f64; D]> = kind.node_coordinates().iter().map(bend).collect();
    let slope = [2.0, -5.0, 7.0];
    for xi in samples(kind) {
        let (mut n, mut grad) = ([0.0; MAX_NODES], [[0.0; D]; MAX_NODES]);
        assert!(map(kind, &x, &xi, &mut n, &mut grad) > 0.0);
        for d in 0..D {
            let field = |x: &[f64; D]| 3.0 + x.iter().zip(slope).map(|(x, s)| s * x).sum::<f64>();
            let found: f64 = x.iter().zip(&grad).map(|(x, g)| g[d] * field(x)).sum();
            assert!((found - slope[d]).abs() < 1e-12, "{kind:?} {d}: {found}");
        }
    }
}

#[test]
fn quadrature_integrates_its_degree() {
    for kind in CellKind::ALL.into_iter().filter(|k| k.dimension() > 0) {
        for degree in 0..=6usize {
            let rule = rule(kind, degree);
            assert!(rule.iter().all(|(xi, w)| *w > 0.0 && kind.depth(xi).0 > 0.0), "{kind:?} degree {degree}");
            for (a, b) in (0..=degree).flat_map(|a| (0..=degree - a).map(move |b| (a, b))) {
                // What is left goes to the last direction.
                let powers = match kind.dimension() {
                    1 => [a, 0, 0],
                    2 => [a, degree - a, 0],
                    _ => [a, b, degree - a - b],
                };
                let term = |xi: &[f64; 3]| xi.iter().zip(powers).map(|(x, n)| x.powi(n as i32)).product::<f64>();
                let sum: f64 = rule.iter().map(|(xi, w)| w * term(xi)).sum();
                let factorial = |n: usize| (1..=n).map(|k| k as f64).product::<f64>();
                let side = |n: usize| if n.is_multiple_of(2) { 2.0 / (n as f64 + 1.0) } else { 0.0 };
                let dimension = kind.dimension();
                let exact = if kind.is_simplex() {
                    powers.map(factorial).iter().product::<f64>() / factorial(powers.iter().sum::<usize>() + dimension)
                } else {
                    powers[..dimension].iter().map(|&n| side(n)).product()
                };
                assert!((sum - exact).abs() < 1e-14, "{kind:?} degree {degree}: {sum} against {exact}");
            }
        }
    }
}

/// Tetrahedra have the rules of 4 and 15 points, hexahedra three Gauss points in each direction.
#[test]
fn solid_rules_have_the_points_of_their_sources() {
    let count = |kind, degree| rule(kind, degree).len();
    assert_eq!([1, 2, 3, 5, 6].map(|degree| count(CellKind::T10, degree)), [1, 4, 15, 15, 24]);
    assert_eq!([1, 3, 5].map(|degree| count(CellKind::H27, degree)), [1, 8, 27]);
}

/// The nodes of a facet are where its kind has them, its normal points out of the cell and its functions are those of the cell.
#[test]
fn facets_are_cells_of_their_kind_seen_from_outside() {
    for kind in cells().filter(|k| k.dimension() == 3) {
        let (facet, all) = kind.facets();
        let mut seen = vec![0; kind.node_count()];
        for (number, nodes) in all.iter().enumerate() {
            assert_eq!(nodes.len(), facet.node_count());
            nodes.iter().for_each(|&n| seen[n] += 1);
            let x: Vec<[f64; 3]> = nodes.iter().map(|&n| kind.node_coordinates()[n]).collect();
            assert!(x.iter().all(|x| kind.depth(x).0 == 0.0));
            for xi in samples(facet) {
                let (mut own, mut dn, mut n) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES], [0.0; MAX_NODES]);
                facet.values(&xi, &mut own);
                facet.derivatives(&xi, &mut dn);
                let sum =
                    |factor: &dyn Fn(usize) -> f64| [0, 1, 2].map(|d| (0..x.len()).map(|i| factor(i) * x[i][d]).sum());
                let place: [f64; 3] = sum(&|i| own[i]);
                let [a, b]: [[f64; 3]; 2] = [0, 1].map(|k| sum(&|i| dn[i][k]));
                let normal = [0, 1, 2].map(|d| a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3]);
                let out = [0, 1, 2].map(|d| place[d] - kind.centre()[d]);
                assert!(normal.iter().zip(out).map(|(n, o)| n * o).sum::<f64>() > 0.0, "{kind:?} {number}");
                let (depth, limiting) = kind.depth(&place);
                assert!(depth.abs() < 1e-15 && limiting == number, "{kind:?} {number}: {depth}, {limiting}");
                kind.values(&place, &mut n);
                for (&node, own) in nodes.iter().zip(own) {
                    assert!((n[node] - own).abs() < 1e-14, "{kind:?} {number}");
                }
            }
        }
        // A corner has three faces, an edge two, the middle of a face one.
        let faces = |n: usize| kind.node_coordinates()[n].iter().filter(|x| x.abs() == 1.0).count();
        match kind {
            CellKind::T10 => assert!(seen[..4].iter().all(|&n| n == 3) && seen[4..].iter().all(|&n| n == 2)),
            _ => assert!((0..seen.len()).all(|n| seen[n] == faces(n)), "{seen:?}"),
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
    assert_eq!(CellKind::T10.depth(&[0.4, 0.4, -0.1]), (-0.1, 0));
    assert_eq!(CellKind::T10.depth(&[0.6, 0.6, 0.4]).1, 3);
    assert_eq!(CellKind::H27.depth(&[0.0, 1.5, 0.0]), (-0.25, 4));
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
