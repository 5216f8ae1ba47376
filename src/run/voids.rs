//! Warnings of voids that open within soil, or under a structure that cannot part from it, where the surface of the soil is followed.
//!
//! What opens beside a structure that may part from the soil is what its contact says: the log has a line on it, and no warning. What has no soil
//! above it, and no structure beside it, is open air.

use super::warning::WARNING;
use crate::contact::Interface;
use crate::geometry::{Bins, box_around, distance, side};
use crate::mesh::{Mesh, height};
use crate::step::{Fem, Report, Scene, State};
use crate::surface::{News, Void, lies_near};

/// What rounding leaves empty (-) of a cell that is full.
const ROUNDING: f64 = 1e-9;

/// A boundary that touches soil in this phase.
struct Structure<const D: usize> {
    name: String,
    may_part: bool,
    /// Places (m) along it.
    places: Vec<[f64; D]>,
}

/// Notes what is empty as a run begins, and no void: what structures leave behind later is one.
pub fn begin<const D: usize>(scene: &Scene<D>, state: &mut State<D>) {
    if state.front.is_none() || !state.voids.of_cell.is_empty() {
        return;
    }
    let mesh = restored(scene, state);
    let emptiness = emptiness(scene, state, &mesh);
    state.voids.look(&mesh, &emptiness, &mut |_, _| false);
}

/// The grid as it was restored last.
fn restored<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Mesh<D> {
    Mesh { nodes: state.coordinates(scene).to_vec(), ..scene.mesh.clone() }
}

/// Lines for the log on a step, by the grid as it was restored before; warnings begin with [`WARNING`].
pub fn found<const D: usize>(scene: &Scene<D>, state: &mut State<D>, report: &Report<D>) -> Vec<String> {
    if !report.restored || state.front.is_none() {
        return Vec::new();
    }
    let mesh = restored(scene, state);
    let emptiness = emptiness(scene, state, &mesh);
    let mut voids = std::mem::take(&mut state.voids);
    let structures: Vec<Structure<D>> = scene
        .touching(state.phase)
        .filter(|(_, interface)| !interface.sides().soils.is_empty())
        .map(|(_, interface)| structure(&mesh, interface, state.phase))
        .collect();
    let beside = |cells: &[u32]| structures.iter().filter(|s| lies_near(&mesh, cells, &s.places)).collect::<Vec<_>>();
    let mut is_news = |cells: &[u32], cut_off: bool| {
        !(cut_off && reaches_boundary(scene, cells))
            && (lies_beneath_soil(&mesh, &state.points.position, cells) || !beside(cells).is_empty())
    };
    let news = voids.look(&mesh, &emptiness, &mut is_news);
    state.voids = voids;
    let phase = scene.phases.get(state.phase).map_or("", |phase| phase.name.as_str());
    let line = |void: &Void<D>| {
        let structures = beside(&void.cells);
        let bound = structures.iter().map(|s| format!("`{}`", s.name)).collect::<Vec<_>>().join(" and ");
        let (warning, place, cure) = if bound.is_empty() {
            (
                WARNING,
                "within the soil".to_string(),
                ": its sides bear neither stress nor water pressure; smaller cells there show whether it stays",
            )
        } else if structures.iter().any(|structure| structure.may_part) {
            ("", format!("at {bound}, which has parted from the soil"), "")
        } else {
            (
                WARNING,
                format!("at {bound}, which cannot part from the soil"),
                ": the contact bears tension without limit; set `tension: {limit: …}`, or `tension: cut_off` if it may part",
            )
        };
        let (at, area, time) = (&void.place, void.area, state.time);
        match void.news {
            News::Opened => format!(
                "{warning}phase `{phase}`: a void has opened {place}, at {at:.3?} m, of {area:.3e} m² at {time:.6} s{cure}"
            ),
            News::Grown => format!(
                "{warning}phase `{phase}`: the void {place}, at {at:.3?} m, has grown to {area:.3e} m² at {time:.6} s"
            ),
            News::Closed => format!(
                "{warning}phase `{phase}`: the void {place}, at {at:.3?} m, has closed at {time:.6} s; it was {area:.3e} m²"
            ),
        }
    };
    news.iter().map(line).collect()
}

