//! The vibrating bar, fixed–free, at small amplitude (`tests/analytical/vibrating_bar.rs`), first mode.

use crate::analytical::vibrating_bar::Bar;
use crate::support::bench::{Bench, constant, quadrature_points, run};
use mpm::kinematics::PlaneStrain;
use mpm::material::{Elasticity, LinearElastic};
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

const LENGTH: f64 = 10.0;
const YOUNG: f64 = 100.0;
const DENSITY: f64 = 1.0;
const VELOCITY: f64 = 1e-3;

/// Time, tip displacement and energy (kinetic, elastic) after each step.
struct Trace {
    time: Vec<f64>,
    tip: Vec<f64>,
    energy: Vec<f64>,
}

fn vibrate(steps_a_period: usize, periods: usize, spectral_radius: f64, cells: usize) -> Trace {
    vibrate_with(4, steps_a_period, periods, spectral_radius, cells)
}

/// With the points of the quadrature rule of `degree`.
fn vibrate_with(degree: usize, steps_a_period: usize, periods: usize, spectral_radius: f64, cells: usize) -> Trace {
    let bar = bar();
    let mesh = rectangle(CellKind::T6, LENGTH, LENGTH / cells as f64, cells, 1, 0.0, 1);
    let elasticity = Elasticity::new(constant(YOUNG), 0.0).unwrap();
    let mut bench = Bench::new(mesh, Arc::new(LinearElastic::new(elasticity)));
    bench.density = DENSITY;
    bench.dynamic = true;
    bench.spectral_radius = spectral_radius;
    bench.duration = bar.period() * periods as f64;
    bench.steps = steps_a_period * periods;
    bench.hold("left", &[0]).hold("bottom", &[1]).hold("top", &[1]);
    let mut points = quadrature_points::<PlaneStrain>(&bench.mesh, degree, DENSITY);
    points.velocity = points.position.iter().map(|x| [bar.velocity(x[0], 0.0), 0.0]).collect();
    let tip = bench.mesh.group("right").unwrap().nodes[0] as usize;
    let scene = bench.scene::<PlaneStrain>();
    let mut trace = Trace { time: Vec::new(), tip: Vec::new(), energy: Vec::new() };
    run::<PlaneStrain>(&scene, points, |state, report| {
        trace.time.push(state.time);
        trace.tip.push(state.displacement[tip][0]);
        trace.energy.push(report.motion.kinetic + report.elastic);
    });
    trace
}

/// The period from the upward crossings of zero by the tip, interpolated.
fn period(trace: &Trace) -> f64 {
    let mut crossings = Vec::new();
    for i in 1..trace.tip.len() {
        let (a, b) = (trace.tip[i - 1], trace.tip[i]);
        if a < 0.0 && b >= 0.0 {
            crossings.push(trace.time[i - 1] + (trace.time[i] - trace.time[i - 1]) * a / (a - b));
        }
    }
    (crossings[crossings.len() - 1] - crossings[0]) / (crossings.len() - 1) as f64
}

fn bar() -> Bar {
    Bar { length: LENGTH, modulus: YOUNG, density: DENSITY, mode: 1, velocity: VELOCITY }
}

fn exact() -> f64 {
    bar().period()
}

/// The trapezoidal rule lengthens a period by (ωΔt)²/12, the least of all A-stable linear multistep methods
/// of second order (Dahlquist 1963): 0.82 % at 20 steps a period, 0.2 % at 41. Against that own period of the
/// method the rest, from space, is below 0.01 %.
#[test]
fn the_period_is_that_of_the_trapezoidal_rule_and_converges_at_second_order() {
    let mut errors = Vec::new();
    for steps in [20, 41, 80] {
        let found = period(&vibrate(steps, 20, 1.0, 16));
        let dt = exact() / steps as f64;
        let own = TAU * dt / (2.0 * (PI / steps as f64).atan());
        println!(
            "{steps} steps a period: {:+.4} %, of the method's own {:+.4} %",
            100.0 * (found / exact() - 1.0),
            100.0 * (found / own - 1.0)
        );
        assert!((found / own - 1.0).abs() < 1e-4, "{steps} steps: {found} against {own}");
        errors.push(found / exact() - 1.0);
    }
    assert!(errors[1] < 2e-3, "{errors:?}");
    let order = (errors[0] / errors[2]).log2() / 2.0;
    assert!((1.95..2.05).contains(&order), "order {order} of {errors:?}");
}

#[test]
fn the_energy_is_kept_over_twenty_periods() {
    let trace = vibrate(20, 20, 1.0, 16);
    let drift = trace.energy.iter().map(|e| (e / trace.energy[0] - 1.0).abs()).fold(0.0, f64::max);
    println!("energy kept to {drift:.1e}");
    assert!(drift < 1e-3, "{drift:e}");
}

/// The first mode in steps of 100 times the time that a wave takes through a cell.
#[test]
fn a_hundred_times_the_courant_step_is_stable() {
    let cells = 200;
    let courant = LENGTH / cells as f64 / (YOUNG / DENSITY).sqrt();
    let steps = (exact() / (100.0 * courant)).round() as usize;
    for spectral_radius in [1.0, 0.8, 0.0] {
        let trace = vibrate(steps, 10, spectral_radius, cells);
        let bar = bar();
        assert!(trace.time[0] >= 99.0 * courant);
        let largest = trace.energy.iter().fold(0.0, |a: f64, &e| a.max(e));
        let start = bar.energy() * LENGTH / cells as f64;
        println!("ρ∞ = {spectral_radius}, {steps} steps a period: energy at most {:.6} of the start", largest / start);
        assert!(largest < 1.001 * start, "{largest} {start}");
    }
}

/// Three points leave the mass of a six-node triangle singular; the motion starts all the same, and 1 % of
/// the energy is what so few points miss.
#[test]
fn a_motion_starts_from_three_points_a_cell() {
    let trace = vibrate_with(2, 40, 2, 1.0, 16);
    let start = bar().energy() * LENGTH / 16.0;
    assert!(trace.energy.iter().all(|e| (e / start - 1.0).abs() < 0.02), "{:?}", trace.energy);
}
