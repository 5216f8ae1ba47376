//! How phases end: at their time, before it because what they look for is found, or because the analysis cannot go on.

use super::measured::Soil;
use super::values::value;
use super::watch::{Quantity, Watch, column_name};
use crate::error::{Error, Kind, Result};
use crate::gravity::Gravity;
use crate::kinematics::Kinematics;
use crate::step::{Controller, Phase, Report, Scene, Simulation, State, kink};
use crate::time_value::TimeValue;

/// Part of the largest kinetic energy that counts as rest (-) where dynamics hands back to a quasi-static phase.
const REST: f64 = 1e-2;

/// Kinetic energy over the elastic one (-) below which nothing moves: velocities are a millionth of those that the stresses could set. Newton's
/// tolerance leaves less.
const STILL: f64 = 1e-12;

/// A smaller part (-) of what was out of balance is no more than rounding.
const TOLD: f64 = 1e-6;

/// Where soil moves this many times as fast at the end of a search as in the mean (-), its displacement has a kink, though equilibrium was found.
const SUDDEN: f64 = 10.0;

/// What ends a phase before its time.
#[derive(Clone, Debug, PartialEq)]
pub enum Until {
    /// A quantity of the entry of the history with the name `of` is at least, or where `below` at most `bound`.
    Reached { of: String, quantity: Quantity, bound: f64, below: bool },
    /// The kinetic energy has fallen to this part (-) of its largest in the phase; or the phase begins at rest and its forces are in
    /// balance but for this part, so that there is no such energy to fall.
    Equilibrium(f64),
}

/// Whether the phase that begins waits for a rest that it will never leave.
///
/// # Errors
/// When memory does not suffice.
pub fn is_met_at_first<const D: usize, K: Kinematics<D>>(
    until: &[Until],
    simulation: &mut Simulation<D, K>,
) -> Result<bool> {
    equilibrium(until).map_or(Ok(false), |part| simulation.stays_at_rest(part, 0.0))
}

/// The part of the kinetic energy (-) that a phase waits for.
fn equilibrium(until: &[Until]) -> Option<f64> {
    until.iter().find_map(|condition| match condition {
        Until::Equilibrium(part) => Some(*part),
        Until::Reached { .. } => None,
    })
}

/// Whether the phase waits for a rest that it has come to in the step of the `report`: what is left of a motion before it may not fall any
/// further.
///
/// # Errors
/// When memory does not suffice.
pub fn is_still<const D: usize, K: Kinematics<D>>(
    until: &[Until],
    simulation: &mut Simulation<D, K>,
    report: &Report<D>,
) -> Result<bool> {
    let most = STILL * report.elastic.abs();
    match equilibrium(until) {
        Some(part) if report.motion.kinetic <= most => simulation.stays_at_rest(part, most),
        _ => Ok(false),
    }
}

/// Why a phase ends with the step of the `report` that [`is_still`].
pub fn at_rest<const D: usize>(phase: &Phase, report: &Report<D>) -> String {
    let (name, kinetic, elastic) = (&phase.name, report.motion.kinetic, report.elastic);
    format!(
        "phase `{name}` ends: nothing moves, with its forces in balance: the kinetic energy is {kinetic:.3e} kJ beside {elastic:.3e} kJ of the \
         stresses"
    )
}

/// Why a phase ends with its first step that [`is_met_at_first`].
pub fn at_first(phase: &Phase) -> String {
    format!("phase `{}` ends: it began at rest, with its forces in balance", phase.name)
}

