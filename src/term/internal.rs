//! Internal force: `f_I = Σ_q w_q τ_q · ∇_x N_I`, with its consistent tangent. The sum is over the integration points, or over the material points
//! with `w = V⁰` where integrals are summed over these.
//!
//! Kinematics: `F = I + Σ u ⊗ ∇N` from the restored grid, the increment since the last converged step
//! `ΔF = F F_n⁻¹`, the elastic trial `b = ΔF b_n ΔFᵀ` (theory, eq. 2). The term keeps no state: the points
//! carry it, and it is written only on convergence.
//!
//! With inertia the stress within the step acts on the configuration within it: in place of `τ` stands `A W`,
//! `A = (1 − α_f) I + α_f ΔF⁻¹`. The metric within the step is `C = (1 − α_f) ΔFᵀΔF + α_f I = HᵀH`, and the model
//! responds to `H̃ b_n H̃ᵀ`, `H̃` being `H` with the volume of the step, with the stress `τ_H`, so that `W = Q τ_H Qᵀ`,
//! `Q = ΔF H⁻¹` (theory, eq. 7 and 8). `A W Aᵀ` being symmetric, the forces have no moment about the positions within the step; a rotation leaves `C = I`; and
//! soil that yields dissipates, for the stress within the step is one that it can bear. Where it does not yield, to it is added
//! what makes its work that which the step stores (`internal/energy.rs`).
//!
//! A [`Mixed`] of the stress may be carried by unknowns of its own; it is a type, so that a scene without one pays
//! nothing.

mod dissipation;
mod energy;
mod strain;

use super::extended::{Kept, scatter_functions};
use super::mixed::{Acting, Answer, Coupling, FieldVolumeStrain, ModelInput, Point};
use super::smoothed::{self, Layout};
use super::stiffness::{Stiffness, add_turning};
use super::volume::VolumeFit;
use super::{Assembly, Dissipated, Frame, Histories, History, Term, Trial, Update};
use super::{Mixed, Ratios};
use crate::error::{Error, Result};
use crate::interpolation::{CellPoints, Entries, Interpolation, MAX_FUNCTIONS};
use crate::kinematics::{Gradient, Kinematics};
use crate::material::spatial::Spatial;
use crate::material::{Model, State, internal_count};
use crate::points::Points;
use crate::profile::timed_material;
use crate::system::Local;
use crate::tensor::{full, symmetric};
use dissipation::Yielded;
use energy::Work;
use rayon::prelude::*;
use std::borrow::Cow;
use std::marker::PhantomData;
use std::sync::Arc;
use strain::{Ends, Strained, inadmissible, metric_factor, moved_nodes, strain};

/// The least part (-) of the volume of the material points in a cell that its integration points stand for, if they resist a change of that volume.
const RESISTS: f64 = 0.05;

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

/// Deformations of the points of a cell and the answers of their models, in order.
type Evaluated<K, const D: usize> = (Vec<Strained>, Vec<Answer<K, D>>);

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

    /// The answer of the model at a point, given the rate (1/s) of steps, the weight of the end of the step and the stiffening of the tangent, with its
    /// internal variables at the end of the step in `internal`.
    fn answer<const D: usize>(
        &self,
        models: &[Option<Arc<dyn Model>>],
        (points, entries): (&Points<D>, &Entries<D>),
        cell: &S::Cell,
        strained: &Strained,
        (inverse_dt, end_weight, stiffening): (f64, f64, f64),
        internal: &mut [f64],
    ) -> Result<Answer<K, D>>
    where
        K: Kinematics<D>,
        S: Mixed<D, K>,
    {
        let p = entries.point;
        let metric_factor = &strained.metric_factor;
        let of_step = end_weight < 1.0 && self.share.has_step_volume(points, p);
        let factor = if of_step { strained.with_volume::<D, K>(end_weight) } else { *metric_factor };
        let trial = symmetric(&(factor * full(&points.elastic[p]) * factor.transpose()));
        let Some(model) = points.by_material(p, models) else {
            return Err(Error::analysis(format!("material point {p}"), "it has no material", ""));
        };
        let state = State { stiffening, ..points.state(p, inverse_dt) };
        let input = ModelInput { model: model.as_ref(), trial, state, end_weight };
        let point = Point { points, entries, ratios: strained.ratios };
        let answer = self.share.respond(cell, &point, &input, internal);
        answer.ok_or_else(|| inadmissible(points, p, "is strained beyond measure", &strained.increment))
    }

    /// What a point that yields dissipates in a step (kPa), given the answer of its model to that.
    fn yielded<const D: usize>(
        &self,
        models: &[Option<Arc<dyn Model>>],
        (points, entries): (&Points<D>, &Entries<D>),
        cell: &S::Cell,
        (strained, end, field_strain): (&Strained, &Spatial<K::Tangent>, &Option<FieldVolumeStrain>),
        trial: &Trial<D>,
    ) -> f64
    where
        K: Kinematics<D>,
        S: Mixed<D, K>,
    {
        let Some(model) = points.by_material(entries.point, models) else { return 0.0 };
        let end_weight = 1.0 - trial.alpha_f;
        let within = (trial.alpha_f > 0.0).then(|| {
            let metric_factor = metric_factor(&strained.increment, trial.alpha_f)?;
            let within = Strained { metric_factor, ..*strained };
            let mut internal = vec![0.0; self.internal_count(points)];
            let rate = (trial.inverse_dt / end_weight, end_weight, 0.0);
            let (answer, _) = self.answer(models, (points, entries), cell, &within, rate, &mut internal).ok()?;
            Some((metric_factor, answer.elastic))
        });
        let within = within.flatten();
        let received = field_strain.as_ref().map(|field_strain| field_strain.received);
        let within = within.as_ref().map(|(factor, elastic)| (factor, elastic));
        let (model, increment, end) = (model.as_ref(), &strained.increment, &end.elastic);
        Yielded { model, increment, received, end, within }.dissipates(points, entries.point)
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
        let rate = (trial.inverse_dt / end_weight, end_weight, trial.stiffening);
        let mut answers = Vec::with_capacity(strained.len());
        timed_material(|| -> Result<()> {
            for (entries, strained) in frame.interpolation.entries::<K>(cell_points).zip(&strained) {
                answers.push(self.answer(models, (frame.points, &entries), cell, strained, rate, &mut internal)?);
            }
            Ok(())
        })?;
        Ok((strained, answers))
    }

    /// With inertia, the work that the model of a point has to do. A model that receives its volume strain from unknowns shares its work with them.
    fn work<const D: usize>(
        &self,
        models: &[Option<Arc<dyn Model>>],
        (points, entries): (&Points<D>, &Entries<D>),
        cell: &S::Cell,
        (strained, answer): (&Strained, &Answer<K, D>),
        (trial, internal): (&Trial<D>, &mut [f64]),
    ) -> Result<Option<Work>>
    where
        K: Kinematics<D>,
        S: Mixed<D, K>,
    {
        let Some(model) = points.by_material(entries.point, models).filter(|_| answer.1.is_none()) else {
            return Ok(None);
        };
        let whole = Strained { metric_factor: strained.increment, ..*strained };
        let rate = (trial.inverse_dt, 1.0, 0.0);
        let (end, _) = timed_material(|| self.answer(models, (points, entries), cell, &whole, rate, internal))?;
        Ok(energy::work::<D, K>(points, (entries.point, model.as_ref()), strained, &end, trial.alpha_f))
    }
}

