//! The stiffness of the points of a patch on the functions that smooth its gradients.
//!
//! They come in groups with the gradients `ψ_a e_j`, one function a direction, so that all that a point has for group
//! `a` is a multiple of what it has for `e_j`: `ψ_a` times against the nodes of the cell, `ψ_a ψ_b` times against
//! group `b`. These sums run over whole rows of numbers and are put in their places once a patch.

use crate::kinematics::{Gradient, Kinematics};
use crate::mesh::shape::MAX_NODES;
use crate::stencil::Entries;
use crate::system::Local;
use crate::tensor::Tensor;
use pulp::{Arch, Simd, WithSimd};
use std::cell::RefCell;

thread_local! {
    /// Memory that the patches of a thread use again and again.
    static SCRATCH: RefCell<Smoothed> = RefCell::default();
}

/// The stiffness of some points on the smoothing functions of a patch, collected until [`Smoothed::add_to`].
#[derive(Default)]
pub struct Smoothed {
    /// Nodes of the cell, groups of functions, and whether the stiffness is symmetric.
    own: usize,
    groups: usize,
    symmetric: bool,
    /// For each group, rows of direction and component: a column for each component of each node.
    to_nodes: Vec<f64>,
    /// For each group, rows of node and component: a column for each direction and component. Empty where symmetric.
    from_nodes: Vec<f64>,
    /// For each pair of groups, the second not after the first: rows and columns of direction and component.
    among: Vec<f64>,
    /// The same three of one point, without `ψ`.
    point: [Vec<f64>; 3],
}

impl Smoothed {
    /// Runs `work` with the memory of this thread, empty, for a patch with `own` nodes and so many groups.
    pub fn with<const D: usize, T>(own: usize, groups: usize, symmetric: bool, work: impl FnOnce(&mut Self) -> T) -> T {
        SCRATCH.with_borrow_mut(|scratch| {
            (scratch.own, scratch.groups, scratch.symmetric) = (own, groups, symmetric);
            let row = D * D * own * D;
            let sizes = [row, if symmetric { 0 } else { row }, D * D * D * D];
            let counts = [groups, groups, groups * (groups + 1) / 2];
            let Self { to_nodes, from_nodes, among, point, .. } = scratch;
            for (k, sum) in [to_nodes, from_nodes, among].into_iter().enumerate() {
                sum.clear();
                sum.resize(counts[k] * sizes[k], 0.0);
                point[k].resize(sizes[k], 0.0);
            }
            work(scratch)
        })
    }

    /// Takes in a point with its tangent, the gradients of the nodes on the deformed grid, the inverse of its
    /// deformation since the grid was restored, and its weight (m³).
    pub fn push<const D: usize, K: Kinematics<D>>(
        &mut self,
        tangent: &K::Tangent,
        entries: &Entries<D>,
        spatial: &[Gradient<D>],
        inverse: &Tensor,
        weight: f64,
    ) {
        let (own, groups) = (self.own, self.groups);
        let along: [Gradient<D>; D] = std::array::from_fn(|j| {
            let unit = std::array::from_fn(|d| if d == j { 1.0 } else { 0.0 });
            K::push_forward(&Gradient { g: unit, hoop: 0.0 }, inverse)
        });
        let [to_nodes, from_nodes, among] = &mut self.point;
        let put = |to: &mut [f64], width: usize, row: usize, column: usize, block: [[f64; D]; D]| {
            for (c, block) in block.iter().enumerate() {
                let to = &mut to[(row * D + c) * width + column * D..][..D];
                to.iter_mut().zip(block).for_each(|(to, b)| *to = weight * b);
            }
        };
        for (i, gradient) in spatial.iter().enumerate() {
            let column = K::column(tangent, gradient);
            for (j, along) in along.iter().enumerate() {
                put(to_nodes, own * D, j, i, K::block(&column, along));
            }
        }
        for (k, to) in along.iter().enumerate() {
            let column = K::column(tangent, to);
            for (j, from) in along.iter().enumerate() {
                put(among, D * D, j, k, K::block(&column, from));
            }
            if !self.symmetric {
                for (i, gradient) in spatial.iter().enumerate() {
                    put(from_nodes, D * D, i, k, K::block(&column, gradient));
                }
            }
        }
        let mut psi = [0.0; MAX_NODES];
        for (a, psi) in psi[..groups].iter_mut().enumerate() {
            *psi = entries.gradient(own + a * D).g[0];
        }
        Arch::new().dispatch(Add { psi: &psi[..groups], sums: self });
    }

    /// Adds the stiffness of the points taken in to `local`, whose first equations are those of the nodes.
    pub fn add_to<const D: usize>(&self, local: &mut Local) {
        let (own, size, across) = (self.own * D, local.size, D * D);
        let place = |a: usize, row: usize, width: usize| (a * across + row) * width;
        for a in 0..self.groups {
            for row in 0..across {
                let to = &mut local.matrix[(own + a * across + row) * size..][..own];
                add(to, &self.to_nodes[place(a, row, own)..]);
            }
            for i in 0..own {
                let to = &mut local.matrix[i * size + own + a * across..][..across];
                if self.symmetric {
                    for (row, to) in to.iter_mut().enumerate() {
                        *to += self.to_nodes[place(a, row, own) + i];
                    }
                } else {
                    add(to, &self.from_nodes[place(a, 0, own) + i * across..]);
                }
            }
            for b in 0..self.groups {
                let pair = if a < b { b * (b + 1) / 2 + a } else { a * (a + 1) / 2 + b };
                for row in 0..across {
                    let to = &mut local.matrix[(own + a * across + row) * size + own + b * across..][..across];
                    add(to, &self.among[place(pair, row, across)..]);
                }
            }
        }
    }
}

fn add(to: &mut [f64], from: &[f64]) {
    to.iter_mut().zip(from).for_each(|(to, from)| *to += from);
}

/// Adds what one point has, times its `ψ`, to the sums.
struct Add<'a> {
    psi: &'a [f64],
    sums: &'a mut Smoothed,
}

impl WithSimd for Add<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Smoothed { to_nodes, from_nodes, among, point, .. } = self.sums;
        for (k, sums) in [to_nodes, from_nodes].into_iter().enumerate() {
            if !point[k].is_empty() {
                for (sum, &psi) in sums.chunks_exact_mut(point[k].len()).zip(self.psi) {
                    add_multiple(simd, sum, psi, &point[k]);
                }
            }
        }
        let mut sums = among.chunks_exact_mut(point[2].len());
        for (a, psi_a) in self.psi.iter().enumerate() {
            for (psi_b, sum) in self.psi[..=a].iter().zip(&mut sums) {
                add_multiple(simd, sum, psi_a * psi_b, &point[2]);
            }
        }
    }
}

/// Adds a multiple. A closure in its place might be compiled on its own, without the instructions that its caller may
/// use.
#[inline(always)]
fn add_multiple<S: Simd>(simd: S, to: &mut [f64], factor: f64, from: &[f64]) {
    let ((to, last), (from, last_from)) = (S::as_mut_simd_f64s(to), S::as_simd_f64s(from));
    let factors = simd.splat_f64s(factor);
    for (to, from) in to.iter_mut().zip(from) {
        *to = simd.mul_add_e_f64s(factors, *from, *to);
    }
    for (to, from) in last.iter_mut().zip(last_from) {
        *to += factor * from;
    }
}
