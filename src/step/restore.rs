//! Grid reset (docs/theory.md, sections 3, 4 and 6): the nodes go to their first positions, or to positions that fit finite elements which
//! moved; the points are located; the active cells and the integration weights are determined.

use super::boundary_projection::project_onto_boundary;
use super::facing;
use super::family::Interpolations;
use super::fem;
use super::ghost_faces;
use super::inflow;
use super::nodal_fit::Filled;
use super::outflow;
use super::predictor;
use super::pressure;
use super::relax::{self, Relaxed};
use super::scene::{Restore, Scene};
use super::state::State;
use crate::error::{Error, Result};
use crate::interpolation::{Domains, First, Interpolation, Located, Reset};
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::quadrature::{Renewed, Restored, Samples, Weights};
use rayon::prelude::*;

/// Rings of cells around those with points that are active too, so that points can move some way before the pattern of the matrix
/// changes.
const RINGS: usize = 2;

/// Resets the grid: locates the points, chooses the active cells and determines the integration weights. True if the matrix needs
/// another pattern than before.
///
/// # Errors
/// When a point lies outside the grid; the step then goes on from the grid as it was.
pub fn begin_anew<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    state: &mut State<D>,
    interpolations: &mut Interpolations<D>,
    relaxed: &mut Option<Relaxed<D>>,
) -> Result<bool> {
    let out = outflow::release(scene, state, relax::mesh(scene, relaxed.as_ref()))?;
    let (strips, new) = inflow::enter::<D, K>(scene, state, relax::mesh(scene, relaxed.as_ref()))?;
    let (nodes, position) = (state.nodes.clone(), state.points.position.clone());
    let (cell, parametric) = (state.points.cell.clone(), state.parametric.clone());
    let before = relaxed.take();
    let placed = place::<D, K>(scene, state, relaxed);
    let Ok(projected) = placed else {
        // The displacement is still that of the last converged step.
        (state.nodes, state.points.position) = (nodes, position);
        (state.points.cell, state.parametric) = (cell, parametric);
        *relaxed = before;
        return placed.map(|_| false);
    };
    let (mesh, locator) = relax::mesh(scene, relaxed.as_ref());
    let here = relax::mesh(scene, before.as_ref());
    let domains = renew_domains::<D, K>(scene, here, state);
    let changed = choose_cells(scene, state);
    let (outlines, contact) = (facing::outlines(scene, state), facing::status(scene, state));
    interpolations.integration =
        interpolations.material.take().unwrap_or_else(|| std::mem::take(&mut interpolations.integration));
    fill::<D, K>(&mut interpolations.integration, scene, (mesh, locator), state);
    let grid = Restored {
        mesh,
        locator,
        before: here,
        outlines: &outlines,
        contact: &contact,
        relaxed: relaxed.is_some(),
        points: &state.points,
        parametric: &state.parametric,
        interpolation: &interpolations.integration,
        active: &state.active,
        entering: (&strips, new),
        displacement: (state.restorations > 0).then_some(&state.displacement),
    };
    state.weights = scene.quadrature.weigh(&grid, &mut state.front);
    state.weights.notes = out.into_iter().chain(projected.0).chain(domains).collect();
    state.weights.beyond = projected.1;
    renew::<D, K>(&mut interpolations.integration, scene, (mesh, locator), state);
    predictor::carry(here, mesh, state);
    state.ramp.carry(scene, (here.0, &state.displacement), (mesh, locator), &state.points.cell);
    state.displacement.fill([0.0; D]);
    state.restorations += 1;
    if scene.numerics.restore == Restore::Never {
        // A grid that is never restored carries its points along: its cells stay as full as seeded.
        state.weights.partly_filled.clear();
        if !scene.terms.iter().any(|t| t.penalises_faces()) {
            state.weights.ill_conditioned.clear();
        }
    }
    take_weights::<D, K>(interpolations, scene, mesh, state);
    if scene.has_pressure_field() {
        let mut field = std::mem::take(&mut state.pressure);
        let soil = Filled { mesh, interpolation: &interpolations.integration, points: state.integration() };
        pressure::gather::<D, K>(soil, scene.places()[0], &mut field);
        state.pressure = field;
    }
    let chosen = ghost_faces::choose(scene, state);
    Ok(ghost_faces::make_room(&scene.locator.faces, state, &chosen) || changed)
}

/// Moves the nodes to their positions on the reset grid and locates the points. Returns a note on points that were projected onto
/// supports, and a warning of those that were onto other sides.
///
/// # Errors
/// When a cell of the grid is folded, or a point lies outside it.
fn place<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    state: &mut State<D>,
    relaxed: &mut Option<Relaxed<D>>,
) -> Result<(Option<String>, Option<String>)> {
    fem::keep_shape(scene, state);
    *relaxed = relax::relax(scene, state)?;
    let (mesh, locator) = relax::mesh(scene, relaxed.as_ref());
    let mut told = (None, None);
    if let Err(lost) = locate_points(mesh, locator, state) {
        told = project_onto_boundary::<D, K>(scene, mesh, locator, state);
        if told == (None, None) {
            return Err(lost);
        }
        locate_points(mesh, locator, state)?;
    }
    Ok(told)
}

