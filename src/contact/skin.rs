//! The surface that soil began with, seen from its points.
//!
//! A point knows how it was strained since the run began, and so where that surface is now, as far as it is near: at
//! `x_p + F (X_s − X_p)`. That is as smooth as the strain is, where the points themselves lie anywhere below it.

use crate::geometry::{Line, Lines, length, way};
use crate::mesh::Mesh;
use crate::mesh::faces::Faces;

/// Cosine of the angle from which on a piece of the surface faces a direction.
const FACING: f64 = 0.5;

/// The boundary of the soil as it was seeded.
#[derive(Clone, Debug, Default)]
pub struct Skin {
    /// With the soil on their left.
    pieces: Vec<Line<2>>,
    longest: f64,
}

impl Skin {
    /// That of the cells of some `regions` of a mesh, without the facets that `skip` is true for, given their nodes.
    pub fn new(mesh: &Mesh<2>, regions: &[u16], skip: impl Fn(&[u32]) -> bool) -> Self {
        let cells = mesh.part(|c| regions.contains(&mesh.cells.region[c]));
        let at = |n: u32| cells.nodes[n as usize];
        let mut pieces = Vec::new();
        for (cell, side) in Faces::of(&cells).boundary {
            let (_, local) = cells.cells.kind[cell as usize].facets();
            let nodes = cells.cells.nodes(cell as usize);
            let facet: Vec<u32> = local[side as usize].iter().map(|&i| nodes[i]).collect();
            match facet[..] {
                _ if skip(&facet) => {}
                [a, b, middle] => pieces.extend([[at(a), at(middle)], [at(middle), at(b)]]),
                [a, b] => pieces.push([at(a), at(b)]),
                _ => {}
            }
        }
        let longest = pieces.iter().map(length).fold(0.0, f64::max);
        Self { pieces, longest }
    }

    /// The pieces by place, to be seen from no farther than `reach` (m).
    pub fn seen(&self, reach: f64) -> Seen {
        Seen { pieces: Lines::new(self.pieces.clone(), reach + self.longest), reach }
    }
}

/// A skin by place.
pub struct Seen {
    pieces: Lines,
    reach: f64,
}

impl Seen {
    /// How deep (m) a place in the soil is below the surface, along a unit direction out of the soil; `None` where nothing
    /// that faces it is within reach.
    pub fn depth(&self, x: &[f64; 2], outward: &[f64; 2]) -> Option<f64> {
        let faces = |piece: usize| {
            let [a, b] = &self.pieces.lines[piece];
            let along = way(a, b);
            along[1] * outward[0] - along[0] * outward[1] >= FACING * along[0].hypot(along[1])
        };
        let hits = self.pieces.hits(*x, *outward, faces).map(|hit| hit.distance);
        hits.filter(|distance| (0.0..=self.reach).contains(distance)).min_by(f64::total_cmp)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::builder::rectangle;
    use crate::mesh::shape::CellKind;

    /// Below the top of a square the depth is that to the top along any direction that it faces, and nothing else is seen.
    #[test]
    fn depth_is_along_the_direction() {
        let mut mesh = rectangle(CellKind::T6, 1.0, 1.0, 4, 4, 0.0, 0);
        mesh.regions = vec!["soil".to_string()];
        let skin = Skin::new(&mesh, &[0], |_| false);
        let seen = skin.seen(0.3);
        assert!((seen.depth(&[0.4, 0.9], &[0.0, 1.0]).unwrap() - 0.1).abs() < 1e-14);
        assert!((seen.depth(&[0.4, 0.9], &[0.6, 0.8]).unwrap() - 0.125).abs() < 1e-14);
        assert!((seen.depth(&[0.1, 0.3], &[-1.0, 0.0]).unwrap() - 0.1).abs() < 1e-14);
        assert_eq!(seen.depth(&[0.1, 0.5], &[0.0, 1.0]), None);
        assert_eq!(seen.depth(&[0.1, 0.9], &[0.0, -1.0]), None);
        let open = Skin::new(&mesh, &[0], |nodes| nodes.iter().all(|&n| mesh.nodes[n as usize][1] == 1.0));
        assert_eq!(open.seen(0.3).depth(&[0.4, 0.9], &[0.0, 1.0]), None);
    }
}
