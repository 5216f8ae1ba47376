//! Changes of material in phases: what a case says of them, checked, and the numbers that materials have in a scene.
//!
//! A scene numbers first the regions of the mesh, each with the material it begins with, then the changes of all phases in their order
//! ([`crate::points::Points::model_of`]).

use super::check::Checker;
use super::checked::{Case, Change, Content, Material, Phase, Region};
use super::find::{filled, region_index, regions};
use super::incompressible::has_water_of_its_own;
use super::locate::{At, Path};
use super::over_depth::check_over_depth;
use super::raw;
use super::structure::suggest;
use crate::error::Result;
use crate::material::{Model, RandomStrengths};
use crate::mesh::Mesh;
use crate::step;
use crate::term::MixedPressure;
use std::collections::BTreeMap;
use std::sync::Arc;

/// How a material has the pressure of its pore water.
fn water(material: &raw::Material) -> &'static str {
    match material.drainage {
        Some(raw::Drainage::Undrained) if has_water_of_its_own(material) => "undrained with pore water of its own",
        Some(raw::Drainage::Undrained) => "undrained without a permeability",
        _ => "drained or in total stress",
    }
}

impl Checker {
    /// The materials that regions take as a phase begins, given those before it, by region, which they replace.
    pub(super) fn changes(
        &mut self,
        phase: &raw::Phase,
        first: bool,
        file: &raw::CaseFile,
        now: &mut BTreeMap<String, String>,
        path: &Path,
    ) -> Vec<Change> {
        let mut changes = Vec::new();
        let materials: Vec<&str> = file.materials.keys().map(String::as_str).collect();
        for (name, into) in &phase.materials {
            let path = path.key("materials").key(name);
            if first {
                let remedy = "name the material under `regions`, or change it in a later phase";
                self.issue(&path, At::Key, "the first phase begins with the materials of `regions`", remedy);
                continue;
            }
            let Some(region) = self.region_named(file, name, &path) else { continue };
            let Ok(material) = materials.binary_search(&into.as_str()) else {
                let problem = format!("there is no material `{into}`");
                self.issue(&path, At::Value, problem, suggest(into, materials.iter().copied()));
                continue;
            };
            if file.regions[name].kind == raw::RegionKind::Buffer {
                self.issue(&path, At::Key, "a buffer region holds no material", "take it out, or name another region");
                continue;
            }
            if file.regions[name].plate.is_some() {
                let remedy = "take it out; to change a plate, draw two and `activate` one as the other is deactivated";
                self.issue(&path, At::Key, "a plate has stiffnesses of its own, and no material", remedy);
                continue;
            }
            if file.regions[name].rigid == Some(true) {
                let problem = "a rigid structure has nothing of its material but the mass";
                self.issue(&path, At::Key, problem, "take it out, or leave `rigid` out of the region");
                continue;
            }
            // A region without a known material has been told of.
            let Some(before) = now.get(name).and_then(|before| Some((before, file.materials.get(before)?))) else {
                continue;
            };
            if before.0 == into {
                self.issue(&path, At::Value, format!("`{name}` is of `{into}` already"), "take it out");
                continue;
            }
            let kinds = [before.1, &file.materials[into]].map(water);
            if kinds[0] != kinds[1] {
                let problem = format!("`{into}` is {}, but `{}` before it is {}", kinds[1], before.0, kinds[0]);
                let remedy = "choose a material with the same drainage: it says whose stress the model answers for, and where \
                    the pressure of the water is";
                self.issue(&path, At::Value, problem, remedy);
                continue;
            }
            now.insert(name.clone(), into.clone());
            changes.push(Change { region, material });
        }
        changes
    }
}

/// All changes, in the order of their numbers, with their regions and materials.
fn all(case: &Case) -> impl Iterator<Item = (&Region, &Material)> {
    let of_phase = |phase: &'_ Phase| phase.changes.clone();
    let changes = case.phases.iter().flat_map(of_phase);
    changes.filter_map(|change| Some((&case.regions[change.region], case.materials.get(change.material)?)))
}

/// The regions with points and the materials that they ever have.
pub fn used(case: &Case) -> impl Iterator<Item = (&Region, &Material)> {
    filled(case).chain(all(case))
}

