//! `mpm report`: one page on a run.

use super::args::{CaseArgs, StageArgs};
use super::print::{Outcome, print};
use super::stage::Stage;
use super::{mesh, solve};
use crate::case::Keys;
use crate::draw::history::Run;
use crate::error::Error;
use crate::io::atomic;
use crate::io::provenance::Record;
use crate::io::run_folder::{STAGE, Standing};
use crate::report::Subject;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

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
    /// Report on the run that was not finished, where there is a finished one too
    #[arg(long)]
    unfinished: bool,
}

pub fn run(args: &Args, keys: &Keys) -> Outcome {
    let stage = StageArgs { case: args.case.clone(), output: args.from.clone(), threads: None };
    let stage = Stage::open(&stage, keys)?;
    let path = args.output.clone().unwrap_or_else(|| stage.folder().join("report.html"));
    if !path.extension().is_some_and(|kind| kind == "html" || kind == "htm") {
        return Err(Error::input(path.display(), "a report is HTML", "let the name end in .html").into());
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
    let now = humantime::format_rfc3339_seconds(SystemTime::now()).to_string();
    let mesh = match &mesh {
        Ok(mesh) => Ok(mesh),
        Err(errors) => Err(errors.first().map_or_else(String::new, ToString::to_string)),
    };
    let subject = Subject { loaded: &stage.loaded, keys, mesh, run: &run, records: &records, cautions: &cautions, now };
    let page = subject.page()?;
    atomic::write(&path, |out| out.write_all(page.as_bytes()))?;
    print(&format!("{}\n", path.display()))
}

/// The record of a stage: that of the run is in its own folder.
fn record(stage: &Stage, run: &crate::io::run_folder::RunFolder, name: &str) -> Option<Record> {
    let folder: &Path = if name == STAGE { run.path() } else { stage.folder() };
    Record::read(folder, name)
}
