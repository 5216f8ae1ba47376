//! Scalar fields that the material carries beside displacement and pressures, with an unknown at each corner of the cells: a temperature, a
//! concentration. The scene declares a field; its equation is a term. No case makes one so far.
//!
//! The unknowns are those of all active cells of the grid, so the term has to contribute to each cell in [`crate::term::Frame::cells`], with points
//! or without. [`crate::term::Frame::field`] is their place among the unknowns of a cell.

use super::nodal_fit::{self, Filled};
use super::scene::Scene;
use super::state::State;
use crate::dofs::DofMap;
use crate::interpolation::Interpolation;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::term::pressure_hats;

/// Makes room for the fields in the state; points that have none have zeros.
pub fn make_room<const D: usize>(scene: &Scene<D>, state: &mut State<D>) {
    if scene.fields.is_empty() {
        return;
    }
    let [places, _] = scene.places();
    state.pressure.resize(places.end(scene.fields.len()), 0.0);
    state.points.fields.resize(scene.fields.len() * state.points.len(), 0.0);
}

/// Takes the fields over from the material points to a restored grid.
pub fn project<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    (mesh, interpolation): (&Mesh<D>, &Interpolation<D>),
    state: &mut State<D>,
) {
    make_room(scene, state);
    let ([places, _], count) = (scene.places(), scene.fields.len());
    for k in 0..count {
        let range = places.field(k, 0)..places.field(k + 1, 0);
        let mut values = state.pressure[range.clone()].to_vec();
        let filled = Filled { mesh, interpolation, points: &state.points };
        nodal_fit::fit::<D, K>(&[filled], |points, p| Some(points.fields[p * count + k]), &mut values);
        state.pressure[range].copy_from_slice(&values);
    }
}

/// Adds the interpolated increments of the nodal values, which become `new`, to the values of the material points: where nothing changes, the
/// points keep theirs.
pub fn to_points<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    (mesh, interpolation): (&Mesh<D>, &Interpolation<D>),
    state: &mut State<D>,
    new: &[f64],
) {
    let ([places, _], count) = (scene.places(), scene.fields.len());
    for k in 0..count {
        for cell_points in &interpolation.filled {
            let kind = mesh.cells.kind[cell_points.cell as usize];
            let corners = &mesh.cells.nodes(cell_points.cell as usize)[..kind.corner_count()];
            for entries in interpolation.entries::<K>(cell_points) {
                let shapes = pressure_hats(kind, entries.shape);
                let change = |(shape, &n): (&f64, &u32)| {
                    let place = places.field(k, n);
                    shape * (new[place] - state.pressure[place])
                };
                state.points.fields[entries.point * count + k] += shapes.iter().zip(corners).map(change).sum::<f64>();
            }
        }
    }
}

/// Sets the prescribed increments of the fields in a step of `dt` (s) in `given`, one entry per equation. With `dt = 0` all values are fixed.
pub fn give<const D: usize>(scene: &Scene<D>, state: &State<D>, dofs: &DofMap<D>, dt: f64, given: &mut [Option<f64>]) {
    let [places, _] = scene.places();
    for (k, field) in scene.fields.iter().enumerate() {
        if dt == 0.0 {
            dofs.field(k).for_each(|(equation, _)| given[equation] = Some(0.0));
            continue;
        }
        for (nodes, value) in &field.given {
            for (equation, node) in dofs.field(k) {
                if nodes.binary_search(&node).is_ok() {
                    given[equation] = Some(value.at(state.phase_time + dt) - state.pressure[places.field(k, node)]);
                }
            }
        }
    }
}
