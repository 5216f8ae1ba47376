//! The functions: against the recurrence of Cox and de Boor, what they reproduce, and how smooth they are.

use super::{KINDS, graded};
use crate::support::Random;
use mpm::interpolation::{BSpline, Basis, Jump};
use mpm::kinematics::PlaneStrain;
use mpm::mesh::Mesh;
use mpm::mesh::faces::Face;
use mpm::mesh::shape::{CellKind, MAX_NODES, map, map_second};
use mpm::system::LinearConstraints;

/// The different values of a coordinate of the corners, ascending.
fn knots(mesh: &Mesh<2>, d: usize) -> Vec<f64> {
    let corners = (0..mesh.cells.len()).flat_map(|c| &mesh.cells.nodes(c)[..4]);
    let mut out: Vec<f64> = corners.map(|&n| mesh.nodes[n as usize][d]).collect();
    out.sort_unstable_by(f64::total_cmp);
    out.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    out
}

/// The B-spline `k` of a degree on the knots `t` at `x` by the recurrence of Cox and de Boor, zero over zero being zero.
fn cox_de_boor(t: &[f64], k: usize, degree: usize, x: f64) -> f64 {
    if degree == 0 {
        return f64::from(u8::from(t[k] <= x && x < t[k + 1]));
    }
    let part = |from: usize, by: f64| {
        let length = t[from + degree] - t[from];
        if length > 0.0 { by / length * cox_de_boor(t, from, degree - 1, x) } else { 0.0 }
    };
    part(k, x - t[k]) + part(k + 1, t[k + degree + 1] - x)
}

/// The nodal values of the function of a control.
fn function(constraints: &LinearConstraints, control: u32, nodes: usize) -> Vec<f64> {
    let value = |n: u32| constraints.of_node(n).iter().filter(|(m, _)| *m == control).map(|(_, by)| by).sum();
    (0..nodes as u32).map(value).collect()
}

/// The numbers of the controls: nodes that have a row in the left inverse.
fn controls(constraints: &LinearConstraints, nodes: usize) -> Vec<u32> {
    (0..nodes as u32).filter(|&n| !constraints.of_control(n).is_empty()).collect()
}

/// One function a control, those of Cox and de Boor with open knots at the grid lines, whatever the spacing and also with a single cell.
#[test]
fn functions_are_those_of_cox_and_de_boor() {
    let grids = [(5, 4, 1.0), (6, 3, 1.3), (1, 2, 0.8), (1, 1, 1.0), (3, 2, 1.7)];
    for (kind, (nx, ny, ratio)) in KINDS.into_iter().flat_map(|kind| grids.map(|grid| (kind, grid))) {
        let degree = kind.order();
        let mesh = graded(kind, 3.0, 2.0, nx, ny, ratio);
        let constraints = BSpline.constraints(&mesh).unwrap();
        let controls = controls(&constraints, mesh.nodes.len());
        assert_eq!(controls.len(), (nx + degree) * (ny + degree));
        let open = [0, 1].map(|d| {
            let x = knots(&mesh, d);
            let (first, last) = (x[0], x[x.len() - 1]);
            [vec![first; degree], x, vec![last; degree]].concat()
        });
        // The places of the controls along each direction, ascending as the functions are.
        let places = [0, 1].map(|d| {
            let mut places: Vec<f64> = controls.iter().map(|&n| mesh.nodes[n as usize][d]).collect();
            places.sort_unstable_by(f64::total_cmp);
            places.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
            places
        });
        let mut random = Random(3);
        let mut worst = 0f64;
        for &control in &controls {
            let number = [0, 1].map(|d| {
                let own = mesh.nodes[control as usize][d];
                let number = places[d].iter().position(|place| (place - own).abs() < 1e-9).unwrap();
                // Its Greville abscissa is the mean of the inner knots; of cubic splines where these are evenly spaced.
                let greville = open[d][number + 1..=number + degree].iter().sum::<f64>() / degree as f64;
                assert!((greville - own).abs() < 1e-9 || degree == 3 && ratio != 1.0);
                number
            });
            let values = function(&constraints, control, mesh.nodes.len());
            for c in 0..mesh.cells.len() {
                let nodes = mesh.cells.nodes(c);
                let x: Vec<[f64; 2]> = nodes.iter().map(|&n| mesh.nodes[n as usize]).collect();
                let xi = [0.999 * random.next(), 0.999 * random.next(), 0.0];
                let (mut n, mut gradient) = ([0.0; MAX_NODES], [[0.0; 2]; MAX_NODES]);
                map(kind, &x, &xi, &mut n, &mut gradient);
                let place = [0, 1].map(|d| x.iter().zip(&n).map(|(x, n)| x[d] * n).sum::<f64>());
                let found: f64 = nodes.iter().zip(&n).map(|(&m, n)| values[m as usize] * n).sum();
                let exact: f64 = (0..2).map(|d| cox_de_boor(&open[d], number[d], degree, place[d])).product();
                worst = worst.max((found - exact).abs());
            }
        }
        println!("{kind:?}, {nx} × {ny}, ratio {ratio}: {worst:.1e} off Cox–de Boor");
        assert!(worst < 1e-13, "{worst:e}");
    }
}

/// What the field of the controls that a nodal field has is off it, at the nodes.
fn lost(mesh: &Mesh<2>, constraints: &LinearConstraints, field: impl Fn([f64; 2]) -> f64) -> f64 {
    let control =
        |m: u32| constraints.of_control(m).iter().map(|&(n, by)| by * field(mesh.nodes[n as usize])).sum::<f64>();
    let value = |n: u32| constraints.of_node(n).iter().map(|&(m, by)| by * control(m)).sum::<f64>();
    (0..mesh.nodes.len() as u32).map(|n| (value(n) - field(mesh.nodes[n as usize])).abs()).fold(0.0, f64::max)
}

