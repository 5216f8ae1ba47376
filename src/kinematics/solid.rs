//! Three dimensions: the whole deformation gradient, and no hoop strain.

use super::{Gradient, Kinematics};
use crate::material::spatial::{self, SolidTangent, Spatial};
use crate::material::{Model, State, spectral};
use crate::tensor::{Symmetric, Tensor, full, symmetric};

/// Points in space; the third axis is the vertical one.
#[derive(Clone, Copy, Debug, Default)]
pub struct ThreeD;

/// The places (i, j) of the components of a [`Symmetric`].
const PLACES: [[usize; 2]; 6] = [[0, 0], [1, 1], [2, 2], [0, 1], [1, 2], [0, 2]];

/// All pairs of directions, in the order of the rows of a [`SolidTangent`].
fn pairs() -> impl Iterator<Item = (usize, usize)> {
    (0..3).flat_map(|i| (0..3).map(move |j| (i, j)))
}

impl Kinematics<3> for ThreeD {
    type Tangent = SolidTangent;
    type Column = [[f64; 3]; 9];
    const HOOP: bool = false;

    fn respond(
        model: &dyn Model,
        y: f64,
        trial: &Symmetric,
        state: &State,
        internal: &mut [f64],
    ) -> Option<Spatial<Self::Tangent>> {
        spatial::solid(model, y, trial, state, internal)
    }

    fn roots(t: &Symmetric) -> [f64; 3] {
        spectral::solid(t).0
    }

    fn convect(answer: &mut Spatial<Self::Tangent>, q: &Tensor) {
        let (first, tau) = (answer.tangent, full(&answer.kirchhoff));
        let stress = q * tau * q.transpose();
        for (column, (k, l)) in pairs().enumerate() {
            let strain = Tensor::from_fn(|m, n| 0.5 * (q[(k, m)] * q[(l, n)] + q[(l, m)] * q[(k, n)]));
            // `a : d = δτ − τ d`, so that `rate` is the Oldroyd rate of the Kirchhoff stress, `δτ − d τ − τ d`.
            let change = |m: usize, n: usize| pairs().zip(first[3 * m + n]).map(|((r, s), a)| a * strain[(r, s)]).sum();
            let rate = Tensor::from_fn(change) - strain * tau;
            let turned = q * rate * q.transpose();
            for (row, (i, j)) in pairs().enumerate() {
                answer.tangent[row][column] = turned[(i, j)] + if i == k { stress[(j, l)] } else { 0.0 };
            }
        }
        answer.kirchhoff = symmetric(&stress);
    }

    fn weight(tangent: &mut Self::Tangent, a: &Tensor, kirchhoff: &Symmetric, w: &Tensor) {
        let (carried, tau) = (*tangent, full(kirchhoff));
        for (row, (i, j)) in pairs().enumerate() {
            for (column, (k, l)) in pairs().enumerate() {
                let mixed: f64 = (0..3).map(|m| a[(i, m)] * carried[3 * m + j][column]).sum();
                tangent[row][column] = mixed - a[(i, k)] * tau[(j, l)] + if i == k { w[(j, l)] } else { 0.0 };
            }
        }
    }

    fn hold(answer: &mut Spatial<Self::Tangent>) {
        let (first, tau) = (answer.tangent, full(&answer.kirchhoff));
        let turned = |(i, j): (usize, usize), k: usize, l: usize| {
            first[3 * i + j][3 * k + l] + if j == k { tau[(i, l)] } else { 0.0 }
        };
        for (row, ij) in pairs().enumerate() {
            for (column, (k, l)) in pairs().enumerate() {
                answer.tangent[row][column] = 0.5 * (turned(ij, k, l) + turned(ij, l, k));
            }
        }
    }

    fn add_pressure(tangent: &mut Self::Tangent, pressure: f64) {
        for (i, j) in pairs() {
            tangent[3 * i + j][3 * j + i] -= pressure;
        }
    }

