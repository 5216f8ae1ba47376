//! Springs and dashpots under curves, to a ground that does not move: the traction `−k_n u_n`, `−k_t u_t` of an elastic foundation (Winkler) and, with
//! inertia, `−c_n v_n`, `−c_t v_t`, per area of the undeformed curve. With `c_n = ρ c_p`, `c_t = ρ c_s` it is that of soil that goes on beyond, and waves
//! leave (Lysmer & Kuhlemeyer 1969).
//!
//! Springs are free of force as the run begins. The velocity is that of the step, `Δu/Δt`: dashpots act between its ends as other loads do
//! (docs/theory.md, eq. 6), and take energy in every step.

use super::{Assembly, Frame, Role, Source, Term, Trial};
use crate::error::Result;
use std::sync::Arc;

/// What holds a node elastically and damps its motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Spring<const D: usize> {
    pub node: u32,
    /// Force for a displacement (kN/m), and for a velocity (kN s/m); symmetric.
    pub stiffness: [[f64; D]; D],
    pub damping: [[f64; D]; D],
}

impl<const D: usize> Spring<D> {
    /// The force (kN) that resists a displacement (m) and a velocity (m/s).
    pub fn resists(&self, displacement: &[f64; D], velocity: &[f64; D]) -> [f64; D] {
        let sum = |row: &[f64; D], by: &[f64; D]| row.iter().zip(by).map(|(a, b)| a * b).sum::<f64>();
        std::array::from_fn(|d| sum(&self.stiffness[d], displacement) + sum(&self.damping[d], velocity))
    }

    /// Whether it holds the node, and does not only damp its motion.
    pub fn is_elastic(&self) -> bool {
        self.stiffness.iter().flatten().any(|k| *k != 0.0)
    }
}

/// The force of springs and dashpots on the nodes.
pub struct Springs<const D: usize>(pub Arc<[Spring<D>]>);

impl<const D: usize> Term<D> for Springs<D> {
    fn role(&self) -> Role {
        Role::Restoring
    }

    fn source(&self) -> Source {
        Source::Load
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let rate = if trial.acceleration.is_empty() { 0.0 } else { trial.inverse_dt };
        for spring in &*self.0 {
            let n = spring.node as usize;
            let block = frame.block[n];
            if block == u32::MAX {
                continue;
            }
            let (travel, before) = (&frame.travel[n], &trial.converged[n]);
            let displacement = std::array::from_fn(|d| travel[d] + trial.between[n][d] - before[d]);
            let velocity = std::array::from_fn(|d| rate * (trial.displacement[n][d] - before[d]));
            let force = spring.resists(&displacement, &velocity);
            let first = frame.pattern.start[block as usize] as usize;
            (0..D).for_each(|d| out.force[first + d] += force[d]);
            if let Some(tangent) = &mut out.tangent {
                let slope =
                    |i: usize, j: usize| (1.0 - trial.alpha_f) * spring.stiffness[i][j] + rate * spring.damping[i][j];
                tangent.add_block(frame.pattern, first, D, slope);
            }
        }
        Ok(())
    }
}
