//! Fill: soil that comes as a phase begins, without stress (docs/theory.md, section 14, *Fill*).

use super::energies::Item;
use super::grid::Grid;
use super::new_points::points;
use super::overlap;
use super::relax;
use super::scene::{Scene, Soil};
use super::state::State;
use super::work;
use crate::error::Result;
use crate::kinematics::Kinematics;
use crate::points::Points;
use crate::quadrature::Placed;

/// The part (-) of a region as drawn up to which soil that is there, or room beside the region, is not told of.
const TOLD: f64 = 1e-3;

/// Places the soil that comes as the phase in hand begins, on a reset grid. Returns lines for the log, none where nothing comes.
///
/// # Errors
/// When a point lies outside the grid, in a structure, or memory does not suffice.
pub fn place<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &mut State<D>,
) -> Result<Vec<String>> {
    let placement = scene.placements.get(state.phase).and_then(Option::as_ref);
    let Some(placement) = placement.filter(|_| state.phase_time == 0.0) else { return Ok(Vec::new()) };
    work::begin(scene, grid, state)?;
    grid.restore::<K>(scene, state)?;
    let notes = state.weights.notes.clone();
    let lost = state.weights.lost_front.clone();
    let (mesh, locator) = relax::mesh(scene, grid.relaxed.as_ref());
    let all = placement.placing.place((mesh, locator), (&state.points, &state.parametric), &mut state.front);
    let mut lines = Vec::new();
    if state.front.is_none() {
        lines.push(format!(
            "warning: phase `{}`: the surface of the soil is not followed any more, and its points give it to a part of a cell: what is placed may \
             overlap the soil that is there, or leave a gap; the log has why and when that ended, smaller steps or cells may help",
            scene.phases[state.phase].name
        ));
    }
    for (soil, placed) in placement.soils.iter().zip(&all) {
        let points = points(state, soil, placed);
        lines.push(note(scene, state, (soil, placed), &points));
        if !points.is_empty() && is_on_nothing(scene, state, placed) {
            lines.push(format!(
                "warning: phase `{}`: `{}` is placed on nothing, neither soil nor a support is beside it: in `place` name regions in the order in which \
                 they come",
                scene.phases[state.phase].name, scene.mesh.regions[usize::from(soil.region)]
            ));
        }
        if !state.start_position.is_empty() {
            state.start_position.extend(&points.position);
        }
        state.points.append(&points);
    }
    overlap::on_placement(scene, state)?;
    grid.restore::<K>(scene, state)?;
    state.weights.notes.splice(0..0, notes);
    if lost.is_some() {
        state.weights.lost_front = lost;
    }
    state.increment.fill([0.0; D]);
    state.balanced = None;
    work::note(scene, grid, state, Item::Changes)?;
    Ok(lines)
}

/// A line for the log on the soil of a region that has come.
fn note<const D: usize>(
    scene: &Scene<D>,
    state: &State<D>,
    (soil, placed): (&Soil, &Placed<D>),
    points: &Points<D>,
) -> String {
    let phase = &scene.phases[state.phase].name;
    let region = &scene.mesh.regions[usize::from(soil.region)];
    if points.is_empty() {
        return format!(
            "warning: phase `{phase}`: nothing is placed in `{region}`: soil is there already, or the region is thinner than its points are apart; \
             take it out of `place`, or give it smaller cells"
        );
    }
    let (volume, mass): (f64, f64) = (placed.volumes.iter().sum(), points.mass.iter().sum());
    let mut line = format!(
        "phase `{phase}`: `{region}` is filled with {volume:.6} m³ and {mass:.6} t of `{}`, {} points; drawn were {:.6} m³",
        soil.material.name,
        points.len(),
        placed.drawn
    );
    let occupied = placed.drawn - (volume - placed.beside);
    let told = TOLD * placed.drawn;
    if placed.beside > told {
        line.push_str(&format!(", and {:.6} m³ fill what the ground has left since", placed.beside));
    }
    if occupied > told {
        line.push_str(&format!(", but {occupied:.6} m³ of them have soil already"));
    }
    line
}

/// Whether soil that comes is beside no soil, and beside nothing that is held along gravity. Where structures are, they may bear it.
fn is_on_nothing<const D: usize>(scene: &Scene<D>, state: &State<D>, placed: &Placed<D>) -> bool {
    if scene.fem.is_some() || !scene.interfaces.is_empty() || scene.gravity == [0.0; D] {
        return false;
    }
    let down = (0..D).max_by(|&a, &b| scene.gravity[a].abs().total_cmp(&scene.gravity[b].abs())).unwrap_or(0);
    let mut bears = vec![false; scene.displacements()];
    let of_soil = state.points.cell.iter().flat_map(|&c| scene.mesh.cells.nodes(c as usize));
    let held = scene.fixed(state.phase).filter(|fixed| fixed.component == down).flat_map(|fixed| &fixed.nodes);
    of_soil.chain(held).for_each(|&n| bears[n as usize] = true);
    placed.cell.iter().all(|&c| scene.mesh.cells.nodes(c as usize).iter().all(|&n| !bears[n as usize]))
}
