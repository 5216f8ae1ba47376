//! What soil that yields dissipates in a step, for the balance of energy (docs/theory.md, section 5).

use crate::material::{Model, spectral};
use crate::points::Points;
use crate::tensor::{Symmetric, Tensor, full, symmetric};

/// Weight of the end of a step in the stress whose work is told: with inertia that of the equations, else a half, the trapezoidal rule.
pub fn end_weight(alpha_f: f64) -> f64 {
    if alpha_f > 0.0 { 1.0 - alpha_f } else { 0.5 }
}

/// What a step dissipates (kPa) as point `p` yields, from its increment of deformation, the volume strain that its model has received in place of that,
/// and its elastic tensor at the end: the stress times the plastic strain, the stress that of the end with inertia, else the mean of both ends.
pub fn plastic<const D: usize>(
    points: &Points<D>,
    (p, model): (usize, &dyn Model),
    (increment, received, end): (&Tensor, Option<f64>, &Symmetric),
    alpha_f: f64,
) -> f64 {
    let (y, begin) = (points.seeded_height(p), &points.elastic[p]);
    let stress = |b: &Symmetric| full(&spectral::map_roots(b, |b| model.elastic_stress(y, &b.map(|b| 0.5 * b.ln()))));
    let strain = |b: &Symmetric| full(&spectral::map_roots(b, |b| b.map(|b| 0.5 * b.ln())));
    let trial = strain(&symmetric(&(increment * full(begin) * increment.transpose())));
    let mut plastic = trial - strain(end);
    if let Some(received) = received {
        let own = increment.determinant().ln();
        plastic += Tensor::identity() * ((received - own) / 3.0);
    }
    let mut acts = stress(end);
    if alpha_f == 0.0 {
        let stretch = symmetric(&(increment.transpose() * increment));
        let turn = increment * full(&spectral::map_roots(&stretch, |c| c.map(|c| 1.0 / c.sqrt())));
        acts = (acts + turn * stress(begin) * turn.transpose()) * 0.5;
    }
    acts.dot(&plastic)
}
