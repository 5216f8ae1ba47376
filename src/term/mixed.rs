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

/// A point of a cell in a trial state.
#[derive(Clone, Copy)]
pub struct Point<'a, const D: usize> {
    pub points: &'a Points<D>,
    pub entries: &'a Entries<'a, D>,
    /// Of the end of the step.
    pub ratios: Ratios,
}

/// What the model of a point responds to within the step.
pub struct ModelInput<'a> {
    pub model: &'a dyn Model,
    /// Elastic trial left Cauchy–Green tensor (-).
    pub trial: Symmetric,
    pub state: State<'a>,
    /// Weight `1 − α_f` (-) of the end of the step.
    pub end_weight: f64,
}

/// The volume strain that the model of a point receives from unknowns in place of its own: (25b), linearised.
#[derive(Clone, Copy)]
pub struct FieldVolumeStrain {
    /// The measure of the volume strain that the unknowns stand for, `Δg(j_θ)/(1 − α_f)`, and its slope (1/kPa) in them, `g′²/H`.
    pub strain: f64,
    pub compliance: f64,
    /// Derivative (-) of the stress of the model with respect to them.
    pub stress: Tensor,
    /// The volume strain (-) that the model has received in the step.
    pub received: f64,
    /// Minus the derivative (-) of that measure with respect to the strain of the point.
    pub taken: Tensor,
}

impl FieldVolumeStrain {
    /// Transforms both tensors from one configuration to another, as a stress.
    pub fn convect(&mut self, q: &Tensor) {
        self.stress = q * self.stress * q.transpose();
        self.taken = q * self.taken * q.transpose();
    }
}

/// The answer of a model, and the volume strain that it receives.
pub type Answer<K, const D: usize> = (Spatial<<K as Kinematics<D>>::Tangent>, Option<FieldVolumeStrain>);

/// How what acts within a step on a point follows from a stress there (theory, eq. 8): the configuration at the end of the step is that of all tensors.
pub struct Acting {
    /// `A`: the tensor (-) through which the stress acts; unity without inertia.
    pub through: Tensor,
    /// Ratios of volumes by the metric within the step.
    pub within: Ratios,
    /// The unit stress of the metric within the step, `Q Qᵀ` (-).
    pub unit: Tensor,
    /// The correction of the stress for each unit of work (kPa) that the stress lacks, and the strain of the step `½ (1 − F⁻ᵀF⁻¹)` (-), by which
    /// the stress does its work.
    pub correction: Tensor,
    pub strain: Tensor,
}

impl Acting {
    /// Without inertia, at the end of the step.
    pub fn at_end(ratios: Ratios) -> Self {
        let (through, unit) = (Tensor::identity(), Tensor::identity());
        Self { through, within: ratios, unit, correction: Tensor::zeros(), strain: Tensor::zeros() }
    }

    /// What acts where a share has a stress of `slope` times the unit and has to do the work `work`.
    pub fn of_unit(&self, slope: f64, work: f64) -> Tensor {
        let stress = self.unit * slope;
        self.through * (stress + self.correction * (work - stress.dot(&self.strain)))
    }
}

/// What couples the unknowns of a share with the displacements at a point.
pub struct Coupling<'a, const D: usize> {
    /// The gradients on the deformed grid (1/m) that forces act through, and those that strains are taken with.
    pub forces: &'a [Gradient<D>],
    pub strains: &'a [Gradient<D>],
    /// The volume strain that the model receives from the unknowns.
    pub field_strain: Option<&'a FieldVolumeStrain>,
    pub acting: &'a Acting,
    /// Weight `1 − α_f` (-) of the end of the step.
    pub end_weight: f64,
}

/// A share of the stress of the points that unknowns of its own carry.
pub trait Mixed<const D: usize, K: Kinematics<D>>: Send + Sync {
    /// Its unknowns over a cell.
    type Cell;

    fn over(&self, frame: &Frame<D>, trial: &Trial<D>, cell_points: &CellPoints) -> Self::Cell;

    /// Whether within a step the model of a point has the volume of the step, not that of the mean metric: where its mean stress is its own.
    fn has_step_volume(&self, _points: &Points<D>, _p: usize) -> bool {
        true
    }

    /// The response of the model of a point to an elastic trial left Cauchy–Green tensor within the step, and the volume strain that it receives.
    /// The internal variables at the end of the step go into `internal`. `None` where the tensor is out of the range of the model.
    #[inline]
    fn respond(
        &self,
        _: &Self::Cell,
        point: &Point<D>,
        input: &ModelInput,
        internal: &mut [f64],
    ) -> Option<Answer<K, D>> {
        let y = point.points.seeded_height(point.entries.point);
        Some((K::respond(input.model, y, &input.trial, &input.state, internal)?, None))
    }

