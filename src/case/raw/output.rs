//! What is written of a run, as it is written in the case.

use crate::io::frame::INTERNAL;
use crate::run;
use schemars::JsonSchema;
use serde::Deserialize;

/// What is written, and when.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// Time between frames (s). Default: one frame at the end of each phase.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub every: Option<f64>,
    /// The fields of the frames. Default: stress and displacement.
    pub fields: Option<Vec<Field>>,
    /// How the exported files are packed: compressed, or plain (larger, and what meshio reads). Default: compressed.
    pub encoding: Encoding,
    /// Whether the surface of the material points is written. It always is where a load or water acts on it.
    pub surface: bool,
    /// Columns of history.csv, which has a row for each step.
    pub history: Vec<History>,
}

/// A field of the frames.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Field {
    Displacement,
    Velocity,
    Stress,
    MeanStress,
    DeviatoricStress,
    PlasticStrain,
    DeformationGradient,
    PorePressure,
    Mass,
    InternalVariables,
    ShearStrength,
}

impl Field {
    /// The name in the case, in frames and in exported files.
    pub fn name(self) -> &'static str {
        match self {
            Self::Displacement => "displacement",
            Self::Velocity => "velocity",
            Self::Stress => "stress",
            Self::MeanStress => "mean_stress",
            Self::DeviatoricStress => "deviatoric_stress",
            Self::PlasticStrain => "plastic_strain",
            Self::DeformationGradient => "deformation_gradient",
            Self::PorePressure => "pore_pressure",
            Self::Mass => "mass",
            Self::InternalVariables => INTERNAL,
            Self::ShearStrength => "shear_strength",
        }
    }
}

/// How the exported files are packed.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Encoding {
    #[default]
    Compressed,
    Plain,
}

/// An entry of history.csv.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct History {
    /// The name of the columns.
    pub name: String,
    /// The name of a physical curve, a physical point, a region, a rigid structure or a wall.
    pub on: String,
    /// The quantities that are written of it.
    #[schemars(extend("minItems" = 1))]
    pub quantities: Vec<Quantity>,
}

/// A quantity of history.csv: means over the nodes of a curve or the points of a region, of a rigid structure those of its
/// centroid; reactions are sums, contact is the force of all contacts on a structure; moments are about the centroid.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    Ux,
    Uy,
    Vx,
    Vy,
    ReactionX,
    ReactionY,
    ContactX,
    ContactY,
    Rotation,
    ReactionMoment,
    ContactMoment,
    PorePressure,
}

impl From<Quantity> for run::Quantity {
    fn from(quantity: Quantity) -> Self {
        match quantity {
            Quantity::Ux => Self::Displacement(0),
            Quantity::Uy => Self::Displacement(1),
            Quantity::Vx => Self::Velocity(0),
            Quantity::Vy => Self::Velocity(1),
            Quantity::ReactionX => Self::Reaction(0),
            Quantity::ReactionY => Self::Reaction(1),
            Quantity::ContactX => Self::Contact(0),
            Quantity::ContactY => Self::Contact(1),
            Quantity::Rotation => Self::Rotation,
            Quantity::ReactionMoment => Self::ReactionMoment,
            Quantity::ContactMoment => Self::ContactMoment,
            Quantity::PorePressure => Self::PorePressure,
        }
    }
}