/// Why a phase ends with the step of the `report`, if one of its conditions holds.
pub fn met<const D: usize, K: Kinematics<D>>(
    until: &[Until],
    watches: &[Watch],
    scene: &Scene<D>,
    state: &State<D>,
    report: &Report<D>,
) -> Option<String> {
    let name = &scene.phases[state.phase].name;
    let held = if state.ramp.is_kept() { 0.0 } else { state.ramp.share(state.phase_time) };
    let note = until.iter().find_map(|condition| match condition {
        Until::Reached { of, quantity, bound, below } => {
            // An entry may be several watches.
            let watch = watches.iter().find(|watch| watch.name == *of && watch.quantities.contains(quantity))?;
            let value = value(&watch.on, *quantity, &Soil::<D, K>::new(scene, state), report)?;
            let reached = if *below { value <= *bound } else { value >= *bound };
            reached.then(|| format!("phase `{name}` ends: {} is {value:.6e}", column_name(watch, *quantity)))
        }
        Until::Equilibrium(part) => {
            let kinetic = report.motion.kinetic;
            let still = state.peak > 0.0 && kinetic <= part * state.peak;
            still.then(|| {
                format!("phase `{name}` ends: the kinetic energy is {kinetic:.3e} kJ of {:.3e} kJ", state.peak)
            })
        }
    })?;
    if held <= TOLD {
        return Some(note);
    }
    let (share, most) = (100.0 * held, state.ramp.most());
    let next = if scene.phases.len() > state.phase + 1 { ", and comes on in the next" } else { "" };
    Some(format!(
        "{note}; {share:.1} % of what was out of balance {}, up to {most:.3e} kN at a node, is not released{next}",
        since(state)
    ))
}

/// When what is held came out of balance.
fn since<const D: usize>(state: &State<D>) -> &'static str {
    if state.ramp.from > 0.0 { "on a reset grid" } else { "as the phase began" }
}

/// Whether a step that failed hands over to dynamics.
pub fn falls<const D: usize>(phase: &Phase, state: &State<D>, controller: &Controller) -> bool {
    phase.auto && controller.exhausted && !state.switched_to_dynamics
}

/// Goes on with inertia after a step that failed with `error`: the note for the log.
pub fn switch_to_dynamics<const D: usize>(
    phase: &Phase,
    state: &mut State<D>,
    controller: &mut Controller,
    error: &Error,
) -> String {
    controller.exhausted = false;
    (state.switched_to_dynamics, state.peak) = (true, 0.0);
    format!("phase `{}` goes on with inertia from t = {:.6} s: {}", phase.name, state.time, error.problem)
}

/// Goes back to equilibrium where such a phase has come to rest, not before it ends by what it waits `until`: the note for the
/// log.
pub fn switch_to_quasi_static<const D: usize>(
    phase: &Phase,
    until: &[Until],
    state: &mut State<D>,
    report: &Report<D>,
    controller: &mut Controller,
) -> Option<String> {
    let kinetic = report.motion.kinetic;
    let part = |condition: &Until| if let Until::Equilibrium(part) = condition { *part } else { REST };
    let rest = until.iter().map(part).fold(REST, f64::min);
    if !state.switched_to_dynamics || state.peak <= 0.0 || kinetic > rest * state.peak {
        return None;
    }
    let note = format!(
        "phase `{}` is quasi-static again from t = {:.6} s: the kinetic energy is {kinetic:.3e} kJ of {:.3e} kJ",
        phase.name, state.time, state.peak
    );
    state.rest();
    (state.switched_to_dynamics, state.peak) = (false, 0.0);
    controller.wanted = phase.step.initial;
    Some(note)
}

/// Whether a step that failed is the end of a search for the strength that leaves no equilibrium, which begins with one.
pub fn found_failure<const D: usize>(phase: &Phase, state: &State<D>, controller: &Controller) -> bool {
    phase.search.is_some() && controller.exhausted && !state.search_curve.is_empty()
}

