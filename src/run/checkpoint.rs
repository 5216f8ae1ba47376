//! The state as named arrays, for checkpoints, every number bit-exact.

mod valid;

use super::foreign::foreign;
use crate::contact::Multipliers;
use crate::error::Result;
use crate::interpolation::PartlyFilled;
use crate::io::columns;
use crate::io::container::Store;
use crate::quadrature::{Count, Samples, Tally, Weights};
use crate::step::{Energies, ITEMS, Scene, Span, State, UnbalancedRamp};
use crate::surface::{ActiveBoundary, MarkerFront, Path, Piece, Voids};

const POINTS: &str = "points.";
const FEM: &str = "fem.";
const SAMPLES: &str = "sample.";
/// What a checkpoint has for the area of a void that is no news.
const NO_NEWS: f64 = -1.0;

/// Puts everything in a state into a store for a file of whichever kind.
pub fn put<const D: usize>(mut store: Store, state: &State<D>) -> Store {
    // No `..`: a new field of the state must find its place here.
    let State {
        phase,
        time,
        phase_time,
        step,
        step_size,
        frames,
        points,
        fem,
        fem_parametric,
        nodes,
        multipliers,
        moving,
        switched_to_dynamics,
        peak,
        in_play,
        energies,
        reaction,
        start_position,
        ramp,
        parametric,
        displacement,
        increment,
        last_step,
        balanced,
        search_geometry,
        search_curve,
        travel,
        uncounted,
        pressure,
        velocity,
        acceleration,
        active,
        penalised,
        weights,
        front,
        voids,
        restorations,
    } = state;
    store.put(
        "state.counts",
        1,
        vec![*phase as u64, *step, *frames, u64::from(*moving), *restorations, u64::from(*switched_to_dynamics)],
    );
    store.put(
        "state.times",
        1,
        vec![*time, *phase_time, *step_size, *last_step, *peak, *in_play, ramp.from, ramp.until],
    );
    let last = balanced.map_or_else(Vec::new, |last| vec![last.phase as f64, last.from, last.to]);
    store.put("state.balanced", 1, last);
    store.put("state.energies", 1, energies.map_or_else(Vec::new, |energies| energies.0.to_vec()));
    store.put("state.parametric", 3, parametric.concat());
    store.put("state.fem_parametric", 3, fem_parametric.concat());
    for (name, field) in [
        ("displacement", displacement),
        ("travel", travel),
        ("uncounted", uncounted),
        ("velocity", velocity),
        ("acceleration", acceleration),
        ("coordinates", nodes),
        ("increment", increment),
        ("start_position", start_position),
        ("ramp", &ramp.force),
        ("search_geometry", search_geometry),
        ("reaction", reaction),
    ] {
        store.put(&format!("state.{name}"), D, field.concat());
    }
    store.put("state.search_curve", 2, search_curve.concat());
    store.put("state.pressure", 1, pressure.clone());
    store.put("state.active", 1, active.iter().map(|&b| u8::from(b)).collect());
    store.put("state.penalised", 1, penalised.iter().map(|&b| u8::from(b)).collect());
    put_weighing(&mut store, weights);
    put_multipliers(&mut store, multipliers);
    // Without loops where the surface is not followed.
    let (markers, loops) = front.as_ref().map_or((Vec::new(), Vec::new()), |f| (f.position.concat(), f.first.clone()));
    store.put("front.position", 2, markers);
    store.put("front.first", 1, loops);
    store.put("voids.of_cell", 1, voids.of_cell.clone());
    store.put("voids.reported", 1, voids.reported.iter().map(|area| area.unwrap_or(NO_NEWS)).collect());
    columns::put(&mut store, POINTS, points);
    columns::put(&mut store, FEM, fem);
    store
}

