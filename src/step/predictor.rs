//! The predictor of Newton's method (docs/theory.md, section 14): linear extrapolation of the last increment.
//!
//! Where soil flows, or a structure moves steadily, the next increment is close to the last one. The iteration that begins with it finds the
//! soil yielding where it did, with its elasto-plastic tangent, and the same contact nodes closed.

use super::state::State;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::mesh::shape::MAX_NODES;

/// A step more than this many times as long as the last one has no predictor. Within a phase steps grow by less; another phase may have
/// another scale of time.
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

/// Interpolates the last increment from the grid `before` a reset, whose displacement is still in the state, to the nodes of the grid
/// `after` it: each from where the material that is now at the node was. Nodes that no material of the grid comes to keep theirs.
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
