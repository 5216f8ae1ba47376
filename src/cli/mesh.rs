//! `mpm mesh`: from the `.geo`, or a mesh in its place, to `mesh.msh`.

use super::args::StageArgs;
use super::print::{Outcome, note, print};
use super::signals;
use super::stage::{Inputs, Stage};
use crate::case::checked::{Order, Source};
use crate::case::names::{Groups, Of};
use crate::case::raw::Product;
use crate::case::unconnected::{self, Place};
use crate::case::unmeant;
use crate::case::{checked, plates, scheme};
use crate::error::{Error, Result};
use crate::io::{atomic, provenance};
use crate::machine;
use crate::mesh::gmsh::{self, Options, Outline, Worker};
use crate::mesh::{Mesh, given, msh, quality};
use crate::reading;
use crate::run::WARNING;
use std::fs;
use std::path::{Path, PathBuf};

/// The name of the stage, in its record.
pub const STAGE: &str = "mesh";

/// How long Gmsh may work (s) and how much memory (GiB) it may take for a mesh.
const MESHING: [u64; 2] = [600, 8];

/// And for the names of the groups alone.
const NAMING: [u64; 2] = [20, 2];

#[derive(clap::Args)]
#[group(skip)]
pub struct Args {
    #[command(flatten)]
    stage: StageArgs,
    #[command(flatten)]
    gmsh: Gmsh,
}

/// What the user lets Gmsh do.
#[derive(clap::Args)]
pub struct Gmsh {
    #[command(flatten)]
    limits: Limits,
    /// Let the .geo execute programs and write files, as Gmsh itself does: only for a file that you trust
    #[arg(long)]
    allow_system_calls: bool,
}

/// What the user lets Gmsh take.
#[derive(clap::Args)]
pub struct Limits {
    /// The longest time that Gmsh may take [default: 600 for a mesh, 20 for its names alone]
    #[arg(long, value_name = "SECONDS", value_parser = clap::value_parser!(u64).range(1..=31_536_000))]
    mesh_timeout: Option<u64>,
    /// The most memory that Gmsh may take [default: 8 for a mesh, 2 for its names alone, or 3/4 of the machine's where that is less]
    #[arg(long, value_name = "GIB", value_parser = clap::value_parser!(u64).range(1..=65_536))]
    mesh_memory: Option<u64>,
}

impl Limits {
    /// How Gmsh is started by the program at `program`, for so many seconds and with so many GiB unless the user has said otherwise.
    fn worker<'a>(&self, program: &'a Path, [seconds, gib]: [u64; 2]) -> Worker<'a> {
        let memory = machine::memory("MemTotal").unwrap_or(u64::MAX);
        Worker {
            program,
            seconds: self.mesh_timeout.unwrap_or(seconds),
            memory: self.mesh_memory.map_or((memory / 4 * 3).min(gib * GIB), |gib| gib * GIB),
            analysis: memory / 4 * 3,
            filter: true,
            sandbox: true,
            stop: signals::stop(),
            warn: |text| note(&format!("{WARNING}{text}")),
        }
    }
}

const GIB: u64 = 1 << 30;

fn program() -> Result<PathBuf> {
    std::env::current_exe().map_err(|e| Error::machine("mpm", format!("it cannot find itself: {e}"), "mount /proc"))
}

pub fn run(args: &Args) -> Outcome {
    work(&Stage::open(&args.stage)?, &args.gmsh)
}

/// Whether `mesh.msh` is there and would come out the same, which nobody knows of a `.geo` that may execute programs.
///
/// # Errors
/// Input: a `.geo`, or what it includes, that cannot be read or does what it may not.
pub fn is_current(stage: &Stage, gmsh: &Gmsh) -> Result<bool> {
    Ok(!gmsh.allow_system_calls && inputs(stage)?.are_current(stage.folder(), &[stage.mesh()]))
}

