//! The seabed slope through the program, on coarse meshes: it runs out and comes to rest, keeps its mass, and
//! its momentum and energy balance; whether it stands or fails is what limit equilibrium says.

use crate::support::{project, python, solve, succeeds};
use mpm::io::frame::{self, Frame};
use mpm::io::points_vtu;
use std::fs;
use std::path::PathBuf;
use tempfile::TempDir;

/// Density of the clay (t/m³) and its strength (kPa) by height (m), as in the case.
const DENSITY: f64 = 1.65;
fn strength(y: f64) -> f64 {
    1.5 + 0.3 * (5.0 - y)
}

/// A step as the log has it.
#[derive(Clone, Copy, Debug, Default)]
struct Step {
    time: f64,
    dt: f64,
    mass: f64,
    elastic: f64,
    potential: f64,
    kinetic: f64,
    momentum: [f64; 2],
    imbalance: [f64; 2],
}

impl Step {
    fn energy(&self) -> f64 {
        self.elastic + self.potential + self.kinetic
    }
}

struct Run {
    folder: TempDir,
    steps: Vec<Step>,
    frames: Vec<PathBuf>,
}

impl Run {
    /// Solves the case on cells of 1 m.
    fn new(settings: &[&str]) -> Self {
        let folder = solve("cases/seabed_slope", &[&["mesh.parameters.h=1"], settings].concat());
        let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
        let steps = log.lines().filter(|l| l.starts_with("step ")).map(step).collect();
        let frames = frame::list(&folder.path().join("results")).unwrap().into_iter().map(|f| f.path).collect();
        Self { folder, steps, frames }
    }

    fn last(&self) -> Step {
        *self.steps.last().unwrap()
    }

    fn frame(&self, number: usize) -> Frame {
        Frame::read(&self.frames[number]).unwrap()
    }

    /// Σ V₀ √3 s_u ε_p (kJ): the work of plastic flow in plane strain, with ε_p = γ_p/√3 and s_u from the first
    /// height of the point, as the strength goes with the soil.
    fn plastic_work(&self) -> f64 {
        let seeds = points_vtu::read::<2>(&self.folder.path().join("points.vtu")).unwrap().points;
        let last = self.frame(self.frames.len() - 1);
        let strain = &last.points.columns.iter().find(|c| c.name == "plastic_strain").unwrap().values;
        let work = |((m, x), e): ((&f64, &[f64; 2]), &f64)| m / DENSITY * 3f64.sqrt() * strength(x[1]) * e;
        seeds.mass.iter().zip(&seeds.origin).zip(strain).map(work).sum()
    }
}

fn step(line: &str) -> Step {
    let words: Vec<&str> = line.split_whitespace().collect();
    let after = |name: &str, offset: usize| -> f64 {
        let at = words.iter().position(|w| *w == name).unwrap_or_else(|| panic!("no {name} in {line}"));
        words[at + offset].parse().unwrap()
    };
    Step {
        time: after("t", 1),
        dt: after("dt", 1),
        mass: after("mass", 1),
        elastic: after("elastic", 1),
        potential: after("potential", 1),
        kinetic: after("kinetic", 1),
        momentum: [after("momentum", 1), after("momentum", 2)],
        imbalance: [after("imbalance", 1), after("imbalance", 2)],
    }
}

/// The largest distance of a point between two frames (m).
fn largest_move(a: &Frame, b: &Frame) -> f64 {
    let distance = |(a, b): (&[f64; 3], &[f64; 3])| (a[0] - b[0]).hypot(a[1] - b[1]);
    a.points.position.iter().zip(&b.points.position).map(distance).fold(0.0, f64::max)
}

/// Gravity grows over the first second.
fn gravity_factor(time: f64) -> f64 {
    time.min(1.0)
}

#[test]
fn momentum_balances_to_the_tolerance_without_damping() {
    let run = Run::new(&["numerics.spectral_radius=1", "phases.fail.duration=2"]);
    let largest = run.steps.iter().flat_map(|s| s.imbalance).map(f64::abs).fold(0.0, f64::max);
    println!("largest imbalance {largest:.1e} of a momentum of {:.1} t m/s", run.last().momentum[0]);
    assert!(largest < 1e-6 * run.last().momentum[0]);
}

