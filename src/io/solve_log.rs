//! `solve.log` read again: the steps of a run, and what it had to say.
//!
//! The lines of steps are those that `run::record` writes; every other line is a remark: notes, warnings, and why the run ended.

use super::atomic;
use crate::error::Result;
use crate::reading;
use std::path::Path;

/// A converged step.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    pub phase: String,
    /// Time at its end (s).
    pub time: f64,
    /// Its size (s).
    pub size: f64,
    /// Iterations of Newton's method.
    pub iterations: f64,
    /// How many times it was halved until it converged.
    pub halvings: f64,
    /// Whether the grid was restored after it.
    pub restored: bool,
}

/// A line that is no step, and the time (s) of the step before it.
#[derive(Clone, Debug, PartialEq)]
pub struct Remark {
    pub time: f64,
    pub text: String,
}

/// What a log has.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SolveLog {
    /// The first lines, before any step.
    pub heading: Vec<String>,
    pub steps: Vec<Step>,
    pub remarks: Vec<Remark>,
}

/// How the reason of a halving begins.
const HALVED: &str = "  halved: ";

impl SolveLog {
    /// Reads a log; a line that is being written counts as far as it goes.
    ///
    /// # Errors
    /// `Input` when it is missing, `Machine` when it cannot be read.
    pub fn read(path: &Path) -> Result<Self> {
        let bytes = reading::bytes(path).map_err(|e| atomic::unreadable(path, &e, "run `mpm solve` first"))?;
        Ok(Self::parse(&String::from_utf8_lossy(&bytes)))
    }

    /// The log of a text.
    pub fn parse(text: &str) -> Self {
        let (mut log, mut halvings, mut time) = (Self::default(), 0.0, 0.0);
        for line in text.lines() {
            if let Some(step) = Step::parse(line, halvings) {
                (time, halvings) = (step.time, 0.0);
                log.steps.push(step);
                continue;
            }
            if line.starts_with(HALVED) {
                halvings += 1.0;
            }
            // What a run is made of stands before its first step, as do warnings, which are remarks.
            let remarked = !log.steps.is_empty() || line.starts_with("warning") || line.starts_with(' ');
            match remarked {
                true => log.remarks.push(Remark { time, text: line.trim().to_owned() }),
                false => log.heading.push(line.to_owned()),
            }
        }
        log
    }

    /// The phases in their order, each with the time (s) at which it begins.
    pub fn phases(&self) -> Vec<(&str, f64)> {
        let mut phases: Vec<(&str, f64)> = Vec::new();
        for step in &self.steps {
            if phases.last().is_none_or(|(name, _)| *name != step.phase) {
                phases.push((&step.phase, step.time - step.size));
            }
        }
        phases
    }
}

impl Step {
    fn parse(line: &str, halvings: f64) -> Option<Self> {
        let (number, rest) = line.strip_prefix("step ")?.split_once(' ')?;
        number.parse::<u64>().ok()?;
        // The name of a phase may have spaces, and even words of the line, in it: the last place that fits is that of the time.
        let (at, numbers) =
            rest.match_indices(" t ").filter_map(|(at, _)| Some((at, Self::numbers(&rest[at..])?))).last()?;
        let [time, size, iterations] = numbers;
        let restored = rest.contains(" restored");
        Some(Self { phase: rest[..at].to_owned(), time, size, iterations, halvings, restored })
    }

    /// Time, size and iterations from ` t T dt S iterations N residuals`.
    fn numbers(text: &str) -> Option<[f64; 3]> {
        let mut words = text.split_whitespace();
        let mut number = |name: &str| (words.next()? == name).then(|| words.next()?.parse().ok())?;
        Some([number("t")?, number("dt")?, number("iterations")?])
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LOG: &str = "2048 material points, mass 0e0 t, in 178 cells with 531 nodes\nenergies in kJ\n\
        warning: no contact names it\n\
        step 1 push t 1 t 0.002500000 dt 2.500e-3 iterations 2 residuals 0.0e0 5.2e-6 by Iterative mass 0e0\n  \
        halved: Newton: too many iterations\n  halved: again\n\
        step 2 push t 1 t 0.006250000 dt 3.750e-3 iterations 7 residuals 8e-3 by Lu mass 0 restored cells fitted linear 1\n\
        phase `push t 1` ends: it is there\nstep 3 pull t 0.010000000 dt 3.750e-3 iterations 1 residuals 8e-3 by Lu\n\
        the analysis ends here: no\nstep 4 pull t 0.0";

    #[test]
    fn steps_halvings_phases_and_remarks_are_those_of_the_log() {
        let log = SolveLog::parse(LOG);
        assert_eq!(log.heading.len(), 2);
        let steps: Vec<_> =
            log.steps.iter().map(|s| (&*s.phase, s.time, s.iterations, s.halvings, s.restored)).collect();
        let expected = [
            ("push t 1", 0.0025, 2.0, 0.0, false),
            ("push t 1", 0.00625, 7.0, 2.0, true),
            ("pull", 0.01, 1.0, 0.0, false),
        ];
        assert_eq!(steps, expected);
        assert_eq!(log.phases(), [("push t 1", 0.0), ("pull", 0.0025 + 0.00375)]);
        let remarks: Vec<_> = log.remarks.iter().map(|r| (r.time, r.text.as_str())).collect();
        assert_eq!(remarks[0], (0.0, "warning: no contact names it"));
        assert_eq!(remarks[1], (0.0025, "halved: Newton: too many iterations"));
        assert_eq!(remarks[3], (0.00625, "phase `push t 1` ends: it is there"));
        assert_eq!(remarks[4], (0.01, "the analysis ends here: no"));
    }
}
