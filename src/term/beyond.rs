//! Forces on functions that reach beyond the nodes of a cell, and their stiffness.
//!
//! The matrix takes what a cell's own nodes have among themselves. The rest is kept as the small matrices over the
//! functions of each patch, and known by its products: expanded to the nodes around it would fill the system.

use super::{Assembly, Frame, scatter_patches};
use crate::error::Result;
use crate::stencil::{Patch, Reach};
use crate::system::{Beyond, Local};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use std::sync::Arc;

/// What one patch has over its functions and unknowns of its own at the end.
#[derive(Clone, Copy)]
struct Sizes {
    cell: u32,
    /// Equations of the nodes of the cell, of all functions, and of those and the other unknowns.
    own: usize,
    functions: usize,
    all: usize,
}

/// The stiffness over the functions of all patches but that among the nodes of a cell.
struct Rest<const D: usize> {
    reach: Arc<Reach>,
    sizes: Vec<Sizes>,
    /// The matrices, row-major, `stride` numbers a patch.
    stiffness: Vec<f64>,
    stride: usize,
    /// The equations of the cliques: `width` a patch.
    equation: Vec<u32>,
    width: usize,
}

/// Adds what `compute` makes of each patch over its functions.
///
/// # Errors
/// The error of the first patch that fails.
pub fn scatter_functions<const D: usize>(
    frame: &Frame<D>,
    compute: impl Fn(&Patch, &mut Local) -> Result<()> + Sync,
    out: &mut Assembly,
) -> Result<()> {
    let Some(reach) = &frame.stencil.reach else { return scatter_patches(frame, compute, out) };
    let patches = &frame.stencil.patches;
    let sizes: Vec<Sizes> = patches
        .iter()
        .map(|patch| {
            let [own, functions] = [patch.node_count, patch.function_count].map(|n| D * n as usize);
            let extra = frame.pattern.clique_size(frame.clique[patch.cell as usize] as usize) - own;
            Sizes { cell: patch.cell, own, functions, all: functions + extra }
        })
        .collect();
    let most = sizes.iter().map(|s| s.all).max().unwrap_or(0).max(1);
    let wanted = out.tangent.is_some();
    let stride = if wanted { most * most } else { 1 };
    let mut force = vec![0.0; most * patches.len()];
    // As large as all else of a step together: taken over from the last tangent.
    let mut stiffness = out.tangent.as_deref_mut().and_then(|tangent| tangent.spare.pop()).unwrap_or_default();
    stiffness.resize(stride * patches.len(), 0.0);
    let slots = force.par_chunks_mut(most).zip(stiffness.par_chunks_mut(stride)).zip(patches.par_iter().zip(&sizes));
    let failed = slots.map(|((vector, matrix), (patch, sizes))| {
        let size = sizes.all;
        let matrix = if wanted { &mut matrix[..size * size] } else { &mut matrix[..0] };
        matrix.fill(0.0);
        compute(patch, &mut Local { matrix, vector: &mut vector[..size], size }).err()
    });
    if let Some(error) = failed.find_first(Option::is_some).flatten() {
        return Err(error);
    }
    // The functions pass their forces on to the nodes of the cells they are averages of.
    let sums =
        reach.sum::<D>(sizes.iter().zip(force.chunks_exact(most)).map(|(s, f)| (s.cell, &f[s.own..s.functions])));
    force.par_chunks_mut(most).zip(&sizes).for_each(|(force, s)| {
        let (own, rest) = force.split_at_mut(s.own);
        reach.pass_on::<D>(s.cell, &sums, &rest[..s.functions - s.own], own);
    });
    let place = |cell: u32| patches.partition_point(|patch| patch.cell < cell);
    let copy = |patch: &Patch, local: &mut Local| {
        let k = place(patch.cell);
        let (s, from) = (sizes[k], &force[k * most..]);
        let beside = s.functions - s.own;
        let index = |i: usize| if i < s.own { i } else { i + beside };
        for i in 0..local.size {
            local.vector[i] = from[index(i)];
        }
        if !local.matrix.is_empty() {
            let from = &stiffness[k * stride..];
            for i in 0..local.size {
                for j in 0..local.size {
                    local.matrix[i * local.size + j] = from[index(i) * s.all + index(j)];
                }
            }
        }
        Ok(())
    };
    scatter_patches(frame, copy, out)?;
    if let Some(tangent) = out.tangent.as_deref_mut() {
        let width = frame.pattern.largest_clique;
        let mut equation = vec![0; width * patches.len()];
        for (patch, to) in patches.iter().zip(equation.chunks_exact_mut(width)) {
            let blocks = frame.pattern.cliques.blocks(frame.clique[patch.cell as usize] as usize);
            let all = blocks.iter().flat_map(|&b| frame.pattern.start[b as usize]..frame.pattern.start[b as usize + 1]);
            to.iter_mut().zip(all).for_each(|(to, e)| *to = e);
        }
        let reach = reach.clone();
        tangent.beyond.push(Box::new(Rest::<D> { reach, sizes, stiffness, stride, equation, width }));
    }
    Ok(())
}

