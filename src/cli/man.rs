//! `mpm man`: the manual pages of the program and its commands, for man(1).

use super::print::{Outcome, print};
use crate::error::Error;
use crate::io::atomic;
use clap::Command;
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct Args {
    /// The folder of the pages, such as ~/.local/share/man/man1
    folder: PathBuf,
}

pub fn run(args: &Args, command: Command) -> Outcome {
    atomic::prepare_folder(&args.folder)?;
    let folder = args.folder.display();
    clap_mangen::generate_to(command, &args.folder)
        .map_err(|e| Error::machine(&folder, e, "make room, or name another folder"))?;
    print(&format!("{folder}: mpm.1 and a page for each command, such as mpm-solve.1\n"))
}
