//! Projection of the pressure field `π` from the points at a grid reset (docs/theory.md, section 10, *Projection at a reset*).

use super::nodal_fit::{self, Filled};
use crate::dofs::Places;
use crate::kinematics::Kinematics;
use crate::term::pressure_shapes;

/// Projects the field over a family of cells from their points: a linear fit at the corners, and the remaining mean of each cell as its
/// constant. It is the initial value of the next step; the equations (eq. 25) take the values of the points themselves as `π_n`.
pub fn gather<const D: usize, K: Kinematics<D>>(cells: Filled<D>, places: Places, field: &mut Vec<f64>) {
    let Filled { mesh, interpolation, points } = cells;
    let (constants, end) = (places.constant(0), places.constant(mesh.cells.len()));
    field.resize(end.max(field.len()), 0.0);
    nodal_fit::fit::<D, K>(&[cells], |points, p| Some(points.pressure[p]), &mut field[..mesh.nodes.len()]);
    field[constants..end].fill(0.0);
    for cell_points in &interpolation.filled {
        let cell = cell_points.cell as usize;
        let kind = mesh.cells.kind[cell];
        if kind.order() == 1 {
            continue;
        }
        let (mut left, mut all) = (0.0, 0.0);
        for entries in interpolation.entries::<K>(cell_points) {
            let shapes = pressure_shapes(kind, entries.shape);
            let corners = mesh.cells.corners(cell);
            let there: f64 = shapes.iter().zip(corners).map(|(shape, &n)| shape * field[n as usize]).sum();
            left += entries.weight * (points.pressure[entries.point] - there);
            all += entries.weight;
        }
        if all > 0.0 {
            field[places.constant(cell)] = left / all;
        }
    }
}
