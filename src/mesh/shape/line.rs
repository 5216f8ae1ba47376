//! Points and lines of two, three (`0 - 2 - 1`) and four nodes (`0 - 2 - 3 - 1`) on `[-1, 1]`: the facets of plane cells.

use super::q16;

pub struct Point1;
pub struct Line2;
pub struct Line3;
pub struct Line4;

impl super::Shape for Point1 {
    const NODES: usize = 1;
    const DIMENSION: usize = 0;

    fn values(_: &[f64; 3], n: &mut [f64]) {
        n[0] = 1.0;
    }

    fn derivatives(_: &[f64; 3], dn: &mut [[f64; 3]]) {
        dn[0] = [0.0; 3];
    }
}

impl super::Shape for Line2 {
    const NODES: usize = 2;
    const DIMENSION: usize = 1;

    fn values(xi: &[f64; 3], n: &mut [f64]) {
        n[..2].copy_from_slice(&[0.5 * (1.0 - xi[0]), 0.5 * (1.0 + xi[0])]);
    }

    fn derivatives(_: &[f64; 3], dn: &mut [[f64; 3]]) {
        dn[..2].copy_from_slice(&[[-0.5, 0.0, 0.0], [0.5, 0.0, 0.0]]);
    }
}

impl super::Shape for Line3 {
    const NODES: usize = 3;
    const DIMENSION: usize = 1;

    fn values(xi: &[f64; 3], n: &mut [f64]) {
        let t = xi[0];
        n[..3].copy_from_slice(&[0.5 * t * (t - 1.0), 0.5 * t * (t + 1.0), 1.0 - t * t]);
    }

    fn derivatives(xi: &[f64; 3], dn: &mut [[f64; 3]]) {
        let t = xi[0];
        dn[..3].copy_from_slice(&[[t - 0.5, 0.0, 0.0], [t + 0.5, 0.0, 0.0], [-2.0 * t, 0.0, 0.0]]);
    }
}

impl super::Shape for Line4 {
    const NODES: usize = 4;
    const DIMENSION: usize = 1;

    fn values(xi: &[f64; 3], n: &mut [f64]) {
        let [a, c, d, b] = q16::line(xi[0]);
        n[..4].copy_from_slice(&[a, b, c, d]);
    }

    fn derivatives(xi: &[f64; 3], dn: &mut [[f64; 3]]) {
        let [a, c, d, b] = q16::line_derivative(xi[0]);
        dn[..4].copy_from_slice(&[a, b, c, d].map(|slope| [slope, 0.0, 0.0]));
    }
}
