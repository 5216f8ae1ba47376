//! What touches what, from the case to the results: rigid structures, walls, and bodies with bodies.

mod bodies;
mod changes;
mod effective_friction;
mod input;
mod rigid;
mod rough;
mod sliding;
mod structures;
mod tube;
mod wall;

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    mod hertz;
    mod rolling;
}

use crate::support::{errors, mpm, rows, run};

/// Runs a case with overrides and returns the rows of its history.
fn history(case: &str, overrides: &[&str]) -> Vec<Vec<f64>> {
    rows(run(case, overrides).path())
}

/// `mpm run` refuses a case with overrides, and says all of `words`.
fn refused(case: &str, overrides: &[&str], words: &[&str]) {
    let folder = tempfile::tempdir().unwrap();
    let output = mpm("run", case, folder.path(), overrides);
    let said = errors(&output);
    assert_eq!(output.status.code(), Some(2), "{overrides:?}: {said}");
    assert!(words.iter().all(|word| said.contains(word)), "{overrides:?}: {said}");
}
