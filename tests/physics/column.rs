//! The self-weight column (VERIFICATION: large-strain closed form with Lambert's W).
//!
//! Confined sides, ν = 0, Hencky elasticity: the stress at original depth Z is −ρ₀ g Z whatever the
//! stiffness, and the settlement follows from the stretch W(q)/q.

use crate::bench::{Bench, constant, quadrature_points, run};
use mpm::kinematics::PlaneStrain;
use mpm::material::{Elasticity, LinearElastic};
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use mpm::time_value::TimeValue;
use std::sync::Arc;

const HEIGHT: f64 = 10.0;
const GRAVITY: f64 = 10.0;

/// Mean stress error relative to ρ g H, and the error of the mean displacement of the points relative to the
/// settlement of the top.
fn column(kind: CellKind, cells: usize, r: f64, steps: usize, restore: bool) -> (f64, f64) {
    let (young, density) = (100.0, r * 100.0 / (GRAVITY * HEIGHT));
    let mesh = rectangle(kind, HEIGHT / cells as f64, HEIGHT, 1, cells, 0.0, 1);
    let elasticity = Elasticity::new(constant(young), 0.0).unwrap();
    let mut bench = Bench::new(mesh, Arc::new(LinearElastic::new(elasticity)));
    bench.density = density;
    bench.gravity = [0.0, -GRAVITY];
    bench.gravity_factor = TimeValue::Rate(1.0);
    bench.restore_every_step = restore;
    bench.steps = steps;
    bench.hold("left", &[0]).hold("right", &[0]).hold("bottom", &[1]);
    let points = quadrature_points::<PlaneStrain>(&bench.mesh, 3, density);
    let scene = bench.scene::<PlaneStrain>();
    let state = run::<PlaneStrain>(&scene, points, |_, _| {});
    let exact = Exact { r };
    let p = &state.points;
    let volume: f64 = p.initial_volume.iter().sum();
    let (mut stress, mut displacement) = (0.0, 0.0);
    for i in 0..p.len() {
        let depth = HEIGHT - p.origin[i][1];
        stress += p.initial_volume[i] * (p.stress[i][1] - exact.stress(depth, density)).abs();
        displacement += p.initial_volume[i] * (p.position[i][1] - p.origin[i][1] - exact.displacement(depth)).abs();
    }
    (stress / (volume * density * GRAVITY * HEIGHT), displacement / (volume * -exact.displacement(0.0)))
}

#[test]
fn print() {
    for r in [0.01, 0.1, 1.0] {
        for cells in [4, 8, 16, 32] {
            let (s, d) = column(CellKind::T6, cells, r, 4, false);
            println!("r {r} cells {cells} stress {s:.3e} disp {d:.3e}");
        }
    }
    for cells in [8, 16, 32] {
        let (s, d) = column(CellKind::T6, cells, 0.5, 40, true);
        println!("restored cells {cells} stress {s:.3e} disp {d:.3e}");
    }
}

struct Exact {
    r: f64,
}
impl Exact {
    fn w(q: f64) -> f64 {
        let mut w = q.ln_1p();
        for _ in 0..50 {
            w -= (w * w.exp() - q) / (w.exp() * (1.0 + w));
        }
        w
    }
    fn stress(&self, z: f64, rho: f64) -> f64 {
        -rho * GRAVITY * z
    }
    fn below(&self, z: f64) -> f64 {
        let w = Self::w(self.r * z / HEIGHT);
        HEIGHT / self.r * (0.5 * w * w + w)
    }
    fn displacement(&self, z: f64) -> f64 {
        self.below(HEIGHT) - self.below(z) - (HEIGHT - z)
    }
}
