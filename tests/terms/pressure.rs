//! The pressure field: its tangent, its symmetry, and the inf-sup constant of its functions.

use crate::support::Random;
use crate::support::layout::add_point;
use crate::support::stand::{KINDS, SMOOTHED, Stand, mesh, points};
use mpm::interpolation::{Basis, Ddmp, Mpm};
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::material::{CamClay, Elasticity, Friction, LinearElastic, Model, MohrCoulomb, Profile, Tresca};
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::{CellKind, MAX_NODES, map, rule};
use mpm::points::Points;
use mpm::term::{Internal, MixedPressure, PressureField, SmoothPressure, Term};
use nalgebra::{DMatrix, SymmetricEigen};
use std::sync::Arc;

const UNIT: f64 = 700.0;

/// A model of shear modulus 400 kPa, nearly without volume stiffness.
fn elasticity() -> Elasticity {
    let poisson = -0.9;
    Elasticity::new(Profile::constant(800.0 * (1.0 + poisson)), poisson).unwrap()
}

/// The share at Poisson's ratio 0.4999, with water in the pores or without.
fn carried(model: Arc<dyn Model>, water: f64) -> MixedPressure {
    MixedPressure { model, ratio: 2.0 * 1.4999 / (3.0 * 0.0002), water, bound: None, limit: None }
}

/// The same with a limit of the tension within the range of the noise.
fn limited(model: Arc<dyn Model>, water: f64) -> MixedPressure {
    MixedPressure { limit: Some(Profile::constant(9.0)), ..carried(model, water) }
}

/// A stand in large strain, with noise in all unknowns.
fn set<K: Kinematics<2>>(
    scheme: &'static dyn Basis<2>,
    kind: CellKind,
    carried: MixedPressure,
    alpha_f: f64,
) -> (Stand<K>, [Vec<[f64; 2]>; 2]) {
    let mesh = mesh(kind);
    let mut points = points(&mesh, |_| true);
    let mut random = Random(17);
    points.pressure = (0..points.len()).map(|_| 30.0 * random.next()).collect();
    let model = carried.model.clone();
    let field = PressureField::<K>::new(vec![Some(carried)], UNIT);
    let term = Box::new(Internal::<K, _>::sharing(vec![Some(model)], alpha_f > 0.0, field));
    let mut stand = Stand::<K>::with(scheme, mesh, points, term, false, true, Some(UNIT));
    stand.alpha_f = alpha_f;
    stand.state.points.stress.fill([3.0, -7.0, 2.0, 1.5, 0.0, 0.0]);
    for pressure in &mut stand.pressure {
        *pressure = 40.0 + 20.0 * random.next();
    }
    let converged = stand.field(0.02, 1, |[x, y]| [0.1 * x - 0.2 * y, 0.1 * x + 0.05 * y]);
    let trial = stand.field(0.02, 2, |[x, y]| [0.12 * x - 0.3 * y, 0.3 * x - 0.1 * y]);
    (stand, [trial, converged])
}

fn tangent_is_the_derivative<K: Kinematics<2>>(scheme: &'static dyn Basis<2>, kinds: &[CellKind]) {
    let elastic: Arc<dyn Model> = Arc::new(LinearElastic::new(elasticity()));
    let tresca: Arc<dyn Model> = Arc::new(Tresca::new(elasticity(), Profile::constant(5.0)).unwrap());
    for &kind in kinds {
        for model in [&elastic, &tresca] {
            for water in [0.0, 0.7, 1.0] {
                for alpha_f in [0.0, 0.4] {
                    let (stand, [trial, converged]) = set::<K>(scheme, kind, carried(model.clone(), water), alpha_f);
                    let name = format!("{scheme:?}, {kind:?}, water {water}, α_f = {alpha_f}");
                    let error = stand.tangent_error(&trial, &converged);
                    assert!(error < 1e-6, "{name}: {error:.1e}");
                    if alpha_f == 0.0 {
                        let asymmetry = stand.asymmetry(&trial, &converged);
                        assert!(asymmetry < 1e-12, "{name}: {asymmetry:.1e}");
                    }
                }
            }
        }
    }
}

