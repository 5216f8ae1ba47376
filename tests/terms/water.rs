//! Pore water: its tangent and symmetry, alone and beside a pressure field, and what it leaves alone.

use crate::support::Random;
use crate::support::stand::{KINDS, Stand, elastic, mesh, points};
use mpm::interpolation::Mpm;
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::material::Model;
use mpm::mesh::shape::CellKind;
use mpm::step::Water;
use mpm::surface::{ActiveBoundary, Path, Piece};
use mpm::term::{
    DrainedSurface, Internal, MixedPressure, PoreStabilisation, PoreWater, Porous, PressureField, Term, WaterStiffness,
};
use std::sync::Arc;

const UNIT: f64 = 700.0;

fn porous(mobility: [f64; 2]) -> Vec<Option<Porous>> {
    vec![Some(Porous { model: elastic(), stiffness: WaterStiffness::Ratio(20.0), mobility })]
}

/// A stand in large strain with noise in all unknowns.
fn set<K: Kinematics<2>>(kind: CellKind, beside: bool, alpha_f: f64, flow_time: f64) -> (Stand<K>, [Vec<[f64; 2]>; 2]) {
    let mesh = mesh(kind);
    let mut points = points(&mesh, |_| true);
    let mut random = Random(17);
    points.pore_pressure = (0..points.len()).map(|_| 30.0 * random.next()).collect();
    points.pressure = (0..points.len()).map(|_| 20.0 * random.next()).collect();
    let model: Arc<dyn Model> = elastic();
    let water = PoreWater::<K>::new(porous([3e-5, 1e-5]), UNIT);
    let (models, dynamic) = (vec![Some(model.clone())], alpha_f > 0.0);
    let term: Box<dyn Term<2>> = if beside {
        let field = PressureField::<K>::new(
            vec![Some(MixedPressure { model, ratio: 3.0, water: 0.0, bound: None, limit: None })],
            UNIT,
        );
        Box::new(Internal::<K, _>::sharing(models, dynamic, (field, water)))
    } else {
        Box::new(Internal::<K, _>::sharing(models, dynamic, water))
    };
    let water = Some(Water { porous: porous([0.0; 2]), alone: !beside, ..Water::default() });
    let mut stand = Stand::<K>::with_water(&Mpm, mesh, points, term, false, true, Some(UNIT), water);
    (stand.alpha_f, stand.flow_time) = (alpha_f, flow_time);
    stand.state.points.stress.fill([3.0, -7.0, 2.0, 1.5, 0.0, 0.0]);
    for f in &mut stand.state.points.deformation {
        *f *= 0.97 + 0.02 * random.next();
    }
    for pressure in &mut stand.pressure {
        *pressure = 40.0 + 20.0 * random.next();
    }
    let converged = stand.field(0.02, 1, |[x, y]| [0.1 * x - 0.2 * y, 0.1 * x + 0.05 * y]);
    let trial = stand.field(0.02, 2, |[x, y]| [0.12 * x - 0.3 * y, 0.3 * x - 0.1 * y]);
    (stand, [trial, converged])
}

