//! The stiffness of the points of a cell, `Σ_p w_p B_pᵀ a_p B_p`, as a product of two dense matrices.
//!
//! The right one holds `w a B` of the gradients that strains are taken with, a row for each component of each point; the left one the
//! gradients that forces act through. Their product runs along rows of the result, so that it fills whole registers, whatever the machine has.

use crate::interpolation::{MAX_FUNCTIONS, reach_beyond_cells};
use crate::kinematics::{Gradient, Kinematics};
use crate::system::Local;
use crate::tensor::Tensor;
use pulp::{Arch, Simd, WithSimd};
use std::cell::RefCell;

/// Points whose rows are multiplied at once: as many as stay in the nearest cache.
const AT_ONCE: usize = 16;
const _: () = assert!(MAX_FUNCTIONS <= u64::BITS as usize);

thread_local! {
    /// Memory that the cells of a thread use again and again.
    static SCRATCH: RefCell<Stiffness> = RefCell::default();
}

/// The stiffness of some points of a cell, collected until [`Stiffness::add_to`] works it out.
#[derive(Default)]
pub struct Stiffness {
    /// Gradients: a block a point, in it a row a direction and one of the hoop, a column a function.
    left: Vec<f64>,
    /// `w a B`: a block a point, in it a row a component of the gradient, a column an equation, padded with zeros.
    right: Vec<f64>,
    /// Functions of the cell.
    functions: usize,
    /// Length of the rows of `right`.
    width: usize,
    points: usize,
    /// The functions that have a gradient at each point, in bits: of `left` and of `right`. A point sees few of those of its cell where these
    /// reach as far as the cells around it.
    seen: [[u64; 2]; AT_ONCE],
}

impl Stiffness {
    /// Runs `work` with the memory of this thread, empty, for a cell with so many functions in `D` dimensions.
    pub fn with<const D: usize, T>(functions: usize, work: impl FnOnce(&mut Self) -> T) -> T {
        SCRATCH.with_borrow_mut(|scratch| {
            scratch.points = 0;
            scratch.functions = functions;
            scratch.width = (functions * D).next_multiple_of(Arch::new().dispatch(Lanes));
            work(scratch)
        })
    }

    /// Takes in a point with its tangent, gradients on the deformed grid that forces act through and strains are taken with, and weight (m³).
    pub fn push<const D: usize, K: Kinematics<D>>(
        &mut self,
        tangent: &K::Tangent,
        [forces, strains]: [&[Gradient<D>]; 2],
        weight: f64,
        local: &mut Local,
    ) {
        if self.points == AT_ONCE {
            self.add_to::<D, K>(local);
        }
        let (width, functions) = (self.width, self.functions);
        let (left, right) = ((D + 1) * functions, rows::<D, K>() * width);
        self.left.resize(left * AT_ONCE, 0.0);
        self.right.resize(right * AT_ONCE, 0.0);
        let left = &mut self.left[left * self.points..][..left];
        let right = &mut self.right[right * self.points..][..right];
        self.seen[self.points] = if reach_beyond_cells(functions) {
            [forces, strains]
                .map(|gradients| (0..).zip(gradients).fold(0, |seen, (b, g)| seen | u64::from(!g.is_zero()) << b))
        } else {
            [u64::MAX; 2]
        };
        let seen = self.seen[self.points];
        for (b, (force, strain)) in forces.iter().zip(strains).enumerate() {
            for d in 0..D {
                left[d * functions + b] = force.g[d];
            }
            left[D * functions + b] = force.hoop;
            if seen[1] >> b & 1 == 0 {
                right.chunks_exact_mut(width).for_each(|row| row[b * D..(b + 1) * D].fill(0.0));
                continue;
            }
            let column = K::column(tangent, strain);
            for (row, column) in right.chunks_exact_mut(width).zip(column.as_ref()) {
                for (entry, a) in row[b * D..(b + 1) * D].iter_mut().zip(column) {
                    *entry = weight * a;
                }
            }
        }
        for row in right.chunks_exact_mut(width) {
            row[functions * D..].fill(0.0);
        }
        self.points += 1;
    }

