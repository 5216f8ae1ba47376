//! The internal force: every model, elastic and on each kind of its returns, in large strain and rotation.

use crate::support::Random;
use crate::support::stand::{KINDS, Stand, elastic, elasticity, mesh, points, resultant, size};
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::material::{
    CamClay, Friction, Model, MohrCoulomb, Profile, Response, Softening, SofteningTresca, State, Swelling, Tresca,
    VonMises,
};
use mpm::mesh::shape::CellKind;
use mpm::tensor::Tensor;
use mpm::term::Internal;
use std::sync::Arc;

/// A kind of state of a model.
struct Case {
    name: &'static str,
    model: Arc<dyn Model>,
    /// Elastic trial Hencky strains: two in the plane and the third out of it.
    strain: [f64; 3],
    /// Whether the points yield, and how many of their principal stresses are then equal (1: none).
    yields: Option<usize>,
}

fn mohr_coulomb(dilation: f64, tension: Option<f64>) -> Arc<dyn Model> {
    let friction = Friction::degrees(30.0, dilation).unwrap();
    Arc::new(MohrCoulomb::new(elasticity(), Profile::constant(5.0), friction, tension.map(Profile::constant)).unwrap())
}

fn cases() -> Vec<Case> {
    let case = |name, model: &Arc<dyn Model>, strain, yields| Case { name, model: model.clone(), strain, yields };
    let elastic: Arc<dyn Model> = elastic();
    let von_mises: Arc<dyn Model> = Arc::new(VonMises::new(elasticity(), Profile::constant(12.0)).unwrap());
    let strength = Profile::growing(6.0, 0.5, 1.0);
    let tresca: Arc<dyn Model> = Arc::new(Tresca::new(elasticity(), strength).unwrap());
    let (associated, dilating) = (mohr_coulomb(30.0, None), mohr_coulomb(10.0, None));
    let cut = mohr_coulomb(10.0, Some(2.0));
    let softening = Softening { remoulded: 0.3, ductility: 0.5, rate: 0.0, reference_rate: 1.0 };
    let softens: Arc<dyn Model> = Arc::new(SofteningTresca::new(elasticity(), strength, softening).unwrap());
    let pressure = Profile::constant(20.0);
    let critical: Arc<dyn Model> = Arc::new(CamClay::new(elasticity(), 1.0, pressure, 0.1).unwrap());
    let swelling = Swelling::new(0.05, 1.0, Profile::constant(10.0)).unwrap();
    let swells: Arc<dyn Model> = Arc::new(CamClay::with_swelling(swelling, 0.25, 1.0, pressure, 0.1).unwrap());
    vec![
        case("elastic, small strain", &elastic, [1e-3, -2e-3, 5e-4], None),
        case("elastic, large strain", &elastic, [0.5, -0.7, 0.2], None),
        case("elastic, equal roots", &elastic, [0.1, 0.1, 0.1], None),
        case("von Mises, below yield", &von_mises, [2e-3, -2e-3, 0.0], None),
        case("von Mises, yielding", &von_mises, [0.05, -0.04, 0.01], Some(1)),
        case("von Mises, equal roots in the plane", &von_mises, [0.05, 0.05, -0.06], Some(2)),
        case("Tresca, plane, middle out of the plane", &tresca, [0.03, -0.03, 0.0], Some(1)),
        case("Tresca, plane, middle in the plane", &tresca, [0.0, -0.03, 0.03], Some(1)),
        case("Tresca, edge in tension", &tresca, [0.03, -0.05, 0.027], Some(2)),
        case("Tresca, edge in compression", &tresca, [-0.03, 0.05, -0.026], Some(2)),
        case("Mohr-Coulomb, plane, associated", &associated, [0.06, -0.08, -0.02], Some(1)),
        case("Mohr-Coulomb, plane", &dilating, [0.06, -0.08, -0.02], Some(1)),
        case("Mohr-Coulomb, edge in compression", &dilating, [-0.07, 0.06, -0.067], Some(2)),
        case("Mohr-Coulomb, edge in tension", &dilating, [0.02, -0.12, 0.017], Some(2)),
        case("Mohr-Coulomb, apex", &dilating, [0.09, 0.08, 0.085], Some(3)),
        case("Tresca that softens", &softens, [0.03, -0.03, 0.0], Some(1)),
        case("Modified Cam-Clay, wet", &critical, [-0.01, -0.05, -0.02], Some(1)),
        case("Modified Cam-Clay, dry", &critical, [0.03, -0.05, 0.01], Some(1)),
        case("Modified Cam-Clay that swells", &swells, [-0.03, -0.09, -0.05], Some(1)),
        case("Mohr-Coulomb, cut-off", &cut, [0.01, -0.003, -0.006], Some(1)),
    ]
}

