//! A free body that spins, and one that is turned by its boundary: momentum kept, stress objective.

use crate::support::bench::{Bench, constant, quadrature_points, run};
use mpm::kinematics::PlaneStrain;
use mpm::material::{Elasticity, LinearElastic};
use mpm::mesh::Mesh;
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use mpm::step::{Fixed, Prescribed};
use mpm::time_value::TimeValue;
use std::f64::consts::TAU;
use std::sync::Arc;

const YOUNG: f64 = 1000.0;

/// A jittered square of side 1 about the origin.
fn square(kind: CellKind) -> Mesh<2> {
    let mut mesh = rectangle(kind, 1.0, 1.0, 3, 3, 0.2, 5);
    mesh.nodes.iter_mut().flatten().for_each(|x| *x -= 0.5);
    mesh
}

fn bench(kind: CellKind) -> Bench {
    let elasticity = Elasticity::new(constant(YOUNG), 0.3).unwrap();
    Bench::new(square(kind), Arc::new(LinearElastic::new(elasticity)))
}

/// A free square thrown and spun for one turn. Mean stress over a turn: the virial theorem gives ρ ω² ⟨x²⟩ in
/// steady rotation, about which the body, stress-free at first, pulsates; a rotation mistaken for strain
/// would show as many times that. Numerical damping (ρ∞ < 1) takes a little of the spin with the pulsation.
#[test]
fn a_free_body_keeps_its_momenta_over_a_turn() {
    for (spin, steps, spectral_radius, tolerance) in
        [(1.0, 60, 1.0, 1e-11), (1.0, 300, 1.0, 1e-11), (4.0, 200, 1.0, 1e-11), (1.0, 300, 0.9, 2e-5)]
    {
        let mut bench = bench(CellKind::T6);
        bench.dynamic = true;
        bench.spectral_radius = spectral_radius;
        bench.duration = TAU / spin;
        bench.steps = steps;
        let mut points = quadrature_points::<PlaneStrain>(&bench.mesh, 4, 1.0);
        points.velocity = points.position.iter().map(|x| [0.3 - spin * x[1], spin * x[0]]).collect();
        let scene = bench.scene::<PlaneStrain>();
        let (mut angular, mut linear, mut virial) = (0f64, 0f64, 0.0);
        run::<PlaneStrain>(&scene, points, |state, report| {
            // About the centre of mass, which flies along x.
            angular = angular.max((report.motion.angular * 6.0 / spin - 1.0).abs());
            linear = linear.max((report.motion.linear[0] - 0.3).abs()).max(report.motion.linear[1].abs());
            let p = &state.points;
            let volume: f64 = (0..p.len()).map(|i| p.volume(i)).sum();
            let stress: f64 = (0..p.len()).map(|i| p.volume(i) * 0.5 * (p.stress[i][0] + p.stress[i][1])).sum();
            virial += stress / volume * 12.0 / (spin * spin) / steps as f64;
        });
        println!(
            "ω = {spin}, {steps} steps, ρ∞ = {spectral_radius}: momenta to {angular:.1e} and {linear:.1e}, virial {virial:.4}"
        );
        assert!(angular < tolerance && linear < 1e-12, "{angular:e} {linear:e}");
        assert!((virial - 1.0).abs() < 0.03, "ω = {spin}, {steps} steps: {virial}");
    }
}

/// A stressed square whose boundary is turned once around in 12 steps: the stress turns with it.
#[test]
fn stress_turns_with_the_body() {
    for kind in [CellKind::T6, CellKind::Q9] {
        let mut bench = bench(kind);
        let mut nodes: Vec<u32> = bench.mesh.groups.iter().flat_map(|g| g.nodes.clone()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        bench.steps = 12;
        bench.duration = 12.0;
        for n in nodes {
            let x = bench.mesh.nodes[n as usize];
            for component in 0..2 {
                let at = |k: usize| {
                    let (s, c) = (TAU * k as f64 / 12.0).sin_cos();
                    [c * x[0] - s * x[1] - x[0], s * x[0] + c * x[1] - x[1]][component]
                };
                let table = (0..=12).map(|k| [k as f64, at(k)]).collect();
                let fixed = Fixed { nodes: vec![n], component };
                bench.prescribed.push(Prescribed { fixed, displacement: TimeValue::Table(table) });
            }
        }
        let mut points = quadrature_points::<PlaneStrain>(&bench.mesh, 4, 1.0);
        let start = [1.02, 0.97, 1.01, 0.013, 0.0, 0.0];
        points.elastic.fill(start);
        let scene = bench.scene::<PlaneStrain>();
        let mut after_a_twelfth = None;
        let state = run::<PlaneStrain>(&scene, points, |state, _| {
            after_a_twelfth.get_or_insert_with(|| state.points.elastic[0]);
        });
        let (s, c) = (TAU / 12.0).sin_cos();
        let turned = c * c * start[0] - 2.0 * s * c * start[3] + s * s * start[1];
        assert!((after_a_twelfth.unwrap()[0] - turned).abs() < 1e-12, "{kind:?}");
        for b in &state.points.elastic {
            let error = b.iter().zip(start).map(|(b, s)| (b - s).abs()).fold(0.0, f64::max);
            assert!(error < 1e-11, "{kind:?}: {error:e}");
        }
    }
}
