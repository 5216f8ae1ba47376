//! A field of unknowns that carries most of the mean stress, so that cells with many points do not lock.
//!
//! The points keep the shear modulus and a small bulk modulus `K_m`; the field `π` (tension positive) carries the rest:
//! `K_f = K − K_m` in total stress, and with it the `K_w/n` of the pore water in effective stress. Both are stationary points of
//! `Σ w₀ [W_m + π g(j) − U*(π)]` (theory, eq. 24), `j` the volume over that when the grid was restored, `U*` the complementary energy
//! of Hencky's law:
//!
//! ```text
//! R_u += Σ w₀ τ_f 1 : ∇_x N        R_π = Σ w₀ L [Δg(j) − Δg(j(π))]        τ_f = π dg/d ln j,   Δτ_f = K_f Δ ln j(π)
//! ```
//!
//! Where the field is in tension as the step begins, `g = ½ j²`, and `g = j` where its tension has a limit; elsewhere `g = ln j`, and with it `τ_f = π`.
//! Beyond a limit the law is that of cavitation ([`crate::material::cavitation`]) in place of Hencky's. The second equation is in
//! increments: the points carry `τ_f`. The volume strain of single points is only loosely bound to
//! the field; were it summed up, a restored grid would have to undo what other cells make of it, in every step.
//!
//! Where yield knows the mean stress, the field is the mean stress of soil and water together, and the model sees in place of the volume strain of the
//! point that at which both bear it (theory, eq. 25a): a scalar equation a point. The points carry the elastic tensor that their model has seen.
//!
//! Why two measures: with a uniform `π` the sum of `π j` is `π` times the volume of the body, whatever single points do inside. To that `π ln j`
//! adds a bulk modulus of `−π` for the volume strain of single points, and `½ π j²` one of `π`: each is a stiffness on its side of zero.
//!
//! `L` are the linear shape functions of the corners, continuous from cell to cell, and in cells of second order a constant a cell (Taylor–Hood
//! with cell-wise volume balance; Boffi et al. 2012). Cells of first order have no room for the constant; there the
//! projection `Σ w₀ (L − L̄)(π − π_n)/2G` of Bochev, Dohrmann & Gunzburger (2006) makes the linear pressure stable.

use super::mixed::{Answer, Coupling, FieldVolumeStrain, ModelInput, Point};
use super::mixed_pressure::{MixedPressure, volume_strain};
use super::volume_measure::Measure;
use super::{Frame, History, Mixed, Ratios, Trial};
use crate::geometry::dot;
use crate::interpolation::{CellPoints, Entries, reach_beyond_cells};
use crate::kinematics::Kinematics;
use crate::material::spatial::Spatial;
use crate::mesh::shape::CellKind;
use crate::points::Points;
use crate::system::Local;
use crate::tensor::{IDENTITY, Symmetric, Tensor, full, mean};
use std::marker::PhantomData;

/// Most unknowns of a cell.
pub const MOST: usize = 5;

/// Largest error (-) of the volume strain that a model sees.
const SMALLEST: f64 = 1e-12;
/// Most iterations for it: two or three where the model is smooth, and where it is not as many as bisections from a strain of one need.
const LOCAL_ITERATIONS: usize = 60;

/// Values of the functions of the field at a point: corners, then the constant.
pub type Coefficients = [f64; MOST];

/// How many unknowns the field has in a cell: one a corner, and the constant in cells of second order.
pub fn unknowns(kind: CellKind) -> usize {
    kind.corner_count() + usize::from(kind.order() > 1)
}

/// The functions of the field where the shape functions of the cell are `n`: the linear ones of the corners lie in their span.
pub fn shapes(kind: CellKind, n: &[f64]) -> Coefficients {
    let corners = kind.corner_count();
    let mut shapes = [0.0; MOST];
    shapes[..corners].copy_from_slice(&n[..corners]);
    if kind.order() > 1 {
        for v in 0..corners {
            shapes[v] += 0.5 * (n[corners + v] + n[corners + (v + corners - 1) % corners]);
            shapes[v] += n.get(2 * corners).map_or(0.0, |centre| 0.25 * centre);
        }
        shapes[corners] = 1.0;
    }
    shapes
}

