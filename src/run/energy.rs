//! Energy from nowhere: where nothing but gravity acts from outside, the sum of kinetic, elastic and potential energy cannot grow, and a
//! solution in which it does is wrong, as in an impact with too large steps.

use super::warning::WARNING;
use crate::step::{Report, Scene, State};

/// How much the sum may grow (-), over the energy that is moved and over the elastic one: what resets, and points that keep more elastic
/// energy than the grid sees, may add in a sound run.
const PARTS: [f64; 2] = [0.1, 0.01];

/// A warning after a step with inertia.
pub fn found<const D: usize>(scene: &Scene<D>, state: &mut State<D>, report: &Report<D>) -> Option<String> {
    let phase = scene.phases.get(state.phase).filter(|phase| phase.isolated && state.dynamic(scene))?;
    let (kinetic, elastic, potential) = (report.motion.kinetic, report.elastic, report.potential);
    let sum = kinetic + elastic + potential;
    if state.isolated.is_empty() {
        state.isolated = vec![sum, potential, 0.0];
    }
    let [first, height, moved] = state.isolated[..] else { return None };
    let (moved, grown) = (moved.max(kinetic).max((potential - height).abs()), sum - first);
    state.isolated[2] = moved;
    (grown > PARTS[0] * moved && grown > PARTS[1] * elastic).then(|| {
        format!(
            "{WARNING}phase `{}`: at t = {:.4} s the sum of kinetic, elastic and potential energy has grown by {grown:.3e} kJ, {:.0} % of the energy \
             that is moved, and no load does work: the motion since then is wrong; take smaller steps (`step.max`) or more numerical damping \
             (`numerics: {{spectral_radius: 0.6}}`)",
            phase.name,
            state.time,
            100.0 * grown / moved
        )
    })
}
