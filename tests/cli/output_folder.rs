//! The output folder: results outlive a run that fails beside them, one process at a time works there, every file knows
//! what it was made from, and what does not belong together is refused.

use crate::support::{PROGRAM, block, command, in_folder, said};
use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output};
use std::sync::OnceLock;
use std::time::Duration;
use tempfile::TempDir;

/// Arguments with which no step converges.
const FAILING: [&str; 4] = ["--set", "numerics.max_iterations=1", "--set", "phases.load.step={initial: 1, min: 1}"];
/// Arguments of a run long enough to be killed.
const LONG: [&str; 2] = ["--set", "phases.load.step={initial: 0.001, max: 0.001}"];

const RUN: [&str; 6] = ["results", "checkpoints", "history.csv", "energy.csv", "solve.log", "provenance/solve.json"];

/// A folder with the case and all of its stages done.
fn done() -> TempDir {
    static FILES: OnceLock<BTreeMap<PathBuf, Vec<u8>>> = OnceLock::new();
    let files = FILES.get_or_init(|| {
        let folder = scene();
        says(&in_folder(folder.path(), &["run", "."]), 0, &[]);
        all(folder.path(), "")
    });
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, bytes).unwrap();
    }
    folder
}

fn scene() -> TempDir {
    block::scene("1", "0.25", "0.25")
}

