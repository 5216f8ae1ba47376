//! `mpm seed`: from `mesh.msh` to `points.vtu`.

use super::stage::{Stage, Stamp};
use super::{Outcome, StageArgs, mesh, print};
use crate::case::seeding;
use crate::error::Result;
use crate::io::points_vtu;

pub fn run(args: &StageArgs) -> Outcome {
    work(&Stage::open(args)?)
}

/// Whether `points.vtu` is there and would come out the same.
///
/// # Errors
/// A `mesh.msh` that cannot be read.
pub fn is_current(stage: &Stage) -> Result<bool> {
    Ok(stamp(stage)?.is_current(&[stage.points()]))
}

/// Seeds, and prints a summary, with what does not bear its initial stress. Earlier points stay until the new ones are written.
pub fn work(stage: &Stage) -> Outcome {
    let mesh = mesh::read(stage)?;
    let points = seeding::points(&stage.loaded.case, &mesh)?;
    stage.prepare()?;
    points_vtu::write(&stage.points(), &points, &mesh.regions)?;
    stamp(stage)?.write(&[stage.points()])?;
    for note in seeding::notes(&stage.loaded.case, &mesh, &points)? {
        print(&format!("{note}\n"))?;
    }
    let mass: f64 = points.mass.iter().sum();
    print(&format!("{}: {} points, {mass} t\n", stage.points().display(), points.len()))
}

fn stamp(stage: &Stage) -> Result<Stamp> {
    let mut keys = vec!["geometry", "regions", "materials", "gravity", "water"];
    keys.extend(["initial_stress", "initial_pore_pressure", "initial_velocity"]);
    if stage.loaded.case.water.is_some() {
        // The soil begins under the water of the first phase.
        keys.push("phases");
    }
    stage.stamp("seed", &keys, &[stage.mesh()])
}