    /// Adds the stiffness of the points taken in to the first equations of `local`, and forgets them.
    pub fn add_to<const D: usize, K: Kinematics<D>>(&mut self, local: &mut Local) {
        let points = std::mem::take(&mut self.points);
        for component in 0..D {
            Arch::new().dispatch(Product {
                left: &self.left[..(D + 1) * self.functions * points],
                right: &self.right[..rows::<D, K>() * self.width * points],
                seen: &self.seen[..points],
                functions: self.functions,
                width: self.width,
                dimension: D,
                hoop: K::HOOP,
                component,
                matrix: local.matrix,
                size: local.size,
            });
        }
    }
}

/// Adds what the forces of a point change by where the gradients that they act through turn and stretch otherwise than those that strains are taken
/// with: with the stress `P` of the force `V P ∇_x N`, of which the tangent takes `∇_x N` to follow the strain, `V (P (∇L_b − ∇N_b)) ⊗ ∇N_a`.
pub fn add_turning<const D: usize>(
    stress: &Tensor,
    [forces, strains]: [&[Gradient<D>]; 2],
    volume: f64,
    local: &mut Local,
) {
    for (b, (force, strain)) in forces.iter().zip(strains).enumerate() {
        let pull: [f64; D] =
            std::array::from_fn(|i| volume * (0..D).map(|j| stress[(i, j)] * (strain.g[j] - force.g[j])).sum::<f64>());
        for (a, force) in forces.iter().enumerate() {
            for (i, pull) in pull.iter().enumerate() {
                let row = (a * D + i) * local.size + b * D;
                for (entry, g) in local.matrix[row..row + D].iter_mut().zip(&force.g) {
                    *entry += pull * g;
                }
            }
        }
    }
}

/// Components of a gradient.
fn rows<const D: usize, K: Kinematics<D>>() -> usize {
    D * D + usize::from(K::HOOP)
}

/// How many numbers a register holds.
struct Lanes;

impl WithSimd for Lanes {
    type Output = usize;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> usize {
        S::F64_LANES
    }
}

/// The rows of one component of the force, `Σ_p Σ_j g_aj (w a B)_ij`.
struct Product<'a> {
    left: &'a [f64],
    right: &'a [f64],
    seen: &'a [[u64; 2]],
    functions: usize,
    width: usize,
    dimension: usize,
    hoop: bool,
    component: usize,
    matrix: &'a mut [f64],
    size: usize,
}

impl WithSimd for Product<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) {
        let vectors = self.width / S::F64_LANES;
        for a in (0..self.functions).step_by(3) {
            for c in (0..vectors).step_by(3) {
                match ((self.functions - a).min(3), (vectors - c).min(3)) {
                    (3, 3) => self.tile::<S, 3, 3>(simd, a, c),
                    (3, 2) => self.tile::<S, 3, 2>(simd, a, c),
                    (3, _) => self.tile::<S, 3, 1>(simd, a, c),
                    (2, 3) => self.tile::<S, 2, 3>(simd, a, c),
                    (2, 2) => self.tile::<S, 2, 2>(simd, a, c),
                    (2, _) => self.tile::<S, 2, 1>(simd, a, c),
                    (_, 3) => self.tile::<S, 1, 3>(simd, a, c),
                    (_, 2) => self.tile::<S, 1, 2>(simd, a, c),
                    _ => self.tile::<S, 1, 1>(simd, a, c),
                }
            }
        }
    }
}

