//! Eight-node (serendipity) quadrilateral on `[-1, 1]²`.
//!
//! ```text
//! 3 - 6 - 2
//! 7       5
//! 0 - 4 - 1
//! ```

pub struct Q8;

const CORNER: [[f64; 2]; 4] = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
const MIDDLE: [[f64; 2]; 4] = [[0.0, -1.0], [1.0, 0.0], [0.0, 1.0], [-1.0, 0.0]];

impl super::Shape for Q8 {
    const NODES: usize = 8;
    const DIMENSION: usize = 2;

    fn values(xi: &[f64; 3], n: &mut [f64]) {
        let (x, y) = (xi[0], xi[1]);
        for (n, c) in n[..4].iter_mut().zip(CORNER) {
            let (a, b) = (c[0] * x, c[1] * y);
            *n = 0.25 * (1.0 + a) * (1.0 + b) * (a + b - 1.0);
        }
        for (n, m) in n[4..8].iter_mut().zip(MIDDLE) {
            *n = if m[0] == 0.0 {
                0.5 * (1.0 - x * x) * (1.0 + m[1] * y)
            } else {
                0.5 * (1.0 + m[0] * x) * (1.0 - y * y)
            };
        }
    }

    fn derivatives(xi: &[f64; 3], dn: &mut [[f64; 3]]) {
        let (x, y) = (xi[0], xi[1]);
        for (dn, c) in dn[..4].iter_mut().zip(CORNER) {
            let (a, b) = (c[0] * x, c[1] * y);
            *dn = [0.25 * c[0] * (1.0 + b) * (2.0 * a + b), 0.25 * c[1] * (1.0 + a) * (2.0 * b + a), 0.0];
        }
        for (dn, m) in dn[4..8].iter_mut().zip(MIDDLE) {
            *dn = if m[0] == 0.0 {
                [-x * (1.0 + m[1] * y), 0.5 * m[1] * (1.0 - x * x), 0.0]
            } else {
                [0.5 * m[0] * (1.0 - y * y), -y * (1.0 + m[0] * x), 0.0]
            };
        }
    }
}
