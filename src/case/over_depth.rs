//! Whether a material is in range over the height of a region.

use super::checked::{Material, Region};
use crate::error::{Error, Result};
use crate::mesh::Mesh;

/// Heights at which a material is checked over a region, beside its lowest point. A profile is linear below its datum but for where it has
/// fallen to its least value.
const HEIGHTS: u32 = 64;

/// Checks a material over the height of a region: a profile in range at top and bottom is so in between, but conditions on two profiles may not hold.
pub(super) fn check_over_depth(mesh: &Mesh<2>, index: u16, region: &Region, material: &Material) -> Result<()> {
    let cells = (0..mesh.cells.len()).filter(|&c| mesh.cells.region[c] == index);
    let heights = cells.flat_map(|c| mesh.cells.nodes(c)).map(|&n| mesh.nodes[n as usize][1]);
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(y), h.max(y)));
    let share = |k: u32| f64::from(k) / f64::from(HEIGHTS);
    let within = (1..HEIGHTS).map(|k| low + (high - low) * share(k));
    for y in [low, high].into_iter().chain(within) {
        material.model.check(y).map_err(|e| Error {
            place: format!("material `{}` in region `{}` at y = {y} m: {}", material.name, region.name, e.place),
            ..e
        })?;
        if material.density.at(y) < 0.0 {
            return Err(Error::input(
                format!("material `{}` in region `{}` at y = {y} m", material.name, region.name),
                format!("the density is {}", material.density.at(y)),
                "change its top or gradient",
            ));
        }
    }
    Ok(())
}
