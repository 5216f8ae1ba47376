//! Materials that change as a phase begins (docs/theory.md, section 9, *Change of material*): the pressure field, and the log messages.

use super::change::Change;
use super::grid::Grid;
use super::scene::Scene;
use super::state::State;
use crate::kinematics::Kinematics;
use crate::material::{is_beyond_yield, odd_poisson, on_poisson};

/// Takes the pressure field of a phase that begins with other materials over from the points.
pub fn project_pressure<const D: usize, K: Kinematics<D>>(scene: &Scene<D>, grid: &Grid<D>, state: &mut State<D>) {
    let changed = scene.phases.get(state.phase).is_some_and(|phase| !phase.changes.is_empty());
    if changed && state.phase_time == 0.0 && scene.has_pressure_field() {
        grid.project_pressure::<K>(scene, state);
    }
}

/// Lines for the log on the changes of the phase that begins.
pub fn notes<const D: usize, K: Kinematics<D>>(scene: &Scene<D>, state: &State<D>) -> Vec<String> {
    let Some(phase) = scene.phases.get(state.phase) else { return Vec::new() };
    let note = |change: &Change| {
        let (mut all, mut beyond, mut odd) = (0, 0, Vec::new());
        for points in [&state.points, &state.fem] {
            for p in change.of(points) {
                let volume_ratio = points.deformation[p].determinant();
                let (model, y) = (change.into.model.as_ref(), points.seeded_height(p));
                let stress = points.stress[p].map(|s| volume_ratio * s);
                all += 1;
                odd.extend(odd_poisson(model, y, &K::roots(&stress)));
                beyond += usize::from(is_beyond_yield(model, y, &stress, &points.state(p, 0.0)));
            }
        }
        let Change { of, into, .. } = change;
        let mut note = format!("phase {}: region `{of}` is of `{}` from here on", phase.name, into.name);
        if beyond > 0 {
            note.push_str(&format!(
                "; the stress of {beyond} of its {all} points is more than that bears, and is reduced to it in the first step"
            ));
        }
        if let Some(&ratio) = odd.first() {
            note.push_str(&format!(
                "; Poisson's ratio of {} of its {all} points, at their stress, {}",
                odd.len(),
                on_poisson(ratio)
            ));
        }
        note
    };
    phase.changes.iter().map(note).collect()
}
