//! Positions of nodes and of the boundaries of structures as a step begins, and the matrix pattern of contact (docs/theory.md, section 13).

use super::scene::Scene;
use super::state::State;
use crate::contact::{Interface, Multipliers};
use crate::dofs::DofMap;
use crate::surface::ContactStatus;
use crate::system::Connectivity;

/// Where a node, or the reference point of a rigid body, is at the last converged step.
pub(super) fn position<const D: usize>(scene: &Scene<D>, state: &State<D>, n: u32) -> [f64; D] {
    let (from, by) = (state.at_reset(scene, n), &state.displacement[n as usize]);
    std::array::from_fn(|d| from[d] + by[d])
}

/// The boundaries of the structures that touch soil, when the grid is restored: the nodes are in place already, the
/// displacement is still that of the grid before.
pub fn outlines<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Vec<Vec<[f64; D]>> {
    let place = |n: u32| state.at_reset(scene, n);
    scene.touching(state.phase).flat_map(|(_, interface)| interface.outlines(&place)).collect()
}

/// The contact status of each piece of these at the end of the last step.
pub fn status<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Vec<Vec<ContactStatus>> {
    let of = |(k, interface): (usize, &dyn Interface<D>)| match state.multipliers.get(k) {
        Some(multipliers) => interface.status(multipliers),
        // Before the first step.
        None => interface.status(&Multipliers::new(interface.contact_nodes())),
    };
    scene.touching(state.phase).flat_map(of).collect()
}

/// Appends a coupling for each contact node with room.
pub fn couple<const D: usize>(state: &State<D>, dofs: &DofMap<D>, connectivity: &mut Connectivity) -> Vec<Vec<u32>> {
    let of_interface = |multipliers: &Multipliers| {
        let contact_nodes = multipliers.first.len() - 1;
        let coupling = |k: usize| {
            let room = multipliers.room(k);
            // Cells that no longer take part leave nothing to couple.
            let any = !room.is_empty() && room.iter().all(|&n| dofs.has(n));
            if any { dofs.couple(room.iter().copied(), connectivity) } else { u32::MAX }
        };
        (0..contact_nodes).map(coupling).collect()
    };
    state.multipliers.iter().map(of_interface).collect()
}
