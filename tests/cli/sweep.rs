//! `mpm sweep`: a case for every combination of values.

use crate::support::{column, command, errors, in_folder, said, succeeds};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

const GEO: &str = r#"Point(1) = {0, 0, 0, 1}; Point(2) = {2, 0, 0, 1}; Point(3) = {2, 1, 0, 1}; Point(4) = {0, 1, 0, 1};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Physical Surface("soil") = {1}; Physical Curve("bottom") = {1}; Physical Curve("top") = {3};
"#;

const CASE: &str = "\
title: Block
geometry: plane_strain
mesh: {geo: scene.geo}
regions: {soil: {kind: mpm, material: clay}}
materials: {clay: {model: linear_elastic, young: 100, poisson: 0.3, density: 1.8}}
supports: {bottom: {ux: 0, uy: 0}}
phases:
  - name: load
    analysis: quasi_static
    duration: 1
    step: {initial: 0.1, max: 0.1}
    prescribe: {top: {uy: {table: [[0, 0], [1, -0.001]]}}}
output:
  every: 1
  history: [{name: top, on: top, quantities: [uy, reaction_y]}]
";

/// A folder with the case in `block`.
pub fn scene() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::create_dir(folder.path().join("block")).unwrap();
    fs::write(folder.path().join("block/case.yaml"), CASE).unwrap();
    fs::write(folder.path().join("block/scene.geo"), GEO).unwrap();
    folder
}

/// The rows of a table, the heading first.
pub fn rows(table: &Path) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_path(table).unwrap();
    reader.records().map(|record| record.unwrap().iter().map(str::to_owned).collect()).collect()
}

#[test]
fn every_combination_has_a_folder_and_a_row() {
    let scene = scene();
    let axes = ["materials.clay.young=100,200", "materials.clay.poisson=0.2,0.3"];
    succeeds(&in_folder(scene.path(), &["sweep", "block", axes[0], axes[1]]));
    let table = rows(&scene.path().join("block/sweep/table.csv"));
    let quantities = ["top.uy last [m]", "top.uy min [m]", "top.uy max [m]"];
    assert_eq!(table[0][..8], [&["run", "young", "poisson", "state", "time [s]"][..], &quantities].concat());
    assert_eq!(table[0][8..], ["last", "min", "max"].map(|how| format!("top.reaction_y {how} [kN]")));
    assert_eq!(table[1][..5], ["young=100__poisson=0.2", "100", "0.2", "finished", "1.0"]);
    assert_eq!(table.len(), 5);
    let number = |row: usize, column: usize| table[row][column].parse::<f64>().unwrap();
    for (row, pair) in [(1, 3), (2, 4)] {
        // The force of an elastic block is proportional to Young's modulus.
        let (soft, stiff) = (number(row, 8), number(pair, 8));
        assert!(soft < -0.1 && (stiff / soft - 2.0).abs() < 1e-6, "{soft} {stiff}");
        let alone = scene.path().join("alone");
        let set =
            [format!("materials.clay.young={}", table[row][1]), format!("materials.clay.poisson={}", table[row][2])];
        let out = alone.display().to_string();
        succeeds(&in_folder(scene.path(), &["run", "block", "-o", &out, "--set", &set[0], "--set", &set[1]]));
        let force = column(&alone, "top.reaction_y [kN]");
        assert_eq!((soft, number(row, 10)), (*force.last().unwrap(), force.iter().copied().fold(f64::MIN, f64::max)));
    }
}

#[test]
fn a_run_that_cannot_go_on_has_its_reason_in_the_table_and_the_others_finish() {
    let scene = scene();
    let axis = "phases.load.prescribe.top.uy.table=[[0, 0], [1, -0.001]],[[0, 0], [1, -3]],[[0, 0], [1, 0.001]]";
    let output = in_folder(scene.path(), &["sweep", "block", axis, "-o", "out"]);
    assert_eq!(output.status.code(), Some(1), "{}", said(&output));
    let table = rows(&scene.path().join("out/table.csv"));
    let states: Vec<&str> = table[1..].iter().map(|row| row[2].as_str()).collect();
    assert_eq!((states[0], states[2]), ("finished", "finished"));
    assert!(states[1].starts_with("ended early: ") && states[1].len() > 20, "{}", states[1]);
    assert!(errors(&output).contains(&format!("see out/{}.log", table[2][0])), "{}", errors(&output));
    assert!(table[2][3].parse::<f64>().unwrap() < 1.0);
}

#[test]
fn every_mistake_is_told_before_anything_begins() {
    let scene = scene();
    let output =
        in_folder(scene.path(), &["sweep", "block", "materials.clay.young=100,-5,soft", "mesh.parametres.h=1"]);
    assert_eq!(output.status.code(), Some(2));
    let said = errors(&output);
    assert!(said.contains("-5") && said.contains("soft") && said.contains("parametres"), "{said}");
    assert!(!scene.path().join("block/sweep").exists());
}

#[test]
fn runs_can_be_listed_and_done_one_by_one() {
    let scene = scene();
    let sweep =
        |more: &[&str]| in_folder(scene.path(), &[&["sweep", "block", "materials.clay.young=100,200"], more].concat());
    assert_eq!(said(&sweep(&["--list"])), "young=100\nyoung=200\n");
    assert!(!scene.path().join("block/sweep").exists());
    succeeds(&sweep(&["--only", "young=200"]));
    succeeds(&sweep(&["--table"]));
    let table = rows(&scene.path().join("block/sweep/table.csv"));
    assert_eq!((table[1][2].as_str(), table[2][2].as_str()), ("not run", "finished"));
    let unknown = sweep(&["--only", "young=300"]);
    assert_eq!(unknown.status.code(), Some(2));
    assert!(errors(&unknown).contains("young=300"), "{}", errors(&unknown));
}

/// Also where there is one thread alone: those that watch the runs do not wait for the one that waits for them.
#[test]
fn a_change_of_the_case_makes_its_runs_out_of_date() {
    let scene = scene();
    let sweep = |more: &[&str]| {
        let mut command = command(scene.path(), &[&["sweep", "block", "materials.clay.young=100"], more].concat());
        command.env("RAYON_NUM_THREADS", "1").output().unwrap()
    };
    succeeds(&sweep(&[]));
    succeeds(&sweep(&["--table", "--set", "materials.clay.poisson=0.2"]));
    let table = scene.path().join("block/sweep/table.csv");
    assert_eq!(rows(&table)[1][2], "out of date");
    succeeds(&sweep(&["--set", "materials.clay.poisson=0.2"]));
    assert_eq!(rows(&table)[1][2], "finished");
}
