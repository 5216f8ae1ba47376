//! Disturbed processes: kills, signals and full disks in every stage, and pairs of processes in one folder. What follows
//! gives the same bytes as an undisturbed run, or the earlier results are as they were. And hostile folders: links, pipes and devices in
//! place of files and folders, and files of others, none of which is read without end, changed or lost.
//!
//! The tests disturb a few; `make campaign` disturbs as many as `CAMPAIGN` times that.

use crate::support::{PROGRAM, Random, block, command, in_folder, said, succeeds};
use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;
use std::time::{Duration, Instant};
use tempfile::TempDir;

/// The case that left results before.
const EARLIER: [&str; 2] = ["--set", "phases.load.duration=0.5"];

const STAGES: [&str; 4] = ["mesh", "seed", "solve", "export"];

/// How many times the few of a test.
fn times() -> u64 {
    std::env::var("CAMPAIGN").ok().and_then(|times| times.parse().ok()).unwrap_or(1)
}

type Files = BTreeMap<PathBuf, Vec<u8>>;

/// The files of an output folder that the same inputs give again to the bit, and how long each stage takes.
struct Whole {
    files: Files,
    earlier: Files,
    seconds: [f64; 4],
}

fn whole() -> &'static Whole {
    static WHOLE: OnceLock<Whole> = OnceLock::new();
    WHOLE.get_or_init(|| {
        let earlier = scene();
        succeeds(&in_folder(earlier.path(), &[&["run", "."], &EARLIER[..]].concat()));
        let whole = scene();
        let seconds = STAGES.map(|stage| {
            let start = Instant::now();
            succeeds(&in_folder(whole.path(), &[stage, "."]));
            start.elapsed().as_secs_f64()
        });
        Whole { files: files(whole.path()), earlier: files(earlier.path()), seconds }
    })
}

fn scene() -> TempDir {
    block::scene("0.25", "0.005", "0.05")
}

