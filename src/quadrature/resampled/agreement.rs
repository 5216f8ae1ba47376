//! Where soil moves, the mass of the equations is to be where that of the points is (docs/theory.md, section 6, *Points outside the surface*).

use super::super::Restored;
use crate::kinematics::Kinematics;
use crate::mesh::shape::MAX_NODES;
use crate::surface::Geometry;
use rayon::prelude::*;

/// The part (-) of what the surface encloses, or of the volume of a cell's points, below which the other does not agree.
const AGREES: f64 = 0.5;
/// The least part (-) of the volume of a cell on the boundary of the mesh that the surface leaves out of its points.
const MISSED: f64 = 0.2;

/// Brings the cells that are `inside` the surface, and those whose points are `outside`, to what the points say, where these and the level set disagree.
///
/// A thin sheet of soil that flies has its points in some of its cells, and its surface encloses others. Where the points in a cell, and those in it and
/// the cells beside it, have less than half of the volume that the surface encloses there, it encloses nothing. Points in such a cell speak for themselves;
/// so do those that the surface does not reach, and those of a toe on the boundary of the mesh that is thinner than a cell, which the level set misses.
pub fn settle<K: Kinematics<2>>(
    geometry: &Geometry,
    grid: &Restored<2>,
    level_set: &[f64],
    [inside, outside]: [&mut [bool]; 2],
) {
    let Restored { mesh, points, locator, .. } = *grid;
    let cells = 0..mesh.cells.len();
    let mut held = vec![0.0; mesh.cells.len()];
    points.cell.iter().enumerate().for_each(|(p, &c)| held[c as usize] += points.volume(p));
    let filled_of = |c: usize| {
        let mut values = [0.0; MAX_NODES];
        let nodes = mesh.cells.nodes(c);
        values.iter_mut().zip(nodes).for_each(|(value, &n)| *value = level_set[n as usize]);
        if inside[c] { geometry.filled::<K>(mesh, c, &values[..nodes.len()]) } else { 0.0 }
    };
    let filled: Vec<f64> = cells.clone().into_par_iter().with_min_len(64).map(filled_of).collect();
    let neighbours = |c: usize| locator.faces.neighbours(c as u32);
    let around = |of: &[f64], c: usize| of[c] + neighbours(c).iter().map(|&d| of[d as usize]).sum::<f64>();
    for c in cells {
        let void =
            inside[c] && !outside[c] && held[c] < AGREES * filled[c] && around(&held, c) < AGREES * around(&filled, c);
        inside[c] &= !void;
        if held[c] > 0.0 {
            let (whole, ends) = (geometry.volume(c), neighbours(c).len() < mesh.cells.corners(c).len());
            let holds = held[c].min(whole);
            let toe = ends && filled[c] < AGREES * holds && holds - filled[c] > MISSED * whole;
            outside[c] |= void || toe || !inside[c];
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::PlaneStrain;
    use crate::mesh::builder::rectangle;
    use crate::mesh::shape::CellKind;
    use crate::quadrature::fixture::{on_grid, undeformed};

    /// A block that fills its cells, a place far from it that the surface encloses, with one small point in it, and a point that it does not reach.
    #[test]
    fn a_surface_encloses_no_cells_that_points_do_not_fill() {
        let mesh = rectangle(CellKind::T6, 6.0, 1.0, 12, 2, 0.0, 1);
        let geometry = Geometry::new::<PlaneStrain>(&mesh);
        let mut position: Vec<[f64; 2]> =
            (0..80).map(|k| [0.05 + 0.1 * (k % 20) as f64, 0.125 + 0.25 * (k / 20) as f64]).collect();
        position.extend([[4.6, 0.4], [2.9, 0.4]]);
        let points = undeformed(&mesh, position, 0.025);
        let level_set: Vec<f64> = mesh.nodes.iter().map(|x| (2.0 - x[0]).max(1.0 - (x[0] - 4.5).abs())).collect();
        let reached = |c: usize| mesh.cells.nodes(c).iter().any(|&n| level_set[n as usize] > 0.0);
        let first: Vec<bool> = (0..mesh.cells.len()).map(reached).collect();
        let (mut inside, mut outside) = (first.clone(), vec![false; mesh.cells.len()]);
        on_grid(&mesh, &points, |grid| {
            settle::<PlaneStrain>(&geometry, grid, &level_set, [&mut inside, &mut outside]);
        });
        let far = |c: usize| mesh.cells.nodes(c).iter().all(|&n| mesh.nodes[n as usize][0] > 3.0);
        assert!((0..inside.len()).any(|c| far(c) && first[c]));
        for c in 0..inside.len() {
            assert_eq!(inside[c], first[c] && !far(c), "cell {c}");
            assert_eq!(outside[c], points.cell[80..].contains(&(c as u32)), "cell {c}");
        }
    }
}
