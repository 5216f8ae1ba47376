//! Points in cells of every kind, curved ones too.

mod solid;

use super::*;
use crate::mesh::builder::rectangle;

fn plane_kinds() -> impl Iterator<Item = CellKind> {
    CellKind::ALL.into_iter().filter(|k| k.dimension() == 2)
}

/// A reproducible sequence in `[0, 1)`, equidistributed in the plane (Roberts' R2).
fn sequence(i: usize) -> [f64; 2] {
    [0.754_877_666_246_692_8, 0.569_840_290_998_053_3].map(|a| (0.5 + a * (i + 1) as f64).fract())
}

fn inside(kind: CellKind, [a, b]: [f64; 2]) -> [f64; 3] {
    match kind.is_simplex() {
        true if a + b > 1.0 => [1.0 - a, 1.0 - b, 0.0],
        true => [a, b, 0.0],
        false => [2.0 * a - 1.0, 2.0 * b - 1.0, 0.0],
    }
}

/// A quarter of a ring of radii 1 and 2: the outer edges of second-order cells are curved.
fn ring(kind: CellKind) -> Mesh<2> {
    let mut mesh = rectangle(kind, 1.0, 1.0, 3, 4, 0.15, 3);
    for x in &mut mesh.nodes {
        let (r, t) = (1.0 + x[0], x[1] * std::f64::consts::FRAC_PI_2);
        *x = [r * t.cos(), r * t.sin()];
    }
    mesh
}

#[test]
fn cells_and_coordinates_come_back_whatever_the_hint() {
    for kind in plane_kinds() {
        for mesh in [rectangle(kind, 3.0, 2.0, 7, 5, 0.25, 1), ring(kind)] {
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
                    assert!((0..2).all(|d| (at[d] - xi[d]).abs() < 1e-11), "{kind:?} {xi:?} {at:?}");
                }
            }
        }
    }
}

