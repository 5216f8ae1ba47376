//! `mpm export`: from `results/` to series of `.vtu` with their `.pvd`.

use super::args::StageArgs;
use super::mesh;
use super::print::{Outcome, note, print};
use super::stage::{Inputs, POINTS, Stage};
use crate::case::checked::Encoding;
use crate::case::parts;
use crate::case::raw::Product;
use crate::error::{Error, Result};
use crate::io::export::Exported;
pub use crate::io::export::STAGE;
use crate::io::run_folder::{RunFolder, Standing};
use crate::io::{export, frame, hash, provenance, vtu};
use std::fs;
use std::path::{Path, PathBuf};

#[derive(clap::Args, Clone)]
pub struct Args {
    #[command(flatten)]
    pub stage: StageArgs,
    /// Export the run that was not finished, where there are finished results too
    #[arg(long)]
    pub unfinished: bool,
}

pub fn run(args: &Args) -> Outcome {
    let stage = Stage::open(&args.stage)?;
    stage.lock()?;
    let run = if args.unfinished { unfinished(&stage)? } else { shown(&stage)? };
    work(&stage, &run, stage.folder())
}

/// Exports what an analysis came to that could not go on: beside finished results into the folder of its own, so that these keep
/// their series.
pub fn unfinished_run(stage: &Stage) -> Outcome {
    let run = unfinished(stage)?;
    work(stage, &run, run.path())
}

/// Whether the series are there and would come out the same.
///
/// # Errors
/// Results that cannot be read.
pub fn is_current(stage: &Stage) -> Result<bool> {
    let run = shown(stage)?;
    Ok(run.standing()? == Standing::Finished
        && inputs(stage, &run)?.are_current(stage.folder(), &series(stage.folder())))
}

/// Exports the results, and prints a summary.
pub fn results(stage: &Stage) -> Outcome {
    work(stage, &shown(stage)?, stage.folder())
}

/// Exports a run into a folder.
fn work(stage: &Stage, run: &RunFolder, folder: &Path) -> Outcome {
    let mesh = mesh::read(stage)?;
    let case = &stage.loaded.case;
    let output = &case.output;
    let fields: Vec<String> = output.fields.iter().map(|field| field.name().to_owned()).collect();
    let encoding = match output.encoding {
        Encoding::Compressed => vtu::Encoding::Lz4,
        Encoding::Plain => vtu::Encoding::Plain,
    };
    let mut record = inputs(stage, run)?.begin();
    check_run(stage, run)?;
    provenance::refuse_others(folder, STAGE, export::replaced(folder)?)?;
    let regions = parts::of_series(case, &mesh);
    let export = || export::export(&run.results(), &mesh, &regions, folder, &fields, encoding);
    let Exported { frames, soil } = record.around(folder, export)?;
    record.finish(folder, &series(folder))?;
    record.write(folder)?;
    let pvd = folder.join("points.pvd");
    let finished = run.standing()? == Standing::Finished;
    let state = if finished { String::new() } else { unfinished_state(run)? };
    print(&format!("{}: {frames} frames{state}\n", pvd.display()))?;
    if !soil && regions.soil.iter().zip(&regions.elements).any(|(soil, fem)| *soil && !fem) {
        let needs = if fields.iter().any(|field| field == "displacement") {
            "these results are of an earlier version, without the volumes of the points; run `mpm solve` again"
        } else {
            "the soil is seen as a body where `displacement` is among the fields of `output`"
        };
        note(&format!("note: no soil.pvd: {needs}"));
    }
    if finished && stage.runs().beside.has_frames() {
        print(&format!(
            "{}: a later run that was not finished is there too; `--unfinished` exports it\n",
            stage.runs().beside.path().display()
        ))?;
    }
    Ok(())
}

/// How far a run that is not finished has come, and why it ended.
fn unfinished_state(run: &RunFolder) -> Result<String> {
    let until = frame::list(&run.results())?.last().map_or(0.0, |frame| frame.time);
    let reason = run.record().and_then(|record| record.sessions.last()?.reason.clone());
    let reason = reason.unwrap_or_else(|| "it was killed".to_owned());
    Ok(format!(" of a run that is not finished, up to t = {until} s: {reason}"))
}

/// The run whose results are shown: that in the output folder, or where there is none the one beside it.
pub(super) fn shown(stage: &Stage) -> Result<RunFolder> {
    let runs = stage.runs();
    Ok(if !runs.main.has_frames() && runs.beside.has_frames() { runs.beside } else { runs.main })
}

pub(super) fn unfinished(stage: &Stage) -> Result<RunFolder> {
    let runs = stage.runs();
    let candidates = [runs.beside, runs.main].into_iter();
    let mut unfinished = Vec::new();
    for run in candidates.filter(RunFolder::has_frames) {
        if run.standing()? != Standing::Finished {
            unfinished.push(run);
        }
    }
    unfinished.into_iter().next().ok_or_else(|| {
        let place = stage.folder().display();
        Error::input(place, "there is no run that was not finished", "take `--unfinished` out to export the results")
    })
}

/// Refuses results that were changed since the run, or that are of another mesh.
pub(super) fn check_run(stage: &Stage, run: &RunFolder) -> Result<()> {
    const AGAIN: &str = "run `mpm solve` again";
    let frames = frame::list(&run.results())?;
    let mesh = hash::file(&stage.mesh(), "run `mpm mesh` first")?;
    if let Some(other) = frames.iter().find(|frame| frame.origin.mesh != mesh) {
        let problem = "it was made with another mesh.msh";
        return Err(Error::input(other.path.display(), problem, "run `mpm seed` and `mpm solve` again, or `mpm run`"));
    }
    run.changed()?.map_or(Ok(()), |place| {
        Err(Error::input(place.display(), "it is not as the run left it: missing, added or changed", AGAIN))
    })
}

fn inputs(stage: &Stage, run: &RunFolder) -> Result<Inputs> {
    let mut files = run.outputs()?;
    files.push(stage.mesh());
    stage.inputs(STAGE, Product::Series, &files)
}

/// The files of the series that are there.
fn series(output: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for folder in [output.to_owned(), output.join("vtu")] {
        // A folder that is not there has no files in it.
        let entries = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
        files.extend(
            entries.filter(|path| path.extension().is_some_and(|kind| kind == "vtu" || kind == "vtp" || kind == "pvd")),
        );
    }
    files.retain(|path| *path != output.join(POINTS));
    files.sort();
    files
}
