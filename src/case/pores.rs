//! Water in the pores whose pressure is a field of its own: what a case says of it, checked, and what a scene has of it.

use super::changes;
use super::check::Checker;
use super::checked::{Analysis, Case, Material, Phase};
use super::find;
use super::incompressible::{bulk, has_water_of_its_own};
use super::locate::{At, Path};
use super::raw;
use crate::error::Result;
use crate::material::{Model, Profile};
use crate::mesh::Mesh;
use crate::run::{self, Watch, WatchedOn};
use crate::step::{Scene, Water};
use crate::term::{Porous, WaterStiffness};
use std::sync::Arc;

/// Poisson's ratio of an undrained soil as a whole, where none is given: that of PLAXIS.
const UNDRAINED: f64 = 0.495;
/// Unit weight of water (kN/m³) where none is given.
const UNIT_WEIGHT: f64 = 9.81;

impl Checker {
    /// Refuses what only an undrained material has.
    pub(super) fn drained_material(&mut self, material: &raw::Material, path: &Path) {
        let given = [
            ("permeability", material.permeability.is_some()),
            ("porosity", material.porosity.is_some()),
            ("water_bulk_modulus", material.water_bulk_modulus.is_some()),
            ("water_unit_weight", material.water_unit_weight.is_some()),
        ];
        for (key, _) in given.into_iter().filter(|(_, given)| *given) {
            let problem = format!("a drained material has no `{key}`: its pores never hold excess pressure");
            self.issue(&path.key(key), At::Key, problem, "take it out, or set `drainage: undrained`");
        }
    }

    /// The pore water of a material, if it has one of its own.
    pub(super) fn porous(&mut self, material: &raw::Material, model: &Arc<dyn Model>, path: &Path) -> Option<Porous> {
        if material.drainage != Some(raw::Drainage::Undrained) {
            return None;
        }
        if !has_water_of_its_own(material) {
            if material.water_unit_weight.is_some() {
                let remedy = "take it out, or give a `permeability`";
                self.issue(&path.key("water_unit_weight"), At::Key, "water that does not flow needs no weight", remedy);
            }
            return None;
        }
        let stiffness = self.water_stiffness(material, model, path)?;
        let permeability = material.permeability.map_or([0.0; 2], raw::Permeability::by_axis);
        if let Some(k) = permeability.iter().find(|k| **k < 0.0 || k.is_nan()) {
            let problem = format!("is {k}, but must be at least 0");
            self.issue(&path.key("permeability"), At::Value, problem, "give it in m/s, such as 1.0e-8");
            return None;
        }
        let weight = material.water_unit_weight.unwrap_or(UNIT_WEIGHT);
        Some(Porous { model: model.clone(), stiffness, mobility: permeability.map(|k| k / weight) })
    }

    fn water_stiffness(
        &mut self,
        material: &raw::Material,
        model: &Arc<dyn Model>,
        path: &Path,
    ) -> Option<WaterStiffness> {
        match (material.porosity, material.water_bulk_modulus) {
            (Some(porosity), Some(modulus)) => {
                if material.undrained_poisson.is_some() {
                    let problem = "`porosity` and `water_bulk_modulus` tell the stiffness of the water already";
                    self.issue(&path.key("undrained_poisson"), At::Key, problem, "keep one of the two ways");
                }
                Some(WaterStiffness::Modulus(modulus / porosity))
            }
            (None, None) => {
                let undrained = self.undrained_poisson(material, model, path)?;
                Some(WaterStiffness::Ratio(bulk(undrained) - bulk(model.elasticity().poisson())))
            }
            (porosity, _) => {
                let (given, missing) = match porosity {
                    Some(_) => ("porosity", "water_bulk_modulus"),
                    None => ("water_bulk_modulus", "porosity"),
                };
                let problem = format!("it tells the stiffness of the water only together with `{missing}`");
                self.issue(&path.key(given), At::Key, problem, format!("add `{missing}: …`, or take it out"));
                None
            }
        }
    }

    /// Poisson's ratio of an undrained soil as a whole, where that tells the stiffness of its water.
    pub(super) fn undrained_poisson(
        &mut self,
        material: &raw::Material,
        model: &Arc<dyn Model>,
        path: &Path,
    ) -> Option<f64> {
        let reference = "reference_pressure";
        if material.parameters.contains_key(reference) {
            let problem = "it would tell the stiffness of the water, too: far too little where the soil bears more";
            let remedy = "give `porosity` and `water_bulk_modulus`, such as 0.5 and 2.0e+6, or take it out";
            self.issue(&path.key(reference), At::Key, problem, remedy);
        }
        let poisson = model.elasticity().poisson();
        let undrained = material.undrained_poisson.unwrap_or(UNDRAINED);
        if undrained > poisson && undrained < 0.5 {
            return Some(undrained);
        }
        let problem = format!("is {undrained}, but must lie between `poisson` ({poisson}) and 0.5");
        let key = if material.undrained_poisson.is_some() { "undrained_poisson" } else { "poisson" };
        self.issue(&path.key(key), At::Value, problem, "give `poisson` of the skeleton, such as 0.3");
        None
    }

    /// A curve where water leaves.
    pub(super) fn drained(&mut self, file: &raw::CaseFile, name: &str, held: &raw::Components, path: &Path) {
        let Some(pressure) = held.pore_pressure else { return };
        let path = path.key("pore_pressure");
        if file.regions.get(name).is_some_and(|region| region.rigid == Some(true)) {
            let remedy = "take it out, or drain a physical curve of the soil by its name";
            self.issue(&path, At::Key, "a rigid structure has no pores", remedy);
        }
        if pressure != 0.0 {
            self.issue(&path, At::Value, "a drained curve has no excess pressure", "write 0 here");
        }
        if file.materials.values().all(|material| material.permeability.is_none()) {
            let remedy = "take it out, or give an undrained material a `permeability`";
            self.issue(&path, At::Key, "no material has a permeability", remedy);
        }
    }

