//! From the case file as written to a [`Case`] that cannot be wrong; every mistake is kept, none ends the search.

use super::checked::{self, *};
use super::locate::{At, Path};
use super::raw;
use super::source::Issue;
use super::structure::suggest;
use crate::material::Profile;
use crate::time_value::TimeValue;
use std::collections::BTreeMap;
use std::path::Path as FilePath;

/// The checked case of `file`, whose paths are relative to `folder`.
///
/// # Errors
/// Every mistake that shows without the mesh.
pub fn check(file: &raw::CaseFile, folder: &FilePath) -> Result<Case, Vec<Issue>> {
    let mut checker = Checker::default();
    let case = checker.case(file, folder);
    if checker.issues.is_empty() { Ok(case) } else { Err(checker.issues) }
}

const LATER: &str = "is not available yet";

#[derive(Default)]
pub(super) struct Checker {
    issues: Vec<Issue>,
}

impl Checker {
    pub(super) fn issue(&mut self, path: &Path, at: At, problem: impl Into<String>, remedy: impl Into<String>) {
        self.issues.push(Issue { path: path.clone(), at, problem: problem.into(), remedy: remedy.into() });
    }

    fn case(&mut self, file: &raw::CaseFile, folder: &FilePath) -> Case {
        let root = Path::default();
        let gravity = [file.gravity.x, file.gravity.y];
        let materials: Vec<_> = file
            .materials
            .iter()
            .map(|(name, material)| self.material(name, material, &gravity, &root.key("materials").key(name)))
            .collect();
        let names: Vec<&str> = file.materials.keys().map(String::as_str).collect();
        let regions = file
            .regions
            .iter()
            .map(|(name, region)| self.region(name, region, &names, &root.key("regions").key(name)))
            .collect();
        if !file.contacts.is_empty() {
            self.issue(&root.key("contacts"), At::Key, format!("contact {LATER}"), "take the entry out");
        }
        let numerics = self.numerics(&file.numerics, &root.key("numerics"));
        let phases = self.phases(file, &numerics, &root.key("phases"));
        let case = Case {
            title: file.title.clone(),
            geometry: self.geometry(file.geometry, &root.key("geometry")),
            mesh: self.mesh(&file.mesh, folder, &root.key("mesh")),
            regions,
            materials,
            supports: self.supports(&file.supports, &root.key("supports")),
            gravity,
            k0: file.initial_stress.map(|stress| stress.k0),
            initial_velocity: self.initial_velocity(file, &root.key("initial_velocity")),
            numerics,
            phases,
            output: self.output(&file.output, &root.key("output")),
        };
        self.together(&case);
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

    fn mesh(&mut self, mesh: &raw::Mesh, folder: &FilePath, path: &Path) -> checked::Mesh {
        let geo = folder.join(&mesh.geo);
        if !geo.is_file() {
            let problem = format!("there is no file {}", geo.display());
            self.issue(&path.key("geo"), At::Value, problem, "name a .geo file, relative to the case file");
        }
        if mesh.incomplete && mesh.order == 1 {
            let remedy = "take `incomplete` out, or set `order: 2`";
            self.issue(&path.key("incomplete"), At::Key, "cells of order 1 have no centre node to leave out", remedy);
        }
        let order = match (mesh.order, mesh.incomplete) {
            (1, _) => Order::First,
            (_, false) => Order::Second,
            (_, true) => Order::SecondIncomplete,
        };
        checked::Mesh { geo, order, parameters: mesh.parameters.clone() }
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
                let kind = if region.kind == raw::RegionKind::Fem { "fem" } else { "structure" };
                let problem = format!("a region of kind `{kind}` {LATER}");
                self.issue(&path.key("kind"), At::Value, problem, "choose mpm or buffer");
                return Region { name: name.to_owned(), content: Content::Buffer };
            }
        };
        if region.rigid.is_some() {
            self.issue(&path.key("rigid"), At::Key, "only a structure can be rigid", "take `rigid` out");
        }
        Region { name: name.to_owned(), content }
    }

    fn material_of(&mut self, region: &raw::Region, materials: &[&str], path: &Path) -> usize {
        let Some(name) = &region.material else {
            let remedy = "add `material: …`, the name of an entry of `materials`";
            self.issue(path, At::Key, "a region of kind mpm has no `material`", remedy);
            return 0;
        };
        materials.iter().position(|material| material == name).unwrap_or_else(|| {
            let problem = format!("there is no material `{name}`");
            self.issue(&path.key("material"), At::Value, problem, suggest(name, materials.iter().copied()));
            0
        })
    }

    /// A parameter that may vary with depth; `least` is its lower bound, itself excluded if `above`.
    pub(super) fn in_depth(&mut self, value: raw::InDepth, least: f64, above: bool, path: &Path) -> Profile {
        let (profile, path) = match value {
            raw::InDepth::Constant(value) => (Profile::constant(value), path.clone()),
            raw::InDepth::Profile(p) => (Profile { top: p.top, gradient: p.gradient, datum: p.datum }, path.key("top")),
        };
        if profile.top < least || (above && profile.top == least) {
            let wanted = if above { "above" } else { "at least" };
            let problem = format!("is {}, but must be {wanted} {least}", profile.top);
            self.issue(&path, At::Value, problem, "give a value in range, in kPa, kN/m³ or t/m³");
        }
        profile
    }

    fn supports(&mut self, supports: &BTreeMap<String, raw::Components>, path: &Path) -> Vec<Support> {
        let mut checked = Vec::new();
        for (curve, held) in supports {
            let path = path.key(curve);
            for (key, value) in [("ux", held.ux), ("uy", held.uy)] {
                if value.is_some_and(|value| value != 0.0) {
                    let remedy = "write 0 here and the motion under `prescribe` of a phase";
                    self.issue(&path.key(key), At::Value, "a support does not move", remedy);
                }
            }
            if held.ux.is_none() && held.uy.is_none() {
                self.issue(&path, At::Key, "nothing is held", "add `ux: 0` or `uy: 0`");
            }
            checked.push(Support { curve: curve.clone(), fixed: [held.ux.is_some(), held.uy.is_some()] });
        }
        checked
    }

    fn initial_velocity(&mut self, file: &raw::CaseFile, path: &Path) -> Vec<InitialVelocity> {
        let regions: Vec<&str> = file.regions.keys().map(String::as_str).collect();
        let mut checked = Vec::new();
        for (name, v) in &file.initial_velocity {
            let Some(region) = regions.iter().position(|region| region == name) else {
                let problem = format!("there is no region `{name}`");
                self.issue(&path.key(name), At::Key, problem, suggest(name, regions.iter().copied()));
                continue;
            };
            if file.regions.get(name).is_some_and(|region| region.kind == raw::RegionKind::Buffer) {
                let remedy = "take the entry out, or make the region `kind: mpm`";
                self.issue(&path.key(name), At::Key, "a buffer region holds nothing that could move", remedy);
            }
            checked.push(InitialVelocity {
                region,
                velocity: [v.velocity.x, v.velocity.y],
                gradient: v.gradient,
                centre: [v.centre.x, v.centre.y],
                standing_wave: v.standing_wave.as_ref().map(|wave| StandingWave {
                    component: wave.component as usize,
                    along: wave.along as usize,
                    amplitude: wave.amplitude,
                    wave_number: wave.wave_number,
                }),
            });
        }
        checked
    }

    fn numerics(&mut self, numerics: &raw::Numerics, path: &Path) -> Numerics {
        if numerics.gradient != raw::Gradient::Mpm {
            let problem = format!("this gradient {LATER}");
            self.issue(&path.key("gradient"), At::Value, problem, "choose mpm");
        }
        if numerics.quadrature != raw::Quadrature::Points {
            let problem = format!("`fitted` {LATER}");
            self.issue(&path.key("quadrature"), At::Value, problem, "choose points");
        }
        let restore = match numerics.restore {
            raw::Restore::Named(raw::RestoreName::EveryStep) => Restore::EveryStep,
            raw::Restore::Named(raw::RestoreName::Never) => Restore::Never,
            raw::Restore::Quality(_) => {
                let problem = format!("`min_quality` {LATER}");
                self.issue(&path.key("restore"), At::Value, problem, "choose every_step or never");
                Restore::Never
            }
        };
        Numerics {
            restore,
            spectral_radius: numerics.spectral_radius,
            tolerance: numerics.tolerance,
            max_iterations: numerics.max_iterations,
            empty_stiffness: numerics.empty_stiffness,
        }
    }

    fn phases(&mut self, file: &raw::CaseFile, numerics: &Numerics, path: &Path) -> Vec<Phase> {
        let mut checked = Vec::new();
        for (i, phase) in file.phases.iter().enumerate() {
            let path = path.index(i);
            if file.phases[..i].iter().any(|earlier| earlier.name == phase.name) {
                let problem = format!("two phases are called `{}`", phase.name);
                self.issue(&path.key("name"), At::Value, problem, "give each phase a name of its own");
            }
            checked.push(self.phase(phase, file, numerics, &path));
        }
        checked
    }

    fn phase(&mut self, phase: &raw::Phase, file: &raw::CaseFile, numerics: &Numerics, path: &Path) -> Phase {
        let analysis = match phase.analysis {
            raw::Analysis::QuasiStatic => Analysis::QuasiStatic,
            raw::Analysis::Dynamic => Analysis::Dynamic,
            raw::Analysis::Consolidation => {
                let problem = format!("`consolidation` {LATER}");
                self.issue(&path.key("analysis"), At::Value, problem, "choose quasi_static or dynamic");
                Analysis::QuasiStatic
            }
        };
        let mut prescribed = Vec::new();
        for (curve, motion) in &phase.prescribe {
            let path = path.key("prescribe").key(curve);
            if motion.ux.is_none() && motion.uy.is_none() {
                self.issue(&path, At::Key, "nothing is prescribed", "add `ux: …` or `uy: …`");
            }
            for (component, key, value) in [(0, "ux", &motion.ux), (1, "uy", &motion.uy)] {
                let Some(value) = value else { continue };
                let displacement = self.in_time(value, &path.key(key));
                let held = file.supports.get(curve).is_some_and(|held| [held.ux, held.uy][component].is_some());
                if held && displacement != TimeValue::Constant(0.0) {
                    let problem = format!("`{curve}` is held in this direction under `supports`");
                    self.issue(&path.key(key), At::Key, problem, format!("take `{key}` out there or here"));
                }
                prescribed.push(Prescribed { curve: curve.clone(), component, displacement });
            }
        }
        let tractions = phase
            .tractions
            .iter()
            .enumerate()
            .map(|(i, traction)| self.traction(traction, numerics, &path.key("tractions").index(i)))
            .collect();
        let gravity = match &phase.gravity {
            Some(factor) => self.in_time(factor, &path.key("gravity")),
            None => TimeValue::Constant(1.0),
        };
        Phase {
            name: phase.name.clone(),
            analysis,
            duration: phase.duration,
            step: self.step(&phase.step, phase.duration, &path.key("step")),
            prescribed,
            tractions,
            gravity,
        }
    }

    fn traction(&mut self, traction: &raw::Traction, numerics: &Numerics, path: &Path) -> Traction {
        if numerics.restore != Restore::Never {
            let problem = "a traction on a curve needs a grid that moves with the material";
            self.issue(&path.key("on"), At::Value, problem, "set `restore: never` under `numerics`");
        }
        if traction.tx.is_none() && traction.ty.is_none() {
            self.issue(path, At::Value, "there is no load", "add `tx: …` or `ty: …`");
        }
        let mut component = |key, value: &Option<raw::InTime>| match value {
            Some(value) => self.in_time(value, &path.key(key)),
            None => TimeValue::Constant(0.0),
        };
        Traction {
            curve: traction.on.clone(),
            components: [component("tx", &traction.tx), component("ty", &traction.ty)],
        }
    }

    fn step(&mut self, step: &raw::Step, duration: f64, path: &Path) -> StepSize {
        let min = step.min.unwrap_or(1e-4 * step.initial);
        let max = step.max.unwrap_or(step.initial);
        if step.initial > duration {
            let problem = format!("the first step {} is longer than the phase ({duration})", step.initial);
            self.issue(&path.key("initial"), At::Value, problem, "shorten `initial` or lengthen `duration`");
        }
        if min > step.initial {
            let problem = format!("`min` ({min}) is above `initial` ({})", step.initial);
            self.issue(&path.key("min"), At::Value, problem, "lower `min`");
        }
        if max < step.initial {
            let problem = format!("`max` ({max}) is below `initial` ({})", step.initial);
            self.issue(&path.key("max"), At::Value, problem, "raise `max`");
        }
        StepSize { initial: step.initial, min, max }
    }

    fn in_time(&mut self, value: &raw::InTime, path: &Path) -> TimeValue {
        match value {
            raw::InTime::Constant(value) => TimeValue::Constant(*value),
            raw::InTime::Rate(rate) => TimeValue::Rate(rate.rate),
            raw::InTime::Table(raw::Table { table }) => {
                if let Some(i) = table.windows(2).position(|pair| pair[1][0] <= pair[0][0]) {
                    let problem = format!("the time {} does not come after {}", table[i + 1][0], table[i][0]);
                    let path = path.key("table").index(i + 1);
                    self.issue(&path, At::Value, problem, "sort the table by time, each time once");
                }
                TimeValue::Table(table.clone())
            }
        }
    }

    fn output(&mut self, output: &raw::Output, path: &Path) -> Output {
        let fields = output.fields.clone().unwrap_or(vec![Field::Stress, Field::Displacement]);
        for (i, field) in fields.iter().enumerate() {
            let path = path.key("fields").index(i);
            if *field == Field::PorePressure {
                self.issue(&path, At::Value, format!("`pore_pressure` {LATER}"), "take it out");
            }
            if fields[..i].contains(field) {
                self.issue(&path, At::Value, "the field is named twice", "take it out");
            }
        }
        for (i, entry) in output.history.iter().enumerate() {
            let path = path.key("history").index(i);
            if output.history[..i].iter().any(|earlier| earlier.name == entry.name) {
                let problem = format!("two entries are called `{}`", entry.name);
                self.issue(&path.key("name"), At::Value, problem, "give each entry a name of its own");
            }
            if entry.name.contains([',', '"', '\n']) {
                let problem = "the name has a comma, a quote or a line break in it";
                self.issue(&path.key("name"), At::Value, problem, "it heads a CSV column: choose a plain name");
            }
        }
        let history = output.history.iter().map(|entry| History {
            name: entry.name.clone(),
            on: entry.on.clone(),
            quantities: entry.quantities.clone(),
        });
        Output { every: output.every, fields, encoding: output.encoding, history: history.collect() }
    }

    /// What only shows between blocks.
    fn together(&mut self, case: &Case) {
        let root = Path::default();
        let dynamic = case.phases.iter().any(|phase| phase.analysis == Analysis::Dynamic);
        let filled = |content: Content| match content {
            Content::Mpm { material, .. } => Some(material),
            Content::Buffer => None,
        };
        if case.regions.iter().all(|region| filled(region.content).is_none()) && self.issues.is_empty() {
            let remedy = "make at least one region `kind: mpm` with a material";
            self.issue(&root.key("regions"), At::Key, "no region holds material", remedy);
        }
        if case.k0.is_some() && case.gravity[0] != 0.0 {
            let remedy = "take `x` out, or load gravity in a first quasi_static phase in place of `initial_stress`";
            self.issue(&root.key("gravity").key("x"), At::Value, "k0 needs vertical gravity", remedy);
        }
        if !dynamic {
            if let Some(velocity) = case.initial_velocity.first() {
                let path = root.key("initial_velocity").key(&case.regions[velocity.region].name);
                let remedy = "make a phase dynamic, or take `initial_velocity` out";
                self.issue(&path, At::Key, "no phase is dynamic, so nothing ever moves by itself", remedy);
            }
        }
        for (i, material) in case.materials.iter().enumerate() {
            let used = case.regions.iter().any(|region| filled(region.content) == Some(i));
            if dynamic && used && material.density.top <= 0.0 && !self.is_about(&material.name) {
                let path = root.key("materials").key(&material.name);
                let remedy = "give it a `density` above 0, or make the phases quasi_static";
                self.issue(&path, At::Key, "a dynamic phase needs material with mass", remedy);
            }
        }
    }

    /// Whether a mistake in a material was found already.
    fn is_about(&self, material: &str) -> bool {
        let path = Path::default().key("materials").key(material);
        self.issues.iter().any(|issue| path.contains(&issue.path))
    }
}
