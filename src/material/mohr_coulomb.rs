//! Perfectly plastic Mohr–Coulomb model with dilation (non-associated flow) and tension cut-off:
//! `(τ₁ − τ₃) + (τ₁ + τ₃) sin φ ≤ 2 c cos φ` and `τ₁ ≤ σ_t`, tension positive.
//!
//! The return, with edges, apex and the cut-off's corners, is that of [`super::polyhedral`]; flow on the
//! cut-off is associated. Dilation ends with the plastic volume strain that the soil may take up ([`Planes::respond_within`]).

use super::model::AT;
use super::polyhedral::Planes;
use super::{Elasticity, Kind, Model, Parameter, Parameters, Profile, Response, State, Variable, VariableKind};
use crate::error::{Error, Result};
use std::sync::Arc;

/// Angles of friction and dilation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    sin_friction: f64,
    cos_friction: f64,
    sin_dilation: f64,
}

impl Friction {
    /// The angles `friction` φ and `dilation` ψ in degrees.
    ///
    /// # Errors
    /// Unless `0 ≤ friction < 90` and `0 ≤ dilation ≤ friction`.
    pub fn degrees(friction: f64, dilation: f64) -> Result<Self> {
        if !(0.0..90.0).contains(&friction) {
            return Err(Error::input(
                "friction",
                format!("{friction} is outside 0 <= friction < 90"),
                "give the angle of friction in degrees",
            ));
        }
        if !(0.0..=friction).contains(&dilation) {
            return Err(Error::input(
                "dilation",
                format!("{dilation} is outside 0 <= dilation <= friction = {friction}"),
                "give the angle of dilation in degrees, at most that of friction",
            ));
        }
        let (sin_friction, cos_friction) = friction.to_radians().sin_cos();
        Ok(Self { sin_friction, cos_friction, sin_dilation: dilation.to_radians().sin() })
    }

