//! The length of a step along the direction of an iteration: line search, watchdog, damping (docs/theory.md, section 14, eq. 14 and 14a).

use super::super::balance::evaluate;
use super::super::unknowns::Buffers;
use super::Newton;
use crate::error::Result;

/// Sufficient decrease of the residual for a step length `s`: by a factor `1 − ARMIJO · s`.
const ARMIJO: f64 = 1e-4;
/// Halvings of the step length before the best one is taken.
const BACKTRACKS: i32 = 6;
/// Line searches that may end without a decrease before the step is given up.
const STALLED: usize = 4;
/// Least fraction (-) by which the diagonal of the tangent is raised (Levenberg 1944).
const LEAST_DAMPING: f64 = 1e-4;
/// No larger fraction (-): 0.1 is the largest power of ten below. Without damping a wall that is pushed into clay stops as it is pulled
/// (`docs/numerics.md`, *As expected*).
const MOST_DAMPING: f64 = 0.2;
/// Where soil with friction follows a prescribed motion the residual is to fall below the largest of this many before it (Grippo, Lampariello & Lucidi
/// 1986). Damping grows where it rises.
const MEMORY: usize = 5;
/// The factor by which damping grows where it is too little, and falls after each accepted step.
const DAMPING_FACTOR: f64 = 10.0;
/// From this many halvings of an accepted step length on, the diagonal is raised. Else the last equilibrium of a slope is found at a factor of safety
/// 0.4 % lower (`docs/numerics.md`, *As expected*).
const DAMPED_FROM: i32 = 3;
/// Full steps that may raise the residual before the iteration returns to its best state.
const WATCHDOG: usize = 3;
/// A full step that leaves more than this fraction (-) of the residual may have gone too far.
const WORTH: f64 = 0.25;
/// Fraction (-) of the work along the direction that a step may leave, eq. 14a (Matthies & Strang 1979).
const ENERGY_LEFT: f64 = 0.5;
/// Most trial states of the energy line search.
const ENERGY_TRIALS: usize = 5;
/// Least distance (-) of the next length from the ends of the bracket, over its size.
const LEAST_INWARDS: f64 = 0.1;

