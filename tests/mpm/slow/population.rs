//! Material points that are split where soil is stretched: its cells keep points, and neither mass nor momentum is lost.

use crate::support::bench::{Bench, constant, run};
use crate::support::layout::{at, resample, seeded};
use mpm::kinematics::PlaneStrain;
use mpm::material::{Elasticity, LinearElastic, Model};
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use mpm::quadrature::Resampled;
use mpm::step::Restore;
use std::sync::Arc;

/// A block of 1 m by 1 m that flies apart to 20 times its length, `v = k x`, with next to no stiffness.
fn stretch(kind: CellKind, each: u32) {
    let mut bench = Bench::new(rectangle(kind, 24.0, 3.0, 48, 6, 0.1, 3), {
        let model: Arc<dyn Model> = Arc::new(LinearElastic::new(Elasticity::new(constant(1e-4), 0.0).unwrap()));
        model
    });
    bench.dynamic = true;
    bench.restore = Restore::Quality { least: 0.5, stretch: 1.5 };
    bench.duration = 19.0;
    bench.steps = 400;
    bench.spectral_radius = 0.5;
    resample::<PlaneStrain>(&mut bench);
    let resampled = Resampled::<PlaneStrain>::new(&bench.mesh, vec![Some(bench.model.clone())], false);
    bench.quadrature = Some(Box::new(resampled.renewing(vec![each])));
    let places: Vec<_> = seeded(&rectangle(kind, 1.0, 1.0, 2, 2, 0.0, 3), each)
        .into_iter()
        .map(|([x, y], a)| ([x + 0.5, y + 1.0], a))
        .collect();
    let mut points = at::<PlaneStrain>(&bench.mesh, &places, 1.0);
    let velocity = |x: &[f64; 2], t: f64| (x[0] - 0.5) / (1.0 + t);
    points.velocity = points.position.iter().map(|x| [velocity(x, 0.0), 0.0]).collect();
    let mass: f64 = points.mass.iter().sum();
    let scene = bench.scene::<PlaneStrain>();
    let (mut split, mut starved, mut errors, mut first) = (0, 0, [0.0f64; 3], None);
    let seeded = points.clone();
    let state = run::<PlaneStrain>(&scene, points, |state, report| {
        let motion = &report.motion;
        let (linear, angular) = first.get_or_insert((motion.linear, motion.angular));
        let off = (motion.linear[0] - linear[0]).hypot(motion.linear[1] - linear[1]) / mass;
        let now = [off, (motion.angular - *angular).abs() / mass, (motion.mass / mass - 1.0).abs()];
        (0..3).for_each(|k| errors[k] = errors[k].max(now[k]));
        if report.restored {
            split += state.weights.tally.population.split;
            starved = starved.max(state.weights.tally.population.starved);
        }
    });
    let p = &state.points;
    let off = |i: usize| (p.velocity[i][0] - velocity(&p.position[i], state.time)).abs();
    let fastest = (0..p.len()).map(off).fold(0.0, f64::max);
    // Where the seeded points would be, and the cells that would have none.
    let mut cells = state.weights.samples.as_ref().unwrap().points.cell.clone();
    cells.dedup();
    let alone: Vec<_> = seeded.position.iter().map(|[x, y]| ([0.5 + 20.0 * (x - 0.5), *y], 1.0)).collect();
    let alone = at::<PlaneStrain>(&scene.mesh, &alone, 1.0).cell;
    let empty = cells.iter().filter(|c| !alone.contains(c)).count();
    println!(
        "{kind:?}, {each} points a cell: {} points of {}, split {split}, short {starved}; of {} cells {empty} would have none; momentum {:.1e}, \
         angular {:.1e}, mass {:.1e}, velocity {fastest:.1e}",
        p.len(),
        seeded.len(),
        cells.len(),
        errors[0],
        errors[1],
        errors[2]
    );
    // A cell in ten may wait for a point that is large enough to be split.
    assert!(split > 0 && empty > cells.len() / 2 && 10 * starved as usize <= cells.len());
    assert!(p.len() <= 4 * each as usize * cells.len());
    assert!(errors[0] < 1e-9 && errors[2] < 1e-12, "{errors:?}");
}

#[test]
fn a_block_stretched_twentyfold_keeps_points_in_its_cells() {
    stretch(CellKind::T6, 16);
}
