//! A handful of the random scenes of `make stress`: each ends converged or with a clean statement. What is held against
//! a run is in `benches/stress/check.py`, whose examples show that it finds the faults it looks for.

use crate::support::{self, PROGRAM, project, succeeds};

/// Runs the Python of the project with this program, which succeeds; returns what it printed.
fn python(arguments: &[&str]) -> String {
    let mut command = support::python();
    let output = command.args(arguments).current_dir(project("")).env("MPM", PROGRAM).output().unwrap();
    succeeds(&output);
    String::from_utf8_lossy(&output.stdout).into_owned()
}

#[test]
fn the_checks_find_the_faults_they_look_for() {
    python(&["-m", "doctest", "benches/stress/check.py"]);
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    #[test]
    fn random_scenes_end_converged_or_with_a_statement() {
        let text = python(&["benches/stress/run.py", "--seed", "7", "--count", "12"]);
        println!("{text}");
        assert!(text.contains("| all | 12 |"), "{text}");
    }
}
