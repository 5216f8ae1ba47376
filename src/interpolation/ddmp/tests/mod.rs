//! Properties of the smoothed gradients on jittered meshes of each kind.

use crate::interpolation::{Basis, Ddmp, Interpolation, Mpm, integrate};
use crate::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use crate::mesh::Mesh;
use crate::mesh::builder::rectangle;
use crate::mesh::locate::Locator;
use crate::mesh::shape::{CellKind, rule};

const KINDS: [CellKind; 4] = [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q9];

/// Points in the cells of a mesh.
struct Points {
    cell: Vec<u32>,
    xi: Vec<[f64; 3]>,
    place: Vec<[f64; 2]>,
    weight: Vec<f64>,
}

fn place(mesh: &Mesh<2>, cell: u32, xi: &[f64; 3]) -> [f64; 2] {
    let mut n = [0.0; 27];
    mesh.cells.kind[cell as usize].values(xi, &mut n);
    let nodes = mesh.cells.nodes(cell as usize);
    [0, 1].map(|d| nodes.iter().zip(&n).map(|(&i, n)| n * mesh.nodes[i as usize][d]).sum())
}

/// A quadrature of each cell of `cells`.
fn in_cells<K: Kinematics<2>>(mesh: &Mesh<2>, cells: impl Iterator<Item = u32>) -> Points {
    let mut points = Points { cell: Vec::new(), xi: Vec::new(), place: Vec::new(), weight: Vec::new() };
    for c in cells {
        let kind = mesh.cells.kind[c as usize];
        let nodes: Vec<[f64; 2]> = mesh.cells.nodes(c as usize).iter().map(|&n| mesh.nodes[n as usize]).collect();
        for (xi, w) in rule(kind, 6) {
            let (mut n, mut g) = ([0.0; 27], [[0.0; 2]; 27]);
            let det = crate::mesh::shape::map(kind, &nodes, &xi, &mut n, &mut g);
            let x = place(mesh, c, &xi);
            points.cell.push(c);
            points.xi.push(xi);
            points.place.push(x);
            points.weight.push(w * det * K::measure(&x));
        }
    }
    points
}

/// A turned lattice over the whole mesh, all of one volume.
fn lattice(mesh: &Mesh<2>, spacing: f64) -> Points {
    let locator = Locator::new(mesh);
    let mut points = Points { cell: Vec::new(), xi: Vec::new(), place: Vec::new(), weight: Vec::new() };
    for i in -200..200 {
        for j in -200..200 {
            let (a, b) = (spacing * (f64::from(i) + 0.37), spacing * (f64::from(j) + 0.21));
            let x = [0.9 * a - 0.43589 * b, 0.43589 * a + 0.9 * b];
            if x[0] > 0.0 && x[0] < 1.0 && x[1] > 0.0 && x[1] < 1.0 {
                let (cell, xi) = locator.locate(mesh, &x, None).unwrap();
                points.cell.push(cell);
                points.xi.push(xi);
                points.place.push(x);
                points.weight.push(spacing * spacing);
            }
        }
    }
    points
}

fn filled<K: Kinematics<2>>(mesh: &Mesh<2>, points: &Points, scheme: &'static dyn Basis<2>) -> Interpolation<2> {
    let mut interpolation = Interpolation::default();
    let mut active = vec![false; mesh.cells.len()];
    points.cell.iter().for_each(|&c| active[c as usize] = true);
    interpolation.fill::<K>(scheme, mesh, &points.cell, &points.xi, &active);
    interpolation.weigh(&points.weight);
    interpolation
}

/// Calls `f(point, weight, node, ∇̄N)` for all points and nodes.
fn for_all<K: Kinematics<2>>(
    mesh: &Mesh<2>,
    interpolation: &Interpolation<2>,
    mut f: impl FnMut(usize, f64, usize, [f64; 2]),
) {
    for cell_points in &interpolation.filled {
        let own = cell_points.node_count as usize;
        let nodes = interpolation
            .extension
            .as_ref()
            .map_or(mesh.cells.nodes(cell_points.cell as usize), |r| r.nodes(cell_points.cell));
        let rows = interpolation.extension.as_ref().map_or(&[][..], |r| r.rows(cell_points.cell));
        for entries in interpolation.entries::<K>(cell_points) {
            for (k, &node) in nodes.iter().enumerate() {
                let mut g = if k < own { entries.gradient(k).g } else { [0.0; 2] };
                for (i, row) in rows.chunks_exact(nodes.len()).enumerate() {
                    let function = entries.gradient(own + i).g;
                    (0..2).for_each(|d| g[d] += row[k] * function[d]);
                }
                f(entries.point, entries.weight, node as usize, g);
            }
        }
    }
}

/// `∇̄u` at the points.
fn gradient_of<K: Kinematics<2>>(
    mesh: &Mesh<2>,
    interpolation: &Interpolation<2>,
    u: impl Fn(&[f64; 2]) -> f64,
) -> Vec<[f64; 2]> {
    let mut gradient = vec![[0.0; 2]; interpolation.points.len()];
    for_all::<K>(mesh, interpolation, |p, _, node, g| {
        (0..2).for_each(|d| gradient[p][d] += u(&mesh.nodes[node]) * g[d]);
    });
    gradient
}

fn mesh(kind: CellKind) -> Mesh<2> {
    rectangle(kind, 1.0, 1.0, 6, 5, 0.2, 11)
}

