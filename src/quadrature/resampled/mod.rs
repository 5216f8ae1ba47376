//! Resampled quadrature: the integrals of a step are sums over integration points of the cells, not over the material points.
//!
//! When the grid is restored, each cell gets integration points where it is full of material and where the surface cuts
//! it ([`places`]). They take their state from a linear function that is fitted to that of the material points around
//! ([`fit`]), and until the grid is restored again they are ordinary points of finite elements. The material points move
//! with the grid and answer for its deformation themselves; nothing is handed back to them.
//!
//! What is fitted are the Kirchhoff stress of the model, `ln J`, the density, and what the model remembers, which stays within the
//! range of the points that it is fitted to. It is the stress and not the elastic strain, for it is the stress that is in balance: in
//! clay whose stiffness grows with pressure, a stress linear in depth has a strain that is not. What lies outside
//! the yield surface is brought back to it.

mod fit;
mod places;

use super::surface::{boundary, follow, smoothed};
use super::{Quadrature, Restored, Tally, Weighing};
use crate::kinematics::Kinematics;
use crate::material::spatial::elastic_from_stress;
use crate::material::{Model, State, spectral};
use crate::mesh::Mesh;
use crate::mesh::shape::MAX_NODES;
use crate::points::Points;
use crate::stencil::SoftCell;
use crate::surface::{Contour, Distance, Front, Geometry};
use crate::tensor::{IDENTITY, Symmetric, Tensor, mean};
use fit::{Around, Fit, Held, Rings};
use places::{Place, Places};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::marker::PhantomData;
use std::sync::Arc;

/// What is fitted: stress xx, yy, zz, xy; ln J; density; plastic strain and what the model remembers; the
/// pressure of the field, the mean stress beside that of the model and the pore pressure; the place when seeded.
const FIELDS: usize = 13;
type Fields = [f64; FIELDS];
const STRESS: usize = 0;
const VOLUME: usize = 4;
const DENSITY: usize = 5;
const PLASTIC: usize = 6;
const MEMORY: usize = 7;
const PRESSURE: usize = 8;
const BESIDE: usize = 9;
const WATER: usize = 10;
const ORIGIN: usize = 11;
/// Those that stay within the range of the points.
const BOUNDED: std::ops::RangeInclusive<usize> = DENSITY..=MEMORY;

/// The integration points of a grid.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Samples<const D: usize> {
    /// Ascending by cell. Their volume when seeded is that which they stand for over their `J`; they have no motion of their own.
    pub points: Points<D>,
    /// Parametric coordinates in their cells.
    pub parametric: Vec<[f64; 3]>,
}

/// The model of each material by number.
type Models = Vec<Option<Arc<dyn Model>>>;

/// Integration points whose state is resampled from the material points.
pub struct Resampled<K> {
    geometry: Geometry,
    around: Around,
    places: Places,
    models: Models,
    /// Whether the boundary of the material is wanted.
    bounded: bool,
    kinematics: PhantomData<K>,
}

/// An integration point with its state.
struct Sample {
    cell: u32,
    place: Place,
    region: u16,
    fields: Fields,
    elastic: Symmetric,
    stress: Symmetric,
}

/// What became of a cell.
#[derive(Default)]
struct Sampled {
    samples: Vec<Sample>,
    linear: u32,
    constant: u32,
}

impl<K: Kinematics<2>> Resampled<K> {
    /// For grids that are restored to `mesh`, with the models of the points by number of the material.
    pub fn new(mesh: &Mesh<2>, models: Models, bounded: bool) -> Self {
        Self {
            geometry: Geometry::new::<K>(mesh),
            around: Around::of(mesh),
            places: Places::new(),
            models,
            bounded,
            kinematics: PhantomData,
        }
    }

    /// The level set (m) of the material at the nodes: the distance to the surface that is followed, else to the smoothed
    /// contour of the points, or that contour. Also why the surface is followed no longer, where it just ceased to be.
    fn level_set(
        &self,
        geometry: &Geometry,
        grid: &Restored<2>,
        front: &mut Option<Front>,
    ) -> (Vec<f64>, Option<String>) {
        let Restored { mesh, locator, points, parametric, taking_part, .. } = *grid;
        let lost = follow::<K>(geometry, grid, front).err().map(|fault| {
            *front = None;
            fault.to_string()
        });
        let to = |front: &Front, cells: &[u32]| {
            let mut distance = Distance::default();
            distance.update(mesh, geometry, locator, front, cells, taking_part);
            distance.level_set
        };
        if let Some(front) = front {
            return (to(front, &points.cell), lost);
        }
        let mut contour = Contour::default();
        contour.update::<K>(mesh, geometry, points, parametric, taking_part);
        let smoothed = smoothed::<K>(geometry, grid, &contour.level_set);
        (smoothed.map_or(contour.level_set, |(front, cells)| to(&front, &cells)), lost)
    }