/// Gives the points that integrals are summed over their weights, given the interpolation of the material points.
pub fn take_weights<const D: usize, K: Kinematics<D>>(
    interpolations: &mut Interpolations<D>,
    scene: &Scene<D>,
    mesh: &Mesh<D>,
    state: &State<D>,
) {
    let Weights { samples, weight, .. } = &state.weights;
    if let Some(Samples { points, parametric, .. }) = samples {
        interpolations.material = Some(std::mem::take(&mut interpolations.integration));
        interpolations.integration.fill::<K>(scene.basis, mesh, &points.cell, parametric, &state.active);
    }
    interpolations.integration.weigh(weight);
}

/// Takes the material points that a weighed grid asks for, and fills their interpolation.
fn renew<const D: usize, K: Kinematics<D>>(
    interpolation: &mut Interpolation<D>,
    scene: &Scene<D>,
    grid: (&Mesh<D>, &Locator<D>),
    state: &mut State<D>,
) {
    let Some(Renewed { points, parametric, from }) = state.weights.renewed.take() else { return };
    if !state.start_position.is_empty() {
        // Each has moved as far as the one that it was before.
        let start = |(x, &p): (&[f64; D], &u32)| {
            let (start, before) = (&state.start_position[p as usize], &state.points.position[p as usize]);
            std::array::from_fn(|d| start[d] + x[d] - before[d])
        };
        state.start_position = points.position.iter().zip(&from).map(start).collect();
    }
    (state.points, state.parametric) = (points, parametric);
    fill::<D, K>(interpolation, scene, grid, state);
}

/// Gives the material points, which have been located, the domains that the scheme of the scene wants, given the grid before. Returns a note
/// on them.
fn renew_domains<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    (mesh, locator): (&Mesh<D>, &Locator<D>),
    state: &mut State<D>,
) -> Option<String> {
    if state.restorations == 0 {
        let first = First { mesh, xi: &state.parametric, measure: K::measure };
        scene.basis.begin_domains(&first, &mut state.points);
        return None;
    }
    let before = Reset { mesh, locator, active: &state.active, displacement: &state.displacement };
    scene.basis.renew_domains(&before, &mut state.points)
}

/// Fills the interpolation for the material points where they were last located.
pub fn fill<const D: usize, K: Kinematics<D>>(
    interpolation: &mut Interpolation<D>,
    scene: &Scene<D>,
    (mesh, locator): (&Mesh<D>, &Locator<D>),
    state: &State<D>,
) {
    let located = Located::new::<K>(mesh, &state.active, &state.points.cell, &state.parametric);
    scene.basis.fill(&Located { domains: Domains::of(&state.points, locator), ..located }, interpolation);
}

/// Finds the cell of every point of the restored grid.
///
/// # Errors
/// An analysis error that names the first point outside the grid.
fn locate_points<const D: usize>(mesh: &Mesh<D>, locator: &Locator<D>, state: &mut State<D>) -> Result<()> {
    let points = &mut state.points;
    let position = &points.position;
    state.parametric.resize(position.len(), [0.0; 3]);
    let lost = points
        .cell
        .par_iter_mut()
        .zip(&mut state.parametric)
        .enumerate()
        .filter_map(|(p, (cell, parametric))| match locator.locate(mesh, &position[p], Some(*cell)) {
            Some((c, xi)) => {
                (*cell, *parametric) = (c, xi);
                None
            }
            None => Some(p),
        })
        .min();
    match lost {
        None => Ok(()),
        Some(p) => {
            let region = mesh.regions.get(points.region[p] as usize).map_or("", String::as_str);
            Err(Error::analysis(
                format!("material point {p} ({region})"),
                format!("it left the grid at {:.4?} m", position[p]),
                "extend the mesh by a buffer region there, or hold the material back by a support",
            ))
        }
    }
}

/// Chooses the active cells; true if they changed since the last reset.
fn choose_cells<const D: usize>(scene: &Scene<D>, state: &mut State<D>) -> bool {
    let cells = scene.mesh.cells.len();
    // A face to a cell that is not active would have no entries in the matrix.
    let surrounded = |&c: &u32| {
        state.active[c as usize] && scene.locator.faces.neighbours(c).iter().all(|&other| state.active[other as usize])
    };
    if state.active.len() == cells && state.points.cell.iter().all(surrounded) {
        return false;
    }
    let mut chosen = vec![false; cells];
    for &c in &state.points.cell {
        chosen[c as usize] = true;
    }
    if scene.numerics.restore != Restore::Never {
        let mut reached = vec![false; scene.mesh.nodes.len()];
        for _ in 0..RINGS {
            for c in (0..cells).filter(|&c| chosen[c]) {
                for &n in scene.mesh.cells.nodes(c) {
                    reached[n as usize] = true;
                }
            }
            for (c, chosen) in chosen.iter_mut().enumerate() {
                *chosen |= scene.mesh.cells.nodes(c).iter().any(|&n| reached[n as usize]);
            }
        }
    }
    state.active = chosen;
    true
}
