//! Rigid walls: physical curves of the mesh that soil or bodies touch.
//!
//! A wall is a rigid body of its own, with copies of the nodes of its curve: those belong to the grid, which deforms. The copies are of no cell. It
//! has a region without cells, by which it is known as structures are. What touches it is on the side where its cells are.

use super::checked::{Case, Touching};
use super::find::group;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::mesh::shape::CellKind;
use crate::rigid::Body;

/// Appends the nodes and the regions of the walls of a case to the whole mesh and tells them, wall by wall.
///
/// # Errors
/// Input: a curve that the mesh has not, or that is called as a region.
pub fn append(case: &Case, mesh: &mut Mesh<2>) -> Result<Vec<(u16, Vec<u32>)>> {
    let mut walls: Vec<(u16, Vec<u32>)> = Vec::new();
    for contact in &case.contacts {
        let Touching::Wall(name) = &contact.structure else { continue };
        if walls.iter().any(|(region, _)| mesh.regions[*region as usize] == *name) {
            continue;
        }
        if mesh.regions.contains(name) {
            return Err(fault(name, "a region is called so, too", "give the curve a name of its own in the .geo"));
        }
        let curve = group(mesh, name)?.nodes.clone();
        let first = mesh.nodes.len() as u32;
        let copies: Vec<[f64; 2]> = curve.iter().map(|&n| mesh.nodes[n as usize]).collect();
        mesh.nodes.extend(copies);
        walls.push((mesh.regions.len() as u16, (first..mesh.nodes.len() as u32).collect()));
        mesh.regions.push(name.clone());
    }
    Ok(walls)
}

/// The facets of a wall with the cells of some `regions` of a mesh, the grid or the one beside it, on their right, by the
/// nodes of the wall.
///
/// # Errors
/// Input: a curve that branches, or with such cells on both of its sides.
pub fn facets(mesh: &Mesh<2>, body: &Body<2>, regions: &[u16]) -> Result<(CellKind, Vec<Vec<u32>>)> {
    let name = &mesh.regions[body.region as usize];
    let curve = group(mesh, name)?;
    let own = |n: &u32| curve.nodes.binary_search(n).map_or(u32::MAX, |i| body.nodes[i]);
    let kind = curve.facets.first().map_or(CellKind::Line3, |(kind, _)| *kind);
    let mut left: Vec<Vec<u32>> = curve.facets.iter().map(|(_, nodes)| nodes.iter().map(own).collect()).collect();
    let middles = middles(mesh, regions);
    let mut all = Vec::new();
    while let Some(first) = left.pop() {
        // All that hangs together, each facet begun where another one ends.
        let mut chain = vec![first];
        let mut k = 0;
        while k < chain.len() {
            let [a, b] = [chain[k][0], chain[k][1]];
            while let Some(i) = left.iter().position(|f| [f[0], f[1]].iter().any(|n| [a, b].contains(n))) {
                let mut next = left.swap_remove(i);
                if next[0] == a || next[1] == b {
                    next.swap(0, 1);
                }
                chain.push(next);
            }
            k += 1;
        }
        let meets = |n: u32, end: usize| chain.iter().filter(|f| f[end] == n).count();
        if chain.iter().any(|f| meets(f[0], 0) > 1 || meets(f[1], 1) > 1) {
            return Err(fault(name, "it branches", "make a wall of each branch"));
        }
        if is_left(mesh, name, &chain, &middles)? {
            chain.iter_mut().for_each(|facet| facet.swap(0, 1));
        }
        all.extend(chain);
    }
    Ok((kind, all))
}

/// The middles of the cells of some regions (m).
fn middles(mesh: &Mesh<2>, regions: &[u16]) -> Vec<[f64; 2]> {
    let cells = (0..mesh.cells.len()).filter(|&c| regions.contains(&mesh.cells.region[c]));
    cells.map(|c| mesh.centre(c)).collect()
}

/// Whether the nearest of the `middles` of cells is on the left of a chain of facets.
///
/// # Errors
/// Input: a chain with cells at it on both sides.
fn is_left(mesh: &Mesh<2>, name: &str, chain: &[Vec<u32>], middles: &[[f64; 2]]) -> Result<bool> {
    let mut nearest: Option<(f64, bool)> = None;
    let mut against = [false; 2];
    for facet in chain {
        let [a, b] = [facet[0], facet[1]].map(|n| mesh.nodes[n as usize]);
        let (along, middle) = ([b[0] - a[0], b[1] - a[1]], [0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
        let length = along[0].hypot(along[1]);
        for x in middles {
            let to = [x[0] - middle[0], x[1] - middle[1]];
            let (distance, left) = (to[0].hypot(to[1]), along[0] * to[1] - along[1] * to[0] > 0.0);
            against[usize::from(left)] |= distance < 0.5 * length;
            if nearest.is_none_or(|(other, _)| distance < other) {
                nearest = Some((distance, left));
            }
        }
    }
    if against == [true; 2] {
        return Err(fault(
            name,
            "what touches it lies on both of its sides",
            "name what is on one side as a region of its own",
        ));
    }
    Ok(nearest.is_some_and(|(_, left)| left))
}

fn fault(name: &str, problem: &str, remedy: &str) -> Error {
    Error::input(format!("the wall `{name}`"), problem, remedy)
}
