//! Which faces take a ghost penalty, and which the system has room for.

use super::determined::undetermined;
use super::scene::Scene;
use super::state::State;
use crate::mesh::faces::{Face, Faces};

/// Rings of cells beyond those in need for which the system has room too, so that its pattern seldom changes.
const RINGS: usize = 2;

/// The faces that take a penalty, ascending: those of poor cells and, with inertia, of cells whose
/// points do not determine the motion of their nodes, and those of the empty cells beside these, as far as one of the two cells holds points.
pub fn choose<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Vec<u32> {
    let Some(faces) = &scene.faces else { return Vec::new() };
    let cells = scene.mesh.cells.len();
    let (mut holds, mut poor, mut ring) = (vec![false; cells], vec![false; cells], vec![false; cells]);
    for &c in state.points.cell.iter().chain(&state.integration().cell) {
        holds[c as usize] = true;
    }
    let undetermined =
        if scene.dynamic() { undetermined(&scene.mesh, &state.points.cell, &state.parametric) } else { Vec::new() };
    for c in undetermined.into_iter().chain(state.weighing.poor.iter().copied()) {
        poor[c as usize] = true;
        for &other in faces.neighbours(c) {
            ring[other as usize] = true;
        }
    }
    let wanted = |face: &Face| {
        let [a, b] = face.cells.map(|c| c as usize);
        let near = |c: usize| poor[c] || ring[c] && !holds[c];
        let inside = |c: usize| state.taking_part[c] && (holds[c] || ring[c]);
        (holds[a] || holds[b]) && inside(a) && inside(b) && (near(a) || near(b))
    };
    (0u32..).zip(&faces.inner).filter(|(_, face)| wanted(face)).map(|(number, _)| number).collect()
}

/// Whether the system has room for a penalty at a face.
pub fn has_room<const D: usize>(state: &State<D>, face: &Face) -> bool {
    face.cells.iter().any(|&c| state.penalised.get(c as usize).copied().unwrap_or(false))
        && face.cells.iter().all(|&c| state.taking_part[c as usize])
}

/// Whether the system has room for all penalties that the cells of a state, which exist and take part, ask for.
pub fn has_room_for_penalties<const D: usize>(scene: &Scene<D>, state: &State<D>) -> bool {
    let Some(faces) = &scene.faces else { return true };
    choose(scene, state).into_iter().all(|f| has_room(state, &faces.inner[f as usize]))
}

/// Makes room for the faces in `chosen` and those around; true where there was not enough.
pub fn make_room<const D: usize>(faces: &Faces, state: &mut State<D>, chosen: &[u32]) -> bool {
    if chosen.iter().all(|&f| has_room(state, &faces.inner[f as usize])) {
        return false;
    }
    let mut marked = vec![false; state.taking_part.len()];
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
