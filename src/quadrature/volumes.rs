//! The classical weights: each point stands for its volume.

use super::{Quadrature, Restored, Weights};
use crate::interpolation::{CellPoints, partly_filled_cells};
use crate::kinematics::Kinematics;
use crate::surface::MarkerFront;
use std::marker::PhantomData;

/// Fewer points than this do not hold a cell's nodes by themselves.
const FEW: u32 = 4;
/// Nor do points in a cell that is emptier (-) than this.
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
        let half_empty = |cell: u32| {
            partly_filled
                .binary_search_by_key(&cell, |s| s.cell)
                .is_ok_and(|at| partly_filled[at].emptiness > ILL_CONDITIONED)
        };
        let ill_conditioned = |cell_points: &&CellPoints| cell_points.point_count < FEW || half_empty(cell_points.cell);
        let ill_conditioned =
            interpolation.filled.iter().filter(ill_conditioned).map(|cell_points| cell_points.cell).collect();
        Weights { weight: points.initial_volume.clone(), partly_filled, ill_conditioned, ..Weights::default() }
    }
}
