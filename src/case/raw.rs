//! The case file as it is written: one structure a block, names exactly the contract.
//!
//! Nothing is checked here beyond shape and simple ranges; the checker turns these into a
//! [`super::Case`]. The documentation comments become the descriptions of `mpm schema`, and the first
//! sentence of each is shown as a remedy, so each says what the entry is and its unit.

mod materials;
mod numerics;
mod output;
mod phases;

pub use materials::*;
pub use numerics::*;
pub use output::*;
pub use phases::*;

use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A case of mpm. Units are kN, m, s and t throughout; stress and strain are positive in tension; y is up.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CaseFile {
    /// A line that names the case in logs and pictures.
    #[serde(default)]
    pub title: String,
    /// The kind of geometry: plane_strain, axisymmetric (x is the radius), or solid (not available yet).
    pub geometry: Geometry,
    /// The background mesh.
    pub mesh: Mesh,
    /// What fills each physical surface of the .geo, by its name.
    #[schemars(extend("minProperties" = 1))]
    pub regions: BTreeMap<String, Region>,
    /// The materials, by name.
    #[serde(default)]
    pub materials: BTreeMap<String, Material>,
    /// Contacts between structures and soil.
    #[serde(default)]
    pub contacts: Vec<Contact>,
    /// Displacements held at zero in every phase, by the name of a physical curve or a rigid structure.
    #[serde(default)]
    pub supports: BTreeMap<String, Components>,
    /// Acceleration of gravity (m/s²).
    #[serde(default)]
    pub gravity: Vector,
    /// The stress before the first phase; without it there is none.
    pub initial_stress: Option<InitialStress>,
    /// Excess pore pressure (kPa, compression positive) before the first phase, by the name of a region.
    #[serde(default)]
    pub initial_pore_pressure: BTreeMap<String, InDepth>,
    /// The velocity before the first phase, by the name of a region; without it everything is at rest.
    #[serde(default)]
    pub initial_velocity: BTreeMap<String, Velocity>,
    /// Water whose pressure acts on all that is below its level; without it none.
    pub water: Option<Water>,
    /// The numerical method.
    #[serde(default)]
    pub numerics: Numerics,
    /// The phases of the analysis, one after the other.
    #[schemars(extend("minItems" = 1))]
    pub phases: Vec<Phase>,
    /// What is written, and when.
    #[serde(default)]
    pub output: Output,
}

/// What the stages make.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Product {
    Mesh,
    Points,
    Results,
    /// What ParaView reads.
    Series,
}

/// What each entry of [`CaseFile`] shapes itself, beside what is made from that. What it shapes is stale when it changes. Further
/// entries are [`super::keyed::Keyed`].
pub const SHAPES: [(&str, &[Product]); 15] = [
    ("title", &[]),
    ("geometry", &[Product::Points, Product::Results]),
    ("mesh", &[Product::Mesh]),
    ("regions", &[Product::Points, Product::Results]),
    ("materials", &[Product::Points, Product::Results]),
    ("contacts", &[Product::Results]),
    ("supports", &[Product::Results]),
    ("gravity", &[Product::Points, Product::Results]),
    ("initial_stress", &[Product::Points]),
    ("initial_pore_pressure", &[Product::Points]),
    ("initial_velocity", &[Product::Points]),
    ("water", &[Product::Points, Product::Results]),
    ("numerics", &[Product::Results]),
    ("phases", &[Product::Results]),
    ("output", &[Product::Results, Product::Series]),
];

/// The kind of geometry.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Geometry {
    PlaneStrain,
    Axisymmetric,
    Solid,
}

/// The background mesh.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// The .geo file, relative to the case file.
    pub geo: String,
    /// Order of the cells: 2 (T6, Q9), 1 (T3, Q4), or 3 (Q16, for cubic B-splines).
    #[serde(default = "two")]
    #[schemars(range(min = 1, max = 3))]
    pub order: u8,
    /// Whether quadrangles of order 2 have no centre node (Q8 in place of Q9).
    #[serde(default)]
    pub incomplete: bool,
    /// Values for the DefineConstant parameters of the .geo, by name.
    #[serde(default)]
    pub parameters: BTreeMap<String, f64>,
}

/// What fills a physical surface.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Region {
    /// What the region is: mpm (material points), buffer (empty cells), fem or structure.
    pub kind: RegionKind,
    /// The name of an entry of `materials`.
    pub material: Option<String>,
    /// Material points a cell: 4, 9, 16 or 25 equal points, or 3, 6, 7 or 12 quadrature points of a triangle. Without it 16.
    #[schemars(extend("enum" = [3, 4, 6, 7, 9, 12, 16, 25]))]
    pub points_per_cell: Option<usize>,
    /// Whether a structure keeps its shape: it moves and turns as a whole.
    pub rigid: Option<bool>,
}

/// What a region is.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum RegionKind {
    Mpm,
    Buffer,
    Fem,
    Structure,
}

impl RegionKind {
    /// As the case file has it.
    pub fn name(self) -> &'static str {
        match self {
            Self::Mpm => "mpm",
            Self::Buffer => "buffer",
            Self::Fem => "fem",
            Self::Structure => "structure",
        }
    }
}

