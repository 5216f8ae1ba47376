//! From the elastic trial left Cauchy–Green tensor to Kirchhoff stress and spatial tangent for models of the strain tensor, with
//! tensors among their internal variables.
//!
//! With the deformation of the step `ΔF = V R`, tensors `β` turn by `R` as a step begins: `R β Rᵀ`. What is added to them in the step is the
//! model's business. The trial strain is `ε = ½ ln b`. Both turn with the body, and so does the stress of a model that is isotropic in both.
//!
//! A gradient `l = δΔF ΔF⁻¹` changes `b` by `l b + b lᵀ`, and `ε` in the axes of `b` by `δε_AB = g_AB δb_AB`,
//! `g_AB = (ε_A − ε_B)/(λ_A − λ_B)`; it spins `R` by `ω`, `δR = ω R`, the skew solution of `ω V + V ω = l V − V lᵀ`. A spin of strain and
//! tensors together spins the stress; so
//!
//! ```text
//! δτ = D : (δε − ω ε + ε ω) + ω τ − τ ω,    a_ijkl l_kl = δτ_ij − τ_il l_jl
//! ```
//!
//! (Simo & Hughes, *Computational Inelasticity*, 1998, §8.3, on incrementally objective updates; the rotation is that of the polar
//! decomposition.) Where no tensor turns `ω` is left out, as it makes no difference.

use super::model::{SolidTangent, Spatial};
use super::{State, TensorModel, TensorResponse, VariableKind, spectral};
use crate::tensor::{Symmetric, Tensor, full, symmetric};
use nalgebra::Vector3;

/// The response of a model, `internal` being the internal variables as the step begins and then those at its end.
pub fn respond(
    model: &dyn TensorModel,
    y: f64,
    trial: &Symmetric,
    state: &State,
    internal: &mut [f64],
) -> Option<Spatial<SolidTangent>> {
    if !trial.iter().all(|x| x.is_finite()) {
        return None;
    }
    let (roots, axes) = spectral::axes(trial);
    if !roots.iter().all(|&x| x > 0.0) {
        return None;
    }
    let logs = roots.map(|x| 0.5 * x.ln());
    let strain = spectral::compose(&logs, &axes);
    let tensors = model.internal_variables().iter().any(|variable| variable.kind == VariableKind::Tensor);
    let stretch = state.increment.filter(|_| tensors).map(|increment| turn(model, increment, internal));

    let r = model.respond(y, &strain, state, internal);
    let elastic =
        if r.yielding { spectral::map_roots(&r.elastic_strain, |e| e.map(|e| (2.0 * e).exp())) } else { *trial };
    let (b, epsilon, tau) = (full(trial), full(&strain), full(&r.stress));
    let mut tangent = [[0.0; 9]; 9];
    for column in 0..9 {
        let (k, l) = (column / 3, column % 3);
        let mut gradient = Tensor::zeros();
        gradient[(k, l)] = 1.0;
        let of_axes = axes.transpose() * (gradient * b + b * gradient.transpose()) * axes;
        let weighted = Tensor::from_fn(|i, j| {
            let (sum, difference) = (roots[i] + roots[j], roots[i] - roots[j]);
            of_axes[(i, j)] * spectral::half_log_ratio(difference / sum, logs[i] - logs[j]) / sum
        });
        let change = axes * weighted * axes.transpose();
        let stress = match &stretch {
            None => of_strain(&r, &change),
            Some(stretch) => {
                let spin = stretch.spin(&gradient);
                of_strain(&r, &(change - spin * epsilon + epsilon * spin)) + spin * tau - tau * spin
            }
        };
        for i in 0..3 {
            for j in 0..3 {
                let carried = if j == k { tau[(i, l)] } else { 0.0 };
                tangent[3 * i + j][column] = stress[(i, j)] - carried;
            }
        }
    }
    let TensorResponse { stress: kirchhoff, plastic_strain, yielding, .. } = r;
    Some(Spatial { kirchhoff, elastic, tangent, plastic_strain, yielding })
}

/// The left stretch `V` of a step.
struct Stretch {
    itself: Tensor,
    /// `(tr V − V)⁻¹`.
    inverse: Tensor,
}

/// Turns the tensors among the internal variables with a deformation; returns its left stretch.
fn turn(model: &dyn TensorModel, increment: &Tensor, internal: &mut [f64]) -> Stretch {
    let square = symmetric(&(increment * increment.transpose()));
    let [stretch, inverse] =
        [1.0, -1.0].map(|sign| full(&spectral::map_roots(&square, |roots| roots.map(|root| root.sqrt().powf(sign)))));
    let rotation = inverse * increment;
    let mut left = internal;
    for variable in model.internal_variables() {
        let (own, rest) = left.split_at_mut(variable.components());
        if let ([xx, yy, zz, xy, yz, xz], VariableKind::Tensor) = (&*own, variable.kind) {
            let tensor = full(&[*xx, *yy, *zz, *xy, *yz, *xz]);
            own.copy_from_slice(&symmetric(&(rotation * tensor * rotation.transpose())));
        }
        left = rest;
    }
    // It is positive definite, as the stretch is.
    let of_axis = Tensor::from_diagonal_element(stretch.trace()) - stretch;
    Stretch { itself: stretch, inverse: of_axis.try_inverse().unwrap_or_else(Tensor::zeros) }
}

/// `D : δε`.
fn of_strain(r: &TensorResponse, change: &Tensor) -> Tensor {
    let change = symmetric(change);
    full(&std::array::from_fn(|a| {
        let [xx, yy, zz, xy, yz, xz] = r.tangent[a];
        let normal = xx * change[0] + yy * change[1] + zz * change[2];
        normal + 2.0 * (xy * change[3] + yz * change[4] + xz * change[5])
    }))
}

impl Stretch {
    /// `ω` of a gradient, by its axial vector: `(tr V − V) ω = axial(l V − V lᵀ)`.
    fn spin(&self, gradient: &Tensor) -> Tensor {
        let right = gradient * self.itself - self.itself * gradient.transpose();
        (self.inverse * Vector3::new(right[(2, 1)], right[(0, 2)], right[(1, 0)])).cross_matrix()
    }
}