/// The unknowns of a cell in the field `pressure` as the state has it: by node, then by cell.
/// `constant` is where that of the cell stands.
pub fn gather(kind: CellKind, nodes: &[u32], constant: usize, pressure: &[f64]) -> Coefficients {
    let corners = kind.corner_count();
    let mut own = [0.0; MOST];
    for (own, &n) in own.iter_mut().zip(&nodes[..corners]) {
        *own = pressure[n as usize];
    }
    if kind.order() > 1 {
        own[corners] = pressure[constant];
    }
    own
}

/// The pressure field of a scene.
pub struct PressureField<K> {
    /// What it carries of each material by number; `None` where nothing.
    carried: Vec<Option<MixedPressure>>,
    /// What a unit of its unknowns stands for (kPa/m).
    unit: f64,
    kinematics: PhantomData<K>,
}

impl<K> PressureField<K> {
    /// `carried[m]` is what the field carries of material `m` ([`Points::model_of`]), `unit` that of [`crate::step::Scene`].
    pub fn new(carried: Vec<Option<MixedPressure>>, unit: f64) -> Self {
        Self { carried, unit, kinematics: PhantomData }
    }
}

/// The field over a cell.
pub struct Cell {
    kind: CellKind,
    /// Its unknowns (kPa), and those of the last converged step.
    pressure: Coefficients,
    converged: Coefficients,
    /// Means of the functions over the points, weighted by `1/2G`, for cells of first order.
    mean: Option<Coefficients>,
    /// Whether the step has inertia.
    inertia: bool,
}

/// The field (kPa, for each unit of the measure) within the step where its functions are `shapes`: between the unknowns of both ends, so that
/// the equations of the field say what work it does.
fn within(cell: &Cell, shapes: &Coefficients, end_weight: f64) -> f64 {
    end_weight * dot(shapes, &cell.pressure) + (1.0 - end_weight) * dot(shapes, &cell.converged)
}

impl<const D: usize, K: Kinematics<D>> Mixed<D, K> for PressureField<K> {
    type Cell = Cell;

    fn over(&self, frame: &Frame<D>, trial: &Trial<D>, cell_points: &CellPoints) -> Cell {
        let cell = cell_points.cell as usize;
        let kind = frame.mesh.cells.kind[cell];
        let nodes = frame.mesh.cells.nodes(cell);
        let [pressure, converged] = [trial.pressure, trial.converged_pressure]
            .map(|pressure| gather(kind, nodes, frame.places.constant(cell), pressure));
        let mean = (kind.order() == 1).then(|| {
            let (mut sum, mut weight) = ([0.0; MOST], 0.0);
            for entries in frame.interpolation.entries::<K>(cell_points) {
                if let Some(carried) = frame.points.by_material(entries.point, &self.carried) {
                    // As the differences from them are weighted: the projection is symmetric.
                    let own = entries.weight * carried.softness(frame.points.seeded_height(entries.point));
                    weight += own;
                    for (sum, shape) in sum.iter_mut().zip(shapes(kind, entries.shape)) {
                        *sum += own * shape;
                    }
                }
            }
            if weight > 0.0 { sum.map(|s| s / weight) } else { sum }
        });
        Cell { kind, pressure, converged, mean, inertia: trial.alpha_f > 0.0 }
    }

    fn has_step_volume(&self, points: &Points<D>, p: usize) -> bool {
        points.by_material(p, &self.carried).is_none()
    }

