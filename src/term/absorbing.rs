//! Dashpots on boundaries that waves leave through (Lysmer & Kuhlemeyer 1969): the traction `−ρ c_p v_n`, `−ρ c_s v_t` of soil that goes on beyond, per
//! area of the undeformed boundary.
//!
//! The velocity is that of the step, `Δu/Δt`: the force acts between its ends as other loads do (docs/theory.md, eq. 6), and takes energy in every step.

use super::{Assembly, Frame, Role, Term, Trial};
use crate::error::Result;

/// The dashpots of all boundaries.
pub struct Absorbing<const D: usize> {
    /// Nodes with what they resist a velocity (kN s/m), by component.
    dampers: Vec<(u32, [f64; D])>,
    /// Whether they act in each phase.
    phases: Vec<bool>,
}

impl<const D: usize> Absorbing<D> {
    /// `dampers` at nodes, by component (kN s/m), in the phases where they act.
    pub fn new(dampers: Vec<(u32, [f64; D])>, phases: Vec<bool>) -> Self {
        Self { dampers, phases }
    }
}

impl<const D: usize> Term<D> for Absorbing<D> {
    fn role(&self) -> Role {
        Role::External
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        if !self.phases[trial.phase] || trial.acceleration.is_empty() {
            return Ok(());
        }
        for (n, damper) in &self.dampers {
            let (now, before) = (&trial.displacement[*n as usize], &trial.converged[*n as usize]);
            let block = frame.block[*n as usize];
            if block == u32::MAX {
                continue;
            }
            let first = frame.pattern.start[block as usize] as usize;
            for d in 0..D {
                let slope = damper[d] * trial.inverse_dt;
                out.force[first + d] += slope * (now[d] - before[d]);
                if let Some(tangent) = &mut out.tangent {
                    tangent.add_diagonal(frame.pattern, first + d, slope);
                }
            }
        }
        Ok(())
    }
}
