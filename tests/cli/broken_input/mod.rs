//! Broken input: each gets one message with its place and a remedy, exit status 2 or 3, and leaves what was
//! computed before as it was. The table is run through the real program.

mod tables;

use crate::support::{PROGRAM, in_folder};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;
use tables::{ARGUMENTS, FILES, GEOMETRY, LAYOUT, MEANING, TEXT};
use tempfile::TempDir;

const GEO: &str = r#"DefineConstant[ h = {1, Min 1e-6, Name "Parameters/h"} ];
Point(1) = {0, -2, 0, h};
Point(2) = {2, -2, 0, h};
Point(3) = {2, 0, 0, h};
Point(4) = {0, 0, 0, h};
Point(5) = {2, 1, 0, h};
Point(6) = {0, 1, 0, h};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Line(5) = {3, 5};
Line(6) = {5, 6};
Line(7) = {6, 4};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Curve Loop(2) = {5, 6, 7, -3};
Plane Surface(2) = {2};
Physical Surface("soil") = {1};
Physical Surface("water") = {2};
Physical Curve("bottom") = {1};
Physical Curve("side") = {2, 4};
Physical Curve("surface") = {3};
Physical Point("corner") = {4};
"#;

const CASE: &str = "\
title: Block
geometry: plane_strain
mesh:
  geo: scene.geo
  order: 2
  parameters: {h: 1}
regions:
  soil: {kind: mpm, material: clay, points_per_cell: 4}
  water: {kind: buffer}
materials:
  clay: {model: tresca, young: {top: 100, gradient: 10}, poisson: 0.49, shear_strength: 1, density: 1.8}
supports:
  bottom: {ux: 0, uy: 0}
  side: {ux: 0}
gravity: {y: -9.81}
initial_stress: {k0: 0.8}
numerics: {restore: every_step, tolerance: 1.0e-8}
phases:
  - name: load
    analysis: quasi_static
    duration: 1
    step: {initial: 0.1, min: 0.001, max: 0.2}
    prescribe: {surface: {uy: {table: [[0, 0], [1, -0.01]]}}}
output:
  every: 0.5
  fields: [stress, displacement]
  history:
    - {name: head, on: surface, quantities: [uy, reaction_y]}
";

/// A broken input: what is changed in a sound case, and what the program must say to it.
struct Broken {
    change: Change,
    /// The subcommand with its arguments after the case.
    command: &'static [&'static str],
    status: i32,
    /// What the one message contains: the place, the problem and the remedy.
    says: &'static [&'static str],
}

enum Change {
    /// A piece of the case, and what stands in its place.
    Case(&'static str, &'static str),
    /// The same for the `.geo`.
    Geo(&'static str, &'static str),
    /// Something done to the folder of the case.
    Do(fn(&Path)),
    Nothing,
}

use Change::{Case, Do, Geo, Nothing};

#[test]
fn the_text_of_the_case() {
    try_all(TEXT);
}

#[test]
fn the_meaning_of_the_case() {
    try_all(MEANING);
}

#[test]
fn the_geometry() {
    try_all(GEOMETRY);
}

#[test]
fn the_arguments() {
    try_all(ARGUMENTS);
}

#[test]
fn the_layout_of_the_regions() {
    try_all(LAYOUT);
}

#[test]
fn the_files_and_the_machine() {
    try_all(FILES);
}

#[test]
fn the_sound_case_passes() {
    let scene = Scene::new();
    for command in ["check", "mesh", "seed", "solve", "export"] {
        let output = scene.mpm(&[command]);
        assert!(output.status.success(), "{command}: {}", text(&output.stderr));
    }
}

#[test]
fn every_mistake_is_told_in_one_go() {
    let scene = Scene::new();
    let mistakes = [
        ("plane_strain", "plane_strian", "(geometry)"),
        ("order: 2", "ordr: 2", "(mesh.ordr)"),
        ("points_per_cell: 4", "points_per_cell: 5", "(regions.soil.points_per_cell)"),
        ("poisson: 0.49", "poisson: half", "(materials.clay.poisson)"),
        ("tolerance: 1.0e-8", "tolerance: -1", "(numerics.tolerance)"),
        ("duration: 1", "duration: .inf", "(phases[0].duration)"),
    ];
    mistakes.iter().for_each(|(from, to, _)| scene.replace("case.yaml", from, to));
    let output = scene.mpm(&["check"]);
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(2));
    for (_, _, place) in mistakes {
        assert!(said.contains(place), "{place} is not in:\n{said}");
    }
    assert_eq!(said.matches("error: ").count(), mistakes.len(), "{said}");
}

