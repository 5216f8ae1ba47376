//! `mpm seed`: from `mesh.msh` to `points.vtu`.

use super::args::StageArgs;
use super::mesh;
use super::print::{Outcome, note, print};
use super::stage::{Inputs, Stage};
use crate::case::raw::Product;
use crate::case::{at_rest, seeding};
use crate::error::Result;
use crate::io::points_vtu::{self, Source};
use crate::io::{hash, provenance};

/// The name of the stage, in its record.
pub const STAGE: &str = "seed";

pub fn run(args: &StageArgs) -> Outcome {
    work(&Stage::open(args)?)
}

/// Whether `points.vtu` is there and would come out the same.
///
/// # Errors
/// A `mesh.msh` that cannot be read.
pub fn is_current(stage: &Stage) -> Result<bool> {
    Ok(inputs(stage)?.are_current(stage.folder(), &[stage.points()]))
}

/// Seeds, and prints a summary, with what does not bear its initial stress. Earlier points stay until the new ones are written.
pub fn work(stage: &Stage) -> Outcome {
    stage.lock()?;
    provenance::refuse_others(stage.folder(), STAGE, [stage.points()])?;
    let mesh = mesh::read(stage)?;
    let mut record = inputs(stage)?.begin();
    let points = seeding::points(&stage.loaded.case, &mesh)?;
    stage.prepare()?;
    let source = source(stage)?;
    record.around(stage.folder(), || points_vtu::write(&stage.points(), &points, &mesh.regions, &source))?;
    record.finish(stage.folder(), &[stage.points()])?;
    record.write(stage.folder())?;
    for note in seeding::notes(&stage.loaded.case, &mesh, &points)? {
        print(&format!("{note}\n"))?;
    }
    at_rest::imbalance(&stage.loaded.case, &mesh)?.iter().for_each(|warning| note(warning));
    let mass: f64 = points.mass.iter().sum();
    print(&format!("{}: {} points, {mass} t\n", stage.points().display(), points.len()))
}

/// What the points of this case are seeded from.
///
/// # Errors
/// A `mesh.msh` that cannot be read.
pub fn source(stage: &Stage) -> Result<Source> {
    let mesh = hash::file(&stage.mesh(), "run `mpm mesh` first")?;
    Ok(Source { mesh: hash::text(mesh), case: hash::text(stage.hash_of(Product::Points)) })
}

fn inputs(stage: &Stage) -> Result<Inputs> {
    stage.inputs(STAGE, Product::Points, &[stage.mesh()])
}
