//! Whether the state in a checkpoint is one that the scene can be in: the step takes its indices, lengths and ranges for
//! granted. That numbers are finite was checked as they were read.

use super::super::foreign::foreign;
use crate::contact::{Interface, Multipliers};
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::points::{Column, Item, Points, Presence, Visitor};
use crate::quadrature::{Samples, Weights};
use crate::step::{Controller, Scene, Span, State, has_room_for_penalties};
use crate::surface::{ActiveBoundary, MarkerFront, NO_REGION, Voids};
use std::collections::HashSet;

/// What rounding leaves of times that are sums over steps, and of parametric coordinates (-).
const ROUNDING: f64 = 1e-9;

/// More steps and restorations than any run has, and room to count on.
const MOST: u64 = 1 << 48;

/// Checks `state` against the scene and the state `first` that its run began with.
///
/// # Errors
/// `Input`: the first thing that does not fit.
pub fn check<const D: usize>(scene: &Scene<D>, first: &State<D>, state: &State<D>) -> Result<()> {
    check_times(scene, state)?;
    check_fields(scene, state)?;
    check_cells(scene, state)?;
    check_points(scene, first, state)?;
    check_elements(scene, first, state)?;
    check_samples(scene, state)?;
    check_weighing(scene, state)?;
    state.front.iter().try_for_each(check_front)?;
    check_contact(scene, state)?;
    ensure(has_room_for_penalties(scene, state), "the list of penalised cells")
}

fn ensure(fits: bool, what: &str) -> Result<()> {
    if fits { Ok(()) } else { Err(foreign(what)) }
}

/// Where the run is, and the size of its steps.
fn check_times<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Result<()> {
    let State { phase, phase_time, step, step_size, last_step, peak, frames, .. } = *state;
    let time = state.time - scene.begins;
    let phases = scene.phases.len();
    ensure(phase <= phases, "the number of its phase")?;
    ensure((1..=MOST).contains(&step) && frames <= step + 1, "its number of steps")?;
    ensure((1..=MOST).contains(&state.restorations), "its number of restorations")?;
    let earlier: f64 = scene.phases[..phase].iter().map(|p| p.duration).sum();
    let longest = (1.0 + ROUNDING) * (earlier + phase_time);
    ensure(phase_time >= 0.0 && (1.0 - ROUNDING) * phase_time <= time && time <= longest, "its time")?;
    // Steps that the clock does not feel would never end.
    let felt = last_step > 0.0 && time + last_step > time && last_step <= (1.0 + ROUNDING) * time;
    // A search for failure begins with a step that takes no time.
    ensure(felt || (time == 0.0 && last_step == 0.0), "its last step")?;
    let of_phase = |last: Span| {
        let latest = scene.phases.get(last.phase).map_or(0.0, |phase| (1.0 + ROUNDING) * phase.duration);
        last.phase <= phase && last.from >= 0.0 && last.from < last.to && last.to <= latest
    };
    ensure(state.balanced.is_none_or(of_phase), "its last step")?;
    ensure(step_size > 0.0 && peak >= 0.0, "the size of its steps")?;
    ensure(
        state.in_play >= 0.0 && state.energies.is_none_or(|energies| energies.0.iter().all(|e| e.is_finite())),
        "its energies",
    )?;
    let counted = state.left.iter().flatten().chain(state.entered.iter().flatten()).all(|flow| *flow >= 0.0);
    ensure(counted && [0, scene.outflows.len()].contains(&state.left.len()), "what has left")?;
    ensure([0, scene.inflows.len()].contains(&state.entered.len()), "what has entered")?;
    let Some(next) = scene.phases.get(phase) else {
        return ensure(phase_time == 0.0 && !state.moving && !state.switched_to_dynamics, "its end");
    };
    ensure(next.duration + step_size > next.duration, "the size of its steps")?;
    let more = Controller::new(next.step, next.stops.clone(), step_size).next_stop(phase_time).is_some();
    ensure(more, "its time in the phase")?;
    ensure(next.auto || !state.switched_to_dynamics, "its fall")?;
    ensure(state.dynamic(scene) || !state.moving, "its motion")
}

