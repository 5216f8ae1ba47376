//! Points on a mesh that has just been restored, for the tests of this module.

use super::Restored;
use crate::interpolation::Interpolation;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::points::Points;
use crate::tensor::Tensor;

/// Undeformed points at `position` (m), each of `volume` (m² or m³).
pub fn undeformed(mesh: &Mesh<2>, position: Vec<[f64; 2]>, volume: f64) -> Points<2> {
    let locator = Locator::new(mesh);
    Points {
        initial_volume: vec![volume; position.len()],
        deformation: vec![Tensor::identity(); position.len()],
        cell: position.iter().map(|x| locator.locate(mesh, x, None).unwrap().0).collect(),
        position,
        ..Points::default()
    }
}

/// What is found where every cell is active.
pub fn on_grid<T>(mesh: &Mesh<2>, points: &Points<2>, find: impl FnOnce(&Restored<2>) -> T) -> T {
    let locator = Locator::new(mesh);
    let places = points.position.iter().zip(&points.cell);
    let parametric: Vec<[f64; 3]> = places.map(|(x, c)| locator.locate(mesh, x, Some(*c)).unwrap().1).collect();
    find(&Restored {
        mesh,
        locator: &locator,
        points,
        parametric: &parametric,
        interpolation: &Interpolation::default(),
        active: &vec![true; mesh.cells.len()],
        before: (mesh, &locator),
        outlines: &[],
        contact: &[],
        relaxed: false,
        entering: (&[], 0),
        displacement: None,
    })
}