fn put_weighing<const D: usize>(store: &mut Store, weights: &Weights<D>) {
    // Why a front was lost has been told when it was.
    let Weights {
        samples,
        weight,
        partly_filled,
        ill_conditioned,
        boundary,
        level_set,
        tally,
        lost_front: _,
        notes: _,
        beyond: _,
        renewed: _,
    } = weights;
    let Tally { linear, constant, taken, point_volume, volume, population: Count { split, merged, starved } } = tally;
    if let Some(Samples { points, parametric, outside, .. }) = samples {
        columns::put(store, SAMPLES, points);
        store.put("samples.parametric", 3, parametric.concat());
        store.put("samples.outside", 1, outside.clone());
    }
    store.put("weights.weight", 1, weight.clone());
    store.put("weights.partly_filled", 1, partly_filled.iter().map(|s| s.cell).collect());
    store.put("weights.emptiness", 1, partly_filled.iter().map(|s| s.emptiness).collect());
    store.put("weights.ill_conditioned", 1, ill_conditioned.clone());
    store.put("weights.level_set", 1, level_set.clone());
    let ActiveBoundary { pieces, first } = boundary;
    store.put("boundary.first", 1, first.clone());
    let path = |path: &Path| [path.ends, path.rates].concat().concat();
    store.put(
        "boundary.paths",
        2,
        pieces.iter().flat_map(|piece| [path(&piece.path), path(&piece.in_host)].concat()).collect(),
    );
    let numbers = |piece: &Piece| [piece.cell, piece.host, u32::from(piece.region), u32::from(piece.wall)];
    store.put("boundary.numbers", 4, pieces.iter().flat_map(numbers).collect());
    store.put("weights.cells", 1, vec![*linear, *constant, *taken, *split, *merged, *starved]);
    store.put("weights.volume", 1, vec![*point_volume, *volume]);
}

fn take_weighing<const D: usize>(store: &mut Store) -> Result<Weights<D>> {
    let samples = match store.take_if_present::<f64>("samples.parametric", 3)? {
        Some(parametric) => Some(Samples {
            points: columns::take(store, SAMPLES)?,
            parametric: vectors(&parametric),
            outside: store.take::<u32>("samples.outside", 1)?,
            motion: Vec::new(),
        }),
        None => None,
    };
    let weight = store.take::<f64>("weights.weight", 1)?;
    let (partly_filled, emptiness) =
        (store.take::<u32>("weights.partly_filled", 1)?, store.take::<f64>("weights.emptiness", 1)?);
    if partly_filled.len() != emptiness.len() {
        return Err(foreign("what it says of cells"));
    }
    let partly_filled =
        partly_filled.into_iter().zip(emptiness).map(|(cell, emptiness)| PartlyFilled { cell, emptiness }).collect();
    let ill_conditioned = store.take::<u32>("weights.ill_conditioned", 1)?;
    let level_set = store.take::<f64>("weights.level_set", 1)?;
    let boundary = take_boundary(store)?;
    let (cells, volume) = (store.take::<u32>("weights.cells", 1)?, store.take::<f64>("weights.volume", 1)?);
    let ([linear, constant, taken, split, merged, starved], [point_volume, volume]) = (&cells[..], &volume[..]) else {
        return Err(foreign("its weights"));
    };
    let population = Count { split: *split, merged: *merged, starved: *starved };
    let (point_volume, volume) = (*point_volume, *volume);
    let tally = Tally { linear: *linear, constant: *constant, taken: *taken, point_volume, volume, population };
    let (lost_front, notes, beyond, renewed) = (None, Vec::new(), None, None);
    Ok(Weights {
        samples,
        weight,
        partly_filled,
        ill_conditioned,
        boundary,
        level_set,
        tally,
        lost_front,
        notes,
        beyond,
        renewed,
    })
}

fn take_boundary(store: &mut Store) -> Result<ActiveBoundary> {
    let first = store.take::<u32>("boundary.first", 1)?;
    let (paths, numbers) = (store.take::<f64>("boundary.paths", 2)?, store.take::<u32>("boundary.numbers", 4)?);
    if paths.len() != 4 * numbers.len() {
        return Err(foreign("its boundary"));
    }
    let piece = |(paths, numbers): (&[f64], &[u32])| {
        let two = |k: usize| [[paths[k], paths[k + 1]], [paths[k + 2], paths[k + 3]]];
        let path = |k: usize| Path { ends: two(k), rates: two(k + 4) };
        let region = u16::try_from(numbers[2]).map_err(|_| foreign("a region of its boundary"))?;
        let wall = flag(numbers[3], "its boundary")?;
        Ok(Piece { cell: numbers[0], path: path(0), wall, region, host: numbers[1], in_host: path(8) })
    };
    let pieces = paths.chunks_exact(16).zip(numbers.chunks_exact(4)).map(piece).collect::<Result<_>>()?;
    Ok(ActiveBoundary { pieces, first })
}

