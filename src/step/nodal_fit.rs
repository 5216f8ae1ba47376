//! Projection of the values of points to a continuous field of corner values at a grid reset (docs/theory.md, sections 10 and 11): at each
//! corner by weighted least squares, the linear function that fits the points around it best, weighted by its linear shape function.
//!
//! Points that are close together, or in a line, and far from the corner do not tell the value there: a small difference between them would
//! become a large one. So no corner goes farther beyond the values of the points in the cells around it, and in those that share a corner with these,
//! than they differ among themselves. What is interpolated at a point is then of the size of the values of the points.

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
    /// The least and the largest value of the points in the cells around it and in those that share a corner with these.
    range: [f64; 2],
}

impl<const D: usize> Around<D> {
    /// The value nearest to `value` that is not farther beyond those of the points than they differ among themselves.
    fn limited(&self, value: f64) -> f64 {
        let [low, high] = self.range;
        value.max(low - (high - low)).min(high + (high - low))
    }
}

/// A point that a corner of its cell sees.
struct Seen<'a, 'b, const D: usize> {
    filled: &'a Filled<'b, D>,
    cell: usize,
    node: usize,
    /// Its weight times the linear shape function of the corner.
    weight: f64,
    point: usize,
    value: f64,
    /// The difference of its value from the field.
    missing: f64,
}

impl<const D: usize> Seen<'_, '_, D> {
    fn position(&self) -> SVector<f64, D> {
        SVector::from(self.filled.points.position[self.point])
    }
}

/// Corrects a nodal `field` by the difference between the `value` of the points that have one and the field there. A field whose points have
/// not moved does not change, nor does a linear one where the points around each node tell its gradient: in a sliver with a line of points they do
/// not. Nodes without points keep their values; the others keep within reach of the values of their points.
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
        range: [f64::INFINITY, f64::NEG_INFINITY],
    };
    let mut around = vec![nothing; field.len()];
    visit::<D, K>(cells, value, field, |seen| {
        let around = &mut around[seen.node];
        around.node = SVector::from(seen.filled.mesh.nodes[seen.node]);
        around.size = around.size.max(cell_size(seen.filled.mesh, seen.cell));
        around.weight += seen.weight;
        around.place += seen.weight * seen.position();
        around.value += seen.weight * seen.missing;
        around.range = [around.range[0].min(seen.value), around.range[1].max(seen.value)];
    });
    for around in around.iter_mut().filter(|around| around.weight > 0.0) {
        around.place /= around.weight;
        around.value /= around.weight;
        around.spread = SMatrix::identity() * (SPREAD * around.size.powi(2) * around.weight);
    }
    visit::<D, K>(cells, value, field, |seen| {
        let around = &mut around[seen.node];
        let from = seen.position() - around.place;
        around.spread += seen.weight * from * from.transpose();
        around.slope += seen.weight * (seen.missing - around.value) * from;
    });
    widen(cells, &mut around);
    for (value, around) in field.iter_mut().zip(&around).filter(|(_, around)| around.weight > 0.0) {
        let gradient = around.spread.try_inverse().map_or(SVector::zeros(), |inverse| inverse * around.slope);
        *value = around.limited(*value + around.value + gradient.dot(&(around.node - around.place)));
    }
}

/// Widens the range of each corner to those of the other corners of its cells. Where the surface cuts the cells so that a single row of points is left in
/// them, the points of the row beneath tell how much a linear field may change.
fn widen<const D: usize>(cells: &[Filled<D>], around: &mut [Around<D>]) {
    let own: Vec<[f64; 2]> = around.iter().map(|around| around.range).collect();
    for filled in cells {
        for cell_points in &filled.interpolation.filled {
            let cell = cell_points.cell as usize;
            let corners = filled.mesh.cells.corners(cell);
            let ranges = corners.iter().map(|&n| own[n as usize]);
            let whole = ranges.fold([f64::INFINITY, f64::NEG_INFINITY], |a, b| [a[0].min(b[0]), a[1].max(b[1])]);
            for &n in corners {
                let range = &mut around[n as usize].range;
                *range = [range[0].min(whole[0]), range[1].max(whole[1])];
            }
        }
    }
}

