//! Curves through which soil leaves the model: what a case says of them, checked, and their sides on the boundary of the mesh.

use super::check::Checker;
use super::checked::{Case, Contact, Numerics, Phase, Restore, Touching};
use super::find::group;
use super::locate::{At, Path};
use super::raw::{self, Analysis};
use crate::error::{Error, Result};
use crate::mesh::locate::Locator;
use crate::mesh::shape::CellKind;
use crate::mesh::{Group, Mesh};
use crate::step::Outflow;
use crate::time_value::TimeValue;
use std::collections::{HashMap, HashSet};

/// The name of a scheme that lets no soil pass the boundary of the mesh; `None` of others.
pub(super) fn unfit(numerics: &Numerics) -> Option<&'static str> {
    let name = numerics.basis.name();
    (!["mpm", "ddmp"].contains(&name)).then_some(name)
}

impl Checker {
    /// Refuses curves through which soil cannot leave.
    pub(super) fn outflows(&mut self, file: &raw::CaseFile, (numerics, phases): (&Numerics, &[Phase]), path: &Path) {
        let walls: Vec<Wall> =
            file.contacts.iter().filter_map(|c| Some((c.wall.as_deref()?, c.name.as_deref()))).collect();
        for (curve, held) in file.supports.iter().filter(|(_, held)| held.outflow) {
            let path = path.key(curve).key("outflow");
            let components = [held.ux, held.uy, held.un, held.rotation, held.pore_pressure];
            let yields = held.absorbing || held.springs.is_some() || held.dashpots.is_some();
            let tied = held.tied.is_some() || file.supports.values().any(|held| held.tied.as_ref() == Some(curve));
            if components.iter().any(Option::is_some) || yields || tied {
                let problem = "soil does not leave through a curve that holds, drains or absorbs, or is tied";
                self.issue(&path, At::Key, problem, "leave `outflow: true` alone in the entry");
            }
            if file.regions.contains_key(curve) {
                self.issue(
                    &path,
                    At::Key,
                    "soil leaves through a physical curve",
                    "name the curve in place of the region",
                );
            }
            if numerics.solver.restore == Restore::Never {
                let problem = "a grid that is never reset takes its boundary along with the soil";
                self.issue(&path, At::Key, problem, "take `restore: never` out of `numerics`");
            }
            if let Some(name) = unfit(numerics) {
                let problem = format!("outflow with `gradient: {name}` is not available yet");
                self.issue(&path, At::Key, problem, "choose `gradient: mpm` or `gradient: ddmp` under `numerics`");
            }
            if file.water.is_some() || file.materials.values().any(|material| material.permeability.is_some()) {
                let problem = "outflow of soil with water in its pores or around it is not available yet";
                self.issue(&path, At::Key, problem, "take `water` and every `permeability` out");
            }
            let mut opens = false;
            for (phase, checked) in file.phases.iter().zip(phases) {
                if !is_open(&walls, checked, curve) {
                    continue;
                }
                opens = true;
                if phase.analysis != Analysis::Dynamic {
                    let problem = format!(
                        "soil leaves in phases with `analysis: dynamic`, and phase `{}`, which is not, has the curve open",
                        phase.name
                    );
                    let remedy = format!(
                        "close it there by `prescribe: {{{curve}: {{ux: 0, uy: 0}}}}` or a wall of that curve, or make the phase dynamic"
                    );
                    self.issue(&path, At::Key, problem, remedy);
                }
            }
            if !opens {
                let problem = "every phase prescribes the curve or has it as a wall";
                self.issue(&path, At::Key, problem, "let it open in a phase, or take `outflow` out");
            }
            let moves = |phase: &&Phase| {
                phase.prescribed.iter().any(|p| p.curve == *curve && p.displacement != TimeValue::Constant(0.0))
            };
            if let Some(phase) = phases.iter().find(moves) {
                let problem = format!("phase `{}` moves the curve", phase.name);
                self.issue(&path, At::Key, problem, "prescribe 0, which closes it, or nothing");
            }
        }
    }
}

/// The curve of a wall, and the name of its contact.
type Wall<'a> = (&'a str, Option<&'a str>);

/// Whether a phase lets soil leave through a curve: it neither prescribes its displacement nor has it as one of the walls.
fn is_open(walls: &[Wall], phase: &Phase, curve: &str) -> bool {
    let is_absent = |name: &str| phase.absent.iter().any(|absent| absent == name);
    let holds = |(wall, name): &Wall| *wall == curve && !is_absent(curve) && !name.is_some_and(is_absent);
    !phase.prescribed.iter().any(|p| p.curve == curve) && !walls.iter().any(holds)
}

/// The sides of a curve on the boundary of the grid `mesh`, by cell and number of the side; `fem` are the finite elements beside it.
///
/// # Errors
/// Input, at `place`: a curve that is not on the boundary of the mesh of material points.
pub(super) fn boundary_sides(
    (mesh, locator): (&Mesh<2>, &Locator<2>),
    fem: Option<&Mesh<2>>,
    curve: &Group,
    place: &dyn Fn() -> String,
) -> Result<Vec<(u32, u8)>> {
    let sorted = |mut ends: [u32; 2]| {
        ends.sort_unstable();
        ends
    };
    let of_side = |&(cell, side): &(u32, u8)| {
        let (_, facets) = mesh.cells.kind[cell as usize].facets();
        let nodes = mesh.cells.nodes(cell as usize);
        sorted([0, 1].map(|i| nodes[facets[side as usize][i]]))
    };
    let boundary: HashMap<[u32; 2], (u32, u8)> =
        locator.faces.boundary.iter().map(|side| (of_side(side), *side)).collect();
    let of_elements: HashSet<u32> = fem.iter().flat_map(|fem| fem.cells.nodes.iter().copied()).collect();
    let side = |(_, nodes): &(CellKind, Vec<u32>)| {
        let shared = of_elements.contains(&nodes[0]) && of_elements.contains(&nodes[1]);
        boundary.get(&sorted([nodes[0], nodes[1]])).filter(|_| !shared).copied().ok_or_else(|| {
            let x = mesh.nodes[nodes[0] as usize];
            let problem = format!("at {x:.3?} m the curve is not on the boundary of the mesh of material points");
            Error::input(place(), problem, "draw it where the regions of kind mpm and buffer end, with nothing beyond")
        })
    };
    curve.facets.iter().map(side).collect()
}

/// The curves of a case through which soil leaves the grid `mesh`.
///
/// # Errors
/// As [`boundary_sides`].
pub fn outflows(case: &Case, grid: (&Mesh<2>, &Locator<2>), fem: Option<&Mesh<2>>) -> Result<Vec<Outflow>> {
    let wall = |contact: &'_ Contact| match &contact.structure {
        Touching::Wall(curve) => Some((curve.clone(), contact.name.clone())),
        Touching::Structure(_) => None,
    };
    let walls: Vec<_> = case.contacts.iter().filter_map(wall).collect();
    let walls: Vec<Wall> = walls.iter().map(|(curve, name)| (curve.as_str(), name.as_deref())).collect();
    let outflow = |name: &String| {
        let sides = boundary_sides(grid, fem, group(grid.0, name)?, &|| format!("supports.{name}.outflow"))?;
        let open = case.phases.iter().map(|phase| is_open(&walls, phase, name)).collect();
        Ok(Outflow { name: name.clone(), sides, open })
    };
    case.supports.iter().filter(|support| support.outflow).map(|support| outflow(&support.curve)).collect()
}
