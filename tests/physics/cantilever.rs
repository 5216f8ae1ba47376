//! The cantilever with a dead end load against the elastica (VERIFICATION: PL²/EI up to 5).
//!
//! L/h = 20, plane strain (EI with E/(1 − ν²)), the grid never restored. The continuum differs from the
//! elastica by shear and axial strain, of order (h/L)²: hence 0.5 %.

use crate::bench::{Bench, constant, quadrature_points, run};
use mpm::kinematics::PlaneStrain;
use mpm::material::{Elasticity, LinearElastic};
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use mpm::term::Traction;
use mpm::time_value::TimeValue;
use std::sync::Arc;

const LENGTH: f64 = 20.0;

/// Tip deflection and shortening over L, and the residuals of the last step.
fn cantilever(kind: CellKind, load: f64, along: usize, steps: usize, degree: usize) -> (f64, f64, Vec<f64>) {
    let (young, poisson) = (1.2e4, 0.2);
    let mesh = rectangle(kind, LENGTH, 1.0, along, 2, 0.0, 1);
    let elasticity = Elasticity::new(constant(young), poisson).unwrap();
    let mut bench = Bench::new(mesh, Arc::new(LinearElastic::new(elasticity)));
    bench.steps = steps;
    bench.hold("left", &[0, 1]);
    let rigidity = young / (1.0 - poisson * poisson) / 12.0;
    let force = load * rigidity / (LENGTH * LENGTH);
    let tip = bench.mesh.group("right").unwrap().clone();
    let traction = [TimeValue::Constant(0.0), TimeValue::Rate(-force)];
    bench.extra.push(Box::new(Traction::<PlaneStrain, 2>::new(&bench.mesh, &tip, 0, traction)));
    let points = quadrature_points::<PlaneStrain>(&bench.mesh, degree, 1.0);
    let scene = bench.scene::<PlaneStrain>();
    let mut residuals = Vec::new();
    let state = run::<PlaneStrain>(&scene, points, |_, report| residuals = report.residuals.clone());
    let mid = tip.nodes.iter().find(|&&n| (scene.mesh.nodes[n as usize][1] - 0.5).abs() < 1e-12).unwrap();
    let u = state.displacement[*mid as usize];
    (-u[1] / LENGTH, -u[0] / LENGTH, residuals)
}

/// PL²/EI, δ/L, shortening/L of the elastica.
const ELASTICA: [[f64; 3]; 6] = [
    [0.25, 0.08275, 0.00412],
    [0.5, 0.16214, 0.01592],
    [1.0, 0.30172, 0.05643],
    [2.0, 0.49346, 0.16064],
    [3.0, 0.60325, 0.25442],
    [5.0, 0.71379, 0.38763],
];

#[test]
fn print() {
    for [load, d, s] in ELASTICA {
        let (dd, ss, r) = cantilever(CellKind::T6, load, 40, 5, 2);
        println!("{load}: {:.4} % {:.4} %  {r:?}", 100.0 * (dd / d - 1.0), 100.0 * (ss / s - 1.0));
    }
    let [load, d, s] = ELASTICA[5];
    for (kind, n, deg) in [
        (CellKind::T6, 20, 2),
        (CellKind::T6, 40, 4),
        (CellKind::T6, 80, 2),
        (CellKind::Q9, 40, 2),
        (CellKind::Q8, 40, 2),
    ] {
        let (dd, ss, r) = cantilever(kind, load, n, 5, deg);
        println!("{kind:?} {n} {load}: {:.4} % {:.4} %  {r:?}", 100.0 * (dd / d - 1.0), 100.0 * (ss / s - 1.0));
    }
}
