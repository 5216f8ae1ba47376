//! Claims that hold whatever the method: bodies in flight, motion that is prescribed, units, turned and distant
//! coordinates, closed forms in axisymmetry, soil at rest.

use crate::support::bench::{Bench, constant, quadrature_points, run};
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::material::{Elasticity, LinearElastic, spatial};
use mpm::mesh::Mesh;
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use mpm::points::Points;
use mpm::seed::{RegionSeed, RegionWeight, k0_stress, seed};
use mpm::step::{Fixed, Prescribed, Restore};
use mpm::term::Traction;
use mpm::time_value::TimeValue;
use std::sync::Arc;

fn elastic(young: f64, poisson: f64) -> Arc<LinearElastic> {
    Arc::new(LinearElastic::new(Elasticity::new(constant(young), poisson).unwrap()))
}

/// The points for which `wanted` holds at their place.
fn keep(mut points: Points<2>, wanted: impl Fn(&[f64; 2]) -> bool) -> Points<2> {
    let kept: Vec<bool> = points.position.iter().map(wanted).collect();
    fn only<T>(column: &mut Vec<T>, kept: &[bool]) {
        let mut flag = kept.iter();
        column.retain(|_| *flag.next().unwrap());
    }
    only(&mut points.position, &kept);
    only(&mut points.origin, &kept);
    only(&mut points.mass, &kept);
    only(&mut points.initial_volume, &kept);
    only(&mut points.deformation, &kept);
    only(&mut points.elastic, &kept);
    only(&mut points.stress, &kept);
    only(&mut points.plastic_strain, &kept);
    only(&mut points.region, &kept);
    only(&mut points.cell, &kept);
    points
}

fn largest(values: impl Iterator<Item = f64>) -> f64 {
    values.fold(0.0, |a, v| if v.is_nan() { f64::NAN } else { a.max(v.abs()) })
}

/// A block thrown across some ten cells of a grid that is restored in every step.
#[test]
fn a_thrown_block_flies_a_parabola_free_of_stress() {
    for spectral_radius in [1.0, 0.8] {
        let mesh = rectangle(CellKind::T6, 8.0, 8.0, 8, 8, 0.2, 3);
        let mut bench = Bench::new(mesh, elastic(1e4, 0.3));
        bench.gravity = [0.0, -10.0];
        bench.density = 1.7;
        bench.dynamic = true;
        bench.restore = Restore::EveryStep;
        bench.spectral_radius = spectral_radius;
        bench.steps = 100;
        bench.duration = 0.9;
        let all = quadrature_points::<PlaneStrain>(&bench.mesh, 6, 1.7);
        let mut points = keep(all, |x| (1.0..2.1).contains(&x[0]) && (2.0..3.3).contains(&x[1]));
        points.velocity = vec![[4.0, 7.0]; points.len()];
        let mass: f64 = points.mass.iter().sum();
        let scene = bench.scene::<PlaneStrain>();
        let mut worst = [0f64; 3];
        run::<PlaneStrain>(&scene, points, |state, report| {
            let (t, p) = (state.time, &state.points);
            let place = |i: usize| {
                (p.position[i][0] - p.origin[i][0] - 4.0 * t)
                    .hypot(p.position[i][1] - p.origin[i][1] - 7.0 * t + 5.0 * t * t)
            };
            worst[0] = worst[0].max(largest((0..p.len()).map(place)));
            worst[1] = worst[1].max(largest(p.stress.iter().flatten().copied()));
            let momentum = [report.motion.linear[0] / mass - 4.0, report.motion.linear[1] / mass - 7.0 + 10.0 * t];
            worst[2] = worst[2].max(largest(momentum.into_iter()));
        });
        println!(
            "ρ∞ = {spectral_radius}: place {:.1e} m, stress {:.1e} kPa, velocity {:.1e} m/s",
            worst[0], worst[1], worst[2]
        );
        assert!(worst[0] < 1e-9 && worst[1] < 1e-6 && worst[2] < 1e-11, "{worst:?}");
    }
}

