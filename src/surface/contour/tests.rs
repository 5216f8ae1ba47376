use super::*;
use crate::kinematics::{Axisymmetric, PlaneStrain};
use crate::mesh::builder::rectangle;
use crate::mesh::shape::CellKind;
use crate::surface::fixture::{active, lattice, points, volumes};
use std::f64::consts::TAU;

/// The error of the active volume of cut cells that random points may cause, in the mean and at most, as a share of the
/// cell: 16 points a cell stand for 6 % of it each.
const MEAN: f64 = 0.05;
const GREATEST: f64 = 0.2;

/// Points an h that make about 16 a cell, of which a box has two if they are triangles.
fn per_length(kind: CellKind) -> usize {
    if kind.is_simplex() { 6 } else { 4 }
}

struct Found {
    mesh: Mesh<2>,
    geometry: Geometry,
    contour: Contour,
    /// What of each cell is within the contour (m³).
    volume: Vec<f64>,
    points: Points<2>,
}

impl Found {
    /// The volume within the contour (m³).
    fn enclosed(&self) -> f64 {
        self.volume.iter().sum()
    }
}

fn find<K: Kinematics<2>>(mesh: Mesh<2>, places: &[([f64; 2], f64)]) -> Found {
    let geometry = Geometry::new::<K>(&mesh);
    let (points, parametric) = points(&mesh, places);
    let active = active(&mesh, &points.cell);
    let mut contour = Contour::default();
    // A second time, with used buffers.
    for _ in 0..2 {
        contour.update::<K>(&mesh, &geometry, &points, &parametric, &active);
    }
    let volume = volumes::<K>(&mesh, &geometry, &contour.level_set, &active);
    Found { mesh, geometry, contour, volume, points }
}

/// The mean error of the volume of the cells cut by the exact surface, the greatest of all cells, as shares of the
/// cell, and the number of those cut; `exact` is positive in the material.
fn error<K: Kinematics<2>>(found: &Found, exact: impl Fn(&[f64; 2]) -> f64) -> (f64, f64, usize) {
    let (mesh, geometry) = (&found.mesh, &found.geometry);
    let (mut sum, mut greatest, mut count) = (0.0, 0.0f64, 0);
    for c in 0..mesh.cells.len() {
        let values: Vec<f64> = mesh.cells.nodes(c).iter().map(|&n| exact(&mesh.nodes[n as usize])).collect();
        let wanted = geometry.cell(mesh, c, c).clipped::<K>(&values);
        let cut = wanted[0] > 0.0 && wanted[0] < geometry.volume(c);
        let error = (found.volume[c] - wanted[0]).abs() / geometry.volume(c);
        greatest = greatest.max(error);
        if cut {
            count += 1;
            sum += error;
        }
    }
    (sum / f64::from(count), greatest, count as usize)
}

fn mesh(kind: CellKind, n: usize) -> Mesh<2> {
    rectangle(kind, 2.0, 2.0, n, n, 0.2, 4)
}

#[test]
fn a_rectangle_may_end_at_any_height() {
    for kind in CellKind::ALL.into_iter().filter(|k| k.dimension() == 2) {
        let (mut sum, mut worst) = (0.0, 0.0f64);
        for step in 0..12 {
            let height = 1.0 + 0.021 * f64::from(step);
            for spread in [0.0, 0.6] {
                let n = per_length(kind) * 8;
                let rows = (0.5 * n as f64 * height).round() as usize;
                let places = lattice([2.0, height], [n, rows], spread, |_| true);
                let found = find::<PlaneStrain>(mesh(kind, 8), &places);
                let share = found.enclosed() / (2.0 * height);
                assert!((share - 1.0).abs() < 1e-12, "{kind:?} {height}: {:?}", found.contour);
                let (mean, greatest, _) = error::<PlaneStrain>(&found, |x| height - x[1]);
                sum += mean / 24.0;
                worst = worst.max(greatest);
            }
        }
        println!("{kind:?} flat top: {sum:.4} {worst:.4}");
        assert!(sum < MEAN && worst < GREATEST, "{kind:?} {sum} {worst}");
    }
}

