//! Soil that slides into another equilibrium without inertia: where it fails and the slide ends in another shape that stands, the steps of a
//! quasi-static analysis may lead there, and nothing on the way has a meaning.
//!
//! It is looked for in phases that do not move the soil themselves, by prescribed displacements or structures in contact, and do not
//! look for failure. Soil that is elastic does not fail, and a settlement that comes from its compression has a path.

use super::warning::WARNING;
use crate::mesh::height;
use crate::step::{FARTHEST, Scene, State};

/// Notes where the material points are as a phase, or the part of it without inertia, begins.
pub fn watch<const D: usize>(scene: &Scene<D>, state: &mut State<D>) {
    if is_watched(scene, state) {
        state.start_position.clone_from(&state.points.position);
    } else {
        state.start_position.clear();
    }
}

fn is_watched<const D: usize>(scene: &Scene<D>, state: &State<D>) -> bool {
    let Some(phase) = scene.phases.get(state.phase) else { return false };
    let is_structure = |region: u16| scene.fem.as_ref().is_some_and(|fem| fem.mesh.cells.region.contains(&region));
    let mut pressed = scene.touching(state.phase).filter(|(_, interface)| !interface.sides().soils.is_empty());
    let driven = phase.moves() || pressed.any(|(_, interface)| is_structure(interface.sides().structure));
    !driven && phase.search.is_none() && !state.dynamic(scene)
}

/// A warning where soil that yields has moved farther since then than half its height and what its compression explains of that, once.
pub fn found<const D: usize>(scene: &Scene<D>, state: &mut State<D>) -> Option<String> {
    let heights = state.start_position.iter().map(height);
    let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), y| (low.min(y), high.max(y)));
    let apart = |(a, b): (&[f64; D], &[f64; D])| a.iter().zip(b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
    let moved = state.points.position.iter().zip(&state.start_position).map(apart).enumerate();
    let (p, most) = moved.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let points = &state.points;
    let yields = points.plastic_strain.iter().any(|&strain| strain > 0.0);
    let volume: f64 = (0..points.len()).map(|p| points.volume(p)).sum();
    let compressed = (1.0 - volume / points.initial_volume.iter().sum::<f64>()).max(0.0);
    if !yields || most <= (FARTHEST + compressed) * (high - low) {
        return None;
    }
    state.start_position.clear();
    let (name, place) = (&scene.phases[state.phase].name, &state.points.position[p]);
    Some(format!(
        "{WARNING}phase `{name}`: without inertia the soil has moved by {most:.3} m, to {place:.3?} m, which is more than half its height of \
         {:.3} m: the quasi-static analysis has jumped to another equilibrium, and its path has no meaning; use `analysis: dynamic`",
        high - low
    ))
}
