//! The state as named arrays, for checkpoints, every number bit-exact. One list of them serves both ways.

mod valid;

use super::foreign::foreign;
use crate::contact::Multipliers;
use crate::error::Result;
use crate::interpolation::PartlyFilled;
use crate::io::columns;
use crate::io::container::{Scalar, Store};
use crate::points::Points;
use crate::quadrature::{Count, Samples, Tally, Weights};
use crate::step::{Energies, Scene, Span, State, UnbalancedRamp};
use crate::surface::{ActiveBoundary, MarkerFront, Path, Piece, Voids};

/// What a checkpoint has for the area of a void that is no news.
const NO_NEWS: f64 = -1.0;

/// A store that is written, and what is passed to it is what it takes; or one that is read, and that is what it gives back.
struct Archive {
    store: Store,
    reads: bool,
}

impl Archive {
    fn list<E: Entry>(&mut self, name: &str, values: &[E]) -> Result<Vec<E>> {
        if self.reads {
            return Ok(self.store.take(name, E::WIDTH)?.chunks_exact(E::WIDTH).map(E::of).collect());
        }
        let mut numbers = Vec::with_capacity(values.len() * E::WIDTH);
        values.iter().for_each(|value| value.append(&mut numbers));
        self.store.put(name, E::WIDTH, numbers);
        Ok(Vec::new())
    }

    /// A list of a known length.
    fn array<E: Entry, const N: usize>(&mut self, name: &str, values: [E; N]) -> Result<[E; N]> {
        let read = self.list(name, &values)?;
        if self.reads { read.try_into().map_err(|_| unlike(name)) } else { Ok(values) }
    }

    /// A list of a known length, or none.
    fn option<E: Entry, const N: usize>(&mut self, name: &str, values: Option<[E; N]>) -> Result<Option<[E; N]>> {
        let read = self.list(name, values.as_ref().map_or(&[][..], |values| values))?;
        if read.is_empty() { Ok(None) } else { read.try_into().map(Some).map_err(|_| unlike(name)) }
    }

    fn points<const D: usize>(&mut self, prefix: &str, points: &Points<D>) -> Result<Points<D>> {
        if self.reads {
            return columns::take(&mut self.store, prefix);
        }
        columns::put(&mut self.store, prefix, points);
        Ok(Points::default())
    }
}

fn unlike(name: &str) -> crate::error::Error {
    foreign(&format!("the length of `{name}`"))
}

/// An entry of a list, as numbers of one type.
trait Entry: Copy {
    type Number: Scalar;
    const WIDTH: usize;

    fn append(self, numbers: &mut Vec<Self::Number>);

    fn of(numbers: &[Self::Number]) -> Self;
}

macro_rules! entry {
    ($($own:ty as $number:ty: $to:expr, $from:expr;)*) => {
        $(impl Entry for $own {
            type Number = $number;
            const WIDTH: usize = 1;

            fn append(self, numbers: &mut Vec<$number>) {
                numbers.push($to(self));
            }

            fn of(numbers: &[$number]) -> Self {
                $from(numbers[0])
            }
        })*
    };
}
entry! {
    f64 as f64: f64::from, f64::from;
    u64 as u64: u64::from, u64::from;
    u32 as u32: u32::from, u32::from;
    bool as u8: u8::from, |flag| flag != 0;
}

impl<E: Entry, const N: usize> Entry for [E; N] {
    type Number = E::Number;
    const WIDTH: usize = N * E::WIDTH;

    fn append(self, numbers: &mut Vec<E::Number>) {
        self.into_iter().for_each(|entry| entry.append(numbers));
    }

    fn of(numbers: &[E::Number]) -> Self {
        std::array::from_fn(|i| E::of(&numbers[i * E::WIDTH..]))
    }
}

/// Puts everything in a state into a store for a file of whichever kind.
///
/// # Errors
/// None: that is for reading.
pub fn put<const D: usize>(store: Store, state: &State<D>) -> Result<Store> {
    let mut archive = Archive { store, reads: false };
    pass(&mut archive, state)?;
    Ok(archive.store)
}

/// The state in a store, as it stands there.
fn read<const D: usize>(store: Store) -> Result<State<D>> {
    pass(&mut Archive { store, reads: true }, &State::default())
}

