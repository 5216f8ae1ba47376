//! The front of cells that are filled with points.

use super::super::loops::loops;
use super::{MarkerFront, PER_LENGTH};
use crate::geometry::way;
use crate::mesh::Mesh;
use crate::mesh::faces::{BOUNDARY, Faces};
use crate::mesh::shape::CellKind;

/// A side of a filled cell beyond which there is nothing, with the material on its left.
struct Side {
    ends: [u32; 2],
    middle: Option<u32>,
}

impl MarkerFront {
    /// The boundary of the union of the cells that are `filled`.
    pub fn around(mesh: &Mesh<2>, faces: &Faces, filled: &[bool]) -> Self {
        let sides = sides(mesh, faces, filled);
        let ends: Vec<[u32; 2]> = sides.iter().map(|side| side.ends).collect();
        let direction = |number: usize| {
            let [a, b] = ends[number].map(|n| mesh.nodes[n as usize]);
            way(&a, &b)
        };
        let mut front = Self { position: Vec::new(), first: vec![0] };
        for of_loop in loops(&ends, direction) {
            of_loop.into_iter().for_each(|number| front.add(mesh, &sides[number]));
            front.first.push(front.position.len() as u32);
        }
        front
    }

    /// Appends the markers of a side without its last one.
    fn add(&mut self, mesh: &Mesh<2>, side: &Side) {
        let [a, b] = side.ends.map(|n| mesh.nodes[n as usize]);
        let half = [0, 1].map(|d| 0.5 * (a[d] + b[d]));
        let middle = side.middle.map_or(half, |n| mesh.nodes[n as usize]);
        for k in 0..PER_LENGTH {
            let t = k as f64 / PER_LENGTH as f64;
            self.position.push([0, 1].map(|d| a[d] + t * (b[d] - a[d]) + 4.0 * t * (1.0 - t) * (middle[d] - half[d])));
        }
    }
}

fn sides(mesh: &Mesh<2>, faces: &Faces, filled: &[bool]) -> Vec<Side> {
    let mut sides = Vec::new();
    for c in (0..mesh.cells.len()).filter(|&c| filled[c]) {
        let nodes = mesh.cells.nodes(c);
        let (kind, facets) = mesh.cells.kind[c].facets();
        for (facet, &other) in facets.iter().zip(faces.across(c as u32)) {
            if other == BOUNDARY || !filled[other as usize] {
                let middle = (kind == CellKind::Line3).then(|| nodes[facet[2]]);
                sides.push(Side { ends: [nodes[facet[0]], nodes[facet[1]]], middle });
            }
        }
    }
    sides
}
