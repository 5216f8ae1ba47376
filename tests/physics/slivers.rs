//! Thin parts of cells: the edge of a body goes over the edge of a cell, from 0.3 of it down to 1e-12.

use crate::bench::{Bench, constant, run};
use crate::layout::{at, fit};
use mpm::kinematics::PlaneStrain;
use mpm::material::{Elasticity, LinearElastic, Model};
use mpm::mesh::builder::rectangle;
use mpm::mesh::faces::Faces;
use mpm::mesh::shape::CellKind;
use mpm::points::Points;
use mpm::step::{Grid, Restore, Scene, State};
use mpm::system::{Matrix, Workspace};
use mpm::term::{Assembly, GhostPenalty, Internal, Trial};
use nalgebra::{DMatrix, SymmetricEigen};
use std::sync::Arc;

const YOUNG: f64 = 1e3;

fn elastic(young: f64) -> Arc<dyn Model> {
    Arc::new(LinearElastic::new(Elasticity::new(constant(young), 0.3).unwrap()))
}

/// A block 2 m long and 1 m high on the bottom of a grid of cells of 1 m or so, pushed sideways by its weight.
fn bench() -> Bench {
    let mut bench = Bench::new(rectangle(CellKind::T6, 6.0, 3.0, 6, 3, 0.15, 2), elastic(YOUNG));
    bench.restore = Restore::EveryStep;
    bench.gravity = [10.0, -10.0];
    bench.density = 1.0;
    bench
}

/// Points 0.2 m apart whose last column is at `end`; the first is between 0.9 and 1.1 m.
fn block(bench: &Bench, end: f64) -> Points<2> {
    let places: Vec<_> = (0..11 * 5)
        .map(|k| ([end - 0.2 * f64::from(k % 11), 0.1 + 0.2 * f64::from(k / 11)], 0.04))
        .collect();
    at::<PlaneStrain>(&bench.mesh, &places, 1.0)
}

/// The ratio of the largest to the least eigenvalue of the tangent at the start, among the degrees that are free.
fn condition(scene: &Scene<2>, points: Points<2>) -> f64 {
    let mut state = State::new(points, scene.mesh.nodes.len(), 1.0);
    let grid = Grid::first::<PlaneStrain>(scene, &mut state).unwrap();
    let zero = vec![[0.0; 2]; scene.mesh.nodes.len()];
    let trial = Trial {
        displacement: &zero,
        between: &zero,
        alpha_f: 0.0,
        converged: &zero,
        pressure: &[],
        converged_pressure: &[],
        acceleration: &[],
        acceleration_slope: 0.0,
        phase: 0,
        time: 1.0,
    };
    let pattern = &grid.motion.pattern;
    let (mut matrix, mut workspace) = (Matrix::new(pattern), Workspace::default());
    let mut force = vec![0.0; pattern.len()];
    let frame = grid.frame(&scene.mesh, &state.points, &state.weighing);
    for term in &scene.terms {
        let mut out = Assembly { force: &mut force, tangent: Some(&mut matrix), workspace: &mut workspace };
        term.assemble(&frame, &trial, &mut out).unwrap();
    }
    let mut free = vec![true; pattern.len()];
    for fixed in scene.fixed(0) {
        for &n in fixed.nodes.iter().filter(|n| grid.block[**n as usize] != u32::MAX) {
            free[grid.block[n as usize] as usize * 2 + fixed.component] = false;
        }
    }
    let free: Vec<usize> = (0..pattern.len()).filter(|&e| free[e]).collect();
    let mut dense = DMatrix::zeros(free.len(), free.len());
    let (mut x, mut y) = (vec![0.0; pattern.len()], vec![0.0; pattern.len()]);
    for (j, &column) in free.iter().enumerate() {
        x[column] = 1.0;
        matrix.multiply(pattern, &x, &mut y);
        x[column] = 0.0;
        for (i, &row) in free.iter().enumerate() {
            dense[(i, j)] = y[row];
        }
    }
    let values = SymmetricEigen::new(dense).eigenvalues;
    values.max() / values.min()
}

/// Mean and largest displacement of the points, and the iterations.
fn push(scene: &Scene<2>, points: Points<2>) -> (f64, f64, usize) {
    let mut iterations = 0;
    let p = run::<PlaneStrain>(scene, points, |_, report| iterations += report.iterations()).points;
    let moved = |i: usize| (p.position[i][0] - p.origin[i][0]).hypot(p.position[i][1] - p.origin[i][1]);
    let all = (0..p.len()).map(moved);
    (all.clone().sum::<f64>() / p.len() as f64, all.fold(0.0, f64::max), iterations)
}

