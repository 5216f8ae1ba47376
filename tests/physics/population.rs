//! Material points that are split where soil is stretched: none of its cells is without, and nothing of its motion is lost.

use crate::bench::{Bench, constant, run};
use crate::layout::{at, seeded};
use mpm::kinematics::PlaneStrain;
use mpm::material::{Elasticity, LinearElastic, Model};
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use mpm::quadrature::Resampled;
use mpm::step::Restore;
use std::sync::Arc;

/// What became of the block.
struct Stretched {
    points: usize,
    split: u32,
    /// The most cells at a time that hold integration points and no material point.
    empty: usize,
    /// Cells that stayed short of points.
    starved: u32,
    /// Errors of momentum, angular momentum, mass and velocity (-).
    errors: [f64; 4],
}

/// A block of 1 m by 1 m that flies apart to 20 times its length, `v = k x`, with next to no stiffness: it stays a block, and its velocity linear.
fn stretch(kind: CellKind, each: u32, renewing: bool) -> Stretched {
    let mut bench = Bench::new(rectangle(kind, 24.0, 2.0, 48, 4, 0.1, 3), {
        let model: Arc<dyn Model> = Arc::new(LinearElastic::new(Elasticity::new(constant(1e-6), 0.0).unwrap()));
        model
    });
    bench.dynamic = true;
    bench.restore = Restore::Quality { least: 0.5, stretch: 1.5 };
    bench.duration = 19.0;
    bench.steps = 200;
    let resampled = Resampled::<PlaneStrain>::new(&bench.mesh, vec![Some(bench.model.clone())], false);
    bench.quadrature = Some(Box::new(if renewing { resampled.renewing(vec![each]) } else { resampled }));
    let places: Vec<_> = seeded(&rectangle(kind, 1.0, 1.0, 2, 2, 0.0, 3), each)
        .into_iter()
        .map(|([x, y], a)| ([x + 0.5, y + 0.5], a))
        .collect();
    let mut points = at::<PlaneStrain>(&bench.mesh, &places, 1.0);
    let velocity = |x: &[f64; 2], t: f64| (x[0] - 0.5) / (1.0 + t);
    points.velocity = points.position.iter().map(|x| [velocity(x, 0.0), 0.01]).collect();
    let mass: f64 = points.mass.iter().sum();
    let scene = bench.scene::<PlaneStrain>();
    let mut out = Stretched { points: 0, split: 0, empty: 0, starved: 0, errors: [0.0; 4] };
    let mut first = None;
    let state = run::<PlaneStrain>(&scene, points, |state, report| {
        let motion = &report.motion;
        let (linear, angular) = first.get_or_insert((motion.linear, motion.angular));
        let scale = mass * 0.5;
        let off = (motion.linear[0] - linear[0]).hypot(motion.linear[1] - linear[1]) / scale;
        let errors = [off, (motion.angular - *angular).abs() / scale, (motion.mass / mass - 1.0).abs(), 0.0];
        (0..4).for_each(|k| out.errors[k] = out.errors[k].max(errors[k]));
        if report.restored {
            let population = state.weighing.tally.population;
            out.split += population.split;
            out.starved = out.starved.max(population.starved);
            let samples = state.weighing.samples.as_ref().unwrap();
            let mut cells = samples.points.cell.clone();
            cells.dedup();
            let has = |c: &u32| state.points.cell.contains(c);
            out.empty = out.empty.max(cells.iter().filter(|c| !has(c)).count());
        }
    });
    out.points = state.points.len();
    let p = &state.points;
    let off = |i: usize| (p.velocity[i][0] - velocity(&p.position[i], state.time)).abs();
    out.errors[3] = (0..p.len()).map(off).fold(0.0, f64::max);
    println!(
        "{kind:?}, {each} points a cell, renewing {renewing}: {} points, split {}, cells without points {}, short of points {}; momentum {:.1e}, \
         angular {:.1e}, mass {:.1e}, velocity {:.1e}",
        out.points, out.split, out.empty, out.starved, out.errors[0], out.errors[1], out.errors[2], out.errors[3]
    );
    out
}

#[test]
fn no_cell_of_a_block_stretched_twentyfold_is_without_points() {
    for (kind, each) in [(CellKind::T6, 16), (CellKind::T6, 4), (CellKind::Q9, 9)] {
        let without = stretch(kind, each, false);
        assert!(without.empty > 20 && without.split == 0);
        let with = stretch(kind, each, true);
        assert!(with.split > 0 && with.starved == 0, "{} {}", with.split, with.starved);
    }
}
