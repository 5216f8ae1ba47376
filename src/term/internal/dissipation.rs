//! What soil that yields dissipates in a step, for the balance of energy (docs/theory.md, section 5).

use crate::material::{Model, spectral};
use crate::points::Points;
use crate::tensor::{Symmetric, Tensor, full, symmetric};

/// Weight of the end of a step in the stress whose work is told: with inertia that of the equations, else a half, the trapezoidal rule.
pub fn end_weight(alpha_f: f64) -> f64 {
    if alpha_f > 0.0 { 1.0 - alpha_f } else { 0.5 }
}

/// A step of a point that yields.
pub struct Yielded<'a> {
    pub model: &'a dyn Model,
    /// Increment of deformation (-), and the volume strain that the model has received in place of that of it.
    pub increment: &'a Tensor,
    pub received: Option<f64>,
    /// Elastic left Cauchy–Green tensor (-) at the end.
    pub end: &'a Symmetric,
    /// With inertia, the metric factor `H` and that tensor of the stress within the step.
    pub within: Option<(&'a Tensor, &'a Symmetric)>,
}

impl Yielded<'_> {
    /// What point `p` dissipates (kPa): the stress that acts times the plastic strain of the step. With inertia that is the stress within the step,
    /// else the mean of those at its ends.
    pub fn dissipates<const D: usize>(&self, points: &Points<D>, p: usize) -> f64 {
        let Self { model, increment, received, end, within } = *self;
        let (y, begin) = (points.seeded_height(p), &points.elastic[p]);
        let hencky = |b: &[f64; 3]| b.map(|b| 0.5 * b.ln());
        let stress = |b: &Symmetric| full(&spectral::map_roots(b, |b| model.elastic_stress(y, &hencky(b))));
        let strain = |b: &Symmetric| full(&spectral::map_roots(b, hencky));
        let trial = symmetric(&(increment * full(begin) * increment.transpose()));
        let mut plastic = strain(&trial) - strain(end);
        if let Some(received) = received {
            plastic += Tensor::identity() * ((received - increment.determinant().ln()) / 3.0);
        }
        let acts = match within {
            Some((factor, elastic)) => {
                let q = increment * factor.try_inverse().unwrap_or_else(Tensor::identity);
                q * stress(elastic) * q.transpose()
            }
            None => {
                let metric = symmetric(&(increment.transpose() * increment));
                let turn = increment * full(&spectral::map_roots(&metric, |c| c.map(|c| 1.0 / c.sqrt())));
                (stress(end) + turn * stress(begin) * turn.transpose()) * 0.5
            }
        };
        acts.dot(&plastic)
    }
}