/// What a search came to, given the reduction of strength (-) that left no equilibrium, if one was found.
pub fn safety<const D: usize>(phase: &Phase, state: &State<D>, failed: Option<f64>) -> String {
    let (name, held) = (&phase.name, phase.reduction_at(state.phase_time));
    let moved = state.search_curve.last().map_or(0.0, |[_, moved]| *moved);
    let moved = format!("the soil has moved by {moved:.3e} m");
    let kink = kink(&state.search_curve, if failed.is_some() { 1.0 } else { SUDDEN });
    match (failed, kink) {
        (Some(failed), kink) => {
            let kink = kink.map_or(String::new(), |kink| format!(", and the curve of that has its kink at {kink:.4}"));
            format!(
                "factor of safety {held:.4} to {failed:.4} (phase `{name}`): equilibrium was last found at strengths divided by \
                 the first, and none at the second; {moved}{kink}"
            )
        }
        (None, Some(kink)) => format!(
            "factor of safety near {kink:.4} (phase `{name}`): equilibrium was found up to the end of the phase, at {held:.4}, but {moved}, and the \
             curve of that has its kink at the first"
        ),
        (None, None) => format!(
            "factor of safety above {held:.4} (phase `{name}`): equilibrium was found up to the end of the phase; {moved}"
        ),
    }
}

/// The curve of a search for the log: how far the soil has moved (m) at each factor.
pub fn curve<const D: usize>(phase: &Phase, state: &State<D>) -> String {
    let places: Vec<_> = state.search_curve.iter().map(|[factor, moved]| format!("{factor:.4} {moved:.3e}")).collect();
    format!("factors of phase `{}`, and how far the soil has moved at each (m): {}", phase.name, places.join(", "))
}

/// An error of the analysis with the moment it came in, and, where loads grow without inertia, how far they had come:
/// what stops Newton's method there may be the limit load. Of soil with friction the message says so: nothing else is known there, as it may also be
/// a state that the iteration does not get across.
pub fn in_time<const D: usize>(error: Error, scene: &Scene<D>, phase: &Phase, state: &State<D>) -> Error {
    if error.kind != Kind::Analysis {
        return error;
    }
    let moment = format!("in step {} from t = {:.6} s in phase `{}`", state.step + 1, state.time, phase.name);
    // A search that has not begun has found no equilibrium.
    let none = state.dynamic(scene) || (phase.search.is_some() && state.search_curve.is_empty());
    let loads = if none { Vec::new() } else { loads_reached(scene, phase, state) };
    if loads.is_empty() {
        return Error { problem: format!("{} ({moment})", error.problem), ..error };
    }
    let frictional = error.place == "Newton" && scene.has_friction();
    let meaning = if frictional { "no equilibrium found: the load may be the limit; " } else { "" };
    let problem = format!("{meaning}{} ({moment}; equilibrium was last found at {})", error.problem, loads.join(", "));
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
    let gravity = scene.terms.iter().find_map(|term| term.gravity(state.phase));
    let of_gravity = |d: usize, value: &TimeValue| match gravity {
        Some(Gravity::Components(_)) => {
            let axis = ["x", "y", "z"][d];
            format!("a gravity of {:.4} of {:.4} m/s² in {axis}", value.at(now), value.at(end))
        }
        _ => format!("the gravity factor {:.4} of {:.4}", value.at(now), value.at(end)),
    };
    let values = gravity.iter().flat_map(|gravity| gravity.values()).enumerate();
    let gravity = values.filter(|(_, value)| varies(value)).map(|(d, value)| of_gravity(d, value));
    let moved = phase.prescribed.iter().filter(|p| varies(&p.displacement)).map(|p| {
        let (now, end) = (p.displacement.at(now), p.displacement.at(end));
        match p.fixed.nodes.first().and_then(|&n| scene.turning(n)) {
            Some(dofs) => format!("a rotation of {:.4e} of {:.4e} rad prescribed", now / dofs.arm, end / dofs.arm),
            None => format!("{now:.4e} of {end:.4e} m prescribed in {}", ["x", "y", "z"][p.fixed.component]),
        }
    });
    let reduction = phase.reduction.iter().filter(|value| varies(value));
    let reduction = reduction.map(|value| format!("strengths divided by {:.4} of {:.4}", value.at(now), value.at(end)));
    let held = state.ramp.share(now);
    let released = (held > 0.0 && !state.ramp.is_kept() && now > state.ramp.from)
        .then(|| format!("{:.1} % of what was out of balance {}", 100.0 * (1.0 - held), since(state)));
    gravity.chain(moved).chain(reduction).chain(released).collect()
}