#[test]
fn a_point_on_an_edge_or_corner_belongs_to_the_lowest_cell() {
    for kind in plane_kinds() {
        for mesh in [rectangle(kind, 3.0, 2.0, 7, 5, 0.25, 1), ring(kind)] {
            let locator = Locator::new(&mesh);
            let count = mesh.cells.len();
            let corners = |c: usize| &mesh.cells.nodes(c)[..kind.corner_count()];
            for c in 0..count {
                for facet in kind.facets().1 {
                    for t in [0.0, 0.17, 0.5, 0.93] {
                        let place = kind.node_coordinates();
                        let xi = [0, 1, 2].map(|d| (1.0 - t) * place[facet[0]][d] + t * place[facet[1]][d]);
                        let (x, _) = position(&mesh, c as u32, &xi);
                        let ends = facet[..if t == 0.0 { 1 } else { 2 }].iter().map(|&i| mesh.cells.nodes(c)[i]);
                        let lowest = (0..count).find(|&k| ends.clone().all(|node| corners(k).contains(&node))).unwrap();
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
}

#[test]
fn a_point_just_outside_is_taken_in_and_one_farther_out_is_not() {
    for kind in plane_kinds() {
        let mesh = rectangle(kind, 3.0, 2.0, 6, 4, 0.2, 5);
        let locator = Locator::new(&mesh);
        for i in 0..200 {
            let [s, _] = sequence(i);
            for (x, out) in [
                ([3.0 * s, 0.0], [0.0, -1.0]),
                ([3.0, 2.0 * s], [1.0, 0.0]),
                ([3.0 * s, 2.0], [0.0, 1.0]),
                ([0.0, 2.0 * s], [-1.0, 0.0]),
                ([3.0, 2.0], [0.7, 0.7]),
            ] {
                let at = |d: f64| [x[0] + d * out[0], x[1] + d * out[1]];
                for hint in [None, Some(i as u32 % 24)] {
                    let (c, xi) = locator.locate(&mesh, &at(1e-10), hint).unwrap();
                    assert!(distance(&x, &position(&mesh, c, &xi).0) < 3e-10);
                    assert!(kind.depth(&xi).0 >= -1e-15);
                    assert_eq!(locator.locate(&mesh, &at(7e-10), hint), None);
                    assert_eq!(locator.locate(&mesh, &at(1e3), hint), None);
                }
            }
        }
        assert_eq!(locator.locate(&mesh, &[f64::NAN, 1.0], Some(0)), None);
        assert_eq!(locator.locate(&mesh, &[1.0, f64::INFINITY], None), None);
    }
}

#[test]
fn the_bulge_of_a_curved_edge_is_inside_and_its_chord_is_not_the_boundary() {
    let mesh = ring(CellKind::T6);
    let locator = Locator::new(&mesh);
    // On the quadratic outer edges: beyond every chord, farther out than the vertices' own polygon.
    for group in ["right", "left"] {
        for (_, nodes) in &mesh.group(group).unwrap().facets {
            let middle = mesh.nodes[nodes[2] as usize];
            let scaled = |f: f64| middle.map(|v| v * f);
            let (kept, lost) = if group == "right" { (1.0 - 1e-6, 1.0 + 1e-6) } else { (1.0 + 1e-6, 1.0 - 1e-6) };
            assert!(locator.locate(&mesh, &scaled(kept), None).is_some());
            assert!(locator.locate(&mesh, &scaled(lost), None).is_none());
        }
    }
}

#[test]
fn walks_end_at_a_re_entrant_corner_and_the_bins_take_over() {
    // An L: the straight way from the hint to the point leaves the mesh.
    let mut mesh = rectangle(CellKind::T6, 2.0, 2.0, 8, 8, 0.0, 0);
    let whole = std::mem::take(&mut mesh.cells);
    for c in 0..whole.len() {
        let hole = whole.nodes(c)[..3].iter().all(|&n| mesh.nodes[n as usize].iter().all(|&v| v >= 1.0));
        if !hole {
            mesh.cells.push(whole.kind[c], 0, whole.nodes(c));
        }
    }
    let locator = Locator::new(&mesh);
    let last = mesh.cells.len() as u32 - 1;
    for hint in 0..=last {
        assert!(locator.locate(&mesh, &[1.93, 0.91], Some(hint)).is_some());
        assert!(locator.locate(&mesh, &[0.91, 1.93], Some(hint)).is_some());
        assert_eq!(locator.locate(&mesh, &[1.2, 1.1], Some(hint)), None);
    }
}

#[test]
fn queries_run_in_parallel_and_an_empty_mesh_holds_nothing() {
    fn shared<T: Send + Sync>(_: &T) {}
    let mesh = Mesh::<2>::default();
    let locator = Locator::new(&mesh);
    shared(&locator);
    assert_eq!(locator.locate(&mesh, &[0.0, 0.0], Some(3)), None);
}

/// Bins as small as a share of each cell would take memory that grows as the square of the cells.
#[test]
fn cells_that_all_lie_on_one_another_take_no_more_bins_than_others() {
    let mut mesh = rectangle(CellKind::T3, 3.0, 2.0, 1, 1, 0.0, 0);
    for _ in 0..5000 {
        let nodes = mesh.cells.nodes(0).to_vec();
        mesh.cells.push(CellKind::T3, 0, &nodes);
    }
    let locator = Locator::new(&mesh);
    assert!(locator.bins.cells.len() <= bins::MOST * mesh.cells.len());
    assert_eq!(locator.holders(&mesh, &[2.0, 0.6]).count(), 5001);
    assert_eq!(locator.holders(&mesh, &[2.0, 0.1]).count(), 0);
}

/// Meshes without cells have a locator for every step with contact, and that of a thin plate must not have bins across it.
#[test]
fn meshes_without_extent_have_few_bins() {
    for (mesh, most) in [(Mesh::<2>::default(), 1), (rectangle(CellKind::T3, 3.0, 1e-9, 20, 1, 0.0, 0), 40)] {
        assert!(Locator::new(&mesh).bins.offset.len() <= most + 1);
    }
}
