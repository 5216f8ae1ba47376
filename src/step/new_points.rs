//! Material points of soil that comes: without stress and strain.

use super::scene::Soil;
use super::state::State;
use crate::mesh::height;
use crate::points::Points;
use crate::quadrature::Placed;
use crate::tensor::{IDENTITY, Tensor};

/// Points at rest and without stress, with the columns of those that are there.
pub fn points<const D: usize>(state: &State<D>, soil: &Soil, placed: &Placed<D>) -> Points<D> {
    let count = placed.position.len();
    let there = &state.points;
    let Soil { region, number, material } = soil;
    let has = |column: usize| if column == 0 { 0 } else { count };
    let density = |(x, volume): (&[f64; D], &f64)| material.density.at(height(x)) * volume;
    let mut points = Points {
        position: placed.position.clone(),
        origin: placed.position.clone(),
        reference: placed.position[..has(there.reference.len())].to_vec(),
        velocity: vec![[0.0; D]; has(there.velocity.len())],
        acceleration: vec![[0.0; D]; has(there.acceleration.len())],
        mass: placed.position.iter().zip(&placed.volumes).map(density).collect(),
        initial_volume: placed.volumes.clone(),
        deformation: vec![Tensor::identity(); count],
        elastic: vec![IDENTITY; count],
        stress: vec![[0.0; 6]; count],
        plastic_strain: vec![0.0; count],
        plastic_increment: vec![0.0; has(there.plastic_increment.len())],
        internal: vec![0.0; count * there.internal_count()],
        pressure: vec![0.0; has(there.pressure.len())],
        pore_pressure: vec![0.0; has(there.pore_pressure.len())],
        domain: Vec::new(),
        strength: vec![1.0; has(there.strength.len())],
        region: vec![*region; count],
        model: vec![*number; has(there.model.len())],
        cell: placed.cell.clone(),
    };
    for p in 0..count {
        points.begin_internal(p, material.model.as_ref());
        if let (Some(carried), true) = (&material.carried, !points.pressure.is_empty()) {
            points.pressure[p] = carried.begin(material.model.as_ref(), &points, p);
        }
        if let (Some(field), true) = (&material.random_strength, !points.strength.is_empty()) {
            points.strength[p] = field.factor(&points.origin[p]);
        }
    }
    points
}