/// The left Cauchy–Green tensor of Hencky strains whose first axis lies at the angle `angle`.
fn left_cauchy_green(strain: &[f64; 3], angle: f64) -> Tensor {
    let (s, c) = angle.sin_cos();
    let turn = Tensor::new(c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0);
    let roots = strain.map(|e| (2.0 * e).exp());
    turn * Tensor::from_diagonal(&roots.into()) * turn.transpose()
}

/// The answer to a first strain.
fn respond(case: &Case, y: f64, strain: &[f64; 3]) -> Response {
    let mut internal = vec![0.0; case.model.internal_variables().iter().map(|variable| variable.components()).sum()];
    case.model.begin(y, &mut internal);
    case.model.respond(y, strain, &State::default(), &mut internal)
}

/// Checks that a point aimed at is where the case says.
fn check(case: &Case, y: f64, strain: &[f64; 3]) {
    let response = respond(case, y, strain);
    assert_eq!(response.yielding, case.yields.is_some(), "{}", case.name);
    if let Some(equal) = case.yields {
        let mut t = response.stress;
        t.sort_by(f64::total_cmp);
        let found = 1 + usize::from(t[1] - t[0] < 1e-6) + usize::from(t[2] - t[1] < 1e-6);
        assert_eq!(found, equal, "{}: {t:?}", case.name);
    }
}

/// A stand in a state of the case, with the trial and the converged displacements.
struct Set<K> {
    stand: Stand<K>,
    trial: Vec<[f64; 2]>,
    converged: Vec<[f64; 2]>,
}

fn set<K: Kinematics<2>>(case: &Case, kind: CellKind, whole: bool, alpha_f: f64) -> Set<K> {
    let mesh = mesh(kind);
    let points = points(&mesh, |_| true);
    let term = Box::new(Internal::<K>::new(vec![Some(case.model.clone())], alpha_f > 0.0));
    let mut stand = Stand::<K>::new(mesh, points, term, false, whole);
    stand.alpha_f = alpha_f;
    stand.state.points.stress.fill([3.0, -7.0, 2.0, 1.5, 0.0, 0.0]);
    // Turned, stretched and sheared before, and again in the step.
    let converged = stand.field(0.02, 1, |[x, y]| [0.2 * x - 0.3 * y, 0.2 * x + 0.1 * y]);
    let trial = stand.field(0.02, 2, |[x, y]| [0.1 * x - 0.6 * y, 0.7 * x - 0.2 * y]);
    let heights: Vec<f64> = stand.state.points.origin.iter().map(|x| x[1]).collect();
    let mut random = Random(3);
    // Noise small beside the distance to a kink.
    let noise = 0.02 * case.strain.iter().fold(0f64, |a, b| a.max(b.abs()));
    stand.aim(&trial, &converged, |p| {
        let equal = case.strain[0] == case.strain[1];
        let strain = if equal { case.strain } else { case.strain.map(|e| e + noise * random.next()) };
        check(case, heights[p], &strain);
        left_cauchy_green(&strain, 3.0 * random.next())
    });
    Set { stand, trial, converged }
}

