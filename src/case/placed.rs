//! Soil that phases place: what a case says of it, checked, and what is there before a phase.

use super::changes;
use super::check::Checker;
use super::checked::{Case, Change, Content, Geometry, Numerics, Restore};
use super::find::region_index;
use super::locate::{At, Path};
use super::raw::{self, Analysis, Quadrature, RegionKind};
use super::structure::suggest;
use crate::error::Result;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::soil::{Fill, Filling};
use crate::step::Placement;
use std::collections::{BTreeMap, BTreeSet};

/// The soil that is there before phase `number`, of `all` regions of material points, given what each phase removes and then places. What is placed
/// before it is removed is absent at first.
fn before<'a>(all: impl Iterator<Item = &'a str>, stages: &[[Vec<&'a str>; 2]], number: usize) -> BTreeSet<&'a str> {
    let comes = |name: &&str| {
        let first =
            stages.iter().flatten().zip([false, true].into_iter().cycle()).find(|(names, _)| names.contains(name));
        first.is_some_and(|(_, placed)| placed)
    };
    let mut there: BTreeSet<&str> = all.filter(|name| !comes(name)).collect();
    for [removed, placed] in &stages[..number] {
        there.retain(|name| !removed.contains(name));
        there.extend(placed);
    }
    there
}

impl Case {
    /// The regions of material points that are there before phase `number`, without what it removes and places.
    pub fn soil_before(&self, number: usize) -> BTreeSet<&str> {
        let of = |names: &mut dyn Iterator<Item = &String>| -> Vec<&str> {
            let names: Vec<&String> = names.collect();
            self.regions.iter().map(|r| r.name.as_str()).filter(|name| names.iter().any(|n| n == name)).collect()
        };
        let stages: Vec<_> =
            self.phases.iter().map(|phase| [of(&mut phase.removed.iter()), of(&mut phase.coming())]).collect();
        let all = self.regions.iter().filter(|region| matches!(region.content, Content::Mpm { .. }));
        before(all.map(|region| region.name.as_str()), &stages, number)
    }

    /// Whether a region is empty as the run begins, to be filled by a phase.
    pub fn comes_later(&self, region: &str) -> bool {
        let is_soil = matches!(self.content(region), Some(Content::Mpm { .. }));
        is_soil
            && self.phases.iter().any(|phase| phase.coming().any(|n| n == region))
            && !self.soil_before(0).contains(region)
    }
}

/// Regions that soil comes into.
fn coming(phase: &raw::Phase) -> impl Iterator<Item = &String> {
    phase.place.names().chain(phase.inflow.values().map(|inflow| &inflow.region))
}

/// The soil that is there before phase `number` of the case file.
pub(super) fn soil_before(file: &raw::CaseFile, number: usize) -> BTreeSet<&str> {
    let all = file.regions.iter().filter(|(_, region)| region.kind == RegionKind::Mpm).map(|(name, _)| name.as_str());
    let of = |phase: &'_ raw::Phase| -> [Vec<&str>; 2] {
        let known = |name: &str| file.regions.get_key_value(name).map(|(name, _)| name.as_str());
        [phase.remove.iter().filter_map(|n| known(n)).collect(), coming(phase).filter_map(|n| known(n)).collect()]
    };
    let stages: Vec<_> = file.phases.iter().map(of).collect();
    before(all, &stages, number)
}

impl Checker {
    /// The regions that phase `number` fills, and the materials that they take other than those they have, by region.
    pub(super) fn placed(
        &mut self,
        number: usize,
        (file, numerics): (&raw::CaseFile, &Numerics),
        now: &mut BTreeMap<String, String>,
        path: &Path,
    ) -> (Vec<String>, Vec<Change>) {
        let phase = &file.phases[number];
        let mut there = soil_before(file, number);
        there.retain(|name| !phase.remove.iter().any(|n| n == name));
        let (mut placed, mut changes) = (Vec::new(), Vec::new());
        let path = path.key("place");
        for (i, (name, into)) in phase.place.entries().enumerate() {
            let (path, at) = if into.is_some() { (path.key(name), At::Key) } else { (path.index(i), At::Value) };
            match file.regions.get(name).map(|region| region.kind) {
                Some(RegionKind::Mpm) if there.contains(name.as_str()) || placed.contains(name) => {
                    let remedy = "take it out, or `remove` it before";
                    self.issue(&path, at, format!("`{name}` is there already"), remedy);
                    continue;
                }
                Some(RegionKind::Mpm) => placed.push(name.clone()),
                Some(RegionKind::Structure) => {
                    let remedy =
                        format!("let it come with `activate: [{name}]`, after a `deactivate` in the first phase");
                    self.issue(&path, at, format!("`{name}` is a structure"), remedy);
                    continue;
                }
                Some(_) => {
                    self.issue(&path, at, format!("`{name}` is not of kind mpm"), "give the region `kind: mpm`");
                    continue;
                }
                None => {
                    let soil = file.regions.iter().filter(|(_, region)| region.kind == RegionKind::Mpm);
                    let remedy = suggest(name, soil.map(|(name, _)| name.as_str()));
                    self.issue(&path, at, format!("there is no region `{name}` of soil"), remedy);
                    continue;
                }
            }
            let Some(into) = into.filter(|into| now.get(name) != Some(into)) else { continue };
            let names: Vec<&str> = file.materials.keys().map(String::as_str).collect();
            let Ok(material) = names.binary_search(&into.as_str()) else {
                self.issue(&path, At::Value, format!("there is no material `{into}`"), suggest(into, names));
                continue;
            };
            if number == 0 {
                let remedy = format!("name `{into}` as the material of `{name}` there");
                self.issue(&path, At::Value, "the first phase begins with the materials of `regions`", remedy);
                continue;
            }
            now.insert(name.clone(), into.clone());
            changes.extend(self.region_named(file, name, &path).map(|region| Change { region, material }));
        }
        if !placed.is_empty() {
            self.can_place(phase, numerics, &path);
            self.is_empty_at_first(file, &placed);
        }
        (placed, changes)
    }

    fn can_place(&mut self, phase: &raw::Phase, numerics: &Numerics, path: &Path) {
        if numerics.solver.restore == Restore::Never {
            let remedy = "take `restore: never` out of `numerics`";
            self.issue(path, At::Key, "a grid that is never reset takes no new soil", remedy);
        }
        if numerics.quadrature == Quadrature::Points {
            let problem =
                "new soil needs the surface of the soil that is there, which `quadrature: points` does not follow";
            self.issue(path, At::Key, problem, "choose `quadrature: resampled` under `numerics`");
        }
        if phase.analysis == Analysis::StrengthReduction {
            let remedy = "place it in a phase before, with `analysis: quasi_static`";
            self.issue(path, At::Key, "a search for failure begins in equilibrium", remedy);
        }
    }

    /// Refuses a state at the beginning of regions that are empty then.
    pub(super) fn is_empty_at_first(&mut self, file: &raw::CaseFile, placed: &[String]) {
        let at_first = soil_before(file, 0);
        if at_first.is_empty() {
            let remedy = "leave a region of kind mpm out of every `place`: the ground on which the rest comes";
            self.issue(&Path::default().key("regions"), At::Key, "no soil is there as the run begins", remedy);
        }
        for name in placed.iter().filter(|name| !at_first.contains(name.as_str())) {
            let blocks = [
                ("initial_velocity", file.initial_velocity.contains_key(name)),
                ("initial_pore_pressure", file.initial_pore_pressure.contains_key(name)),
            ];
            for (block, _) in blocks.iter().filter(|(_, given)| *given) {
                let problem = format!("`{name}` is empty until a phase places it, without stress and at rest");
                self.issue(&Path::default().key(block).key(name), At::Key, problem, "take it out");
            }
        }
    }
}

/// What a phase places on the background grid `mesh`, given its number; `None` of nothing.
///
/// # Errors
/// `Input`: a region that the mesh has not.
pub fn of_phase<K: Kinematics<2>>(case: &Case, mesh: &Mesh<2>, number: usize) -> Result<Option<Placement<2>>> {
    let phase = &case.phases[number];
    if phase.placed.is_empty() {
        return Ok(None);
    }
    let mut there = case.soil_before(number);
    there.retain(|name| !phase.removed.iter().any(|n| n == name));
    let is_there = mesh.regions.iter().map(|name| there.contains(name.as_str())).collect();
    let (mut fills, mut soils) = (Vec::new(), Vec::new());
    for name in &phase.placed {
        let Some(Content::Mpm { points_per_cell, .. }) = case.content(name) else { continue };
        let region = region_index(mesh, name)?;
        fills.push(Fill { region, points_per_cell: points_per_cell as u32 });
        soils.push(changes::at(case, mesh, number, name)?);
    }
    let axisymmetric = case.geometry == Geometry::Axisymmetric;
    let placing = Box::new(Filling::<K>::new(mesh.clone(), is_there, fills, axisymmetric));
    Ok(Some(Placement { soils, placing }))
}
