//! How unevenly the soil of a cell flows, and what that makes of its gradients.
//!
//! A field of displacements that is continuous spreads a slip line over a cell. The strains then change within the
//! cell as much as they are large, the plastic work is `s_u ∫ |γ|` where the soil needs no more than `s_u |∫ γ|`, and
//! the limit load is that of a wider footing. What the cell has of such a strain is its mean, so that the points
//! take a part `β` of the way to it: `∇̄N = ∇N + β (∫∇N/V − ∇N)`, in the strain and in the force alike.
//!
//! With the plastic strain increments `v = Δε_p s/|s|` of the last step, `s` the deviator of stress, and means by weight
//! over the cell, `β = min(2 θ, 0.55)`, `θ² = 1 − |mean v|²/mean |v|²`. It vanishes where the soil is elastic or
//! flows uniformly, and is of the order of h in a smooth flow: the strain stays of second order. Linear fields keep
//! their gradients. Being of the last step it leaves the tangent exact.

use super::Frame;
use crate::stencil::Patch;
use crate::tensor::{Symmetric, mean};

/// Part of the way for a unit of unevenness (-).
const SLOPE: f64 = 2.0;
/// Most of the way (-): what is left of the stiffness against strains that vary in the cell is the square of the rest.
const MOST: f64 = 0.55;

/// The part of the way (-) that the gradients of a patch go to their means.
pub fn towards_mean<const D: usize>(frame: &Frame<D>, patch: &Patch) -> f64 {
    let increments = &frame.points.plastic_increment;
    if increments.is_empty() || frame.stencil.reach.is_some() {
        return 0.0;
    }
    let weights = &frame.stencil.weight[patch.first_point as usize..];
    let (mut weight, mut square, mut sum) = (0.0, 0.0, [0.0; 6]);
    for (&p, w) in frame.stencil.points(patch).iter().zip(weights) {
        let (flow, stress) = (increments[p as usize], &frame.points.stress[p as usize]);
        weight += w;
        square += w * flow * flow;
        if flow > 0.0 {
            let direction = direction(stress);
            for (sum, component) in sum.iter_mut().zip(direction) {
                *sum += w * flow * component;
            }
        }
    }
    if square > 0.0 {
        let even = contract(&sum) / (weight * square);
        (SLOPE * f64::max(1.0 - even, 0.0).sqrt()).min(MOST)
    } else {
        0.0
    }
}

/// The deviator over its norm; zero without one.
fn direction(stress: &Symmetric) -> Symmetric {
    let mut deviator = *stress;
    let mean = mean(stress);
    deviator[..3].iter_mut().for_each(|normal| *normal -= mean);
    let norm = contract(&deviator).sqrt();
    if norm > 0.0 { deviator.map(|s| s / norm) } else { [0.0; 6] }
}

/// `a : a`.
fn contract(a: &Symmetric) -> f64 {
    a[..3].iter().map(|x| x * x).sum::<f64>() + 2.0 * a[3..].iter().map(|x| x * x).sum::<f64>()
}
