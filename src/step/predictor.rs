//! The predictor: the motion of the step before goes on.
//!
//! Where soil flows, or a structure moves on, the end of a step is much the same as before, a step farther on. The iteration that begins
//! there finds soil that yields where it did, with its elasto-plastic tangent, and contact nodes that touch as they did.

use super::state::State;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::mesh::shape::MAX_NODES;

/// A step this many times as long as the last one does not go on with it. Within a phase steps grow less; the next phase may
/// count its time on another scale.
const LONGEST: f64 = 4.0;

/// Passes of the search for where the material at a node was.
const PASSES: usize = 4;

/// The predicted displacement (m) of the nodes at the end of a step of size `dt` (s): linear extrapolation of the last increment. None
/// where nothing has moved, and in a step that is far longer than the last.
pub fn extrapolated<const D: usize>(state: &State<D>, dt: f64) -> Option<Vec<[f64; D]>> {
    let share = dt / state.last_step;
    let goes_on = share <= LONGEST && state.increment.iter().flatten().any(|&by| by != 0.0);
    let ends = state.displacement.iter().zip(&state.increment);
    goes_on.then(|| ends.map(|(u, by)| std::array::from_fn(|d| u[d] + share * by[d])).collect())
}

/// Takes the last increment to the nodes of the grid in `after`, where it is restored to, from that `before`, whose
/// displacement is still in the state: from about where the material at the node was. Nodes that nothing comes to keep theirs.
pub fn carry<const D: usize>((before, locator): (&Mesh<D>, &Locator<D>), after: &Mesh<D>, state: &mut State<D>) {
    if state.increment.is_empty() {
        return;
    }
    let mut increment = state.increment.clone();
    let mut done: Vec<bool> = state.displacement.iter().map(|u| u.iter().all(|&u| u == 0.0)).collect();
    let (mut values, mut hint) = ([0.0; MAX_NODES], None);
    for &n in &after.cells.nodes {
        let n = n as usize;
        if std::mem::replace(&mut done[n], true) {
            continue;
        }
        // Fixed-point iteration for where the material at the node was.
        let mut back = state.displacement[n];
        for _ in 0..PASSES {
            let from = std::array::from_fn(|d| after.nodes[n][d] - back[d]);
            let Some((c, xi)) = locator.locate(before, &from, hint) else { break };
            hint = Some(c);
            before.cells.kind[c as usize].values(&xi, &mut values);
            let value = |field: &[[f64; D]]| {
                let around = before.cells.nodes(c as usize).iter().zip(&values);
                around.fold([0.0; D], |sum, (&m, v)| std::array::from_fn(|d| sum[d] + v * field[m as usize][d]))
            };
            (back, increment[n]) = (value(&state.displacement), value(&state.increment));
        }
    }
    state.increment = increment;
}