/// The fields on the nodes.
fn check_fields<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Result<()> {
    let displacements = scene.displacements();
    let exact = |field: &[[f64; D]], present: bool, name: &str| {
        let expected = if present { displacements } else { 0 };
        ensure(field.len() == expected, &format!("the length {} of `{name}`, not {expected},", field.len()))
    };
    exact(&state.displacement, true, "displacement")?;
    exact(&state.travel, true, "travel")?;
    exact(&state.increment, true, "increment")?;
    exact(&state.reaction, true, "reaction")?;
    exact(&state.uncounted, begun(scene, state).any(|phase| phase.reset_displacements), "uncounted")?;
    let searches = scene.phases.get(state.phase).is_some_and(|phase| phase.search.is_some());
    let begun_search = !state.search_curve.is_empty();
    exact(&state.search_geometry, begun_search, "search_geometry")?;
    ensure(searches || !begun_search, "its search for failure")?;
    ensure(state.free_lengths.len() == scene.bars.len(), "its bars")?;
    exact(&state.velocity, state.moving, "velocity")?;
    exact(&state.acceleration, state.moving, "acceleration")?;
    let moved = scene.fem.is_some() || !scene.bodies.is_empty();
    // A run that this one goes on from may have moved curves, or not.
    exact(&state.nodes, moved || !state.nodes.is_empty(), "coordinates")?;
    let held = !state.ramp.force.is_empty();
    exact(&state.ramp.force, held, "ramp")?;
    let until = state.ramp.until;
    ensure(if held { state.phase_time < until } else { until == 0.0 }, "the time of its ramp")?;
    let numbers = scene.basis.domain_size() * state.points.len();
    ensure(state.points.domain.len() == numbers && state.fem.domain.is_empty(), "the domains of its points")?;
    let [places, _] = scene.places();
    let pressures = if scene.pressure_unit.is_some() { places.end(scene.water.is_some()) } else { 0 };
    ensure(state.pressure.len() == pressures, "its pressure field")
}

/// The phases after the first one that have begun.
fn begun<'a, const D: usize>(
    scene: &'a Scene<D>,
    state: &State<D>,
) -> impl DoubleEndedIterator<Item = &'a crate::step::Phase> {
    scene.phases.iter().take(state.phase + 1).skip(1)
}

/// The cells that take part.
fn check_cells<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Result<()> {
    let cells = scene.mesh.cells.len();
    ensure(state.active.len() == cells, "the number of cells")?;
    ensure([0, cells].contains(&state.penalised.len()), "the list of penalised cells")?;
    let Voids { of_cell, reported } = &state.voids;
    let known = of_cell.iter().all(|&label| (label as usize) <= reported.len());
    let areas = reported.iter().flatten().all(|area| *area >= 0.0);
    ensure([0, cells].contains(&of_cell.len()) && known && areas, "its voids")
}

fn check_points<const D: usize>(scene: &Scene<D>, first: &State<D>, state: &State<D>) -> Result<()> {
    check_family(scene, state, &scene.mesh, &first.points, &state.points)?;
    let flows = !state.left.is_empty() || !state.entered.is_empty();
    if flows || state.weights.samples.is_some() || scene.touched(state.phase, state.phase_time).contains(&true) {
        check_sums(scene, state, &first.points, &state.points)?;
    } else {
        check_kept(scene, state, &first.points, &state.points)?;
    }
    ensure(state.points.plastic_increment.len() == state.points.len(), "a column of its points")?;
    let Points { cell, .. } = &state.points;
    ensure(cell.iter().all(|&c| state.active[c as usize]), "the cell of a material point")?;
    ensure([0, cell.len()].contains(&state.start_position.len()), "where its material points began the phase")?;
    let places = &state.parametric;
    let inside = |(&c, xi): (&u32, &[f64; 3])| is_inside(&scene.mesh, c, xi);
    ensure(places.len() == cell.len() && cell.iter().zip(places).all(inside), "the place of a material point")
}

