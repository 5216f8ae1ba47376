//! Roots and axes of symmetric tensors: in closed form where z is a principal axis (plane strain,
//! axisymmetry), by nalgebra's QR iteration otherwise.

use crate::tensor::{Symmetric, full, symmetric};
use nalgebra::{Matrix3, SymmetricEigen, Vector3};

/// A symmetric tensor with `xz = yz = 0` by its roots. In the plane it is `mean·I + radius·S` with the
/// unit tensor `S = [[c, s], [s, -c]]`, whose angle is twice that of the first axis: no root or direction
/// is ever a small difference, and equal roots need no care beyond some choice of `S`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plane {
    /// Half the sum of the in-plane roots.
    pub mean: f64,
    /// Half their difference, not negative.
    pub radius: f64,
    /// Cosine of twice the angle from x to the axis of the larger root.
    pub c: f64,
    /// Sine of it.
    pub s: f64,
    /// The root along z.
    pub z: f64,
}

impl Plane {
    /// Decomposes `t`, whose components yz and xz are taken as zero.
    #[inline]
    pub fn of(t: &Symmetric) -> Self {
        let mean = 0.5 * (t[0] + t[1]);
        let d = 0.5 * (t[0] - t[1]);
        let radius = (d * d + t[3] * t[3]).sqrt();
        let (c, s) = if radius > 0.0 { (d / radius, t[3] / radius) } else { (1.0, 0.0) };
        Self { mean, radius, c, s, z: t[2] }
    }

    /// The roots: larger and smaller in the plane, then z.
    #[inline]
    pub fn roots(&self) -> [f64; 3] {
        [self.mean + self.radius, self.mean - self.radius, self.z]
    }

    /// The tensor with the same axes and other roots, in the order of [`Plane::roots`].
    #[inline]
    pub fn with_roots(&self, roots: &[f64; 3]) -> Symmetric {
        let (mean, half) = (0.5 * (roots[0] + roots[1]), 0.5 * (roots[0] - roots[1]));
        [mean + half * self.c, mean - half * self.c, roots[2], half * self.s, 0.0, 0.0]
    }
}

/// Roots of a symmetric tensor and the matrix whose columns are its axes.
pub fn solid(t: &Symmetric) -> ([f64; 3], Matrix3<f64>) {
    let e = SymmetricEigen::new(full(t));
    (e.eigenvalues.into(), e.eigenvectors)
}

/// Roots of a symmetric tensor, in the plane those of [`Plane::roots`].
pub fn roots(t: &Symmetric) -> [f64; 3] {
    if in_plane(t) { Plane::of(t).roots() } else { solid(t).0 }
}

/// Whether z is an axis.
fn in_plane(t: &Symmetric) -> bool {
    t[4] == 0.0 && t[5] == 0.0
}

/// The isotropic tensor function `f` of the roots of `t`, in three dimensions.
pub fn map_roots(t: &Symmetric, f: impl FnOnce(&[f64; 3]) -> [f64; 3]) -> Symmetric {
    if in_plane(t) {
        let plane = Plane::of(t);
        plane.with_roots(&f(&plane.roots()))
    } else {
        let (roots, axes) = solid(t);
        compose(&f(&roots), &axes)
    }
}

/// The symmetric tensor with the given roots and axes (columns).
pub fn compose(roots: &[f64; 3], axes: &Matrix3<f64>) -> Symmetric {
    symmetric(&(axes * Matrix3::from_diagonal(&Vector3::from(*roots)) * axes.transpose()))
}

/// `atanh(x)/x` where `atanh(x) = ½ ln(λ_A/λ_B) = strain`, `x = (λ_A − λ_B)/(λ_A + λ_B)`, by its series where x is small.
#[inline]
pub fn half_log_ratio(x: f64, strain: f64) -> f64 {
    if x.abs() > 0.05 {
        return strain / x;
    }
    let q = x * x;
    1.0 + q * (1.0 / 3.0 + q * (1.0 / 5.0 + q * (1.0 / 7.0 + q * (1.0 / 9.0 + q / 11.0))))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(a: &Symmetric, b: &Symmetric, tolerance: f64) {
        for (x, y) in a.iter().zip(b) {
            assert!((x - y).abs() <= tolerance, "{a:?} {b:?}");
        }
    }

    #[test]
    fn roots_and_axes_give_the_tensor_back() {
        for t in [
            [2.0, 0.5, 1.1, 0.3, 0.0, 0.0],
            [1.0, 1.0, 1.0, 0.0, 0.0, 0.0],
            [1.0, 1.0, 3.0, 1e-15, 0.0, 0.0],
            [1.0 + 1e-15, 1.0, 0.2, 0.0, 0.0, 0.0],
        ] {
            close(&map_roots(&t, |r| *r), &t, 4e-16 * 3.0);
        }
        let t = [2.0, 0.5, 1.1, 0.3, -0.2, 0.4];
        close(&map_roots(&t, |r| *r), &t, 2e-15);
    }

    #[test]
    fn the_plane_form_agrees_with_the_solid_one() {
        let t = [2.0, 0.5, 1.1, -0.3, 0.0, 0.0];
        let (roots, axes) = solid(&t);
        close(&map_roots(&t, |r| r.map(f64::ln)), &compose(&roots.map(f64::ln), &axes), 1e-14);
    }
}
