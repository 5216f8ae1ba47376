//! A column of clay that swells along a line, consolidated under its own weight: at rest it stays as it is, and what comes on it settles and
//! unloads as the law of one dimension says, integrated depth by depth with the model alone.

use crate::support::{column, errors, mpm, written};
use mpm::io::frame::{self, Frame};
use mpm::material::{MODELS, Model, Parameters, Profile, State};
use std::fs;
use std::path::Path;
use std::sync::Arc;
use tempfile::TempDir;

const HEIGHT: f64 = 5.0;
const WEIGHT: f64 = 8.0;
const K0: f64 = 0.6;
/// Steps of a phase.
const STEPS: usize = 20;
const NUMBERS: &str = "swelling: 0.02, compression: 0.1, poisson: 0.3, critical_slope: 1";
/// Normally consolidated, p (1 + η²/M²) at K₀, but for a crust of 10 kPa: at the surface there is no stress.
const CRUST: f64 = 10.0;

fn growth() -> f64 {
    let (p, eta) = (WEIGHT * (1.0 + 2.0 * K0) / 3.0, 3.0 * (1.0 - K0) / (1.0 + 2.0 * K0));
    p * (1.0 + eta * eta)
}

/// Runs the column to its end, of a clay with `more` entries, which the other clay has, too.
fn run(kind: &str, restore: &str, more: &str, phases: &str) -> TempDir {
    let text = format!(
        "geometry: plane_strain\n\
         mesh: {{geo: GEO/slump.geo, parameters: {{half_width: 0.5, height: {HEIGHT}, room: 0, h: 0.25}}}}\n\
         regions: {{block: {{kind: {kind}, material: clay}}}}\n\
         materials:\n\
         \x20 clay: {{model: cam_clay, {NUMBERS}, unit_weight: {WEIGHT}{more}, \
           preconsolidation: {{top: {CRUST}, gradient: {}, datum: {HEIGHT}}}}}\n\
         \x20 other: {{model: cam_clay, swelling: 0.05, compression: 0.12, poisson: 0.2, critical_slope: 1.2, \
           preconsolidation: 100, unit_weight: {WEIGHT}{more}}}\n\
         supports: {{bottom: {{uy: 0}}, axis: {{ux: 0}}, face: {{ux: 0}}}}\n\
         gravity: {{y: -10}}\n\
         initial_stress: {{k0: {K0}}}\n\
         numerics: {{restore: {restore}, tolerance: 1.0e-9}}\n\
         phases:\n- {{name: rest, analysis: quasi_static, duration: 1, step: {{initial: 1}}}}\n{phases}\
         output: {{every: 1, fields: [stress, displacement{}], history: [{{name: top, on: top, quantities: [uy]}}]}}\n",
        growth(),
        if more.is_empty() { "" } else { ", pore_pressure" },
    );
    let folder = written(&text);
    for stage in ["mesh", "seed", "solve"] {
        let output = mpm(stage, folder.path(), folder.path(), &[]);
        let said = errors(&output);
        assert!(output.status.success() && !said.contains("more than `clay` bears"), "{said}");
    }
    folder
}

fn clay() -> Arc<dyn Model> {
    let kind = MODELS.iter().find(|kind| kind.name == "cam_clay").unwrap();
    let mut parameters = Parameters::default();
    for entry in NUMBERS.split(", ") {
        let (name, value) = entry.split_once(": ").unwrap();
        parameters.set(name, Profile::constant(value.parse().unwrap()));
    }
    parameters.set("preconsolidation", Profile::growing(CRUST, growth(), HEIGHT));
    (kind.build)(&parameters).unwrap()
}

