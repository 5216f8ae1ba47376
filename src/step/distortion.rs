//! Whether the grid is due for a reset: how distorted its cells are since the last one (docs/theory.md, section 4, *Grid reset by quality*;
//! its reference 1, §2.8).

use super::grid::Grid;
use super::scene::Scene;
use super::state::State;
use crate::mesh::quality;
use crate::mesh::shape::MAX_NODES;
use rayon::prelude::*;

/// Least ratio of the least to the largest determinant of the isoparametric map of a cell, relative to that at the last reset: a curved
/// cell folds where it reaches zero.
const FOLDED: f64 = 0.3;

/// Whether a cell with points has a quality below the fraction `least` of that at the last reset, is nearly folded, or has an edge `stretch`
/// times as long as at the last reset, or as short.
pub fn exceeds<const D: usize>(scene: &Scene<D>, state: &State<D>, grid: &Grid<D>, least: f64, stretch: f64) -> bool {
    const { assert!(D == 2, "the quality of cells is known in the plane only") };
    let mesh = grid.mesh(scene);
    grid.interpolations.integration.filled.par_iter().any(|cell_points| {
        let cell = cell_points.cell as usize;
        let (kind, nodes) = (mesh.cells.kind[cell], mesh.cells.nodes(cell));
        let (mut before, mut now) = ([[0.0; 2]; MAX_NODES], [[0.0; 2]; MAX_NODES]);
        for (i, &n) in nodes.iter().enumerate() {
            for d in 0..D.min(2) {
                before[i][d] = mesh.nodes[n as usize][d];
                now[i][d] = before[i][d] + state.displacement[n as usize][d];
            }
        }
        let (before, now) = (&before[..nodes.len()], &now[..nodes.len()]);
        let corners = kind.corner_count();
        if quality::quality(&now[..corners]) < least * quality::quality(&before[..corners]) {
            return true;
        }
        let evenness = |x: &[[f64; 2]]| {
            let (low, high) = quality::jacobian_range(kind, x);
            if high > 0.0 { low / high } else { 0.0 }
        };
        if evenness(now) < FOLDED * evenness(before) {
            return true;
        }
        (0..corners).any(|i| {
            let length = |x: &[[f64; 2]]| {
                let (a, b) = (x[i], x[(i + 1) % corners]);
                (b[0] - a[0]).hypot(b[1] - a[1])
            };
            !(1.0 / stretch..=stretch).contains(&(length(now) / length(before)))
        })
    })
}

/// Whether an active cell without points will be flat or inverted with one more increment like the last one: what moves towards it is about to
/// pass a support or another body.
pub fn closes<const D: usize>(scene: &Scene<D>, state: &State<D>, grid: &Grid<D>) -> bool {
    const { assert!(D == 2, "the quality of cells is known in the plane only") };
    if state.increment.is_empty() {
        return false;
    }
    let mesh = grid.mesh(scene);
    let filled = &grid.interpolations.integration;
    grid.cells.par_iter().filter(|&&c| filled.of_cell(c).is_none()).any(|&c| {
        let place = |&n: &u32| {
            let n = n as usize;
            [0, 1].map(|d| mesh.nodes[n][d] + state.displacement[n][d] + state.increment[n][d])
        };
        let corners: Vec<[f64; 2]> = mesh.cells.corners(c as usize).iter().map(place).collect();
        quality::quality(&corners) <= 0.0
    })
}
