//! Plane strain, axisymmetry and three dimensions: how nodal displacements strain a point.
//!
//! A point sees the gradient `g_I = ∇N_I` of each node and, in axisymmetry, the hoop `h_I = N_I / r`. The
//! marker types below carry no data; they only decide whether the hoop terms exist, so that plane strain
//! does not pay for them. Tensors are three-dimensional throughout (see [`crate::tensor`]); a solid is one
//! more marker with `D = 3`.

mod solid;

pub use solid::ThreeD;

use crate::material::spatial::{self, PlaneTangent, Spatial};
use crate::material::{Model, State, spectral};
use crate::tensor::{IDENTITY, Symmetric, Tensor, full, symmetric};
use std::f64::consts::TAU;

/// The gradient of a shape function at a point.
#[derive(Clone, Copy, Debug)]
pub struct Gradient<const D: usize> {
    /// `∇N_I` (1/m).
    pub g: [f64; D],
    /// `N_I / r` (1/m), zero but in axisymmetry.
    pub hoop: f64,
}

impl<const D: usize> Gradient<D> {
    /// Whether the function neither acts on the point nor strains it.
    pub fn is_zero(&self) -> bool {
        self.hoop == 0.0 && self.g.iter().all(|&g| g == 0.0)
    }
}

/// How nodal displacements strain a point in `D` dimensions.
pub trait Kinematics<const D: usize>: Copy + Default + Send + Sync + 'static {
    /// The spatial tangent `a_ijkl = C_ijkl − τ_il δ_jk`.
    type Tangent;
    /// The product of the tangent with the gradient of one node, one column a displacement component; the rows
    /// are the components (i, j) of a gradient, and the hoop where it exists.
    type Column: AsRef<[[f64; D]]>;

    /// Whether the circumferential strain `u_r / r` exists.
    const HOOP: bool;

    /// The response of a point seeded at height `y` (m) to an elastic trial left Cauchy–Green tensor, with the internal variables
    /// at the end of the step in `internal`; `None` where the trial tensor is not positive definite.
    fn respond(
        model: &dyn Model,
        y: f64,
        trial: &Symmetric,
        state: &State,
        internal: &mut [f64],
    ) -> Option<Spatial<Self::Tangent>>;

    /// Principal values of a symmetric tensor.
    fn roots(t: &Symmetric) -> [f64; 3];

    /// Takes an answer from one configuration to another, `Q` from the first to the second: the stress `τ` becomes `Q τ Qᵀ` and
    /// the tangent that of it, where the second is strained by `l` and the first by `Qᵀ ½(l + lᵀ) Q`.
    fn convect(answer: &mut Spatial<Self::Tangent>, q: &Tensor);

    /// The tangent of `A W` from that of `τ`: `A_im (a_mjkl − δ_mk τ_jl) + δ_ik W_jl` (theory, eq. 9).
    fn weight(tangent: &mut Self::Tangent, a: &Tensor, kirchhoff: &Symmetric, w: &Tensor);

    /// Takes the tangent to a geometry that is held: what symmetric strains change of the stress, `½ (b_ijkl + b_ijlk)`, `b_ijkl = a_ijkl + τ_il δ_jk`.
    fn hold(answer: &mut Spatial<Self::Tangent>);

    /// Adds to the tangent that of the stress `π 1` at a fixed `π` (kPa): `−π δ_il δ_jk`.
    fn add_pressure(tangent: &mut Self::Tangent, pressure: f64);

    /// Adds `s l_ij r_kl` to the tangent.
    fn add_product(tangent: &mut Self::Tangent, s: f64, left: &Symmetric, right: &Symmetric);

    /// Adds to the tangent that of a stress `s 1` with `s` (kPa) proportional to the volume: `s δ_ij δ_kl`.
    fn add_volumetric(tangent: &mut Self::Tangent, stress: f64) {
        Self::add_product(tangent, stress, &IDENTITY, &IDENTITY);
    }

    /// Adds `½ s (b_ik b_jl + b_il b_jk)` to the tangent, `b` symmetric.
    fn add_metric(tangent: &mut Self::Tangent, s: f64, b: &Tensor);

    /// `l_ij c_ijkl` with the tangent of an answer for the Oldroyd rate of the stress, `c_ijkl = a_ijkl − δ_ik τ_jl`.
    fn contract(answer: &Spatial<Self::Tangent>, left: &Symmetric) -> Tensor;

    /// What the volume strain changes of the stress, `⅓ C_ijkk`, and the strain of the mean stress, `⅓ C_kkij`.
    fn volumetric(answer: &Spatial<Self::Tangent>) -> [Symmetric; 2];

    /// What [`Kinematics::stretch`] changes of the stress for each unit of `ln J`.
    fn stretched(answer: &Spatial<Self::Tangent>) -> Symmetric {
        Self::volumetric(answer)[0]
    }

    /// `a : (e_k ⊗ ∇N)` for each component `k`.
    fn column(tangent: &Self::Tangent, gradient: &Gradient<D>) -> Self::Column;

    /// The stiffness of a node against the node of `column`: `K_ik = g_j a_ijkl g'_l` with the hoop terms.
    fn block(column: &Self::Column, gradient: &Gradient<D>) -> [[f64; D]; D];

    /// What an area (volume in 3D) element at `x` weighs: 1, or `2πr` for a full turn.
    fn measure(x: &[f64; D]) -> f64 {
        if Self::HOOP { TAU * x[0] } else { 1.0 }
    }

    /// Adds `u ⊗ ∇N` to a deformation gradient.
    fn deform(f: &mut Tensor, u: &[f64; D], gradient: &Gradient<D>) {
        for i in 0..D {
            for j in 0..D {
                f[(i, j)] += u[i] * gradient.g[j];
            }
        }
        if Self::HOOP {
            f[(2, 2)] += u[0] * gradient.hoop;
        }
    }

    /// Multiplies the volume by `ratio` (-): by a stretch in the plane, about an axis and in space in all directions.
    fn stretch(f: &mut Tensor, ratio: f64) {
        if Self::HOOP || D == 3 {
            *f *= ratio.cbrt();
        } else {
            let stretch = ratio.sqrt();
            (0..3).for_each(|i| (0..D).for_each(|j| f[(i, j)] *= stretch));
        }
    }

    /// `∇_x N = ∇_X N · F⁻¹`, given `F⁻¹`.
    fn push_forward(gradient: &Gradient<D>, inverse: &Tensor) -> Gradient<D> {
        let mut g = [0.0; D];
        for j in 0..D {
            for i in 0..D {
                g[j] += gradient.g[i] * inverse[(i, j)];
            }
        }
        Gradient { g, hoop: if Self::HOOP { gradient.hoop * inverse[(2, 2)] } else { 0.0 } }
    }

    /// The internal force on a node for the stress `s`: `s · ∇N`, with the hoop stress on the radius.
    fn force(s: &Tensor, gradient: &Gradient<D>) -> [f64; D] {
        let mut f = [0.0; D];
        for i in 0..D {
            for j in 0..D {
                f[i] += s[(i, j)] * gradient.g[j];
            }
        }
        if Self::HOOP {
            f[0] += s[(2, 2)] * gradient.hoop;
        }
        f
    }
}

