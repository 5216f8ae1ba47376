//! The fields of points in the frames.

use super::internal_variables::InternalVariable;
use crate::io::columns::{padded, to_array};
use crate::io::container::{Array, Data};
use crate::io::frame::Column;
use crate::material::Model;
use crate::points::Points;
use crate::term::{MixedPressure, excess_pressure};
use std::fmt;
use std::sync::Arc;

/// A field of the points.
pub trait Field<const D: usize>: fmt::Debug + Send + Sync {
    /// Its columns for some points: mostly one, with a name, a unit and as many components for each point.
    fn columns(&self, points: &Points<D>) -> Vec<Column>;

    /// Whether frames also contain the displacement of the grid nodes if this field is written.
    fn is_displacement(&self) -> bool {
        false
    }
}

/// Displacement (m) since seeding or the last reset.
#[derive(Clone, Copy, Debug)]
pub struct Displacement;

impl<const D: usize> Field<D> for Displacement {
    fn columns(&self, points: &Points<D>) -> Vec<Column> {
        let u: Vec<[f64; D]> = (0..points.len()).map(|p| points.displacement(p)).collect();
        vec![Column::new("displacement", "m", 3, padded(&u))]
    }

    fn is_displacement(&self) -> bool {
        true
    }
}

/// Velocity (m/s); zero without inertia.
#[derive(Clone, Copy, Debug)]
pub struct Velocity;

impl<const D: usize> Field<D> for Velocity {
    fn columns(&self, points: &Points<D>) -> Vec<Column> {
        let values = if points.velocity.is_empty() { vec![0.0; 3 * points.len()] } else { padded(&points.velocity) };
        vec![Column::new("velocity", "m/s", 3, values)]
    }
}

/// Deformation gradient (-) since seeding, row by row.
#[derive(Clone, Copy, Debug)]
pub struct DeformationGradient;

impl<const D: usize> Field<D> for DeformationGradient {
    fn columns(&self, points: &Points<D>) -> Vec<Column> {
        let rows = points.deformation.iter().flat_map(|f| f.transpose().data.0.into_iter().flatten());
        vec![Column::new("deformation_gradient", "-", 9, rows.collect())]
    }
}

/// A column of the points by its name, as it is; nothing where that is not one of floating-point numbers.
#[derive(Clone, Copy, Debug)]
pub struct PointColumn(pub &'static str);

impl<const D: usize> Field<D> for PointColumn {
    fn columns(&self, points: &Points<D>) -> Vec<Column> {
        match to_array(points, self.0) {
            Some(Array { name, unit, components, data: Data::F64(values) }) => {
                vec![Column { name, unit, components, values }]
            }
            _ => Vec::new(),
        }
    }
}

/// Excess pressure (kPa) of the pore water, given the part of each material, by number, that the pressure field carries where the water has no
/// field of its own.
#[derive(Clone, Debug)]
pub struct PorePressure(pub Vec<Option<MixedPressure>>);

impl<const D: usize> Field<D> for PorePressure {
    fn columns(&self, points: &Points<D>) -> Vec<Column> {
        let excess = (0..points.len()).map(|p| excess_pressure(&self.0, points, p));
        vec![Column::new("pore_pressure", "kPa", 1, excess.collect())]
    }
}

/// Shear strength (kPa) in the state of a point, given the models by number of the material; 0 where the model does not yield.
pub struct ShearStrength(pub Vec<Option<Arc<dyn Model>>>);

impl fmt::Debug for ShearStrength {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("ShearStrength")
    }
}

impl<const D: usize> Field<D> for ShearStrength {
    fn columns(&self, points: &Points<D>) -> Vec<Column> {
        let of = |p: usize| {
            let model = points.by_material(p, &self.0)?;
            let strength = model.shear_strength(points.seeded_height(p), &points.state(p, 0.0));
            strength.is_finite().then_some(strength)
        };
        vec![Column::new("shear_strength", "kPa", 1, (0..points.len()).map(|p| of(p).unwrap_or(0.0)).collect())]
    }
}

impl<const D: usize> Field<D> for InternalVariable {
    fn columns(&self, points: &Points<D>) -> Vec<Column> {
        vec![self.column(points)]
    }
}
