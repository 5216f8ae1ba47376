//! The vibrating bar, fixed–free, at small amplitude ([`mpm::analytical::vibrating_bar`]), first mode.

use crate::bench::{Bench, constant, quadrature_points, run};
use mpm::analytical::vibrating_bar::Bar;
use mpm::kinematics::PlaneStrain;
use mpm::material::{Elasticity, LinearElastic};
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
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
    let bar = Bar { length: LENGTH, modulus: YOUNG, density: DENSITY, mode: 1, velocity: VELOCITY };
    let mesh = rectangle(CellKind::T6, LENGTH, LENGTH / cells as f64, cells, 1, 0.0, 1);
    let elasticity = Elasticity::new(constant(YOUNG), 0.0).unwrap();
    let mut bench = Bench::new(mesh, Arc::new(LinearElastic::new(elasticity)));
    bench.density = DENSITY;
    bench.dynamic = true;
    bench.spectral_radius = spectral_radius;
    bench.duration = bar.period() * periods as f64;
    bench.steps = steps_a_period * periods;
    bench.hold("left", &[0]).hold("bottom", &[1]).hold("top", &[1]);
    let mut points = quadrature_points::<PlaneStrain>(&bench.mesh, 4, DENSITY);
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

fn exact() -> f64 {
    Bar { length: LENGTH, modulus: YOUNG, density: DENSITY, mode: 1, velocity: VELOCITY }.period()
}

#[test]
fn print() {
    for steps in [20, 40, 80] {
        let t = vibrate(steps, 20, 1.0, 16);
        let e0 = t.energy[0];
        let drift = t.energy.iter().map(|e| (e / e0 - 1.0).abs()).fold(0.0, f64::max);
        println!("{steps}: period error {:.4} % energy drift {drift:.2e}", 100.0 * (period(&t) / exact() - 1.0));
    }
}
