//! What touches what, from the case to the results: rigid structures, walls, and bodies with bodies.

mod bodies;
mod hertz;
mod rigid;
mod tube;
mod wall;

use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

fn mpm(verb: &str, case: &str, folder: &Path, overrides: &[&str]) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_mpm"));
    command.arg(verb).arg(Path::new(env!("CARGO_MANIFEST_DIR")).join(case)).arg("-o").arg(folder);
    for entry in overrides {
        command.args(["--set", entry]);
    }
    command.output().unwrap()
}

/// Runs a case with overrides and returns its folder.
fn run(case: &str, overrides: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let output = mpm("run", case, folder.path(), overrides);
    assert!(output.status.success(), "{case} {overrides:?}: {}", String::from_utf8_lossy(&output.stderr));
    folder
}

/// The rows of the history of a run.
fn rows(folder: &Path) -> Vec<Vec<f64>> {
    let text = std::fs::read_to_string(folder.join("history.csv")).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(|v| v.parse().unwrap()).collect()).collect()
}

/// Runs a case with overrides and returns the rows of its history.
fn history(case: &str, overrides: &[&str]) -> Vec<Vec<f64>> {
    rows(run(case, overrides).path())
}

/// `mpm run` refuses a case with overrides, and says all of `words`.
fn refused(case: &str, overrides: &[&str], words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let output = mpm("run", case, folder.path(), overrides);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(2), "{overrides:?}: {said}");
    assert!(words.iter().all(|word| said.contains(word)), "{overrides:?}: {said}");
}