    /// The angles with `tan φ` divided by `factor`. Dilation is at most friction, and stays equal to it where it is, so that
    /// the tangent stays symmetric for factors below one.
    fn reduced(&self, factor: f64) -> Self {
        let tan = self.sin_friction / (self.cos_friction * factor);
        let cos_friction = 1.0 / tan.hypot(1.0);
        let sin_friction = tan * cos_friction;
        let associated = self.sin_dilation == self.sin_friction;
        let sin_dilation = if associated { sin_friction } else { self.sin_dilation.min(sin_friction) };
        Self { sin_friction, cos_friction, sin_dilation }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MohrCoulomb {
    elasticity: Elasticity,
    cohesion: Profile,
    friction: Friction,
    tension: Option<Profile>,
    /// Plastic volume strain (-) at which dilation ends, if it does.
    dilation_cutoff: Option<f64>,
    /// Whether it is derived from another model, with its strengths divided: a `tension` above the apex is then no error of the case, and the apex
    /// is the limit.
    is_derived: bool,
}

/// The name of the plastic volume strain at which dilation ends among the parameters.
const CUTOFF: &str = "dilation_cutoff";

/// What soil carries whose dilation ends.
const VARIABLES: [Variable; 1] =
    [Variable { name: "plastic_volume_strain", unit: "-", kind: VariableKind::Scalar, initial: 0.0 }];

/// The entry of the model list.
pub const KIND: Kind = Kind {
    name: "mohr_coulomb",
    keeps_volume: false,
    yields: true,
    parameters: &[
        Parameter::YOUNG,
        Parameter::POISSON,
        Parameter { name: "cohesion", unit: "kPa", required: true, varies: true, meaning: "cohesion c" },
        Parameter { name: "friction", unit: "degrees", required: true, varies: false, meaning: "angle of friction" },
        Parameter {
            name: "dilation",
            unit: "degrees",
            required: false,
            varies: false,
            meaning: "angle of dilation, at most that of friction; default 0",
        },
        Parameter {
            name: "tension",
            unit: "kPa",
            required: false,
            varies: true,
            meaning: "largest principal stress in tension, at most c cot φ; default: no cut-off",
        },
        Parameter {
            name: CUTOFF,
            unit: "-",
            required: false,
            varies: false,
            meaning: "plastic volume strain at which dilation ends, ln((1 + e_max)/(1 + e_0)) of the void ratios; default: dilation without end",
        },
    ],
    build,
    examples: &[
        &[("young", 1000.0), ("poisson", 0.3), ("cohesion", 1.0), ("friction", 30.0), ("dilation", 10.0)],
        &[("young", 1000.0), ("poisson", 0.3), ("cohesion", 1.0), ("friction", 30.0), ("dilation", 30.0)],
        &[("young", 5e4), ("poisson", 0.2), ("cohesion", 5.0), ("friction", 45.0)],
        &[("young", 1e4), ("poisson", 0.3), ("cohesion", 0.1), ("friction", 38.0), ("dilation", 8.0), ("tension", 0.0)],
        &[("young", 2e4), ("poisson", 0.35), ("cohesion", 10.0), ("friction", 20.0), ("tension", 6.0)],
        &[
            ("young", 2e3),
            ("poisson", 0.0),
            ("cohesion", 2.0),
            ("friction", 25.0),
            ("dilation", 25.0),
            ("tension", 1.0),
        ],
        &[("young", 100.0), ("poisson", 0.495), ("cohesion", 1.0), ("friction", 0.0), ("tension", 0.5)],
        &[
            ("young", 1000.0),
            ("poisson", 0.3),
            ("cohesion", 1.0),
            ("friction", 35.0),
            ("dilation", 20.0),
            ("dilation_cutoff", 5e-4),
        ],
    ],
};

fn build(parameters: &Parameters) -> Result<Arc<dyn Model>> {
    let friction = Friction::degrees(parameters.number("friction")?, parameters.number_or("dilation", 0.0)?)?;
    let (elasticity, cohesion) = (parameters.elasticity()?, parameters.profile("cohesion")?);
    let model = MohrCoulomb::new(elasticity, cohesion, friction, parameters.optional("tension"))?;
    if parameters.optional(CUTOFF).is_none() {
        return Ok(Arc::new(model));
    }
    Ok(Arc::new(model.dilating_until(parameters.number(CUTOFF)?)?))
}

impl MohrCoulomb {
    /// A model with the cohesion (kPa) and, if any, the largest tension (kPa).
    ///
    /// # Errors
    /// As [`Model::check`], at the datum of cohesion.
    pub fn new(
        elasticity: Elasticity,
        cohesion: Profile,
        friction: Friction,
        tension: Option<Profile>,
    ) -> Result<Self> {
        let model = Self { elasticity, cohesion, friction, tension, dilation_cutoff: None, is_derived: false };
        model.check(cohesion.datum)?;
        Ok(model)
    }

    /// The model with dilation until the plastic volume strain is `strain` (-).
    ///
    /// # Errors
    /// Where it is negative.
    pub fn dilating_until(self, strain: f64) -> Result<Self> {
        if strain < 0.0 {
            let remedy =
                "give the plastic volume strain at which dilation ends, ln((1 + e_max)/(1 + e_0)) of the void ratios";
            return Err(Error::input(CUTOFF, format!("{strain} is negative"), remedy));
        }
        Ok(Self { dilation_cutoff: Some(strain), ..self })
    }

    /// The model with its strengths divided by `factor` (-).
    fn divided(&self, factor: f64) -> Self {
        Self {
            elasticity: self.elasticity,
            cohesion: self.cohesion.scaled(1.0 / factor),
            friction: self.friction.reduced(factor),
            tension: self.tension.map(|t| t.scaled(1.0 / factor)),
            dilation_cutoff: self.dilation_cutoff,
            is_derived: true,
        }
    }

    /// Isotropic tension `c cot φ` at the apex, infinite without friction.
    fn apex(&self, y: f64) -> f64 {
        if self.friction.sin_friction > 0.0 {
            self.cohesion.at(y) * self.friction.cos_friction / self.friction.sin_friction
        } else {
            f64::INFINITY
        }
    }

    fn planes(&self, y: f64, state: &State) -> Planes {
        if state.strength != 1.0 {
            return self.divided(1.0 / state.strength).planes(y, &State { strength: 1.0, ..*state });
        }
        let apex = self.apex(y);
        Planes {
            sin_friction: self.friction.sin_friction,
            sin_dilation: self.friction.sin_dilation,
            strength: 2.0 * self.cohesion.at(y) * self.friction.cos_friction,
            tension: self.tension.map_or(apex, |t| t.at(y).min(apex)),
        }
    }
}

impl Model for MohrCoulomb {
    fn respond(&self, y: f64, trial: &[f64; 3], state: &State, internal: &mut [f64]) -> Response {
        let (planes, moduli) = (self.planes(y, state), self.elasticity.at(y));
        let Some(cutoff) = self.dilation_cutoff else { return planes.respond(&moduli, trial, state) };
        let before = state.first_variable();
        let (response, grown) = planes.respond_within(&moduli, trial, state, cutoff - before);
        if let Some(strain) = internal.first_mut() {
            *strain = before + grown;
        }
        response
    }

    fn yield_excess(&self, y: f64, stress: &[f64; 3], state: &State) -> f64 {
        self.planes(y, state).excess(stress)
    }

    fn is_at_tension_limit(&self, y: f64, stress: &[f64; 3], state: &State) -> bool {
        let planes = self.planes(y, state);
        let largest = stress.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        let unit = stress.iter().fold(self.shear_strength(y, state), |most, s| most.max(s.abs()));
        self.tension.is_some() && largest >= planes.tension - AT * unit
    }

    fn elasticity(&self) -> &Elasticity {
        &self.elasticity
    }

    fn internal_variables(&self) -> &[Variable] {
        if self.dilation_cutoff.is_some() { &VARIABLES } else { &[] }
    }

    fn symmetric(&self) -> bool {
        let ends = self.dilation_cutoff.is_some() && self.friction.sin_dilation > 0.0;
        self.friction.sin_friction == self.friction.sin_dilation && !ends
    }

    fn has_friction(&self) -> bool {
        self.friction.sin_friction > 0.0
    }

    fn shear_strength(&self, y: f64, state: &State) -> f64 {
        self.cohesion.at(y) * state.strength
    }

    fn reduced(&self, factor: f64) -> Arc<dyn Model> {
        Arc::new(self.divided(factor))
    }

    fn check(&self, y: f64) -> Result<()> {
        self.elasticity.check(y)?;
        if self.friction.sin_friction > 0.0 {
            self.cohesion.not_negative_at("cohesion", y)?;
        } else {
            self.cohesion.positive_at("cohesion", y)?;
        }
        let Some(tension) = self.tension else { return Ok(()) };
        tension.not_negative_at("tension", y)?;
        let apex = self.apex(y);
        if !self.is_derived && tension.at(y) > apex * (1.0 + 1e-12) {
            return Err(Error::input(
                "tension",
                format!("{} is above the apex c cot(friction) = {apex} at y = {y}", tension.at(y)),
                "lower it, or leave it out for no cut-off",
            ));
        }
        Ok(())
    }
}