fn pass<const D: usize>(archive: &mut Archive, state: &State<D>) -> Result<State<D>> {
    let s = state;
    let counts = [s.phase as u64, s.step, s.frames, s.moving.into(), s.restorations, s.switched_to_dynamics.into()];
    let [phase, step, frames, moving, restorations, switched_to_dynamics] = archive.array("state.counts", counts)?;
    let times = [s.time, s.phase_time, s.step_size, s.last_step, s.peak, s.in_play, s.ramp.from, s.ramp.until];
    let [time, phase_time, step_size, last_step, peak, in_play, from, until] = archive.array("state.times", times)?;
    let balanced = s.balanced.map(|last| [last.phase as f64, last.from, last.to]);
    let balanced = archive.option("state.balanced", balanced)?;
    // No `..`: a new field of the state must find its place here.
    Ok(State {
        phase: phase as usize,
        time,
        phase_time,
        step,
        step_size,
        frames,
        points: archive.points("points.", &s.points)?,
        fem: archive.points("fem.", &s.fem)?,
        fem_parametric: archive.list("state.fem_parametric", &s.fem_parametric)?,
        nodes: archive.list("state.coordinates", &s.nodes)?,
        multipliers: pass_multipliers(archive, &s.multipliers)?,
        free_lengths: archive.list("state.free_lengths", &s.free_lengths)?,
        moving: moving != 0,
        switched_to_dynamics: switched_to_dynamics != 0,
        peak,
        in_play,
        energies: archive.option("state.energies", s.energies.map(|energies| energies.0))?.map(Energies),
        left: archive.list("state.left", &s.left)?,
        entered: archive.list("state.entered", &s.entered)?,
        reaction: archive.list("state.reaction", &s.reaction)?,
        start_position: archive.list("state.start_position", &s.start_position)?,
        ramp: UnbalancedRamp { force: archive.list("state.ramp", &s.ramp.force)?, from, until },
        parametric: archive.list("state.parametric", &s.parametric)?,
        displacement: archive.list("state.displacement", &s.displacement)?,
        increment: archive.list("state.increment", &s.increment)?,
        last_step,
        balanced: balanced.map(|[phase, from, to]| Span { phase: phase as usize, from, to }),
        search_geometry: archive.list("state.search_geometry", &s.search_geometry)?,
        search_curve: archive.list("state.search_curve", &s.search_curve)?,
        travel: archive.list("state.travel", &s.travel)?,
        uncounted: archive.list("state.uncounted", &s.uncounted)?,
        pressure: archive.list("state.pressure", &s.pressure)?,
        velocity: archive.list("state.velocity", &s.velocity)?,
        acceleration: archive.list("state.acceleration", &s.acceleration)?,
        active: archive.list("state.active", &s.active)?,
        penalised: archive.list("state.penalised", &s.penalised)?,
        weights: pass_weights(archive, &s.weights)?,
        front: pass_front(archive, s.front.as_ref())?,
        voids: pass_voids(archive, &s.voids)?,
        restorations,
    })
}

fn pass_weights<const D: usize>(archive: &mut Archive, weights: &Weights<D>) -> Result<Weights<D>> {
    let w = weights;
    let Tally { linear, constant, taken, point_volume, volume, population: Count { split, merged, starved } } = w.tally;
    let cells = [linear, constant, taken, split, merged, starved];
    let [linear, constant, taken, split, merged, starved] = archive.array("weights.cells", cells)?;
    let [point_volume, volume] = archive.array("weights.volume", [point_volume, volume])?;
    let population = Count { split, merged, starved };
    let there = if archive.reads { archive.store.has("samples.parametric") } else { w.samples.is_some() };
    let none = Samples::default();
    let samples = there.then(|| pass_samples(archive, w.samples.as_ref().unwrap_or(&none))).transpose()?;
    let cells: Vec<u32> = w.partly_filled.iter().map(|s| s.cell).collect();
    let emptiness: Vec<f64> = w.partly_filled.iter().map(|s| s.emptiness).collect();
    let cells = archive.list("weights.partly_filled", &cells)?;
    let emptiness = archive.list("weights.emptiness", &emptiness)?;
    if cells.len() != emptiness.len() {
        return Err(unlike("weights.emptiness"));
    }
    let partly_filled = cells.into_iter().zip(emptiness).map(|(cell, emptiness)| PartlyFilled { cell, emptiness });
    Ok(Weights {
        samples,
        weight: archive.list("weights.weight", &w.weight)?,
        partly_filled: partly_filled.collect(),
        ill_conditioned: archive.list("weights.ill_conditioned", &w.ill_conditioned)?,
        boundary: pass_boundary(archive, &w.boundary)?,
        level_set: archive.list("weights.level_set", &w.level_set)?,
        tally: Tally { linear, constant, taken, point_volume, volume, population },
        // Why a front was lost has been told when it was.
        lost_front: None,
        notes: Vec::new(),
        beyond: None,
        renewed: None,
    })
}