/// The points of the finite elements, which stay where they are in their cells.
fn check_elements<const D: usize>(scene: &Scene<D>, first: &State<D>, state: &State<D>) -> Result<()> {
    let none = Mesh::default();
    let mesh = scene.fem.as_ref().map_or(&none, |fem| &fem.mesh);
    check_family(scene, state, mesh, &first.fem, &state.fem)?;
    check_kept(scene, state, &first.fem, &state.fem)?;
    let (now, then) = (&state.fem, &first.fem);
    let same = now.cell == then.cell && now.origin == then.origin && state.fem_parametric == first.fem_parametric;
    ensure(same, "the place of a point of a finite element")
}

/// Points that stay those that the run began with.
fn check_kept<const D: usize>(scene: &Scene<D>, state: &State<D>, first: &Points<D>, points: &Points<D>) -> Result<()> {
    ensure(points.len() == first.len(), "the number of points")?;
    let same = points.region == first.region && points.initial_volume == first.initial_volume;
    ensure(same, "the region or the volume of a point")?;
    let changed = |p: usize| begun(scene, state).flat_map(|phase| &phase.changes).any(|c| c.region == points.region[p]);
    ensure((0..points.len()).all(|p| points.mass[p] == first.mass[p] || changed(p)), "the mass of a point")
}

/// The volume when seeded and the mass of the material points of each region, which may have been split and merged, where phases have not
/// removed or placed any.
fn check_sums<const D: usize>(scene: &Scene<D>, state: &State<D>, first: &Points<D>, points: &Points<D>) -> Result<()> {
    let changes: Vec<_> = begun(scene, state).flat_map(|phase| &phase.changes).map(|change| change.region).collect();
    let sums = |points: &Points<D>| {
        let mut sums = vec![[0.0; 2]; scene.mesh.regions.len()];
        for (p, &region) in points.region.iter().enumerate() {
            let [volume, mass] = &mut sums[usize::from(region)];
            *volume += points.initial_volume[p];
            *mass += if changes.contains(&region) { 0.0 } else { points.mass[p] };
        }
        sums
    };
    let touched = scene.touched(state.phase, state.phase_time);
    let close = |(a, b): (&f64, &f64)| (a - b).abs() <= ROUNDING * b;
    if !state.left.is_empty() || !state.entered.is_empty() {
        // Soil of any region may have left or entered: all of it together is kept.
        let mass = |points: &Points<D>| points.mass.iter().sum::<f64>();
        let left: f64 = state.left.iter().map(|[mass, _]| mass).sum();
        let entered: f64 = state.entered.iter().map(|[mass, ..]| mass).sum();
        let fits = close((&(mass(points) + left), &(mass(first) + entered)));
        return ensure(
            fits || !changes.is_empty() || touched.contains(&true),
            "the mass of the points with what has passed",
        );
    }
    let all = sums(points).into_iter().zip(sums(first)).zip(touched);
    let mut kept = all.filter(|(_, touched)| !touched).map(|(sums, _)| sums);
    ensure(kept.all(|(now, then)| now.iter().zip(&then).all(close)), "the volume or the mass of a region")
}

