//! `mpm report`: one page on a run.

use super::args::{CaseArgs, StageArgs};
use super::print::{Outcome, print};
use super::stage::Stage;
use super::{mesh, plot, solve};
use crate::case::parts;
use crate::draw::field::{Asked, Field, Options};
use crate::draw::history::Run;
use crate::error::{Error, Result};
use crate::io::atomic;
use crate::io::export::Series;
use crate::io::frame::Info;
use crate::io::provenance::{self, Record};
use crate::io::run_folder::{RunFolder, STAGE, Standing};
use crate::io::sweep_table::{self, SweepTable};
use crate::io::table::Table;
use crate::mesh::Mesh;
use crate::report::{Html, Subject, variants};
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
#[group(skip)]
pub struct Args {
    #[command(flatten)]
    case: CaseArgs,
    /// The output folder with the run [default: out/ beside the case]
    #[arg(long, value_name = "DIR")]
    from: Option<PathBuf>,
    /// The page [default: report.html in the output folder]
    #[arg(short, long, value_name = "FILE.html")]
    output: Option<PathBuf>,
    /// A field that is shown over the soil, such as stress.yy; may be repeated [default: displacement, and plastic_strain where there is one]
    #[arg(long, value_name = "NAME[.COMPONENT]")]
    field: Vec<String>,
    /// The times in s at which it is shown, of the frames that are nearest [default: the end of each phase]
    #[arg(long, value_name = "T,T,…", value_delimiter = ',')]
    times: Vec<f64>,
    /// The folder of a sweep, or its table.csv, whose variants are shown beside the run [default: sweep/ beside the case, if it has a table]
    #[arg(long, value_name = "DIR")]
    sweep: Option<PathBuf>,
    /// Report on the run that was not finished, where there is a finished one too
    #[arg(long)]
    unfinished: bool,
}

pub fn run(args: &Args) -> Outcome {
    let stage = StageArgs { case: args.case.clone(), output: args.from.clone(), threads: None };
    let stage = Stage::open(&stage)?;
    let path = args.output.clone().unwrap_or_else(|| stage.folder().join("report.html"));
    if !path.extension().is_some_and(|kind| kind == "html" || kind == "htm") {
        return Err(Error::input(path.display(), "a report is HTML", "let the name end in .html").into());
    }
    if args.output.is_none() {
        atomic::refuse_link(stage.folder())?;
    }
    let Some(folder) = stage.runs().with_history(args.unfinished) else {
        let problem = "there is no run to report on";
        return Err(
            Error::input(stage.folder().display(), problem, "run `mpm solve`, or name its folder with --from").into()
        );
    };
    let name = folder.path().display().to_string();
    let run = Run::read(&folder, name)?;
    let mesh = mesh::read(&stage);
    let records: Vec<Record> =
        ["mesh", "seed", STAGE, "export"].iter().filter_map(|name| record(&stage, &folder, name)).collect();
    let mut cautions = Vec::new();
    if folder.standing()? == Standing::Finished && !solve::is_current(&stage).unwrap_or(false) {
        cautions.push(
            "The case, its mesh or the program has changed since the run: its entries below may not be those that the results are of."
                .to_owned(),
        );
    }
    let sweep = match sweep(args, &run.table) {
        // What was asked for must be there; without that the page says why it is not.
        Err(error) if args.sweep.is_none() => Some(Err(error.to_string())),
        sweep => sweep?.map(Ok),
    };
    if let Some(Ok((_, true))) = &sweep {
        let text = "The case file was changed after the table of its variants was written: `mpm sweep` with `--table` says which are out of date.";
        cautions.push(text.to_owned());
    }
    let sweep = sweep.map(|sweep| sweep.map(|(variants, _)| variants));
    let now = provenance::now();
    let mesh = match &mesh {
        Ok(mesh) => Ok(mesh),
        Err(errors) => Err(errors.first().map_or_else(String::new, ToString::to_string)),
    };
    let pictures = match mesh {
        Ok(mesh) => pictures(&stage, mesh, &folder, args),
        Err(ref problem) => Err(Error::input("mesh.msh", problem, "")),
    };
    let pictures = match pictures {
        // What was asked for must be there; without that the page says why there are none.
        Err(error) if !args.field.is_empty() => return Err(error.into()),
        pictures => pictures.map_err(|error| error.to_string()),
    };
    let subject = Subject {
        loaded: &stage.loaded,
        mesh,
        run: &run,
        pictures,
        records: &records,
        sweep,
        cautions: &cautions,
        now,
    };
    let page = subject.page()?;
    atomic::write(&path, |out| out.write_all(page.as_bytes()))?;
    print(&format!("{}\n", path.display()))
}

