//! Scalar fields beside displacement and pressure field, with an unknown at each corner of the cells ([`Scene::scalars`]): the excess pressure of
//! the water in the pores, and what else the material carries, such as a temperature or a concentration. The scene declares the latter, and its
//! equation is a term. No case makes one so far.
//!
//! The unknowns are those of all active cells of the grid, so a term has to contribute to each cell in [`crate::term::Frame::cells`], with points
//! or without. [`crate::term::Frame::field`] is their place among the unknowns of a cell. Finite elements have the pore pressure only.

use super::nodal_fit::{self, Filled};
use super::pore_pressure;
use super::scene::{Scalar, Scene};
use super::state::State;
use crate::dofs::DofMap;
use crate::interpolation::Interpolation;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::term::pressure_shapes;

/// Makes room for the fields in the state; points that have none have zeros.
pub fn make_room<const D: usize>(scene: &Scene<D>, state: &mut State<D>) {
    let [places, _] = scene.places();
    state.pressure.resize(places.end(scene.scalars().count()), 0.0);
    state.points.fields.resize(scene.fields.len() * state.points.len(), 0.0);
}

/// Takes the fields over to a restored grid: the pore pressure from the points of all cells that integrals are summed over, the others from the
/// material points in `carried`.
pub fn project<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    integrated: &[Filled<D>],
    carried: Filled<D>,
    pressure: &mut [f64],
) {
    let ([places, _], count) = (scene.places(), scene.fields.len());
    for (k, scalar) in scene.scalars().enumerate() {
        let values = &mut pressure[places.field(k, 0)..places.field(k + 1, 0)];
        match scalar {
            Scalar::PorePressure(water) => pore_pressure::gather::<D, K>(integrated, &water.porous, values),
            Scalar::Other(column, _) => {
                nodal_fit::fit::<D, K>(&[carried], |points, p| Some(points.fields[p * count + column]), values);
            }
        }
    }
}

/// Adds the interpolated increments of the nodal values, which become `new`, to the values of the material points: where nothing changes, the
/// points keep theirs. The pore pressure of the points is that of their stress.
pub fn to_points<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    (mesh, interpolation): (&Mesh<D>, &Interpolation<D>),
    state: &mut State<D>,
    new: &[f64],
) {
    let ([places, _], count) = (scene.places(), scene.fields.len());
    for (k, scalar) in scene.scalars().enumerate() {
        let Scalar::Other(column, _) = scalar else { continue };
        for cell_points in &interpolation.filled {
            let kind = mesh.cells.kind[cell_points.cell as usize];
            let corners = mesh.cells.corners(cell_points.cell as usize);
            for entries in interpolation.entries::<K>(cell_points) {
                let shapes = pressure_shapes(kind, entries.shape);
                let change = |(shape, &n): (&f64, &u32)| {
                    let place = places.field(k, n);
                    shape * (new[place] - state.pressure[place])
                };
                state.points.fields[entries.point * count + column] +=
                    shapes.iter().zip(corners).map(change).sum::<f64>();
            }
        }
    }
}

/// Sets the prescribed increments of the fields in a step of `dt` (s) in `given`, one entry per equation; the water has no excess pressure at the
/// nodes `drained`, ascending. With `dt = 0` all values that change by
/// flow alone are fixed.
pub fn give<const D: usize>(
    scene: &Scene<D>,
    state: &State<D>,
    (dofs, drained): (&DofMap<D>, &[u32]),
    dt: f64,
    given: &mut [Option<f64>],
) {
    let [places, _] = scene.places();
    for (k, scalar) in scene.scalars().enumerate() {
        let mut give = |nodes: &[u32], value: f64| {
            for (equation, node) in dofs.field(k).filter(|(_, node)| nodes.binary_search(node).is_ok()) {
                given[equation] = Some(value - state.pressure[places.field(k, node)]);
            }
        };
        match scalar {
            Scalar::PorePressure(_) => give(drained, 0.0),
            Scalar::Other(..) if dt == 0.0 => dofs.field(k).for_each(|(equation, _)| given[equation] = Some(0.0)),
            Scalar::Other(_, field) => {
                field.given.iter().for_each(|(nodes, value)| give(nodes, value.at(state.phase_time + dt)));
            }
        }
    }
}
