//! Tresca model with associated flow whose strength falls as it is sheared and grows with the rate of that (Einav &
//! Randolph 2005, *Combining upper bound and strain path methods for evaluating penetration resistance*, Int. J. Numer. Meth.
//! Engng 63, 1991–2016):
//!
//! ```text
//! τ₁ − τ₃ ≤ 2 s_u,   s_u = s_u0 [1 + μ log₁₀(max(ξ̇, γ̇_ref)/γ̇_ref)] [δ_rem + (1 − δ_rem) e^(−3 ξ/ξ₉₅)]
//! ```
//!
//! `ξ = Σ Σ_A |Δε_p,A|` is the accumulated plastic shear strain: in shear the sum of `|Δγ_p|`. So it is what the strength
//! does work on, `s_u Δξ`, at the edges of the surface as on its faces. Both ends of the step count as the end does: the return
//! finds `Δξ` with the strength that it leads to. For a given strength the return is that of [`super::polyhedral`], and
//! `∂ξ/∂(2 s_u) = −c`, `c = 1/2G` on a face and `2/3G` at an edge, `∂ξ/∂ε = 2 ∂τ/∂(2 s_u) = 2 t`: the tangent stays symmetric,
//!
//! ```text
//! ∂τ/∂ε = (∂τ/∂ε at constant s_u) + 4 s′/(1 + 2 c s′) t ⊗ t,   s′ = ds_u/dξ
//! ```
//!
//! There is one answer as long as the soil softens more slowly than it unloads, which [`Model::check`] sees to. Softening makes
//! shear bands as narrow as the cells allow: results depend on their size.

use super::polyhedral::Planes;
use super::{
    Elasticity, Kind, Model, Moduli, Parameter, Parameters, Profile, Response, State, Variable, VariableKind,
    cavitation,
};
use crate::error::{Error, Result};
use std::f64::consts::LN_10;
use std::sync::Arc;

/// Iterations of the search for the strength; halving alone would need 60.
const ITERATIONS: usize = 100;

/// The least that counts for what falls ([`falls`]).
const LEAST: f64 = 0.1;

const VARIABLES: [Variable; 1] =
    [Variable { name: "plastic_shear_strain", unit: "-", kind: VariableKind::Scalar, initial: 0.0 }];

#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SofteningTresca {
    elasticity: Elasticity,
    shear_strength: Profile,
    softening: Softening,
}

/// How the strength changes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Softening {
    /// δ_rem (-): the strength of remoulded soil over the first one.
    pub remoulded: f64,
    /// ξ₉₅ (-): plastic shear strain at which 95 % of the softening is done, such as 10 (1000 %).
    pub ductility: f64,
    /// μ (-): the strength gained with each tenfold rate.
    pub rate: f64,
    /// γ̇_ref (1/s): the rate up to which the strength is `s_u0`.
    pub reference_rate: f64,
}

/// The entry of the model list.
pub const KIND: Kind = Kind {
    name: "tresca_softening",
    keeps_volume: true,
    yields: true,
    parameters: &[
        Parameter::YOUNG,
        Parameter::POISSON,
        Parameter::SHEAR_STRENGTH,
        Parameter {
            name: "remoulded",
            unit: "-",
            required: true,
            varies: false,
            meaning: "δ_rem, strength of remoulded soil over that of intact soil, above 0 and at most 1: one over the sensitivity",
        },
        Parameter {
            name: "ductility",
            unit: "-",
            required: true,
            varies: false,
            meaning: "ξ₉₅, plastic shear strain at which 95 % of the softening is done, such as 10 (1000 %)",
        },
        Parameter {
            name: "rate",
            unit: "-",
            required: false,
            varies: false,
            meaning: "μ, part of the strength gained with each tenfold rate of plastic shear strain; default 0",
        },
        Parameter {
            name: "reference_rate",
            unit: "1/s",
            required: false,
            varies: false,
            meaning: "rate of plastic shear strain from which on the strength grows; needed with `rate`, and time is then real in quasi-static phases too",
        },
        cavitation::PARAMETER,
    ],
    build,
    examples: &[
        &[("young", 1000.0), ("poisson", 0.49), ("shear_strength", 2.0), ("remoulded", 0.3), ("ductility", 2.0)],
        &[("young", 100.0), ("poisson", 0.3), ("shear_strength", 1.0), ("remoulded", 0.2), ("ductility", 0.5)],
        &[("young", 5e4), ("poisson", 0.0), ("shear_strength", 50.0), ("remoulded", 1.0), ("ductility", 10.0)],
        &[
            ("young", 500.0),
            ("poisson", 0.45),
            ("shear_strength", 2.0),
            ("remoulded", 0.5),
            ("ductility", 5.0),
            ("tension_limit", 10.0),
        ],
    ],
};

