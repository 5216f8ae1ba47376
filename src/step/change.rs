//! Materials that change as a phase begins (docs/theory.md, section 9, *Change of material*): the state of the points of a region.
//!
//! Stress and excess pore pressure are kept: the points get the elastic strain of the new material, and the value of the pressure field, that
//! belong to them. Deformation, volume and accumulated plastic strain are kept, too. The mass becomes that of the new density. Internal
//! variables are kept if they are the same quantity in both models, and are set to their initial value otherwise.

use crate::material::{Model, Profile, RandomStrength, spatial};
use crate::points::Points;
use crate::term::{MixedPressure, Porous};
use std::fmt;
use std::sync::Arc;

/// The material of a region, or that it takes as a phase begins.
#[derive(Clone)]
pub struct Material {
    pub name: String,
    /// The name of its model.
    pub model_name: String,
    /// Density (t/m³).
    pub density: Profile,
    pub model: Arc<dyn Model>,
    /// The field of its strength, where that varies at random.
    pub random_strength: Option<Arc<RandomStrength>>,
    /// What the pressure field carries of its stress.
    pub carried: Option<MixedPressure>,
    /// The water in its pores, where that flows or has a stiffness of its own.
    pub porous: Option<Porous>,
    /// Whether its pores are drained, so that they take the water of undrained soil beside it.
    pub drains: bool,
}

impl Material {
    /// Whether the excess pressure of its pore water is found.
    pub fn has_pore_pressure(&self) -> bool {
        self.porous.is_some() || self.carried.as_ref().is_some_and(|carried| carried.water > 0.0)
    }

    /// Whether it has a density anywhere.
    pub fn has_mass(&self) -> bool {
        self.density.top > 0.0 || self.density.gradient > 0.0
    }
}

impl fmt::Debug for Material {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Material").field("name", &self.name).field("density", &self.density).finish_non_exhaustive()
    }
}

/// A material that a region takes as a phase begins.
#[derive(Clone, Debug)]
pub struct Change {
    /// Index into the regions of the mesh, and its name.
    pub region: u16,
    pub of: String,
    /// The number of the material among those of the scene ([`Points::model_of`]).
    pub number: u16,
    pub into: Material,
    /// The material before.
    pub before: Option<Material>,
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
        let Self { into, before, .. } = self;
        let carried_before = before.as_ref().and_then(|before| before.carried.as_ref());
        // The same model has the same internal variables.
        let keeps_internal = before.as_ref().is_some_and(|before| before.model_name == into.model_name);
        let numbers: Vec<usize> = self.of(points).collect();
        for p in numbers {
            let y = points.seeded_height(p);
            let volume_ratio = points.deformation[p].determinant();
            // In undrained soil the pressure field contains the excess pore pressure.
            let shares = |carried: &&MixedPressure| carried.water > 0.0;
            let pore_pressure = carried_before.filter(shares).map_or(0.0, |c| c.pore_pressure(points, p));
            let kirchhoff = points.stress[p].map(|s| volume_ratio * s);
            points.elastic[p] = spatial::elastic_from_stress(into.model.as_ref(), y, &kirchhoff);
            if !points.pressure.is_empty() {
                points.pressure[p] = into.carried.as_ref().map_or(0.0, |carried| {
                    if shares(&carried) {
                        carried.held(points, p) - volume_ratio * pore_pressure
                    } else {
                        carried.begin(into.model.as_ref(), points, p)
                    }
                });
            }
            if !keeps_internal {
                points.begin_internal(p, into.model.as_ref());
            }
            points.mass[p] = into.density.at(y) * points.initial_volume[p];
            points.model[p] = self.number;
            if !points.strength.is_empty() {
                points.strength[p] = into.random_strength.as_ref().map_or(1.0, |field| field.factor(&points.origin[p]));
            }
        }
    }
}
