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

/// Work (kPa) that the stress of a model has to do in a step, and the part (-) of what lacks that is added; and their derivatives by the strain at
/// the end of the step.
pub struct Work {
    wanted: f64,
    wanted_rate: Tensor,
    part: f64,
    part_rate: Tensor,
}

/// The strain of a step, on the configuration as it begins and as it ends.
struct Step {
    start: Tensor,
    end: Tensor,
    /// `ΔF X ΔFᵀ` of that as the step begins: half the derivative of `X:X` by the strain at the end.
    forward: Tensor,
}

impl Step {
    fn of(increment: &Tensor) -> Self {
        let back = increment.try_inverse().unwrap_or_else(Tensor::identity);
        let start = (increment.transpose() * increment - Tensor::identity()) * 0.5;
        Self { end: back.transpose() * start * back, forward: increment * start * increment.transpose(), start }
    }
}

/// What the stress of the model of point `p` has to do, given its answer to the whole step: what the step adds to the stored energy, what yield
/// dissipates, and what the time integration dissipates by the weight `1 − α_f` of the end of the step. Where all of the strain is plastic, none:
/// there the stress of the mean metric is one that the soil bears.
pub fn work<const D: usize, K: Kinematics<D>>(
    points: &Points<D>,
    (p, model): (usize, &dyn Model),
    strained: &Strained,
    end: &Spatial<K::Tangent>,
    alpha_f: f64,
) -> Option<Work> {
    let (y, increment, begin) = (points.seeded_height(p), &strained.increment, &points.elastic[p]);
    let step = Step::of(increment);
    let stress = full(&end.kirchhoff);
    let energy = |b: &Symmetric| model.elastic_energy(y, &K::roots(b).map(|b| 0.5 * b.ln()));
    let bears = |b: &Symmetric| full(&spectral::map_roots(b, |b| model.elastic_stress(y, &b.map(|b| 0.5 * b.ln()))));
    let mut work = Work {
        wanted: energy(&end.elastic) - energy(begin),
        wanted_rate: stress,
        part: 1.0,
        part_rate: Tensor::zeros(),
    };
    if end.yielding {
        let trial = symmetric(&(increment * full(begin) * increment.transpose()));
        let moduli = [model.elasticity().at(y).shear, model.bulk_modulus(y, stress.trace() / 3.0)];
        work.yields::<D, K>(&step, moduli, (&trial, bears(&trial)), end);
        if work.part <= 0.0 {
            return None;
        }
    }
    let before = bears(begin);
    let grown = stress.dot(&step.end) - before.dot(&step.start);
    if grown > 0.0 {
        let share = 0.5 - alpha_f;
        work.wanted += share * grown;
        let of_end = K::contract(end, &symmetric(&step.end)) + stress;
        work.wanted_rate += (of_end - increment * before * increment.transpose()) * share;
    }
    Some(work)
}

impl Work {
    /// Adds what the end of a step dissipates by yield, and takes the part `(1 − r)²`, `r = |Δε_p|/|X|`. The plastic strain is that of a deviator that
    /// returns along itself, `Δε_p = Δe ŝ + ⅓ Δv 1` (`ŝ = s/|s|`): `Δe` is what the norm of the elastic deviator lacks of that of the trial strain.
    fn yields<const D: usize, K: Kinematics<D>>(
        &mut self,
        step: &Step,
        [shear, bulk]: [f64; 2],
        (trial, of_trial): (&Symmetric, Tensor),
        end: &Spatial<K::Tangent>,
    ) {
        let one = Tensor::identity();
        let (stress, of_trial) = (full(&end.kirchhoff), of_trial - one * (of_trial.trace() / 3.0));
        let mean = stress.trace() / 3.0;
        let deviator = stress - one * mean;
        let [along, along_trial] = [deviator, of_trial].map(|s| s.try_normalize(0.0).unwrap_or_else(Tensor::zeros));
        let sheared = (of_trial.norm() - deviator.norm()) / (2.0 * shear);
        let [volume, volume_trial] = [&end.elastic, trial].map(|b| 0.5 * full(b).determinant().ln());
        let swells = volume_trial - volume;
        // A:δτ of a tensor that is coaxial with the stress.
        let by_stress = |a: Tensor| K::contract(end, &symmetric(&a)) + a * stress * 2.0;

        let plastic = along * sheared + one * (swells / 3.0);
        self.wanted += stress.dot(&plastic);
        self.wanted_rate = along_trial * deviator.norm() + one * mean + by_stress(plastic);

        let square = step.start.norm_squared() + ROUNDING;
        let r = ((sheared * sheared + swells * swells / 3.0) / square).sqrt();
        let elastic = along * (sheared / (2.0 * shear)) + one * (swells / (9.0 * bulk));
        let grows = along_trial * sheared + one * (swells / 3.0) - by_stress(elastic) - step.forward * (r * r);
        let left = (1.0 - r).max(0.0);
        self.part = left * left;
        self.part_rate = if r > 0.0 { grows * (-2.0 * left / (r * square)) } else { Tensor::zeros() };
    }
}

/// The stress `A W` that acts in a step, and how it acts; its tangent takes the place of that of `τ_H` in `answer`. `of_stretch` is what its
/// volume changes of the stress of a model that has that of the step ([`Kinematics::stretched`]). `share` is the work of the shares of the stress that unknowns carry, and its derivative by the volume strain.
pub fn stress<const D: usize, K: Kinematics<D>>(
    strained: &Strained,
    alpha_f: f64,
    ((answer, field_strain), of_stretch): (&mut Answer<K, D>, Option<Symmetric>),
    work: Option<(&Work, [f64; 2])>,
) -> (Tensor, Acting) {
    let increment = &strained.increment;
    // Both have the determinant of what was found to be admissible.
    let [back, across] = [increment, &strained.metric_factor].map(|f| f.try_inverse().unwrap_or_else(Tensor::identity));
    let q = increment * across;
    K::convect(answer, &q);
    let unit = q * q.transpose();
    if let Some(field_strain) = field_strain {
        field_strain.convect(&q);
    } else if let Some(of_stretch) = of_stretch {
        // The volume of the model is that of the step, not that of the metric.
        let stress = symmetric(&(q * full(&of_stretch) * q.transpose()));
        K::add_product(&mut answer.tangent, 1.0, &stress, &symmetric(&(Tensor::identity() - unit)));
    }
    let end_weight = 1.0 - alpha_f;
    let through = Tensor::identity() * end_weight + back * alpha_f;
    let of_metric = answer.kirchhoff;
    let mut w = full(&of_metric);
    let (mut correction, mut strain) = (Tensor::zeros(), Tensor::zeros());
    if let Some((model, [share, by_volume])) = work {
        let step = Step::of(increment);
        let lacks = model.wanted + share - w.dot(&step.end);
        let square = step.start.norm_squared() + ROUNDING;
        let along = step.forward / square;
        let added = model.part * lacks;
        let rate = model.wanted_rate + Tensor::identity() * by_volume
            - K::contract(answer, &symmetric(&step.end)) * end_weight
            - w;
        let rate = rate * model.part + model.part_rate * lacks - along * (2.0 * added);
        let tangent = &mut answer.tangent;
        K::add_product(tangent, 1.0 / end_weight, &symmetric(&along), &symmetric(&rate));
        K::add_metric(tangent, added / (square * end_weight), &(increment * increment.transpose()));
        w += along * added;
        (correction, strain) = (along * model.part, step.end);
    }
    K::weight(&mut answer.tangent, &through, &of_metric, &w);
    (through * w, Acting { through, within: strained.within(), unit, correction, strain })
}
