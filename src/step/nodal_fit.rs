//! Projection of the values of points to a continuous field of corner values at a grid reset (docs/theory.md, sections 10 and 11): at each
//! corner by weighted least squares, the linear function that fits the points around it best, weighted by its linear shape function.

use crate::interpolation::Interpolation;
use crate::kinematics::Kinematics;
use crate::mesh::{Mesh, cell_size};
use crate::points::Points;
use crate::term::{Frame, pressure_shapes};
use nalgebra::{SMatrix, SVector};

/// Least variance (-) of the positions of the points of a node, over the square of the size of the cell: points too close together to
/// determine a gradient yield none.
const SPREAD: f64 = 1e-6;

/// Passes: each projects the difference that the passes before have left.
const ROUNDS: usize = 3;

/// Cells and the points in them.
#[derive(Clone, Copy)]
pub struct Filled<'a, const D: usize> {
    pub mesh: &'a Mesh<D>,
    pub interpolation: &'a Interpolation<D>,
    pub points: &'a Points<D>,
}

impl<'a, const D: usize> From<Frame<'a, D>> for Filled<'a, D> {
    fn from(Frame { mesh, interpolation, points, .. }: Frame<'a, D>) -> Self {
        Self { mesh, interpolation, points }
    }
}

/// Weighted sums over the points around a node; in the end moments about their centre.
#[derive(Clone)]
struct Around<const D: usize> {
    weight: f64,
    place: SVector<f64, D>,
    value: f64,
    spread: SMatrix<f64, D, D>,
    slope: SVector<f64, D>,
    node: SVector<f64, D>,
    size: f64,
}

/// Corrects a nodal `field` by the difference between the `value` of the points that have one and the field there. A field whose points have
/// not moved does not change, nor does a linear one where the points around each node tell its gradient: in a sliver with a line of points they do
/// not. Nodes without points keep their values.
pub fn fit<const D: usize, K: Kinematics<D>>(
    cells: &[Filled<D>],
    value: impl Fn(&Points<D>, usize) -> Option<f64>,
    field: &mut [f64],
) {
    for _ in 0..ROUNDS {
        correct::<D, K>(cells, &value, field);
    }
}

fn correct<const D: usize, K: Kinematics<D>>(
    cells: &[Filled<D>],
    value: &impl Fn(&Points<D>, usize) -> Option<f64>,
    field: &mut [f64],
) {
    let nothing = Around {
        weight: 0.0,
        place: SVector::zeros(),
        value: 0.0,
        spread: SMatrix::zeros(),
        slope: SVector::zeros(),
        node: SVector::zeros(),
        size: 0.0,
    };
    let mut around = vec![nothing; field.len()];
    visit::<D, K>(cells, value, field, |filled, cell, n, weight, p, missing| {
        let around = &mut around[n];
        around.node = SVector::from(filled.mesh.nodes[n]);
        around.size = around.size.max(cell_size(filled.mesh, cell));
        around.weight += weight;
        around.place += weight * SVector::from(filled.points.position[p]);
        around.value += weight * missing;
    });
    for around in around.iter_mut().filter(|around| around.weight > 0.0) {
        around.place /= around.weight;
        around.value /= around.weight;
        around.spread = SMatrix::identity() * (SPREAD * around.size.powi(2) * around.weight);
    }
    visit::<D, K>(cells, value, field, |filled, _, n, weight, p, missing| {
        let around = &mut around[n];
        let from = SVector::from(filled.points.position[p]) - around.place;
        around.spread += weight * from * from.transpose();
        around.slope += weight * (missing - around.value) * from;
    });
    for (value, around) in field.iter_mut().zip(&around).filter(|(_, around)| around.weight > 0.0) {
        let gradient = around.spread.try_inverse().map_or(SVector::zeros(), |inverse| inverse * around.slope);
        *value += around.value + gradient.dot(&(around.node - around.place));
    }
}

