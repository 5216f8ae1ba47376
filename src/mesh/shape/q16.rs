//! Sixteen-node (Lagrange) quadrilateral on `[-1, 1]²`, the carrier of cubic splines.
//!
//! ```text
//!  3 -  9 -  8 -  2
//! 10   15   14    7
//! 11   12   13    6
//!  0 -  4 -  5 -  1
//! ```

pub struct Q16;

/// A third.
const T: f64 = 1.0 / 3.0;

/// Position of each node along the two directions, as an index into the one-dimensional functions.
const INDEX: [[usize; 2]; 16] = [
    [0, 0],
    [3, 0],
    [3, 3],
    [0, 3],
    [1, 0],
    [2, 0],
    [3, 1],
    [3, 2],
    [2, 3],
    [1, 3],
    [0, 2],
    [0, 1],
    [1, 1],
    [2, 1],
    [2, 2],
    [1, 2],
];

/// Parametric coordinates of the nodes.
pub const NODES: [[f64; 3]; 16] = {
    let line = [-1.0, -T, T, 1.0];
    let mut nodes = [[0.0; 3]; 16];
    let mut i = 0;
    while i < 16 {
        nodes[i] = [line[INDEX[i][0]], line[INDEX[i][1]], 0.0];
        i += 1;
    }
    nodes
};

/// Cubic Lagrange functions with nodes at -1, -⅓, ⅓, 1.
pub fn line(t: f64) -> [f64; 4] {
    [
        -0.5625 * (t + T) * (t - T) * (t - 1.0),
        1.6875 * (t + 1.0) * (t - T) * (t - 1.0),
        -1.6875 * (t + 1.0) * (t + T) * (t - 1.0),
        0.5625 * (t + 1.0) * (t + T) * (t - T),
    ]
}

/// Their derivatives.
pub fn line_derivative(t: f64) -> [f64; 4] {
    let square = 3.0 * t * t;
    [
        -0.5625 * (square - 2.0 * t - T * T),
        1.6875 * (square - 2.0 * T * t - 1.0),
        -1.6875 * (square + 2.0 * T * t - 1.0),
        0.5625 * (square + 2.0 * t - T * T),
    ]
}

impl super::Shape for Q16 {
    const NODES: usize = 16;
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
