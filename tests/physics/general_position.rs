//! Limit loads with points that owe nothing to the cells they lie in, and with soil that ends within them.
//!
//! Half of a rigid footing of width B = 1 m on soil so stiff (G = 10⁴ s_u) that the closed forms of small strain hold;
//! ν = 0.4999 with the pressure field; the grid restored in every step. Points in general position: those that
//! an unrelated mesh is seeded with, shifted by (0.37, 0.21) h; a randomised lattice; those of an unrelated mesh after a
//! shear of 2. With the points' volumes as weights the limit load is 15–20 % low there.

use crate::bench::{Bench, constant, run};
use crate::layout::{Random, at, describe, fit, lattice, seeded, straighten};
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::material::{Elasticity, Model, Profile, Tresca};
use mpm::mesh::Mesh;
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use mpm::points::Points;
use mpm::step::{Fixed, Prescribed, Restore, Scene};
use mpm::stencil::cell_size;
use mpm::term::{Carried, Internal, PressureField, SmoothPressure};
use mpm::time_value::TimeValue;
use std::f64::consts::{PI, TAU};
use std::sync::Arc;
use std::time::Instant;

const WIDTH: f64 = 2.5;
const DEPTH: f64 = 1.5;
const POISSON: f64 = 0.4999;
const SHEAR: f64 = 1e4;

#[derive(Clone, Copy, Debug, PartialEq)]
enum Layout {
    /// 16 points to each cell of the grid itself.
    Regular,
    Shifted,
    Lattice,
    Sheared,
}

#[derive(Clone, Copy, Debug)]
struct Footing {
    /// Cells over the width B.
    cells: usize,
    rough: bool,
    layout: Layout,
    fitted: bool,
    steps: usize,
    /// Strength (kPa/m) gained with depth; 1 kPa at the surface.
    gain: f64,
    /// The surface beside the footing runs through the cells.
    cut: bool,
    of_points: f64,
    restored: bool,
    /// The cells shrink towards the edge of the footing and the surface, to a half and less.
    graded: bool,
    seed: u64,
}

const STRIP: Footing = Footing {
    cells: 8,
    rough: true,
    layout: Layout::Regular,
    fitted: true,
    steps: 10,
    gain: 0.0,
    cut: false,
    of_points: 0.3,
    restored: false,
    graded: false,
    seed: 1,
};

/// Bulk modulus over shear modulus.
fn bulk(poisson: f64) -> f64 {
    2.0 * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson))
}

/// Where a place of the uniform section goes in the graded one, and what becomes of an area there.
fn grade(x: [f64; 2]) -> ([f64; 2], f64) {
    let (power, half) = (1.6, 0.5);
    let towards = |s: f64, p: f64| (s.abs().powf(p) * s.signum(), p * s.abs().powf(p - 1.0));
    let (a, da) = if x[0] < half {
        let (f, df) = towards((half - x[0]) / half, power);
        (half - half * f, df)
    } else {
        let length = WIDTH - half;
        let (f, df) = towards((x[0] - half) / length, power);
        (half + length * f, df)
    };
    let (f, df) = towards((DEPTH - x[1]) / DEPTH, power);
    ([a, DEPTH - DEPTH * f], da * df)
}

impl Footing {
    fn mesh(&self) -> Mesh<2> {
        let h = 1.0 / self.cells as f64;
        let (nx, ny) = ((WIDTH / h).round() as usize, (DEPTH / h).round() as usize);
        if !self.restored {
            let mut mesh = rectangle(CellKind::T6, WIDTH, DEPTH, nx, ny, 0.2, self.seed);
            if self.graded {
                mesh.nodes.iter_mut().for_each(|x| *x = grade(*x).0);
                straighten(&mut mesh);
            }
            return mesh;
        }
        let mut mesh = rectangle(CellKind::T6, WIDTH, DEPTH + 2.0 * h, nx, ny + 2, 0.2, self.seed);
        let mut random = Random(self.seed + 7);
        for i in 0..=nx {
            let node = &mut mesh.nodes[ny * (nx + 1) + i];
            let x = i as f64 * h;
            if x < 0.5 + 1e-9 || !self.cut {
                *node = [x, DEPTH];
            } else {
                node[1] = DEPTH + 0.4 * h * random.next();
            }
        }
        straighten(&mut mesh);
        mesh
    }

