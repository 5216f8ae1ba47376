use super::*;
use std::fs;

/// A run that has converged `steps` steps, whose files hold `text`.
fn write_run(run: &RunFolder, text: &str, finished: bool) {
    fs::create_dir_all(run.results()).unwrap();
    fs::create_dir_all(run.checkpoints()).unwrap();
    for file in
        [run.history(), run.log(), frame::path(&run.results(), 0), run.checkpoints().join("step-000000001.mpmc")]
    {
        fs::write(file, text).unwrap();
    }
    let mut record = Record::begin(STAGE, 1, Default::default());
    if finished {
        record.finish(run.path(), &run.outputs().unwrap()).unwrap();
    }
    record.write(run.path()).unwrap();
}

fn history(run: &RunFolder) -> String {
    fs::read_to_string(run.history()).unwrap_or_default()
}

fn runs() -> (tempfile::TempDir, Runs) {
    let folder = tempfile::tempdir().unwrap();
    let runs = Runs::of(folder.path());
    (folder, runs)
}

#[test]
fn a_run_starts_in_place_and_beside_results() {
    let (_folder, runs) = runs();
    assert_eq!(runs.start().unwrap(), &runs.main);
    write_run(&runs.main, "first", true);
    assert_eq!(runs.start().unwrap(), &runs.beside);
    assert_eq!(history(&runs.main), "first");
}

#[test]
fn a_finished_run_takes_the_place_of_any_and_an_unfinished_one_only_of_an_unfinished_one() {
    // What is there, what comes, and whether that takes its place.
    for (old, new, expected) in [(true, true, true), (true, false, false), (false, true, true), (false, false, true)] {
        let (_folder, runs) = runs();
        write_run(&runs.main, "old", old);
        let run = runs.start().unwrap();
        write_run(run, "new", new);
        assert_eq!(runs.settle(run).unwrap(), expected, "{old} {new}");
        assert_eq!(history(&runs.main), if expected { "new" } else { "old" });
        assert_eq!(runs.main.standing().unwrap() == Standing::Finished, if expected { new } else { old });
        assert_eq!(runs.beside.path().exists(), !expected);
        assert!(!runs.replaced().path().exists() && !runs.marker().exists());
    }
}

#[test]
fn a_run_without_a_converged_step_leaves_what_is_there() {
    let (_folder, runs) = runs();
    write_run(&runs.main, "old", false);
    let run = runs.start().unwrap();
    fs::write(run.log(), "failed").unwrap();
    assert!(!runs.settle(run).unwrap());
    assert_eq!(history(&runs.main), "old");
}

/// Every state that a kill can leave of the exchange: whichever of the renames were done.
#[test]
fn an_exchange_that_was_cut_short_is_completed() {
    let names = ["results", "checkpoints", "history.csv", "solve.log"];
    for done in 0..=names.len() {
        for half in [false, true] {
            let (_folder, runs) = runs();
            write_run(&runs.main, "old", true);
            write_run(&runs.beside, "new", true);
            fs::write(runs.marker(), "").unwrap();
            fs::create_dir(runs.replaced().path()).unwrap();
            for (k, name) in names.iter().enumerate() {
                let old = runs.main.path().join(name);
                if k < done || (k == done && half) {
                    fs::rename(&old, runs.replaced().path().join(name)).unwrap();
                }
                if k < done {
                    fs::rename(runs.beside.path().join(name), &old).unwrap();
                }
            }
            runs.prepare().unwrap();
            assert_eq!((history(&runs.main).as_str(), runs.main.standing().unwrap()), ("new", Standing::Finished));
            assert!(runs.main.record().is_some() && runs.main.changed().unwrap().is_none());
            assert!(!runs.beside.path().exists() && !runs.replaced().path().exists() && !runs.marker().exists());
        }
    }
}

#[test]
fn links_in_place_of_folders_are_refused_and_not_emptied() {
    for name in ["results", "checkpoints", "history.csv", "energy.csv", "solve.log", BESIDE, provenance::FOLDER] {
        let (folder, runs) = runs();
        let elsewhere = tempfile::tempdir().unwrap();
        fs::write(elsewhere.path().join("frame-000000.mpmf"), "precious").unwrap();
        std::os::unix::fs::symlink(elsewhere.path(), folder.path().join(name)).unwrap();
        let refused = runs.prepare().unwrap_err();
        assert!(refused.to_string().contains(name) && refused.problem.contains("symbolic link"), "{refused}");
        assert_eq!(fs::read(elsewhere.path().join("frame-000000.mpmf")).unwrap(), b"precious");
    }
}

#[test]
fn results_without_checkpoints_are_results_all_the_same() {
    for finished in [true, false] {
        let (_folder, runs) = runs();
        write_run(&runs.main, "old", finished);
        fs::write(frame::path(&runs.main.results(), 1), "old").unwrap();
        let mut record = runs.main.record().unwrap();
        if finished {
            record.finish(runs.main.path(), &runs.main.outputs().unwrap()).unwrap();
            record.write(runs.main.path()).unwrap();
        }
        fs::remove_dir_all(runs.main.checkpoints()).unwrap();
        assert_eq!(runs.start().unwrap(), &runs.beside, "{finished}");
        assert_eq!(history(&runs.main), "old");
    }
}

#[test]
fn what_others_keep_in_the_folders_stays_and_what_they_would_lose_is_refused() {
    let (folder, runs) = runs();
    let notes = ["results/notes.txt", "phases/copy.mpms", "unfinished/notes.txt", "unfinished/checkpoints/a/b.txt"];
    let write = |name: &str| {
        let path = folder.path().join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, "mine").unwrap();
    };
    notes.iter().for_each(|name| write(name));
    write_run(&runs.main, "old", true);
    for _ in 0..2 {
        let run = runs.start().unwrap();
        assert_eq!(run, &runs.beside);
        write_run(run, "new", true);
        assert!(runs.settle(run).unwrap());
        runs.prepare().unwrap();
        assert_eq!(history(&runs.main), "new");
        // What was beside goes with the run to its place.
        let now = ["results/notes.txt", "phases/copy.mpms", "unfinished/notes.txt", "checkpoints/a/b.txt"];
        now.iter().for_each(|name| assert_eq!(fs::read(folder.path().join(name)).unwrap(), b"mine", "{name}"));
        assert!(!runs.replaced().path().exists());
    }
    fs::remove_file(provenance::path(folder.path(), STAGE)).unwrap();
    let refused = runs.start().unwrap_err().to_string();
    assert!(refused.contains("history.csv: it is there already, and not by `mpm solve`"), "{refused}");
}
