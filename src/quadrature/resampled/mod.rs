//! Resampled quadrature: the integrals of a step are sums over integration points of the cells, not over the material points.
//!
//! When the grid is restored, each cell gets integration points where it is full of material and where the surface cuts
//! it ([`places`]). They take their state from a linear function that is fitted to that of the material points around
//! ([`fit`]), and until the grid is restored again they are ordinary points of finite elements. The material points move
//! with the grid and answer for its deformation themselves; nothing is handed back to them. Material points
//! outside the surface, as drops that are thrown out, are integration points themselves, with their volume and state. So are those of a cell in which all
//! have come apart: there is no stress to sum up, and what moves is the mass of each, where it is. Fitted masses are those of the points in sum only, and
//! points that fly by themselves would be mapped with one mass and moved with another.
//!
//! What is fitted are the Kirchhoff stress of the model, `ln J`, the density, and what the model remembers, which stays within the
//! range of the points that it is fitted to. It is the stress and not the elastic strain, for it is the stress that is in balance: in
//! clay whose stiffness grows with pressure, a stress linear in depth has a strain that is not. What lies outside
//! the yield surface is brought back to it.

mod fit;
mod mass;
mod places;
mod population;

use super::surface::{boundary, follow, largest_offset, smoothed};
use super::{Quadrature, Restored, Tally, Weighing};
use crate::kinematics::Kinematics;
use crate::material::spatial::elastic_from_stress;
use crate::material::{Model, State, spectral};
use crate::mesh::shape::MAX_NODES;
use crate::mesh::{Bodies, Mesh};
use crate::points::Points;
use crate::stencil::SoftCell;
use crate::surface::{Contour, Distance, Front, Geometry, HIGHEST};
use crate::tensor::{IDENTITY, Symmetric, Tensor, mean};
use fit::{Around, Fit, Held, Rings};
use places::{Place, Places};
pub use population::{Count, Renewed};
use population::{Ground, Part, renew};
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::marker::PhantomData;
use std::sync::Arc;

/// What is fitted: stress xx, yy, zz, xy; ln J; density; plastic strain, what the model remembers, and what the last step added to the former; the
/// pressure of the field, the mean stress beside that of the model and the pore pressure; the place when seeded.
const FIELDS: usize = 14;
type Fields = [f64; FIELDS];
const STRESS: usize = 0;
const VOLUME: usize = 4;
const DENSITY: usize = 5;
const PLASTIC: usize = 6;
const MEMORY: usize = 7;
const FLOW: usize = 8;
const PRESSURE: usize = 9;
const BESIDE: usize = 10;
const WATER: usize = 11;
const ORIGIN: usize = 12;
/// Iterations, and the part (-) of the volume, to which the volume within the surface is that of the material points.
const OFFSETS: usize = 8;
/// The first offset tried, as a share of the range.
const FIRST_OFFSET: f64 = 1e-3;
const VOLUME_TOLERANCE: f64 = 1e-12;
/// Strain (-) up to which is rounding.
const STRAINED: f64 = 1e-9;

/// Those that stay within the range of the points.
const BOUNDED: std::ops::RangeInclusive<usize> = DENSITY..=FLOW;

/// The integration points of a grid.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Samples<const D: usize> {
    /// Ascending by cell. Their volume when seeded is that which they stand for over their `J`; they have no motion of their own.
    pub points: Points<D>,
    /// Parametric coordinates in their cells.
    pub parametric: Vec<[f64; 3]>,
    /// The cells outside the surface, ascending, whose integration points are the material points.
    pub outside: Vec<u32>,
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
    /// The points that a cell of each region was seeded with; empty where their number stays.
    seeded: Vec<u32>,
    kinematics: PhantomData<K>,
}

