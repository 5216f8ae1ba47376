//! What a grid whose nodes follow control values cannot have: finite elements with its nodes, and displacements given where it has no controls.

use crate::error::{Error, Result};
use crate::interpolation::Basis;
use crate::mesh::Mesh;
use crate::step::Scene;

/// Refuses a `scheme` that has no functions on the grid, or whose functions finite elements with nodes of the grid would move.
///
/// # Errors
/// `Input` where it does.
pub fn of_grid(scheme: &dyn Basis<2>, mesh: &Mesh<2>, fem: Option<&Mesh<2>>) -> Result<()> {
    if scheme.constraints(mesh)?.is_none() {
        return Ok(());
    }
    let mut of_grid = vec![false; mesh.nodes.len()];
    mesh.cells.nodes.iter().for_each(|&n| of_grid[n as usize] = true);
    let shares = |part: &&Mesh<2>| part.cells.nodes.iter().any(|&n| of_grid[n as usize]);
    if fem.filter(shares).is_some() {
        return Err(Error::input(
            "numerics.gradient",
            format!(
                "finite elements share nodes with the grid, which then moves with them and does not stay the rectangle that {} needs",
                scheme.name()
            ),
            "mesh them apart from the grid, with a contact between them, or choose `gradient: mpm`",
        ));
    }
    Ok(())
}

/// Refuses displacements that are given at nodes which no control among them moves.
///
/// # Errors
/// `Input` where there are such.
pub fn of_displacements(scene: &Scene<2>) -> Result<()> {
    let Some(constraints) = scene.basis.constraints(&scene.mesh)? else { return Ok(()) };
    for fixed in (0..scene.phases.len()).flat_map(|phase| scene.fixed(phase)) {
        if let Some(node) = constraints.unheld(&fixed.nodes) {
            let place = scene.mesh.nodes[node as usize];
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
