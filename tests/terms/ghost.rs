//! The ghost penalty: what it leaves alone, and how stiff it is.

use crate::support::layout::add_point;
use crate::support::stand::{KINDS, Stand, elastic, resultant, size};
use crate::terms::loads::{anywhere, stand};
use mpm::error::Result;
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::material::{Elasticity, Friction, LinearElastic, Model, MohrCoulomb, Profile, Tresca};
use mpm::mesh::Mesh;
use mpm::mesh::builder::rectangle;
use mpm::mesh::faces::Faces;
use mpm::mesh::shape::CellKind;
use mpm::points::Points;
use mpm::term::{Assembly, Frame, GhostInertia, GhostPenalty, Internal, Role, Term, Trial};
use std::sync::Arc;

const FACTOR: f64 = 0.1;

pub fn penalty<K: Kinematics<2>>(mesh: &Mesh<2>) -> Box<dyn Term<2>> {
    Box::new(of::<K>(mesh, vec![Some(elastic())]))
}

fn of<K: Kinematics<2>>(mesh: &Mesh<2>, models: Vec<Option<Arc<dyn Model>>>) -> GhostPenalty<K> {
    GhostPenalty::new(FACTOR, models, Faces::of(mesh).inner.len())
}

/// Forces and moments that sum to nothing whatever the increment; none at all where the increment is one
/// polynomial of first degree, a rigid turn among them, or on complete second-order cells of second degree.
#[test]
fn it_resists_jumps_of_the_increment_alone() {
    fn check<K: Kinematics<2>>(kind: CellKind) {
        let stand: Stand<K> = stand(kind, penalty::<K>, false);
        assert_eq!(stand.term().role(), Role::Internal);
        assert!(stand.ghost_faces().len() > 2);
        let (trial, converged) = anywhere(&stand);
        let force = stand.evaluate(&trial, &converged, 0, false).0;
        let resisted = size(&force);
        assert!(resisted > 1.0, "{resisted}");
        let sum = resultant(&force);
        let moment: f64 = force.iter().zip(&stand.scene.mesh.nodes).map(|(f, x)| x[0] * f[1] - x[1] * f[0]).sum();
        for total in [sum[0], sum[1], moment] {
            assert!(total.abs() < 1e-11 * resisted, "{kind:?}: {sum:?} {moment:.1e} of {resisted}");
        }
        let moved = |by: fn([f64; 2]) -> [f64; 2]| {
            let step = stand.field(0.0, 1, by);
            let trial: Vec<_> = converged.iter().zip(&step).map(|(a, b)| [a[0] + b[0], a[1] + b[1]]).collect();
            size(&stand.evaluate(&trial, &converged, 0, false).0)
        };
        assert!(moved(|[x, y]| [0.3 + 0.2 * x - 0.5 * y, 0.1 - 0.7 * x + 0.4 * y]) < 1e-12 * resisted, "{kind:?}");
        if matches!(kind, CellKind::T6 | CellKind::Q9) {
            assert!(moved(|[x, y]| [x * x - 0.3 * x * y, 0.2 * y * y + x]) < 1e-11 * resisted, "{kind:?}");
        }
    }
    for kind in KINDS {
        check::<PlaneStrain>(kind);
        check::<Axisymmetric>(kind);
    }
}

pub fn inertia<K: Kinematics<2>>(mesh: &Mesh<2>) -> Box<dyn Term<2>> {
    Box::new(GhostInertia::<K>::new(2.0, Faces::of(mesh).inner.len()))
}

/// Whatever the acceleration, the inertia of the faces exerts no force and no moment.
#[test]
fn inertia_of_faces_keeps_both_momenta() {
    for kind in KINDS {
        let stand: Stand<PlaneStrain> = stand(kind, inertia::<PlaneStrain>, false);
        assert_eq!(stand.term().role(), Role::Inertia);
        let (trial, converged) = anywhere(&stand);
        let force = stand.evaluate(&trial, &converged, 0, false).0;
        let resisted = size(&force);
        assert!(resisted > 0.0);
        let sum = resultant(&force);
        let moment: f64 = force.iter().zip(&stand.scene.mesh.nodes).map(|(f, x)| x[0] * f[1] - x[1] * f[0]).sum();
        for total in [sum[0], sum[1], moment] {
            assert!(total.abs() < 1e-11 * resisted, "{kind:?}: {sum:?} {moment:.1e} of {resisted}");
        }
    }
}

fn young(young: f64) -> Option<Arc<dyn Model>> {
    let profile = Profile::growing(young, 0.0, 0.0);
    Some(Arc::new(LinearElastic::new(Elasticity::new(profile, 0.25).unwrap())))
}