impl Product<'_> {
    /// `R` functions from `a` on, `C` registers of columns from `c` on.
    #[inline(always)]
    fn tile<S: Simd, const R: usize, const C: usize>(&mut self, simd: S, a: usize, c: usize) {
        let (dimension, functions) = (self.dimension, self.functions);
        let vectors = self.width / S::F64_LANES;
        let per_point = (dimension * dimension + usize::from(self.hoop)) * vectors;
        let (right, _) = S::as_simd_f64s(self.right);
        let mut sum = [[simd.splat_f64s(0.0); C]; R];
        let (begin, end) = (c * S::F64_LANES, (c + C) * S::F64_LANES);
        let tile = [bits(a, a + R), bits(begin / dimension, functions.min(end.div_ceil(dimension)))];
        let points = self.left.chunks_exact((dimension + 1) * functions).zip(right.chunks_exact(per_point));
        for ((left, right), seen) in points.zip(self.seen) {
            if seen[0] & tile[0] == 0 || seen[1] & tile[1] == 0 {
                continue;
            }
            for j in 0..dimension {
                let right = &right[(self.component * dimension + j) * vectors..];
                add(simd, &mut sum, &left[j * functions + a..], &right[c..]);
            }
            if self.hoop && self.component == 0 {
                let right = &right[dimension * dimension * vectors..];
                add(simd, &mut sum, &left[dimension * functions + a..], &right[c..]);
            }
        }
        for (k, sum) in sum.iter().enumerate() {
            let row = ((a + k) * dimension + self.component) * self.size;
            let row = &mut self.matrix[row..row + functions * dimension];
            let end = row.len().min(end);
            for (entry, sum) in row[begin..end].iter_mut().zip(pulp::bytemuck::cast_slice::<S::f64s, f64>(sum)) {
                *entry += sum;
            }
        }
    }
}

/// Bits from `begin` to `end`, of at most 64.
fn bits(begin: usize, end: usize) -> u64 {
    (u64::MAX >> (64 - (end - begin))) << begin
}

/// Adds the products of `R` gradients with `C` registers. A closure in its place might be compiled on its own, without
/// the instructions that its caller may use.
#[inline(always)]
fn add<S: Simd, const R: usize, const C: usize>(simd: S, sum: &mut [[S::f64s; C]; R], left: &[f64], right: &[S::f64s]) {
    let (left, right) = (&left[..R], &right[..C]);
    for k in 0..R {
        let g = simd.splat_f64s(left[k]);
        for l in 0..C {
            sum[k][l] = simd.mul_add_e_f64s(g, right[l], sum[k][l]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::Axisymmetric;

    /// Points that see some of many functions, forces others than strains: the sum is that of the blocks of all pairs of functions.
    #[test]
    fn functions_that_points_do_not_see_are_left_out() {
        for functions in [5, 31, MAX_FUNCTIONS] {
            let size = 2 * functions + 3;
            let (mut matrix, mut vector) = (vec![0.0; size * size], vec![0.0; size]);
            let mut expected = matrix.clone();
            let mut local = Local { matrix: &mut matrix, vector: &mut vector, size };
            let tangent = std::array::from_fn(|i| std::array::from_fn(|j| ((3 * i + j) as f64).cos()));
            Stiffness::with::<2, _>(functions, |stiffness| {
                for p in 0..AT_ONCE + 5 {
                    let gradient = |b: usize, shift: usize| match (b + p + shift) % 7 {
                        0 => Gradient { g: [(b + p) as f64, 1.0], hoop: 0.5 },
                        1 => Gradient { g: [0.0; 2], hoop: b as f64 + 1.0 },
                        _ => Gradient { g: [0.0; 2], hoop: 0.0 },
                    };
                    let [forces, strains]: [Vec<Gradient<2>>; 2] =
                        [0, 1].map(|shift| (0..functions).map(|b| gradient(b, shift)).collect());
                    stiffness.push::<2, Axisymmetric>(&tangent, [&forces, &strains], 0.25, &mut local);
                    for (b, strain) in strains.iter().enumerate() {
                        let column = Axisymmetric::column(&tangent, strain);
                        for (a, force) in forces.iter().enumerate() {
                            let block = Axisymmetric::block(&column, force);
                            for i in 0..2 {
                                for k in 0..2 {
                                    expected[(2 * a + i) * size + 2 * b + k] += 0.25 * block[i][k];
                                }
                            }
                        }
                    }
                }
                stiffness.add_to::<2, Axisymmetric>(&mut local);
            });
            let largest = expected.iter().fold(0.0, |most: f64, e| most.max(e.abs()));
            for (found, wanted) in matrix.iter().zip(&expected) {
                assert!((found - wanted).abs() < 1e-12 * largest, "{functions}: {found} against {wanted}");
            }
        }
    }
}
