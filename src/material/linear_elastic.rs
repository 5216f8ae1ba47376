//! Hencky elasticity without yield.

use super::{Elasticity, Kind, Model, Parameter, Parameters, Response, State};
use crate::error::Result;
use std::sync::Arc;

/// See [`Elasticity`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LinearElastic {
    elasticity: Elasticity,
}

/// The entry of the model list.
pub const KIND: Kind = Kind {
    name: "linear_elastic",
    keeps_volume: true,
    yields: false,
    parameters: &[Parameter::YOUNG, Parameter::POISSON],
    build,
    examples: &[
        &[("young", 1000.0), ("poisson", 0.3)],
        &[("young", 2.1e8), ("poisson", 0.0)],
        &[("young", 100.0), ("poisson", 0.4999)],
        &[("young", 100.0), ("poisson", -0.5)],
    ],
};

fn build(parameters: &Parameters) -> Result<Arc<dyn Model>> {
    Ok(Arc::new(LinearElastic::new(parameters.elasticity()?)))
}

impl LinearElastic {
    pub fn new(elasticity: Elasticity) -> Self {
        Self { elasticity }
    }
}

impl Model for LinearElastic {
    fn respond(&self, y: f64, trial: &[f64; 3], state: &State, _: &mut [f64]) -> Response {
        Response::elastic(&self.elasticity.at(y), trial, state)
    }

    fn yield_excess(&self, _: f64, _: &[f64; 3], _: &State) -> f64 {
        f64::NEG_INFINITY
    }

    fn elasticity(&self) -> &Elasticity {
        &self.elasticity
    }

    fn symmetric(&self) -> bool {
        true
    }

    fn shear_strength(&self, _: f64, _: &State) -> f64 {
        f64::INFINITY
    }

    fn reduced(&self, _: f64) -> Arc<dyn Model> {
        Arc::new(*self)
    }

    fn check(&self, y: f64) -> Result<()> {
        self.elasticity.check(y)
    }
}
