//! A penalty on jumps of the strain across the faces of cells that hold too little material to stand alone
//! (Burman 2010, *Ghost penalty*): such a cell then continues the polynomial of its neighbour, and its nodes are
//! as stiff as the material however thin the sliver in it.
//!
//! `γ E_f ∫ (h [∂_n Δu]² + h³ [∂_nn Δu]²)` on the increment of the step, for each component. It is free of stress
//! at the beginning of every step and leaves alone what is one polynomial over both cells, rigid motion included.
//!
//! `E_f` is the harmonic mean of Young's modulus over the points of both cells, by volume: soft material beside
//! stiff decides. Soil that flows must not be held by more than it bears itself: the penalty is the slope of the energy
//! `γ E_f j₀² (√(1 + j²/j₀²) − 1)` in the mean jump `j` of the face, quadratic in small jumps and linear in large ones, with
//! `γ E_f j₀ = κ t`. `t` measures the shear strength: the harmonic mean over the points of `q/√3 + ⟨−f⟩/2`, `f` being the yield function. Soil with friction
//! counts in `E_f` with no more than `100 t`, its secant stiffness at a strain of one per cent: near a free surface `t` is a hundred-thousandth of its
//! stiffness, and a penalty that turns from one to the other within that strain is a kink that Newton's method does not get across. Without
//! κ, what yielded in the last step counts with its secant stiffness, `E c τ/(G Δγ)`, from its shear stress `τ` and plastic shear
//! strain `Δγ`, so that what the penalty resists with is of the order `γ c τ` whatever the step.

use super::{Assembly, Frame, GhostFace, Source, Term, Trial};
use crate::error::Result;
use crate::interpolation::{Jump, Jumps};
use crate::kinematics::Kinematics;
use crate::material::{Model, spectral};
use crate::points::Points;
use crate::system::Local;
use crate::tensor::deviatoric;
use std::marker::PhantomData;
use std::sync::Arc;

/// Part `c` (-) of the shear strength that the penalty may resist flow with, times `γ`, where there is no κ.
const SECANT: f64 = 0.005;

/// Least part (-) of its elastic stiffness that a yielding point counts with there, also where it bears no stress.
const LEAST_SECANT: f64 = 1e-4;

/// The jump (-) at which the penalty beside soil with friction saturates, times `κ/γ`, or more.
const FLOWING: f64 = 0.01;

/// The least shear stress (-), over Young's modulus, that it is measured by, for soil that has none and bears none.
const LEAST: f64 = 1e-5;

/// The penalty of a face.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FacePenalty {
    /// `γ E_f` (kPa).
    pub stiffness: f64,
    /// `κ t` (kPa), at which it saturates; infinite without κ.
    pub limit: f64,
}

impl FacePenalty {
    /// What the form of a face counts with where the mean square of its jumps is `square`: the form itself, and in the tangent the
    /// product of the forces of a unit with themselves, over the measure (m²) of the face and its cells.
    fn factors(&self, square: f64) -> [f64; 2] {
        let over = self.stiffness / self.limit;
        let share = 1.0 / (1.0 + square * over * over).sqrt();
        [self.stiffness * share, -self.stiffness * (share * over).powi(2) * share]
    }
}

/// The penalty of all faces that take one.
pub struct GhostPenalty<K> {
    /// γ (-).
    factor: f64,
    /// κ (-), where there is one.
    share: Option<f64>,
    /// The model of each material by number; `None` where a region holds no points.
    models: Vec<Option<Arc<dyn Model>>>,
    jumps: Jumps,
    kinematics: PhantomData<K>,
}

impl<K> GhostPenalty<K> {
    /// `factor` is γ (-), `models[m]` that of material `m` ([`Points::model_of`]), `faces` the number of inner faces of
    /// the mesh.
    pub fn new(factor: f64, models: Vec<Option<Arc<dyn Model>>>, faces: usize) -> Self {
        Self { factor, share: None, models, jumps: Jumps::new(faces), kinematics: PhantomData }
    }

    /// With saturation, by κ (-): the part of its shear strength that the penalty may resist flowing soil with.
    #[must_use]
    pub fn saturating(self, share: f64) -> Self {
        Self { share: Some(share), ..self }
    }

