//! Records of acceleration that curves and rigid structures are moved by.

use super::check::Checker;
use super::checked::{Case, Phase};
use super::locate::{At, Path};
use super::raw::{self, Analysis, InTime};
use crate::time_value::{Record, TimeValue};

/// The keys of the components.
pub const RECORDS: [&str; 2] = ["ax", "ay"];

/// What may be left of the largest velocity (-) as a phase ends: less is the rounding of the record.
const LEFT: f64 = 0.01;

impl Checker {
    /// The displacements that records of acceleration prescribe, by component.
    pub(super) fn records(
        &mut self,
        phase: &raw::Phase,
        file: &raw::CaseFile,
        motion: &raw::Motion,
        path: &Path,
    ) -> [Option<TimeValue>; 2] {
        let given = [(&motion.ax, motion.ux.is_some()), (&motion.ay, motion.uy.is_some())];
        [0, 1].map(|component| {
            let (value, moved) = given[component];
            let (value, path) = (value.as_ref()?, path.key(RECORDS[component]));
            if moved {
                let displacement = ["ux", "uy"][component];
                let problem = format!("`{displacement}` is prescribed as well");
                self.issue(&path, At::Key, problem, "take one of the two out");
            }
            if motion.rotation.is_some() {
                self.issue(&path, At::Key, "a rotation is prescribed as well", "give `ux`, `uy` and `rotation`");
            }
            if phase.analysis != Analysis::Dynamic {
                let remedy = "make the phase `analysis: dynamic`, or prescribe `ux` or `uy`";
                self.issue(&path, At::Key, "accelerations are prescribed in dynamic phases", remedy);
            }
            if file.numerics.gradient == "bspline" {
                let remedy = "choose `gradient: mpm`";
                self.issue(&path, At::Key, "accelerations are those of nodes, and splines have none", remedy);
            }
            let table = match (self.in_time(value, &path), value) {
                (TimeValue::Table(table), _) => table,
                (_, InTime::Constant(a)) => vec![[0.0, *a]],
                (rate, _) => vec![[0.0, 0.0], [phase.duration, rate.at(phase.duration)]],
            };
            Some(TimeValue::Record(Record::new(&table).into()))
        })
    }
}

/// A warning for each record of a phase that leaves a velocity in the end, or goes beyond the phase.
pub fn warnings(case: &Case) -> Vec<String> {
    case.phases.iter().flat_map(of_phase).collect()
}

fn of_phase(phase: &Phase) -> impl Iterator<Item = String> {
    phase.prescribed.iter().filter_map(|moved| {
        let record = moved.displacement.record()?;
        let name = format!("phase `{}`: `{}` of `{}`", phase.name, RECORDS[moved.component], moved.curve);
        let (end, last) = (phase.duration, record.end());
        if last > end * (1.0 + 1e-9) {
            return Some(format!(
                "warning: {name} goes to {last} s, and the phase ends at {end} s: the rest is not reached; lengthen the phase"
            ));
        }
        let left = record.at(end);
        (left.velocity.abs() > LEFT * record.fastest(end)).then(|| {
            format!(
                "warning: {name} leaves a velocity of {:.3e} m/s (the largest is {:.3e} m/s) and a displacement of {:.3e} m as the phase ends: \
                 correct the baseline of the record if it is to end at rest",
                left.velocity,
                record.fastest(end),
                left.displacement
            )
        })
    })
}