    fn respond(
        &self,
        cell: &Cell,
        &Point { points, entries, ratios }: &Point<D>,
        at: &ModelInput,
        internal: &mut [f64],
    ) -> Option<Answer<K, D>> {
        let (p, y) = (entries.point, points.seeded_height(entries.point));
        let bound = points.by_material(p, &self.carried).and_then(|carried| Some((carried, carried.bound?)));
        let Some((carried, bound)) = bound else {
            return Some((K::respond(at.model, y, &at.trial, &at.state, internal)?, None));
        };
        let (measure, bound) =
            (Measure::of(carried, points, p, cell.inertia), bound * at.model.elasticity().at(y).shear);
        let (water, grid) = (carried.law(y).bulk, ratios.grid / ratios.step);
        let (strain, slope) = (volume_strain(&points.elastic[p]), measure.slope(grid));
        let (local, mean_before) = (volume_strain(&at.trial) - strain, at.model.mean_stress(y, strain));
        let before = if carried.is_whole() { mean_before } else { points.pressure[p] };
        let pressure = at.end_weight * dot(&shapes(cell.kind, entries.shape), &cell.pressure)
            + (1.0 - at.end_weight) * before / slope;
        // `gained` is the volume strain of the field in the step; at first as if nothing yields.
        let mut gained = (pressure * slope - before) / (water + at.model.bulk_modulus(y, mean_before));
        // The stress that is missing falls with it, in soil that yields with slopes that differ by orders of magnitude.
        let mut bracket = [f64::NEG_INFINITY, f64::INFINITY];
        for _ in 0..LOCAL_ITERATIONS {
            let stretch = f64::exp(2.0 / 3.0 * (gained - local));
            let mut answer = K::respond(at.model, y, &at.trial.map(|b| stretch * b), &at.state, internal)?;
            let [stress, strain] = K::volumetric(&answer);
            let (of_model, binding, ratio) = (mean(&answer.kirchhoff), bound * (local - gained), gained.exp());
            let (bulk, slope) = (bound + mean(&stress), measure.slope(grid * ratio));
            let missing = pressure * slope + binding - before - water * gained - (of_model - mean_before);
            let stiffness = water + bulk - f64::from(measure.power()) * pressure * slope;
            let change = missing / stiffness;
            if stiffness <= 0.0 || !change.is_finite() {
                return None;
            }
            if change.abs() > SMALLEST {
                bracket[usize::from(missing < 0.0)] = gained;
                let [low, high] = bracket;
                gained += change;
                if gained <= low || gained >= high {
                    gained = 0.5 * (low + high);
                }
                continue;
            }
            let beside = |of: &Symmetric| std::array::from_fn(|i| of[i] - bulk * IDENTITY[i]);
            let (stress, strain): (Symmetric, Symmetric) = (beside(&stress), beside(&strain));
            for normal in &mut answer.kirchhoff[..3] {
                *normal += binding - of_model;
            }
            let tangent = &mut answer.tangent;
            K::add_pressure(tangent, binding - of_model);
            K::add_product(tangent, -1.0, &stress, &IDENTITY);
            K::add_product(tangent, -1.0, &IDENTITY, &strain);
            K::add_volumetric(tangent, -bulk);
            K::add_product(tangent, -1.0 / stiffness, &stress, &strain);
            let coupled = |of: &Symmetric| full(of) * (slope / stiffness);
            let field_strain = FieldVolumeStrain {
                strain: measure.strain(Ratios { step: ratio, grid: grid * ratio }) / at.end_weight,
                compliance: slope * slope / stiffness,
                stress: coupled(&stress),
                received: gained,
                taken: coupled(&strain),
            };
            return Some((answer, Some(field_strain)));
        }
        None
    }

    /// By Hencky's law from the change of the field. Soil with a limited tension has no such law beyond the limit, and without water the plastic
    /// volume strain is beside it.
    fn volume_ratio(&self, cell: &Cell, points: &Points<D>, entries: &Entries<D>, before: f64) -> Option<f64> {
        let p = entries.point;
        let carried =
            points.by_material(p, &self.carried).filter(|carried| carried.limit.is_none() && !carried.is_whole())?;
        let y = points.seeded_height(p);
        let skeleton = match carried.bound {
            Some(_) => carried.model.bulk_modulus(y, carried.model.mean_stress(y, volume_strain(&points.elastic[p]))),
            None => 0.0,
        };
        let (measure, bulk) = (Measure::of(carried, points, p, cell.inertia), carried.law(y).bulk + skeleton);
        measure.ratio(
            bulk,
            points.pressure[p],
            dot(&shapes(cell.kind, entries.shape), &cell.pressure),
            measure.slope(before),
        )
    }

    fn add(&self, cell: &Cell, point: &Point<D>, end_weight: f64, answer: &mut Spatial<K::Tangent>) {
        let &Point { points, entries, ratios } = point;
        let Some(carried) = points.by_material(entries.point, &self.carried) else { return };
        let measure = Measure::of(carried, points, entries.point, cell.inertia);
        let pressure = measure.slope(ratios.grid) * within(cell, &shapes(cell.kind, entries.shape), end_weight);
        for normal in &mut answer.kirchhoff[..3] {
            *normal += pressure;
        }
        K::add_pressure(&mut answer.tangent, pressure);
        if measure.power() > 0 {
            K::add_volumetric(&mut answer.tangent, f64::from(measure.power()) * pressure);
        }
    }

    fn work(&self, cell: &Cell, point: &Point<D>, end_weight: f64) -> [f64; 2] {
        let &Point { points, entries, ratios } = point;
        let Some(carried) = points.by_material(entries.point, &self.carried) else { return [0.0; 2] };
        let measure = Measure::of(carried, points, entries.point, cell.inertia);
        let pressure = within(cell, &shapes(cell.kind, entries.shape), end_weight);
        [pressure * measure.strain(ratios), pressure * measure.slope(ratios.grid)]
    }

