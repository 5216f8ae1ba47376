//! A pressure on the whole boundary of the material, as the work it does in the material (paper §2.5): by the theorem of
//! Gauss, `−∮ p N_I n dS = −∫ (p ∇N_I + N_I ∇p) dV`, so that
//!
//! `R_I = Σ_p w_p J_p (p ∇_x N_I + N_I ∇p)` at the places of the points in the trial state.
//!
//! The weights are those of the internal force: material with the stress `−p 1` and the weight `∇p` is in balance to
//! rounding wherever its points lie and however jagged its surface. Where regions of the material meet, and where it
//! meets finite elements with the same pressure on them, it cancels; on a wall it presses on the support.
//! A pressure in space alone has a potential, and the tangent is symmetric.

use super::beyond::scatter_functions;
use super::head::Head;
use super::{Assembly, Frame, Role, Term, Trial};
use crate::error::{Error, Result};
use crate::kinematics::{Gradient, Kinematics};
use crate::mesh::shape::MAX_NODES;
use crate::stencil::Patch;
use crate::system::Local;
use crate::tensor::Tensor;
use std::marker::PhantomData;

/// A pressure on the boundary of all material points.
pub struct VirtualPressure<K> {
    /// What acts in each phase.
    heads: Vec<Option<Head>>,
    kinematics: PhantomData<K>,
}

impl<K> VirtualPressure<K> {
    /// `heads[i]` acts in phase `i`.
    pub fn new(heads: Vec<Option<Head>>) -> Self {
        Self { heads, kinematics: PhantomData }
    }
}

impl<const D: usize, K: Kinematics<D>> Term<D> for VirtualPressure<K> {
    fn role(&self) -> Role {
        Role::External
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let Some(head) = self.heads.get(trial.phase).and_then(Option::as_ref) else { return Ok(()) };
        let head = head.at(trial.time);
        let compute = |patch: &Patch, local: &mut Local| {
            let now = frame.stencil.gather(frame.mesh, patch, trial.between);
            let before = frame.stencil.gather(frame.mesh, patch, trial.converged);
            let nodes = frame.mesh.cells.nodes(patch.cell as usize);
            for entries in frame.stencil.entries::<K>(patch) {
                let height = |(n, &node): (&f64, &u32)| {
                    n * (frame.mesh.nodes[node as usize][1] + trial.between[node as usize][1])
                };
                let [p, slope, second] = head.at(entries.value.iter().zip(nodes).map(height).sum());
                if p == 0.0 && slope == 0.0 {
                    continue;
                }
                let count = entries.functions();
                let (mut deformed, mut known) = (Tensor::identity(), Tensor::identity());
                for i in 0..count {
                    K::deform(&mut deformed, &now[i], &entries.gradient(i));
                    K::deform(&mut known, &before[i], &entries.gradient(i));
                }
                let inverse = deformed.try_inverse().filter(|_| deformed.determinant() > 0.0).ok_or_else(|| {
                    let what = format!("is turned inside out (det F {:.3})", deformed.determinant());
                    Error::analysis(
                        format!("material point {}", entries.point),
                        what,
                        "take smaller steps or refine the mesh",
                    )
                })?;
                let ratio = deformed.determinant() / known.determinant();
                let volume = entries.weight * ratio * frame.points.deformation[entries.point].determinant();
                let mut spatial = [Gradient { g: [0.0; D], hoop: 0.0 }; MAX_NODES];
                let mut divergence = [[0.0; D]; MAX_NODES];
                for i in 0..count {
                    spatial[i] = K::push_forward(&entries.gradient(i), &inverse);
                    divergence[i] = K::force(&Tensor::identity(), &spatial[i]);
                }
                let value = |i: usize| entries.value.get(i).copied().unwrap_or(0.0);
                for i in 0..count {
                    for d in 0..D {
                        local.vector[i * D + d] += volume * p * divergence[i][d];
                    }
                    local.vector[i * D + 1] += volume * slope * value(i);
                }
                if local.matrix.is_empty() {
                    continue;
                }
                let weight = (1.0 - trial.alpha_f) * volume;
                for i in 0..count {
                    for j in 0..count {
                        let (a, b, size) = (&spatial[i], &spatial[j], local.size);
                        for d in 0..D {
                            for e in 0..D {
                                let mut entry = p * (divergence[i][d] * divergence[j][e] - a.g[e] * b.g[d]);
                                if d == 0 && e == 0 {
                                    entry -= p * a.hoop * b.hoop;
                                }
                                if e == 1 {
                                    entry += slope * divergence[i][d] * value(j);
                                }
                                if d == 1 {
                                    entry += slope * value(i) * divergence[j][e];
                                }
                                if d == 1 && e == 1 {
                                    entry += second * value(i) * value(j);
                                }
                                local.matrix[(i * D + d) * size + j * D + e] += weight * entry;
                            }
                        }
                    }
                }
            }
            Ok(())
        };
        scatter_functions(frame, compute, out)
    }
}
