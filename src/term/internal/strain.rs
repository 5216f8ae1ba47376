//! The deformation of a point in a trial state, on the geometry of that or on one that is held.

use crate::error::{Error, Result};
use crate::interpolation::Entries;
use crate::kinematics::Kinematics;
use crate::points::Points;
use crate::tensor::{Tensor, exponential, full, symmetric};
use crate::term::Ratios;

/// Least ratio of volumes in one step that a trial state may have.
const LEAST_VOLUME_RATIO: f64 = 0.05;

/// The deformation of a point in a trial state.
pub struct Strained {
    /// Deformation since the last converged step.
    pub increment: Tensor,
    /// Inverse of the deformation since the grid was restored.
    pub inverse: Tensor,
    /// `H`: the deformation that the model responds to, [`Strained::increment`] without inertia.
    pub metric_factor: Tensor,
    pub ratios: Ratios,
}

impl Strained {
    /// Stretches the point so that its volume has these ratios.
    pub fn take_volume<const D: usize, K: Kinematics<D>>(&mut self, ratios: Ratios) {
        K::stretch(&mut self.increment, ratios.step / self.ratios.step);
        self.metric_factor = self.increment;
        self.ratios = ratios;
    }

    /// `H̃`: the metric factor with the volume `ΔJ^w` at the weight `w` of the end of the step. The mean of two metrics has a larger one, by the square
    /// of the shear between them.
    pub fn with_volume<const D: usize, K: Kinematics<D>>(&self, end_weight: f64) -> Tensor {
        let mut factor = self.metric_factor;
        let ratio = self.ratios.step.powf(end_weight) / factor.determinant();
        K::stretch(&mut factor, ratio);
        factor
    }

    /// Ratios of volumes by the metric within the step.
    pub fn within(&self) -> Ratios {
        let step = self.metric_factor.determinant();
        Ratios { step, grid: self.ratios.grid / self.ratios.step * step }
    }
}

/// A factor `H` of the metric within the step, `HᵀH = (1 − α_f) ΔFᵀΔF + α_f I`.
#[inline]
pub fn metric_factor(increment: &Tensor, alpha_f: f64) -> Option<Tensor> {
    let metric = increment.transpose() * increment * (1.0 - alpha_f) + Tensor::from_diagonal_element(alpha_f);
    metric.cholesky().map(|factor| factor.l().transpose())
}

/// The displacements (m) of the functions of a cell.
pub struct Ends<'a, const D: usize> {
    pub now: &'a [[f64; D]],
    /// At the last converged step, `None` for all zero.
    pub before: Option<&'a [[f64; D]]>,
    /// Those whose geometry is held, where it is; none where they are all zero.
    pub held: Option<&'a [[f64; D]]>,
}

/// The displacements, or none where all are zero.
pub fn moved_nodes<const D: usize>(u: &[[f64; D]]) -> &[[f64; D]] {
    if u.iter().flatten().any(|&u| u != 0.0) { u } else { &[] }
}

/// The deformation of a point.
#[inline]
pub fn strain<const D: usize, K: Kinematics<D>>(
    points: &Points<D>,
    entries: &Entries<D>,
    ends: &Ends<D>,
) -> Result<Strained> {
    if let Some(held) = ends.held {
        return linear_strain::<D, K>(points, entries, ends, held);
    }
    let p = entries.point;
    let now = entries.deformation::<K>(ends.now);
    let inverse = now.try_inverse().ok_or_else(|| inadmissible(points, p, "is squeezed flat", &now))?;
    let increment = match ends.before {
        None => now,
        Some(converged) => {
            let before = entries.deformation::<K>(converged);
            now * before.try_inverse().ok_or_else(|| inadmissible(points, p, "was squeezed flat", &before))?
        }
    };
    let ratios = Ratios { step: increment.determinant(), grid: now.determinant() };
    if !(ratios.step > LEAST_VOLUME_RATIO && ratios.grid > 0.0) {
        let what = if ratios.step > 0.0 && ratios.grid > 0.0 {
            format!("is compressed to {:.1} % of its volume in one step", 100.0 * ratios.step)
        } else {
            "is turned inside out".into()
        };
        return Err(inadmissible(points, p, &what, &increment));
    }
    Ok(Strained { increment, inverse, metric_factor: increment, ratios })
}

/// The deformation of a point on the geometry of the displacements `held`: the exponential of the symmetric gradient there of what was
/// displaced in the step (docs/theory.md, section 9, *Strength reduction*).
fn linear_strain<const D: usize, K: Kinematics<D>>(
    points: &Points<D>,
    entries: &Entries<D>,
    ends: &Ends<D>,
    held: &[[f64; D]],
) -> Result<Strained> {
    let p = entries.point;
    let [start, now] = [held, ends.now].map(|u| entries.deformation::<K>(u));
    let before = ends.before.map_or_else(Tensor::identity, |u| entries.deformation::<K>(u));
    let inverse = start.try_inverse().ok_or_else(|| inadmissible(points, p, "was squeezed flat", &start))?;
    let strain = full(&symmetric(&((now - before) * inverse)));
    let since = ((now - start) * inverse).trace();
    let increment = exponential(&strain);
    let ratios = Ratios { step: strain.trace().exp(), grid: start.determinant() * since.exp() };
    if !(ratios.step > LEAST_VOLUME_RATIO && ratios.grid > 0.0 && increment.iter().all(|f| f.is_finite())) {
        return Err(inadmissible(points, p, "is strained beyond measure in one step", &increment));
    }
    Ok(Strained { increment, inverse, metric_factor: increment, ratios })
}

#[cold]
pub fn inadmissible<const D: usize>(points: &Points<D>, p: usize, what: &str, deformation: &Tensor) -> Error {
    Error::analysis(
        format!("the material at {:.3?} m", points.position[p]),
        format!("{what} (det F {:.3})", deformation.determinant()),
        "take smaller steps; where these do not help, finer cells there do, or a grid that is reset sooner (numerics.restore)",
    )
}
