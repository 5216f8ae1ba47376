//! Scenes of `make everyday`: ordinary ones with known answers, and relations between scenes. None is wrong in silence.

use crate::support::{self, PROGRAM, project};

/// Runs the Python of the project with this program; returns whether it succeeded, and what it printed.
fn python(arguments: &[&str]) -> (bool, String) {
    let output = support::python().args(arguments).current_dir(project("")).env("MPM", PROGRAM).output().unwrap();
    let text = [output.stdout, output.stderr].map(|text| String::from_utf8_lossy(&text).into_owned()).concat();
    (output.status.success(), text)
}

#[test]
fn the_closed_forms_have_known_values() {
    for file in ["geometry", "column", "water", "slope", "walls"] {
        let (good, text) = python(&["-m", "doctest", &format!("benches/everyday/{file}.py")]);
        assert!(good, "{text}");
    }
}

/// A tall bin of dry sand, whose residual does not depend on the step, fills by the default step; ground that yields all over as its weight comes on,
/// and bears it in shear bands, is told of. The first ended, and the second was wrong in silence.
#[test]
fn scenes_that_ended_or_were_wrong_in_silence() {
    for (seed, number, verdicts) in [("58", "509", &["right"][..]), ("59", "457", &["right", "refused or said"])] {
        let (good, text) = python(&["benches/everyday/run.py", "--seed", seed, "--only", number]);
        assert!(good && verdicts.iter().any(|verdict| text.contains(&format!("): {verdict}"))), "{text}");
    }
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    #[test]
    fn ordinary_scenes_are_right_or_it_is_said() {
        let (good, text) = python(&["benches/everyday/run.py", "--seed", "7", "--count", "60"]);
        println!("{text}");
        assert!(good && text.contains("| all | 60 |"), "{text}");
    }
}
