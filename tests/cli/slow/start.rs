//! A case that goes on from the end of a phase of another run does what it would in one run with the phases of both, bit by bit.

use crate::support::{errors, mpm, said, stage, succeeds};
use mpm::io::container::{Array, Store};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A case with overrides and its phases, the one at which it is cut among them.
struct Case {
    file: &'static str,
    overrides: &'static [&'static str],
    phases: &'static [&'static str],
    cut: usize,
}

/// A plate pressed into clay that it cannot part from, pulled, and let go.
const CONTACT: Case = Case {
    file: "tests/data/plate",
    overrides: &[
        "mesh.parameters={plate: 0.8, left: 0.6, edge: 0.05}",
        "materials.soil={model: tresca, young: 1000, poisson: 0.49, shear_strength: 10, density: 0}",
        "contacts=[{name: base, structure: plate, soil: soil, adhesion_factor: 0.5, tension: no_separation}]",
    ],
    phases: &[
        "{name: install, analysis: quasi_static, duration: 1, step: {initial: 0.1}, prescribe: {top: {ux: 0, uy: {rate: -0.03}}}}",
        "{name: pull, analysis: quasi_static, duration: 1, step: {initial: 0.1}, prescribe: {top: {ux: 0, uy: {rate: 0.03}}}, \
         reset_displacements: true}",
    ],
    cut: 1,
};

/// Consolidation, from the middle of it.
const WATER: Case = Case {
    file: "cases/terzaghi",
    overrides: &[],
    phases: &[
        "{name: T 0.01, analysis: consolidation, duration: 100, step: {initial: 5}, tractions: [{on: top, ty: -0.1}]}",
        "{name: T 0.05, analysis: consolidation, duration: 400, step: {initial: 20}, tractions: [{on: top, ty: -0.1}]}",
        "{name: T 0.1, analysis: consolidation, duration: 500, step: {initial: 50}, tractions: [{on: top, ty: -0.1}]}",
    ],
    cut: 2,
};

/// A beam that swings on, and is then let come to rest in another material.
const SWING: Case = Case {
    file: "tests/data/release",
    overrides: &[
        "mesh.parameters.h=0.5",
        "materials.soft={model: von_mises, young: 6000, poisson: 0.3, yield_stress: 100, density: 1}",
    ],
    phases: &[
        "{name: bend, analysis: quasi_static, duration: 1, step: {initial: 0.1}, prescribe: {tip: {uy: {rate: -0.3}}}}",
        "{name: swing, analysis: dynamic, duration: 0.2, step: {initial: 0.01, max: 0.02}}",
        "{name: on, analysis: dynamic, duration: 0.2, step: {initial: 0.02}, materials: {beam: soft}}",
        "{name: rest, analysis: quasi_static, duration: 0.5, step: {initial: 0.1}, reset_displacements: true}",
    ],
    cut: 2,
};

impl Case {
    fn phases(&self, which: std::ops::Range<usize>) -> String {
        format!("phases=[{}]", self.phases[which].join(", "))
    }

    fn run(&self, folder: &Path, phases: std::ops::Range<usize>, more: &[&str]) {
        let phases = self.phases(phases);
        succeeds(&mpm("run", self.file, folder, &[self.overrides, &[phases.as_str()], more].concat()));
    }
}

fn from(run: &Path) -> String {
    format!("start_from={{run: {}}}", run.display())
}

/// The rows of the history that are later than a time.
fn later(folder: &Path, time: f64) -> Vec<String> {
    let text = fs::read_to_string(folder.join("history.csv")).unwrap();
    let time_of = |row: &str| row.split(',').next().unwrap().parse::<f64>().unwrap();
    text.lines().skip(1).filter(|row| time_of(row) > time + 1e-9).map(str::to_owned).collect()
}

/// The state at the end of the phase with a number, but for the number of its frames.
fn state(folder: &Path, number: usize) -> Vec<Array> {
    let start = format!("{number:02}-");
    let is_wanted = |name: &str| name.starts_with(&start);
    let mut entries = fs::read_dir(folder.join("phases")).unwrap().map(|entry| entry.unwrap());
    let file = entries.find(|entry| is_wanted(entry.file_name().to_str().unwrap())).unwrap();
    let mut arrays = Store::read(&file.path(), "phase", "").unwrap().into_arrays();
    arrays.retain(|array| array.name != "state.counts");
    assert!(arrays.len() > 20);
    arrays
}

fn is_that_of_one_run(case: &Case) -> [TempDir; 3] {
    let [whole, before, after] = [0; 3].map(|_| tempfile::tempdir().unwrap());
    let last = case.phases.len();
    case.run(whole.path(), 0..last, &[]);
    case.run(before.path(), 0..case.cut, &[]);
    case.run(after.path(), case.cut..last, &[&from(before.path())]);
    let log = fs::read_to_string(after.path().join("solve.log")).unwrap();
    assert!(log.contains("the run goes on from the end of phase"), "{log}");
    let rows = later(after.path(), 0.0);
    let begun = later(before.path(), 0.0).last().unwrap().split(',').next().unwrap().parse().unwrap();
    assert!(rows.len() >= 5 && rows == later(whole.path(), begun), "{rows:#?}");
    for number in case.cut..last {
        assert!(state(after.path(), number) == state(whole.path(), number), "phase {number}");
    }
    [whole, before, after]
}

