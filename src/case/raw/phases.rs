//! Phases as they are written: steps, motions, loads, and what ends a phase.

use super::{Axis, Profile, Quantity, Tension, WaterTable};
use schemars::JsonSchema;
use serde::Deserialize;
use std::collections::BTreeMap;

/// A phase of the analysis.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Phase {
    /// The name of the phase, for logs and messages. Each phase has its own.
    pub name: String,
    /// The kind of analysis: quasi_static (no inertia), dynamic, auto (quasi-static; dynamic where there is no equilibrium, until
    /// rest), strength_reduction (quasi-static with small displacements, until no equilibrium is found) or consolidation (quasi-static with pore water flow).
    pub analysis: Analysis,
    /// Duration of the phase (s). In a quasi_static phase time only orders the loads.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub duration: f64,
    /// Time steps.
    pub step: Step,
    /// Displacements since the beginning of the phase, by the name of a physical curve or a rigid structure.
    #[serde(default)]
    pub prescribe: BTreeMap<String, Motion>,
    /// Loads on named curves, at named points, or on the surface of the material points.
    #[serde(default)]
    pub tractions: Vec<Traction>,
    /// Height y of the water level outside in this phase (m). Default: that of `water`.
    pub water_level: Option<WaterTable>,
    /// Height y of the water level in the pores in this phase, or a line (m). Default: that of `water`.
    pub phreatic_level: Option<WaterTable>,
    /// Factor on gravity in the phase (-), or its components, each an acceleration (m/s²). Default: 1.
    pub gravity: Option<PhaseGravity>,
    /// Structures, walls and contacts, by name, that are taken away as the phase begins: until they are activated they carry
    /// nothing, touch nothing and stay where they are.
    #[serde(default)]
    pub deactivate: Vec<String>,
    /// Structures, walls and contacts, by name, that come back as the phase begins.
    #[serde(default)]
    pub activate: Vec<String>,
    /// Regions of kind mpm that are dug out as the phase begins. In phases without inertia the forces that their soil bore are taken off evenly
    /// until the end of the phase.
    #[serde(default)]
    pub remove: Vec<String>,
    /// Regions of kind mpm that are filled as the phase begins, without stress: a list, or the material of each by its name. Without a `remove`
    /// before, they are empty until then. In phases without inertia their weight comes evenly until the end of the phase.
    #[serde(default)]
    pub place: Placed,
    /// Soil that enters the model in a dynamic phase, by the name of the physical curve on the boundary of the mesh that it comes through.
    #[serde(default)]
    pub inflow: BTreeMap<String, Inflow>,
    /// The materials that regions take as the phase begins, by the names of the regions. Stress is kept.
    #[serde(default)]
    pub materials: BTreeMap<String, String>,
    /// Settings that contacts, by their `name`, take as the phase begins; what is left out stays.
    #[serde(default)]
    pub contacts: BTreeMap<String, ContactChange>,
    /// Whether frames and history count displacements from the beginning of the phase.
    #[serde(default)]
    pub reset_displacements: bool,
    /// Conditions, any of which ends the phase before its time.
    #[serde(default)]
    pub until: Vec<Until>,
    /// Factor that the strengths of soil and contacts are divided by, above 0 (-). Default: 1; in a strength_reduction phase 1 plus the time.
    pub strength_reduction: Option<InTime>,
}

/// Soil that enters the model, without stress.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Inflow {
    /// The region of kind mpm at the curve, whose soil enters: it has its material. Without a `remove` before, it is empty until then.
    pub region: String,
    /// Velocity across the curve into the mesh, with which the soil enters (m/s).
    pub velocity: InTime,
}

/// Regions that are filled: with the material that they have, or each with one by name.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Placed {
    Kept(Vec<String>),
    With(BTreeMap<String, String>),
}

impl Default for Placed {
    fn default() -> Self {
        Self::Kept(Vec::new())
    }
}

impl Placed {
    /// The regions, each with the material that it takes, if one is named.
    pub fn entries(&self) -> impl Iterator<Item = (&String, Option<&String>)> {
        let (kept, with) = match self {
            Self::Kept(names) => (Some(names), None),
            Self::With(materials) => (None, Some(materials)),
        };
        let kept = kept.into_iter().flatten().map(|name| (name, None));
        kept.chain(with.into_iter().flatten().map(|(name, material)| (name, Some(material))))
    }

    /// The regions.
    pub fn names(&self) -> impl Iterator<Item = &String> {
        self.entries().map(|(name, _)| name)
    }
}

impl Phase {
    /// The materials that regions take, by their names.
    pub fn assigned(&self) -> impl Iterator<Item = (&String, &String)> {
        let placed = self.place.entries().filter_map(|(name, material)| Some((name, material?)));
        self.materials.iter().chain(placed)
    }
}

