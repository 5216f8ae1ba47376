//! Energy from nowhere: where nothing but gravity acts from outside, the sum of kinetic, elastic and potential energy cannot grow, and a
//! solution in which it does is wrong, as in an impact with too large steps.

use super::warning::WARNING;
use crate::step::{Report, Scene, State};

/// How much the sum may grow (-) over the energy that is moved, and over the elastic one: what resets, and points that keep more elastic
/// energy than the grid sees, may add in a sound run.
const PARTS: [f64; 2] = [0.1, 0.01];

/// The energies (kJ) of a phase.
#[derive(Default)]
pub struct Energy {
    phase: Option<usize>,
    /// The least sum, and the potential energy, of its first step.
    first: [f64; 2],
    /// The largest kinetic energy, and change of the potential one.
    moved: f64,
    told: bool,
}

impl Energy {
    /// A warning after a step with inertia, one a phase. A run that is continued counts from there.
    pub fn found<const D: usize>(&mut self, scene: &Scene<D>, state: &State<D>, report: &Report<D>) -> Option<String> {
        let phase = scene.phases.get(state.phase).filter(|phase| phase.isolated && state.dynamic(scene))?;
        let sum = report.motion.kinetic + report.elastic + report.potential;
        if self.phase != Some(state.phase) {
            *self = Self { phase: Some(state.phase), first: [sum, report.potential], moved: 0.0, told: false };
        }
        let [first, potential] = self.first;
        self.moved = self.moved.max(report.motion.kinetic).max((report.potential - potential).abs());
        let grown = sum - first;
        if self.told || grown <= PARTS[0] * self.moved || grown <= PARTS[1] * report.elastic {
            return None;
        }
        self.told = true;
        Some(format!(
            "{WARNING}phase `{}`: at t = {:.4} s the sum of kinetic, elastic and potential energy has grown by {grown:.3e} kJ, {:.0} % of the energy \
             that is moved, and no load does work: the motion since then is wrong; take smaller steps (`step.max`) or more numerical damping \
             (`numerics: {{spectral_radius: 0.6}}`)",
            phase.name,
            state.time,
            100.0 * grown / self.moved
        ))
    }
}