#[test]
fn with_contact() {
    let case = &CONTACT;
    let [_, before, after] = is_that_of_one_run(case);

    // Nothing has changed, until the run before has.
    let pull = case.phases(1..2);
    let start = from(before.path());
    let set = [case.overrides, &[pull.as_str(), &start]].concat();
    let again = |words: &str| {
        let output = mpm("run", case.file, after.path(), &set);
        succeeds(&output);
        assert!(said(&output).contains(words), "{}", said(&output));
    };
    again("solve: nothing has changed");
    case.run(before.path(), 0..1, &["output.fields=[stress]"]);
    again("solve: nothing has changed");
    let faster = case.phases(0..1).replace("-0.03", "-0.031");
    succeeds(&mpm("run", case.file, before.path(), &[case.overrides, &[faster.as_str()]].concat()));
    again("solved in");
    let record = fs::read_to_string(after.path().join("provenance/solve.json")).unwrap();
    assert!(record.contains("phases/00-install.mpms"), "{record}");

    // A contact may have other numbers from there on. The plate is pulled by soil that it may part from now.
    let other = tempfile::tempdir().unwrap();
    let parts = "contacts=[{name: base, structure: plate, soil: soil, adhesion_factor: 0.5}]";
    let set = [case.overrides, &[parts, &pull, &start]].concat();
    succeeds(&mpm("run", case.file, other.path(), &set));
    let force = |folder: &Path| later(folder, 0.0).last().unwrap().split(',').nth(4).unwrap().parse::<f64>().unwrap();
    let [held, parted] = [after.path(), other.path()].map(force);
    assert!(held < -1.0 && parted.abs() < 1e-6, "{held} {parted}");

    // All else is refused, and named.
    for (entry, words) in [
        ("materials.soil.shear_strength=11", ["materials.soil.shear_strength", "it is 10"]),
        ("regions.soil.points_per_cell=9", ["regions.soil.points_per_cell", "it is not given"]),
        ("geometry=axisymmetric", ["geometry", "plane_strain"]),
        ("supports.side={ux: 0, uy: 0}", ["supports.side.uy", "not given"]),
        ("numerics.restore=every_step", ["numerics", "not given"]),
        ("contacts=[]", ["contacts", "there are 1 contacts"]),
        ("contacts=[{structure: plate, soil: soil}]", ["contacts[0].name", "base"]),
        ("mesh.parameters.h=0.25", ["start_from", "another mesh"]),
        ("start_from.phase=instal", ["start_from.phase", "did you mean `install`"]),
        ("start_from.run=nowhere", ["start_from.run", "no state at the end of a phase"]),
        ("phases[0].activate=[plate]", ["phases[0].activate[0]", "has not been deactivated"]),
        ("phases[0].name=install", ["phases[0].name", "two phases"]),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let output = mpm("run", case.file, folder.path(), &[case.overrides, &[&pull, &start, entry]].concat());
        let said = errors(&output);
        assert_eq!(output.status.code(), Some(2), "{entry}: {said}");
        assert!(words.iter().all(|word| said.contains(word)), "{entry}: {said}");
    }
    // The folder of the run before would be lost.
    let output = mpm("solve", case.file, before.path(), &[case.overrides, &[&pull, &start]].concat());
    assert!(output.status.code() == Some(2) && errors(&output).contains("would be lost"), "{}", errors(&output));
}

#[test]
fn with_water_in_the_pores() {
    is_that_of_one_run(&WATER);
}

/// A run that goes on from one that went on from another, and is continued after it was stopped.
#[test]
fn with_inertia_and_in_a_chain() {
    let case = &SWING;
    let [whole, before, _] = is_that_of_one_run(case);
    let [on, rest] = [0; 2].map(|_| tempfile::tempdir().unwrap());
    case.run(on.path(), 2..3, &[&from(before.path())]);
    case.run(rest.path(), 3..4, &[&from(on.path())]);
    assert!(state(rest.path(), 3) == state(whole.path(), 3));

    // Of a phase before the last, by its name.
    let named = tempfile::tempdir().unwrap();
    case.run(named.path(), 3..4, &[&format!("start_from={{run: {}, phase: on}}", whole.path().display())]);
    assert!(state(named.path(), 3) == state(whole.path(), 3));

    // A copy of the finished run without its later checkpoint and its record is one that was killed.
    let phases = case.phases(2..4);
    let start = from(before.path());
    let set = [case.overrides, &[phases.as_str(), &start]].concat();
    let killed = tempfile::tempdir().unwrap();
    for name in ["mesh", "seed"] {
        succeeds(&mpm(name, case.file, killed.path(), &set));
    }
    let mut child = stage("solve", case.file, killed.path(), &set).spawn().unwrap();
    let rows = || fs::read_to_string(killed.path().join("history.csv")).unwrap_or_default().lines().count();
    while rows() < 6 {
        assert!(child.try_wait().unwrap().is_none(), "the run ended by itself");
        std::thread::sleep(std::time::Duration::from_micros(100));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let output = stage("solve", case.file, killed.path(), &set).arg("--resume").output().unwrap();
    succeeds(&output);
    for number in [2, 3] {
        assert!(state(killed.path(), number) == state(whole.path(), number), "phase {number}");
    }
}
