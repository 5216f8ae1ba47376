//! Finite elements that share nodes with the grid: what passes between them and the points.

use crate::analytical::self_weight_column::Column;
use crate::mpm::patch::stretch_boundary;
use crate::support::bench::{Bench, constant, quadrature_points, run_parts};
use crate::support::layout::{at, resample, seeded};
use mpm::case::parts::places;
use mpm::kinematics::PlaneStrain;
use mpm::material::{Elasticity, LinearElastic};
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use mpm::points::Points;
use mpm::step::{Controller, Prescribed, Restore, Simulation, State};
use mpm::time_value::TimeValue;
use std::f64::consts::PI;
use std::sync::Arc;

fn elastic(young: f64, poisson: f64) -> Arc<LinearElastic> {
    Arc::new(LinearElastic::new(Elasticity::new(constant(young), poisson).unwrap()))
}

/// Displacements linear in the coordinates on the boundary of a jittered mesh: the largest error of the deformation gradients.
fn patch(kind: CellKind, restore: Restore, steps: usize, within: impl Fn(&[f64; 2]) -> bool) -> f64 {
    let gradient = [[-0.2, 0.1], [0.05, -0.15]];
    let mut bench = Bench::new(rectangle(kind, 2.0, 1.5, 6, 5, 0.2, 7), elastic(1000.0, 0.3));
    bench.elements_where(within);
    bench.restore = restore;
    bench.steps = steps;
    resample::<PlaneStrain>(&mut bench);
    stretch_boundary(&mut bench, gradient);
    let parts = bench.split(quadrature_points::<PlaneStrain>(&bench.mesh, 4, 1.0));
    assert!(parts.iter().all(|points| !points.is_empty()));
    let state = run_parts::<PlaneStrain>(&bench.scene::<PlaneStrain>(), parts, |_, _| {});
    let mut error = 0f64;
    for f in state.points.deformation.iter().chain(&state.fem.deformation) {
        for i in 0..2 {
            for j in 0..2 {
                error = error.max((f[(i, j)] - f64::from(u8::from(i == j)) - gradient[i][j]).abs());
            }
        }
    }
    error
}

const KINDS: [CellKind; 5] = [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q8, CellKind::Q9];

/// On a grid that stays with the body, and in the first step of one that is restored, whose outer boundary does not move.
#[test]
fn a_uniform_strain_passes_a_slanted_interface() {
    let below = |x: &[f64; 2]| x[1] < 0.4 + 0.4 * x[0];
    for kind in KINDS {
        for (restore, steps) in [(Restore::Never, 3), (Restore::EveryStep, 1)] {
            let e = patch(kind, restore, steps, below);
            assert!(e < 1e-10, "{kind:?} {restore:?}: {e:e}");
        }
    }
}

/// Points within finite elements, the grid relaxed between them in every step: a uniform strain stays uniform while
/// the interface moves by a cell.
#[test]
fn a_uniform_strain_stays_one_on_a_grid_that_is_relaxed() {
    let around = |x: &[f64; 2]| (x[0] - 1.0).abs() > 0.68 || (x[1] - 0.75).abs() > 0.46;
    for kind in [CellKind::T6, CellKind::T3] {
        let e = patch(kind, Restore::EveryStep, 5, around);
        println!("{kind:?}: {e:.1e}");
        assert!(e < 1e-10, "{kind:?}: {e:e}");
    }
}

/// A step that fails while the grid is restored leaves nodes and points where the last converged one had them, so that a smaller step can
/// go on from there.
#[test]
fn a_restoration_that_fails_moves_no_node_and_no_point() {
    let mut bench = Bench::new(rectangle(CellKind::T6, 2.0, 1.0, 8, 4, 0.0, 1), elastic(100.0, 0.0));
    bench.elements_where(|x| x[0] < 1.0);
    bench.restore = Restore::EveryStep;
    bench.steps = 10;
    bench.prescribed.push(Prescribed { fixed: bench.on("left", 0), displacement: TimeValue::Rate(1.0) });
    bench.hold("bottom", &[1]);
    let [points, fem] = bench.split(quadrature_points::<PlaneStrain>(&bench.mesh, 4, 1.0));
    let scene = bench.scene::<PlaneStrain>();
    let fem_parametric = places(&scene.fem.as_ref().unwrap().mesh, &fem).unwrap();
    let first = State { fem, fem_parametric, ..State::new(points, scene.mesh.nodes.len(), 0.1) };
    let mut simulation = Simulation::<2, PlaneStrain>::new(&scene, first).unwrap();
    let phase = &scene.phases[0];
    let mut controller = Controller::new(phase.step, phase.stops.clone(), phase.step.initial);
    let mut before = simulation.state.clone();
    let error = loop {
        match simulation.advance(&mut controller) {
            Ok(_) => before = simulation.state.clone(),
            Err(error) => break error,
        }
    };
    assert!(before.step > 0 && error.to_string().contains("left the grid"), "{error}");
    let now = &simulation.state;
    assert!(now.nodes == before.nodes && now.displacement == before.displacement);
    assert!(now.points.position == before.points.position);
    assert!(now.points.cell == before.points.cell && now.parametric == before.parametric);
}

