//! Small dense tensors, and the one place that fixes the order of their components.
//!
//! Everything here is three-dimensional; plane strain and axisymmetry are paddings. In plane strain the
//! third axis is the out-of-plane one, in axisymmetry the circumferential one.

use nalgebra::Matrix3;

/// A full second-order tensor, `m[(i, j)]`.
pub type Tensor = Matrix3<f64>;

/// A symmetric second-order tensor in the order xx, yy, zz, xy, yz, xz (that of VTK). Shear entries are
/// tensor components, not engineering strains.
pub type Symmetric = [f64; 6];

/// Names of the components of [`Symmetric`], in order.
pub const SYMMETRIC_NAMES: [&str; 6] = ["xx", "yy", "zz", "xy", "yz", "xz"];

/// The symmetric identity.
pub const IDENTITY: Symmetric = [1.0, 1.0, 1.0, 0.0, 0.0, 0.0];

/// The full tensor of a symmetric one.
pub fn full(s: &Symmetric) -> Tensor {
    Tensor::new(s[0], s[3], s[5], s[3], s[1], s[4], s[5], s[4], s[2])
}

/// The symmetric part of a full tensor.
pub fn symmetric(t: &Tensor) -> Symmetric {
    [
        t[(0, 0)],
        t[(1, 1)],
        t[(2, 2)],
        0.5 * (t[(0, 1)] + t[(1, 0)]),
        0.5 * (t[(1, 2)] + t[(2, 1)]),
        0.5 * (t[(0, 2)] + t[(2, 0)]),
    ]
}

/// Mean of the three normal components.
pub fn mean(s: &Symmetric) -> f64 {
    (s[0] + s[1] + s[2]) / 3.0
}

/// The deviatoric (von Mises) equivalent `q = sqrt(3 J2)` of a symmetric tensor.
pub fn deviatoric(s: &Symmetric) -> f64 {
    let p = mean(s);
    let (x, y, z) = (s[0] - p, s[1] - p, s[2] - p);
    (1.5 * (x * x + y * y + z * z) + 3.0 * (s[3] * s[3] + s[4] * s[4] + s[5] * s[5])).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn full_and_symmetric_are_inverse() {
        let s = [1.0, 2.0, 3.0, 4.0, 5.0, 6.0];
        assert_eq!(symmetric(&full(&s)), s);
    }

    #[test]
    fn equivalents_of_uniaxial_and_shear() {
        assert!((deviatoric(&[2.0, 0.0, 0.0, 0.0, 0.0, 0.0]) - 2.0).abs() < 1e-15);
        assert!((deviatoric(&[0.0, 0.0, 0.0, 1.0, 0.0, 0.0]) - 3f64.sqrt()).abs() < 1e-15);
        assert!((mean(&[1.0, 2.0, 6.0, 9.0, 9.0, 9.0]) - 3.0).abs() < 1e-15);
    }
}
