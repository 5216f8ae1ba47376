//! A sweep that is killed goes on where it was, and the same sweep by Snakemake comes to the same table.

use crate::cli::sweep::{rows, scene};
use crate::support::{PROGRAM, command, in_folder, project, succeeds};
use std::fs;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, Command};
use std::time::{Duration, Instant, SystemTime};

const AXES: [&str; 2] = ["materials.clay.young=100,200,300,400", "materials.clay.poisson=0.1,0.2,0.3"];
/// Steps enough that a run takes a tenth of a second or two.
const SET: &str = "phases.load.step={initial: 0.01, max: 0.01}";

fn sweep(folder: &str) -> [&str; 8] {
    ["sweep", "block", AXES[0], AXES[1], "--set", SET, "-o", folder]
}

/// The finished runs in the folder of a sweep, with the time of their histories.
fn finished(folder: &Path) -> Vec<(String, SystemTime)> {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    let record = |path: &Path| fs::read_to_string(path.join("provenance/solve.json")).unwrap_or_default();
    let mut found: Vec<_> = entries
        .filter(|entry| record(&entry.path()).contains("\"finished\": true"))
        .map(|entry| {
            let history = fs::metadata(entry.path().join("history.csv")).unwrap();
            (entry.file_name().into_string().unwrap(), history.modified().unwrap())
        })
        .collect();
    found.sort();
    found
}

/// Waits until two runs are finished, kills `process` with all it has started in its group, and returns the finished runs.
fn kill_in_the_middle(mut process: Child, folder: &Path) -> Vec<(String, SystemTime)> {
    let start = Instant::now();
    while finished(folder).len() < 2 {
        assert!(start.elapsed() < Duration::from_secs(120), "no run is finished");
        assert!(process.try_wait().unwrap().is_none(), "it ended before");
        std::thread::sleep(Duration::from_millis(5));
    }
    let kill = format!("kill -KILL -{}", process.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().unwrap().success());
    process.wait().unwrap();
    let done = finished(folder);
    assert!(done.len() < 12, "it was too late to kill it");
    done
}

#[test]
fn twelve_runs_killed_in_the_middle_go_on_to_the_same_table() {
    let scene = scene();
    succeeds(&in_folder(scene.path(), &sweep("whole")));
    let whole = rows(&scene.path().join("whole/table.csv"));
    assert_eq!((whole.len(), whole[1..].iter().filter(|row| row[3] == "finished").count()), (13, 12));

    let folder = scene.path().join("killed");
    let done = kill_in_the_middle(command(scene.path(), &sweep("killed")).process_group(0).spawn().unwrap(), &folder);
    succeeds(&in_folder(scene.path(), &sweep("killed")));
    assert_eq!(rows(&folder.join("table.csv")), whole);
    let after = finished(&folder);
    assert!(done.iter().all(|run| after.contains(run)), "a finished run was done again");

    let folder = scene.path().join("workflow");
    let snakemake = || {
        let mut command = Command::new(project(".venv/bin/python"));
        command
            .args(["-m", "snakemake", "--cores", "2", "--rerun-incomplete", "-s"])
            .arg(project("pipeline/sweep.smk"));
        command.args(["--config", "case=block", "folder=workflow"]).arg(format!("mpm={PROGRAM}"));
        command.arg(format!("axes=['{}', '{}']", AXES[0], AXES[1])).arg(format!("set=['{SET}']"));
        command.current_dir(scene.path()).env("XDG_CACHE_HOME", scene.path());
        command
    };
    let done = kill_in_the_middle(snakemake().process_group(0).spawn().unwrap(), &folder);
    succeeds(&snakemake().arg("--unlock").output().unwrap());
    succeeds(&snakemake().output().unwrap());
    assert_eq!(rows(&folder.join("table.csv")), whole);
    let after = finished(&folder);
    assert!(done.iter().all(|run| after.contains(run)), "a finished run was done again");
}
