//! The tangent of the internal force against differences, with each scheme.

use crate::schemes::functions::{COMPOSITE, CPDI, CPDI2, CPGIMP, UGIMP};
use crate::support::stand::{SMOOTHED, Stand, elastic, elasticity, mesh, points, resultant, size};
use mpm::interpolation::{Basis, Ddmp};
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::material::{Model, Profile, VonMises};
use mpm::mesh::Mesh;
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use mpm::term::Internal;
use std::sync::Arc;

/// The schemes with other gradients than those of the cells, with the grids that they support, away from the axis.
fn all() -> Vec<(&'static dyn Basis<2>, Mesh<2>)> {
    let mut straight = rectangle(CellKind::Q4, 2.0, 1.5, 2, 2, 0.0, 5);
    straight.nodes.iter_mut().for_each(|x| x[0] += 2.0);
    let mut all = vec![(UGIMP, straight.clone()), (CPGIMP, straight.clone()), (COMPOSITE, straight)];
    all.extend(SMOOTHED.map(|kind| (&Ddmp as &dyn Basis<2>, mesh(kind))));
    for kind in [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q8, CellKind::Q9] {
        all.extend([(CPDI, mesh(kind)), (CPDI2, mesh(kind))]);
    }
    all
}

fn for_all<K: Kinematics<2>>(whole: bool, check: impl Fn(&str, &Stand<K>, &[[f64; 2]], &[[f64; 2]])) {
    let von_mises: Arc<dyn Model> = Arc::new(VonMises::new(elasticity(), Profile::constant(12.0)).unwrap());
    for (scheme, mesh) in all() {
        for (name, model) in [("elastic", elastic() as Arc<dyn Model>), ("von Mises", von_mises.clone())] {
            for alpha_f in [0.0, 0.4] {
                let points = points(&mesh, |_| true);
                let kind = mesh.cells.kind[0];
                let term = Box::new(Internal::<K>::new(vec![Some(model.clone())], alpha_f > 0.0));
                let mut stand = Stand::<K>::with(scheme, mesh.clone(), points, term, false, whole, None);
                stand.alpha_f = alpha_f;
                let converged = stand.field(0.02, 1, |[x, y]| [0.1 * x - 0.3 * y, 0.2 * x + 0.1 * y]);
                let trial = stand.field(0.02, 2, |[x, y]| [0.2 * x - 0.5 * y, 0.6 * x - 0.2 * y]);
                let name = format!("{} on {kind:?}, {name}, α_f = {alpha_f}", scheme.name());
                check(&name, &stand, &trial, &converged);
            }
        }
    }
}

fn tangent_is_the_derivative<K: Kinematics<2>>() {
    for_all::<K>(true, |name, stand, trial, converged| {
        let error = stand.tangent_error(trial, converged);
        assert!(error < 1e-6, "{name}: {error:.1e}");
    });
}

#[test]
fn the_tangent_is_the_derivative_in_plane_strain() {
    tangent_is_the_derivative::<PlaneStrain>();
}

#[test]
fn the_tangent_is_the_derivative_in_axisymmetry() {
    tangent_is_the_derivative::<Axisymmetric>();
}

/// Cauchy's laws: the gradients of constants vanish, and those of linear fields are exact.
#[test]
fn the_force_is_in_balance_with_itself() {
    for_all::<PlaneStrain>(false, |name, stand, trial, converged| {
        let (force, _) = stand.evaluate(trial, converged, 0, false);
        // The place of a domain that is scaled to end at the boundary is found to 1e-9.
        let [sums, moments] = if name.starts_with("ddmp") { [1e-11, 3e-10] } else { [1e-9, 1e-7] };
        let sum = resultant(&force);
        assert!(sum.iter().all(|s| s.abs() < sums * size(&force)), "{name}: {sum:?}");
        if stand.alpha_f == 0.0 {
            let places = stand.scene.mesh.nodes.iter().zip(trial).map(|(x, u)| [x[0] + u[0], x[1] + u[1]]);
            let moment: f64 = places.zip(&force).map(|(x, f)| x[0] * f[1] - x[1] * f[0]).sum();
            assert!(moment.abs() < moments * size(&force), "{name}: {moment:.1e}");
        }
    });
}

/// Stands with elastic strain on a geometry that is held, a displacement, and one that strains it by another `size`.
fn for_all_held<K: Kinematics<2>>(size: f64, check: impl Fn(&str, &Stand<K>, &[[f64; 2]], &[[f64; 2]])) {
    for (scheme, mesh) in all() {
        let mut points = points(&mesh, |_| true);
        points.elastic.fill([1.02, 0.99, 1.01, 0.005, 0.0, 0.0]);
        let kind = mesh.cells.kind[0];
        let term = Box::new(Internal::<K>::new(vec![Some(elastic() as Arc<dyn Model>)], false));
        let mut stand = Stand::<K>::with(scheme, mesh.clone(), points, term, false, true, None);
        stand.state.search_geometry = stand.field(0.02, 3, |[x, y]| [0.1 * y - 0.2 * x, 0.1 * x + 0.1 * y]);
        let converged = stand.field(0.02, 1, |[x, y]| [0.1 * x - 0.3 * y, 0.2 * x + 0.1 * y]);
        let more = stand.field(0.02, 2, |[x, y]| [0.2 * x - 0.5 * y, 0.6 * x - 0.2 * y]);
        let trial: Vec<_> =
            converged.iter().zip(&more).map(|(c, m)| [c[0] + size * m[0], c[1] + size * m[1]]).collect();
        check(&format!("{} on {kind:?}", scheme.name()), &stand, &trial, &converged);
    }
}

/// But for the strain of the step, which turns the axes of the elastic one.
fn the_tangent_of_a_held_geometry_is_the_derivative<K: Kinematics<2>>() {
    for_all_held::<K>(1e-5, |name, stand, trial, converged| {
        let error = stand.tangent_error(trial, converged);
        assert!(error < 1e-6, "{name}: {error:.1e}");
    });
}

#[test]
fn the_tangent_of_a_held_geometry_is_the_derivative_in_plane_strain() {
    the_tangent_of_a_held_geometry_is_the_derivative::<PlaneStrain>();
}

#[test]
fn the_tangent_of_a_held_geometry_is_the_derivative_in_axisymmetry() {
    the_tangent_of_a_held_geometry_is_the_derivative::<Axisymmetric>();
}

/// Displacements are small on a geometry that is held: what would turn it by any angle strains nothing, and the force stays as it is.
#[test]
fn a_turn_on_a_held_geometry_changes_no_force() {
    for_all_held::<PlaneStrain>(0.0, |name, stand, _, converged| {
        let places =
            stand.scene.mesh.nodes.iter().zip(&stand.state.search_geometry).map(|(x, u)| [x[0] + u[0], x[1] + u[1]]);
        let turned: Vec<_> = places.zip(converged).map(|(x, c)| [c[0] - 0.7 * x[1], c[1] + 0.7 * x[0]]).collect();
        let [before, after] = [converged, &turned[..]].map(|trial| stand.evaluate(trial, converged, 0, false).0);
        let change: Vec<_> = before.iter().zip(&after).map(|(a, b)| [a[0] - b[0], a[1] - b[1]]).collect();
        assert!(size(&change) < 1e-9 * size(&before), "{name}: {:.1e} of {:.1e}", size(&change), size(&before));
    });
}