fn tangent_is_the_derivative<K: Kinematics<2>>() {
    for case in cases() {
        for kind in KINDS {
            for alpha_f in [0.0, 0.4] {
                let Set { stand, trial, converged } = set::<K>(&case, kind, true, alpha_f);
                let error = stand.tangent_error(&trial, &converged);
                assert!(error < 1e-6, "{}, {kind:?}, α_f = {alpha_f}: {error:.1e}", case.name);
            }
        }
    }
}

#[test]
fn the_tangent_is_the_derivative_in_plane_strain() {
    tangent_is_the_derivative::<PlaneStrain>();
}

#[test]
fn the_tangent_is_the_derivative_in_axisymmetry() {
    tangent_is_the_derivative::<Axisymmetric>();
}

fn symmetric_as_it_says<K: Kinematics<2>>() {
    for case in cases() {
        let whole = set::<K>(&case, CellKind::T6, true, 0.0);
        let asymmetry = whole.stand.asymmetry(&whole.trial, &whole.converged);
        if !case.model.symmetric() {
            assert!(!whole.stand.term().symmetric());
            // The apex and the cut-off do not know of the dilation.
            let flows = !(case.name.contains("apex") || case.name.contains("cut-off"));
            assert!(!flows || asymmetry > 1e-3, "{}: {asymmetry:.1e}", case.name);
            continue;
        }
        assert!(whole.stand.term().symmetric());
        assert!(asymmetry < 1e-12, "{}: {asymmetry:.1e}", case.name);
        // Half of it is computed in a symmetric system; the other half must be the same.
        let half = set::<K>(&case, CellKind::T6, false, 0.0);
        let (_, a) = whole.stand.evaluate(&whole.trial, &whole.converged, 0, true);
        let (_, b) = half.stand.evaluate(&half.trial, &half.converged, 0, true);
        for (a, b) in a.iter().flatten().zip(b.iter().flatten()) {
            assert!((a - b).abs() < 1e-9, "{}: {a} {b}", case.name);
        }
    }
}

/// With inertia the stresses of both ends act between them: no moment there, whatever the material does.
#[test]
fn the_force_in_a_dynamic_step_has_no_moment_about_the_places_between() {
    for case in cases() {
        let Set { stand, trial, converged } = set::<PlaneStrain>(&case, CellKind::T6, true, 0.5);
        let (force, _) = stand.evaluate(&trial, &converged, 0, false);
        let between = stand.between(&trial, &converged);
        let (mut moment, mut size) = (0.0, 0.0);
        for ((f, u), x) in force.iter().zip(&between).zip(&stand.scene.mesh.nodes) {
            let x = [x[0] + u[0], x[1] + u[1]];
            moment += x[0] * f[1] - x[1] * f[0];
            size += (x[0] * f[1]).abs() + (x[1] * f[0]).abs();
        }
        assert!(moment.abs() < 1e-12 * size, "{}: {moment:e} of {size}", case.name);
    }
}

/// With inertia the stress does the work that the soil stores and dissipates, from below yield to beyond it: no force jumps as a point yields.
fn the_force_is_continuous_at_yield<K: Kinematics<2>>() {
    for case in cases().into_iter().filter(|case| case.yields == Some(1)) {
        let at = |y: f64, part: f64| {
            let strain = case.strain.map(|e| part * e);
            (strain, respond(&case, y, &strain).yielding)
        };
        let forces = [-1e-9, 1e-9].map(|beyond| {
            let Set { mut stand, trial, converged } = set::<K>(&case, CellKind::T6, true, 0.4);
            let heights: Vec<f64> = stand.state.points.origin.iter().map(|x| x[1]).collect();
            stand.aim(&trial, &converged, |p| {
                let (mut below, mut above) = (0.0, 1.0);
                for _ in 0..60 {
                    let middle = 0.5 * (below + above);
                    if at(heights[p], middle).1 { above = middle } else { below = middle }
                }
                left_cauchy_green(&at(heights[p], above * (1.0 + beyond)).0, 0.7)
            });
            stand.evaluate(&trial, &converged, 0, false).0
        });
        let differ =
            forces[0].iter().zip(&forces[1]).map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1])).fold(0.0, f64::max);
        assert!(differ < 1e-6 * size(&forces[0]), "{}: {differ:.1e}", case.name);
    }
}

