//! `mpm mesh`: from the `.geo` to `mesh.msh`.

use super::stage::{Inputs, Stage};
use super::{Outcome, StageArgs, print};
use crate::case::checked;
use crate::case::names::Groups;
use crate::error::{Error, Result};
use crate::io::atomic;
use crate::mesh::gmsh::{self, Options};
use crate::mesh::{Mesh, msh, quality};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

pub fn run(args: &StageArgs) -> Outcome {
    work(&Stage::open(args)?)
}

/// Whether `mesh.msh` is there and would come out the same.
///
/// # Errors
/// Input: a `.geo`, or what it includes, that cannot be read.
pub fn is_current(stage: &Stage) -> Result<bool> {
    Ok(inputs(stage)?.are_current(stage.folder(), &[stage.mesh()]))
}

/// Meshes, and prints a summary. An earlier mesh stays until the new one has passed every check.
///
/// # Errors
/// Input: names that the `.geo` does not have, one that does not mesh, cells of bad quality; a machine error where
/// files cannot be written.
pub fn work(stage: &Stage) -> Outcome {
    let case = &stage.loaded.case;
    stage.lock()?;
    let mut record = inputs(stage)?.begin();
    stage.loaded.check_names(&groups(&case.mesh)?)?;
    stage.prepare()?;
    let candidate = stage.folder().join(".candidate.msh");
    let summary = gmsh::generate(&case.mesh.geo, &options(&case.mesh), &candidate)
        .and_then(|()| msh::seal(&candidate).map_err(|e| atomic::unwritable(&candidate, &e)))
        .and_then(|()| quality::check(&msh::read(&candidate)?, &case.mesh.geo))
        .and_then(|summary| {
            fs::rename(&candidate, stage.mesh()).map_err(|e| atomic::unwritable(&stage.mesh(), &e))?;
            Ok(summary)
        });
    if summary.is_err() {
        // What is left of the attempt; that it may not exist is no further error.
        let _ = fs::remove_file(&candidate);
    }
    let summary = summary?;
    record.finish(stage.folder(), &[stage.mesh()])?;
    record.write(stage.folder())?;
    print(&format!("{}\n{summary}\n", stage.mesh().display()))
}

/// The mesh of an earlier `mpm mesh`, checked as when it was made, and held against the names in the case.
///
/// # Errors
/// Input: no mesh, one that cannot be read or has bad cells, and each name of the case that it does not have.
pub fn read(stage: &Stage) -> std::result::Result<Mesh<2>, Vec<Error>> {
    if !stage.mesh().exists() {
        let place = stage.mesh().display().to_string();
        return Err(Error::input(place, "there is no mesh yet", "run `mpm mesh` first, or `mpm run` for all").into());
    }
    let mesh = msh::read(&stage.mesh())?;
    quality::check(&mesh, &stage.mesh())?;
    let named = |dimension| mesh.groups.iter().filter(move |g| g.dimension == dimension).map(|g| g.name.clone());
    let (curves, points) = (named(1).collect(), named(0).collect());
    let groups = Groups { surfaces: mesh.regions.clone(), curves, points, meshed: true };
    stage.loaded.check_names(&groups)?;
    Ok(mesh)
}

/// The names of the groups of the `.geo`, without meshing it.
///
/// # Errors
/// Input: a `.geo` that Gmsh does not read, or that lacks a parameter.
pub fn groups(mesh: &checked::Mesh) -> Result<Groups> {
    let gmsh::Groups { surfaces, curves, points } = gmsh::groups(&mesh.geo, &options(mesh))?;
    Ok(Groups { surfaces, curves, points, meshed: false })
}

fn options(mesh: &checked::Mesh) -> Options {
    let (order, incomplete) = match mesh.order {
        checked::Order::First => (1, false),
        checked::Order::Second => (2, false),
        checked::Order::SecondIncomplete => (2, true),
    };
    Options { order, incomplete, parameters: mesh.parameters.iter().map(|(name, &v)| (name.clone(), v)).collect() }
}

fn inputs(stage: &Stage) -> Result<Inputs> {
    let mut files = BTreeSet::new();
    include(&stage.loaded.case.mesh.geo, &mut files);
    stage.inputs("mesh", &["mesh"], &files.into_iter().collect::<Vec<_>>())
}

/// A `.geo` and what it includes or merges.
fn include(geo: &Path, files: &mut BTreeSet<PathBuf>) {
    if !files.insert(geo.to_owned()) {
        return;
    }
    // A file that cannot be read is missed when it is hashed, with its name.
    let text = fs::read(geo).unwrap_or_default();
    for line in String::from_utf8_lossy(&text).lines() {
        let line = line.trim_start();
        let name = line.strip_prefix("Include").or(line.strip_prefix("Merge")).and_then(|rest| rest.split('"').nth(1));
        if let Some(name) = name {
            include(&geo.with_file_name("").join(name), files);
        }
    }
}
