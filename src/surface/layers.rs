//! Places in the active part of a cell for integrals of what bends at given heights.
//!
//! The triangles between the nodes of the cell are cut along the level set (see `split.rs`), and along the heights as
//! far as these are linear on each of them. A function that is a polynomial of the height between them is integrated as
//! one: exactly where the cell has straight edges and heights are linear in it.

use super::split::{Barycentric, positive, triangles};
use super::straight::Triangles;
use crate::geometry::twice_area;
use crate::mesh::shape::{CellKind, rule};
use std::sync::OnceLock;

/// The degree of what a piece integrates exactly: the square of the height times a function that is linear, or a
/// quadratic one times the height, both times the radius.
const DEGREE: usize = 4;

/// A part of one of the cell's triangles.
struct Piece {
    /// The corners, as [`Triangles::corners`], and the heights there (m).
    at: [[f64; 2]; 3],
    height: [f64; 3],
    /// Its area.
    area: f64,
}

impl Piece {
    /// Calls `part` for the pieces in which the linear function with the values `v` at the corners is positive.
    fn positive(&self, v: &[f64; 3], mut part: impl FnMut(&Self)) {
        positive(v, |corners, fraction| {
            let mix = |l: &Barycentric, of: [f64; 3]| l[0] * of[0] + l[1] * of[1] + l[2] * of[2];
            let at = corners.map(|l| [0, 1].map(|d| mix(&l, self.at.map(|x| x[d]))));
            let height = corners.map(|l| mix(&l, self.height));
            part(&Self { at, height, area: self.area * fraction });
        });
    }

    /// Calls `place` for the places of the piece, cut at the ascending `breaks`.
    fn visit(&self, breaks: &[f64], place: &mut dyn FnMut(&[f64; 2], f64)) {
        let Some((&level, above)) = breaks.split_first() else { return self.emit(place) };
        self.positive(&self.height.map(|y| level - y), |below| below.emit(place));
        self.positive(&self.height.map(|y| y - level), |rest| rest.visit(above, place));
    }

    fn emit(&self, place: &mut dyn FnMut(&[f64; 2], f64)) {
        static RULE: OnceLock<Vec<([f64; 3], f64)>> = OnceLock::new();
        let [a, b, c] = self.at;
        for ([s, t, _], weight) in RULE.get_or_init(|| rule(CellKind::T3, DEGREE)) {
            let [x, y] = [0, 1].map(|d| a[d] + s * (b[d] - a[d]) + t * (c[d] - a[d]));
            place(&[x, y], 2.0 * weight * self.area);
        }
    }
}

/// Calls `place` with the parametric coordinates and the weight of places that cover the part of a cell with its nodes at `x` (m)
/// where the level set is positive, given by its nodal values; `height` (m) are those of the nodes, `breaks` ascending. The weight is parametric, or
/// an area (m²) where [`Triangles::in_space`].
pub fn visit_layers(
    split: &Triangles,
    level_set: &[f64],
    height: &[f64],
    breaks: &[f64],
    mut place: impl FnMut(&[f64; 3], f64),
) {
    for triangle in triangles(split.kind()) {
        let at = split.corners(triangle);
        let whole = Piece { at, height: triangle.map(|i| height[i]), area: 0.5 * twice_area(&at) };
        whole.positive(&triangle.map(|i| level_set[i]), |part| {
            part.visit(breaks, &mut |at, weight| {
                let [x, y] = split.parametric(at);
                place(&[x, y, 0.0], weight);
            });
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::PlaneStrain;
    use crate::mesh::Mesh;
    use crate::mesh::builder::rectangle;
    use crate::mesh::shape::{MAX_NODES, map};
    use crate::surface::Geometry;

    /// `∫ f(value) dV` (m²) over the part of cell `c` where `level_set` is positive, `value` given at the nodes.
    fn integral(
        mesh: &Mesh<2>,
        c: usize,
        level_set: &[f64],
        value: &[f64],
        breaks: &[f64],
        f: impl Fn(f64) -> f64,
    ) -> f64 {
        let (kind, nodes) = (mesh.cells.kind[c], mesh.cells.nodes(c));
        let x: Vec<_> = nodes.iter().map(|&n| mesh.nodes[n as usize]).collect();
        let (mut n, mut gradient, mut sum) = ([0.0; MAX_NODES], [[0.0; 2]; MAX_NODES], 0.0);
        let split = Triangles::of(kind, &x);
        visit_layers(&split, level_set, value, breaks, |xi, weight| {
            let det = map(kind, &x, xi, &mut n, &mut gradient);
            let there: f64 = n.iter().zip(value).map(|(n, value)| n * value).sum();
            sum += weight * if split.in_space() { 1.0 } else { det } * f(there);
        });
        sum
    }

    #[test]
    fn what_bends_at_heights_is_integrated_exactly_in_the_active_part() {
        for kind in CellKind::ALL.into_iter().filter(|kind| kind.dimension() == 2) {
            let mesh = rectangle(kind, 0.7, 0.6, 2, 2, 0.2, 1);
            let geometry = Geometry::new::<PlaneStrain>(&mesh);
            for c in 0..mesh.cells.len() {
                let at = |f: fn(&[f64; 2]) -> f64| -> Vec<f64> {
                    mesh.cells.nodes(c).iter().map(|&n| f(&mesh.nodes[n as usize])).collect()
                };
                let (slanted, height) = (at(|x| x[0] - 0.3 * x[1] - 0.21), at(|x| x[1]));
                let all = vec![1.0; height.len()];
                for level in [-0.1, 0.0, 0.07, 0.3, 0.41, 0.6, 0.8] {
                    // ∫ ⟨level − y⟩² dV from the moments of what is below the level.
                    let below: Vec<f64> = height.iter().map(|y| level - y).collect();
                    let frame = geometry.frame[c];
                    let moments = geometry.cell(&mesh, c, c).clipped::<PlaneStrain>(&below);
                    let (l, s) = (level - frame.centre[1], frame.length);
                    let wanted = l * l * moments[0] - 2.0 * l * s * moments[2] + s * s * moments[5];
                    let got = integral(&mesh, c, &all, &height, &[level], |y| (level - y).max(0.0).powi(2));
                    assert!((got - wanted).abs() < 1e-15, "{kind:?}, {level}: {got} {wanted}");
                    // The same part cut off in two ways.
                    let one = integral(&mesh, c, &slanted, &height, &[level], |y| f64::from(y < level));
                    let other = integral(&mesh, c, &below, &slanted, &[0.0], |v| f64::from(v > 0.0));
                    assert!((one - other).abs() < 1e-15, "{kind:?}, {level}: {one} {other}");
                }
            }
        }
    }
}