    /// The penalty of a face; none where nothing beside it is summed over.
    pub fn of_face<const D: usize>(&self, frame: &Frame<D>, face: &GhostFace) -> Option<FacePenalty>
    where
        K: Kinematics<D>,
    {
        let (mut volume, mut compliance, mut weakness) = (0.0, 0.0, 0.0);
        for cell in face.between.cells {
            for &p in frame.interpolation.points_in(cell) {
                let p = p as usize;
                let Some(model) = frame.points.by_material(p, &self.models) else {
                    continue;
                };
                let (v, young) = (frame.points.initial_volume[p], model.young(frame.points.seeded_height(p)));
                volume += v;
                match self.share {
                    None => compliance += v / (young * secant(frame.points, p, model.as_ref())),
                    Some(_) => {
                        let strength = strength(frame.points, p, model.as_ref()).max(LEAST * young);
                        let most = if model.has_friction() { strength / FLOWING } else { young };
                        compliance += v / young.min(most);
                        weakness += v / strength;
                    }
                }
            }
        }
        let penalty = FacePenalty {
            stiffness: self.factor * volume / compliance,
            limit: self.share.map_or(f64::INFINITY, |share| share * volume / weakness),
        };
        (volume > 0.0).then_some(penalty)
    }
}

/// The measure `q/√3 + ⟨−f⟩/2` (kPa) of the shear strength at point `p`.
fn strength<const D: usize>(points: &Points<D>, p: usize, model: &dyn Model) -> f64 {
    let lacks =
        -model.yield_excess(points.seeded_height(p), &spectral::roots(&points.stress[p]), &points.state(p, 0.0));
    deviatoric(&points.stress[p]) / 3f64.sqrt() + 0.5 * lacks.max(0.0)
}

/// What part of its elastic stiffness a point had in the last step.
fn secant<const D: usize>(points: &Points<D>, p: usize, model: &dyn Model) -> f64 {
    let flow = points.plastic_increment.get(p).copied().unwrap_or(0.0);
    if flow <= 0.0 {
        return 1.0;
    }
    // With τ = q/√3 and Δγ = √3 Δε_p, both of which are the shear stress and strain in shear.
    let modulus = model.elasticity().at(points.seeded_height(p)).shear;
    (SECANT * deviatoric(&points.stress[p]) / (3.0 * modulus * flow)).clamp(LEAST_SECANT, 1.0)
}

impl<const D: usize, K: Kinematics<D>> Term<D> for GhostPenalty<K> {
    fn source(&self) -> Source {
        Source::Penalty
    }

    fn penalises_faces(&self) -> bool {
        true
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let factors = |face: &GhostFace, jump: &Jump, square: f64| {
            let Some(penalty) = self.of_face::<D>(frame, face) else { return [0.0; 3] };
            let [form, product] = penalty.factors(square / jump.measure);
            [form, (1.0 - trial.alpha_f) * form, (1.0 - trial.alpha_f) * product / jump.measure]
        };
        let increment = |n: usize| std::array::from_fn(|k| trial.between[n][k] - trial.converged[n][k]);
        penalise::<D, K>(frame, &self.jumps, factors, increment, out)
    }
}

/// Adds the penalty on the jumps of a nodal field, `value` by node. `factors` of a face, given its form and that of the field, are what
/// the form counts with in the force and in the tangent, and what the product of the forces of a unit with themselves counts with there.
pub(super) fn penalise<const D: usize, K: Kinematics<D>>(
    frame: &Frame<D>,
    jumps: &Jumps,
    factors: impl Fn(&GhostFace, &Jump, f64) -> [f64; 3] + Sync,
    value: impl Fn(usize) -> [f64; D] + Sync,
    out: &mut Assembly,
) -> Result<()> {
    let compute = |ghost: &GhostFace, local: &mut Local| {
        let fresh = frame.relaxed.then(|| Jump::of::<D, K>(frame.mesh, &ghost.between));
        let jump = fresh.as_ref().unwrap_or_else(|| jumps.of::<D, K>(frame.mesh, &ghost.between, ghost.face));
        let form = &jump.form;
        let count = local.size / D;
        let mut square = 0.0;
        for (b, n) in ghost.between.nodes(frame.mesh).enumerate() {
            let value = value(n as usize);
            for a in 0..count {
                for k in 0..D {
                    local.vector[a * D + k] += form[a * count + b] * value[k];
                }
            }
        }
        for (a, n) in ghost.between.nodes(frame.mesh).enumerate() {
            let value = value(n as usize);
            square += (0..D).map(|k| local.vector[a * D + k] * value[k]).sum::<f64>();
        }
        let [force, slope, product] = factors(ghost, jump, square);
        if !local.matrix.is_empty() {
            for (a, row) in form.chunks_exact(count).enumerate() {
                for (b, form) in row.iter().enumerate() {
                    for k in 0..D {
                        local.matrix[(a * D + k) * local.size + b * D + k] = slope * form;
                    }
                }
            }
            if product != 0.0 {
                for (row, own) in local.matrix.chunks_exact_mut(local.size).zip(local.vector.iter()) {
                    row.iter_mut().zip(local.vector.iter()).for_each(|(entry, other)| *entry += product * own * other);
                }
            }
        }
        local.vector.iter_mut().for_each(|unit| *unit *= force);
        Ok(())
    };
    out.scatter(frame.pattern, frame.ghost, |ghost| ghost.coupling as usize, compute)
}