/// A column under its own weight, its lower half of finite elements, with the grid restored in every step: mean error of the
/// vertical stress over that at the base, and the way of the interface in cells.
fn column(kind: CellKind, cells: usize) -> (f64, f64) {
    const HEIGHT: f64 = 10.0;
    const YOUNG: f64 = 100.0;
    let weight = YOUNG / HEIGHT;
    let h = HEIGHT / cells as f64;
    let mut bench = Bench::new(rectangle(kind, h, HEIGHT, 1, cells, 0.0, 1), elastic(YOUNG, 0.0));
    bench.elements_where(|x| x[1] < 0.5 * HEIGHT);
    bench.density = weight / 10.0;
    bench.gravity = [0.0, -10.0];
    bench.gravity_factor = TimeValue::Rate(1.0);
    bench.restore = Restore::EveryStep;
    bench.steps = 20;
    resample::<PlaneStrain>(&mut bench);
    bench.hold("left", &[0]).hold("right", &[0]).hold("bottom", &[1]);
    let [points, _] = bench.split(at::<PlaneStrain>(&bench.mesh, &seeded(&bench.mesh, 16), bench.density));
    let [_, fem] = bench.split(quadrature_points::<PlaneStrain>(&bench.mesh, 4, bench.density));
    let scene = bench.scene::<PlaneStrain>();
    let State { points, fem, .. } = run_parts::<PlaneStrain>(&scene, [points, fem], |_, _| {});
    let exact = Column { height: HEIGHT, unit_weight: weight, modulus: YOUNG };
    let mut error = 0.0;
    for part in [&points, &fem] {
        for p in 0..part.len() {
            let depth = HEIGHT - part.origin[p][1];
            error += part.initial_volume[p] / (h * HEIGHT)
                * (part.stress[p][1] / exact.stress(HEIGHT) - depth / HEIGHT).abs();
        }
    }
    (error, -exact.displacement(0.5 * HEIGHT) / h)
}

#[test]
fn an_interface_that_moves_by_several_cells_stays_valid() {
    let mut errors = Vec::new();
    for cells in [8, 16, 32] {
        let (error, way) = column(CellKind::T6, cells);
        println!("{cells} cells: stress {error:.2e}, the interface moves by {way:.1} cells");
        errors.push(error);
    }
    assert!(errors[1] < 2e-4 && errors[2] < 0.1 * errors[0], "second order: {errors:?}");
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    /// A pulse `sin²` from the end of a bar of finite elements into points, whose stiffness and mass are the same: the largest
    /// velocity that is left in the elements, over that of the pulse, once it has passed.
    #[test]
    fn a_wave_passes_the_interface() {
        const LENGTH: f64 = 20.0;
        const SPEED: f64 = 10.0;
        const VELOCITY: f64 = 1e-4;
        const WIDTH: f64 = 0.4;
        let h = LENGTH / 160.0;
        let mut bench = Bench::new(rectangle(CellKind::T6, LENGTH, h, 160, 1, 0.0, 1), elastic(SPEED * SPEED, 0.0));
        bench.elements_where(|x| x[0] < 0.5 * LENGTH);
        bench.dynamic = true;
        bench.restore = Restore::EveryStep;
        bench.duration = 1.7;
        bench.steps = 425;
        resample::<PlaneStrain>(&mut bench);
        bench.hold("bottom", &[1]).hold("top", &[1]);
        let moved = |t: f64| VELOCITY * (0.5 * t - WIDTH / (4.0 * PI) * (2.0 * PI * t / WIDTH).sin());
        let table = (0..=100).map(|k| f64::from(k) * WIDTH / 100.0).map(|t| [t, moved(t)]).collect();
        bench.prescribed.push(Prescribed { fixed: bench.on("left", 0), displacement: TimeValue::Table(table) });
        let parts = bench.split(quadrature_points::<PlaneStrain>(&bench.mesh, 4, 1.0));
        let largest = |points: &Points<2>| points.velocity.iter().fold(0f64, |a, v| a.max(v[0].abs())) / VELOCITY;
        let state = run_parts::<PlaneStrain>(&bench.scene::<PlaneStrain>(), parts, |_, _| {});
        println!("{:.2e} stay, {:.4} pass", largest(&state.fem), largest(&state.points));
        assert!(largest(&state.fem) < 0.01 && (largest(&state.points) - 1.0).abs() < 0.01);
    }
}
