//! Nodes that are moved by a record of acceleration: their velocity and acceleration at both ends of a step are those of the record, which is linear in
//! the step, and not those that Newmark's rule gives for their displacement (docs/theory.md, section 5, *Base motion*).

use super::grid::Grid;
use super::scene::Scene;
use super::state::State;
use crate::time_value::Motion;
use std::collections::BTreeMap;

/// The motion at the end of a step of each component of each node that is driven.
pub type Ends = BTreeMap<(u32, usize), Motion>;

/// The motion with which a step begins at the equations that are driven.
pub type Begins = Vec<(usize, Motion)>;

/// The motion of driven nodes at the beginning and at the end of a step of size `dt` (s).
pub fn motion<const D: usize>(scene: &Scene<D>, state: &State<D>, grid: &Grid<D>, dt: f64) -> (Begins, Ends) {
    let (mut begins, mut ends) = (Begins::new(), Ends::new());
    for prescribed in &scene.phases[state.phase].prescribed {
        let Some(record) = prescribed.displacement.record() else { continue };
        let [from, to] = [state.phase_time, state.phase_time + dt].map(|time| record.at(time));
        let component = prescribed.fixed.component;
        for &n in prescribed.fixed.nodes.iter().filter(|n| grid.dofs.has(**n)) {
            ends.insert((n, component), to);
            begins.extend(grid.dofs.displacement(n, component).map(|equation| (equation, from)));
        }
    }
    (begins, ends)
}
