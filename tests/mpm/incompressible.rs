//! The pressure field at Poisson's ratio 0.4999: the patch, a thick cylinder, undrained against total stress.

use crate::mpm::patch::stretch_boundary;
use crate::support::bench::{Bench, constant, quadrature_points, run};
use crate::support::layout::{at, resample, seeded};
use crate::support::solve_text;
use mpm::io::frame::{self, Frame};
use mpm::io::run_folder::RunFolder;
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::material::{Elasticity, LinearElastic, Model, Tresca};
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use mpm::step::{Prescribed, Restore, State};
use mpm::term::MixedPressure;
use mpm::time_value::TimeValue;
use std::sync::Arc;

const SHEAR: f64 = 400.0;
const POISSON: f64 = 0.4999;
const KINDS: [CellKind; 5] = [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q8, CellKind::Q9];

fn bulk(poisson: f64) -> f64 {
    2.0 * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson))
}

fn elastic(poisson: f64) -> Arc<dyn Model> {
    let young = constant(2.0 * SHEAR * (1.0 + poisson));
    Arc::new(LinearElastic::new(Elasticity::new(young, poisson).unwrap()))
}

/// A bench whose points keep the bulk modulus of Poisson's ratio `kept` and whose field carries the rest.
fn bench(mesh: mpm::mesh::Mesh<2>, kept: f64) -> Bench {
    let model = elastic(kept);
    let mut bench = Bench::new(mesh, model.clone());
    bench.carried =
        Some(MixedPressure { model, ratio: bulk(POISSON) - bulk(kept), water: 0.0, bound: None, limit: None });
    bench
}

/// Stretches a jittered mesh by a linear field and returns the largest error of the deformation gradients, and of
/// the mean stress relative to the bulk modulus.
fn patch<K: Kinematics<2>>(kind: CellKind, gradient: [[f64; 2]; 2], restore: bool, dynamic: bool) -> [f64; 2] {
    let mut mesh = rectangle(kind, 2.0, 1.5, 4, 3, 0.2, 7);
    if !K::HOOP {
        for x in &mut mesh.nodes {
            x[0] += 3.0;
        }
    }
    let mut bench = bench(mesh, -0.9);
    bench.restore = if restore { Restore::EveryStep } else { Restore::Never };
    bench.steps = if restore { 1 } else { 2 };
    bench.dynamic = dynamic;
    if dynamic {
        // Without mass to speak of the patch is at rest in every step.
        bench.density = 1e-9;
    }
    stretch_boundary(&mut bench, gradient);
    let points = quadrature_points::<K>(&bench.mesh, 4, bench.density);
    let hoop = if K::HOOP { gradient[0][0] } else { 0.0 };
    let mut scene = bench.scene::<K>();
    // The second step begins with the predicted state, and so ends close to the tolerance, not far below it.
    scene.numerics.tolerance = 1e-13;
    let state = run::<K>(&scene, points, |_, report| assert!(report.iterations() <= 8));
    let mut error = [0f64; 2];
    for (f, stress) in state.points.deformation.iter().zip(&state.points.stress) {
        for i in 0..2 {
            for j in 0..2 {
                let exact = f64::from(u8::from(i == j)) + gradient[i][j];
                error[0] = error[0].max((f[(i, j)] - exact).abs());
            }
        }
        error[0] = error[0].max((f[(2, 2)] - 1.0 - hoop).abs());
        let k = SHEAR * bulk(POISSON);
        let exact = k * f.determinant().ln() / f.determinant();
        error[1] = error[1].max((mpm::tensor::mean(stress) - exact).abs() / k);
    }
    error
}

#[test]
fn a_uniform_strain_is_exact() {
    for kind in KINDS {
        for gradient in [[[1e-3, 2e-3], [-1e-3, 3e-3]], [[0.2, 0.3], [-0.1, 0.15]]] {
            for (restore, dynamic) in [(false, false), (false, true), (true, false)] {
                let sign = if restore { -1.0 } else { 1.0 };
                let gradient = gradient.map(|row: [f64; 2]| row.map(|g| sign * g));
                let e = patch::<PlaneStrain>(kind, gradient, restore, dynamic);
                assert!(e[0] < 1e-10 && e[1] < 1e-10, "{kind:?}, {gradient:?}, {restore}, {dynamic}: {e:?}");
            }
        }
        let e = patch::<Axisymmetric>(kind, [[0.1, 0.0], [0.0, -0.15]], false, false);
        assert!(e[0] < 1e-10 && e[1] < 1e-10, "{kind:?}: {e:?}");
    }
}

