//! `mpm export`: from `results/` to series of `.vtu` with their `.pvd`.

use super::args::StageArgs;
use super::frames;
use super::mesh;
use super::print::{Outcome, note, print};
use super::stage::{Inputs, POINTS, Stage};
use crate::case::checked::Encoding;
use crate::case::parts;
use crate::case::raw::Product;
use crate::error::{Error, Result};
pub use crate::io::export::STAGE;
use crate::io::export::{Exported, Section, Series, Sheet};
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
    /// Write numbers of frames as a table in place of the series: of the material points, or along a line, with all fields of the output
    #[arg(long, value_name = "FILE.csv")]
    pub csv: Option<PathBuf>,
    /// The points in a box alone (m)
    #[arg(long, value_name = "X0,Y0,X1,Y1", requires = "csv", allow_hyphen_values = true, value_parser = frames::box_of)]
    pub window: Option<[f64; 4]>,
    /// Values of the soil along a line, in place of those of points (m)
    #[arg(long, value_name = "X0,Y0,X1,Y1", requires = "csv", conflicts_with = "window", allow_hyphen_values = true,
        value_parser = frames::ends)]
    pub along: Option<[f64; 4]>,
    /// The number of places along the line, its ends among them [default: 101]
    #[arg(long, value_name = "N", requires = "along", value_parser = clap::value_parser!(u32).range(2..=100_000))]
    pub stations: Option<u32>,
    /// The time of the frame in s: that of the nearest one
    #[arg(long, value_name = "T", requires = "csv", conflicts_with_all = ["frame", "times"])]
    pub time: Option<f64>,
    /// The frame by its number, from 0, or `last` [default: last]
    #[arg(long, value_name = "N", requires = "csv", conflicts_with = "times")]
    pub frame: Option<String>,
    /// Times of several frames, whose rows follow each other
    #[arg(long, value_name = "T,T,...", requires = "csv", value_delimiter = ',')]
    pub times: Vec<f64>,
}

/// Places along a line, unless another number is wanted.
pub const STATIONS: u32 = 101;

pub fn run(args: &Args) -> Outcome {
    let stage = Stage::open(&args.stage)?;
    stage.lock()?;
    let run = if args.unfinished { unfinished(&stage)? } else { shown(&stage)? };
    if let Some(path) = &args.csv {
        return table(&stage, &run, path, args);
    }
    work(&stage, &run, stage.folder())
}

/// Writes numbers of frames as a table.
fn table(stage: &Stage, run: &RunFolder, path: &Path, args: &Args) -> Outcome {
    let mesh = mesh::read(stage)?;
    check_run(stage, run)?;
    let case = &stage.loaded.case;
    let regions = parts::of_series(case, &mesh);
    let series = Series::open(&run.results(), &mesh, &regions)?;
    let infos = &series.infos;
    let chosen = match (&args.frame, args.time) {
        _ if !args.times.is_empty() => frames::at(infos, &args.times)?,
        (Some(number), _) => vec![frames::numbered(infos, number)?],
        (None, Some(time)) => frames::at(infos, &[time])?,
        (None, None) => vec![infos.len() - 1],
    };
    let corners = |[a, b, c, d]: [f64; 4]| [[a, b], [c, d]];
    let section = match (args.window, args.along) {
        (Some(window), _) => Section::Window(corners(window)),
        (None, Some(ends)) => {
            Section::Along { ends: corners(ends), stations: args.stations.unwrap_or(STATIONS) as usize }
        }
        (None, None) => Section::Points,
    };
    let fields: Vec<String> = case.output.fields.iter().map(|field| field.name().to_owned()).collect();
    let mut all = Sheet::default();
    for i in chosen {
        let Sheet { headings, rows } = series.section(i, &fields, &section)?;
        all.headings = headings;
        all.rows.extend(rows);
    }
    let empty = all.rows.iter().filter(|row| row.contains(&None)).count();
    if all.rows.len() == empty {
        let problem = "there is no soil at that place and time";
        return Err(
            Error::input(path.display(), problem, "choose another `--window` or `--along`, or another time").into()
        );
    }
    crate::io::table::write(path, &all.headings, &all.rows)?;
    if empty > 0 {
        note(&format!("note: {empty} of {} rows are empty: there is no soil at those places", all.rows.len()));
    }
    print(&format!("{}: {} rows\n", path.display(), all.rows.len()))
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
    files.extend(Some(output.join(export::SECTIONS)).filter(|path| path.exists()));
    files.retain(|path| *path != output.join(POINTS));
    files.sort();
    files
}
