//! `mpm plot`: curves of histories, or pictures of a field.

mod curves;
pub mod field;

use super::print::Outcome;
use crate::case::Keys;
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Args {
    /// Cases (a case.yaml or its folder) or output folders, whose curves are drawn together
    #[arg(required = true)]
    cases: Vec<PathBuf>,
    /// The picture, by its ending an SVG or a PNG [default: history.svg, or the field's name, in the output folder]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    curves: curves::Args,
    #[command(flatten)]
    field: field::Args,
}

pub fn run(args: &Args, keys: &Keys) -> Outcome {
    if let Some(name) = &args.field.field {
        return args
            .cases
            .iter()
            .try_for_each(|case| field::run(case, args.output.as_deref(), name, &args.field, keys));
    }
    curves::run(&args.cases, args.output.as_deref(), &args.curves, args.field.unfinished, keys)
}
