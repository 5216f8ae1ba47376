//! A process that is killed at any moment leaves files from which the run goes on as if nothing had happened.
//!
//! The test starts itself again as the process to be killed, which writes a history row, a frame and a
//! checkpoint for each of many steps, in the way a run does.

use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Duration;

use mpm::io::background::Background;
use mpm::io::checkpoint::{Checkpoints, Fingerprint};
use mpm::io::frame::{self, Frame, Part};
use mpm::io::history::{History, Mark};
use mpm::io::provenance::Origin;

const FOLDER: &str = "MPM_TEST_KILL_FOLDER";
const STEPS: u64 = 200;

fn checkpoints(folder: &Path) -> Checkpoints {
    Checkpoints::new(folder.join("checkpoints"), Fingerprint::of(&[b"case"]))
}

/// A state that depends on all steps before: a chaotic map, so that one lost bit shows.
fn advance(state: &mut [f64]) {
    state.iter_mut().for_each(|x| *x = 3.9 * *x * (1.0 - *x));
}

/// The run: continues from the newest checkpoint, if there is one.
fn run(folder: &Path) {
    let columns = ["time [s]".to_string(), "x [m]".to_string()];
    let checkpoints = checkpoints(folder);
    let background = Background::start(2).unwrap();
    let (mut step, mut state, mut history) = match checkpoints.latest().unwrap() {
        Some(mut loaded) => {
            assert!(loaded.warnings.is_empty(), "{:?}", loaded.warnings);
            let [lines, hash] = loaded.store.take::<u64>("history", 2).unwrap()[..] else { panic!("no mark") };
            let mark = Mark { lines, hash };
            let history = History::resume(&folder.join("history.csv"), &columns, mark).unwrap();
            (loaded.step, loaded.store.take::<f64>("state", 1).unwrap(), history)
        }
        None => {
            frame::prepare(&folder.join("results"), 0).unwrap();
            let state = (1..2000).map(|i| f64::from(i) / 2000.0).collect();
            (0, state, History::create(&folder.join("history.csv"), &columns).unwrap())
        }
    };
    while step < STEPS {
        step += 1;
        advance(&mut state);
        let time = step as f64 * 0.1;
        history.row(&[time, state[7]].map(Some)).unwrap();
        if step.is_multiple_of(5) {
            let points = Part { position: state.iter().map(|&x| [x, 0.0, 0.0]).collect(), columns: Vec::new() };
            let frame = Frame {
                time,
                phase: "push".to_string(),
                step,
                origin: Origin::default(),
                points,
                grid: Part::default(),
                elements: Part::default(),
                contact: Part::default(),
                surface: Part::default(),
            };
            let results = folder.join("results");
            background.submit(move || frame.write(&results, step as usize / 5 - 1).map(drop)).unwrap();
        }
        let mut store = Checkpoints::store();
        store.put("state", 1, state.clone());
        let Mark { lines, hash } = history.mark();
        store.put("history", 2, vec![lines, hash]);
        let checkpoints = checkpoints.clone();
        background.submit(move || checkpoints.save(step, store)).unwrap();
    }
    background.close().unwrap();
}

/// Not a test of its own: the process that [`kill_9_at_any_moment_loses_nothing`] kills.
#[test]
fn process_to_be_killed() {
    if let Some(folder) = std::env::var_os(FOLDER) {
        run(Path::new(&folder));
    }
}

/// The newest step that has a checkpoint, by the names of the files.
fn newest(folder: &Path) -> u64 {
    let Ok(entries) = std::fs::read_dir(folder.join("checkpoints")) else { return 0 };
    let step = |name: &str| name.strip_prefix("step-")?.strip_suffix(".mpmc")?.parse().ok();
    entries.filter_map(|e| step(e.unwrap().file_name().to_str()?)).max().unwrap_or(0)
}

fn contents(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut files = Vec::new();
    for part in [folder.to_path_buf(), folder.join("results")] {
        for entry in std::fs::read_dir(part).unwrap() {
            let path = entry.unwrap().path();
            if path.is_file() {
                let name = path.file_name().unwrap().to_string_lossy().into_owned();
                // What a killed process leaves is removed with the next fresh run.
                if !name.starts_with('.') {
                    files.push((name, std::fs::read(&path).unwrap()));
                }
            }
        }
    }
    files.sort();
    files
}

#[test]
fn kill_9_at_any_moment_loses_nothing() {
    let (undisturbed, killed) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    run(undisturbed.path());
    let mut reached = 0;
    for attempt in 0..10 {
        let mut child = Command::new(std::env::current_exe().unwrap())
            .args(["--exact", "io::kill::process_to_be_killed"])
            .env(FOLDER, killed.path())
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        // Some way on in the first half of the run, at whatever it is doing then.
        let target = attempt * STEPS / 20 + 3;
        while newest(killed.path()) < target {
            assert!(child.try_wait().unwrap().is_none(), "the run ended by itself");
            std::thread::sleep(Duration::from_micros(170 * attempt + 50));
        }
        child.kill().unwrap();
        child.wait().unwrap();
        let loaded = checkpoints(killed.path()).latest().unwrap().unwrap();
        assert!(loaded.step >= target.max(reached), "step {} after {reached}", loaded.step);
        reached = loaded.step;
    }
    run(killed.path());
    assert_eq!(frame::list(&killed.path().join("results")).unwrap().len() as u64, STEPS / 5);
    assert!(contents(undisturbed.path()) == contents(killed.path()), "the files differ");
    assert!(reached < STEPS, "killed too late");
}
