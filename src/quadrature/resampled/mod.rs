//! Resampled quadrature: the integrals of a step are sums over integration points of the cells, not over the material points.
//!
//! When the grid is restored, each cell gets integration points where it is full of material and where the surface cuts
//! it ([`places`]). They take their state from a linear function (a quadratic one in cells of third order) that is fitted to that of the material points around
//! ([`fit`], [`internal`]), and until the grid is restored again they are ordinary points of finite elements. The material points move
//! with the grid and answer for its deformation themselves; nothing is handed back to them. Material points
//! outside the surface, as drops that are thrown out, are integration points themselves, with their volume and state. So are those of a cell in which all
//! have come apart: there is no stress to sum up, and what moves is the mass of each, where it is. Fitted masses are those of the points in sum only, and
//! points that fly by themselves would be mapped with one mass and moved with another.
//!
//! [`fields`] lists what is fitted: the Kirchhoff stress of the model, the pressures, `ln J`, the density, the plastic strain, the place at seeding and
//! the internal variables. Density, plastic strain and internal variables stay within the range of the points that they are fitted to. It is the stress and not the elastic strain, for it is the stress that is in balance: in
//! clay whose stiffness grows with pressure, a stress linear in depth has a strain that is not. A stress outside
//! the yield surface is returned to it, while the internal variables stay as they are fitted: where these harden in the return, the next step
//! finds a stress a little outside again.

mod agreement;
mod fields;
mod fit;
mod internal;
mod level_set;
mod mass;
mod places;
mod population;
mod samples;

use super::surface::boundary;
use super::{Quadrature, Restored, Tally, Weights};
use crate::interpolation::PartlyFilled;
use crate::kinematics::Kinematics;
use crate::material::RandomStrengths;
use crate::mesh::Mesh;
use crate::mesh::shape::MAX_NODES;
use crate::points::Points;
use crate::surface::{Geometry, MarkerFront};
use crate::tensor::{Symmetric, Tensor};
use fields::{
    ACCELERATION, BOUNDED, DENSITY, FIELDS, FLOW, Fields, Materials, Models, ORIGIN, PLASTIC, PRESSURE, VELOCITY,
    VOLUME, WATER,
};
pub use fit::{Around, Fit, Held, Rings};
use internal::Internal;
use level_set::Surface;
pub use places::Place;
use places::Places;
pub use population::{Count, Renewed};
use population::{Ground, Part, renew};
use rayon::prelude::*;
pub use samples::Samples;
use std::collections::BTreeSet;

/// Integration points whose state is resampled from the material points.
pub struct Resampled<K> {
    geometry: Geometry,
    around: Around,
    places: Places,
    materials: Materials<K>,
    /// Whether the boundary of the material is wanted.
    bounded: bool,
    /// The points that a cell of each region was seeded with; empty where their number stays.
    seeded: Vec<u32>,
}

/// An integration point with its state.
struct Sample {
    cell: u32,
    place: Place,
    region: u16,
    fields: Fields,
    elastic: Symmetric,
    stress: Symmetric,
    /// Over that of the parameters (-).
    strength: f64,
}

/// What became of a cell.
#[derive(Default)]
struct Sampled {
    samples: Vec<Sample>,
    /// Their internal variables, one after the other.
    internal: Vec<f64>,
    linear: u32,
    constant: u32,
    /// The cell, if it is outside the surface.
    outside: Option<u32>,
    /// Points that take the state of a material point, for no model answers to that which is fitted.
    taken: u32,
}

impl<K: Kinematics<2>> Resampled<K> {
    /// For grids that are restored to `mesh`, with the models of the points by number of the material.
    pub fn new(mesh: &Mesh<2>, models: Models, bounded: bool) -> Self {
        Self {
            geometry: Geometry::new::<K>(mesh),
            around: Around::of(mesh),
            places: Places::new(),
            materials: Materials::new(models),
            bounded,
            seeded: Vec::new(),
        }
    }

    /// Lets material points be split and merged, given how many a cell of each region was seeded with (0: none).
    #[must_use]
    pub fn renewing(self, seeded: Vec<u32>) -> Self {
        Self { seeded, ..self }
    }