/// A number, or `{top, gradient, datum}`: `top` at the height `datum` and above, growing downwards by `gradient`.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum InDepth {
    Constant(f64),
    Profile(Profile),
}

/// A number that grows with depth.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// Value at the height `datum` and above.
    pub top: f64,
    /// Growth per metre below `datum`, 0 or above.
    #[schemars(range(min = 0))]
    pub gradient: f64,
    /// Height y (m) at which the growth begins.
    #[serde(default)]
    pub datum: f64,
}

/// Displacements, or the excess pore pressure, held on a curve, or displacements of a rigid structure by its name.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Components {
    /// Horizontal (in axisymmetry radial) displacement, held at 0.
    pub ux: Option<f64>,
    /// Vertical displacement, held at 0.
    pub uy: Option<f64>,
    /// Rotation of a rigid structure, held at 0.
    pub rotation: Option<f64>,
    /// Excess pore pressure, held at 0 while water flows: the curve is drained.
    pub pore_pressure: Option<f64>,
}

/// Contact between a structure or a wall and soil, or between two bodies.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// A name by which phases take the contact away.
    pub name: Option<String>,
    /// The name of a region of kind structure.
    pub structure: Option<String>,
    /// In place of a structure, the name of a physical curve: a rigid wall.
    pub wall: Option<String>,
    /// The name of a region of kind mpm, or a list of them.
    pub soil: Option<OneOrMore>,
    /// In place of soil, the name of another region of kind structure or fem.
    pub against: Option<String>,
    /// Coefficient of friction tan δ (-).
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub friction: f64,
    /// Adhesion (kPa).
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub adhesion: f64,
    /// α (-), from 0 to 1: the shear is at most α times the shear strength that the soil has; without friction and adhesion it is
    /// just that.
    #[schemars(range(min = 0, max = 1))]
    pub adhesion_factor: Option<f64>,
    /// Whether the two part where they are pulled: cut_off (they do), no_separation (they do not), or {limit: t}, where the tension
    /// would exceed t.
    #[serde(default)]
    pub tension: Tension,
}

/// What pulling does to a contact.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Tension {
    Named(TensionName),
    Limited(TensionLimit),
}

impl Default for Tension {
    fn default() -> Self {
        Self::Named(TensionName::CutOff)
    }
}

/// What needs no number.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum TensionName {
    CutOff,
    NoSeparation,
}

/// A tensile strength.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TensionLimit {
    /// The largest tension (kPa).
    #[schemars(range(min = 0))]
    pub limit: f64,
}

impl Tension {
    /// The largest tension (kPa).
    pub fn limit(self) -> f64 {
        match self {
            Self::Named(TensionName::CutOff) => 0.0,
            Self::Named(TensionName::NoSeparation) => f64::INFINITY,
            Self::Limited(TensionLimit { limit }) => limit,
        }
    }
}

/// A name or a list of names.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum OneOrMore {
    One(String),
    More(Vec<String>),
}

impl OneOrMore {
    pub fn names(&self) -> &[String] {
        match self {
            Self::One(name) => std::slice::from_ref(name),
            Self::More(names) => names,
        }
    }
}

/// A vector in the plane.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Vector {
    /// Horizontal (in axisymmetry radial) component.
    #[serde(default)]
    pub x: f64,
    /// Vertical component, positive upwards.
    #[serde(default)]
    pub y: f64,
}

/// The stress before the first phase.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct InitialStress {
    /// Horizontal over vertical stress (-), 0 or above; the vertical stress is the weight above the point.
    #[schemars(range(min = 0))]
    pub k0: f64,
}

/// Water around the soil and the structures, a load on their boundaries, and in the pores of the soil.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Water {
    /// Height y (m) of its level outside of the soil, in the time of each phase; without it there is none.
    pub level: Option<InTime>,
    /// Height y (m) up to which it stands in the pores of the soil, in the time of each phase: with it, materials are those of the effective
    /// stress. Without it there is none.
    pub phreatic_level: Option<InTime>,
    /// Unit weight (kN/m³), above 0.
    #[serde(default = "unit_weight_of_water")]
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub unit_weight: f64,
}

/// A velocity field: `velocity + gradient · (x − centre)` plus a standing wave.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Velocity {
    /// Velocity at the centre (m/s).
    #[serde(default)]
    pub velocity: Vector,
    /// Velocity gradient (1/s), in rows: [[0, -w], [w, 0]] is a spin of w radians a second.
    #[serde(default)]
    pub gradient: [[f64; 2]; 2],
    /// The point (m) the gradient is taken about.
    #[serde(default)]
    pub centre: Vector,
    /// A standing wave.
    pub standing_wave: Option<StandingWave>,
}

/// A velocity component `amplitude · sin(wave_number · coordinate)`.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StandingWave {
    /// The component of the velocity: x or y.
    pub component: Axis,
    /// The coordinate it varies along: x or y.
    pub along: Axis,
    /// Largest velocity (m/s).
    pub amplitude: f64,
    /// Wave number (rad/m).
    pub wave_number: f64,
}

/// A coordinate axis.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    X,
    Y,
}

fn two() -> u8 {
    2
}

fn unit_weight_of_water() -> f64 {
    9.81
}
