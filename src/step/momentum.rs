//! Conservation of momentum between the integration points, over which inertia is summed, and the material points, which carry it
//! (docs/theory.md, section 6, *Momentum*).
//!
//! The masses of both agree in sum, but not node by node, so a nodal field has the momentum `Σ_q m_q N_I a_I` at the integration
//! points and a slightly different one at the material points. A field that is transferred between them is corrected by a rigid motion of
//! each body, such that its linear momentum and its angular momentum about the centre of mass are the same on both sides. A body is a set
//! of cells with material that share nodes. In axisymmetry only the momentum along the axis is conserved.
//!
//! Internal forces have no moment about the positions halfway through the step. So the angular momentum of a velocity increment is taken
//! there.

use super::family::{Family, interpolate};
use super::grid::Grid;
use super::scene::Scene;
use super::state::State;
use crate::kinematics::Kinematics;
use crate::mesh::{Bodies, Mesh};
use crate::points::Points;
use crate::quadrature::Samples;
use rayon::prelude::*;

/// Part (-) of `Σ m |x|²` that rounding may leave of the moment of inertia of a body whose mass is in one place.
const ROUNDING: f64 = 1e-12;

/// Moments of the mass of a body, and its momentum in some field.
#[derive(Clone, Copy)]
struct Momentum<const D: usize> {
    /// `Σ m` (t), `Σ m x` (t m) and `Σ m |x|²` (t m²).
    mass: f64,
    first: [f64; D],
    second: f64,
    linear: [f64; D],
    angular: f64,
}

/// `translation + rotation × x`.
struct Rigid<const D: usize> {
    translation: [f64; D],
    rotation: f64,
}

impl<const D: usize> Rigid<D> {
    fn at(&self, x: &[f64; D]) -> [f64; D] {
        const { assert!(D == 2, "bodies turn by one angle in the plane only") };
        let mut value = self.translation;
        value[0] -= self.rotation * x[1];
        value[1] += self.rotation * x[0];
        value
    }
}

impl<const D: usize> Momentum<D> {
    const ZERO: Self = Self { mass: 0.0, first: [0.0; D], second: 0.0, linear: [0.0; D], angular: 0.0 };

    fn add(&mut self, mass: f64, x: &[f64; D], value: &[f64; D]) {
        const { assert!(D == 2, "angular momentum is a number in the plane only") };
        self.mass += mass;
        for d in 0..D {
            self.first[d] += mass * x[d];
            self.second += mass * x[d] * x[d];
            self.linear[d] += mass * value[d];
        }
        self.angular += mass * (x[0] * value[1] - x[1] * value[0]);
    }

    /// The angular momentum about the centre of mass.
    fn spin(&self) -> f64 {
        self.angular - (self.first[0] * self.linear[1] - self.first[1] * self.linear[0]) / self.mass
    }

    /// The rigid motion that brings the momentum of this body to that of `other`.
    fn towards<K: Kinematics<D>>(&self, other: &Self) -> Rigid<D> {
        let mut rigid = Rigid { translation: [0.0; D], rotation: 0.0 };
        if self.mass <= 0.0 || other.mass <= 0.0 {
            return rigid;
        }
        let lacks: [f64; D] = std::array::from_fn(|d| other.linear[d] - self.linear[d]);
        if K::HOOP {
            rigid.translation[1] = lacks[1] / self.mass;
            return rigid;
        }
        let centre = self.first.map(|s| s / self.mass);
        let inertia = self.second - centre.iter().zip(&self.first).map(|(c, s)| c * s).sum::<f64>();
        if inertia > ROUNDING * self.second {
            rigid.rotation = (other.spin() - self.spin()) / inertia;
        }
        rigid.translation = lacks.map(|l| l / self.mass);
        rigid.translation[0] += rigid.rotation * centre[1];
        rigid.translation[1] -= rigid.rotation * centre[0];
        rigid
    }
}