    /// Lets the strength of materials vary at random, given the fields by number of the material.
    #[must_use]
    pub fn varying(self, strengths: RandomStrengths) -> Self {
        Self { materials: self.materials.varying(strengths), ..self }
    }

    /// The integration points of a cell with the nodal values of the level set.
    fn sample(
        &self,
        geometry: &Geometry,
        grid: &Restored<2>,
        (held, all_fields): (&Held, &[Fields]),
        cell: u32,
        values: &[f64],
    ) -> Sampled {
        let Restored { mesh, points, .. } = *grid;
        let is_full = values.iter().all(|&v| v >= 0.0);
        let mut rings = Rings::of(cell);
        let near = rings.nearest(&self.around, held);
        let regions: BTreeSet<u16> = near.iter().map(|&p| points.region[p as usize]).collect();
        let mut places = Vec::new();
        if is_full && regions.len() < 2 {
            self.places.full::<K>(mesh, cell as usize, &mut places);
        } else {
            let all = [1.0; MAX_NODES];
            let values = if is_full { &all[..values.len()] } else { values };
            self.places.cut::<K>(mesh, cell as usize, values, &mut places);
        }
        let mut sampled = Sampled::default();
        for &region in &regions {
            let own: Vec<Place> = if regions.len() == 1 {
                places.clone()
            } else {
                let of_region = |place: &Place| points.region[nearest(points, &near, &place.x)] == region;
                places.iter().copied().filter(of_region).collect()
            };
            let counts = |p: u32| points.region[p as usize] == region;
            let neighbours = (&self.around, held);
            let frame = &geometry.frame[cell as usize];
            let frame = (frame, mesh.cells.kind[cell as usize].order());
            let Some(fit) = Fit::new(points, neighbours, &mut rings, frame, &own, &counts).filter(|_| !own.is_empty())
            else {
                continue;
            };
            if fit.linear {
                sampled.linear += 1;
            } else {
                sampled.constant += 1;
            }
            let coefficients = fit.coefficients(all_fields);
            let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; FIELDS];
            for &p in &fit.points {
                for (range, value) in range.iter_mut().zip(&all_fields[p as usize]) {
                    *range = [range[0].min(*value), range[1].max(*value)];
                }
            }
            let model = fit.points.first().map_or(usize::from(region), |&p| points.model_of(p as usize));
            let internal = Internal::new(points, &fit, self.materials.internal_variables(model));
            for place in own {
                let begin = sampled.internal.len();
                internal.add_at(&place.x, &mut sampled.internal);
                let mut fields = fit.at(&coefficients, &place.x);
                for k in BOUNDED {
                    fields[k] = fields[k].clamp(range[k][0], range[k][1]);
                }
                let mut strength = self.materials.strength(model, &[fields[ORIGIN], fields[ORIGIN + 1]]);
                let state = self.materials.state(model, &fields, &sampled.internal[begin..], strength);
                let (elastic, stress) = state.unwrap_or_else(|| {
                    // What no model answers to is not the state of the soil there: the nearest point's is.
                    let p = nearest(points, &fit.points, &place.x);
                    fields = all_fields[p];
                    strength = points.strength_of(p);
                    sampled.internal[begin..].copy_from_slice(points.internal_of(p));
                    sampled.taken += 1;
                    (points.elastic[p], points.stress[p])
                });
                sampled.samples.push(Sample { cell, place, region, fields, elastic, stress, strength });
            }
        }
        sampled
    }

    /// The material points of a cell that the surface leaves out, as integration points.
    fn themselves(points: &Points<2>, parametric: &[[f64; 3]], held: &Held, fields: &[Fields], cell: u32) -> Sampled {
        let sample = |&p: &u32| {
            let p = p as usize;
            let place = Place { xi: parametric[p], x: points.position[p], weight: points.volume(p) };
            let (region, elastic, stress) = (points.region[p], points.elastic[p], points.stress[p]);
            Sample { cell, place, region, fields: fields[p], elastic, stress, strength: points.strength_of(p) }
        };
        let samples: Vec<Sample> = held.points(cell).iter().map(sample).collect();
        let internal = held.points(cell).iter().flat_map(|&p| points.internal_of(p as usize)).copied().collect();
        Sampled { outside: (!samples.is_empty()).then_some(cell), samples, internal, ..Sampled::default() }
    }

    fn weigh_on(&self, geometry: &Geometry, grid: &Restored<2>, front: &mut Option<MarkerFront>) -> Weights<2> {
        let Restored { mesh, points, active, .. } = *grid;
        let Surface { level_set, mut outside, lost: lost_front } = Surface::of::<K>(geometry, grid, front);
        let values = |c: usize| -> Vec<f64> { mesh.cells.nodes(c).iter().map(|&n| level_set[n as usize]).collect() };
        let mut inside: Vec<bool> =
            (0..mesh.cells.len()).map(|c| active[c] && values(c).iter().any(|&value| value > 0.0)).collect();
        if !points.velocity.is_empty() {
            agreement::settle::<K>(geometry, grid, &level_set, [&mut inside, &mut outside]);
        }
        // Points in other cells, such as a crumb that a structure carries along, resist nothing, and their state says nothing of the rest.
        let counts: Vec<bool> = (0..mesh.cells.len()).map(|c| outside[c] || inside[c]).collect();
        let held = Held::of(&counts, &points.cell);
        let fields = self.materials.all(points);
        let work = |c: usize| {
            if outside[c] {
                Self::themselves(points, grid.parametric, &held, &fields, c as u32)
            } else if counts[c] {
                self.sample(geometry, grid, (&held, &fields), c as u32, &values(c))
            } else {
                Sampled::default()
            }
        };
        let sampled: Vec<Sampled> = (0..mesh.cells.len()).into_par_iter().with_min_len(64).map(work).collect();
        let (mut samples, mut tally) = collect(points, &sampled);
        mass::conserve(mesh, points, &mut samples);
        let weight = samples.points.initial_volume.clone();

        let (mut partly_filled, mut ill_conditioned) = (Vec::new(), Vec::new());
        for c in (0..mesh.cells.len()).filter(|&c| active[c]) {
            let (inside, whole) = (sampled[c].samples.iter().map(|s| s.place.weight).sum::<f64>(), geometry.volume(c));
            let is_full = inside > 0.0 && !outside[c] && values(c).iter().all(|&v| v >= 0.0);
            if !is_full {
                partly_filled.push(PartlyFilled { cell: c as u32, emptiness: (1.0 - inside / whole).clamp(0.0, 1.0) });
            }
            if !is_full && inside > 0.0 {
                ill_conditioned.push(c as u32);
            }
        }
        partly_filled.retain(|partly_filled| partly_filled.emptiness > 0.0);
        let mut renewed = None;
        if !self.seeded.is_empty() && grid.displacement.is_some() {
            let parts = parts(geometry, &sampled);
            let (around, seeded) = (&self.around, &self.seeded[..]);
            let (level_set, outside) = (&level_set[..], &outside[..]);
            let ground = Ground { geometry, around, grid, level_set, outside, parts: &parts, seeded, held: &held };
            (renewed, tally.population) = renew(&ground, &self.materials);
        }
        let mut weights =
            Weights { weight, partly_filled, ill_conditioned, tally, lost_front, renewed, ..Weights::default() };
        if self.bounded {
            let cells = &samples.points.cell;
            let of_cell = |c: u32| cells.partition_point(|&d| d < c)..cells.partition_point(|&d| d <= c);
            weights.boundary = boundary(geometry, grid, &level_set, &samples.points, of_cell);
            weights.level_set = level_set;
        }
        weights.samples = Some(samples);
        weights
    }
}

