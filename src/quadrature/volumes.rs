//! The classical weights: each point stands for its volume.

use super::{Quadrature, Restored, Weights};
use crate::interpolation::partly_filled_cells;
use crate::kinematics::Kinematics;
use crate::surface::MarkerFront;
use std::marker::PhantomData;

/// Points in a cell that is emptier (-) than this do not hold its nodes by themselves.
const ILL_CONDITIONED: f64 = 0.5;

/// Points weigh what their volume is. Cells are as full as the volumes of their points say.
#[derive(Default)]
pub struct Volumes<K> {
    kinematics: PhantomData<K>,
}

impl<const D: usize, K: Kinematics<D>> Quadrature<D> for Volumes<K> {
    fn weigh(&self, grid: &Restored<D>, _front: &mut Option<MarkerFront>) -> Weights<D> {
        let Restored { mesh, points, interpolation, active, .. } = *grid;
        let partly_filled = partly_filled_cells::<D, K>(mesh, interpolation, points, active);
        let half_empty = |cell: &u32| {
            let found = partly_filled.binary_search_by_key(cell, |s| s.cell);
            found.is_ok_and(|at| partly_filled[at].emptiness > ILL_CONDITIONED)
        };
        let filled = interpolation.filled.iter().map(|cell_points| cell_points.cell);
        let ill_conditioned = filled.filter(half_empty).collect();
        Weights { weight: points.initial_volume.clone(), partly_filled, ill_conditioned, ..Weights::default() }
    }
}
