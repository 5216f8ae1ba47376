//! A step that failed, tried once more over residuals that rise (docs/theory.md, section 14).

use super::super::problem::Problem;
use super::{Newton, norm};
use crate::error::Result;
use crate::term::Frozen;

/// A state found over rising residuals that is this many times as far from the last one as an elastic step goes is another equilibrium. Heaps on rough floors
/// go 1.0 to 1.14 times as far; vertical cuts beyond their limit, 23 to 220 times.
const FAR: f64 = 2.0;
/// An iteration that is on the way to one goes this many times as far. On the way to the nearest one it may go beyond that for a while, too.
const ASTRAY: f64 = 10.0;

impl<const D: usize> Newton<'_, D> {
    /// Whether a step that fails may be tried again: soil with friction, without inertia, and with strengths that are not reduced.
    pub(super) fn may_rise(&self) -> bool {
        let Problem { scene, phase, integration, .. } = self.problem;
        integration.is_none() && scene.has_friction() && scene.phases[*phase].reduction.is_none()
    }

    /// Iterates once more, over residuals that rise, to the equilibrium that the step leads to. Soil beyond its limit may have another one, at another
    /// geometry, which is far away: many times as far as an elastic step. An iteration that goes there is given up.
    pub(super) fn iterate_near(&mut self) -> Result<()> {
        let elastic = self.elastic_way()?;
        self.restart();
        self.farthest = ASTRAY * elastic;
        (self.follows, self.strict, self.relaxed) = (true, !self.problem.scene.interfaces.is_empty(), 0);
        self.iterate()?;
        if self.way() < FAR * elastic { Ok(()) } else { Err(self.failure("another equilibrium")) }
    }

    /// The norm (m) of the displacements of an elastic step in which contact is stuck.
    fn elastic_way(&mut self) -> Result<f64> {
        self.restart();
        self.elastic = true;
        self.buffers.frozen = Frozen::Stuck;
        let solved = self.evaluate(true).and_then(|()| {
            self.problem.gaps(self.grid, &self.buffers.now.at, &mut self.buffers.gap);
            self.direction()
        });
        self.elastic = false;
        self.buffers.frozen = Frozen::Not;
        solved.map(|()| norm(&self.buffers.delta[..self.grid.dofs.displacements()]))
    }

    /// The norm (m) of the displacements since the step began.
    pub(super) fn way(&self) -> f64 {
        let (at, converged) = (&self.buffers.now.at.displacement, self.problem.converged());
        let square = |&n: &u32| (0..D).map(|d| (at[n as usize][d] - converged[n as usize][d]).powi(2)).sum::<f64>();
        self.grid.dofs.node.iter().map(square).sum::<f64>().sqrt()
    }
}
