//! The moving surface of soil as a drained boundary: Terzaghi's layer whose surface runs through the cells, and large strains.

use crate::analytical::self_weight_column::Column;
use crate::analytical::terzaghi::Layer;
use crate::support::bench::{Bench, constant, run};
use crate::support::layout::{at, resample, resample_bounded, seeded};
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::material::{Elasticity, LinearElastic, Model};
use mpm::mesh::builder::rectangle;
use mpm::mesh::cell_size;
use mpm::mesh::shape::CellKind;
use mpm::step::Restore;
use mpm::term::{DrainedSurface, Hydrostatic, Porous, SurfaceLoad, SurfaceTraction, WaterStiffness};
use mpm::time_value::TimeValue;
use std::sync::Arc;

const LOAD: f64 = 1e-3;
const YOUNG: f64 = 1000.0;
const POISSON: f64 = 0.2;
const MOBILITY: f64 = 1e-6;
/// Shares of a cell below the surface.
const SHARES: [f64; 5] = [1.0, 0.63, 0.5, 0.1, 0.02];

fn pressed() -> SurfaceLoad {
    let zero = || TimeValue::Constant(0.0);
    SurfaceLoad {
        phase: 0,
        region: None,
        pressure: Some(Hydrostatic { top: TimeValue::Constant(LOAD), gradient: zero(), datum: zero(), band: 0.1 }),
        shear: zero(),
        components: [zero(), zero()],
        within: None,
    }
}

/// Lets the surface of the soil of a bench drain, and makes it known. After the rest of the bench is made.
fn drain<K: Kinematics<2> + 'static>(bench: &mut Bench) {
    let unit = bench.model.elasticity().at(0.0).shear / cell_size(&bench.mesh, 0);
    resample_bounded::<K>(bench);
    bench.extra.push(Box::new(DrainedSurface::<K>::new(vec![bench.porous.clone()], None, unit, vec![true])));
}

