//! What a grid whose nodes follow control values cannot have: displacements given where it has no controls.

use crate::error::{Error, Result};
use crate::step::Scene;

/// Refuses displacements that are given at nodes which no control among them moves.
///
/// # Errors
/// `Input` where there are such.
pub fn of_displacements(scene: &Scene<2>) -> Result<()> {
    let Some(constraints) = scene.constraints() else { return Ok(()) };
    for fixed in (0..scene.phases.len()).flat_map(|phase| scene.fixed(phase)) {
        if let Some(node) = constraints.unheld(&fixed.nodes) {
            let place = scene.origin(node);
            if !scene.ties.is_empty() {
                return Err(Error::input(
                    "supports",
                    format!(
                        "the node at {place:.3?} m is tied to one of the opposite side, which is not held or moved with it"
                    ),
                    "hold or move both sides alike: name the side at the other end of the tie as well, or a curve with both",
                ));
            }
            return Err(Error::input(
                "numerics.gradient",
                format!(
                    "a support or a prescribed displacement is within the grid, near {place:.3?} m, where {} has no control points on the grid lines",
                    scene.basis.name()
                ),
                "give displacements on the boundary of the grid or on structures with a contact, or choose `gradient: mpm`",
            ));
        }
    }
    Ok(())
}
