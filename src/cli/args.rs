//! Arguments that subcommands share.

use clap::Args;
use std::path::PathBuf;

/// What every subcommand that reads a case takes.
#[derive(Args, Clone)]
pub struct CaseArgs {
    /// A case.yaml, or the folder that holds one
    pub case: PathBuf,
    /// Override an entry of the case, e.g. mesh.parameters.h=0.1 or phases[0].duration=2
    #[arg(long = "set", value_name = "PATH=VALUE")]
    pub overrides: Vec<String>,
}

/// What every subcommand that writes takes.
#[derive(Args, Clone)]
pub struct StageArgs {
    #[command(flatten)]
    pub case: CaseArgs,
    /// The output folder [default: out/ beside the case]
    #[arg(short, long, value_name = "DIR")]
    pub output: Option<PathBuf>,
    /// The number of threads [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub threads: Option<u16>,
}
