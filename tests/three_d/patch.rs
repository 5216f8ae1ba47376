//! The linear patch test on irregular meshes: boundary displacements of a uniform strain give that strain everywhere, with a
//! uniform stress and no force on the nodes within.

use crate::three_d::stand::{Random, Stand, Step, linear, points, size};
use mpm::material::{Elasticity, LinearElastic, Model, Profile, State, VonMises, spatial};
use mpm::mesh::Mesh;
use mpm::mesh::brick::brick;
use mpm::mesh::shape::CellKind;
use mpm::seed::QUADRATURE;
use mpm::tensor::{Tensor, full, symmetric};
use nalgebra::{DMatrix, DVector};
use std::sync::Arc;

fn models() -> [Arc<dyn Model>; 2] {
    let elasticity = || Elasticity::new(Profile::constant(1000.0), 0.3).unwrap();
    let von_mises = VonMises::new(elasticity(), Profile::constant(12.0)).unwrap();
    [Arc::new(LinearElastic::new(elasticity())), Arc::new(von_mises)]
}

fn gradients() -> [Tensor; 2] {
    [
        Tensor::new(1e-3, 2e-3, -5e-4, -1e-3, 3e-3, 1e-3, 0.0, -2e-3, 1e-3),
        Tensor::new(0.1, 0.2, -0.05, -0.1, 0.05, 0.1, 0.15, -0.1, -0.08),
    ]
}

/// Integration points, and material points: in tetrahedra the middles of equal parts, in hexahedra the places of a rule, which
/// integrate the gradients in irregular cells exactly.
fn irregular() -> Vec<(CellKind, Mesh<3>, u32)> {
    let mesh = |kind| brick(kind, [2.0, 1.5, 1.0], [3, 2, 2], 0.15, 7);
    let of = |(kind, count)| (kind, mesh(kind), count);
    [
        (CellKind::T10, QUADRATURE),
        (CellKind::T10, 4),
        (CellKind::T10, 8),
        (CellKind::T10, 64),
        (CellKind::H27, QUADRATURE),
    ]
    .map(of)
    .to_vec()
}

/// Parallelepipeds of unequal sizes: there the middles of equal boxes do so too.
fn slanted() -> Vec<(CellKind, Mesh<3>, u32)> {
    let mesh = |kind| {
        let mut mesh = brick(kind, [2.0, 1.5, 1.0], [3, 2, 2], 0.0, 7);
        for x in &mut mesh.nodes {
            let [a, b, c] = *x;
            *x = [a + 0.3 * b - 0.1 * c, 0.2 * a + b, c + 0.2 * b];
        }
        mesh
    };
    [8, 27, 64].map(|count| (CellKind::H27, mesh(CellKind::H27), count)).to_vec()
}

/// The nodes within.
fn inner(mesh: &Mesh<3>) -> Vec<usize> {
    let outer: Vec<u32> = mesh.groups.iter().flat_map(|group| group.nodes.iter().copied()).collect();
    (0..mesh.nodes.len()).filter(|&n| !outer.contains(&(n as u32))).collect()
}

#[test]
fn a_uniform_strain_gives_a_uniform_stress_and_no_force_within() {
    for (kind, mesh, count) in irregular().into_iter().chain(slanted()) {
        for model in models() {
            let stand = Stand::new(mesh.clone(), points(&mesh, count), model.clone(), false);
            let rest = vec![[0.0; 3]; mesh.nodes.len()];
            for gradient in gradients() {
                let trial = linear(&mesh, &gradient);
                let step = Step::to(&trial, &rest);
                let force = stand.force(step);
                let within: Vec<[f64; 3]> = inner(&mesh).iter().map(|&n| force[n]).collect();
                assert!(within.len() > 3);
                let error = size(&within) / size(&force);
                assert!(error < 1e-12, "{kind:?} {count}: {error:.1e}");

                let f = Tensor::identity() + gradient;
                let b = symmetric(&(f * f.transpose()));
                let answer = spatial::solid(model.as_ref(), 0.0, &b, &State::default(), &mut []).unwrap();
                let exact = full(&answer.kirchhoff) / f.determinant();
                for history in stand.commit(step) {
                    let error = (full(&history.stress) - exact).amax() / exact.amax();
                    assert!(error < 1e-10, "{kind:?} {count}: {error:.1e}");
                }
            }
        }
    }
}

/// Newton's method finds the uniform strain from elsewhere, and quadratically.
#[test]
fn the_boundary_alone_gives_the_uniform_strain() {
    for (kind, mesh, count) in irregular().into_iter().chain(slanted()).filter(|(.., count)| *count != 64) {
        for model in models() {
            let (stand, free) = (Stand::new(mesh.clone(), points(&mesh, count), model, false), inner(&mesh));
            let rest = vec![[0.0; 3]; mesh.nodes.len()];
            for gradient in gradients() {
                let exact = linear(&mesh, &gradient);
                let (mut trial, mut random) = (exact.clone(), Random(9));
                let far = 0.05 * gradient.amax();
                free.iter().for_each(|&n| trial[n].iter_mut().for_each(|u| *u += far * random.next()));
                let equations: Vec<usize> = free.iter().flat_map(|n| (0..3).map(move |d| 3 * n + d)).collect();
                let mut residuals = Vec::new();
                for _ in 0..12 {
                    let (force, tangent) = stand.evaluate(Step::to(&trial, &rest), true).unwrap();
                    let tangent = tangent.unwrap();
                    let residual =
                        DVector::from_iterator(equations.len(), equations.iter().map(|&e| force[e / 3][e % 3]));
                    residuals.push(residual.amax() / size(&force));
                    if residuals.last().is_some_and(|r| *r < 1e-11) {
                        break;
                    }
                    let count = equations.len();
                    let matrix = DMatrix::from_fn(count, count, |i, j| tangent[(equations[i], equations[j])]);
                    let change = matrix.lu().solve(&residual).unwrap();
                    equations.iter().zip(&change).for_each(|(&e, change)| trial[e / 3][e % 3] -= change);
                }
                let error = trial.iter().zip(&exact).flat_map(|(u, v)| [0, 1, 2].map(|d| (u[d] - v[d]).abs()));
                let error = error.fold(0.0, f64::max) / far;
                assert!(error < 1e-9, "{kind:?} {count}: {error:.1e}, {residuals:?}");
                assert!(residuals.len() <= 8, "{kind:?} {count}: {residuals:?}");
            }
        }
    }
}
