//! Points in solid cells.

use super::*;
use crate::mesh::brick::brick;

fn counts(kind: CellKind) -> &'static [u32] {
    if kind.is_simplex() { &[QUADRATURE, 4, 8, 15, 24, 64] } else { &[QUADRATURE, 1, 8, 27, 64] }
}

fn solid_kinds() -> impl Iterator<Item = CellKind> {
    CellKind::ALL.into_iter().filter(|k| k.dimension() == 3)
}

#[test]
fn the_mass_is_density_times_volume_and_grows_with_depth() {
    for kind in solid_kinds() {
        let mesh = brick(kind, [3.0, 2.0, 1.5], [3, 2, 2], 0.1, 11);
        for &count in counts(kind) {
            let points = seed(&mesh, false, &all(count, 1.7)).unwrap();
            let each = match (count, kind) {
                (QUADRATURE, CellKind::T10) => 15,
                (QUADRATURE, _) => 27,
                _ => count,
            };
            assert_eq!(points.len(), each as usize * mesh.cells.len());
            let mass: f64 = points.mass.iter().sum();
            assert!((mass / (1.7 * 9.0) - 1.0).abs() < 1e-12, "{kind:?} {count}: {mass}");
        }
        // Height is z.
        let density = Profile::growing(1.0, 0.5, 1.5);
        let seeds = [RegionSeed { region: 0, points_per_cell: 8, density }];
        let points = seed(&mesh, false, &seeds).unwrap();
        let mass: f64 = points.mass.iter().sum();
        assert!((mass / (6.0 * (1.5 + 0.25 * 1.5 * 1.5)) - 1.0).abs() < 1e-2, "{kind:?}: {mass}");
        for p in 0..points.len() {
            let expected = 1.0 + 0.5 * (1.5 - points.position[p][2]);
            assert!((points.mass[p] / points.initial_volume[p] - expected).abs() < 1e-12);
        }
    }
}

/// Gauss's theorem over the curved faces: `3 V = ∮ x · n dA`.
#[test]
fn curved_cells_keep_their_exact_volume() {
    for kind in solid_kinds() {
        let mut mesh = brick(kind, [1.0; 3], [2; 3], 0.1, 3);
        for x in &mut mesh.nodes {
            let (r, t) = (1.0 + x[0], x[1] * 0.5 * PI);
            *x = [r * t.cos(), r * t.sin(), x[2] * (1.0 + 0.1 * r.sin())];
        }
        let (facet, facets) = kind.facets();
        let mut x = Vec::new();
        for &count in counts(kind) {
            let points = seed(&mesh, false, &all(count, 1.0)).unwrap();
            for c in 0..mesh.cells.len() {
                mesh.cell_coordinates(c, &mut x);
                let sum: f64 =
                    (0..points.len()).filter(|&p| points.cell[p] as usize == c).map(|p| points.initial_volume[p]).sum();
                let mut exact = 0.0;
                for (nodes, (xi, w)) in
                    facets.iter().flat_map(|nodes| rule(facet, 6).into_iter().map(move |at| (nodes, at)))
                {
                    let (mut n, mut dn) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
                    facet.values(&xi, &mut n);
                    facet.derivatives(&xi, &mut dn);
                    let sum = |factor: &dyn Fn(usize) -> f64| {
                        [0, 1, 2].map(|d| nodes.iter().enumerate().map(|(i, &k)| factor(i) * x[k][d]).sum::<f64>())
                    };
                    let [y, a, b] = [sum(&|i| n[i]), sum(&|i| dn[i][0]), sum(&|i| dn[i][1])];
                    let normal = |d: usize| a[(d + 1) % 3] * b[(d + 2) % 3] - a[(d + 2) % 3] * b[(d + 1) % 3];
                    exact += w / 3.0 * (0..3).map(|d| y[d] * normal(d)).sum::<f64>();
                }
                assert!((sum / exact - 1.0).abs() < 1e-12, "{kind:?} {count}: {sum} {exact}");
            }
        }
    }
}

#[test]
fn points_are_inside_their_cell_and_balanced() {
    for kind in solid_kinds() {
        let mesh = brick(kind, [1.0; 3], [2; 3], 0.0, 0);
        let locator = Locator::new(&mesh);
        for &count in counts(kind) {
            let points = seed(&mesh, false, &all(count, 1.0)).unwrap();
            let each = points.initial_volume[0];
            let equal = points.initial_volume.iter().all(|v| (v / each - 1.0).abs() < 1e-12);
            let of_a_rule = [QUADRATURE, 15, 24].contains(&count);
            assert_eq!(equal, !of_a_rule, "{kind:?} {count}");
            let mut moment = [0.0; 3];
            for p in 0..points.len() {
                let found = locator.locate(&mesh, &points.position[p], None).unwrap().0;
                assert_eq!(found, points.cell[p], "{kind:?} {count}");
                for (sum, x) in moment.iter_mut().zip(points.position[p]) {
                    *sum += points.initial_volume[p] * x;
                }
            }
            assert!(moment.iter().all(|m| (m - 0.5).abs() < 1e-13), "{kind:?} {count}: {moment:?}");
        }
    }
}

#[test]
fn impossible_numbers_are_told_with_those_that_are_possible() {
    for (kind, offers) in [(CellKind::T10, "use 4, 8, 15, 24 or 64"), (CellKind::H27, "use 8, 27 or 64")] {
        let mesh = brick(kind, [1.0; 3], [1; 3], 0.0, 0);
        let message = seed(&mesh, false, &all(9, 1.0)).unwrap_err().to_string();
        assert!(message.contains("9 points") && message.contains(offers), "{message}");
    }
}