/// A block of which every node on the boundary is moved along at a constant speed has that speed, and no stress
/// but that of the start: the velocity of nodes that are moved is the one they are moved with.
#[test]
fn a_body_carried_by_its_boundary_moves_as_its_boundary_does() {
    for restore in [false, true] {
        for spectral_radius in [1.0, 0.8] {
            let mesh = rectangle(CellKind::T6, 1.0, 1.0, 3, 3, 0.2, 3);
            let mut bench = Bench::new(mesh, elastic(1e4, 0.3));
            bench.dynamic = true;
            bench.restore = if restore { Restore::EveryStep } else { Restore::Never };
            bench.spectral_radius = spectral_radius;
            bench.steps = 20;
            bench.duration = 1e-2;
            let nodes = (0..bench.mesh.nodes.len() as u32).collect();
            bench
                .prescribed
                .push(Prescribed { fixed: Fixed { nodes, component: 0 }, displacement: TimeValue::Rate(0.5) });
            bench.hold("bottom", &[1]).hold("top", &[1]);
            let points = quadrature_points::<PlaneStrain>(&bench.mesh, 4, 1.0);
            // A restored grid stays where it is: leave room for the points to move.
            let points = if restore { keep(points, |x| x[0] < 0.9) } else { points };
            let mass: f64 = points.mass.iter().sum();
            let scene = bench.scene::<PlaneStrain>();
            let mut worst = [0f64; 3];
            run::<PlaneStrain>(&scene, points, |state, report| {
                let p = &state.points;
                worst[0] = worst[0].max(largest(p.velocity.iter().map(|v| v[0] - 0.5)));
                worst[1] = worst[1].max(largest(p.acceleration.iter().map(|a| a[0])));
                worst[2] = worst[2].max((report.motion.kinetic / (0.5 * mass * 0.25) - 1.0).abs());
            });
            println!("restore {restore}, ρ∞ = {spectral_radius}: {worst:?}");
            assert!(worst[0] < 1e-10 && worst[1] < 1e-7 && worst[2] < 1e-9, "restore {restore}: {worst:?}");
        }
    }
}

/// A bar pushed at one end at a constant speed from rest: behind the wave its stress is ρ c v, and the force on
/// the end ρ c v A, without noise in a damped method.
#[test]
fn a_bar_pushed_at_its_end_answers_with_its_impedance() {
    let (young, density, speed) = (1e4, 1.0, 0.01);
    let c = f64::sqrt(young / density);
    let mesh = rectangle(CellKind::T6, 1.0, 0.0125, 80, 1, 0.0, 1);
    let mut bench = Bench::new(mesh, elastic(young, 0.0));
    bench.density = density;
    bench.dynamic = true;
    bench.spectral_radius = 0.5;
    bench.duration = 0.8 / c;
    bench.steps = 160;
    bench.hold("bottom", &[1]).hold("top", &[1]);
    let fixed = bench.on("left", 0);
    let nodes = fixed.nodes.clone();
    bench.prescribed.push(Prescribed { fixed, displacement: TimeValue::Rate(speed) });
    let points = quadrature_points::<PlaneStrain>(&bench.mesh, 4, density);
    let scene = bench.scene::<PlaneStrain>();
    let mut forces = Vec::new();
    let end = run::<PlaneStrain>(&scene, points, |_, report| {
        forces.push(nodes.iter().map(|&n| report.reaction[n as usize][0]).sum::<f64>() / 0.0125);
    });
    let exact = density * c * speed;
    let late = &forces[40..];
    println!(
        "force over ρ c v A: {:.4} … {:.4}",
        late.iter().fold(f64::MAX, |a, &f| a.min(f / exact)),
        largest(late.iter().map(|f| f / exact))
    );
    assert!(late.iter().all(|f| (f / exact - 1.0).abs() < 0.02), "{late:?} {exact}");
    let p = &end.points;
    for i in (0..p.len()).filter(|&i| p.origin[i][0] < 0.6) {
        assert!((p.velocity[i][0] / speed - 1.0).abs() < 0.05, "{} {:?}", p.origin[i][0], p.velocity[i]);
    }
}