/// The surface of the material.
struct Surface {
    /// Its level set (m) at the nodes, positive inside.
    level_set: Vec<f64>,
    /// Cells with material points that are outside it.
    outside: Vec<bool>,
    /// Why the surface is followed no longer, where it just ceased to be.
    lost: Option<String>,
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
            models,
            bounded,
            seeded: Vec::new(),
            kinematics: PhantomData,
        }
    }

    /// Lets material points be split and merged, given how many a cell of each region was seeded with (0: none).
    #[must_use]
    pub fn renewing(self, seeded: Vec<u32>) -> Self {
        Self { seeded, ..self }
    }

    /// The surface of the material: one that is followed, else the smoothed contour of the points, or that contour.
    fn surface(&self, geometry: &Geometry, grid: &Restored<2>, front: &mut Option<Front>) -> Surface {
        let Restored { mesh, locator, points, parametric, taking_part, .. } = *grid;
        let lost = follow::<K>(geometry, grid, front).err().map(|lost| {
            *front = None;
            lost.to_string()
        });
        let to = |front: &Front, cells: &[u32]| {
            let mut distance = Distance::default();
            distance.update(mesh, geometry, locator, front, cells, taking_part);
            distance.level_set
        };
        // Points that neither the surface nor the contour that it smooths reaches are outside. Where structures touch the material,
        // such points are in these, by as much as contact lets them.
        let apart = apart(mesh.cells.len(), points);
        let outside = |level_set: &[f64], within: &[u32]| {
            let mut outside = vec![false; mesh.cells.len()];
            if !grid.outlines.is_empty() {
                return outside;
            }
            points.cell.iter().for_each(|&c| outside[c as usize] = true);
            let reached = |c: usize| mesh.cells.nodes(c).iter().any(|&n| level_set[n as usize] > 0.0);
            (0..outside.len())
                .filter(|&c| reached(c))
                .chain(within.iter().map(|&c| c as usize))
                .for_each(|c| outside[c] = false);
            outside.iter_mut().zip(&apart).for_each(|(outside, apart)| *outside |= apart);
            outside
        };
        let at = |front: &Front, level_set: Vec<f64>, within: &[u32]| {
            let outside = outside(&level_set, within);
            let most = largest_offset::<K>(front, geometry, grid);
            let level_set = self.keep_volume(geometry, grid, [-most, most], &outside, level_set);
            Surface { level_set, outside, lost: lost.clone() }
        };
        if let Some(front) = front {
            return at(front, to(front, &points.cell), &[]);
        }
        let mut contour = Contour::default();
        contour.update::<K>(mesh, geometry, points, parametric, taking_part);
        if let Some((front, cells)) = smoothed::<K>(geometry, grid, &contour.level_set) {
            return at(&front, to(&front, &cells), &cells);
        }
        // A contour encloses the volume of all points that it is made of: those outside are not among them.
        let (mut out, mut count) = (outside(&contour.level_set, &[]), points.len());
        loop {
            let numbers: Vec<usize> = (0..points.len()).filter(|&p| !out[points.cell[p] as usize]).collect();
            if numbers.len() == count {
                let limits = [contour.level - HIGHEST, contour.level];
                let level_set = self.keep_volume(geometry, grid, limits, &out, contour.level_set);
                return Surface { level_set, outside: out, lost };
            }
            count = numbers.len();
            let places: Vec<_> = numbers.iter().map(|&p| parametric[p]).collect();
            contour.update::<K>(mesh, geometry, &points.select(&numbers), &places, taking_part);
            let more = outside(&contour.level_set, &[]);
            out.iter_mut().zip(more).for_each(|(out, more)| *out |= more);
        }
    }

    /// Adds an offset within `limits` to the level set of each body such that the volume inside is that of its material points that are not
    /// outside: a front that only moves with the grid would sink or rise a little in every reset. Where structures touch the
    /// material, the surface is theirs and stays.
    fn keep_volume(
        &self,
        geometry: &Geometry,
        grid: &Restored<2>,
        [least, most]: [f64; 2],
        outside: &[bool],
        level_set: Vec<f64>,
    ) -> Vec<f64> {
        let Restored { mesh, points, taking_part, .. } = *grid;
        if !grid.outlines.is_empty() || most <= least {
            return level_set;
        }
        let counts = |c: u32| taking_part[c as usize] && !outside[c as usize];
        let near = |c: &u32| mesh.cells.nodes(*c as usize).iter().any(|&n| level_set[n as usize] > -most);
        let cells: Vec<u32> = (0..mesh.cells.len() as u32).filter(|c| counts(*c) && near(c)).collect();
        let inside = |c: &u32| mesh.cells.nodes(*c as usize).iter().any(|&n| level_set[n as usize] > 0.0);
        let held = cells.iter().filter(|c| inside(c)).chain(&points.cell).copied().filter(|&c| counts(c));
        let bodies = Bodies::of(mesh, held, &[]);
        let body_of = |c: u32| mesh.cells.nodes(c as usize).iter().find_map(|&n| bodies.of_node(n as usize));
        let by_body = |volumes: &mut dyn Iterator<Item = (u32, f64)>| {
            let mut sums = vec![0.0; bodies.count()];
            volumes.filter(|(c, _)| counts(*c)).for_each(|(c, volume)| {
                body_of(c).into_iter().for_each(|body| sums[body] += volume);
            });
            sums
        };
        let wanted = by_body(&mut points.cell.iter().enumerate().map(|(p, &c)| (c, points.volume(p))));
        let shifted = |offsets: &[f64], n: usize| level_set[n] + bodies.of_node(n).map_or(0.0, |body| offsets[body]);
        let lacking = |offsets: &[f64]| -> Vec<f64> {
            let of_cell = |&c: &u32| {
                let mut values = [0.0; MAX_NODES];
                let nodes = mesh.cells.nodes(c as usize);
                values.iter_mut().zip(nodes).for_each(|(value, &n)| *value = shifted(offsets, n as usize));
                (c, geometry.filled::<K>(mesh, c as usize, &values[..nodes.len()]))
            };
            let volumes: Vec<(u32, f64)> = cells.par_iter().with_min_len(64).map(of_cell).collect();
            by_body(&mut volumes.into_iter()).iter().zip(&wanted).map(|(has, wanted)| wanted - has).collect()
        };
        // The secant method, body by body; a slope that is far from the first one is one of rounding.
        let first = FIRST_OFFSET * (most - least);
        let mut lacks = lacking(&vec![0.0; bodies.count()]);
        let shifted_first = lacking(&vec![first; bodies.count()]);
        let slopes: Vec<f64> = shifted_first.iter().zip(&lacks).map(|(then, now)| (now - then) / first).collect();
        let (mut offsets, mut now) = (vec![0.0; bodies.count()], slopes.clone());
        for _ in 0..OFFSETS {
            let next = |b: usize| {
                let has_surface = slopes[b] > 0.0 && lacks[b].abs() > VOLUME_TOLERANCE * wanted[b];
                if has_surface { (offsets[b] + lacks[b] / now[b]).clamp(least, most) } else { offsets[b] }
            };
            let tried: Vec<f64> = (0..bodies.count()).map(next).collect();
            if tried == offsets {
                break;
            }
            for (b, then) in lacking(&tried).into_iter().enumerate() {
                let slope = (lacks[b] - then) / (tried[b] - offsets[b]);
                if (0.1..10.0).contains(&(slope / slopes[b])) {
                    now[b] = slope;
                }
                if then.abs() < lacks[b].abs() {
                    (offsets[b], lacks[b]) = (tried[b], then);
                }
            }
        }
        (0..level_set.len()).map(|n| shifted(&offsets, n)).collect()
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
            for place in own {
                let mut fields = fit.at(&coefficients, &place.x);
                for k in BOUNDED {
                    fields[k] = fields[k].clamp(range[k][0], range[k][1]);
                }
                let (elastic, stress) = self.state(model, &fields).unwrap_or_else(|| {
                    // What no model answers to is not the state of the soil there: the nearest point's is.
                    let p = nearest(points, &fit.points, &place.x);
                    fields = all_fields[p];
                    sampled.taken += 1;
                    (points.elastic[p], points.stress[p])
                });
                sampled.samples.push(Sample { cell, place, region, fields, elastic, stress });
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
            Sample { cell, place, region, fields: fields[p], elastic, stress }
        };
        let samples: Vec<Sample> = held.points(cell).iter().map(sample).collect();
        Sampled { outside: (!samples.is_empty()).then_some(cell), samples, ..Sampled::default() }
    }

    /// The elastic left Cauchy–Green tensor and the stress (kPa) that a model can have near the given fields.
    fn state(&self, model: usize, fields: &Fields) -> Option<(Symmetric, Symmetric)> {
        let kirchhoff = [fields[0], fields[1], fields[2], fields[3], 0.0, 0.0];
        let state = State { plastic_strain: fields[PLASTIC], memory: fields[MEMORY], per_second: 0.0 };
        let y = fields[ORIGIN + 1];
        let model = self.models.get(model)?.as_ref()?;
        let elastic = elastic_from_stress(model.as_ref(), y, &kirchhoff);
        let answer = K::respond(model.as_ref(), y, &elastic, &state)?;
        let volume_ratio = fields[VOLUME].exp();
        let mut stress = answer.kirchhoff.map(|t| t / volume_ratio);
        stress[..3].iter_mut().for_each(|s| *s += fields[BESIDE] / volume_ratio);
        Some((answer.elastic, stress))
    }

    /// What is fitted of each point.
    fn fields(&self, points: &Points<2>) -> Vec<Fields> {
        (0..points.len()).into_par_iter().with_min_len(256).map(|p| self.fields_of(points, p)).collect()
    }

    fn fields_of(&self, points: &Points<2>, p: usize) -> Fields {
        let at = |column: &[f64], p: usize| column.get(p).copied().unwrap_or(0.0);
        let volume_ratio = points.deformation[p].determinant();
        let mut fields = [0.0; FIELDS];
        fields[VOLUME] = volume_ratio.ln();
        fields[DENSITY] = points.mass[p] / points.initial_volume[p];
        fields[PLASTIC] = points.plastic_strain[p];
        fields[MEMORY] = at(&points.memory, p);
        fields[FLOW] = at(&points.plastic_increment, p);
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
    }

    fn weigh_on(&self, geometry: &Geometry, grid: &Restored<2>, front: &mut Option<Front>) -> Weighing<2> {
        let Restored { mesh, points, taking_part, .. } = *grid;
        let Surface { level_set, outside, lost: lost_front } = self.surface(geometry, grid, front);
        let values = |c: usize| -> Vec<f64> { mesh.cells.nodes(c).iter().map(|&n| level_set[n as usize]).collect() };
        let held = Held::new(mesh.cells.len(), &points.cell);
        let fields = self.fields(points);
        let work = |c: usize| {
            let values = values(c);
            let inside = taking_part[c] && values.iter().any(|&v| v > 0.0);
            if outside[c] {
                Self::themselves(points, grid.parametric, &held, &fields, c as u32)
            } else if inside {
                self.sample(geometry, grid, (&held, &fields), c as u32, &values)
            } else {
                Sampled::default()
            }
        };
        let sampled: Vec<Sampled> = (0..mesh.cells.len()).into_par_iter().with_min_len(64).map(work).collect();
        let (mut samples, mut tally) = collect(points, &sampled);
        mass::conserve(mesh, points, &mut samples);
        let weight = samples.points.initial_volume.clone();

        let (mut soft, mut poor) = (Vec::new(), Vec::new());
        for c in (0..mesh.cells.len()).filter(|&c| taking_part[c]) {
            let (inside, whole) = (sampled[c].samples.iter().map(|s| s.place.weight).sum::<f64>(), geometry.volume(c));
            let is_full = inside > 0.0 && !outside[c] && values(c).iter().all(|&v| v >= 0.0);
            if !is_full {
                soft.push(SoftCell { cell: c as u32, emptiness: (1.0 - inside / whole).clamp(0.0, 1.0) });
            }
            if !is_full && inside > 0.0 {
                poor.push(c as u32);
            }
        }
        soft.retain(|soft| soft.emptiness > 0.0);
        let mut renewed = None;
        if !self.seeded.is_empty() && grid.displacement.is_some() {
            let parts = parts(geometry, &sampled);
            let (around, seeded) = (&self.around, &self.seeded[..]);
            let (level_set, outside) = (&level_set[..], &outside[..]);
            let ground = Ground { geometry, around, grid, level_set, outside, parts: &parts, seeded, held: &held };
            (renewed, tally.population) = renew(&ground, self);
        }
        let mut weighing = Weighing { weight, soft, poor, tally, lost_front, renewed, ..Weighing::default() };
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

/// The one of some points that is nearest to a place; the first point where there are none.
fn nearest(points: &Points<2>, near: &[u32], x: &[f64; 2]) -> usize {
    let square = |p: u32| {
        let y = &points.position[p as usize];
        (x[0] - y[0]).powi(2) + (x[1] - y[1]).powi(2)
    };
    let best = near.iter().map(|&p| (square(p), p)).min_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or(0, |(_, p)| p as usize)
}

/// The cells whose material points have all come apart: without elastic strain, in more room than they were seeded in.
fn apart(cells: usize, points: &Points<2>) -> Vec<bool> {
    let (mut holds, mut bears) = (vec![false; cells], vec![false; cells]);
    for (p, &c) in points.cell.iter().enumerate() {
        let strained = points.elastic[p].iter().zip(&IDENTITY).any(|(b, one)| (b - one).abs() > STRAINED);
        holds[c as usize] = true;
        bears[c as usize] |= strained || points.deformation[p].determinant() <= 1.0 + STRAINED;
    }
    holds.iter().zip(bears).map(|(holds, bears)| *holds && !bears).collect()
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
        reference: Vec::new(),
        velocity: Vec::new(),
        acceleration: Vec::new(),
        mass: all().zip(&initial_volume).map(|(s, volume)| s.fields[DENSITY] * volume).collect(),
        initial_volume,
        deformation: all().map(|s| Tensor::identity() * (s.fields[VOLUME] / 3.0).exp()).collect(),
        elastic: all().map(|s| s.elastic).collect(),
        stress: all().map(|s| s.stress).collect(),
        plastic_strain: column(true, PLASTIC),
        plastic_increment: column(!points.plastic_increment.is_empty(), FLOW),
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
        taken: count(|cell| cell.taken),
        point_volume: (0..points.len()).map(|p| points.volume(p)).sum(),
        volume: all().map(|s| s.place.weight).sum(),
        population: Count::default(),
    };
    let outside = sampled.iter().filter_map(|cell| cell.outside).collect();
    (Samples { points: samples, parametric: all().map(|s| s.place.xi).collect(), outside }, tally)
}
