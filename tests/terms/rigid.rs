//! Rigid bodies: what acts on their unknowns, and the tangents of that.

use crate::loads::anywhere;
use crate::stand::{Stand, mesh, points};
use mpm::kinematics::PlaneStrain;
use mpm::mesh::shape::CellKind;
use mpm::rigid::Body;
use mpm::term::{RigidInertia, RigidTraction, RigidWeight, Term};
use mpm::time_value::TimeValue;

/// A body that has its unknowns at two nodes of the stand.
fn body() -> Body<2> {
    Body {
        region: 0,
        nodes: vec![0, 1, 2],
        first: 3,
        reference: 3,
        turning: Some(7),
        arm: 0.8,
        mass: 2.5,
        inertia: 0.4,
    }
}

fn stand(term: Box<dyn Term<2>>) -> Stand<PlaneStrain> {
    let mesh = mesh(CellKind::T6);
    let points = points(&mesh, |_| true);
    Stand::new(mesh, points, term, true, true)
}

fn traction() -> Box<dyn Term<2>> {
    let value = [TimeValue::Constant(30.0), TimeValue::Rate(-50.0)];
    let position = mesh(CellKind::T6).nodes;
    Box::new(RigidTraction::new(&body(), &position, &[(0, 0.2), (1, 0.7)], 0, value))
}

#[test]
fn tangents_are_the_derivatives() {
    for term in [Box::new(RigidInertia::new(&body())) as Box<dyn Term<2>>, traction()] {
        let mut stand = stand(term);
        for alpha_f in [0.0, 0.4] {
            stand.alpha_f = alpha_f;
            let (trial, converged) = anywhere(&stand);
            let error = stand.tangent_error(&trial, &converged);
            assert!(error < 1e-7, "{alpha_f}: {error:.1e}");
        }
    }
}

#[test]
fn weight_and_traction_act_on_the_reference_point() {
    let (trial, converged) = anywhere(&stand(traction()));
    let weight = stand(Box::new(RigidWeight::new(&body(), [1.0, -10.0], vec![TimeValue::Constant(1.0); 2])));
    let force = weight.evaluate(&trial, &converged, 0, false).0;
    assert_eq!((force[3], force[7]), ([-2.5, 25.0], [0.0; 2]));
    let traction = stand(traction());
    let force = traction.evaluate(&trial, &converged, 0, false).0;
    let expected = [-0.9 * 30.0, 0.9 * 25.0];
    assert!((0..2).all(|d| (force[3][d] - expected[d]).abs() < 1e-12), "{:?}", force[3]);
    // The other phase has another load.
    assert_eq!(traction.evaluate(&trial, &converged, 1, false).0[3], [0.0; 2]);
    // The moment: Σ (R r) × t, over the arm.
    let nodes = &traction.scene.mesh.nodes;
    let first: [f64; 2] = [0, 1].map(|d| 0.2 * (nodes[0][d] - nodes[3][d]) + 0.7 * (nodes[1][d] - nodes[3][d]));
    let turned = (nodes[7][0] + trial[7][0] - nodes[3][0]) / 0.8;
    let (sin, cos) = turned.sin_cos();
    let arm = [cos * first[0] - sin * first[1], sin * first[0] + cos * first[1]];
    let moment = (arm[0] * -25.0 - arm[1] * 30.0) / 0.8;
    assert!((force[7][0] + moment).abs() < 1e-12 && force[7][1] == 0.0, "{:?} {moment}", force[7]);
}