/// Calls `see` with each cell, corner and point in it that has a value, the weight of the point times the linear shape function of the
/// corner, and the difference of its value from the field.
fn visit<const D: usize, K: Kinematics<D>>(
    cells: &[Filled<D>],
    value: &impl Fn(&Points<D>, usize) -> Option<f64>,
    field: &[f64],
    mut see: impl FnMut(&Filled<D>, usize, usize, f64, usize, f64),
) {
    for filled in cells {
        for cell_points in &filled.interpolation.filled {
            let cell = cell_points.cell as usize;
            let kind = filled.mesh.cells.kind[cell];
            for entries in filled.interpolation.entries::<K>(cell_points) {
                let Some(value) = value(filled.points, entries.point) else { continue };
                let shapes = pressure_shapes(kind, entries.shape);
                let corners = || shapes.iter().zip(&filled.mesh.cells.nodes(cell)[..kind.corner_count()]);
                let there: f64 = corners().map(|(shape, &n)| shape * field[n as usize]).sum();
                for (shape, &n) in corners() {
                    see(filled, cell, n as usize, entries.weight * shape, entries.point, value - there);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::interpolation::Mpm;
    use crate::kinematics::{Axisymmetric, PlaneStrain};
    use crate::material::Profile;
    use crate::mesh::builder::rectangle;
    use crate::mesh::locate::Locator;
    use crate::mesh::shape::CellKind;
    use crate::seed::{RegionSeed, seed};

    /// The largest errors of the fit to the points left of `end` (m) in a mesh of `kind`, `each` a cell, of a constant and of a linear field, at the
    /// corners of cells with points, over the largest value.
    fn errors<K: Kinematics<2>>(kind: CellKind, each: u32, end: f64) -> [f64; 2] {
        // Far from the origin, in small cells that are not regular; in axisymmetry from the axis on.
        let mesh = rectangle(kind, 0.004, 0.003, 4, 3, 0.2, 7);
        let density = Profile::constant(1.0);
        let all = seed(&mesh, K::HOOP, &[RegionSeed { region: 0, points_per_cell: each, density }]).unwrap();
        let inside: Vec<usize> = (0..all.len()).filter(|&p| all.position[p][0] < end).collect();
        let points = all.select(&inside);
        let locator = Locator::new(&mesh);
        let xi: Vec<_> = points.position.iter().map(|x| locator.locate(&mesh, x, None).unwrap().1).collect();
        let mut interpolation = Interpolation::default();
        interpolation.fill::<K>(&Mpm, &mesh, &points.cell, &xi, &vec![true; mesh.cells.len()]);
        interpolation.weigh(&points.initial_volume);
        let cells = Filled { mesh: &mesh, interpolation: &interpolation, points: &points };
        let fields: [fn(&[f64; 2]) -> f64; 2] = [|_| -3.0e4, |x| 200.0 - 7.0e4 * x[0] + 5.0e4 * x[1]];
        fields.map(|exact| {
            let mut field = vec![0.0; mesh.nodes.len()];
            fit::<2, K>(&[cells], |points, p| Some(exact(&points.position[p])), &mut field);
            let corners = points.cell.iter().flat_map(|&c| {
                let kind = mesh.cells.kind[c as usize];
                mesh.cells.nodes(c as usize)[..kind.corner_count()].iter()
            });
            let size = points.position.iter().map(|x| exact(x).abs()).fold(0.0, f64::max);
            let error = |&n: &u32| (field[n as usize] - exact(&mesh.nodes[n as usize])).abs() / size;
            corners.map(error).fold(0.0, f64::max)
        })
    }

    /// In full cells both come back, beside the axis, too. Where the body ends within cells, the points around some nodes do not tell a gradient:
    /// there a constant comes back.
    #[test]
    fn constant_and_linear_fields_come_back() {
        for kind in [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q9] {
            for each in if kind.is_simplex() { [3, 6, 12] } else { [4, 9, 16] } {
                for [constant, linear] in
                    [errors::<PlaneStrain>(kind, each, 1.0), errors::<Axisymmetric>(kind, each, 1.0)]
                {
                    assert!(constant < 1e-12 && linear < 1e-4, "{kind:?} {each}: {constant:.1e} {linear:.1e}");
                }
                let [constant, _] = errors::<PlaneStrain>(kind, each, 0.0022);
                assert!(constant < 1e-12, "{kind:?} {each}: {constant:.1e}");
            }
        }
    }
}
