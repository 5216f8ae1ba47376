//! What a quasi-static step with contact begins with: the motion of the step before goes on.
//!
//! Close to a structure that moves on, the state at the end of a step is much the same as before, a step farther on;
//! begun without that, hats that touch would part, and touch again.

use super::scene::Scene;
use super::state::State;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::mesh::shape::MAX_NODES;

/// The displacement (m) of the nodes after `share` times their last increment.
pub fn going_on<const D: usize>(state: &State<D>, share: f64) -> Vec<[f64; D]> {
    let ends = state.displacement.iter().zip(&state.increment);
    ends.map(|(u, by)| std::array::from_fn(|d| u[d] + share * by[d])).collect()
}

/// Takes the last increment to the nodes of the grid in `after`, where it is restored to, from that `before`, whose
/// displacement is still in the state. Nodes that come from outside it keep theirs.
pub fn carry<const D: usize>(scene: &Scene<D>, before: &Mesh<D>, after: &Mesh<D>, state: &mut State<D>) {
    let moved = state.displacement.iter().flatten().any(|&u| u != 0.0);
    if scene.pairs.is_empty() || state.increment.is_empty() || !moved {
        return;
    }
    let nodes = before.nodes.iter().zip(&state.displacement);
    let nodes = nodes.map(|(x, u)| std::array::from_fn(|d| x[d] + u[d])).collect();
    let deformed = Mesh { nodes, ..before.clone() };
    let locator = Locator::new(&deformed);
    let mut increment = state.increment.clone();
    let mut done = vec![false; increment.len()];
    let (mut values, mut hint) = ([0.0; MAX_NODES], None);
    for &n in &after.cells.nodes {
        let n = n as usize;
        if std::mem::replace(&mut done[n], true) {
            continue;
        }
        let Some((c, xi)) = locator.locate(&deformed, &after.nodes[n], hint) else { continue };
        hint = Some(c);
        deformed.cells.kind[c as usize].values(&xi, &mut values);
        let around = deformed.cells.nodes(c as usize).iter().zip(&values);
        increment[n] = around.fold([0.0; D], |sum, (&m, value)| {
            std::array::from_fn(|d| sum[d] + value * state.increment[m as usize][d])
        });
    }
    state.increment = increment;
}
