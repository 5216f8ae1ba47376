//! From the case file as written to a [`Case`] that cannot be wrong; every mistake is kept, none ends the search.

use super::checked::*;
use super::issue::{Issue, MOST_FOUND};
use super::locate::{At, Path};
use super::raw;
use super::structure::{list, suggest};
use super::unlikely;
use crate::interpolation::{Basis, Mpm, SCHEMES};
use crate::material::MODELS;
use crate::step;
use std::path::Path as FilePath;

/// The case of `file`, whose paths are relative to `folder`, and every mistake that shows without the mesh; the case is a sound one only if there is none.
pub(super) fn check(file: &raw::CaseFile, folder: &FilePath) -> (Case, Vec<Issue>) {
    let mut checker = Checker::default();
    let case = checker.case(file, folder);
    (case, checker.issues)
}

/// How many times an edge may become as long or short until the grid is restored, if the case does not say. A body
/// far compressed wants fresh cells early, one that bends or slumps late.
const STRETCH: f64 = 1.3;
/// The same where there is contact: its nodes meet other cells after each restoration, and their forces jump a little.
const STRETCH_WITH_CONTACTS: f64 = 1.5;

/// Frames are numbered by six digits.
const MOST_FRAMES: f64 = 999_999.0;

pub(super) const LATER: &str = "is not available yet";

/// Keeps the mistakes of a case.
#[derive(Default)]
pub(super) struct Checker {
    issues: Vec<Issue>,
}

impl Checker {
    /// Keeps a mistake in the entry at `path`.
    pub fn issue(&mut self, path: &Path, at: At, problem: impl Into<String>, remedy: impl Into<String>) {
        if self.issues.len() < MOST_FOUND {
            self.issues.push(Issue::new(path, at, problem, remedy));
        }
    }

    /// The number of mistakes found so far.
    pub(super) fn count(&self) -> usize {
        self.issues.len()
    }

    fn case(&mut self, file: &raw::CaseFile, folder: &FilePath) -> Case {
        let root = Path::default();
        let gravity = [file.gravity.x, file.gravity.y];
        let mut materials: Vec<_> = file
            .materials
            .iter()
            .filter_map(|(name, material)| {
                self.material(name, material, &gravity, file.numerics.pressure, &root.key("materials").key(name))
            })
            .collect();
        let names: Vec<&str> = file.materials.keys().map(String::as_str).collect();
        let regions = file
            .regions
            .iter()
            .map(|(name, region)| self.region(name, region, &names, &root.key("regions").key(name)))
            .collect();
        let k0 = self.earth_pressures(file, &materials, &root.key("initial_stress").key("k0"));
        let (regions, plates) = self.plates(file, regions, &mut materials, &root.key("regions"));
        let contacts = self.contacts(file, &root.key("contacts"));
        let rollers = self.rollers(file, &root.key("supports"));
        let has_contact = !contacts.is_empty() || !rollers.is_empty();
        let numerics = self.numerics(file, has_contact, &root.key("numerics"));
        let mut phases = self.phases(file, &numerics, &root.key("phases"));
        self.outflows(file, (&numerics, &phases), &root.key("supports"));
        let mut water = self.water(file, &root);
        let equilibrium = self.equilibrium(file, &mut phases, water.as_mut(), &root);
        let mut case = Case {
            title: file.title.clone(),
            geometry: self.geometry(file.geometry, &root.key("geometry")),
            mesh: self.mesh(&file.mesh, folder, &root.key("mesh")),
            regions,
            plates,
            materials,
            contacts,
            bars: self.bars(file, &root.key("bars")),
            supports: self.supports(file, &root.key("supports")),
            gravity,
            k0,
            water,
            initial_pore_pressure: self.initial_pore_pressure(file, &root.key("initial_pore_pressure")),
            initial_velocity: self.initial_velocity(file, &root.key("initial_velocity")),
            numerics,
            phases,
            equilibrium,
            output: self.output(&file.output, &root.key("output")),
            drained_surface: self.drained_surface(file, &root.key("drained_surface")),
            unlikely: unlikely::values(file),
        };
        self.together(&case, file);
        case.contacts.extend(rollers);
        case
    }

