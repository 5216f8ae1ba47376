//! Perfectly plastic von Mises model with associated flow: `q = √(3 J2) ≤ yield_stress`.
//!
//! Radial return (Wilkins 1964; de Souza Neto, Perić & Owen, *Computational Methods for Plasticity*, 2008,
//! §7.3.4) and its consistent tangent, in principal axes. `yield_stress` is the strength in uniaxial
//! tension; the strength in simple shear is `yield_stress/√3`. No hardening.

use super::model::equivalent_plastic;
use super::{Elasticity, Kind, Model, Parameter, Parameters, Profile, Response, State, cavitation};
use crate::error::Result;
use std::sync::Arc;

/// Yield within this fraction of the yield stress counts as elastic, so that a returned state is.
const TOLERANCE: f64 = 1e-12;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VonMises {
    elasticity: Elasticity,
    yield_stress: Profile,
}

/// The entry of the model list.
pub const KIND: Kind = Kind {
    name: "von_mises",
    keeps_volume: true,
    yields: true,
    parameters: &[
        Parameter::YOUNG,
        Parameter::POISSON,
        Parameter {
            name: "yield_stress",
            unit: "kPa",
            required: true,
            varies: true,
            meaning: "strength in uniaxial stress, √(3 J₂) at yield: √3 times the shear strength",
        },
        cavitation::PARAMETER,
    ],
    build,
    examples: &[
        &[("young", 1000.0), ("poisson", 0.3), ("yield_stress", 2.0)],
        &[("young", 100.0), ("poisson", 0.4999), ("yield_stress", 1.0)],
        &[("young", 2.1e8), ("poisson", 0.2), ("yield_stress", 2.4e5)],
        &[("young", 1000.0), ("poisson", 0.3), ("yield_stress", 10.0), ("tension_limit", 5.0)],
    ],
};

fn build(parameters: &Parameters) -> Result<Arc<dyn Model>> {
    cavitation::limited(
        VonMises::new(parameters.elasticity()?, parameters.profile("yield_stress")?)?,
        VonMises::divided,
        parameters,
    )
}

impl VonMises {
    /// # Errors
    /// Unless `yield_stress` (kPa) is positive at its datum.
    pub fn new(elasticity: Elasticity, yield_stress: Profile) -> Result<Self> {
        yield_stress.positive_at("yield_stress", yield_stress.datum)?;
        Ok(Self { elasticity, yield_stress })
    }

    /// It with its strength divided by `factor` (-).
    fn divided(&self, factor: f64) -> Self {
        Self { yield_stress: self.yield_stress.scaled(1.0 / factor), ..*self }
    }
}

impl Model for VonMises {
    fn respond(&self, y: f64, trial: &[f64; 3], state: &State, _: &mut [f64]) -> Response {
        let moduli = self.elasticity.at(y);
        let sy = self.yield_stress.at(y) * state.strength;
        let volumetric = trial[0] + trial[1] + trial[2];
        let e = trial.map(|x| x - volumetric / 3.0);
        let norm = (e[0] * e[0] + e[1] * e[1] + e[2] * e[2]).sqrt();
        let q = 2.0 * moduli.shear * 1.5f64.sqrt() * norm;
        if q <= sy * (1.0 + TOLERANCE) {
            return Response::elastic(&moduli, trial, state);
        }
        let kept = sy / q;
        let n = e.map(|x| x / norm);
        let mean = moduli.bulk() * volumetric;
        let g = 2.0 * moduli.shear * kept;
        let tangent = std::array::from_fn(|a| {
            std::array::from_fn(|b| {
                let identity = if a == b { 1.0 } else { 0.0 };
                moduli.bulk() + g * (identity - 1.0 / 3.0 - n[a] * n[b])
            })
        });
        Response {
            stress: e.map(|x| mean + g * x),
            tangent,
            elastic_strain: e.map(|x| volumetric / 3.0 + kept * x),
            plastic_strain: state.plastic_strain + equivalent_plastic(&e.map(|x| (1.0 - kept) * x)),
            yielding: true,
        }
    }

    fn yield_excess(&self, y: f64, stress: &[f64; 3], state: &State) -> f64 {
        let [a, b, c] = stress;
        (0.5 * ((a - b).powi(2) + (b - c).powi(2) + (c - a).powi(2))).sqrt() - self.yield_stress.at(y) * state.strength
    }

    fn elasticity(&self) -> &Elasticity {
        &self.elasticity
    }

    fn symmetric(&self) -> bool {
        true
    }

    fn shear_strength(&self, y: f64, state: &State) -> f64 {
        self.yield_stress.at(y) * state.strength / 3f64.sqrt()
    }

    fn reduced(&self, factor: f64) -> Arc<dyn Model> {
        Arc::new(self.divided(factor))
    }

    fn check(&self, y: f64) -> Result<()> {
        self.elasticity.check(y)?;
        self.yield_stress.positive_at("yield_stress", y)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn simple_shear_strength_is_yield_stress_over_root_three() {
        let elasticity = Elasticity::new(Profile::constant(1000.0), 0.3).unwrap();
        let model = VonMises::new(elasticity, Profile::growing(2.0, 0.5, 0.0)).unwrap();
        let r = model.respond(-4.0, &[0.1, 0.0, -0.1], &State::default(), &mut []);
        let k = 4.0 / 3f64.sqrt();
        for (got, expected) in r.stress.iter().zip([k, 0.0, -k]) {
            assert!((got - expected).abs() < 1e-12);
        }
        // Equivalent plastic strain of a pure shear ±e is 2e/√3.
        let e = 0.1 - k / (1000.0 / 1.3);
        assert!((r.plastic_strain - 2.0 * e / 3f64.sqrt()).abs() < 1e-15);
    }
}