impl<K: Kinematics<2>> Quadrature<2> for Resampled<K> {
    fn weigh(&self, grid: &Restored<2>, front: &mut Option<MarkerFront>) -> Weights<2> {
        let relaxed = grid.relaxed.then(|| Geometry::new::<K>(grid.mesh));
        self.weigh_on(relaxed.as_ref().unwrap_or(&self.geometry), grid, front)
    }
}

/// The one of some points that is nearest to a place; the first point where there are none.
fn nearest(points: &Points<2>, near: &[u32], x: &[f64; 2]) -> usize {
    let square = |p: u32| {
        let y = &points.position[p as usize];
        (x[0] - y[0]).powi(2) + (x[1] - y[1]).powi(2)
    };
    let best = near.iter().map(|&p| (square(p), p)).min_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or(0, |(_, p)| p as usize)
}

/// What each material fills of the cells.
fn parts(geometry: &Geometry, sampled: &[Sampled]) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    for cell in sampled.iter().filter(|cell| cell.outside.is_none()) {
        let first = parts.len();
        for sample in &cell.samples {
            let share = sample.place.weight / geometry.volume(sample.cell as usize);
            match parts[first..].last_mut().filter(|part| part.region == sample.region) {
                Some(part) => {
                    part.share += share;
                    part.places.push(sample.place);
                }
                None => {
                    let (cell, region) = (sample.cell, sample.region);
                    parts.push(Part { cell, region, share, full: false, places: vec![sample.place] });
                }
            }
        }
        if let [part] = &mut parts[first..] {
            part.full = part.share > 1.0 - 1e-9;
        }
    }
    parts
}