/// What the program said, after a check of its exit status and of parts of that.
fn says(output: &Output, status: i32, parts: &[&str]) -> String {
    let said = said(output);
    assert_eq!(output.status.code(), Some(status), "{said}");
    for part in parts {
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
    said
}

/// The files below a part of a folder, with their bytes.
fn all(folder: &Path, part: &str) -> BTreeMap<PathBuf, Vec<u8>> {
    let (mut files, mut open) = (BTreeMap::new(), vec![folder.join(part)]);
    while let Some(path) = open.pop() {
        if path.is_dir() {
            open.extend(fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
        } else if path.is_file() {
            files.insert(path.strip_prefix(folder).unwrap().to_owned(), fs::read(&path).unwrap());
        }
    }
    files
}

/// The files of the run in the output folder.
fn run_files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    RUN.iter().flat_map(|part| all(folder, &format!("out/{part}"))).collect()
}

/// Those that the same inputs give again to the bit: all but the record, which has times.
fn results(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    RUN[..4].iter().flat_map(|part| all(folder, &format!("out/{part}"))).collect()
}

fn copy(from: &Path, to: &Path) {
    fs::copy(from, to).unwrap();
}

/// Starts a run and waits for `rows` rows in the `history`.
fn start(folder: &Path, arguments: &[&str], history: &str, rows: usize) -> Child {
    let history = folder.join(history);
    let _ = fs::remove_file(&history);
    let mut child = command(folder, arguments).spawn().unwrap();
    while fs::read_to_string(&history).unwrap_or_default().lines().count() <= rows {
        assert!(child.try_wait().unwrap().is_none(), "it ended by itself");
        std::thread::sleep(Duration::from_millis(1));
    }
    child
}

fn kill(mut child: Child) {
    child.kill().unwrap();
    child.wait().unwrap();
}

#[test]
fn a_solve_that_fails_leaves_the_earlier_results() {
    let scene = done();
    let before = run_files(scene.path());
    let said = says(
        &in_folder(scene.path(), &[&["solve", "."], &FAILING[..]].concat()),
        1,
        &["the earlier results are as they were"],
    );
    assert!(said.contains("unfinished"), "{said}");
    assert_eq!(run_files(scene.path()), before);
    assert!(scene.path().join("out/unfinished/solve.log").exists(), "its log says why");
    says(&in_folder(scene.path(), &["export", "."]), 0, &["5 frames\n", "--unfinished"]);
    says(
        &in_folder(scene.path(), &["export", ".", "--unfinished"]),
        0,
        &["1 frames of a run that is not finished, up to t = 0 s: "],
    );
    says(&in_folder(scene.path(), &["run", "."]), 0, &["solve: nothing has changed"]);
}

/// `mpm run` exports what an analysis came to that could not go on: beside earlier results into a folder of its own.
#[test]
fn a_run_that_fails_is_exported_as_far_as_it_came() {
    let exported = "1 frames of a run that is not finished, up to t = 0 s: ";
    let failing = [&["run", "."], &FAILING[..]].concat();
    let first = scene();
    let said = says(&in_folder(first.path(), &failing), 1, &[&format!("out/points.pvd: {exported}"), "error: Newton"]);
    assert!(said.find(exported) < said.find("error: Newton"), "{said}");
    assert!(first.path().join("out/points.pvd").exists());

    let scene = done();
    let series = || [all(scene.path(), "out/vtu"), all(scene.path(), "out/points.pvd")];
    let before = (run_files(scene.path()), series());
    says(&in_folder(scene.path(), &failing), 1, &[&format!("out/unfinished/points.pvd: {exported}")]);
    assert!(scene.path().join("out/unfinished/points.pvd").exists());
    assert!((run_files(scene.path()), series()) == before);
    says(&in_folder(scene.path(), &["run", "."]), 0, &["solve: nothing has changed", "export: nothing has changed"]);
}

#[test]
fn points_of_other_entries_of_the_case_are_refused_and_no_result_is_touched() {
    let scene = done();
    let before = run_files(scene.path());
    let solve = in_folder(scene.path(), &["solve", ".", "--set", "materials.rock.young=1e15"]);
    says(&solve, 2, &["points.vtu", "other entries of the case", "mpm seed"]);
    assert_eq!(run_files(scene.path()), before);
}

#[test]
fn a_full_disk_leaves_the_earlier_results() {
    let scene = done();
    let before = run_files(scene.path());
    let script = format!("trap '' XFSZ; ulimit -f 2; exec '{PROGRAM}' solve . {} '{}'", LONG[0], LONG[1]);
    let output = Command::new("sh").args(["-c", &script]).current_dir(scene.path()).output().unwrap();
    says(&output, 3, &["cannot be written"]);
    assert_eq!(run_files(scene.path()), before);
}

#[test]
fn a_run_that_is_killed_beside_results_is_continued_and_takes_their_place() {
    let whole = scene();
    says(&in_folder(whole.path(), &[&["run", "."], &LONG[..]].concat()), 0, &[]);
    let scene = done();
    let before = run_files(scene.path());
    kill(start(scene.path(), &[&["run", "."], &LONG[..]].concat(), "out/unfinished/history.csv", 20));
    assert_eq!(run_files(scene.path()), before, "the results stay until there are better ones");
    let unfinished = ["can be continued", "--resume", "--fresh"];
    for verb in ["run", "solve"] {
        says(&in_folder(scene.path(), &[&[verb, "."], &LONG[..]].concat()), 2, &unfinished);
    }
    says(&in_folder(scene.path(), &[&["run", ".", "--resume"], &LONG[..]].concat()), 0, &[]);
    assert!(results(scene.path()) == results(whole.path()), "not the results of an undisturbed run");
    assert!(!scene.path().join("out/unfinished").exists());
}

#[test]
fn a_first_run_that_is_stopped_is_not_thrown_away_but_by_request() {
    let scene = scene();
    says(&in_folder(scene.path(), &["mesh", "."]), 0, &[]);
    says(&in_folder(scene.path(), &["seed", "."]), 0, &[]);
    let solve = [&["solve", "."], &LONG[..]].concat();
    kill(start(scene.path(), &solve, "out/history.csv", 5));
    let before = results(scene.path());
    says(&in_folder(scene.path(), &solve), 2, &["can be continued", "--fresh"]);
    assert_eq!(results(scene.path()), before);
    says(&in_folder(scene.path(), &["export", "."]), 0, &["of a run that is not finished"]);
    // Another case cannot continue it, and takes its place when it has something to show.
    says(&in_folder(scene.path(), &["solve", ".", "--set", "phases.load.duration=0.5"]), 0, &[]);
    kill(start(scene.path(), &solve, "out/unfinished/history.csv", 5));
    says(&in_folder(scene.path(), &[&solve[..], &["--fresh"]].concat()), 0, &[]);
    assert!(!scene.path().join("out/unfinished").exists());
    says(&in_folder(scene.path(), &[&solve[..], &["--fresh", "--resume"]].concat()), 2, &["--resume"]);
    says(&in_folder(scene.path(), &[&solve[..], &["--resume"]].concat()), 0, &["is finished"]);
}

#[test]
fn what_a_run_wrote_before_is_not_continued_when_it_was_changed() {
    let scene = scene();
    says(&in_folder(scene.path(), &["mesh", "."]), 0, &[]);
    says(&in_folder(scene.path(), &["seed", "."]), 0, &[]);
    let solve = ["solve", ".", LONG[0], LONG[1], "--set", "output.every=0.005"];
    kill(start(scene.path(), &solve, "out/history.csv", 40));
    let resume = [&solve[..], &["--resume"]].concat();
    type Damage = (&'static str, fn(&mut Vec<u8>));
    let damages: [Damage; 4] = [
        ("history.csv", |bytes| bytes[30] = b'7'),
        ("solve.log", |bytes| bytes[10] ^= 1),
        ("results/frame-000001.mpmf", |bytes| bytes.truncate(100)),
        ("results/frame-000002.mpmf", |bytes| *bytes.last_mut().unwrap() ^= 1),
    ];
    for (name, damage) in damages {
        let path = scene.path().join("out").join(name);
        let whole = fs::read(&path).unwrap();
        let mut bytes = whole.clone();
        damage(&mut bytes);
        fs::write(&path, &bytes).unwrap();
        says(&in_folder(scene.path(), &resume), 2, &[name, "changed after", "--fresh"]);
        assert_eq!(fs::read(&path).unwrap(), bytes, "a file that is refused stays");
        fs::write(&path, whole).unwrap();
    }
    let lost = scene.path().join("out/results/frame-000003.mpmf");
    let whole = fs::read(&lost).unwrap();
    fs::remove_file(&lost).unwrap();
    says(&in_folder(scene.path(), &resume), 2, &["frame-000003.mpmf"]);
    fs::write(&lost, whole).unwrap();
    says(&in_folder(scene.path(), &resume), 0, &[]);
}

#[test]
fn what_does_not_belong_together_is_refused_with_the_stage_to_run() {
    let scene = done();
    let fine = ["--set", "mesh.parameters.h=0.5"];
    says(&in_folder(scene.path(), &[&["mesh", "."], &fine[..]].concat()), 0, &[]);
    says(
        &in_folder(scene.path(), &[&["solve", "."], &fine[..]].concat()),
        2,
        &["points.vtu", "another mesh.msh", "mpm seed"],
    );
    says(
        &in_folder(scene.path(), &[&["export", "."], &fine[..]].concat()),
        2,
        &["frame-000000", "another mesh.msh", "mpm solve"],
    );
    says(&in_folder(scene.path(), &[&["seed", "."], &fine[..]].concat()), 0, &[]);
    says(&in_folder(scene.path(), &[&["export", "."], &fine[..]].concat()), 2, &["mpm solve"]);
    says(&in_folder(scene.path(), &[&["solve", "."], &fine[..]].concat()), 0, &[]);
    says(&in_folder(scene.path(), &[&["export", "."], &fine[..]].concat()), 0, &[]);
}

#[test]
fn a_frame_that_was_copied_lost_or_taken_from_another_run_is_noticed() {
    let other = scene();
    says(&in_folder(other.path(), &["run", ".", "--set", "materials.rock.young=200"]), 0, &[]);
    let name = |i: usize| format!("out/results/frame-{i:06}.mpmf");
    let changes: [&dyn Fn(&Path); 4] = [
        &|d| copy(&d.join(name(4)), &d.join(name(5))),
        &|d| fs::remove_file(d.join(name(4))).unwrap(),
        &|d| copy(&d.join(name(3)), &d.join(name(4))),
        &|d| copy(&other.path().join(name(2)), &d.join(name(2))),
    ];
    for (number, change) in changes.iter().enumerate() {
        let scene = done();
        let before = results(scene.path());
        change(scene.path());
        says(&in_folder(scene.path(), &["export", "."]), 2, &["frame-00000", "mpm solve"]);
        let said = says(&in_folder(scene.path(), &["run", "."]), 0, &["seed: nothing has changed"]);
        assert!(!said.contains("solve: nothing has changed"), "change {number}: {said}");
        assert!(results(scene.path()) == before, "change {number}");
    }
}

#[test]
fn results_of_another_program_are_made_again() {
    let scene = done();
    for stage in ["mesh", "seed", "solve", "export"] {
        let path = scene.path().join(format!("out/provenance/{stage}.json"));
        let mut record: serde_json::Value = serde_json::from_slice(&fs::read(&path).unwrap()).unwrap();
        assert_eq!(record["program"]["version"], env!("CARGO_PKG_VERSION"));
        // What the hash of the inputs would be with other sources.
        record["inputs"] = "0123456789abcdef".into();
        fs::write(&path, record.to_string()).unwrap();
        let said = says(&in_folder(scene.path(), &["run", "."]), 0, &[]);
        assert!(!said.contains(&format!("{stage}: nothing has changed")), "{said}");
    }
}

#[test]
fn of_two_processes_in_a_folder_one_works_and_the_other_names_it() {
    let scene = done();
    let long = [&["run", "."], &LONG[..]].concat();
    let child = start(scene.path(), &long, "out/unfinished/history.csv", 3);
    let other: [&[&str]; 6] =
        [&long, &["mesh", "."], &["seed", "."], &["solve", ".", "--resume"], &["export", "."], &["run", "."]];
    for arguments in other {
        let process = format!("process {}", child.id());
        says(&in_folder(scene.path(), arguments), 3, &[&process, "is at work in this folder", "-o"]);
    }
    says(&in_folder(scene.path(), &["check", "."]), 0, &[]);
    kill(child);
    says(&in_folder(scene.path(), &["run", ".", "--set", "output.encoding=plain"]), 0, &[]);
}

#[test]
fn pairs_that_start_together_leave_one_whole_run() {
    let whole = scene();
    says(&in_folder(whole.path(), &["run", "."]), 0, &[]);
    for _ in 0..10 {
        let scene = scene();
        let pair = [(); 2].map(|()| command(scene.path(), &["run", "."]).spawn().unwrap());
        let ended = pair.map(|child| child.wait_with_output().unwrap());
        let done = ended.iter().filter(|output| output.status.success()).count();
        assert!(done >= 1, "{ended:?}");
        for output in ended.iter().filter(|output| !output.status.success()) {
            says(output, 3, &["is at work in this folder"]);
        }
        assert!(results(scene.path()) == results(whole.path()));
        says(&in_folder(scene.path(), &["run", "."]), 0, &["export: nothing has changed"]);
    }
}

#[test]
fn links_in_the_output_folder_are_refused_and_their_targets_untouched() {
    for name in ["history.csv", "solve.log", "results", "checkpoints", "unfinished", "vtu"] {
        let scene = scene();
        let elsewhere = tempfile::tempdir().unwrap();
        let target = elsewhere.path().join("precious");
        fs::create_dir(scene.path().join("out")).unwrap();
        if name.contains('.') {
            fs::write(&target, "kept").unwrap();
        } else {
            fs::create_dir(&target).unwrap();
            fs::write(target.join("frame-000000.mpmf"), "kept").unwrap();
        }
        let before = all(elsewhere.path(), "");
        symlink(&target, scene.path().join("out").join(name)).unwrap();
        says(&in_folder(scene.path(), &["run", "."]), 2, &[name, "symbolic link"]);
        assert_eq!(all(elsewhere.path(), ""), before, "{name}");
    }
}

#[test]
fn info_tells_what_every_file_was_made_from() {
    let scene = done();
    let identity = says(&in_folder(scene.path(), &["--version"]), 0, &["commit", "sources"]);
    let identity = identity.trim().strip_prefix("mpm ").unwrap();
    let files = [
        "points.vtu",
        "results/frame-000002.mpmf",
        "checkpoints/step-000000004.mpmc",
        "vtu/points_000001.vtu",
        "grid.pvd",
    ];
    for file in files {
        says(&in_folder(scene.path(), &["info", &format!("out/{file}")]), 0, &[identity]);
    }
    for (file, stage) in [
        ("mesh.msh", "mesh"),
        ("points.vtu", "seed"),
        ("results/frame-000002.mpmf", "solve"),
        ("history.csv", "solve"),
        ("solve.log", "solve"),
        ("vtu/points_000001.vtu", "export"),
    ] {
        let parts = [stage, "as the stage left it", "commit", "Gmsh", "command", "run .", "started", "scene.geo"];
        let count = if stage == "mesh" { parts.len() } else { parts.len() - 1 };
        says(&in_folder(scene.path(), &["info", &format!("out/{file}")]), 0, &parts[..count]);
    }
    fs::write(scene.path().join("out/history.csv"), "time [s]\n").unwrap();
    says(&in_folder(scene.path(), &["info", "out/history.csv"]), 0, &["changed since"]);
    for folder in [".", "out"] {
        says(
            &in_folder(scene.path(), &["info", folder]),
            0,
            &["mesh, finished", "seed, finished", "solve, finished", "export, finished"],
        );
    }
    says(&in_folder(scene.path(), &["info", "scene.geo"]), 2, &["not written by mpm"]);
    says(&in_folder(scene.path(), &["info", "nowhere"]), 2, &["no such file"]);
}

#[test]
fn results_whose_checkpoints_were_removed_are_not_lost() {
    let scene = done();
    fs::remove_dir_all(scene.path().join("out/checkpoints")).unwrap();
    let before = run_files(scene.path());
    says(
        &in_folder(scene.path(), &[&["solve", "."], &FAILING[..]].concat()),
        1,
        &["the earlier results are as they were"],
    );
    assert_eq!(run_files(scene.path()), before);
    says(&in_folder(scene.path(), &["export", "."]), 0, &["5 frames\n"]);
    says(&in_folder(scene.path(), &["solve", ".", "--resume"]), 0, &["no checkpoint", "afresh"]);
}
