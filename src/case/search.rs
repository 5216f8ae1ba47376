//! What counts as failure of the soil where a phase reduces strengths until there is no equilibrium.

use super::checked::{Analysis, Case};
use super::find::{filled, region_index};
use crate::error::Result;
use crate::mesh::Mesh;
use crate::step::{FARTHEST, Search};

/// What the phases of the case that look for failure go by; `None` without such phases.
///
/// # Errors
/// Input: a region that the mesh has not.
pub fn search(case: &Case, mesh: &Mesh<2>, fem: Option<&Mesh<2>>) -> Result<Option<Search>> {
    if case.phases.iter().all(|phase| phase.analysis != Analysis::StrengthReduction) {
        return Ok(None);
    }
    let (mut low, mut high, mut elements) = (f64::INFINITY, f64::NEG_INFINITY, Vec::new());
    for (region, _) in filled(case).filter(|(region, _)| !region.content.is_structure()) {
        let number = region_index(mesh, &region.name)?;
        for (part, is_fem) in std::iter::once((mesh, false)).chain(fem.map(|fem| (fem, true))) {
            for c in (0..part.cells.len()).filter(|&c| part.cells.region[c] == number) {
                let nodes = part.cells.nodes(c);
                for &n in nodes {
                    (low, high) = (low.min(part.nodes[n as usize][1]), high.max(part.nodes[n as usize][1]));
                }
                elements.extend_from_slice(if is_fem { nodes } else { &[] });
            }
        }
    }
    elements.sort_unstable();
    elements.dedup();
    Ok(Some(Search { farthest: FARTHEST * (high - low).max(0.0), elements }))
}
