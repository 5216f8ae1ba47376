//! Points in solid cells: what holds in the plane.

use super::*;
use crate::mesh::brick::brick;

fn solid_kinds() -> impl Iterator<Item = CellKind> {
    CellKind::ALL.into_iter().filter(|k| k.dimension() == 3)
}

/// A reproducible sequence in `[0, 1)³`, equidistributed (Roberts' R3).
fn sequence(i: usize) -> [f64; 3] {
    [0.819_172_513_396_164_4, 0.671_043_606_703_789_3, 0.549_700_477_901_903_2]
        .map(|a| (0.5 + a * (i + 1) as f64).fract())
}

/// A place in the parametric domain.
fn inside(kind: CellKind, at: [f64; 3]) -> [f64; 3] {
    if !kind.is_simplex() {
        return at.map(|t| 2.0 * t - 1.0);
    }
    // The gaps between three sorted numbers are barycentric coordinates.
    let mut at = at;
    at.sort_by(f64::total_cmp);
    [at[0], at[1] - at[0], at[2] - at[1]]
}

/// A quarter of a tube of radii 1 and 2 whose upper end is not flat: edges and faces of its cells are curved.
fn tube(kind: CellKind) -> Mesh<3> {
    let mut mesh = brick(kind, [1.0; 3], [3, 4, 2], 0.1, 3);
    for x in &mut mesh.nodes {
        let (r, t) = (1.0 + x[0], x[1] * std::f64::consts::FRAC_PI_2);
        *x = [r * t.cos(), r * t.sin(), x[2] * (1.0 + 0.1 * (2.0 * r).sin())];
    }
    mesh
}

fn meshes(kind: CellKind) -> [Mesh<3>; 2] {
    [brick(kind, [3.0, 2.0, 1.5], [4, 3, 3], 0.12, 1), tube(kind)]
}

#[test]
fn cells_and_coordinates_come_back_whatever_the_hint() {
    for kind in solid_kinds() {
        for mesh in meshes(kind) {
            let locator = Locator::new(&mesh);
            let count = mesh.cells.len() as u32;
            for i in 0..2000 {
                let c = (i * 7) as u32 % count;
                let xi = inside(kind, sequence(i));
                if kind.depth(&xi).0 < 1e-6 {
                    continue;
                }
                let (x, _) = position(&mesh, c, &xi);
                for hint in [None, Some(c), Some((i * 13) as u32 % count), Some(u32::MAX)] {
                    let (found, at) = locator.locate(&mesh, &x, hint).unwrap();
                    assert_eq!(found, c, "{kind:?} {x:?} {hint:?}");
                    assert!((0..3).all(|d| (at[d] - xi[d]).abs() < 1e-10), "{kind:?} {xi:?} {at:?}");
                }
            }
        }
    }
}

#[test]
fn a_point_on_a_face_edge_or_corner_belongs_to_the_lowest_cell() {
    for kind in solid_kinds() {
        for mesh in meshes(kind) {
            let locator = Locator::new(&mesh);
            let count = mesh.cells.len();
            let corners = |c: usize| &mesh.cells.nodes(c)[..kind.corner_count()];
            let (face, faces) = kind.facets();
            let place = kind.node_coordinates();
            for (c, facet) in (0..count).flat_map(|c| faces.iter().map(move |facet| (c, facet))) {
                // Weights of the first corners of the face: at a corner, on an edge, within.
                for weights in [[1.0, 0.0, 0.0], [0.3, 0.7, 0.0], [0.25, 0.35, 0.4]] {
                    let xi = [0, 1, 2].map(|d| (0..3).map(|k| weights[k] * place[facet[k]][d]).sum());
                    let (x, _) = position(&mesh, c as u32, &xi);
                    let on = weights.iter().filter(|w| **w > 0.0).count();
                    let on = if on == 3 { face.corner_count() } else { on };
                    let shared: Vec<u32> = facet[..on].iter().map(|&i| mesh.cells.nodes(c)[i]).collect();
                    let lowest = (0..count).find(|&k| shared.iter().all(|node| corners(k).contains(node))).unwrap();
                    for hint in [None, Some(0), Some(c as u32), Some(count as u32 - 1)] {
                        let (found, at) = locator.locate(&mesh, &x, hint).unwrap();
                        assert_eq!(found as usize, lowest, "{kind:?} {x:?} {hint:?}");
                        assert!(kind.depth(&at).0 >= -1e-15);
                        assert!(distance(&x, &position(&mesh, found, &at).0) < 1e-11);
                    }
                }
            }
        }
    }
}

