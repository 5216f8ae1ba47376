//! Shape functions, one cell kind a file, in Gmsh's node order and parametric coordinates.

mod functions;
mod h27;
mod line;
mod q16;
mod q4;
mod q8;
mod q9;
mod quadrature;
mod second;
mod t10;
mod t3;
mod t6;

pub use functions::{MAX_NODES, Shape, invert, jacobian};
pub use quadrature::rule;
pub use second::map_second;

/// Defines the kinds of cells and facets, each with its shape in a file.
macro_rules! kinds {
    ($($kind:ident in $file:ident),+) => {
        /// The kinds of cells and facets. Adding one: a file beside this one, its place in the list, a line in each `match`.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        pub enum CellKind {
            $($kind),+
        }

        impl CellKind {
            pub const ALL: [Self; 12] = [$(Self::$kind),+];

            pub fn node_count(self) -> usize {
                match self { $(Self::$kind => $file::$kind::NODES),+ }
            }

            pub fn dimension(self) -> usize {
                match self { $(Self::$kind => $file::$kind::DIMENSION),+ }
            }

            /// Shape functions at `xi` into `n[..node_count]`.
            pub fn values(self, xi: &[f64; 3], n: &mut [f64]) {
                match self { $(Self::$kind => $file::$kind::values(xi, n)),+ }
            }

            /// Derivatives with respect to `xi` into `dn[..node_count]`.
            pub fn derivatives(self, xi: &[f64; 3], dn: &mut [[f64; 3]]) {
                match self { $(Self::$kind => $file::$kind::derivatives(xi, dn)),+ }
            }
        }
    };
}

kinds!(
    Point1 in line, Line2 in line, Line3 in line, Line4 in line, T3 in t3, T6 in t6, Q4 in q4, Q8 in q8, Q9 in q9,
    Q16 in q16, T10 in t10, H27 in h27
);

impl CellKind {
    /// Whether the parametric domain is a simplex (triangle, tetrahedron) rather than a box.
    pub fn is_simplex(self) -> bool {
        matches!(self, Self::T3 | Self::T6 | Self::T10)
    }

    /// Corner nodes, which come first in a cell.
    pub fn corner_count(self) -> usize {
        match self {
            Self::Point1 => 1,
            Self::Line2 | Self::Line3 | Self::Line4 => 2,
            Self::T3 | Self::T6 => 3,
            Self::Q4 | Self::Q8 | Self::Q9 | Self::Q16 | Self::T10 => 4,
            Self::H27 => 8,
        }
    }

    /// Polynomial order of the edges.
    pub fn order(self) -> usize {
        match self {
            Self::Point1 => 0,
            Self::Line2 | Self::T3 | Self::Q4 => 1,
            Self::Line3 | Self::T6 | Self::Q8 | Self::Q9 | Self::T10 | Self::H27 => 2,
            Self::Line4 | Self::Q16 => 3,
        }
    }

