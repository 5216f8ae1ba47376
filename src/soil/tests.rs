use super::*;
use crate::geometry::twice_area;
use crate::material::Profile;
use crate::mesh::builder::{rectangle, signed_unit};
use crate::mesh::shape::CellKind;
use crate::seed::{RegionSeed, seed};
use std::f64::consts::PI;

/// A grid over `[-2, 2]²` of `n` by `n` boxes, with regions by the centres of the cells, 0 without points.
fn grid(kind: CellKind, n: usize, region: impl Fn([f64; 2]) -> u16) -> Mesh<2> {
    let mut mesh = rectangle(kind, 4.0, 4.0, n, n, 0.0, 1);
    mesh.nodes.iter_mut().flatten().for_each(|x| *x -= 2.0);
    for c in 0..mesh.cells.len() {
        mesh.cells.region[c] = region(mesh.centre(c));
    }
    mesh.regions = ["air", "clay", "sand"].map(String::from).to_vec();
    mesh
}

/// A square of side 2 about the middle.
fn square(x: [f64; 2]) -> u16 {
    u16::from(x[0].abs() < 1.0 && x[1].abs() < 1.0)
}

/// The body of points that a motion has taken from where they were seeded, with a field of the place that they have now and of their
/// region.
fn body(
    mesh: &Mesh<2>,
    motion: impl Fn([f64; 2]) -> [f64; 2],
    field: impl Fn([f64; 2], u16) -> f64,
    structures: (&[[f64; 2]], &[[u32; 3]]),
) -> Body {
    let density = Profile::constant(1.0);
    let each = if mesh.cells.kind[0].is_simplex() { 12 } else { 9 };
    let regions = [1, 2].map(|region| RegionSeed { region, points_per_cell: each, density });
    let points = seed(mesh, false, &regions).unwrap();
    let position: Vec<[f64; 2]> = points.position.iter().map(|x| motion(*x)).collect();
    let of: Vec<f64> = position.iter().zip(&points.region).map(|(x, r)| field(*x, *r)).collect();
    let soil = Soil::new(mesh.clone(), &[false, true, true]);
    let values = Values { width: 1, of: &of };
    soil.body(
        &mesh.nodes,
        Cloud { position: &position, origin: &points.position, area: &points.initial_volume, values },
        structures,
    )
}

fn area(body: &Body, region: Option<u16>) -> f64 {
    let own = body.triangles.iter().zip(&body.region).filter(|(_, r)| region.is_none_or(|region| **r == region));
    own.map(|(t, _)| 0.5 * twice_area(&t.map(|i| body.places[i as usize]))).sum()
}

/// The area (m²) that four corners on 16 cells may lose: half a triangle between nodes each.
fn corners(kind: CellKind) -> f64 {
    let side = 0.25 / kind.order() as f64;
    4.0 * 0.25 * side * side
}

const NONE: (&[[f64; 2]], &[[u32; 3]]) = (&[], &[]);
const KINDS: [CellKind; 4] = [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q9];

#[test]
fn a_block_at_rest_is_its_cells_with_its_edges_and_a_linear_field() {
    for kind in KINDS {
        let linear = |x: [f64; 2], _| 3.0 - 2.0 * x[0] + 5.0 * x[1];
        let body = body(&grid(kind, 16, square), |x| x, linear, NONE);
        assert!((area(&body, None) - 4.0).abs() < 1e-12, "{kind:?}: {}", area(&body, None));
        let mut corners = 0;
        for (x, value) in body.places.iter().zip(&body.values) {
            assert!(x.iter().all(|x| x.abs() < 1.0 + 1e-12), "{kind:?}: {x:?}");
            corners += usize::from(x.iter().all(|x| x.abs() > 1.0 - 1e-12));
            // At the surface it is bounded by what the points have.
            if x.iter().all(|x| x.abs() < 0.7) {
                assert!((value - linear(*x, 1)).abs() < 1e-11, "{kind:?}: {x:?} {value}");
            }
            assert!((value - linear(*x, 1)).abs() < 7.0 * 0.25, "{kind:?}: {x:?} {value}");
        }
        assert_eq!(corners, 4, "{kind:?}");
        assert!(body.values.iter().all(|v| (-4.0..10.0).contains(v)));
    }
}

