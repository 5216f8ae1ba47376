//! The case file as it is written: one structure a block, names exactly the contract.
//!
//! Nothing is checked here beyond shape and simple ranges; the checker turns these into a
//! [`super::Case`]. The documentation comments become the descriptions of `mpm schema`, and the first
//! sentence of each is shown as a remedy, so each says what the entry is and its unit.

mod ground;
mod materials;
mod numerics;
mod output;
mod phases;
mod plate;

pub use ground::*;
pub use materials::*;
pub use numerics::*;
pub use output::*;
pub use phases::*;
pub use plate::*;

use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A case of mpm. Units are kN, m, s and t throughout; stress and strain are positive in tension; y is up.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CaseFile {
    /// A line that names the case in logs and pictures. Default: empty.
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
    /// Anchors, struts and springs, by name: bars between two points of structures, or such a point and a place that does not move.
    #[serde(default)]
    pub bars: BTreeMap<String, Bar>,
    /// Displacements held at zero in every phase, by the name of a physical curve or a rigid structure.
    #[serde(default)]
    pub supports: BTreeMap<String, Components>,
    /// Acceleration of gravity (m/s²). Default: none.
    #[serde(default)]
    pub gravity: Vector,
    /// The stress before the first phase. Default: none.
    pub initial_stress: Option<InitialStress>,
    /// Excess pore pressure before the first phase, compression positive, by the name of a region (kPa). Default: none.
    #[serde(default)]
    pub initial_pore_pressure: BTreeMap<String, InDepth>,
    /// The velocity before the first phase, by the name of a region. Default: at rest.
    #[serde(default)]
    pub initial_velocity: BTreeMap<String, Velocity>,
    /// Water at rest outside of the soil, in its pores, or both. Default: none.
    pub water: Option<Water>,
    /// The surface of soil, wherever it moves, that has no excess pore pressure while water flows: all, or the name of a region. Default: none.
    pub drained_surface: Option<String>,
    /// The end of a phase of another run, from which the phases go on. Default: the points as seeded.
    pub start_from: Option<StartFrom>,
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

/// The end of a phase of another run, with the same mesh and points.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct StartFrom {
    /// The output folder of the run, relative to the case file.
    pub run: String,
    /// The name of the phase. Default: the last one.
    pub phase: Option<String>,
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

/// What each entry of [`CaseFile`] shapes itself, beside what is made from that. What it shapes is stale when it changes.
pub const SHAPES: [(&str, &[Product]); 18] = [
    ("title", &[]),
    ("geometry", &[Product::Points, Product::Results]),
    ("mesh", &[Product::Mesh]),
    ("regions", &[Product::Points, Product::Results]),
    ("materials", &[Product::Points, Product::Results]),
    ("contacts", &[Product::Results]),
    ("bars", &[Product::Results]),
    ("supports", &[Product::Results]),
    ("gravity", &[Product::Points, Product::Results]),
    ("initial_stress", &[Product::Points, Product::Results]),
    ("initial_pore_pressure", &[Product::Points]),
    ("initial_velocity", &[Product::Points]),
    ("water", &[Product::Points, Product::Results]),
    ("drained_surface", &[Product::Results]),
    // By the hash of the state that it names.
    ("start_from", &[]),
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
    /// The .geo file, relative to the case file. This or `file`.
    pub geo: Option<String>,
    /// A mesh of Gmsh (.msh), Abaqus (.inp) or Salome (.med), relative to the case file, in place of a .geo. This or `geo`.
    pub file: Option<String>,
    /// Order of the cells: 2 (T6, Q9), 1 (T3, Q4), or 3 (Q16, for cubic B-splines). Default: 2, or with `file` that of its cells.
    #[schemars(range(min = 1, max = 3))]
    pub order: Option<u8>,
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
    /// What the region is: mpm (material points), buffer (empty cells that soil may move into), fem (finite elements that share nodes with the grid) or
    /// structure (finite elements with a mesh of their own, over the grid).
    pub kind: RegionKind,
    /// The name of an entry of `materials`. Not of a buffer.
    pub material: Option<String>,
    /// Material points a cell, of mpm: 4, 9, 16 or 25 equal points, or 3, 6, 7 or 12 quadrature points of a triangle. Default: 16.
    #[schemars(extend("enum" = [3, 4, 6, 7, 9, 12, 16, 25]))]
    pub points_per_cell: Option<usize>,
    /// Whether a structure keeps its shape and moves and turns as a whole. Default: false.
    pub rigid: Option<bool>,
    /// A wall, lining or slab by its axis: a structure that the .geo does not have, and without `material`.
    pub plate: Option<Plate>,
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

/// A number, or `{top, gradient, datum}`: `top` at the height `datum` and above, growing downwards by `gradient`. One that falls has a
/// gradient below 0, and `least`.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum InDepth {
    Constant(f64),
    Profile(Profile),
}

/// A number that grows with depth, or falls.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Profile {
    /// Value at the height `datum` and above.
    pub top: f64,
    /// Growth per metre below `datum`. A negative one lets the value fall with depth, down to `least`.
    pub gradient: f64,
    /// Height y at which the growth begins (m).
    #[serde(default)]
    pub datum: f64,
    /// The least value of a profile that falls with depth, which needs it.
    pub least: Option<f64>,
}

