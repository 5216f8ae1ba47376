//! How full of points the surroundings of a node are, and of which regions.
//!
//! `φ_v = Σ A_p L_v(x_p) / ∫ L_v dA` as the contour of [`crate::surface::Contour`] has it, but with what structures leave of the
//! area: beside one the soil is full, not half full. `φ` is then smoothed once, by its means over the triangles between nodes,
//! so that the scatter of points makes no holes; where a straight surface goes through a node it stays ½.

use super::polygon::{WHOLE, share, without};
use super::structures::Structures;
use crate::geometry::area;
use crate::mesh::Mesh;
use crate::points::Points;
use crate::surface::{Triangles, triangles};

/// A node of which structures leave less than this part (-) takes its value from those around.
const LEAST: f64 = 0.1;

/// The fullness at the nodes.
pub struct Fullness {
    /// Smoothed `φ` (-).
    pub value: Vec<f64>,
    /// The part (-) that each region has in it, region by region; empty where there is but one.
    pub part: Vec<Vec<f64>>,
}

impl Fullness {
    /// That of `points` at parametric places in the cells of `mesh`; `regions` are those of the points.
    pub fn of(
        mesh: &Mesh<2>,
        points: &Points<2>,
        parametric: &[[f64; 3]],
        regions: &[u16],
        structures: &Structures,
    ) -> Self {
        let count = mesh.nodes.len();
        let (mut sum, mut part) = (vec![0.0; count], vec![vec![0.0; count]; regions.len()]);
        for (p, xi) in parametric.iter().enumerate() {
            let c = points.cell[p] as usize;
            let x = mesh.coordinates(c);
            let (triangle, l) = Triangles::of(mesh.cells.kind[c], &x).barycentric(xi);
            let own = regions.iter().position(|&r| r == points.region[p]);
            for (&i, l) in triangle.iter().zip(l) {
                let n = mesh.cells.nodes(c)[i] as usize;
                sum[n] += l * points.initial_volume[p];
                if let Some(own) = own {
                    part[own][n] += l * points.initial_volume[p];
                }
            }
        }
        for (n, sum) in sum.iter().enumerate() {
            part.iter_mut().for_each(|part| part[n] = if *sum > 0.0 { part[n] / sum } else { 0.0 });
        }
        let (mut whole, mut free, mut pieces) = (vec![0.0; count], vec![0.0; count], Vec::new());
        for c in 0..mesh.cells.len() {
            let nodes = mesh.cells.nodes(c);
            for triangle in triangles(mesh.cells.kind[c]) {
                let corners = triangle.map(|i| nodes[i] as usize);
                let x = corners.map(|n| mesh.nodes[n]);
                let (all, mut left) = (area(&x), 1.0);
                if structures.touch(&x) {
                    left = without(WHOLE.to_vec(), &x, structures.near(&x)).iter().map(|p| share(p)).sum();
                }
                for n in corners {
                    whole[n] += all / 3.0;
                    free[n] += left * all / 3.0;
                }
                pieces.push((corners, left * all));
            }
        }
        let known = |n: usize| free[n] > LEAST * whole[n];
        let phi: Vec<f64> = (0..count).map(|n| if known(n) { sum[n] / free[n] } else { 0.0 }).collect();
        let (mut value, mut weight) = (vec![0.0; count], vec![0.0; count]);
        for (corners, area) in &pieces {
            for &n in corners {
                for &m in corners.iter().filter(|&&m| known(m)) {
                    value[n] += area * phi[m];
                    weight[n] += area;
                }
            }
        }
        let mean = |n: usize| if weight[n] > 0.0 { value[n] / weight[n] } else { 0.0 };
        Self { value: (0..count).map(mean).collect(), part: if regions.len() > 1 { part } else { Vec::new() } }
    }
}
