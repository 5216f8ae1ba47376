//! Contact in a step (docs/theory.md, section 13): which contact nodes face soil as the step begins and with what gap (eq. 28), which parts of
//! the surface the structures cover (section 11), and pressure, shear and resultants at its end (eq. 29 and 30).

use super::balance::go_ahead;
use super::facing::position;
use super::grid::Grid;
use super::leaving;
use super::problem::Solution;
use super::relax;
use super::rigid;
use super::scene::Scene;
use super::start::Start;
use super::state::State;
use crate::contact::{Constraint, Ground, Interface, Motion, Multipliers, Pushed};
use crate::error::Result;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::mesh::shape::MAX_NODES;
use crate::points::Points;
use crate::surface::{join, open};
use crate::term::{PlacedConstraint, Trial, contact_answer, excess_pressure};
use crate::time_integration::GeneralisedAlpha;

/// The resultant of an interface in a step.
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
    /// The number of closed contact nodes, and the largest mean overlap (m).
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

/// Finds the contact nodes that face soil and makes their constraints. If the pattern of the matrix has no entries for one, it is made anew.
///
/// # Errors
/// As [`Grid::new`], and analysis: a structure that left the grid.
pub fn begin<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &mut State<D>,
) -> Result<()> {
    if scene.interfaces.is_empty() {
        return Ok(());
    }
    if state.multipliers.is_empty() {
        state.multipliers =
            scene.interfaces.iter().map(|interface| Multipliers::new(interface.contact_nodes())).collect();
    }
    let at = |n: u32| position(scene, state, n);
    let moved = state.displacement.iter().flatten().any(|&u| u != 0.0);
    let deformed = moved.then(|| {
        let nodes = (0..scene.mesh.nodes.len() as u32).map(at).collect();
        let mesh = Mesh { nodes, ..scene.mesh.clone() };
        let locator = scene.locator.moved(&mesh);
        (mesh, locator)
    });
    let restored = relax::mesh(scene, grid.relaxed.as_ref());
    let (mesh, locator) = deformed.as_ref().map_or(restored, |(mesh, locator)| (mesh, locator));
    let surface = surface(restored, state);
    let excess = |points: &Points<D>, p: usize| excess_pressure(&scene.carried, points, p);
    let (points, elements) = (&state.points, &state.fem);
    let integration = &state.integration().cell;
    let (phase, active) = (state.phase, &state.active);
    let ground = Ground {
        phase,
        grid: mesh,
        locator,
        points,
        integration,
        active,
        surface: &surface,
        elements,
        excess: &excess,
    };
    let (mut placed, mut covers) = (Vec::new(), Vec::new());
    let covered = scene.terms.iter().any(|term| term.sees_open_boundary());
    for (number, interface) in scene.touching(state.phase) {
        let held = &state.multipliers[number];
        let constraints = interface.constraints(&ground, &at, &held.evened(interface.runs()));
        leaving::check(scene, interface, held, &constraints, &ground, &at)?;
        if covered {
            covers.extend(interface.covers(&constraints, &at));
        }
        let interface = number as u32;
        let presses = constraints.iter().any(|constraint| constraint.penalty.pressure > 0.0);
        let to_place = |condition: Constraint<D>| PlacedConstraint {
            interface,
            initially_closed: !presses && condition.lies(),
            condition,
            coupling: 0,
            place: Vec::new(),
        };
        placed.extend(constraints.into_iter().map(to_place));
    }
    join(&mut covers);
    let open = covered.then(|| open(mesh, &state.weights.boundary.pieces, &covers));
    let takes_part = |constraint: &PlacedConstraint<D>| constraint.condition.nodes.iter().all(|&n| grid.dofs.has(n));
    placed.retain(takes_part);
    if !place(grid, state, &mut placed) {
        make_room(state, &placed);
        let interpolations = std::mem::take(&mut grid.interpolations);
        *grid = Grid::with::<K>(scene, state, interpolations, grid.relaxed.take())?;
        place(grid, state, &mut placed);
    }
    (grid.constraints, grid.open) = (placed, open);
    Ok(())
}

