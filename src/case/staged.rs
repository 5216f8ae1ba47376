//! What is not there in a phase: structures that stay where they are, and contacts that do not touch.

use super::checked::{Case, Contact, Phase, Touched, Touching};
use super::find::region_index;
use super::rigid;
use crate::error::Result;
use crate::mesh::Mesh;
use crate::rigid::Body;
use crate::step::Fixed;
use std::collections::BTreeSet;

/// The nodes of the structures that are absent, all of their directions held; `mesh` has the nodes of all, `fem` the cells
/// of the structures.
///
/// # Errors
/// Input: a region that the mesh has not.
pub fn held(case: &Case, mesh: &Mesh<2>, fem: &Mesh<2>, bodies: &[Body<2>], phase: &Phase) -> Result<Vec<Fixed>> {
    let mut held = Vec::new();
    for region in case.regions.iter().filter(|region| phase.absent.contains(&region.name)) {
        let number = region_index(mesh, &region.name)?;
        if let Some(body) = bodies.iter().find(|body| body.region == number) {
            held.extend(rigid::held(body));
            continue;
        }
        let cells = (0..fem.cells.len()).filter(|&c| fem.cells.region[c] == number);
        let nodes: BTreeSet<u32> = cells.flat_map(|c| fem.cells.nodes(c).iter().copied()).collect();
        let nodes: Vec<u32> = nodes.into_iter().collect();
        held.extend([0, 1].map(|component| Fixed { nodes: nodes.clone(), component }));
    }
    Ok(held)
}

/// The numbers of the contacts that are absent, or of which one side is.
pub fn apart(case: &Case, phase: &Phase) -> Vec<usize> {
    let absent = |name: &String| phase.absent.contains(name);
    let is_apart = |contact: &Contact| {
        let structure = match &contact.structure {
            Touching::Structure(region) => &case.regions[*region].name,
            Touching::Wall(curve) => curve,
        };
        let other = match &contact.on {
            Touched::Body(region) => absent(&case.regions[*region].name),
            Touched::Soil(_) => false,
        };
        absent(structure) || other || contact.name.as_ref().is_some_and(absent)
    };
    (0..case.contacts.len()).filter(|&i| is_apart(&case.contacts[i])).collect()
}