/// A cylinder from r = 1 to 2 m between smooth plates, its inner face pushed out by `u`: Lamé's solution
/// `u_r = A r + B/r`, `A = B (1 − 2ν)/b²`.
fn cylinder(kind: CellKind, n: usize, water: f64) -> State<2> {
    let mut mesh = rectangle(kind, 1.0, 0.5, 2 * n, n, 0.2, 3);
    for x in &mut mesh.nodes {
        x[0] += 1.0;
    }
    let mut bench = bench(mesh, -0.9);
    if let Some(carried) = &mut bench.carried {
        carried.water = water;
    }
    bench.hold("bottom", &[1]).hold("top", &[1]);
    let fixed = bench.on("left", 0);
    bench.prescribed.push(Prescribed { fixed, displacement: TimeValue::Rate(PUSHED) });
    let points = quadrature_points::<Axisymmetric>(&bench.mesh, 6, 1.0);
    let scene = bench.scene::<Axisymmetric>();
    run::<Axisymmetric>(&scene, points, |_, report| assert!(report.iterations() <= 3))
}

const PUSHED: f64 = 1e-5;

/// Root mean square error of the radial and the mean stress over the largest radial stress, and the largest error of
/// the mean stress: it is uniform, so that a checkerboard in the field would show.
fn cylinder_error(kind: CellKind, n: usize) -> [f64; 2] {
    let state = cylinder(kind, n, 0.0);
    let (outer, lateral) = (2.0f64, 1.0 - 2.0 * POISSON);
    let b = PUSHED / (lateral / outer.powi(2) + 1.0);
    let a = b * lateral / outer.powi(2);
    let scale = 2.0 * SHEAR * b * (1.0 - 1.0 / outer.powi(2));
    let (mut sum, mut volume, mut largest) = (0.0, 0.0, 0f64);
    for p in 0..state.points.len() {
        let (r, stress) = (state.points.origin[p][0], &state.points.stress[p]);
        let radial = 2.0 * SHEAR * (a / lateral - b / (r * r));
        let mean = 2.0 * a * bulk(POISSON) * SHEAR;
        let deviation = mpm::tensor::mean(stress) - mean;
        largest = largest.max(deviation.abs() / scale);
        sum += state.points.initial_volume[p] * ((stress[0] - radial).powi(2) + deviation.powi(2));
        volume += state.points.initial_volume[p];
    }
    [(sum / volume).sqrt() / scale, largest]
}

/// Second order in the stresses for cells of second order, first for the others: the displacements are one order
/// better than their gradients, and linear pressures are as good as these.
#[test]
fn thick_cylinder() {
    for kind in KINDS {
        let errors = [4, 8].map(|n| cylinder_error(kind, n));
        let [[coarse, _], [fine, largest]] = errors;
        println!("{kind:?}: stress error {coarse:.2e}, {fine:.2e}, at most {largest:.2e} in the mean");
        let ratio = if kind.order() > 1 { 0.33 } else { 0.65 };
        let small = if kind.order() > 1 { 2e-3 } else { 5e-2 };
        assert!(fine < ratio * coarse && fine < small && largest < 15.0 * fine, "{kind:?}: {errors:?}");
    }
}

/// What the water carries is missing in the stress of the points, and nothing else changes.
#[test]
fn undrained_is_total_stress_less_the_pore_pressure() {
    let [total, undrained] = [0.0, 0.8].map(|water| cylinder(CellKind::T6, 4, water));
    let carried =
        MixedPressure { model: elastic(-0.9), ratio: bulk(POISSON) - bulk(-0.9), water: 0.8, bound: None, limit: None };
    let largest = total.points.stress.iter().fold(0f64, |a, s| a.max(s[0].abs()));
    for p in 0..total.points.len() {
        let pore = carried.pore_pressure(&undrained.points, p);
        for i in 0..3 {
            let sum = undrained.points.stress[p][i] - pore;
            assert!((sum - total.points.stress[p][i]).abs() < 1e-6 * largest, "point {p}: {sum}");
        }
    }
}

/// Clay between rough plates that part or come together, restored in every step: the volume of a material point is the one that its pressure has by the law
/// of the field, however far it flows, and no sum over the steps of what the displacements make of it. The equilibrium after a reset changes the pressure and
/// no volume: the two differ by about as much as the pressure changes the volume, 10⁻⁵.
#[test]
fn material_points_have_the_volume_of_their_pressure() {
    // Total stress, and undrained soil whose model sees the volume of the field. Each with its bulk modulus, over the shear modulus.
    let [kept, drained] = [-0.9, 0.3].map(tresca);
    let total = MixedPressure { model: kept, ratio: bulk(POISSON) - bulk(-0.9), water: 0.0, bound: None, limit: None };
    let undrained =
        MixedPressure { model: drained, ratio: bulk(POISSON) - bulk(0.3), water: 1.0, bound: Some(1e-3), limit: None };
    for way in [-0.02, 0.02] {
        between_plates::<PlaneStrain>(way, total.clone(), total.ratio);
        between_plates::<PlaneStrain>(way, undrained.clone(), bulk(POISSON));
        between_plates::<Axisymmetric>(way, total.clone(), total.ratio);
    }
}

fn tresca(poisson: f64) -> Arc<dyn Model> {
    let elasticity = Elasticity::new(constant(2.0 * SHEAR * (1.0 + poisson)), poisson).unwrap();
    Arc::new(Tresca::new(elasticity, constant(1.0)).unwrap())
}

