//! The classical weights: each point stands for its volume.

use super::{Quadrature, Restored, Weights};
use crate::kinematics::Kinematics;
use crate::stencil::{Patch, partly_filled_cells};
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
        let Restored { mesh, points, stencil, active, .. } = *grid;
        let partly_filled = partly_filled_cells::<D, K>(mesh, stencil, points, active);
        let half_empty = |cell: u32| {
            partly_filled
                .binary_search_by_key(&cell, |s| s.cell)
                .is_ok_and(|at| partly_filled[at].emptiness > ILL_CONDITIONED)
        };
        let ill_conditioned = |patch: &&Patch| patch.point_count < FEW || half_empty(patch.cell);
        let ill_conditioned = stencil.patches.iter().filter(ill_conditioned).map(|patch| patch.cell).collect();
        Weights { weight: points.initial_volume.clone(), partly_filled, ill_conditioned, ..Weights::default() }
    }
}
