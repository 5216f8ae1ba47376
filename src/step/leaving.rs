//! Error: a structure in contact that leaves the grid.

use super::scene::Scene;
use crate::contact::{Constraint, Ground, Interface, Multipliers};
use crate::error::{Error, Result};

/// Rejects a contact node that was closed in the step before, as `held` has it, has no constraint among the `constraints` of this one, and
/// is where the grid has no cells: the soil there has no unknowns, and contact would be lost without a message.
/// Two bodies need no grid between them, and a wall may leave it: its curve is often the end of it, and soil that follows
/// leaves the grid itself.
///
/// # Errors
/// Analysis: the structure and where its boundary is.
pub fn check<const D: usize>(
    scene: &Scene<D>,
    interface: &dyn Interface<D>,
    held: &Multipliers,
    constraints: &[Constraint<D>],
    ground: &Ground<D>,
    position: &dyn Fn(u32) -> [f64; D],
) -> Result<()> {
    let mut lost: Vec<bool> = (0..interface.contact_nodes()).map(|k| held.touched(k)).collect();
    constraints.iter().for_each(|constraint| lost[constraint.contact_node as usize] = false);
    let is_wall =
        || !scene.fem.as_ref().is_some_and(|fem| fem.mesh.cells.region.contains(&interface.sides().structure));
    if !lost.contains(&true) || interface.sides().against.is_some() || is_wall() {
        return Ok(());
    }
    // Where a contact node is: the mark at which it is largest.
    let mut places = vec![(0.0, [0.0; D]); lost.len()];
    for mark in interface.lines(position).iter().flatten() {
        for (contact_node, share) in mark.contact_nodes {
            if share > places[contact_node as usize].0 {
                places[contact_node as usize] = (share, mark.place);
            }
        }
    }
    let outside = |x: &[f64; D]| ground.locator.locate(ground.grid, x, None).is_none();
    let left = lost.iter().zip(&places).find(|(lost, (_, place))| **lost && outside(place));
    let Some((_, (_, place))) = left else { return Ok(()) };
    let name = scene.mesh.regions.get(interface.sides().structure as usize).map_or("", String::as_str);
    Err(Error::analysis(
        format!("structure `{name}`"),
        format!("its boundary, in contact near {place:.3?} m, has left the grid"),
        "extend the regions of kind mpm and buffer in the .geo beyond the way of the structure, or end the phase before",
    ))
}
