//! Soil that phases remove: what a case says of it, checked, and where the rest ends.

use super::check::Checker;
use super::checked::{Case, Content, Numerics, Phase, Restore};
use super::locate::{At, Path};
use super::raw::{self, Analysis, RegionKind};
use super::structure::suggest;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::soil::Parting;
use crate::step::Removal;

impl Checker {
    /// The regions that a phase removes, given the phases before it.
    pub(super) fn removed(
        &mut self,
        phase: &raw::Phase,
        before: &[Phase],
        (file, numerics): (&raw::CaseFile, &Numerics),
        path: &Path,
    ) -> Vec<String> {
        let soil = || file.regions.iter().filter(|(_, region)| region.kind == RegionKind::Mpm).map(|(name, _)| name);
        let mut gone: Vec<&String> = before.iter().flat_map(|phase| &phase.removed).collect();
        let mut removed = Vec::new();
        for (i, name) in phase.remove.iter().enumerate() {
            let path = path.key("remove").index(i);
            let kind = file.regions.get(name).map(|region| region.kind);
            match kind {
                Some(RegionKind::Mpm) if gone.contains(&name) => {
                    self.issue(&path, At::Value, format!("`{name}` is removed already"), "take it out");
                }
                Some(RegionKind::Mpm) => {
                    gone.push(name);
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
        if !removed.is_empty() && soil().all(|name| gone.contains(&name)) {
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
    let in_phases = |phases: &[Phase]| -> Vec<bool> {
        mesh.regions.iter().map(|name| phases.iter().any(|phase| phase.removed.contains(name))).collect()
    };
    let removed = in_phases(&case.phases[phase..=phase]);
    if !removed.contains(&true) {
        return None;
    }
    let gone = in_phases(&case.phases[..phase]);
    let is_soil = |name: &String| case.content(name).is_some_and(|content| matches!(content, Content::Mpm { .. }));
    let there: Vec<bool> = mesh.regions.iter().zip(&gone).map(|(name, gone)| is_soil(name) && !gone).collect();
    let parting = Parting::<K>::new(mesh.clone(), &there, &removed);
    Some(Removal { regions: removed, parting: Box::new(parting) })
}
