//! Which materials leave a part of their stress to the pressure field, and how much.

use super::check::Checker;
use super::locate::{At, Path};
use super::raw;
use crate::material::{Kind, Model, Profile, cavitation};
use crate::term::MixedPressure;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Poisson's ratio from which on a material is left to the pressure field unasked: above it cells of second order
/// with many points lock.
const NEARLY_INCOMPRESSIBLE: f64 = 0.45;
/// The same for soil whose yield knows the mean stress. It need not keep its volume as it flows, and locks less; nearer to one half the displacements
/// alone leave it so badly conditioned that no equilibrium is found long before its limit load.
const DILATES: f64 = 0.495;
/// Bulk modulus that the points keep, over the shear modulus (-). With 16 points a cell it is a bound of its own where
/// soil flows: on 8 cells a rough strip footing is 1.3 % stronger with that of Poisson's ratio 0.3 than with this
/// (`general_position::what_the_points_keep…`). With less, single points in cut cells of a moving body have nothing that keeps their volume.
const KEPT: f64 = 1e-3;

/// Bulk modulus over shear modulus.
pub(super) fn bulk(poisson: f64) -> f64 {
    2.0 * (1.0 + poisson) / (3.0 * (1.0 - 2.0 * poisson))
}

impl Checker {
    /// Whether the pores of a material are drained. One that is nearly incompressible in total stress has water in its pores that does not leave.
    pub(super) fn drains(material: &raw::Material, model: &Arc<dyn Model>) -> bool {
        let drained = || model.elasticity().poisson() < NEARLY_INCOMPRESSIBLE;
        material.drainage.map_or_else(drained, |drainage| drainage == raw::Drainage::Drained)
    }

    /// What the pressure field carries of a material; `build` makes its model with other parameters.
    pub(super) fn carried(
        &mut self,
        material: &raw::Material,
        kind: &Kind,
        model: &Arc<dyn Model>,
        values: &BTreeMap<&str, Profile>,
        pressure: Option<raw::Pressure>,
        path: &Path,
    ) -> Option<MixedPressure> {
        let poisson = model.elasticity().poisson();
        if material.drainage == Some(raw::Drainage::Undrained) && has_water_of_its_own(material) {
            if values.contains_key(cavitation::NAME) {
                let problem = "the limit is one of the whole stress, and the water of this soil has a pressure field of its own without a limit";
                let remedy =
                    "take `permeability` out of the material: its water then stays, and cavitates with the soil";
                self.issue(&path.key(cavitation::NAME), At::Key, problem, remedy);
            }
            // A skeleton that yields locks as well as one that is nearly incompressible.
            let split = match pressure {
                Some(raw::Pressure::None) => false,
                Some(raw::Pressure::Field) => true,
                None => poisson >= NEARLY_INCOMPRESSIBLE || model.yields(),
            };
            let ratio = bulk(poisson) - KEPT;
            let split = split && kind.keeps_volume && ratio > KEPT;
            return split.then(|| deviatoric(kind, values, poisson)).flatten().map(|model| MixedPressure {
                model,
                ratio,
                water: 0.0,
                bound: None,
                limit: None,
            });
        }
        if material.drainage == Some(raw::Drainage::Undrained) {
            if pressure == Some(raw::Pressure::None) {
                let remedy = "take `pressure: none` out of `numerics`, or `drainage` out of the material";
                self.issue(&path.key("drainage"), At::Value, "an undrained material needs the pressure field", remedy);
                return None;
            }
            let undrained = self.undrained_poisson(material, model, path)?;
            let water = bulk(undrained) - bulk(poisson);
            if !kind.keeps_volume {
                let model = model.clone();
                return Some(MixedPressure { model, ratio: water, water: 1.0, bound: Some(KEPT), limit: None });
            }
            let ratio = bulk(undrained) - KEPT;
            let (model, limit) = (deviatoric(kind, values, poisson)?, share(values, ratio));
            return Some(MixedPressure { model, ratio, water: water / ratio, bound: None, limit });
        }
        self.drained_material(material, path);
        if material.undrained_poisson.is_some() {
            let problem = "a drained material has no `undrained_poisson`";
            self.issue(&path.key("undrained_poisson"), At::Key, problem, "take it out, or set `drainage: undrained`");
        }
        let least = match pressure {
            Some(raw::Pressure::None) => return None,
            Some(raw::Pressure::Field) => f64::NEG_INFINITY,
            None => NEARLY_INCOMPRESSIBLE,
        };
        if !kind.keeps_volume {
            // Yield knows the mean stress: the field has the whole of it, and the points see its volume strain.
            let model = model.clone();
            let whole = MixedPressure { model, ratio: 0.0, water: 0.0, bound: Some(KEPT), limit: None };
            return (poisson >= DILATES).then_some(whole);
        }
        if poisson < least || bulk(poisson) <= 2.0 * KEPT {
            return None;
        }
        let model = deviatoric(kind, values, poisson)?;
        let ratio = bulk(poisson) - KEPT;
        Some(MixedPressure { model, ratio, water: 0.0, bound: None, limit: share(values, ratio) })
    }
}

/// What of the limit of the mean tension the field bears with a bulk modulus of `ratio` (-), in shear moduli, beside that of the points.
fn share(values: &BTreeMap<&str, Profile>, ratio: f64) -> Option<Profile> {
    values.get(cavitation::NAME).map(|limit| limit.scaled(ratio / (ratio + KEPT)))
}

/// The model with the same shear modulus and nearly no bulk modulus, and no limit of its mean stress.
fn deviatoric(kind: &Kind, values: &BTreeMap<&str, Profile>, poisson: f64) -> Option<Arc<dyn Model>> {
    let of_points = (3.0 * KEPT - 2.0) / (6.0 * KEPT + 2.0);
    let mut values = values.clone();
    values.remove(cavitation::NAME);
    let stretch = (1.0 + of_points) / (1.0 + poisson);
    if let Some(young) = values.get_mut("young") {
        *young = young.scaled(stretch);
    }
    values.insert("poisson", Profile::constant(of_points));
    super::materials::build(kind, &values).ok()
}

/// Whether the pressure of the water is a field of its own, and no share of one with the skeleton.
pub(super) fn has_water_of_its_own(material: &raw::Material) -> bool {
    material.permeability.is_some() || material.porosity.is_some() || material.water_bulk_modulus.is_some()
}
