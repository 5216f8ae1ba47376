//! What a case names, in its mesh.

use super::checked::{Case, Content, Material, Region};
use crate::error::{Error, Result};
use crate::mesh::{Group, Mesh, cell_size};

/// The regions with points and their materials.
pub fn filled(case: &Case) -> impl Iterator<Item = (&Region, &Material)> {
    case.regions.iter().filter_map(|region| Some((region, &case.materials[region.content.material()?])))
}

/// The mean size of the cells of a mesh (m).
pub fn mean_size(mesh: &Mesh<2>) -> f64 {
    let cells = mesh.cells.len();
    (0..cells).map(|c| cell_size(mesh, c)).sum::<f64>() / cells as f64
}

/// Whether each region of the mesh is what is asked.
pub fn regions(case: &Case, mesh: &Mesh<2>, is: impl Fn(&Content) -> bool) -> Vec<bool> {
    mesh.regions.iter().map(|name| case.content(name).is_some_and(|content| is(&content))).collect()
}

/// The number of a region of the mesh.
///
/// # Errors
/// `Input` where it has none of that name.
pub fn region_index(mesh: &Mesh<2>, name: &str) -> Result<u16> {
    mesh.regions.iter().position(|r| r == name).map(|i| i as u16).ok_or_else(|| {
        Error::input(
            "mesh.msh",
            format!("it has no region `{name}`; it has {}", mesh.regions.join(", ")),
            "run `mpm mesh` again",
        )
    })
}

/// A curve of the mesh.
///
/// # Errors
/// `Input` where it has none of that name.
pub fn group<'a>(mesh: &'a Mesh<2>, name: &str) -> Result<&'a Group> {
    mesh.group(name)
        .ok_or_else(|| Error::input("mesh.msh", format!("it has no curve `{name}`"), "run `mpm mesh` again"))
}