    fn add_product(tangent: &mut Self::Tangent, s: f64, left: &Symmetric, right: &Symmetric) {
        let (left, right) = (full(left), full(right));
        for (row, (i, j)) in tangent.iter_mut().zip(pairs()) {
            for (entry, (k, l)) in row.iter_mut().zip(pairs()) {
                *entry += s * left[(i, j)] * right[(k, l)];
            }
        }
    }

    fn add_metric(tangent: &mut Self::Tangent, s: f64, b: &Tensor) {
        for (row, (i, j)) in tangent.iter_mut().zip(pairs()) {
            for (entry, (k, l)) in row.iter_mut().zip(pairs()) {
                *entry += 0.5 * s * (b[(i, k)] * b[(j, l)] + b[(i, l)] * b[(j, k)]);
            }
        }
    }

    fn contract(answer: &Spatial<Self::Tangent>, left: &Symmetric) -> Tensor {
        let left = full(left);
        let mut sum = -left * full(&answer.kirchhoff);
        for (row, (i, j)) in answer.tangent.iter().zip(pairs()) {
            for (entry, (k, l)) in row.iter().zip(pairs()) {
                sum[(k, l)] += left[(i, j)] * entry;
            }
        }
        full(&symmetric(&sum))
    }

    fn volumetric(answer: &Spatial<Self::Tangent>) -> [Symmetric; 2] {
        let a = &answer.tangent;
        let mut sums = [answer.kirchhoff; 2];
        for (component, [i, j]) in PLACES.into_iter().enumerate() {
            for k in 0..3 {
                sums[0][component] += a[3 * i + j][4 * k];
                sums[1][component] += a[4 * k][3 * i + j];
            }
        }
        sums.map(|sum| sum.map(|s| s / 3.0))
    }

    fn column(tangent: &Self::Tangent, gradient: &Gradient<3>) -> Self::Column {
        let g = &gradient.g;
        tangent.map(|row| [0, 1, 2].map(|k| row[3 * k] * g[0] + row[3 * k + 1] * g[1] + row[3 * k + 2] * g[2]))
    }

