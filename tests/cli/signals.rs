//! What people expect of a Unix program: pipes that close, `nohup`, Ctrl-C.

use crate::support::{PROGRAM, command, in_folder, python};
use std::collections::BTreeMap;
use std::fs;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Output, Stdio};
use std::time::{Duration, Instant};
use tempfile::TempDir;

const GEO: &str = r#"Point(1) = {0, 0, 0, 1}; Point(2) = {2, 0, 0, 1}; Point(3) = {2, 1, 0, 1}; Point(4) = {0, 1, 0, 1};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {4, 1};
Curve Loop(1) = {1:4}; Plane Surface(1) = {1};
Physical Surface("soil") = {1}; Physical Curve("bottom") = {1}; Physical Curve("top") = {3};
"#;

const CASE: &str = "\
title: Block
geometry: plane_strain
mesh: {geo: scene.geo, order: 2}
regions:
  soil: {kind: mpm, material: clay, points_per_cell: 4}
materials:
  clay: {model: tresca, young: 100, poisson: 0.3, shear_strength: 1, density: 1.8}
supports:
  bottom: {ux: 0, uy: 0}
phases:
  - name: load
    analysis: quasi_static
    duration: 1
    step: {initial: STEP, max: STEP}
    prescribe: {top: {uy: {table: [[0, 0], [1, -0.001]]}}}
output: {every: 0.5, fields: [stress]}
";

fn scene(statement: &str, step: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("case.yaml"), CASE.replace("STEP", step)).unwrap();
    fs::write(folder.path().join("scene.geo"), format!("{GEO}{statement}\n")).unwrap();
    folder
}

