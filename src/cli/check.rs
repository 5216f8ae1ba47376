//! `mpm check`: every mistake of a case and its `.geo` in one go, those that show on the mesh and before the first step too, and warnings of
//! what is surely unmeant.

use super::args::CaseArgs;
use super::mesh;
use super::print::{Outcome, note, print};
use crate::case::checked::Source;
use crate::case::names::Of;
use crate::case::{self, Review, plates, scene, seeding, unconnected, unmeant};
use crate::run::WARNING;

#[derive(clap::Args)]
#[group(skip)]
pub struct Args {
    #[command(flatten)]
    case: CaseArgs,
    #[command(flatten)]
    limits: mesh::Limits,
}

pub fn run(args: &Args) -> Outcome {
    let CaseArgs { case, overrides } = &args.case;
    // A mesh that is given is read once, for its names.
    let mut given = None;
    let Review { mistakes, notes, case: sound } = case::review(case, overrides, |case| match &case.mesh.source {
        Source::Geo(_) => Ok(mesh::groups(&case.mesh, &args.limits)?),
        Source::Mesh(_) => {
            let mesh = mesh::generated(&case.mesh, &args.limits)?;
            let told = (mesh::names_of(&mesh, Of::Given), unconnected::places(&mesh));
            given = Some(mesh);
            Ok(told)
        }
    })?;
    let mut warnings = notes.iter().filter(|text| text.starts_with(WARNING)).count();
    notes.iter().for_each(|text| note(text));
    if !mistakes.is_empty() {
        return Err(mistakes);
    }
    if let Some(sound) = sound {
        let mut mesh = given.map_or_else(|| mesh::generated(&sound.mesh, &args.limits), Ok)?;
        plates::append(&sound, &mut mesh)?;
        let found = unmeant::on_mesh(&sound, &mesh)?;
        warnings += found.iter().filter(|text| text.starts_with(WARNING)).count();
        found.iter().for_each(|text| note(text));
        unconnected::nodes(&sound, &mesh).iter().try_for_each(|text| print(&format!("{text}\n")))?;
        let points = seeding::points(&sound, &mesh)?;
        seeding::notes(&sound, &mesh, &points)?.iter().try_for_each(|text| print(&format!("{text}\n")))?;
        scene::rehearse(&sound, mesh, points)?;
    }
    let warned = match warnings {
        0 => String::new(),
        1 => ", one warning".to_owned(),
        count => format!(", {count} warnings"),
    };
    print(&format!("{}: no mistakes{warned}\n", case.display()))
}
