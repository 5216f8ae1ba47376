//! The state that the iteration of a step begins with (docs/theory.md, section 14).

use super::super::problem::Problem;
use super::{Newton, norm};
use crate::error::Result;
use crate::term::Frozen;

/// Most first iterations, which have a frozen contact status.
const FROZEN_ITERATIONS: usize = 3;
/// A first state of smooth contact in which nodes move this many times as far as in one of stuck contact is that of a body that slides away.
const SLIDES: f64 = 10.0;

impl<const D: usize> Newton<'_, D> {
    /// The state that the iteration begins with: where contacts are closed, what the first directions come to from the predicted state, or else,
    /// for bodies that start in contact, from the converged one; without contact the better one of these two.
    pub(super) fn begin(&mut self) -> Result<()> {
        let contact = self.problem.integration.is_none() && !self.grid.constraints.is_empty();
        self.buffers.predicted = contact && self.problem.predictor.is_some();
        if !contact {
            return self.predict();
        }
        if let Some(predictor) = self.problem.predictor {
            self.problem.begin(self.grid, &mut self.buffers.now.at, predictor);
            if self.first_iterations().is_ok() {
                return Ok(());
            }
            self.restart();
        }
        if self.grid.constraints.iter().any(|constraint| constraint.initially_closed) {
            if self.close_contacts().is_ok() {
                return Ok(());
            }
            self.restart();
        }
        self.evaluate(true)?;
        self.note();
        Ok(())
    }

    /// Begins with the predicted state if its residual is less than that of the converged one, the prescribed displacements being reached
    /// in both.
    fn predict(&mut self) -> Result<()> {
        let residual = |newton: &mut Self, start: &[[f64; D]], tangent: bool| {
            newton.problem.begin(newton.grid, &mut newton.buffers.now.at, start);
            newton.problem.gaps(newton.grid, &newton.buffers.now.at, &mut newton.buffers.gap);
            newton.problem.advance(newton.grid, &mut newton.buffers.now.at, &newton.buffers.gap, 1.0);
            let found = newton.evaluate(tangent).map(|()| newton.size(&newton.buffers.now));
            found.ok().filter(|size| size.is_finite()).unwrap_or(f64::INFINITY)
        };
        let predicted = self.problem.predictor.is_some_and(|predictor| {
            let without = residual(self, self.problem.converged(), false);
            residual(self, predictor, true) < without
        });
        self.buffers.predicted = predicted;
        if predicted {
            self.buffers.best.clone_from(&self.buffers.now.at);
        } else {
            self.restart();
            self.evaluate(true)?;
        }
        self.note();
        Ok(())
    }

    /// The first iterations from a predictor. The predicted state may open contact nodes that finally close. The soil beneath them, or the
    /// structure, is then unsupported, and the tangent yields far too large displacements. So the directions keep such contact nodes closed
    /// (frozen contact status) until one is taken at full length.
    fn first_iterations(&mut self) -> Result<()> {
        self.evaluate(false)?;
        self.note();
        let mut size = self.size(&self.buffers.now);
        for _ in 0..FROZEN_ITERATIONS {
            let noted = self.history.len();
            if self.converged() {
                break;
            }
            self.buffers.frozen = Frozen::Stuck;
            self.direction()?;
            self.buffers.frozen = Frozen::Not;
            // The residual to reduce is the true one, not that with the frozen status.
            self.target = if self.unreached { self.target.max(size) } else { size };
            self.search()?;
            if self.history.len() > noted {
                size = self.size(&self.buffers.now);
            }
            if self.length == 1.0 {
                break;
            }
        }
        Ok(())
    }

    /// The first iteration of bodies that start in contact: in full, along a direction that keeps all contact nodes closed. The residual is no measure
    /// of it: before it nothing supports the bodies, and after it contact nodes pull that will open. Contact is smooth in it, so that nothing hangs on
    /// a wall beyond its friction and pulls at soil that bears no tension; it is stuck where only friction holds a body, which would slide away.
    fn close_contacts(&mut self) -> Result<()> {
        self.evaluate(false)?;
        self.note();
        let Problem { scene, phase, .. } = *self.problem;
        let rough = scene.touching(phase).any(|(_, interface)| interface.sides().laws.at(phase).friction > 0.0);
        let ways: &[Frozen] = if rough { &[Frozen::Stuck, Frozen::Smooth] } else { &[Frozen::Stuck] };
        let mut chosen: Option<(f64, Vec<f64>)> = None;
        for &way in ways {
            self.problem.gaps(self.grid, &self.buffers.now.at, &mut self.buffers.gap);
            self.buffers.frozen = way;
            let found = self.direction();
            self.buffers.frozen = Frozen::Not;
            let Some(_) = found.ok().and_then(|()| self.attempt(1.0, false)) else { continue };
            let way = norm(&self.buffers.delta[..self.grid.dofs.displacements()]);
            if chosen.as_ref().is_none_or(|(stuck, _)| way <= SLIDES * stuck) {
                chosen = Some((way, self.buffers.delta.clone()));
            }
        }
        let (_, delta) = chosen.ok_or_else(|| self.failure("no first trial state is admissible"))?;
        self.buffers.delta = delta;
        self.attempt(1.0, true).ok_or_else(|| self.failure("the first trial state is not admissible"))?;
        self.accept(true);
        Ok(())
    }
}
