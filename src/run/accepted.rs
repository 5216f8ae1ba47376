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
        "{WARNING}phase `{}`: the step to t = {:.4} s was accepted with an unbalanced force of {residual:.1e} of the largest force, as no iteration came \
         closer to equilibrium; soil with friction that is pushed may have no smooth path, and `numerics.acceptable_tolerance` allows {:e}; solve.log \
         names each such step",
        phase.name, state.time, scene.numerics.acceptable_tolerance
    ))
}
