//! The command line: one file a subcommand. Only [`main`] prints errors and decides the exit status.

mod check;
mod export;
mod info;
mod mesh;
mod run;
mod schema;
mod seed;
mod signals;
mod solve;
mod stage;

use crate::error::{Error, plain_lines};
use crate::mesh::gmsh;
use crate::program;
use clap::{Args, Parser, Subcommand};
use std::io::{self, Write};
use std::path::PathBuf;
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
    /// Mesh the .geo of a case: writes mesh.msh
    Mesh(mesh::Args),
    /// Fill the regions of the mesh with material points: writes points.vtu
    Seed(StageArgs),
    /// Solve the equations of motion: writes results/, history.csv, solve.log and checkpoints/
    Solve(solve::Args),
    /// Turn results/ into series for ParaView: writes vtu/ and .pvd
    Export(export::Args),
    /// All stages in turn, but those whose inputs have not changed
    Run(run::Args),
    /// Print every mistake of a case that shows without its mesh, with file, line and remedy; writes nothing
    Check(check::Args),
    /// Print what a file of mpm was made from, or those of an output folder: program, inputs, command, time
    Info(info::Args),
    /// Print the JSON schema of case.yaml, for editors
    Schema,
    /// Gmsh in a process of its own, which `mesh` and `check` start
    #[command(name = gmsh::COMMAND, hide = true)]
    GmshWorker,
}

/// What every subcommand that reads a case takes.
#[derive(Args, Clone)]
struct CaseArgs {
    /// A case.yaml, or the folder that holds one
    case: PathBuf,
    /// Override an entry of the case, e.g. mesh.parameters.h=0.1 or phases[0].duration=2
    #[arg(long = "set", value_name = "PATH=VALUE")]
    overrides: Vec<String>,
}

/// What every subcommand that writes takes.
#[derive(Args, Clone)]
struct StageArgs {
    #[command(flatten)]
    case: CaseArgs,
    /// The output folder [default: out/ beside the case]
    #[arg(short, long, value_name = "DIR")]
    output: Option<PathBuf>,
    /// The number of threads [default: one a core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
}

/// What went wrong, and all of it.
type Outcome = Result<(), Vec<Error>>;

/// Runs the program on the arguments of the process.
pub fn main() -> ExitCode {
    let outcome = match Cli::parse().command {
        Command::Mesh(args) => mesh::run(&args),
        Command::Seed(args) => seed::run(&args),
        Command::Solve(args) => solve::run(&args),
        Command::Export(args) => export::run(&args),
        Command::Run(args) => run::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Schema => schema::run(),
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

/// Prints to standard output, without what a terminal would obey; a reader that has gone (`| head`) is no error.
///
/// # Errors
/// Standard output that cannot be written, such as a full disk behind it.
fn print(text: &str) -> Outcome {
    let mut out = io::stdout().lock();
    match out.write_all(plain_lines(text).as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != io::ErrorKind::BrokenPipe => {
            Err(vec![Error::machine("standard output", e, "make room, or send it elsewhere")])
        }
        _ => Ok(()),
    }
}

/// Prints a line on standard error, where progress and notes go; nobody may be listening.
fn note(text: &str) {
    let _ = writeln!(io::stderr(), "{}", plain_lines(text));
}
