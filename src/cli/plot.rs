//! `mpm plot`: curves of histories.

mod curves;

use super::print::Outcome;
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Args {
    /// Cases (a case.yaml or its folder) or output folders, whose curves are drawn together
    #[arg(required = true)]
    cases: Vec<PathBuf>,
    /// The picture, by its ending an SVG or a PNG [default: history.svg in the output folder of the first]
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    #[command(flatten)]
    curves: curves::Args,
}

pub fn run(args: &Args) -> Outcome {
    curves::run(&args.cases, args.output.as_deref(), &args.curves)
}
