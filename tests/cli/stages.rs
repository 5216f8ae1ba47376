//! The command line: overrides, the output folder, and which stages `mpm run` skips.

use crate::support::block::{self, GEO};
use crate::support::{command, in_folder, said};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

const STAGES: [&str; 4] = ["mesh", "seed", "solve", "export"];

#[test]
fn run_does_every_stage_once() {
    let scene = scene();
    assert_eq!(skipped(&in_folder(scene.path(), &["run", "."])), [false; 4]);
    assert_eq!(skipped(&in_folder(scene.path(), &["run", "."])), [true; 4]);
}

#[test]
fn a_change_runs_the_stages_it_reaches() {
    // What is changed, and the stages that may be skipped then.
    let changes: [(&[&str], [bool; 4]); 7] = [
        (&["--set", "title=Other"], [true, true, true, true]),
        (&["--set", "output.encoding=plain"], [true, true, false, false]),
        (&["--set", "phases.load.step.initial=0.5"], [true, true, false, false]),
        (&["--set", "materials.rock.young=2000"], [true, false, false, false]),
        (&["--set", "regions.block.points_per_cell=9"], [true, false, false, false]),
        (&["--set", "mesh.parameters.h=0.5"], [false, false, false, false]),
        (&["--threads", "1"], [true, true, true, true]),
    ];
    for (arguments, expected) in changes {
        let scene = scene();
        in_folder(scene.path(), &["run", "."]);
        let output = in_folder(scene.path(), &[&["run", "."], arguments].concat());
        assert_eq!(skipped(&output), expected, "{arguments:?}: {}", said(&output));
    }
}

/// The soil begins under the water of the first phase.
#[test]
fn another_first_level_of_the_water_seeds_again() {
    let scene = scene();
    let water = ["run", ".", "--set", "water={level: 1}"];
    assert_eq!(skipped(&in_folder(scene.path(), &water)), [false; 4]);
    let output = in_folder(scene.path(), &[&water[..], &["--set", "phases.load.water_level=2"]].concat());
    assert_eq!(skipped(&output), [true, false, false, false], "{}", said(&output));
}

/// Soil of 20 kN/m³ and K₀ = 0.5 has the shear stress 5 kPa/m times the depth: a strength of 4 kPa bears it down to 0.8 m of 2 m.
#[test]
fn an_initial_stress_beyond_yield_is_told() {
    let scene = scene();
    let seed = |strength: &str| {
        let material = format!(
            "materials.rock={{model: tresca, young: 1000, poisson: 0.2, density: 2, shear_strength: {strength}}}"
        );
        let arguments = ["--set", &material, "--set", "initial_stress={k0: 0.5}", "--set", "mesh.parameters.h=0.2"];
        said(&in_folder(scene.path(), &[&["run", "."], &arguments[..]].concat()))
    };
    let said = seed("4");
    let line = said.lines().find(|line| line.contains("initial stress")).unwrap_or_else(|| panic!("{said}"));
    let numbers: Vec<f64> = line.split(' ').filter_map(|word| word.parse().ok()).collect();
    assert!(line.starts_with("region `block`") && (numbers[0] / numbers[1] - 0.6).abs() < 0.05, "{line}");
    assert!(!seed("10.1").contains("region `block`"), "strong enough everywhere");
}

#[test]
fn a_changed_geo_meshes_again() {
    let scene = scene();
    in_folder(scene.path(), &["run", "."]);
    fs::write(scene.path().join("scene.geo"), GEO.replace("{1, 2, 0, h}", "{1, 3, 0, h}")).unwrap();
    assert_eq!(skipped(&in_folder(scene.path(), &["run", "."])), [false; 4]);
}

#[test]
fn a_file_that_was_lost_or_changed_is_made_again() {
    let scene = scene();
    in_folder(scene.path(), &["run", "."]);
    let points = fs::read(scene.path().join("out/points.vtu")).unwrap();
    fs::remove_file(scene.path().join("out/points.vtu")).unwrap();
    // The same points again: what follows need not be done again.
    assert_eq!(skipped(&in_folder(scene.path(), &["run", "."])), [true, false, true, true]);
    fs::write(scene.path().join("out/points.vtu"), &points[..100]).unwrap();
    assert_eq!(skipped(&in_folder(scene.path(), &["run", "."])), [true, false, true, true]);
    assert_eq!(fs::read(scene.path().join("out/points.vtu")).unwrap(), points);
    fs::remove_file(scene.path().join("out/vtu/points_000000.vtu")).unwrap();
    assert_eq!(skipped(&in_folder(scene.path(), &["run", "."])), [true, true, true, false]);
}

#[test]
fn the_output_folder_can_be_chosen() {
    let scene = scene();
    assert!(in_folder(scene.path(), &["mesh", ".", "-o", "a/b"]).status.success());
    assert!(scene.path().join("a/b/mesh.msh").is_file());
    assert!(!scene.path().join("out").exists());
}

#[test]
fn overrides_reach_the_mesh_and_make_entries() {
    let scene = scene();
    in_folder(scene.path(), &["mesh", ".", "-o", "coarse"]);
    in_folder(scene.path(), &["mesh", ".", "-o", "fine", "--set", "mesh.parameters.h=0.25"]);
    in_folder(scene.path(), &["mesh", ".", "-o", "linear", "--set", "mesh.order=1"]);
    let size = |folder: &str| fs::metadata(scene.path().join(folder).join("mesh.msh")).unwrap().len();
    assert!(size("fine") > 4 * size("coarse") && size("linear") < size("coarse"));
}

