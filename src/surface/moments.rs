//! Integrals of 1, x, y, x², xy, y² over a cell, or over the part of it where a level set is positive.
//!
//! The level set is given at the nodes and linear on the triangles between them (see `straight.rs`), in space where all edges are straight, else in
//! the parametric domain: curved cells keep their shape. Areas and volumes are per metre in plane strain and per
//! full turn (2π) in axisymmetry, by [`Kinematics::measure`].

use super::split::{Barycentric, CORNERS, corners, positive, triangles};
use crate::geometry::twice_area;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::shape::{self, CellKind, MAX_NODES, rule};
use std::sync::OnceLock;

/// The coordinates `(x − centre) / length` of one cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CellFrame {
    /// Mean of the corner nodes (m).
    pub centre: [f64; 2],
    /// Square root of the area between the corner nodes (m).
    pub length: f64,
}

/// The integrals (m³, per metre or full turn) of `1, x, y, x², xy, y²` in the coordinates of a [`CellFrame`].
pub type Moments = [f64; 6];

impl CellFrame {
    /// The frame of cell `c`.
    pub fn of(mesh: &Mesh<2>, c: usize) -> Self {
        let (centre, count) = (mesh.centre(c), mesh.cells.kind[c].corner_count());
        let x = |i: usize| mesh.nodes[mesh.cells.nodes(c)[i % count] as usize];
        let area: f64 = (0..count).map(|i| 0.5 * twice_area(&[centre, x(i), x(i + 1)])).sum();
        Self { centre, length: area.abs().sqrt() }
    }

    /// The coordinates (-) of the place `x` (m).
    pub fn local(&self, x: &[f64; 2]) -> [f64; 2] {
        [0, 1].map(|d| (x[d] - self.centre[d]) / self.length)
    }
}

/// `1, x, y, x², xy, y²` at local coordinates.
pub fn monomials(x: &[f64; 2]) -> Moments {
    [1.0, x[0], x[1], x[0] * x[0], x[0] * x[1], x[1] * x[1]]
}

/// A cell with what its integrals need.
pub struct Cell<'a> {
    kind: CellKind,
    /// The nodes in the local coordinates of the frame in which moments are taken.
    x: [[f64; 2]; MAX_NODES],
    frame: &'a CellFrame,
    straight: bool,
}

impl<'a> Cell<'a> {
    /// Cell `c`, its moments to be taken in `frame`; `straight` as [`is_straight`] has it.
    pub fn new(mesh: &Mesh<2>, c: usize, frame: &'a CellFrame, straight: bool) -> Self {
        let mut x = [[0.0; 2]; MAX_NODES];
        for (x, &n) in x.iter_mut().zip(mesh.cells.nodes(c)) {
            *x = frame.local(&mesh.nodes[n as usize]);
        }
        Self { kind: mesh.cells.kind[c], x, frame, straight }
    }

    /// The moments of the whole cell, exact for cells up to second order and for straight ones.
    pub fn whole<K: Kinematics<2>>(&self) -> Moments {
        let mut moments = [0.0; 6];
        if self.straight || self.kind.is_simplex() {
            for triangle in triangles(self.kind) {
                self.add::<K>(triangle, &CORNERS, 1.0, &mut moments);
            }
        } else {
            // x² · det J · r is of degree 4 + 3 + 2 in each direction.
            for (xi, weight) in rule(self.kind, 9) {
                self.add_point::<K>(&xi, weight, &mut moments);
            }
        }
        moments
    }

    /// The moments of the part where the level set with the nodal `values` is positive: exact where the cell is
    /// straight or a triangle. Empty parts have exact zeros.
    pub fn clipped<K: Kinematics<2>>(&self, values: &[f64]) -> Moments {
        let mut moments = [0.0; 6];
        for triangle in triangles(self.kind) {
            positive(&triangle.map(|i| values[i]), |piece, fraction| {
                self.add::<K>(triangle, piece, fraction, &mut moments);
            });
        }
        moments
    }

    /// The volume (m³) of that part: `clipped()[0]` to rounding, for less where the cell is straight.
    pub fn clipped_volume<K: Kinematics<2>>(&self, values: &[f64]) -> f64 {
        if !self.straight {
            return self.clipped::<K>(values)[0];
        }
        let mut volume = 0.0;
        for triangle in triangles(self.kind) {
            let x = triangle.map(|i| self.x[i]);
            let area = 0.5 * self.frame.length * self.frame.length * twice_area(&x);
            positive(&triangle.map(|i| values[i]), |piece, fraction| {
                let centroid = [0, 1, 2].map(|k| (piece[0][k] + piece[1][k] + piece[2][k]) / 3.0);
                volume += area * fraction * self.measure::<K>(&place(&x, &centroid));
            });
        }
        volume
    }

