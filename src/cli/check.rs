//! `mpm check`: every mistake of a case and its `.geo` in one go, and warnings of what is surely unmeant.

use super::args::CaseArgs;
use super::mesh;
use super::print::{Outcome, note, print};
use crate::case::{Keys, Review, unmeant};
use crate::run::WARNING;

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
    let Review { mistakes, notes, case: sound } =
        keys.review(case, overrides, |mesh| mesh::groups(mesh, &args.limits))?;
    let mut warnings = notes.iter().filter(|text| text.starts_with(WARNING)).count();
    notes.iter().for_each(|text| note(text));
    if !mistakes.is_empty() {
        return Err(mistakes);
    }
    // Only contacts with soil depend on the size of the cells.
    if let Some(sound) = sound.filter(unmeant::looks_at_mesh) {
        let mesh = mesh::generated(&sound.mesh, &args.limits)?;
        let found = unmeant::on_mesh(&sound, &mesh);
        warnings += found.len();
        found.iter().for_each(|text| note(text));
    }
    let warned = match warnings {
        0 => String::new(),
        1 => ", one warning".to_owned(),
        count => format!(", {count} warnings"),
    };
    print(&format!("{}: no mistakes{warned}\n", case.display()))
}
