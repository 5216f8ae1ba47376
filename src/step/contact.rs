//! Contact in a step: which contact nodes face soil where the step begins, what of the surface they cover, and what they come to in its end.

use super::balance::go_ahead;
use super::facing::position;
use super::grid::Grid;
use super::leaving;
use super::problem::Solution;
use super::scene::Scene;
use super::state::State;
use super::transfer::Start;
use crate::contact::{Ground, Motion, Multipliers, Pair, Pushed, Row};
use crate::error::Result;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::mesh::shape::MAX_NODES;
use crate::points::Points;
use crate::surface::{join, open};
use crate::term::{Touch, Trial, contact_answer, excess_pressure};
use crate::time_integration::GeneralisedAlpha;

/// What a pair exerted in a step.
#[derive(Clone, Debug, PartialEq)]
pub struct Resultant<const D: usize> {
    /// The region of the structure, and that of the body it touches.
    pub structure: u16,
    pub against: Option<u16>,
    /// Force (kN) of what it touches on the structure.
    pub force: [f64; D],
    /// Its moment (kN m) about the origin, in the plane, anticlockwise, and that of the opposite force on what it touches.
    pub moment: f64,
    pub moment_against: f64,
    /// Hats that touch, and the deepest mean overlap (m) of one.
    pub contact_nodes: usize,
    pub overlap: f64,
    pub pushed: Pushed,
}

impl<const D: usize> Resultant<D> {
    /// Force (kN) of this contact on a region, and its moment (kN m) about the origin.
    pub fn on(&self, region: u16) -> ([f64; D], f64) {
        if self.structure == region {
            (self.force, self.moment)
        } else if self.against == Some(region) {
            (self.force.map(|f| -f), self.moment_against)
        } else {
            ([0.0; D], 0.0)
        }
    }
}

/// Finds the contact nodes that face soil and makes room for them in the system.
///
/// # Errors
/// As [`Grid::new`], and analysis: a structure that left the grid.
pub fn begin<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &mut State<D>,
) -> Result<()> {
    if scene.pairs.is_empty() {
        return Ok(());
    }
    if state.multipliers.is_empty() {
        state.multipliers = scene.pairs.iter().map(|pair| Multipliers::new(pair.contact_nodes())).collect();
    }
    let at = |n: u32| position(scene, state, n);
    let moved = state.displacement.iter().flatten().any(|&u| u != 0.0);
    let deformed = moved.then(|| {
        let nodes = (0..scene.mesh.nodes.len() as u32).map(at).collect();
        let mesh = Mesh { nodes, ..scene.mesh.clone() };
        let locator = Locator::new(&mesh);
        (mesh, locator)
    });
    let restored = grid.relaxed.as_ref().map_or((&scene.mesh, &scene.locator), |r| (&r.mesh, &r.locator));
    let (mesh, locator) = deformed.as_ref().map_or(restored, |(mesh, locator)| (mesh, locator));
    let surface = surface(restored, state);
    let excess = |points: &Points<D>, p: usize| excess_pressure(&scene.carried, points, p);
    let (points, elements, increment) = (&state.points, &state.fem, &state.increment);
    let integration = &state.integration().cell;
    let ground =
        Ground { grid: mesh, locator, points, integration, surface: &surface, increment, elements, excess: &excess };
    let (mut touches, mut covers) = (Vec::new(), Vec::new());
    let covered = scene.terms.iter().any(|term| term.sees_open_boundary());
    for (number, pair) in scene.touching(state.phase) {
        let held = &state.multipliers[number];
        let rows = pair.rows(&ground, &at, &held.evened(pair.runs()));
        leaving::check(scene, pair, held, &rows, &ground, &at)?;
        if covered {
            covers.extend(pair.covers(&rows, &at));
        }
        let pair = number as u32;
        let presses = rows.iter().any(|row| row.penalty.pressure > 0.0);
        let touch =
            |row: Row<D>| Touch { pair, initially_closed: !presses && row.lies(), row, clique: 0, place: Vec::new() };
        touches.extend(rows.into_iter().map(touch));
    }
    join(&mut covers);
    let open = covered.then(|| open(mesh, &state.weighing.boundary.pieces, &covers));
    let takes_part = |touch: &Touch<D>| touch.row.nodes.iter().all(|&n| grid.block[n as usize] != u32::MAX);
    touches.retain(takes_part);
    if !place(grid, state, &mut touches) {
        make_room(state, &touches);
        let stencils = std::mem::take(&mut grid.stencils);
        *grid = Grid::with::<K>(scene, state, stencils, grid.relaxed.take())?;
        place(grid, state, &mut touches);
    }
    (grid.touches, grid.open) = (touches, open);
    Ok(())
}

/// The surface of the soil where it is now, given the grid as restored; no loops where it is not followed.
fn surface<const D: usize>((mesh, locator): (&Mesh<D>, &Locator<D>), state: &State<D>) -> Vec<Vec<[f64; D]>> {
    let Some(front) = &state.front else { return Vec::new() };
    let (mut n, mut hint) = ([0.0; MAX_NODES], None);
    let mut moved = |marker: &[f64; 2]| {
        let mut x: [f64; D] = std::array::from_fn(|d| marker.get(d).copied().unwrap_or(0.0));
        if let Some((c, xi)) = locator.locate(mesh, &x, hint) {
            hint = Some(c);
            mesh.cells.kind[c as usize].values(&xi, &mut n);
            for (&node, n) in mesh.cells.nodes(c as usize).iter().zip(&n) {
                for d in 0..D {
                    x[d] += n * state.displacement[node as usize][d];
                }
            }
        }
        x
    };
    (0..front.loops()).map(|l| front.markers(l).iter().map(&mut moved).collect()).collect()
}

