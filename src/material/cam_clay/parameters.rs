//! Modified Cam-Clay in the list of models: its parameters, of which some exclude others, and what a case is told of them.

use super::{CamClay, Swelling};
use crate::error::{Error, Result};
use crate::material::{Kind, Model, Parameter, Parameters};
use std::sync::Arc;

/// Pressure (kPa) down to which soil swells along its line, where none is given.
const LEAST_PRESSURE: f64 = 1.0;

/// The entry of the model list.
pub const KIND: Kind = Kind {
    name: "cam_clay",
    keeps_volume: false,
    yields: true,
    parameters: &[
        Parameter { required: false, ..Parameter::YOUNG },
        Parameter::POISSON,
        Parameter {
            name: "swelling",
            unit: "-",
            required: false,
            varies: false,
            meaning: "κ*, slope of unloading in logarithms of volume and mean effective pressure, below 1, in place of `young`: the bulk modulus is then p/κ*",
        },
        Parameter {
            name: "least_pressure",
            unit: "kPa",
            required: false,
            varies: false,
            meaning: "beside `swelling`: mean pressure below which the bulk modulus is constant; default 1",
        },
        Parameter {
            name: "reference_pressure",
            unit: "kPa",
            required: false,
            varies: true,
            meaning: "beside `swelling`: mean pressure at which `poisson` holds, or `least_pressure` if that is more; default `preconsolidation`",
        },
        Parameter {
            name: "critical_slope",
            unit: "-",
            required: true,
            varies: false,
            meaning: "M, q over p at the critical state",
        },
        Parameter {
            name: "preconsolidation",
            unit: "kPa",
            required: true,
            varies: true,
            meaning: "p_c, isotropic effective pressure that the soil bears without plastic strain at first",
        },
        Parameter {
            name: "compression",
            unit: "-",
            required: false,
            varies: false,
            meaning: "λ*, slope of virgin compression in logarithms of volume and mean effective pressure, below 1, beside `swelling` and above it; this or `plastic_compressibility`",
        },
        Parameter {
            name: "plastic_compressibility",
            unit: "-",
            required: false,
            varies: false,
            meaning: "λ* − κ*, slope of virgin compression less that of unloading",
        },
    ],
    build,
    examples: &[
        &[
            ("young", 5000.0),
            ("poisson", 0.3),
            ("critical_slope", 1.0),
            ("preconsolidation", 100.0),
            ("plastic_compressibility", 0.1),
        ],
        &[
            ("young", 2000.0),
            ("poisson", 0.2),
            ("critical_slope", 1.3),
            ("preconsolidation", 20.0),
            ("plastic_compressibility", 0.05),
        ],
        &[
            ("swelling", 0.02),
            ("compression", 0.1),
            ("poisson", 0.3),
            ("critical_slope", 1.0),
            ("preconsolidation", 100.0),
        ],
        &[
            ("swelling", 0.01),
            ("plastic_compressibility", 0.05),
            ("poisson", 0.2),
            ("critical_slope", 1.3),
            ("preconsolidation", 20.0),
            ("least_pressure", 2.0),
            ("reference_pressure", 5.0),
        ],
    ],
};

fn build(parameters: &Parameters) -> Result<Arc<dyn Model>> {
    let given = |name: &str| parameters.optional(name).is_some();
    let slope = parameters.number("critical_slope")?;
    let preconsolidation = parameters.profile("preconsolidation")?;
    if !given("swelling") {
        if !given("young") {
            let remedy = "give `swelling` for a stiffness that grows with the pressure, `young` for one that does not";
            return Err(Error::input("young", "neither `young` nor `swelling` is given", remedy));
        }
        for (name, remedy) in [
            ("compression", "give `plastic_compressibility`, which is λ* − κ*, or `swelling` in place of `young`"),
            ("least_pressure", "take it out, or give `swelling` in place of `young`"),
            ("reference_pressure", "take it out, or give `swelling` in place of `young`"),
        ] {
            if given(name) {
                return Err(Error::input(name, "it says something only beside `swelling`", remedy));
            }
        }
        let compressibility =
            slope_of_kirchhoff("plastic_compressibility", parameters.number("plastic_compressibility")?)?;
        return Ok(Arc::new(CamClay::new(parameters.elasticity()?, slope, preconsolidation, compressibility)?));
    }
    if given("young") {
        return Err(Error::input("swelling", "`young` is given too", "keep one of them"));
    }
    let reference = match parameters.optional("reference_pressure") {
        Some(reference) => reference,
        None => {
            preconsolidation.positive_at("preconsolidation", preconsolidation.datum)?;
            preconsolidation
        }
    };
    let least = parameters.number_or("least_pressure", LEAST_PRESSURE)?;
    let unloading = parameters.number("swelling")?;
    let swelling = Swelling::new(slope_of_kirchhoff("swelling", unloading)?, least, reference)?;
    let (name, compression) = compression(parameters, unloading)?;
    let compressibility = slope_of_kirchhoff(name, compression)? - swelling.slope();
    let poisson = parameters.number("poisson")?;
    Ok(Arc::new(CamClay::with_swelling(swelling, poisson, slope, preconsolidation, compressibility)?))
}

/// The slope (-) of a line in the logarithm of the Kirchhoff pressure, which is `ln p − ε`, by that of `ε` in the logarithm of the Cauchy
/// pressure `p`.
fn slope_of_kirchhoff(name: &str, slope: f64) -> Result<f64> {
    if slope > 0.0 && slope < 1.0 {
        return Ok(slope / (1.0 - slope));
    }
    let remedy = "divide the slope in void ratio by 1 + e; clays have 0.005 to 0.3";
    Err(Error::input(name, format!("is {slope}, but must be above 0 and below 1"), remedy))
}

/// λ* (-) of soil whose κ* is `swelling`, and the parameter that tells it.
fn compression(parameters: &Parameters, swelling: f64) -> Result<(&'static str, f64)> {
    match (parameters.optional("compression"), parameters.optional("plastic_compressibility")) {
        (None, Some(_)) => {
            let plastic = parameters.number("plastic_compressibility")?;
            slope_of_kirchhoff("plastic_compressibility", plastic)?;
            Ok(("plastic_compressibility", swelling + plastic))
        }
        (Some(_), None) => {
            let compression = parameters.number("compression")?;
            if compression > swelling {
                return Ok(("compression", compression));
            }
            let problem = format!("is {compression}, but must be above `swelling` ({swelling})");
            Err(Error::input("compression", problem, "five times `swelling` is common"))
        }
        (Some(_), Some(_)) => {
            let problem = "`plastic_compressibility` is given too, which is `compression` less `swelling`";
            Err(Error::input("compression", problem, "keep one of them"))
        }
        (None, None) => {
            let remedy = "give `compression` (λ*), or `plastic_compressibility` (λ* − κ*)";
            Err(Error::input("compression", "is missing", remedy))
        }
    }
}
