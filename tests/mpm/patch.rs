//! The linear patch test: boundary displacements of a uniform strain give that strain everywhere.

use crate::support::bench::{Bench, constant, quadrature_points, run};
use mpm::interpolation::{Basis, Mpm};
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::material::{Elasticity, LinearElastic};
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use mpm::step::{Fixed, Prescribed, Restore};
use mpm::time_value::TimeValue;
use std::sync::Arc;

/// Prescribes on the whole boundary, in a duration of one, the displacement (m) with a uniform gradient.
pub fn stretch_boundary(bench: &mut Bench, gradient: [[f64; 2]; 2]) {
    let mut boundary: Vec<u32> = bench.mesh.groups.iter().flat_map(|g| g.nodes.clone()).collect();
    boundary.sort_unstable();
    boundary.dedup();
    for n in boundary {
        let x = bench.mesh.nodes[n as usize];
        for component in 0..2 {
            let u = gradient[component][0] * x[0] + gradient[component][1] * x[1];
            let fixed = Fixed { nodes: vec![n], component };
            bench.prescribed.push(Prescribed { fixed, displacement: TimeValue::Rate(u) });
        }
    }
}

/// Stretches a jittered mesh by a linear displacement field and returns the largest error of the
/// deformation gradients.
pub fn error<K: Kinematics<2>>(
    scheme: &'static dyn Basis<2>,
    kind: CellKind,
    gradient: [[f64; 2]; 2],
    restore: bool,
    degree: usize,
) -> f64 {
    let mut mesh = rectangle(kind, 2.0, 1.5, 4, 3, 0.2, 7);
    if !K::HOOP {
        // Away from the origin nothing changes in plane strain; in axisymmetry the field must keep u_r ∝ r.
        for x in &mut mesh.nodes {
            x[0] += 3.0;
        }
    }
    let elasticity = Elasticity::new(constant(1000.0), 0.3).unwrap();
    let mut bench = Bench::new(mesh, Arc::new(LinearElastic::new(elasticity)));
    bench.restore = if restore { Restore::EveryStep } else { Restore::Never };
    bench.scheme = scheme;
    bench.steps = if restore { 1 } else { 2 };
    stretch_boundary(&mut bench, gradient);
    let points = quadrature_points::<K>(&bench.mesh, degree, 1.0);
    let hoop = if K::HOOP { gradient[0][0] } else { 0.0 };
    let scene = bench.scene::<K>();
    let state = run::<K>(&scene, points, |_, report| assert!(report.iterations() <= 8));
    let mut error = 0f64;
    for f in &state.points.deformation {
        for i in 0..2 {
            for j in 0..2 {
                let exact = f64::from(u8::from(i == j)) + gradient[i][j];
                error = error.max((f[(i, j)] - exact).abs());
            }
        }
        error = error.max((f[(2, 2)] - 1.0 - hoop).abs());
    }
    error
}

const KINDS: [CellKind; 5] = [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q8, CellKind::Q9];

#[test]
fn plane_strain_small_and_large() {
    for kind in KINDS {
        for gradient in [[[1e-3, 2e-3], [-1e-3, 3e-3]], [[0.2, 0.3], [-0.1, 0.15]]] {
            let e = error::<PlaneStrain>(&Mpm, kind, gradient, false, 4);
            assert!(e < 1e-10, "{kind:?}: {e:e}");
        }
    }
}

#[test]
fn axisymmetry() {
    for kind in KINDS {
        // A uniform strain in axisymmetry has no shear that depends on r.
        let e = error::<Axisymmetric>(&Mpm, kind, [[0.1, 0.0], [0.0, -0.15]], false, 4);
        assert!(e < 1e-10, "{kind:?}: {e:e}");
    }
}

/// The first step on a grid that is restored: its points are still a quadrature of their cells, so that a
/// uniform strain is exact there too. Once they have moved it is not, which is the plain method's error.
#[test]
fn in_the_first_step_of_a_restored_grid() {
    for kind in KINDS {
        for gradient in [[[1e-3, 2e-3], [-1e-3, 3e-3]], [[-0.2, 0.1], [0.05, -0.15]]] {
            let e = error::<PlaneStrain>(&Mpm, kind, gradient, true, 4);
            assert!(e < 1e-10, "{kind:?}: {e:e}");
        }
        let e = error::<Axisymmetric>(&Mpm, kind, [[-0.1, 0.0], [0.0, -0.15]], true, 4);
        assert!(e < 1e-10, "{kind:?}: {e:e}");
    }
}