    /// The integration points of a cell with the nodal values of the level set.
    fn sample(
        &self,
        geometry: &Geometry,
        grid: &Restored<2>,
        (held, fields): (&Held, &[Fields]),
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
                places.iter().copied().filter(|place| nearest(points, &near, &place.x) == Some(region)).collect()
            };
            let counts = |p: u32| points.region[p as usize] == region;
            let neighbours = (&self.around, held);
            let frame = &geometry.frame[cell as usize];
            let Some(fit) = Fit::new(points, neighbours, &mut rings, frame, &own, &counts).filter(|_| !own.is_empty())
            else {
                continue;
            };
            if fit.linear {
                sampled.linear += 1;
            } else {
                sampled.constant += 1;
            }
            let coefficients = fit.coefficients(fields);
            let mut range = [[f64::INFINITY, f64::NEG_INFINITY]; FIELDS];
            for &p in &fit.points {
                for (range, value) in range.iter_mut().zip(&fields[p as usize]) {
                    *range = [range[0].min(*value), range[1].max(*value)];
                }
            }
            let model = fit.points.first().map_or(usize::from(region), |&p| points.model_of(p as usize));
            for place in own {
                let mut fields = fit.at(&coefficients, &place.x);
                for k in BOUNDED {
                    fields[k] = fields[k].clamp(range[k][0], range[k][1]);
                }
                let (elastic, stress) = self.state(model, &fields);
                sampled.samples.push(Sample { cell, place, region, fields, elastic, stress });
            }
        }
        sampled
    }

    /// The elastic left Cauchy–Green tensor and the stress (kPa) that a model can have near the given fields.
    fn state(&self, model: usize, fields: &Fields) -> (Symmetric, Symmetric) {
        let kirchhoff = [fields[0], fields[1], fields[2], fields[3], 0.0, 0.0];
        let state = State { plastic_strain: fields[PLASTIC], memory: fields[MEMORY], per_second: 0.0 };
        let y = fields[ORIGIN + 1];
        let answer = self.models.get(model).and_then(Option::as_ref).and_then(|model| {
            let elastic = elastic_from_stress(model.as_ref(), y, &kirchhoff);
            K::respond(model.as_ref(), y, &elastic, &state)
        });
        let Some(answer) = answer else { return (IDENTITY, [0.0; 6]) };
        let volume_ratio = fields[VOLUME].exp();
        let mut stress = answer.kirchhoff.map(|t| t / volume_ratio);
        stress[..3].iter_mut().for_each(|s| *s += fields[BESIDE] / volume_ratio);
        (answer.elastic, stress)
    }

    /// What is fitted of each point.
    fn fields(&self, points: &Points<2>) -> Vec<Fields> {
        let at = |column: &[f64], p: usize| column.get(p).copied().unwrap_or(0.0);
        let one = |p: usize| {
            let volume_ratio = points.deformation[p].determinant();
            let mut fields = [0.0; FIELDS];
            fields[VOLUME] = volume_ratio.ln();
            fields[DENSITY] = points.mass[p] / points.initial_volume[p];
            fields[PLASTIC] = points.plastic_strain[p];
            fields[MEMORY] = at(&points.memory, p);
            fields[PRESSURE] = at(&points.pressure, p);
            fields[WATER] = at(&points.pore_pressure, p);
            fields[ORIGIN..].copy_from_slice(&points.origin[p]);
            if let Some(model) = self.models.get(points.model_of(p)).and_then(Option::as_ref) {
                let y = points.origin[p][1];
                let stress = |b: &[f64; 3]| model.elastic_stress(y, &b.map(|b| 0.5 * b.ln()));
                let stress = spectral::map_roots(&points.elastic[p], stress);
                fields[STRESS..STRESS + 4].copy_from_slice(&stress[..4]);
                if !points.pressure.is_empty() {
                    fields[BESIDE] = volume_ratio * mean(&points.stress[p]) - mean(&stress);
                }
            }
            fields
        };
        (0..points.len()).into_par_iter().with_min_len(256).map(one).collect()
    }

    fn weigh_on(&self, geometry: &Geometry, grid: &Restored<2>, front: &mut Option<Front>) -> Weighing<2> {
        let Restored { mesh, points, taking_part, .. } = *grid;
        let (level_set, lost_front) = self.level_set(geometry, grid, front);
        let values = |c: usize| -> Vec<f64> { mesh.cells.nodes(c).iter().map(|&n| level_set[n as usize]).collect() };
        let held = Held::new(mesh.cells.len(), &points.cell);
        let fields = self.fields(points);
        let work = |c: usize| {
            let values = values(c);
            let inside = taking_part[c] && values.iter().any(|&v| v > 0.0);
            if inside { self.sample(geometry, grid, (&held, &fields), c as u32, &values) } else { Sampled::default() }
        };
        let sampled: Vec<Sampled> = (0..mesh.cells.len()).into_par_iter().with_min_len(64).map(work).collect();
        let (samples, tally) = collect(points, &sampled);
        let weight = samples.points.initial_volume.clone();

        let (mut soft, mut poor) = (Vec::new(), Vec::new());
        for c in (0..mesh.cells.len()).filter(|&c| taking_part[c]) {
            let (inside, whole) = (sampled[c].samples.iter().map(|s| s.place.weight).sum::<f64>(), geometry.volume(c));
            let is_full = inside > 0.0 && values(c).iter().all(|&v| v >= 0.0);
            if !is_full {
                soft.push(SoftCell { cell: c as u32, emptiness: (1.0 - inside / whole).clamp(0.0, 1.0) });
            }
            if !is_full && inside > 0.0 {
                poor.push(c as u32);
            }
        }
        soft.retain(|soft| soft.emptiness > 0.0);
        let mut weighing = Weighing { weight, soft, poor, tally, lost_front, ..Weighing::default() };
        if self.bounded {
            let cells = &samples.points.cell;
            let of_cell = |c: u32| cells.partition_point(|&d| d < c)..cells.partition_point(|&d| d <= c);
            weighing.boundary = boundary(geometry, grid, &level_set, &samples.points, of_cell);
            weighing.level_set = level_set;
        }
        weighing.samples = Some(samples);
        weighing
    }
}

