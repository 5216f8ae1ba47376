//! The phases of a case: time steps, prescribed displacements and loads.

use super::check::Checker;
use super::checked::{Numerics, Phase, Prescribed, StepSize, Until};
use super::locate::{At, Path};
use super::raw::{self, Analysis};
use super::records::RECORDS;
use super::structure::suggest;
use crate::gravity::Gravity;
use crate::material::MODELS;
use crate::time_value::TimeValue;
use std::collections::HashSet;

impl Checker {
    pub(super) fn phases(&mut self, file: &raw::CaseFile, numerics: &Numerics, path: &Path) -> Vec<Phase> {
        let mut checked: Vec<Phase> = Vec::new();
        let begun = file.regions.iter().filter_map(|(name, region)| Some((name.clone(), region.material.clone()?)));
        let mut materials = begun.collect();
        let named = |contact: &raw::Contact| Some((contact.name.clone()?, contact.law()));
        let mut laws = file.contacts.iter().filter_map(named).collect();
        let mut names = HashSet::new();
        for (i, phase) in file.phases.iter().enumerate() {
            let path = path.index(i);
            if !names.insert(&phase.name) {
                let problem = format!("two phases are called `{}`", phase.name);
                self.issue(&path.key("name"), At::Value, problem, "give each phase a name of its own");
            }
            let absent = self.absent(phase, checked.last(), file, &path);
            let mut changes = self.changes(phase, i == 0, file, &mut materials, &path);
            let contacts = self.contact_changes(phase, file, &mut laws, &path);
            let removed = self.removed(i, (file, numerics), &path);
            let (placed, taken) = self.placed(i, (file, numerics), &mut materials, &path);
            changes.extend(taken);
            let inflows = self.inflows(phase, (file, numerics), &path.key("inflow"));
            let rest = self.phase(phase, file, numerics, &path);
            checked.push(Phase { absent, removed, placed, inflows, changes, contacts, ..rest });
        }
        checked
    }

    fn phase(&mut self, phase: &raw::Phase, file: &raw::CaseFile, numerics: &Numerics, path: &Path) -> Phase {
        if phase.analysis == Analysis::Consolidation
            && file.materials.values().all(|material| material.permeability.is_none())
        {
            let remedy = "give an undrained material a `permeability`, or choose quasi_static";
            self.issue(&path.key("analysis"), At::Value, "no material has a permeability", remedy);
        }
        let mut prescribed = Vec::new();
        for (curve, motion) in &phase.prescribe {
            let path = path.key("prescribe").key(curve);
            if file.supports.get(curve).is_some_and(|held| held.un.is_some()) {
                let remedy = "take one of the two out; a curve that moves is a `wall` of `contacts`";
                self.issue(&path, At::Key, format!("`{curve}` has `un: 0` under `supports`"), remedy);
            }
            if motion.rotation.is_some() {
                self.turns(file, curve, &path.key("rotation"));
            }
            let accelerated = self.records(phase, file, motion, &path);
            let entries = [("ux", &motion.ux), ("uy", &motion.uy), ("rotation", &motion.rotation)];
            if entries.iter().all(|(_, value)| value.is_none()) && accelerated.iter().all(Option::is_none) {
                self.issue(&path, At::Key, "nothing is prescribed", "add `ux: …` or `uy: …`");
            }
            for (component, (key, value)) in entries.into_iter().enumerate() {
                let (key, displacement) = match (value, accelerated.get(component)) {
                    (_, Some(Some(record))) => (RECORDS[component], record.clone()),
                    (Some(value), _) => (key, self.in_time(value, &path.key(key))),
                    (None, _) => continue,
                };
                let held =
                    file.supports.get(curve).is_some_and(|held| [held.ux, held.uy, held.rotation][component].is_some());
                if held && displacement != TimeValue::Constant(0.0) {
                    let problem = format!("`{curve}` is held in this direction under `supports`");
                    self.issue(&path.key(key), At::Key, problem, format!("take `{key}` out there or here"));
                }
                prescribed.push(Prescribed { curve: curve.clone(), component, displacement });
            }
        }
        let (tractions, surface_loads) = self.loads(phase, file, numerics, &path.key("tractions"));
        let gravity = self.gravity(phase, [file.gravity.x, file.gravity.y], &path.key("gravity"));
        Phase {
            name: phase.name.clone(),
            analysis: phase.analysis,
            duration: phase.duration,
            step: self.step(&phase.step, phase.duration, &path.key("step")),
            prescribed,
            tractions,
            surface_loads,
            gravity,
            reduction: self.reduction(phase, file, path),
            absent: Vec::new(),
            removed: Vec::new(),
            placed: Vec::new(),
            inflows: Vec::new(),
            changes: Vec::new(),
            contacts: Vec::new(),
            reset_displacements: phase.reset_displacements,
            until: self.until(phase, file, &path.key("until")),
        }
    }

