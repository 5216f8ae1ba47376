//! `mpm run`: all stages in turn, but those whose inputs have not changed.

use super::stage::Stage;
use super::{Outcome, StageArgs, export, mesh, print, seed};
use crate::error::Result;

/// A stage: its name, whether it may be skipped, and its work.
type Entry = (&'static str, fn(&Stage) -> Result<bool>, fn(&Stage) -> Outcome);

const STAGES: [Entry; 3] = [
    ("mesh", mesh::is_current, mesh::work),
    ("seed", seed::is_current, seed::work),
    ("export", export::is_current, export::work),
];

pub fn run(args: &StageArgs) -> Outcome {
    let stage = Stage::open(args)?;
    for (name, is_current, work) in STAGES {
        if is_current(&stage)? {
            print(&format!("{name}: nothing has changed\n"))?;
        } else {
            work(&stage)?;
        }
    }
    Ok(())
}