    fn geometry(&mut self, geometry: raw::Geometry, path: &Path) -> Geometry {
        match geometry {
            raw::Geometry::PlaneStrain => Geometry::PlaneStrain,
            raw::Geometry::Axisymmetric => Geometry::Axisymmetric,
            raw::Geometry::Solid => {
                self.issue(path, At::Value, format!("`solid` {LATER}"), "choose plane_strain or axisymmetric");
                Geometry::PlaneStrain
            }
        }
    }

    fn region(&mut self, name: &str, region: &raw::Region, materials: &[&str], path: &Path) -> Region {
        let content = match region.kind {
            raw::RegionKind::Mpm => {
                let material = self.material_of(region, materials, path);
                Content::Mpm { material, points_per_cell: region.points_per_cell.unwrap_or(16) }
            }
            raw::RegionKind::Buffer => {
                if region.material.is_some() {
                    let remedy = "take `material` out, or make the region `kind: mpm`";
                    self.issue(&path.key("material"), At::Key, "a buffer region is empty", remedy);
                }
                if region.points_per_cell.is_some() {
                    let remedy = "take `points_per_cell` out, or make the region `kind: mpm`";
                    self.issue(&path.key("points_per_cell"), At::Key, "a buffer region is empty", remedy);
                }
                Content::Buffer
            }
            raw::RegionKind::Fem | raw::RegionKind::Structure => {
                if region.points_per_cell.is_some() {
                    let problem = "finite elements have the points of their quadrature rule";
                    self.issue(&path.key("points_per_cell"), At::Key, problem, "take `points_per_cell` out");
                }
                let material = self.material_of(region, materials, path);
                if region.kind == raw::RegionKind::Fem {
                    Content::Fem { material }
                } else {
                    Content::Structure { material, rigid: region.rigid == Some(true) }
                }
            }
        };
        if region.rigid.is_some() && region.kind != raw::RegionKind::Structure {
            self.issue(&path.key("rigid"), At::Key, "only a structure can be rigid", "take `rigid` out");
        }
        Region { name: name.to_owned(), content }
    }

    fn material_of(&mut self, region: &raw::Region, materials: &[&str], path: &Path) -> usize {
        if region.plate.is_some() {
            return 0;
        }
        let Some(name) = &region.material else {
            let remedy = "add `material: …`, the name of an entry of `materials`";
            self.issue(path, At::Key, "a region that is not a buffer has no `material`", remedy);
            return 0;
        };
        // They are sorted.
        materials.binary_search(&name.as_str()).unwrap_or_else(|_| {
            let problem = format!("there is no material `{name}`");
            self.issue(&path.key("material"), At::Value, problem, suggest(name, materials.iter().copied()));
            0
        })
    }

    /// Refuses a rotation of anything but a rigid structure.
    pub(super) fn turns(&mut self, file: &raw::CaseFile, name: &str, path: &Path) {
        let wall = file.contacts.iter().any(|contact| contact.wall.as_deref() == Some(name));
        if !wall && file.regions.get(name).is_none_or(|region| region.rigid != Some(true)) {
            let remedy = "take it out, or name a wall, or a region of kind structure with `rigid: true`";
            self.issue(path, At::Key, "only a rigid structure as a whole can be turned", remedy);
        }
    }

    fn supports(&mut self, file: &raw::CaseFile, path: &Path) -> Vec<Support> {
        let mut checked = Vec::new();
        for (curve, held) in &file.supports {
            let path = path.key(curve);
            for (key, value) in [("ux", held.ux), ("uy", held.uy), ("un", held.un), ("rotation", held.rotation)] {
                if value.is_some_and(|value| value != 0.0) {
                    let remedy = "write 0 here and the motion under `prescribe` of a phase";
                    self.issue(&path.key(key), At::Value, "a support does not move", remedy);
                }
            }
            if held.rotation.is_some() {
                self.turns(file, curve, &path.key("rotation"));
            }
            self.drained(file, curve, held, &path);
            let displacements = [held.ux, held.uy, held.un, held.rotation];
            self.on_springs(file, curve, held, &path);
            self.tied(file, curve, held, &path);
            let [springs, dashpots] = [("springs", held.springs), ("dashpots", held.dashpots)]
                .map(|(key, given)| self.yielding(given, &path.key(key)));
            let yields = held.outflow
                || held.absorbing
                || held.springs.is_some()
                || held.dashpots.is_some()
                || held.tied.is_some();
            if displacements.iter().chain([&held.pore_pressure]).all(Option::is_none) && !yields {
                self.issue(&path, At::Key, "nothing is held", "add `ux: 0`, `uy: 0` or `un: 0`");
            }
            checked.push(Support {
                curve: curve.clone(),
                fixed: [held.ux.is_some(), held.uy.is_some()],
                rotation: held.rotation.is_some(),
                across: held.un.is_some(),
                drained: held.pore_pressure.is_some(),
                absorbing: held.absorbing,
                springs,
                dashpots,
                tied: held.tied.clone(),
                outflow: held.outflow,
            });
        }
        checked
    }