fn pass_samples<const D: usize>(archive: &mut Archive, samples: &Samples<D>) -> Result<Samples<D>> {
    Ok(Samples {
        points: archive.points("sample.", &samples.points)?,
        parametric: archive.list("samples.parametric", &samples.parametric)?,
        outside: archive.list("samples.outside", &samples.outside)?,
        motion: Vec::new(),
    })
}

fn pass_boundary(archive: &mut Archive, boundary: &ActiveBoundary) -> Result<ActiveBoundary> {
    let pieces = &boundary.pieces;
    let paths: Vec<_> = pieces.iter().map(|p| [&p.path, &p.in_host].map(|path| [path.ends, path.rates])).collect();
    let numbers: Vec<_> = pieces.iter().map(|p| [p.cell, p.host, p.region.into(), p.wall.into()]).collect();
    let paths = archive.list("boundary.paths", &paths)?;
    let numbers = archive.list("boundary.numbers", &numbers)?;
    if paths.len() != numbers.len() {
        return Err(unlike("boundary.paths"));
    }
    let pieces = paths.into_iter().zip(numbers).map(|(paths, [cell, host, region, wall])| {
        let [path, in_host] = paths.map(|[ends, rates]| Path { ends, rates });
        let region = u16::try_from(region).map_err(|_| foreign("a region of its boundary"))?;
        Ok(Piece { cell, path, wall: wall != 0, region, host, in_host })
    });
    let pieces = pieces.collect::<Result<_>>()?;
    Ok(ActiveBoundary { pieces, first: archive.list("boundary.first", &boundary.first)? })
}

/// Without loops where the surface is not followed.
fn pass_front(archive: &mut Archive, front: Option<&MarkerFront>) -> Result<Option<MarkerFront>> {
    let position = archive.list("front.position", front.map_or(&[], |front| &front.position))?;
    let first = archive.list("front.first", front.map_or(&[], |front| &front.first))?;
    let none = position.is_empty() && first.is_empty();
    Ok((!none).then_some(MarkerFront { position, first }))
}

fn pass_voids(archive: &mut Archive, voids: &Voids) -> Result<Voids> {
    let reported: Vec<f64> = voids.reported.iter().map(|area| area.unwrap_or(NO_NEWS)).collect();
    let reported = archive.list("voids.reported", &reported)?;
    Ok(Voids {
        of_cell: archive.list("voids.of_cell", &voids.of_cell)?,
        reported: reported.into_iter().map(|area| (area != NO_NEWS).then_some(area)).collect(),
    })
}

fn pass_multipliers(archive: &mut Archive, interfaces: &[Multipliers]) -> Result<Vec<Multipliers>> {
    let none = Multipliers::default();
    let [count] = archive.array("contact.interfaces", [interfaces.len() as u64])?;
    let interface = |i: u64| {
        let m = interfaces.get(i as usize).unwrap_or(&none);
        let name = |list: &str| format!("contact.{i}.{list}");
        Ok(Multipliers {
            pressure: archive.list(&name("pressure"), &m.pressure)?,
            shear: archive.list(&name("shear"), &m.shear)?,
            gap: archive.list(&name("gap"), &m.gap)?,
            slip: archive.list(&name("slip"), &m.slip)?,
            slid: archive.list(&name("slid"), &m.slid)?,
            force: archive.list(&name("force"), &m.force)?,
            faces: archive.list(&name("faces"), &m.faces)?,
            apart: archive.list(&name("apart"), &m.apart)?,
            room: archive.list(&name("room"), &m.room)?,
            first: archive.list(&name("first"), &m.first)?,
        })
    };
    (0..count).map(interface).collect()
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