    /// The facets (edges of a plane cell, faces of a solid one), as a kind and local node numbers, counter-clockwise: faces
    /// as seen from outside.
    pub fn facets(self) -> (Self, &'static [&'static [usize]]) {
        match self {
            Self::T3 => (Self::Line2, &[&[0, 1], &[1, 2], &[2, 0]]),
            Self::T6 => (Self::Line3, &[&[0, 1, 3], &[1, 2, 4], &[2, 0, 5]]),
            Self::Q4 => (Self::Line2, &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]]),
            Self::Q8 | Self::Q9 => (Self::Line3, &[&[0, 1, 4], &[1, 2, 5], &[2, 3, 6], &[3, 0, 7]]),
            Self::Q16 => (Self::Line4, &[&[0, 1, 4, 5], &[1, 2, 6, 7], &[2, 3, 8, 9], &[3, 0, 10, 11]]),
            Self::T10 => (Self::T6, &t10::FACES),
            Self::H27 => (Self::Q9, &h27::FACES),
            Self::Line2 | Self::Line3 | Self::Line4 => (Self::Point1, &[&[0], &[1]]),
            Self::Point1 => (Self::Point1, &[]),
        }
    }

    /// Parametric coordinates of the nodes.
    pub fn node_coordinates(self) -> &'static [[f64; 3]] {
        const T: [[f64; 3]; 6] =
            [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [0.5, 0., 0.], [0.5, 0.5, 0.], [0., 0.5, 0.]];
        const Q: [[f64; 3]; 9] = [
            [-1., -1., 0.],
            [1., -1., 0.],
            [1., 1., 0.],
            [-1., 1., 0.],
            [0., -1., 0.],
            [1., 0., 0.],
            [0., 1., 0.],
            [-1., 0., 0.],
            [0., 0., 0.],
        ];
        const L: [[f64; 3]; 3] = [[-1., 0., 0.], [1., 0., 0.], [0., 0., 0.]];
        const L4: [[f64; 3]; 4] = [[-1., 0., 0.], [1., 0., 0.], [-1. / 3., 0., 0.], [1. / 3., 0., 0.]];
        match self {
            Self::Point1 => &L[2..],
            Self::Line2 => &L[..2],
            Self::Line3 => &L,
            Self::Line4 => &L4,
            Self::T3 => &T[..3],
            Self::T6 => &T,
            Self::Q4 => &Q[..4],
            Self::Q8 => &Q[..8],
            Self::Q9 => &Q,
            Self::Q16 => &q16::NODES,
            Self::T10 => &t10::NODES,
            Self::H27 => &h27::NODES,
        }
    }

    /// The parametric centre.
    pub fn centre(self) -> [f64; 3] {
        match self {
            Self::T10 => [0.25; 3],
            _ if self.is_simplex() => [1.0 / 3.0, 1.0 / 3.0, 0.0],
            _ => [0.0; 3],
        }
    }

    /// How far inside the parametric domain `xi` lies: the least barycentric coordinate of a simplex, half
    /// the least distance to a side of a box; negative outside. The second value is the facet that limits it.
    #[inline]
    pub fn depth(self, xi: &[f64; 3]) -> (f64, usize) {
        let [x, y, z] = *xi;
        match self.dimension() {
            3 if self.is_simplex() => least([z, y, x, 1.0 - x - y - z]),
            3 => least([1.0 + z, 1.0 + y, 1.0 + x, 1.0 - x, 1.0 - y, 1.0 - z].map(|side| 0.5 * side)),
            2 if self.is_simplex() => least([y, 1.0 - x - y, x]),
            2 => least([1.0 + y, 1.0 - x, 1.0 - y, 1.0 + x].map(|side| 0.5 * side)),
            1 => least([1.0 + x, 1.0 - x].map(|side| 0.5 * side)),
            _ => (f64::INFINITY, 0),
        }
    }
}

/// The least of some values, and which one it is: the first of equals.
#[inline]
fn least<const N: usize>(values: [f64; N]) -> (f64, usize) {
    let mut least = (values[0], 0);
    for (i, &value) in values.iter().enumerate().skip(1) {
        if value < least.0 {
            least = (value, i);
        }
    }
    least
}

/// Values of the shape functions and their spatial gradients at `xi` of a cell with nodes at `x`:
/// `n` and `grad` take one entry a node; returns the determinant of the Jacobian `∂x/∂ξ`.
///
/// A gradient is meaningless where the determinant is not positive: the caller checks it.
pub fn map<const D: usize>(kind: CellKind, x: &[[f64; D]], xi: &[f64; 3], n: &mut [f64], grad: &mut [[f64; D]]) -> f64 {
    let mut dn = [[0.0; 3]; MAX_NODES];
    kind.values(xi, n);
    kind.derivatives(xi, &mut dn);
    let (inverse, determinant) = invert(&jacobian(x, &dn));
    for (grad, dn) in grad.iter_mut().zip(&dn).take(x.len()) {
        for j in 0..D {
            grad[j] = (0..D).map(|k| dn[k] * inverse[k][j]).sum();
        }
    }
    determinant
}

#[cfg(test)]
mod tests;