    fn block(column: &Self::Column, gradient: &Gradient<3>) -> [[f64; 3]; 3] {
        let g = &gradient.g;
        let row = |i: usize, k: usize| (0..3).map(|j| g[j] * column[3 * i + j][k]).sum();
        [0, 1, 2].map(|i| [0, 1, 2].map(|k| row(i, k)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::PlaneStrain;
    use crate::material::{Elasticity, LinearElastic, Profile, VonMises};

    /// Components of a plane gradient (xx, xy, yx, yy, zz) among those of a solid one.
    const IN_PLANE: [usize; 5] = [0, 1, 3, 4, 8];

    fn models() -> [Box<dyn Model>; 2] {
        let elasticity = || Elasticity::new(Profile::constant(1000.0), 0.3).unwrap();
        let yields = VonMises::new(elasticity(), Profile::constant(12.0)).unwrap();
        [Box::new(LinearElastic::new(elasticity())), Box::new(yields)]
    }

    /// A left Cauchy–Green tensor without shear out of the plane, and a deformation in the plane.
    const TRIAL: Symmetric = [1.2, 0.9, 1.05, 0.1, 0.0, 0.0];

    fn in_plane() -> Tensor {
        Tensor::new(0.9, -0.35, 0.0, 0.45, 1.1, 0.0, 0.0, 0.0, 1.0)
    }

    /// Both answers to the same trial, changed in the same way, agree in the components that the plane has.
    fn agree(
        solid: impl Fn(&mut Spatial<SolidTangent>),
        plane: impl Fn(&mut Spatial<<PlaneStrain as Kinematics<2>>::Tangent>),
    ) {
        for model in models() {
            let mut a = ThreeD::respond(model.as_ref(), 0.0, &TRIAL, &State::default(), &mut []).unwrap();
            let mut b = PlaneStrain::respond(model.as_ref(), 0.0, &TRIAL, &State::default(), &mut []).unwrap();
            solid(&mut a);
            plane(&mut b);
            for (row, i) in IN_PLANE.into_iter().enumerate() {
                for (column, j) in IN_PLANE.into_iter().enumerate() {
                    let (found, wanted) = (a.tangent[i][j], b.tangent[row][column]);
                    assert!((found - wanted).abs() < 1e-10, "{row} {column}: {found} {wanted}");
                }
            }
            assert!(a.kirchhoff.iter().zip(b.kirchhoff).all(|(a, b)| (a - b).abs() < 1e-11));
            let [found, wanted] = [ThreeD::volumetric(&a), PlaneStrain::volumetric(&b)].map(|v| v.concat());
            assert!(found.iter().zip(&wanted).all(|(a, b)| (a - b).abs() < 1e-10), "{found:?} {wanted:?}");
            for (g, h) in [([0.3, -0.7], [1.1, 0.4]), ([1.0, 0.0], [0.0, 1.0])] {
                let in_space = [g, h].map(|g| Gradient { g: [g[0], g[1], 0.0], hoop: 0.0 });
                let in_plane = [g, h].map(|g| Gradient { g, hoop: 0.0 });
                let found = ThreeD::block(&ThreeD::column(&a.tangent, &in_space[0]), &in_space[1]);
                let wanted = PlaneStrain::block(&PlaneStrain::column(&b.tangent, &in_plane[0]), &in_plane[1]);
                for (i, k) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                    assert!((found[i][k] - wanted[i][k]).abs() < 1e-10);
                }
            }
        }
    }

    #[test]
    fn plane_strain_is_a_special_case() {
        let (q, w) = (in_plane(), Tensor::new(3.0, -2.0, 0.0, 1.0, 4.0, 0.0, 0.0, 0.0, 5.0));
        let weight = symmetric(&w);
        agree(|_| {}, |_| {});
        agree(|a| ThreeD::convect(a, &q), |b| PlaneStrain::convect(b, &q));
        agree(ThreeD::hold, PlaneStrain::hold);
        agree(
            |a| ThreeD::weight(&mut a.tangent, &q, &a.kirchhoff, &w),
            |b| PlaneStrain::weight(&mut b.tangent, &q, &b.kirchhoff, &w),
        );
        agree(|a| ThreeD::add_pressure(&mut a.tangent, 7.0), |b| PlaneStrain::add_pressure(&mut b.tangent, 7.0));
        agree(
            |a| ThreeD::add_product(&mut a.tangent, 3.0, &weight, &TRIAL),
            |b| PlaneStrain::add_product(&mut b.tangent, 3.0, &weight, &TRIAL),
        );
        agree(|a| ThreeD::add_volumetric(&mut a.tangent, 3.0), |b| PlaneStrain::add_volumetric(&mut b.tangent, 3.0));
    }

    /// The axes of space have no meaning: an answer in turned axes is the turned answer.
    #[test]
    fn no_axis_is_another_than_the_others() {
        // Each axis becomes the next one.
        let q = Tensor::new(0.0, 0.0, 1.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0);
        let trial: Symmetric = [1.2, 0.9, 1.05, 0.1, -0.15, 0.07];
        let turned = symmetric(&(q * full(&trial) * q.transpose()));
        for model in models() {
            let answer = |b: &Symmetric| ThreeD::respond(model.as_ref(), 0.0, b, &State::default(), &mut []).unwrap();
            let (mut here, there) = (answer(&trial), answer(&turned));
            ThreeD::convect(&mut here, &q);
            for (a, b) in here.tangent.as_flattened().iter().zip(there.tangent.as_flattened()) {
                assert!((a - b).abs() < 1e-9, "{a} {b}");
            }
            assert!(here.kirchhoff.iter().zip(there.kirchhoff).all(|(a, b)| (a - b).abs() < 1e-10));
            let [a, b] = [&here, &there].map(|answer| ThreeD::volumetric(answer).concat());
            assert!(a.iter().zip(&b).all(|(a, b)| (a - b).abs() < 1e-9), "{a:?} {b:?}");
        }
    }
}
