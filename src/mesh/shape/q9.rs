//! Nine-node (Lagrange) quadrilateral on `[-1, 1]²`.
//!
//! ```text
//! 3 - 6 - 2
//! 7   8   5
//! 0 - 4 - 1
//! ```

pub struct Q9;

/// Position of each node along the two directions, as an index into the one-dimensional functions.
const INDEX: [[usize; 2]; 9] = [[0, 0], [2, 0], [2, 2], [0, 2], [1, 0], [2, 1], [1, 2], [0, 1], [1, 1]];

/// Quadratic Lagrange functions with nodes at -1, 0, 1.
pub fn line(t: f64) -> [f64; 3] {
    [0.5 * t * (t - 1.0), 1.0 - t * t, 0.5 * t * (t + 1.0)]
}

/// Their derivatives.
pub fn line_derivative(t: f64) -> [f64; 3] {
    [t - 0.5, -2.0 * t, t + 0.5]
}

impl super::Shape for Q9 {
    const NODES: usize = 9;
    const DIMENSION: usize = 2;

    fn values(xi: &[f64; 3], n: &mut [f64]) {
        let (x, y) = (line(xi[0]), line(xi[1]));
        for (n, [i, j]) in n.iter_mut().zip(INDEX) {
            *n = x[i] * y[j];
        }
    }

    fn derivatives(xi: &[f64; 3], dn: &mut [[f64; 3]]) {
        let (x, y) = (line(xi[0]), line(xi[1]));
        let (dx, dy) = (line_derivative(xi[0]), line_derivative(xi[1]));
        for (dn, [i, j]) in dn.iter_mut().zip(INDEX) {
            *dn = [dx[i] * y[j], x[i] * dy[j], 0.0];
        }
    }
}
