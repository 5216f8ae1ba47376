//! `mpm check`: every mistake of a case that shows without its mesh, in one go.

use super::args::CaseArgs;
use super::mesh;
use super::print::{Outcome, note, print};
use crate::case::{Keys, Review};

#[derive(clap::Args)]
#[group(skip)]
pub struct Args {
    #[command(flatten)]
    case: CaseArgs,
    #[command(flatten)]
    limits: mesh::Limits,
}

pub fn run(args: &Args, keys: &Keys) -> Outcome {
    let CaseArgs { case, overrides } = &args.case;
    let Review { mistakes, notes } = keys.review(case, overrides, |mesh| mesh::groups(mesh, &args.limits))?;
    notes.iter().for_each(|text| note(text));
    if mistakes.is_empty() { print(&format!("{}: no mistakes\n", case.display())) } else { Err(mistakes) }
}
