//! Stability: energies, the coupling with a linear pressure, and the forces of a uniform stress.

use super::{KINDS, Points, filled, for_all, in_cells, lattice, mesh};
use crate::interpolation::{Basis, Ddmp, Interpolation, Mpm};
use crate::kinematics::PlaneStrain;
use crate::mesh::Mesh;
use crate::mesh::builder::rectangle;
use crate::mesh::shape::CellKind;
use crate::seed::{RegionSeed, seed};
use nalgebra::{Cholesky, DMatrix, SymmetricEigen};

/// `count` points in each cell of `cells`, as they are seeded.
fn seeded(mesh: &Mesh<2>, count: u32, cells: impl Fn(u32) -> bool) -> Points {
    let region = RegionSeed { region: 0, points_per_cell: count, density: crate::material::Profile::constant(1.0) };
    let all = seed(mesh, false, &[region]).unwrap();
    let locator = crate::mesh::locate::Locator::new(mesh);
    let mut points = Points { cell: Vec::new(), xi: Vec::new(), place: Vec::new(), weight: Vec::new() };
    for p in (0..all.len()).filter(|&p| cells(all.cell[p])) {
        let (cell, xi) = locator.locate(mesh, &all.position[p], Some(all.cell[p])).unwrap();
        points.cell.push(cell);
        points.xi.push(xi);
        points.place.push(all.position[p]);
        points.weight.push(all.initial_volume[p]);
    }
    points
}

/// `∇̄N` at the points, one row a point and direction, each with the root of the weight.
fn operator(mesh: &Mesh<2>, interpolation: &Interpolation<2>) -> DMatrix<f64> {
    let mut b = DMatrix::zeros(2 * interpolation.points.len(), mesh.nodes.len());
    for_all::<PlaneStrain>(mesh, interpolation, |p, w, node, g| {
        (0..2).for_each(|d| b[(2 * p + d, node)] += w.sqrt() * g[d]);
    });
    b
}

/// Energy of the strain, `∫ ε : ε + (tr ε)²`, over the displacements of the nodes.
fn stiffness(mesh: &Mesh<2>, interpolation: &Interpolation<2>) -> DMatrix<f64> {
    let b = operator(mesh, interpolation);
    let (points, nodes) = (interpolation.points.len(), mesh.nodes.len());
    let mut strain = DMatrix::zeros(4 * points, 2 * nodes);
    let r = 0.5f64.sqrt();
    for p in 0..points {
        for n in 0..nodes {
            let (x, y) = (b[(2 * p, n)], b[(2 * p + 1, n)]);
            strain[(4 * p, 2 * n)] = x;
            strain[(4 * p + 1, 2 * n + 1)] = y;
            (strain[(4 * p + 2, 2 * n)], strain[(4 * p + 2, 2 * n + 1)]) = (r * y, r * x);
            (strain[(4 * p + 3, 2 * n)], strain[(4 * p + 3, 2 * n + 1)]) = (x, y);
        }
    }
    strain.transpose() * strain
}

/// Zero modes of the nodes that see material.
fn zero_modes(mesh: &Mesh<2>, points: &Points, scheme: &'static dyn Basis<2>) -> usize {
    let k = stiffness(mesh, &filled::<PlaneStrain>(mesh, points, scheme));
    let used: Vec<usize> = (0..k.nrows()).filter(|&i| k[(i, i)] > 0.0).collect();
    let k = k.select_rows(&used).select_columns(&used);
    let eigen = SymmetricEigen::new(k).eigenvalues;
    let largest = eigen.max();
    eigen.iter().filter(|e| **e < 1e-10 * largest).count()
}

#[test]
fn nine_points_a_cell_leave_no_spurious_mode() {
    for kind in KINDS {
        let mesh = rectangle(kind, 1.0, 1.0, 4, 4, 0.2, 5);
        let scheme = &Ddmp;
        let half = mesh.cells.len() as u32 / 2 + 3;
        assert_eq!(zero_modes(&mesh, &seeded(&mesh, 9, |_| true), scheme), 3, "{kind:?}");
        assert_eq!(zero_modes(&mesh, &seeded(&mesh, 9, |c| c < half), scheme), 3, "{kind:?}, cut");
        // Nine points a triangle, eighteen a quadrilateral.
        let spacing = (1.0 / (32.0 * 9.0f64)).sqrt();
        assert_eq!(zero_modes(&mesh, &lattice(&mesh, spacing), scheme), 3, "{kind:?}, lattice");
    }
}