/// Of 1 kPa and 1 GPa the soft one decides, and that in a cell of few soft points as in one of many.
#[test]
fn soft_material_decides() {
    let models = vec![young(1e6), young(1.0)];
    let mut stand: Stand<PlaneStrain> = stand(CellKind::T6, penalty::<PlaneStrain>, false);
    let penalty = of::<PlaneStrain>(&stand.scene.mesh, models);
    let stiffness = |stand: &Stand<PlaneStrain>| -> Vec<f64> {
        let frame = stand.frame();
        stand.ghost_faces().iter().map(|face| penalty.of_face(&frame, face).unwrap().stiffness).collect()
    };
    for s in stiffness(&stand) {
        assert!((s - FACTOR * 1e6).abs() < 1e-6);
    }
    // One point of three soft in every cell.
    let volume: f64 = stand.state.points.initial_volume.iter().sum();
    (0..stand.state.points.len()).step_by(3).for_each(|p| stand.state.points.region[p] = 1);
    let least = stand.state.points.initial_volume.iter().fold(f64::INFINITY, |a, b| a.min(*b));
    for s in stiffness(&stand) {
        assert!(s >= FACTOR && s < 1.001 * FACTOR * volume / least, "{s}");
    }
}

/// Several terms as one.
struct Sum(Vec<Box<dyn Term<2>>>);

impl Term<2> for Sum {
    fn assemble(&self, frame: &Frame<2>, trial: &Trial<2>, out: &mut Assembly) -> Result<()> {
        for term in &self.0 {
            let tangent = out.tangent.as_deref_mut();
            term.assemble(frame, trial, &mut Assembly { force: out.force, tangent, workspace: out.workspace })?;
        }
        Ok(())
    }

    fn penalises_faces(&self) -> bool {
        self.0.iter().any(|term| term.penalises_faces())
    }
}

/// Condition number of the stiffness of a body that fills the left half of the rectangle of the stand and reaches
/// `over` (in widths of a cell) into the right one, held at the left.
fn condition(over: f64, ghost: bool) -> f64 {
    let mesh = rectangle(CellKind::T6, 4.0, 4.0, 4, 4, 0.0, 0);
    let mut points = Points::default();
    let mut add = |x: [f64; 2], volume: f64| add_point(&mut points, x, [volume; 2], 0);
    let spacing = 0.2;
    for j in 0..20 {
        let y = (f64::from(j) + 0.5) * spacing;
        (0..10).for_each(|i| add([(f64::from(i) + 0.5) * spacing, y], spacing * spacing));
        add([2.0 + 0.5 * over, y], over * spacing);
    }
    let mut terms: Vec<Box<dyn Term<2>>> = vec![Box::new(Internal::<PlaneStrain>::new(vec![young(1000.0)], false))];
    if ghost {
        terms.push(Box::new(of::<PlaneStrain>(&mesh, vec![young(1000.0)])));
    }
    let stand: Stand<PlaneStrain> = Stand::new(mesh, points, Box::new(Sum(terms)), true, false);
    let rest = stand.field(0.0, 1, |_| [0.0; 2]);
    let (_, tangent) = stand.evaluate(&rest, &rest, 0, true);
    let nodes = &stand.scene.mesh.nodes;
    let free: Vec<usize> = (0..tangent.len()).filter(|&i| tangent[i][i] != 0.0 && nodes[i / 2][0] > 0.0).collect();
    let k = nalgebra::DMatrix::from_fn(free.len(), free.len(), |i, j| tangent[free[j]][free[i]]);
    let values = nalgebra::SymmetricEigen::new(k).eigenvalues;
    values.max() / values.min().max(0.0)
}

/// A body shifted over the edge of its cells: what is left in the next ones may be as thin as rounding.
#[test]
fn the_condition_number_is_bounded_however_thin_the_sliver() {
    let slivers = [0.3, 0.1, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12];
    let with = slivers.map(|over| condition(over, true));
    let without = slivers.map(|over| condition(over, false));
    for ((over, with), without) in slivers.iter().zip(&with).zip(&without) {
        println!("{over:.0e} h over the edge: condition {with:.3e}, without the penalty {without:.1e}");
    }
    // The last one is so thin that its points lie on the edge: there is no sliver.
    assert!(with[..6].iter().all(|&c| c < 100.0 * with[6]), "{with:?}");
    assert!((with[5] - with[3]).abs() < 1e-2 * with[3], "no bound in sight: {with:?}");
    assert!(without[..6].iter().all(|&c| c > 1e12), "{without:?}");
}

