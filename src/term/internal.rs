//! Internal force: `f_I = Σ_q w_q τ_q · ∇_x N_I`, with its consistent tangent. The sum is over the integration points, or over the material points
//! with `w = V⁰` where integrals are summed over these.
//!
//! Kinematics: `F = I + Σ u ⊗ ∇N` from the restored grid, the increment since the last converged step
//! `ΔF = F F_n⁻¹`, the elastic trial `b = ΔF b_n ΔFᵀ` (theory, eq. 2). The term keeps no state: the points
//! carry it, and it is written only on convergence.
//!
//! With inertia the stress within the step acts on the configuration within it: in place of `τ` stands `A W`,
//! `A = (1 − α_f) I + α_f ΔF⁻¹`. The metric within the step is `C = (1 − α_f) ΔFᵀΔF + α_f I = HᵀH`, and the model
//! responds to `H b_n Hᵀ` with the stress `τ_H`, so that `W = Q τ_H Qᵀ`, `Q = ΔF H⁻¹` (theory, eq. 7 and 8). `A W Aᵀ`
//! being symmetric, the forces have no moment about the positions within the step; a rotation leaves `C = I`; and
//! soil that yields dissipates, for the stress within the step is one that it can bear.
//!
//! A [`Mixed`] of the stress may be carried by unknowns of its own; it is a type, so that a scene without one pays
//! nothing.

use super::extended::{Kept, scatter_functions};
use super::mixed::{Answer, Coupling, ModelInput, Point};
use super::smoothed::{self, Layout};
use super::stiffness::{Stiffness, add_turning};
use super::volume::VolumeFit;
use super::{Assembly, Frame, Histories, History, Term, Trial, Update};
use super::{Mixed, Ratios};
use crate::error::{Error, Result};
use crate::interpolation::{CellPoints, Entries, MAX_FUNCTIONS};
use crate::kinematics::{Gradient, Kinematics};
use crate::material::spatial::Spatial;
use crate::material::{Model, State, VariableKind, internal_count};
use crate::points::Points;
use crate::profile::timed_material;
use crate::system::Local;
use crate::tensor::{Tensor, exponential, full, symmetric};
use rayon::prelude::*;
use std::borrow::Cow;
use std::marker::PhantomData;
use std::sync::Arc;

/// Least ratio of volumes in one step that a trial state may have.
const LEAST_VOLUME_RATIO: f64 = 0.05;

/// The internal force of all material points.
pub struct Internal<K, S = ()> {
    /// The model of each material by number; `None` where a region holds no points.
    models: Models,
    /// Numbers of internal variables that the models need.
    internal_count: usize,
    /// Whether the strength of each material is what [`Trial::reduction`] divides.
    reduces: Vec<bool>,
    /// Whether the scene has dynamic phases.
    dynamic: bool,
    share: S,
    kinematics: PhantomData<K>,
}

/// The model of each material by number.
type Models = Vec<Option<Arc<dyn Model>>>;

/// The deformation of a point in a trial state.
struct Strained {
    /// Deformation since the last converged step.
    increment: Tensor,
    /// Inverse of the deformation since the grid was restored.
    inverse: Tensor,
    /// `H`: the deformation that the model responds to, [`Strained::increment`] without inertia.
    metric_factor: Tensor,
    ratios: Ratios,
}

impl Strained {
    /// Stretches the point so that its volume has these ratios.
    fn take_volume<const D: usize, K: Kinematics<D>>(&mut self, ratios: Ratios) {
        K::stretch(&mut self.increment, ratios.step / self.ratios.step);
        self.metric_factor = self.increment;
        self.ratios = ratios;
    }

    /// The stress `A W` that acts in the step, and `A`; its tangent takes the place of that of `τ_H` in `answer`. `add` adds
    /// the share of the stress that unknowns carry at the end of the step and returns that at its beginning (kPa).
    #[inline]
    fn stress<const D: usize, K: Kinematics<D>>(
        &self,
        alpha_f: f64,
        (answer, field_strain): &mut Answer<K, D>,
        add: impl Fn(&mut Spatial<K::Tangent>) -> f64,
    ) -> (Tensor, Tensor) {
        if alpha_f == 0.0 {
            add(answer);
            return (full(&answer.kirchhoff), Tensor::identity());
        }
        let increment = &self.increment;
        // Both have the determinant of what was found to be admissible.
        let [back, across] = [increment, &self.metric_factor].map(|f| f.try_inverse().unwrap_or_else(Tensor::identity));
        let q = increment * across;
        K::convect(answer, &q);
        if let Some(field_strain) = field_strain {
            field_strain.convect(&q);
        }
        let of_model = full(&answer.kirchhoff);
        let before = add(answer);
        let a = Tensor::identity() * (1.0 - alpha_f) + back * alpha_f;
        let of_share = (full(&answer.kirchhoff) - of_model) * (1.0 - alpha_f);
        let w = of_model + of_share + increment * increment.transpose() * (alpha_f * before);
        K::weight(&mut answer.tangent, &a, &answer.kirchhoff, &w);
        (a * w, a)
    }
}

