//! The reduced system: its tangent against differences, and forces on controls and nodes.

use super::{KINDS, elastic, graded};
use crate::support::Random;
use crate::support::bench::Bench;
use crate::support::layout::{at, lattice, resample};
use mpm::interpolation::BSpline;
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::mesh::shape::CellKind;
use mpm::step::{Grid, Restore, Scene, Simulation, State};
use mpm::system::{Connectivity, Local, Matrix, Pattern, Workspace, scatter};
use mpm::term::{Assembly, GhostInertia, Term, Trial};

/// A grid of which points fill a corner, with all terms that a restored dynamic scene has.
fn partly_filled<K: Kinematics<2> + 'static>(kind: CellKind) -> (Scene<2>, State<2>, Grid<2>) {
    let mesh = graded(kind, 4.0, 4.0, 7, 7, 1.1);
    let mut bench = Bench::new(mesh, elastic(1000.0, 0.3));
    bench.scheme = &BSpline;
    bench.gravity = [0.0, -10.0];
    bench.dynamic = true;
    bench.restore = Restore::EveryStep;
    resample::<K>(&mut bench);
    let faces = mpm::mesh::faces::Faces::of(&bench.mesh).inner.len();
    bench.extra.push(Box::new(GhostInertia::<K>::new(1.0, faces)));
    let mut places = lattice(1.3, 1.1, 0.13, &mut Random(5));
    places.iter_mut().for_each(|(x, _)| *x = [x[0] + 0.07, x[1] + 0.05]);
    let points = at::<K>(&bench.mesh, &places, 1.0);
    let scene = bench.scene::<K>();
    let simulation = Simulation::<2, K>::new(&scene, State::new(points, scene.mesh.nodes.len(), 1.0)).unwrap();
    let state = simulation.state;
    let grid = Grid::new::<K>(&scene, &state).unwrap();
    (scene, state, grid)
}

/// Residual and tangent of all terms of a scene in the unknowns of the system.
fn assembled(
    (scene, state, grid): (&Scene<2>, &State<2>, &Grid<2>),
    control: &[f64],
    matrix: Option<&mut Matrix>,
) -> Vec<f64> {
    let mut displacement = vec![[0.0; 2]; scene.mesh.nodes.len()];
    for d in 0..2 {
        let values: Vec<f64> = control.iter().skip(d).step_by(2).copied().collect();
        grid.dofs.write(&values, d, &mut displacement);
    }
    const SLOPE: f64 = 170.0;
    let acceleration: Vec<[f64; 2]> = displacement.iter().map(|u| u.map(|u| SLOPE * u)).collect();
    let trial = Trial {
        acceleration: &acceleration,
        acceleration_slope: SLOPE,
        ..Trial::at_rest(&displacement, &state.displacement)
    };
    let mut force = vec![0.0; grid.motion.pattern.len()];
    let mut workspace = Workspace::default();
    let frame = grid.frame(&scene.mesh, state);
    let mut tangent = matrix;
    for term in &scene.terms {
        let mut out = Assembly { force: &mut force, tangent: tangent.as_deref_mut(), workspace: &mut workspace };
        Term::assemble(term.as_ref(), &frame, &trial, &mut out).unwrap();
    }
    force
}

/// The tangent over the controls is the derivative of the residual over them, and the residual does the work of the nodal forces.
#[test]
fn the_reduced_tangent_is_that_of_the_reduced_residual() {
    fn check<K: Kinematics<2> + 'static>(kind: CellKind) {
        let (scene, state, grid) = partly_filled::<K>(kind);
        let nodes: std::collections::BTreeSet<u32> =
            grid.cells.iter().flat_map(|&c| scene.mesh.cells.nodes(c as usize)).copied().collect();
        assert!(grid.dofs.node.len() < nodes.len() / 2, "{} controls of {} nodes", grid.dofs.node.len(), nodes.len());
        assert!(grid.cells.len() < scene.mesh.cells.len() && !grid.ghost.is_empty());
        let count = grid.motion.pattern.len();
        let mut random = Random(9);
        let control: Vec<f64> = (0..count).map(|_| 0.01 * random.next()).collect();
        let way: Vec<f64> = (0..count).map(|_| random.next()).collect();
        let mut matrix = Matrix::new(&grid.motion.pattern);
        let of = (&scene, &state, &grid);
        let force = assembled(of, &control, Some(&mut matrix));
        let mut slope = vec![0.0; count];
        matrix.multiply(&grid.motion.pattern, &way, &mut slope);
        let step = 1e-6;
        let moved = |by: f64| -> Vec<f64> { control.iter().zip(&way).map(|(c, w)| c + by * w).collect() };
        let [after, before] = [step, -step].map(|by| assembled(of, &moved(by), None));
        let size = slope.iter().map(|s| s * s).sum::<f64>().sqrt();
        let differ = (0..count).map(|i| ((after[i] - before[i]) / (2.0 * step) - slope[i]).powi(2)).sum::<f64>().sqrt();
        println!("{kind:?}: tangent off by {:.1e}, {} equations", differ / size, force.len());
        assert!(differ < 1e-7 * size, "{differ:e} of {size:e}");
    }
    for kind in KINDS {
        check::<PlaneStrain>(kind);
        check::<Axisymmetric>(kind);
    }
}