/// Meshes, and prints a summary. An earlier mesh stays until the new one has passed every check.
///
/// # Errors
/// Input: names that the `.geo` does not have, one that does not mesh, cells of bad quality; a machine error where
/// files cannot be written.
pub fn work(stage: &Stage, gmsh: &Gmsh) -> Outcome {
    let case = &stage.loaded.case;
    let program = program()?;
    let allowed = gmsh.allow_system_calls;
    let worker = Worker { filter: !allowed, sandbox: !allowed, ..gmsh.limits.worker(&program, MESHING) };
    stage.lock()?;
    provenance::refuse_others(stage.folder(), STAGE, [stage.mesh()])?;
    let mut record = if allowed { unknown_inputs(stage)? } else { inputs(stage)? }.begin();
    let scratch = Scratch::new(stage)?;
    let candidate = scratch.folder.join("mesh.msh");
    let caught = signals::catch()?;
    let mut mesh = make(&case.mesh, &worker, &candidate, |groups| stage.loaded.check_names(&named(groups.clone())))?;
    drop(caught);
    if matches!(case.mesh.source, Source::Mesh(_)) {
        stage.loaded.check_names(&names_of(&mesh, Of::Given))?;
    }
    msh::seal(&candidate).map_err(|e| atomic::unwritable(&candidate, &e))?;
    let summary = quality::check(&mesh, case.mesh.source.path())?;
    plates::append(case, &mut mesh)?;
    let rename = || fs::rename(&candidate, stage.mesh()).map_err(|e| atomic::unwritable(&stage.mesh(), &e));
    record.around(stage.folder(), rename)?;
    scratch.keep_folder();
    record.finish(stage.folder(), &[stage.mesh()])?;
    record.write(stage.folder())?;
    print(&format!("{}\n{summary}\n", stage.mesh().display()))?;
    unmeant::on_mesh(case, &mesh)?.iter().for_each(|text| note(text));
    unconnected::nodes(case, &mesh).iter().try_for_each(|note| print(&format!("{note}\n")))
}

/// Makes the mesh at `out`, once `agree` has nothing against the names of a `.geo`, and reads it.
///
/// # Errors
/// As [`work`].
fn make(
    mesh: &checked::Mesh,
    worker: &Worker,
    out: &Path,
    agree: impl FnOnce(&gmsh::Groups) -> std::result::Result<(), Vec<Error>>,
) -> std::result::Result<Mesh<2>, Vec<Error>> {
    let unwritable = |e: std::io::Error| atomic::unwritable(out, &e);
    let file = mesh.source.path();
    match &mesh.source {
        Source::Geo(geo) => worker.mesh(geo, &options(mesh), out, agree)?,
        Source::Mesh(file) => match given::read(file)? {
            Some((bytes, notes)) => {
                fs::write(out, bytes).map_err(unwritable)?;
                notes.iter().for_each(|text| note(text));
            }
            None => worker.mesh(file, &options(mesh), out, |_| Ok(()))?,
        },
    }
    let bytes = msh::unsealed(reading::bytes(out).map_err(unwritable)?);
    let made = msh::parse(&bytes, &file.display().to_string())?;
    scheme::check_order(mesh, &made)?;
    Ok(made)
}

/// The only folder that Gmsh writes in, `.gmsh-<process>` in the output folder. It goes away with this, and the output
/// folder too where it was made for an attempt that failed.
struct Scratch {
    folder: PathBuf,
    made: Option<PathBuf>,
}

/// The marker of such folders.
const MARK: &str = ".gmsh-";

impl Scratch {
    fn new(stage: &Stage) -> Result<Self> {
        let made = (!stage.folder().exists()).then(|| stage.folder().to_owned());
        stage.prepare()?;
        // What killed processes have left.
        for entry in fs::read_dir(stage.folder()).into_iter().flatten().flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            let process = name.strip_prefix(MARK).and_then(|process| process.parse::<u32>().ok());
            if process.is_some_and(|p| p == std::process::id() || !Path::new(&format!("/proc/{p}")).exists()) {
                // Only tidiness; where it matters the next call says so.
                let _ = fs::remove_dir_all(entry.path());
            }
        }
        let folder = stage.folder().join(format!("{MARK}{}", std::process::id()));
        fs::create_dir(&folder).map_err(|e| atomic::unwritable(&folder, &e))?;
        Ok(Self { folder, made })
    }

    /// The output folder holds something now.
    fn keep_folder(mut self) {
        self.made = None;
    }
}