/// Deformation and answers of the points of a cell, in order.
type Evaluated<K, const D: usize> = (Vec<Strained>, Vec<Answer<K, D>>);

/// A factor `H` of the metric within the step, `HᵀH = (1 − α_f) ΔFᵀΔF + α_f I`.
#[inline]
fn metric_factor(increment: &Tensor, alpha_f: f64) -> Option<Tensor> {
    let metric = increment.transpose() * increment * (1.0 - alpha_f) + Tensor::from_diagonal_element(alpha_f);
    metric.cholesky().map(|factor| factor.l().transpose())
}

impl<K> Internal<K> {
    /// `models[m]` is the model of material `m` ([`Points::model_of`]); `dynamic` where any phase is.
    pub fn new(models: Models, dynamic: bool) -> Self {
        Self::sharing(models, dynamic, ())
    }
}

impl<K, S> Internal<K, S> {
    /// As [`Internal::new`], where `share` carries a part of the stress.
    pub fn sharing(models: Models, dynamic: bool, share: S) -> Self {
        let internal_count = models.iter().flatten().map(|model| internal_count(model.as_ref())).max().unwrap_or(0);
        let reduces = vec![true; models.len()];
        Self { internal_count, reduces, models, dynamic, share, kinematics: PhantomData }
    }

    /// Takes materials out of every reduction of strength; `kept[m]` is true for those.
    pub fn keeping(mut self, kept: &[bool]) -> Self {
        self.reduces = kept.iter().map(|kept| !kept).collect();
        self
    }

    /// Numbers of internal variables for each of some points: those without the column begin each step with the first values.
    fn internal_count<const D: usize>(&self, points: &Points<D>) -> usize {
        if points.internal.is_empty() { self.internal_count } else { points.internal_count() }
    }

    /// The models in a trial state.
    fn models_in<const D: usize>(&self, trial: &Trial<D>) -> Cow<'_, [Option<Arc<dyn Model>>]> {
        if trial.reduction == 1.0 {
            return Cow::Borrowed(&self.models);
        }
        let reduced = |(model, reduces): (&Option<Arc<dyn Model>>, &bool)| {
            model.as_ref().map(|model| if *reduces { model.reduced(trial.reduction) } else { model.clone() })
        };
        Cow::Owned(self.models.iter().zip(&self.reduces).map(reduced).collect())
    }

    /// The answer of the model at a point, given the weight of the end of the step, with its internal variables at the end of the
    /// step in `internal`.
    fn answer<const D: usize>(
        &self,
        models: &[Option<Arc<dyn Model>>],
        (points, entries): (&Points<D>, &Entries<D>),
        cell: &S::Cell,
        strained: &Strained,
        (inverse_dt, end_weight): (f64, f64),
        internal: &mut [f64],
    ) -> Result<Answer<K, D>>
    where
        K: Kinematics<D>,
        S: Mixed<D, K>,
    {
        let p = entries.point;
        let metric_factor = &strained.metric_factor;
        let trial = symmetric(&(metric_factor * full(&points.elastic[p]) * metric_factor.transpose()));
        let Some(model) = points.by_material(p, models) else {
            return Err(Error::analysis(format!("material point {p}"), "it has no material", ""));
        };
        let state = State { increment: Some(metric_factor), ..points.state(p, inverse_dt) };
        let input = ModelInput { model: model.as_ref(), trial, state, end_weight };
        let point = Point { points, entries, ratios: strained.ratios };
        let answer = self.share.respond(cell, &point, &input, internal);
        answer.ok_or_else(|| inadmissible(points, p, "is strained beyond measure", &strained.increment))
    }

    /// The points of a cell at a trial state.
    fn evaluate<const D: usize>(
        &self,
        models: &[Option<Arc<dyn Model>>],
        frame: &Frame<D>,
        trial: &Trial<D>,
        cell_points: &CellPoints,
        cell: &S::Cell,
    ) -> Result<Evaluated<K, D>>
    where
        K: Kinematics<D>,
        S: Mixed<D, K>,
    {
        let now = frame.interpolation.gather(frame.mesh, cell_points, trial.displacement);
        let before = frame.interpolation.gather(frame.mesh, cell_points, trial.converged);
        // In the first step after a restoration nothing has moved before.
        let moved = before.iter().flatten().any(|&u| u != 0.0);
        let held = trial.geometry.map(|u| frame.interpolation.gather(frame.mesh, cell_points, u));
        let mut strained = Vec::with_capacity(cell_points.point_count as usize);
        for entries in frame.interpolation.entries::<K>(cell_points) {
            let ends = Ends { now: &now, before: moved.then_some(&before[..]), held: held.as_deref().map(moved_nodes) };
            let mut point = strain::<D, K>(frame.points, &entries, &ends)?;
            if trial.alpha_f > 0.0 {
                point.metric_factor = metric_factor(&point.increment, trial.alpha_f)
                    .ok_or_else(|| inadmissible(frame.points, entries.point, "is squeezed flat", &point.increment))?;
            }
            strained.push(point);
        }
        let end_weight = 1.0 - trial.alpha_f;
        // What the internal variables become is wanted of converged steps only.
        let mut internal = vec![0.0; self.internal_count(frame.points)];
        let answer = |(entries, strained): (Entries<D>, &Strained)| {
            let of_point = (frame.points, &entries);
            self.answer(models, of_point, cell, strained, (trial.inverse_dt / end_weight, end_weight), &mut internal)
        };
        let entries = frame.interpolation.entries::<K>(cell_points).zip(&strained);
        let answers = timed_material(|| entries.map(answer).collect::<Result<_>>())?;
        Ok((strained, answers))
    }
}