/// The variants, and whether the case file is newer than their table; one that was not asked for may be missing.
fn sweep(args: &Args, run: &Table) -> Result<Option<(Html, bool)>> {
    let case = &args.case.case;
    let beside = if case.is_dir() { case.as_path() } else { case.parent().unwrap_or(Path::new("")) };
    let path = sweep_table::file(&args.sweep.clone().unwrap_or_else(|| beside.join("sweep")));
    if args.sweep.is_none() && !path.is_file() {
        return Ok(None);
    }
    let table = SweepTable::read(&path, "run `mpm sweep` first, or name its folder")?;
    if !table.is_sweep() {
        let problem = "is not the table of a sweep: it has no `run` and `state`";
        return Err(Error::input(path.display(), problem, "name the folder of a sweep, or its table, with --sweep"));
    }
    let file = if case.is_dir() { case.join("case.yaml") } else { case.clone() };
    let changed = |path: &Path| path.metadata().and_then(|data| data.modified()).ok();
    let newer = changed(&file).zip(changed(&path)).is_some_and(|(case, table)| case > table);
    Ok(Some((variants(&table, run)?, newer)))
}

/// Pixels of a picture of a field across the page.
const PIXELS: u32 = 1440;
/// Pictures of each field that are drawn unless times are asked for.
const MOST: usize = 6;

/// Pictures of the fields at the times.
fn pictures(stage: &Stage, mesh: &Mesh<2>, run: &RunFolder, args: &Args) -> Result<Vec<Field>> {
    let case = &stage.loaded.case;
    let regions = parts::of_series(case, mesh);
    let series = Series::open(&run.results(), mesh, &regions)?;
    let has = |name: &str| case.output.fields.iter().any(|field| field.name() == name);
    let usual = ["displacement", "plastic_strain"].into_iter().filter(|name| has(name)).map(str::to_owned);
    let fields: Vec<String> = if args.field.is_empty() { usual.collect() } else { args.field.clone() };
    let frames =
        if args.times.is_empty() { ends(&series.infos) } else { super::frames::at(&series.infos, &args.times)? };
    let options = Options { width: Some(PIXELS), axisymmetric: regions.axisymmetric, ..Options::default() };
    let mut pictures = Vec::new();
    for field in fields {
        let asked = Asked::of(&field);
        for &i in &frames {
            pictures.push(plot::field::of_frame(&series, &regions, i, &asked, &field, options.clone())?);
        }
    }
    Ok(pictures)
}

/// The last frame of each phase, of the last phases where they are many.
fn ends(infos: &[Info]) -> Vec<usize> {
    let last = |&i: &usize| infos.get(i + 1).is_none_or(|next| next.phase != infos[i].phase);
    let mut ends: Vec<usize> = (1..infos.len()).filter(last).collect();
    ends.drain(..ends.len().saturating_sub(MOST));
    ends
}

/// The record of a stage: that of the run is in its own folder.
fn record(stage: &Stage, run: &RunFolder, name: &str) -> Option<Record> {
    let folder: &Path = if name == STAGE { run.path() } else { stage.folder() };
    Record::read(folder, name)
}