/// Corrects the `values` of a nodal field at the material points, so that they have its momentum at the integration points. The
/// positions are the present ones less the nodal displacement `back` (m).
pub fn complete_points<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    grid: &Grid<D>,
    state: &State<D>,
    field: &[[f64; D]],
    back: &[[f64; D]],
    values: &mut [[f64; D]],
) {
    let Some(samples) = &state.weights.samples else { return };
    let places = |position: &[[f64; D]], moved: &[[f64; D]]| -> Vec<[f64; D]> {
        position.iter().zip(moved).map(|(x, u)| std::array::from_fn(|d| x[d] - u[d])).collect()
    };
    let bodies = bodies(&scene.mesh, state, samples);
    let moved = at_samples::<D, K>(scene, grid, samples, back);
    let field = at_samples::<D, K>(scene, grid, samples, field);
    let wanted = momentum(&bodies, &samples.points, &places(&samples.points.position, &moved), &field);
    let of_material = grid.family_of_material(scene, state);
    let position = places(&state.points.position, &interpolate::<D, K>(&of_material, back));
    bound(&scene.mesh, (&samples.points, &field), &state.points, values);
    let has = momentum(&bodies, &state.points, &position, values);
    let rigid: Vec<Rigid<D>> = has.iter().zip(&wanted).map(|(has, wanted)| has.towards::<K>(wanted)).collect();
    for ((value, x), &c) in values.iter_mut().zip(&position).zip(&state.points.cell) {
        if let Some(body) = bodies.of_cell(c) {
            let more = rigid[body].at(x);
            (0..D).for_each(|d| value[d] += more[d]);
        }
    }
}

/// Bounds the `values` of a nodal field at material points by those at the integration points of the cells that share nodes with theirs: they lie beyond the
/// range of these by no more than its width. What the equations do not see may be anything: nodes that only a corner of the surface reaches have little
/// mass, and the points beside them would take any velocity.
fn bound<const D: usize>(
    mesh: &Mesh<D>,
    (samples, field): (&Points<D>, &[[f64; D]]),
    points: &Points<D>,
    values: &mut [[f64; D]],
) {
    let nothing = [[f64::INFINITY, f64::NEG_INFINITY]; D];
    let mut of_node = vec![nothing; mesh.nodes.len()];
    let widen = |range: &mut [[f64; 2]; D], by: &[[f64; 2]; D]| {
        range.iter_mut().zip(by).for_each(|(range, by)| *range = [range[0].min(by[0]), range[1].max(by[1])]);
    };
    for (value, &c) in field.iter().zip(&samples.cell) {
        mesh.cells.nodes(c as usize).iter().for_each(|&n| widen(&mut of_node[n as usize], &value.map(|v| [v, v])));
    }
    values.par_iter_mut().zip(&points.cell).with_min_len(256).for_each(|(value, &c)| {
        let mut range = nothing;
        mesh.cells.nodes(c as usize).iter().for_each(|&n| widen(&mut range, &of_node[n as usize]));
        for (value, [low, high]) in value.iter_mut().zip(range) {
            if low <= high {
                *value = value.clamp(2.0 * low - high, 2.0 * high - low);
            }
        }
    });
}

/// Corrects a nodal `field`, so that it has at the integration points the momentum of `values` at the material points.
pub fn complete_nodes<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    grid: &Grid<D>,
    state: &State<D>,
    values: &[[f64; D]],
    field: &mut [[f64; D]],
) {
    let Some(samples) = &state.weights.samples else { return };
    let bodies = bodies(&scene.mesh, state, samples);
    let at_samples = at_samples::<D, K>(scene, grid, samples, field);
    let has = momentum(&bodies, &samples.points, &samples.points.position, &at_samples);
    let wanted = momentum(&bodies, &state.points, &state.points.position, values);
    let rigid: Vec<Rigid<D>> = has.iter().zip(&wanted).map(|(has, wanted)| has.towards::<K>(wanted)).collect();
    add_to_nodes(scene, grid, state, &bodies, &rigid, field);
}