#[test]
fn explore_slivers() {
    for fitted in [true, false] {
        for centre in [true, false] {
            for k in -3i32..60 {
                // The last points, or the surface 0.1 m beyond them, go over the edge at 3 m.
                let shift = if k < 0 {
                    -1e-12 * 10f64.powi(5 * (-1 - k))
                } else {
                    0.3 * (1e-12f64 / 0.3).powf(f64::from(k) / 59.0)
                };
                let end = 3.0 + shift - if centre { 0.0 } else { 0.1 };
                let make = || {
                    let mut bench = bench();
                    for x in &mut bench.mesh.nodes {
                        // The edge at 3 m is straight.
                        if (x[0] - 3.0).abs() < 0.2 {
                            x[0] = 3.0;
                        }
                    }
                    crate::layout::straighten(&mut bench.mesh);
                    if fitted {
                        fit::<PlaneStrain>(&mut bench);
                    }
                    bench.hold("bottom", &[0, 1]);
                    let points = block(&bench, end);
                    (bench.scene::<PlaneStrain>(), points)
                };
                let (scene, points) = make();
                let condition = condition(&scene, points.clone());
                let (mean, most, iterations) = push(&scene, points);
                if k % 6 == 0 || k < 3 {
                    println!(
                        "fitted {fitted}, points {centre}, {shift:+.1e}: condition {condition:.2e}, moved {mean:.6e} {most:.6e}, {iterations} iterations"
                    );
                }
            }
        }
    }
}

#[test]
fn explore_contrast() {
    for stiff in [1.0, 1e3, 1e6] {
        for (soft_first, end) in [(true, 3.001), (false, 3.001), (true, 3.2), (false, 3.2)] {
            let mut bench = bench();
            bench.quadrature = Some(Box::new(mpm::quadrature::Fitted::<PlaneStrain>::new(&bench.mesh)));
            let models = if soft_first {
                vec![Some(elastic(YOUNG)), Some(elastic(stiff * YOUNG))]
            } else {
                vec![Some(elastic(stiff * YOUNG)), Some(elastic(YOUNG))]
            };
            let faces = Faces::of(&bench.mesh).inner.len();
            bench.extra.push(Box::new(GhostPenalty::<PlaneStrain>::new(0.1, models.clone(), faces)));
            bench.mesh.regions.push("other".into());
            bench.hold("bottom", &[0, 1]);
            let mut points = block(&bench, end);
            for i in 0..points.len() {
                points.region[i] = u16::from(points.position[i][0] > end - 0.5);
            }
            let mut scene = bench.scene::<PlaneStrain>();
            scene.terms[0] = Box::new(Internal::<PlaneStrain>::new(models, false));
            scene.stiffness_scale *= stiff;
            let condition = condition(&scene, points.clone());
            println!("contrast {stiff:e}, soft first {soft_first}, {end}: condition {condition:.1e}, {:?}", push(&scene, points));
        }
    }
}

#[test]
fn explore_single() {
    for y in [0.5, 1.5, 2.5] {
        for x in [3.000001, 3.4, 4.4, 5.5] {
            let mut bench = bench();
            fit::<PlaneStrain>(&mut bench);
            bench.hold("bottom", &[0, 1]);
            let block = block(&bench, 2.85);
            let mut places: Vec<_> = block.position.iter().map(|x| (*x, 0.04)).collect();
            places.push(([x, y], 0.04));
            let points = at::<PlaneStrain>(&bench.mesh, &places, 1.0);
            let scene = bench.scene::<PlaneStrain>();
            let condition = condition(&scene, points.clone());
            println!("a point at {x}, {y}: condition {condition:.1e}, {:?}", push(&scene, points));
        }
    }
}

#[test]
fn explore_flight() {
    let mut bench = Bench::new(rectangle(CellKind::T6, 10.0, 8.0, 10, 8, 0.2, 2), elastic(YOUNG));
    bench.restore = Restore::EveryStep;
    bench.dynamic = true;
    bench.gravity = [0.0, -10.0];
    bench.duration = 1.0;
    bench.steps = 100;
    bench.spectral_radius = 0.8;
    fit::<PlaneStrain>(&mut bench);
    bench.hold("bottom", &[0, 1]);
    let mut places: Vec<_> = block(&bench, 3.15).position.iter().map(|x| (*x, 0.04)).collect();
    places.push(([4.7, 2.1], 0.04));
    let mut points = at::<PlaneStrain>(&bench.mesh, &places, 1.0);
    points.velocity = vec![[0.0; 2]; points.len()];
    let last = points.len() - 1;
    points.velocity[last] = [3.0, 5.0];
    let scene = bench.scene::<PlaneStrain>();
    let (mut worst, mut iterations, mut stress) = (0f64, 0, 0f64);
    run::<PlaneStrain>(&scene, points, |state, report| {
        let (t, x) = (state.time, state.points.position[last]);
        worst = worst.max((x[0] - 4.7 - 3.0 * t).hypot(x[1] - 2.1 - 5.0 * t + 5.0 * t * t));
        iterations = iterations.max(report.iterations());
        stress = stress.max(state.points.stress[last].iter().fold(0.0, |a: f64, s| a.max(s.abs())));
    });
    println!("in flight: {worst:.1e} m off its parabola, at most {iterations} iterations, stress {stress:.1e}");
}
