//! Cavitation: soil whose mean stress in tension has a limit, at which its volume grows.
//!
//! The mean Kirchhoff stress `τ` of the elastic volume strain `v` is Hencky's up to the limit `t`. Beyond it the soil is filled with voids at a mean
//! Cauchy stress that is nearly constant: with `J = exp v`, `v_t = t/K`, `J_t = exp v_t`,
//!
//! ```text
//! τ = K v   for v ≤ v_t,      τ = J [t/J_t + k (J − J_t)]   beyond,      k = 2 s_u
//! ```
//!
//! The law is elastic: it has an energy, is monotone, and the voids close as they opened; the stress alone tells their volume. The strengths of the
//! models are Kirchhoff stresses: soil that is stretched by voids loses `4/3 s_u/J` of what it bears beyond its mean stress. `k` makes up for more than that, or the
//! voids of soil in uniform tension would gather in one place. Models are those whose yield and flow do not know the mean stress.

use super::model::AT;
use super::{Elasticity, Model, Parameter, Parameters, Profile, Response, State, Variable};
use crate::error::{Error, Result};
use std::sync::Arc;

/// `k` over the shear strength (-): half as much again as makes up for the fall of the axial stress of confined soil that is stretched in one direction.
const RISE: f64 = 2.0;

/// Most of the bulk modulus (-) that the limit may be: well below the strain of one at which the Cauchy stress of Hencky's law has its maximum.
const LARGEST: f64 = 0.25;

/// The law of the mean Kirchhoff stress (kPa) at a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Volumetric {
    /// Bulk modulus K (kPa).
    pub bulk: f64,
    /// Limit `t` (kPa) of the mean stress in tension; infinite without.
    pub limit: f64,
    /// `k` (kPa).
    pub rise: f64,
}

impl Volumetric {
    /// That of soil with the strength of a model at height `y` (m), a bulk modulus and a limit (kPa).
    pub fn of(model: &dyn Model, bulk: f64, limit: f64, y: f64) -> Self {
        Self { bulk, limit, rise: RISE * model.shear_strength(y, &State::default()) }
    }

    /// Hencky's law with a bulk modulus (kPa).
    pub fn unlimited(bulk: f64) -> Self {
        Self { bulk, limit: f64::INFINITY, rise: 0.0 }
    }

    /// `J_t` (-), and the Cauchy stress (kPa) there.
    pub fn at_limit(&self) -> (f64, f64) {
        let ratio = (self.limit / self.bulk).exp();
        (ratio, self.limit / ratio)
    }

    /// The stress (kPa) of an elastic volume strain, and its slope (kPa).
    pub fn stress(&self, strain: f64) -> [f64; 2] {
        let elastic = self.bulk * strain;
        if elastic <= self.limit {
            return [elastic, self.bulk];
        }
        let ((least, cauchy), ratio) = (self.at_limit(), strain.exp());
        let stress = ratio * (cauchy + self.rise * (ratio - least));
        [stress, stress + self.rise * ratio * ratio]
    }

    /// The elastic volume strain of a stress (kPa), the inverse of [`Self::stress`], and its slope (1/kPa).
    pub fn strain(&self, stress: f64) -> [f64; 2] {
        if stress <= self.limit {
            return [stress / self.bulk, 1.0 / self.bulk];
        }
        // The positive root of `k J² + (t/J_t − k J_t) J = τ`, without cancellation.
        let (least, cauchy) = self.at_limit();
        let linear = cauchy - self.rise * least;
        let root = (linear * linear + 4.0 * self.rise * stress).sqrt();
        let ratio = if linear > 0.0 { 2.0 * stress / (linear + root) } else { (root - linear) / (2.0 * self.rise) };
        [ratio.ln(), 1.0 / (stress + self.rise * ratio * ratio)]
    }

    /// What a stress (kPa) stores (kPa): the work from none to it.
    pub fn energy(&self, stress: f64) -> f64 {
        if stress <= self.limit {
            return 0.5 * stress * stress / self.bulk;
        }
        let ((least, cauchy), [strain, _]) = (self.at_limit(), self.strain(stress));
        let more = strain.exp() - least;
        0.5 * self.limit * self.limit / self.bulk + cauchy * more + 0.5 * self.rise * more * more
    }
}

/// A model with a limit of the mean stress in tension.
pub struct Cavitating<M> {
    model: M,
    limit: Profile,
    /// [`Model::reduced`] of the model.
    reduced: fn(&M, f64) -> M,
}

/// The name of the limit among the parameters of a model.
pub const NAME: &str = "tension_limit";

/// The limit as a parameter of a model.
pub const PARAMETER: Parameter = Parameter {
    name: NAME,
    unit: "kPa",
    required: false,
    varies: true,
    meaning: "largest mean stress in tension, at which the soil cavitates: its volume grows and closes again; default: no limit",
};

/// `model`, that `reduced` divides the strengths of, with the limit that its parameters have, if they have one.
///
/// # Errors
/// Unless the limit is positive and less than a quarter of the bulk modulus, at its datum.
pub fn limited<M: Model + 'static>(
    model: M,
    reduced: fn(&M, f64) -> M,
    parameters: &Parameters,
) -> Result<Arc<dyn Model>> {
    match parameters.optional(NAME) {
        None => Ok(Arc::new(model)),
        Some(limit) => {
            let limited = Cavitating { model, limit, reduced };
            limited.check_limit(limit.datum)?;
            Ok(Arc::new(limited))
        }
    }
}

