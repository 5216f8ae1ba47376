//! Curves through which soil enters the model (docs/theory.md, section 4, *Soil that leaves and enters*).
//!
//! The soil has the velocity of the inflow across the curve and no stress. It comes in rows of material points: when what has come since the last row is as
//! thick as points are apart, the grid is reset, and the strip along the curve that the soil before has left is filled. Its mass is that of the flow in this
//! time, to rounding. Inflow presses on nothing: soil that is still in the strip ends the analysis.

use super::energies::Item;
use super::new_points;
use super::scene::{Inflow, Scene};
use super::state::State;
use crate::error::{Error, Result};
use crate::geometry::{at, distance};
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::quadrature::{Placed, Strip};

/// The strip of an inflow with a thickness (m).
fn strip<const D: usize>(inflow: &Inflow<D>, thickness: f64) -> Strip<D> {
    Strip { ends: inflow.ends, inward: inflow.inward, open: inflow.open, thickness }
}

/// Counts the soil that comes in the step of `dt` (s) that begins now.
pub fn count<const D: usize>(scene: &Scene<D>, state: &mut State<D>, dt: f64) {
    if scene.inflows.is_empty() {
        return;
    }
    state.entered.resize(scene.inflows.len(), [0.0; 3]);
    for (entered, inflow) in state.entered.iter_mut().zip(&scene.inflows) {
        if let Some(Some((_, velocity))) = inflow.phases.get(state.phase) {
            let ends = [state.phase_time, state.phase_time + dt].map(|time| velocity.at(time));
            entered[2] += 0.5 * dt * (ends[0] + ends[1]);
        }
    }
}

/// Whether a row of points is to come.
pub fn is_due<const D: usize>(scene: &Scene<D>, state: &State<D>) -> bool {
    scene.inflows.iter().zip(&state.entered).any(|(inflow, entered)| entered[2] >= inflow.spacing)
}

/// Adds the rows that are due to the material points of a grid that is being reset. Returns their strips, and the number of new points.
///
/// # Errors
/// Analysis: soil is in the way.
pub fn enter<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    state: &mut State<D>,
    (mesh, locator): (&Mesh<D>, &Locator<D>),
) -> Result<(Vec<Strip<D>>, usize)> {
    let (mut strips, before) = (Vec::new(), state.points.len());
    for (number, inflow) in scene.inflows.iter().enumerate() {
        let Some(&[_, _, due]) = state.entered.get(number) else { break };
        let Some(Some((soil, velocity))) = inflow.phases.get(state.phase).filter(|_| due >= inflow.spacing) else {
            continue;
        };
        let strip = strip(inflow, due);
        let place = || format!("inflow `{}`", inflow.name);
        if let Some(x) = state.points.position[..before].iter().find(|x| strip.level(x) > 0.0) {
            return Err(Error::analysis(
                place(),
                format!(
                    "soil at {x:.4?} m is in the way of what enters: the model is full there, or the soil leaves the curve more slowly than it comes"
                ),
                "end the phase before, by `until` with a bound on mass_in, take a smaller `velocity`, or draw the curve higher above the soil",
            ));
        }
        let rows = (due / inflow.spacing).round().max(1.0) as usize;
        let (length, count) = (distance(&inflow.ends[0], &inflow.ends[1]), inflow.row as f64);
        let mut placed = Placed { region: soil.region, ..Placed::default() };
        for row in 0..rows {
            let depth = due * (row as f64 + 0.5) / rows as f64;
            for k in 0..inflow.row {
                let on = at(&inflow.ends, (k as f64 + 0.5) / count);
                let x = std::array::from_fn(|d| on[d] + depth * inflow.inward[d]);
                let (cell, _) = locator.locate(mesh, &x, None).ok_or_else(|| {
                    let problem = format!("a row of it would lie outside the mesh at {x:.4?} m");
                    Error::analysis(
                        place(),
                        problem,
                        "take smaller steps (step.max), or give the mesh room behind the curve",
                    )
                })?;
                placed.position.push(x);
                placed.volumes.push(K::measure(&on) * length / count * due / rows as f64);
                placed.cell.push(cell);
            }
        }
        let speed = velocity.at(state.phase_time);
        let mut points = new_points::points(state, soil, &placed);
        points.velocity.fill(inflow.inward.map(|n| speed * n));
        points.acceleration.fill(inflow.gravity[state.phase].at(state.phase_time));
        let mass: f64 = points.mass.iter().sum();
        if let Some(energies) = &mut state.energies {
            let kinetic = 0.5 * mass * speed * speed;
            energies.add(Item::Inflow, kinetic);
            energies.add(Item::Kinetic, kinetic);
        }
        let volume: f64 = placed.volumes.iter().sum();
        state.entered[number] = [state.entered[number][0] + mass, state.entered[number][1] + volume, 0.0];
        if !state.start_position.is_empty() {
            state.start_position.extend(&points.position);
        }
        state.points.append(&points);
        strips.push(strip);
    }
    Ok((strips, state.points.len() - before))
}
