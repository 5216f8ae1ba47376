//! The command line: one file a subcommand. Only [`main`] prints errors and decides the exit status.

mod args;
mod check;
mod completions;
mod export;
mod frames;
mod info;
mod man;
mod mesh;
mod new;
mod plot;
mod print;
mod report;
mod run;
mod seed;
mod signals;
mod solve;
mod stage;
mod sweep;

use crate::case;
use crate::error::Error;
use crate::mesh::gmsh;
use crate::program;
use args::StageArgs;
use clap::{CommandFactory, Parser, Subcommand};
use std::io::{self, Write};
use std::process::ExitCode;

/// Implicit second-order Material Point Method for geotechnics, from a Gmsh .geo file to ParaView.
///
/// Exit status: 0 done, 1 the analysis could not go on (everything until then is kept), 2 the input is
/// wrong, 3 something on the machine is missing, 130 stopped by Ctrl-C.
#[derive(Parser)]
#[command(name = "mpm", version = program::IDENTITY, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Write a folder with a case that runs, from a template: footing, penetration, anchor, slope, pipe, consolidation, silo, impact, wall, excavation, embankment, cpt, monopile
    New(new::Args),
    /// Mesh the .geo of a case: writes mesh.msh
    Mesh(mesh::Args),
    /// Fill the regions of the mesh with material points: writes points.vtu
    Seed(StageArgs),
    /// Solve the equations of motion: writes results/, history.csv, energy.csv, solve.log and checkpoints/
    Solve(solve::Args),
    /// Turn results/ into series for ParaView: writes vtu/ and .pvd
    Export(export::Args),
    /// All stages in turn, but those whose inputs have not changed
    Run(run::Args),
    /// Run a case for every combination of values of some of its entries: writes a folder a run and table.csv
    Sweep(sweep::Args),
    /// Print every mistake of a case, with file, line and remedy, and warnings of what is surely unmeant; writes nothing
    Check(check::Args),
    /// Draw curves of the histories of cases, or of output folders, as SVG or PNG
    Plot(Box<plot::Args>),
    /// Write one page on a run, whole in itself: scene, entries, curves, work of the solver, provenance
    Report(report::Args),
    /// Print what a file of mpm was made from, or those of an output folder: program, inputs, command, time
    Info(info::Args),
    /// Print the JSON schema of case.yaml, for editors
    Schema,
    /// Print what a shell needs to complete commands and options: bash, zsh, fish, …
    Completions(completions::Args),
    /// Write the manual pages into a folder, for man
    Man(man::Args),
    /// Gmsh in a process of its own, which `mesh` and `check` start
    #[command(name = gmsh::COMMAND, hide = true)]
    GmshWorker,
}

/// Runs the program on the arguments of the process.
pub fn main() -> ExitCode {
    let outcome = match Cli::parse().command {
        Command::New(args) => new::run(&args),
        Command::Mesh(args) => mesh::run(&args),
        Command::Seed(args) => seed::run(&args),
        Command::Solve(args) => solve::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Run(args) => run::run(&args),
        Command::Sweep(args) => sweep::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Plot(args) => plot::run(&args),
        Command::Report(args) => report::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Schema => print::print(&format!("{:#}\n", case::schema())),
        Command::Completions(args) => completions::run(&args, &Cli::command()),
        Command::Man(args) => man::run(&args, Cli::command()),
        Command::GmshWorker => gmsh::serve().map_err(Vec::from),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(errors) => {
            for error in &errors {
                // There is nowhere left to report that standard error is closed.
                let _ = writeln!(io::stderr(), "error: {error}");
            }
            ExitCode::from(errors.iter().map(Error::exit_status).max().unwrap_or(1))
        }
    }
}