/// Vectors of `D` components, one after the other.
fn vectors<const D: usize>(values: &[f64]) -> Vec<[f64; D]> {
    values.chunks_exact(D).map(|v| std::array::from_fn(|d| v[d])).collect()
}

/// A truth value that is stored as 0 or 1.
fn flag(value: impl Into<u64>, name: &str) -> Result<bool> {
    match value.into() {
        0 => Ok(false),
        1 => Ok(true),
        _ => Err(foreign(name)),
    }
}

fn flags(store: &mut Store, name: &str) -> Result<Vec<bool>> {
    store.take::<u8>(name, 1)?.into_iter().map(|value| flag(value, name)).collect()
}

fn put_multipliers(store: &mut Store, interfaces: &[Multipliers]) {
    store.put("contact.interfaces", 1, vec![interfaces.len() as u64]);
    for (i, Multipliers { pressure, shear, gap, slip, slid, force, faces, apart, room, first }) in
        interfaces.iter().enumerate()
    {
        for (name, values) in [("pressure", pressure), ("shear", shear), ("gap", gap), ("slip", slip), ("slid", slid)] {
            store.put(&format!("contact.{i}.{name}"), 1, values.clone());
        }
        store.put(&format!("contact.{i}.force"), 3, force.concat());
        for (name, flags) in [("faces", faces), ("apart", apart)] {
            store.put(&format!("contact.{i}.{name}"), 1, flags.iter().map(|&b| u8::from(b)).collect());
        }
        store.put(&format!("contact.{i}.room"), 1, room.clone());
        store.put(&format!("contact.{i}.first"), 1, first.clone());
    }
}

fn take_multipliers(store: &mut Store) -> Result<Vec<Multipliers>> {
    let [count] = store.take::<u64>("contact.interfaces", 1)?[..] else { return Err(foreign("its contact")) };
    let interface = |i: u64| {
        let mut values = |name: &str| store.take::<f64>(&format!("contact.{i}.{name}"), 1);
        let (pressure, shear, gap) = (values("pressure")?, values("shear")?, values("gap")?);
        let (slip, slid) = (values("slip")?, values("slid")?);
        let force = store.take::<f64>(&format!("contact.{i}.force"), 3)?;
        let force = force.chunks_exact(3).map(|f| [f[0], f[1], f[2]]).collect();
        let [faces, apart] =
            [flags(store, &format!("contact.{i}.faces"))?, flags(store, &format!("contact.{i}.apart"))?];
        let mut numbers = |name: &str| store.take::<u32>(&format!("contact.{i}.{name}"), 1);
        let (room, first) = (numbers("room")?, numbers("first")?);
        Ok(Multipliers { pressure, shear, gap, slip, slid, force, faces, apart, room, first })
    };
    (0..count).map(interface).collect()
}

fn take_balanced(store: &mut Store) -> Result<Option<Span>> {
    match store.take::<f64>("state.balanced", 1)?[..] {
        [] => Ok(None),
        [phase, from, to] => Ok(Some(Span { phase: phase as usize, from, to })),
        _ => Err(foreign("its last step")),
    }
}

fn take_energies(store: &mut Store) -> Result<Option<Energies>> {
    let values = store.take::<f64>("state.energies", 1)?;
    match <[f64; ITEMS.len()]>::try_from(&values[..]) {
        Ok(values) => Ok(Some(Energies(values))),
        Err(_) if values.is_empty() => Ok(None),
        Err(_) => Err(foreign("its energies")),
    }
}

fn take_front(store: &mut Store) -> Result<Option<MarkerFront>> {
    let position = vectors(&store.take::<f64>("front.position", 2)?);
    let first = store.take::<u32>("front.first", 1)?;
    let none = position.is_empty() && first.is_empty();
    Ok((!none).then_some(MarkerFront { position, first }))
}

