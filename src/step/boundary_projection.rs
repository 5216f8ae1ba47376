//! Projection of points that are slightly beyond a support (docs/theory.md, section 4, *Points beyond a support*).
//!
//! The nodes of a support do not move across it, and so neither does any place on its sides. But a cell beside it that is strongly
//! compressed or sheared can move a point across. Such a point is projected onto the side; its velocity across the side vanishes with
//! that of the nodes there. A point that is farther beyond, or leaves the mesh elsewhere, is an error.

use super::scene::Scene;
use super::state::State;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::mesh::side::Side;
use rayon::prelude::*;

/// How far beyond a side a point may be (-), in the diagonal of the cell there.
pub const FARTHEST: f64 = 0.1;

/// Projects points onto the sides of supports, but not onto the axis of symmetry, where a point would have no volume. Returns a note on
/// how many and how far, if there are any.
pub fn project_onto_boundary<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    mesh: &Mesh<D>,
    locator: &Locator<D>,
    state: &mut State<D>,
) -> Option<String> {
    let points = &state.points;
    let is_lost = |p: &usize| locator.locate(mesh, &points.position[*p], Some(points.cell[*p])).is_none();
    let lost: Vec<usize> = (0..points.len()).into_par_iter().with_min_len(1024).filter(is_lost).collect();
    if lost.is_empty() {
        return None;
    }
    let sides = holding(scene, mesh, state.phase);
    let (mut count, mut most) = (0, 0.0f64);
    for p in lost {
        let x = &mut state.points.position[p];
        let near = sides
            .iter()
            .filter_map(|side| side.nearest(x, FARTHEST))
            .filter(|(place, _)| !(K::HOOP && place[0] <= 0.0));
        if let Some((place, distance)) = near.min_by(|a, b| a.1.total_cmp(&b.1)) {
            *x = place;
            (count, most) = (count + 1, most.max(distance));
        }
    }
    (count > 0).then(|| {
        format!("{count} points were put back onto the supports that they had got beyond, by {most:.1e} m at most")
    })
}

/// The sides on the boundary whose nodes cannot move across them in a phase.
pub fn holding<const D: usize>(scene: &Scene<D>, mesh: &Mesh<D>, phase: usize) -> Vec<Side<D>> {
    let mut held = vec![[false; D]; scene.displacements()];
    for fixed in &scene.supports {
        for &n in &fixed.nodes {
            held[n as usize][fixed.component] = true;
        }
    }
    for prescribed in &scene.phases[phase].prescribed {
        for &n in &prescribed.fixed.nodes {
            held[n as usize][prescribed.fixed.component] = false;
        }
    }
    let side = |&(cell, number): &(u32, u8)| {
        let nodes = mesh.cells.nodes(cell as usize);
        let (_, facets) = mesh.cells.kind[cell as usize].facets();
        let facet = &facets[number as usize];
        let side = Side::of(mesh, (cell, number));
        let Side { ends, size } = side;
        // In the plane, a side along one axis is crossed along the other; one at a slant along both.
        let crossed = |d: usize| (ends[1][1 - d] - ends[0][1 - d]).abs() > 1e-9 * size;
        let holds = (0..D).all(|d| !crossed(d) || facet.iter().all(|&i| held[nodes[i] as usize][d]));
        holds.then_some(side)
    };
    scene.locator.faces.boundary.iter().filter_map(side).collect()
}