/// A block thrown on a fixed floor comes to rest: no point keeps a velocity that the grid has not (but of the
/// kind that no shape function shows to the grid). Without damping the momentum it loses is the impulse of its
/// weight and the floor, at the impact too.
#[test]
fn what_has_landed_is_at_rest() {
    for (spectral_radius, duration, steps) in [(0.0, 6.0, 200), (1.0, 0.2, 20)] {
        let mesh = rectangle(CellKind::T6, 2.0, 2.0, 4, 4, 0.2, 3);
        let mut bench = Bench::new(mesh, elastic(200.0, 0.0));
        bench.dynamic = true;
        bench.restore = Restore::EveryStep;
        bench.spectral_radius = spectral_radius;
        (bench.duration, bench.steps) = (duration, steps);
        bench.gravity = [0.0, -10.0];
        bench.hold("bottom", &[0, 1]).hold("left", &[0]).hold("right", &[0]);
        let mut points = keep(quadrature_points::<PlaneStrain>(&bench.mesh, 6, 1.0), |x| x[1] < 1.0);
        points.velocity = vec![[0.0, -1.0]; points.len()];
        let mass: f64 = points.mass.iter().sum();
        let scene = bench.scene::<PlaneStrain>();
        let (mut imbalance, mut kinetic) = (0f64, 0.0);
        let end = run::<PlaneStrain>(&scene, points, |_, report| {
            imbalance = imbalance.max(report.imbalance[1].abs());
            kinetic = report.motion.kinetic / (0.5 * mass);
        });
        let fastest = largest(end.points.velocity.iter().map(|v| v[1]));
        println!(
            "ρ∞ = {spectral_radius}: energy left {kinetic:.1e}, fastest {fastest:.1e} m/s, imbalance {imbalance:.1e}"
        );
        if spectral_radius == 1.0 {
            assert!(imbalance < 1e-9, "{imbalance:e}");
        } else {
            assert!(kinetic < 1e-3 && fastest < 0.05, "{kinetic:e} {fastest}");
        }
    }
}

/// The places of the points of a column under its weight, on a mesh that `put` has moved.
fn heavy_column(put: impl Fn([f64; 2]) -> [f64; 2], gravity: [f64; 2], restore: bool) -> Points<2> {
    let mut mesh = rectangle(CellKind::T6, 1.0, 2.0, 3, 6, 0.2, 3);
    mesh.nodes.iter_mut().for_each(|x| *x = put(*x));
    let mut bench = Bench::new(mesh, elastic(100.0, 0.3));
    bench.density = 1.0;
    bench.gravity = gravity;
    bench.gravity_factor = TimeValue::Rate(1.0);
    bench.restore = if restore { Restore::EveryStep } else { Restore::Never };
    bench.steps = 3;
    bench.hold("bottom", &[0, 1]);
    let points = keep(quadrature_points::<PlaneStrain>(&bench.mesh, 6, 1.0), |_| true);
    let scene = bench.scene::<PlaneStrain>();
    run::<PlaneStrain>(&scene, points, |_, _| {}).points
}

#[test]
fn a_turned_mesh_gives_turned_results() {
    let (s, c) = 0.7f64.sin_cos();
    let turn = |x: [f64; 2]| [c * x[0] - s * x[1], s * x[0] + c * x[1]];
    let straight = heavy_column(|x| x, [0.0, -3.0], false);
    let turned = heavy_column(turn, turn([0.0, -3.0]), false);
    for i in 0..straight.len() {
        let x = turn(straight.position[i]);
        assert!((x[0] - turned.position[i][0]).hypot(x[1] - turned.position[i][1]) < 1e-10);
        let trace = |s: &[f64; 6]| s[0] + s[1];
        assert!((trace(&straight.stress[i]) - trace(&turned.stress[i])).abs() < 1e-7);
    }
}

/// Coordinates as surveyors have them: a million metres from the origin.
#[test]
fn results_do_not_depend_on_where_the_origin_is() {
    for restore in [false, true] {
        for size in [1.0, 1e-2] {
            let far = [412_345.25, 5_812_345.5];
            let near = heavy_column(|x| x.map(|v| v * size), [0.0, -3.0 / size], restore);
            let distant = heavy_column(|x| [far[0] + size * x[0], far[1] + size * x[1]], [0.0, -3.0 / size], restore);
            let mut worst = [0f64; 2];
            for i in 0..near.len() {
                for d in 0..2 {
                    worst[0] = worst[0].max((near.position[i][d] + far[d] - distant.position[i][d]).abs() / size);
                }
                worst[1] = worst[1].max(largest((0..6).map(|k| near.stress[i][k] - distant.stress[i][k])));
            }
            println!("restore {restore}, size {size}: place {:.1e}, stress {:.1e}", worst[0], worst[1]);
            assert!(worst[0] < 1e-6 && worst[1] < 1e-4, "restore {restore}, size {size}: {worst:?}");
        }
    }
}

