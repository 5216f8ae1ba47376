//! A scheme with two rings of support, defined in this file only; the library needs no change for it.
//!
//! `N̄_I(x) = Σ_J N_J(x) A_JI`, where row J of `A` mixes the value of node J with that at J of the plane fitted to all nodes of the cells around J;
//! at nodes on the boundary `A` is the identity. `A` is not singular, so that the functions span what the shape functions of the cells do, with
//! the same values on the boundary: whatever the program solves with this scheme must have the same solution as with plain MPM.

use crate::support::bench::{Bench, constant, quadrature_points, run};
use mpm::interpolation::{Basis, Interpolation, Located, Mpm, Place, Support};
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::material::{Elasticity, LinearElastic, Tresca};
use mpm::mesh::Mesh;
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use mpm::points::Points;
use mpm::step::{Restore, State};
use mpm::term::{MixedPressure, Porous, WaterStiffness};
use nalgebra::{Matrix3, Vector3};
use std::sync::Arc;

const KINDS: [CellKind; 4] = [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q9];

/// The part (-) of the fitted plane in the value at a node.
const MIXED: f64 = 0.4;

#[derive(Debug)]
struct Fitted;

impl Fitted {
    /// Row `node` of `A`, over the nodes in `others` that cells around the node have: their numbers and the entries.
    fn row(mesh: &Mesh<2>, node: u32, fixed: bool) -> Vec<(u32, f64)> {
        if fixed {
            return vec![(node, 1.0)];
        }
        let mut nodes: Vec<u32> = (0..mesh.cells.len())
            .map(|c| mesh.cells.nodes(c))
            .filter(|nodes| nodes.contains(&node))
            .flatten()
            .copied()
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        let from = mesh.nodes[node as usize];
        let at = |n: u32| {
            let x = mesh.nodes[n as usize];
            Vector3::new(1.0, x[0] - from[0], x[1] - from[1])
        };
        let normal: Matrix3<f64> = nodes.iter().map(|&n| at(n) * at(n).transpose()).sum();
        let first = normal.try_inverse().unwrap().column(0).into_owned();
        nodes.iter().map(|&n| (n, MIXED * first.dot(&at(n)) + if n == node { 1.0 - MIXED } else { 0.0 })).collect()
    }
}

impl Basis<2> for Fitted {
    fn name(&self) -> &'static str {
        "fitted"
    }

    fn support(&self, mesh: &Mesh<2>, active: &[bool]) -> Option<Support> {
        Some(Support::with_neighbours(mesh, active))
    }

    fn fill(&self, points: &Located<2>, interpolation: &mut Interpolation<2>) {
        let mesh = points.mesh;
        let mut fixed = vec![false; mesh.nodes.len()];
        mesh.groups.iter().flat_map(|group| &group.nodes).for_each(|&n| fixed[n as usize] = true);
        let rows: Vec<_> = (0u32..).zip(&fixed).map(|(n, &fixed)| Self::row(mesh, n, fixed)).collect();
        let support = Support::with_neighbours(mesh, points.active);
        interpolation.fill_support(points, support, |place: &Place<2>, value, gradient| {
            for (k, &n) in mesh.cells.nodes(place.cell).iter().enumerate() {
                for &(m, entry) in &rows[n as usize] {
                    let to = place.nodes.iter().position(|&other| other == m).unwrap();
                    value[to] += entry * place.shape[k];
                    (0..2).for_each(|d| gradient[to][d] += entry * place.shape_gradient[k][d]);
                }
            }
        });
    }
}

/// Values sum up to one and gradients to zero, a linear field comes back, and the functions reach beyond the cell.
#[test]
fn linear_fields_come_back() {
    for kind in KINDS {
        let mesh = rectangle(kind, 4.0, 3.0, 4, 3, 0.2, 5);
        let points = quadrature_points::<PlaneStrain>(&mesh, 4, 1.0);
        let xi = mpm::case::parts::places(&mesh, &points).unwrap();
        let mut interpolation = Interpolation::default();
        interpolation.fill::<PlaneStrain>(&Fitted, &mesh, &points.cell, &xi, &vec![true; mesh.cells.len()]);
        let mut widest = 0;
        for cell_points in &interpolation.filled {
            let nodes = interpolation.nodes(&mesh, cell_points.cell);
            widest = widest.max(nodes.len());
            for entries in interpolation.entries::<PlaneStrain>(cell_points) {
                let sum = |of: &dyn Fn(&[f64; 2]) -> f64| -> [f64; 3] {
                    let terms = (0..nodes.len()).map(|i| (of(&mesh.nodes[nodes[i] as usize]), i));
                    terms.fold([0.0; 3], |[v, x, y], (f, i)| {
                        let [gx, gy] = entries.gradient(i).g;
                        [v + f * entries.value[i], x + f * gx, y + f * gy]
                    })
                };
                let close = |a: [f64; 3], b: [f64; 3]| a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-11);
                let [x, y] = points.position[entries.point];
                assert!(close(sum(&|_| 1.0), [1.0, 0.0, 0.0]), "{kind:?}");
                assert!(close(sum(&|x| 2.0 * x[0] - 3.0 * x[1]), [2.0 * x - 3.0 * y, 2.0, -3.0]), "{kind:?}");
            }
        }
        assert!(widest > 2 * kind.node_count(), "{kind:?}: {widest}");
    }
}

