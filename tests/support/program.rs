//! Starting the program and the Python of the project.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use tempfile::TempDir;

/// The program under test.
pub const PROGRAM: &str = env!("CARGO_BIN_EXE_mpm");

/// A path of the repository.
pub fn project(path: impl AsRef<Path>) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// The program on one thread, as tests run side by side; what it says goes into pipes.
fn program() -> Command {
    let mut command = Command::new(PROGRAM);
    command.env("RAYON_NUM_THREADS", "1").stdout(Stdio::piped()).stderr(Stdio::piped());
    command
}

/// The program to be started in a folder.
pub fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = program();
    command.args(arguments).current_dir(folder);
    command
}

/// Runs [`command`] to its end, whichever that is.
pub fn in_folder(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments).output().unwrap()
}

/// `mpm <stage> <case> -o <out>` with entries of the case overridden; the path of the case may be one of the repository.
pub fn stage(stage: &str, case: impl AsRef<Path>, out: &Path, set: &[&str]) -> Command {
    let mut command = program();
    command.arg(stage).arg(project(case)).arg("-o").arg(out).args(set.iter().flat_map(|entry| ["--set", entry]));
    command
}

/// Runs [`stage`] to its end, whichever that is.
pub fn mpm(name: &str, case: impl AsRef<Path>, out: &Path, set: &[&str]) -> Output {
    stage(name, case, out, set).output().unwrap()
}

/// Runs a case with overrides through all stages, which succeed; returns the folder with the results.
pub fn run(case: impl AsRef<Path>, set: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    succeeds(&mpm("run", case, folder.path(), set));
    folder
}

/// Meshes, seeds and solves a case with overrides; returns the folder with the results.
pub fn solve(case: impl AsRef<Path>, set: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for stage in ["mesh", "seed", "solve"] {
        succeeds(&mpm(stage, &case, folder.path(), set));
    }
    folder
}

/// A folder with a case that is given as text; `GEO` in it stands for the folder of geometries.
pub fn written(text: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let geo = project("geo").display().to_string();
    fs::write(folder.path().join("case.yaml"), text.replace("GEO", &geo)).unwrap();
    folder
}

/// Meshes, seeds and solves such a case; returns the folder with the case and the results.
pub fn solve_text(text: &str) -> TempDir {
    let folder = written(text);
    for stage in ["mesh", "seed", "solve"] {
        succeeds(&mpm(stage, folder.path(), folder.path(), &[]));
    }
    folder
}

/// What `mpm solve` wrote into its log.
pub fn log(folder: &Path) -> String {
    fs::read_to_string(folder.join("solve.log")).unwrap()
}

/// The factor of safety as a log has it: the largest with equilibrium and the least without.
pub fn safety(log: &str) -> [f64; 2] {
    let line = log.lines().find(|line| line.starts_with("factor of safety")).unwrap_or_else(|| panic!("{log}"));
    let words: Vec<&str> = line.split(' ').collect();
    [words[3], words[5]].map(|number| number.parse().unwrap_or_else(|_| panic!("{line}")))
}

/// What a program said on standard error.
pub fn errors(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

/// What a program said.
pub fn said(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned() + &errors(output)
}

/// Fails with what the program said unless it succeeded.
#[track_caller]
pub fn succeeds(output: &Output) {
    assert!(output.status.success(), "{}: {}", output.status, said(output));
}

/// The Python of the project, to be started.
pub fn python() -> Command {
    let python = project(".venv/bin/python");
    assert!(python.exists(), "{} is missing: run make setup", python.display());
    Command::new(python)
}
