//! The triangles between the nodes of a cell as they lie in space.
//!
//! They are straight in the parametric domain (see `split.rs`). In a quadrilateral with straight edges they are so in space instead, which is not the
//! same unless it is a parallelogram: there alone a diagonal of the domain is straight. So a level set that is linear in space is linear on the
//! triangles of all cells with straight edges, and these are cut where it is zero.

use super::split::{Barycentric, corners, triangles};
use crate::geometry::twice_area;
use crate::mesh::shape::CellKind;

/// Newton steps to find parametric coordinates.
const INVERSIONS: usize = 20;
/// A parametric step that is rounding.
const ROUNDING: f64 = 1e-15;

/// The triangles of a cell with its nodes in place.
#[derive(Clone, Copy)]
pub struct Triangles<'a> {
    kind: CellKind,
    x: &'a [[f64; 2]],
    /// Whether it is a quadrilateral with straight edges.
    in_space: bool,
}

impl<'a> Triangles<'a> {
    /// Those of a cell with its nodes at `x` (m), or more than these.
    pub fn of(kind: CellKind, x: &'a [[f64; 2]]) -> Self {
        Self { kind, x, in_space: !kind.is_simplex() && is_straight(kind, x) }
    }

    pub fn kind(&self) -> CellKind {
        self.kind
    }

    /// Whether they are straight in space and not in the parametric domain.
    pub fn in_space(&self) -> bool {
        self.in_space
    }

    /// The corners of one of them where it is straight: in space (m), or parametric.
    pub fn corners(&self, triangle: &[usize; 3]) -> [[f64; 2]; 3] {
        if self.in_space { triangle.map(|i| self.x[i]) } else { corners(self.kind, triangle) }
    }

    /// The parametric coordinates of a place that is given as [`Self::corners`] are.
    pub fn parametric(&self, place: &[f64; 2]) -> [f64; 2] {
        if self.in_space { self.inverse(place) } else { *place }
    }

    /// The parametric coordinates of the place at the share `t` of the way from one node to another of the same triangle.
    pub fn between(&self, [i, j]: [usize; 2], t: f64) -> [f64; 2] {
        let way = |x: [f64; 2], y: [f64; 2]| [0, 1].map(|d| x[d] + t * (y[d] - x[d]));
        if self.in_space {
            return self.inverse(&way(self.x[i], self.x[j]));
        }
        let node = |i: usize| [0, 1].map(|d| self.kind.node_coordinates()[i][d]);
        way(node(i), node(j))
    }

    /// The triangle that holds the parametric point `xi` (the first of several) and the barycentric coordinates there. A point outside
    /// the cell belongs to the nearest triangle, with a negative coordinate.
    pub fn barycentric(&self, xi: &[f64; 3]) -> (&'static [usize; 3], Barycentric) {
        let place = if self.in_space { self.place(&[xi[0], xi[1]]) } else { [xi[0], xi[1]] };
        let (mut best, mut depth) = ((&[0, 0, 0], [0.0; 3]), f64::NEG_INFINITY);
        for triangle in triangles(self.kind) {
            let x = self.corners(triangle);
            let whole = twice_area(&x);
            let (b, c) = (twice_area(&[x[0], place, x[2]]) / whole, twice_area(&[x[0], x[1], place]) / whole);
            let l = [1.0 - b - c, b, c];
            let least = l[0].min(b).min(c);
            if least > depth {
                (best, depth) = ((triangle, l), least);
                if least >= 0.0 {
                    break;
                }
            }
        }
        best
    }

    /// The change of the parametric coordinates at `xi` that is `by` (m) in space, where lines are straight in space.
    pub fn change(&self, xi: &[f64; 2], by: &[f64; 2]) -> Option<[f64; 2]> {
        self.in_space.then(|| solve(&slopes(self.x, xi), by))
    }

    fn place(&self, xi: &[f64; 2]) -> [f64; 2] {
        bilinear(self.x, xi)
    }

    fn inverse(&self, place: &[f64; 2]) -> [f64; 2] {
        let mut xi = [0.0; 2];
        for _ in 0..INVERSIONS {
            let at = self.place(&xi);
            let step = solve(&slopes(self.x, &xi), &[place[0] - at[0], place[1] - at[1]]);
            xi = [xi[0] + step[0], xi[1] + step[1]];
            if step[0].abs() + step[1].abs() <= ROUNDING {
                break;
            }
        }
        xi
    }
}