/// Beyond a limit and below it, from states of points on both sides of it and in compression.
fn tangent_with_a_limit_is_the_derivative<K: Kinematics<2>>() {
    let tresca: Arc<dyn Model> = Arc::new(Tresca::new(elasticity(), Profile::constant(5.0)).unwrap());
    for kind in KINDS {
        for level in [-40.0, 0.0, 9.0, 15.0] {
            let (mut stand, [trial, converged]) = set::<K>(&Mpm, kind, limited(tresca.clone(), 0.7), 0.0);
            stand.pressure.iter_mut().for_each(|pressure| *pressure += level - 40.0);
            let error = stand.tangent_error(&trial, &converged);
            assert!(error < 1e-6, "{kind:?}, {level}: {error:.1e}");
            let asymmetry = stand.asymmetry(&trial, &converged);
            assert!(asymmetry < 1e-12, "{kind:?}, {level}: {asymmetry:.1e}");
        }
    }
}

/// Models that need their mean stress, and see the volume strain of the field in place of their own.
fn tangent_where_the_field_tells_the_volume_is_the_derivative<K: Kinematics<2>>() {
    let elasticity = || Elasticity::new(Profile::constant(1000.0), 0.25).unwrap();
    let mohr_coulomb = |dilation, tension: Option<f64>| -> Arc<dyn Model> {
        let friction = Friction::degrees(25.0, dilation).unwrap();
        let tension = tension.map(Profile::constant);
        // With 20 kPa a point of the Q9 mesh is on an edge of the yield surface to 1e-6, where there is no derivative.
        Arc::new(MohrCoulomb::new(elasticity(), Profile::constant(18.0), friction, tension).unwrap())
    };
    let clay: Arc<dyn Model> = Arc::new(CamClay::new(elasticity(), 1.0, Profile::constant(60.0), 0.1).unwrap());
    let models = [mohr_coulomb(0.0, None), mohr_coulomb(25.0, None), mohr_coulomb(10.0, Some(2.0)), clay];
    for kind in KINDS {
        for (number, model) in models.iter().enumerate() {
            // With water, and without: the field has the whole mean stress then.
            for (ratio, bound, alpha_f) in
                [(80.0, 1e-3, 0.0), (80.0, 0.5, 0.0), (80.0, 0.5, 0.4), (0.0, 0.5, 0.0), (0.0, 0.5, 0.4)]
            {
                let water = f64::from(u8::from(ratio > 0.0));
                let carried = MixedPressure { model: model.clone(), ratio, water, bound: Some(bound), limit: None };
                let (stand, [trial, converged]) = set::<K>(&Mpm, kind, carried, alpha_f);
                let name = format!("{kind:?}, model {number}, water {ratio}, bound by {bound}, α_f = {alpha_f}");
                let error = stand.tangent_error(&trial, &converged);
                assert!(error < 1e-6, "{name}: {error:.1e}");
                if alpha_f == 0.0 && model.symmetric() {
                    let asymmetry = stand.asymmetry(&trial, &converged);
                    assert!(asymmetry < 1e-12, "{name}: {asymmetry:.1e}");
                }
            }
        }
    }
}

#[test]
fn the_tangent_where_the_field_tells_the_volume_is_the_derivative() {
    tangent_where_the_field_tells_the_volume_is_the_derivative::<PlaneStrain>();
    tangent_where_the_field_tells_the_volume_is_the_derivative::<Axisymmetric>();
}

#[test]
fn the_tangent_of_cavitating_soil_is_the_derivative() {
    tangent_with_a_limit_is_the_derivative::<PlaneStrain>();
    tangent_with_a_limit_is_the_derivative::<Axisymmetric>();
}

#[test]
fn the_tangent_is_the_derivative_in_plane_strain() {
    tangent_is_the_derivative::<PlaneStrain>(&Mpm, &KINDS);
}