#[test]
fn a_point_just_outside_is_taken_in_and_one_farther_out_is_not() {
    for kind in solid_kinds() {
        let mesh = brick(kind, [3.0, 2.0, 1.0], [3, 2, 2], 0.1, 5);
        let locator = Locator::new(&mesh);
        for i in 0..100 {
            let [s, t, _] = sequence(i);
            for (x, out) in [
                ([3.0 * s, 2.0 * t, 0.0], [0.0, 0.0, -1.0]),
                ([3.0, 2.0 * s, t], [1.0, 0.0, 0.0]),
                ([3.0 * s, 2.0, t], [0.0, 1.0, 0.0]),
                ([3.0 * s, 2.0 * t, 1.0], [0.0, 0.0, 1.0]),
                ([0.0, 2.0 * s, t], [-1.0, 0.0, 0.0]),
                ([3.0, 2.0, s], [0.7, 0.7, 0.0]),
                ([3.0, 2.0, 1.0], [0.57, 0.57, 0.57]),
            ] {
                let at = |d: f64| [0, 1, 2].map(|k| x[k] + d * out[k]);
                for hint in [None, Some(i as u32 % 12)] {
                    // Moved back along the edges of the cell, farther than along the normal of its face.
                    let (c, xi) = locator.locate(&mesh, &at(5e-11), hint).unwrap();
                    assert!(distance(&x, &position(&mesh, c, &xi).0) < 3e-10);
                    assert!(kind.depth(&xi).0 >= -1e-15);
                    assert_eq!(locator.locate(&mesh, &at(7e-10), hint), None);
                    assert_eq!(locator.locate(&mesh, &at(1e3), hint), None);
                }
            }
        }
        assert_eq!(locator.locate(&mesh, &[f64::NAN, 1.0, 0.5], Some(0)), None);
        assert_eq!(locator.locate(&mesh, &[1.0, 0.5, f64::INFINITY], None), None);
    }
}

/// The middle node of an outer face lies beyond the plane through its corners, within the box of its cell.
#[test]
fn the_bulge_of_a_curved_face_is_inside() {
    for kind in solid_kinds() {
        let mesh = tube(kind);
        let locator = Locator::new(&mesh);
        for (facet, nodes) in &mesh.group("right").unwrap().facets {
            let mut n = [0.0; MAX_NODES];
            facet.values(&facet.centre(), &mut n);
            let at = |d: usize| nodes.iter().zip(&n).map(|(&node, n)| n * mesh.nodes[node as usize][d]).sum::<f64>();
            let x = [at(0), at(1), at(2)];
            let scaled = |f: f64| [f * x[0], f * x[1], x[2]];
            assert!(locator.locate(&mesh, &scaled(1.0 - 1e-6), None).is_some(), "{kind:?} {x:?}");
            assert!(locator.locate(&mesh, &scaled(1.0 + 1e-6), None).is_none(), "{kind:?} {x:?}");
        }
    }
}

/// Bézier points bound the cell: no point of it lies outside its box.
#[test]
fn boxes_hold_curved_cells() {
    for kind in solid_kinds() {
        let mesh = tube(kind);
        let mut x = Vec::new();
        for c in 0..mesh.cells.len() {
            mesh.cell_coordinates(c, &mut x);
            let (low, high) = bounds(kind, &x);
            for i in 0..200 {
                let (y, _) = position(&mesh, c as u32, &inside(kind, sequence(i)));
                assert!((0..3).all(|d| low[d] <= y[d] && y[d] <= high[d]), "{kind:?} {c} {y:?}");
            }
        }
    }
}