/// Settings of a contact from a phase on.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ContactChange {
    /// Coefficient of friction tan δ (-). Default: unchanged.
    #[schemars(range(min = 0))]
    pub friction: Option<f64>,
    /// Adhesion c_a (kPa). Default: unchanged.
    #[schemars(range(min = 0))]
    pub adhesion: Option<f64>,
    /// α from 0 to 1, or none: the share of the shear strength of the soil that limits the shear (-). Default: unchanged.
    pub adhesion_factor: Option<AdhesionFactor>,
    /// What happens where the two are pulled apart: cut_off, no_separation or {limit: t}. Default: unchanged.
    pub tension: Option<Tension>,
}

/// The share of the shear strength of the soil that limits the shear of a contact.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum AdhesionFactor {
    Number(f64),
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
    /// The phase ends when the quantity is this much or more, in the unit of the quantity.
    pub above: Option<f64>,
    /// The phase ends when the quantity is this much or less, in the unit of the quantity.
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

impl Analysis {
    /// Whether inertia may come in.
    pub fn has_inertia(self) -> bool {
        matches!(self, Self::Dynamic | Self::Auto)
    }
}

/// Time steps: halved when Newton fails, growing again after.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Step {
    /// First time step (s).
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub initial: f64,
    /// Smallest time step, at most `initial`: steps are halved down to it where Newton's method fails (s). Default: `initial`/10000.
    #[schemars(extend("exclusiveMinimum" = 0))]
    pub min: Option<f64>,
    /// Largest time step, at least `initial`: steps grow again up to it (s). Default: `initial`.
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

/// A factor on the gravity of the case, or the acceleration in the phase by component.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum PhaseGravity {
    Factor(InTime),
    Components(Acceleration),
}

/// The acceleration of gravity in a phase, in place of that of the case.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Acceleration {
    /// Horizontal (in axisymmetry radial) component: soil is pushed that way (m/s²). Default: that of the case.
    pub x: Option<InTime>,
    /// Vertical component, positive upwards (m/s²). Default: that of the case.
    pub y: Option<InTime>,
}

/// A value that grows from 0.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rate {
    /// Growth per second, from 0.
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
    /// Horizontal (in axisymmetry radial) displacement since the beginning of the phase (m).
    pub ux: Option<InTime>,
    /// Vertical displacement since the beginning of the phase, positive upwards (m).
    pub uy: Option<InTime>,
    /// In place of `ux`, the horizontal acceleration in a dynamic phase, as of the record of an earthquake: from rest as the phase begins (m/s²).
    pub ax: Option<InTime>,
    /// In place of `uy`, the vertical acceleration, positive upwards (m/s²).
    pub ay: Option<InTime>,
    /// Rotation of a rigid structure since the beginning of the phase, anticlockwise (rad).
    pub rotation: Option<InTime>,
}

/// A load: a force `on` a named point; `on` a named curve, dead tractions per area of the undeformed curve and a pressure that follows it; or on
/// the `surface` of the material points, which it follows, per area of the surface as it is.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Traction {
    /// The name of a physical curve: tx and ty are dead loads per area of the undeformed curve, a pressure follows it; or of a physical point,
    /// with fx and fy.
    pub on: Option<String>,
    /// In place of a curve, the surface of the material points of a region, by its name, or of `all`: per area of the present surface.
    pub surface: Option<String>,
    /// Horizontal (in axisymmetry radial) traction; on a curve it may vary with depth, along the curve or by a formula (kPa).
    pub tx: Option<Load>,
    /// Vertical traction, positive upwards; on a curve it may vary with depth, along the curve or by a formula (kPa).
    pub ty: Option<Load>,
    /// Horizontal (in axisymmetry radial) force at a point, per metre out of the plane or in axisymmetry of the whole turn (kN).
    pub fx: Option<InTime>,
    /// Vertical force at a point, positive upwards, per metre out of the plane or in axisymmetry of the whole turn (kN).
    pub fy: Option<InTime>,
    /// Pressure at right angles to a surface or a curve, compression positive; it may grow with depth (kPa).
    pub pressure: Option<Load>,
    /// Traction along a surface, positive in the direction that has the soil on its left (kPa).
    pub shear: Option<InTime>,
    /// Factor on the profiles and tables of the load (-). Default: 1.
    pub factor: Option<InTime>,
    /// The part of a surface that is loaded. Default: all of it.
    #[serde(rename = "where")]
    pub within: Option<Window>,
}

/// A number in time, one that grows with depth, a formula of x, y and t, or a table along a curve.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(untagged)]
pub enum Load {
    InTime(InTime),
    Profile(Profile),
    Formula(String),
    Along(Along),
}

/// A load that is linear between places of a curve, and constant before the first and after the last.
#[derive(Clone, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Along {
    /// The coordinate along which it varies, x or y.
    pub along: Axis,
    /// Pairs [coordinate (m), value], coordinates growing.
    #[schemars(extend("minItems" = 1))]
    pub values: Vec<[f64; 2]>,
}

/// A box, fixed in space.
#[derive(Clone, Copy, Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Window {
    /// From and to, horizontally (m). Default: everywhere.
    pub x: Option<[f64; 2]>,
    /// From and to, vertically (m). Default: everywhere.
    pub y: Option<[f64; 2]>,
}