/// The displacements (m) of the functions of a cell.
struct Ends<'a, const D: usize> {
    now: &'a [[f64; D]],
    /// At the last converged step, `None` for all zero.
    before: Option<&'a [[f64; D]]>,
    /// Those whose geometry is held, where it is; none where they are all zero.
    held: Option<&'a [[f64; D]]>,
}

/// The displacements, or none where all are zero.
fn moved_nodes<const D: usize>(u: &[[f64; D]]) -> &[[f64; D]] {
    if u.iter().flatten().any(|&u| u != 0.0) { u } else { &[] }
}

/// The deformation of a point.
#[inline]
fn strain<const D: usize, K: Kinematics<D>>(
    points: &Points<D>,
    entries: &Entries<D>,
    ends: &Ends<D>,
) -> Result<Strained> {
    if let Some(held) = ends.held {
        return linear_strain::<D, K>(points, entries, ends, held);
    }
    let p = entries.point;
    let now = entries.deformation::<K>(ends.now);
    let inverse = now.try_inverse().ok_or_else(|| inadmissible(points, p, "is squeezed flat", &now))?;
    let increment = match ends.before {
        None => now,
        Some(converged) => {
            let before = entries.deformation::<K>(converged);
            now * before.try_inverse().ok_or_else(|| inadmissible(points, p, "was squeezed flat", &before))?
        }
    };
    let ratios = Ratios { step: increment.determinant(), grid: now.determinant() };
    if !(ratios.step > LEAST_VOLUME_RATIO && ratios.grid > 0.0) {
        let what = if ratios.step > 0.0 && ratios.grid > 0.0 {
            format!("is compressed to {:.1} % of its volume in one step", 100.0 * ratios.step)
        } else {
            "is turned inside out".into()
        };
        return Err(inadmissible(points, p, &what, &increment));
    }
    Ok(Strained { increment, inverse, metric_factor: increment, ratios })
}