/// The Hencky strain and the stresses (kPa, Cauchy) across and along the column at a depth (m), after each of the vertical stresses `path` (kPa,
/// Cauchy): along the vertical the volume changes alone, so that `σ = τ e^(−ε)`.
fn confined(model: &dyn Model, depth: f64, path: impl Iterator<Item = f64>) -> Vec<[f64; 3]> {
    let y = HEIGHT - depth;
    let mut elastic = model.elastic_strain(y, &[-K0 * WEIGHT * depth, -WEIGHT * depth, -K0 * WEIGHT * depth]);
    let (mut strain, mut before) = (0.0, [0.0]);
    let step = |stress: f64| {
        let respond = |by: f64| {
            let mut internal = before;
            let trial = [elastic[0], elastic[1] + by, elastic[2]];
            (model.respond(y, &trial, &State::default(), &mut internal), internal)
        };
        let (mut low, mut high) = (-0.2, 0.2);
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            let above = respond(middle).0.stress[1] * (-(strain + middle)).exp() > stress;
            (low, high) = if above { (low, middle) } else { (middle, high) };
        }
        let (response, internal) = respond(low);
        (strain, elastic, before) = (strain + low, response.elastic_strain, internal);
        let cauchy = response.stress.map(|t| t * (-strain).exp());
        [strain, cauchy[0], cauchy[1]]
    };
    path.map(step).collect()
}

/// The settlement (m) of the column after each step, `stress` being the vertical one at a depth after a step.
fn settlement(model: &dyn Model, steps: usize, stress: impl Fn(f64, usize) -> f64) -> Vec<f64> {
    const SLICES: usize = 400;
    let mut sum = vec![0.0; steps];
    for slice in 0..SLICES {
        let depth = HEIGHT * (slice as f64 + 0.5) / SLICES as f64;
        let strains = confined(model, depth, (1..=steps).map(|n| stress(depth, n)));
        for (sum, [strain, ..]) in sum.iter_mut().zip(strains) {
            *sum += (1.0 - strain.exp()) * HEIGHT / SLICES as f64;
        }
    }
    sum
}

fn worst(errors: &[f64]) -> f64 {
    errors.iter().fold(0.0, |most, e| most.max(e.abs()))
}

/// Stress at the points when the load is on: as it was at their depth at first.
fn stresses(folder: &Path, model: &dyn Model, stress: impl Fn(f64, usize) -> f64) {
    let frames = frame::list(&folder.join("results")).unwrap();
    let info = frames.iter().find(|info| (info.time - 2.0).abs() < 1e-9).unwrap();
    let points = Frame::read(&info.path).unwrap().points;
    let values = |name: &str| &points.columns.iter().find(|c| c.name == name).unwrap().values;
    let (mut across, mut along, mut count) = (0.0, 0.0, 0.0);
    for ((x, u), s) in
        points.position.iter().zip(values("displacement").chunks_exact(3)).zip(values("stress").chunks_exact(6))
    {
        let depth = HEIGHT - (x[1] - u[1]);
        let path = confined(model, depth, (1..=STEPS).map(|n| stress(depth, n)));
        let [_, horizontal, vertical] = path[STEPS - 1];
        across += (s[0] - horizontal).abs();
        along += (s[1] - vertical).abs();
        count += 1.0;
    }
    let (across, along) = (across / count, along / count);
    println!("stress: across {across:.1e}, along {along:.1e} kPa");
    assert!(across < 0.02 && along < 0.02);
}

/// On a grid that is restored in every step the weight grows to three times what it was.
#[test]
fn a_restored_grid_settles_under_more_weight() {
    let phases = format!(
        "- {{name: load, analysis: quasi_static, duration: 1, step: {{initial: {}}}, gravity: {{table: [[0, 1], [1, 3]]}}}}\n",
        1.0 / STEPS as f64
    );
    let model = clay();
    let exact = settlement(&*model, STEPS, |depth, n| -WEIGHT * depth * (1.0 + 2.0 * n as f64 / STEPS as f64));
    let folder = run("mpm", "every_step", "", &phases);
    let uy = column(folder.path(), "top.uy [m]");
    let errors: Vec<f64> = uy[1..].iter().zip(&exact).map(|(u, s)| -u / s - 1.0).collect();
    println!("at rest {:.1e} m, loaded {:.5} m, worst {:.1e}", uy[0], uy[STEPS], worst(&errors));
    assert!(uy[0].abs() < 1e-4 * exact[STEPS - 1], "{}", uy[0]);
    assert!(worst(&errors) < 5e-3, "{errors:?}");
}

