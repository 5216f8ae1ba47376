//! Water around soil and structures and in the pores of soil: its levels in each phase, and the terms of its pressure.

use super::changes;
use super::check::Checker;
use super::checked::{Case, Content, LoadProfile, Phase, SurfaceLoad, Water};
use super::find::{mean_size, region_index, regions};
use super::locate::{At, Path};
use super::raw;
use crate::error::Result;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::run::Acting;
use crate::term::{self, FacetPressure, Hydrostatic, SurfaceTraction, Term, VirtualPressure, WaterLevels};
use crate::time_value::TimeValue;

/// Half the height of the band over which a pressure begins to grow, as a share of the diagonal of a cell:
/// a quarter of its side.
const BAND: f64 = 0.18;

impl Checker {
    pub(super) fn water(&mut self, file: &raw::CaseFile, root: &Path) -> Option<Water> {
        let whole = file.water.as_ref();
        let path = root.key("water");
        if whole.is_some_and(|water| water.level.is_none() && water.phreatic_level.is_none()) {
            self.issue(&path, At::Key, "the water has no level", "add `level: …` or `phreatic_level: …`");
        }
        let of_phases = |of: fn(&raw::Phase) -> &Option<raw::InTime>| file.phases.iter().map(of).collect::<Vec<_>>();
        let outside = whole.and_then(|water| water.level.as_ref());
        let level = self.levels(["level", "water_level"], outside, of_phases(|phase| &phase.water_level), root);
        let inside = whole.and_then(|water| water.phreatic_level.as_ref());
        let of_pores = of_phases(|phase| &phase.phreatic_level);
        let phreatic = self.levels(["phreatic_level"; 2], inside, of_pores, root);
        Some(Water { unit_weight: whole?.unit_weight, level, phreatic })
    }

    /// A level in each phase, given that of the whole case and those of the phases, by the keys of both.
    fn levels(
        &mut self,
        [key, of_phase]: [&str; 2],
        whole: Option<&raw::InTime>,
        own: Vec<&Option<raw::InTime>>,
        root: &Path,
    ) -> Option<Vec<TimeValue>> {
        let path = |i: usize| root.key("phases").index(i).key(of_phase);
        let Some(whole) = whole else {
            for (i, _) in own.iter().enumerate().filter(|(_, level)| level.is_some()) {
                let problem = format!("there is no water with a `{key}` in this case");
                self.issue(&path(i), At::Key, problem, format!("add `water: {{{key}: …}}`, or take it out"));
            }
            return None;
        };
        let whole = self.in_time(whole, &root.key("water").key(key));
        let levels = own.into_iter().enumerate().map(|(i, level)| match level {
            Some(level) => self.in_time(level, &path(i)),
            None => whole.clone(),
        });
        Some(levels.collect())
    }
}

impl Water {
    /// The pressure of the water outside in each phase, over cells of the size `size` (m).
    pub fn heads(&self, size: f64) -> Vec<Option<Hydrostatic>> {
        self.below(self.level.as_deref(), size)
    }

    /// That of the water in the pores.
    pub fn heads_in_pores(&self, size: f64) -> Vec<Option<Hydrostatic>> {
        self.below(self.phreatic.as_deref(), size)
    }

    /// Both, where they differ in some phase: friction has no share in what the one has more than the other.
    pub fn levels(&self, size: f64) -> Option<WaterLevels> {
        let differ = self.phreatic.is_some() && self.phreatic != self.level;
        differ.then(|| WaterLevels::new(self.heads(size), self.heads_in_pores(size)))
    }

    fn below(&self, levels: Option<&[TimeValue]>, size: f64) -> Vec<Option<Hydrostatic>> {
        let head = |level: &TimeValue| Hydrostatic {
            top: TimeValue::Constant(0.0),
            gradient: TimeValue::Constant(self.unit_weight),
            datum: level.clone(),
            band: BAND * size,
        };
        levels.unwrap_or_default().iter().map(|level| Some(head(level))).collect()
    }

    /// The pressure (kPa) outside at height `y` (m) as the run begins.
    pub fn at_first(&self, y: f64) -> f64 {
        self.pressure_at_first(self.level.as_deref(), y)
    }

    /// That in the pores; `None` where they have no water.
    pub fn in_pores_at_first(&self, y: f64) -> Option<f64> {
        self.phreatic.as_ref().map(|levels| self.pressure_at_first(Some(levels), y))
    }

    fn pressure_at_first(&self, levels: Option<&[TimeValue]>, y: f64) -> f64 {
        let level = levels.and_then(|levels| levels.first());
        level.map_or(0.0, |level| self.unit_weight * (level.at(0.0) - y).max(0.0))
    }
}

impl LoadProfile {
    /// The same over cells of the size `size` (m).
    pub fn head(&self, size: f64) -> Hydrostatic {
        let datum = TimeValue::Constant(self.datum);
        Hydrostatic { top: self.top.clone(), gradient: self.gradient.clone(), datum, band: BAND * size }
    }
}

impl SurfaceLoad {
    /// Whether it acts on all of the boundary of the material and is nothing but a pressure.
    pub fn is_pressure_all_around(&self) -> bool {
        let none = TimeValue::Constant(0.0);
        let whole = self.region.is_none() && self.within.is_none();
        whole && self.shear == none && self.components.iter().all(|component| *component == none)
    }
}

