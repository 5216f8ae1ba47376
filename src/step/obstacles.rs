//! Places that hold material whatever its grid does: nodes whose displacement is given, the sides of the mesh between them, and other bodies
//! of soil (docs/theory.md, section 4, *What the grid has not met*).
//!
//! The active cells move with the material. A body that moves without distorting takes them along, beyond nodes that are not active, and
//! nothing would resist it there. So the grid is due for a reset where points come into cells with such nodes ([`meets`]), and a step that takes
//! a point across a side that holds it has failed ([`check`]).
//!
//! Only points of cells at the rim of the material can be the first.

use super::boundary_projection::{FARTHEST, holding};
use super::grid::Grid;
use super::relax;
use super::scene::{Restore, Scene};
use super::state::State;
use crate::error::{Error, Result};
use crate::geometry::distance;
use crate::interpolation::CellPoints;
use crate::kinematics::Kinematics;
use crate::mesh::Bodies;
use crate::mesh::side::Side;
use rayon::prelude::*;

/// Nearer (-) than this, over the size of its cell, a side of the boundary is as near as another one.
const AS_NEAR: f64 = 1e-9;

/// Whether a point will come, with one more increment like the last one, into a cell with nodes whose displacement is given and that are not
/// active, or of another body.
pub fn meets<const D: usize, K: Kinematics<D>>(scene: &Scene<D>, state: &State<D>, grid: &Grid<D>) -> bool {
    if state.increment.is_empty() {
        return false;
    }
    let moved = |n: u32| -> f64 {
        let (u, more) = (&state.displacement[n as usize], &state.increment[n as usize]);
        u.iter().zip(more).map(|(u, more)| (u + more).powi(2)).sum::<f64>().sqrt()
    };
    // Two rings of cells around them are active: what has moved by less than an edge is still among them.
    let has_come_far = |cell_points: &&CellPoints| {
        let (mesh, cell) = (grid.mesh(scene), cell_points.cell as usize);
        let corners = mesh.cells.corners(cell);
        let edge = |i: usize| {
            let [a, b] = [i, (i + 1) % corners.len()].map(|i| &mesh.nodes[corners[i] as usize]);
            distance(a, b)
        };
        let shortest = (0..corners.len()).map(edge).fold(f64::INFINITY, f64::min);
        corners.iter().any(|&n| moved(n) >= shortest)
    };
    let rim: Vec<&CellPoints> = rim(scene, grid).into_iter().filter(has_come_far).collect();
    if rim.is_empty() {
        return false;
    }
    let (mesh, locator) = relax::mesh(scene, grid.relaxed.as_ref());
    let mut given = vec![false; scene.displacements()];
    scene.fixed(state.phase).flat_map(|fixed| &fixed.nodes).for_each(|&n| given[n as usize] = true);
    let bodies = Bodies::of(mesh, grid.cells.iter().copied(), &[]);
    rim.par_iter().any(|cell_points| {
        let own = bodies.of_cell(cell_points.cell);
        let holds = |&n: &u32| match bodies.of_node(n as usize) {
            None => given[n as usize],
            body => body != own,
        };
        after::<D, K>(scene, state, grid, cell_points, &state.increment).any(|(_, x)| {
            let found = locator.locate(mesh, &x, Some(cell_points.cell));
            found.is_some_and(|(cell, _)| mesh.cells.nodes(cell as usize).iter().any(holds))
        })
    })
}

