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
//! `L` are the corner hats, continuous from cell to cell, and in cells of second order a constant a cell (Taylor–Hood
//! with cell-wise volume balance; Boffi et al. 2012). Cells of first order have no room for the constant; there the
//! projection `Σ w₀ (L − L̄)(π − π_n)/2G` of Bochev, Dohrmann & Gunzburger (2006) makes the hats stable.

use super::share::{Answer, Seen, Within};
use super::{Frame, History, Ratios, Share, Trial};
use crate::kinematics::{Gradient, Kinematics};
use crate::material::cavitation::Volumetric;
use crate::material::spatial::Spatial;
use crate::material::{Model, Profile};
use crate::mesh::shape::CellKind;
use crate::points::Points;
use crate::stencil::{Entries, Patch};
use crate::system::Local;
use crate::tensor::{IDENTITY, Symmetric, Tensor, full, mean};
use std::fmt;
use std::marker::PhantomData;
use std::sync::Arc;

/// Most unknowns of a cell.
pub const MOST: usize = 5;

/// Most iterations for the volume at a pressure; it takes two or three.
const ITERATIONS: usize = 20;

/// Largest error (-) of the volume strain that a model sees.
const SMALLEST: f64 = 1e-12;

/// Values of the functions of the field at a point: corners, then the constant.
pub type Hats = [f64; MOST];

/// What the field carries in a region.
#[derive(Clone)]
pub struct Carried {
    /// The model of the points of the region.
    pub model: Arc<dyn Model>,
    /// `K_f / G` (-).
    pub ratio: f64,
    /// Share (-) of its increments that is pressure of the pore water and not stress of the points: 0 in total stress.
    pub water: f64,
    /// Where the model sees the volume strain of the field in place of its own: bulk modulus over the shear modulus (-) that binds the one to the
    /// other in a step. `None` where the model answers for its own and the field carries the rest.
    pub bound: Option<f64>,
    /// Limit (kPa) of the field in tension, at which the volume of the soil grows.
    pub limit: Option<Profile>,
}

impl fmt::Debug for Carried {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Carried").field("ratio", &self.ratio).field("water", &self.water).finish_non_exhaustive()
    }
}

impl Carried {
    /// The law of the volume at a point seeded at height `y` (m): with `K_f`, and a limit where it has one.
    fn law(&self, y: f64) -> Volumetric {
        let shear = self.model.elasticity().at(y).shear;
        let bulk = self.ratio * shear;
        let limited = |limit: Profile| Volumetric::of(self.model.as_ref(), bulk, limit.at(y), y);
        self.limit.map_or_else(|| Volumetric::unlimited(bulk), limited)
    }

    /// `1 / 2G` (1/kPa) at a point seeded at height `y` (m).
    fn softness(&self, y: f64) -> f64 {
        0.5 / self.model.elasticity().at(y).shear
    }

    /// What the stress of point `p` holds of the field (kPa, Kirchhoff).
    pub fn held<const D: usize>(&self, points: &Points<D>, p: usize) -> f64 {
        if self.water == 0.0 {
            return points.pressure[p];
        }
        points.deformation[p].determinant() * mean(&points.stress[p]) - self.of_model(points, p)
    }

    /// What the model bears of the mean stress of point `p` beside the field (kPa, Kirchhoff).
    fn of_model<const D: usize>(&self, points: &Points<D>, p: usize) -> f64 {
        match self.bound {
            Some(_) => 0.0,
            None => self.model.mean_stress(points.origin[p][1], volume_strain(&points.elastic[p])),
        }
    }

    /// Excess pressure of the pore water (kPa, Cauchy, compression positive) at point `p`.
    pub fn pore_pressure<const D: usize>(&self, points: &Points<D>, p: usize) -> f64 {
        (self.held(points, p) - points.pressure[p]) / points.deformation[p].determinant()
    }

    /// What the field begins with (kPa) at a point whose elastic tensor is that of `whole`, the model that answers for
    /// the whole stress.
    pub fn begin<const D: usize>(&self, whole: &dyn Model, points: &Points<D>, p: usize) -> f64 {
        whole.mean_stress(points.origin[p][1], volume_strain(&points.elastic[p])) - self.of_model(points, p)
    }
}

/// Excess pressure of the pore water (kPa, Cauchy, compression positive) at point `p` of soil of which a pressure field carries the share of
/// the water, or that has a field for the water alone, or neither.
pub fn excess_pressure<const D: usize>(carried: &[Option<Carried>], points: &Points<D>, p: usize) -> f64 {
    match carried.get(points.model_of(p)).and_then(Option::as_ref) {
        Some(share) if share.water > 0.0 && !points.pressure.is_empty() => share.pore_pressure(points, p),
        _ => points.pore_pressure.get(p).copied().unwrap_or(0.0),
    }
}