/// The deformation of a point on the geometry of the displacements `held`: the exponential of the symmetric gradient there of what was
/// displaced in the step (docs/theory.md, section 9, *Strength reduction*).
fn linear_strain<const D: usize, K: Kinematics<D>>(
    points: &Points<D>,
    entries: &Entries<D>,
    ends: &Ends<D>,
    held: &[[f64; D]],
) -> Result<Strained> {
    let p = entries.point;
    let [start, now] = [held, ends.now].map(|u| entries.deformation::<K>(u));
    let before = ends.before.map_or_else(Tensor::identity, |u| entries.deformation::<K>(u));
    let inverse = start.try_inverse().ok_or_else(|| inadmissible(points, p, "was squeezed flat", &start))?;
    let strain = full(&symmetric(&((now - before) * inverse)));
    let since = ((now - start) * inverse).trace();
    let increment = exponential(&strain);
    let ratios = Ratios { step: strain.trace().exp(), grid: start.determinant() * since.exp() };
    if !(ratios.step > LEAST_VOLUME_RATIO && ratios.grid > 0.0 && increment.iter().all(|f| f.is_finite())) {
        return Err(inadmissible(points, p, "is strained beyond measure in one step", &increment));
    }
    Ok(Strained { increment, inverse, metric_factor: increment, ratios })
}

#[cold]
fn inadmissible<const D: usize>(points: &Points<D>, p: usize, what: &str, deformation: &Tensor) -> Error {
    Error::analysis(
        format!("the material at {:.3?} m", points.position[p]),
        format!("{what} (det F {:.3})", deformation.determinant()),
        "take smaller steps; where these do not help, finer cells there do, or a grid that is reset sooner (numerics.restore)",
    )
}

impl<const D: usize, K: Kinematics<D>, S: Mixed<D, K>> Term<D> for Internal<K, S> {
    fn symmetric(&self) -> bool {
        // The spin of internal tensors has no potential.
        let has_tensors = |m: &dyn Model| m.internal_variables().iter().any(|v| v.kind == VariableKind::Tensor);
        !self.dynamic && self.models.iter().flatten().all(|m| m.symmetric() && !has_tensors(m.as_ref()))
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let wanted = out.tangent.is_some();
        let models = self.models_in(trial);
        let compute = |cell_points: &CellPoints, local: &mut Local, kept: &mut [f64]| {
            let cell = self.share.over(frame, trial, cell_points);
            let (strained, mut answers) = self.evaluate(&models, frame, trial, cell_points, &cell)?;
            let count = cell_points.function_count as usize;
            let end_weight = 1.0 - trial.alpha_f;
            let mut spatial = [Gradient { g: [0.0; D], hoop: 0.0 }; MAX_FUNCTIONS];
            let own = cell_points.node_count as usize;
            let layout = Layout::new::<D, K>(cell_points);
            // Where strains are taken with other gradients than forces act through, the grid is deformed by each of them.
            let apart = frame.interpolation.strains_apart();
            let held = trial.geometry.is_some();
            let shape = trial.geometry.unwrap_or(trial.displacement);
            let now = apart.then(|| frame.interpolation.gather(frame.mesh, cell_points, shape));
            let mut buffer = Vec::new();
            Stiffness::with::<D, _>(own, |stiffness| {
                for (k, ((entries, point), answer)) in
                    frame.interpolation.entries::<K>(cell_points).zip(&strained).zip(&mut answers).enumerate()
                {
                    let at = Point { points: frame.points, entries: &entries, ratios: point.ratios };
                    let add = |answer: &mut _| self.share.add(&cell, &at, answer);
                    let (stress, acts_on) = point.stress::<D, K>(trial.alpha_f, answer, add);
                    if held && wanted {
                        K::hold(&mut answer.0);
                    }
                    let volume = entries.weight;
                    let of_forces = now.as_ref().map(|now| entries.deformation_of_forces::<K>(now));
                    let inverse = match of_forces {
                        None => point.inverse,
                        Some(deformation) => deformation.try_inverse().ok_or_else(|| {
                            inadmissible(frame.points, entries.point, "is squeezed flat", &deformation)
                        })?,
                    };
                    for i in 0..count {
                        spatial[i] = K::push_forward(&entries.gradient(i), &inverse);
                        let f = K::force(&stress, &spatial[i]);
                        for d in 0..D {
                            local.vector[i * D + d] += volume * f[d];
                        }
                    }
                    let forces = &spatial[..count];
                    let strains = entries.strains::<K>(forces, &point.inverse, &mut buffer);
                    if wanted {
                        let (tangent, weight) = (&answer.0.tangent, end_weight * volume);
                        stiffness.push::<D, K>(tangent, [&forces[..own], &strains[..own]], weight, local);
                        if apart && !held {
                            add_turning(&stress, [forces, strains], volume, local);
                        }
                        if !kept.is_empty() {
                            smoothed::keep::<D, K>(&layout, tangent, &entries, &point.inverse, weight, k, kept);
                        }
                    }
                    let coupling =
                        Coupling { forces, strains, field_strain: answer.1.as_ref(), acts_on: &acts_on, end_weight };
                    self.share.couple(&cell, &at, &coupling, local);
                }
                if wanted {
                    stiffness.add_to::<D, K>(local);
                }
                Ok(())
            })
        };
        scatter_functions(frame, Kept::Points(Layout::new::<D, K>), compute, out)
    }