#[test]
fn a_block_that_has_moved_and_leans_has_its_area_and_a_linear_field_on_its_cut_cells() {
    for kind in KINDS {
        let mut errors = Vec::new();
        for n in [16, 32] {
            let motion = |[x, y]: [f64; 2]| [x + 0.3 * y + 0.113, y + 0.077];
            let linear = |x: [f64; 2], _| 3.0 - 2.0 * x[0] + 5.0 * x[1];
            let body = body(&grid(kind, n, square), motion, linear, NONE);
            errors.push((area(&body, None) - 4.0).abs());
            for (x, value) in body.places.iter().zip(&body.values) {
                let first = [x[0] - 0.113 - 0.3 * (x[1] - 0.077), x[1] - 0.077];
                assert!(first.iter().all(|x| x.abs() < 1.0 + 0.2 / n as f64), "{kind:?}: {first:?}");
                if first.iter().all(|x| x.abs() < 1.0 - 6.0 / n as f64) {
                    assert!((value - linear(*x, 1)).abs() < 1e-10, "{kind:?}: {x:?} {value}");
                }
            }
        }
        // What the corners lose, up to half a triangle between nodes each, is of second order.
        assert!(errors[0] < corners(kind) && errors[1] < 0.5 * errors[0], "{kind:?}: {errors:?}");
    }
}

/// A square that was pressed into a disc, evenly (Shirley & Chiu 1997): squares about the middle become circles, and every area π/4 of what it was.
fn disc(x: [f64; 2]) -> [f64; 2] {
    let [a, b] = x;
    let (r, angle) = if a.abs() > b.abs() { (a, PI / 4.0 * b / a) } else { (b, PI / 2.0 - PI / 4.0 * a / b) };
    if r == 0.0 { [0.0; 2] } else { [r * angle.cos(), r * angle.sin()] }
}

#[test]
fn the_area_of_a_disc_converges() {
    for kind in [CellKind::T6, CellKind::Q9] {
        let error = |n| {
            let body = body(&grid(kind, n, square), disc, |_, _| 1.0, NONE);
            // The map has a kink where the corners of the square came to lie: a quarter of a cell.
            let farthest = body.places.iter().map(|x| x[0].hypot(x[1])).fold(0.0, f64::max);
            assert!(farthest < 1.0 + 1.0 / n as f64, "{kind:?}: {farthest}");
            (area(&body, None) / PI - 1.0).abs()
        };
        let errors = [16, 32, 64].map(error);
        assert!(errors[0] < 0.02 && errors[2] < 0.25 * errors[0] && errors[2] < 2e-3, "{kind:?}: {errors:?}");
    }
}

/// Points that have changed places: only where they are tells of the soil, and it has no holes.
#[test]
fn soil_without_a_smooth_motion_is_where_its_points_are() {
    for kind in [CellKind::T6, CellKind::Q9] {
        let mesh = grid(kind, 16, square);
        let mut random = 5;
        let jitter = |x: [f64; 2], random: &mut u64| x.map(|x| (x + 0.02 * signed_unit(random)).clamp(-0.999, 0.999));
        let points = seed(
            &mesh,
            false,
            &[RegionSeed {
                region: 1,
                points_per_cell: if kind.is_simplex() { 12 } else { 9 },
                density: Profile::constant(1.0),
            }],
        )
        .unwrap();
        let position: Vec<[f64; 2]> = points.position.iter().map(|x| jitter(*x, &mut random)).collect();
        // Each comes from the place across the middle, or from its own: neighbours differ by as much as the block is large. Or all are said to come
        // from where there was no soil.
        let across = |(p, x): (usize, &[f64; 2])| if p % 2 == 0 { *x } else { x.map(|x| -x) };
        let mixed: Vec<[f64; 2]> = points.position.iter().enumerate().map(across).collect();
        for origin in [mixed, vec![[1.7, 1.6]; position.len()]] {
            let soil = Soil::new(mesh.clone(), &[false, true, false]);
            let of = vec![1.0; position.len()];
            let values = Values { width: 1, of: &of };
            let body = soil.body(
                &mesh.nodes,
                Cloud { position: &position, origin: &origin, area: &points.initial_volume, values },
                NONE,
            );
            // No holes: the inner part is all there.
            let inner = body.triangles.iter().map(|t| t.map(|i| body.places[i as usize]));
            let inner = inner.filter(|t| t.iter().flatten().all(|x| x.abs() < 0.75 + 1e-12));
            let inner: f64 = inner.map(|t| 0.5 * twice_area(&t)).sum();
            assert!((inner - 2.25).abs() < 1e-9, "{kind:?}: {inner}");
            let off = area(&body, None) / 4.0 - 1.0;
            assert!(off.abs() < 0.05, "{kind:?}: {off}");
        }
    }
}