#[test]
fn the_tangent_is_the_derivative_in_axisymmetry() {
    tangent_is_the_derivative::<Axisymmetric>(&Mpm, &KINDS);
}

/// The field reaches the functions beyond a cell's nodes, too, whose stiffness the system has by products alone.
#[test]
fn the_tangent_is_the_derivative_with_smoothed_gradients() {
    tangent_is_the_derivative::<PlaneStrain>(&Ddmp, &SMOOTHED);
    tangent_is_the_derivative::<Axisymmetric>(&Ddmp, &SMOOTHED);
}

#[test]
fn the_bond_is_free_for_a_uniform_increment_and_its_tangent_the_derivative() {
    for kind in KINDS {
        let mesh = mesh(kind);
        let mut points = points(&mesh, |_| true);
        points.pressure = vec![0.0; points.len()];
        let (corners, cells) = (mesh.nodes.len(), mesh.cells.len());
        let term: Box<dyn Term<2>> = Box::new(SmoothPressure::<PlaneStrain>::new(vec![true], UNIT, 400.0, cells));
        let mut stand = Stand::<PlaneStrain>::with_pressure(mesh, points, term, false, true, Some(UNIT));
        let rest = stand.field(0.0, 1, |_| [0.0; 2]);
        stand.pressure[..corners].fill(25.0);
        let (force, _) = stand.system(&rest, &stand.pressure, &rest, 0, false);
        assert!(force.iter().all(|f| f.abs() < 1e-12), "{kind:?}");
        let mut random = Random(5);
        for pressure in &mut stand.pressure {
            *pressure = 1e4 * random.next();
        }
        assert!(stand.tangent_error(&rest, &rest) < 1e-6, "{kind:?}");
    }
}

/// Where all is of a material of which the field carries nothing, a uniform pressure must not be free.
#[test]
fn the_bond_holds_a_uniform_increment_where_nothing_is_carried() {
    for kind in KINDS {
        let mesh = mesh(kind);
        let mut points = points(&mesh, |_| true);
        points.pressure = vec![0.0; points.len()];
        let (corners, cells) = (mesh.nodes.len(), mesh.cells.len());
        let term: Box<dyn Term<2>> = Box::new(SmoothPressure::<PlaneStrain>::new(vec![false], UNIT, 400.0, cells));
        let mut stand = Stand::<PlaneStrain>::with_pressure(mesh, points, term, false, true, Some(UNIT));
        let rest = stand.field(0.0, 1, |_| [0.0; 2]);
        stand.pressure[..corners].fill(2.5e7);
        let (force, _) = stand.system(&rest, &stand.pressure, &rest, 0, false);
        assert!(force.iter().any(|f| f.abs() > 1e-9), "{kind:?}: {force:?}");
        let mut random = Random(6);
        for pressure in &mut stand.pressure {
            *pressure = 1e4 * random.next();
        }
        assert!(stand.tangent_error(&rest, &rest) < 1e-6, "{kind:?}");
    }
}

/// 16 or 9 points a cell at the places of a quadrature.
fn lattice(mesh: &mpm::mesh::Mesh<2>) -> Points<2> {
    let mut points = Points::default();
    let (mut n, mut g) = ([0.0; MAX_NODES], [[0.0; 2]; MAX_NODES]);
    for c in 0..mesh.cells.len() {
        let mut x = Vec::new();
        mesh.cell_coordinates(c, &mut x);
        for (xi, weight) in rule(mesh.cells.kind[c], 4) {
            let volume = weight * map(mesh.cells.kind[c], &x, &xi, &mut n, &mut g);
            let place: [f64; 2] = std::array::from_fn(|d| x.iter().zip(&n).map(|(x, n)| x[d] * n).sum());
            add_point(&mut points, place, [volume; 2], c as u32);
            points.pressure.push(0.0);
        }
    }
    points
}