impl<M: Model> Cavitating<M> {
    fn law(&self, y: f64) -> Volumetric {
        Volumetric::of(&self.model, self.model.elasticity().at(y).bulk(), self.limit.at(y), y)
    }

    fn check_limit(&self, y: f64) -> Result<()> {
        self.limit.positive_at(NAME, y)?;
        let (limit, bulk) = (self.limit.at(y), self.model.elasticity().at(y).bulk());
        if limit < LARGEST * bulk {
            return Ok(());
        }
        let problem = format!("{limit} kPa is not below a quarter of the bulk modulus, {bulk:.4} kPa");
        Err(Error::input(NAME, problem, "lower it, or leave it out"))
    }
}

impl<M: Model + 'static> Model for Cavitating<M> {
    fn respond(&self, y: f64, trial: &[f64; 3], state: &State, internal: &mut [f64]) -> Response {
        let mut response = self.model.respond(y, trial, state, internal);
        let (law, strain) = (self.law(y), trial.iter().sum::<f64>());
        if law.bulk * strain > law.limit {
            let [stress, slope] = law.stress(strain);
            response.stress.iter_mut().for_each(|s| *s += stress - law.bulk * strain);
            response.tangent.iter_mut().flatten().for_each(|entry| *entry += slope - law.bulk);
        }
        response
    }

    fn yield_excess(&self, y: f64, stress: &[f64; 3], state: &State) -> f64 {
        self.model.yield_excess(y, stress, state)
    }

    fn is_at_tension_limit(&self, y: f64, stress: &[f64; 3], _state: &State) -> bool {
        stress.iter().sum::<f64>() / 3.0 >= (1.0 - AT) * self.limit.at(y)
    }

    fn elasticity(&self) -> &Elasticity {
        self.model.elasticity()
    }

    fn symmetric(&self) -> bool {
        self.model.symmetric()
    }

    fn internal_variables(&self) -> &[Variable] {
        self.model.internal_variables()
    }

    fn begin(&self, y: f64, internal: &mut [f64]) {
        self.model.begin(y, internal);
    }

    fn shear_strength(&self, y: f64, state: &State) -> f64 {
        self.model.shear_strength(y, state)
    }

    fn check(&self, y: f64) -> Result<()> {
        self.model.check(y)?;
        self.check_limit(y)
    }

    fn reduced(&self, factor: f64) -> Arc<dyn Model> {
        Arc::new(Self { model: (self.reduced)(&self.model, factor), ..*self })
    }

    fn mean_stress(&self, y: f64, volume_strain: f64) -> f64 {
        self.law(y).stress(volume_strain)[0]
    }

    fn bulk_modulus(&self, y: f64, mean: f64) -> f64 {
        1.0 / self.law(y).strain(mean)[1]
    }

    fn elastic_stress(&self, y: f64, strain: &[f64; 3]) -> [f64; 3] {
        let (law, volume) = (self.law(y), strain.iter().sum::<f64>());
        let lacks = law.stress(volume)[0] - law.bulk * volume;
        self.model.elastic_stress(y, strain).map(|s| s + lacks)
    }

    fn elastic_energy(&self, y: f64, strain: &[f64; 3]) -> f64 {
        let (law, volume) = (self.law(y), strain.iter().sum::<f64>());
        let [stress, _] = law.stress(volume);
        self.model.elastic_energy(y, strain) - 0.5 * law.bulk * volume * volume + law.energy(stress)
    }

    fn elastic_strain(&self, y: f64, stress: &[f64; 3]) -> [f64; 3] {
        let (law, mean) = (self.law(y), stress.iter().sum::<f64>() / 3.0);
        let more = law.strain(mean)[0] - mean / law.bulk;
        self.model.elastic_strain(y, stress).map(|e| e + more / 3.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAW: Volumetric = Volumetric { bulk: 8000.0, limit: 20.0, rise: 2.0 };

    #[test]
    fn stress_strain_slope_and_energy_agree() {
        let step = 1e-7;
        for strain in [-0.1, -1e-3, 0.0, 2e-3, 3e-3, 0.01, 0.3, 2.0] {
            let [stress, slope] = LAW.stress(strain);
            let [back, compliance] = LAW.strain(stress);
            assert!((back - strain).abs() < 1e-14 * (1.0 + strain.abs()), "{strain} {back}");
            assert!((compliance * slope - 1.0).abs() < 1e-12 && slope > 0.0, "{strain}");
            let [up, down] = [step, -step].map(|d| LAW.stress(strain + d)[0]);
            assert!(((up - down) / (2.0 * step) / slope - 1.0).abs() < 1e-6, "{strain}");
            let work = |d: f64| LAW.energy(LAW.stress(strain + d)[0]);
            assert!(
                ((work(step) - work(-step)) / (2.0 * step) - stress).abs() < 1e-5 * (1.0 + stress.abs()),
                "{strain}"
            );
        }
        // The Cauchy stress at the limit stays, but for `k (J − J_t)`.
        let (ratio, cauchy) = LAW.at_limit();
        for strain in [0.01f64, 0.3, 0.7] {
            let mean = LAW.stress(strain)[0] / strain.exp();
            assert!((mean - cauchy - LAW.rise * (strain.exp() - ratio)).abs() < 1e-12);
            assert!((mean / 20.0 - 1.0).abs() < 0.11, "{mean}");
        }
        let without = Volumetric { limit: f64::INFINITY, ..LAW };
        assert_eq!((without.stress(0.5), without.strain(4000.0)), ([4000.0, 8000.0], [0.5, 1.0 / 8000.0]));
    }
}