fn signal(name: &str, process: &Child) {
    // A shell has `kill` built in; the program of that name may be missing.
    let kill = format!("kill -{name} {}", process.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
}

/// Waits until `done`, for a minute at most.
fn until(what: &str, mut done: impl FnMut() -> bool) {
    let start = Instant::now();
    while !done() {
        assert!(start.elapsed() < Duration::from_secs(60), "{what}");
        std::thread::sleep(Duration::from_millis(5));
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

/// The processes with `command` among their arguments that work in `folder`.
fn workers(folder: &Path) -> usize {
    let here = folder.canonicalize().unwrap();
    let processes = fs::read_dir("/proc").unwrap().flatten().filter(|process| {
        let arguments = fs::read(process.path().join("cmdline")).unwrap_or_default();
        let place = fs::read_link(process.path().join("cwd")).unwrap_or_default();
        text(&arguments).contains("gmsh-worker") && place == here
    });
    processes.count()
}

#[test]
fn ctrl_c_while_gmsh_works_ends_both_and_leaves_nothing() {
    for name in ["INT", "TERM", "HUP"] {
        let scene = scene("Sleep 1000;", "0.5");
        let mut process = command(scene.path(), &["mesh", "."]).spawn().unwrap();
        until("Gmsh does not start", || workers(scene.path()) == 1);
        // The output folder of the process shows that it catches signals; a moment for the rest.
        std::thread::sleep(Duration::from_millis(200));
        signal(name, &process);
        assert_eq!(process.wait().unwrap().code(), Some(130), "{name}");
        until("Gmsh goes on", || workers(scene.path()) == 0);
        assert!(!scene.path().join("out").exists(), "{name}");
    }
}

#[test]
fn gmsh_ends_with_a_program_that_is_killed() {
    let scene = scene("Sleep 1000;", "0.5");
    let mut process = command(scene.path(), &["check", "."]).spawn().unwrap();
    until("Gmsh does not start", || workers(scene.path()) == 1);
    std::thread::sleep(Duration::from_millis(200));
    signal("KILL", &process);
    assert_eq!(process.wait().unwrap().signal(), Some(9));
    until("Gmsh goes on", || workers(scene.path()) == 0);
}

#[test]
fn a_reader_that_has_gone_stops_nothing() {
    let scene = scene("", "0.5");
    for stage in ["mesh", "run"] {
        let mut process = command(scene.path(), &[stage, "."]).spawn().unwrap();
        drop(process.stdout.take());
        let Output { status, stderr, .. } = process.wait_with_output().unwrap();
        assert!(status.success(), "{stage}: {status} {}", text(&stderr));
    }
    let again = in_folder(scene.path(), &["run", "."]);
    assert_eq!(text(&again.stdout).matches("nothing has changed").count(), 4, "{}", text(&again.stdout));
}

#[test]
fn nohup_goes_on_when_the_terminal_closes() {
    let scene = scene("", "0.002");
    for stage in ["mesh", "seed"] {
        assert!(command(scene.path(), &[stage, "."]).status().unwrap().success());
    }
    let script = "trap '' HUP; exec \"$0\" solve .";
    let mut process = Command::new("sh");
    process.args(["-c", script, PROGRAM]).current_dir(scene.path()).process_group(0);
    let mut process = process.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    let history = scene.path().join("out/history.csv");
    until("it does not solve", || {
        assert!(process.try_wait().unwrap().is_none(), "it ended before the signal");
        fs::read_to_string(&history).unwrap_or_default().lines().count() > 5
    });
    signal("HUP", &process);
    assert!(process.wait().unwrap().success());
    // Without nohup the same signal ends the run in an orderly way.
    fs::remove_dir_all(scene.path().join("out")).unwrap();
    for stage in ["mesh", "seed"] {
        assert!(command(scene.path(), &[stage, "."]).status().unwrap().success());
    }
    let mut process = command(scene.path(), &["solve", "."]).spawn().unwrap();
    until("it does not solve", || fs::read_to_string(&history).unwrap_or_default().lines().count() > 5);
    signal("HUP", &process);
    assert_eq!(process.wait().unwrap().code(), Some(130));
}

/// So many frames that their export takes longer than a signal to it.
const LONG: [&str; 3] = [".", "--set", "output.every=0.002"];

/// The numbers of the signals that end a program by themselves.
const SIGNALS: [(&str, i32); 2] = [("INT", 2), ("TERM", 15)];

/// Sends a signal while the frames are being written, and returns how the process ended.
fn interrupt_export(arguments: &[&str], folder: &Path, name: &str) -> ExitStatus {
    let frames = folder.join("out/.vtu-new");
    let _ = fs::remove_dir_all(&frames);
    let mut process = command(folder, arguments).stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    until("it does not export", || frames.exists() || process.try_wait().unwrap().is_some());
    // It may have come to its end by now.
    let _ = Command::new("sh").args(["-c", &format!("kill -{name} {} 2>/dev/null", process.id())]).status();
    process.wait().unwrap()
}

/// Tries until a signal came in time: on a busy machine it may come after the end. 20 times at most.
fn in_time(mut interrupted: impl FnMut() -> bool) {
    assert!((0..20).any(|_| interrupted()), "no signal came in time, or none did anything");
}

#[test]
fn ctrl_c_ends_an_export_and_leaves_the_earlier_one() {
    let scene = scene("", "0.002");
    assert!(in_folder(scene.path(), &[&["run"], &LONG[..]].concat()).status.success());
    let plain = [&["export"], &LONG[..], &["--set", "output.encoding=plain"]].concat();
    for (name, number) in SIGNALS {
        in_time(|| {
            let before = series(scene.path());
            let status = interrupt_export(&plain, scene.path(), name);
            assert!(status.success() || status.signal() == Some(number), "{name}: {status}");
            !status.success() && series(scene.path()) == before
        });
    }
    assert!(in_folder(scene.path(), &plain).status.success());
    assert!(!scene.path().join("out/.vtu-new").exists());
}

/// The solution before it catches signals; the export after it must not keep them.
#[test]
fn ctrl_c_ends_the_export_of_a_run() {
    let run = [&["run"], &LONG[..]].concat();
    for (name, _) in SIGNALS {
        let scene = scene("", "0.002");
        in_time(|| {
            // Only a process that has solved has caught signals before.
            let _ = fs::remove_dir_all(scene.path().join("out"));
            let status = interrupt_export(&run, scene.path(), name);
            assert!(status.success() || status.code() == Some(130), "{name}: {status}");
            !status.success()
        });
        let again = in_folder(scene.path(), &run);
        assert!(again.status.success() && text(&again.stdout).contains("solve: nothing has changed"), "{name}");
        assert_eq!(series(scene.path()).len(), 2 * 501 + 2, "{name}");
    }
}

/// The files of the series, with their bytes.
fn series(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let folders = [folder.join("out"), folder.join("out/vtu")].map(fs::read_dir);
    let paths = folders.into_iter().flatten().flatten().map(|entry| entry.unwrap().path());
    let is_of_series = |path: &PathBuf| {
        path.extension().is_some_and(|kind| kind == "pvd")
            || path.parent().is_some_and(|folder| folder.ends_with("vtu"))
    };
    paths.filter(is_of_series).map(|path| (path.clone(), fs::read(path).unwrap())).collect()
}

/// Progress is drawn where the terminal can, and told in lines where it cannot.
#[test]
fn a_terminal_that_can_draw_nothing_gets_plain_lines() {
    for (term, drawn) in [("xterm", true), ("dumb", false)] {
        let scene = scene("", "0.01");
        let script = "import os, pty, sys; sys.exit(os.waitstatus_to_exitcode(pty.spawn(sys.argv[1:])))";
        let mut process = python();
        process.args(["-c", script, PROGRAM, "run", "."]).current_dir(scene.path()).env("TERM", term);
        let Output { status, stdout, .. } = process.stdin(Stdio::null()).output().unwrap();
        let said = text(&stdout);
        assert!(status.success() && said.contains("solved in"), "{term}: {status} {said}");
        assert_eq!(said.contains('\u{1b}'), drawn, "{term}: {said:?}");
    }
}