#[test]
fn of_many_mistakes_the_first_are_told_and_the_others_counted() {
    let scene = Scene::new();
    let keys: String = (0..9_000).map(|i| format!("key{i}: {i}\n")).collect();
    let unknown = scene.attach("case.yaml", &keys);
    assert_eq!(unknown.matches("error: ").count(), 51, "{unknown}");
    assert!(unknown.contains("case.yaml:29:1 (key0)") && unknown.contains("(key49)"), "{unknown}");
    assert!(unknown.contains("there are 8950 more mistakes; correct these first"), "{unknown}");
    let scene = Scene::new();
    let names: String = (0..100).map(|i| format!("    - {{name: n{i}, on: nowhere{i}, quantities: [uy]}}\n")).collect();
    let nowhere = scene.attach("case.yaml", &names);
    assert_eq!(nowhere.matches("error: ").count(), 51, "{nowhere}");
    assert!(nowhere.contains("there are 50 more mistakes"), "{nowhere}");
}

#[test]
fn large_cases_are_read_in_time_that_grows_with_their_size() {
    let scene = Scene::new();
    let rows: Vec<String> = (0..100_000).map(|i| format!("[{i}e-5, {i}.5]")).collect();
    scene.replace("case.yaml", "{table: [[0, 0], [1, -0.01]]}", &format!("{{table: [{}]}}", rows.join(", ")));
    let names: String = (0..9_000).map(|i| format!("    - {{name: n{i}, on: surface, quantities: [uy]}}\n")).collect();
    assert_eq!(scene.attach("case.yaml", &names), "");
}

