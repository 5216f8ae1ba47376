//! Three-node triangle, `ξ, η ≥ 0`, `ξ + η ≤ 1`.
//!
//! ```text
//! 2
//! | \
//! 0 - 1
//! ```

pub struct T3;

impl super::Shape for T3 {
    const NODES: usize = 3;
    const DIMENSION: usize = 2;

    fn values(xi: &[f64; 3], n: &mut [f64]) {
        n[..3].copy_from_slice(&[1.0 - xi[0] - xi[1], xi[0], xi[1]]);
    }

    fn derivatives(_: &[f64; 3], dn: &mut [[f64; 3]]) {
        dn[..3].copy_from_slice(&[[-1.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]);
    }
}