    /// Adds the integrals (m³) of the shape functions of the cell's nodes, linear on the triangles between them, to `out`, one
    /// entry a node. They sum to the volume of the cell.
    pub fn nodal_volumes<K: Kinematics<2>>(&self, out: &mut [f64]) {
        for triangle in triangles(self.kind) {
            if self.straight {
                let x = triangle.map(|i| self.x[i]);
                let area = 0.5 * self.frame.length * self.frame.length * twice_area(&x);
                // Shape function times radius is of degree 2: the middles of the sides.
                for l in [[0.5, 0.5, 0.0], [0.0, 0.5, 0.5], [0.5, 0.0, 0.5]] {
                    let volume = area / 3.0 * self.measure::<K>(&place(&x, &l));
                    for (&i, l) in triangle.iter().zip(l) {
                        out[i] += l * volume;
                    }
                }
                continue;
            }
            let xi = corners(self.kind, triangle);
            let area = twice_area(&xi);
            for (l, weight) in high_rule() {
                let [a, b] = place(&xi, l);
                let mut moments = [0.0; 6];
                self.add_point::<K>(&[a, b, 0.0], weight * area, &mut moments);
                for (&i, l) in triangle.iter().zip(l) {
                    out[i] += l * moments[0];
                }
            }
        }
    }

    /// Adds the moments of a piece of one of the cell's triangles.
    fn add<K: Kinematics<2>>(
        &self,
        triangle: &[usize; 3],
        piece: &[Barycentric; 3],
        fraction: f64,
        moments: &mut Moments,
    ) {
        let mix = |l: &Barycentric| [0, 1, 2].map(|k| (0..3).map(|m| l[m] * piece[m][k]).sum::<f64>());
        if !self.straight {
            let xi = corners(self.kind, triangle);
            let area = fraction * twice_area(&xi);
            for (l, weight) in high_rule() {
                let [a, b] = place(&xi, &mix(l));
                self.add_point::<K>(&[a, b, 0.0], weight * area, moments);
            }
            return;
        }
        let x = triangle.map(|i| self.x[i]);
        let area = 0.5 * fraction * self.frame.length * self.frame.length * twice_area(&x);
        let at = piece.map(|l| place(&x, &l));
        let mut add = |x: [f64; 2], weight: f64| {
            let weight = weight * area * self.measure::<K>(&x);
            for (sum, value) in moments.iter_mut().zip(monomials(&x)) {
                *sum += weight * value;
            }
        };
        let mean = |i: usize, j: usize| [0, 1].map(|d| 0.5 * (at[i][d] + at[j][d]));
        if K::HOOP {
            // Degree 3: corners, middles of the sides and centroid.
            at.iter().for_each(|x| add(*x, 1.0 / 20.0));
            [mean(0, 1), mean(1, 2), mean(2, 0)].into_iter().for_each(|x| add(x, 2.0 / 15.0));
            add([0, 1].map(|d| (at[0][d] + at[1][d] + at[2][d]) / 3.0), 9.0 / 20.0);
        } else {
            // Degree 2.
            [mean(0, 1), mean(1, 2), mean(2, 0)].into_iter().for_each(|x| add(x, 1.0 / 3.0));
        }
    }

    /// Adds the moments at a quadrature point of the parametric domain.
    fn add_point<K: Kinematics<2>>(&self, xi: &[f64; 3], weight: f64, moments: &mut Moments) {
        let (mut n, mut gradient) = ([0.0; MAX_NODES], [[0.0; 2]; MAX_NODES]);
        let count = self.kind.node_count();
        let det = shape::map(self.kind, &self.x[..count], xi, &mut n, &mut gradient);
        let x = [0, 1].map(|d| (0..count).map(|i| n[i] * self.x[i][d]).sum::<f64>());
        let weight = weight * det * self.frame.length * self.frame.length * self.measure::<K>(&x);
        for (sum, value) in moments.iter_mut().zip(monomials(&x)) {
            *sum += weight * value;
        }
    }

    fn measure<K: Kinematics<2>>(&self, x: &[f64; 2]) -> f64 {
        K::measure(&[0, 1].map(|d| self.frame.centre[d] + self.frame.length * x[d]))
    }
}

/// Whether cell `c` has straight edges and its other nodes where the map of its corners has them.
pub fn is_straight(mesh: &Mesh<2>, c: usize) -> bool {
    super::straight::is_straight(mesh.cells.kind[c], &mesh.coordinates(c))
}

/// The place with barycentric coordinates `l` in the triangle `x`.
fn place(x: &[[f64; 2]; 3], l: &Barycentric) -> [f64; 2] {
    [0, 1].map(|d| l[0] * x[0][d] + l[1] * x[1][d] + l[2] * x[2][d])
}

/// Barycentric points and weights (sum ½) of degree 8: x² · det J · r on a curved six-node triangle. A Gauss rule of
/// the square, collapsed onto the triangle.
fn high_rule() -> &'static [(Barycentric, f64)] {
    static RULE: OnceLock<Vec<(Barycentric, f64)>> = OnceLock::new();
    RULE.get_or_init(|| {
        let collapse = |(xi, weight): ([f64; 3], f64)| {
            let (a, b) = (0.5 * (1.0 + xi[0]), 0.5 * (1.0 + xi[1]));
            ([1.0 - a, a * (1.0 - b), a * b], 0.25 * weight * a)
        };
        rule(CellKind::Q4, 9).into_iter().map(collapse).collect()
    })
}

#[cfg(test)]
mod tests;