    fn couple(&self, cell: &Cell, point: &Point<D>, coupling: &Coupling<D>, local: &mut Local) {
        let &Point { points, entries, ratios } = point;
        let &Coupling { forces, strains, field_strain, acting, end_weight } = coupling;
        let p = entries.point;
        let Some(carried) = points.by_material(p, &self.carried) else { return };
        let count = unknowns(cell.kind);
        // They are the last ones of a coupling.
        let begin = local.size - count;
        let y = points.seeded_height(p);
        let shapes = shapes(cell.kind, entries.shape);
        // Cells of first order: only what varies within the cell is stabilised.
        let stabilised: Coefficients = match &cell.mean {
            None => [0.0; MOST],
            Some(mean) => {
                let softness = carried.softness(y);
                std::array::from_fn(|a| softness * (shapes[a] - mean[a]))
            }
        };
        let measure = Measure::of(carried, points, p, cell.inertia);
        let [slope_before, slope] = [ratios.grid / ratios.step, ratios.grid].map(|ratio| measure.slope(ratio));
        let (before, pressure) = (points.pressure[p], dot(&shapes, &cell.pressure));
        let gained = pressure - before / slope_before;
        let [elastic, compliance] = match field_strain {
            Some(field_strain) => [field_strain.strain, field_strain.compliance],
            None => measure.elastic(&carried.law(y), before, pressure, slope_before),
        };
        let strain = measure.strain(ratios) - elastic;
        let weight = end_weight * self.unit * entries.weight;
        for a in 0..count {
            local.vector[begin + a] += weight * (shapes[a] * strain - stabilised[a] * gained);
        }
        if local.matrix.is_empty() {
            return;
        }
        let size = local.size;
        let mut by_strain = Tensor::identity() * slope;
        let mut acts = acting.of_unit(measure.slope(acting.within.grid), measure.strain(ratios));
        if let Some(field_strain) = field_strain {
            by_strain += field_strain.taken;
            acts += acting.through * field_strain.stress;
        }
        let beyond = reach_beyond_cells(forces.len());
        for (i, (force, strain)) in forces.iter().zip(strains).enumerate() {
            if beyond && force.is_zero() && strain.is_zero() {
                continue;
            }
            let (volume, force) = (K::force(&by_strain, strain), K::force(&acts, force));
            for (a, shape) in shapes.iter().enumerate().take(count) {
                for d in 0..D {
                    local.matrix[(begin + a) * size + i * D + d] += weight * shape * volume[d];
                    local.matrix[(i * D + d) * size + begin + a] += weight * shape * force[d];
                }
            }
        }
        for a in 0..count {
            for b in 0..count {
                local.matrix[(begin + a) * size + begin + b] -=
                    weight * self.unit * (compliance * shapes[a] + stabilised[a]) * shapes[b];
            }
        }
    }

    fn commit(&self, cell: &Cell, &Point { points, entries, ratios }: &Point<D>, history: &mut History) {
        let Some(carried) = points.by_material(entries.point, &self.carried) else { return };
        let slope = Measure::of(carried, points, entries.point, cell.inertia).slope(ratios.grid);
        history.pressure = slope * dot(&shapes(cell.kind, entries.shape), &cell.pressure);
        let gained = history.pressure - points.pressure[entries.point];
        let volume_ratio = history.deformation.determinant();
        let held = if carried.bound.is_some() {
            let of_model =
                carried.model.mean_stress(points.seeded_height(entries.point), volume_strain(&history.elastic));
            if carried.is_whole() {
                history.pressure = of_model;
            }
            of_model - volume_ratio * mean(&history.stress)
        } else {
            carried.held(points, entries.point) + (1.0 - carried.water) * gained
        };
        for normal in &mut history.stress[..3] {
            *normal += held / volume_ratio;
        }
    }

    fn energy(&self, points: &Points<D>, p: usize) -> f64 {
        let Some(carried) = points.by_material(p, &self.carried).filter(|carried| !carried.is_whole()) else {
            return 0.0;
        };
        let of_model = if carried.bound.is_some() { carried.held(points, p) } else { 0.0 };
        points.initial_volume[p] * carried.law(points.seeded_height(p)).energy(points.pressure[p] - of_model)
    }
}
