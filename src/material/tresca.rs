//! Perfectly plastic Tresca model with associated flow: `τ₁ − τ₃ ≤ 2 s_u`, undrained clay in total stress.
//!
//! The return is that of [`super::polyhedral`] without friction.

use super::polyhedral::Planes;
use super::{Elasticity, Kind, Model, Parameter, Parameters, Profile, Response, State, cavitation};
use crate::error::Result;
use std::sync::Arc;

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tresca {
    elasticity: Elasticity,
    shear_strength: Profile,
}

/// The entry of the model list.
pub const KIND: Kind = Kind {
    name: "tresca",
    keeps_volume: true,
    yields: true,
    parameters: &[Parameter::YOUNG, Parameter::POISSON, Parameter::SHEAR_STRENGTH, cavitation::PARAMETER],
    build,
    examples: &[
        &[("young", 100.0), ("poisson", 0.49), ("shear_strength", 0.5)],
        &[("young", 1000.0), ("poisson", 0.4999), ("shear_strength", 1.0)],
        &[("young", 50_000.0), ("poisson", 0.0), ("shear_strength", 100.0)],
        &[("young", 1000.0), ("poisson", 0.49), ("shear_strength", 5.0), ("tension_limit", 20.0)],
    ],
};

fn build(parameters: &Parameters) -> Result<Arc<dyn Model>> {
    cavitation::limited(
        Tresca::new(parameters.elasticity()?, parameters.profile("shear_strength")?)?,
        Tresca::divided,
        parameters,
    )
}

impl Tresca {
    /// # Errors
    /// Unless `shear_strength` (kPa) is positive at its datum.
    pub fn new(elasticity: Elasticity, shear_strength: Profile) -> Result<Self> {
        shear_strength.positive_at("shear_strength", shear_strength.datum)?;
        Ok(Self { elasticity, shear_strength })
    }

    fn planes(&self, y: f64, state: &State) -> Planes {
        Planes {
            sin_friction: 0.0,
            sin_dilation: 0.0,
            strength: 2.0 * self.shear_strength(y, state),
            tension: f64::INFINITY,
        }
    }

    /// It with its strength divided by `factor` (-).
    fn divided(&self, factor: f64) -> Self {
        Self { shear_strength: self.shear_strength.scaled(1.0 / factor), ..*self }
    }
}

impl Model for Tresca {
    fn respond(&self, y: f64, trial: &[f64; 3], state: &State, _: &mut [f64]) -> Response {
        self.planes(y, state).respond(&self.elasticity.at(y), trial, state)
    }

    fn yield_excess(&self, y: f64, stress: &[f64; 3], state: &State) -> f64 {
        self.planes(y, state).excess(stress)
    }

    fn elasticity(&self) -> &Elasticity {
        &self.elasticity
    }

    fn symmetric(&self) -> bool {
        true
    }

    fn shear_strength(&self, y: f64, state: &State) -> f64 {
        self.shear_strength.at(y) * state.strength
    }

    fn reduced(&self, factor: f64) -> Arc<dyn Model> {
        Arc::new(self.divided(factor))
    }

    fn check(&self, y: f64) -> Result<()> {
        self.elasticity.check(y)?;
        self.shear_strength.positive_at("shear_strength", y)
    }
}
