//! `mpm check`: every mistake of a case in one go.

use super::{CaseArgs, Outcome, print};
use crate::case;

pub fn run(args: &CaseArgs) -> Outcome {
    let loaded = case::load(&args.case, &args.overrides)?;
    print(&format!("{}: no mistakes\n", loaded.source.file().display()))
}
