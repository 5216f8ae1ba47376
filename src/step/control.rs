//! Step control (docs/theory.md, section 14): steps grow while Newton's method converges fast, and are halved when it fails.

use super::scene::{StepSize, Stop};
use crate::error::{Error, Result};

/// A step is easy that takes at most this many iterations.
pub const EASY: usize = 6;
/// So many halvings of one step in a row are in vain: its residual does not depend on its size.
const IN_VAIN: usize = 2;
/// Relative residuals that differ by less than this part of themselves are the same.
const ALIKE: f64 = 0.01;
/// The factor (-) by which it grows: from a tenth of the largest step to it in six steps.
const GROWTH: f64 = 1.5;

/// Step control within one phase.
#[derive(Clone, Debug)]
pub struct Controller {
    limits: StepSize,
    stops: Vec<Stop>,
    /// The size (s) that the next step should have, before it is fitted to the next stop.
    pub wanted: f64,
    /// Halvings since the last accepted step, with the reasons.
    halvings: Vec<String>,
    /// The least relative residual (-) of each of these steps, in order.
    residuals: Vec<f64>,
    /// Whether a step failed that could not be halved again.
    pub exhausted: bool,
}

impl Controller {
    /// `stops` ascend and end with the end of the phase.
    pub fn new(limits: StepSize, stops: Vec<Stop>, wanted: f64) -> Self {
        Self { limits, stops, wanted, halvings: Vec::new(), residuals: Vec::new(), exhausted: false }
    }

    /// The next time a step must end at, after `now`.
    pub fn next_stop(&self, now: f64) -> Option<&Stop> {
        self.stops.get(self.stops.partition_point(|s| s.time <= now || same(s.time, now)))
    }

    /// The stop at `now`, if there is one.
    pub fn stop_at(&self, now: f64) -> Option<&Stop> {
        self.stops.iter().find(|s| same(s.time, now))
    }

    /// The size of the next step: the time to the next stop in equal parts no larger than wanted.
    pub fn size(&self, now: f64) -> f64 {
        match self.next_stop(now) {
            None => self.wanted,
            Some(stop) => {
                let left = stop.time - now;
                left / (left / self.wanted - 1e-9).ceil().max(1.0)
            }
        }
    }

    /// The least step over the first one (-).
    pub fn finest(&self) -> f64 {
        self.limits.min / self.limits.initial
    }

    /// Whether smaller steps than `dt` are in vain: it was halved in vain, or cannot be halved.
    pub fn in_vain(&self, dt: f64) -> bool {
        self.halvings.len() >= IN_VAIN || self.is_least(dt)
    }

    /// Whether half the step left the same residual: sand without cohesion has stresses, and residuals, in proportion to the step.
    pub fn is_alike(&self) -> bool {
        matches!(self.residuals[..], [.., before, last] if (last - before).abs() < ALIKE * before)
    }

    /// Whether half a step of `dt` (s) would be less than the least one.
    fn is_least(&self, dt: f64) -> bool {
        let half = 0.5 * dt;
        half < self.limits.min && !same(half, self.limits.min)
    }

    /// Halves the step after a failure, in which the relative residual came down to `residual` (-).
    ///
    /// # Errors
    /// The failure itself, once the step would fall below the least one.
    pub fn halve(&mut self, dt: f64, error: Error, residual: f64) -> Result<()> {
        self.residuals.push(residual);
        if self.is_least(dt) {
            self.exhausted = true;
            let how = match self.halvings.len() {
                0 => format!("the step of {dt:.3e} s cannot be halved"),
                1 => format!("the step was halved once down to {dt:.3e} s and cannot be again"),
                n => format!("the step was halved {n} times down to {dt:.3e} s and cannot be again"),
            };
            let least = self.limits.min;
            let problem = format!("{}; {how}: step.min is {least:.3e} s{}", error.problem, self.unbalanced());
            return Err(Error { problem, ..error });
        }
        self.wanted = 0.5 * dt;
        self.halvings.push(format!("{}: {}", error.place, error.problem));
        Ok(())
    }

    /// What the failed steps left out of balance, from the first to the last of them.
    fn unbalanced(&self) -> String {
        let known: Vec<f64> = self.residuals.iter().copied().filter(|residual| residual.is_finite()).collect();
        match known[..] {
            [only] => format!("; the unbalanced force was {only:.1e} of the largest force"),
            [first, .., last] => format!(
                "; the unbalanced force was {first:.1e} of the largest force in the first of these steps, {last:.1e} in the last"
            ),
            _ => String::new(),
        }
    }

    /// Takes note of an accepted step: the next one grows where this one was `easy`. Returns why it was halved.
    pub fn accept(&mut self, dt: f64, easy: bool) -> Vec<String> {
        let eased = easy && self.halvings.is_empty();
        // A step shortened to meet a stop says nothing about the size that would have converged.
        let base = self.wanted.max(dt);
        self.wanted = if eased { (base * GROWTH).min(self.limits.max) } else { base.min(self.limits.max) };
        self.residuals.clear();
        std::mem::take(&mut self.halvings)
    }
}

/// Whether two times differ by rounding only.
fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-10 * a.abs().max(b.abs())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn controller() -> Controller {
        let stops = [0.25, 1.0].map(|time| Stop { time, frame: true }).to_vec();
        Controller::new(StepSize { initial: 0.1, min: 0.01, max: 0.2 }, stops, 0.1)
    }

    #[test]
    fn steps_meet_the_stops_in_equal_parts() {
        let c = controller();
        assert!((c.size(0.0) - 0.25 / 3.0).abs() < 1e-15);
        assert!((c.size(0.25) - 0.75 / 8.0).abs() < 1e-15);
        assert!(c.next_stop(1.0).is_none());
    }

    #[test]
    fn steps_shrink_and_recover() {
        let mut c = controller();
        let error = || Error::analysis("Newton", "too many iterations", "");
        c.halve(0.1, error(), 1e-3).unwrap();
        assert!(!c.in_vain(0.1));
        assert!(!c.is_alike());
        c.halve(0.1, error(), 1.005e-3).unwrap();
        assert!(c.in_vain(0.1), "two halvings of one step");
        assert!(c.is_alike());
        c.accept(0.05, true);
        assert!(!c.in_vain(0.1));
        c.halve(0.1, error(), 1e-3).unwrap();
        assert_eq!(c.wanted, 0.05);
        c.accept(0.05, true);
        assert_eq!(c.wanted, 0.05, "no growth right after a halving");
        c.accept(0.05, true);
        assert!((c.wanted - 0.075).abs() < 1e-15);
        for _ in 0..5 {
            c.accept(c.wanted, true);
        }
        assert_eq!(c.wanted, 0.2);
        c.halve(0.03 - 0.01, error(), 1e-3).expect("half of it is the least one but for rounding");
        let problem = c.halve(0.015, error(), 5e-4).unwrap_err().problem;
        assert!(
            problem.contains("halved once") && problem.contains("was 1.0e-3 of the largest force in the first"),
            "{problem}"
        );
        assert!(problem.contains("5.0e-4 in the last"), "{problem}");
    }
}
