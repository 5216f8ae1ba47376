//! Excavation: soil that goes as a phase begins (docs/theory.md, section 14, *Excavation*).

use super::energies::Item;
use super::grid::Grid;
use super::relax;
use super::scene::Scene;
use super::state::State;
use super::work;
use crate::error::Result;
use crate::kinematics::Kinematics;

/// Removes the soil that goes as the phase in hand begins, on a reset grid; false where nothing of it is there.
///
/// # Errors
/// When a point lies outside the grid, or memory does not suffice.
pub fn remove<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &mut State<D>,
) -> Result<bool> {
    let removal = scene.removals.get(state.phase).and_then(Option::as_ref);
    let Some(removal) = removal.filter(|_| state.phase_time == 0.0) else { return Ok(false) };
    let stays = |&p: &usize| !removal.regions[state.points.region[p] as usize];
    if (0..state.points.len()).all(|p| stays(&p)) {
        return Ok(false);
    }
    work::begin(scene, grid, state)?;
    grid.restore::<K>(scene, state)?;
    let (mesh, locator) = relax::mesh(scene, grid.relaxed.as_ref());
    if let Some(front) = &mut state.front {
        removal.parting.part((mesh, locator), &state.points, &state.active, front);
    }
    let lost = state.weights.lost_front.take();
    let stays = |&p: &usize| !removal.regions[state.points.region[p] as usize];
    let left: Vec<usize> = (0..state.points.len()).filter(stays).collect();
    state.points = state.points.select(&left);
    state.parametric = left.iter().map(|&p| state.parametric[p]).collect();
    if !state.start_position.is_empty() {
        state.start_position = left.iter().map(|&p| state.start_position[p]).collect();
    }
    grid.restore::<K>(scene, state)?;
    if lost.is_some() {
        state.weights.lost_front = lost;
    }
    state.increment.fill([0.0; D]);
    state.balanced = None;
    work::note(scene, grid, state, Item::Changes)?;
    Ok(true)
}
