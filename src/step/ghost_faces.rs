//! Which faces have a ghost penalty (docs/theory.md, section 8), and for which faces the pattern of the matrix has entries (*room*).

use super::scene::Scene;
use super::state::State;
use crate::mesh::faces::{Face, Faces};

/// Rings of cells around those with a penalty for whose faces the pattern has entries too, so that it seldom changes.
const RINGS: usize = 2;

/// The faces with a penalty, ascending: those of ill-conditioned cells and, with inertia, of cells with fewer points than nodes, and
/// those of the empty cells beside these, if one of the two cells of the face holds points.
pub fn choose<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Vec<u32> {
    let (faces, dynamic) = (&scene.locator.faces, scene.dynamic());
    let cells = scene.mesh.cells.len();
    let (mut holds, mut ill_conditioned, mut ring) = (vec![false; cells], vec![false; cells], vec![false; cells]);
    let mut count = vec![0; cells];
    for &c in &state.points.cell {
        holds[c as usize] = true;
        count[c as usize] += 1;
    }
    state.integration().cell.iter().for_each(|&c| holds[c as usize] = true);
    // The mass of fewer points than nodes is singular.
    let few = (0u32..)
        .zip(&count)
        .filter(|&(c, &n)| dynamic && holds[c as usize] && n < scene.mesh.cells.nodes(c as usize).len());
    for c in few.map(|(c, _)| c).chain(state.weights.ill_conditioned.iter().copied()) {
        ill_conditioned[c as usize] = true;
        for &other in faces.neighbours(c) {
            ring[other as usize] = true;
        }
    }
    let wanted = |face: &Face| {
        let [a, b] = face.cells.map(|c| c as usize);
        let near = |c: usize| ill_conditioned[c] || ring[c] && !holds[c];
        let inside = |c: usize| state.active[c] && (holds[c] || ring[c]);
        (holds[a] || holds[b]) && inside(a) && inside(b) && (near(a) || near(b))
    };
    (0u32..).zip(&faces.inner).filter(|(_, face)| wanted(face)).map(|(number, _)| number).collect()
}

/// Whether the pattern has entries for a penalty at a face.
pub fn has_room<const D: usize>(state: &State<D>, face: &Face) -> bool {
    face.cells.iter().any(|&c| state.penalised.get(c as usize).copied().unwrap_or(false))
        && face.cells.iter().all(|&c| state.active[c as usize])
}

/// Whether the pattern has entries for all penalties of a state.
pub fn has_room_for_penalties<const D: usize>(scene: &Scene<D>, state: &State<D>) -> bool {
    choose(scene, state).into_iter().all(|f| has_room(state, &scene.locator.faces.inner[f as usize]))
}

/// Marks the cells whose faces get entries: those of the faces in `chosen` and of the rings around; true if the pattern changes.
pub fn make_room<const D: usize>(faces: &Faces, state: &mut State<D>, chosen: &[u32]) -> bool {
    if chosen.iter().all(|&f| has_room(state, &faces.inner[f as usize])) {
        return false;
    }
    let mut marked = vec![false; state.active.len()];
    for &f in chosen {
        for c in faces.inner[f as usize].cells {
            marked[c as usize] = true;
        }
    }
    for _ in 0..RINGS {
        let inside: Vec<u32> = (0u32..).zip(&marked).filter(|(_, m)| **m).map(|(c, _)| c).collect();
        for other in inside.into_iter().flat_map(|c| faces.neighbours(c)) {
            marked[*other as usize] = true;
        }
    }
    state.penalised = marked;
    true
}
