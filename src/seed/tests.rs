mod rest;
mod solid;

use super::*;
use crate::mesh::builder::rectangle;
use crate::mesh::locate::Locator;
use crate::mesh::shape::rule;
use std::f64::consts::PI;

const TRIANGLE_COUNTS: [u32; 8] = [3, 4, 6, 7, 9, 12, 16, 25];
const BOX_COUNTS: [u32; 5] = [1, 4, 9, 16, 25];

fn counts(kind: CellKind) -> &'static [u32] {
    if kind.is_simplex() { &TRIANGLE_COUNTS } else { &BOX_COUNTS }
}

fn plane_kinds() -> impl Iterator<Item = CellKind> {
    CellKind::ALL.into_iter().filter(|k| k.dimension() == 2)
}

fn all(points_per_cell: u32, density: f64) -> Vec<RegionSeed> {
    vec![RegionSeed { region: 0, points_per_cell, density: Profile::constant(density) }]
}

/// A quarter of a ring of radii 1 and 2 about the origin.
fn ring(kind: CellKind, n: usize) -> Mesh<2> {
    let mut mesh = rectangle(kind, 1.0, 1.0, n, n, 0.15, 3);
    for x in &mut mesh.nodes {
        let (r, t) = (1.0 + x[0], x[1] * 0.5 * PI);
        *x = [r * t.cos(), r * t.sin()];
    }
    mesh
}

/// What the message offers is what the schema of a case allows.
#[test]
fn a_number_of_points_that_cells_cannot_have_is_told_with_those_they_can() {
    let mesh = rectangle(CellKind::Q9, 1.0, 1.0, 1, 1, 0.0, 3);
    let error = seed(&mesh, false, &all(6, 1.0)).unwrap_err().to_string();
    assert!(error.contains("6 points are not possible in its Q9 cells; use 4, 9, 16 or 25"), "{error}");
    let error = no_rule(&mesh, &all(5, 1.0)[0], CellKind::T6).to_string();
    assert!(error.contains("use 3, 4, 6, 7, 9, 12, 16 or 25"), "{error}");
}

#[test]
fn the_mass_is_density_times_area_or_revolved_volume() {
    for kind in plane_kinds() {
        let mesh = rectangle(kind, 3.0, 2.0, 5, 4, 0.2, 11);
        for &count in counts(kind) {
            for (axisymmetric, measure) in [(false, 6.0), (true, PI * 9.0 * 2.0)] {
                let points = seed(&mesh, axisymmetric, &all(count, 1.7)).unwrap();
                assert_eq!(points.len(), count as usize * mesh.cells.len());
                let mass: f64 = points.mass.iter().sum();
                assert!((mass / (1.7 * measure) - 1.0).abs() < 1e-12, "{kind:?} {count}: {mass}");
            }
        }
    }
}

#[test]
fn finite_elements_have_points_that_integrate_degree_4() {
    for kind in plane_kinds() {
        let mesh = rectangle(kind, 3.0, 2.0, 5, 4, 0.0, 11);
        let points = seed(&mesh, false, &all(QUADRATURE, 1.0)).unwrap();
        assert_eq!(points.len(), mesh.cells.len() * if kind.is_simplex() { 6 } else { 9 });
        let terms = points.position.iter().zip(&points.initial_volume).map(|(x, v)| v * x[0].powi(2) * x[1].powi(2));
        assert!((terms.sum::<f64>() / (9.0 * 8.0 / 3.0) - 1.0).abs() < 1e-12, "{kind:?}");
    }
}