    /// The volume (-) at the end of the step over that at its beginning that the unknowns give a point, `before` being that at its beginning over that
    /// when the grid was restored; `None` where they do not determine it.
    #[inline]
    fn volume_ratio(&self, _: &Self::Cell, _: &Points<D>, _: &Entries<D>, _before: f64) -> Option<f64> {
        None
    }

    /// Adds the share within the step to the answer of the model there. The ratios of `point` are those within the step, `end_weight` is `1 − α_f`.
    fn add(&self, cell: &Self::Cell, point: &Point<D>, end_weight: f64, answer: &mut Spatial<K::Tangent>);

    /// The work (kPa) that the share does in the step, and its derivative by the volume strain at the end of that.
    fn work(&self, cell: &Self::Cell, point: &Point<D>, end_weight: f64) -> [f64; 2];

    /// Adds the equations of the unknowns and what couples them with the displacements to the end of `local`.
    fn couple(&self, cell: &Self::Cell, point: &Point<D>, coupling: &Coupling<D>, local: &mut Local);

    /// What water that flows through the pores of a point dissipates in the step (kJ), `end_weight` being that of its end in the pressure that does work.
    #[inline]
    fn seepage(&self, _: &Self::Cell, _: &Point<D>, _end_weight: f64) -> f64 {
        0.0
    }

    /// Completes what a point keeps.
    fn commit(&self, cell: &Self::Cell, point: &Point<D>, history: &mut History);

    /// Energy (kJ) stored at point `p`.
    fn energy(&self, points: &Points<D>, p: usize) -> f64;
}

/// No share: the models answer for the whole stress.
impl<const D: usize, K: Kinematics<D>> Mixed<D, K> for () {
    type Cell = ();

    #[inline]
    fn over(&self, _: &Frame<D>, _: &Trial<D>, _: &CellPoints) {}

    #[inline]
    fn add(&self, (): &(), _: &Point<D>, _: f64, _: &mut Spatial<K::Tangent>) {}

    #[inline]
    fn work(&self, (): &(), _: &Point<D>, _: f64) -> [f64; 2] {
        [0.0; 2]
    }

    #[inline]
    fn couple(&self, (): &(), _: &Point<D>, _: &Coupling<D>, _: &mut Local) {}

    #[inline]
    fn commit(&self, (): &(), _: &Point<D>, _: &mut History) {}

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

    fn has_step_volume(&self, points: &Points<D>, p: usize) -> bool {
        self.0.has_step_volume(points, p) && self.1.has_step_volume(points, p)
    }

    fn respond(
        &self,
        cell: &Self::Cell,
        point: &Point<D>,
        input: &ModelInput,
        internal: &mut [f64],
    ) -> Option<Answer<K, D>> {
        self.0.respond(&cell.0, point, input, internal)
    }

    fn volume_ratio(&self, cell: &Self::Cell, points: &Points<D>, entries: &Entries<D>, before: f64) -> Option<f64> {
        let other = || self.1.volume_ratio(&cell.1, points, entries, before);
        self.0.volume_ratio(&cell.0, points, entries, before).or_else(other)
    }

    fn add(&self, cell: &Self::Cell, point: &Point<D>, end_weight: f64, answer: &mut Spatial<K::Tangent>) {
        self.0.add(&cell.0, point, end_weight, answer);
        self.1.add(&cell.1, point, end_weight, answer);
    }

    fn work(&self, cell: &Self::Cell, point: &Point<D>, end_weight: f64) -> [f64; 2] {
        let (one, other) = (self.0.work(&cell.0, point, end_weight), self.1.work(&cell.1, point, end_weight));
        [one[0] + other[0], one[1] + other[1]]
    }

    fn couple(&self, cell: &Self::Cell, point: &Point<D>, coupling: &Coupling<D>, local: &mut Local) {
        self.0.couple(&cell.0, point, coupling, local);
        self.1.couple(&cell.1, point, coupling, local);
    }

    fn seepage(&self, cell: &Self::Cell, point: &Point<D>, end_weight: f64) -> f64 {
        self.0.seepage(&cell.0, point, end_weight) + self.1.seepage(&cell.1, point, end_weight)
    }

    fn commit(&self, cell: &Self::Cell, point: &Point<D>, history: &mut History) {
        self.0.commit(&cell.0, point, history);
        self.1.commit(&cell.1, point, history);
    }

    fn energy(&self, points: &Points<D>, p: usize) -> f64 {
        self.0.energy(points, p) + self.1.energy(points, p)
    }
}
