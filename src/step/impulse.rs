//! Contact with soil in steps with inertia: an impulse at the beginning of the step (docs/theory.md, section 5, *Contact*).

use super::grid::Grid;
use super::scene::Scene;
use crate::contact::Motion;
use crate::term::{Trial, contact_answer};

/// The force (kN, one entry an equation) of contact with soil that acts as an impulse in a step with inertia; empty where nothing touches.
pub fn force<const D: usize>(scene: &Scene<D>, grid: &Grid<D>, trial: &Trial<D>) -> Vec<f64> {
    let mut sum = Vec::new();
    for constraint in grid.constraints.iter().filter(|constraint| !constraint.condition.looks_ahead()) {
        let condition = &constraint.condition;
        let law = scene.interfaces[constraint.interface as usize].sides().laws.at(trial.phase);
        let (answer, Motion { turn, .. }) = contact_answer(law, scene.levels.as_ref(), constraint, trial);
        if answer.pressure == 0.0 && answer.shear == 0.0 {
            continue;
        }
        sum.resize(grid.motion.pattern.len(), 0.0);
        for (k, (t, &node)) in condition.by_tangent.iter().zip(&condition.nodes).enumerate() {
            let (n, lever) = (condition.normal(k, turn), condition.curvature * answer.moment);
            for d in 0..D {
                if let Some(equation) = grid.dofs.displacement(node, d) {
                    let by_arc = lever * condition.by_arc[k][d];
                    sum[equation] += condition.area * (answer.pressure * n[d] + answer.shear * t[d] + by_arc);
                }
            }
        }
    }
    sum
}
