//! How far to go along the direction of an iteration.

use super::super::balance::evaluate;
use super::{Buffers, Newton};
use crate::error::Result;

/// Share of the work of the residual along a direction that a step length may leave.
const SLACK: f64 = 0.5;
/// Trial lengths after the full one, and the least share of a bracket that the next goes into it.
const TRIALS: usize = 5;
const INWARDS: f64 = 0.1;

impl<const D: usize> Newton<'_, D> {
    /// Whether the next full step will end the iteration, if it converges as the last ones did: its tangent is then
    /// not worth its time.
    fn near_the_end(&self) -> bool {
        let [.., before, last] = self.history[..] else { return false };
        last < before && last * (last / before).powi(2) < self.tolerance()
    }

    /// Goes along `δ`: the full step, unless the residual does much work beyond it. Then the length is sought where
    /// the work vanishes, by regula falsi with halved ends (Matthies & Strang 1979; Dowell & Jarratt 1971). Where contacts
    /// open and close on the way the residual must fall, too.
    pub(super) fn search(&mut self) -> Result<()> {
        let tangent = !self.near_the_end();
        let first = self.work(&self.buffers.wanted);
        let before = self.size(&self.buffers.now);
        let full = self.attempt(1.0, tangent);
        // What is given unbalances more than the residual at hand, and along ascent there is no such length.
        let any = self.due || first <= 0.0;
        let too_large = |newton: &Self| newton.strict && !newton.due && newton.size(&newton.buffers.trial) > before;
        let falls = !too_large(self);
        if full.is_some_and(|work| any || falls && work <= SLACK * first || self.balanced()) {
            self.take(tangent);
            return Ok(());
        }
        // Beyond an inadmissible state the work is taken to be large.
        let (mut low, mut high) = ((0.0, -first), (1.0, full.filter(|_| falls).unwrap_or(first)));
        let (mut below, mut admissible) = (None, false);
        for _ in 0..TRIALS {
            let root = if any { 0.5 } else { low.1 / (low.1 - high.1) };
            let length = low.0 + (high.0 - low.0) * root.clamp(INWARDS, 1.0 - INWARDS);
            let found = self.attempt(length, false);
            admissible = found.is_some();
            let work = found.filter(|_| !too_large(self)).unwrap_or(first);
            if admissible && (any || work.abs() <= SLACK * first) {
                break;
            }
            // An end that stays a second time weighs half.
            let again = if below.replace(work < 0.0) == Some(work < 0.0) { 0.5 } else { 1.0 };
            if work < 0.0 {
                low = (length, work);
                high.1 *= again;
            } else {
                high = (length, work);
                low.1 *= again;
            }
        }
        if !admissible && (low.0 == 0.0 || self.attempt(low.0, false).is_none()) {
            let why = self.refused.take().map_or(String::new(), |error| format!(": {} {}", error.place, error.problem));
            return Err(self.failure(&format!("no trial state is admissible{why}")));
        }
        self.take(false);
        Ok(())
    }

    /// The work (kJ) of a force along `δ`, that of what is given and of pressures left out.
    fn work(&self, force: &[f64]) -> f64 {
        let of_nodes = D * self.grid.node.len();
        let each = force.iter().zip(&self.buffers.delta).zip(&self.buffers.fixed).take(of_nodes);
        each.map(|((f, d), fixed)| if *fixed { 0.0 } else { f * d }).sum()
    }

    /// Whether the residual of the trial state is small enough.
    fn balanced(&self) -> bool {
        let trial = &self.buffers.trial;
        self.size(trial) <= self.problem.scene.numerics.tolerance * trial.scale.max(self.floor)
    }

    /// The work (kJ) of the residual of the trial state at a step length, if it is admissible.
    fn attempt(&mut self, length: f64, tangent: bool) -> Option<f64> {
        self.length = length;
        let mut trial = std::mem::take(&mut self.buffers.trial);
        trial.at.clone_from(&self.buffers.now.at);
        trial.at.advance(self.problem, self.grid, &self.buffers.delta, length);
        let done = evaluate(self.problem, self.grid, &mut self.buffers, &mut trial, tangent);
        let finite = self.size(&trial).is_finite();
        self.buffers.trial = trial;
        match done {
            Ok(()) => finite.then(|| self.work(&self.buffers.trial.force)),
            Err(error) => {
                self.refused = Some(error);
                None
            }
        }
    }

    /// Makes the trial state the one at hand; `tangent` where the matrix of the grid is its tangent.
    fn take(&mut self, tangent: bool) {
        let Buffers { now, trial, .. } = &mut self.buffers;
        std::mem::swap(now, trial);
        self.tangent = tangent;
        self.note();
    }
}