/// Elastic volume strain `½ ln det b` (-).
fn volume_strain(elastic: &Symmetric) -> f64 {
    0.5 * full(elastic).determinant().ln()
}

/// How many unknowns the field has in a cell: one a corner, and the constant in cells of second order.
pub fn unknowns(kind: CellKind) -> usize {
    kind.corner_count() + usize::from(kind.order() > 1)
}

/// The functions of the field where the shape functions of the cell are `n`: the corner hats lie in their span.
pub fn hats(kind: CellKind, n: &[f64]) -> Hats {
    let corners = kind.corner_count();
    let mut hats = [0.0; MOST];
    hats[..corners].copy_from_slice(&n[..corners]);
    if kind.order() > 1 {
        for v in 0..corners {
            hats[v] += 0.5 * (n[corners + v] + n[corners + (v + corners - 1) % corners]);
            hats[v] += n.get(2 * corners).map_or(0.0, |centre| 0.25 * centre);
        }
        hats[corners] = 1.0;
    }
    hats
}

/// The unknowns of a cell in the field `pressure` as the state has it: by node, then by cell.
/// `constant` is where that of the cell stands.
pub fn gather(kind: CellKind, nodes: &[u32], constant: usize, pressure: &[f64]) -> Hats {
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

/// What the field is conjugate to at a point: `ln j`, or where the field is in tension as the step begins `½ j²`, and `j` where the tension has a
/// limit. `j` is the volume over that when the grid was restored.
#[derive(Clone, Copy)]
enum Measure {
    Logarithm,
    Volume,
    Square,
}

impl Measure {
    fn of<const D: usize>(carried: &Carried, points: &Points<D>, p: usize) -> Self {
        match points.pressure[p] > 0.0 {
            false => Self::Logarithm,
            true if carried.limit.is_some() => Self::Volume,
            true => Self::Square,
        }
    }

    /// The power `n` of the measure `jⁿ/n`; 0 of the logarithm.
    fn power(self) -> i32 {
        self as i32
    }

    /// The slope of the measure in `ln j`: the Kirchhoff stress of a unit of the field.
    fn slope(self, ratio: f64) -> f64 {
        ratio.powi(self.power())
    }

    /// What a step of the given ratios adds to the measure.
    fn strain(self, ratios: Ratios) -> f64 {
        let before = ratios.grid / ratios.step;
        match self {
            Self::Logarithm => ratios.step.ln(),
            Self::Volume => ratios.grid - before,
            Self::Square => 0.5 * (ratios.grid.powi(2) - before.powi(2)),
        }
    }

    /// The volume strain of a law, by this measure, as the field goes from the Kirchhoff stress `before` to `pressure` (kPa), and its
    /// slope (1/kPa). `slope` is that of the measure as the step begins. Not a number at a tension for which the law has no volume,
    /// as at half the bulk modulus and above; such a trial state is refused.
    fn elastic(self, law: &Volumetric, before: f64, pressure: f64, slope: f64) -> [f64; 2] {
        let (then, compliance) = (law.strain(before)[0], 1.0 / law.bulk);
        match self {
            Self::Logarithm => {
                let [strain, compliance] = law.strain(pressure);
                [strain - then, compliance]
            }
            Self::Volume => {
                // The Cauchy stress is linear in the volume beyond the limit. `first` is the volume, over that without stress, as the step begins.
                let (first, (least, cauchy)) = (then.exp(), law.at_limit());
                let more = pressure * slope / first - cauchy;
                if more > 0.0 {
                    let x = (least + more / law.rise) / first;
                    return [slope * (x - 1.0), slope * slope / (first * first * law.rise)];
                }
                let now = compliance * pressure * slope;
                let x = least_root(1, then, now, (-then).exp());
                [slope * (x - 1.0), compliance * slope * slope * x / (1.0 / x - now)]
            }
            Self::Square => {
                let now = compliance * pressure * slope;
                let x = least_root(2, then, now, if then < 0.5 && now < 0.5 { 1.0 } else { f64::NAN });
                [0.5 * slope * (x * x - 1.0), compliance * slope * slope * x.powi(3) / (1.0 / x - 2.0 * now * x)]
            }
        }
    }
}

/// The least root of `then + ln x = now xⁿ` by Newton's method from `x`; not a number where it finds none. From the second iterate on it comes from below.
fn least_root(n: i32, then: f64, now: f64, mut x: f64) -> f64 {
    for _ in 0..ITERATIONS {
        let change = (then + f64::ln(x) - now * x.powi(n)) / (1.0 / x - f64::from(n) * now * x.powi(n - 1));
        x -= change;
        // What is left is the square of the last change.
        if change.abs() < 1e-9 * x {
            return x;
        }
    }
    f64::NAN
}

fn dot(a: &Hats, b: &Hats) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The pressure field of a scene.
pub struct PressureField<K> {
    /// What it carries of each material by number; `None` where nothing.
    carried: Vec<Option<Carried>>,
    /// What a unit of its unknowns stands for (kPa/m).
    unit: f64,
    kinematics: PhantomData<K>,
}

impl<K> PressureField<K> {
    /// `carried[m]` is what the field carries of material `m` ([`Points::model_of`]), `unit` that of [`crate::step::Scene`].
    pub fn new(carried: Vec<Option<Carried>>, unit: f64) -> Self {
        Self { carried, unit, kinematics: PhantomData }
    }

    fn of<const D: usize>(&self, points: &Points<D>, p: usize) -> Option<&Carried> {
        self.carried.get(points.model_of(p)).and_then(Option::as_ref)
    }
}

/// The field over a cell.
pub struct Cell {
    kind: CellKind,
    /// Its unknowns (kPa).
    pressure: Hats,
    /// Means of the functions over the points, weighted by `1/2G`, for cells of first order.
    mean: Option<Hats>,
}

impl<const D: usize, K: Kinematics<D>> Share<D, K> for PressureField<K> {
    type Cell = Cell;

    fn over(&self, frame: &Frame<D>, trial: &Trial<D>, patch: &Patch) -> Cell {
        let cell = patch.cell as usize;
        let kind = frame.mesh.cells.kind[cell];
        let nodes = frame.mesh.cells.nodes(cell);
        let pressure = gather(kind, nodes, frame.constants + cell, trial.pressure);
        let mean = (kind.order() == 1).then(|| {
            let (mut sum, mut weight) = ([0.0; MOST], 0.0);
            for entries in frame.stencil.entries::<K>(patch) {
                if let Some(carried) = self.of(frame.points, entries.point) {
                    // As the differences from them are weighted: the projection is symmetric.
                    let own = entries.weight * carried.softness(frame.points.origin[entries.point][1]);
                    weight += own;
                    for (sum, hat) in sum.iter_mut().zip(hats(kind, entries.value)) {
                        *sum += own * hat;
                    }
                }
            }
            if weight > 0.0 { sum.map(|s| s / weight) } else { sum }
        });
        Cell { kind, pressure, mean }
    }

    fn respond(&self, cell: &Cell, points: &Points<D>, entries: &Entries<D>, at: &Within) -> Option<Answer<K, D>> {
        let (p, y) = (entries.point, points.origin[entries.point][1]);
        let bound = self.of(points, p).and_then(|carried| Some((carried, carried.bound?)));
        let Some((carried, bound)) = bound else { return Some((K::respond(at.model, y, &at.trial, &at.state)?, None)) };
        let (measure, bound) = (Measure::of(carried, points, p), bound * at.model.elasticity().at(y).shear);
        let (water, grid) = (carried.law(y).bulk, at.ratios.grid / at.ratios.step);
        let (before, slope) = (points.pressure[p], measure.slope(grid));
        let pressure =
            at.later * dot(&hats(cell.kind, entries.value), &cell.pressure) + (1.0 - at.later) * before / slope;
        let strain = volume_strain(&points.elastic[p]);
        let (local, mean_before) = (volume_strain(&at.trial) - strain, at.model.mean_stress(y, strain));
        // `gained` is the volume strain of the field in the step; at first as if nothing yields.
        let mut gained = (pressure * slope - before) / (water + at.model.bulk_modulus(y, mean_before));
        for _ in 0..ITERATIONS {
            let stretch = f64::exp(2.0 / 3.0 * (gained - local));
            let mut answer = K::respond(at.model, y, &at.trial.map(|b| stretch * b), &at.state)?;
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
                gained += change;
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
            let seen = Seen {
                strain: measure.strain(Ratios { step: ratio, grid: grid * ratio }) / at.later,
                compliance: slope * slope / stiffness,
                stress: coupled(&stress),
                taken: coupled(&strain),
            };
            return Some((answer, Some(seen)));
        }
        None
    }

    fn add(
        &self,
        cell: &Cell,
        points: &Points<D>,
        entries: &Entries<D>,
        ratios: Ratios,
        answer: &mut Spatial<K::Tangent>,
    ) -> f64 {
        let Some(carried) = self.of(points, entries.point) else { return 0.0 };
        let measure = Measure::of(carried, points, entries.point);
        let pressure = measure.slope(ratios.grid) * dot(&hats(cell.kind, entries.value), &cell.pressure);
        for normal in &mut answer.kirchhoff[..3] {
            *normal += pressure;
        }
        K::add_pressure(&mut answer.tangent, pressure);
        if measure.power() > 0 {
            K::add_volumetric(&mut answer.tangent, f64::from(measure.power()) * pressure);
        }
        points.pressure[entries.point]
    }

    fn couple(
        &self,
        cell: &Cell,
        points: &Points<D>,
        entries: &Entries<D>,
        spatial: &[Gradient<D>],
        ratios: Ratios,
        seen: Option<&Seen>,
        acts_on: &Tensor,
        later: f64,
        local: &mut Local,
    ) {
        let p = entries.point;
        let Some(carried) = self.of(points, p) else { return };
        let count = unknowns(cell.kind);
        // They are the last ones of a clique.
        let begin = local.size - count;
        let y = points.origin[p][1];
        let hats = hats(cell.kind, entries.value);
        // Cells of first order: only what varies within the cell is stabilised.
        let stabilised: Hats = match &cell.mean {
            None => [0.0; MOST],
            Some(mean) => {
                let softness = carried.softness(y);
                std::array::from_fn(|a| softness * (hats[a] - mean[a]))
            }
        };
        let measure = Measure::of(carried, points, p);
        let [slope_before, slope] = [ratios.grid / ratios.step, ratios.grid].map(|ratio| measure.slope(ratio));
        let (before, pressure) = (points.pressure[p], dot(&hats, &cell.pressure));
        let gained = pressure - before / slope_before;
        let [elastic, compliance] = match seen {
            Some(seen) => [seen.strain, seen.compliance],
            None => measure.elastic(&carried.law(y), before, pressure, slope_before),
        };
        let strain = measure.strain(ratios) - elastic;
        let weight = later * self.unit * entries.weight;
        for a in 0..count {
            local.vector[begin + a] += weight * (hats[a] * strain - stabilised[a] * gained);
        }
        if local.matrix.is_empty() {
            return;
        }
        let size = local.size;
        let [mut by_strain, mut by_field] = [Tensor::identity() * slope; 2];
        if let Some(seen) = seen {
            by_strain += seen.taken;
            by_field += seen.stress;
        }
        let acting = acts_on * by_field;
        for (i, gradient) in spatial.iter().enumerate() {
            let (volume, force) = (K::force(&by_strain, gradient), K::force(&acting, gradient));
            for (a, hat) in hats.iter().enumerate().take(count) {
                for d in 0..D {
                    local.matrix[(begin + a) * size + i * D + d] += weight * hat * volume[d];
                    local.matrix[(i * D + d) * size + begin + a] += weight * hat * force[d];
                }
            }
        }
        for a in 0..count {
            for b in 0..count {
                local.matrix[(begin + a) * size + begin + b] -=
                    weight * self.unit * (compliance * hats[a] + stabilised[a]) * hats[b];
            }
        }
    }

    fn commit(&self, cell: &Cell, points: &Points<D>, entries: &Entries<D>, ratios: Ratios, history: &mut History) {
        let Some(carried) = self.of(points, entries.point) else { return };
        let slope = Measure::of(carried, points, entries.point).slope(ratios.grid);
        history.pressure = slope * dot(&hats(cell.kind, entries.value), &cell.pressure);
        let gained = history.pressure - points.pressure[entries.point];
        let volume_ratio = history.deformation.determinant();
        let held = if carried.bound.is_some() {
            let of_model = carried.model.mean_stress(points.origin[entries.point][1], volume_strain(&history.elastic));
            of_model - volume_ratio * mean(&history.stress)
        } else {
            carried.held(points, entries.point) + (1.0 - carried.water) * gained
        };
        for normal in &mut history.stress[..3] {
            *normal += held / volume_ratio;
        }
    }

    fn energy(&self, points: &Points<D>, p: usize) -> f64 {
        let Some(carried) = self.of(points, p) else { return 0.0 };
        let of_model = if carried.bound.is_some() { carried.held(points, p) } else { 0.0 };
        points.initial_volume[p] * carried.law(points.origin[p][1]).energy(points.pressure[p] - of_model)
    }
}
