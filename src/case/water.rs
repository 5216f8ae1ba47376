//! Water around soil and structures and in the pores of soil: its levels in each phase, and the terms of its pressure.

use super::changes;
use super::check::Checker;
use super::checked::{Case, Content, LoadProfile, Phase, Quantity, SurfaceLoad, Water};
use super::find::{mean_size, region_index, regions};
use super::locate::{At, Path};
use super::raw;
use crate::error::Result;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::run::Acting;
use crate::term::{self, FacetPressure, Hydrostatic, Phreatic, SurfaceTraction, Term, VirtualPressure, WaterLevels};
use crate::time_value::TimeValue;
use crate::water_table::{WaterLine, WaterTable};

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
        let of_phases =
            |of: fn(&raw::Phase) -> &Option<raw::WaterTable>| file.phases.iter().map(of).collect::<Vec<_>>();
        let outside = whole.and_then(|water| water.level.as_ref());
        let level = self.tables(["level", "water_level"], outside, of_phases(|phase| &phase.water_level), root);
        let inside = whole.and_then(|water| water.phreatic_level.as_ref());
        let of_pores = of_phases(|phase| &phase.phreatic_level);
        let phreatic = self.tables(["phreatic_level"; 2], inside, of_pores, root);
        // What is inclined has been refused.
        let level = level.map(|tables| tables.iter().filter_map(WaterTable::level).cloned().collect());
        Some(Water { unit_weight: whole?.unit_weight, level, phreatic })
    }

    /// A water table in each phase, given that of the whole case and those of the phases, by the keys of both.
    fn tables(
        &mut self,
        [key, of_phase]: [&str; 2],
        whole: Option<&raw::WaterTable>,
        own: Vec<&Option<raw::WaterTable>>,
        root: &Path,
    ) -> Option<Vec<WaterTable>> {
        let path = |i: usize| root.key("phases").index(i).key(of_phase);
        let Some(whole) = whole else {
            for (i, _) in own.iter().enumerate().filter(|(_, level)| level.is_some()) {
                let problem = format!("there is no water with a `{key}` in this case");
                self.issue(&path(i), At::Key, problem, format!("add `water: {{{key}: …}}`, or take it out"));
            }
            return None;
        };
        let whole = self.table(whole, key, &root.key("water").key(key));
        let tables = own.into_iter().enumerate().map(|(i, table)| match table {
            Some(table) => self.table(table, key, &path(i)),
            None => whole.clone(),
        });
        Some(tables.collect())
    }

    fn table(&mut self, table: &raw::WaterTable, key: &str, path: &Path) -> WaterTable {
        let line = match table {
            raw::WaterTable::Level(level) => return WaterTable::Level(self.in_time(level, path)),
            raw::WaterTable::Line(raw::WaterLine { line }) => line,
        };
        if key == "level" {
            let remedy = "give one height here; only the `phreatic_level`, that in the pores, may be a line";
            self.issue(path, At::Value, "the surface of water outside of the soil is level", remedy);
            return WaterTable::Level(TimeValue::Constant(0.0));
        }
        if let Some(i) = line.windows(2).position(|pair| pair[1][0] <= pair[0][0]) {
            let problem = format!("x = {} m does not come after {} m", line[i + 1][0], line[i][0]);
            let remedy = "sort the places by x, each x once";
            self.issue(&path.key("line").index(i + 1), At::Value, problem, remedy);
        }
        WaterTable::Line(WaterLine(line.as_slice().into()))
    }
}

impl Water {
    /// The pressure of the water outside in each phase, over cells of the size `size` (m).
    pub fn heads(&self, size: f64) -> Vec<Option<Hydrostatic>> {
        self.level.iter().flatten().map(|level| Some(self.below(level.clone(), size))).collect()
    }

    /// That of the water in the pores.
    pub fn heads_in_pores(&self, size: f64) -> Vec<Option<Phreatic>> {
        let head = |table: &WaterTable| match table {
            WaterTable::Level(level) => Phreatic::from(self.below(level.clone(), size)),
            WaterTable::Line(line) => Phreatic::under(line.clone(), self.below(TimeValue::Constant(0.0), size)),
        };
        self.phreatic.iter().flatten().map(|table| Some(head(table))).collect()
    }

    /// Both, where they differ in some phase: friction has no share in what the one has more than the other.
    pub fn levels(&self, size: f64) -> Option<WaterLevels> {
        let in_pores = self.phreatic.as_ref()?;
        let same = |outside: &Vec<TimeValue>| in_pores.iter().map(WaterTable::level).eq(outside.iter().map(Some));
        let differ = !self.level.as_ref().is_some_and(same);
        differ.then(|| WaterLevels::new(self.heads(size), self.heads_in_pores(size)))
    }

    fn below(&self, datum: TimeValue, size: f64) -> Hydrostatic {
        Hydrostatic {
            top: TimeValue::Constant(0.0),
            gradient: TimeValue::Constant(self.unit_weight),
            datum,
            band: BAND * size,
        }
    }

    /// The pressure (kPa) outside at height `y` (m) as the run begins.
    pub fn at_first(&self, y: f64) -> f64 {
        let level = self.level.as_ref().and_then(|levels| levels.first());
        level.map_or(0.0, |level| self.pressure(level.at(0.0), y))
    }

    /// That in the pores at a place (m); `None` where they have no water.
    pub fn in_pores_at_first(&self, [x, y]: [f64; 2]) -> Option<f64> {
        Some(self.pressure(self.phreatic.as_ref()?.first()?.at_first(x), y))
    }

    fn pressure(&self, level: f64, y: f64) -> f64 {
        self.unit_weight * (level - y).max(0.0)
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
    let measured = case.output.history.iter().any(|entry| entry.quantities.contains(&Quantity::Thickness));
    let needed = case.output.surface || water || measured || case.drained_surface.is_some();
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
    let outside = case.water.iter().filter_map(move |water| water.level.as_ref()?.get(number));
    let in_pores = case.water.iter().filter_map(move |water| water.phreatic.as_ref()?.get(number)?.level());
    phase.surface_loads.iter().flat_map(of_load).chain(outside).chain(in_pores)
}
