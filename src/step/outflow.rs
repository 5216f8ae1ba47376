//! Curves through which soil leaves the model (docs/theory.md, section 4, *Soil that leaves and enters*).
//!
//! A material point that has passed such a curve is beyond the mesh, and the curve is the side of the boundary that is nearest to it. The grid is reset
//! as soon as there are such points, and they are left out of the reset: what has passed is a row of points, not a cell.

use super::boundary_projection::holding;
use super::energies::Item;
use super::scene::{Outflow, Scene};
use super::state::State;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::mesh::side::Side;
use rayon::prelude::*;

/// Nearer (-) than this, over the size of its cell, a side of the boundary is as near as another one.
const AS_NEAR: f64 = 1e-9;

/// Whether soil has passed a curve that is still in the model: at the beginning of a phase, in the one before.
fn was_open<const D: usize>(outflow: &Outflow, state: &State<D>) -> bool {
    let open = |phase: usize| outflow.open.get(phase) == Some(&true);
    open(state.phase) || (state.phase_time == 0.0 && state.phase > 0 && open(state.phase - 1))
}

/// The material points that have passed a curve, ascending, with its number.
pub fn passed<const D: usize>(
    scene: &Scene<D>,
    state: &State<D>,
    grid: (&Mesh<D>, &Locator<D>),
) -> Vec<(usize, usize)> {
    let (mesh, locator) = grid;
    if !scene.outflows.iter().any(|outflow| was_open(outflow, state)) {
        return Vec::new();
    }
    let points = &state.points;
    let is_lost = |p: &usize| locator.locate(mesh, &points.position[*p], Some(points.cell[*p])).is_none();
    let lost: Vec<usize> = (0..points.len()).into_par_iter().with_min_len(1024).filter(is_lost).collect();
    if lost.is_empty() {
        return Vec::new();
    }
    let held = holding(scene, mesh, state);
    let owner = |side: &(u32, u8)| {
        scene.outflows.iter().position(|outflow| was_open(outflow, state) && outflow.sides.contains(side))
    };
    let of_side = |side: &(u32, u8)| {
        let line = Side::of(mesh, *side);
        (line, owner(side).filter(|_| !held.contains(&line)))
    };
    let sides: Vec<(Side<D>, Option<usize>)> = scene.locator.faces.boundary.iter().map(of_side).collect();
    let through = |p: usize| {
        let (mut least, mut nearest) = (f64::INFINITY, None);
        for (side, owner) in &sides {
            let Some((_, away)) = side.nearest(&points.position[p], f64::INFINITY) else { continue };
            let near = AS_NEAR * side.size;
            if away < least - near || (away <= least + near && owner.is_some()) {
                (least, nearest) = (away, *owner);
            }
        }
        nearest.map(|number| (p, number))
    };
    lost.into_iter().filter_map(through).collect()
}

/// Takes the material points that have passed a curve out of the model, and counts what leaves with them. Returns lines for the log.
///
/// # Errors
/// Analysis: no soil is left.
pub fn release<const D: usize>(
    scene: &Scene<D>,
    state: &mut State<D>,
    grid: (&Mesh<D>, &Locator<D>),
) -> Result<Vec<String>> {
    let passed = passed(scene, state, grid);
    if passed.is_empty() {
        return Ok(Vec::new());
    }
    if passed.len() == state.points.len() {
        let name = &scene.outflows[passed[0].1].name;
        return Err(Error::analysis(
            format!("outflow `{name}`"),
            "all soil has left the model",
            format!(
                "end the phase before, by `until: [{{of: {name}, quantity: mass_out, above: …}}]` with that in the history"
            ),
        ));
    }
    state.left.resize(scene.outflows.len(), [0.0; 2]);
    let mut counts = vec![(0, 0.0); scene.outflows.len()];
    for &(p, number) in &passed {
        let (mass, volume) = (state.points.mass[p], state.points.volume(p));
        state.left[number][0] += mass;
        state.left[number][1] += volume;
        counts[number] = (counts[number].0 + 1, counts[number].1 + mass);
    }
    let gone: Vec<usize> = passed.iter().map(|(p, _)| *p).collect();
    let leaving = state.points.select(&gone);
    let kinetic: f64 = leaving
        .velocity
        .iter()
        .zip(&leaving.mass)
        .map(|(v, mass)| 0.5 * mass * v.iter().map(|v| v * v).sum::<f64>())
        .sum();
    let stored: f64 = scene.terms.iter().map(|term| term.energy(&leaving)).sum();
    if let Some(energies) = &mut state.energies {
        energies.add(Item::Outflow, -(kinetic + stored));
        energies.add(Item::Kinetic, -kinetic);
        energies.add(Item::Stored, -stored);
    }
    let mut stays = vec![true; state.points.len()];
    gone.iter().for_each(|&p| stays[p] = false);
    let left: Vec<usize> = (0..stays.len()).filter(|&p| stays[p]).collect();
    state.points = state.points.select(&left);
    state.parametric = left.iter().map(|&p| state.parametric[p]).collect();
    if !state.start_position.is_empty() {
        state.start_position = left.iter().map(|&p| state.start_position[p]).collect();
    }
    let line = |(outflow, (count, mass)): (&Outflow, (usize, f64))| {
        (count > 0).then(|| format!("{count} points with {mass:.6e} t left through `{}`", outflow.name))
    };
    Ok(scene.outflows.iter().zip(counts).filter_map(line).collect())
}