    /// The excess pore pressure before the first phase.
    pub(super) fn initial_pore_pressure(&mut self, file: &raw::CaseFile, path: &Path) -> Vec<(usize, Profile)> {
        let mut checked = Vec::new();
        for (name, value) in &file.initial_pore_pressure {
            let path = path.key(name);
            let Some(region) = self.region_named(file, name, &path) else { continue };
            let material = file.regions.get(name).and_then(|region| file.materials.get(region.material.as_ref()?));
            if !material.is_some_and(has_water_of_its_own) {
                let remedy = "take it out, or give the material a `permeability`";
                self.issue(&path, At::Key, "its material has no pore water of its own", remedy);
            }
            self.falls_to_something(*value, &path);
            checked.push((region, value.profile()));
        }
        checked
    }

    /// What of the water only shows between blocks.
    pub(super) fn pores(&mut self, case: &Case, file: &raw::CaseFile) {
        let path = Path::default().key("numerics").key("gradient");
        let basis = case.numerics.basis;
        if let Some(lack) = basis.without_pore_water()
            && case.materials.iter().any(|m| m.porous.is_some())
        {
            let remedy = "choose `gradient: mpm`, or take the permeability out";
            self.issue(&path, At::Value, format!("{} {lack}", basis.name()), remedy);
        }
        if let Some(lack) = basis.without_pressure_field()
            && case.materials.iter().any(|m| m.carried.is_some())
        {
            let remedy =
                "choose `gradient: mpm`; or, for drained materials, `pressure: none` with a Poisson's ratio below 0.45";
            self.issue(&path, At::Value, format!("{} {lack}", basis.name()), remedy);
        }
        let wanted = |q: &raw::Quantity| *q == raw::Quantity::PorePressure;
        for (i, entry) in file.output.history.iter().enumerate().filter(|(_, e)| e.quantities.iter().any(wanted)) {
            // Nodes have that of the field of the water alone.
            let of_nodes = entry.on.as_ref().is_some_and(|on| !file.regions.contains_key(on));
            let (has, problem, remedy): (fn(&Material) -> bool, _, _) = if of_nodes {
                (
                    |m| m.porous.is_some(),
                    "no material has pore water of its own",
                    "give an undrained material a `permeability`",
                )
            } else {
                (Material::has_pore_pressure, "no material is undrained", "set `drainage: undrained`")
            };
            if !case.materials.iter().any(has) {
                let path = Path::default().key("output").key("history").index(i).key("quantities");
                self.issue(&path, At::Value, problem, format!("take `pore_pressure` out, or {remedy}"));
            }
        }
    }
}

/// The water in the pores, if some soil has a field for its pressure.
pub(super) fn water(case: &Case, mesh: &Mesh<2>) -> Result<Option<Water>> {
    let porous = porous(case, mesh)?;
    if porous.iter().all(Option::is_none) {
        return Ok(None);
    }
    let mut drained = Vec::new();
    for support in case.supports.iter().filter(|support| support.drained) {
        drained.extend_from_slice(&find::group(mesh, &support.curve)?.nodes);
    }
    drained.sort_unstable();
    drained.dedup();
    let structures = changes::of_structures(case, mesh);
    let drains = changes::by_number(case, mesh, |material| material.drains.then_some(()))?;
    let drains = drains.iter().zip(structures).map(|(drains, structure)| drains.is_some() && !structure).collect();
    Ok(Some(Water { porous, alone: changes::used(case).all(|(_, m)| m.carried.is_none()), drains, drained }))
}

/// Whether water flows in a phase.
pub(super) fn flows(case: &Case, phase: &Phase) -> bool {
    matches!(phase.analysis, Analysis::Dynamic | Analysis::Consolidation)
        && case.materials.iter().any(|m| m.porous.is_some())
}

/// The porous soil of each material by number.
pub(super) fn porous(case: &Case, mesh: &Mesh<2>) -> Result<Vec<Option<Porous>>> {
    changes::by_number(case, mesh, |material| material.porous.clone())
}

/// Lets pore pressures be watched at corners of cells, which alone have them.
pub(super) fn pressures_at_corners(scene: &Scene<2>, watches: Vec<Watch>) -> Vec<Watch> {
    let wanted = |watch: &Watch| watch.quantities.contains(&run::Quantity::PorePressure);
    if !watches.iter().any(wanted) {
        return watches;
    }
    let mut corner = vec![false; scene.mesh.nodes.len()];
    for mesh in std::iter::once(&scene.mesh).chain(scene.fem.iter().map(|fem| &fem.mesh)) {
        for c in 0..mesh.cells.len() {
            for &n in mesh.cells.corners(c) {
                corner[n as usize] = true;
            }
        }
    }
    let mut all = Vec::new();
    for watch in watches {
        let WatchedOn::Nodes(nodes) = &watch.on else {
            all.push(watch);
            continue;
        };
        let corners: Vec<u32> = nodes.iter().copied().filter(|&n| corner[n as usize]).collect();
        for &quantity in &watch.quantities {
            let at_corners = quantity == run::Quantity::PorePressure;
            let on = WatchedOn::Nodes(if at_corners { corners.clone() } else { nodes.clone() });
            all.push(Watch { name: watch.name.clone(), on, quantities: vec![quantity] });
        }
    }
    all
}