/// Forces on controls, nodal forces that do the same work, and back.
#[test]
fn forces_on_controls_come_back_from_nodes() {
    for kind in KINDS {
        let (_, _, grid) = partly_filled::<PlaneStrain>(kind);
        let mut random = Random(4);
        let force: Vec<[f64; 2]> = grid.dofs.node.iter().map(|_| [random.next(), random.next()]).collect();
        let back = grid.dofs.on_blocks(&grid.dofs.on_nodes(&force));
        let off = force.iter().flatten().zip(back.iter().flatten()).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(off < 1e-13, "{kind:?}: {off:e}");
    }
}

/// A coupling of three nodes, combinations of four blocks of two equations, and of a scalar block behind them: the system has `Eᵀ r` and
/// `Eᵀ K E` with the identity for the scalar.
#[test]
fn couplings_are_reduced_by_their_rows() {
    let rows: [&[(u32, f64)]; 3] = [&[(2, 0.25), (0, 0.75)], &[(1, 1.0)], &[(0, 0.1), (3, 0.6), (1, 0.3)]];
    let mut e = nalgebra::DMatrix::<f64>::zeros(7, 9);
    for (n, row) in rows.iter().enumerate() {
        for &(block, by) in *row {
            (0..2).for_each(|d| e[(2 * n + d, 2 * block as usize + d)] = by);
        }
    }
    e[(6, 8)] = 1.0;
    for symmetric in [true, false] {
        let mut random = Random(6);
        let mut k = nalgebra::DMatrix::from_fn(7, 7, |_, _| random.next());
        if symmetric {
            k += k.transpose();
        }
        let r = nalgebra::DVector::from_fn(7, |_, _| random.next());
        let mut nodes = Connectivity::default();
        nodes.push([3, 1]);
        nodes.push_combined(rows);
        let mut connectivity = Connectivity::default();
        connectivity.push_extended(&nodes, 0, []);
        connectivity.push_extended(&nodes, 1, [4]);
        let pattern = Pattern::new(&[2, 2, 2, 2, 1], connectivity, symmetric);
        let (mut force, mut matrix) = (vec![0.0; 9], Matrix::new(&pattern));
        let compute = |_: &usize, local: &mut Local| {
            assert_eq!(local.size, 7);
            local.vector.copy_from_slice(r.as_slice());
            (0..49).for_each(|i| local.matrix[i] = k[(i / 7, i % 7)]);
            Ok(())
        };
        let mut workspace = Workspace::default();
        scatter(&pattern, &[1], |k| *k, compute, &mut force, Some(&mut matrix), &mut workspace).unwrap();
        let (wanted, tangent) = (e.transpose() * &r, e.transpose() * &k * &e);
        assert!(wanted.iter().zip(&force).all(|(a, b)| (a - b).abs() < 1e-14), "{wanted} {force:?}");
        for j in 0..9 {
            let unit: Vec<f64> = (0..9).map(|i| f64::from(u8::from(i == j))).collect();
            let mut column = vec![0.0; 9];
            matrix.multiply(&pattern, &unit, &mut column);
            let off = (0..9).map(|i| (tangent[(i, j)] - column[i]).abs()).fold(0.0, f64::max);
            assert!(off < 1e-14, "symmetric {symmetric}, column {j}: {off:e}");
        }
    }
}
