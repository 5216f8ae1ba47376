//! Points in simple bodies, for the tests.

use super::geometry::Geometry;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::points::Points;
use crate::tensor::Tensor;

/// Points of the same volume at the given places, undeformed, in the cells of `mesh`, with their parametric
/// coordinates.
pub fn points(mesh: &Mesh<2>, places: &[([f64; 2], f64)]) -> (Points<2>, Vec<[f64; 3]>) {
    let locator = Locator::new(mesh);
    let found: Vec<_> = places.iter().map(|(x, _)| locator.locate(mesh, x, None).unwrap()).collect();
    let points = Points {
        position: places.iter().map(|p| p.0).collect(),
        initial_volume: places.iter().map(|p| p.1).collect(),
        deformation: vec![Tensor::identity(); places.len()],
        cell: found.iter().map(|f| f.0).collect(),
        ..Points::default()
    };
    (points, found.iter().map(|f| f.1).collect())
}

/// Cells with points and two rings around them.
pub fn active(mesh: &Mesh<2>, cell: &[u32]) -> Vec<bool> {
    let mut chosen = vec![false; mesh.cells.len()];
    cell.iter().for_each(|&c| chosen[c as usize] = true);
    for _ in 0..2 {
        let mut reached = vec![false; mesh.nodes.len()];
        for c in (0..chosen.len()).filter(|&c| chosen[c]) {
            mesh.cells.nodes(c).iter().for_each(|&n| reached[n as usize] = true);
        }
        for (c, chosen) in chosen.iter_mut().enumerate() {
            *chosen |= mesh.cells.nodes(c).iter().any(|&n| reached[n as usize]);
        }
    }
    chosen
}

/// What of each cell (m³) is where `level_set` is positive, of those `active`.
pub fn volumes<K: Kinematics<2>>(mesh: &Mesh<2>, geometry: &Geometry, level_set: &[f64], active: &[bool]) -> Vec<f64> {
    let of_cell = |c: usize| {
        let values: Vec<f64> = mesh.cells.nodes(c).iter().map(|&n| level_set[n as usize]).collect();
        if active[c] { geometry.filled::<K>(mesh, c, &values) } else { 0.0 }
    };
    (0..mesh.cells.len()).map(of_cell).collect()
}

/// The centres of the boxes of a lattice over `[0, lx] × [0, ly]` that satisfy
/// `inside`, each with the volume of its box; `spread` moves them by up to that share of the spacing.
pub fn lattice(
    [lx, ly]: [f64; 2],
    [nx, ny]: [usize; 2],
    spread: f64,
    inside: impl Fn(&[f64; 2]) -> bool,
) -> Vec<([f64; 2], f64)> {
    let (dx, dy) = (lx / nx as f64, ly / ny as f64);
    let mut places = Vec::new();
    for j in 0..ny {
        for i in 0..nx {
            let k = (places.len() + 1) as f64;
            let [a, b] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3].map(|g| (g * k).fract() - 0.5);
            places.push(([(i as f64 + 0.5 + spread * a) * dx, (j as f64 + 0.5 + spread * b) * dy], dx * dy));
        }
    }
    places.retain(|(x, _)| inside(x));
    places
}
