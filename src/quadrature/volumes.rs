//! The classical weights: each point stands for its volume.

use super::{Quadrature, Tally, Weighing};
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::points::Points;
use crate::stencil::{Stencil, soft_cells};
use std::marker::PhantomData;

/// Points weigh what their volume is. Cells are as full as the volumes of their points say.
#[derive(Default)]
pub struct Volumes<K> {
    kinematics: PhantomData<K>,
}

impl<const D: usize, K: Kinematics<D>> Quadrature<D> for Volumes<K> {
    fn weigh(
        &self,
        mesh: &Mesh<D>,
        points: &Points<D>,
        _parametric: &[[f64; 3]],
        stencil: &Stencil<D>,
        taking_part: &[bool],
    ) -> Weighing<D> {
        let volume = (0..points.len()).map(|p| points.volume(p)).sum();
        Weighing {
            weight: points.initial_volume.clone(),
            shift: Vec::new(),
            soft: soft_cells::<D, K>(mesh, stencil, points, taking_part),
            poor: Vec::new(),
            tally: Tally {
                volume: stencil.patches.len() as u32,
                point_volume: volume,
                fitted_volume: volume,
                ..Tally::default()
            },
        }
    }
}
