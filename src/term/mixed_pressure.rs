//! What the pressure field carries of the stress of a material.

use crate::material::cavitation::Volumetric;
use crate::material::{Model, Profile};
use crate::points::Points;
use crate::tensor::{Symmetric, full, mean};
use std::fmt;
use std::sync::Arc;

/// What the field carries in a region.
#[derive(Clone)]
pub struct MixedPressure {
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

impl fmt::Debug for MixedPressure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("MixedPressure").field("ratio", &self.ratio).field("water", &self.water).finish_non_exhaustive()
    }
}

impl MixedPressure {
    /// Whether it carries the mean stress of soil without water: that which the model answers to its volume strain.
    pub(super) fn is_whole(&self) -> bool {
        self.bound.is_some() && self.ratio == 0.0
    }

    /// The law of the volume at a point seeded at height `y` (m): with `K_f`, and a limit where it has one.
    pub(super) fn law(&self, y: f64) -> Volumetric {
        let shear = self.model.elasticity().at(y).shear;
        let bulk = self.ratio * shear;
        let limited = |limit: Profile| Volumetric::of(self.model.as_ref(), bulk, limit.at(y), y);
        self.limit.map_or_else(|| Volumetric::unlimited(bulk), limited)
    }

    /// `1 / 2G` (1/kPa) at a point seeded at height `y` (m).
    pub(super) fn softness(&self, y: f64) -> f64 {
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
    pub(super) fn of_model<const D: usize>(&self, points: &Points<D>, p: usize) -> f64 {
        match self.bound {
            Some(_) => 0.0,
            None => self.model.mean_stress(points.seeded_height(p), volume_strain(&points.elastic[p])),
        }
    }

    /// Excess pressure of the pore water (kPa, Cauchy, compression positive) at point `p`.
    pub fn pore_pressure<const D: usize>(&self, points: &Points<D>, p: usize) -> f64 {
        (self.held(points, p) - points.pressure[p]) / points.deformation[p].determinant()
    }

    /// What the field begins with (kPa) at a point whose elastic tensor is that of `whole`, the model that answers for
    /// the whole stress.
    pub fn begin<const D: usize>(&self, whole: &dyn Model, points: &Points<D>, p: usize) -> f64 {
        whole.mean_stress(points.seeded_height(p), volume_strain(&points.elastic[p])) - self.of_model(points, p)
    }
}

/// Excess pressure of the pore water (kPa, Cauchy, compression positive) at point `p` of soil of which a pressure field carries the share of
/// the water, or that has a field for the water alone, or neither.
pub fn excess_pressure<const D: usize>(carried: &[Option<MixedPressure>], points: &Points<D>, p: usize) -> f64 {
    match points.by_material(p, carried) {
        Some(share) if share.water > 0.0 && !points.pressure.is_empty() => share.pore_pressure(points, p),
        _ => points.pore_pressure.get(p).copied().unwrap_or(0.0),
    }
}

/// Elastic volume strain `½ ln det b` (-).
pub(super) fn volume_strain(elastic: &Symmetric) -> f64 {
    0.5 * full(elastic).determinant().ln()
}
