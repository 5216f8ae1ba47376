//! Structures that leave the grid.

use super::scene::Scene;
use crate::contact::{Ground, Multipliers, Pair};
use crate::error::{Error, Result};

/// Refuses a hat that touched soil in the step before, as `held` has it, and has no cell of the grid anywhere under it now:
/// the soil there has no freedom to answer with, and contact would be lost without a word.
///
/// # Errors
/// Analysis: the structure and where its boundary is.
pub fn check<const D: usize>(
    scene: &Scene<D>,
    pair: &dyn Pair<D>,
    held: &Multipliers,
    ground: &Ground<D>,
    position: &dyn Fn(u32) -> [f64; D],
) -> Result<()> {
    if held.pressure.iter().all(|&p| p == 0.0) {
        return Ok(());
    }
    // Of each hat that touched: a place under it, and whether a cell is under it.
    let mut under: Vec<Option<([f64; D], bool)>> = vec![None; held.pressure.len()];
    let mut hint = None;
    for line in pair.lines(position) {
        for ends in line.windows(2) {
            let hats = || {
                ends.iter().flat_map(|mark| mark.hats).filter(|(_, share)| *share > 0.0).map(|(hat, _)| hat as usize)
            };
            if hats().all(|hat| held.pressure[hat] == 0.0) {
                continue;
            }
            let middle = std::array::from_fn(|d| 0.5 * (ends[0].place[d] + ends[1].place[d]));
            let cell = ground.locator.locate(ground.grid, &middle, hint).map(|(cell, _)| cell);
            hint = cell.or(hint);
            for hat in hats().filter(|&hat| held.pressure[hat] != 0.0) {
                let (_, has_cell) = under[hat].get_or_insert((middle, false));
                *has_cell |= cell.is_some();
            }
        }
    }
    match under.into_iter().flatten().find(|(_, has_cell)| !has_cell) {
        None => Ok(()),
        Some((place, _)) => {
            let name = scene.mesh.regions.get(pair.structure() as usize).map_or("", String::as_str);
            Err(Error::analysis(
                format!("structure `{name}`"),
                format!("its boundary, in contact near {place:.3?} m, has left the grid"),
                "extend the regions of kind mpm and buffer in the .geo beyond the way of the structure, or end the phase before",
            ))
        }
    }
}