/// All files below the output folder but the records, which have times, and what is hidden or beside the results.
fn files(folder: &Path) -> Files {
    let (mut files, mut open) = (Files::new(), vec![folder.join("out")]);
    while let Some(path) = open.pop() {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        if name.starts_with('.') || name == "provenance" || name == "unfinished" {
            continue;
        }
        if !path.exists() {
            continue;
        }
        if path.is_dir() {
            open.extend(fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
        } else {
            files.insert(path.strip_prefix(folder).unwrap().to_owned(), fs::read(&path).unwrap());
        }
    }
    files
}

fn same(found: &Files, expected: &Files, what: &str) {
    let names = |files: &Files| files.keys().cloned().collect::<Vec<_>>();
    assert_eq!(names(found), names(expected), "{what}");
    for (name, bytes) in found {
        assert!(expected[name] == *bytes, "{what}: {} differs", name.display());
    }
}

/// A folder in which the stages before number `stage` are done, with the results of another run in every second.
fn prepared(stage: usize, with_earlier: bool) -> TempDir {
    let folder = scene();
    if with_earlier {
        succeeds(&in_folder(folder.path(), &[&["run", "."], &EARLIER[..]].concat()));
    }
    for stage in &STAGES[..stage] {
        succeeds(&in_folder(folder.path(), &[stage, "."]));
    }
    folder
}

/// After a disturbance: results are the earlier ones or new ones, and the next run gives what an undisturbed one gives.
fn recovers(folder: &Path, stage: usize, with_earlier: bool, what: &str) {
    if with_earlier && stage == 2 {
        let run = |files: &Files| {
            let of_run = |name: &PathBuf| {
                ["results", "history", "solve.log"]
                    .iter()
                    .any(|p| name.starts_with("out") && name.to_string_lossy().contains(p))
            };
            files
                .iter()
                .filter(|(name, _)| of_run(name))
                .map(|(name, bytes)| (name.clone(), bytes.clone()))
                .collect::<Files>()
        };
        let found = run(&files(folder));
        if found != run(&whole().files) {
            same(&found, &run(&whole().earlier), what);
        }
    }
    let mut again = in_folder(folder, &["run", "."]);
    if again.status.code() == Some(2) && said(&again).contains("can be continued") {
        again = in_folder(folder, &["run", ".", "--resume"]);
    }
    assert!(again.status.success(), "{what}: {}: {}", again.status, said(&again));
    same(&files(folder), &whole().files, what);
    let skipped = in_folder(folder, &["run", "."]);
    succeeds(&skipped);
    for stage in STAGES {
        assert!(said(&skipped).contains(&format!("{stage}: nothing has changed")), "{what}: {}", said(&skipped));
    }
}

/// Sends a signal to a stage at some moment.
fn disturb(signal: &str, count: u64, seed: u64) {
    let mut random = Random(seed);
    for number in 0..count {
        let (stage, with_earlier) = (number as usize % 4, number / 4 % 2 == 1);
        let folder = prepared(stage, with_earlier);
        let mut child = command(folder.path(), &[STAGES[stage], "."]).spawn().unwrap();
        let after = whole().seconds[stage] * random.below(1000) as f64 / 1000.0;
        std::thread::sleep(Duration::from_secs_f64(after));
        // A shell has `kill` built in; the process may have ended by itself.
        let _ = Command::new("sh").args(["-c", &format!("kill -{signal} {} 2>/dev/null", child.id())]).status();
        let deadline = Instant::now() + Duration::from_secs(60);
        while child.try_wait().unwrap().is_none() {
            assert!(Instant::now() < deadline, "SIG{signal} does not end `mpm {}`", STAGES[stage]);
            std::thread::sleep(Duration::from_millis(5));
        }
        recovers(
            folder.path(),
            stage,
            with_earlier,
            &format!("SIG{signal} number {number} after {after} s of {}", STAGES[stage]),
        );
    }
}

#[test]
fn disks_that_fill_in_all_stages_lose_nothing() {
    let mut random = Random(5);
    for number in 0..4 * times() {
        let (stage, with_earlier) = (number as usize % 4, number / 4 % 2 == 1);
        let folder = prepared(stage, with_earlier);
        let before = files(folder.path());
        // No file may grow beyond so many blocks of 512 bytes: writing fails as on a full disk.
        let blocks = random.below(12);
        let script = format!("trap '' XFSZ; ulimit -f {blocks}; exec '{PROGRAM}' {} .", STAGES[stage]);
        let output = Command::new("sh").args(["-c", &script]).current_dir(folder.path()).output().unwrap();
        let what = format!("{blocks} blocks for {}, {}: {}", STAGES[stage], output.status, said(&output));
        assert!(output.status.success() || output.status.code() == Some(3), "{what}");
        if !output.status.success() && stage != 2 {
            same(&files(folder.path()), &before, &what);
        }
        recovers(folder.path(), stage, with_earlier, &what);
    }
}

/// All that there is below a folder, links not followed: what each entry is, with the bytes of files.
fn census(folder: &Path) -> BTreeMap<PathBuf, (String, Vec<u8>)> {
    let (mut found, mut open) = (BTreeMap::new(), vec![folder.to_owned()]);
    while let Some(path) = open.pop() {
        let kind = fs::symlink_metadata(&path).unwrap().file_type();
        if kind.is_dir() {
            open.extend(fs::read_dir(&path).unwrap().map(|entry| entry.unwrap().path()));
        }
        let bytes = if kind.is_file() { fs::read(&path).unwrap() } else { Vec::new() };
        found.insert(path.strip_prefix(folder).unwrap().to_owned(), (format!("{kind:?}"), bytes));
    }
    found
}

/// Runs a command to its end, which it reaches by itself with the memory that the case needs; its exit status and what it said.
fn ends(folder: &Path, arguments: &[&str]) -> (Option<i32>, String) {
    let script = "ulimit -v 4000000; exec timeout 60 \"$0\" \"$@\"";
    let mut limited = Command::new("sh");
    limited.args(["-c", script, PROGRAM]).args(arguments).current_dir(folder).env("RAYON_NUM_THREADS", "1");
    let output = limited.output().unwrap();
    (output.status.code(), said(&output))
}

/// The commands that read or write an output folder.
const VERBS: [&[&str]; 9] = [
    &["run", "."],
    &["mesh", "."],
    &["seed", "."],
    &["solve", "."],
    &["solve", ".", "--resume"],
    &["export", "."],
    &["report", "."],
    &["info", "."],
    &["plot", ".", "--field", "stress.yy"],
];

/// A link out of the folder, a device or a pipe takes the place of something in a folder that has been run.
fn hostile(count: u64, seed: u64) {
    let folder = block::scene("1", "0.5", "0.5");
    succeeds(&in_folder(folder.path(), &["run", "."]));
    let sound = census(folder.path());
    let hidden = [".exchange", ".replaced", ".vtu-new", ".vtu-old", "unfinished", "unfinished/results", "report.html"];
    let places: Vec<PathBuf> = sound.keys().filter(|path| path.starts_with("out")).cloned().collect();
    let places: Vec<PathBuf> = places.into_iter().chain(hidden.map(|name| Path::new("out").join(name))).collect();
    let mut random = Random(seed);
    for number in 0..count {
        let (case, home) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
        for (path, (kind, bytes)) in &sound {
            let path = case.path().join(path);
            if kind.contains("is_dir: true") {
                fs::create_dir_all(path).unwrap()
            } else {
                fs::write(path, bytes).unwrap()
            }
        }
        for name in ["frame-000000.mpmf", "frame-000009.mpmf", "points_000000.vtu", "solve.json", "results/thesis.csv"]
        {
            let path = home.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, "years of work").unwrap();
        }
        let place = case.path().join(&places[random.below(places.len() as u64) as usize]);
        fs::create_dir_all(place.parent().unwrap()).unwrap();
        let _ = fs::remove_dir_all(&place).or_else(|_| fs::remove_file(&place));
        let target = match random.below(6) {
            0 => Some(PathBuf::from("/dev/zero")),
            1 => Some(home.path().join("results/thesis.csv")),
            2 => Some(PathBuf::from("/proc/self/status")),
            3 | 4 => Some(home.path().to_owned()),
            _ => None,
        };
        match &target {
            Some(target) => symlink(target, &place).unwrap(),
            None => assert!(Command::new("mkfifo").arg(&place).status().unwrap().success()),
        }
        let before = census(home.path());
        let verb = VERBS[random.below(VERBS.len() as u64) as usize];
        let (status, said) = ends(case.path(), verb);
        let what =
            format!("number {number}: {verb:?} with {target:?} in place of {}: {status:?}: {said}", place.display());
        assert!(matches!(status, Some(0..=3)), "{what}");
        assert!(census(home.path()) == before, "{what}");
    }
}