/// Points against those that the run began with: their columns and materials.
fn check_family<const D: usize>(
    scene: &Scene<D>,
    state: &State<D>,
    mesh: &Mesh<D>,
    first: &Points<D>,
    points: &Points<D>,
) -> Result<()> {
    let count = points.len();
    points
        .check(mesh.regions.len(), mesh.cells.len())
        .map_err(|problem| Error::input("checkpoint", problem, "start the analysis afresh, without --resume"))?;
    let began_moving = !first.velocity.is_empty();
    let columns = [
        (points.reference.len(), begun(scene, state).any(|phase| phase.reset_displacements)),
        (points.velocity.len(), state.moving || began_moving && !points.velocity.is_empty()),
        (points.acceleration.len(), state.moving),
        (points.model.len(), begun(scene, state).any(|phase| !phase.changes.is_empty())),
    ];
    ensure(
        columns.iter().all(|&(length, present)| length == if present { count } else { 0 }),
        "a column of its points",
    )?;
    let expected = |column: &Column, at_first: usize| if column.presence == Presence::Phases { ANY } else { at_first };
    ensure(widths_agree(points, first, &expected), "a column of its points")?;
    let changes: Vec<_> = begun(scene, state).flat_map(|phase| &phase.changes).collect();
    for (p, &region) in points.region.iter().enumerate() {
        let change = changes.iter().rev().find(|change| change.region == region);
        let number = change.map_or(region, |change| change.number);
        ensure(points.model.is_empty() || points.model[p] == number, "the material of a point")?;
    }
    Ok(())
}

/// Any number of entries.
const ANY: usize = usize::MAX;

/// Whether each column has as many entries for a point as is `expected` of it, given how many it has in `others`.
fn widths_agree<const D: usize>(
    points: &Points<D>,
    others: &Points<D>,
    expected: &dyn Fn(&Column, usize) -> usize,
) -> bool {
    struct Widths<'a> {
        count: usize,
        of: Vec<(&'a Column, usize)>,
    }
    impl Visitor<'_> for Widths<'_> {
        fn visit<T: Item>(&mut self, column: &'static Column, values: &[T]) {
            self.of.push((column, if values.is_empty() { 0 } else { values.len() / self.count }));
        }
    }
    let [own, others] = [points, others].map(|points| {
        let mut widths = Widths { count: points.len(), of: Vec::new() };
        points.each(&mut widths);
        widths.of
    });
    points.is_empty()
        || own.iter().zip(&others).all(|((column, own), (_, others))| [ANY, *own].contains(&expected(column, *others)))
}

/// Whether a parametric place is within a cell.
fn is_inside<const D: usize>(mesh: &Mesh<D>, cell: u32, xi: &[f64; 3]) -> bool {
    mesh.cells.kind[cell as usize].depth(xi).0 >= -ROUNDING
}

/// The integration points of the cells.
fn check_samples<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Result<()> {
    let Some(Samples { points, parametric, outside, .. }) = &state.weights.samples else { return Ok(()) };
    points
        .check(scene.mesh.regions.len(), scene.mesh.cells.len())
        .map_err(|problem| Error::input("checkpoint", problem, "start the analysis afresh, without --resume"))?;
    let material = &state.points;
    let expected = |column: &Column, of_material: usize| if column.at_integration { of_material } else { 0 };
    ensure(widths_agree(points, material, &expected), "a column of its integration points")?;
    let number = |region: u16| material.region.iter().position(|&r| r == region).and_then(|p| material.model.get(p));
    let same = (0..points.model.len()).all(|q| number(points.region[q]) == Some(&points.model[q]));
    ensure(same, "the material of an integration point")?;
    let cell = &points.cell;
    let takes_part = cell.iter().all(|&c| state.active[c as usize]);
    ensure(takes_part && cell.is_sorted(), "the cell of an integration point")?;
    let inside = |(&c, xi): (&u32, &[f64; 3])| is_inside(&scene.mesh, c, xi);
    let places = parametric.len() == cell.len() && cell.iter().zip(parametric).all(inside);
    ensure(places, "the place of an integration point")?;
    let count = |of: &Points<D>, c: u32| of.cell.iter().filter(|&&d| d == c).count();
    let same = |&c: &u32| count(points, c) > 0 && count(points, c) == count(material, c);
    ensure(outside.is_sorted_by(|a, b| a < b) && outside.iter().all(same), "a cell outside the surface")
}

