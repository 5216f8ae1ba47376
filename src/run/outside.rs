//! Soil that has left the mesh: its own cells carry it on, as long as the grid is not reset, and nothing there acts on it; a little of it is put back
//! onto the end of the mesh at a reset.

use super::warning::WARNING;
use crate::geometry::box_around;
use crate::mesh::cell_size;
use crate::step::{Restore, Scene, State};

/// How far out of the box around the mesh a point is (-), over the size of its cell, before it is told of: supports project points back.
const FAR: f64 = 0.5;

/// Warnings after a step; none on a grid that is never reset, which goes where the soil does.
pub fn found<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Vec<String> {
    let phase = scene.phases.get(state.phase).map_or("", |phase| phase.name.as_str());
    let projected = state.weights.beyond.iter().map(|told| format!("{WARNING}phase `{phase}`: {told}"));
    projected.chain(left(scene, state, phase)).collect()
}

fn left<const D: usize>(scene: &Scene<D>, state: &State<D>, phase: &str) -> Option<String> {
    if scene.numerics.restore == Restore::Never {
        return None;
    }
    let [low, high] = box_around(scene.mesh.nodes.iter().copied())?;
    let points = &state.points;
    let beyond = |p: &usize| {
        let x = &points.position[*p];
        let away = (0..D).map(|d| (low[d] - x[d]).max(x[d] - high[d])).fold(0.0, f64::max);
        away > 0.0 && away > FAR * cell_size(&scene.mesh, points.cell[*p] as usize)
    };
    let first = (0..points.len()).find(beyond)?;
    Some(format!(
        "{WARNING}phase `{phase}`: soil of region `{}` has left the mesh near {:.3?} m: nothing acts on it there, and the next grid reset ends the analysis; \
         extend the mesh by a region of `kind: buffer`, or hold the soil back by a support",
        scene.mesh.regions[usize::from(points.region[first])],
        points.position[first]
    ))
}