/// The components of a symmetric tensor in the order of a [`PlaneTangent`].
const IN_PLANE: [usize; 5] = [0, 3, 3, 1, 2];

/// A plane of points, with or without hoop strain.
#[derive(Clone, Copy, Debug, Default)]
pub struct Plane<const HOOP: bool>;

/// No strain out of the plane.
pub type PlaneStrain = Plane<false>;

/// `x` is the radius, `y` the axis, the third direction the circumference.
pub type Axisymmetric = Plane<true>;

impl<const HOOP: bool> Kinematics<2> for Plane<HOOP> {
    type Tangent = PlaneTangent;
    type Column = [[f64; 2]; 5];
    const HOOP: bool = HOOP;

    fn respond(
        model: &dyn Model,
        y: f64,
        trial: &Symmetric,
        state: &State,
        internal: &mut [f64],
    ) -> Option<Spatial<Self::Tangent>> {
        spatial::plane(model, y, trial, state, internal)
    }

    fn roots(t: &Symmetric) -> [f64; 3] {
        spectral::Plane::of(t).roots()
    }

    fn convect(answer: &mut Spatial<Self::Tangent>, q: &Tensor) {
        // Rows and columns in the order xx, xy, yx, yy, zz.
        let (first, tau) = (answer.tangent, full(&answer.kirchhoff));
        let stress = q * tau * q.transpose();
        for column in 0..5 {
            let (k, l) = (column / 2, column % 2);
            let mut strain = [0.0; 5];
            if column < 4 {
                for m in 0..2 {
                    for n in 0..2 {
                        strain[2 * m + n] = 0.5 * (q[(k, m)] * q[(l, n)] + q[(l, m)] * q[(k, n)]);
                    }
                }
            } else {
                strain[4] = q[(2, 2)] * q[(2, 2)];
            }
            // The change of the stress beyond that of the area which it acts on.
            let rate: [f64; 5] = std::array::from_fn(|row| {
                let along = if row < 4 {
                    let (m, n) = (row / 2, row % 2);
                    strain[2 * m] * tau[(0, n)] + strain[2 * m + 1] * tau[(1, n)]
                } else {
                    strain[4] * tau[(2, 2)]
                };
                (0..5).map(|c| first[row][c] * strain[c]).sum::<f64>() - along
            });
            for i in 0..2 {
                for j in 0..2 {
                    let mut sum = if column < 4 && i == k { stress[(j, l)] } else { 0.0 };
                    for m in 0..2 {
                        for n in 0..2 {
                            sum += q[(i, m)] * rate[2 * m + n] * q[(j, n)];
                        }
                    }
                    answer.tangent[2 * i + j][column] = sum;
                }
            }
            answer.tangent[4][column] = q[(2, 2)] * rate[4] * q[(2, 2)];
        }
        answer.tangent[4][4] += stress[(2, 2)];
        answer.kirchhoff = symmetric(&stress);
    }

