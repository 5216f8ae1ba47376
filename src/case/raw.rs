//! The case file as it is written: one structure a block, names exactly the contract.
//!
//! Nothing is checked here beyond shape and simple ranges; the checker turns these into a
//! [`super::Case`]. The documentation comments become the descriptions of `mpm schema`, and the first
//! sentence of each is shown as a remedy, so each says what the entry is and its unit.

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
    /// The kind of geometry: plane_strain, axisymmetric (x is the radius) or solid.
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
    /// The surface of soil, wherever it moves, that has no excess pore pressure while water flows: all, or the name of a region.
    pub drained_surface: Option<String>,
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
    /// Order of the cells: 2 (T6, Q9) or 1 (T3, Q4).
    #[serde(default = "two")]
    #[schemars(range(min = 1, max = 2))]
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
    /// Material points a cell: 4, 9, 16 or 25 equal points, or 3, 6, 7 or 12 quadrature points of a triangle.
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
    /// The parameters of the model.
    #[serde(flatten)]
    pub parameters: BTreeMap<String, InDepth>,
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
    /// Horizontal permeability (m/s), 0 or above.
    #[schemars(range(min = 0))]
    pub x: f64,
    /// Vertical permeability (m/s), 0 or above.
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
    /// α (-), from 0 to 1: the shear is at most α times the strength of the soil; without friction and adhesion it is
    /// just that.
    #[schemars(range(min = 0, max = 1))]
    pub adhesion_factor: Option<f64>,
    /// Whether the two part where they are pulled: cut_off (they do) or no_separation (they do not).
    #[serde(default)]
    pub tension: Tension,
}

/// What pulling does to a contact.
#[derive(Clone, Copy, Debug, Default, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Tension {
    #[default]
    CutOff,
    NoSeparation,
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

/// The numerical method.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Numerics {
    /// How gradients at the points are formed: mpm (plain), ddmp, gimp, cpdi, cpdi2 or bspline.
    pub gradient: Gradient,
    /// The integration weights: points (the volumes of the points) or fitted.
    pub quadrature: Quadrature,
    /// Who carries the mean stress of nearly incompressible and undrained materials: a field of pressure unknowns, or
    /// none. Without it a field where Poisson's ratio is 0.45 or more or a material is undrained.
    pub pressure: Option<Pressure>,
    /// When the grid goes back to its first shape: every_step, never, or {min_quality: q, max_stretch: s}.
    pub restore: Restore,
    /// Spectral radius ρ∞ (-) of generalised-α at high frequencies, from 0 to 1; 1 damps nothing.
    #[schemars(range(min = 0, max = 1))]
    pub spectral_radius: f64,
    /// Newton's iteration ends when the residual is this small beside the forces (-).
    #[schemars(extend("exclusiveMinimum" = 0), extend("exclusiveMaximum" = 1))]
    pub tolerance: f64,
    /// Iterations after which a step is halved.
    #[schemars(range(min = 1, max = 1000))]
    pub max_iterations: usize,
    /// Stiffness of empty cells over that of the soil (-).
    #[schemars(extend("exclusiveMinimum" = 0), extend("exclusiveMaximum" = 1))]
    pub empty_stiffness: f64,
}

impl Default for Numerics {
    fn default() -> Self {
        Self {
            gradient: Gradient::Mpm,
            quadrature: Quadrature::Fitted,
            pressure: None,
            restore: Restore::Quality(RestoreQuality { min_quality: 0.5, max_stretch: None }),
            spectral_radius: 0.9,
            tolerance: 1e-8,
            max_iterations: 25,
            empty_stiffness: 1e-5,
        }
    }
}

/// How gradients at the points are formed.
#[derive(Clone, Copy, Debug, Deserialize, serde::Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Gradient {
    Mpm,
    Ddmp,
    Gimp,
    Cpdi,
    Cpdi2,
    Bspline,
}

/// The integration weights.
#[derive(Clone, Copy, Debug, Deserialize, serde::Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Quadrature {
    Points,
    Fitted,
}

/// Who carries the mean stress.
#[derive(Clone, Copy, Debug, Deserialize, serde::Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Pressure {
    Field,
    None,
}

/// When the grid goes back to its first shape.
#[derive(Clone, Copy, Debug, Deserialize, serde::Serialize, JsonSchema)]
#[serde(untagged)]
pub enum Restore {
    Named(RestoreName),
    Quality(RestoreQuality),
}

/// The restorations that need no number.
#[derive(Clone, Copy, Debug, Deserialize, serde::Serialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum RestoreName {
    EveryStep,
    Never,
}

/// Restoration by quality.
#[derive(Clone, Copy, Debug, Deserialize, serde::Serialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RestoreQuality {
    /// The grid is restored when a cell's quality falls below this share of its first one (-).
    #[schemars(range(min = 0, max = 1))]
    pub min_quality: f64,
    /// And when an edge is this many times as long as at first, or as short (-), above 1.
    /// Default: 1.3, and 1.5 in a scene with contacts.
    #[schemars(extend("exclusiveMinimum" = 1))]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub max_stretch: Option<f64>,
}

