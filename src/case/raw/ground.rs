//! The state of the ground as it is written: the stress before the first phase, and the water.

use super::{InDepth, InTime};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// The stress before the first phase.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InitialStress {
    /// Horizontal over vertical effective stress, of all soil or by the name of a material; the vertical stress is the weight above the point (-).
    pub k0: EarthPressures,
    /// What the run does with it before the first phase: equilibrium (a quasi-static phase of its own under the weight, after which displacements are
    /// counted from 0). Default: nothing.
    pub then: Option<Then>,
}

/// What becomes of an initial stress before the first phase.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Then {
    Equilibrium,
}

/// A number or a profile for all soil, or one of each material.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum EarthPressures {
    All(EarthPressure),
    ByMaterial(BTreeMap<String, EarthPressure>),
}

/// A number, a profile, or `{overconsolidation_ratio: R}`: (1 − sin φ) R^(sin φ), with the angle of friction φ of the material.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum EarthPressure {
    Given(InDepth),
    Overconsolidated(Overconsolidated),
}

/// Soil that bore more in the past.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Overconsolidated {
    /// Largest vertical effective stress of the past over that of today, 1 for normally consolidated soil (-).
    pub overconsolidation_ratio: InDepth,
}

/// Water around the soil and the structures, a load on their boundaries, and in the pores of the soil.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Water {
    /// Height y of the water level outside of the soil, in the time of each phase (m). Default: no water outside.
    pub level: Option<WaterTable>,
    /// Height y of the water level in the pores, in the time of each phase, or a line (m). With it, all materials are in effective stress.
    /// Default: no water in the pores.
    pub phreatic_level: Option<WaterTable>,
    /// Unit weight of the water (kN/m³).
    #[serde(default = "unit_weight_of_water")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub unit_weight: f64,
}

/// A height y, or `{line: [[x, y], …]}`.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum WaterTable {
    Level(InTime),
    Line(WaterLine),
}

/// A water table that is inclined. Only of the water in the pores: that outside is level.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct WaterLine {
    /// Places [x, y], x growing; the table is level beyond the first and the last (m).
    #[schemars(extend("minItems" = 2))]
    pub line: Vec<[f64; 2]>,
}

fn unit_weight_of_water() -> f64 {
    9.81
}
