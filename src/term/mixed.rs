//! The share of the stress of the points that unknowns of its own carry: what the internal force asks of it.

use super::{Frame, History, Trial};
use crate::interpolation::{CellPoints, Entries};
use crate::kinematics::{Gradient, Kinematics};
use crate::material::spatial::Spatial;
use crate::material::{Model, State};
use crate::points::Points;
use crate::system::Local;
use crate::tensor::{Symmetric, Tensor};

/// Ratios of volumes (-) at a point.
#[derive(Clone, Copy)]
pub struct Ratios {
    /// To that at the last converged step, `ΔJ`.
    pub step: f64,
    /// To that when the grid was restored, `det Φ`.
    pub grid: f64,
}

/// A point within the step.
pub struct Within<'a> {
    pub model: &'a dyn Model,
    /// Elastic trial left Cauchy–Green tensor (-).
    pub trial: Symmetric,
    pub state: State<'a>,
    /// Of the end of the step.
    pub ratios: Ratios,
    /// Weight of the end of the step.
    pub later: f64,
}

/// What the model of a point sees of unknowns that tell it its volume.
#[derive(Clone, Copy)]
pub struct Seen {
    /// The measure of the volume strain that the unknowns stand for, and its slope (1/kPa) in them.
    pub strain: f64,
    pub compliance: f64,
    /// What they change of the stress of the model (-).
    pub stress: Tensor,
    /// What the strain of the point takes off that measure (-).
    pub taken: Tensor,
}

impl Seen {
    /// Takes it from one configuration to another as a stress.
    pub fn convect(&mut self, q: &Tensor) {
        self.stress = q * self.stress * q.transpose();
        self.taken = q * self.taken * q.transpose();
    }
}

/// The answer of a model, and what it sees of the share.
pub type Answer<K, const D: usize> = (Spatial<<K as Kinematics<D>>::Tangent>, Option<Seen>);

/// A share of the stress of the points that unknowns of its own carry.
pub trait Mixed<const D: usize, K: Kinematics<D>>: Send + Sync {
    /// Its unknowns over a cell.
    type Cell;

    fn over(&self, frame: &Frame<D>, trial: &Trial<D>, cell_points: &CellPoints) -> Self::Cell;

    /// The response of the model of a point to an elastic trial left Cauchy–Green tensor within the step, and what it sees of the share.
    /// The internal variables at the end of the step go into `internal`. `None` where the tensor is out of the range of the model.
    #[inline]
    fn respond(
        &self,
        _: &Self::Cell,
        points: &Points<D>,
        entries: &Entries<D>,
        at: &Within,
        internal: &mut [f64],
    ) -> Option<Answer<K, D>> {
        let y = points.seeded_height(entries.point);
        Some((K::respond(at.model, y, &at.trial, &at.state, internal)?, None))
    }

    /// Adds the share at the end of the step to the answer of the model, given the ratios of volumes, and returns that at its beginning (kPa,
    /// Kirchhoff).
    fn add(
        &self,
        cell: &Self::Cell,
        points: &Points<D>,
        entries: &Entries<D>,
        ratios: Ratios,
        answer: &mut Spatial<K::Tangent>,
    ) -> f64;

    /// Adds the equations of the unknowns and what couples them with the displacements to the end of `local`, given what the model sees of them,
    /// the gradients on the deformed grid that forces act through and those that strains are taken with, the ratios of volumes, the tensor through which the stress acts and the weight of the end
    /// of the step.
    #[expect(clippy::too_many_arguments, reason = "a point, and where it goes")]
    fn couple(
        &self,
        cell: &Self::Cell,
        points: &Points<D>,
        entries: &Entries<D>,
        gradients: [&[Gradient<D>]; 2],
        ratios: Ratios,
        seen: Option<&Seen>,
        acts_on: &Tensor,
        later: f64,
        local: &mut Local,
    );

    /// Completes what a point keeps.
    fn commit(
        &self,
        cell: &Self::Cell,
        points: &Points<D>,
        entries: &Entries<D>,
        ratios: Ratios,
        history: &mut History,
    );

    /// Energy (kJ) stored at point `p`.
    fn energy(&self, points: &Points<D>, p: usize) -> f64;
}

/// No share: the models answer for the whole stress.
impl<const D: usize, K: Kinematics<D>> Mixed<D, K> for () {
    type Cell = ();

    #[inline]
    fn over(&self, _: &Frame<D>, _: &Trial<D>, _: &CellPoints) {}

    #[inline]
    fn add(&self, (): &(), _: &Points<D>, _: &Entries<D>, _: Ratios, _: &mut Spatial<K::Tangent>) -> f64 {
        0.0
    }

    #[inline]
    fn couple(
        &self,
        (): &(),
        _: &Points<D>,
        _: &Entries<D>,
        _: [&[Gradient<D>]; 2],
        _: Ratios,
        _: Option<&Seen>,
        _: &Tensor,
        _: f64,
        _: &mut Local,
    ) {
    }

    #[inline]
    fn commit(&self, (): &(), _: &Points<D>, _: &Entries<D>, _: Ratios, _: &mut History) {}

    #[inline]
    fn energy(&self, _: &Points<D>, _: usize) -> f64 {
        0.0
    }
}

/// Two shares, side by side.
impl<const D: usize, K: Kinematics<D>, A: Mixed<D, K>, B: Mixed<D, K>> Mixed<D, K> for (A, B) {
    type Cell = (A::Cell, B::Cell);

    fn over(&self, frame: &Frame<D>, trial: &Trial<D>, cell_points: &CellPoints) -> Self::Cell {
        (self.0.over(frame, trial, cell_points), self.1.over(frame, trial, cell_points))
    }

    fn respond(
        &self,
        cell: &Self::Cell,
        points: &Points<D>,
        entries: &Entries<D>,
        at: &Within,
        internal: &mut [f64],
    ) -> Option<Answer<K, D>> {
        self.0.respond(&cell.0, points, entries, at, internal)
    }

    fn add(
        &self,
        cell: &Self::Cell,
        points: &Points<D>,
        entries: &Entries<D>,
        ratios: Ratios,
        answer: &mut Spatial<K::Tangent>,
    ) -> f64 {
        self.0.add(&cell.0, points, entries, ratios, answer) + self.1.add(&cell.1, points, entries, ratios, answer)
    }

    fn couple(
        &self,
        cell: &Self::Cell,
        points: &Points<D>,
        entries: &Entries<D>,
        gradients: [&[Gradient<D>]; 2],
        ratios: Ratios,
        seen: Option<&Seen>,
        acts_on: &Tensor,
        later: f64,
        local: &mut Local,
    ) {
        self.0.couple(&cell.0, points, entries, gradients, ratios, seen, acts_on, later, local);
        self.1.couple(&cell.1, points, entries, gradients, ratios, seen, acts_on, later, local);
    }

    fn commit(
        &self,
        cell: &Self::Cell,
        points: &Points<D>,
        entries: &Entries<D>,
        ratios: Ratios,
        history: &mut History,
    ) {
        self.0.commit(&cell.0, points, entries, ratios, history);
        self.1.commit(&cell.1, points, entries, ratios, history);
    }

    fn energy(&self, points: &Points<D>, p: usize) -> f64 {
        self.0.energy(points, p) + self.1.energy(points, p)
    }
}
