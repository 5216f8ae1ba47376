//! The segments of a boundary where the structure is now.

use super::surface::Surface;
use crate::geometry::{cross, distance, dot, way};
use crate::kinematics::Kinematics;
use crate::mesh::shape::MAX_NODES;

/// A segment where it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Placed {
    /// Its ends and its middle (m).
    pub from: [f64; 2],
    pub to: [f64; 2],
    pub middle: [f64; 2],
    /// Unit normal out of the structure.
    pub normal: [f64; 2],
    /// Area (m², per metre or full turn).
    pub area: f64,
    /// Curvature (1/m) of the boundary, positive where the structure is convex.
    pub curvature: f64,
    /// Arc length (m) of the middle along its piece.
    pub along: f64,
    /// Whether the boundary has a corner or an end where the segment begins and where it ends.
    pub ends: [bool; 2],
    /// Shape functions of the facet at the middle.
    pub value: [f64; 3],
}

impl Placed {
    /// Whether a place is beyond a corner or end of the boundary, so that the segment does not face it.
    pub fn passes(&self, x: &[f64; 2]) -> bool {
        let along = way(&self.from, &self.to);
        let beyond = |end: &[f64; 2]| dot(&way(end, x), &along);
        self.ends[0] && beyond(&self.from) < 0.0 || self.ends[1] && beyond(&self.to) > 0.0
    }
}

/// An angle (rad) between segments that is rounding.
const FLAT: f64 = 1e-6;

/// Finds the curvature of the segments of a smooth piece, by how the normal turns between those beside each.
fn bend(piece: &mut [Placed]) {
    let curvature = |i: usize| {
        let (a, b) = (&piece[i.saturating_sub(1)], &piece[(i + 1).min(piece.len() - 1)]);
        let (n, m) = (a.normal, b.normal);
        let length = b.along - a.along;
        let turn = cross(&n, &m).atan2(dot(&n, &m));
        if length > 0.0 && turn.abs() > FLAT { turn / length } else { 0.0 }
    };
    let curvatures: Vec<f64> = (0..piece.len()).map(curvature).collect();
    piece.iter_mut().zip(curvatures).for_each(|(placed, curvature)| placed.curvature = curvature);
}

/// All segments of a boundary, in their order.
#[derive(Clone, Debug, Default)]
pub struct Segments(pub Vec<Placed>);

impl Segments {
    /// The segments of `surface` with the nodes at `position`.
    pub fn new<K: Kinematics<2>>(surface: &Surface, position: impl Fn(u32) -> [f64; 2]) -> Self {
        let mut placed = Vec::with_capacity(surface.segments.len());
        for piece in &surface.pieces {
            let mut along = 0.0;
            for segment in &surface.segments[piece.clone()] {
                let facet = &surface.facets[segment.facet as usize];
                let at = |xi: f64| {
                    let mut n = [0.0; MAX_NODES];
                    surface.kind.values(&[xi, 0.0, 0.0], &mut n);
                    let mut x = [0.0; 2];
                    for (n, &node) in n.iter().zip(facet) {
                        let p = position(node);
                        for d in 0..2 {
                            x[d] += n * p[d];
                        }
                    }
                    (x, [n[0], n[1], n[2]])
                };
                let ([from, to], (middle, value)) =
                    ([segment.from, segment.to].map(|xi| at(xi).0), at(0.5 * (segment.from + segment.to)));
                let chord = [to[0] - from[0], to[1] - from[1]];
                let length = chord[0].hypot(chord[1]);
                let value = if facet.len() == 2 { [value[0], value[1], 0.0] } else { value };
                placed.push(Placed {
                    from,
                    to,
                    middle,
                    normal: [chord[1] / length, -chord[0] / length],
                    area: length * K::measure(&middle),
                    curvature: 0.0,
                    along: along + 0.5 * length,
                    ends: [false; 2],
                    value,
                });
                along += length;
            }
            bend(&mut placed[piece.clone()]);
            if let [first, .., last] = &mut placed[piece.clone()]
                && distance(&first.from, &last.to) > 1e-9 * along
            {
                (first.ends[0], last.ends[1]) = (true, true);
            }
        }
        Self(placed)
    }

    /// The length (m) of the piece of each contact node of `surface`, where that closes.
    pub fn loops(&self, surface: &Surface) -> Vec<Option<f64>> {
        let mut loops = vec![None; surface.contact_nodes];
        for ((contact_nodes, is_loop), piece) in surface.runs.iter().zip(&surface.pieces) {
            if let (true, [first, .., last]) = (*is_loop, &self.0[piece.clone()]) {
                loops[contact_nodes.clone()].fill(Some(last.along + first.along));
            }
        }
        loops
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::PlaneStrain;
    use crate::mesh::Mesh;
    use crate::mesh::shape::CellKind;

    /// The middle and the corners of a cell, of which two nodes of second order lie on each side.
    fn square(bulge: f64) -> Mesh<2> {
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let sides = [[0.0, -bulge], [bulge, 0.0], [0.0, bulge], [-bulge, 0.0]];
        let nodes = corners.into_iter().chain(sides).collect();
        let mut mesh = Mesh { nodes, regions: vec!["body".to_string()], ..Mesh::default() };
        mesh.cells.push(CellKind::Q8, 0, &[0, 1, 2, 3, 4, 5, 6, 7]);
        mesh
    }

    #[test]
    fn flat_sides_have_no_curvature_and_round_ones_that_of_their_circle() {
        for (bulge, curvature) in [(1.0, 0.0), (std::f64::consts::SQRT_2, 1.0 / std::f64::consts::SQRT_2)] {
            let mesh = square(bulge);
            let surface = Surface::new(&mesh, 0, 0.05, |_| false).unwrap();
            let segments = Segments::new::<PlaneStrain>(&surface, |n| mesh.nodes[n as usize]);
            let found: Vec<f64> = segments.0.iter().map(|segment| segment.curvature).collect();
            let mean = found.iter().sum::<f64>() / found.len() as f64;
            // A parabola through the corner and the middle of a side is a quarter of a circle but for some per cent.
            assert!((mean - curvature).abs() <= 0.03 * curvature, "{mean} {curvature}");
            assert!(curvature > 0.0 || found.iter().all(|&found| found == 0.0), "{found:?}");
        }
    }
}
