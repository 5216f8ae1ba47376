//! The surface as a contour of how full the surroundings of the nodes are.
//!
//! `φ_v = Σ V_p L_v(x_p) / ∫ L_v dV` with shape functions `L_v` that are linear on the triangles between the nodes of a cell;
//! the material is where `φ > c`, at the level `c` that encloses `Σ V_p`. The integral of a shape function ends at the boundary of
//! the mesh, so that a wall there is no surface. There is no smoothing.

use super::geometry::Geometry;
use super::straight::Triangles;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::points::Points;
use rayon::prelude::*;

/// The highest level: below what irregular points leave of a full cell, so that a body that fills its surroundings but
/// whose points have lost volume does not fall into holes. A flat surface is near ½, a convex corner near ¼.
pub const HIGHEST: f64 = 0.75;
/// Enclosed volume and `Σ V_p` agree to this share of it, or the level is found to [`CLOSE`].
const MATCHED: f64 = 1e-13;
/// Values so near to the level are on it.
const CLOSE: f64 = 1e-13;

/// The contour at the last restoration; its buffers are reused.
#[derive(Clone, Debug, Default)]
pub struct Contour {
    /// `φ − c` (-) at the nodes: positive in the material. Nodes out of reach of all points have `−c`.
    pub level_set: Vec<f64>,
    /// The level `c` (-), from 0 to 0.75.
    pub level: f64,
    /// `Σ V_p` (m³), which the contour encloses. It does not where no level in bounds does: the points have lost volume inside
    /// a body that fills its surroundings, or hold more than the cells they reach.
    pub wanted: f64,
    /// Nodes and volume of each point.
    shares: Vec<([u32; 3], [f64; 3])>,
    /// Cells that some level in the bracket cuts, with their least and greatest `φ`.
    undecided: Vec<(u32, f64, f64)>,
}

impl Contour {
    /// Finds the contour of points at `parametric` coordinates in their cells. All cells with a point, and their
    /// neighbours over nodes, must be among those `active`.
    pub fn update<K: Kinematics<2>>(
        &mut self,
        mesh: &Mesh<2>,
        geometry: &Geometry,
        points: &Points<2>,
        parametric: &[[f64; 3]],
        active: &[bool],
    ) {
        self.fill(mesh, geometry, points, parametric);
        self.wanted = self.shares.iter().map(|(_, volume)| volume.iter().sum::<f64>()).sum();
        self.find_level::<K>(mesh, geometry, active);
        for value in &mut self.level_set {
            *value -= self.level;
            if value.abs() <= CLOSE {
                *value = 0.0;
            }
        }
    }

    /// `φ` at the nodes.
    fn fill(&mut self, mesh: &Mesh<2>, geometry: &Geometry, points: &Points<2>, parametric: &[[f64; 3]]) {
        let share = |p: usize| {
            let cell = points.cell[p] as usize;
            let x = mesh.coordinates(cell);
            let (triangle, l) = Triangles::of(mesh.cells.kind[cell], &x).barycentric(&parametric[p]);
            let nodes = mesh.cells.nodes(cell);
            let volume = points.volume(p);
            (triangle.map(|i| nodes[i]), l.map(|l| l * volume))
        };
        (0..points.len()).into_par_iter().map(share).collect_into_vec(&mut self.shares);
        self.level_set.clear();
        self.level_set.resize(mesh.nodes.len(), 0.0);
        for (nodes, volume) in &self.shares {
            for (&n, v) in nodes.iter().zip(volume) {
                self.level_set[n as usize] += v;
            }
        }
        for (phi, volume) in self.level_set.iter_mut().zip(&geometry.nodal_volume) {
            // A node of no cell has no volume and no point.
            *phi = if *volume > 0.0 { *phi / volume } else { 0.0 };
        }
    }

    /// The level that encloses `wanted`: the method of the false position in the variant of Anderson and Björck
    /// (1973), with a bisection in every third step; cells leave the list when the bracket no longer cuts them.
    fn find_level<K: Kinematics<2>>(&mut self, mesh: &Mesh<2>, geometry: &Geometry, active: &[bool]) {
        let phi = &self.level_set;
        let undecided = &mut self.undecided;
        undecided.clear();
        for c in (0..mesh.cells.len()).filter(|&c| active[c]) {
            let values = mesh.cells.nodes(c).iter().map(|&n| phi[n as usize]);
            let (low, high) = values.fold((f64::INFINITY, 0.0f64), |(l, h), v| (l.min(v), h.max(v)));
            if high > 0.0 {
                undecided.push((c as u32, low, high));
            }
        }
        // The volume of cells that are full at every level of the bracket.
        let mut full = 0.0;
        let mut values = Vec::new();
        let mut volume = |undecided: &[(u32, f64, f64)], full: f64, level: f64| {
            let mut sum = full;
            for &(c, low, high) in undecided {
                let c = c as usize;
                if low >= level {
                    sum += geometry.volume(c);
                } else if high > level {
                    values.clear();
                    values.extend(mesh.cells.nodes(c).iter().map(|&n| phi[n as usize] - level));
                    sum += geometry.cell(mesh, c, c).clipped_volume::<K>(&values);
                }
            }
            sum
        };
        let matched = MATCHED * self.wanted;
        let (mut low, mut high) = (0.0, HIGHEST);
        let mut at_low = volume(undecided, full, low) - self.wanted;
        let mut at_high = volume(undecided, full, high) - self.wanted;
        if at_low <= matched {
            self.level = low;
            return;
        }
        if at_high >= -matched {
            self.level = high;
            return;
        }
        let (mut turn, mut raised) = (0, None);
        loop {
            undecided.retain(|&(c, least, greatest)| {
                if least >= high {
                    full += geometry.volume(c as usize);
                }
                least < high && greatest > low
            });
            let secant = low + (high - low) * (at_low / (at_low - at_high));
            turn += 1;
            let level = if turn % 3 == 0 || !(low < secant && secant < high) { 0.5 * (low + high) } else { secant };
            let there = volume(undecided, full, level) - self.wanted;
            self.level = level;
            if there.abs() <= matched || high - low <= CLOSE {
                return;
            }
            // An end that stays a second time loses weight.
            let weight = |before: f64| if there.abs() < before.abs() { 1.0 - there / before } else { 0.5 };
            if there > 0.0 {
                if raised == Some(true) {
                    at_high *= weight(at_low);
                }
                (low, at_low, raised) = (level, there, Some(true));
            } else {
                if raised == Some(false) {
                    at_low *= weight(at_high);
                }
                (high, at_high, raised) = (level, there, Some(false));
            }
        }
    }
}

#[cfg(test)]
mod tests;