    /// Gravity in a phase, given that of the case (m/s²).
    fn gravity(&mut self, phase: &raw::Phase, whole: [f64; 2], path: &Path) -> Gravity<2> {
        let components = match &phase.gravity {
            None => return Gravity::Scaled { whole, factor: TimeValue::Constant(1.0) },
            Some(raw::PhaseGravity::Factor(factor)) => {
                return Gravity::Scaled { whole, factor: self.in_time(factor, path) };
            }
            Some(raw::PhaseGravity::Components(components)) => components,
        };
        if components.x.is_none() && components.y.is_none() {
            let remedy = "add `x: …` or `y: …`, accelerations in m/s², or write a factor on gravity, a number";
            self.issue(path, At::Value, "gravity has no component", remedy);
        }
        if whole == [0.0; 2] {
            let remedy = "add `gravity: {y: -9.81}` to the case, or take it out here";
            self.issue(path, At::Key, "the case has no gravity that a phase could change", remedy);
        }
        let given = [("x", &components.x), ("y", &components.y)];
        let mut in_time = |d: usize| match given[d] {
            (key, Some(value)) => self.in_time(value, &path.key(key)),
            (_, None) => TimeValue::Constant(whole[d]),
        };
        let gravity = Gravity::Components([in_time(0), in_time(1)]);
        let up = gravity.extremes(phase.duration).map(|g| g[1]).find(|y| y * whole[1] < 0.0);
        if let Some(up) = up {
            let problem = format!(
                "`y` is an acceleration in m/s², positive upwards, and comes to {up}, against the {} of the case",
                whole[1]
            );
            let remedy = format!("write `y: {}`, or a factor on all of gravity, `gravity: 1`", whole[1]);
            self.issue(&path.key("y"), At::Value, problem, remedy);
        }
        gravity
    }

    /// What strengths are divided by in a phase. A search goes from 1 upwards by 1 a second where nothing is said.
    fn reduction(&mut self, phase: &raw::Phase, file: &raw::CaseFile, path: &Path) -> Option<TimeValue> {
        let searches = phase.analysis == Analysis::StrengthReduction;
        let at = path.key("strength_reduction");
        // A model that is not known has been reported.
        let bears_all = |name: &str| MODELS.iter().any(|kind| kind.name == name && !kind.yields);
        if (searches || phase.strength_reduction.is_some())
            && file.materials.values().all(|material| bears_all(&material.model))
        {
            let at = if phase.strength_reduction.is_some() { &at } else { path };
            self.issue(at, At::Key, "no material has a strength to be reduced", "give the soil a model that yields");
        }
        let Some(given) = &phase.strength_reduction else {
            return searches.then(|| TimeValue::Table(vec![[0.0, 1.0], [phase.duration, 1.0 + phase.duration]]));
        };
        let value = self.in_time(given, &at);
        let remedy = "give a number above 0, or `{table: [[0, 1], [1, 2]]}`";
        match &value {
            TimeValue::Constant(factor) if *factor <= 0.0 => {
                self.issue(&at, At::Value, format!("strengths cannot be divided by {factor}"), remedy);
            }
            TimeValue::Rate(_) => {
                self.issue(&at, At::Value, "a rate begins at 0, and strengths cannot be divided by that", remedy)
            }
            TimeValue::Table(table) => {
                for (i, [_, factor]) in table.iter().enumerate().filter(|(_, [_, factor])| *factor <= 0.0) {
                    let at = at.key("table").index(i);
                    self.issue(&at, At::Value, format!("strengths cannot be divided by {factor}"), remedy);
                }
            }
            TimeValue::Constant(_) | TimeValue::Record(_) => {}
        }
        let grows =
            matches!(&value, TimeValue::Table(table) if table.len() > 1 && table.windows(2).all(|w| w[1][1] > w[0][1]));
        if searches && !grows {
            let remedy = "give a table that grows, or leave it out: then the factor is 1 plus the time";
            self.issue(&at, At::Value, "a search for failure needs a factor that grows", remedy);
        }
        Some(value)
    }

