//! The internal force in three dimensions: elastic and yielding, in large strain and rotation.

use crate::three_d::stand::{Field, KINDS, Random, Stand, Step, elasticity, linear, points, size};
use mpm::material::{Friction, LinearElastic, Model, MohrCoulomb, Profile, State, VonMises};
use mpm::mesh::brick::brick;
use mpm::mesh::shape::CellKind;
use mpm::tensor::{Tensor, full};
use mpm::term::Term;
use nalgebra::Vector3;
use std::sync::Arc;

/// A kind of state of a model.
struct Case {
    name: &'static str,
    model: Arc<dyn Model>,
    /// Elastic trial Hencky strains.
    strain: [f64; 3],
    yields: bool,
}

fn cases() -> Vec<Case> {
    let case = |name, model: &Arc<dyn Model>, strain, yields| Case { name, model: model.clone(), strain, yields };
    let elastic: Arc<dyn Model> = Arc::new(LinearElastic::new(elasticity()));
    let von_mises: Arc<dyn Model> = Arc::new(VonMises::new(elasticity(), Profile::constant(12.0)).unwrap());
    let friction = Friction::degrees(30.0, 10.0).unwrap();
    let mohr_coulomb: Arc<dyn Model> =
        Arc::new(MohrCoulomb::new(elasticity(), Profile::constant(5.0), friction, None).unwrap());
    vec![
        case("elastic, small strain", &elastic, [1e-3, -2e-3, 5e-4], false),
        case("elastic, large strain", &elastic, [0.5, -0.7, 0.2], false),
        case("elastic, equal roots", &elastic, [0.1, 0.1, 0.1], false),
        case("von Mises, below yield", &von_mises, [2e-3, -2e-3, 0.0], false),
        case("von Mises, yielding", &von_mises, [0.05, -0.04, 0.01], true),
        case("Mohr-Coulomb", &mohr_coulomb, [0.06, -0.08, -0.02], true),
    ]
}

/// A stand in a state of the case, with the trial and the converged displacements.
struct Set {
    stand: Stand,
    trial: Field,
    converged: Field,
    alpha_f: f64,
}

impl Set {
    fn step(&self) -> Step<'_> {
        Step { trial: &self.trial, converged: &self.converged, alpha_f: self.alpha_f }
    }
}

fn set(case: &Case, kind: CellKind, alpha_f: f64) -> Set {
    let mut mesh = brick(kind, [2.0, 1.5, 1.0], [1; 3], 0.0, 0);
    let mut random = Random(5);
    // Curved edges and faces.
    mesh.nodes.iter_mut().flatten().for_each(|x| *x += 0.03 * random.next());
    let points = points(&mesh, 8);
    let mut stand = Stand::new(mesh, points, case.model.clone(), alpha_f > 0.0);
    // Turned, stretched and sheared before, and again in the step.
    let before = Tensor::new(0.2, -0.3, 0.1, 0.2, 0.1, -0.1, 0.0, 0.15, -0.1);
    let after = Tensor::new(0.1, -0.5, 0.2, 0.6, -0.1, -0.2, 0.1, 0.3, -0.1);
    let (converged, trial) = (stand.field(&before, 0.01, 1), stand.field(&after, 0.01, 2));
    let heights: Vec<f64> = stand.points.origin.iter().map(|x| x[2]).collect();
    // Noise small beside the distance to a kink.
    let noise = 0.02 * case.strain.iter().fold(0f64, |a, b| a.max(b.abs()));
    let step = Step { trial: &trial, converged: &converged, alpha_f };
    stand.aim(step, |p| {
        let equal = case.strain[0] == case.strain[1];
        let strain = if equal { case.strain } else { case.strain.map(|e| e + noise * random.next()) };
        let response = case.model.respond(heights[p], &strain, &State::default(), &mut []);
        assert_eq!(response.yielding, case.yields, "{}", case.name);
        left_cauchy_green(&strain, &random.rotation())
    });
    Set { stand, trial, converged, alpha_f }
}

fn left_cauchy_green(strain: &[f64; 3], axes: &Tensor) -> Tensor {
    axes * Tensor::from_diagonal(&strain.map(|e| (2.0 * e).exp()).into()) * axes.transpose()
}