/// The same problem in other units and sizes takes the same iterations to the same answer.
#[test]
fn results_do_not_depend_on_units() {
    let solve = |size: f64, young: f64| {
        let mesh = rectangle(CellKind::T6, size, 2.0 * size, 3, 6, 0.2, 3);
        let mut bench = Bench::new(mesh, elastic(young, 0.3));
        bench.density = 1e-4 * young;
        bench.gravity = [0.0, -100.0 / size];
        bench.steps = 2;
        bench.gravity_factor = TimeValue::Rate(1.0);
        bench.hold("bottom", &[0, 1]);
        let points = quadrature_points::<PlaneStrain>(&bench.mesh, 6, bench.density);
        let scene = bench.scene::<PlaneStrain>();
        let mut iterations = 0;
        let p = run::<PlaneStrain>(&scene, points, |_, report| iterations += report.iterations()).points;
        let stress: Vec<f64> = p.stress.iter().flatten().map(|s| s / young).collect();
        (iterations, stress)
    };
    let (count, expected) = solve(1.0, 1.0);
    for (size, young) in [(1.0, 1e-3), (1.0, 1e9), (1e-3, 1e5), (1e3, 1e5), (1e-3, 1e-3)] {
        let (iterations, found) = solve(size, young);
        let worst = largest(expected.iter().zip(&found).map(|(a, b)| a - b));
        println!("size {size:e}, E {young:e}: {iterations} iterations (of {count}), {worst:.1e}");
        assert!(iterations == count && worst < 1e-10);
    }
}

/// A thick-walled cylinder under inner pressure against Lamé, at small strain, its ends held.
#[test]
fn a_thick_walled_cylinder_is_that_of_lame() {
    let (a, b, young, poisson, pressure) = (0.7, 1.9, 5e4, 0.27, 1e-2);
    let mut errors = Vec::new();
    for cells in [6, 12] {
        let mut mesh = rectangle(CellKind::T6, b - a, 0.3, cells, 2, 0.0, 1);
        mesh.nodes.iter_mut().for_each(|x| x[0] += a);
        let mut bench = Bench::new(mesh, elastic(young, poisson));
        bench.hold("bottom", &[1]).hold("top", &[1]);
        let group = bench.mesh.group("left").unwrap().clone();
        let value = [TimeValue::Constant(pressure), TimeValue::Constant(0.0)];
        bench.extra.push(Box::new(Traction::<Axisymmetric, 2>::new(&bench.mesh, &group, 0, value)));
        let points = quadrature_points::<Axisymmetric>(&bench.mesh, 6, 1.0);
        let scene = bench.scene::<Axisymmetric>();
        let p = run::<Axisymmetric>(&scene, points, |_, _| {}).points;
        let k = pressure * a * a / (b * b - a * a);
        let shear = 0.5 * young / (1.0 + poisson);
        let mut error = 0f64;
        for i in 0..p.len() {
            let r = p.origin[i][0];
            let u = k / (2.0 * shear) * ((1.0 - 2.0 * poisson) * r + b * b / r);
            error = error.max(((p.position[i][0] - r) / u - 1.0).abs());
            let hoop = k * (1.0 + b * b / (r * r));
            assert!((p.stress[i][2] / hoop - 1.0).abs() < 0.03, "{r}: {} {hoop}", p.stress[i][2]);
            assert!((p.stress[i][1] - 2.0 * poisson * k).abs() < 0.02 * hoop);
        }
        println!("{cells} cells: {error:.2e}");
        errors.push(error);
    }
    assert!(errors[1] < 2e-4 && errors[0] / errors[1] > 3.5, "{errors:?}");
}