/// The surface of the soil where it is now, given the grid as restored; no loops where it is not followed.
fn surface<const D: usize>((mesh, locator): (&Mesh<D>, &Locator<D>), state: &State<D>) -> Vec<Vec<[f64; D]>> {
    const { assert!(D == 2, "the surface is a line in the plane only") };
    let Some(front) = &state.front else { return Vec::new() };
    let (mut n, mut hint) = ([0.0; MAX_NODES], None);
    let mut moved = |marker: &[f64; 2]| {
        let mut x: [f64; D] = std::array::from_fn(|d| marker[d]);
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

/// Finds the places of the constraints in their couplings; false where one has none.
fn place<const D: usize>(grid: &Grid<D>, state: &State<D>, constraints: &mut [PlacedConstraint<D>]) -> bool {
    for constraint in constraints {
        let (interface, contact_node) = (constraint.interface as usize, constraint.condition.contact_node as usize);
        let coupling = grid.constraint_coupling.get(interface).map_or(u32::MAX, |couplings| couplings[contact_node]);
        let room = state.multipliers[interface].room(contact_node);
        let found =
            constraint.condition.nodes.iter().map(|n| room.iter().position(|other| other == n).map(|at| at as u32));
        match found.collect::<Option<Vec<_>>>() {
            Some(place) if coupling != u32::MAX => (constraint.coupling, constraint.place) = (coupling, place),
            _ => return false,
        }
    }
    true
}

/// Notes the nodes of just these constraints as those that the pattern has entries for.
fn make_room<const D: usize>(state: &mut State<D>, constraints: &[PlacedConstraint<D>]) {
    for (multipliers, number) in state.multipliers.iter_mut().zip(0..) {
        let contact_nodes = multipliers.first.len() - 1;
        let mut constraints = constraints.iter().filter(|constraint| constraint.interface == number).peekable();
        multipliers.room.clear();
        for contact_node in 0..contact_nodes {
            multipliers.first[contact_node] = multipliers.room.len() as u32;
            if let Some(constraint) =
                constraints.next_if(|constraint| constraint.condition.contact_node as usize == contact_node)
            {
                multipliers.room.extend(&constraint.condition.nodes);
            }
        }
        multipliers.first[contact_nodes] = multipliers.room.len() as u32;
    }
}

/// How far the nodes go (m) in half a step after the end of a converged one; empty without inertia.
fn ahead<const D: usize>(
    scene: &Scene<D>,
    state: &State<D>,
    (solution, start): (&Solution<D>, Option<&Start<D>>),
    dt: f64,
) -> Vec<[f64; D]> {
    let mut ahead = Vec::new();
    if let Some(Start { velocity, acceleration, .. }) = start {
        let integration = GeneralisedAlpha::new(scene.numerics.spectral_radius, dt);
        go_ahead(&integration, (&solution.displacement, &state.displacement), (velocity, acceleration), &mut ahead);
    }
    ahead
}

/// What contact sees of a converged step of `dt` (s) that begins at a time (s) of a phase, between displacements (m), given what [`ahead`] has found.
fn trial_at_end<'a, const D: usize>(
    scene: &Scene<D>,
    (phase, from): (usize, f64),
    (now, before): (&'a [[f64; D]], &'a [[f64; D]]),
    ahead: &'a [[f64; D]],
    dt: f64,
) -> Trial<'a, D> {
    let with_inertia = !ahead.is_empty();
    let alpha_f = if with_inertia { GeneralisedAlpha::new(scene.numerics.spectral_radius, dt).alpha_f } else { 0.0 };
    let (time, reduction) = (from + (1.0 - alpha_f) * dt, scene.phases[phase].reduction_at(from + dt));
    Trial { reduction, phase, time, ahead, ..Trial::at_rest(now, before) }
}

/// The work (kJ) in a step of `dt` (s) that goes into the normal and into the tangential forces of contact, these being as the step ends or as it
/// `begins`. The state is that before it.
pub fn works<const D: usize>(
    scene: &Scene<D>,
    grid: &Grid<D>,
    state: &State<D>,
    (solution, start): (&Solution<D>, Option<&Start<D>>),
    dt: f64,
    begins: bool,
) -> [f64; 2] {
    let ahead = ahead(scene, state, (solution, start), dt);
    let ends = (&solution.displacement[..], &state.displacement[..]);
    let mut trial = trial_at_end(scene, (state.phase, state.phase_time), ends, &ahead, dt);
    if begins {
        (trial.displacement, trial.time) = (&state.displacement, state.phase_time);
        trial.reduction = scene.phases[state.phase].reduction_at(state.phase_time);
    }
    let mut works = [0.0; 2];
    for constraint in &grid.constraints {
        let condition = &constraint.condition;
        let law = scene.interfaces[constraint.interface as usize].sides().laws.at(trial.phase);
        let (answer, Motion { turn, .. }) = contact_answer(law, scene.levels.as_ref(), constraint, &trial);
        let lever = condition.curvature * answer.moment;
        for (k, &node) in condition.nodes.iter().enumerate() {
            let (now, before) = (&solution.displacement[node as usize], &state.displacement[node as usize]);
            let normal = condition.normal(k, turn);
            for d in 0..D {
                let way = condition.area * (now[d] - before[d]);
                works[0] -= way * (answer.pressure * normal[d] + lever * condition.by_arc[k][d]);
                works[1] -= way * answer.shear * condition.by_tangent[k][d];
            }
        }
    }
    works
}

