//! A penalty on jumps of the strain across the faces of cells that hold too little material to stand alone
//! (Burman 2010, *Ghost penalty*): such a cell then continues the polynomial of its neighbour, and its nodes are
//! as stiff as the material however thin the sliver in it.
//!
//! `γ E_f ∫ (h [∂_n Δu]² + h³ [∂_nn Δu]²)` on the increment of the step, for each component. It is free of stress
//! at the beginning of every step and leaves alone what is one polynomial over both cells, rigid motion included.
//!
//! `E_f` is the harmonic mean of Young's modulus over the points of both cells, by volume: soft material beside
//! stiff decides. In plastic flow a penalty on increments would act as a viscosity far stiffer than the soil:
//! what yielded in the last step counts with its secant stiffness, `E c τ/(G Δγ)`, from its shear stress `τ` and
//! plastic shear strain `Δγ`, so that what the penalty resists with is of the order `γ c τ` whatever the step.

use super::{Assembly, Frame, GhostFace, Term, Trial};
use crate::error::{Error, Result};
use crate::kinematics::Kinematics;
use crate::material::Model;
use crate::points::Points;
use crate::stencil::{Jump, Jumps};
use crate::system::{Local, scatter};
use crate::tensor::deviatoric;
use std::marker::PhantomData;
use std::sync::Arc;

/// Part `c` (-) of the shear strength that the penalty may resist flow with, times `γ`.
const SECANT: f64 = 0.005;

/// Least part (-) of its elastic stiffness that a yielding point counts with, also where it bears no stress.
const LEAST: f64 = 1e-4;

/// The penalty of all faces that take one.
pub struct GhostPenalty<K> {
    /// γ (-).
    factor: f64,
    /// The model of each material by number; `None` where a region holds no points.
    models: Vec<Option<Arc<dyn Model>>>,
    jumps: Jumps,
    kinematics: PhantomData<K>,
}

impl<K> GhostPenalty<K> {
    /// `factor` is γ (-), `models[m]` that of material `m` ([`Points::model_of`]), `faces` the number of inner faces of
    /// the mesh.
    pub fn new(factor: f64, models: Vec<Option<Arc<dyn Model>>>, faces: usize) -> Self {
        Self { factor, models, jumps: Jumps::new(faces), kinematics: PhantomData }
    }

    /// `γ E_f` (kPa) of a face.
    ///
    /// # Errors
    /// When neither of its cells holds points with a material.
    pub fn stiffness<const D: usize>(&self, frame: &Frame<D>, face: &GhostFace) -> Result<f64> {
        let (mut volume, mut compliance) = (0.0, 0.0);
        for cell in face.between.cells {
            let Ok(patch) = frame.stencil.patches.binary_search_by_key(&cell, |patch| patch.cell) else { continue };
            for &p in frame.stencil.points(&frame.stencil.patches[patch]) {
                let p = p as usize;
                let Some(model) = self.models.get(frame.points.model_of(p)).and_then(Option::as_ref) else {
                    continue;
                };
                let v = frame.points.initial_volume[p];
                volume += v;
                compliance += v / (model.young(frame.points.origin[p][1]) * secant(frame.points, p, model.as_ref()));
            }
        }
        if compliance > 0.0 {
            Ok(self.factor * volume / compliance)
        } else {
            let [a, b] = face.between.cells;
            Err(Error::analysis(format!("the face between cells {a} and {b}"), "no material is beside it", ""))
        }
    }
}

/// What part of its elastic stiffness a point had in the last step.
fn secant<const D: usize>(points: &Points<D>, p: usize, model: &dyn Model) -> f64 {
    let flow = points.plastic_increment.get(p).copied().unwrap_or(0.0);
    if flow <= 0.0 {
        return 1.0;
    }
    // With τ = q/√3 and Δγ = √3 Δε_p, both of which are the shear stress and strain in shear.
    let modulus = model.elasticity().at(points.origin[p][1]).shear;
    (SECANT * deviatoric(&points.stress[p]) / (3.0 * modulus * flow)).clamp(LEAST, 1.0)
}

impl<const D: usize, K: Kinematics<D>> Term<D> for GhostPenalty<K> {
    fn penalises_faces(&self) -> bool {
        true
    }

    fn sees_flow(&self) -> bool {
        self.models.iter().flatten().any(|model| model.yields())
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let factors = |face: &GhostFace, _: &Jump| {
            let stiffness = self.stiffness(frame, face)?;
            Ok([stiffness, (1.0 - trial.alpha_f) * stiffness])
        };
        let increment = |n: usize| std::array::from_fn(|k| trial.between[n][k] - trial.converged[n][k]);
        penalise::<D, K>(frame, &self.jumps, factors, increment, out)
    }
}

/// Adds the penalty on the jumps of a nodal field, `value` by node: `factors` of a face are what its form counts with in the
/// force and in the tangent.
pub(super) fn penalise<const D: usize, K: Kinematics<D>>(
    frame: &Frame<D>,
    jumps: &Jumps,
    factors: impl Fn(&GhostFace, &Jump) -> Result<[f64; 2]> + Sync,
    value: impl Fn(usize) -> [f64; D] + Sync,
    out: &mut Assembly,
) -> Result<()> {
    let compute = |ghost: &GhostFace, local: &mut Local| {
        let fresh = frame.relaxed.then(|| Jump::of::<D, K>(frame.mesh, &ghost.between));
        let jump = fresh.as_ref().unwrap_or_else(|| jumps.of::<D, K>(frame.mesh, &ghost.between, ghost.face));
        let [force, slope] = factors(ghost, jump)?;
        let form = &jump.form;
        let count = local.size / D;
        for (b, n) in ghost.between.nodes(frame.mesh).enumerate() {
            let value = value(n as usize);
            for a in 0..count {
                for k in 0..D {
                    local.vector[a * D + k] += force * form[a * count + b] * value[k];
                }
            }
        }
        if local.matrix.is_empty() {
            return Ok(());
        }
        for (a, row) in form.chunks_exact(count).enumerate() {
            for (b, form) in row.iter().enumerate() {
                for k in 0..D {
                    local.matrix[(a * D + k) * local.size + b * D + k] = slope * form;
                }
            }
        }
        Ok(())
    };
    scatter(
        frame.pattern,
        frame.ghost,
        |ghost| ghost.clique as usize,
        compute,
        out.force,
        out.tangent.as_deref_mut(),
        out.workspace,
    )
}