/// Jumps far beyond what soil bears meet no more than a share of its strength, and the tangent is that of the force.
#[test]
fn soil_that_flows_is_held_by_no_more_than_a_share_of_its_strength() {
    fn limited(mesh: &Mesh<2>) -> Box<dyn Term<2>> {
        let profile = |top: f64| Profile::growing(top, 0.0, 0.0);
        let elasticity = Elasticity::new(profile(1000.0), 0.25).unwrap();
        let soil: Arc<dyn Model> = Arc::new(Tresca::new(elasticity, profile(1.0)).unwrap());
        Box::new(of::<PlaneStrain>(mesh, vec![Some(soil)]).saturating(5e-4))
    }
    for kind in KINDS {
        let stand: Stand<PlaneStrain> = stand(kind, limited, false);
        let (trial, converged) = anywhere(&stand);
        let error = stand.tangent_error(&trial, &converged);
        assert!(error < 1e-6, "{kind:?}: {error:.1e}");
        let at = |by: f64| {
            let scaled: Vec<_> =
                trial.iter().zip(&converged).map(|(u, c)| [0, 1].map(|d| c[d] + by * (u[d] - c[d]))).collect();
            size(&stand.evaluate(&scaled, &converged, 0, false).0)
        };
        let (tiny, one, more) = (at(1e-7), at(1e3), at(1e4));
        assert!((more / one - 1.0).abs() < 1e-2, "{kind:?}: {one} {more}");
        assert!(one < 1e-3 * 1e10 * tiny, "{kind:?}: {one} of {}", 1e10 * tiny);
    }
}
/// What flowed in the last step resists a step of the same kind with the same force, whatever its size.
#[test]
fn in_flow_it_resists_independently_of_the_step() {
    let mut stand: Stand<PlaneStrain> = stand(CellKind::T6, penalty::<PlaneStrain>, false);
    let (trial, converged) = anywhere(&stand);
    let count = stand.state.points.len();
    stand.state.points.stress = vec![[2.0, -2.0, 0.0, 0.0, 0.0, 0.0]; count];
    let elastic = size(&stand.evaluate(&trial, &converged, 0, false).0);
    let mut flow = |by: f64| {
        stand.state.points.plastic_increment = vec![1e-2 * by; count];
        let scaled: Vec<_> =
            trial.iter().zip(&converged).map(|(u, c)| [0, 1].map(|d| c[d] + by * (u[d] - c[d]))).collect();
        size(&stand.evaluate(&scaled, &converged, 0, false).0)
    };
    let (one, half, tenth) = (flow(1.0), flow(0.5), flow(0.1));
    assert!((half - one).abs() < 1e-9 * one && (tenth - one).abs() < 1e-9 * one, "{one} {half} {tenth}");
    assert!(one < 1e-2 * elastic, "{one} of {elastic}");
    // As it was where the flow is too small to tell.
    assert!((flow(1e-5) - 1e-5 * elastic).abs() < 1e-9 * 1e-5 * elastic);
}

/// Sand without stress is as weak as nothing beside its stiffness. The penalty then saturates at a jump of a hundredth, times κ/γ, not at that of the
/// elastic stiffness, a thousand times smaller; beside clay it keeps that.
#[test]
fn beside_sand_it_is_as_soft_as_sand_that_flows() {
    const SHARE: f64 = 0.1;
    let profile = |top: f64| Profile::growing(top, 0.0, 0.0);
    let elasticity = Elasticity::new(profile(3e4), 0.25).unwrap();
    let sand = MohrCoulomb::new(elasticity, profile(0.1), Friction::degrees(32.0, 0.0).unwrap(), None).unwrap();
    let clay = Tresca::new(elasticity, profile(60.0)).unwrap();
    let stand: Stand<PlaneStrain> = stand(CellKind::T6, penalty::<PlaneStrain>, false);
    let faces = |model: Arc<dyn Model>| {
        let penalty = of::<PlaneStrain>(&stand.scene.mesh, vec![Some(model)]).saturating(SHARE);
        let frame = stand.frame();
        stand.ghost_faces().iter().map(|face| penalty.of_face(&frame, face).unwrap()).collect::<Vec<_>>()
    };
    for face in faces(Arc::new(sand)) {
        let jump = face.limit / face.stiffness;
        assert!(jump > 0.999e-2 * SHARE / FACTOR, "{face:?}");
    }
    for face in faces(Arc::new(clay)) {
        assert!((face.stiffness / (FACTOR * 3e4) - 1.0).abs() < 1e-12, "{face:?}");
    }
}