fn tangent_is_the_derivative<K: Kinematics<2>>() {
    for kind in KINDS {
        for beside in [false, true] {
            for (alpha_f, flow_time) in [(0.0, 0.0), (0.0, 1.0), (0.0, 1e4), (0.4, 10.0)] {
                let (stand, [trial, converged]) = set::<K>(kind, beside, alpha_f, flow_time);
                let error = stand.tangent_error(&trial, &converged);
                assert!(error < 1e-6, "{kind:?}, beside {beside}, {alpha_f}, {flow_time}: {error:.1e}");
                if alpha_f == 0.0 {
                    let asymmetry = stand.asymmetry(&trial, &converged);
                    assert!(asymmetry < 1e-12, "{kind:?}: {asymmetry:.1e}");
                }
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

/// What the equations of all shape functions sum up to is the water that the points have taken up: flow and what keeps
/// pressures from each other have no share in it.
#[test]
fn no_water_is_made_or_lost_between_the_corners() {
    for kind in KINDS {
        let (stand, [trial, converged]) = set::<PlaneStrain>(kind, false, 0.0, 10.0);
        let (force, _) = stand.system(&trial, &stand.pressure, &converged, 0, false);
        let (still, _) = {
            let mut still = set::<PlaneStrain>(kind, false, 0.0, 0.0).0;
            still.pressure.clone_from(&stand.pressure);
            still.system(&trial, &still.pressure, &converged, 0, false)
        };
        let sum = |force: &[f64]| force[2 * trial.len()..].iter().sum::<f64>();
        let size = force.iter().fold(0f64, |a, f| a.max(f.abs()));
        assert!((sum(&force) - sum(&still)).abs() < 1e-12 * size, "{kind:?}");
    }
}

#[test]
fn the_bond_is_free_for_a_uniform_increment_and_its_tangent_the_derivative() {
    for kind in KINDS {
        let mesh = mesh(kind);
        let mut points = points(&mesh, |_| true);
        points.pore_pressure = vec![0.0; points.len()];
        let (nodes, cells) = (mesh.nodes.len(), mesh.cells.len());
        let term: Box<dyn Term<2>> =
            Box::new(PoreStabilisation::<PlaneStrain>::new(porous([0.0; 2]), UNIT, 400.0, cells));
        let water = Some(Water { porous: porous([0.0; 2]), alone: true, ..Water::default() });
        let mut stand = Stand::<PlaneStrain>::with_water(&Mpm, mesh, points, term, false, true, Some(UNIT), water);
        let rest = stand.field(0.0, 1, |_| [0.0; 2]);
        let begin = stand.pressure.len() - nodes;
        stand.pressure[begin..].fill(25.0);
        let (force, _) = stand.system(&rest, &stand.pressure, &rest, 0, false);
        assert!(force.iter().all(|f| f.abs() < 1e-12), "{kind:?}");
        let mut random = Random(5);
        for pressure in &mut stand.pressure {
            *pressure = 1e4 * random.next();
        }
        assert!(stand.tangent_error(&rest, &rest) < 1e-6, "{kind:?}");
    }
}

/// A drained surface in every cell, through that and as a neighbour's, but for a wall and another region: its tangent, and that it lets out
/// what the shape functions lose.
fn a_surface_drains<K: Kinematics<2>>() {
    for kind in KINDS {
        let mesh = mesh(kind);
        let mut points = points(&mesh, |_| true);
        points.pore_pressure = vec![0.0; points.len()];
        let cells = mesh.cells.len() as u32;
        let soil = porous([3e-5, 1e-5]);
        let term: Box<dyn Term<2>> = Box::new(DrainedSurface::<K>::new(soil.clone(), Some(3), UNIT, vec![true; 2]));
        let water = Some(Water { porous: soil, alone: true, ..Water::default() });
        let mut stand = Stand::<K>::with_water(&Mpm, mesh, points, term, false, true, Some(UNIT), water);
        let piece = |cell: u32| {
            let in_host = Path {
                ends: if cell == 0 { [[1.1, -0.2], [0.4, 0.9]] } else { [[0.2, 0.1], [0.3, 0.6]] },
                rates: [[0.1, 0.4], [-0.1, 0.6]],
            };
            Piece {
                cell,
                path: Path::straight([[0.2, 0.1], [0.3, 0.6]]),
                wall: cell == 1,
                region: 3 + u16::from(cell == 2),
                host: cell,
                in_host,
            }
        };
        stand.state.weights.boundary =
            ActiveBoundary { pieces: (0..cells).map(piece).collect(), first: vec![0, cells] };
        let mut random = Random(9);
        for pressure in &mut stand.pressure {
            *pressure = 40.0 + 20.0 * random.next();
        }
        let converged = stand.field(0.02, 1, |[x, y]| [0.1 * x - 0.2 * y, 0.1 * x + 0.05 * y]);
        let trial = stand.field(0.02, 2, |[x, y]| [0.12 * x - 0.3 * y, 0.3 * x - 0.1 * y]);
        let (force, _) = stand.system(&trial, &stand.pressure, &converged, 0, false);
        assert!(force.iter().all(|f| *f == 0.0), "{kind:?}: nothing flows in no time");
        stand.flow_time = 1e4;
        let error = stand.tangent_error(&trial, &converged);
        assert!(error < 1e-8, "{kind:?}: {error:.1e}");
        assert!(stand.asymmetry(&trial, &converged) < 1e-12, "{kind:?}");
        let (force, _) = stand.system(&trial, &stand.pressure, &converged, 0, false);
        let (lost, out) = (-force.iter().sum::<f64>() / UNIT, stand.outflow(&trial, &converged));
        let nothing = |stand: &Stand<K>| stand.term().idle_load(&stand.frame(), &converged, 0);
        assert_eq!(nothing(&stand), None);
        stand.state.weights.boundary.pieces.retain(|piece| piece.wall || piece.region != 3);
        assert!(stand.outflow(&trial, &converged) == 0.0 && nothing(&stand).is_some(), "{kind:?}");
        assert!(out.abs() > 1e-3 && (lost / out - 1.0).abs() < 1e-12, "{kind:?}: {lost} {out}");
    }
}

#[test]
fn a_surface_drains_symmetrically_what_the_corners_lose() {
    a_surface_drains::<PlaneStrain>();
    a_surface_drains::<Axisymmetric>();
}