#[test]
fn hostile_folders_do_no_harm() {
    hostile(20 * times(), 7);
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    #[test]
    fn kills_in_all_stages_lose_nothing() {
        disturb("KILL", 8 * times(), 1);
    }

    #[test]
    fn signals_in_all_stages_lose_nothing() {
        for (signal, seed) in [("INT", 2), ("TERM", 3), ("HUP", 4)] {
            disturb(signal, 2 * times(), seed);
        }
    }

    #[test]
    fn pairs_of_processes_do_not_mix() {
        for number in 0..8 * times() {
            let (stage, with_earlier) = (number as usize % 4, number / 4 % 2 == 1);
            let folder = prepared(stage, with_earlier);
            let pair = [(); 2].map(|()| command(folder.path(), &[STAGES[stage], "."]).spawn().unwrap());
            let ended = pair.map(|child| child.wait_with_output().unwrap());
            assert!(ended.iter().any(|output| output.status.success()), "{} {}", said(&ended[0]), said(&ended[1]));
            for output in ended.iter().filter(|output| !output.status.success()) {
                let said = said(output);
                assert!(
                    output.status.code() == Some(3) && said.contains("is at work in this folder"),
                    "{}: {said}",
                    output.status
                );
            }
            recovers(folder.path(), stage, with_earlier, &format!("pair {number} of {}", STAGES[stage]));
        }
    }
}
