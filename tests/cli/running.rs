//! What the solve stage does when the analysis cannot go on, and what `--resume` does and refuses.

use crate::support::{errors, stage};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const SLOPE: &str = "cases/seabed_slope";
const BEAM: &str = "tests/data/release";
const PLATE: &str = "tests/data/plate";

/// Runs `mpm verb case -o folder` with entries of the case overridden; returns what it said on standard error.
fn mpm(verb: &str, case: &str, folder: &Path, set: &[&str], more: &[&str], status: i32) -> String {
    let output = stage(verb, case, folder, set).args(more).output().unwrap();
    let said = errors(&output);
    assert_eq!(output.status.code(), Some(status), "{said}");
    assert!(!said.contains("panicked"), "{said}");
    said
}

fn says(text: &str, parts: &[&str]) {
    for part in parts {
        assert!(text.contains(part), "`{part}` is not in: {text}");
    }
}

/// An analysis that ends with an error that says `parts`: all until then can be exported. Returns the number of
/// frames.
fn fails(case: &str, set: &[&str], parts: &[&str]) -> usize {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    mpm("mesh", case, folder, set, &[], 0);
    mpm("seed", case, folder, set, &[], 0);
    let said = mpm("solve", case, folder, set, &[], 1);
    assert_eq!(said.lines().filter(|line| line.starts_with("error")).count(), 1, "{said}");
    says(&said, parts);
    let log = fs::read_to_string(folder.join("solve.log")).unwrap();
    let last = log.lines().last().unwrap();
    assert!(last.starts_with("the analysis ends here") && parts.iter().all(|p| last.contains(p)), "{last}");
    mpm("export", case, folder, set, &[], 0);
    let steps = fs::read_to_string(folder.join("history.csv")).unwrap().lines().count() - 1;
    let series = fs::read_to_string(folder.join("points.pvd")).unwrap();
    let frames = series.matches("<DataSet").count();
    let logged = log.lines().filter(|line| line.starts_with("step ")).count();
    assert_eq!(logged, steps);
    // The first state, and the one in which it could not go on.
    assert!(frames > usize::from(steps > 0), "{frames} frames of {steps} steps");
    frames
}

const SHORT: [&str; 2] = ["mesh.parameters.h=1.5", "phases[0].duration=2"];

#[test]
fn points_that_leave_the_grid_are_named() {
    // Without the water there is nowhere to go, and without the end nothing to hold the soil.
    let regions = "regions={soil: {kind: mpm, material: clay, points_per_cell: 16}, \
                   water: {kind: mpm, material: clay, points_per_cell: 4}}";
    let set = [SHORT[0], SHORT[1], regions, "supports={bottom: {ux: 0, uy: 0}}"];
    let frames =
        fails(SLOPE, &set, &["material point", "(soil)", "left the grid at [", "phase `fail`", "buffer region"]);
    assert!(frames >= 3, "{frames}");
}

#[test]
fn a_body_free_to_move_is_told_to_be_held() {
    let parts = |ways| [ways, "step 1 ", "hold it by supports"];
    let phase = |tractions: &str| {
        format!(
            "phases=[{{name: pull, analysis: quasi_static, duration: 1, step: {{initial: 0.1}}, \
             tractions: {tractions}}}]"
        )
    };
    let pulled = phase("[{on: tip, tx: 5}]");
    // In balance: there are solutions, and none of them is the one.
    let balanced = phase("[{on: tip, tx: 5}, {on: clamp, tx: -5}]");
    for phases in [pulled, balanced] {
        let parts = parts("singular: `beam` is free in x, in y and to turn;");
        fails(BEAM, &["supports={}", &phases], &parts);
    }
    // The tip is moved downwards: there it may turn.
    fails(BEAM, &["supports={}"], &parts("singular: `beam` is free in x and to turn about [4.0000, "));
    // A plate on soil, held by nothing but the soil: it may slide.
    let lies = "phases=[{name: lie, analysis: quasi_static, duration: 1, step: {initial: 0.1}, tractions: [{on: top, ty: -1}]}]";
    fails(PLATE, &[lies], &parts("singular: `plate` is free in x;"));
    fails(PLATE, &[lies, "regions.plate.rigid=true"], &parts("singular: `plate` is free in x;"));
}

#[test]
fn a_step_that_cannot_converge_ends_the_analysis_and_a_smaller_one_continues_it() {
    // Plastic steps of this size converge, but not in two iterations.
    let coarse = ["phases.swing.step.min=0.01", "numerics.max_iterations=2"];
    let parts = ["too many iterations", "step.min", "phase `"];
    fails(BEAM, &coarse, &parts);

    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    mpm("mesh", BEAM, folder, &[], &[], 0);
    mpm("seed", BEAM, folder, &[], &[], 0);
    mpm("solve", BEAM, folder, &coarse, &[], 1);
    let before = fs::read(folder.join("history.csv")).unwrap();
    mpm("solve", BEAM, folder, &[], &["--resume"], 0);
    let after = fs::read(folder.join("history.csv")).unwrap();
    assert!(after.len() > before.len() && after.starts_with(&before), "it goes on where it was");
    mpm("export", BEAM, folder, &[], &[], 0);
}

#[test]
fn what_is_watched_may_be_empty() {
    let folder = tempfile::tempdir().unwrap();
    let set = [SHORT[0], "phases[0].duration=0.1", "output.history=[{name: w, on: water, quantities: [ux, vy]}]"];
    mpm("run", SLOPE, folder.path(), &set, &[], 0);
}

