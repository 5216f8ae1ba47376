//! How phases end: at their time, before it because what they look for is found, or because the analysis cannot go on.

use crate::error::{Error, Kind};
use crate::step::{Controller, Phase, Scene, State};
use crate::time_value::TimeValue;

/// Whether a step that failed is the end of a search for the strength that leaves no equilibrium: where no step of the
/// phase found any, nothing says that there was one to begin with.
pub fn found_failure<const D: usize>(phase: &Phase, state: &State<D>, controller: &Controller) -> bool {
    phase.search.is_some() && controller.exhausted && state.phase_time > 0.0
}

/// What a search came to, given the reduction of strength (-) that left no equilibrium, if one was found.
pub fn safety<const D: usize>(phase: &Phase, state: &State<D>, failed: Option<f64>) -> String {
    let (name, held) = (&phase.name, phase.reduction_at(state.phase_time));
    match failed {
        Some(failed) => format!(
            "factor of safety {held:.4} to {failed:.4} (phase `{name}`): equilibrium was last found at strengths divided by \
             the first, and none at the second"
        ),
        None => format!(
            "factor of safety above {held:.4} (phase `{name}`): equilibrium was found up to the end of the phase"
        ),
    }
}

/// An error of the analysis with the moment it came in, and, where loads grow without inertia, how far they had come:
/// what stops Newton's method there may be the limit load.
pub fn in_time<const D: usize>(error: Error, scene: &Scene<D>, phase: &Phase, state: &State<D>) -> Error {
    if error.kind != Kind::Analysis {
        return error;
    }
    let moment = format!("in step {} from t = {:.6} s in phase `{}`", state.step + 1, state.time, phase.name);
    let loads = if phase.dynamic { Vec::new() } else { loads_reached(scene, phase, state) };
    if loads.is_empty() {
        return Error { problem: format!("{} ({moment})", error.problem), ..error };
    }
    let problem = format!("{} ({moment}; equilibrium was last found at {})", error.problem, loads.join(", "));
    let remedy = match error.place.as_str() {
        "Newton" => format!("{}; beyond the load that the soil can bear go on with `analysis: dynamic`", error.remedy),
        _ => error.remedy,
    };
    Error { problem, remedy, ..error }
}

/// The loads of a phase that vary: where they stand, and where the phase takes them.
fn loads_reached<const D: usize>(scene: &Scene<D>, phase: &Phase, state: &State<D>) -> Vec<String> {
    let (now, end) = (state.phase_time, phase.duration);
    let varies = |value: &TimeValue| !matches!(value, TimeValue::Constant(_)) && value.at(end) != 0.0;
    let factors = scene.terms.iter().filter_map(|term| term.factor(state.phase)).filter(|value| varies(value));
    let factors = factors.map(|value| format!("the gravity factor {:.4} of {:.4}", value.at(now), value.at(end)));
    let moved = phase.prescribed.iter().filter(|p| varies(&p.displacement)).map(|p| {
        let axis = ["x", "y", "z"][p.fixed.component];
        let (now, end) = (p.displacement.at(now), p.displacement.at(end));
        format!("{now:.4e} of {end:.4e} m prescribed in {axis}")
    });
    let reduction = phase.reduction.iter().filter(|value| varies(value));
    let reduction = reduction.map(|value| format!("strengths divided by {:.4} of {:.4}", value.at(now), value.at(end)));
    factors.chain(moved).chain(reduction).collect()
}

/// Begins the next phase in the converged state of this one.
pub fn next_phase<const D: usize>(scene: &Scene<D>, state: &mut State<D>) {
    let dynamic = |phase: usize| scene.phases.get(phase).is_some_and(|p| p.dynamic);
    if dynamic(state.phase) && !dynamic(state.phase + 1) {
        state.rest();
    }
    state.phase += 1;
    state.phase_time = 0.0;
    if let Some(next) = scene.phases.get(state.phase) {
        state.step_size = next.first_step;
    }
}
