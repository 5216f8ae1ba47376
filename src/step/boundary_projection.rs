//! Projection of points that are slightly beyond a support (docs/theory.md, section 4, *Points beyond a support*).
//!
//! The nodes of a support do not move across it, and so neither does any place on its sides; soil does not cross a wall at the boundary of the mesh either. But a cell beside it that is strongly
//! compressed or sheared can move a point across. Such a point is projected onto the side; its velocity across the side vanishes with
//! that of the nodes there.
//!
//! Elsewhere soil that leaves the mesh is an error, but a few points that splash or heave a little beyond its end do not end an analysis: they are
//! put back onto it too, with a warning. A point that is farther beyond is an error.

use super::facing::outlines;
use super::scene::Scene;
use super::state::State;
use crate::geometry::{at, nearest as distance_to};
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::mesh::side::Side;
use rayon::prelude::*;

/// How far beyond a side a point may be (-), in the diagonal of the cell there.
pub const FARTHEST: f64 = 0.1;

/// How near (-) to a wall a side of the mesh is that lies on it, in the diagonal of its cell.
const ON_WALL: f64 = 1e-6;

/// Part of the material points (-) that may be beyond the end of the mesh where nothing holds them.
const FEW: f64 = 0.01;

/// Projects points onto the sides of supports, but not onto the axis of symmetry, where a point would have no volume, and a few onto other sides.
/// Returns a note on the former and a warning of the latter, if there are any.
pub fn project_onto_boundary<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    mesh: &Mesh<D>,
    locator: &Locator<D>,
    state: &mut State<D>,
) -> (Option<String>, Option<String>) {
    let points = &state.points;
    let is_lost = |p: &usize| locator.locate(mesh, &points.position[*p], Some(points.cell[*p])).is_none();
    let lost: Vec<usize> = (0..points.len()).into_par_iter().with_min_len(1024).filter(is_lost).collect();
    if lost.is_empty() {
        return (None, None);
    }
    let held = holding(scene, mesh, state);
    let open: Vec<Side<D>> = scene.locator.faces.boundary.iter().map(|&side| Side::of(mesh, side)).collect();
    let nearest = |sides: &[Side<D>], x: &[f64; D]| {
        let near = sides.iter().filter_map(|side| side.nearest(x, FARTHEST));
        near.filter(|(place, _)| !(K::HOOP && place[0] <= 0.0)).min_by(|a, b| a.1.total_cmp(&b.1))
    };
    let (mut count, mut most, mut beyond) = (0, 0.0f64, Vec::new());
    for p in lost {
        let x = &mut state.points.position[p];
        if let Some((place, distance)) = nearest(&held, x) {
            *x = place;
            (count, most) = (count + 1, most.max(distance));
        } else {
            beyond.push((p, nearest(&open, x)));
        }
    }
    let of_supports = (count > 0).then(|| {
        format!("{count} points were put back onto the supports that they had got beyond, by {most:.1e} m at most")
    });
    let places: Option<Vec<_>> = beyond.iter().map(|&(p, place)| Some((p, place?))).collect();
    let few = places.filter(|few| !few.is_empty() && few.len() as f64 <= FEW * state.points.len() as f64);
    let Some(few) = few else { return (of_supports, None) };
    few.iter().for_each(|&(p, (place, _))| state.points.position[p] = place);
    let of_end = format!(
        "soil gets beyond the end of the mesh near {:.3?} m, {} of {} points by {:.1e} m at most, and is projected to the boundary; extend the mesh \
         by a buffer region there",
        few[0].1.0,
        few.len(),
        state.points.len(),
        few.iter().map(|(_, (_, distance))| *distance).fold(0.0, f64::max)
    );
    (of_supports, Some(of_end))
}

/// The sides on the boundary that soil cannot cross in a phase: their nodes cannot, or a wall is there.
pub fn holding<const D: usize>(scene: &Scene<D>, mesh: &Mesh<D>, state: &State<D>) -> Vec<Side<D>> {
    let phase = state.phase;
    let walls = outlines(scene, state);
    let is_near =
        |x: &[f64; D], line: &[[f64; D]], by: f64| line.windows(2).any(|w| distance_to(x, &[w[0], w[1]]).1 <= by);
    let is_wall = |Side { ends, size }: &Side<D>| {
        let middle = at(ends, 0.5);
        let lies = |wall: &Vec<[f64; D]>| {
            ends.iter().all(|x| is_near(x, wall, ON_WALL * size)) && is_near(&middle, wall, FARTHEST * size)
        };
        walls.iter().any(lies)
    };
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
        (holds || is_wall(&side)).then_some(side)
    };
    scene.locator.faces.boundary.iter().filter_map(side).collect()
}