impl<K: Kinematics<2>> Quadrature<2> for Resampled<K> {
    fn weigh(&self, grid: &Restored<2>, front: &mut Option<Front>) -> Weighing<2> {
        let relaxed = grid.relaxed.then(|| Geometry::new::<K>(grid.mesh));
        self.weigh_on(relaxed.as_ref().unwrap_or(&self.geometry), grid, front)
    }
}

/// The region of the one of some points that is nearest to a place.
fn nearest(points: &Points<2>, near: &[u32], x: &[f64; 2]) -> Option<u16> {
    let square = |p: u32| {
        let y = &points.position[p as usize];
        (x[0] - y[0]).powi(2) + (x[1] - y[1]).powi(2)
    };
    let best = near.iter().map(|&p| (square(p), p)).min_by(|a, b| a.0.total_cmp(&b.0));
    best.map(|(_, p)| points.region[p as usize])
}

/// The integration points of all cells, with the mass of the material points of each region.
fn collect(points: &Points<2>, sampled: &[Sampled]) -> (Samples<2>, Tally) {
    let all = || sampled.iter().flat_map(|cell| &cell.samples);
    let column = |filled: bool, k: usize| if filled { all().map(|s| s.fields[k]).collect() } else { Vec::new() };
    let initial_volume: Vec<f64> = all().map(|s| s.place.weight * (-s.fields[VOLUME]).exp()).collect();
    let mut mass: Vec<f64> = all().zip(&initial_volume).map(|(s, volume)| s.fields[DENSITY] * volume).collect();
    let regions = points.region.iter().max().map_or(0, |&r| usize::from(r) + 1);
    let (mut wanted, mut got) = (vec![0.0; regions], vec![0.0; regions]);
    points.region.iter().zip(&points.mass).for_each(|(&r, m)| wanted[usize::from(r)] += m);
    all().zip(&mass).for_each(|(s, m)| got[usize::from(s.region)] += m);
    for (sample, mass) in all().zip(&mut mass) {
        let r = usize::from(sample.region);
        if got[r] > 0.0 {
            *mass *= wanted[r] / got[r];
        }
    }
    let mut model = Vec::new();
    if !points.model.is_empty() {
        let mut of_region = vec![0; regions];
        points.region.iter().zip(&points.model).for_each(|(&r, &model)| of_region[usize::from(r)] = model);
        model = all().map(|s| of_region[usize::from(s.region)]).collect();
    }
    let samples = Points {
        position: all().map(|s| s.place.x).collect(),
        origin: all().map(|s| [s.fields[ORIGIN], s.fields[ORIGIN + 1]]).collect(),
        reference: Vec::new(),
        velocity: Vec::new(),
        acceleration: Vec::new(),
        mass,
        initial_volume,
        deformation: all().map(|s| Tensor::identity() * (s.fields[VOLUME] / 3.0).exp()).collect(),
        elastic: all().map(|s| s.elastic).collect(),
        stress: all().map(|s| s.stress).collect(),
        plastic_strain: column(true, PLASTIC),
        plastic_increment: Vec::new(),
        memory: column(!points.memory.is_empty(), MEMORY),
        pressure: column(!points.pressure.is_empty(), PRESSURE),
        pore_pressure: column(!points.pore_pressure.is_empty(), WATER),
        region: all().map(|s| s.region).collect(),
        model,
        cell: all().map(|s| s.cell).collect(),
    };
    let count = |of: fn(&Sampled) -> u32| sampled.iter().map(of).sum();
    let tally = Tally {
        linear: count(|cell| cell.linear),
        constant: count(|cell| cell.constant),
        point_volume: (0..points.len()).map(|p| points.volume(p)).sum(),
        fitted_volume: all().map(|s| s.place.weight).sum(),
        ..Tally::default()
    };
    (Samples { points: samples, parametric: all().map(|s| s.place.xi).collect() }, tally)
}
