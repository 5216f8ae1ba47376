//! The phases of a case: time steps, prescribed displacements and loads.

use super::check::Checker;
use super::checked::{Analysis, Numerics, Phase, Prescribed, StepSize};
use super::locate::{At, Path};
use super::raw;
use crate::time_value::TimeValue;

impl Checker {
    pub(super) fn phases(&mut self, file: &raw::CaseFile, numerics: &Numerics, path: &Path) -> Vec<Phase> {
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
                if file.materials.values().all(|material| material.permeability.is_none()) {
                    let remedy = "give an undrained material a `permeability`, or choose quasi_static";
                    self.issue(&path.key("analysis"), At::Value, "no material has a permeability", remedy);
                }
                Analysis::Consolidation
            }
        };
        let mut prescribed = Vec::new();
        for (curve, motion) in &phase.prescribe {
            let path = path.key("prescribe").key(curve);
            if motion.rotation.is_some() {
                self.turns(file, curve, &path.key("rotation"));
            }
            if motion.ux.is_none() && motion.uy.is_none() && motion.rotation.is_none() {
                self.issue(&path, At::Key, "nothing is prescribed", "add `ux: …` or `uy: …`");
            }
            let entries = [("ux", &motion.ux), ("uy", &motion.uy), ("rotation", &motion.rotation)];
            for (component, (key, value)) in entries.into_iter().enumerate() {
                let Some(value) = value else { continue };
                let displacement = self.in_time(value, &path.key(key));
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
            surface_loads,
            gravity,
        }
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

    pub(super) fn in_time(&mut self, value: &raw::InTime, path: &Path) -> TimeValue {
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