#[test]
fn constants_vanish_and_fields_of_the_cells_order_are_exact() {
    for kind in KINDS {
        let mesh = mesh(kind);
        let points = lattice(&mesh, 0.043);
        let interpolation = filled::<PlaneStrain>(&mesh, &points, &Ddmp);
        let quadratic = if kind.order() == 2 { 1.0 } else { 0.0 };
        let zero = gradient_of::<PlaneStrain>(&mesh, &interpolation, |_| 1.0);
        let field = |x: &[f64; 2]| 2.0 * x[0] - 3.0 * x[1] + quadratic * (x[0] * x[0] + 0.7 * x[0] * x[1]);
        let found = gradient_of::<PlaneStrain>(&mesh, &interpolation, field);
        for (p, x) in points.place.iter().enumerate() {
            let exact = [2.0 + quadratic * (2.0 * x[0] + 0.7 * x[1]), -3.0 + quadratic * 0.7 * x[0]];
            for d in 0..2 {
                assert!(zero[p][d].abs() < 1e-11, "{kind:?}: {:?}", zero[p]);
                assert!((found[p][d] - exact[d]).abs() < 1e-10, "{kind:?}: {:?}, not {exact:?}", found[p]);
            }
        }
    }
}

/// Points on both sides of an edge see the same gradient of a rough field: on straight triangles and on
/// parallelograms, whose gradients are polynomials along the edges.
#[test]
fn gradients_are_continuous_over_edges() {
    let rough = |x: &[f64; 2]| (7.0 * x[0]).sin() * (5.0 * x[1] + 1.0).cos();
    for kind in KINDS {
        let jitter = if kind.is_simplex() { 0.2 } else { 0.0 };
        let mut mesh = rectangle(kind, 1.0, 1.0, 4, 4, jitter, 3);
        mesh.nodes.iter_mut().for_each(|x| x[0] += 0.3 * x[1]);
        let faces = crate::mesh::faces::Faces::of(&mesh);
        let mut points = in_cells::<PlaneStrain>(&mesh, 0..mesh.cells.len() as u32);
        let first = points.cell.len();
        for face in &faces.inner {
            for t in [0.2, 0.71] {
                let ends = mesh.cells.kind[face.cells[0] as usize].facets().1[face.sides[0] as usize];
                let x = [0, 1].map(|d| {
                    let at = |k: usize| mesh.nodes[mesh.cells.nodes(face.cells[0] as usize)[ends[k]] as usize][d];
                    (1.0 - t) * at(0) + t * at(1)
                });
                for cell in face.cells {
                    points.cell.push(cell);
                    points.xi.push(parametric(&mesh, cell, &x));
                    points.place.push(x);
                    points.weight.push(0.0);
                }
            }
        }
        let smooth = filled::<PlaneStrain>(&mesh, &points, &Ddmp);
        let plain = filled::<PlaneStrain>(&mesh, &points, &Mpm);
        let jump = |interpolation: &Interpolation<2>| -> f64 {
            let g = gradient_of::<PlaneStrain>(&mesh, interpolation, rough);
            g[first..].chunks(2).map(|g| (g[0][0] - g[1][0]).hypot(g[0][1] - g[1][1])).fold(0.0, f64::max)
        };
        let (smooth, plain) = (jump(&smooth), jump(&plain));
        assert!(smooth < 1e-11 && plain > 0.1, "{kind:?}: {smooth:e}, plain {plain:e}");
    }
}

/// Parametric coordinates of a place in a cell with straight, parallel sides.
fn parametric(mesh: &Mesh<2>, cell: u32, x: &[f64; 2]) -> [f64; 3] {
    let kind = mesh.cells.kind[cell as usize];
    let mut xi = kind.centre();
    for _ in 0..3 {
        let nodes: Vec<[f64; 2]> = mesh.cells.nodes(cell as usize).iter().map(|&n| mesh.nodes[n as usize]).collect();
        let at = place(mesh, cell, &xi);
        let mut dn = [[0.0; 3]; 27];
        kind.derivatives(&xi, &mut dn);
        let mut jacobian = [[0.0; 2]; 2];
        for (node, dn) in nodes.iter().zip(&dn) {
            (0..2).for_each(|i| (0..2).for_each(|j| jacobian[i][j] += node[i] * dn[j]));
        }
        let (inverse, _) = crate::mesh::shape::invert(&jacobian);
        for i in 0..2 {
            xi[i] += (0..2).map(|j| inverse[i][j] * (x[j] - at[j])).sum::<f64>();
        }
    }
    xi
}

/// `Σ w ∇̄N` over a quadrature of all cells is `∫∇N`, also with a part of the mesh empty and with `2πr`.
#[test]
fn integrals_of_the_gradients_are_those_of_the_shape_functions() {
    fn check<K: Kinematics<2>>() {
        for kind in KINDS {
            let mesh = mesh(kind);
            let full = (0..mesh.cells.len() as u32).filter(|c| c % 7 != 3);
            let points = in_cells::<K>(&mesh, full.clone());
            let interpolation = filled::<K>(&mesh, &points, &Ddmp);
            let mut sum = vec![[0.0; 2]; mesh.nodes.len()];
            for_all::<K>(&mesh, &interpolation, |_, w, node, g| (0..2).for_each(|d| sum[node][d] += w * g[d]));
            for c in full {
                integrate::<2, K>(&mesh, c as usize, |w, _, gradient| {
                    for (g, &n) in gradient.iter().zip(mesh.cells.nodes(c as usize)) {
                        (0..2).for_each(|d| sum[n as usize][d] -= w * g[d]);
                    }
                });
            }
            let error = sum.iter().flatten().fold(0.0, |e: f64, s| e.max(s.abs()));
            assert!(error < 1e-12, "{kind:?}: {error:e}");
        }
    }
    check::<PlaneStrain>();
    check::<Axisymmetric>();
}

mod spectra;