/// Rejects a step whose `increment` of the displacement (m) takes a point across a side of the mesh that holds it, farther than it can be
/// projected back from.
///
/// # Errors
/// Analysis: the point, where it would be and what holds there.
pub fn check<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    state: &State<D>,
    grid: &Grid<D>,
    increment: &[[f64; D]],
) -> Result<()> {
    let (mesh, locator) = relax::mesh(scene, grid.relaxed.as_ref());
    let of_cell = |cell_points: &&CellPoints| -> Vec<(usize, [f64; D])> {
        after::<D, K>(scene, state, grid, cell_points, increment)
            .filter(|(_, x)| locator.locate(mesh, x, Some(cell_points.cell)).is_none())
            .collect()
    };
    let outside: Vec<(usize, [f64; D])> = rim(scene, grid).par_iter().flat_map_iter(of_cell).collect();
    if outside.is_empty() {
        return Ok(());
    }
    let holding = holding(scene, mesh, state);
    let all: Vec<Side<D>> = scene.locator.faces.boundary.iter().map(|&side| Side::of(mesh, side)).collect();
    let nearest = |sides: &[Side<D>], x: &[f64; D]| -> Option<([f64; D], f64, f64)> {
        let of_side = |side: &Side<D>| side.nearest(x, f64::INFINITY).map(|(place, away)| (place, away, side.size));
        sides.iter().filter_map(of_side).min_by(|a, b| a.1.total_cmp(&b.1))
    };
    for (p, x) in outside {
        // What has left the mesh elsewhere may be anywhere.
        let from = &state.points.position[p];
        let was_inside = locator.locate(mesh, from, Some(state.points.cell[p])).is_some();
        let (Some((place, away, size)), Some((_, least, _))) = (nearest(&holding, &x), nearest(&all, &x)) else {
            continue;
        };
        let on_axis = K::HOOP && place[0] <= 0.0;
        let projected = !on_axis && away <= FARTHEST * size;
        let before = nearest(&holding, from).map_or(f64::INFINITY, |(_, away, _)| away);
        if !projected && away <= least + AS_NEAR * size && (was_inside || before <= FARTHEST * size) {
            let region = mesh.regions.get(state.points.region[p] as usize).map_or("", String::as_str);
            let remedy = match scene.numerics.restore {
                Restore::Never => {
                    "on a grid that is never reset, supports hold the nodes of the soil alone: let it be reset (numerics.restore)"
                }
                _ => "take smaller steps (step.max, step.min), or smaller cells there",
            };
            return Err(Error::analysis(
                format!("material point {p} ({region})"),
                format!("it would leave the grid at {x:.4?} m, across a side that is held at {place:.4?} m"),
                remedy,
            ));
        }
    }
    Ok(())
}

/// The points of a cell where they are after an `increment` of the displacement (m).
fn after<'a, const D: usize, K: Kinematics<D>>(
    scene: &'a Scene<D>,
    state: &'a State<D>,
    grid: &'a Grid<D>,
    cell_points: &'a CellPoints,
    increment: &'a [[f64; D]],
) -> impl Iterator<Item = (usize, [f64; D])> {
    let interpolation = grid.of_material();
    let nodes = interpolation.nodes(&scene.mesh, cell_points.cell);
    interpolation.entries::<K>(cell_points).map(move |entries| {
        let mut x = state.points.position[entries.point];
        for (n, &node) in entries.value.iter().zip(nodes) {
            for d in 0..D {
                x[d] += n * increment[node as usize][d];
            }
        }
        (entries.point, x)
    })
}

/// The cells with material points that have a node on the boundary of the mesh, or of a cell without points.
fn rim<'a, const D: usize>(scene: &Scene<D>, grid: &'a Grid<D>) -> Vec<&'a CellPoints> {
    let cells = &scene.mesh.cells;
    let filled = &grid.of_material().filled;
    let mut is_filled = vec![false; cells.len()];
    filled.iter().for_each(|cell_points| is_filled[cell_points.cell as usize] = true);
    let mut open = vec![false; scene.mesh.nodes.len()];
    for c in (0..cells.len()).filter(|&c| !is_filled[c]) {
        cells.nodes(c).iter().for_each(|&n| open[n as usize] = true);
    }
    for &(c, side) in &scene.locator.faces.boundary {
        let facet = cells.kind[c as usize].facets().1[side as usize];
        facet.iter().for_each(|&i| open[cells.nodes(c as usize)[i] as usize] = true);
    }
    let at_rim = |cell_points: &&CellPoints| cells.nodes(cell_points.cell as usize).iter().any(|&n| open[n as usize]);
    filled.iter().filter(at_rim).collect()
}