#[test]
fn walls_of_the_mesh_are_no_surface() {
    for kind in CellKind::ALL.into_iter().filter(|k| k.dimension() == 2) {
        // A mesh filled to the brim, and half a mesh: nothing is missing at the walls.
        let places = lattice([2.0, 2.0], [32, 32], 0.0, |_| true);
        let found = find::<PlaneStrain>(mesh(kind, 8), &places);
        let is_full = |found: &Found, c: usize| found.volume[c] == found.geometry.volume(c);
        assert!((0..found.volume.len()).all(|c| is_full(&found, c)), "{kind:?} {:?}", found.contour.level);
        let places = lattice([2.0, 1.1], [32, 18], 0.3, |_| true);
        let found = find::<PlaneStrain>(mesh(kind, 8), &places);
        for c in 0..found.mesh.cells.len() {
            let top = found.mesh.cells.nodes(c).iter().map(|&n| found.mesh.nodes[n as usize][1]).fold(0.0, f64::max);
            assert!(top > 0.9 || is_full(&found, c), "{kind:?} {c}");
        }
    }
}

#[test]
fn disks_and_slopes_keep_their_volume_and_misplace_less_with_refinement() {
    for (name, exact) in [
        ("disk", (|x: &[f64; 2]| 0.7 - (x[0] - 1.03).hypot(x[1] - 0.98)) as fn(&[f64; 2]) -> f64),
        ("slope", |x: &[f64; 2]| 1.3 - 0.6 * x[0] - x[1]),
    ] {
        let mut misplaced = Vec::new();
        for n in [8, 16, 32] {
            let places = lattice([2.0, 2.0], [6 * n, 6 * n], 0.3, |x| exact(x) > 0.0);
            let found = find::<PlaneStrain>(mesh(CellKind::T6, n), &places);
            let (mean, greatest, count) = error::<PlaneStrain>(&found, exact);
            println!("{name} {n}: mean {mean:.4} greatest {greatest:.4} of {count}, level {}", found.contour.level);
            assert!((found.enclosed() / found.contour.wanted - 1.0).abs() < 1e-12);
            // Leaving points out of the lattice makes the edge a staircase of half a spacing, another tenth of a cell.
            assert!(mean < MEAN && greatest < GREATEST + 0.1, "{name} {n}: {mean} {greatest}");
            misplaced.push(mean * count as f64 / (n * n) as f64);
        }
        assert!(misplaced[2] < 0.45 * misplaced[0], "{name} {misplaced:?}");
    }
}

#[test]
fn a_ring_is_as_exact_as_a_plane_body() {
    let mut mesh = mesh(CellKind::T6, 8);
    mesh.nodes.iter_mut().for_each(|x| x[0] += 0.5);
    let height = 1.13;
    let mut places = lattice([2.0, height], [48, 27], 0.0, |_| true);
    for (x, volume) in &mut places {
        x[0] += 0.5;
        *volume *= TAU * x[0];
    }
    let found = find::<Axisymmetric>(mesh, &places);
    let exact = TAU * 3.0 * height;
    assert!((found.enclosed() / exact - 1.0).abs() < 1e-12);
    let (mean, greatest, _) = error::<Axisymmetric>(&found, |x| height - x[1]);
    println!("axisymmetric: {mean:.4} {greatest:.4}");
    assert!(mean < MEAN, "{mean}");
}

#[test]
fn what_no_level_encloses_is_said() {
    // Points that lost or gained volume in a full box: the level stops at its bounds, the box stays as good as full.
    for factor in [0.95, 1.1] {
        let mut places = lattice([2.0, 2.0], [48, 48], 0.3, |_| true);
        places.iter_mut().for_each(|p| p.1 *= factor);
        let found = find::<PlaneStrain>(mesh(CellKind::T6, 8), &places);
        assert!((found.contour.wanted - 4.0 * factor).abs() < 1e-12);
        let enclosed = found.enclosed();
        assert!((enclosed - 4.0).abs() < 0.01, "{factor}: {} {enclosed}", found.contour.level);
    }
}

#[test]
fn a_single_point_and_no_point_at_all_have_a_contour() {
    let found = find::<PlaneStrain>(mesh(CellKind::T6, 8), &[([0.9, 1.1], 1e-3)]);
    assert!((found.enclosed() / 1e-3 - 1.0).abs() < 1e-12, "{}", found.enclosed());
    assert!(found.contour.level > 0.0 && found.points.len() == 1);
    let found = find::<PlaneStrain>(mesh(CellKind::T6, 8), &[]);
    assert!(found.volume.iter().all(|&v| v == 0.0));
}
