//! A phase of a checked case: its analysis and steps, what it prescribes, loads and changes, and what ends it.

use super::{Analysis, StepSize, Until};
use crate::contact::Law;
use crate::expression::Expression;
use crate::gravity::Gravity;
use crate::time_value::TimeValue;

/// A phase of the analysis.
#[derive(Clone, Debug, PartialEq)]
pub struct Phase {
    pub name: String,
    pub analysis: Analysis,
    /// Duration (s).
    pub duration: f64,
    pub step: StepSize,
    pub prescribed: Vec<Prescribed>,
    pub tractions: Vec<Traction>,
    pub surface_loads: Vec<SurfaceLoad>,
    /// Acceleration of gravity.
    pub gravity: Gravity<2>,
    /// What strengths are divided by (-); absent where they are as given.
    pub reduction: Option<TimeValue>,
    /// Structures, walls and contacts that are not there in the phase.
    pub absent: Vec<String>,
    /// Regions of soil that are removed as it begins.
    pub removed: Vec<String>,
    /// Regions of soil that are filled as it begins, after that.
    pub placed: Vec<String>,
    /// Soil that enters the model.
    pub inflows: Vec<Inflow>,
    /// The materials that regions take as it begins.
    pub changes: Vec<Change>,
    /// The laws that contacts take as it begins.
    pub contacts: Vec<ContactChange>,
    /// Whether displacements are counted from its beginning.
    pub reset_displacements: bool,
    pub until: Vec<Until>,
}

/// Soil of a region that enters through a curve with a velocity (m/s).
#[derive(Clone, Debug, PartialEq)]
pub struct Inflow {
    pub curve: String,
    pub region: String,
    pub velocity: TimeValue,
}

impl Phase {
    /// Regions that soil comes into.
    pub fn coming(&self) -> impl Iterator<Item = &String> {
        self.placed.iter().chain(self.inflows.iter().map(|inflow| &inflow.region))
    }
}

/// A material that a region takes: indices into [`super::Case::regions`] and [`super::Case::materials`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Change {
    pub region: usize,
    pub material: usize,
}

/// A law that the contact of this name takes.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactChange {
    pub name: String,
    pub law: Law,
}

/// A component of the displacement (m) of a curve or a rigid structure since the beginning of the phase.
#[derive(Clone, Debug, PartialEq)]
pub struct Prescribed {
    pub curve: String,
    /// 0 for x, 1 for y, 2 for the rotation (rad) of a rigid structure.
    pub component: usize,
    pub displacement: TimeValue,
}

/// A load on a curve, or at a point.
#[derive(Clone, Debug, PartialEq)]
pub struct Traction {
    /// The number of its entry in the phase.
    pub entry: usize,
    /// The name of the curve or the point.
    pub curve: String,
    /// The force (kN, in plane strain per metre) at a point; `None` on a curve, which has the rest.
    pub force: Option<[TimeValue; 2]>,
    /// In fixed directions, per area of the undeformed curve.
    pub components: [LoadProfile; 2],
    /// What of these is no profile over the depth; the component is zero then.
    pub fields: [Option<LoadField>; 2],
    /// At right angles to the curve where it is, per area of it as it is.
    pub pressure: Option<LoadProfile>,
}

impl Traction {
    /// All that varies in time.
    pub fn values(&self) -> impl Iterator<Item = &TimeValue> {
        let profiles = self.components.iter().chain(&self.pressure).flat_map(|load| [&load.top, &load.gradient]);
        let factors = self.fields.iter().flatten().filter_map(LoadField::factor);
        profiles.chain(self.force.iter().flatten()).chain(factors)
    }
}

/// A component of a traction (kPa) on a curve, by the place on the undeformed curve.
#[derive(Clone, Debug, PartialEq)]
pub enum LoadField {
    Formula(Expression),
    /// Linear between pairs of a coordinate (m), by the number of its axis, and a value, times a factor.
    Along {
        axis: usize,
        values: Vec<[f64; 2]>,
        factor: TimeValue,
    },
}

impl LoadField {
    /// The factor on a table.
    pub fn factor(&self) -> Option<&TimeValue> {
        match self {
            Self::Formula(_) => None,
            Self::Along { factor, .. } => Some(factor),
        }
    }

    /// Whether it is a formula in time.
    pub fn is_formula_in_time(&self) -> bool {
        matches!(self, Self::Formula(formula) if formula.varies_in_time())
    }
}

/// A load on the surface of the material points, per area of the surface as it is.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceLoad {
    /// Index into [`super::Case::regions`]; `None` for all of the surface.
    pub region: Option<usize>,
    pub pressure: Option<LoadProfile>,
    /// Along the surface (kPa), positive in the sense that has the material on its left.
    pub shear: TimeValue,
    /// In fixed directions (kPa).
    pub components: [TimeValue; 2],
    /// From and to (m) in x and y.
    pub within: Option<[[f64; 2]; 2]>,
}

/// A pressure (kPa, compression positive) or a component of a traction (kPa): uniform, or varying with depth.
#[derive(Clone, Debug, PartialEq)]
pub struct LoadProfile {
    pub top: TimeValue,
    pub gradient: TimeValue,
    pub datum: f64,
}
