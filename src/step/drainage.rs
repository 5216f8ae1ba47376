//! Where the water in the pores has no excess pressure while it flows (docs/theory.md, section 11, *Drained soil*): on curves that are drained
//! by name, and in drained soil, which takes the water of the soil beside it.

use super::family::Family;
use super::scene::Scene;
use super::state::State;

/// The part (-) of a cell from which on drained soil in it drains its corners. The boundary of a drain is then where it is to two thirds of a
/// cell, and exact where it is one of the mesh; a layer that is two thirds of a cell thick drains wherever it has moved.
const PART: f64 = 1.0 / 3.0;

/// The nodes without excess pressure in the next step, ascending, given all that integrals are summed over; none where no water flows.
pub fn nodes<'a, const D: usize>(
    scene: &Scene<D>,
    state: &State<D>,
    integrated: impl Iterator<Item = Family<'a, D>>,
) -> Vec<u32> {
    let Some(water) = scene.water.as_ref().filter(|_| scene.phases[state.phase].flows) else { return Vec::new() };
    let mut nodes = water.drained.clone();
    if water.drains.contains(&true) {
        for family in integrated {
            let drains = |p: usize| water.drains.get(family.points.model_of(p)) == Some(&true);
            for cell_points in &family.interpolation.filled {
                let first = cell_points.first_point as usize;
                let (mut all, mut drained) = (0.0, 0.0);
                for k in first..first + cell_points.point_count as usize {
                    let weight = family.interpolation.weight[k];
                    all += weight;
                    if drains(family.interpolation.points[k] as usize) {
                        drained += weight;
                    }
                }
                if drained > 0.0 && drained >= PART * all {
                    nodes.extend_from_slice(family.mesh.cells.corners(cell_points.cell as usize));
                }
            }
        }
        nodes.sort_unstable();
        nodes.dedup();
    }
    nodes
}