/// Displacements, or the excess pore pressure, held on a curve, or displacements of a rigid structure by its name.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Components {
    /// Horizontal (in axisymmetry radial) displacement, held at 0 (m).
    pub ux: Option<f64>,
    /// Vertical displacement, held at 0 (m).
    pub uy: Option<f64>,
    /// Displacement across a curve of any direction, held at 0: the soil slides along it without friction and does not part from it (m).
    pub un: Option<f64>,
    /// Rotation of a rigid structure, held at 0 (rad).
    pub rotation: Option<f64>,
    /// Excess pore pressure, held at 0 while water flows: the curve is drained (kPa).
    pub pore_pressure: Option<f64>,
    /// Whether waves leave there: in dynamic phases the components that are not held here have dashpots of ρ c_p across the curve and ρ c_s along it, of
    /// the soil beside it, in place of supports.
    #[serde(default)]
    pub absorbing: bool,
    /// Whether soil leaves the model there, in dynamic phases that neither prescribe the curve nor have it as a wall.
    #[serde(default)]
    pub outflow: bool,
    /// Springs under the curve, free of force as the run begins: what they resist a displacement, per area of the undeformed curve, in all phases (kN/m³).
    pub springs: Option<Yielding>,
    /// Dashpots under the curve: what they resist a velocity, per area of the undeformed curve, in steps with inertia. Where there are no springs beside
    /// them, the curve is held in other phases (kPa s/m).
    pub dashpots: Option<Yielding>,
    /// The name of the opposite side, whose nodes at the same heights have the same displacements (tied degrees of freedom).
    pub tied: Option<String>,
}

/// What a curve resists, across and along itself.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Yielding {
    /// Across the curve.
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub normal: f64,
    /// Along the curve.
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub tangential: f64,
}

/// Contact between a structure or a wall and soil, or between two bodies.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Contact {
    /// A name by which phases deactivate and activate the contact.
    pub name: Option<String>,
    /// The name of a region of kind structure.
    pub structure: Option<String>,
    /// In place of a structure, the name of a physical curve: a rigid wall.
    pub wall: Option<String>,
    /// The name of a region of kind mpm, or a list of them. Default: all regions of kind mpm.
    pub soil: Option<OneOrMore>,
    /// In place of soil, the name of another region of kind structure, or of one of kind fem.
    pub against: Option<String>,
    /// Coefficient of friction tan δ (-).
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub friction: f64,
    /// Adhesion c_a (kPa).
    #[serde(default)]
    #[schemars(range(min = 0))]
    pub adhesion: f64,
    /// α: the shear is at most α times the shear strength of the soil as the step begins (-). Without friction and adhesion the shear limit is
    /// α times that strength. Default: no such limit.
    #[schemars(range(min = 0, max = 1))]
    pub adhesion_factor: Option<f64>,
    /// What happens where the two are pulled apart: cut_off (they part), no_separation (they do not), or {limit: t} (they part where
    /// the tension would exceed t). Default: cut_off.
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
    /// What fills the gap that opens there: water, which ends the tension; or vapour, so that the tension stays at the limit until the gap has
    /// closed. Default: water.
    #[serde(default)]
    pub gap: Filling,
}

/// What fills a gap that opens at the largest tension.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Filling {
    #[default]
    Water,
    Vapour,
}

impl Tension {
    /// The largest tension (kPa).
    pub fn limit(self) -> f64 {
        match self {
            Self::Named(TensionName::CutOff) => 0.0,
            Self::Named(TensionName::NoSeparation) => f64::INFINITY,
            Self::Limited(TensionLimit { limit, .. }) => limit,
        }
    }

    /// Whether the gap that opens keeps the tension.
    pub fn is_sealed(self) -> bool {
        matches!(self, Self::Limited(TensionLimit { gap: Filling::Vapour, .. }))
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

/// A velocity field: `velocity + gradient · (x − centre)` plus a standing wave.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Velocity {
    /// Velocity at the centre (m/s). Default: 0.
    #[serde(default)]
    pub velocity: Vector,
    /// Velocity gradient, in rows (1/s): [[0, -w], [w, 0]] is a spin of w radians a second.
    #[serde(default)]
    pub gradient: [[f64; 2]; 2],
    /// The point that the gradient is taken about (m). Default: the origin.
    #[serde(default)]
    pub centre: Vector,
    /// A standing wave on top of that. Default: none.
    pub standing_wave: Option<StandingWave>,
}

/// A velocity component `amplitude · sin(wave_number · coordinate)`.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq)]
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