#[test]
fn the_tangent_is_the_derivative() {
    for case in cases() {
        for kind in KINDS {
            for alpha_f in [0.0, 0.4] {
                let set = set(&case, kind, alpha_f);
                let error = set.stand.tangent_error(set.step());
                assert!(error < 1e-6, "{}, {kind:?}, α_f = {alpha_f}: {error:.1e}", case.name);
            }
        }
    }
}

#[test]
fn the_tangent_is_symmetric_where_the_term_says_so() {
    for case in cases() {
        for kind in KINDS {
            let set = set(&case, kind, 0.0);
            let tangent = set.stand.evaluate(set.step(), true).unwrap().1.unwrap();
            let asymmetry = (&tangent - tangent.transpose()).amax() / tangent.amax();
            assert_eq!(set.stand.term.symmetric(), case.model.symmetric());
            if case.model.symmetric() {
                assert!(asymmetry < 1e-12, "{}, {kind:?}: {asymmetry:.1e}", case.name);
            } else {
                assert!(asymmetry > 1e-3, "{}, {kind:?}: {asymmetry:.1e}", case.name);
            }
        }
    }
}

/// Sum of forces, and of their moments about the origin.
fn resultants(places: impl Iterator<Item = Vector3<f64>>, force: &[[f64; 3]]) -> [Vector3<f64>; 2] {
    let forces = places.zip(force.iter().map(|f| Vector3::from(*f)));
    forces.fold([Vector3::zeros(); 2], |[sum, moment], (x, f)| [sum + f, moment + x.cross(&f)])
}

/// Cauchy's laws: the forces of a stressed body balance, and so do their moments; in a dynamic step about the places
/// between its ends.
#[test]
fn the_force_is_in_balance_with_itself() {
    for case in cases() {
        for (kind, alpha_f) in KINDS.into_iter().flat_map(|kind| [(kind, 0.0), (kind, 0.5)]) {
            let set = set(&case, kind, alpha_f);
            let force = set.stand.force(set.step());
            let between = |(x, (u, c)): (&[f64; 3], (&[f64; 3], &[f64; 3]))| {
                Vector3::from([0, 1, 2].map(|d| x[d] + (1.0 - alpha_f) * u[d] + alpha_f * c[d]))
            };
            let places = set.stand.mesh.nodes.iter().zip(set.trial.iter().zip(&set.converged)).map(between);
            let rounding = 1e-12 * size(&force);
            let [sum, moment] = resultants(places, &force);
            assert!(sum.amax() < rounding, "{}, {kind:?}: {sum:?}", case.name);
            assert!(moment.amax() < 30.0 * rounding, "{}, {kind:?}: {moment:?}", case.name);
        }
    }
}

/// A finite rotation about any axis turns forces and stresses.
#[test]
fn forces_and_stresses_of_a_stressed_body_turn_with_it() {
    for case in cases() {
        for kind in KINDS {
            let mut stand = set(&case, kind, 0.0).stand;
            let rest = vec![[0.0; 3]; stand.mesh.nodes.len()];
            let mut random = Random(3);
            stand.aim(Step::to(&rest, &rest), |_| left_cauchy_green(&case.strain, &random.rotation()));
            let turn = random.rotation();
            let turned: Field = linear(&stand.mesh, &(turn - Tensor::identity()))
                .iter()
                .map(|u| [u[0] + 3.0, u[1] - 2.0, u[2] + 1.0])
                .collect();
            let [before, after] = [&rest, &turned].map(|trial| stand.force(Step::to(trial, &rest)));
            let scale = size(&before);
            for (f, g) in before.iter().zip(&after) {
                let error = (turn * Vector3::from(*f) - Vector3::from(*g)).amax();
                assert!(error < 1e-11 * scale, "{}, {kind:?}: {error:.1e} of {scale}", case.name);
            }
            let [before, after] = [&rest, &turned].map(|trial| stand.commit(Step::to(trial, &rest)));
            for (a, b) in before.iter().zip(&after) {
                assert_eq!(a.point, b.point);
                let error = (turn * full(&a.stress) * turn.transpose() - full(&b.stress)).amax();
                assert!(error < 1e-11 * full(&a.stress).amax(), "{}, {kind:?}: {error:.1e}", case.name);
                assert!((turn * a.deformation - b.deformation).amax() < 1e-13);
            }
        }
    }
}
