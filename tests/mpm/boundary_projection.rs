//! Points that got beyond the boundary of the mesh: those next to a support are put back onto it.

use crate::support::bench::{Bench, constant, quadrature_points};
use crate::support::layout::resample;
use mpm::error::Result;
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::material::{Elasticity, LinearElastic};
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use mpm::step::{Controller, Prescribed, Restore, Simulation, State};
use mpm::time_value::TimeValue;
use std::sync::Arc;

/// Size of the cells (m), whose diagonal is √2 times that.
const H: f64 = 0.25;

/// A step at rest of a square of 1 m, smooth on the bottom, rough on the left, with the top's motion prescribed and the right
/// free, once the points nearest to the places `from` have been taken to the places `to` (m). Returns their numbers as well.
fn taken<K: Kinematics<2> + 'static>(
    resampled: bool,
    moves: &[([f64; 2], [f64; 2])],
) -> (Vec<usize>, Result<State<2>>) {
    let model = LinearElastic::new(Elasticity::new(constant(100.0), 0.3).unwrap());
    let mut bench = Bench::new(rectangle(CellKind::Q9, 1.0, 1.0, 4, 4, 0.0, 1), Arc::new(model));
    bench.restore = Restore::EveryStep;
    bench.dynamic = true;
    bench.steps = 2;
    if resampled {
        resample::<K>(&mut bench);
    }
    bench.hold("bottom", &[1]).hold("left", &[0, 1]).hold("top", &[0, 1]);
    bench.prescribed.push(Prescribed { fixed: bench.on("top", 1), displacement: TimeValue::Constant(0.0) });
    let points = quadrature_points::<K>(&bench.mesh, 4, 1.0);
    let scene = bench.scene::<K>();
    let first = State::new(points, scene.mesh.nodes.len(), 0.5);
    let mut simulation = Simulation::<2, K>::new(&scene, first).unwrap();
    let phase = &scene.phases[0];
    let mut controller = Controller::new(phase.step, phase.stops.clone(), phase.step.initial);
    simulation.advance(&mut controller).unwrap();
    assert!(simulation.state.weights.notes.is_empty());
    let place = &mut simulation.state.points.position;
    let mut numbers = Vec::new();
    for (from, to) in moves {
        let away = |p: &usize| (place[*p][0] - from[0]).hypot(place[*p][1] - from[1]);
        let nearest = (0..place.len()).min_by(|a, b| away(a).total_cmp(&away(b))).unwrap();
        place[nearest] = *to;
        numbers.push(nearest);
    }
    let end = simulation.advance(&mut controller).map(|_| simulation.state);
    (numbers, end)
}

#[test]
fn points_a_little_beyond_a_support_are_put_onto_it() {
    for resampled in [false, true] {
        let moves = [
            ([0.4, 0.0], [0.41, -0.14 * H]),
            ([0.0, 0.6], [-0.05 * H, 0.63]),
            ([0.0, 0.0], [-0.03 * H, -0.04 * H]),
            ([0.9, 0.1], [0.8, 0.1]),
        ];
        let (numbers, end) = taken::<PlaneStrain>(resampled, &moves);
        let end = end.unwrap_or_else(|error| panic!("{error}"));
        // Square to the side; at the corner there is one place; a point within stays where it is.
        for (p, expected) in numbers.iter().zip([[0.41, 0.0], [0.0, 0.63], [0.0, 0.0], [0.8, 0.1]]) {
            let x = end.points.position[*p];
            assert!((x[0] - expected[0]).hypot(x[1] - expected[1]) < 1e-9, "{x:?} for {expected:?}");
        }
        let note = end.weights.notes.concat();
        assert!(note.contains("3 points were put back") && note.contains("3.5e-2 m"), "{note}");
        // Nothing else moved, and nothing gained stress or motion.
        let largest = |columns: &[[f64; 2]]| columns.iter().flatten().fold(0f64, |a, v| a.max(v.abs()));
        assert!(largest(&end.points.velocity) < 1e-9 && largest(&end.displacement) < 1e-9);
    }
}

#[test]
fn points_far_beyond_a_support_and_more_than_a_few_beyond_anything_else_have_left_the_grid() {
    let beyond = |y: f64| ([1.0, y], [1.0 + 0.02 * H, y]);
    let lost = [
        ("far below the support", vec![([0.4, 0.0], [0.4, -0.143 * H])]),
        ("far beyond the free side", vec![([1.0, 0.4], [1.0 + 0.143 * H, 0.4])]),
        ("two of 144 beyond the free side", vec![beyond(0.2), beyond(0.6)]),
    ];
    for (what, mut moves) in lost {
        let error = taken::<PlaneStrain>(true, &moves).1.map(|_| ()).expect_err(what).to_string();
        assert!(error.contains("left the grid"), "{what}: {error}");
        // One that can be put back does not hide it.
        moves.push(([0.6, 0.0], [0.6, -0.01 * H]));
        let error = taken::<PlaneStrain>(true, &moves).1.map(|_| ()).expect_err(what).to_string();
        assert!(error.contains("left the grid"), "{what}: {error}");
    }
}

#[test]
fn a_single_point_beyond_the_end_of_the_mesh_is_put_back_and_told() {
    let sides = [([1.0, 0.4], [1.0 + 0.02 * H, 0.4], [1.0, 0.4]), ([0.4, 1.0], [0.4, 1.0 + 0.02 * H], [0.4, 1.0])];
    for (from, to, end) in sides {
        let (numbers, state) = taken::<PlaneStrain>(true, &[(from, to)]);
        let state = state.unwrap_or_else(|error| panic!("{error}"));
        let x = state.points.position[numbers[0]];
        assert!((x[0] - end[0]).hypot(x[1] - end[1]) < 1e-9, "{x:?} for {end:?}");
        let told = state.weights.beyond.unwrap();
        assert!(told.contains("beyond the end of the mesh") && told.contains("1 of 144 points by 5.0e-3 m"), "{told}");
        assert!(state.weights.notes.is_empty());
    }
}

/// On the axis of a ring a point would have no volume.
#[test]
fn none_is_put_onto_the_axis() {
    for (from, to) in [([0.0, 0.6], [-0.02 * H, 0.6]), ([0.0, 0.0], [-0.02 * H, -0.02 * H])] {
        let error = taken::<Axisymmetric>(true, &[(from, to)]).1.map(|_| ()).expect_err("beyond the axis").to_string();
        assert!(error.contains("left the grid"), "{error}");
    }
    let (numbers, end) = taken::<Axisymmetric>(true, &[([0.4, 0.0], [0.4, -0.02 * H])]);
    assert!(end.unwrap().points.position[numbers[0]][1].abs() < 1e-9);
}
