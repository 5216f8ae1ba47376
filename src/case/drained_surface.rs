//! `drained_surface`: the surface of soil, wherever it moves, as one that drains.

use super::check::Checker;
use super::checked::{Case, Surface};
use super::find::region_index;
use super::locate::{At, Path};
use super::pores::{flows, porous};
use super::raw::{self, CaseFile};
use crate::error::Result;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::term;

impl Checker {
    /// The surface that drains, if one does and the entry, at `path`, has no mistake.
    pub(super) fn drained_surface(&mut self, file: &CaseFile, path: &Path) -> Option<Surface> {
        let name = file.drained_surface.as_ref()?;
        let surface = self.surface(name, file, path)?;
        let named = |region: &String| surface.region().is_none() || region == name;
        let first =
            file.regions.iter().filter(|(region, _)| named(region)).filter_map(|(_, region)| region.material.as_ref());
        let later =
            file.phases.iter().flat_map(raw::Phase::assigned).filter(|(region, _)| named(region)).map(|(_, m)| m);
        let conducts = |material: &raw::Material| material.permeability.is_some();
        if !first.chain(later).any(|material| file.materials.get(material).is_some_and(conducts)) {
            let remedy = "take it out, or give the material of the soil a `permeability`";
            self.issue(path, At::Key, "no soil there has a permeability", remedy);
        }
        if matches!(file.numerics.restore, raw::Restore::Named(raw::RestoreName::Never)) {
            let problem = "on a grid that is never restored the surface of the soil lies on curves";
            let remedy = "drain these by `pore_pressure: 0` under `supports`, or take `restore: never` out";
            self.issue(path, At::Key, problem, remedy);
        }
        Some(surface)
    }
}

/// The term of the surface that drains, where water flows (kPa/m: `unit`).
///
/// # Errors
/// Input: a region that the mesh lacks.
pub(super) fn term<K: Kinematics<2>>(
    case: &Case,
    mesh: &Mesh<2>,
    unit: Option<f64>,
) -> Result<Option<term::DrainedSurface<K>>> {
    let (Some(surface), Some(unit)) = (case.drained_surface, unit) else { return Ok(None) };
    let region = surface.region().map(|i| region_index(mesh, &case.regions[i].name)).transpose()?;
    let flows = case.phases.iter().map(|phase| flows(case, phase)).collect();
    Ok(Some(term::DrainedSurface::new(porous(case, mesh)?, region, unit, flows)))
}
