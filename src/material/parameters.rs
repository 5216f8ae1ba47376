//! Parameters of the models: what a model tells the case about its parameters.

use super::profile::Profile;
use super::{Elasticity, Model};
use crate::error::{Error, Result};
use std::sync::Arc;

/// A model in the list of models: its name in a case, its parameters and how to build it.
pub struct Kind {
    pub name: &'static str,
    /// Whether neither yield nor flow knows the mean stress, so that the bulk modulus can be taken out of the model: it is
    /// built again with another `young` and `poisson`, which it has to have for parameters.
    pub keeps_volume: bool,
    /// Whether its stress has a limit ([`Model::yields`]).
    pub yields: bool,
    pub parameters: &'static [Parameter],
    /// Builds the model; an error names the parameter at fault.
    pub build: fn(&Parameters) -> Result<Arc<dyn Model>>,
    /// Valid sets of parameters over the model's range: what the shared tests run on.
    pub examples: &'static [&'static [(&'static str, f64)]],
}

/// A parameter of a model as the case file has it.
pub struct Parameter {
    pub name: &'static str,
    pub unit: &'static str,
    pub required: bool,
    /// Whether it may vary with depth.
    pub varies: bool,
    pub meaning: &'static str,
}

impl Parameter {
    pub const YOUNG: Self =
        Self { name: "young", unit: "kPa", required: true, varies: true, meaning: "Young's modulus" };
    pub const POISSON: Self =
        Self { name: "poisson", unit: "-", required: true, varies: false, meaning: "Poisson's ratio" };
    pub const SHEAR_STRENGTH: Self = Self {
        name: "shear_strength",
        unit: "kPa",
        required: true,
        varies: true,
        meaning: "undrained shear strength s_u, half the largest difference of principal stresses",
    };
}

/// Named values for [`Kind::build`].
#[derive(Clone, Debug, Default)]
pub struct Parameters(Vec<(String, Profile)>);

impl Parameters {
    /// Adds a value.
    pub fn set(&mut self, name: impl Into<String>, value: Profile) {
        self.0.push((name.into(), value));
    }

    /// The profile called `name`, if given.
    pub fn optional(&self, name: &str) -> Option<Profile> {
        self.0.iter().find(|(n, _)| n == name).map(|(_, p)| *p)
    }

    /// The profile called `name`.
    ///
    /// # Errors
    /// If it is missing.
    pub fn profile(&self, name: &str) -> Result<Profile> {
        self.optional(name).ok_or_else(|| Error::input(name, "is missing", format!("give a value for {name}")))
    }

    /// The value called `name`, which may not vary with depth.
    ///
    /// # Errors
    /// If it is missing or varies.
    pub fn number(&self, name: &str) -> Result<f64> {
        self.profile(name).and_then(|p| single(name, p))
    }

    /// The value called `name`, which may not vary with depth, or `default` where it is not given.
    ///
    /// # Errors
    /// If it varies.
    pub fn number_or(&self, name: &str, default: f64) -> Result<f64> {
        self.optional(name).map_or(Ok(default), |p| single(name, p))
    }

    /// The elastic parameters every model has.
    ///
    /// # Errors
    /// If one is missing or out of range.
    pub fn elasticity(&self) -> Result<Elasticity> {
        Elasticity::new(self.profile("young")?, self.number("poisson")?)
    }
}

fn single(name: &str, profile: Profile) -> Result<f64> {
    if profile.gradient == 0.0 {
        Ok(profile.top)
    } else {
        Err(Error::input(name, "varies with depth", "give a single number: only moduli and strengths may vary"))
    }
}

impl<'a> FromIterator<&'a (&'a str, f64)> for Parameters {
    fn from_iter<I: IntoIterator<Item = &'a (&'a str, f64)>>(pairs: I) -> Self {
        Self(pairs.into_iter().map(|(n, v)| (n.to_string(), Profile::constant(*v))).collect())
    }
}