/// Whether a load can be taken into the material. Finite elements would need it too where they meet the material.
fn is_all_around(case: &Case, load: &SurfaceLoad) -> bool {
    let fem = case.regions.iter().any(|region| region.content.is_fem() && !region.content.is_structure());
    !fem && load.is_pressure_all_around()
}

/// Whether the surface of the material points must be known: for loads on it, for other terms, or to be shown.
pub fn needs_surface(case: &Case) -> bool {
    let water = case.water.as_ref().is_some_and(|water| water.level.is_some());
    let needed = case.output.surface || water || case.drained_surface.is_some();
    needed || case.phases.iter().any(|phase| !phase.surface_loads.is_empty())
}

/// The loads on the surface of the material points.
///
/// # Errors
/// Input: a region that the mesh has not.
pub fn loads(case: &Case, mesh: &Mesh<2>, size: f64) -> Result<Vec<term::SurfaceLoad>> {
    let mut loads = Vec::new();
    for (phase, load) in case.phases.iter().enumerate().flat_map(|(i, p)| p.surface_loads.iter().map(move |l| (i, l))) {
        let name = load.region.map(|region| &case.regions[region].name);
        loads.push(term::SurfaceLoad {
            phase,
            region: name.map(|name| region_index(mesh, name)).transpose()?,
            pressure: load.pressure.as_ref().map(|pressure| pressure.head(size)),
            shear: load.shear.clone(),
            components: load.components.clone(),
            within: load.within,
        });
    }
    Ok(loads)
}

/// What acts on the surface of the material points, for the frames.
///
/// # Errors
/// As [`loads`].
pub fn acting(case: &Case, mesh: &Mesh<2>) -> Result<Acting> {
    let size = mean_size(mesh);
    let water = case.water.as_ref().map_or_else(Vec::new, |water| water.heads(size));
    Ok(Acting { loads: loads(case, mesh, size)?, water })
}

/// The terms of water and of loads on the surface of the material points.
///
/// # Errors
/// As [`loads`].
pub fn terms<K: Kinematics<2>>(case: &Case, mesh: &Mesh<2>, size: f64) -> Result<Vec<Box<dyn Term<2>>>> {
    let mut terms: Vec<Box<dyn Term<2>>> = Vec::new();
    if let Some(water) = &case.water {
        terms.push(Box::new(of_water::<K>(case, water, water.heads(size), mesh, size)));
    }
    for (i, phase) in case.phases.iter().enumerate() {
        for load in phase.surface_loads.iter().filter(|load| is_all_around(case, load)) {
            let Some(pressure) = &load.pressure else { continue };
            let mut heads = vec![None; case.phases.len()];
            heads[i] = Some(pressure.head(size));
            terms.push(Box::new(VirtualPressure::<K>::new(heads)));
        }
    }
    let all = case.phases.iter().flat_map(|phase| &phase.surface_loads);
    let pieces = loads(case, mesh, size)?.into_iter().zip(all).filter(|(_, load)| !is_all_around(case, load));
    let pieces: Vec<_> = pieces.map(|(load, _)| load).collect();
    if !pieces.is_empty() {
        terms.push(Box::new(SurfaceTraction::<K>::new(pieces)));
    }
    Ok(terms)
}

/// Water with the pressure `outside` in each phase, and that in the pores of all soil.
fn of_water<K>(
    case: &Case,
    water: &Water,
    outside: Vec<Option<Hydrostatic>>,
    mesh: &Mesh<2>,
    size: f64,
) -> VirtualPressure<K> {
    let porous = changes::of_structures(case, mesh).into_iter().map(|structure| !structure).collect();
    VirtualPressure::new(outside).with_pores(water.heads_in_pores(size), porous)
}

/// The terms of water on and in the finite elements of `mesh` that deform.
pub fn on_elements<K: Kinematics<2>>(case: &Case, mesh: &Mesh<2>, size: f64) -> Vec<Box<dyn Term<2>>> {
    let mut terms: Vec<Box<dyn Term<2>>> = Vec::new();
    let Some(water) = &case.water else { return terms };
    if water.level.is_some() {
        let rigid = regions(case, mesh, Content::is_rigid);
        let deforms = |c: usize| !rigid[mesh.cells.region[c] as usize];
        terms.push(Box::new(FacetPressure::<K>::new(mesh, deforms, water.heads(size))));
    }
    if water.phreatic.is_some() {
        terms.push(Box::new(of_water::<K>(case, water, Vec::new(), mesh, size).in_full_cells()));
    }
    terms
}

/// What of a phase's loads and of the water varies in time.
pub fn values<'a>(case: &'a Case, number: usize, phase: &'a Phase) -> impl Iterator<Item = &'a TimeValue> {
    let of_load = |load: &'a SurfaceLoad| {
        let pressure = load.pressure.iter().flat_map(|p| [&p.top, &p.gradient]);
        pressure.chain([&load.shear]).chain(&load.components)
    };
    let levels = case.water.iter().flat_map(|water| water.level.iter().chain(&water.phreatic));
    let level = levels.filter_map(move |levels| levels.get(number));
    phase.surface_loads.iter().flat_map(of_load).chain(level)
}
