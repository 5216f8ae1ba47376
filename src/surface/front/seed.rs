//! The front of cells that are filled with points.

use super::{MarkerFront, PER_LENGTH};
use crate::mesh::Mesh;
use crate::mesh::faces::{BOUNDARY, Faces};
use crate::mesh::shape::CellKind;
use std::collections::BTreeMap;

/// A side of a filled cell beyond which there is nothing, with the material on its left.
struct Side {
    from: u32,
    to: u32,
    middle: Option<u32>,
}

impl MarkerFront {
    /// The boundary of the union of the cells that are `filled`.
    pub fn around(mesh: &Mesh<2>, faces: &Faces, filled: &[bool]) -> Self {
        let sides = sides(mesh, faces, filled);
        let mut outgoing: BTreeMap<u32, Vec<usize>> = BTreeMap::new();
        for (number, side) in sides.iter().enumerate() {
            outgoing.entry(side.from).or_default().push(number);
        }
        let direction = |side: &Side| {
            let (a, b) = (mesh.nodes[side.from as usize], mesh.nodes[side.to as usize]);
            [b[0] - a[0], b[1] - a[1]]
        };
        let mut front = Self { position: Vec::new(), first: vec![0] };
        let mut used = vec![false; sides.len()];
        for start in 0..sides.len() {
            let mut at = start;
            while !used[at] {
                used[at] = true;
                front.add(mesh, &sides[at]);
                let d = direction(&sides[at]);
                // Where bodies touch in a node, the sharpest turn to the left stays with the same one.
                let turn = |&number: &usize| {
                    let e = direction(&sides[number]);
                    (d[0] * e[1] - d[1] * e[0]).atan2(d[0] * e[0] + d[1] * e[1])
                };
                let next = outgoing.get(&sides[at].to).into_iter().flatten().copied().filter(|&n| !used[n]);
                let Some(next) = next.max_by(|a, b| turn(a).total_cmp(&turn(b))) else { break };
                at = next;
            }
            let count = front.position.len() as u32;
            if front.first.last() != Some(&count) {
                front.first.push(count);
            }
        }
        front
    }

    /// Appends the markers of a side without its last one.
    fn add(&mut self, mesh: &Mesh<2>, side: &Side) {
        let (a, b) = (mesh.nodes[side.from as usize], mesh.nodes[side.to as usize]);
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
                sides.push(Side { from: nodes[facet[0]], to: nodes[facet[1]], middle });
            }
        }
    }
    sides
}
