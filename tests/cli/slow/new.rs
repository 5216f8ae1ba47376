//! The templates run to their end on coarse meshes, and come to the numbers that their READMEs promise, as closely as these say.
//! The slope and the bar that penetrates are run by the first steps of the manual (`tests/manual.rs`), which print theirs.

use crate::support::{column, in_folder, succeeds};
use std::f64::consts::PI;
use std::path::Path;
use tempfile::TempDir;

/// Writes a template with changes and runs it; returns the folder, with the results in `case/out`.
#[track_caller]
fn run(template: &str, set: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let set: Vec<&str> = set.iter().flat_map(|entry| ["--set", entry]).collect();
    succeeds(&in_folder(folder.path(), &[&["new", template, "case"], &set[..]].concat()));
    succeeds(&in_folder(folder.path(), &["run", "case"]));
    folder
}

fn history(folder: &TempDir, name: &str) -> Vec<f64> {
    column(&folder.path().join("case/out"), name)
}

/// The mean of a column from the time `from` on.
fn mean(folder: &TempDir, name: &str, from: f64) -> f64 {
    let (time, values) = (history(folder, "time [s]"), history(folder, name));
    let chosen: Vec<f64> = time.iter().zip(values).filter(|(time, _)| **time > from).map(|(_, value)| value).collect();
    chosen.iter().sum::<f64>() / chosen.len() as f64
}

/// Fails unless `found` is `expected` but for the part `tolerance`.
#[track_caller]
fn is_close(found: f64, expected: f64, tolerance: f64) {
    let error = found / expected - 1.0;
    println!("{found:.4}, expected {expected:.4}: {:+.2} %", 100.0 * error);
    assert!(error.abs() <= tolerance, "{found} is {:+.2} % beside {expected}", 100.0 * error);
}

#[test]
fn footing() {
    for (geometry, load) in [("plane_strain", (2.0 + PI) * 20.0), ("axisymmetric", 6.05 * 20.0 * PI)] {
        let out = run("footing", &["mesh.parameters.h=0.1", &format!("geometry={geometry}")]);
        is_close(*history(&out, "footing.contact_y [kN]").last().unwrap(), load, 0.08);
    }
}

/// The template to its end, on cells and with steps larger by 1.28: a strip once stopped in the last half metre.
#[test]
fn penetration_of_a_strip() {
    let coarse = ["mesh.parameters.h=0.16", "phases.push.step.max=0.026"];
    let out = run("penetration", &[&coarse[..], &["mesh.parameters.shape=1"]].concat());
    let load = 2.0 * mean(&out, "body.contact_y [kN]", 3.5) - 6.0 * 0.25;
    is_close(load, 12.1 * 2.0, 0.05);
}

/// Limit analysis of a wall in contact all along its side: `benches/verification/limit_analysis.py --body 0 0.125 -1.75 0 --adhesion 0.5 --width 5
/// --beneath 2.5`, twice the bound with cells of 0.0078 m less that with 0.0156 m.
#[test]
fn penetration_of_a_wall() {
    let out = run("penetration", &["mesh.parameters.way=2", "phases.push.duration=2", "mesh.parameters.shape=2"]);
    // With the weight of the clay that it displaces, of the half, at the mean depth of 1.75 m.
    let expected = 0.5 * 2.0 * 4.101 + 6.0 * 0.125 * 1.75;
    is_close(mean(&out, "body.contact_y [kN]", 1.5), expected, 0.03);
}

#[test]
fn anchor() {
    let (parts, bonded) = (5.5 + 6.0 * 4.0 / 10.0, 12.1);
    for (entry, factor) in [
        ("contacts[0].tension=cut_off", parts),
        ("numerics={restore: every_step}", parts),
        ("contacts[0].tension=no_separation", bonded),
    ] {
        let out = run("anchor", &[entry, "phases.pull.duration=0.15", "mesh.parameters.h=0.125"]);
        is_close(-mean(&out, "plate.contact_y [kN]", 0.1), factor * 10.0 / 2.0, 0.05);
    }
}

#[test]
fn pipe() {
    let out = run("pipe", &["mesh.parameters.h=0.14", "mesh.parameters.way=0.3", "phases.pull.duration=0.3"]);
    let (time, load) = (history(&out, "time [s]"), history(&out, "pipe.contact_y [kN]"));
    let laid_at = time.iter().position(|&time| (time - 0.12).abs() < 1e-9).expect("the end of the phase `lay`");
    let (diameter, depth, strength) = (0.8_f64, 0.12, 2.5);
    let half_angle = (1.0 - 2.0 * depth / diameter).acos();
    let section = diameter * diameter / 4.0 * (half_angle - half_angle.sin() * half_angle.cos());
    is_close(section, 0.0473, 0.001);
    let bearing = 6.0 * (depth / diameter).powf(0.25) * diameter * strength + 1.5 * 6.5 * section;
    is_close(load[laid_at], bearing, 0.1);
    // The weight of the mesh of the pipe, whose edges are parabolas.
    is_close(*load.last().unwrap(), 7.0 * PI * diameter * diameter / 4.0, 3e-4);
    assert!(history(&out, "pipe.contact_x [kN]").last().unwrap() < &-1.5, "it resists");
}

#[test]
fn consolidation() {
    let out = run("consolidation", &[]);
    // The first term of the series: those beyond it are below 1e-6 at T_v = 1.
    let decay = (-PI * PI / 4.0).exp();
    is_close(-history(&out, "top.uy [m]").last().unwrap(), 0.018 * (1.0 - 8.0 / (PI * PI) * decay), 0.04);
    is_close(*history(&out, "base.pore_pressure [kPa]").last().unwrap(), 40.0 * 4.0 / PI * decay, 0.04);
}

/// Passive, in sand and in clay, and active; the heave makes the first two larger by 2 %.
#[test]
fn wall() {
    let force = |settings: &[&str]| {
        let out = run("wall", &[&["mesh.parameters.h=1"], settings].concat());
        -history(&out, "wall.contact_x [kN]").last().unwrap()
    };
    is_close(force(&[]), 3.0 * 18.0 * 8.0 + 2.0 * 5.0 * 3f64.sqrt() * 4.0, 0.03);
    let clay = "materials.sand={model: tresca, young: 60000, poisson: 0.49, shear_strength: 40, unit_weight: 18}";
    is_close(force(&[clay, "initial_stress.k0=1"]), 18.0 * 8.0 + 2.0 * 40.0 * 4.0, 0.03);
    let active = ["phases.push.prescribe.wall.ux.rate=-0.03", "materials.sand.cohesion=0"];
    is_close(force(&active), 18.0 * 8.0 / 3.0, 0.05);
}

/// The parts of a pile bear its whole force, also those with round edges, in the first case and in the one that goes on from it.
#[test]
fn monopile() {
    let out = run("monopile", &["mesh.parameters.h=0.2", "phases.push.duration=0.8"]);
    succeeds(&in_folder(out.path(), &["run", "case/loading.yaml", "-o", "loading"]));
    let parts = |folder: &Path, names: &[&str]| -> f64 {
        names.iter().map(|name| *column(folder, &format!("{name}.contact_y [kN]")).last().unwrap()).sum()
    };
    for folder in ["case/out", "loading"].map(|folder| out.path().join(folder)) {
        let all = parts(&folder, &["pile"]);
        is_close(parts(&folder, &["tip", "outside", "inside"]), all, 2e-3);
        assert_eq!(all > 0.0, folder.ends_with("case/out"), "{all}");
    }
}
