//! What of the boundary of a structure lies on the soil, so that its surface there is not open.

use super::constraint::{Constraint, FADING};
use super::place::Segments;
use super::surface::Surface;
use crate::surface::Cover;

/// The segments under contact nodes whose gap, as the `constraints` have it, is closed: less than that over which adhesion fades.
pub fn covers(surface: &Surface, segments: &Segments, constraints: &[Constraint<2>]) -> Vec<Cover<2>> {
    let mut gaps = vec![None; surface.contact_nodes];
    for constraint in constraints {
        gaps[constraint.contact_node as usize] = Some(constraint.gap);
    }
    let closed = |s: usize| {
        // Of two contact nodes one may have no soil under it.
        let (mut sum, mut gap) = (0.0, 0.0);
        for (contact_node, share) in surface.segments[s].contact_nodes {
            if let Some(of_node) = gaps[contact_node as usize] {
                (sum, gap) = (sum + share, gap + share * of_node);
            }
        }
        sum > 0.0 && gap < FADING * surface.spacing * sum
    };
    let bears: Vec<bool> = (0..segments.0.len()).map(closed).collect();
    let end = |s: usize, k: usize| surface.facets[surface.segments[s].facet as usize][k];
    let mut covers = Vec::new();
    for chain in &surface.chains {
        let (first, last) = (chain.start, chain.end - 1);
        let is_loop = end(first, 0) == end(last, 1);
        for s in chain.clone().filter(|&s| bears[s]) {
            let before = if s > first { bears[s - 1] } else { is_loop && bears[last] };
            let after = if s < last { bears[s + 1] } else { is_loop && bears[first] };
            let placed = &segments.0[s];
            covers.push(Cover { ends: [placed.from, placed.to], goes_on: [before, after], reach: surface.spacing });
        }
    }
    covers
}
