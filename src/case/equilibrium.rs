//! The phase that brings an initial stress into equilibrium, before the phases of the case file (`initial_stress.then`).

use super::check::Checker;
use super::checked::{Analysis, Case, Material, Phase, Prescribed, StepSize, Water};
use super::locate::{At, Path};
use super::raw;
use crate::gravity::Gravity;
use crate::time_value::TimeValue;

/// The name of the phase.
const NAME: &str = "equilibrium";
/// Its duration (s), in one step: the time before 0.
const DURATION: f64 = 1.0;
/// Its shortest step (s).
const SHORTEST: f64 = 1e-4;

impl Checker {
    /// Puts the phase before those of the case file, if it asks for one: gravity, the water and the structures are what they are as the
    /// first of these begins, and what that moves is held. Says whether there is one.
    pub(super) fn equilibrium(
        &mut self,
        file: &raw::CaseFile,
        phases: &mut Vec<Phase>,
        water: Option<&mut Water>,
        root: &Path,
    ) -> bool {
        let wanted = file.initial_stress.as_ref().and_then(|initial| initial.then) == Some(raw::Then::Equilibrium);
        let Some(first) = phases.first_mut().filter(|_| wanted) else { return false };
        let hold = |moved: &Prescribed| Prescribed { displacement: TimeValue::Constant(0.0), ..moved.clone() };
        let phase = Phase {
            name: NAME.to_owned(),
            analysis: Analysis::QuasiStatic,
            duration: DURATION,
            step: StepSize { initial: DURATION, min: SHORTEST, max: DURATION },
            prescribed: first.prescribed.iter().map(hold).collect(),
            tractions: Vec::new(),
            surface_loads: Vec::new(),
            gravity: Gravity::Scaled { whole: [file.gravity.x, file.gravity.y], factor: TimeValue::Constant(1.0) },
            reduction: None,
            absent: first.absent.clone(),
            removed: Vec::new(),
            placed: Vec::new(),
            inflows: Vec::new(),
            changes: Vec::new(),
            contacts: Vec::new(),
            reset_displacements: false,
            until: Vec::new(),
        };
        first.reset_displacements = true;
        phases.insert(0, phase);
        if let Some(Water { level, phreatic, .. }) = water {
            level.iter_mut().for_each(|levels| levels.insert(0, TimeValue::Constant(levels[0].at(0.0))));
            phreatic.iter_mut().for_each(|tables| tables.insert(0, tables[0].held()));
        }
        if let Some(i) = file.phases.iter().position(|phase| phase.name == NAME) {
            let path = root.key("phases").index(i).key("name");
            let problem = format!("`initial_stress` has `then: {NAME}`, a phase of that name");
            self.issue(&path, At::Value, problem, "give this phase another name");
        }
        let cure = "take `then` out, and let gravity act in a first phase of your own";
        for name in file.initial_velocity.keys() {
            let problem = "`initial_stress` has `then: equilibrium`, which leaves the soil at rest";
            self.issue(&root.key("initial_velocity").key(name), At::Key, problem, cure);
        }
        for name in file.initial_pore_pressure.keys() {
            let problem = "`initial_stress` has `then: equilibrium`, without the load that balances this pressure";
            self.issue(&root.key("initial_pore_pressure").key(name), At::Key, problem, cure);
        }
        true
    }
}

/// A warning where soil that keeps its volume comes to equilibrium.
pub fn undrained(case: &Case) -> Option<String> {
    // A case with mistakes may lack materials.
    let of_regions = case.regions.iter().filter_map(|region| case.materials.get(region.content.material()?));
    let Material { name, .. } = of_regions.filter(|_| case.equilibrium).find(|soil| soil.has_pore_pressure())?;
    Some(format!(
        "warning: `then: {NAME}` of `initial_stress` deforms `{name}` undrained, and leaves an excess pore pressure in it where ground or layers \
         are not level; where there is to be none, load gravity in a first consolidation phase in place of `initial_stress`"
    ))
}