/// The inf-sup constant of a linear pressure on quadratic triangles, displacements held at the boundary, in the
/// norm of the plain gradients.
fn inf_sup(n: usize, scheme: &'static dyn Basis<2>) -> f64 {
    let mesh = rectangle(CellKind::T6, 1.0, 1.0, n, n, 0.2, 5);
    let points = seeded(&mesh, 16, |_| true);
    let interpolation = filled::<PlaneStrain>(&mesh, &points, scheme);
    let (b, plain) = (operator(&mesh, &interpolation), operator(&mesh, &filled::<PlaneStrain>(&mesh, &points, &Mpm)));
    let inside: Vec<usize> =
        (0..mesh.nodes.len()).filter(|&i| mesh.nodes[i].iter().all(|&x| x > 1e-9 && x < 1.0 - 1e-9)).collect();
    let vertices = (n + 1) * (n + 1);
    let mut pressure = DMatrix::zeros(points.cell.len(), vertices);
    for (p, &c) in points.cell.iter().enumerate() {
        let xi = &points.xi[p];
        let shapes = [1.0 - xi[0] - xi[1], xi[0], xi[1]];
        for (shape, &node) in shapes.iter().zip(mesh.cells.nodes(c as usize)) {
            pressure[(p, node as usize)] += points.weight[p].sqrt() * shape;
        }
    }
    let along = |b: &DMatrix<f64>, d: usize| {
        let rows: Vec<usize> = (0..points.cell.len()).map(|p| 2 * p + d).collect();
        b.select_rows(&rows).select_columns(&inside)
    };
    let norm = (0..2).map(|d| along(&plain, d).transpose() * along(&plain, d)).reduce(|a, b| a + b).unwrap();
    let norm = Cholesky::new(norm).unwrap();
    let mut schur = DMatrix::zeros(vertices, vertices);
    for d in 0..2 {
        let coupling: DMatrix<f64> = pressure.transpose() * along(&b, d);
        schur += &coupling * norm.solve(&coupling.transpose());
    }
    let inverse: DMatrix<f64> = Cholesky::new(pressure.transpose() * &pressure).unwrap().l().try_inverse().unwrap();
    let schur: DMatrix<f64> = &inverse * schur * inverse.transpose();
    let mut eigen: Vec<f64> = SymmetricEigen::new(schur).eigenvalues.as_slice().to_vec();
    eigen.sort_by(f64::total_cmp);
    // The first belongs to the constant pressure.
    eigen[1].sqrt()
}

#[test]
fn a_linear_pressure_is_stable_on_quadratic_triangles() {
    for scheme in [&Mpm as &'static dyn Basis<2>, &Ddmp] {
        let beta = [4, 6, 8].map(|n| inf_sup(n, scheme));
        println!("{scheme:?}: inf-sup constants {beta:.3?} at 4, 6, 8 cells a side");
        assert!(beta.iter().all(|b| *b > 0.3) && beta[2] > 0.9 * beta[0], "{scheme:?}: {beta:?}");
    }
}

/// The forces that a uniform stress in points on a lattice exerts on the nodes inside, where they should vanish,
/// by those of a single cell: root mean square.
fn residual(mesh: &Mesh<2>, points: &Points, scheme: &'static dyn Basis<2>) -> f64 {
    let interpolation = filled::<PlaneStrain>(mesh, points, scheme);
    let mut force = vec![[0.0; 2]; mesh.nodes.len()];
    for_all::<PlaneStrain>(mesh, &interpolation, |_, w, node, g| (0..2).for_each(|d| force[node][d] += w * g[d]));
    let exact = in_cells::<PlaneStrain>(mesh, 0..mesh.cells.len() as u32);
    let mut scale = vec![0.0; mesh.nodes.len()];
    let plain = filled::<PlaneStrain>(mesh, &exact, &Mpm);
    for_all::<PlaneStrain>(mesh, &plain, |_, w, node, g| scale[node] += w * g[0].hypot(g[1]));
    let inside = |x: &[f64; 2]| x.iter().all(|x| *x > 0.25 && *x < 0.75);
    let nodes: Vec<usize> = (0..mesh.nodes.len()).filter(|&i| inside(&mesh.nodes[i])).collect();
    let square = |i: &usize| (force[*i][0].hypot(force[*i][1]) / scale[*i]).powi(2);
    (nodes.iter().map(square).sum::<f64>() / nodes.len() as f64).sqrt()
}

#[test]
fn crossing_points_make_less_noise() {
    for kind in KINDS {
        let mesh = mesh(kind);
        for per in [4.9, 11.0] {
            let spacing = (1.0 / (mesh.cells.len() as f64 * per)).sqrt();
            let points = lattice(&mesh, spacing);
            let [plain, smooth] = [&Mpm as &'static dyn Basis<2>, &Ddmp].map(|scheme| residual(&mesh, &points, scheme));
            println!("{kind:?}, {per} points a cell: plain {plain:.3}, smooth {smooth:.3}");
            assert!(smooth < 0.5 * plain, "{kind:?}, {per}: {smooth}, plain {plain}");
        }
    }
}
