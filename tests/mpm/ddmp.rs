//! Gradients smoothed between cells: exact where the plain ones are, and far less noise once points move.

use crate::analytical::self_weight_column::Column;
use crate::mpm::patch;
use crate::support::bench::{Bench, constant, run};
use mpm::interpolation::{Basis, Ddmp, Mpm};
use mpm::kinematics::{Axisymmetric, PlaneStrain};
use mpm::material::{Elasticity, LinearElastic, Profile};
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use mpm::seed::{RegionSeed, seed};
use mpm::step::Restore;
use mpm::time_value::TimeValue;
use std::sync::Arc;

const KINDS: [CellKind; 4] = [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q9];

/// The points integrate the blends exactly, as degree 6 does.
#[test]
fn the_linear_patch_is_exact() {
    for kind in KINDS {
        for restore in [false, true] {
            let scheme = &Ddmp;
            let check = |e: f64, what: &str| {
                assert!(e < 1e-10, "{kind:?}, restored {restore}, {what}: {e:e}");
            };
            for gradient in [[[1e-3, 2e-3], [-1e-3, 3e-3]], [[-0.2, 0.1], [0.05, -0.15]]] {
                check(patch::error::<PlaneStrain>(scheme, kind, gradient, restore, 6), "plane strain");
            }
            let gradient = [[-0.1, 0.0], [0.0, -0.15]];
            check(patch::error::<Axisymmetric>(scheme, kind, gradient, restore, 6), "axisymmetry");
        }
    }
}

/// The mean error of stress, by `ρ g H`, and the Newton iterations a step, of a column under its own weight with
/// `r = ρ g H / E` that is restored in each of 40 steps: jittered, `wide` cells wide.
fn column(scheme: &'static dyn Basis<2>, kind: CellKind, cells: usize, wide: usize, points: u32, r: f64) -> (f64, f64) {
    const HEIGHT: f64 = 50.0;
    const YOUNG: f64 = 10.0;
    let weight = r * YOUNG / HEIGHT;
    let h = HEIGHT / cells as f64;
    let mesh = rectangle(kind, wide as f64 * h, HEIGHT, wide, cells, 0.2, 5);
    let region = RegionSeed { region: 0, points_per_cell: points, density: Profile::constant(weight / 10.0) };
    let points = seed(&mesh, false, &[region]).unwrap();
    let mut bench = Bench::new(mesh, Arc::new(LinearElastic::new(Elasticity::new(constant(YOUNG), 0.0).unwrap())));
    bench.scheme = scheme;
    bench.density = weight / 10.0;
    bench.gravity = [0.0, -10.0];
    bench.gravity_factor = TimeValue::Rate(1.0);
    bench.restore = Restore::EveryStep;
    bench.steps = 40;
    bench.hold("left", &[0]).hold("right", &[0]).hold("bottom", &[1]);
    let scene = bench.scene::<PlaneStrain>();
    let (mut iterations, mut steps) = (0, 0);
    let p = run::<PlaneStrain>(&scene, points, |_, report| {
        iterations += report.iterations();
        steps += 1;
    })
    .points;
    let exact = Column { height: HEIGHT, unit_weight: weight, modulus: YOUNG };
    let volume: f64 = p.initial_volume.iter().sum();
    let error = (0..p.len())
        .map(|i| p.initial_volume[i] / volume * (p.stress[i][1] - exact.stress(HEIGHT - p.origin[i][1])).abs())
        .sum::<f64>();
    (error / (weight * HEIGHT), iterations as f64 / f64::from(steps))
}

/// Compressed to 30 % at its foot, `r = 4`: a column three cells wide on which the plain method ends without
/// convergence, and two others.
#[test]
fn a_tall_column_stands() {
    for (wide, cells) in [(3, 8), (1, 16), (2, 32)] {
        let (error, iterations) = column(&Ddmp, CellKind::T6, cells, wide, 16, 4.0);
        println!("tall, {wide} wide, {cells} cells: {error:.2e}, {iterations:.1} iterations a step");
        assert!(error < 2e-2, "{cells} cells: {error:e}");
        assert!(iterations <= 4.0, "{cells} cells: {iterations} iterations a step");
    }
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    /// The noise that plain gradients make when points cross edges, 2 to 12 % at any number of cells, is reduced
    /// by the smoothing, by what the ratio says for each kind; quadratic cells gain more.
    #[test]
    fn a_column_restored_in_every_step_errs_less_than_with_plain_gradients() {
        for (kind, wide, ratio) in [
            (CellKind::T6, 1, 0.2),
            (CellKind::T6, 3, 0.2),
            (CellKind::Q9, 2, 0.15),
            (CellKind::T3, 2, 0.5),
            (CellKind::Q4, 2, 0.35),
        ] {
            for cells in [8, 16] {
                let (plain, _) = column(&Mpm, kind, cells, wide, 16, 0.5);
                let (smooth, iterations) = column(&Ddmp, kind, cells, wide, 16, 0.5);
                println!(
                    "{kind:?}, {wide} wide, {cells} cells: plain {plain:.2e}, smooth {smooth:.2e}, {iterations:.1} iterations a step"
                );
                assert!(smooth < ratio * plain, "{kind:?}, {cells} cells: {smooth:e}, plain {plain:e}");
                assert!(iterations <= 3.5, "{kind:?}, {cells} cells: {iterations} iterations a step");
            }
        }
    }
}
