//! Internal force of the material points: `f_I = Σ_p V⁰_p τ_p · ∇_x N_I`, with its consistent tangent.
//!
//! Kinematics: `F = I + Σ u ⊗ ∇N` from the restored grid, the increment since the last converged step
//! `ΔF = F F_n⁻¹`, the elastic trial `b = ΔF b_n ΔFᵀ` (theory, eq. 3–5). The term keeps no state: the points
//! carry it, and it is written only on convergence.
//!
//! With inertia the stresses of both ends of the step act on the configuration between them: in place of `τ`
//! stands `A W`, `A = (1 − α_f) I + α_f ΔF⁻¹`, `W = (1 − α_f) τ + α_f ΔF τ_n ΔFᵀ`. `A W Aᵀ` being symmetric,
//! the forces have no moment about the positions in between, where the trapezoidal rule needs it.

use super::{Assembly, Frame, Term, Trial, Update};
use crate::error::{Error, Result};
use crate::kinematics::{Gradient, Kinematics};
use crate::material::spatial::Spatial;
use crate::material::{Model, State};
use crate::mesh::shape::MAX_NODES;
use crate::points::Points;
use crate::stencil::{Entries, Patch};
use crate::system::{Local, scatter};
use crate::tensor::{Symmetric, Tensor, full, symmetric};
use rayon::prelude::*;
use std::marker::PhantomData;
use std::sync::Arc;

/// Least ratio of volumes in one step that a trial state may have.
const LEAST_VOLUME_RATIO: f64 = 0.05;

/// The internal force of all material points.
pub struct Internal<K> {
    /// The model of each region of the mesh; `None` where a region holds no points.
    models: Vec<Option<Arc<dyn Model>>>,
    /// Whether the scene has dynamic phases.
    dynamic: bool,
    kinematics: PhantomData<K>,
}

/// A point in a trial state.
struct Strained<T> {
    /// Deformation since the last converged step.
    increment: Tensor,
    /// Inverse of the deformation since the grid was restored.
    inverse: Tensor,
    answer: Spatial<T>,
}

impl<T> Strained<T> {
    /// The stress `A W` that acts in the step, and its tangent in place of that of `τ`.
    fn weighted_stress<const D: usize, K>(&mut self, points: &Points<D>, p: usize, alpha_f: f64) -> Result<Tensor>
    where
        K: Kinematics<D, Tangent = T>,
    {
        let kirchhoff = full(&self.answer.kirchhoff);
        if alpha_f == 0.0 {
            return Ok(kirchhoff);
        }
        let back = self
            .increment
            .try_inverse()
            .ok_or_else(|| Error::analysis(format!("material point {p}"), "is squeezed flat", "take smaller steps"))?;
        let before = full(&points.stress[p]) * points.deformation[p].determinant();
        let a = Tensor::identity() * (1.0 - alpha_f) + back * alpha_f;
        let w = kirchhoff * (1.0 - alpha_f) + self.increment * before * self.increment.transpose() * alpha_f;
        K::weight(&mut self.answer.tangent, &a, &self.answer.kirchhoff, &w);
        Ok(a * w)
    }
}

impl<K> Internal<K> {
    /// `models[r]` is the model of the points of region `r`; `dynamic` where any phase is.
    pub fn new(models: Vec<Option<Arc<dyn Model>>>, dynamic: bool) -> Self {
        Self { models, dynamic, kinematics: PhantomData }
    }

    fn strain<const D: usize>(
        &self,
        points: &Points<D>,
        entries: &Entries<D>,
        trial: &[[f64; D]],
        converged: &[[f64; D]],
    ) -> Result<Strained<K::Tangent>>
    where
        K: Kinematics<D>,
    {
        let p = entries.point;
        let (mut now, mut before) = (Tensor::identity(), Tensor::identity());
        for i in 0..entries.value.len() {
            let gradient = entries.gradient(i);
            K::deform(&mut now, &trial[i], &gradient);
            K::deform(&mut before, &converged[i], &gradient);
        }
        let inverted = |what: &str| {
            Error::analysis(
                format!("material point {p}"),
                format!("{what} (det F of the step {:.3})", now.determinant() / before.determinant()),
                "take smaller steps or refine the mesh",
            )
        };
        let inverse = now.try_inverse().ok_or_else(|| inverted("is squeezed flat"))?;
        let increment = now * before.try_inverse().ok_or_else(|| inverted("was squeezed flat"))?;
        if !(increment.determinant() > LEAST_VOLUME_RATIO && now.determinant() > 0.0) {
            return Err(inverted("is turned inside out"));
        }
        let elastic = symmetric(&(increment * full(&points.elastic[p]) * increment.transpose()));
        let Some(model) = self.models.get(points.region[p] as usize).and_then(Option::as_ref) else {
            return Err(Error::analysis(format!("material point {p}"), "its region has no material", ""));
        };
        let state = State { plastic_strain: points.plastic_strain[p] };
        let answer = K::respond(model.as_ref(), points.origin[p][1], &elastic, &state)
            .ok_or_else(|| inverted("is strained beyond measure"))?;
        Ok(Strained { increment, inverse, answer })
    }
}