#[test]
fn a_byte_order_mark_is_no_mistake() {
    let scene = Scene::new();
    let case = fs::read_to_string(scene.path().join("case.yaml")).unwrap();
    fs::write(scene.path().join("case.yaml"), format!("\u{feff}{case}")).unwrap();
    let output = scene.mpm(&["check"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    scene.replace("case.yaml", "title: Block", "titel: Block");
    let said = text(&scene.mpm(&["check"]).stderr);
    assert!(said.contains("case.yaml:1:1 (titel)"), "{said}");
}

#[test]
fn more_threads_than_cores_are_not_started() {
    let scene = Scene::new();
    let output = scene.mpm(&["seed", "--threads", "1024"]);
    let said = text(&output.stderr);
    assert!(output.status.success(), "{said}");
    let cores = std::thread::available_parallelism().unwrap().get();
    if cores < 1024 {
        assert!(said.contains(&format!("--threads 1024 is more than the {cores} cores there are")), "{said}");
    }
}

/// A name of a group or a file may hold what a terminal obeys.
#[test]
fn names_reach_the_terminal_as_text() {
    let scene = Scene::new();
    scene.replace("scene.geo", "Physical Surface(\"water\")", "Physical Surface(\"wa\x1b[2J\u{202e}ter\")");
    let folder = scene.path().join("\x1b]0;title\x07");
    fs::create_dir(&folder).unwrap();
    for (name, command) in [("scene.geo", vec!["check"]), ("none", vec!["check", "--set", "mesh.geo=a\u{202e}b"])] {
        let output = scene.mpm(&command);
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{name}: {said}");
        assert!(!said.contains(['\x1b', '\x07', '\u{202e}']), "{name}: {said:?}");
        assert!(said.contains("\\u{202e}"), "{name}: {said}");
    }
    let output = mpm(&folder, &["check"]);
    let nothing = text(&output.stderr) + &text(&output.stdout);
    assert!(nothing.contains("case.yaml") && !nothing.contains(['\x1b', '\x07']), "{nothing:?}");
    let output = Command::new(PROGRAM).arg("check").arg(&folder).output().unwrap();
    let said = text(&output.stderr);
    assert!(said.contains("\\u{1b}]0;title\\u{7}") && !said.contains(['\x1b', '\x07']), "{said:?}");
}

#[test]
fn mistakes_of_the_case_and_its_geometry_are_told_together() {
    let scene = Scene::new();
    for (from, to) in [("poisson: 0.49", "poisson: 0.5"), ("top: 100", "top: -1"), ("bottom: {ux", "botom: {ux")] {
        scene.replace("case.yaml", from, to);
    }
    let said = text(&scene.mpm(&["check"]).stderr);
    for place in ["(materials.clay.poisson)", "(materials.clay.young.top)", "(supports.botom)"] {
        assert!(said.contains(place), "{place} is not in:\n{said}");
    }
}

#[test]
fn the_line_is_shown_with_a_caret_under_the_place() {
    let scene = Scene::new();
    scene.replace("case.yaml", "order: 2", "ordr: 2");
    let said = text(&scene.mpm(&["check"]).stderr);
    assert!(said.contains("\n 5 |   ordr: 2\n   |   ^\n"), "{said}");
}

#[test]
fn a_full_disk_leaves_the_earlier_files() {
    for command in ["mesh", "seed", "export"] {
        let scene = Scene::new();
        let before = scene.out();
        // No file may grow beyond 4 blocks of 512 bytes: writing fails as on a full disk.
        let script = format!("trap '' XFSZ; ulimit -f 4; exec '{PROGRAM}' {command} case.yaml");
        let output = Command::new("sh").args(["-c", &script]).current_dir(scene.path()).output().unwrap();
        let said = text(&output.stderr);
        assert_eq!(output.status.code(), Some(3), "{command}: {said}");
        assert!(said.contains("-o") && !said.contains("panicked"), "{command}: {said}");
        assert_eq!(scene.out(), before, "{command}");
    }
}

#[test]
fn a_disk_that_fills_while_solving_loses_nothing_that_is_needed_to_go_on() {
    let whole = Scene::new();
    let scene = Scene::new();
    for part in ["results", "checkpoints"] {
        fs::remove_dir_all(scene.path().join("out").join(part)).unwrap();
    }
    let script = format!("trap '' XFSZ; ulimit -f 2; exec '{PROGRAM}' solve case.yaml");
    let output = Command::new("sh").args(["-c", &script]).current_dir(scene.path()).output().unwrap();
    let said = text(&output.stderr);
    assert_eq!(output.status.code(), Some(3), "{said}");
    assert!(said.contains("cannot be written") && said.contains("-o") && !said.contains("panicked"), "{said}");
    let output = scene.mpm(&["solve", "--resume"]);
    assert!(output.status.success(), "{}", text(&output.stderr));
    let frame = |scene: &Scene| fs::read(scene.path().join("out/results/frame-000002.mpmf")).unwrap();
    assert!(frame(&scene) == frame(&whole), "the last frame is another one");
}

#[test]
fn standard_output_that_is_full_or_gone_is_no_panic() {
    let scene = Scene::new();
    let sh = |script: &str| Command::new("sh").args(["-c", script]).current_dir(scene.path()).output().unwrap();
    let full = sh(&format!("'{PROGRAM}' schema > /dev/full"));
    assert_eq!(full.status.code(), Some(3), "{}", text(&full.stderr));
    assert!(text(&full.stderr).contains("standard output"));
    let gone = sh(&format!("'{PROGRAM}' schema | head -c 1"));
    assert_eq!(text(&gone.stderr), "");
    let closed = sh(&format!("'{PROGRAM}' check case.yaml >&- 2>&-"));
    assert!(closed.status.code().is_some(), "killed by a signal");
}

fn try_all(table: &[Broken]) {
    let failures: Vec<String> = table.iter().filter_map(|broken| broken.attempt().err()).collect();
    assert!(failures.is_empty(), "{} of {}:\n\n{}", failures.len(), table.len(), failures.join("\n\n"));
}

impl Broken {
    fn attempt(&self) -> Result<(), String> {
        let scene = Scene::new();
        let what = match self.change {
            Case(from, to) => {
                scene.replace("case.yaml", from, to);
                format!("case: {from:?} → {to:?}")
            }
            Geo(from, to) => {
                scene.replace("scene.geo", from, to);
                format!("geo: {from:?} → {to:?}")
            }
            Do(action) => {
                action(scene.path());
                "an action".to_owned()
            }
            Nothing => "nothing".to_owned(),
        };
        let before = scene.out();
        let output = scene.mpm(self.command);
        let said = text(&output.stderr);
        let fault = |fault: &str| Err(format!("{what}, {:?}: {fault}\n{said}", self.command));
        if output.status.code() != Some(self.status) {
            return fault(&format!("status {:?} in place of {}", output.status.code(), self.status));
        }
        if let Some(missing) = self.says.iter().find(|&&piece| !said.contains(piece)) {
            return fault(&format!("{missing:?} is not said"));
        }
        if said.matches("error: ").count() != 1 || said.contains("panicked") || said.contains("NaN") {
            return fault("not one message");
        }
        // Place, problem and remedy.
        let first = said.lines().next().unwrap_or_default();
        if !first.contains(": ") || first.rsplit_once("; ").is_none_or(|(_, remedy)| remedy.trim().is_empty()) {
            return fault("no remedy");
        }
        if scene.out() != before {
            return fault("the output folder was touched");
        }
        Ok(())
    }
}

/// A folder with a case, its `.geo` and what was computed before.
struct Scene(TempDir);

impl Scene {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("case.yaml"), CASE).unwrap();
        fs::write(folder.path().join("scene.geo"), GEO).unwrap();
        fs::create_dir(folder.path().join("out")).unwrap();
        for (name, content) in computed() {
            let file = folder.path().join("out").join(name);
            fs::create_dir_all(file.parent().unwrap()).unwrap();
            fs::write(file, content).unwrap();
        }
        Self(folder)
    }

    fn path(&self) -> &Path {
        self.0.path()
    }

    fn replace(&self, file: &str, from: &str, to: &str) {
        let file = self.path().join(file);
        let text = fs::read_to_string(&file).unwrap();
        assert_eq!(text.matches(from).count(), 1, "{from:?} is not once in {}", file.display());
        fs::write(file, text.replace(from, to)).unwrap();
    }

    /// Runs the program on the case with a subcommand and its options.
    fn mpm(&self, command: &[&str]) -> Output {
        mpm(self.path(), command)
    }

    /// Appends to a file and checks the case: what is said then.
    fn attach(&self, file: &str, more: &str) -> String {
        let file = self.path().join(file);
        let before = fs::read_to_string(&file).unwrap();
        fs::write(&file, before + more).unwrap();
        text(&self.mpm(&["check"]).stderr)
    }

    /// Every file of the output folder with its content.
    fn out(&self) -> BTreeMap<PathBuf, Vec<u8>> {
        files(&self.path().join("out"))
    }
}

fn mpm(folder: &Path, command: &[&str]) -> Output {
    in_folder(folder, &[&command[..1], &["case.yaml"], &command[1..]].concat())
}

/// The files of the stages up to the solution, made once.
fn computed() -> &'static BTreeMap<PathBuf, Vec<u8>> {
    static FILES: OnceLock<BTreeMap<PathBuf, Vec<u8>>> = OnceLock::new();
    FILES.get_or_init(|| {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("case.yaml"), CASE).unwrap();
        fs::write(folder.path().join("scene.geo"), GEO).unwrap();
        for command in ["mesh", "seed", "solve"] {
            let output = mpm(folder.path(), &[command]);
            assert!(output.status.success(), "{command}: {}", text(&output.stderr));
        }
        let out = folder.path().join("out");
        let named = |(path, content): (PathBuf, _)| (path.strip_prefix(&out).unwrap().to_owned(), content);
        files(&out).into_iter().map(named).collect()
    })
}

fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path));
        } else {
            let content = fs::read(&path).unwrap();
            found.insert(path, content);
        }
    }
    found
}

fn truncate(file: &Path) {
    let content = fs::read(file).unwrap();
    fs::write(file, &content[..content.len() / 2]).unwrap();
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}
