use super::*;
use crate::kinematics::{Axisymmetric, PlaneStrain};
use crate::mesh::builder::rectangle;
use std::f64::consts::{PI, TAU};

fn plane_kinds() -> impl Iterator<Item = CellKind> {
    CellKind::ALL.into_iter().filter(|k| k.dimension() == 2)
}

/// A mesh off the axis whose cells are no parallelograms but have straight edges.
fn straight(kind: CellKind) -> Mesh<2> {
    let mut mesh = rectangle(kind, 3.0, 2.0, 4, 3, 0.2, 5);
    mesh.nodes.iter_mut().for_each(|x| *x = [1.5 + x[0] + 0.3 * x[1], 0.2 * x[0] + x[1] - 4.0]);
    mesh
}

/// A quarter of a ring of radii 1 and 2 about the origin.
fn ring(kind: CellKind) -> Mesh<2> {
    let mut mesh = rectangle(kind, 1.0, 1.0, 3, 4, 0.15, 3);
    for x in &mut mesh.nodes {
        let (r, t) = (1.0 + x[0], x[1] * 0.5 * PI);
        *x = [r * t.cos(), r * t.sin()];
    }
    mesh
}

/// Moments of what lies left of a closed curve of quadratic pieces (ends and middle), by Green's theorem:
/// `∫ x^a y^b dA = ∮ x^(a+1)/(a+1) y^b dy`.
fn green(curve: &[[[f64; 2]; 3]], frame: &CellFrame, hoop: bool) -> Moments {
    let mut moments = [0.0; 6];
    for [p, m, q] in curve {
        for part in 0..8 {
            for (t, weight) in rule(CellKind::Line2, 7) {
                let t = (f64::from(part) + 0.5 * (1.0 + t[0])) / 8.0;
                let (n, d) = ([(1.0 - t) * (1.0 - 2.0 * t), 4.0 * t * (1.0 - t), t * (2.0 * t - 1.0)], t);
                let d = [4.0 * d - 3.0, 4.0 - 8.0 * d, 4.0 * d - 1.0];
                let at = |d: usize| n[0] * p[d] + n[1] * m[d] + n[2] * q[d];
                let x = frame.local(&[at(0), at(1)]);
                let dy = 0.5 * weight / 8.0 * (d[0] * p[1] + d[1] * m[1] + d[2] * q[1]) * frame.length;
                for (k, (a, b)) in [(0, 0), (1, 0), (0, 1), (2, 0), (1, 1), (0, 2)].into_iter().enumerate() {
                    let primitive = |a: i32| x[0].powi(a + 1) / f64::from(a + 1) * x[1].powi(b);
                    moments[k] += dy
                        * if hoop {
                            TAU * (frame.centre[0] * primitive(a) + frame.length * primitive(a + 1))
                        } else {
                            primitive(a)
                        };
                }
            }
        }
    }
    moments
}

fn polygon(x: &[[f64; 2]]) -> Vec<[[f64; 2]; 3]> {
    let next = |i: usize| x[(i + 1) % x.len()];
    (0..x.len()).map(|i| [x[i], [0, 1].map(|d| 0.5 * (x[i][d] + next(i)[d])), next(i)]).collect()
}

/// The part of a polygon where a function linear between consecutive corners is positive.
fn clip(corners: &[([f64; 2], f64)]) -> Vec<[f64; 2]> {
    let mut kept = Vec::new();
    for (i, (x, v)) in corners.iter().enumerate() {
        let (y, w) = corners[(i + 1) % corners.len()];
        if *v > 0.0 {
            kept.push(*x);
        }
        if (*v > 0.0) != (w > 0.0) {
            kept.push([0, 1].map(|d| (x[d] * w - y[d] * v) / (w - v)));
        }
    }
    kept
}

fn close(found: &Moments, expected: &Moments, scale: f64, what: &str) {
    for (f, e) in found.iter().zip(expected) {
        assert!((f - e).abs() <= 1e-12 * scale, "{what}: {found:?} is not {expected:?}");
    }
}