    fn weight(tangent: &mut Self::Tangent, a: &Tensor, kirchhoff: &Symmetric, w: &Tensor) {
        let tau = full(kirchhoff);
        let carried = *tangent;
        for i in 0..2 {
            for j in 0..2 {
                for column in 0..5 {
                    let mixed = a[(i, 0)] * carried[j][column] + a[(i, 1)] * carried[2 + j][column];
                    let stress = if column < 4 {
                        let (k, l) = (column / 2, column % 2);
                        -a[(i, k)] * tau[(j, l)] + if i == k { w[(j, l)] } else { 0.0 }
                    } else {
                        0.0
                    };
                    tangent[2 * i + j][column] = mixed + stress;
                }
            }
        }
        for column in 0..5 {
            tangent[4][column] = a[(2, 2)] * carried[4][column];
        }
        tangent[4][4] += w[(2, 2)] - a[(2, 2)] * tau[(2, 2)];
    }

    fn hold(answer: &mut Spatial<Self::Tangent>) {
        let (first, tau) = (answer.tangent, full(&answer.kirchhoff));
        let turned = |row: usize, k: usize, l: usize| {
            let (i, j) = (row / 2, row % 2);
            first[row][2 * k + l] + if row < 4 && j == k { tau[(i, l)] } else { 0.0 }
        };
        for row in 0..5 {
            for column in 0..4 {
                let (k, l) = (column / 2, column % 2);
                answer.tangent[row][column] = 0.5 * (turned(row, k, l) + turned(row, l, k));
            }
        }
        answer.tangent[4][4] += tau[(2, 2)];
    }

