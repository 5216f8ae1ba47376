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
    /// Whether the surface of the material points is written. It always is where a load or water acts on it, or a thickness is measured.
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
    Strain,
    PlasticStrain,
    DeformationGradient,
    PorePressure,
    Mass,
    InternalVariables,
    ShearStrength,
    PlasticPoints,
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
            Self::Strain => "strain",
            Self::PlasticStrain => "plastic_strain",
            Self::DeformationGradient => "deformation_gradient",
            Self::PorePressure => "pore_pressure",
            Self::Mass => "mass",
            Self::InternalVariables => INTERNAL,
            Self::ShearStrength => "shear_strength",
            Self::PlasticPoints => "plastic_points",
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
    /// The name of a physical curve, a physical point, a region, a rigid structure, a wall or a bar.
    pub on: Option<String>,
    /// A point in the soil: x and y (m).
    pub at: Option<[f64; 2]>,
    /// Whether the entry is of the soil that was seeded `at` the point, wherever that goes. Default: false.
    #[serde(default)]
    pub follow: bool,
    /// A box: x and y of its lower left corner, then of its upper right one (m).
    pub r#box: Option<[f64; 4]>,
    /// A line: x and y of one end, then of the other (m).
    pub line: Option<[f64; 4]>,
    /// The quantities that are written of it.
    #[schemars(extend("minItems" = 1))]
    pub quantities: Vec<Quantity>,
}

/// A quantity of history.csv: means over the nodes of a curve, the points of a region or of a box, or a line; of a rigid structure those of its
/// centroid; reactions, mass and volume are sums, mass_in, mass_out, volume_in and volume_out what has entered and left through a curve since the run began, contact is the force of all contacts on a structure; moments are about the centroid;
/// normal and shear force and bending moment are those in the section of a plate where they are largest in amount.
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
    StressXx,
    StressYy,
    StressZz,
    StressXy,
    MeanStress,
    DeviatoricStress,
    StrainXx,
    StrainYy,
    StrainZz,
    StrainXy,
    PlasticStrain,
    Mass,
    Volume,
    MassIn,
    MassOut,
    VolumeIn,
    VolumeOut,
    XMin,
    XMax,
    YMin,
    YMax,
    Thickness,
    NormalForce,
    ShearForce,
    BendingMoment,
    Force,
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
            Quantity::StressXx => Self::Stress(0),
            Quantity::StressYy => Self::Stress(1),
            Quantity::StressZz => Self::Stress(2),
            Quantity::StressXy => Self::Stress(3),
            Quantity::MeanStress => Self::MeanStress,
            Quantity::DeviatoricStress => Self::DeviatoricStress,
            Quantity::StrainXx => Self::Strain(0),
            Quantity::StrainYy => Self::Strain(1),
            Quantity::StrainZz => Self::Strain(2),
            Quantity::StrainXy => Self::Strain(3),
            Quantity::PlasticStrain => Self::PlasticStrain,
            Quantity::Mass => Self::Mass,
            Quantity::Volume => Self::Volume,
            Quantity::MassIn => Self::In(0),
            Quantity::MassOut => Self::Out(0),
            Quantity::VolumeIn => Self::In(1),
            Quantity::VolumeOut => Self::Out(1),
            Quantity::XMin => Self::Least(0),
            Quantity::XMax => Self::Most(0),
            Quantity::YMin => Self::Least(1),
            Quantity::YMax => Self::Most(1),
            Quantity::Thickness => Self::Thickness,
            Quantity::Force => Self::BarForce,
            Quantity::NormalForce => Self::Section(run::Force::Normal),
            Quantity::ShearForce => Self::Section(run::Force::Shear),
            Quantity::BendingMoment => Self::Section(run::Force::Moment),
        }
    }
}
