//! Structures that are given by their axis.

use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A wall, lining or slab by its axis: a strip of finite elements, √(12 EI/EA) thick.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Plate {
    /// Places [x, y] of its axis, joined by straight lines; a ring ends where it begins (m).
    #[schemars(extend("minItems" = 2))]
    pub axis: Vec<[f64; 2]>,
    /// Stiffness along the axis (kN/m).
    #[serde(rename = "EA")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub ea: f64,
    /// Stiffness in bending (kNm²/m).
    #[serde(rename = "EI")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub ei: f64,
    /// Weight of an area of it, all of it, not that in excess of the soil (kN/m²).
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub weight: f64,
    /// Poisson's ratio (-).
    #[serde(default)]
    #[schemars(extend("exclusiveMaximum" = 0.5), range(min = 0))]
    pub poisson: f64,
    /// Length of its elements along the axis, at most (m). Default: its thickness.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub size: Option<f64>,
    /// Points of its axis [x, y], by name: elements end there, and supports, forces, `bars` and the history may name them (m).
    #[serde(default)]
    pub points: BTreeMap<String, [f64; 2]>,
}

/// An anchor, a strut or a spring: a bar that pulls or presses along the line between its ends.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Bar {
    /// The name of a point of a structure: a physical point, or one of `points` of a plate.
    pub from: String,
    /// The name of another such point, or a place [x, y] that does not move (m).
    pub to: BarEnd,
    /// Stiffness of a metre out of the plane: that of one bar over the spacing of the bars (kN/m).
    #[serde(rename = "EA")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub ea: f64,
    /// The length that stretches: an elongation of u makes a force EA u/length (m). Default: the distance of its ends.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub length: Option<f64>,
    /// The force that it has throughout the phase that begins with it or activates it, tension positive; of a metre out of the plane (kN). Default: it
    /// begins without force.
    pub prestress: Option<f64>,
    /// The largest force in tension, at which it yields; of a metre out of the plane (kN). Default: no limit.
    #[schemars(range(min = 0))]
    pub tension_limit: Option<f64>,
    /// The largest force in compression, at which it yields, as a positive number; of a metre out of the plane (kN). Default: no limit.
    #[schemars(range(min = 0))]
    pub compression_limit: Option<f64>,
}

/// The end of a bar.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum BarEnd {
    Point(String),
    Place([f64; 2]),
}