/// Another clay takes the stress over as its own law has it, with water in the pores too; the water then bears what comes.
#[test]
fn another_clay_takes_the_stress_over() {
    let load = 20.0;
    let phases = format!(
        "- {{name: change, analysis: quasi_static, duration: 1, step: {{initial: 1}}, materials: {{block: other}}}}\n\
         - {{name: load, analysis: quasi_static, duration: 1, step: {{initial: 0.2}}, tractions: [{{on: top, ty: {{rate: -{load}}}}}]}}\n",
    );
    for more in ["", ", drainage: undrained", ", drainage: undrained, permeability: 1.0e-9"] {
        let folder = run("mpm", "never", more, &phases);
        let uy = column(folder.path(), "top.uy [m]");
        let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
        assert!(log.contains("is of `other` from here on; Poisson's ratio of"), "{log}");
        assert!(uy[..2].iter().all(|u| u.abs() < 1e-10), "{more}: {uy:?}");
        let frames = frame::list(&folder.path().join("results")).unwrap();
        let mean_excess = |time: f64| {
            let info = frames.iter().find(|info| (info.time - time).abs() < 1e-9).unwrap();
            let points = Frame::read(&info.path).unwrap().points;
            let values = &points.columns.iter().find(|c| c.name == "pore_pressure").unwrap().values;
            values.iter().sum::<f64>() / values.len() as f64
        };
        if !more.is_empty() {
            let excess = [1.0, 2.0, 3.0].map(mean_excess);
            println!("{more}: {excess:?}");
            assert!(excess[0].abs() < 1e-9 && excess[1].abs() < 1e-9, "{excess:?}");
            assert!(excess[2] > 0.95 * load && excess[2] < load, "{excess:?}");
        }
    }
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    /// Loaded and unloaded evenly at its surface, with the grid's points and with finite elements. The same law in steps ten times as
    /// fine tells what the steps are worth.
    #[test]
    fn a_surcharge_settles_and_swells_as_in_the_oedometer() {
        let load = 20.0;
        let phases = format!(
            "- {{name: load, analysis: quasi_static, duration: 1, step: {{initial: {}}}, tractions: [{{on: top, ty: {{rate: -{load}}}}}]}}\n\
         - {{name: unload, analysis: quasi_static, duration: 1, step: {{initial: {0}}}, tractions: [{{on: top, ty: {{table: [[0, -{load}], [1, 0]]}}}}]}}\n",
            1.0 / STEPS as f64
        );
        let model = clay();
        let stress = |steps: usize| {
            move |depth: f64, n: usize| -WEIGHT * depth - load * (1.0 - (n as f64 / steps as f64 - 1.0).abs())
        };
        let exact = settlement(&*model, 2 * STEPS, stress(STEPS));
        let fine = settlement(&*model, 20 * STEPS, stress(10 * STEPS));
        println!("steps: {:.2e}", exact[STEPS - 1] / fine[10 * STEPS - 1] - 1.0);
        for kind in ["mpm", "fem"] {
            let folder = run(kind, "never", "", &phases);
            let uy = column(folder.path(), "top.uy [m]");
            assert_eq!(uy.len(), 1 + 2 * STEPS);
            let errors: Vec<f64> = uy[1..].iter().zip(&exact).map(|(u, s)| -u / s - 1.0).collect();
            println!("{kind}: at rest {:.1e} m, loaded {:.5} m, back {:.5} m", uy[0], uy[STEPS], uy[2 * STEPS]);
            println!(
                "worst {:.1e}, loaded {:.1e}, back {:.1e}",
                worst(&errors),
                errors[STEPS - 1],
                errors[2 * STEPS - 1]
            );
            assert!(uy[0].abs() < 1e-10, "{}", uy[0]);
            assert!((-uy[STEPS] / fine[10 * STEPS - 1] - 1.0).abs() < 1e-3, "{uy:?} {}", fine[10 * STEPS - 1]);
            assert!(worst(&errors) < 1e-3, "{errors:?}");
            if kind == "mpm" {
                stresses(folder.path(), &*model, stress(STEPS));
            }
        }
    }
}