#[test]
fn curved_cells_keep_their_exact_measure() {
    for kind in plane_kinds().filter(|k| k.order() == 2) {
        let mesh = ring(kind, 3);
        let mut x = Vec::new();
        for &count in counts(kind) {
            let points = seed(&mesh, true, &all(count, 1.0)).unwrap();
            for c in 0..mesh.cells.len() {
                mesh.cell_coordinates(c, &mut x);
                let sum: f64 =
                    (0..points.len()).filter(|&p| points.cell[p] as usize == c).map(|p| points.mass[p]).sum();
                // Pappus over the boundary: 2π ∫ r dA = π ∮ r² dy, by Gauss on the quadratic edges.
                let mut exact = 0.0;
                for facet in kind.facets().1 {
                    let edge: Vec<[f64; 2]> = facet.iter().map(|&i| x[i]).collect();
                    for (xi, w) in rule(CellKind::Line3, 6) {
                        let (mut n, mut dn) = ([0.0; 3], [[0.0; 3]; 3]);
                        CellKind::Line3.values(&xi, &mut n);
                        CellKind::Line3.derivatives(&xi, &mut dn);
                        let r: f64 = edge.iter().zip(&n).map(|(x, n)| n * x[0]).sum();
                        let dy: f64 = edge.iter().zip(&dn).map(|(x, dn)| dn[0] * x[1]).sum();
                        exact += PI * w * r * r * dy;
                    }
                }
                assert!((sum / exact - 1.0).abs() < 1e-13, "{kind:?} {count}: {sum} {exact}");
            }
        }
    }
}

#[test]
fn points_are_equal_inside_their_cell_and_balanced() {
    for kind in plane_kinds() {
        let mesh = rectangle(kind, 1.0, 1.0, 2, 2, 0.0, 0);
        let locator = Locator::new(&mesh);
        for &count in counts(kind) {
            let points = seed(&mesh, false, &all(count, 1.0)).unwrap();
            let each = points.initial_volume[0];
            let equal = points.initial_volume.iter().all(|v| (v / each - 1.0).abs() < 1e-13);
            assert_eq!(equal, ![6, 7, 12].contains(&count), "{kind:?} {count}");
            for p in 0..points.len() {
                let found = locator.locate(&mesh, &points.position[p], None).unwrap().0;
                assert_eq!(found, points.cell[p]);
            }
            // First moments of the points are those of the square.
            let mut moment = [0.0; 2];
            for (x, v) in points.position.iter().zip(&points.initial_volume) {
                moment = [moment[0] + v * x[0], moment[1] + v * x[1]];
            }
            assert!((moment[0] - 0.5).abs() < 1e-14 && (moment[1] - 0.5).abs() < 1e-14);
        }
    }
}

#[test]
fn only_the_regions_asked_for_are_filled_each_with_its_density() {
    let mut mesh = rectangle(CellKind::T6, 2.0, 1.0, 4, 2, 0.0, 0);
    mesh.regions = ["clay", "water", "sand"].map(String::from).to_vec();
    for c in 0..mesh.cells.len() {
        mesh.cells.region[c] = (c % 3) as u16;
    }
    let sand = Profile::growing(2.0, 0.5, 1.0);
    let seeds = [
        RegionSeed { region: 0, points_per_cell: 16, density: Profile::constant(1.0) },
        RegionSeed { region: 2, points_per_cell: 3, density: sand },
    ];
    let points = seed(&mesh, false, &seeds).unwrap();
    assert!(points.region.iter().all(|&r| r != 1));
    for p in 0..points.len() {
        let density = if points.region[p] == 0 { 1.0 } else { 2.0 + 0.5 * (1.0 - points.position[p][1]) };
        assert!((points.mass[p] - density * points.initial_volume[p]).abs() < 1e-16);
    }
    assert_eq!(points.deformation.len(), points.len());
    assert_eq!(points.origin, points.position);
    assert!(points.velocity.is_empty() && points.acceleration.is_empty());
}