/// Root mean square error of the pressure over p₀ at the time factor `factor` in a layer 1 m high, whose surface has `share` of the
/// cells that it runs through below it.
fn layer<K: Kinematics<2> + 'static>(
    kind: CellKind,
    cells: usize,
    share: f64,
    steps: usize,
    factor: f64,
    restore: Restore,
) -> f64 {
    let modulus = YOUNG * (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
    let layer = Layer { height: 1.0, modulus, storage: 1e-4 / modulus, mobility: MOBILITY, load: LOAD };
    let h = 1.0 / (cells as f64 - 1.0 + share);
    let mut mesh = rectangle(kind, 2.0 * h, (cells + 2) as f64 * h, 2, cells + 2, 0.2, 5);
    // Points of a mesh of their own.
    let mut soil = rectangle(CellKind::T6, 2.0 * h, 1.0, 2, cells, 0.1, 9);
    if K::HOOP {
        mesh.nodes.iter_mut().chain(&mut soil.nodes).for_each(|x| x[0] += 1.0);
    }
    let model: Arc<dyn Model> = Arc::new(LinearElastic::new(Elasticity::new(constant(YOUNG), POISSON).unwrap()));
    let mut bench = Bench::new(mesh, model.clone());
    let stiffness = WaterStiffness::Modulus(1.0 / layer.storage);
    bench.porous = Some(Porous { model, stiffness, mobility: [MOBILITY; 2] });
    bench.restore = restore;
    bench.steps = steps;
    bench.duration = layer.time(factor);
    resample::<K>(&mut bench);
    drain::<K>(&mut bench);
    bench.hold("left", &[0]).hold("right", &[0]).hold("bottom", &[0, 1]);
    bench.extra.push(Box::new(SurfaceTraction::<K>::new(vec![pressed()])));
    let points = at::<K>(&bench.mesh, &seeded(&soil, 16), 1.0);
    let scene = bench.scene::<K>();
    let state = run::<K>(&scene, points, |_, _| {});
    let p = &state.points;
    let (mut sum, mut volume) = (0.0, 0.0);
    for i in 0..p.len() {
        let exact = layer.pressure(1.0 - p.origin[i][1], state.time);
        let error = (p.pore_pressure[i] - exact) / layer.first_pressure();
        sum += p.initial_volume[i] * error * error;
        volume += p.initial_volume[i];
    }
    (sum / volume).sqrt()
}

#[test]
fn axisymmetry_is_alike() {
    let [plane, ring] = [
        layer::<PlaneStrain>(CellKind::T6, 12, 0.37, 100, 0.2, Restore::EveryStep),
        layer::<Axisymmetric>(CellKind::T6, 12, 0.37, 100, 0.2, Restore::EveryStep),
    ];
    println!("{plane:.1e} in plane strain, {ring:.1e} in a ring");
    assert!(ring < 1.2 * plane + 1e-4, "{plane} {ring}");
}

/// A column settles by more than a quarter under its weight while its water leaves through its surface, which crosses cells.
#[test]
fn large_strains_conserve_the_water() {
    let (height, young) = (10.0, 400.0);
    let column = Column { height, unit_weight: 40.0, modulus: young };
    for restore in [Restore::EveryStep, Restore::Quality { least: 0.5, stretch: 1.3 }] {
        let mesh = rectangle(CellKind::T6, 2.0, 11.0, 2, 11, 0.2, 5);
        let soil = rectangle(CellKind::T6, 2.0, height, 2, 10, 0.1, 9);
        let model: Arc<dyn Model> = Arc::new(LinearElastic::new(Elasticity::new(constant(young), 0.0).unwrap()));
        let mut bench = Bench::new(mesh, model.clone());
        bench.porous = Some(Porous { model, stiffness: WaterStiffness::Modulus(1e6), mobility: [1e-4; 2] });
        bench.restore = restore;
        bench.density = 4.0;
        bench.gravity = [0.0, -10.0];
        bench.gravity_factor = TimeValue::Table(vec![[0.0, 0.0], [2000.0, 1.0]]);
        (bench.steps, bench.duration) = (60, 20_000.0);
        resample::<PlaneStrain>(&mut bench);
        drain::<PlaneStrain>(&mut bench);
        bench.hold("left", &[0]).hold("right", &[0]).hold("bottom", &[0, 1]);
        let points = at::<PlaneStrain>(&bench.mesh, &seeded(&soil, 16), 4.0);
        let scene = bench.scene::<PlaneStrain>();
        let (mut taken_up, mut left) = (0.0, 0.0);
        let p = run::<PlaneStrain>(&scene, points, |_, report| {
            let water = report.water.unwrap();
            taken_up += water.taken_up;
            left += water.left;
        })
        .points;
        let largest = p.pore_pressure.iter().fold(0f64, |a, p| a.max(p.abs()));
        let volume: f64 = p.initial_volume.iter().sum();
        let one = |i: usize| p.initial_volume[i] * (p.stress[i][1] - column.stress(height - p.origin[i][1])).abs();
        let error = (0..p.len()).map(one).sum::<f64>() / (volume * column.unit_weight * height);
        println!(
            "{restore:?}: {left:.6} m3 left of {volume}, imbalance {:.1e}; pressure left {largest:.1e} kPa, stress error {error:.1e}",
            (taken_up + left) / left
        );
        assert!(((taken_up + left) / left).abs() < 1e-10, "{restore:?}");
        assert!(largest < 1e-3 * column.unit_weight * height && error < 5e-3, "{restore:?} {largest} {error}");
    }
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    /// However the surface cuts the cells, the pressure converges to that of a layer drained along a curve, at second order in the mean over
    /// the ways to cut: where a tenth of a cell is left the points tell the place of the surface to a few hundredths of one.
    #[test]
    fn a_surface_anywhere_drains_at_second_order() {
        for (kind, shares) in [(CellKind::T6, &SHARES[..]), (CellKind::Q9, &SHARES[1..4]), (CellKind::T3, &SHARES[2..])]
        {
            let mut mean = 0.0;
            for &share in shares {
                let errors = [5, 20].map(|n| layer::<PlaneStrain>(kind, n, share, 100, 0.1, Restore::EveryStep));
                let order = 0.5 * (errors[0] / errors[1]).log2();
                println!("{kind:?}, {share} of a cell: {errors:.6?}, order {order:.2}");
                assert!(errors[1] < 2e-3 && order > 1.1, "{kind:?} {share}: {errors:?}");
                mean += order / shares.len() as f64;
            }
            assert!(mean > 1.8, "{kind:?}: {mean}");
        }
    }
}
