//! The pressure field on a restored grid: its unknowns, and what the points bring to them.

use super::state::State;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::stencil::Stencil;
use crate::term::pressure_hats;

/// Where the unknowns of a cell stand in [`State::pressure`]: its corners by node, and the constant of the cell.
pub fn unknowns_of<const D: usize>(mesh: &Mesh<D>, cell: usize) -> impl Iterator<Item = u32> {
    let kind = mesh.cells.kind[cell];
    let constant = (kind.order() > 1).then_some((mesh.nodes.len() + cell) as u32);
    mesh.cells.nodes(cell)[..kind.corner_count()].iter().copied().chain(constant)
}

/// Takes the field from the points: weighted means at the corners, and what is left of the mean of each cell. It is
/// where the next step begins; what the step makes of it follows from the points themselves.
pub fn gather<const D: usize, K: Kinematics<D>>(mesh: &Mesh<D>, stencil: &Stencil<D>, state: &mut State<D>) {
    let nodes = mesh.nodes.len();
    let (mut sum, mut weight) = (vec![0.0; nodes], vec![0.0; nodes]);
    state.pressure.resize(nodes + mesh.cells.len(), 0.0);
    for patch in &stencil.patches {
        let cell = patch.cell as usize;
        let kind = mesh.cells.kind[cell];
        for entries in stencil.entries::<K>(patch) {
            let hats = pressure_hats(kind, entries.value);
            for (hat, &n) in hats.iter().zip(&mesh.cells.nodes(cell)[..kind.corner_count()]) {
                sum[n as usize] += entries.weight * hat * state.points.pressure[entries.point];
                weight[n as usize] += entries.weight * hat;
            }
        }
    }
    for ((pressure, sum), weight) in state.pressure.iter_mut().zip(&sum).zip(&weight) {
        if *weight > 0.0 {
            *pressure = sum / weight;
        }
    }
    state.pressure[nodes..].fill(0.0);
    for patch in &stencil.patches {
        let cell = patch.cell as usize;
        let kind = mesh.cells.kind[cell];
        if kind.order() == 1 {
            continue;
        }
        let (mut left, mut all) = (0.0, 0.0);
        for entries in stencil.entries::<K>(patch) {
            let hats = pressure_hats(kind, entries.value);
            let corners = &mesh.cells.nodes(cell)[..kind.corner_count()];
            let there: f64 = hats.iter().zip(corners).map(|(hat, &n)| hat * state.pressure[n as usize]).sum();
            left += entries.weight * (state.points.pressure[entries.point] - there);
            all += entries.weight;
        }
        if all > 0.0 {
            state.pressure[nodes + cell] = left / all;
        }
    }
}
