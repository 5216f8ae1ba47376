//! `mpm run`: all stages in turn, but those whose inputs have not changed. An analysis that cannot go on is exported as far as it came.

use super::print::{Outcome, note, print};
use super::stage::Stage;
use super::{export, mesh, seed, solve, sweep};
use crate::error::{Kind, Result};
use crate::io::run_folder::STAGE;

#[derive(clap::Args)]
#[group(skip)]
pub struct Args {
    #[command(flatten)]
    solve: solve::Args,
    #[command(flatten)]
    gmsh: mesh::Gmsh,
    /// Stop after this stage
    #[arg(long, value_name = "STAGE", value_parser = [mesh::STAGE, seed::STAGE, STAGE, export::STAGE])]
    until: Option<String>,
    /// Ends with the process of this number, which has started this one
    #[arg(long, hide = true, value_name = "PROCESS")]
    end_with: Option<u32>,
}

/// A stage: its name, whether it may be skipped, and its work.
type Entry<'a> = (&'static str, &'a dyn Fn(&Stage) -> Result<bool>, &'a dyn Fn(&Stage) -> Outcome);

pub fn run(args: &Args) -> Outcome {
    args.end_with.map_or(Ok(()), sweep::end_with)?;
    let stage = Stage::open(&args.solve.stage)?;
    stage.lock()?;
    let stages: [Entry; 4] = [
        (mesh::STAGE, &|stage| mesh::is_current(stage, &args.gmsh), &|stage| mesh::work(stage, &args.gmsh)),
        (seed::STAGE, &seed::is_current, &seed::work),
        (STAGE, &solve::is_current, &|stage| solve::work(stage, args.solve.start)),
        (export::STAGE, &export::is_current, &export::results),
    ];
    for (name, is_current, work) in stages {
        let is_last = args.until.as_deref().unwrap_or(export::STAGE) == name;
        if is_current(&stage)? {
            // With `--until` a stage is told of by its own command.
            if is_last || args.until.is_none() {
                print(&format!("{name}: nothing has changed\n"))?;
            }
        } else {
            work(&stage).inspect_err(|errors| {
                if name == STAGE && errors.iter().any(|error| error.kind == Kind::Analysis) {
                    // What it came to is shown all the same.
                    let shown = export::unfinished_run(&stage);
                    shown.unwrap_or_else(|errors| errors.iter().for_each(|error| note(&format!("export: {error}"))));
                }
            })?;
        }
        if is_last {
            break;
        }
    }
    Ok(())
}