fn build(parameters: &Parameters) -> Result<Arc<dyn Model>> {
    let rate = parameters.number_or("rate", 0.0)?;
    let reference_rate =
        if rate == 0.0 { parameters.number_or("reference_rate", 1.0)? } else { parameters.number("reference_rate")? };
    let (remoulded, ductility) = (parameters.number("remoulded")?, parameters.number("ductility")?);
    let softening = Softening { remoulded, ductility, rate, reference_rate };
    let strength = parameters.profile("shear_strength")?;
    cavitation::limited(
        SofteningTresca::new(parameters.elasticity()?, strength, softening)?,
        SofteningTresca::divided,
        parameters,
    )
}

impl Softening {
    /// `s_u/s_u0` and its derivative by ξ at the accumulated strain `before + more`, of which `more` came at `inverse_dt`
    /// steps a second.
    fn factor(&self, before: f64, more: f64, inverse_dt: f64) -> (f64, f64) {
        let lost = (1.0 - self.remoulded) * (-3.0 * (before + more) / self.ductility).exp();
        let (kept, kept_slope) = (self.remoulded + lost, -3.0 * lost / self.ductility);
        let times = more * inverse_dt / self.reference_rate;
        let (fast, fast_slope) =
            if times > 1.0 { (1.0 + self.rate * times.log10(), self.rate / (LN_10 * more)) } else { (1.0, 0.0) };
        (kept * fast, kept_slope * fast + kept * fast_slope)
    }
}

impl SofteningTresca {
    /// # Errors
    /// Names the parameter that is out of range, at the datum of the strength.
    pub fn new(elasticity: Elasticity, shear_strength: Profile, softening: Softening) -> Result<Self> {
        let Softening { remoulded, ductility, rate, reference_rate } = softening;
        let refuse = |name: &str, value: f64, remedy: &str| {
            Err(Error::input(name, format!("{value} is out of range"), remedy.to_string()))
        };
        if !(remoulded > 0.0 && remoulded <= 1.0) {
            return refuse("remoulded", remoulded, "give a part of the strength above 0, and 1 at most");
        }
        if !(ductility > 0.0 && ductility.is_finite()) {
            return refuse("ductility", ductility, "give a plastic shear strain above 0, such as 10 for 1000 %");
        }
        if !(rate >= 0.0 && rate.is_finite()) {
            return refuse("rate", rate, "give a part of the strength, 0 or more, such as 0.1");
        }
        if !(reference_rate > 0.0 && reference_rate.is_finite()) {
            return refuse("reference_rate", reference_rate, "give a rate of shear above 0 [1/s]");
        }
        let model = Self { elasticity, shear_strength, softening };
        model.check(shear_strength.datum)?;
        Ok(model)
    }

    /// The yield surface where the first strength is `first` (kPa) and `factor` (-) of it is left.
    fn planes(first: f64, factor: f64) -> Planes {
        Planes { sin_friction: 0.0, sin_dilation: 0.0, strength: 2.0 * first * factor, tension: f64::INFINITY }
    }

    /// `s_u0` (kPa) in a state.
    fn first(&self, y: f64, state: &State) -> f64 {
        self.shear_strength.at(y) * state.strength
    }

    /// It with its strength divided by `factor` (-).
    fn divided(&self, factor: f64) -> Self {
        Self { shear_strength: self.shear_strength.scaled(1.0 / factor), ..*self }
    }
}

/// The plastic shear strain of a return.
fn sheared(trial: &[f64; 3], response: &Response) -> f64 {
    trial.iter().zip(&response.elastic_strain).map(|(t, e)| (t - e).abs()).sum()
}