/// The functions sum to one, and constants, linear, biquadratic and, of third degree, bicubic fields are among them; of a linear field the controls are
/// its values at their nodes, of cubic splines on an even grid.
#[test]
fn fields_of_their_degree_are_exact() {
    for (kind, ratio) in KINDS.into_iter().flat_map(|kind| [(kind, 1.0), (kind, 1.25)]) {
        let mesh = graded(kind, 3.0, 2.0, 5, 4, ratio);
        let constraints = BSpline.constraints(&mesh).unwrap();
        for n in 0..mesh.nodes.len() as u32 {
            let sum: f64 = constraints.of_node(n).iter().map(|(_, by)| by).sum();
            assert!((sum - 1.0).abs() < 1e-14, "{sum}");
            assert!(constraints.of_node(n).iter().all(|(_, by)| *by > 0.0));
            let linear = |x: [f64; 2]| 1.0 + 2.0 * x[0] - 3.0 * x[1];
            let row = constraints.of_control(n);
            let control: f64 = row.iter().map(|&(m, by)| by * linear(mesh.nodes[m as usize])).sum();
            let off = (control - linear(mesh.nodes[n as usize])).abs();
            assert!(row.is_empty() || off < 1e-13 || kind == CellKind::Q16 && ratio != 1.0, "{off:e}");
        }
        for field in [
            |_: [f64; 2]| 1.0,
            |[x, y]: [f64; 2]| 2.0 * x - 3.0 * y,
            |[x, y]: [f64; 2]| x * x - 0.7 * x * y + 1.3 * y * y,
            |[x, y]: [f64; 2]| x * x * y * y - x * y * y,
        ] {
            let lost = lost(&mesh, &constraints, field);
            assert!(lost < 2e-13, "{kind:?}: {lost:e}");
        }
        let cubic = lost(&mesh, &constraints, |[x, y]| x * x * x * y * y * y - x * y * y + 2.0 * y * y * y);
        assert!(cubic < 1e-12 || kind == CellKind::Q9, "{cubic:e}");
    }
}

/// Gradients have no jump across cells whatever the controls, and of cubic splines neither have second derivatives. The next ones normal to the edge
/// have: what the ghost penalty sees.
#[test]
fn derivatives_are_continuous_across_cells() {
    KINDS.into_iter().for_each(smooth);
}

fn smooth(kind: CellKind) {
    let mesh = graded(kind, 3.0, 2.0, 5, 4, 1.2);
    let constraints = BSpline.constraints(&mesh).unwrap();
    let mut random = Random(7);
    let control: Vec<f64> = mesh.nodes.iter().map(|_| random.next()).collect();
    let value = |n: u32| constraints.of_node(n).iter().map(|&(m, by)| by * control[m as usize]).sum::<f64>();
    let (mut kink, mut bend) = (0f64, 0f64);
    for face in &mpm::mesh::faces::Faces::of(&mesh).inner {
        let [a, b] = face.cells.map(|c| mesh.cells.nodes(c as usize));
        let shared: Vec<u32> = a.iter().filter(|n| b.contains(n)).copied().collect();
        let normal = usize::from((mesh.nodes[shared[0] as usize][0] - mesh.nodes[shared[1] as usize][0]).abs() > 1e-9);
        for &node in &shared {
            let sides = [a, b].map(|nodes| {
                let x: Vec<[f64; 2]> = nodes.iter().map(|&n| mesh.nodes[n as usize]).collect();
                let own = nodes.iter().position(|&n| n == node).unwrap();
                let xi = kind.node_coordinates()[own];
                let (mut g, mut s) = ([[0.0; 2]; MAX_NODES], [[[0.0; 2]; 2]; MAX_NODES]);
                map_second(kind, &x, &xi, &mut g, &mut s);
                nodes.iter().zip(g.iter().zip(&s)).fold([0.0; 3], |[x, y, nn], (&n, (g, s))| {
                    let u = value(n);
                    [x + u * g[0], y + u * g[1], nn + u * s[normal][normal]]
                })
            });
            let jump = |i: usize| (sides[0][i] - sides[1][i]).abs();
            kink = kink.max(jump(0)).max(jump(1));
            bend = bend.max(jump(2));
        }
    }
    let energy = |nodal: &dyn Fn(u32) -> f64| -> f64 {
        let faces = mpm::mesh::faces::Faces::of(&mesh);
        faces.inner.iter().map(|face| quadratic_form(&mesh, face, nodal)).fold(0.0, f64::max)
    };
    let [spline, polynomial] = [energy(&value), energy(&|n| mesh.nodes[n as usize][0].powi(kind.order() as i32))];
    println!(
        "{kind:?}: jump of the gradient {kink:.1e}, of the second derivative {bend:.1e}, ghost penalty {spline:.1e}, {polynomial:.1e}"
    );
    assert!(kink < 1e-11, "{kink:e}");
    assert!(if kind == CellKind::Q9 { bend > 1.0 } else { bend < 1e-9 }, "{kind:?}: {bend:e}");
    assert!(spline > 1.0 && polynomial < 1e-10 * spline, "{kind:?}: {spline:e} {polynomial:e}");
}

/// What the ghost penalty of a face is of a nodal field.
fn quadratic_form(mesh: &Mesh<2>, face: &Face, value: &dyn Fn(u32) -> f64) -> f64 {
    let u: Vec<f64> = face.nodes(mesh).map(value).collect();
    let form = Jump::of::<2, PlaneStrain>(mesh, face).form;
    form.chunks_exact(u.len()).zip(&u).map(|(row, a)| a * row.iter().zip(&u).map(|(k, b)| k * b).sum::<f64>()).sum()
}
