//! A handful of the random scenes of `make stress`: each ends converged or with a clean statement. What is held against
//! a run is in `benches/stress/check.py`, whose examples show that it finds the faults it looks for.

use std::path::Path;
use std::process::Command;

fn python(arguments: &[&str]) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut command = Command::new(root.join(".venv/bin/python"));
    command.args(arguments).current_dir(root).env("MPM", env!("CARGO_BIN_EXE_mpm"));
    let output = command.output().expect("the Python of the project is there: make setup");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    assert!(output.status.success(), "{arguments:?}: {text}{}", String::from_utf8_lossy(&output.stderr));
    text
}

#[test]
fn the_checks_find_the_faults_they_look_for() {
    python(&["-m", "doctest", "benches/stress/check.py"]);
}

#[test]
fn random_scenes_end_converged_or_with_a_statement() {
    let text = python(&["benches/stress/run.py", "--seed", "7", "--count", "20"]);
    println!("{text}");
    assert!(text.contains("| all | 20 |"), "{text}");
}