#[test]
fn two_materials_keep_to_themselves() {
    for kind in KINDS {
        let layers = |x: [f64; 2]| square(x) * if x[1] > 0.25 { 2 } else { 1 };
        for by in [[0.0; 2], [0.09, -0.13]] {
            let motion = |x: [f64; 2]| [x[0] + by[0], x[1] + by[1] + 0.1 * x[0]];
            let body = body(&grid(kind, 16, layers), motion, |_, region| f64::from(region), NONE);
            for (triangle, region) in body.triangles.iter().zip(&body.region) {
                assert!(triangle.iter().all(|&i| body.values[i as usize] == f64::from(*region)), "{kind:?}");
            }
            for (region, wanted) in [(1, 2.5), (2, 1.5)] {
                let off = area(&body, Some(region)) - wanted;
                assert!(off.abs() < corners(kind), "{kind:?}, {region}: {off}");
            }
        }
    }
}

/// A structure that was pushed into a block from above, with the soil beside it where it was.
#[test]
fn the_soil_ends_at_a_structure() {
    let places = [[-0.33, 0.41], [0.37, 0.41], [0.37, 1.7], [-0.33, 1.7]];
    let corners = [[0, 1, 2], [0, 2, 3]];
    let inside = |x: &[f64; 2], by: f64| x[0] > -0.33 + by && x[0] < 0.37 - by && x[1] > 0.41 + by;
    for kind in KINDS {
        let mesh = grid(kind, 16, square);
        // What is in the way is not there.
        let motion = |x: [f64; 2]| if inside(&x, 0.0) { [x[0], 9.0] } else { x };
        let body = body(&mesh, motion, |_, _| 1.0, (&places, &corners));
        let wanted = 4.0 - 0.7 * 0.59;
        assert!((area(&body, None) / wanted - 1.0).abs() < 2e-3, "{kind:?}: {} for {wanted}", area(&body, None));
        for triangle in &body.triangles {
            let x = triangle.map(|i| body.places[i as usize]);
            let middle = [0, 1].map(|d| (x[0][d] + x[1][d] + x[2][d]) / 3.0);
            assert!(!inside(&middle, 1e-9), "{kind:?}: {middle:?}");
        }
    }
}

#[test]
fn origins_are_traced_through_a_reset() {
    let at = |i: usize| [(i % 10) as f64, (i / 10) as f64];
    let before: Vec<[f64; 2]> = (0..100).map(at).collect();
    let origins: Vec<[f64; 2]> = before.iter().map(|x| [x[0] - 3.0, x[1] + 1.0]).collect();
    let now: Vec<[f64; 2]> = before.iter().map(|x| [x[0] + 0.2, x[1] - 0.1]).collect();
    for (x, traced) in now.iter().zip(Soil::traced(&now, &before, &origins)) {
        assert!((traced[0] - x[0] + 3.0).abs() < 1e-12 && (traced[1] - x[1] - 1.0).abs() < 1e-12);
    }
}

/// Beside a gap that opens between two materials what is drawn of one is not of the other, whose points are far.
#[test]
fn two_materials_that_part_have_values_everywhere() {
    for kind in [CellKind::T6, CellKind::Q9] {
        let mesh = grid(kind, 16, |x| if x[1] < 0.0 { 2 * square(x) } else { square(x) });
        for gap in [0.3, 0.6, 0.9] {
            let motion = |x: [f64; 2]| [x[0], x[1] + if x[1] > 0.0 { gap } else { 0.0 }];
            let body = body(&mesh, motion, |_, region| f64::from(region), (&[], &[]));
            assert!(body.values.iter().all(|value| value.is_finite()), "{kind:?} {gap}: {:?}", body.values);
            for (triangle, region) in body.triangles.iter().zip(&body.region) {
                let own = triangle.iter().all(|&i| (body.values[i as usize] - f64::from(*region)).abs() < 1e-12);
                let values = triangle.map(|i| body.values[i as usize]);
                assert!(
                    own,
                    "{kind:?} {gap}: {values:?} at {:?} of region {region}",
                    triangle.map(|i| body.places[i as usize])
                );
            }
        }
    }
}