    fn yields(&self) -> bool {
        self.models.iter().flatten().any(|model| model.yields())
    }

    fn energy(&self, points: &Points<D>) -> f64 {
        let energy = |p: usize| {
            let Some(model) = points.by_material(p, &self.models) else { return 0.0 };
            let strain = K::roots(&points.elastic[p]).map(|b| 0.5 * b.ln());
            let stored = model.elastic_energy(points.seeded_height(p), &strain);
            self.share.energy(points, p) + points.initial_volume[p] * stored
        };
        // In order, so that the sum does not depend on the number of threads.
        (0..points.len()).into_par_iter().map(energy).collect::<Vec<f64>>().iter().sum()
    }

    fn commit(&self, frame: &Frame<D>, trial: &Trial<D>) -> Option<Update> {
        let models = self.models_in(trial);
        let of_cell = |cell_points: &CellPoints| {
            let now = frame.interpolation.gather(frame.mesh, cell_points, trial.displacement);
            let before = frame.interpolation.gather(frame.mesh, cell_points, trial.converged);
            let held = trial.geometry.map(|u| frame.interpolation.gather(frame.mesh, cell_points, u));
            let ends = Ends { now: &now, before: Some(&before), held: held.as_deref().map(moved_nodes) };
            let cell = self.share.over(frame, trial, cell_points);
            let volume = frame.integration.and_then(|(interpolation, points)| {
                let cell_points = interpolation.of_cell(cell_points.cell)?;
                let [now, before] =
                    [trial.displacement, trial.converged].map(|u| interpolation.gather(frame.mesh, cell_points, u));
                let held = trial.geometry.map(|u| interpolation.gather(frame.mesh, cell_points, u));
                let ends = Ends { now: &now, before: Some(&before), held: held.as_deref().map(moved_nodes) };
                let fit = |of: fn(Ratios) -> f64| {
                    let value = |entries: Entries<D>| {
                        let point = strain::<D, K>(points, &entries, &ends).ok()?;
                        Some((entries.weight, points.position[entries.point], of(point.ratios).ln()))
                    };
                    let values: Vec<_> = interpolation.entries::<K>(cell_points).filter_map(value).collect();
                    VolumeFit::of(&values, frame.mesh.cells.kind[cell_points.cell as usize].order())
                };
                Some((fit(|ratios| ratios.step)?, fit(|ratios| ratios.grid / ratios.step)?))
            });
            let count = self.internal_count(frame.points);
            let mut out = Histories::with_capacity(cell_points.point_count as usize, count);
            let new = |entries: Entries<D>, internal: &mut [f64]| {
                let mut point = strain::<D, K>(frame.points, &entries, &ends).ok()?;
                if let Some((of_step, of_grid)) = &volume {
                    let place = &frame.points.position[entries.point];
                    let before = of_grid.at(place).exp();
                    let by_law = self.share.volume_ratio(&cell, frame.points, &entries, before);
                    let step = by_law.unwrap_or_else(|| of_step.at(place).exp());
                    point.take_volume::<D, K>(Ratios { step, grid: before * step });
                }
                let of_point = (frame.points, &entries);
                let step = (trial.inverse_dt, 1.0);
                let (answer, _) = self.answer(&models, of_point, &cell, &point, step, internal).ok()?;
                let deformation = point.increment * frame.points.deformation[entries.point];
                let volume_ratio = deformation.determinant();
                let mut history = History {
                    point: entries.point,
                    deformation,
                    elastic: answer.elastic,
                    stress: answer.kirchhoff.map(|t| t / volume_ratio),
                    plastic_strain: answer.plastic_strain,
                    pressure: 0.0,
                    pore_pressure: 0.0,
                };
                let at = Point { points: frame.points, entries: &entries, ratios: point.ratios };
                self.share.commit(&cell, &at, &mut history);
                Some(history)
            };
            for entries in frame.interpolation.entries::<K>(cell_points) {
                out.add(entries.point, count, |internal| new(entries, internal));
            }
            out
        };
        Some(Update(frame.interpolation.filled.par_iter().map(of_cell).collect()))
    }
}