/// Copies the nodal vectors of a patch.
fn gather<const D: usize>(frame: &Frame<D>, patch: &Patch, field: &[[f64; D]]) -> [[f64; D]; MAX_NODES] {
    let mut local = [[0.0; D]; MAX_NODES];
    for (local, &n) in local.iter_mut().zip(frame.mesh.cells.nodes(patch.cell as usize)) {
        *local = field[n as usize];
    }
    local
}

impl<const D: usize, K: Kinematics<D>> Term<D> for Internal<K> {
    fn symmetric(&self) -> bool {
        !self.dynamic && self.models.iter().flatten().all(|m| m.symmetric())
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let wanted = out.tangent.is_some();
        let symmetric = frame.pattern.symmetric;
        let compute = |patch: &Patch, local: &mut Local| {
            let now = gather(frame, patch, trial.displacement);
            let before = gather(frame, patch, trial.converged);
            let count = patch.node_count as usize;
            for entries in frame.stencil.entries::<K>(patch) {
                let mut point = self.strain(frame.points, &entries, &now, &before)?;
                let stress = point.weighted_stress::<D, K>(frame.points, entries.point, trial.alpha_f)?;
                let volume = frame.points.initial_volume[entries.point];
                let mut spatial = [Gradient { g: [0.0; D], hoop: 0.0 }; MAX_NODES];
                for i in 0..count {
                    spatial[i] = K::push_forward(&entries.gradient(i), &point.inverse);
                    let f = K::force(&stress, &spatial[i]);
                    for d in 0..D {
                        local.vector[i * D + d] += volume * f[d];
                    }
                }
                if wanted {
                    let weight = (1.0 - trial.alpha_f) * volume;
                    add_stiffness::<D, K>(local, &point.answer.tangent, &spatial[..count], weight, symmetric);
                }
            }
            if wanted && symmetric {
                mirror::<D>(local, count);
            }
            Ok(())
        };
        scatter(
            frame.pattern,
            &frame.stencil.patches,
            |patch| frame.clique[patch.cell as usize] as usize,
            compute,
            out.force,
            out.tangent.as_deref_mut(),
            out.workspace,
        )
    }

    fn energy(&self, points: &Points<D>) -> f64 {
        let energy = |p: usize| {
            let Some(model) = self.models.get(points.region[p] as usize).and_then(Option::as_ref) else { return 0.0 };
            let strain = K::roots(&points.elastic[p]).map(|b| 0.5 * b.ln());
            let stress = model.elasticity().at(points.origin[p][1]).stress(&strain);
            0.5 * points.initial_volume[p] * stress.iter().zip(&strain).map(|(t, e)| t * e).sum::<f64>()
        };
        // In order, so that the sum does not depend on the number of threads.
        (0..points.len()).into_par_iter().map(energy).collect::<Vec<f64>>().iter().sum()
    }

    fn commit(&self, frame: &Frame<D>, trial: &Trial<D>) -> Result<Option<Update>> {
        type New = (usize, Tensor, Symmetric, Symmetric, f64);
        let by_patch: Vec<Vec<New>> = frame
            .stencil
            .patches
            .par_iter()
            .map(|patch| {
                let now = gather(frame, patch, trial.displacement);
                let before = gather(frame, patch, trial.converged);
                let new = |entries: Entries<D>| {
                    let point = self.strain(frame.points, &entries, &now, &before)?;
                    let deformation = point.increment * frame.points.deformation[entries.point];
                    let volume_ratio = deformation.determinant();
                    let stress = point.answer.kirchhoff.map(|t| t / volume_ratio);
                    let plastic_strain = point.answer.state.plastic_strain;
                    Ok((entries.point, deformation, point.answer.elastic, stress, plastic_strain))
                };
                frame.stencil.entries::<K>(patch).map(new).collect::<Result<Vec<New>>>()
            })
            .collect::<Result<_>>()?;
        let points = frame.points;
        let mut update = Update {
            deformation: points.deformation.clone(),
            elastic: points.elastic.clone(),
            stress: points.stress.clone(),
            plastic_strain: points.plastic_strain.clone(),
        };
        for (p, deformation, elastic, stress, plastic_strain) in by_patch.into_iter().flatten() {
            update.deformation[p] = deformation;
            update.elastic[p] = elastic;
            update.stress[p] = stress;
            update.plastic_strain[p] = plastic_strain;
        }
        Ok(Some(update))
    }
}

/// Adds the stiffness of one point; of a symmetric one only the lower triangle of blocks.
fn add_stiffness<const D: usize, K: Kinematics<D>>(
    local: &mut Local,
    tangent: &K::Tangent,
    spatial: &[Gradient<D>],
    weight: f64,
    symmetric: bool,
) {
    for (b, gb) in spatial.iter().enumerate() {
        let column = K::column(tangent, gb);
        for (a, ga) in spatial.iter().enumerate().skip(if symmetric { b } else { 0 }) {
            let block = K::block(&column, ga);
            for i in 0..D {
                for k in 0..D {
                    local.matrix[(a * D + i) * local.size + b * D + k] += weight * block[i][k];
                }
            }
        }
    }
}

/// Copies the lower triangle of blocks to the upper one: cliques are not in the order of equations.
fn mirror<const D: usize>(local: &mut Local, count: usize) {
    for a in 0..count * D {
        for b in a + 1..count * D {
            local.matrix[a * local.size + b] = local.matrix[b * local.size + a];
        }
    }
}
