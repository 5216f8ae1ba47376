//! Whether the points of `points.vtu` are ones that `mpm seed` puts into this case and mesh: the analysis takes it for granted.

use super::checked::{Case, Content};
use super::find::{filled, region_index};
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::points::{Column, Item, Points, Visitor};
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
    struct OfTheAnalysis(Option<&'static str>);
    impl Visitor<'_> for OfTheAnalysis {
        fn visit<T: Item>(&mut self, column: &'static Column, values: &[T]) {
            if !column.seeded && !values.is_empty() {
                self.0.get_or_insert(column.name);
            }
        }
    }
    let mut found = OfTheAnalysis(None);
    points.each(&mut found);
    match found.0 {
        Some(name) => Err(foreign(format!("it has a column `{name}`, which seeding does not write"))),
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

/// The points that the cells of each region of the mesh are seeded with.
///
/// # Errors
/// Input: a region that the mesh lacks.
pub fn points_per_cell(case: &Case, mesh: &Mesh<2>) -> Result<Vec<u32>> {
    let mut seeded = vec![0; mesh.regions.len()];
    for region in &case.regions {
        if let Content::Mpm { points_per_cell, .. } = region.content {
            seeded[usize::from(region_index(mesh, &region.name)?)] = points_per_cell as u32;
        }
    }
    Ok(seeded)
}