#[test]
fn a_prescribed_displacement_far_from_all_material_is_noted() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let height = "mesh.parameters.headroom=15";
    let rest = ["phases[0].duration=0.04", "phases[0].gravity=0", "supports={bottom: {uy: 0}}", "output.history=[]"];
    for (curve, noted) in [("top", true), ("end", false)] {
        let prescribe = format!("phases[0].prescribe={{{curve}: {{ux: {{rate: 0.001}}}}}}");
        let set = [SHORT[0], height, &prescribe, rest[0], rest[1], rest[2], rest[3]];
        let said = ["mesh", "seed", "solve"].map(|stage| mpm(stage, SLOPE, folder, &set, &[], 0)).concat();
        let log = fs::read_to_string(folder.join("solve.log")).unwrap();
        for text in [&said, &log] {
            assert_eq!(text.contains("prescribed in x near") && text.contains("meets no material"), noted, "{text}");
        }
    }
}

#[test]
fn frames_without_number_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    for entry in ["output.every=1e-9", "phases[0].duration=1e300"] {
        let said = mpm("run", SLOPE, folder.path(), &[entry], &[], 2);
        says(&said, &["output.every", "frames", "less often"]);
    }
}

/// A beam that was solved, and what its run left.
fn solved() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for verb in ["mesh", "seed", "solve"] {
        mpm(verb, BEAM, folder.path(), &[], &[], 0);
    }
    folder
}

fn contents(folder: &Path) -> Vec<Vec<u8>> {
    let mut files: Vec<_> = fs::read_dir(folder.join("results")).unwrap().map(|e| e.unwrap().path()).collect();
    files.extend(["history.csv", "energy.csv", "solve.log"].map(|name| folder.join(name)));
    files.sort();
    files.into_iter().map(|file| fs::read(file).unwrap()).collect()
}

#[test]
fn resuming_a_finished_run_changes_nothing() {
    let folder = solved();
    let before = contents(folder.path());
    mpm("solve", BEAM, folder.path(), &[], &["--resume"], 0);
    assert!(before == contents(folder.path()));
}

#[test]
fn resuming_without_a_checkpoint_begins_afresh_and_says_so() {
    let folder = solved();
    let before = contents(folder.path());
    fs::remove_dir_all(folder.path().join("checkpoints")).unwrap();
    let said = mpm("solve", BEAM, folder.path(), &[], &["--resume"], 0);
    says(&said, &["no checkpoint", "afresh"]);
    assert!(before == contents(folder.path()));
}

#[test]
fn resuming_another_case_is_refused_and_loses_nothing() {
    let folder = solved();
    let before = contents(folder.path());
    for entry in
        ["output.every=0.05", "phases.rest.duration=2", "materials.steel.young=13000", "numerics.tolerance=1e-6"]
    {
        let said = mpm("solve", BEAM, folder.path(), &[entry], &["--resume"], 2);
        says(&said, &["checkpoint", "another case", "without --resume"]);
        assert!(before == contents(folder.path()), "{entry}");
    }
}

#[test]
fn a_damaged_checkpoint_is_passed_over() {
    let folder = solved();
    let before = contents(folder.path());
    let mut steps: Vec<_> =
        fs::read_dir(folder.path().join("checkpoints")).unwrap().map(|e| e.unwrap().path()).collect();
    steps.sort();
    let newest = steps.last().unwrap();
    let bytes = fs::read(newest).unwrap();
    fs::write(newest, &bytes[..bytes.len() / 2]).unwrap();
    let said = mpm("solve", BEAM, folder.path(), &[], &["--resume"], 0);
    says(&said, &[newest.file_name().unwrap().to_str().unwrap()]);
    assert!(before == contents(folder.path()), "the last step is done again, to the same bytes");
}

/// Where sand finds no equilibrium the message says what that may mean, what was left out of balance, and how far the load came.
#[test]
fn sand_that_finds_no_equilibrium_may_be_at_its_limit() {
    let set = ["materials.soil.cohesion=0.3", "phases.rest.step={initial: 0.1, min: 0.005}"];
    let parts = [
        "no equilibrium found: the load may be the limit",
        "the unbalanced force was",
        "equilibrium was last found at the gravity factor 0.",
    ];
    fails("tests/data/vertical_cut", &set, &parts);
}

/// A motion that is prescribed elsewhere does not lead the iteration past the limit: the cut fails as it does without it.
#[test]
fn sand_that_fails_beside_a_prescribed_motion_finds_no_equilibrium() {
    let set = [
        "materials.soil.cohesion=0.3",
        "phases.rest.step={initial: 0.1, min: 0.005}",
        "phases.rest.prescribe={sides: {uy: {rate: -1.0e-7}}}",
    ];
    fails("tests/data/vertical_cut", &set, &["no equilibrium found: the load may be the limit"]);
}

/// The load factor that a quasi-static analysis came to is what one wants to know of a collapse.
#[test]
fn an_analysis_that_meets_the_limit_load_says_how_far_it_came() {
    let material = "materials.soil={model: tresca, young: 1000, poisson: 0.3, shear_strength: 10, density: 1}";
    let step = "phases.gravity.step={initial: 0.05, min: 0.05}";
    let set = ["mesh.parameters.h=2", material, step, "numerics.max_iterations=4"];
    fails(
        "cases/slump",
        &set,
        &["equilibrium was last found at the gravity factor 0.", " of 1.0000)", "analysis: dynamic"],
    );
}
