//! A pressure on the whole boundary of the material, as the work it does in the material (paper §2.5): by the theorem of
//! Gauss, `−∮ p N_I n dS = −∫ (p ∇N_I + N_I ∇p) dV`, so that
//!
//! `R_I = Σ_p w_p J_p (p ∇_x N_I + N_I ∇p)` at the places of the points in the trial state.
//!
//! The weights are those of the internal force: material with the stress `−p 1` and the weight `∇p` is in balance to
//! rounding wherever its points lie and however jagged its surface. Where regions of the material meet, and where it
//! meets finite elements with the same pressure on them, it cancels; on a wall it presses on the support.
//! A pressure in space alone has a potential, and the tangent is symmetric.
//!
//! Water in the pores has the pressure `u` in space inside of the material, whose models answer for the effective stress `σ + u 1`: it takes
//! `u ∇_x N_I` away, and where it is the water outside nothing is left but the buoyancy `N_I ∇p`. Its volume is that of the soil and not
//! kept, so that the tangent is not symmetric.

use super::beyond::{Kept, scatter_functions};
use super::head::{Head, Momentary};
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
    /// What acts from outside in each phase.
    heads: Vec<Option<Head>>,
    /// What acts in the pores in each phase, and whether each material by number has such pores; both empty without.
    inside: Vec<Option<Head>>,
    porous: Vec<bool>,
    kinematics: PhantomData<K>,
}

impl<K> VirtualPressure<K> {
    /// `heads[i]` acts in phase `i`.
    pub fn new(heads: Vec<Option<Head>>) -> Self {
        Self { heads, inside: Vec::new(), porous: Vec::new(), kinematics: PhantomData }
    }

    /// With water in the pores: `inside[i]` in phase `i`, in material `m` ([`crate::points::Points::model_of`]) where `porous[m]`.
    pub fn with_pores(self, inside: Vec<Option<Head>>, porous: Vec<bool>) -> Self {
        Self { inside, porous, ..self }
    }
}

impl<const D: usize, K: Kinematics<D>> Term<D> for VirtualPressure<K> {
    fn role(&self) -> Role {
        Role::External
    }

    fn symmetric(&self) -> bool {
        self.inside.iter().all(Option::is_none)
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let [outside, inside] = [&self.heads, &self.inside]
            .map(|heads| heads.get(trial.phase).and_then(Option::as_ref).map(|head| head.at(trial.time)));
        if outside.is_none() && inside.is_none() {
            return Ok(());
        }
        let compute = |patch: &Patch, local: &mut Local, _: &mut [f64]| {
            let now = frame.stencil.gather(frame.mesh, patch, trial.between);
            let before = frame.stencil.gather(frame.mesh, patch, trial.converged);
            let nodes = frame.mesh.cells.nodes(patch.cell as usize);
            for entries in frame.stencil.entries::<K>(patch) {
                let height = |(n, &node): (&f64, &u32)| {
                    n * (frame.mesh.nodes[node as usize][1] + trial.between[node as usize][1])
                };
                let y = entries.value.iter().zip(nodes).map(height).sum();
                let at = |head: Option<Momentary>| head.map_or([0.0; 3], |head| head.at(y));
                let [p, slope, second] = at(outside);
                let porous = || self.porous.get(frame.points.model_of(entries.point)).copied().unwrap_or(false);
                let [u, growth, _] = at(inside.filter(|_| porous()));
                // What is left of the pressure in the material, and of its slope.
                let (left, left_slope) = (p - u, slope - growth);
                if [p, slope, u, growth] == [0.0; 4] {
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
                        local.vector[i * D + d] += volume * left * divergence[i][d];
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
                                let mut entry = left * (divergence[i][d] * divergence[j][e] - a.g[e] * b.g[d]);
                                if d == 0 && e == 0 {
                                    entry -= left * a.hoop * b.hoop;
                                }
                                if e == 1 {
                                    entry += left_slope * divergence[i][d] * value(j);
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
        scatter_functions(frame, Kept::Matrix, compute, out)
    }
}