/// The weights of the points and what is known of the cells.
fn check_weighing<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Result<()> {
    let Weights { weight, partly_filled, ill_conditioned, boundary, level_set, .. } = &state.weights;
    let nodes = scene.mesh.nodes.len();
    ensure(weight.len() == state.integration().len() && weight.iter().all(|w| *w > 0.0), "the weight of a point")?;
    let takes_part = |c: u32| state.active.get(c as usize) == Some(&true);
    let ascend = |cells: &mut dyn Iterator<Item = u32>| cells.is_sorted_by(|a, b| a < b);
    ensure(
        ascend(&mut partly_filled.iter().map(|s| s.cell)) && partly_filled.iter().all(|s| takes_part(s.cell)),
        "the list of partly filled cells",
    )?;
    ensure(partly_filled.iter().all(|s| s.emptiness > 0.0 && s.emptiness <= 1.0), "the emptiness of a cell")?;
    ensure(
        ascend(&mut ill_conditioned.iter().copied()) && ill_conditioned.iter().all(|&c| takes_part(c)),
        "the list of ill-conditioned cells",
    )?;
    ensure([0, nodes].contains(&level_set.len()), "its level set")?;
    let ActiveBoundary { pieces, first } = boundary;
    ensure(bounds_of_loops(first, pieces.len(), 1), "a loop of its boundary")?;
    for piece in pieces {
        ensure(takes_part(piece.cell) && takes_part(piece.host), "a cell of its boundary")?;
        let region = piece.region;
        ensure(region == NO_REGION || usize::from(region) < scene.mesh.regions.len(), "a region of its boundary")?;
        let inside = |&[x, y]: &[f64; 2]| is_inside(&scene.mesh, piece.cell, &[x, y, 0.0]);
        ensure(piece.path.ends.iter().all(inside), "a place of its boundary")?;
    }
    Ok(())
}

/// Whether `first` says where each of some loops of at least `least` entries begins, and where the last one ends; there may be
/// none at all.
fn bounds_of_loops(first: &[u32], entries: usize, least: u32) -> bool {
    let whole = first.windows(2).all(|w| w[0].checked_add(least).is_some_and(|end| end <= w[1]));
    match (first.first(), first.last()) {
        (Some(0), Some(&last)) => whole && last as usize == entries,
        (None, _) => entries == 0,
        _ => false,
    }
}

fn check_front(front: &MarkerFront) -> Result<()> {
    let loops = !front.first.is_empty() && bounds_of_loops(&front.first, front.position.len(), 3);
    ensure(loops, "its surface")
}

fn check_contact<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Result<()> {
    ensure(state.multipliers.len() == scene.interfaces.len(), "the number of its contacts")?;
    let fits = |(interface, held): (&dyn Interface<D>, &Multipliers)| {
        let Multipliers { pressure, shear, gap, slip, slid, force, faces, apart, room, first } = held;
        let lengths = [pressure, shear, gap, slip, slid].iter().all(|v| v.len() == interface.contact_nodes());
        let lengths = lengths && [force.len(), faces.len(), apart.len()] == [interface.contact_nodes(); 3];
        let bounds = first.len() == interface.contact_nodes() + 1 && bounds_of_loops(first, room.len(), 0);
        let nodes = room.iter().all(|&n| (n as usize) < scene.displacements());
        lengths && bounds && nodes && slip.iter().all(|slip| *slip >= 0.0) && {
            let mut seen = HashSet::new();
            (0..interface.contact_nodes()).all(|k| {
                seen.clear();
                held.room(k).iter().all(|n| seen.insert(*n))
            })
        }
    };
    ensure(scene.interfaces.iter().map(AsRef::as_ref).zip(&state.multipliers).all(fits), "its contact")
}
