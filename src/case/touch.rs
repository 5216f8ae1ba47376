//! The structures of a case and what they touch.

use super::checked::{Case, Geometry};
use super::scene::region_index;
use crate::contact::{Boundary, Pair, Rigid, Surface};
use crate::error::{Error, Result};
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::rigid::Body;
use std::marker::PhantomData;

/// Distance of the hats (-), in the length of an edge of the grid: that of its nodes.
const HATS: f64 = 0.5;

/// The pairs of a case, given the grid and the finite elements.
///
/// # Errors
/// Input: a region that the mesh has not, a soil without cells.
pub fn pairs<K: Kinematics<2>>(
    case: &Case,
    grid: &Mesh<2>,
    fem: &Mesh<2>,
    bodies: &[Body<2>],
) -> Result<Vec<Box<dyn Pair<2>>>> {
    let mut pairs: Vec<Box<dyn Pair<2>>> = Vec::new();
    for contact in &case.contacts {
        let structure = region_index(grid, &case.regions[contact.structure].name)?;
        let (mut regions, mut models) = (Vec::new(), Vec::new());
        for &soil in &contact.soil {
            let region = &case.regions[soil];
            regions.push(region_index(grid, &region.name)?);
            models.extend(region.content.material().map(|m| case.materials[m].model.clone()));
        }
        let spacing = size(grid, &regions).ok_or_else(|| {
            Error::input(
                format!("contact of `{}`", case.regions[contact.structure].name),
                "the soil that it names has no cells",
                "run `mpm mesh` again",
            )
        })?;
        // The axis of symmetry is no boundary.
        let on_axis = |nodes: &[u32]| nodes.iter().all(|&n| fem.nodes[n as usize][0].abs() < 1e-9 * spacing);
        let skip = |nodes: &[u32]| case.geometry == Geometry::Axisymmetric && on_axis(nodes);
        let surface = Surface::new(fem, structure, HATS * spacing, skip)?;
        let pair = Boundary::<K> { structure, surface, law: contact.law, regions, models, kinematics: PhantomData };
        pairs.push(Box::new(pair));
    }
    Ok(pairs.into_iter().map(|pair| with_bodies(pair, bodies, grid.nodes.len())).collect())
}

/// A pair by the unknowns of the rigid bodies in it, if there are some.
fn with_bodies(pair: Box<dyn Pair<2>>, bodies: &[Body<2>], nodes: usize) -> Box<dyn Pair<2>> {
    match bodies.iter().any(|body| body.region == pair.structure()) {
        true => Box::new(Rigid::new(pair, bodies, nodes)),
        false => pair,
    }
}

/// The length (m) of the finest edges of the cells in some regions: nine of ten are longer.
fn size(mesh: &Mesh<2>, regions: &[u16]) -> Option<f64> {
    let mut edges = Vec::new();
    for c in (0..mesh.cells.len()).filter(|&c| regions.contains(&mesh.cells.region[c])) {
        let nodes = mesh.cells.nodes(c);
        let corners = mesh.cells.kind[c].corner_count();
        for i in 0..corners {
            let [a, b] = [nodes[i], nodes[(i + 1) % corners]].map(|n| mesh.nodes[n as usize]);
            edges.push((b[0] - a[0]).hypot(b[1] - a[1]));
        }
    }
    edges.sort_by(f64::total_cmp);
    edges.get(edges.len() / 10).copied()
}
