//! `mpm check`: every mistake of a case that shows without its mesh, in one go.

use super::{CaseArgs, Outcome, mesh, print};
use crate::case;

pub fn run(args: &CaseArgs) -> Outcome {
    let errors = case::review(&args.case, &args.overrides, mesh::groups)?;
    if errors.is_empty() { print(&format!("{}: no mistakes\n", args.case.display())) } else { Err(errors) }
}
