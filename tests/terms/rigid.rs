//! Rigid bodies: what acts on their unknowns, and the tangents of that.

use crate::support::stand::{KINDS, Stand, mesh, points};
use crate::terms::loads::anywhere;
use mpm::dofs::RigidDofs;
use mpm::gravity::Gravity;
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::mesh::shape::CellKind;
use mpm::rigid::Body;
use mpm::step::Grid;
use mpm::term::{Hydrostatic, RigidInertia, RigidPressure, RigidTraction, RigidWeight, Term};
use mpm::time_value::TimeValue;

/// A body that has the displacements of two nodes of the stand for its unknowns.
fn body() -> Body<2> {
    Body {
        region: 0,
        is_wall: false,
        nodes: vec![0, 1, 2],
        centre: [2.4, 0.4],
        dofs: RigidDofs::new(3, true, 0.8),
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
    let gravity = Gravity::Components([1.0, -10.0].map(TimeValue::Constant));
    let weight = stand(Box::new(RigidWeight::new(&body(), vec![gravity; 2])));
    let force = weight.evaluate(&trial, &converged, 0, false).0;
    assert_eq!((force[3], force[4]), ([-2.5, 25.0], [0.0; 2]));
    let traction = stand(traction());
    let force = traction.evaluate(&trial, &converged, 0, false).0;
    let expected = [-0.9 * 30.0, 0.9 * 25.0];
    assert!((0..2).all(|d| (force[3][d] - expected[d]).abs() < 1e-12), "{:?}", force[3]);
    // The other phase has another load.
    assert_eq!(traction.evaluate(&trial, &converged, 1, false).0[3], [0.0; 2]);
    // The moment: Σ (R r) × t, over the arm.
    let nodes = &traction.scene.mesh.nodes;
    let centre = body().centre;
    let first: [f64; 2] = [0, 1].map(|d| 0.2 * (nodes[0][d] - centre[d]) + 0.7 * (nodes[1][d] - centre[d]));
    let (sin, cos) = (trial[4][0] / 0.8).sin_cos();
    let arm = [cos * first[0] - sin * first[1], sin * first[0] + cos * first[1]];
    let moment = (arm[0] * -25.0 - arm[1] * 30.0) / 0.8;
    assert!((force[4][0] + moment).abs() < 1e-12 && force[4][1] == 0.0, "{:?} {moment}", force[4]);
}

/// All cells of the stand as one body under water, whose level passes through it or is high above.
fn under_water<K: Kinematics<2>>(kind: CellKind, level: f64) -> Stand<K> {
    let constant = TimeValue::Constant;
    let head = Hydrostatic { top: constant(2.0), gradient: constant(9.0), datum: constant(level), band: 0.2 };
    let mesh = mesh(kind);
    let body = Body { dofs: RigidDofs::new(3, !K::HOOP, 0.8), ..body() };
    let term = Box::new(RigidPressure::<K>::new(&body, 0, &mesh, vec![Some(head), None]));
    let points = points(&mesh, |_| true);
    let mut stand = Stand::<K>::new(mesh, points, term, true, true);
    stand.scene.bodies = vec![body];
    stand.grid = Grid::new::<K>(&stand.scene, &stand.state).unwrap();
    stand
}

/// The middle of the body (m), which is that of the stand, in the trial pose, and from its reference point.
fn middle(stand: &Stand<impl Kinematics<2>>, trial: &[[f64; 2]]) -> [[f64; 2]; 2] {
    let Body { centre, dofs, .. } = &stand.scene.bodies[0];
    let turned = dofs.rotation.map_or(0.0, |_| trial[4][0] / 0.8);
    let ((sin, cos), [x, y]) = (turned.sin_cos(), [3.0 - centre[0], 0.75 - centre[1]]);
    let arm = [cos * x - sin * y, sin * x + cos * y];
    [[0, 1].map(|d| centre[d] + trial[3][d] + arm[d]), arm]
}

fn water_on_a_body<K: Kinematics<2>>() {
    for kind in KINDS {
        let anywhere_in_air = under_water::<K>(kind, -50.0);
        let [[_, height], _] = middle(&anywhere_in_air, &anywhere(&anywhere_in_air).0);
        for level in [height, 50.0] {
            let mut stand = under_water::<K>(kind, level);
            for alpha_f in [0.0, 0.4] {
                stand.alpha_f = alpha_f;
                let (trial, converged) = anywhere(&stand);
                let error = stand.tangent_error(&trial, &converged);
                assert!(error < 1e-6, "{kind:?}, {level}, {alpha_f}: {error:.1e}");
                let asymmetry = stand.asymmetry(&trial, &converged);
                assert!(asymmetry < 1e-12, "{kind:?}, {level}: {asymmetry:.1e}");
                assert_eq!(stand.evaluate(&trial, &converged, 1, false).0[3], [0.0; 2]);
            }
        }
    }
}

#[test]
fn the_tangent_of_water_on_a_body_is_its_derivative_and_symmetric() {
    water_on_a_body::<PlaneStrain>();
    water_on_a_body::<Axisymmetric>();
}

/// Under water a body is as much lighter as the water that it displaces weighs, in any pose, at the middle of its volume.
#[test]
fn water_lifts_a_body_in_the_middle_of_its_volume() {
    for kind in KINDS {
        let stand = under_water::<PlaneStrain>(kind, 50.0);
        let (trial, converged) = anywhere(&stand);
        let force = stand.evaluate(&trial, &converged, 0, false).0;
        let weight = 9.0 * 2.0 * 1.5;
        assert!(force[3][0].abs() < 1e-11 * weight && (force[3][1] / -weight - 1.0).abs() < 1e-12, "{:?}", force[3]);
        let [_, [lever, _]] = middle(&stand, &trial);
        let moment = weight * lever / 0.8;
        assert!((force[4][0] + moment).abs() < 1e-11 * weight && force[4][1] == 0.0, "{:?} {moment}", force[4]);
    }
}