fn both(mesh: &Mesh<2>, c: usize, frame: &CellFrame) -> [(Moments, bool, f64); 2] {
    let cell = Cell::new(mesh, c, frame, is_straight(mesh, c));
    let (plane, hoop) = (cell.whole::<PlaneStrain>(), cell.whole::<Axisymmetric>());
    [(plane, false, plane[0]), (hoop, true, hoop[0])]
}

#[test]
fn whole_cells_straight_or_curved_satisfy_greens_theorem() {
    for kind in plane_kinds() {
        // Cells of third order are those of rectangular grids: curved ones are beyond the rules.
        let curved = (kind.order() <= 2).then(|| ring(kind));
        for mesh in std::iter::once(straight(kind)).chain(curved) {
            for c in 0..mesh.cells.len() {
                let frame = CellFrame::of(&mesh, c);
                let mut x = Vec::new();
                mesh.cell_coordinates(c, &mut x);
                let edge = |f: &&[usize]| match **f {
                    [a, b, m] => [x[a], x[m], x[b]],
                    _ => [x[f[0]], [0, 1].map(|d| 0.5 * (x[f[0]][d] + x[f[1]][d])), x[f[1]]],
                };
                let curve: Vec<_> = kind.facets().1.iter().map(edge).collect();
                for (moments, hoop, volume) in both(&mesh, c, &frame) {
                    close(&moments, &green(&curve, &frame, hoop), volume, &format!("{kind:?} {c} {hoop}"));
                }
            }
        }
    }
}

#[test]
fn straight_cells_are_told_from_the_others() {
    for kind in plane_kinds() {
        let mut mesh = rectangle(kind, 3.0, 2.0, 4, 3, 0.2, 0);
        mesh.nodes.iter_mut().for_each(|x| *x = [100.0 + x[0] + 0.3 * x[1], 0.2 * x[0] + x[1]]);
        assert!((0..mesh.cells.len()).all(|c| is_straight(&mesh, c)), "{kind:?}");
        let curved = ring(kind);
        assert_eq!((0..curved.cells.len()).any(|c| is_straight(&curved, c)), kind.order() == 1, "{kind:?}");
    }
}

#[test]
fn a_half_plane_cuts_every_kind_of_cell_exactly() {
    for kind in plane_kinds() {
        let mut mesh = rectangle(kind, 3.0, 2.0, 4, 3, 0.2, 5);
        mesh.nodes.iter_mut().for_each(|x| *x = [1.5 + x[0] + 0.3 * x[1], 0.2 * x[0] + x[1] - 4.0]);
        for turn in 0..12 {
            let (s, c) = (0.1 + f64::from(turn)).sin_cos();
            let level = |x: &[f64; 2]| c * (x[0] - 3.1) + s * (x[1] + 2.7);
            for cell in 0..mesh.cells.len() {
                let frame = CellFrame::of(&mesh, cell);
                let nodes = mesh.cells.nodes(cell);
                let values: Vec<f64> = nodes.iter().map(|&n| level(&mesh.nodes[n as usize])).collect();
                let corners: Vec<_> = nodes[..kind.corner_count()]
                    .iter()
                    .map(|&n| (mesh.nodes[n as usize], level(&mesh.nodes[n as usize])))
                    .collect();
                let curve = polygon(&clip(&corners));
                let it = Cell::new(&mesh, cell, &frame, is_straight(&mesh, cell));
                let what = format!("{kind:?} {turn} {cell}");
                let (plane, hoop) = (it.clipped::<PlaneStrain>(&values), it.clipped::<Axisymmetric>(&values));
                close(&plane, &green(&curve, &frame, false), it.whole::<PlaneStrain>()[0], &what);
                close(&hoop, &green(&curve, &frame, true), it.whole::<Axisymmetric>()[0], &what);
                assert!((it.clipped_volume::<PlaneStrain>(&values) - plane[0]).abs() <= 1e-14 * plane[0].max(0.01));
                assert!((it.clipped_volume::<Axisymmetric>(&values) - hoop[0]).abs() <= 1e-14 * hoop[0].max(0.1));
            }
        }
    }
}