/// The integration points of all cells.
fn collect(points: &Points<2>, sampled: &[Sampled]) -> (Samples<2>, Tally) {
    let all = || sampled.iter().flat_map(|cell| &cell.samples);
    let column = |filled: bool, k: usize| if filled { all().map(|s| s.fields[k]).collect() } else { Vec::new() };
    let initial_volume: Vec<f64> = all().map(|s| s.place.weight * (-s.fields[VOLUME]).exp()).collect();
    let mut model = Vec::new();
    if !points.model.is_empty() {
        let regions = points.region.iter().max().map_or(0, |&r| usize::from(r) + 1);
        let mut of_region = vec![0; regions];
        points.region.iter().zip(&points.model).for_each(|(&r, &model)| of_region[usize::from(r)] = model);
        model = all().map(|s| of_region[usize::from(s.region)]).collect();
    }
    let samples = Points {
        position: all().map(|s| s.place.x).collect(),
        origin: all().map(|s| [s.fields[ORIGIN], s.fields[ORIGIN + 1]]).collect(),
        mass: all().zip(&initial_volume).map(|(s, volume)| s.fields[DENSITY] * volume).collect(),
        initial_volume,
        deformation: all().map(|s| Tensor::identity() * (s.fields[VOLUME] / 3.0).exp()).collect(),
        elastic: all().map(|s| s.elastic).collect(),
        stress: all().map(|s| s.stress).collect(),
        plastic_strain: column(true, PLASTIC),
        plastic_increment: column(!points.plastic_increment.is_empty(), FLOW),
        internal: sampled.iter().flat_map(|cell| &cell.internal).copied().collect(),
        pressure: column(!points.pressure.is_empty(), PRESSURE),
        pore_pressure: column(!points.pore_pressure.is_empty(), WATER),
        strength: if points.strength.is_empty() { Vec::new() } else { all().map(|s| s.strength).collect() },
        region: all().map(|s| s.region).collect(),
        model,
        cell: all().map(|s| s.cell).collect(),
        ..Points::default()
    };
    let count = |of: fn(&Sampled) -> u32| sampled.iter().map(of).sum();
    let tally = Tally {
        linear: count(|cell| cell.linear),
        constant: count(|cell| cell.constant),
        taken: count(|cell| cell.taken),
        point_volume: (0..points.len()).map(|p| points.volume(p)).sum(),
        volume: all().map(|s| s.place.weight).sum(),
        population: Count::default(),
    };
    let outside = sampled.iter().filter_map(|cell| cell.outside).collect();
    let motion = |s: &Sample| [VELOCITY, ACCELERATION].map(|k| [s.fields[k], s.fields[k + 1]]);
    let motion = if points.velocity.is_empty() { Vec::new() } else { all().map(motion).collect() };
    (Samples { points: samples, parametric: all().map(|s| s.place.xi).collect(), motion, outside }, tally)
}
