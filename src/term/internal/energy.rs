//! The stress of a step with inertia that does the work which the point stores (docs/theory.md, section 5).
//!
//! The stress of the mean metric does so to third order in the strain of the step. What lacks is added along that strain, as the least change
//! of the stress (Gonzalez 2000): `S = S_α + X (E − S_α:X)/(X:X)`, `X = ½ (ΔFᵀΔF − 1)`, with the work `E` that is wanted.

use super::strain::Strained;
use crate::kinematics::Kinematics;
use crate::material::spatial::Spatial;
use crate::material::{Model, spectral};
use crate::points::Points;
use crate::tensor::{Symmetric, Tensor, full, symmetric};
use crate::term::mixed::{Acting, Answer};

/// Added to `X:X`, so that the correction of steps that hardly strain is that of their rounding (-).
const ROUNDING: f64 = 1e-10;

/// Work (kPa) that the stress of a model has to do in a step, and its derivative by the strain at the end of that.
pub struct Work {
    wanted: f64,
    rate: Tensor,
}

/// The strain of a step, on the configuration as it begins and as it ends.
struct Step {
    start: Tensor,
    end: Tensor,
}

impl Step {
    fn of(increment: &Tensor) -> Self {
        let back = increment.try_inverse().unwrap_or_else(Tensor::identity);
        let start = (increment.transpose() * increment - Tensor::identity()) * 0.5;
        Self { end: back.transpose() * start * back, start }
    }
}

/// What the stress of the model of point `p` has to do, given its answer to the whole step: what the step adds to the stored energy, and what the
/// time integration dissipates by the weight `1 − α_f` of the end of the step. None of soil that yields: the stress of the mean metric is one that it
/// bears.
pub fn work<const D: usize, K: Kinematics<D>>(
    points: &Points<D>,
    (p, model): (usize, &dyn Model),
    strained: &Strained,
    end: &Spatial<K::Tangent>,
    alpha_f: f64,
) -> Option<Work> {
    if end.yielding {
        return None;
    }
    let (y, increment, begin) = (points.seeded_height(p), &strained.increment, &points.elastic[p]);
    let roots = |b: &Symmetric| K::roots(b).map(|b| 0.5 * b.ln());
    let stress = full(&end.kirchhoff);
    let mut wanted = model.elastic_energy(y, &roots(&end.elastic)) - model.elastic_energy(y, &roots(begin));
    let mut rate = stress;
    let step = Step::of(increment);
    let before = full(&spectral::map_roots(begin, |b| model.elastic_stress(y, &b.map(|b| 0.5 * b.ln()))));
    let grown = stress.dot(&step.end) - before.dot(&step.start);
    if grown > 0.0 {
        let share = 0.5 - alpha_f;
        wanted += share * grown;
        rate += (K::contract(end, &symmetric(&step.end)) + stress - increment * before * increment.transpose()) * share;
    }
    Some(Work { wanted, rate })
}

/// The stress `A W` that acts in a step, and how it acts; its tangent takes the place of that of `τ_H` in `answer`. `share` is the work of the
/// shares of the stress that unknowns carry, and its derivative by the volume strain.
pub fn stress<const D: usize, K: Kinematics<D>>(
    strained: &Strained,
    alpha_f: f64,
    (answer, field_strain): &mut Answer<K, D>,
    work: Option<(&Work, [f64; 2])>,
) -> (Tensor, Acting) {
    let increment = &strained.increment;
    // Both have the determinant of what was found to be admissible.
    let [back, across] = [increment, &strained.metric_factor].map(|f| f.try_inverse().unwrap_or_else(Tensor::identity));
    let q = increment * across;
    K::convect(answer, &q);
    if let Some(field_strain) = field_strain {
        field_strain.convect(&q);
    }
    let end_weight = 1.0 - alpha_f;
    let through = Tensor::identity() * end_weight + back * alpha_f;
    let of_metric = answer.kirchhoff;
    let mut w = full(&of_metric);
    let (mut correction, mut strain) = (Tensor::zeros(), Tensor::zeros());
    if let Some((model, [share, by_volume])) = work {
        let step = Step::of(increment);
        let lacks = model.wanted + share - w.dot(&step.end);
        let forward = increment * step.start * increment.transpose();
        let square = step.start.norm_squared() + ROUNDING;
        let rate = model.rate + Tensor::identity() * by_volume
            - K::contract(answer, &symmetric(&step.end)) * end_weight
            - w
            - forward * (2.0 * lacks / square);
        (correction, strain) = (forward / square, step.end);
        let tangent = &mut answer.tangent;
        K::add_product(tangent, 1.0 / end_weight, &symmetric(&correction), &symmetric(&rate));
        K::add_metric(tangent, lacks / (square * end_weight), &(increment * increment.transpose()));
        w += correction * lacks;
    }
    K::weight(&mut answer.tangent, &through, &of_metric, &w);
    (through * w, Acting { through, within: strained.within(), unit: q * q.transpose(), correction, strain })
}
