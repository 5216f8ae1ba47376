//! Whether the points of `points.vtu` are ones that `mpm seed` puts into this case and mesh: the analysis takes it for granted.

use super::checked::Case;
use super::find::filled;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::points::Points;
use rayon::prelude::*;

/// What rounding and the inversion of a curved cell leave of a parametric place (-).
const NEAR: f64 = 1e-6;

/// Checks points against the whole mesh, before they are parted.
///
/// # Errors
/// `Input`: a point without a cell, a region or a material, one whose state no material can have, or a column that
/// seeding leaves to the analysis.
pub fn check(case: &Case, mesh: &Mesh<2>, points: &Points<2>) -> Result<()> {
    points.check(mesh.regions.len(), mesh.cells.len()).map_err(foreign)?;
    let filled: Vec<bool> = mesh.regions.iter().map(|name| filled(case).any(|(r, _)| r.name == *name)).collect();
    let stray = |&p: &usize| {
        let region = points.region[p];
        region != mesh.cells.region[points.cell[p] as usize] || !filled[usize::from(region)]
    };
    if let Some(p) = (0..points.len()).find(stray) {
        return Err(foreign(format!("{} is in a region that is not that of its cell, or holds none", points.name(p))));
    }
    let of_the_analysis = [
        ("reference", points.reference.is_empty()),
        ("acceleration", points.acceleration.is_empty()),
        ("plastic_increment", points.plastic_increment.is_empty()),
        ("internal", points.internal.is_empty()),
        ("pressure", points.pressure.is_empty()),
        ("model", points.model.is_empty()),
    ];
    match of_the_analysis.iter().find(|(_, absent)| !absent) {
        Some((name, _)) => Err(foreign(format!("it has a column `{name}`, which seeding does not write"))),
        None => Ok(()),
    }
}

/// Checks that the points of the grid are in their cells.
///
/// # Errors
/// `Input`: the first one that is not.
pub fn check_places(mesh: &Mesh<2>, locator: &Locator<2>, points: &Points<2>) -> Result<()> {
    let outside = |p: &usize| {
        let (cell, x) = (points.cell[*p], &points.position[*p]);
        let depth = locator.extend(mesh, cell, x).map(|xi| mesh.cells.kind[cell as usize].depth(&xi).0);
        !depth.is_some_and(|depth| depth >= -NEAR)
    };
    match (0..points.len()).into_par_iter().with_min_len(1024).find_first(outside) {
        Some(p) => Err(foreign(format!("{} is not in its cell", points.name(p)))),
        None => Ok(()),
    }
}

fn foreign(problem: String) -> Error {
    Error::input("points.vtu", problem, "run `mpm seed` again")
}
