//! Four-node quadrilateral on `[-1, 1]²`.
//!
//! ```text
//! 3 - 2
//! |   |
//! 0 - 1
//! ```

pub struct Q4;

const CORNER: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];

impl super::Shape for Q4 {
    const NODES: usize = 4;
    const DIMENSION: usize = 2;

    fn values(xi: &[f64; 3], n: &mut [f64]) {
        for (n, c) in n.iter_mut().zip(CORNER) {
            *n = 0.25 * (1.0 + c[0] * xi[0]) * (1.0 + c[1] * xi[1]);
        }
    }

    fn derivatives(xi: &[f64; 3], dn: &mut [[f64; 3]]) {
        for (dn, c) in dn.iter_mut().zip(CORNER) {
            *dn = [0.25 * c[0] * (1.0 + c[1] * xi[1]), 0.25 * c[1] * (1.0 + c[0] * xi[0]), 0.0];
        }
    }
}
