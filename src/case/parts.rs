//! The parts of a mesh: the background grid with its material points, and the finite elements with theirs.
//!
//! Both number the nodes as the whole mesh does; cells are numbered in each part in their order in the whole.

use super::checked::{Case, Content, Geometry, Phase, Restore};
use super::find::{group, regions};
use crate::error::{Error, Result};
use crate::io::export::Regions;
use crate::mesh::locate::Locator;
use crate::mesh::{Group, Mesh};
use crate::points::Points;
use std::collections::{BTreeMap, HashSet};

/// What the regions of a mesh are for the series of its results.
pub fn of_series(case: &Case, mesh: &Mesh<2>) -> Regions {
    let material = |name: &String| case.content(name).and_then(|content| content.material());
    let is_soil = |name| material(name).is_some() && !case.content(name).is_some_and(|content| content.is_structure());
    let number = |name: &String| mesh.regions.iter().position(|r| r == name).map(|r| r as u16);
    let absent = |phase: &Phase| (phase.name.clone(), phase.absent.iter().filter_map(number).collect());
    let mut now: Vec<u16> = mesh.regions.iter().map(|name| material(name).unwrap_or(0) as u16).collect();
    let mut materials = BTreeMap::new();
    for phase in &case.phases {
        for change in &phase.changes {
            if let Some(changed) = number(&case.regions[change.region].name) {
                now[changed as usize] = change.material as u16;
            }
        }
        materials.insert(phase.name.clone(), now.clone());
    }
    Regions {
        materials,
        elements: regions(case, mesh, Content::is_fem),
        soil: mesh.regions.iter().map(is_soil).collect(),
        plates: case
            .named_plates()
            .filter_map(|(name, _)| Some((number(&name.to_owned())?, name.to_owned())))
            .collect(),
        axisymmetric: case.geometry == Geometry::Axisymmetric,
        resets: case.phases.iter().filter(|phase| phase.reset_displacements).map(|phase| phase.name.clone()).collect(),
        absent: case.phases.iter().map(absent).collect(),
        changes: case.phases.iter().any(|phase| !phase.removed.is_empty() || phase.coming().next().is_some()),
    }
}

/// The background grid of a mesh, and its finite elements if it has some.
pub fn meshes(case: &Case, mesh: Mesh<2>) -> (Mesh<2>, Option<Mesh<2>>) {
    let of_elements = regions(case, &mesh, Content::is_fem);
    let is_fem = |c: usize| of_elements[mesh.cells.region[c] as usize];
    let fem = mesh.part(is_fem);
    if fem.cells.is_empty() {
        return (mesh, None);
    }
    (mesh.part(|c| !is_fem(c)), Some(fem))
}

/// Whether a curve is one of finite elements: they have all of its nodes.
pub fn carries(fem: &Mesh<2>, curve: &Group) -> bool {
    let of: HashSet<u32> = fem.cells.nodes.iter().copied().collect();
    curve.nodes.iter().all(|n| of.contains(n))
}

/// A curve of the `mesh` that moves with the material of bodies that deform, for what acts at `place`.
///
/// # Errors
/// Input: a curve that the mesh lacks, or one of a grid that does not move with the material.
pub fn material_curve<'a>(
    case: &Case,
    (mesh, elements): (&'a Mesh<2>, Option<&Mesh<2>>),
    name: &str,
    place: impl Fn() -> String,
) -> Result<&'a Group> {
    let curve = group(mesh, name)?;
    let moves = case.numerics.solver.restore == Restore::Never;
    if !moves && !elements.is_some_and(|elements| carries(elements, curve)) {
        return Err(Error::input(
            place(),
            "the curve is not one of finite elements, and the grid does not move with the material",
            "set `restore: never` under `numerics`, or make the region beside it `kind: fem`",
        ));
    }
    Ok(curve)
}

/// The material points and those of the finite elements, numbered with the cells of their parts, of all `points`
/// of the whole mesh.
pub fn points(case: &Case, mesh: &Mesh<2>, mut points: Points<2>) -> [Points<2>; 2] {
    let of_elements = regions(case, mesh, Content::is_fem);
    let part = |c: usize| usize::from(of_elements[mesh.cells.region[c] as usize]);
    let mut count = [0; 2];
    let mut number = Vec::with_capacity(mesh.cells.len());
    for c in 0..mesh.cells.len() {
        number.push(count[part(c)]);
        count[part(c)] += 1;
    }
    let mut of = [Vec::new(), Vec::new()];
    for (p, cell) in points.cell.iter_mut().enumerate() {
        of[part(*cell as usize)].push(p);
        *cell = number[*cell as usize];
    }
    if of[1].is_empty() {
        return [points, Points::default()];
    }
    // Finite elements first, then rigid structures.
    let rigid = regions(case, mesh, Content::is_rigid);
    of[1].sort_by_key(|&p| rigid[points.region[p] as usize]);
    of.map(|numbers| points.select(&numbers))
}

/// Where the points of finite elements are in their cells, parametrically.
///
/// # Errors
/// Input: a point that is not in its cell.
pub fn places(mesh: &Mesh<2>, points: &Points<2>) -> Result<Vec<[f64; 3]>> {
    let locator = Locator::new(mesh);
    let place = |(x, &cell): (&[f64; 2], &u32)| match locator.locate(mesh, x, Some(cell)) {
        Some((found, xi)) if found == cell => Ok(xi),
        _ => Err(Error::input(
            "points.vtu",
            format!("the point of a finite element at {x:?} m is not in it"),
            "run `mpm seed` again",
        )),
    };
    points.position.iter().zip(&points.cell).map(place).collect()
}
