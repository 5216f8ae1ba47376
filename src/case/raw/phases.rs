//! Phases as they are written: steps, motions, loads, and what ends a phase.

use super::{Profile, Quantity, Tension};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

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
    /// Settings that contacts, by their `name`, take as the phase begins; what is left out stays.
    #[serde(default)]
    pub contacts: BTreeMap<String, ContactChange>,
    /// Whether displacements are counted from the beginning of the phase in frames and history.
    #[serde(default)]
    pub reset_displacements: bool,
    /// Conditions any of which ends the phase before its time.
    #[serde(default)]
    pub until: Vec<Until>,
    /// What the strengths of all soil and contacts are divided by in the phase (-), above 0; without it 1.
    pub strength_reduction: Option<InTime>,
}

/// Settings of a contact from a phase on.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactChange {
    /// Coefficient of friction tan δ (-).
    #[schemars(range(min = 0))]
    pub friction: Option<f64>,
    /// Adhesion (kPa).
    #[schemars(range(min = 0))]
    pub adhesion: Option<f64>,
    /// α (-), from 0 to 1, or `none`: the share of the shear strength of the soil that limits the shear.
    pub adhesion_factor: Option<AdhesionFactor>,
    /// Whether the two part where they are pulled: cut_off, no_separation or {limit: t}.
    pub tension: Option<Tension>,
}

/// The share of the shear strength of the soil that limits the shear of a contact.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum AdhesionFactor {
    Share(f64),
    Named(NoFactor),
}

/// No such limit.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema, PartialEq, Eq)]
#[serde(rename_all = "snake_case")]
pub enum NoFactor {
    None,
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