/// The blocks `A`, `B`, `C` of the tangent of the undeformed square with all its boundary held, pressures in units of
/// the field and `G = ½`, for `K_f = ratio · G`.
fn blocks(kind: CellKind, n: usize, ratio: f64) -> [DMatrix<f64>; 3] {
    let mesh = rectangle(kind, 1.0, 1.0, n, n, 0.2, 3);
    let mut held = vec![false; mesh.nodes.len()];
    for group in &mesh.groups {
        for &node in &group.nodes {
            held[node as usize] = true;
        }
    }
    // Poisson's ratio 0: A is ∫ ε : ε.
    let model: Arc<dyn Model> = Arc::new(LinearElastic::new(Elasticity::new(Profile::constant(1.0), 0.0).unwrap()));
    let carried = MixedPressure { model: model.clone(), ratio, water: 0.0, bound: None, limit: None };
    let field = PressureField::<PlaneStrain>::new(vec![Some(carried)], 1.0);
    let term = Box::new(Internal::<PlaneStrain, _>::sharing(vec![Some(model)], false, field));
    let points = lattice(&mesh);
    let stand = Stand::<PlaneStrain>::with_pressure(mesh, points, term, false, true, Some(1.0));
    let rest = stand.field(0.0, 1, |_| [0.0; 2]);
    let (_, columns) = stand.system(&rest, &stand.pressure, &rest, 0, true);
    let nodes = rest.len();
    let free: Vec<usize> = (0..2 * nodes).filter(|i| !held[i / 2]).collect();
    let field: Vec<usize> = (2 * nodes..columns.len()).collect();
    let block =
        |rows: &[usize], over: &[usize]| DMatrix::from_fn(rows.len(), over.len(), |i, j| columns[over[j]][rows[i]]);
    [block(&free, &free), block(&field, &free), -block(&field, &field)]
}

/// The least `β` with `sup_v ∫ q div v / |v| ≥ β |q|` (less what stabilises) over all `q` but the constant.
fn inf_sup(kind: CellKind, n: usize) -> f64 {
    let [a, b, soft] = blocks(kind, n, 2.0);
    let [_, _, softer] = blocks(kind, n, 1.0);
    // C = M/K_f + stabilisation, and K_f is G ratio = ratio/2.
    let mass = &softer - &soft;
    let stabilisation = &soft - &mass;
    let schur = &b * a.cholesky().unwrap().solve(&b.transpose()) + stabilisation;
    // Without what the mass does not see: a uniform pressure shifted from the corners to the constants.
    let eigen = SymmetricEigen::new(mass);
    let largest = eigen.eigenvalues.max();
    let seen: Vec<usize> = (0..eigen.eigenvalues.len()).filter(|&i| eigen.eigenvalues[i] > 1e-10 * largest).collect();
    let scaled = DMatrix::from_fn(schur.nrows(), seen.len(), |i, j| {
        eigen.eigenvectors[(i, seen[j])] / eigen.eigenvalues[seen[j]].sqrt()
    });
    let mut values: Vec<f64> =
        SymmetricEigen::new(scaled.transpose() * schur * &scaled).eigenvalues.iter().copied().collect();
    values.sort_by(f64::total_cmp);
    // A uniform pressure does no work on a held boundary; nothing else may.
    assert!(values[0].abs() < 1e-10, "{kind:?}: {:e}", values[0]);
    values[1].max(0.0).sqrt()
}

/// Tolerance: a constant falling with h would halve from n = 4 to 8.
#[test]
fn the_inf_sup_constant_does_not_depend_on_the_mesh() {
    for kind in KINDS {
        let beta = [2, 4, 8].map(|n| inf_sup(kind, n));
        println!(
            "{kind:?}: inf-sup constant {:.3} / {:.3} / {:.3} for 2, 4, 8 boxes a side",
            beta[0], beta[1], beta[2]
        );
        assert!(beta[2] > 0.1 && beta[2] > 0.8 * beta[1], "{kind:?}: {beta:?}");
    }
}