impl<const D: usize> Newton<'_, D> {
    /// Whether the next full step will end the iteration, if it converges as the last ones did: its tangent is then
    /// not worth its time.
    fn near_the_end(&self) -> bool {
        let [.., before, last] = self.history[..] else { return false };
        last < before && last * (last / before).powi(2) < self.tolerance()
    }

    /// Takes a step along `δ`. A full step that reduces the residual little, or not, and goes beyond the length at which the work along `δ`
    /// vanishes is shortened to about that length, if this reduces the residual (energy line search, Matthies & Strang 1979): iterations
    /// would otherwise alternate where soil yields or contacts open. Else the full step is taken even if the residual grows, for a few
    /// iterations: bending structures converge only in this way. If the residual does not fall then, the iteration returns to its best state
    /// and from then on backtracks (watchdog, Chamberlain et al. 1982).
    pub(super) fn search(&mut self) -> Result<()> {
        let with_tangent = !self.near_the_end();
        if let Some(size) = self.attempt(1.0, with_tangent) {
            let far = self.overshoots(size);
            if far && self.energy_search() {
                return Ok(());
            }
            let better = self.better(size, 1.0);
            let on_trial = !better && !self.strict && self.relaxed < WATCHDOG;
            // Where the step was shortened in vain another state was tried since.
            if (better || on_trial) && (!far || self.attempt(1.0, with_tangent).is_some()) {
                if on_trial {
                    self.relaxed += 1;
                    self.take(with_tangent);
                } else {
                    self.relax();
                    self.accept(with_tangent);
                }
                return Ok(());
            }
        }
        if self.is_on_trial() { self.return_to_best() } else { self.backtrack() }
    }

    /// Whether the current state was accepted on trial, with a larger residual than the best one.
    pub(super) fn is_on_trial(&self) -> bool {
        !self.strict && self.relaxed > 0
    }

    /// Goes back to the best state; every iteration has to reduce the residual from here on.
    pub(super) fn return_to_best(&mut self) -> Result<()> {
        self.strict = true;
        self.buffers.now.at.clone_from(&self.buffers.best);
        self.evaluate(true)?;
        self.note();
        Ok(())
    }

    /// The work (kJ) of a force along `δ`, without prescribed displacements and pressures.
    fn work(&self, force: &[f64]) -> f64 {
        let of_nodes = self.grid.dofs.displacements();
        let each = force.iter().zip(&self.buffers.delta).zip(&self.buffers.fixed).take(of_nodes);
        each.map(|((f, d), fixed)| if *fixed { 0.0 } else { f * d }).sum()
    }

    /// Whether the full step, with a residual of this size (kN), went too far: `w(1) > −w(0)/2`, and the residual is worth a search.
    fn overshoots(&self, size: f64) -> bool {
        let done = self.problem.scene.numerics.tolerance * self.buffers.trial.scale.max(self.floor);
        let before = self.work(&self.buffers.wanted);
        let worth = size > done && size > WORTH * self.target && !self.unreached;
        worth && before > 0.0 && self.work(&self.buffers.trial.force) > ENERGY_LEFT * before
    }

    /// Shortens the full step to a length with eq. 14a, by regula falsi with halved ends (Dowell & Jarratt 1971); false if the residual is
    /// not reduced there.
    fn energy_search(&mut self) -> bool {
        let first = -self.work(&self.buffers.wanted);
        let (mut low, mut high) = ((0.0, first), (1.0, self.work(&self.buffers.trial.force)));
        let mut below = None;
        for _ in 0..ENERGY_TRIALS {
            let (whole, root) = (high.0 - low.0, low.1 / (low.1 - high.1));
            let length = low.0 + whole * root.clamp(LEAST_INWARDS, 1.0 - LEAST_INWARDS);
            let Some(size) = self.attempt(length, false) else { return false };
            let work = self.work(&self.buffers.trial.force);
            if work.abs() <= -ENERGY_LEFT * first {
                let better = self.better(size, length);
                if better {
                    self.accept(false);
                }
                return better;
            }
            // The work at an end of the bracket that stays a second time is halved (Illinois).
            let again = below == Some(work < 0.0);
            if work < 0.0 {
                low = (length, work);
                high.1 *= if again { 0.5 } else { 1.0 };
            } else {
                high = (length, work);
                low.1 *= if again { 0.5 } else { 1.0 };
            }
            below = Some(work < 0.0);
        }
        false
    }

    /// Raises the diagonal by [`DAMPING_FACTOR`] times as much from here on; false if that would be too much.
    fn dampen(&mut self) -> bool {
        let more = (DAMPING_FACTOR * self.damping).max(LEAST_DAMPING);
        let can = more <= MOST_DAMPING;
        if can {
            self.damping = more;
        }
        can
    }

    /// Lowers the diagonal again.
    fn relax(&mut self) {
        self.damping = if self.damping > LEAST_DAMPING { self.damping / DAMPING_FACTOR } else { 0.0 };
    }

    /// Halves the step length until the residual falls; takes the least one a few times where it never does.
    fn backtrack(&mut self) -> Result<()> {
        let mut least: Option<(f64, f64)> = None;
        for halvings in 1..=BACKTRACKS {
            let length = 0.5f64.powi(halvings);
            if let Some(size) = self.attempt(length, false) {
                if self.better(size, length) {
                    if halvings >= DAMPED_FROM {
                        self.dampen();
                    } else {
                        self.relax();
                    }
                    self.accept(false);
                    return Ok(());
                }
                if least.is_none_or(|(other, _)| size < other) {
                    least = Some((size, length));
                }
            }
        }
        // No length reduces the residual: the next direction, from the same state, is damped and so shorter.
        if self.dampen() {
            return Ok(());
        }
        let Some((_, length)) = least else {
            let why = self.refused.take().map_or("no trial state is admissible".to_string(), |error| {
                format!("no trial state is admissible: {} {}", error.place, error.problem)
            });
            return Err(self.failure(&why));
        };
        let stalled = self.stalled + 1;
        if stalled <= STALLED && self.attempt(length, true).is_some() {
            self.accept(true);
            self.stalled = stalled;
            return Ok(());
        }
        Err(self.failure("the line search finds no smaller residual"))
    }

    /// The residual (kN) of the trial state at a step length, if it is admissible.
    pub(super) fn attempt(&mut self, length: f64, tangent: bool) -> Option<f64> {
        self.length = length;
        let mut trial = std::mem::take(&mut self.buffers.trial);
        trial.at.clone_from(&self.buffers.now.at);
        self.problem.advance(self.grid, &mut trial.at, &self.buffers.delta, length);
        self.buffers.stiffening = self.stiffening();
        let done = evaluate(self.problem, self.grid, &mut self.buffers, &mut trial, tangent);
        let size = self.size(&trial);
        self.buffers.trial = trial;
        match done {
            Ok(()) => size.is_finite().then_some(size),
            Err(error) => {
                self.refused = Some(error);
                None
            }
        }
    }

    fn better(&self, size: f64, length: f64) -> bool {
        size <= (1.0 - ARMIJO * length) * self.target || size <= self.problem.scene.numerics.tolerance * self.floor
    }

    /// Makes the trial state the current one; `tangent` where the matrix of the grid is its tangent.
    fn take(&mut self, tangent: bool) {
        let Buffers { now, trial, .. } = &mut self.buffers;
        std::mem::swap(now, trial);
        self.tangent = tangent;
        self.note();
    }

    pub(super) fn accept(&mut self, tangent: bool) {
        self.take(tangent);
        self.keep_acceptable();
        let Buffers { now, best, .. } = &mut self.buffers;
        best.clone_from(&now.at);
        let size = self.size(&self.buffers.now);
        if self.follows && self.recent.last().is_some_and(|last| size > *last) {
            self.dampen();
        }
        self.recent.push(size);
        let memory = if self.follows { MEMORY } else { 1 };
        let last = &self.recent[self.recent.len().saturating_sub(memory)..];
        (self.target, self.relaxed, self.stalled) = (last.iter().copied().fold(0.0, f64::max), 0, 0);
    }
}
