//! `mpm export`: from `results/` to series of `.vtu` with their `.pvd`.

use super::stage::{Stage, Stamp};
use super::{Outcome, StageArgs, mesh, print};
use crate::case::checked::Encoding;
use crate::case::parts;
use crate::error::Result;
use crate::io::{export, frame, vtu};
use std::fs;
use std::path::PathBuf;

pub fn run(args: &StageArgs) -> Outcome {
    work(&Stage::open(args)?)
}

/// Whether the series are there and would come out the same.
///
/// # Errors
/// Results that cannot be read.
pub fn is_current(stage: &Stage) -> Result<bool> {
    Ok(stamp(stage)?.is_current(&series(stage)))
}

/// Exports, and prints a summary.
pub fn work(stage: &Stage) -> Outcome {
    let mesh = mesh::read(stage)?;
    let case = &stage.loaded.case;
    let output = &case.output;
    let fields: Vec<String> = output.fields.iter().map(|field| field.name().to_owned()).collect();
    let encoding = match output.encoding {
        Encoding::Compressed => vtu::Encoding::Lz4,
        Encoding::Plain => vtu::Encoding::Plain,
    };
    let stamp = stamp(stage)?;
    // The series change file by file: until all of them are there they are nobody's.
    stamp.remove()?;
    let summary =
        export::export(&stage.results(), &mesh, &parts::of_elements(case, &mesh), stage.folder(), &fields, encoding)?;
    stamp.write(&series(stage))?;
    print(&format!("{}: {} frames\n", stage.folder().join("points.pvd").display(), summary.frames))
}

fn stamp(stage: &Stage) -> Result<Stamp> {
    let mut files: Vec<PathBuf> = frame::list(&stage.results())?.into_iter().map(|frame| frame.path).collect();
    files.push(stage.mesh());
    stage.stamp("export", &["output"], &files)
}

/// The files of the series that are there.
fn series(stage: &Stage) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for folder in [stage.folder().to_owned(), stage.folder().join("vtu")] {
        // A folder that is not there has no files in it.
        let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
        files.extend(
            entries.filter(|path| path.extension().is_some_and(|kind| kind == "vtu" || kind == "vtp" || kind == "pvd")),
        );
    }
    files.retain(|path| *path != stage.points());
    files.sort();
    files
}