/// An interface and its boundary on the grid as restored.
fn structure<const D: usize>(mesh: &Mesh<D>, interface: &dyn Interface<D>, phase: usize) -> Structure<D> {
    Structure {
        name: mesh.regions.get(usize::from(interface.sides().structure)).cloned().unwrap_or_default(),
        may_part: interface.sides().laws.at(phase).tension.is_finite(),
        places: interface.outlines(&|n| mesh.nodes[n as usize]).concat(),
    }
}

/// The part (-) of each cell that is empty; none of one into which a structure or finite element reaches.
fn emptiness<const D: usize>(scene: &Scene<D>, state: &State<D>, mesh: &Mesh<D>) -> Vec<f64> {
    let mut emptiness = vec![1.0f64; mesh.cells.len()];
    for &c in state.points.cell.iter().chain(&state.integration().cell) {
        emptiness[c as usize] = 0.0;
    }
    for partly_filled in state.weights.partly_filled.iter().filter(|cell| cell.emptiness > ROUNDING) {
        let own = &mut emptiness[partly_filled.cell as usize];
        *own = own.max(partly_filled.emptiness.min(1.0 - ROUNDING));
    }
    let Some(fem) = &scene.fem else { return emptiness };
    let mut occupied: Vec<Option<bool>> = vec![None; mesh.nodes.len()];
    let elements: Vec<Vec<[f64; 2]>> = (0..fem.mesh.cells.len()).map(|c| outline(fem, mesh, c)).collect();
    let boxes: Vec<_> = elements.iter().map(|element| box_of(element)).collect();
    let widest = boxes.iter().map(|(low, high)| distance(low, high)).fold(0.0, f64::max);
    let bins = Bins::new(boxes.iter().copied(), widest);
    for (c, emptiness) in emptiness.iter_mut().enumerate().filter(|(_, emptiness)| **emptiness > 0.0) {
        let reaches = mesh.cells.nodes(c).iter().any(|&n| {
            let x = [0, 1].map(|d| mesh.nodes[n as usize][d]);
            let within = || bins.around(&x).flatten().any(|&element| holds(&elements[element as usize], &x));
            *occupied[n as usize].get_or_insert_with(within)
        });
        if reaches {
            *emptiness = 0.0;
        }
    }
    emptiness
}

/// The corners of an element where it is, counter-clockwise.
fn outline<const D: usize>(fem: &Fem<D>, mesh: &Mesh<D>, c: usize) -> Vec<[f64; 2]> {
    const { assert!(D == 2, "cells are polygons in the plane only") };
    let corners = &fem.mesh.cells.nodes(c)[..fem.mesh.cells.kind[c].corner_count()];
    corners.iter().map(|&n| [0, 1].map(|d| mesh.nodes[n as usize][d])).collect()
}

/// The lower left and the upper right corner of the box around some places (m).
fn box_of(x: &[[f64; 2]]) -> ([f64; 2], [f64; 2]) {
    let bound = |start: f64, pick: fn(f64, f64) -> f64| [0, 1].map(|d| x.iter().fold(start, |a, x| pick(a, x[d])));
    (bound(f64::INFINITY, f64::min), bound(f64::NEG_INFINITY, f64::max))
}

/// Whether a place (m) is in a convex polygon.
fn holds(corners: &[[f64; 2]], x: &[f64; 2]) -> bool {
    corners.iter().zip(corners.iter().cycle().skip(1)).all(|(a, b)| side(&[*a, *b], x) >= 0.0)
}

/// Whether some cells reach to the boundary of the grid.
fn reaches_boundary<const D: usize>(scene: &Scene<D>, cells: &[u32]) -> bool {
    scene.locator.faces.boundary.iter().any(|(cell, _)| cells.binary_search(cell).is_ok())
}

/// Whether there is a point of the `soil` (m) above one of some cells: within its width, and higher than it reaches.
fn lies_beneath_soil<const D: usize>(mesh: &Mesh<D>, soil: &[[f64; D]], cells: &[u32]) -> bool {
    cells.iter().any(|&c| {
        let corners = || mesh.cells.corners(c as usize).iter().map(|&n| &mesh.nodes[n as usize]);
        let Some([low, high]) = box_around(corners().copied()) else { return false };
        let top = height(&high);
        let is_above = |x: &[f64; D]| height(x) > top && (0..D - 1).all(|d| low[d] < x[d] && x[d] < high[d]);
        soil.iter().any(is_above)
    })
}