#[test]
fn impossible_seeds_are_refused() {
    let mesh = rectangle(CellKind::T6, 1.0, 1.0, 1, 1, 0.0, 0);
    let message = seed(&mesh, false, &all(5, 1.0)).unwrap_err().to_string();
    assert!(message.contains("region soil") && message.contains("5 points") && message.contains("16"), "{message}");
    let mut left = mesh.clone();
    left.nodes.iter_mut().for_each(|x| x[0] -= 2.0);
    assert!(seed(&left, true, &all(16, 1.0)).unwrap_err().to_string().contains("negative radius"));
    let mut inverted = mesh;
    inverted.nodes.iter_mut().for_each(|x| x[0] = -x[0]);
    assert!(seed(&inverted, false, &all(16, 1.0)).unwrap_err().to_string().contains("inverted"));
}

#[test]
fn stress_at_rest_of_layers_is_exact() {
    for kind in plane_kinds() {
        let mut mesh = rectangle(kind, 2.0, 4.0, 3, 8, 0.0, 0);
        mesh.regions = vec!["sand".into(), "clay".into()];
        // Clay below y = 2, sand above; the sand's weight grows below y = 3.
        for c in 0..mesh.cells.len() {
            let nodes = mesh.cells.nodes(c);
            let top = nodes.iter().map(|&n| mesh.nodes[n as usize][1]).fold(0.0, f64::max);
            mesh.cells.region[c] = u16::from(top <= 2.0);
        }
        let soils = [
            RegionWeight { region: 0, unit_weight: Profile::growing(8.0, 3.0, 3.0) },
            RegionWeight { region: 1, unit_weight: Profile::constant(6.0) },
        ];
        let seeds = [0, 1].map(|region| RegionSeed { region, points_per_cell: 9, density: Profile::constant(1.0) });
        let points = seed(&mesh, false, &seeds).unwrap();
        let stress = k0_stress(&mesh, &soils, |_| 0.5, &points);
        for (x, s) in points.position.iter().zip(&stress) {
            let y = x[1];
            let sand = |y: f64| 8.0 * (4.0 - y) + 1.5 * (3.0 - y).max(0.0).powi(2);
            let expected = if y > 2.0 { sand(y) } else { sand(2.0) + 6.0 * (2.0 - y) };
            assert!((s[1] + expected).abs() < 1e-12 * expected, "{kind:?} {y}: {} {expected}", s[1]);
            assert_eq!((s[0], s[2]), (0.5 * s[1], 0.5 * s[1]));
            assert_eq!(s[3..], [0.0; 3]);
        }
        let clay_only = k0_stress(&mesh, &soils[1..], |_| 0.5, &points);
        assert!(clay_only.iter().zip(&points.region).all(|(s, &r)| (r == 0) == (s[1] == 0.0)));
    }
}

#[test]
fn stress_at_rest_follows_a_curved_surface_and_skips_a_gap() {
    // Under a quarter ring the soil above a point ends at the outer circle; left of x = 1 its vertical
    // leaves the soil at the inner circle.
    let mesh = ring(CellKind::T6, 24);
    let points = seed(&mesh, false, &all(4, 1.0)).unwrap();
    let soil = [RegionWeight { region: 0, unit_weight: Profile::constant(10.0) }];
    let stress = k0_stress(&mesh, &soil, |_| 1.0, &points);
    for (x, s) in points.position.iter().zip(&stress) {
        let height = (4.0 - x[0] * x[0]).max(0.0).sqrt() - x[1];
        // Piecewise quadratics keep the circle to 1e-7, worst where it is steep.
        assert!((s[1] + 10.0 * height).abs() < 1e-4, "{x:?} {} {height}", s[1]);
    }
    // Two cells one above the other with a gap between them.
    let mut mesh = rectangle(CellKind::Q4, 1.0, 3.0, 1, 3, 0.0, 0);
    mesh.regions.push("water".into());
    mesh.cells.region[1] = 1;
    let points = seed(&mesh, false, &all(1, 1.0)).unwrap();
    let stress = k0_stress(&mesh, &soil, |_| 1.0, &points);
    assert!((stress[0][1] + 15.0).abs() < 1e-13 && (stress[1][1] + 5.0).abs() < 1e-13, "{stress:?}");
}