#[test]
fn an_interrupt_ends_the_step_in_hand_and_resume_goes_on_bit_by_bit() {
    let short = ["--set", "phases.load.step.initial=0.001", "--set", "mesh.parameters.h=0.25"];
    let whole = scene();
    assert!(in_folder(whole.path(), &[&["run", "."], &short[..]].concat()).status.success());
    let scene = scene();
    for stage in ["mesh", "seed"] {
        assert!(in_folder(scene.path(), &[&[stage, "."], &short[..]].concat()).status.success());
    }
    let mut solve = command(scene.path(), &[&["solve", "."], &short[..]].concat()).spawn().unwrap();
    let history = scene.path().join("out/history.csv");
    while fs::read_to_string(&history).unwrap_or_default().lines().count() < 5 {
        assert!(solve.try_wait().unwrap().is_none(), "it ended before it could be stopped");
        std::thread::sleep(std::time::Duration::from_millis(1));
    }
    // A shell has `kill` built in; the program of that name may be missing.
    let signal = format!("kill -INT {}", solve.id());
    assert!(Command::new("sh").args(["-c", &signal]).status().unwrap().success());
    assert_eq!(solve.wait().unwrap().code(), Some(130));
    let rows = fs::read_to_string(&history).unwrap().lines().count();
    assert!(rows < 1001, "{rows} rows: it was not stopped");
    let output = in_folder(scene.path(), &[&["solve", ".", "--resume"], &short[..]].concat());
    assert!(output.status.success(), "{}", said(&output));
    for file in ["out/history.csv", "out/results/frame-000001.mpmf"] {
        let read = |folder: &Path| fs::read(folder.join(file)).unwrap();
        assert!(read(scene.path()) == read(whole.path()), "{file} is another one");
    }
}

#[test]
fn check_writes_nothing() {
    let scene = scene();
    assert!(in_folder(scene.path(), &["check", "."]).status.success());
    let mut files: Vec<_> = fs::read_dir(scene.path()).unwrap().map(|e| e.unwrap().file_name()).collect();
    files.sort();
    assert_eq!(files, ["case.yaml", "scene.geo"]);
}

/// Cells and steps that are too coarse for a structure show on the mesh, and `check` makes one to see them.
#[test]
fn check_warns_of_what_only_the_mesh_shows() {
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/tbar");
    let output = in_folder(&case, &["check", ".", "--set", "phases[0].step.max=1", "--set", "mesh.parameters.h=0.5"]);
    let said = said(&output);
    for part in ["which resolve it poorly", "lower its `step.max`", "no mistakes, 2 warnings"] {
        assert!(output.status.success() && said.contains(part), "{part}: {said}");
    }
}

#[test]
fn the_schema_describes_every_key() {
    let output = in_folder(Path::new("."), &["schema"]);
    let schema: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let mut undescribed = Vec::new();
    properties(&schema, &mut |name, property| {
        if property.get("description").is_none() {
            undescribed.push(name.to_owned());
        }
    });
    assert!(undescribed.is_empty(), "{undescribed:?}");
    let young = schema.pointer("/$defs/Material/properties/young");
    assert!(young.is_some_and(|young| young["description"].to_string().contains("kPa")), "{young:?}");
}

#[test]
fn the_cases_of_the_repository_are_sound() {
    let cases = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let mut count = 0;
    for entry in fs::read_dir(cases).unwrap() {
        let case = entry.unwrap().path();
        let output = in_folder(&case, &["check", "."]);
        let said = said(&output);
        // A slope that its first phase brings to equilibrium.
        let known = case.ends_with("submerged_slope") && said.contains("the soil does not begin in equilibrium");
        let warned = said.matches("warning").count() > if known { 2 } else { 0 };
        assert!(output.status.success() && !warned, "{}: {said}", case.display());
        assert!(case.join("README.md").is_file(), "{} has no README.md", case.display());
        count += 1;
    }
    assert!(count >= 5, "{count} cases");
}

#[test]
fn wrong_usage_has_exit_status_2() {
    let usages: [&[&str]; 4] = [&[], &["solves"], &["mesh"], &["mesh", ".", "--threads", "0"]];
    for arguments in usages {
        assert_eq!(in_folder(Path::new("."), arguments).status.code(), Some(2), "{arguments:?}");
    }
}

fn properties<'a>(schema: &'a serde_json::Value, see: &mut impl FnMut(&'a str, &'a serde_json::Value)) {
    if let Some(known) = schema.get("properties").and_then(|p| p.as_object()) {
        known.iter().for_each(|(name, property)| see(name, property));
    }
    match schema {
        serde_json::Value::Object(map) => map.values().for_each(|value| properties(value, see)),
        serde_json::Value::Array(items) => items.iter().for_each(|value| properties(value, see)),
        _ => {}
    }
}

fn scene() -> TempDir {
    block::scene("1", "1", "1")
}

/// Which of the stages a run has skipped.
fn skipped(output: &Output) -> [bool; 4] {
    assert!(output.status.success(), "{}", said(output));
    STAGES.map(|stage| said(output).contains(&format!("{stage}: nothing has changed")))
}