/// A phase of the analysis.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Phase {
    /// The name of the phase, for logs and errors.
    pub name: String,
    /// The kind of analysis: quasi_static (no inertia), dynamic, auto (quasi-static, and dynamic where there is no
    /// equilibrium until there is rest), strength_reduction (quasi-static until no equilibrium is left) or consolidation.
    pub analysis: Analysis,
    /// Duration (s), above 0; in a quasi_static phase a fictitious time that loads vary in.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub duration: f64,
    /// Time steps.
    pub step: Step,
    /// Displacements since the beginning of the phase, by the name of a physical curve or a rigid structure.
    #[serde(default)]
    pub prescribe: BTreeMap<String, Motion>,
    /// Loads on named curves, or on the surface of the material points.
    #[serde(default)]
    pub tractions: Vec<Traction>,
    /// Height y (m) of the water level in this phase; without it that of `water`.
    pub water_level: Option<InTime>,
    /// Height y (m) up to which water stands in the pores in this phase; without it that of `water`.
    pub phreatic_level: Option<InTime>,
    /// Factor on gravity in the phase (-); without it 1.
    pub gravity: Option<InTime>,
    /// Structures, walls and contacts, by name, that are taken away as the phase begins: until they are activated they carry
    /// nothing, touch nothing and stay where they are.
    #[serde(default)]
    pub deactivate: Vec<String>,
    /// Structures, walls and contacts, by name, that come back as the phase begins.
    #[serde(default)]
    pub activate: Vec<String>,
    /// Materials, by the names of regions, that these take as the phase begins, with the stress that they have.
    #[serde(default)]
    pub materials: BTreeMap<String, String>,
    /// Whether displacements are counted from the beginning of the phase in frames and history.
    #[serde(default)]
    pub reset_displacements: bool,
    /// Conditions any of which ends the phase before its time.
    #[serde(default)]
    pub until: Vec<Until>,
    /// What the strengths of all soil and contacts are divided by in the phase (-), above 0; without it 1.
    pub strength_reduction: Option<InTime>,
}

/// A condition that ends a phase: a quantity of the history that is above or below a bound, or equilibrium.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Until {
    /// The name of an entry of `output.history`.
    pub of: Option<String>,
    /// A quantity of that entry.
    pub quantity: Option<Quantity>,
    /// The phase ends when the quantity is this much or more.
    pub above: Option<f64>,
    /// The phase ends when the quantity is this much or less.
    pub below: Option<f64>,
    /// The phase, which has inertia, ends when its kinetic energy has fallen to this part of its largest (-).
    #[schemars(extend("exclusiveMinimum" = 0), extend("exclusiveMaximum" = 1))]
    pub equilibrium: Option<f64>,
}

/// The kind of analysis.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum Analysis {
    QuasiStatic,
    Dynamic,
    Auto,
    StrengthReduction,
    Consolidation,
}

/// Time steps: halved when Newton fails, growing again after.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// First time step (s), above 0.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub initial: f64,
    /// Smallest time step (s), at most `initial`; without it a ten-thousandth of `initial`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub min: Option<f64>,
    /// Largest time step (s), at least `initial`; without it `initial`.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub max: Option<f64>,
}

/// A number (constant), `{rate: r}` (growing from 0 by r a second) or `{table: [[t, v], …]}`, in the phase's own time.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum InTime {
    Constant(f64),
    Rate(Rate),
    Table(Table),
}

/// A value that grows from 0.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rate {
    /// Growth a second.
    pub rate: f64,
}

/// A value linear between the entries of a table, and constant before the first and after the last.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Table {
    /// Pairs [time, value], times growing.
    #[schemars(extend("minItems" = 1))]
    pub table: Vec<[f64; 2]>,
}

/// Displacements prescribed on a curve, or of a rigid structure by its name.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Motion {
    /// Horizontal (in axisymmetry radial) displacement (m) since the beginning of the phase.
    pub ux: Option<InTime>,
    /// Vertical displacement (m) since the beginning of the phase.
    pub uy: Option<InTime>,
    /// Rotation (rad) of a rigid structure since the beginning of the phase, anticlockwise.
    pub rotation: Option<InTime>,
}

/// A load: `on` a named curve, dead and per area of the undeformed curve; or on the `surface` of the material points,
/// which it follows, per area of the surface as it is.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Traction {
    /// The name of a physical curve.
    pub on: Option<String>,
    /// In place of a curve, the surface of the material points of a region by its name, or of `all`.
    pub surface: Option<String>,
    /// Horizontal (in axisymmetry radial) traction (kPa).
    pub tx: Option<InTime>,
    /// Vertical traction (kPa), positive upwards.
    pub ty: Option<InTime>,
    /// Pressure (kPa) on a surface, at right angles to it, positive in compression; it may grow with depth.
    pub pressure: Option<Load>,
    /// Traction (kPa) along a surface, positive in the sense that has the material on its left.
    pub shear: Option<InTime>,
    /// A factor (-) on a pressure that is given as a profile.
    pub factor: Option<InTime>,
    /// The part of a surface that is loaded; without it all of it.
    #[serde(rename = "where")]
    pub within: Option<Window>,
}

/// A number in time, or one that grows with depth.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Load {
    InTime(InTime),
    Profile(Profile),
}

/// A box, fixed in space.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Window {
    /// From and to (m), horizontally.
    pub x: Option<[f64; 2]>,
    /// From and to (m), vertically.
    pub y: Option<[f64; 2]>,
}

/// What is written, and when.
#[derive(Debug, Default, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Output {
    /// Time between frames (s), above 0; without it one frame at the end of each phase.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub every: Option<f64>,
    /// The fields of the frames; without it stress and displacement.
    pub fields: Option<Vec<Field>>,
    /// How the exported files are packed: compressed, or plain (what meshio reads).
    pub encoding: Encoding,
    /// Whether the surface of the material points is written; it is wherever a load or water acts on it.
    pub surface: bool,
    /// Curves of history.csv, a row each step.
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
    /// The name of a physical curve, a physical point or a region.
    pub on: String,
    /// What is written of it.
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

fn two() -> u8 {
    2
}

fn unit_weight_of_water() -> f64 {
    9.81
}
