//! Resampled quadrature: second order with few points, however often the grid is restored.

use crate::bench::{Bench, constant, run};
use crate::fitted::{TALL, Tall, order};
use crate::layout::{Random, at, resample, seeded};
use mpm::kinematics::{Axisymmetric, PlaneStrain};
use mpm::material::{Elasticity, Model, Tresca};
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use mpm::step::{Prescribed, Restore};
use mpm::time_value::TimeValue;
use std::sync::Arc;

const RESAMPLED: Tall = Tall { resampled: true, ..TALL };

#[test]
fn the_column_converges_at_second_order_with_few_points() {
    for (points, bounds) in
        [(16, [2e-3, 3.5e-4, 7e-5, 2e-5]), (9, [2e-3, 3.5e-4, 7e-5, 2e-5]), (4, [4e-3, 7e-4, 1.5e-4, 5e-5])]
    {
        let errors = [8, 16, 32, 64].map(|cells| Tall { cells, points, ..RESAMPLED }.error::<PlaneStrain>());
        println!("{points} points: order {:.2}", order(&errors));
        assert!(errors.iter().zip(bounds).all(|(error, bound)| *error <= bound), "{points} points: {errors:?}");
        assert!(order(&errors) > 1.8, "{points} points: {errors:?}");
    }
}

/// A reset is a projection: four times as many of them leave hardly more behind.
#[test]
fn more_steps_add_little() {
    for (cells, bound) in [(16, 5e-4), (32, 1.5e-4)] {
        for seed in [5, 6] {
            let [few, many] = [40, 160].map(|steps| Tall { cells, steps, seed, ..RESAMPLED }.error::<PlaneStrain>());
            assert!(many <= 2.0 * few && many <= bound, "{cells} cells: {few:e} {many:e}");
        }
    }
}

#[test]
fn other_cells_and_rings_converge_too() {
    for (kind, least) in [(CellKind::T3, 1.2), (CellKind::Q4, 1.2), (CellKind::Q8, 1.5), (CellKind::Q9, 1.5)] {
        let errors = [8, 16, 32].map(|cells| Tall { kind, cells, ..RESAMPLED }.error::<PlaneStrain>());
        println!("{kind:?}: order {:.2}", order(&errors));
        assert!(order(&errors) > least, "{kind:?}: {errors:?}");
    }
    for (kind, least) in [(CellKind::T6, 1.8), (CellKind::T3, 1.2), (CellKind::Q4, 1.2), (CellKind::Q9, 1.5)] {
        let errors = [8, 16, 32].map(|cells| Tall { kind, cells, ..RESAMPLED }.error::<Axisymmetric>());
        println!("{kind:?} ring: order {:.2}", order(&errors));
        assert!(order(&errors) > least, "{kind:?}: {errors:?}");
    }
}

/// Clay between rough plates that come together, restored in every step: points anywhere give the load that the points of a
/// regular seed give.
#[test]
fn soil_that_yields_bears_the_same_wherever_its_points_are() {
    let squeeze = |moved: bool| {
        let mesh = rectangle(CellKind::T6, 4.0, 1.0, 16, 4, 0.1, 3);
        let model: Arc<dyn Model> =
            Arc::new(Tresca::new(Elasticity::new(constant(1000.0), 0.3).unwrap(), constant(1.0)).unwrap());
        let mut bench = Bench::new(mesh, model);
        bench.restore = Restore::EveryStep;
        bench.steps = 40;
        bench.hold("bottom", &[0, 1]).hold("left", &[0]);
        for component in [0, 1] {
            let way = if component == 1 { -0.02 } else { 0.0 };
            let displacement = TimeValue::Rate(way);
            bench.prescribed.push(Prescribed { fixed: bench.on("top", component), displacement });
        }
        resample::<PlaneStrain>(&mut bench);
        // With room for what is squeezed out.
        let mut places: Vec<_> = seeded(&bench.mesh, 9).into_iter().filter(|(x, _)| x[0] < 3.0).collect();
        let mut random = Random(7);
        if moved {
            places.iter_mut().for_each(|(x, _)| *x = x.map(|x| x + 0.02 * random.next()));
        }
        let top = bench.mesh.group("top").unwrap().nodes.clone();
        let points = at::<PlaneStrain>(&bench.mesh, &places, 1.0);
        let scene = bench.scene::<PlaneStrain>();
        let mut load = 0.0;
        run::<PlaneStrain>(&scene, points, |_, report| {
            load = top.iter().map(|&n| -report.reaction[n as usize][1]).sum::<f64>();
        });
        load
    };
    let [regular, moved] = [false, true].map(squeeze);
    println!("{regular:.4} kN with regular points, {moved:.4} kN with moved ones");
    assert!(regular > 4.0 && (moved / regular - 1.0).abs() < 0.01, "{regular} {moved}");
}
