//! The fields of points in the frames.

use super::internal_variables::InternalVariable;
use crate::io::columns::{padded, to_array};
use crate::io::container::{Array, Data};
use crate::io::frame::Column;
use crate::material::{Model, Plasticity};
use crate::points::Points;
use crate::term::{MixedPressure, excess_pressure};
use std::sync::Arc;

/// A field of the points.
#[derive(Clone)]
pub enum Field {
    /// Displacement (m) since seeding or the last reset; frames then also have that of the grid nodes.
    Displacement,
    /// Velocity (m/s); zero without inertia.
    Velocity,
    /// Hencky strain (-) since seeding.
    Strain,
    /// Deformation gradient (-) since seeding, row by row.
    DeformationGradient,
    /// A column of the points by its name, as it is; nothing where that is not one of floating-point numbers.
    Column(&'static str),
    /// Excess pressure (kPa) of the pore water, given the part of each material, by number, that the pressure field carries where the water
    /// has no field of its own.
    PorePressure(Vec<Option<MixedPressure>>),
    /// Shear strength (kPa) in the state of a point, given the models by number of the material; 0 where the model does not yield.
    ShearStrength(Vec<Option<Arc<dyn Model>>>),
    /// Whether a point is at yield (1), at a limit of tension (2) or neither (0), given the models by number of the material.
    PlasticPoints(Vec<Option<Arc<dyn Model>>>),
    Internal(InternalVariable),
}

impl Field {
    /// Its values for some points.
    pub fn column<const D: usize>(&self, points: &Points<D>) -> Option<Column> {
        let all = 0..points.len();
        Some(match self {
            Self::Displacement => {
                let u: Vec<[f64; D]> = all.map(|p| points.displacement(p)).collect();
                Column::new("displacement", "m", 3, padded(&u))
            }
            Self::Velocity if points.velocity.is_empty() => {
                Column::new("velocity", "m/s", 3, vec![0.0; 3 * points.len()])
            }
            Self::Velocity => Column::new("velocity", "m/s", 3, padded(&points.velocity)),
            Self::Strain => Column::new("strain", "-", 6, all.flat_map(|p| points.strain(p)).collect()),
            Self::DeformationGradient => {
                let rows = points.deformation.iter().flat_map(|f| f.transpose().data.0.into_iter().flatten());
                Column::new("deformation_gradient", "-", 9, rows.collect())
            }
            Self::Column(name) => match to_array(points, name)? {
                Array { name, unit, components, data: Data::F64(values) } => Column { name, unit, components, values },
                _ => return None,
            },
            Self::PorePressure(carried) => {
                Column::new("pore_pressure", "kPa", 1, all.map(|p| excess_pressure(carried, points, p)).collect())
            }
            Self::ShearStrength(models) => {
                let of = |p: usize| {
                    let model = points.by_material(p, models)?;
                    let strength = model.shear_strength(points.seeded_height(p), &points.state(p, 0.0));
                    strength.is_finite().then_some(strength)
                };
                Column::new("shear_strength", "kPa", 1, all.map(|p| of(p).unwrap_or(0.0)).collect())
            }
            Self::PlasticPoints(models) => {
                let of = |p: usize| {
                    let model = points.by_material(p, models)?.as_ref();
                    let (y, ratio) = (points.seeded_height(p), points.deformation[p].determinant());
                    Some(match Plasticity::of(model, y, &points.stress[p], ratio, &points.state(p, 0.0)) {
                        Plasticity::Elastic => 0.0,
                        Plasticity::Plastic => 1.0,
                        Plasticity::Tension => 2.0,
                    })
                };
                Column::new("plastic_points", "-", 1, all.map(|p| of(p).unwrap_or(0.0)).collect())
            }
            Self::Internal(variable) => variable.column(points),
        })
    }
}
