//! Error: a structure that overlaps the soil that it is in contact with, at the start of a run or of a phase that activates it.

use super::facing::position;
use super::scene::Scene;
use super::state::State;
use crate::contact::{Interface, Mark};
use crate::error::{Error, Result};
use crate::geometry::nearest;
use crate::mesh::Mesh;
use crate::mesh::cell_size;
use crate::mesh::locate::Locator;
use crate::points::Points;

/// Rejects structures that begin with points of soil in them farther from the boundary than the size of a cell: contact finds only points
/// near the boundary. Walls have no inside.
///
/// # Errors
/// Input: such a structure.
pub fn at_first<const D: usize>(scene: &Scene<D>, points: &Points<D>) -> Result<()> {
    let at = |n: u32| scene.mesh.nodes[n as usize];
    let Some(found) = scene.interfaces.iter().find_map(|interface| within(scene, points, interface.as_ref(), &at))
    else {
        return Ok(());
    };
    let remedy = "in the .geo, move the structure out of the soil, or make its place a region of kind buffer";
    Err(Error::input(found.place, format!("the structure begins within the soil: {}", found.problem), remedy))
}

/// The same where a phase begins in which structures are there that were not before it.
///
/// # Errors
/// Analysis: such a structure.
pub fn on_return<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Result<()> {
    let Some(before) = state.phase.checked_sub(1) else { return Ok(()) };
    let at = |n: u32| position(scene, state, n);
    let mut back = scene.touching(state.phase).filter(|(number, _)| scene.phases[before].apart.contains(number));
    let Some(found) = back.find_map(|(_, interface)| within(scene, &state.points, interface, &at)) else {
        return Ok(());
    };
    let problem = format!(
        "phase `{}` brings the structure back into soil that has come to its place: {}",
        scene.phases[state.phase].name, found.problem
    );
    let remedy = "leave it active, or bring it back before the soil flows";
    Err(Error::analysis(found.place, problem, remedy))
}

/// The same where a phase has placed soil.
///
/// # Errors
/// Analysis: such a structure.
pub fn on_placement<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Result<()> {
    let at = |n: u32| position(scene, state, n);
    let mut touching = scene.touching(state.phase);
    let Some(found) = touching.find_map(|(_, interface)| within(scene, &state.points, interface, &at)) else {
        return Ok(());
    };
    let problem =
        format!("phase `{}` places soil where the structure is: {}", scene.phases[state.phase].name, found.problem);
    let remedy = "in the .geo, leave the place of the structure out of the region";
    Err(Error::analysis(found.place, problem, remedy))
}

/// Soil in a structure.
struct Found {
    place: String,
    problem: String,
}

/// The deepest of the soil that an interface touches within its structure, with the nodes as `at` tells.
fn within<const D: usize>(
    scene: &Scene<D>,
    points: &Points<D>,
    interface: &dyn Interface<D>,
    at: &dyn Fn(u32) -> [f64; D],
) -> Option<Found> {
    let (fem, structure) = (scene.fem.as_ref()?, interface.sides().structure);
    let drawn = fem.mesh.part(|c| fem.mesh.cells.region[c] == structure);
    if interface.sides().soils.is_empty() || drawn.cells.is_empty() {
        return None;
    }
    let body = Mesh { nodes: (0..drawn.nodes.len() as u32).map(at).collect(), ..drawn };
    let (locator, lines) = (Locator::new(&body), interface.lines(at));
    for &soil in &interface.sides().soils {
        let (mut count, mut deepest) = (0, (0.0, 0.0));
        for p in (0..points.len()).filter(|&p| points.region[p] == soil) {
            let x = &points.position[p];
            if locator.locate(&body, x, None).is_none() {
                continue;
            }
            count += 1;
            let (depth, cell) = (distance(x, &lines), cell_size(&scene.mesh, points.cell[p] as usize));
            if depth > cell && depth > deepest.0 {
                deepest = (depth, cell);
            }
        }
        let (depth, cell) = deepest;
        if depth > 0.0 {
            let name = |region: u16| &scene.mesh.regions[region as usize];
            let soil = name(soil);
            return Some(Found {
                place: format!("contact of `{}`", name(structure)),
                problem: format!(
                    "{count} points of `{soil}` are in it, up to {depth:.3} m deep in cells {cell:.3} m wide"
                ),
            });
        }
    }
    None
}

/// How far (m) a place is from the nearest line, in the plane.
fn distance<const D: usize>(x: &[f64; D], lines: &[Vec<Mark<D>>]) -> f64 {
    const { assert!(D == 2, "structures are bounded by lines in the plane only") };
    let to_segment = |ends: &[Mark<D>]| nearest(x, &[ends[0].place, ends[1].place]).1;
    lines.iter().flat_map(|line| line.windows(2)).map(to_segment).fold(f64::INFINITY, f64::min)
}