/// The state in which a run of `scene` begins its phase number `begun`, given that at the end of the phase before, in another run with the same
/// phases until then. `first` is the one that would begin the whole.
///
/// # Errors
/// As [`take`].
pub fn after_phase<const D: usize>(store: Store, scene: &Scene<D>, first: &State<D>, begun: usize) -> Result<State<D>> {
    let mut state = read(store)?;
    if state.phase + 1 != begun || begun >= scene.phases.len() {
        return Err(foreign("the number of its phase"));
    }
    // What begins a phase takes these for granted.
    let regions = scene.mesh.regions.len();
    let cells = scene.mesh.cells.len() + scene.fem.as_ref().map_or(0, |fem| fem.mesh.cells.len());
    let samples = state.weights.samples.as_ref().map(|samples| &samples.points);
    for points in [&state.points, &state.fem].into_iter().chain(samples) {
        points.check(regions, cells).map_err(|problem| foreign(&problem))?;
    }
    state.next_phase(scene);
    state.frames = 0;
    valid::check(scene, first, &state)?;
    Ok(state)
}

/// The state in a checkpoint of the run of `scene` that began with `first`.
///
/// # Errors
/// `Input` when an array is missing or unknown, or what one holds does not fit the scene.
pub fn take<const D: usize>(store: Store, scene: &Scene<D>, first: &State<D>) -> Result<State<D>> {
    let state = read(store)?;
    valid::check(scene, first, &state)?;
    Ok(state)
}

/// The state in a store, as it stands there.
fn read<const D: usize>(mut store: Store) -> Result<State<D>> {
    let counts = store.take::<u64>("state.counts", 1)?;
    let times = store.take::<f64>("state.times", 1)?;
    let (
        [phase, step, frames, moving, restorations, switched_to_dynamics],
        [time, phase_time, step_size, last_step, peak, in_play, from, until],
    ) = (&counts[..], &times[..])
    else {
        return Err(foreign("its list of counts"));
    };
    let mut nodal = |name: &str| Ok(vectors(&store.take::<f64>(&format!("state.{name}"), D)?));
    let (displacement, travel, increment) = (nodal("displacement")?, nodal("travel")?, nodal("increment")?);
    let (velocity, acceleration, nodes) = (nodal("velocity")?, nodal("acceleration")?, nodal("coordinates")?);
    let (uncounted, force, start_position) = (nodal("uncounted")?, nodal("ramp")?, nodal("start_position")?);
    let (search_geometry, reaction) = (nodal("search_geometry")?, nodal("reaction")?);
    let reported = |area: f64| (area != NO_NEWS).then_some(area);
    let state = State {
        phase: usize::try_from(*phase).map_err(|_| foreign("the number of its phase"))?,
        time: *time,
        phase_time: *phase_time,
        step: *step,
        step_size: *step_size,
        frames: *frames,
        points: columns::take(&mut store, POINTS)?,
        fem: columns::take(&mut store, FEM)?,
        fem_parametric: vectors(&store.take::<f64>("state.fem_parametric", 3)?),
        nodes,
        multipliers: take_multipliers(&mut store)?,
        moving: flag(*moving, "whether it moves")?,
        switched_to_dynamics: flag(*switched_to_dynamics, "whether it falls")?,
        peak: *peak,
        in_play: *in_play,
        energies: take_energies(&mut store)?,
        reaction,
        start_position,
        ramp: UnbalancedRamp { force, from: *from, until: *until },
        parametric: vectors(&store.take::<f64>("state.parametric", 3)?),
        displacement,
        increment,
        last_step: *last_step,
        balanced: take_balanced(&mut store)?,
        search_geometry,
        search_curve: vectors(&store.take::<f64>("state.search_curve", 2)?),
        travel,
        uncounted,
        pressure: store.take::<f64>("state.pressure", 1)?,
        velocity,
        acceleration,
        active: flags(&mut store, "state.active")?,
        penalised: flags(&mut store, "state.penalised")?,
        weights: take_weighing(&mut store)?,
        front: take_front(&mut store)?,
        voids: Voids {
            of_cell: store.take::<u32>("voids.of_cell", 1)?,
            reported: store.take("voids.reported", 1)?.into_iter().map(reported).collect(),
        },
        restorations: *restorations,
    };
    if let Some(array) = store.into_arrays().first() {
        return Err(foreign(&format!("the array `{}`", array.name)));
    }
    Ok(state)
}