fn limit_equilibrium(arguments: &[&str]) -> String {
    let output = python().arg(project("cases/seabed_slope/limit_equilibrium.py")).args(arguments).output().unwrap();
    succeeds(&output);
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn limit_equilibrium_has_published_stability_numbers() {
    let text = limit_equilibrium(&["--check"]);
    assert_eq!(text.matches("published").count(), 5, "{text}");
    assert_eq!(text.matches("closed form").count(), 4, "{text}");
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    #[test]
    fn runs_out_by_metres_and_comes_to_rest() {
        let run = Run::new(&["phases.fail.duration=12"]);
        let last = run.last();

        // Mass: that of the drawing, in every step.
        let mass = DENSITY * (20.0 * 6.0 + 5.0 * 1.0 + 12.5 + 15.0 * 1.0);
        assert!(run.steps.iter().all(|s| (s.mass / mass - 1.0).abs() < 1e-12), "mass {} of {mass} t", last.mass);

        // Run-out: several metres, and the back wall and the end of the plain have no part in it.
        let (first, end) = (run.frame(0), run.frame(run.frames.len() - 1));
        let run_out = largest_move(&first, &end);
        let front = end.points.position.iter().filter(|x| x[1] > 0.1).map(|x| x[0]).fold(f64::MIN, f64::max);
        println!("run-out {run_out:.2} m, front at x = {front:.2} m, {} steps", run.steps.len());
        assert!((5.0..9.0).contains(&run_out) && (8.0..12.0).contains(&front));
        for (x, y) in first.points.position.iter().zip(&end.points.position) {
            let beside = x[0] < -24.0 || x[0] > 14.0;
            assert!(!beside || (x[0] - y[0]).hypot(x[1] - y[1]) < 0.15, "{x:?} moved to {y:?}");
        }

        // Rest: nothing moves on, what is left is elastic vibration and noise of the velocities.
        let peak = run.steps.iter().map(|s| s.kinetic).fold(0.0, f64::max);
        let before = run.frame(run.frames.iter().position(|f| Frame::read(f).unwrap().time >= 10.0).unwrap());
        let moved = largest_move(&before, &end);
        println!("kinetic energy {:.2e} of {peak:.1} kJ, moved {moved:.4} m in the last 2 s", last.kinetic);
        for s in run.steps.iter().filter(|s| s.time > 10.0) {
            assert!(s.kinetic < 2e-3 * peak && s.momentum[0].hypot(s.momentum[1]) < 0.01 * mass, "{s:?}");
        }
        assert!(moved < 0.02);

        // Momentum: the imbalances add up to no more than a fraction of a step's impulse, see the README.
        let largest = run.steps.iter().map(|s| s.momentum[0].abs()).fold(0.0, f64::max);
        for d in 0..2 {
            let mut sum = 0.0f64;
            for s in &run.steps {
                sum += s.imbalance[d];
                assert!(sum.abs() < 0.01 * largest, "component {d}: {sum} at {} s", s.time);
            }
        }

        // Energy: the work of gravity is the plastic work, but for what is still there and what damping took.
        let mut work = 0.0;
        let mut before = Step { potential: run.steps[0].potential, ..Step::default() };
        for s in &run.steps {
            work += gravity_factor(s.time - 0.5 * s.dt) * (before.potential - s.potential);
            assert!(
                s.time - s.dt < 1.0 || s.energy() < before.energy() + 1e-3 * peak,
                "energy is made at {} s",
                s.time
            );
            before = *s;
        }
        let found = run.plastic_work() + last.kinetic + last.elastic;
        println!("work of gravity {work:.2} kJ, plastic work, kinetic and elastic energy {found:.2} kJ");
        assert!((found / work - 1.0).abs() < 0.005);
    }

    /// Strengths scaled to a factor of safety of 1.1 stand, to 0.9 they fail.
    #[test]
    fn stands_and_fails_as_limit_equilibrium_says() {
        let text = limit_equilibrium(&[]);
        let safety: f64 = text.lines().next().unwrap().rsplit(' ').next().unwrap().parse().unwrap();
        let moved = [0.9, 1.1].map(|wanted| {
            let scale = wanted / safety;
            let clay = format!(
                "materials.clay.shear_strength={{top: {}, gradient: {}, datum: 5}}",
                scale * strength(5.0),
                scale * (strength(4.0) - strength(5.0))
            );
            let run = Run::new(&[&clay, "mesh.parameters.crest=10", "phases.fail.duration=6"]);
            largest_move(&run.frame(0), &run.frame(run.frames.len() - 1))
        });
        println!("factor of safety of the case {safety}; moved {moved:?} m at 0.9 and 1.1");
        // Ten and one per cent of the height.
        assert!(moved[0] > 0.5 && moved[1] < 0.05);
    }
}