/// What is so of each material by number; `None` for regions without one.
///
/// # Errors
/// Input: a region that the mesh has not.
pub fn by_number<T: Clone>(case: &Case, mesh: &Mesh<2>, of: impl Fn(&Material) -> Option<T>) -> Result<Vec<Option<T>>> {
    let mut numbered = vec![None; mesh.regions.len()];
    for (region, material) in filled(case) {
        numbered[region_index(mesh, &region.name)? as usize] = of(material);
    }
    numbered.extend(all(case).map(|(_, material)| of(material)));
    Ok(numbered)
}

/// Whether each material by number is one of a structure.
pub fn of_structures(case: &Case, mesh: &Mesh<2>) -> Vec<bool> {
    let mut of_structures = regions(case, mesh, Content::is_structure);
    of_structures.extend(all(case).map(|(region, _)| region.content.is_structure()));
    of_structures
}

/// What is so of each region of the mesh with one of the materials that it ever has.
///
/// # Errors
/// As [`by_number`].
pub fn ever(case: &Case, mesh: &Mesh<2>, is: impl Fn(&Material) -> bool) -> Result<Vec<bool>> {
    let mut of_region = vec![false; mesh.regions.len()];
    for (region, material) in used(case) {
        of_region[region_index(mesh, &region.name)? as usize] |= is(material);
    }
    Ok(of_region)
}

/// The material of a region of the `mesh` as phase `number` has begun, with its number in the scene.
///
/// # Errors
/// Input: a region that the mesh has not.
pub fn at(case: &Case, mesh: &Mesh<2>, number: usize, region: &str) -> Result<step::Soil> {
    let index = region_index(mesh, region)?;
    let begun = case.phases[..=number].iter().flat_map(|p| &p.changes).zip(mesh.regions.len()..);
    let last = begun.filter(|(change, _)| case.regions[change.region].name == region).last();
    let first = || Some((case.content(region)?.material()?, usize::from(index)));
    let (material, number) = last.map(|(change, number)| (change.material, number)).or_else(first).unwrap_or_default();
    Ok(step::Soil { region: index, number: number as u16, material: case.materials[material].clone() })
}

/// The changes of a phase, by its number; `meshes` are those of the grid and of what is beside it.
///
/// # Errors
/// Input: a region that the mesh has not, a material that is not in range over the height of a region.
pub fn of_phase(case: &Case, meshes: [&Mesh<2>; 2], phase: usize) -> Result<Vec<step::Change>> {
    let first = meshes[0].regions.len() + case.phases[..phase].iter().map(|p| p.changes.len()).sum::<usize>();
    let change = |(k, change): (usize, &Change)| {
        let region = &case.regions[change.region];
        let before = case.phases[..phase].iter().rev().flat_map(|p| &p.changes).find(|c| c.region == change.region);
        let before = before.map(|change| change.material).or(region.content.material());
        let before = before.and_then(|material| case.materials.get(material));
        let material = &case.materials[change.material];
        let index = region_index(meshes[0], &region.name)?;
        let mesh = meshes[usize::from(region.content.is_fem())];
        check_over_depth(mesh, index, region, material)?;
        Ok(step::Change {
            region: index,
            of: region.name.clone(),
            number: (first + k) as u16,
            into: material.clone(),
            before: before.cloned(),
        })
    };
    case.phases[phase].changes.iter().enumerate().map(change).collect()
}

/// The model of the whole stress of each material by number.
///
/// # Errors
/// As [`by_number`].
pub fn models(case: &Case, mesh: &Mesh<2>) -> Result<Vec<Option<Arc<dyn Model>>>> {
    by_number(case, mesh, |material| Some(material.model.clone()))
}

/// The field of strength of each material by number, where that varies at random.
pub fn random_strengths(case: &Case, mesh: &Mesh<2>) -> Result<RandomStrengths> {
    by_number(case, mesh, |material| material.random_strength.clone())
}

/// What the pressure field carries of each material by number.
pub fn carried(case: &Case, mesh: &Mesh<2>) -> Result<Vec<Option<MixedPressure>>> {
    by_number(case, mesh, |material| material.carried.clone())
}
