//! Six-node triangle, `ξ, η ≥ 0`, `ξ + η ≤ 1`.
//!
//! ```text
//! 2
//! | \
//! 5   4
//! |     \
//! 0 - 3 - 1
//! ```

pub struct T6;

impl super::Shape for T6 {
    const NODES: usize = 6;
    const DIMENSION: usize = 2;

    fn values(xi: &[f64; 3], n: &mut [f64]) {
        let (a, b, c) = (1.0 - xi[0] - xi[1], xi[0], xi[1]);
        n[..6].copy_from_slice(&[
            a * (2.0 * a - 1.0),
            b * (2.0 * b - 1.0),
            c * (2.0 * c - 1.0),
            4.0 * a * b,
            4.0 * b * c,
            4.0 * c * a,
        ]);
    }

    fn derivatives(xi: &[f64; 3], dn: &mut [[f64; 3]]) {
        let (a, b, c) = (1.0 - xi[0] - xi[1], xi[0], xi[1]);
        dn[..6].copy_from_slice(&[
            [1.0 - 4.0 * a, 1.0 - 4.0 * a, 0.0],
            [4.0 * b - 1.0, 0.0, 0.0],
            [0.0, 4.0 * c - 1.0, 0.0],
            [4.0 * (a - b), -4.0 * b, 0.0],
            [4.0 * c, 4.0 * b, 0.0],
            [-4.0 * c, 4.0 * (a - c), 0.0],
        ]);
    }
}