    fn points<K: Kinematics<2>>(&self, mesh: &Mesh<2>) -> Points<2> {
        let h = 1.0 / self.cells as f64;
        let unrelated = |margin: f64| {
            let (lx, ly) = (WIDTH + 2.0 * margin, DEPTH + 4.0 * h);
            let mut other = rectangle(
                CellKind::T6,
                lx,
                ly,
                (lx / h).round() as usize,
                (ly / h).round() as usize,
                0.2,
                50 + self.seed,
            );
            other.nodes.iter_mut().for_each(|x| *x = [x[0] - margin, x[1] - 2.0 * h]);
            seeded(&other, 16)
        };
        if self.layout == Layout::Regular {
            let mut points = at::<K>(mesh, &seeded(mesh, 16), 1.0);
            points.pressure = vec![0.0; points.len()];
            return points;
        }
        let mut places = match self.layout {
            Layout::Regular => Vec::new(),
            Layout::Shifted => unrelated(2.0 * h).iter().map(|(x, a)| ([x[0] + 0.37 * h, x[1] + 0.21 * h], *a)).collect(),
            Layout::Lattice => lattice(WIDTH, DEPTH, h / 32f64.sqrt(), &mut Random(100 + self.seed)),
            Layout::Sheared => unrelated(DEPTH * 1.25)
                .iter()
                .map(|(x, a)| ([x[0] + 2.0 * (x[1] - 0.5 * DEPTH) + 0.37 * h, x[1] + 0.21 * h], *a))
                .collect(),
        };
        places.retain(|(x, _)| x[0] > 1e-9 && x[0] < WIDTH - 1e-9 && x[1] > 1e-9 && x[1] < DEPTH - 1e-9);
        if self.graded {
            for (x, area) in &mut places {
                let (to, ratio) = grade(*x);
                (*x, *area) = (to, *area * ratio);
            }
        }
        let mut points = at::<K>(mesh, &places, 1.0);
        points.pressure = vec![0.0; points.len()];
        points
    }

    /// Mean pressure under the footing over the strength at the surface, after each step.
    fn push<K: Kinematics<2> + 'static>(&self) -> Vec<f64> {
        let begin = Instant::now();
        let strength = Profile { top: 1.0, gradient: self.gain, datum: DEPTH };
        let model = |poisson: f64| -> Arc<dyn Model> {
            let young = Elasticity::new(constant(2.0 * (1.0 + poisson) * SHEAR), poisson).unwrap();
            Arc::new(Tresca::new(young, strength).unwrap())
        };
        let mut bench = Bench::new(self.mesh(), model(self.of_points));
        bench.restore = if self.restored { Restore::EveryStep } else { Restore::Never };
        bench.steps = self.steps;
        if self.fitted {
            fit::<K>(&mut bench);
        }
        bench.hold("left", &[0]).hold("right", &[0]).hold("bottom", &[0, 1]);
        let under = |x: &[f64; 2]| (x[1] - DEPTH).abs() < 1e-9 && x[0] < 0.5 + 1e-9;
        let nodes: Vec<u32> = (0u32..).zip(&bench.mesh.nodes).filter(|(_, x)| under(x)).map(|(n, _)| n).collect();
        if self.rough {
            bench.supports.push(Fixed { nodes: nodes.clone(), component: 0 });
        }
        let settlement = 6.0 / SHEAR * (1.0 + 0.25 * self.gain);
        let fixed = Fixed { nodes: nodes.clone(), component: 1 };
        bench.prescribed = vec![Prescribed { fixed, displacement: TimeValue::Rate(-settlement) }];
        let points = self.points::<K>(&bench.mesh);
        let mut scene = bench.scene::<K>();
        with_pressure::<K>(&mut scene, model(self.of_points), self.of_points);
        scene.numerics.tolerance = 1e-6;
        scene.numerics.max_iterations = 40;
        let area = if K::HOOP { PI * 0.25 } else { 0.5 };
        let (mut loads, mut iterations, mut halvings, mut told) = (Vec::new(), 0, 0, String::new());
        run::<K>(&scene, points, |state, report| {
            loads.push(-nodes.iter().map(|&n| report.reaction[n as usize][1]).sum::<f64>() / area);
            iterations += report.iterations();
            halvings += report.halvings.len();
            if loads.len() == 1 {
                told = describe(&state.weighing.tally, state.weighing.lost_front.as_ref());
            }
        });
        println!(
            "{self:?}\n    N = {:.4} (before {:.4}), {iterations} iterations, {halvings} halvings, {:.1} s; {told}",
            loads[loads.len() - 1],
            loads[loads.len() - 2],
            begin.elapsed().as_secs_f64()
        );
        loads
    }

    fn strip(&self) -> f64 {
        *self.push::<PlaneStrain>().last().unwrap()
    }
}