impl Drop for Scratch {
    fn drop(&mut self) {
        // Only tidiness: a next run does it again.
        let _ = fs::remove_dir_all(&self.folder);
        if let Some(made) = &self.made {
            let _ = fs::remove_dir(made);
        }
    }
}

/// The mesh of an earlier `mpm mesh`, checked as when it was made, and held against the names in the case; with the strips of the plates.
///
/// # Errors
/// Input: no mesh, one that cannot be read or has bad cells, and each name of the case that it does not have.
pub fn read(stage: &Stage) -> std::result::Result<Mesh<2>, Vec<Error>> {
    if !stage.mesh().exists() {
        let place = stage.mesh().display().to_string();
        return Err(Error::input(place, "there is no mesh yet", "run `mpm mesh` first, or `mpm run` for all").into());
    }
    let mut mesh = msh::read(&stage.mesh())?;
    quality::check(&mesh, &stage.mesh())?;
    stage.loaded.check_names(&names_of(&mesh, Of::Made))?;
    plates::append(&stage.loaded.case, &mut mesh)?;
    Ok(mesh)
}

/// The names of the groups of a mesh.
pub fn names_of(mesh: &Mesh<2>, of: Of) -> Groups {
    let named = |dimension| mesh.groups.iter().filter(move |g| g.dimension == dimension).map(|g| g.name.clone());
    Groups { surfaces: mesh.regions.clone(), curves: named(1).collect(), points: named(0).collect(), of }
}

/// The mesh of a case, checked as that of a run is, and kept nowhere.
///
/// # Errors
/// Input: a `.geo` that does not mesh or that does what it may not, cells of bad quality; `Machine` where there is no room for it.
pub fn generated(mesh: &checked::Mesh, limits: &Limits) -> std::result::Result<Mesh<2>, Vec<Error>> {
    let folder = tempfile::tempdir().map_err(|e| atomic::unwritable(&std::env::temp_dir(), &e))?;
    let path = folder.path().join("mesh.msh");
    let program = program()?;
    let caught = signals::catch()?;
    let generated = make(mesh, &limits.worker(&program, MESHING), &path, |_| Ok(()))?;
    drop(caught);
    quality::check(&generated, mesh.source.path())?;
    Ok(generated)
}

/// The names of the groups of the `.geo`, and where its regions lie, without meshing it.
///
/// # Errors
/// Input: a `.geo` that Gmsh does not read, that does what it may not, or that lacks a parameter.
pub fn groups(mesh: &checked::Mesh, limits: &Limits) -> Result<(Groups, Vec<Place>)> {
    let groups = limits.worker(&program()?, NAMING).groups(mesh.source.path(), &options(mesh))?;
    let outlines = groups.surfaces.iter().zip(&groups.outlines);
    let place = |(name, Outline { bounds, curves }): (&String, &Outline)| Place {
        name: name.clone(),
        bounds: *bounds,
        parts: curves.clone(),
    };
    let places = outlines.map(place).collect();
    Ok((named(groups), places))
}

fn named(groups: gmsh::Groups) -> Groups {
    let gmsh::Groups { surfaces, curves, points, .. } = groups;
    Groups { surfaces, curves, points, of: Of::Geo }
}

fn options(mesh: &checked::Mesh) -> Options {
    let (order, incomplete) = match mesh.order {
        Some(Order::First) => (1, false),
        Some(Order::Second) | None => (2, false),
        Some(Order::SecondIncomplete) => (2, true),
        Some(Order::Third) => (3, false),
    };
    Options { order, incomplete, parameters: mesh.parameters.iter().map(|(name, &v)| (name.clone(), v)).collect() }
}

fn inputs(stage: &Stage) -> Result<Inputs> {
    let file = stage.loaded.case.mesh.source.path();
    // What is read here names no other file.
    match &stage.loaded.case.mesh.source {
        Source::Mesh(file) if given::is_abaqus(file) => unknown_inputs(stage),
        _ => stage.inputs(STAGE, Product::Mesh, &gmsh::sources(file)?.files),
    }
}

/// Those of a `.geo` that may read whatever it likes: what is known of them.
fn unknown_inputs(stage: &Stage) -> Result<Inputs> {
    stage.inputs(STAGE, Product::Mesh, &[stage.loaded.case.mesh.source.path().to_owned()])
}