/// Calls `see` with each point that has a value and each corner of its cell that it has a share in. A point on a side of its cell may be
/// outside by rounding: negative shares would make the weight of a corner that has no other points anything.
fn visit<const D: usize, K: Kinematics<D>>(
    cells: &[Filled<D>],
    value: &impl Fn(&Points<D>, usize) -> Option<f64>,
    field: &[f64],
    mut see: impl FnMut(&Seen<D>),
) {
    for filled in cells {
        for cell_points in &filled.interpolation.filled {
            let cell = cell_points.cell as usize;
            let kind = filled.mesh.cells.kind[cell];
            for entries in filled.interpolation.entries::<K>(cell_points) {
                let point = entries.point;
                let Some(value) = value(filled.points, point) else { continue };
                let shapes = pressure_shapes(kind, entries.shape);
                let corners = || shapes.iter().zip(filled.mesh.cells.corners(cell));
                let there: f64 = corners().map(|(shape, &n)| shape * field[n as usize]).sum();
                for (shape, &n) in corners().filter(|(shape, _)| **shape > 0.0) {
                    let (node, weight, missing) = (n as usize, entries.weight * shape, value - there);
                    see(&Seen { filled, cell, node, weight, point, value, missing });
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

    /// The interpolation of points that are in their cells.
    fn located<K: Kinematics<2>>(mesh: &Mesh<2>, points: &Points<2>) -> Interpolation<2> {
        let locator = Locator::new(mesh);
        let xi: Vec<_> = points.position.iter().map(|x| locator.locate(mesh, x, None).unwrap().1).collect();
        let mut interpolation = Interpolation::default();
        interpolation.fill::<K>(&Mpm, mesh, &points.cell, &xi, &vec![true; mesh.cells.len()]);
        interpolation.weigh(&points.initial_volume);
        interpolation
    }

    /// The largest errors of the fit to the points left of `end` (m) in a mesh of `kind`, `each` a cell, of a constant and of a linear field, at the
    /// corners of cells with points, over the largest value.
    fn errors<K: Kinematics<2>>(kind: CellKind, each: u32, end: f64) -> [f64; 2] {
        // Far from the origin, in small cells that are not regular; in axisymmetry from the axis on.
        let mesh = rectangle(kind, 0.004, 0.003, 4, 3, 0.2, 7);
        let density = Profile::constant(1.0);
        let all = seed(&mesh, K::HOOP, &[RegionSeed { region: 0, points_per_cell: each, density }]).unwrap();
        let inside: Vec<usize> = (0..all.len()).filter(|&p| all.position[p][0] < end).collect();
        let points = all.select(&inside);
        let interpolation = located::<K>(&mesh, &points);
        let cells = Filled { mesh: &mesh, interpolation: &interpolation, points: &points };
        let fields: [fn(&[f64; 2]) -> f64; 2] = [|_| -3.0e4, |x| 200.0 - 7.0e4 * x[0] + 5.0e4 * x[1]];
        fields.map(|exact| {
            let mut field = vec![0.0; mesh.nodes.len()];
            fit::<2, K>(&[cells], |points, p| Some(exact(&points.position[p])), &mut field);
            let corners = points.cell.iter().flat_map(|&c| mesh.cells.corners(c as usize));
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

    /// Points close together in a corner of the only cell with points, with values that differ a little: an extrapolation by the gradient that they
    /// tell would be a hundred times the difference at the far corners. The field may also have large values from before.
    #[test]
    fn points_that_tell_no_gradient_yield_no_large_values() {
        for kind in [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q9] {
            let mesh = rectangle(kind, 1.0, 1.0, 1, 1, 0.0, 7);
            let density = Profile::constant(1.0);
            let each = if kind.is_simplex() { 3 } else { 4 };
            let all = seed(&mesh, false, &[RegionSeed { region: 0, points_per_cell: each, density }]).unwrap();
            let mut points = all.select(&[0, 1]);
            let near = points.position[0];
            points.position[1] = [near[0] + 0.01, near[1] + 0.002];
            let interpolation = located::<PlaneStrain>(&mesh, &points);
            let cells = Filled { mesh: &mesh, interpolation: &interpolation, points: &points };
            for before in [0.0, -4.0e5] {
                let mut field = vec![before; mesh.nodes.len()];
                fit::<2, PlaneStrain>(&[cells], |_, p| Some(20.0 + p as f64), &mut field);
                for &n in &mesh.cells.nodes(points.cell[0] as usize)[..kind.corner_count()] {
                    assert!((19.0..=22.0).contains(&field[n as usize]), "{kind:?}: {field:?}");
                }
            }
        }
    }

    /// A linear field of points that have not moved stays, also where a level surface has left one row of points in the upper cells, whose values are equal.
    #[test]
    fn a_field_stays_above_a_single_row_of_points() {
        for kind in [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q9] {
            let mesh = rectangle(kind, 4.0, 3.0, 4, 3, 0.0, 7);
            let density = Profile::constant(1.0);
            let each = if kind.is_simplex() { 3 } else { 4 };
            let all = seed(&mesh, false, &[RegionSeed { region: 0, points_per_cell: each, density }]).unwrap();
            let beneath = |x: f64| all.position.iter().map(|p| p[1]).filter(|&y| y > x).fold(f64::INFINITY, f64::min);
            let row = beneath(2.0);
            let inside: Vec<usize> = (0..all.len()).filter(|&p| all.position[p][1] < row + 1e-9).collect();
            let points = all.select(&inside);
            let interpolation = located::<PlaneStrain>(&mesh, &points);
            let cells = Filled { mesh: &mesh, interpolation: &interpolation, points: &points };
            let depth = |x: &[f64; 2]| 20.0 * (row - x[1]);
            let start: Vec<f64> = mesh.nodes.iter().map(depth).collect();
            let mut field = start.clone();
            fit::<2, PlaneStrain>(&[cells], |points, p| Some(depth(&points.position[p])), &mut field);
            for (n, (now, before)) in field.iter().zip(&start).enumerate() {
                assert!((now - before).abs() < 1e-9, "{kind:?}, {:?}: {before} to {now}", mesh.nodes[n]);
            }
        }
    }

    /// A point that rounding has put outside of its cell has a negative share in a corner: it does not make up the weight of that.
    #[test]
    fn a_point_that_rounding_puts_outside_its_cell_does_not_change_the_far_corners() {
        let mesh = rectangle(CellKind::Q4, 1.0, 1.0, 1, 1, 0.0, 7);
        let density = Profile::constant(1.0);
        let all = seed(&mesh, false, &[RegionSeed { region: 0, points_per_cell: 4, density }]).unwrap();
        let points = all.select(&[0, 1]);
        let mut interpolation = Interpolation::default();
        // The shares of the two in the upper corners nearly cancel: their sum is a tenth of rounding.
        let xi = [[-0.5, -1.0 - 1.0e-13, 0.0], [-0.5, -1.0 + 1.1e-13, 0.0]];
        interpolation.fill::<PlaneStrain>(&Mpm, &mesh, &points.cell, &xi, &[true]);
        interpolation.weigh(&points.initial_volume);
        let cells = Filled { mesh: &mesh, interpolation: &interpolation, points: &points };
        let mut field = vec![0.0; mesh.nodes.len()];
        fit::<2, PlaneStrain>(&[cells], |_, p| Some(20.0 + p as f64), &mut field);
        assert!(field.iter().all(|v| (19.0..=22.0).contains(v)), "{field:?}");
    }
}