impl<const D: usize> Beyond for Rest<D> {
    fn into_memory(self: Box<Self>) -> Vec<f64> {
        self.stiffness
    }

    fn add_product(&self, x: &[f64], y: &mut [f64]) {
        let most = self.sizes.iter().map(|s| s.all).max().unwrap_or(0).max(1);
        let patches = || self.sizes.par_iter().zip(self.equation.par_chunks_exact(self.width));
        // Own values, the gradients of the cell at its nodes, and other unknowns.
        let mut field = vec![0.0; most * self.sizes.len()];
        field.par_chunks_mut(most).zip(patches()).for_each(|(field, (s, equation))| {
            let extra = s.functions - s.own;
            for i in 0..s.all - extra {
                field[if i < s.own { i } else { i + extra }] = x[equation[i] as usize];
            }
            let (own, rest) = field.split_at_mut(s.own);
            self.reach.own_gradients::<D>(s.cell, own, &mut rest[..extra]);
        });
        let slices = self.sizes.iter().zip(field.chunks_exact(most)).map(|(s, f)| (s.cell, &f[s.own..s.functions]));
        let means = self.reach.means::<D>(slices);
        let mut force = vec![0.0; most * self.sizes.len()];
        force
            .par_chunks_mut(most)
            .zip(field.par_chunks_mut(most))
            .zip(self.stiffness.par_chunks_exact(self.stride))
            .zip(&self.sizes)
            .for_each(|(((force, field), stiffness), s)| {
                self.reach.less_own::<D>(s.cell, &means, &mut field[s.own..s.functions]);
                Arch::new().dispatch(Products { sizes: s, stiffness, field, force });
            });
        let slices = self.sizes.iter().zip(force.chunks_exact(most)).map(|(s, f)| (s.cell, &f[s.own..s.functions]));
        let sums = self.reach.sum::<D>(slices);
        force.par_chunks_mut(most).zip(&self.sizes).for_each(|(force, s)| {
            let (own, rest) = force.split_at_mut(s.own);
            self.reach.pass_on::<D>(s.cell, &sums, &rest[..s.functions - s.own], own);
        });
        for ((force, s), equation) in
            force.chunks_exact(most).zip(&self.sizes).zip(self.equation.chunks_exact(self.width))
        {
            let extra = s.functions - s.own;
            for i in 0..s.all - extra {
                y[equation[i] as usize] += force[if i < s.own { i } else { i + extra }];
            }
        }
    }
}

/// The products of the rows of a patch's matrix with its functions, without those that the matrix of the system has.
struct Products<'a> {
    sizes: &'a Sizes,
    stiffness: &'a [f64],
    field: &'a [f64],
    force: &'a mut [f64],
}

impl WithSimd for Products<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let s = self.sizes;
        let beyond = s.own..s.functions;
        for (i, (row, force)) in self.stiffness.chunks_exact(s.all).zip(self.force).take(s.all).enumerate() {
            let columns = if beyond.contains(&i) { 0..s.all } else { beyond.clone() };
            *force = dot(simd, &row[columns.clone()], &self.field[columns]);
        }
    }
}

/// In two registers side by side.
#[inline(always)]
fn dot<S: Simd>(simd: S, a: &[f64], b: &[f64]) -> f64 {
    let ((a, last_a), (b, last_b)) = (S::as_simd_f64s(a), S::as_simd_f64s(b));
    let (mut even, mut odd) = (simd.splat_f64s(0.0), simd.splat_f64s(0.0));
    let (pairs_a, pairs_b) = (a.chunks_exact(2), b.chunks_exact(2));
    for (a, b) in pairs_a.remainder().iter().zip(pairs_b.remainder()) {
        odd = simd.mul_add_e_f64s(*a, *b, odd);
    }
    for (a, b) in pairs_a.zip(pairs_b) {
        even = simd.mul_add_e_f64s(a[0], b[0], even);
        odd = simd.mul_add_e_f64s(a[1], b[1], odd);
    }
    let last: f64 = last_a.iter().zip(last_b).map(|(a, b)| a * b).sum();
    simd.reduce_sum_f64s(simd.add_f64s(even, odd)) + last
}
