use super::*;
use crate::kinematics::{Axisymmetric, PlaneStrain};
use crate::mesh::builder::rectangle;
use crate::mesh::shape::CellKind;
use crate::surface::moments::monomials;

fn level_set(mesh: &Mesh<2>, f: impl Fn(&[f64; 2]) -> f64) -> Vec<f64> {
    mesh.nodes.iter().map(f).collect()
}

#[test]
fn a_sliver_goes_to_the_neighbour_with_most_points() {
    let mesh = rectangle(CellKind::Q9, 3.0, 2.0, 3, 2, 0.0, 0);
    let geometry = Geometry::new::<PlaneStrain>(&mesh);
    let mut active = Active::default();
    // Points in the lower row only, most in its middle; a strip of 0.1 of the upper row is filled.
    let cell = [0, 0, 1, 1, 1, 2];
    let all = [true; 6];
    active.update::<PlaneStrain>(&mesh, &geometry, &level_set(&mesh, |x| 1.1 - x[1]), &cell, &all);
    assert_eq!(active.filling, [Filling::Full, Filling::Full, Filling::Full, Filling::Cut, Filling::Cut, Filling::Cut]);
    for c in 0..3 {
        // ∫ y² over the box of height 1.1 in the frame of the lower cell.
        let (low, high) = (-0.5f64, 0.6f64);
        let expected = (high.powi(3) - low.powi(3)) / 3.0;
        assert!((active.moments[c][5] - expected).abs() < 1e-14 && (active.moments[c][0] - 1.1).abs() < 1e-14);
        assert!((active.volume[c] - 1.0).abs() < 1e-14 && (active.volume[c + 3] - 0.1).abs() < 1e-14);
        assert_eq!(active.moments[c + 3], [0.0; 6]);
    }
    assert!(active.lost == 0.0 && (active.handed - 0.3).abs() < 1e-14);
    // Without the point on the left, its cell and the sliver above it: the former goes to the middle, the latter,
    // which has no neighbour with points, is lost.
    active.update::<PlaneStrain>(&mesh, &geometry, &level_set(&mesh, |x| 1.1 - x[1]), &[1, 1, 1, 2], &all);
    assert!((active.lost - 0.1).abs() < 1e-14 && (active.moments[1][0] - 2.1).abs() < 1e-14);
    // What does not take part is empty.
    active.update::<PlaneStrain>(&mesh, &geometry, &level_set(&mesh, |x| 1.1 - x[1]), &[1], &[false; 6]);
    assert!(active.filling.iter().all(|f| *f == Filling::Empty) && active.volume.iter().all(|&v| v == 0.0));
}

#[test]
fn moments_of_all_cells_make_up_those_of_the_body() {
    for kind in CellKind::ALL.into_iter().filter(|k| k.dimension() == 2) {
        let jitter = if kind.is_simplex() { 0.2 } else { 0.0 };
        let mesh = rectangle(kind, 3.0, 2.0, 6, 4, jitter, 9);
        let geometry = Geometry::new::<Axisymmetric>(&mesh);
        let hats: f64 = geometry.hat.iter().sum();
        assert!((hats - 18.0 * std::f64::consts::PI).abs() < 1e-12);
        let top = 1.37;
        let values = level_set(&mesh, |x| top - x[1]);
        let mut active = Active::default();
        let cell: Vec<u32> = (0..mesh.cells.len() as u32).collect();
        active.update::<Axisymmetric>(&mesh, &geometry, &values, &cell, &vec![true; cell.len()]);
        // ∫ y · 2πr over the body.
        let sum: f64 = (0..mesh.cells.len())
            .map(|c| {
                geometry.frame[c].centre[1] * active.moments[c][0] + geometry.frame[c].length * active.moments[c][2]
            })
            .sum();
        assert!((sum / (std::f64::consts::PI * 9.0 * 0.5 * top * top) - 1.0).abs() < 1e-13, "{kind:?}");
        assert_eq!(monomials(&[2.0, 3.0]), [1.0, 2.0, 3.0, 4.0, 6.0, 9.0]);
    }
}