#[test]
fn any_nodal_values_leave_the_polygons_between_their_zeros() {
    for kind in plane_kinds() {
        let mesh = straight(kind);
        let mut turn = 0.0f64;
        for cell in 0..mesh.cells.len() {
            let frame = CellFrame::of(&mesh, cell);
            let it = Cell::new(&mesh, cell, &frame, is_straight(&mesh, cell));
            for _ in 0..40 {
                let mut next = || {
                    turn += 0.754_877_666_246_692_8;
                    turn.fract() - 0.45
                };
                let values: Vec<f64> = (0..kind.node_count()).map(|_| next()).collect();
                let place = |i: &usize| (mesh.nodes[mesh.cells.nodes(cell)[*i] as usize], values[*i]);
                let curve: Vec<_> =
                    triangles(kind).iter().flat_map(|t| polygon(&clip(&t.each_ref().map(place)))).collect();
                let what = format!("{kind:?} {cell} {values:?}");
                let scale = it.whole::<Axisymmetric>()[0];
                close(&it.clipped::<PlaneStrain>(&values), &green(&curve, &frame, false), scale, &what);
                close(&it.clipped::<Axisymmetric>(&values), &green(&curve, &frame, true), scale, &what);
            }
        }
    }
}

#[test]
fn what_is_positive_and_what_is_not_make_up_the_cell_also_where_it_is_curved() {
    for kind in plane_kinds() {
        for mesh in [straight(kind), ring(kind)] {
            for c in 0..mesh.cells.len() {
                let frame = CellFrame::of(&mesh, c);
                let it = Cell::new(&mesh, c, &frame, is_straight(&mesh, c));
                let whole = it.whole::<Axisymmetric>();
                let count = kind.node_count();
                assert_eq!(it.clipped::<Axisymmetric>(&vec![-0.5; count]), [0.0; 6]);
                // In a curved quadrilateral the degree of the integrand is beyond that of the pieces' rule.
                let exact = kind.is_simplex() || mesh.nodes[0] != [1.0, 0.0];
                let tolerance = if exact { 1e-12 } else { 1e-5 };
                let values: Vec<f64> = (0..count).map(|i| (0.7 * (i + c) as f64).sin()).collect();
                let negative: Vec<f64> = values.iter().map(|v| -v).collect();
                let (a, b) = (it.clipped::<Axisymmetric>(&values), it.clipped::<Axisymmetric>(&negative));
                let full = it.clipped::<Axisymmetric>(&vec![0.5; count]);
                for k in 0..6 {
                    assert!((a[k] + b[k] - whole[k]).abs() < tolerance * whole[0], "{kind:?} {c} {k}");
                    assert!((full[k] - whole[k]).abs() < tolerance * whole[0], "{kind:?} {c} {k}");
                }
            }
        }
    }
}

#[test]
fn a_ring_has_the_volume_of_revolution() {
    let mesh = rectangle(CellKind::T6, 1.0, 1.0, 1, 1, 0.0, 0);
    for height in [1e-6, 0.3, 0.5, 0.9] {
        let (mut volume, mut first) = (0.0, 0.0);
        for c in 0..mesh.cells.len() {
            let frame = CellFrame::of(&mesh, c);
            let values: Vec<f64> = mesh.cells.nodes(c).iter().map(|&n| height - mesh.nodes[n as usize][1]).collect();
            let moments = Cell::new(&mesh, c, &frame, true).clipped::<Axisymmetric>(&values);
            volume += moments[0];
            first += moments[0] * frame.centre[0] + moments[1] * frame.length;
        }
        assert!((volume / (PI * height) - 1.0).abs() < 1e-13, "{height}: {volume}");
        // ∫ r · 2πr dr.
        assert!((first / (TAU / 3.0 * height) - 1.0).abs() < 1e-13, "{height}: {first}");
    }
}
