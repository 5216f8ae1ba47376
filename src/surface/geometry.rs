//! What the integrals over the cells of a restored grid need and what does not change while its nodes stay.

use super::moments::{Cell, CellFrame, Moments, is_straight};
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::faces::Faces;
use crate::mesh::shape::MAX_NODES;
use rayon::prelude::*;
use std::cmp::Reverse;

/// Frames and moments of the whole cells, and the volumes of the nodes.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry {
    /// The frame of each cell, in which its moments are taken.
    pub frame: Vec<CellFrame>,
    /// The moments (m³) of each whole cell.
    pub whole: Vec<Moments>,
    /// Whether each cell has straight edges and its other nodes where the map of its corners has them.
    pub straight: Vec<bool>,
    /// `V_v = ∫ L_v dV` (m³) of each node: the integral of its linear shape function over the mesh.
    pub nodal_volume: Vec<f64>,
    /// The cells that meet across faces.
    pub faces: Faces,
}

impl Geometry {
    /// That of `mesh`, to be made anew when its nodes move.
    pub fn new<K: Kinematics<2>>(mesh: &Mesh<2>) -> Self {
        let cell = |c: usize| {
            let frame = CellFrame::of(mesh, c);
            let straight = is_straight(mesh, c);
            let cell = Cell::new(mesh, c, &frame, straight);
            let mut volumes = [0.0; MAX_NODES];
            cell.nodal_volumes::<K>(&mut volumes);
            (frame, straight, cell.whole::<K>(), volumes)
        };
        let cells: Vec<_> = (0..mesh.cells.len()).into_par_iter().map(cell).collect();
        let mut nodal_volume = vec![0.0; mesh.nodes.len()];
        for (c, cell) in cells.iter().enumerate() {
            for (&n, volume) in mesh.cells.nodes(c).iter().zip(&cell.3) {
                nodal_volume[n as usize] += volume;
            }
        }
        Self {
            frame: cells.iter().map(|c| c.0).collect(),
            straight: cells.iter().map(|c| c.1).collect(),
            whole: cells.iter().map(|c| c.2).collect(),
            nodal_volume,
            faces: Faces::of(mesh),
        }
    }

    /// Cell `c`, its moments to be taken in the frame of cell `owner`.
    pub fn cell(&self, mesh: &Mesh<2>, c: usize, owner: usize) -> Cell<'_> {
        Cell::new(mesh, c, &self.frame[owner], self.straight[c])
    }

    /// The volume (m³) of cell `c`.
    pub fn volume(&self, c: usize) -> f64 {
        self.whole[c][0]
    }

    /// The volume (m³) of the part of cell `c` where the level set with the nodal `values` is positive. Zero counts as inside where
    /// anything is, for a surface through the nodes of a cell cuts nothing off it.
    pub fn filled<K: Kinematics<2>>(&self, mesh: &Mesh<2>, c: usize, values: &[f64]) -> f64 {
        if values.iter().all(|&v| v <= 0.0) {
            0.0
        } else if values.iter().all(|&v| v >= 0.0) {
            self.volume(c)
        } else {
            self.cell(mesh, c, c).clipped_volume::<K>(values)
        }
    }

    /// The cell that stands for what is in `cell`, by the points that each cell has: itself, or the nearest one with points across
    /// faces, the one with most of several, the lowest of equals. `None` where there is none within `rings`.
    pub fn host(&self, cell: u32, rings: usize, points: impl Fn(u32) -> u32) -> Option<u32> {
        let mut reached = vec![cell];
        let mut begin = 0;
        for _ in 0..=rings {
            let ring = begin..reached.len();
            let with_points = reached[ring.clone()].iter().filter(|&&c| points(c) > 0);
            if let Some(&best) = with_points.max_by_key(|&&c| (points(c), Reverse(c))) {
                return Some(best);
            }
            begin = ring.end;
            for i in ring {
                for &next in self.faces.neighbours(reached[i]) {
                    if !reached.contains(&next) {
                        reached.push(next);
                    }
                }
            }
        }
        None
    }

    /// The side (m) of a square that holds cell `c`, or two like it if it is a triangle.
    pub fn size(&self, mesh: &Mesh<2>, c: usize) -> f64 {
        self.frame[c].length * if mesh.cells.kind[c].is_simplex() { std::f64::consts::SQRT_2 } else { 1.0 }
    }
}