    /// What is not there in a phase, given the one before it.
    fn absent(&mut self, phase: &raw::Phase, before: Option<&Phase>, file: &raw::CaseFile, path: &Path) -> Vec<String> {
        let structures =
            file.regions.iter().filter(|(_, r)| r.kind == raw::RegionKind::Structure).map(|(name, _)| name);
        let of_contacts = file.contacts.iter().flat_map(|c| c.wall.iter().chain(&c.name));
        let known: Vec<&str> = structures.chain(of_contacts).chain(file.bars.keys()).map(String::as_str).collect();
        let mut absent = before.map_or_else(Vec::new, |before| before.absent.clone());
        for (i, name) in phase.deactivate.iter().enumerate() {
            let path = path.key("deactivate").index(i);
            if file.regions.get(name).is_some_and(|region| region.kind == raw::RegionKind::Mpm) {
                let remedy = format!("dig it out with `remove: [{name}]`");
                self.issue(&path, At::Value, format!("`{name}` is soil of material points"), remedy);
            } else if !known.contains(&name.as_str()) {
                let problem = format!("there is no structure, wall, contact or bar `{name}`");
                self.issue(&path, At::Value, problem, suggest(name, known.iter().copied()));
            } else if absent.contains(name) {
                self.issue(&path, At::Value, format!("`{name}` is not there already"), "take it out");
            } else {
                absent.push(name.clone());
            }
        }
        for (i, name) in phase.activate.iter().enumerate() {
            match absent.iter().position(|other| other == name) {
                Some(at) => {
                    absent.remove(at);
                }
                None => {
                    let path = path.key("activate").index(i);
                    let remedy = "take it out, or name it under `deactivate` of an earlier phase";
                    self.issue(&path, At::Value, format!("`{name}` has not been deactivated"), remedy);
                }
            }
        }
        for name in phase.prescribe.keys().filter(|name| absent.contains(name)) {
            let path = path.key("prescribe").key(name);
            self.issue(&path, At::Key, format!("`{name}` is not there in this phase"), "take it out, or activate it");
        }
        absent
    }

    fn until(&mut self, phase: &raw::Phase, file: &raw::CaseFile, path: &Path) -> Vec<Until> {
        let mut checked = Vec::new();
        for (i, condition) in phase.until.iter().enumerate() {
            let path = path.index(i);
            let raw::Until { of, quantity, above, below, equilibrium } = condition;
            let (bound, is_below) = match (above, below) {
                (Some(above), None) => (Some(*above), false),
                (None, Some(below)) => (Some(*below), true),
                _ => (None, false),
            };
            match (of, quantity, bound, equilibrium) {
                (Some(of), Some(quantity), Some(bound), None) => {
                    let Some(entry) = file.output.history.iter().find(|entry| entry.name == *of) else {
                        let names = file.output.history.iter().map(|entry| entry.name.as_str());
                        let problem = format!("`output.history` has no entry `{of}`");
                        self.issue(&path.key("of"), At::Value, problem, suggest(of, names));
                        continue;
                    };
                    if !entry.quantities.contains(quantity) {
                        let remedy = "add it to the `quantities` of that entry";
                        let problem = format!("the entry `{of}` of `output.history` does not have this quantity");
                        self.issue(&path.key("quantity"), At::Value, problem, remedy);
                    }
                    checked.push(Until::Reached {
                        of: of.clone(),
                        quantity: (*quantity).into(),
                        bound,
                        below: is_below,
                    });
                }
                (None, None, None, Some(part)) if above.is_none() => {
                    if !phase.analysis.has_inertia() {
                        let remedy = "take it out: every step of a phase without inertia ends in equilibrium";
                        self.issue(&path, At::Value, "there is no motion to come to rest", remedy);
                    }
                    checked.push(Until::Equilibrium(*part));
                }
                _ => {
                    let remedy =
                        "write `{of: …, quantity: …, above: …}`, the same with `below`, or `{equilibrium: 1.0e-3}`";
                    self.issue(&path, At::Value, "this says not, or not only, when the phase ends", remedy);
                }
            }
        }
        checked
    }

    fn step(&mut self, step: &raw::Step, duration: f64, path: &Path) -> StepSize {
        let min = step.min.unwrap_or(1e-4 * step.initial);
        let max = step.max.unwrap_or(step.initial);
        // A number out of range has been reported; what follows from it is not.
        if step.initial > duration && duration > 0.0 {
            let problem = format!("the first step {} is longer than the phase ({duration})", step.initial);
            self.issue(&path.key("initial"), At::Value, problem, "shorten `initial` or lengthen `duration`");
        }
        if min > step.initial && step.initial > 0.0 {
            let problem = format!("`min` ({min}) is above `initial` ({})", step.initial);
            self.issue(&path.key("min"), At::Value, problem, "lower `min`");
        }
        if max < step.initial {
            let problem = format!("`max` ({max}) is below `initial` ({})", step.initial);
            self.issue(&path.key("max"), At::Value, problem, "raise `max`");
        }
        StepSize { initial: step.initial, min, max }
    }

    /// A value in the time of a phase, as the entry at `path` has it.
    pub fn in_time(&mut self, value: &raw::InTime, path: &Path) -> TimeValue {
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
}
