//! A soft linear stiffness in empty and partly empty cells, so that nodes without material points neither
//! make the system singular nor change its pattern (paper §2.4; Coombs 2023 uses the same kind of penalty).
//!
//! `ε E (1 − fill) ∫ ∇ˢN_I : ∇ˢ(u − u_n)`: linear elasticity with Poisson's ratio zero on the increment of
//! the step. It is free of stress at the beginning of every step, and of order `ε` in its end.

use super::{Assembly, Frame, Term, Trial};
use crate::error::Result;
use crate::kinematics::Kinematics;
use crate::mesh::shape::MAX_NODES;
use crate::stencil::{SoftCell, integrate};
use crate::system::{Local, scatter};
use std::marker::PhantomData;

/// The soft stiffness of the cells that are not full.
pub struct EmptyCells<K> {
    /// `ε E` (kPa).
    stiffness: f64,
    kinematics: PhantomData<K>,
}

impl<K> EmptyCells<K> {
    /// `stiffness` is that of an empty cell (kPa).
    pub fn new(stiffness: f64) -> Self {
        Self { stiffness, kinematics: PhantomData }
    }
}

impl<const D: usize, K: Kinematics<D>> Term<D> for EmptyCells<K> {
    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let wanted = out.tangent.is_some();
        let compute = |soft: &SoftCell, local: &mut Local| {
            let nodes = frame.mesh.cells.nodes(soft.cell as usize);
            let mut u = [[0.0; D]; MAX_NODES];
            for (u, &n) in u.iter_mut().zip(nodes) {
                for d in 0..D {
                    u[d] = trial.between[n as usize][d] - trial.converged[n as usize][d];
                }
            }
            let size = local.size;
            integrate::<D, K>(frame.mesh, soft.cell as usize, |weight, _, g| {
                let w = 0.5 * self.stiffness * soft.emptiness * weight;
                for a in 0..g.len() {
                    for b in 0..g.len() {
                        let dot: f64 = (0..D).map(|d| g[a][d] * g[b][d]).sum();
                        for i in 0..D {
                            for k in 0..D {
                                // ∇ˢN_a : ∇ˢN_b = ½ (δ_ik g_a·g_b + g_a,k g_b,i)
                                let entry = w * (if i == k { dot } else { 0.0 } + g[a][k] * g[b][i]);
                                local.vector[a * D + i] += entry * u[b][k];
                                if wanted {
                                    local.matrix[(a * D + i) * size + b * D + k] += (1.0 - trial.alpha_f) * entry;
                                }
                            }
                        }
                    }
                }
            });
            Ok(())
        };
        scatter(
            frame.pattern,
            frame.soft,
            |soft| frame.clique[soft.cell as usize] as usize,
            compute,
            out.force,
            out.tangent.as_deref_mut(),
            out.workspace,
        )
    }
}
