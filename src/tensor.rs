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

/// Terms of the series of [`exponential`]: the rest is rounding.
const TERMS: i32 = 7;
/// The largest norm (-) of what it is summed for.
const SMALL: f64 = 0.02;

/// `exp(t)`: by its series of `t/2ⁿ`, squared `n` times.
pub fn exponential(t: &Tensor) -> Tensor {
    let halvings = (t.norm() / SMALL).log2().ceil().clamp(0.0, 60.0) as i32;
    let part = t * 0.5f64.powi(halvings);
    let series = (1..=TERMS).rev().fold(Tensor::identity(), |sum, n| Tensor::identity() + part * sum / f64::from(n));
    (0..halvings).fold(series, |root, _| root * root)
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
    fn the_exponential_is_that_of_the_principal_values() {
        assert_eq!(exponential(&Tensor::zeros()), Tensor::identity());
        for size in [1e-8, 1e-3, 0.03, 1.0, 20.0] {
            let t = full(&[0.3, -0.8, 0.1, 0.4, -0.2, 0.05]) * size;
            let eigen = t.symmetric_eigen();
            let values = eigen.eigenvalues.map(f64::exp);
            let wanted = eigen.eigenvectors * Tensor::from_diagonal(&values) * eigen.eigenvectors.transpose();
            let found = exponential(&t);
            assert!((found - wanted).norm() < 1e-13 * wanted.norm(), "{size}: {found} {wanted}");
            // Of values that differ by more orders of magnitude, rounding leaves no determinant.
            if size <= 1.0 {
                assert!((found.determinant().ln() - t.trace()).abs() < 1e-12, "{size}");
            }
        }
    }

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
