//! What is fitted of the state of material points, and the state that a model can have near it.

use crate::kinematics::Kinematics;
use crate::material::spatial::elastic_from_stress;
use crate::material::{Model, RandomStrengths, State, Variable, internal_count, spectral, strength_at};
use crate::points::Points;
use crate::tensor::{Symmetric, mean};
use rayon::prelude::*;
use std::marker::PhantomData;
use std::sync::Arc;

/// What is fitted beside the internal variables: stress xx, yy, zz, xy; ln J; density; plastic strain, and what the last step added to it; the
/// velocity and the acceleration; the pressure of the field, the mean stress beside that of the model and the pore pressure; the place when seeded.
pub const FIELDS: usize = 17;
pub type Fields = [f64; FIELDS];
pub const STRESS: usize = 0;
pub const VOLUME: usize = 4;
pub const DENSITY: usize = 5;
pub const PLASTIC: usize = 6;
pub const FLOW: usize = 7;
pub const VELOCITY: usize = 8;
pub const ACCELERATION: usize = 10;
pub const PRESSURE: usize = 12;
pub const BESIDE: usize = 13;
pub const WATER: usize = 14;
pub const ORIGIN: usize = 15;

/// Those that stay within the range of the points.
pub const BOUNDED: std::ops::Range<usize> = DENSITY..VELOCITY;

/// The model of each material by number.
pub type Models = Vec<Option<Arc<dyn Model>>>;

/// The models that answer for the state of points.
pub struct Materials<K> {
    models: Models,
    /// The fields of their strength.
    strengths: RandomStrengths,
    kinematics: PhantomData<K>,
}

impl<K: Kinematics<2>> Materials<K> {
    pub fn new(models: Models) -> Self {
        Self { models, strengths: Vec::new(), kinematics: PhantomData }
    }

    /// Lets the strength of materials vary at random, given the fields by number.
    pub fn varying(self, strengths: RandomStrengths) -> Self {
        Self { strengths, ..self }
    }

    /// The strength over that of the parameters (-) of soil that was seeded at a place (m).
    pub fn strength(&self, model: usize, seeded: &[f64; 2]) -> f64 {
        strength_at(&self.strengths, model, seeded)
    }

    /// Gives point `p`, which has been seeded elsewhere by now, its strength.
    pub fn vary(&self, points: &mut Points<2>, p: usize) {
        if !points.strength.is_empty() {
            points.strength[p] = self.strength(points.model_of(p), &points.origin[p]);
        }
    }

    /// The internal variables of a model.
    pub fn internal_variables(&self, model: usize) -> &[Variable] {
        self.models.get(model).and_then(Option::as_ref).map_or(&[], |model| model.internal_variables())
    }

    /// The elastic left Cauchy–Green tensor and the stress (kPa) that a model can have near the given fields and internal variables, with a strength
    /// over that of the parameters (-).
    pub fn state(
        &self,
        model: usize,
        fields: &Fields,
        internal: &[f64],
        strength: f64,
    ) -> Option<(Symmetric, Symmetric)> {
        let kirchhoff = [fields[0], fields[1], fields[2], fields[3], 0.0, 0.0];
        let state = State { plastic_strain: fields[PLASTIC], internal, strength, ..State::default() };
        let y = fields[ORIGIN + 1];
        let model = self.models.get(model)?.as_ref()?;
        let elastic = elastic_from_stress(model.as_ref(), y, &kirchhoff);
        // The return changes the stress alone.
        let mut after = vec![0.0; internal.len().max(internal_count(model.as_ref()))];
        let answer = K::respond(model.as_ref(), y, &elastic, &state, &mut after)?;
        let volume_ratio = fields[VOLUME].exp();
        let mut stress = answer.kirchhoff.map(|t| t / volume_ratio);
        stress[..3].iter_mut().for_each(|s| *s += fields[BESIDE] / volume_ratio);
        Some((answer.elastic, stress))
    }

    /// What is fitted of each of some points.
    pub fn all(&self, points: &Points<2>) -> Vec<Fields> {
        (0..points.len()).into_par_iter().with_min_len(256).map(|p| self.fields(points, p)).collect()
    }

    /// What is fitted of point `p`.
    pub fn fields(&self, points: &Points<2>, p: usize) -> Fields {
        let at = |column: &[f64], p: usize| column.get(p).copied().unwrap_or(0.0);
        let volume_ratio = points.deformation[p].determinant();
        let mut fields = [0.0; FIELDS];
        fields[VOLUME] = volume_ratio.ln();
        fields[DENSITY] = points.mass[p] / points.initial_volume[p];
        fields[PLASTIC] = points.plastic_strain[p];
        fields[FLOW] = at(&points.plastic_increment, p);
        fields[PRESSURE] = at(&points.pressure, p);
        fields[WATER] = at(&points.pore_pressure, p);
        fields[ORIGIN..].copy_from_slice(&points.origin[p]);
        for (first, motion) in [(VELOCITY, &points.velocity), (ACCELERATION, &points.acceleration)] {
            fields[first..first + 2].copy_from_slice(motion.get(p).unwrap_or(&[0.0; 2]));
        }
        if let Some(model) = points.by_material(p, &self.models) {
            let y = points.seeded_height(p);
            let stress = |b: &[f64; 3]| model.elastic_stress(y, &b.map(|b| 0.5 * b.ln()));
            let stress = spectral::map_roots(&points.elastic[p], stress);
            fields[STRESS..STRESS + 4].copy_from_slice(&stress[..4]);
            if !points.pressure.is_empty() {
                fields[BESIDE] = volume_ratio * mean(&points.stress[p]) - mean(&stress);
            }
        }
        fields
    }
}
