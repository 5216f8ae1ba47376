//! Materials that change as a phase begins (docs/theory.md, section 9, *Change of material*): the state of the points of a region.
//!
//! Stress and excess pore pressure are kept: the points get the elastic strain of the new material, and the value of the pressure field, that
//! belong to them. Deformation, volume and accumulated plastic strain are kept, too. The mass becomes that of the new density. Internal
//! variables are kept if they are the same quantity in both models, and are set to their initial value otherwise.

use crate::material::{Model, Profile, RandomStrength, spatial};
use crate::points::Points;
use crate::term::MixedPressure;
use std::fmt;
use std::sync::Arc;

/// A material that a region takes as a phase begins.
#[derive(Clone)]
pub struct Change {
    /// Index into the regions of the mesh, and its name.
    pub region: u16,
    pub of: String,
    /// The number of the material among those of the scene ([`Points::model_of`]), and its name.
    pub number: u16,
    pub into: String,
    /// The model of the whole stress, and the part of it that the pressure field carries.
    pub model: Arc<dyn Model>,
    pub carried: Option<MixedPressure>,
    /// What the field carried before.
    pub before: Option<MixedPressure>,
    /// Density (t/m³).
    pub density: Profile,
    /// The field of its strength, if that varies at random.
    pub random_strength: Option<Arc<RandomStrength>>,
    /// Whether the model has the internal variables of the one before.
    pub goes_on: bool,
}

impl fmt::Debug for Change {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Change").field("of", &self.of).field("into", &self.into).finish_non_exhaustive()
    }
}

impl Change {
    /// The points of the region among `points`.
    pub fn of<'a, const D: usize>(&self, points: &'a Points<D>) -> impl Iterator<Item = usize> + use<'a, D> {
        let region = self.region;
        (0..points.len()).filter(move |&p| points.region[p] == region)
    }

    /// Gives the points of the region the material.
    pub fn apply<const D: usize>(&self, points: &mut Points<D>) {
        if points.model.is_empty() {
            points.model.clone_from(&points.region);
        }
        let numbers: Vec<usize> = self.of(points).collect();
        for p in numbers {
            let y = points.seeded_height(p);
            let volume_ratio = points.deformation[p].determinant();
            // In undrained soil the pressure field contains the excess pore pressure.
            let shares = |carried: &&MixedPressure| carried.water > 0.0;
            let pore_pressure = self.before.as_ref().filter(shares).map_or(0.0, |c| c.pore_pressure(points, p));
            let kirchhoff = points.stress[p].map(|s| volume_ratio * s);
            points.elastic[p] = spatial::elastic_from_stress(self.model.as_ref(), y, &kirchhoff);
            if !points.pressure.is_empty() {
                points.pressure[p] = self.carried.as_ref().map_or(0.0, |carried| {
                    if shares(&carried) {
                        carried.held(points, p) - volume_ratio * pore_pressure
                    } else {
                        carried.begin(self.model.as_ref(), points, p)
                    }
                });
            }
            if !self.goes_on {
                points.begin_internal(p, self.model.as_ref());
            }
            points.mass[p] = self.density.at(y) * points.initial_volume[p];
            points.model[p] = self.number;
            if !points.strength.is_empty() {
                points.strength[p] = self.random_strength.as_ref().map_or(1.0, |field| field.factor(&points.origin[p]));
            }
        }
    }
}
