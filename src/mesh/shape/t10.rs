//! Ten-node tetrahedron, `ξ, η, ζ ≥ 0`, `ξ + η + ζ ≤ 1`, in the node order of Gmsh (reference manual, "Node ordering",
//! Tetrahedron10). That of VTK has the last two nodes the other way round.
//!
//! ```text
//!            η
//!            2
//!          / | \
//!        6   8   5
//!      /     |     \
//!     0 ---- 4 ---- 1  ξ       8 lies between 2 and 3, 9 between 1 and 3:
//!      \     |     /           3 is the corner in front of the others.
//!        7   |   9
//!          \ | /
//!            3
//!            ζ
//! ```

pub struct T10;

/// Parametric coordinates of the nodes.
pub const NODES: [[f64; 3]; 10] = [
    [0., 0., 0.],
    [1., 0., 0.],
    [0., 1., 0.],
    [0., 0., 1.],
    [0.5, 0., 0.],
    [0.5, 0.5, 0.],
    [0., 0.5, 0.],
    [0., 0., 0.5],
    [0., 0.5, 0.5],
    [0.5, 0., 0.5],
];

/// The nodes of the faces as those of a [`super::t6::T6`], counter-clockwise from outside.
pub const FACES: [&[usize]; 4] = [&[0, 2, 1, 6, 5, 4], &[0, 1, 3, 4, 9, 7], &[0, 3, 2, 7, 8, 6], &[1, 2, 3, 5, 8, 9]];

/// The corners that each of the other nodes lies between.
pub const EDGES: [[usize; 2]; 6] = [[0, 1], [1, 2], [2, 0], [0, 3], [2, 3], [1, 3]];

/// Derivatives of the barycentric coordinates.
const SLOPE: [[f64; 3]; 4] = [[-1., -1., -1.], [1., 0., 0.], [0., 1., 0.], [0., 0., 1.]];

fn barycentric(xi: &[f64; 3]) -> [f64; 4] {
    [1.0 - xi[0] - xi[1] - xi[2], xi[0], xi[1], xi[2]]
}

impl super::Shape for T10 {
    const NODES: usize = 10;
    const DIMENSION: usize = 3;

    fn values(xi: &[f64; 3], n: &mut [f64]) {
        let l = barycentric(xi);
        for (n, l) in n[..4].iter_mut().zip(l) {
            *n = l * (2.0 * l - 1.0);
        }
        for (n, [a, b]) in n[4..10].iter_mut().zip(EDGES) {
            *n = 4.0 * l[a] * l[b];
        }
    }

    fn derivatives(xi: &[f64; 3], dn: &mut [[f64; 3]]) {
        let l = barycentric(xi);
        for ((dn, l), slope) in dn[..4].iter_mut().zip(l).zip(SLOPE) {
            *dn = slope.map(|s| (4.0 * l - 1.0) * s);
        }
        for (dn, [a, b]) in dn[4..10].iter_mut().zip(EDGES) {
            *dn = [0, 1, 2].map(|d| 4.0 * (l[a] * SLOPE[b][d] + l[b] * SLOPE[a][d]));
        }
    }
}
