//! Steps whose iteration comes to rest a little before its goal (docs/theory.md, section 14, *Acceptable residuals*).

use super::Newton;
use crate::error::Result;

/// So many iterations without a smaller residual are the end of one that has come to an acceptable residual.
const AT_REST: usize = 10;

impl<const D: usize> Newton<'_, D> {
    /// Keeps the current state if it has the least residual so far and that is acceptable.
    pub(super) fn keep_acceptable(&mut self) {
        let residual = self.error();
        let least = self.nearest.map_or(self.problem.scene.numerics.acceptable_tolerance, |(residual, _)| residual);
        if self.accepts && residual < least && self.buffers.gap.iter().all(|g| *g == 0.0) {
            self.nearest = Some((residual, self.history.len()));
            self.buffers.nearest.clone_from(&self.buffers.now.at);
        }
    }

    /// Whether the iteration has come to rest at an acceptable residual.
    pub(super) fn at_rest(&self) -> bool {
        self.nearest.is_some_and(|(_, found)| self.history.len() > found + AT_REST)
    }

    /// Takes the state with the least residual, where that is acceptable.
    pub(super) fn take_acceptable(&mut self) -> Result<bool> {
        if self.nearest.is_none() {
            return Ok(false);
        }
        self.buffers.now.at.clone_from(&self.buffers.nearest);
        self.evaluate(false)?;
        self.note();
        Ok(true)
    }
}