/// Lets the pressure field carry what is beyond ν = 0.3, as a case does.
fn with_pressure<K: Kinematics<2> + 'static>(scene: &mut Scene<2>, model: Arc<dyn Model>, of_points: f64) {
    let cells = scene.mesh.cells.len();
    let size = (0..cells).map(|c| cell_size(&scene.mesh, c)).sum::<f64>() / cells as f64;
    let unit = SHEAR / size;
    let carried = Carried { model: model.clone(), ratio: bulk(POISSON) - bulk(of_points), total: true };
    let field = PressureField::<K>::new(vec![Some(carried)], unit);
    scene.terms[0] = Box::new(Internal::<K, _>::sharing(vec![Some(model)], false, field));
    scene.terms.push(Box::new(SmoothPressure::<K>::new(unit, SHEAR, cells)));
    scene.pressure_unit = Some(unit);
}

const PRANDTL: f64 = 2.0 + PI;

#[test]
fn explore_regular() {
    for of_points in [0.3, -0.9999, -0.999999] {
        Footing { of_points, ..STRIP }.strip();
        Footing { of_points, restored: true, ..STRIP }.strip();
        Footing { of_points, cells: 10, ..STRIP }.strip();
    }
    for rough in [true, false] {
        Footing { cells: 16, rough, of_points: -0.9999, ..STRIP }.strip();
    }
}

#[test]
fn explore_graded() {
    for of_points in [-0.9999, 0.3] {
        for layout in [Layout::Regular, Layout::Shifted] {
            for (cells, rough) in [(8, true), (8, false)] {
                Footing { layout, of_points, cells, rough, graded: true, ..STRIP }.strip();
            }
        }
    }
    for rough in [true, false] {
        Footing { of_points: -0.9999, cells: 16, rough, graded: true, ..STRIP }.strip();
    }
}

#[test]
fn explore_general() {
    for of_points in [0.3, -0.9999] {
        for layout in [Layout::Regular, Layout::Shifted, Layout::Lattice, Layout::Sheared] {
            for restored in [false, true] {
                Footing { layout, of_points, restored, ..STRIP }.strip();
            }
        }
    }
    let _ = TAU;
}

#[test]
fn explore_volumes() {
    for layout in [Layout::Shifted, Layout::Lattice, Layout::Sheared] {
        Footing { layout, fitted: false, of_points: -0.9999, ..STRIP }.strip();
    }
}

#[test]
fn explore_cut() {
    for layout in [Layout::Shifted, Layout::Lattice] {
        for steps in [10, 40] {
            Footing { layout, steps, of_points: -0.9999, restored: true, cut: true, ..STRIP }.strip();
        }
    }
}

#[test]
fn explore_circle() {
    for cells in [8, 16] {
        for layout in [Layout::Regular, Layout::Shifted] {
            Footing { layout, cells, rough: false, of_points: -0.9999, ..STRIP }.push::<Axisymmetric>();
        }
    }
}

#[test]
fn explore_gain() {
    for cells in [8, 16] {
        for layout in [Layout::Regular, Layout::Shifted] {
            let n = Footing { layout, cells, rough: false, gain: 1.0, of_points: -0.9999, ..STRIP }.strip();
            println!("F = {:.4}", n / (PRANDTL + 0.25));
        }
    }
}