/// `t = ∂τ/∂(2 s_u)` of a return to `stress`, and `c`: by the face, or the edge where two of the stresses are equal.
fn by_strength(moduli: &Moduli, stress: &[f64; 3]) -> ([f64; 3], f64) {
    let high = stress.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let low = stress.iter().copied().fold(f64::INFINITY, f64::min);
    let near = 1e-9 * (high - low) + 8.0 * f64::EPSILON * high.abs().max(low.abs());
    let (at_high, at_low) = (stress.map(|s| high - s <= near), stress.map(|s| s - low <= near));
    let count = |at: &[bool; 3]| at.iter().filter(|at| **at).count();
    let edge = count(&at_high) + count(&at_low) > 2;
    let share = if edge { [2.0 / 3.0, 1.0 / 3.0] } else { [0.5, 0.5] };
    let of = |number: usize| share[number - 1];
    let (up, down) = if edge { (of(count(&at_high)), of(count(&at_low))) } else { (0.5, 0.5) };
    let t = std::array::from_fn(|k| {
        if at_high[k] {
            up
        } else if at_low[k] {
            -down
        } else {
            0.0
        }
    });
    (t, if edge { 2.0 / (3.0 * moduli.shear) } else { 0.5 / moduli.shear })
}

/// How fast what a return misses falls with the strain that is tried. [`SofteningTresca::check`] keeps it above a third at rates up to the
/// reference; far above, where strength that grows with the rate is lost as fast, steps beyond the one answer are kept finite.
fn falls(c: f64, slope: f64) -> f64 {
    (1.0 + 2.0 * c * slope).max(LEAST)
}

impl Model for SofteningTresca {
    fn respond(&self, y: f64, trial: &[f64; 3], state: &State, internal: &mut [f64]) -> Response {
        let moduli = self.elasticity.at(y);
        let (before, strength) = (internal[0], self.first(y, state));
        let at = |more: f64| {
            let (factor, slope) = self.softening.factor(before, more, state.inverse_dt);
            (Self::planes(strength, factor).respond(&moduli, trial, state), strength * slope)
        };
        // The strength at the end lies between that before and that of remoulded soil, at whatever rate.
        let first = at(0.0).0;
        if !first.yielding {
            return first;
        }
        let weakest = Self::planes(strength, self.softening.remoulded).respond(&moduli, trial, state);
        let (mut low, mut high) = (0.0, sheared(trial, &weakest));
        let mut more = sheared(trial, &first).min(high);
        let (mut response, mut slope) = at(more);
        for _ in 0..ITERATIONS {
            let miss = sheared(trial, &response) - more;
            if miss >= 0.0 {
                low = more
            } else {
                high = more
            }
            let (_, c) = by_strength(&moduli, &response.stress);
            let mut next = more + miss / falls(c, slope);
            if !(next > low && next < high) {
                next = 0.5 * (low + high);
            }
            let done = (next - more).abs() <= 4.0 * f64::EPSILON * more;
            more = next;
            (response, slope) = at(more);
            if done {
                break;
            }
        }
        let (t, c) = by_strength(&moduli, &response.stress);
        let by = 4.0 * slope / falls(c, slope);
        for (row, a) in response.tangent.iter_mut().zip(&t) {
            for (entry, b) in row.iter_mut().zip(&t) {
                *entry += by * a * b;
            }
        }
        internal[0] = before + more;
        response
    }

    fn yield_excess(&self, y: f64, stress: &[f64; 3], state: &State) -> f64 {
        Self::planes(self.first(y, state), self.softening.factor(state.first_variable(), 0.0, 0.0).0).excess(stress)
    }

    fn elasticity(&self) -> &Elasticity {
        &self.elasticity
    }

    fn symmetric(&self) -> bool {
        true
    }

    fn internal_variables(&self) -> &[Variable] {
        &VARIABLES
    }

    fn shear_strength(&self, y: f64, state: &State) -> f64 {
        self.first(y, state) * self.softening.factor(state.first_variable(), 0.0, 0.0).0
    }

    fn reduced(&self, factor: f64) -> Arc<dyn Model> {
        Arc::new(self.divided(factor))
    }

    fn check(&self, y: f64) -> Result<()> {
        self.elasticity.check(y)?;
        self.shear_strength.positive_at("shear_strength", y)?;
        let Softening { remoulded, ductility, .. } = self.softening;
        let (slope, most) =
            (3.0 * (1.0 - remoulded) * self.shear_strength.at(y) / ductility, 0.5 * self.elasticity.at(y).shear);
        if slope <= most {
            return Ok(());
        }
        Err(Error::input(
            "ductility",
            format!(
                "the strength falls by {slope:.4} kPa for a unit of strain, faster than the soil can unload ({most:.4})"
            ),
            "raise it, or the stiffness",
        ))
    }
}

#[cfg(test)]
mod tests;