/// The volume (m³) of the points of a cell.
fn filled<const D: usize>(interpolation: &Interpolation<D>, cell_points: &CellPoints, points: &Points<D>) -> f64 {
    let of_cell = &interpolation.points[cell_points.first_point as usize..][..cell_points.point_count as usize];
    of_cell.iter().map(|&p| points.volume(p as usize)).sum()
}

impl<const D: usize, K: Kinematics<D>, S: Mixed<D, K>> Term<D> for Internal<K, S> {
    fn symmetric(&self) -> bool {
        !self.dynamic && self.models.iter().flatten().all(|m| m.symmetric())
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
            let mut internal = vec![0.0; if trial.alpha_f > 0.0 { self.internal_count(frame.points) } else { 0 }];
            Stiffness::with::<D, _>(own, |stiffness| {
                let evaluated = strained.iter().zip(&mut answers);
                for (k, (entries, (point, answer))) in
                    frame.interpolation.entries::<K>(cell_points).zip(evaluated).enumerate()
                {
                    let at = Point { points: frame.points, entries: &entries, ratios: point.ratios };
                    let (stress, acting) = if trial.alpha_f > 0.0 {
                        let within = Point { ratios: point.within(), ..at };
                        let work = self.work(
                            &models,
                            (frame.points, &entries),
                            &cell,
                            (point, &*answer),
                            (trial, &mut internal),
                        )?;
                        let own = self.share.has_step_volume(frame.points, entries.point);
                        let of_stretch = own.then(|| K::stretched(&answer.0));
                        self.share.add(&cell, &within, end_weight, &mut answer.0);
                        let work = work.as_ref().map(|work| (work, self.share.work(&cell, &at, end_weight)));
                        energy::stress::<D, K>(point, trial.alpha_f, (answer, of_stretch), work)
                    } else {
                        self.share.add(&cell, &at, 1.0, &mut answer.0);
                        (full(&answer.0.kirchhoff), Acting::at_end(point.ratios))
                    };
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
                        Coupling { forces, strains, field_strain: answer.1.as_ref(), acting: &acting, end_weight };
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

    fn has_friction(&self) -> bool {
        self.models.iter().flatten().any(|model| model.has_friction())
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
            let held = filled(frame.interpolation, cell_points, frame.points);
            let volume = frame.integration.map(|(interpolation, points)| {
                let cell_points = interpolation.of_cell(cell_points.cell)?;
                if filled(interpolation, cell_points, points) < RESISTS * held {
                    return None;
                }
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
                if let Some(None) = &volume {
                    // What resists nothing stores nothing: it would be pressed without a limit.
                    point.take_volume::<D, K>(Ratios { step: 1.0, ..point.ratios });
                } else if let Some(Some((of_step, of_grid))) = &volume {
                    let place = &frame.points.position[entries.point];
                    let before = of_grid.at(place).exp();
                    let by_law = self.share.volume_ratio(&cell, frame.points, &entries, before);
                    let step = by_law.unwrap_or_else(|| of_step.at(place).exp());
                    point.take_volume::<D, K>(Ratios { step, grid: before * step });
                }
                let of_point = (frame.points, &entries);
                let step = (trial.inverse_dt, 1.0, 0.0);
                let (answer, field_strain) = self.answer(&models, of_point, &cell, &point, step, internal).ok()?;
                let at = Point { points: frame.points, entries: &entries, ratios: point.ratios };
                let dissipated = Dissipated {
                    plastic: if answer.yielding && frame.integration.is_none() {
                        entries.weight * self.yielded(&models, of_point, &cell, (&point, &answer, &field_strain), trial)
                    } else {
                        0.0
                    },
                    seepage: self.share.seepage(&cell, &at, dissipation::end_weight(trial.alpha_f)),
                };
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
                    dissipated,
                };
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
