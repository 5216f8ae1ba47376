//! The boundary of a structure as lines along which the values of its hats are drawn.

use super::place::Segments;
use super::surface::Surface;

/// A place on a boundary: the two hats over it, with their values there (-), which add up to one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mark<const D: usize> {
    /// (m)
    pub place: [f64; D],
    pub hats: [(u32, f64); 2],
}

impl<const D: usize> Mark<D> {
    /// The function that is `values` at the hats, here.
    pub fn value(&self, values: &[f64]) -> f64 {
        self.hats.iter().map(|&(hat, share)| share * values[hat as usize]).sum()
    }
}

/// A line for each smooth stretch of the boundary, with a mark where segments meet and at both ends; one without ends
/// is closed by a last mark at the place of the first. The structure is on the left of the way along them.
pub fn lines(surface: &Surface, segments: &Segments) -> Vec<Vec<Mark<2>>> {
    let line = |piece: &std::ops::Range<usize>| {
        let cut = &surface.segments[piece.clone()];
        let (Some(first), Some(last)) = (cut.first(), cut.last()) else { return Vec::new() };
        let base = first.hats[0].0;
        let closed = last.hats[1].0 == base;
        // Distances are in hats from the beginning. The middle of a segment, whose hats are known, is the mean of its ends.
        let intervals = last.hats[0].0 + 1 - base;
        let mark = |at: f64, place| {
            let left = (at.max(0.0) as u32).min(intervals - 1);
            let right = if closed && left + 1 == intervals { 0 } else { left + 1 };
            let share = at - f64::from(left);
            Mark { place, hats: [(base + left, 1.0 - share), (base + right, share)] }
        };
        let mut at = 0.0;
        let mut marks = Vec::with_capacity(cut.len() + 1);
        for (segment, placed) in cut.iter().zip(&segments.0[piece.clone()]) {
            marks.push(mark(at, placed.from));
            at = 2.0 * (f64::from(segment.hats[0].0 - base) + segment.hats[1].1) - at;
        }
        marks.push(mark(at, segments.0[piece.end - 1].to));
        marks
    };
    surface.pieces.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::PlaneStrain;
    use crate::mesh::Mesh;
    use crate::mesh::shape::CellKind;

    fn lines_of(mesh: &Mesh<2>, spacing: f64) -> (Surface, Vec<Vec<Mark<2>>>) {
        let surface = Surface::new(mesh, 0, spacing, |_| false).unwrap();
        let segments = Segments::new::<PlaneStrain>(&surface, |n| mesh.nodes[n as usize]);
        let lines = lines(&surface, &segments);
        (surface, lines)
    }

    /// On each side of a square a function that is linear along it is found again, up to the corners.
    #[test]
    fn values_are_linear_between_hats_and_break_at_corners() {
        let mut mesh = Mesh {
            nodes: vec![[0., 0.], [1., 0.], [1., 1.], [0., 1.]],
            regions: vec!["pile".to_string()],
            ..Mesh::default()
        };
        mesh.cells.push(CellKind::Q4, 0, &[0, 1, 2, 3]);
        let (surface, lines) = lines_of(&mesh, 0.3);
        assert_eq!((lines.len(), surface.hats), (4, 16));
        // Four hats a side, the first and last at its corners.
        let values: Vec<f64> = (0..16).map(|k| f64::from(k / 4) + f64::from(k % 4) / 3.0).collect();
        for line in &lines {
            let (begin, end) = (line[0], line[line.len() - 1]);
            for mark in line {
                let along = (0..2).map(|d| (mark.place[d] - begin.place[d]).abs()).sum::<f64>();
                assert!((mark.value(&values) - begin.value(&values) - along).abs() < 1e-14, "{mark:?}");
                assert!((mark.hats[0].1 + mark.hats[1].1 - 1.0).abs() < 1e-15);
            }
            assert!((end.value(&values) - begin.value(&values) - 1.0).abs() < 1e-14);
        }
    }

    /// A disc has one line that ends where it begins.
    #[test]
    fn a_boundary_without_corners_closes() {
        let count = 12;
        let on = |k: usize| {
            let (sin, cos) = (std::f64::consts::TAU * k as f64 / count as f64).sin_cos();
            [cos, sin]
        };
        let mut mesh =
            Mesh { nodes: (0..count).map(on).collect(), regions: vec!["pipe".to_string()], ..Mesh::default() };
        mesh.nodes.push([0.0; 2]);
        for k in 0..count as u32 {
            mesh.cells.push(CellKind::T3, 0, &[k, (k + 1) % count as u32, count as u32]);
        }
        let (surface, lines) = lines_of(&mesh, 0.4);
        let [line] = &lines[..] else { panic!("{} lines", lines.len()) };
        let values: Vec<f64> = (0..surface.hats).map(|k| k as f64).collect();
        let (first, last) = (line[0], line[line.len() - 1]);
        assert!((0..2).all(|d| (first.place[d] - last.place[d]).abs() < 1e-15), "{last:?}");
        assert!((first.value(&values) - last.value(&values)).abs() < 1e-12);
    }
}