/// Two level layers at rest, with gravity from the first step: the largest displacement, over the settlement that
/// the whole weight would give.
fn at_rest<K: Kinematics<2>>(restore: bool, dynamic: bool, count: u32) -> f64 {
    let mut mesh: Mesh<2> = rectangle(CellKind::T6, 3.0, 4.0, 4, 6, 0.0, 0);
    mesh.regions = vec!["sand".into(), "clay".into()];
    for c in 0..mesh.cells.len() {
        let top = mesh.cells.nodes(c).iter().map(|&n| mesh.nodes[n as usize][1]).fold(0.0, f64::max);
        mesh.cells.region[c] = u16::from(top <= 2.0 + 1e-9);
    }
    let density = [1.7, 1.9];
    let model = elastic(1e4, 0.3);
    let seeds: Vec<_> = (0..2)
        .map(|r| RegionSeed { region: r, points_per_cell: count, density: constant(density[r as usize]) })
        .collect();
    let soils: Vec<_> =
        (0..2).map(|r| RegionWeight { region: r, unit_weight: constant(10.0 * density[r as usize]) }).collect();
    let mut points = seed(&mesh, K::HOOP, &seeds).unwrap();
    points.stress = k0_stress(&mesh, &soils, |_| 0.5, &points);
    for p in 0..points.len() {
        points.elastic[p] = spatial::elastic_from_stress(&*model, points.origin[p][1], &points.stress[p]);
        points.region[p] = 0;
    }
    let mut bench = Bench::new(mesh, model);
    bench.gravity = [0.0, -10.0];
    bench.restore = if restore { Restore::EveryStep } else { Restore::Never };
    bench.dynamic = dynamic;
    bench.steps = 10;
    bench.hold("left", &[0]).hold("right", &[0]).hold("bottom", &[0, 1]);
    let scene = bench.scene::<K>();
    let p = run::<K>(&scene, points, |_, _| {}).points;
    largest((0..p.len()).flat_map(|i| [0, 1].map(|d| p.position[i][d] - p.origin[i][d]))) / (17.5 * 8.0 / 1e4)
}

#[test]
fn level_ground_at_rest_stays_at_rest() {
    for restore in [false, true] {
        for dynamic in [false, true] {
            for count in [6, 12, 16] {
                let plane = at_rest::<PlaneStrain>(restore, dynamic, count);
                let round = at_rest::<Axisymmetric>(restore, dynamic, count);
                println!("restore {restore}, dynamic {dynamic}, {count} points: {plane:.1e}, axisymmetric {round:.1e}");
                let tolerance = if count == 16 { 0.02 } else { 1e-8 };
                assert!(plane < tolerance, "{plane}");
                assert!(round < 0.02, "{round}");
            }
        }
    }
}

/// Ground that its weight has settled quasi-statically feels nothing when inertia comes in, and nothing when it
/// goes again.
#[test]
fn inertia_comes_and_goes_without_a_kick() {
    for kind in [CellKind::T6, CellKind::Q9] {
        let scene = |dynamic: bool, gravity_factor: TimeValue| {
            let mut bench = Bench::new(rectangle(kind, 3.0, 2.0, 4, 4, 0.2, 3), elastic(1e4, 0.3));
            bench.gravity = [0.0, -10.0];
            bench.gravity_factor = gravity_factor;
            bench.restore = Restore::EveryStep;
            bench.dynamic = dynamic;
            bench.steps = 10;
            bench.hold("left", &[0]).hold("right", &[0]).hold("bottom", &[0, 1]);
            bench
        };
        let first = scene(false, TimeValue::Rate(1.0));
        let points = quadrature_points::<PlaneStrain>(&first.mesh, 6, 1.0);
        let settled = run::<PlaneStrain>(&first.scene::<PlaneStrain>(), points, |_, _| {}).points;
        let steady = |dynamic| scene(dynamic, TimeValue::Constant(1.0)).scene::<PlaneStrain>();
        let mut fastest = 0f64;
        let moved = run::<PlaneStrain>(&steady(true), settled.clone(), |state, _| {
            fastest = fastest.max(largest(state.points.velocity.iter().flatten().copied()));
        });
        let mut end = moved.points;
        (end.velocity, end.acceleration) = (Vec::new(), Vec::new());
        let end = run::<PlaneStrain>(&steady(false), end, |_, _| {}).points;
        let settlement = largest(settled.position.iter().zip(&settled.origin).map(|(x, o)| x[1] - o[1]));
        let drift = largest(settled.position.iter().zip(&end.position).map(|(a, b)| a[1] - b[1])) / settlement;
        println!("{kind:?}: fastest {fastest:.1e} m/s, drift {drift:.1e} of the settlement");
        assert!(fastest < 2e-4 && drift < 5e-3, "{kind:?}: {fastest:e} {drift:e}");
    }
}
