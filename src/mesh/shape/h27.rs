//! Twenty-seven-node (Lagrange) hexahedron on `[-1, 1]³`, in the node order of Gmsh (reference manual, "Node ordering",
//! Hexahedron27).
//!
//! ```text
//!            η
//!     3 --- 13 --- 2
//!     |\           |\
//!     | 15    24   | 14          faces: 20 at ζ = -1, 25 at ζ = 1,
//!     9  \  20    11  \                 21 at η = -1, 24 at η = 1,
//!     |    7 --- 19+--- 6               22 at ξ = -1, 23 at ξ = 1;
//!     | 22 |  26   | 23 |        centre: 26
//!     0 ---+- 8 -- 1    |  ξ
//!      \  17    25  \   18
//!      10  |  21    12  |
//!        \ |          \ |
//!          4 --- 16 --- 5
//!          ζ
//! ```

use super::q9::{line, line_derivative};

pub struct H27;

/// Parametric coordinates of the nodes.
pub const NODES: [[f64; 3]; 27] = [
    [-1., -1., -1.],
    [1., -1., -1.],
    [1., 1., -1.],
    [-1., 1., -1.],
    [-1., -1., 1.],
    [1., -1., 1.],
    [1., 1., 1.],
    [-1., 1., 1.],
    [0., -1., -1.],
    [-1., 0., -1.],
    [-1., -1., 0.],
    [1., 0., -1.],
    [1., -1., 0.],
    [0., 1., -1.],
    [1., 1., 0.],
    [-1., 1., 0.],
    [0., -1., 1.],
    [-1., 0., 1.],
    [1., 0., 1.],
    [0., 1., 1.],
    [0., 0., -1.],
    [0., -1., 0.],
    [-1., 0., 0.],
    [1., 0., 0.],
    [0., 1., 0.],
    [0., 0., 1.],
    [0., 0., 0.],
];

/// The nodes of the faces as those of a [`super::q9::Q9`], counter-clockwise from outside.
pub const FACES: [&[usize]; 6] = [
    &[0, 3, 2, 1, 9, 13, 11, 8, 20],
    &[0, 1, 5, 4, 8, 12, 16, 10, 21],
    &[0, 4, 7, 3, 10, 17, 15, 9, 22],
    &[1, 2, 6, 5, 11, 14, 18, 12, 23],
    &[2, 3, 7, 6, 13, 15, 19, 14, 24],
    &[4, 5, 6, 7, 16, 18, 19, 17, 25],
];

/// Position of each node along the three directions, as an index into the one-dimensional functions.
const INDEX: [[usize; 3]; 27] = {
    let mut index = [[0; 3]; 27];
    let mut n = 0;
    while n < 27 {
        let [x, y, z] = NODES[n];
        index[n] = [(x + 1.0) as usize, (y + 1.0) as usize, (z + 1.0) as usize];
        n += 1;
    }
    index
};

impl super::Shape for H27 {
    const NODES: usize = 27;
    const DIMENSION: usize = 3;

    fn values(xi: &[f64; 3], n: &mut [f64]) {
        let [x, y, z] = xi.map(line);
        for (n, [i, j, k]) in n.iter_mut().zip(INDEX) {
            *n = x[i] * y[j] * z[k];
        }
    }

    fn derivatives(xi: &[f64; 3], dn: &mut [[f64; 3]]) {
        let [x, y, z] = xi.map(line);
        let [dx, dy, dz] = xi.map(line_derivative);
        for (dn, [i, j, k]) in dn.iter_mut().zip(INDEX) {
            *dn = [dx[i] * y[j] * z[k], x[i] * dy[j] * z[k], x[i] * y[j] * dz[k]];
        }
    }
}
