//! `mpm completions`: what a shell needs to complete the commands and options of the program.

use super::print::{Outcome, print};
use crate::error::Error;
use clap::Command;
use clap_complete::{Shell, generate};

#[derive(clap::Args)]
pub struct Args {
    /// The shell
    shell: Shell,
}

pub fn run(args: &Args, command: &Command) -> Outcome {
    let shown = command.get_subcommands().filter(|command| !command.is_hide_set()).cloned();
    let mut script = Vec::new();
    generate(args.shell, &mut Command::new("mpm").version("").subcommands(shown), "mpm", &mut script);
    let script = String::from_utf8(script).map_err(|e| Error::machine("the script", e, ""))?;
    print(&script)
}