/// Corrects a nodal `field`, so that it has at the material points the momentum of `values` there: what the regularisation of the mapping
/// (eq. 11a) has lost.
pub fn keep_at_nodes<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    grid: &Grid<D>,
    state: &State<D>,
    values: &[[f64; D]],
    field: &mut [[f64; D]],
) {
    let points = &state.points;
    let bodies = Bodies::of(&scene.mesh, points.cell.iter().copied(), &[]);
    let mapped = interpolate::<D, K>(&grid.family_of_material(scene, state), field);
    let [has, wanted] = [&mapped[..], values].map(|values| momentum(&bodies, points, &points.position, values));
    let rigid: Vec<Rigid<D>> = has.iter().zip(&wanted).map(|(has, wanted)| has.towards::<K>(wanted)).collect();
    add_to_nodes(scene, grid, state, &bodies, &rigid, field);
}

/// Adds a rigid motion of each body to a nodal `field`.
fn add_to_nodes<const D: usize>(
    scene: &Scene<D>,
    grid: &Grid<D>,
    state: &State<D>,
    bodies: &Bodies<D>,
    rigid: &[Rigid<D>],
    field: &mut [[f64; D]],
) {
    let mesh = grid.mesh(scene);
    for (n, (value, from)) in field.iter_mut().zip(&mesh.nodes).enumerate() {
        if let Some(body) = bodies.of_node(n) {
            let x: [f64; D] = std::array::from_fn(|d| from[d] + state.displacement[n][d]);
            let more = rigid[body].at(&x);
            (0..D).for_each(|d| value[d] += more[d]);
        }
    }
}

fn at_samples<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    grid: &Grid<D>,
    samples: &Samples<D>,
    field: &[[f64; D]],
) -> Vec<[f64; D]> {
    let (mesh, interpolation, coupling) = (&scene.mesh, &grid.interpolations.integration, &grid.coupling);
    interpolate::<D, K>(&Family { mesh, interpolation, coupling, points: &samples.points }, field)
}

/// The bodies, with the cells outside the surface, in which material points are integration points themselves: nodes that they share with a body are
/// corrected with it.
fn bodies<'a, const D: usize>(mesh: &'a Mesh<D>, state: &State<D>, samples: &'a Samples<D>) -> Bodies<'a, D> {
    let cells = samples.points.cell.iter().chain(&state.points.cell);
    Bodies::of(mesh, cells.copied(), &[])
}

/// The momentum of each body in a field given at points, these being at `position`.
fn momentum<const D: usize>(
    bodies: &Bodies<D>,
    points: &Points<D>,
    position: &[[f64; D]],
    values: &[[f64; D]],
) -> Vec<Momentum<D>> {
    let mut momentum = vec![Momentum::ZERO; bodies.count()];
    for (p, (x, value)) in position.iter().zip(values).enumerate() {
        if let Some(body) = bodies.of_cell(points.cell[p]) {
            momentum[body].add(points.mass[p], x, value);
        }
    }
    momentum
}

#[cfg(test)]
mod tests {
    use super::bound;
    use crate::mesh::builder::rectangle;
    use crate::mesh::shape::CellKind;
    use crate::quadrature::fixture::undeformed;

    /// Three cells in a row, integration points in the first two: values beyond the width of their range are cut off, also in the third cell, and those of a
    /// linear field stay.
    #[test]
    fn values_are_bounded_by_those_that_the_equations_see() {
        let mesh = rectangle(CellKind::Q4, 3.0, 1.0, 3, 1, 0.0, 1);
        let samples = undeformed(&mesh, vec![[0.25, 0.5], [0.75, 0.5], [1.25, 0.5], [1.75, 0.5]], 0.5);
        let linear = |x: &[f64; 2]| [1.0 + 2.0 * x[0], 3.0];
        let field: Vec<[f64; 2]> = samples.position.iter().map(linear).collect();
        let points = undeformed(&mesh, vec![[0.1, 0.5], [1.9, 0.9], [2.1, 0.5], [2.1, 0.5]], 0.5);
        let mut values: Vec<[f64; 2]> = points.position.iter().map(linear).collect();
        values[3] = [100.0, -100.0];
        let mut expected = values.clone();
        // The second cell has 3.5 to 4.5 in the first component, and one value in the other.
        expected[3] = [5.5, 3.0];
        bound(&mesh, (&samples, &field), &points, &mut values);
        assert_eq!(values, expected);
    }
}
