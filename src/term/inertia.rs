//! Inertia with the consistent mass of the integration points, or of the material points where integrals are summed over these: `Σ_q m_q N_I N_J a_J`.
//!
//! Row-summed masses are out of the question: the corner functions of a six-node triangle integrate to zero.

use super::{Assembly, Frame, Role, Term, Trial, scatter_cells};
use crate::error::Result;
use crate::interpolation::CellPoints;
use crate::kinematics::Kinematics;
use crate::system::Local;
use std::marker::PhantomData;

/// The inertia of the material.
#[derive(Default)]
pub struct Inertia<K> {
    kinematics: PhantomData<K>,
}

impl<const D: usize, K: Kinematics<D>> Term<D> for Inertia<K> {
    fn role(&self) -> Role {
        Role::Inertia
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let wanted = out.tangent.is_some();
        scatter_cells(
            frame,
            |cell_points: &CellPoints, local: &mut Local| {
                let nodes = frame.interpolation.nodes(frame.mesh, cell_points.cell);
                for entries in frame.interpolation.entries::<K>(cell_points) {
                    let mass = frame.points.mass[entries.point];
                    let mut a = [0.0; D];
                    for (n, &node) in entries.value.iter().zip(nodes) {
                        for d in 0..D {
                            a[d] += n * trial.acceleration[node as usize][d];
                        }
                    }
                    for (i, n) in entries.value.iter().enumerate() {
                        for d in 0..D {
                            local.vector[i * D + d] += mass * n * a[d];
                        }
                    }
                    if wanted {
                        add_mass::<D>(local, entries.value, mass * trial.acceleration_slope);
                    }
                }
                Ok(())
            },
            out,
        )
    }
}

/// Adds `m N_I N_J` for each displacement component.
fn add_mass<const D: usize>(local: &mut Local, n: &[f64], mass: f64) {
    for (i, ni) in n.iter().enumerate() {
        for (j, nj) in n.iter().enumerate() {
            for d in 0..D {
                local.matrix[(i * D + d) * local.size + j * D + d] += mass * ni * nj;
            }
        }
    }
}