    fn add_pressure(tangent: &mut Self::Tangent, pressure: f64) {
        for (ij, kl) in [(0, 0), (1, 2), (2, 1), (3, 3), (4, 4)] {
            tangent[ij][kl] -= pressure;
        }
    }

    fn add_product(tangent: &mut Self::Tangent, s: f64, left: &Symmetric, right: &Symmetric) {
        for (row, l) in tangent.iter_mut().zip(&IN_PLANE) {
            for (entry, r) in row.iter_mut().zip(&IN_PLANE) {
                *entry += s * left[*l] * right[*r];
            }
        }
    }

    fn add_metric(tangent: &mut Self::Tangent, s: f64, b: &Tensor) {
        for row in 0..4 {
            for column in 0..4 {
                let ((i, j), (k, l)) = ((row / 2, row % 2), (column / 2, column % 2));
                tangent[row][column] += 0.5 * s * (b[(i, k)] * b[(j, l)] + b[(i, l)] * b[(j, k)]);
            }
        }
        tangent[4][4] += s * b[(2, 2)] * b[(2, 2)];
    }

    fn contract(answer: &Spatial<Self::Tangent>, left: &Symmetric) -> Tensor {
        let mut sum = [0.0; 6];
        for (row, &component) in answer.tangent.iter().zip(&IN_PLANE) {
            for (entry, &of) in row.iter().zip(&IN_PLANE) {
                // Both of the places of a component out of the diagonal.
                sum[of] += left[component] * entry * if of == 3 { 0.5 } else { 1.0 };
            }
        }
        full(&sum) - full(&symmetric(&(full(left) * full(&answer.kirchhoff))))
    }

    fn volumetric(answer: &Spatial<Self::Tangent>) -> [Symmetric; 2] {
        let a = &answer.tangent;
        let mut sums = [answer.kirchhoff; 2];
        for (k, component) in IN_PLANE.into_iter().enumerate().filter(|&(k, _)| k != 2) {
            sums[0][component] += a[k][0] + a[k][3] + a[k][4];
            sums[1][component] += a[0][k] + a[3][k] + a[4][k];
        }
        sums.map(|sum| sum.map(|s| s / 3.0))
    }

    fn stretched(answer: &Spatial<Self::Tangent>) -> Symmetric {
        if HOOP {
            return Self::volumetric(answer)[0];
        }
        let a = &answer.tangent;
        let mut sum = answer.kirchhoff;
        sum[2] = 0.0;
        for (k, component) in IN_PLANE.into_iter().enumerate().filter(|&(k, _)| k != 2) {
            sum[component] += a[k][0] + a[k][3];
        }
        sum.map(|s| s / 2.0)
    }

    fn column(tangent: &Self::Tangent, gradient: &Gradient<2>) -> Self::Column {
        let (a, g) = (tangent, &gradient.g);
        let hoop = [gradient.hoop, 0.0];
        let mut column = [[0.0; 2]; 5];
        for ij in 0..if HOOP { 5 } else { 4 } {
            for k in 0..2 {
                column[ij][k] = a[ij][2 * k] * g[0] + a[ij][2 * k + 1] * g[1];
                if HOOP {
                    column[ij][k] += a[ij][4] * hoop[k];
                }
            }
        }
        column
    }

    fn block(column: &Self::Column, gradient: &Gradient<2>) -> [[f64; 2]; 2] {
        let g = &gradient.g;
        let mut block: [[f64; 2]; 2] =
            std::array::from_fn(|i| [0, 1].map(|k| g[0] * column[2 * i][k] + g[1] * column[2 * i + 1][k]));
        if HOOP {
            for k in 0..2 {
                block[0][k] += gradient.hoop * column[4][k];
            }
        }
        block
    }
}