    /// The index of the region that the key at `path` names.
    pub(super) fn region_named(&mut self, file: &raw::CaseFile, name: &str, path: &Path) -> Option<usize> {
        let found = file.regions.keys().position(|region| region == name);
        if found.is_none() {
            let remedy = suggest(name, file.regions.keys().map(String::as_str));
            self.issue(path, At::Key, format!("there is no region `{name}`"), remedy);
        }
        found
    }

    fn initial_velocity(&mut self, file: &raw::CaseFile, path: &Path) -> Vec<InitialVelocity> {
        let mut checked = Vec::new();
        for (name, v) in &file.initial_velocity {
            let Some(region) = self.region_named(file, name, &path.key(name)) else { continue };
            if file.regions.get(name).is_some_and(|region| region.kind == raw::RegionKind::Buffer) {
                let remedy = "take the entry out, or make the region `kind: mpm`";
                self.issue(&path.key(name), At::Key, "a buffer region holds nothing that could move", remedy);
            }
            checked.push(InitialVelocity {
                region,
                velocity: [v.velocity.x, v.velocity.y],
                gradient: v.gradient,
                centre: [v.centre.x, v.centre.y],
                standing_wave: v.standing_wave,
            });
        }
        checked
    }

    fn numerics(&mut self, file: &raw::CaseFile, contacts: bool, path: &Path) -> Numerics {
        let numerics = &file.numerics;
        let named = |scheme: &&&dyn Basis<2>| {
            scheme.name() == numerics.gradient || scheme.alias() == Some(numerics.gradient.as_str())
        };
        let found = SCHEMES.iter().find(named);
        if found.is_none() {
            let problem = format!("there is no gradient `{}`", numerics.gradient);
            let names: Vec<&str> = SCHEMES.iter().map(|scheme| scheme.name()).collect();
            self.issue(&path.key("gradient"), At::Value, problem, format!("choose {}", names.join(" or ")));
        }
        let basis: &'static dyn Basis<2> = found.copied().unwrap_or(&Mpm);
        let of_scheme = if basis.is_of_places() { raw::Quadrature::Resampled } else { raw::Quadrature::Points };
        let quadrature = numerics.quadrature.unwrap_or(of_scheme);
        if let (Some(reason), raw::Quadrature::Resampled) = (basis.of_points(), quadrature) {
            let problem = format!("{} {reason}, and resampled quadrature does not sum over these", basis.name());
            self.issue(&path.key("quadrature"), At::Value, problem, "choose `quadrature: points`, or `gradient: mpm`");
        }
        let restore = match numerics.restore {
            raw::Restore::Named(raw::RestoreName::EveryStep) => Restore::EveryStep,
            raw::Restore::Named(raw::RestoreName::Never) => Restore::Never,
            raw::Restore::Quality(quality) => Restore::Quality {
                least: quality.min_quality,
                stretch: quality.max_stretch.unwrap_or(if contacts { STRETCH_WITH_CONTACTS } else { STRETCH }),
            },
        };
        let solver = step::Numerics {
            restore,
            spectral_radius: numerics.spectral_radius,
            tolerance: numerics.tolerance,
            acceptable_tolerance: numerics.acceptable_tolerance,
            max_iterations: numerics.max_iterations,
        };
        Numerics { basis, quadrature, empty_stiffness: numerics.empty_stiffness, solver }
    }

