//! `mpm plot`: curves of histories, or pictures of a field.

mod along;
mod curves;
pub mod field;
mod plate;
mod table;

use super::print::Outcome;
use crate::error::Error;
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Args {
    /// Cases (a case.yaml or its folder) or output folders, whose curves are drawn together; or the table.csv of a sweep
    #[arg(required = true)]
    cases: Vec<PathBuf>,
    /// The picture, by its ending an SVG or a PNG [default: history.svg, energy.svg or the field's name, in the output folder]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    curves: curves::Args,
    #[command(flatten)]
    field: field::Args,
    /// Draw the displacement of a plate and the forces in its sections along its axis, at the last frame, or at --times
    #[arg(long, value_name = "NAME", conflicts_with_all = ["field", "x", "y", "iterations", "energy", "distribution"])]
    plate: Option<String>,
}

pub fn run(args: &Args) -> Outcome {
    if let Some(name) = &args.field.field {
        return args
            .cases
            .iter()
            .try_for_each(|case| field::run(case, args.output.as_deref(), name, &args.field, &args.curves));
    }
    if args.plate.is_none() && !args.field.times.is_empty() {
        return Err(Error::input("--times", "they are times of frames", "add --field or --plate").into());
    }
    if let Some(name) = &args.plate {
        return args.cases.iter().try_for_each(|case| plate::run(case, args.output.as_deref(), name, &args.field));
    }
    let tables: Vec<PathBuf> = args.cases.iter().filter_map(|path| table::of(path)).collect();
    match &tables[..] {
        [] => {}
        [table] if args.cases.len() == 1 && !args.curves.iterations && !args.curves.energy => {
            return table::run(table, args.output.as_deref(), &args.curves);
        }
        [table, ..] => {
            let problem = "a table of a sweep is drawn alone, and has no steps";
            return Err(Error::input(
                table.display(),
                problem,
                "name nothing else, and leave --iterations and --energy out",
            )
            .into());
        }
    }
    if args.curves.distribution {
        let problem = "a run alone has no distribution";
        return Err(Error::input("--distribution", problem, "name the table.csv of a sweep").into());
    }
    curves::run(&args.cases, args.output.as_deref(), &args.curves, args.field.unfinished)
}
