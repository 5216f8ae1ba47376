//! Weight of the material: `−Σ_q ρ_q w_q N_I g`, `g` in the phase's time, summed over the points that the internal force is summed over.
//!
//! It has the same points and weights as the internal force, so that errors of the quadrature cancel in equilibrium.

use super::{Assembly, Frame, Role, Source, Term, Trial, scatter_cells};
use crate::error::Result;
use crate::gravity::Gravity;
use crate::interpolation::CellPoints;
use crate::kinematics::Kinematics;
use crate::system::Local;
use std::marker::PhantomData;

/// Gravity on the material.
pub struct BodyForce<K, const D: usize> {
    /// That of each phase.
    gravity: Vec<Gravity<D>>,
    kinematics: PhantomData<K>,
}

impl<K, const D: usize> BodyForce<K, D> {
    /// `gravity[i]` acts in phase `i`.
    pub fn new(gravity: Vec<Gravity<D>>) -> Self {
        Self { gravity, kinematics: PhantomData }
    }
}

impl<const D: usize, K: Kinematics<D>> Term<D> for BodyForce<K, D> {
    fn source(&self) -> Source {
        Source::Gravity
    }

    fn role(&self) -> Role {
        Role::External
    }

    fn gravity(&self, phase: usize) -> Option<&Gravity<D>> {
        self.gravity.get(phase)
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let load = self.gravity[trial.phase].at(trial.time).map(|g| -g);
        scatter_cells(
            frame,
            |cell_points: &CellPoints, local: &mut Local| {
                for entries in frame.interpolation.entries::<K>(cell_points) {
                    let p = entries.point;
                    let mass = frame.points.mass[p] / frame.points.initial_volume[p] * entries.weight;
                    for (i, n) in entries.value.iter().enumerate() {
                        for d in 0..D {
                            local.vector[i * D + d] += mass * n * load[d];
                        }
                    }
                }
                Ok(())
            },
            &mut Assembly { force: out.force, tangent: None, workspace: out.workspace },
        )
    }
}
