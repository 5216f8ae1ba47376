//! The cantilever with a dead end load against the elastica (VERIFICATION: PL²/EI up to 5).
//!
//! L/h = 20, plane strain (EI with E/(1 − ν²)), the grid never restored. The continuum differs from the
//! elastica by shear and axial strain, of order (h/L)²: hence 0.5 %.

use crate::analytical::elastica::tip;
use crate::support::bench::{Bench, constant, quadrature_points, run};
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

#[test]
fn tip_follows_the_elastica() {
    for load in [0.25, 0.5, 1.0, 2.0, 3.0, 5.0] {
        let exact = tip(load);
        let (deflection, shortening, _) = cantilever(CellKind::T6, load, 40, 5, 2);
        let errors = [deflection / exact.deflection - 1.0, shortening / exact.shortening - 1.0];
        println!("PL²/EI = {load}: {:+.3} %, {:+.3} %", 100.0 * errors[0], 100.0 * errors[1]);
        assert!(errors.iter().all(|e| e.abs() <= 5e-3), "PL²/EI = {load}: {errors:?}");
    }
}

#[test]
fn every_second_order_cell_bends() {
    let exact = tip(3.0);
    for kind in [CellKind::T6, CellKind::Q8, CellKind::Q9] {
        let (deflection, ..) = cantilever(kind, 3.0, 40, 5, 4);
        assert!((deflection / exact.deflection - 1.0).abs() <= 5e-3, "{kind:?}: {deflection}");
    }
}

/// `R_{k+1} ≤ C R_k²` once the iteration is close, down to rounding. C is large because a residual in bending
/// is small for the displacement it stands for, and the axial one that follows is not.
#[test]
fn newton_converges_quadratically() {
    for load in [0.5, 1.0, 2.0, 3.0, 5.0] {
        let (.., residuals) = cantilever(CellKind::T6, load, 40, 5, 2);
        println!("PL²/EI = {load}: {residuals:?}");
        assert!(residuals.len() <= 8, "PL²/EI = {load}: {residuals:?}");
        for pair in residuals.windows(2).filter(|pair| pair[0] < 1e-4) {
            assert!(pair[1] <= (5e3 * pair[0] * pair[0]).max(1e-11), "PL²/EI = {load}: {residuals:?}");
        }
    }
}
