//! Steps that were accepted before Newton's method came to its goal (docs/theory.md, section 14, *Acceptable residuals*).

use super::warning::WARNING;
use crate::step::{Report, Scene, State};

/// The relative residual (-) of a step that was accepted with more than the tolerance.
pub fn residual<const D: usize>(scene: &Scene<D>, report: &Report<D>) -> Option<f64> {
    report.residuals.last().copied().filter(|&residual| residual > scene.numerics.tolerance)
}

/// A warning after such a step.
pub fn found<const D: usize>(scene: &Scene<D>, state: &State<D>, report: &Report<D>) -> Option<String> {
    let residual = residual(scene, report)?;
    let phase = scene.phases.get(state.phase)?;
    Some(format!(
        "{WARNING}phase `{}`: at t = {:.4} s an iteration came no closer to equilibrium than {residual:.1e} of the largest force, and the step was \
         accepted, as such steps of soil with friction are below `numerics.acceptable_tolerance`, here {:e}: forces have errors of about that size; \
         solve.log names each of these steps",
        phase.name, state.time, scene.numerics.acceptable_tolerance
    ))
}
