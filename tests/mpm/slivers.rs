//! Thin parts of cells: what holds little material neither fails nor makes the rest fail.

use crate::support::bench::{Bench, constant, run};
use crate::support::layout::{at, resample, straighten};
use mpm::kinematics::PlaneStrain;
use mpm::material::{Elasticity, LinearElastic, Model};
use mpm::mesh::builder::rectangle;
use mpm::mesh::faces::Faces;
use mpm::mesh::shape::CellKind;
use mpm::points::Points;
use mpm::quadrature::Resampled;
use mpm::step::{Grid, Restore, Scene, State};
use mpm::system::{Matrix, Workspace};
use mpm::term::{Assembly, Frozen, GhostPenalty, Internal, Trial};
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
    let places: Vec<_> =
        (0..11 * 5).map(|k| ([end - 0.2 * f64::from(k % 11), 0.1 + 0.2 * f64::from(k / 11)], 0.04)).collect();
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
        geometry: None,
        pressure: &[],
        converged_pressure: &[],
        acceleration: &[],
        flow_time: 0.0,
        acceleration_slope: 0.0,
        contact_weight: 1.0,
        ahead: &[],
        ahead_slope: 0.0,
        phase: 0,
        time: 1.0,
        reduction: 1.0,
        frozen: Frozen::Not,
        inverse_dt: 0.0,
        stiffening: 0.0,
    };
    let pattern = &grid.motion.pattern;
    let (mut matrix, mut workspace) = (Matrix::new(pattern), Workspace::default());
    let mut force = vec![0.0; pattern.len()];
    let frame = grid.frame(&scene.mesh, &state);
    for term in &scene.terms {
        let mut out = Assembly { force: &mut force, tangent: Some(&mut matrix), workspace: &mut workspace };
        term.assemble(&frame, &trial, &mut out).unwrap();
    }
    let mut free = vec![true; pattern.len()];
    for fixed in scene.fixed(0) {
        for &n in fixed.nodes.iter().filter(|n| grid.dofs.block[**n as usize] != u32::MAX) {
            free[grid.dofs.block[n as usize] as usize * 2 + fixed.component] = false;
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

/// The block with its last column of points, or its surface 0.1 m beyond, at `shift` past the edge of cells at 3 m:
/// the condition number, the mean displacement and the iterations.
fn shifted(shift: f64, points_at_the_edge: bool) -> (f64, f64, usize) {
    let mut bench = bench();
    for x in bench.mesh.nodes.iter_mut().filter(|x| (x[0] - 3.0).abs() < 0.2) {
        x[0] = 3.0;
    }
    straighten(&mut bench.mesh);
    resample::<PlaneStrain>(&mut bench);
    bench.hold("bottom", &[0, 1]);
    let points = block(&bench, 3.0 + shift - if points_at_the_edge { 0.0 } else { 0.1 });
    let scene = bench.scene::<PlaneStrain>();
    let condition = condition(&scene, points.clone());
    let (mean, _, iterations) = push(&scene, points);
    (condition, mean, iterations)
}

/// 60 shifts from 0.3 of a cell to 1e-12 of it.
#[test]
fn a_body_goes_over_the_edge_of_a_cell() {
    for points_at_the_edge in [true, false] {
        let shifts = (0..60).map(|k| 0.3 * (1e-12f64 / 0.3).powf(f64::from(k) / 59.0));
        let found: Vec<_> = shifts.map(|shift| (shift, shifted(shift, points_at_the_edge))).collect();
        let conditions = || found.iter().map(|(_, (condition, _, _))| *condition);
        let (least, most) = (conditions().fold(f64::INFINITY, f64::min), conditions().fold(0.0, f64::max));
        // Within about 1e-11 of the edge points still belong to the cell that they come from.
        let last = found.iter().rfind(|(shift, _)| *shift > 1e-10).unwrap();
        let (limit, before) = (last.1.1, shifted(-1e-12, points_at_the_edge).1);
        println!("condition {least:.2e} … {most:.2e}; moved {limit:.6e} m at the edge, {before:.6e} m just before it");
        assert!(most < 3.0 * least && most < 1e9, "{least:e} {most:e}");
        assert!((before / limit - 1.0).abs() < 0.005, "{before} {limit}");
        for (shift, (_, moved, iterations)) in found {
            assert_eq!(iterations, 3, "{shift:e}");
            assert!((moved / limit - 1.0).abs() <= 0.005 + 2.0 * shift, "{shift:e}: {moved} {limit}");
            assert!(
                !(1e-10..1e-6).contains(&shift) || (moved / limit - 1.0).abs() < 1e-5,
                "{shift:e}: {moved} {limit}"
            );
        }
    }
}

/// A block the last half metre of which, at the edge of cells, is stiffer or softer than the rest.
#[test]
fn a_million_times_the_stiffness_beside_it() {
    for end in [3.001, 3.2] {
        for stiff_end in [true, false] {
            let moved = [1e3, 1e6].map(|contrast| {
                let (soft, stiff) = (Some(elastic(YOUNG)), Some(elastic(contrast * YOUNG)));
                let models = if stiff_end { vec![soft, stiff] } else { vec![stiff, soft] };
                let mut bench = bench();
                bench.quadrature = Some(Box::new(Resampled::<PlaneStrain>::new(&bench.mesh, models.clone(), false)));
                let faces = Faces::of(&bench.mesh).inner.len();
                bench.extra.push(Box::new(GhostPenalty::<PlaneStrain>::new(0.1, models.clone(), faces)));
                bench.mesh.regions.push("end".into());
                bench.hold("bottom", &[0, 1]);
                let mut points = block(&bench, end);
                for i in 0..points.len() {
                    points.region[i] = u16::from(points.position[i][0] > end - 0.5);
                }
                let mut scene = bench.scene::<PlaneStrain>();
                scene.terms[0] = Box::new(Internal::<PlaneStrain>::new(models, false));
                scene.stiffness_scale *= contrast;
                let condition = condition(&scene, points.clone());
                let (mean, most, iterations) = push(&scene, points);
                println!(
                    "contrast {contrast:e}, stiff end {stiff_end}, {end} m: condition {condition:.1e}, moved {mean:.3e} and at most {most:.3e} m, {iterations} iterations"
                );
                assert!(iterations <= 4);
                most
            });
            // Neither moves more than beside what is less stiff. The cell in which both meet takes strains of the stiffer, so that the soft
            // part is held by more of the cell the stiffer the other is.
            let least = if stiff_end { 0.6 } else { 0.3 };
            assert!((least..1.0).contains(&(moved[1] / moved[0])), "{moved:?}");
        }
    }
}

#[test]
fn a_single_point_in_a_cell() {
    for y in [0.5, 1.5, 2.5] {
        for x in [3.000001, 3.4, 4.4, 5.5] {
            let mut bench = bench();
            resample::<PlaneStrain>(&mut bench);
            bench.hold("bottom", &[0, 1]);
            let block = block(&bench, 2.85);
            let mut places: Vec<_> = block.position.iter().map(|x| (*x, 0.04)).collect();
            places.push(([x, y], 0.04));
            // One on its own would fall without end, were it not for the soft cells: let nothing weigh.
            bench.gravity = [0.0; 2];
            let mut points = at::<PlaneStrain>(&bench.mesh, &places, 1.0);
            points.elastic.fill([1.001, 1.002, 1.0, 0.0005, 0.0, 0.0]);
            let scene = bench.scene::<PlaneStrain>();
            let condition = condition(&scene, points.clone());
            let (_, most, iterations) = push(&scene, points);
            println!(
                "a point at {x}, {y}: condition {condition:.1e}, moved at most {most:.1e} m, {iterations} iterations"
            );
            assert!(condition < 1e9 && iterations <= 12, "{condition:e}");
        }
    }
}

/// A point on its own, 1.5 m from a block that springs back and forth: no failure, and its parabola but for what the
/// soft stiffness of the cells around it takes.
#[test]
fn a_point_on_its_own_flies() {
    for alone in [true, false] {
        let mut bench = Bench::new(rectangle(CellKind::T6, 10.0, 8.0, 10, 8, 0.2, 2), elastic(YOUNG));
        bench.restore = Restore::EveryStep;
        bench.dynamic = true;
        bench.gravity = [0.0, -10.0];
        bench.steps = 100;
        bench.spectral_radius = 0.8;
        resample::<PlaneStrain>(&mut bench);
        bench.hold("bottom", &[0, 1]);
        let block = block(&bench, 3.15);
        let mut places: Vec<_> = block.position.iter().filter(|_| !alone).map(|x| (*x, 0.04)).collect();
        places.push(([4.7, 2.1], 0.04));
        let mut points = at::<PlaneStrain>(&bench.mesh, &places, 1.0);
        points.velocity = vec![[0.0; 2]; points.len()];
        let last = points.len() - 1;
        points.velocity[last] = [3.0, 5.0];
        let scene = bench.scene::<PlaneStrain>();
        let mut worst = 0f64;
        run::<PlaneStrain>(&scene, points, |state, report| {
            let (t, x) = (state.time, state.points.position[last]);
            worst = worst.max((x[0] - 4.7 - 3.0 * t).hypot(x[1] - 2.1 - 5.0 * t + 5.0 * t * t));
            assert!(report.halvings.is_empty() && report.iterations() <= 8);
        });
        println!("alone {alone}: {worst:.1e} m off its parabola");
        assert!(worst < 0.01, "{worst:e}");
    }
}
