//! Materials as they are written.

use super::InDepth;
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A material; its schema is made from the list of models.
#[derive(Debug, Deserialize)]
pub struct Material {
    /// The name of a model.
    pub model: String,
    /// Density (t/m³).
    pub density: Option<InDepth>,
    /// Unit weight (kN/m³).
    pub unit_weight: Option<InDepth>,
    /// Whether water can leave its pores.
    pub drainage: Option<Drainage>,
    /// Poisson's ratio of the undrained soil as a whole (-).
    pub undrained_poisson: Option<f64>,
    /// Permeability of an undrained soil, whose water flows in consolidation.
    pub permeability: Option<Permeability>,
    /// Volume of the pores over that of the soil (-), and bulk modulus of the water (kPa): in place of
    /// `undrained_poisson`.
    pub porosity: Option<f64>,
    pub water_bulk_modulus: Option<f64>,
    /// Unit weight of the water (kN/m³).
    pub water_unit_weight: Option<f64>,
    /// The random field of its strength.
    pub random_strength: Option<RandomStrength>,
    /// The parameters of the model.
    #[serde(flatten)]
    pub parameters: BTreeMap<String, InDepth>,
}

/// Strength that varies at random in space: the strengths of the model are multiplied by a lognormal field with the mean 1.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RandomStrength {
    /// Standard deviation of the strength over its mean (-).
    #[schemars(range(min = 0))]
    pub coefficient_of_variation: f64,
    /// Horizontal scale of fluctuation: the distance over which the strength is correlated (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub horizontal_scale: f64,
    /// Vertical scale of fluctuation (m).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub vertical_scale: f64,
    /// Correlation of the logarithm of the strength at two places, with d² = (Δx/horizontal_scale)² + (Δy/vertical_scale)²: markov, exp(−2d), or gaussian, exp(−πd²),
    /// which is smooth. Default: markov.
    #[serde(default)]
    pub correlation: Correlation,
    /// The number of the realisation. The same number gives the same field on every mesh.
    pub seed: u64,
}

/// A correlation function.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Correlation {
    #[default]
    Markov,
    Gaussian,
}

/// Whether water can leave the pores of a material.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Drainage {
    Drained,
    Undrained,
}

/// A permeability (m/s), or `{x, y}` where it differs horizontally and vertically.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Permeability {
    Uniform(f64),
    ByAxis(PermeabilityByAxis),
}

/// Horizontal (in axisymmetry radial) and vertical permeability.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PermeabilityByAxis {
    /// Horizontal permeability (m/s).
    #[schemars(range(min = 0))]
    pub x: f64,
    /// Vertical permeability (m/s).
    #[schemars(range(min = 0))]
    pub y: f64,
}

impl Permeability {
    /// In x and y (m/s).
    pub fn by_axis(self) -> [f64; 2] {
        match self {
            Self::Uniform(k) => [k; 2],
            Self::ByAxis(PermeabilityByAxis { x, y }) => [x, y],
        }
    }
}
