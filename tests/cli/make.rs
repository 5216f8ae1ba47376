//! `pipeline/mpm.mk` in a project of its own, with a stand-in for the program that logs its calls: only stale
//! stages run, in order, also with `make -j`.

use std::fs::{self, File};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};
use std::thread::sleep;
use std::time::{Duration, SystemTime};

const PROGRAM: &str = r#"#!/bin/sh
echo "$@" >> log
mkdir -p "$2/out/vtu"
case $1 in
  mesh) echo > "$2/out/mesh.msh" ;;
  seed) echo > "$2/out/points.vtu" ;;
  solve) echo > "$2/out/history.csv"; [ ! -e fail ] ;;
  export) echo > "$2/out/points.pvd" ;;
esac
"#;

fn project() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    let rules = Path::new(env!("CARGO_MANIFEST_DIR")).join("pipeline/mpm.mk");
    let makefile = format!("MPM := ./program\nCASES := cases/slope sweep/b\ninclude {}\n", rules.display());
    fs::write(root.join("Makefile"), makefile).unwrap();
    fs::write(root.join("scene.geo"), "").unwrap();
    fs::write(root.join("program"), PROGRAM).unwrap();
    fs::set_permissions(root.join("program"), fs::Permissions::from_mode(0o755)).unwrap();
    for (case, mesh) in [
        ("cases/slope", "mesh:\n  geo: ../../scene.geo  # shared\n"),
        ("sweep/b", "mesh: {geo: \"b.geo\", order: 2}\n"),
    ] {
        fs::create_dir_all(root.join(case)).unwrap();
        fs::write(root.join(case).join("case.yaml"), mesh).unwrap();
    }
    fs::write(root.join("sweep/b/b.geo"), "").unwrap();
    folder
}

fn make(root: &Path, arguments: &[&str]) -> Output {
    // Not the flags of a make that runs these tests.
    let output = Command::new("make").args(arguments).current_dir(root).env_remove("MAKEFLAGS").output().unwrap();
    assert!(!String::from_utf8_lossy(&output.stderr).contains("warning"), "{output:?}");
    output
}

/// The program's calls since the last look.
fn calls(root: &Path) -> Vec<String> {
    let log = fs::read_to_string(root.join("log")).unwrap_or_default();
    let _ = fs::remove_file(root.join("log"));
    log.lines().map(str::to_owned).collect()
}

fn touch(path: &Path) {
    // Past the resolution of file times, so that the file is newer than every output.
    sleep(Duration::from_millis(20));
    File::options().write(true).open(path).unwrap().set_modified(SystemTime::now()).unwrap();
    // The clock that files get their times by runs some milliseconds late: outputs made at once would be older.
    sleep(Duration::from_millis(20));
}

const ALL: [&str; 4] = ["mesh cases/slope", "seed cases/slope", "solve cases/slope", "export cases/slope"];

#[test]
fn only_stale_stages_run() {
    let folder = project();
    let root = folder.path();
    assert!(make(root, &["slope"]).status.success());
    assert_eq!(calls(root), ALL);
    make(root, &["slope"]);
    assert!(calls(root).is_empty());
    for input in ["cases/slope/case.yaml", "scene.geo", "program"] {
        touch(&root.join(input));
        make(root, &["slope"]);
        assert_eq!(calls(root), ALL, "{input}");
    }
    touch(&root.join("cases/slope/out/points.vtu"));
    make(root, &["slope"]);
    assert_eq!(calls(root), ALL[2..]);
    touch(&root.join("sweep/b/b.geo"));
    make(root, &["slope"]);
    assert!(calls(root).is_empty());
    make(root, &["b-mesh"]);
    assert_eq!(calls(root), ["mesh sweep/b"]);
    make(root, &["slope-clean"]);
    assert!(!root.join("cases/slope/out").exists());
}

#[test]
fn a_solve_that_failed_is_taken_up_again() {
    let folder = project();
    let root = folder.path();
    fs::write(root.join("fail"), "").unwrap();
    assert!(!make(root, &["slope"]).status.success());
    assert_eq!(calls(root), ALL[..3]);
    fs::remove_file(root.join("fail")).unwrap();
    make(root, &["slope", "RESUME=1", "THREADS=2"]);
    assert_eq!(calls(root), ["solve cases/slope --resume --threads 2", "export cases/slope"]);
}

#[test]
fn parallel_make_keeps_the_order_of_each_case() {
    let folder = project();
    let root = folder.path();
    assert!(make(root, &["-j4", "slope", "b", "b-solve", "slope-mesh"]).status.success());
    let calls = calls(root);
    assert_eq!(calls.len(), 8, "{calls:?}");
    for case in ["cases/slope", "sweep/b"] {
        let stages: Vec<_> = calls.iter().filter_map(|c| c.strip_suffix(case)).map(str::trim).collect();
        assert_eq!(stages, ["mesh", "seed", "solve", "export"]);
    }
}