/// The final state of a scene under gravity solved with a scheme, and the iterations of each step.
fn solved<K: Kinematics<2>>(
    scheme: &'static dyn Basis<2>,
    kind: CellKind,
    restore: Restore,
    change: impl Fn(&mut Bench),
) -> (State<2>, Vec<usize>) {
    let mesh = rectangle(kind, 3.0, 4.0, 3, 4, 0.15, 3);
    let elasticity = Elasticity::new(constant(1000.0), 0.3).unwrap();
    let mut bench = Bench::new(mesh, Arc::new(LinearElastic::new(elasticity)));
    (bench.scheme, bench.restore) = (scheme, restore);
    bench.gravity = [3.0, -10.0];
    bench.steps = 3;
    bench.hold("left", &[0]).hold("right", &[0]).hold("bottom", &[0, 1]);
    change(&mut bench);
    let density = bench.density;
    let points: Points<2> = quadrature_points::<K>(&bench.mesh, 4, density);
    let scene = bench.scene::<K>();
    let mut iterations = Vec::new();
    let state = run::<K>(&scene, points, |_, report| iterations.push(report.iterations()));
    (state, iterations)
}

/// Both schemes have the same stresses, pressures and velocities, to `within` of the largest, after as many iterations.
fn same<K: Kinematics<2>>(kind: CellKind, restore: Restore, within: f64, change: impl Fn(&mut Bench) + Copy) {
    let (plain, by_plain) = solved::<K>(&Mpm, kind, restore, change);
    let (fitted, by_fitted) = solved::<K>(&Fitted, kind, restore, change);
    assert_eq!(by_plain, by_fitted, "{kind:?}");
    let columns = |state: &State<2>| {
        let points = &state.points;
        let pore = points.pore_pressure.clone();
        [points.stress.as_flattened().to_vec(), points.velocity.as_flattened().to_vec(), points.pressure.clone(), pore]
    };
    for (a, b) in columns(&plain).iter().zip(&columns(&fitted)) {
        let most = a.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let apart = a.iter().zip(b).fold(0.0, |most: f64, (a, b)| most.max((a - b).abs()));
        assert!(apart <= within * most, "{kind:?} {restore:?}: {apart:.1e} of {most:.1e}");
    }
    assert!(plain.points.stress.iter().any(|s| s[1] < -2.0));
}

#[test]
fn elastic_soil_has_the_solution_of_plain_mpm() {
    for kind in KINDS {
        for restore in [Restore::Never, Restore::EveryStep] {
            same::<PlaneStrain>(kind, restore, 1e-8, |_| {});
            same::<Axisymmetric>(kind, restore, 1e-8, |bench| bench.gravity[0] = 0.0);
        }
    }
}

#[test]
fn plastic_soil_with_a_pressure_field_has_the_solution_of_plain_mpm() {
    let clay = |bench: &mut Bench| {
        let elasticity = Elasticity::new(constant(1000.0), 0.3).unwrap();
        let model = Arc::new(Tresca::new(elasticity, constant(4.0)).unwrap());
        bench.carried = Some(MixedPressure { model: model.clone(), ratio: 20.0, water: 0.0, bound: None, limit: None });
        bench.model = model;
    };
    for kind in KINDS {
        same::<PlaneStrain>(kind, Restore::EveryStep, 1e-7, clay);
    }
}

fn with_water(bench: &mut Bench) {
    let model = bench.model.clone();
    bench.porous = Some(Porous { model, stiffness: WaterStiffness::Ratio(100.0), mobility: [1e-3; 2] });
    bench.drained = vec!["top"];
}

#[test]
fn pore_water_has_the_solution_of_plain_mpm() {
    for kind in KINDS {
        same::<PlaneStrain>(kind, Restore::EveryStep, 1e-8, with_water);
    }
}

/// On a grid that is not restored. A reset sets the mapped velocity to zero at supports, after which the two schemes differ at the nodes
/// beside the supports.
#[test]
fn motion_has_the_solution_of_plain_mpm() {
    for kind in KINDS {
        for water in [false, true] {
            same::<PlaneStrain>(kind, Restore::Never, 1e-8, |bench| {
                (bench.dynamic, bench.duration) = (true, 0.2);
                if water {
                    with_water(bench);
                }
            });
        }
    }
}