/// Takes pressure, shear, gap and slip of the converged step as multipliers and history of the next one (Uzawa).
pub fn commit<const D: usize>(
    scene: &Scene<D>,
    grid: &Grid<D>,
    state: &mut State<D>,
    (solution, start): (&Solution<D>, Option<&Start<D>>),
    dt: f64,
) -> Vec<Resultant<D>> {
    const { assert!(D == 2, "moments are numbers in the plane only") };
    let none = |interface: &dyn Interface<D>| Resultant {
        structure: interface.sides().structure,
        against: interface.sides().against,
        force: [0.0; D],
        moment: 0.0,
        moment_against: 0.0,
        contact_nodes: 0,
        overlap: 0.0,
        pushed: Pushed::default(),
    };
    let mut resultants: Vec<_> = scene.interfaces.iter().map(|interface| none(interface.as_ref())).collect();
    let ahead = ahead(scene, state, (solution, start), dt);
    let (phase, ends) = (state.phase, (&solution.displacement[..], &state.displacement[..]));
    let trial = trial_at_end(scene, (phase, state.phase_time), ends, &ahead, dt);
    for multipliers in &mut state.multipliers {
        let Multipliers { pressure, shear, gap, slip, .. } = multipliers;
        [pressure, shear, gap, slip].into_iter().for_each(|values| values.fill(0.0));
        multipliers.force.fill([0.0; 3]);
        multipliers.faces.fill(false);
        multipliers.apart.fill(true);
    }
    for constraint in &grid.constraints {
        let condition = &constraint.condition;
        let (interface, contact_node) = (constraint.interface as usize, condition.contact_node as usize);
        let law = scene.interfaces[interface].sides().laws.at(phase);
        let (answer, Motion { gap, slip, turn, .. }) = contact_answer(law, scene.levels.as_ref(), constraint, &trial);
        let held = &mut state.multipliers[interface];
        (held.pressure[contact_node], held.shear[contact_node]) = (answer.pressure, answer.shear);
        (held.gap[contact_node], held.slip[contact_node]) = (gap, slip.abs());
        held.faces[contact_node] = true;
        let mean = contact_answer(law, scene.levels.as_ref(), &constraint.in_the_mean(), &trial).0;
        held.apart[contact_node] = held.is_apart(contact_node, law, &mean, condition.penalty.fading);
        let resultant = &mut resultants[interface];
        if held.touched(contact_node) {
            resultant.contact_nodes += 1;
            held.slid[contact_node] += slip;
            resultant.overlap = resultant.overlap.max(-gap);
        }
        for (k, (t, &node)) in condition.by_tangent.iter().zip(&condition.nodes).enumerate() {
            let n = condition.normal(k, turn);
            let lever = condition.curvature * answer.moment;
            let force: [f64; D] = std::array::from_fn(|d| {
                condition.area * (answer.pressure * n[d] + answer.shear * t[d] + lever * condition.by_arc[k][d])
            });
            let moment = rigid::moment(scene, state, &solution.displacement, node, &force);
            if k < condition.own {
                for d in 0..D {
                    resultant.force[d] += force[d];
                    state.multipliers[interface].force[contact_node][d] += force[d];
                }
            }
            if k < condition.own || scene.body_of(node).is_some_and(|body| body.region == resultant.structure) {
                resultant.moment += moment;
            } else {
                resultant.moment_against += moment;
            }
        }
    }
    resultants
}

/// Contact projection: moves points out of the structures, once nodes and points are at their final positions.
pub fn project_out<const D: usize>(scene: &Scene<D>, state: &mut State<D>, resultants: &mut [Resultant<D>]) {
    for (number, interface) in scene.touching(state.phase) {
        let resultant = &mut resultants[number];
        let mut points = std::mem::take(&mut state.points);
        resultant.pushed = interface.project_out(&mut points, &|n| position(scene, state, n));
        state.points = points;
    }
}