    fn output(&mut self, output: &raw::Output, path: &Path) -> Output {
        let fields = output.fields.clone().unwrap_or(vec![Field::Stress, Field::Displacement]);
        for (i, field) in fields.iter().enumerate() {
            let path = path.key("fields").index(i);
            if fields[..i].contains(field) {
                self.issue(&path, At::Value, "the field is named twice", "take it out");
            }
        }
        let history = self.histories(&output.history, &path.key("history"));
        Output { every: output.every, fields, encoding: output.encoding, surface: output.surface, history }
    }

    /// What only shows between blocks.
    fn together(&mut self, case: &Case, file: &raw::CaseFile) {
        let root = Path::default();
        // What is not positive has been told already.
        let every = case.output.every.filter(|&every| every > 0.0);
        let frames: f64 = case.phases.iter().map(|p| every.map_or(1.0, |e| (p.duration / e).ceil())).sum();
        if frames > MOST_FRAMES {
            let problem = format!("the phases would give {frames:e} frames, more than {MOST_FRAMES}");
            self.issue(&root.key("output").key("every"), At::Value, problem, "write them less often");
        }
        self.contacts_twice(case, file);
        self.passed(file);
        self.pores(case, file);
        self.scheme(case);
        let undrained = case.materials.iter().any(Material::has_pore_pressure);
        let wanted = case.output.fields.iter().position(|f| *f == Field::PorePressure);
        if let Some(i) = wanted.filter(|_| !undrained) {
            let path = root.key("output").key("fields").index(i);
            self.issue(&path, At::Value, "no material is undrained", "take it out, or set `drainage: undrained`");
        }
        let variables = case.materials.iter().any(|m| !m.model.internal_variables().is_empty());
        let wanted = case.output.fields.iter().position(|f| *f == Field::InternalVariables);
        if let Some(i) = wanted.filter(|_| !variables) {
            let path = root.key("output").key("fields").index(i);
            self.issue(&path, At::Value, "no material has internal variables", "take it out");
        }
        let unused =
            file.numerics.pressure == Some(raw::Pressure::Field) && case.materials.iter().all(|m| m.carried.is_none());
        if unused && self.issues.is_empty() {
            let models: Vec<&str> = MODELS.iter().filter(|kind| kind.keeps_volume).map(|kind| kind.name).collect();
            let models = list(&models);
            let problem = format!(
                "no material has a share for it: the field is for undrained materials, for {models}, and for others from Poisson's ratio 0.495 on"
            );
            self.issue(&root.key("numerics").key("pressure"), At::Value, problem, "take it out");
        }
        if file.regions.values().all(|region| region.kind == raw::RegionKind::Buffer) {
            let remedy = "make at least one region `kind: mpm` or `kind: fem` with a material";
            self.issue(&root.key("regions"), At::Key, "no region holds material", remedy);
        }
        if case.k0.is_some() && case.gravity[0] != 0.0 {
            let remedy = "take `x` out, or load gravity in a first quasi_static phase in place of `initial_stress`";
            self.issue(&root.key("gravity").key("x"), At::Value, "k0 needs vertical gravity", remedy);
        }
        if case.k0.is_some() && case.gravity[1] > 0.0 {
            let remedy = "write gravity as a negative `y`, which is up, or take `initial_stress` out";
            self.issue(&root.key("gravity").key("y"), At::Value, "k0 needs gravity that points down", remedy);
        }
        self.weight(case, file);
        let dynamic = case.phases.iter().any(|phase| phase.analysis.has_inertia());
        if !dynamic {
            for name in file.initial_velocity.keys() {
                let remedy = "make a phase dynamic, or take `initial_velocity` out";
                let path = root.key("initial_velocity").key(name);
                self.issue(&path, At::Key, "no phase is dynamic, so nothing moves by itself", remedy);
            }
            return;
        }
        for material in case.materials.iter().filter(|material| material.density.top == 0.0) {
            let begun = file.regions.values().filter_map(|region| region.material.as_ref());
            if begun
                .chain(file.phases.iter().flat_map(|p| p.assigned().map(|(_, m)| m)))
                .any(|name| *name == material.name)
            {
                let path = root.key("materials").key(&material.name);
                let remedy = "give it a `density` above 0, or make the phases quasi_static";
                self.issue(&path, At::Key, "a dynamic phase needs material with mass", remedy);
            }
        }
    }
}
