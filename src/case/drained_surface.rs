//! `drained_surface`: the surface of soil, wherever it moves, as one that drains.

use super::check::Checker;
use super::checked::{Site, Surface};
use super::find::region_index;
use super::keyed::{Keyed, Terms};
use super::locate::{At, Path};
use super::pores::{flows, porous};
use super::raw::{self, CaseFile};
use crate::kinematics::Kinematics;
use crate::term;

/// The surface that drains.
#[derive(Debug)]
pub struct DrainedSurface(Surface);

impl Keyed for DrainedSurface {
    const KEY: &'static str = "drained_surface";
    const DESCRIPTION: &'static str = "The surface of soil, wherever it moves, that has no excess pore pressure while water flows: all, \
         or the name of a region. Default: none.";

    type Written = String;

    fn check(name: String, file: &CaseFile, path: &Path, checker: &mut Checker) -> Option<Self> {
        let surface = checker.surface(&name, file, path)?;
        let named = |region: &String| surface.region().is_none() || *region == name;
        let first =
            file.regions.iter().filter(|(region, _)| named(region)).filter_map(|(_, region)| region.material.as_ref());
        let later =
            file.phases.iter().flat_map(|phase| &phase.materials).filter(|(region, _)| named(region)).map(|(_, m)| m);
        let conducts = |material: &raw::Material| material.permeability.is_some();
        if !first.chain(later).any(|material| file.materials.get(material).is_some_and(conducts)) {
            let remedy = "take it out, or give the material of the soil a `permeability`";
            checker.issue(path, At::Key, "no soil there has a permeability", remedy);
        }
        if matches!(file.numerics.restore, raw::Restore::Named(raw::RestoreName::Never)) {
            let problem = "on a grid that is never restored the surface of the soil lies on curves";
            let remedy = "drain these by `pore_pressure: 0` under `supports`, or take `restore: never` out";
            checker.issue(path, At::Key, problem, remedy);
        }
        Some(Self(surface))
    }

    fn needs_surface(&self) -> bool {
        true
    }

    fn drains(&self) -> Option<Surface> {
        Some(self.0)
    }

    fn terms<K: Kinematics<2>>(&self, site: &Site) -> Terms {
        let Some(unit) = site.pressure_unit else { return Ok(Vec::new()) };
        let Site { case, mesh, .. } = site;
        let region = self.0.region().map(|i| region_index(mesh, &case.regions[i].name)).transpose()?;
        let flows = case.phases.iter().map(|phase| flows(case, phase)).collect();
        Ok(vec![Box::new(term::DrainedSurface::<K>::new(porous(case, mesh)?, region, unit, flows))])
    }
}
