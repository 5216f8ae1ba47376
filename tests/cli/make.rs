//! `pipeline/mpm.mk` in a project of its own: what is stale is done and no more, in order, also with `make -j`; and nothing
//! that stands in a case reaches `make` or the shell.

use crate::support::{PROGRAM, block, project, said};
use std::fs;
use std::os::unix::fs::PermissionsExt;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

/// A project with the cases `slope` and `b`, whose `.geo` they share, and the rules for a program.
fn scene(program: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let root = folder.path();
    let sound = block::scene("1", "0.5", "0.5");
    let case = fs::read_to_string(sound.path().join("case.yaml")).unwrap();
    fs::copy(sound.path().join("scene.geo"), root.join("scene.geo")).unwrap();
    for name in ["cases/slope", "sweep/b"] {
        fs::create_dir_all(root.join(name)).unwrap();
        fs::write(root.join(name).join("case.yaml"), case.replace("scene.geo", "../../scene.geo")).unwrap();
    }
    let rules = project("pipeline/mpm.mk");
    let makefile = format!("MPM := {program}\nCASES := cases/slope sweep/b\ninclude {}\n", rules.display());
    fs::write(root.join("Makefile"), makefile).unwrap();
    folder
}

fn make(root: &Path, arguments: &[&str]) -> Output {
    // Not the flags of a make that runs these tests.
    Command::new("make").args(arguments).current_dir(root).env_remove("MAKEFLAGS").output().unwrap()
}

/// The stages that were not skipped; each stage ends with a line of its own, that of a skipped one says so.
fn done(output: &Output) -> Vec<&'static str> {
    assert!(output.status.success(), "{}", said(output));
    assert!(!said(output).contains("warning: overriding"), "{}", said(output));
    let is_done = |stage: &&str| !said(output).contains(&format!("{stage}: nothing has changed"));
    ["mesh", "seed", "solve", "export"].into_iter().filter(is_done).collect()
}

#[test]
fn only_stale_stages_run() {
    let folder = scene(PROGRAM);
    let root = folder.path();
    assert_eq!(done(&make(root, &["slope"])), ["mesh", "seed", "solve", "export"]);
    assert!(done(&make(root, &["slope"])).is_empty());
    let edit = |name: &str, from: &str, to: &str| {
        let text = fs::read_to_string(root.join(name)).unwrap();
        assert!(text.contains(from), "{name}");
        fs::write(root.join(name), text.replace(from, to)).unwrap();
    };
    edit("cases/slope/case.yaml", "young: 1000", "young: 2000");
    assert_eq!(done(&make(root, &["slope"])), ["seed", "solve", "export"]);
    edit("cases/slope/case.yaml", "duration: 1", "duration: 0.5");
    assert_eq!(done(&make(root, &["slope-solve"])), ["solve", "export"], "and export is not asked for");
    assert_eq!(done(&make(root, &["slope"])), ["export"]);
    // The file that both share.
    edit("scene.geo", "{1, 2, 0, h}", "{1, 3, 0, h}");
    assert_eq!(done(&make(root, &["slope-mesh"])), ["mesh", "seed", "solve", "export"]);
    assert!(!root.join("sweep/b/out").exists());
    done(&make(root, &["b-mesh"]));
    assert!(root.join("sweep/b/out/mesh.msh").exists() && !root.join("sweep/b/out/points.vtu").exists());
    done(&make(root, &["slope-clean"]));
    assert!(!root.join("cases/slope/out").exists());
}

/// A stand-in for the program, that logs its calls.
const LOGS: &str = "#!/bin/sh\necho \"$@\" >> log\n[ ! -e fail ] || [ \"$4\" != solve ]\n";

fn logged() -> TempDir {
    let folder = scene("./program");
    fs::write(folder.path().join("program"), LOGS).unwrap();
    fs::set_permissions(folder.path().join("program"), fs::Permissions::from_mode(0o755)).unwrap();
    folder
}

/// The stages that were called for a case, with further flags.
fn calls(root: &Path, case: &str) -> Vec<String> {
    let log = fs::read_to_string(root.join("log")).unwrap();
    let start = format!("run {case} --until ");
    log.lines().filter_map(|call| call.strip_prefix(&start)).map(str::to_owned).collect()
}

#[test]
fn a_solve_that_failed_is_taken_up_again() {
    let folder = logged();
    let root = folder.path();
    fs::write(root.join("fail"), "").unwrap();
    assert!(!make(root, &["slope"]).status.success());
    assert_eq!(calls(root, "cases/slope"), ["mesh", "seed", "solve"]);
    fs::remove_file(root.join("fail")).unwrap();
    make(root, &["slope", "RESUME=1", "THREADS=2"]);
    assert_eq!(calls(root, "cases/slope")[3..], ["mesh", "seed", "solve --resume --threads 2", "export"]);
}

#[test]
fn parallel_make_keeps_the_order_of_each_case() {
    let folder = logged();
    let root = folder.path();
    assert!(make(root, &["-j4", "slope", "b", "b-solve", "slope-mesh"]).status.success());
    for case in ["cases/slope", "sweep/b"] {
        assert_eq!(calls(root, case), ["mesh", "seed", "solve", "export"]);
    }
}

#[test]
fn nothing_in_a_case_is_executed() {
    let folder = logged();
    let root = folder.path();
    fs::write(root.join("Makefile"), format!("MPM := ./program\ninclude {}\n", project("pipeline/mpm.mk").display()))
        .unwrap();
    fs::write(root.join("cases/slope/case.yaml"), "# geo: $(shell touch made-by-text)\nmesh: {geo: '`touch made`'}\n")
        .unwrap();
    let names = [
        "$(shell touch made-by-name)",
        "a;touch made-by-name",
        "a`touch made-by-name`",
        "a'touch made-by-name'",
        "a:slope=$(shell touch made-by-name)",
        "x=made",
        "a#b",
        "%",
        "a&touch made-by-name",
    ];
    for name in names {
        fs::create_dir(root.join("cases").join(name)).unwrap();
        fs::write(root.join("cases").join(name).join("case.yaml"), "").unwrap();
    }
    for arguments in [&["-n", "slope"][..], &["slope"], &["slope-clean"], &["-n", "made-by-name"]] {
        let said = said(&make(root, arguments));
        assert!(said.contains("are left out"), "{said}");
    }
    assert_eq!(calls(root, "cases/slope"), ["mesh", "seed", "solve", "export"]);
    let mut there: Vec<_> = fs::read_dir(root).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    there.sort();
    assert_eq!(there, ["Makefile", "cases", "log", "program", "scene.geo", "sweep"]);
}