#[test]
fn the_force_in_a_dynamic_step_is_continuous_where_soil_begins_to_yield() {
    the_force_is_continuous_at_yield::<PlaneStrain>();
    the_force_is_continuous_at_yield::<Axisymmetric>();
}

#[test]
fn the_tangent_is_symmetric_where_the_term_says_so_and_only_there() {
    symmetric_as_it_says::<PlaneStrain>();
    symmetric_as_it_says::<Axisymmetric>();
}

/// Cauchy's laws: the forces of a stressed body balance, and so do their moments about any place.
#[test]
fn the_force_is_in_balance_with_itself() {
    for case in cases() {
        for kind in KINDS {
            let Set { stand, trial, converged } = set::<PlaneStrain>(&case, kind, false, 0.0);
            let (force, _) = stand.evaluate(&trial, &converged, 0, false);
            let rounding = 1e-12 * size(&force);
            let sum = resultant(&force);
            assert!(sum.iter().all(|s| s.abs() < rounding), "{}, {kind:?}: {sum:?}", case.name);
            let places = stand.scene.mesh.nodes.iter().zip(&trial).map(|(x, u)| [x[0] + u[0], x[1] + u[1]]);
            let moment: f64 = places.zip(&force).map(|(x, f)| x[0] * f[1] - x[1] * f[0]).sum();
            assert!(moment.abs() < 30.0 * rounding, "{}, {kind:?}: {moment:.1e}", case.name);

            let Set { stand, trial, converged } = set::<Axisymmetric>(&case, kind, false, 0.0);
            let (force, _) = stand.evaluate(&trial, &converged, 0, false);
            let axial = resultant(&force)[1];
            assert!(axial.abs() < 1e-12 * size(&force), "{}, {kind:?}: {axial:.1e}", case.name);
        }
    }
}

#[test]
fn the_force_of_a_stressed_body_turns_with_it() {
    let (s, c) = 1.1f64.sin_cos();
    let turn = |[x, y]: [f64; 2]| [c * x - s * y, s * x + c * y];
    for case in cases() {
        for kind in KINDS {
            let mut stand = set::<PlaneStrain>(&case, kind, false, 0.0).stand;
            let rest = stand.field(0.0, 1, |_| [0.0; 2]);
            let mut random = Random(3);
            stand.aim(&rest, &rest, |_| left_cauchy_green(&case.strain, 3.0 * random.next()));
            let (force, _) = stand.evaluate(&rest, &rest, 0, false);
            // A rigid motion of a body that is deformed already.
            let turned = stand.field(0.0, 1, |x| {
                let y = turn(x);
                [y[0] - x[0] + 3.0, y[1] - x[1] - 2.0]
            });
            let (after, _) = stand.evaluate(&turned, &rest, 0, false);
            for (f, g) in force.iter().zip(&after) {
                let f = turn(*f);
                let error = (f[0] - g[0]).hypot(f[1] - g[1]);
                assert!(error < 1e-11 * size(&force), "{}, {kind:?}: {error:.1e}", case.name);
            }
        }
    }
}

#[test]
fn an_axisymmetric_body_moves_along_its_axis_unchanged() {
    for case in cases() {
        let Set { stand, trial, converged } = set::<Axisymmetric>(&case, CellKind::T6, false, 0.0);
        let (force, _) = stand.evaluate(&trial, &converged, 0, false);
        let moved: Vec<[f64; 2]> = trial.iter().map(|u| [u[0], u[1] + 5.0]).collect();
        let (after, _) = stand.evaluate(&moved, &converged, 0, false);
        let largest = force.iter().zip(&after).map(|(f, g)| (f[0] - g[0]).hypot(f[1] - g[1])).fold(0.0, f64::max);
        assert!(largest < 1e-11 * size(&force), "{}: {largest:.1e}", case.name);
    }
}