/// Whether a cell has straight edges and all its other nodes where the map of its corners has them, so that this is its map.
pub fn is_straight(kind: CellKind, x: &[[f64; 2]]) -> bool {
    let count = kind.corner_count();
    let centre = [0, 1].map(|d| x[..count].iter().map(|x| x[d]).sum::<f64>() / count as f64);
    let area: f64 = (0..count).map(|i| 0.5 * twice_area(&[centre, x[i], x[(i + 1) % count]])).sum();
    kind.node_coordinates().iter().zip(x).all(|(xi, x_i)| {
        let image = if kind.is_simplex() {
            [0, 1].map(|d| x[0][d] + xi[0] * (x[1][d] - x[0][d]) + xi[1] * (x[2][d] - x[0][d]))
        } else {
            bilinear(x, &[xi[0], xi[1]])
        };
        let rounding = |d: usize| 1e-13 * area.abs().sqrt() + 4.0 * f64::EPSILON * x_i[d].abs();
        (0..2).all(|d| (image[d] - x_i[d]).abs() <= rounding(d))
    })
}

/// The corners of a quadrilateral in its parametric domain.
const SIGNS: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

/// The place of `xi` by the map of the four corners.
fn bilinear(x: &[[f64; 2]], xi: &[f64; 2]) -> [f64; 2] {
    let n = SIGNS.map(|[s, t]| 0.25 * (1.0 + s * xi[0]) * (1.0 + t * xi[1]));
    [0, 1].map(|d| (0..4).map(|i| n[i] * x[i][d]).sum())
}

/// Its derivatives `∂x_d/∂ξ_e`.
fn slopes(x: &[[f64; 2]], xi: &[f64; 2]) -> [[f64; 2]; 2] {
    let of = SIGNS.map(|[s, t]| [0.25 * s * (1.0 + t * xi[1]), 0.25 * t * (1.0 + s * xi[0])]);
    [0, 1].map(|d| [0, 1].map(|e| (0..4).map(|i| of[i][e] * x[i][d]).sum()))
}

fn solve(by: &[[f64; 2]; 2], b: &[f64; 2]) -> [f64; 2] {
    let determinant = by[0][0] * by[1][1] - by[0][1] * by[1][0];
    [(by[1][1] * b[0] - by[0][1] * b[1]) / determinant, (by[0][0] * b[1] - by[1][0] * b[0]) / determinant]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::builder::rectangle;

    /// In quadrilaterals of any shape with straight edges, triangles are straight in space.
    #[test]
    fn places_of_straight_quadrilaterals_are_where_space_has_them() {
        for kind in CellKind::ALL.into_iter().filter(|k| k.dimension() == 2) {
            let mesh = rectangle(kind, 3.0, 2.0, 4, 3, 0.25, 5);
            for c in 0..mesh.cells.len() {
                let x = mesh.coordinates(c);
                let split = Triangles::of(kind, &x);
                assert_eq!(split.in_space(), !kind.is_simplex(), "{kind:?}");
                let mut n = [0.0; crate::mesh::shape::MAX_NODES];
                for triangle in triangles(kind) {
                    let (a, b) = (x[triangle[0]], x[triangle[2]]);
                    let [s, t] = split.between([triangle[0], triangle[2]], 0.3);
                    kind.values(&[s, t, 0.0], &mut n);
                    for d in 0..2 {
                        let place: f64 = n.iter().zip(&x).map(|(n, x)| n * x[d]).sum();
                        assert!((place - (a[d] + 0.3 * (b[d] - a[d]))).abs() < 1e-13, "{kind:?} {c}");
                    }
                    let (found, l) = split.barycentric(&[s, t, 0.0]);
                    let place = |d: usize| (0..3).map(|k| l[k] * x[found[k]][d]).sum::<f64>();
                    assert!(l.iter().all(|l| *l > -1e-12));
                    assert!((0..2).all(|d| (place(d) - (a[d] + 0.3 * (b[d] - a[d]))).abs() < 1e-13), "{kind:?} {c}");
                }
            }
        }
    }
}