/// Soil between plates that move by `way` (m) in twenty steps, each with a grid reset: the volume of its points against that of their pressure.
fn between_plates<K: Kinematics<2>>(way: f64, carried: MixedPressure, bulk: f64) {
    let mesh = rectangle(CellKind::T6, 4.0, 1.0, 12, 3, 0.1, 3);
    let mut bench = Bench::new(mesh, carried.model.clone());
    bench.carried = Some(carried);
    bench.restore = Restore::EveryStep;
    bench.steps = 20;
    bench.hold("bottom", &[0, 1]).hold("left", &[0]);
    for component in [0, 1] {
        let displacement = TimeValue::Rate(if component == 1 { way } else { 0.0 });
        bench.prescribed.push(Prescribed { fixed: bench.on("top", component), displacement });
    }
    resample::<K>(&mut bench);
    let places: Vec<_> = seeded(&bench.mesh, 9).into_iter().filter(|(x, _)| x[0] < 3.0).collect();
    let points = at::<K>(&bench.mesh, &places, 1.0);
    let State { points, .. } = run::<K>(&bench.scene::<K>(), points, |_, _| ());
    let off = |p: usize| (points.deformation[p].determinant().ln() - points.pressure[p] / (bulk * SHEAR)).abs();
    let worst = (0..points.len()).map(off).fold(0.0, f64::max);
    let flown = points.plastic_strain.iter().fold(0.0f64, |a, b| a.max(*b));
    let pressure = points.pressure.iter().fold(0.0f64, |a, b| a.max(b.abs()));
    println!("plates by {way}: volume off by {worst:.1e}, pressure up to {pressure:.1} kPa, strain up to {flown:.2}");
    assert!(worst < 1e-4 && flown > 0.1 && pressure > 3.0, "{worst:e} {flown} {pressure}");
}

/// Compressible soil that a field carries in tension, on one grid for all steps: the stress of the material points is that of their volume.
#[test]
fn points_in_tension_keep_the_stress_of_their_volume() {
    fn stretched<K: Kinematics<2>>(gradient: [[f64; 2]; 2]) -> f64 {
        let mut bench = Bench::new(rectangle(CellKind::T6, 2.0, 1.5, 4, 3, 0.2, 7), elastic(-0.9));
        let ratio = bulk(0.3) - bulk(-0.9);
        bench.carried = Some(MixedPressure { model: elastic(-0.9), ratio, water: 0.0, bound: None, limit: None });
        bench.restore = Restore::Never;
        bench.steps = 5;
        stretch_boundary(&mut bench, gradient);
        resample::<K>(&mut bench);
        let points = at::<K>(&bench.mesh, &seeded(&bench.mesh, 9), 1.0);
        let State { points, .. } = run::<K>(&bench.scene::<K>(), points, |_, _| ());
        let hoop = if K::HOOP { gradient[0][0] } else { 0.0 };
        let ratio = (1.0 + gradient[0][0]) * (1.0 + gradient[1][1]) * (1.0 + hoop);
        let exact = bulk(0.3) * SHEAR * ratio.ln() / ratio;
        points.stress.iter().map(|stress| (mpm::tensor::mean(stress) / exact - 1.0).abs()).fold(0.0, f64::max)
    }
    for error in [
        stretched::<PlaneStrain>([[0.1, 0.0], [0.0, 0.08]]),
        stretched::<PlaneStrain>([[-0.1, 0.0], [0.0, -0.08]]),
        stretched::<Axisymmetric>([[0.06, 0.0], [0.0, 0.05]]),
    ] {
        assert!(error < 1e-8, "{error:e}");
    }
}

/// Soil with an initial stress that is in balance keeps it on triangles of first order. With one integration point a cell nothing would hold a pressure that
/// alternates among the corners.
#[test]
fn soil_at_rest_keeps_its_pressure_on_triangles_of_first_order() {
    let folder = solve_text(
        "geometry: plane_strain\n\
         mesh: {geo: GEO/slump.geo, order: 1, parameters: {half_width: 3, height: 1, room: 0, h: 0.6}}\n\
         regions: {block: {kind: mpm, material: clay}}\n\
         materials: {clay: {model: linear_elastic, young: 1.0e+4, poisson: 0.495, unit_weight: 20}}\n\
         supports: {bottom: {ux: 0, uy: 0}, axis: {ux: 0}, face: {ux: 0}}\n\
         gravity: {y: -9.81}\n\
         initial_stress: {k0: 0.5}\n\
         phases: [{name: rest, analysis: quasi_static, duration: 1, step: {initial: 1}}]\n",
    );
    let results = RunFolder::new(folder.path()).results();
    let Frame { points, .. } = Frame::read(&frame::path(&results, 1)).unwrap();
    let stress = points.columns.iter().find(|column| column.name == "stress").unwrap();
    let off = |(x, stress): (&[f64; 3], &[f64])| (stress[1] + 20.0 * (1.0 - x[1])).abs();
    let most = points.position.iter().zip(stress.values.chunks_exact(stress.components)).map(off).fold(0.0, f64::max);
    println!("{most:.1e} kPa off");
    assert!(most < 1e-6, "{most:.1e} kPa");
}