/// Finds the places of the rows in their cliques; false where one has none.
fn place<const D: usize>(grid: &Grid<D>, state: &State<D>, touches: &mut [Touch<D>]) -> bool {
    for touch in touches {
        let (pair, contact_node) = (touch.pair as usize, touch.row.contact_node as usize);
        let clique = grid.touch_clique.get(pair).map_or(u32::MAX, |cliques| cliques[contact_node]);
        let room = state.multipliers[pair].room(contact_node);
        let found = touch.row.nodes.iter().map(|n| room.iter().position(|other| other == n).map(|at| at as u32));
        match found.collect::<Option<Vec<_>>>() {
            Some(place) if clique != u32::MAX => (touch.clique, touch.place) = (clique, place),
            _ => return false,
        }
    }
    true
}

/// Makes room for just these rows.
fn make_room<const D: usize>(state: &mut State<D>, touches: &[Touch<D>]) {
    for (multipliers, number) in state.multipliers.iter_mut().zip(0..) {
        let contact_nodes = multipliers.first.len() - 1;
        let mut rows = touches.iter().filter(|touch| touch.pair == number).peekable();
        multipliers.room.clear();
        for contact_node in 0..contact_nodes {
            multipliers.first[contact_node] = multipliers.room.len() as u32;
            if let Some(touch) = rows.next_if(|touch| touch.row.contact_node as usize == contact_node) {
                multipliers.room.extend(&touch.row.nodes);
            }
        }
        multipliers.first[contact_nodes] = multipliers.room.len() as u32;
    }
}

/// Hands what the contact nodes came to on to the next step.
pub fn commit<const D: usize>(
    scene: &Scene<D>,
    grid: &Grid<D>,
    state: &mut State<D>,
    (solution, start): (&Solution<D>, Option<&Start<D>>),
    dt: f64,
) -> Vec<Resultant<D>> {
    let none = |pair: &dyn Pair<D>| Resultant {
        structure: pair.structure(),
        against: pair.against(),
        force: [0.0; D],
        moment: 0.0,
        moment_against: 0.0,
        contact_nodes: 0,
        overlap: 0.0,
        pushed: Pushed::default(),
    };
    let mut resultants: Vec<_> = scene.pairs.iter().map(|pair| none(pair.as_ref())).collect();
    let reduction = scene.phases[state.phase].reduction_at(state.phase_time + dt);
    let integration = GeneralisedAlpha::new(scene.numerics.spectral_radius, dt);
    let alpha_f = start.map_or(0.0, |_| integration.alpha_f);
    let mut ahead = Vec::new();
    if let Some(Start { velocity, acceleration }) = start {
        go_ahead(&integration, (&solution.displacement, &state.displacement), (velocity, acceleration), &mut ahead);
    }
    let (phase, time) = (state.phase, state.phase_time + (1.0 - alpha_f) * dt);
    let at_rest = Trial::at_rest(&solution.displacement, &state.displacement);
    let trial = Trial { reduction, phase, time, ahead: &ahead, ..at_rest };
    for multipliers in &mut state.multipliers {
        let Multipliers { pressure, shear, gap, slip, offset, .. } = multipliers;
        [pressure, shear, gap, slip, offset].into_iter().for_each(|values| values.fill(0.0));
        multipliers.force.fill([0.0; 3]);
        multipliers.faces.fill(false);
    }
    for touch in &grid.touches {
        let (pair, contact_node, row) = (touch.pair as usize, touch.row.contact_node as usize, &touch.row);
        let (answer, Motion { gap, slip, turn, .. }) =
            contact_answer(scene.pairs[pair].law(), scene.levels.as_ref(), touch, &trial);
        let held = &mut state.multipliers[pair];
        (held.pressure[contact_node], held.shear[contact_node]) = (answer.pressure, answer.shear);
        (held.gap[contact_node], held.slip[contact_node], held.offset[contact_node]) = (gap, slip.abs(), row.offset);
        held.faces[contact_node] = true;
        let resultant = &mut resultants[pair];
        if held.touched(contact_node) {
            resultant.contact_nodes += 1;
            held.slid[contact_node] += slip;
            resultant.overlap = resultant.overlap.max(-gap);
        }
        for (k, (t, &node)) in row.by_tangent.iter().zip(&row.nodes).enumerate() {
            let n = row.normal(k, turn);
            let lever = row.curvature * answer.moment;
            let force: [f64; D] = std::array::from_fn(|d| {
                row.area * (answer.pressure * n[d] + answer.shear * t[d] + lever * row.by_arc[k][d])
            });
            let turned = scene.turned_by(node);
            let moment = match turned {
                // A moment over the arm.
                Some(body) => body.arm * force[0],
                None => {
                    let first = state.nodes.get(node as usize).unwrap_or(&scene.mesh.nodes[node as usize]);
                    let x: [f64; D] = std::array::from_fn(|d| first[d] + solution.displacement[node as usize][d]);
                    x[0] * force[1] - x[1] * force[0]
                }
            };
            if k < row.own {
                for d in 0..D {
                    resultant.force[d] += force[d];
                    held.force[contact_node][d] += force[d];
                }
            }
            if k < row.own || turned.is_some_and(|body| body.region == resultant.structure) {
                resultant.moment += moment;
            } else {
                resultant.moment_against += moment;
            }
        }
    }
    resultants
}

/// Moves points out of the structures, once all is where the step takes it.
pub fn push_out<const D: usize>(scene: &Scene<D>, state: &mut State<D>, resultants: &mut [Resultant<D>]) {
    for (number, pair) in scene.touching(state.phase) {
        let resultant = &mut resultants[number];
        let mut points = std::mem::take(&mut state.points);
        resultant.pushed = pair.push_out(&mut points, &|n| position(scene, state, n));
        state.points = points;
    }
}
