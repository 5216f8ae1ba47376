//! Soil that phases remove: what a case says of it, checked, and where the rest ends.

use super::check::Checker;
use super::checked::{Case, Numerics, Restore};
use super::locate::{At, Path};
use super::placed;
use super::raw::{self, Analysis, RegionKind};
use super::structure::suggest;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::soil::Parting;
use crate::step::Removal;

impl Checker {
    /// The regions that phase `number` removes.
    pub(super) fn removed(
        &mut self,
        number: usize,
        (file, numerics): (&raw::CaseFile, &Numerics),
        path: &Path,
    ) -> Vec<String> {
        let phase = &file.phases[number];
        let soil = || file.regions.iter().filter(|(_, region)| region.kind == RegionKind::Mpm).map(|(name, _)| name);
        let mut there = placed::soil_before(file, number);
        let mut removed = Vec::new();
        for (i, name) in phase.remove.iter().enumerate() {
            let path = path.key("remove").index(i);
            let kind = file.regions.get(name).map(|region| region.kind);
            match kind {
                Some(RegionKind::Mpm) if !there.contains(name.as_str()) => {
                    self.issue(
                        &path,
                        At::Value,
                        format!("`{name}` is removed already, or not placed yet"),
                        "take it out",
                    );
                }
                Some(RegionKind::Mpm) => {
                    there.remove(name.as_str());
                    removed.push(name.clone());
                }
                Some(RegionKind::Fem) => {
                    let remedy = "give the region `kind: mpm`";
                    self.issue(&path, At::Value, format!("`{name}` is soil of finite elements"), remedy);
                }
                Some(RegionKind::Structure) => {
                    let remedy = format!("take it away with `deactivate: [{name}]`");
                    self.issue(&path, At::Value, format!("`{name}` is a structure"), remedy);
                }
                _ => {
                    let remedy = suggest(name, soil().map(String::as_str));
                    self.issue(&path, At::Value, format!("there is no region `{name}` of soil"), remedy);
                }
            }
        }
        let path = path.key("remove");
        if !removed.is_empty() && there.is_empty() {
            self.issue(
                &path,
                At::Key,
                "no soil of kind mpm is left",
                "leave a region, or end the run before the phase",
            );
        }
        if !removed.is_empty() && numerics.solver.restore == Restore::Never {
            let remedy = "take `restore: never` out of `numerics`";
            self.issue(&path, At::Key, "a grid that is never reset keeps its soil", remedy);
        }
        if !removed.is_empty() && phase.analysis == Analysis::StrengthReduction {
            let remedy = "remove it in a phase before, with `analysis: quasi_static`";
            self.issue(&path, At::Key, "a search for failure begins in equilibrium", remedy);
        }
        removed
    }
}

/// What a phase removes from the background grid `mesh`, given its number; `None` of nothing.
pub fn of_phase<K: Kinematics<2>>(case: &Case, mesh: &Mesh<2>, phase: usize) -> Option<Removal<2>> {
    let removed: Vec<bool> = mesh.regions.iter().map(|name| case.phases[phase].removed.contains(name)).collect();
    if !removed.contains(&true) {
        return None;
    }
    let before = case.soil_before(phase);
    let there: Vec<bool> = mesh.regions.iter().map(|name| before.contains(name.as_str())).collect();
    let parting = Parting::<K>::new(mesh.clone(), &there, &removed);
    Some(Removal { regions: removed, parting: Box::new(parting) })
}
