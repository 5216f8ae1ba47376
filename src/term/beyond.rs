//! Forces on functions that reach beyond the nodes of a cell, and their stiffness.
//!
//! The matrix takes what a cell's own nodes have among themselves. The rest is kept as the small matrices over the
//! functions of each patch, and known by its products: expanded to the nodes around it would fill the system.

use super::{Assembly, Frame, scatter_patches};
use crate::error::Result;
use crate::kinematics::{Gradient, Kinematics};
use crate::mesh::shape::MAX_NODES;
use crate::stencil::{Entries, Patch, Reach};
use crate::system::{Beyond, Local};
use crate::tensor::Tensor;
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
    let (mut force, mut stiffness) = (vec![0.0; most * patches.len()], vec![0.0; stride * patches.len()]);
    let slots = force.par_chunks_mut(most).zip(stiffness.par_chunks_mut(stride)).zip(patches.par_iter().zip(&sizes));
    let failed = slots.map(|((vector, matrix), (patch, sizes))| {
        let size = sizes.all;
        let matrix = if wanted { &mut matrix[..size * size] } else { &mut matrix[..0] };
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
                for (i, row) in stiffness[..s.all * s.all].chunks_exact(s.all).enumerate() {
                    let beyond = s.own..s.functions;
                    let columns = if beyond.contains(&i) { 0..s.all } else { beyond };
                    force[i] = dot(&row[columns.clone()], &field[columns]);
                }
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

/// Adds the stiffness of one point on the functions beyond the nodes of its cell, whose gradients are `spatial` on the
/// deformed grid; of a symmetric one only the lower triangle. As these functions come in groups with gradients
/// `ψ_a e_j`, the blocks of all groups are multiples of those for `e_j`.
pub fn stiffen<const D: usize, K: Kinematics<D>>(
    local: &mut Local,
    tangent: &K::Tangent,
    entries: &Entries<D>,
    spatial: &[Gradient<D>],
    inverse: &Tensor,
    weight: f64,
    symmetric: bool,
) {
    let (own, size) = (spatial.len(), local.size);
    let groups = (entries.functions() - own) / D;
    let along: [Gradient<D>; D] = std::array::from_fn(|j| {
        let unit = std::array::from_fn(|d| if d == j { 1.0 } else { 0.0 });
        K::push_forward(&Gradient { g: unit, hoop: 0.0 }, inverse)
    });
    let psi = |a: usize| entries.gradient(own + a * D).g[0];
    // Of direction j and component c: against the nodes of the cell, and against the other directions.
    let mut to_nodes = [[[[0.0; D]; MAX_NODES]; D]; D];
    let mut from_nodes = [[[[0.0; D]; D]; D]; MAX_NODES];
    let mut among = [[[[0.0; D]; D]; D]; D];
    for (i, gradient) in spatial.iter().enumerate() {
        let column = K::column(tangent, gradient);
        for (j, along) in along.iter().enumerate() {
            let block = K::block(&column, along);
            (0..D).for_each(|c| to_nodes[j][c][i] = block[c].map(|b| weight * b));
        }
    }
    for (k, to) in along.iter().enumerate() {
        let column = K::column(tangent, to);
        for (j, from) in along.iter().enumerate() {
            let block = K::block(&column, from);
            (0..D).for_each(|c| among[j][c][k] = block[c].map(|b| weight * b));
        }
        if !symmetric {
            for (i, gradient) in spatial.iter().enumerate() {
                let block = K::block(&column, gradient);
                (0..D).for_each(|c| from_nodes[i][c][k] = block[c].map(|b| weight * b));
            }
        }
    }
    let add = |to: &mut [f64], factor: f64, from: &[f64]| {
        to.iter_mut().zip(from).for_each(|(to, from)| *to += factor * from);
    };
    for a in 0..groups {
        let psi_a = psi(a);
        for j in 0..D {
            for c in 0..D {
                let row = &mut local.matrix[((own + a * D + j) * D + c) * size..][..size];
                add(&mut row[..own * D], psi_a, to_nodes[j][c][..own].as_flattened());
                for b in 0..if symmetric { a + 1 } else { groups } {
                    let begin = (own + b * D) * D;
                    add(&mut row[begin..begin + D * D], psi_a * psi(b), among[j][c].as_flattened());
                }
            }
        }
        if !symmetric {
            for i in 0..own {
                for c in 0..D {
                    let row = &mut local.matrix[(i * D + c) * size + (own + a * D) * D..][..D * D];
                    add(row, psi_a, from_nodes[i][c].as_flattened());
                }
            }
        }
    }
}

/// Copies what the functions beyond the `own` nodes have in the lower triangle to the upper one.
pub fn mirror_beyond<const D: usize>(local: &mut Local, own: usize, functions: usize) {
    for a in own * D..functions * D {
        for b in 0..a {
            local.matrix[b * local.size + a] = local.matrix[a * local.size + b];
        }
    }
}

/// In four sums side by side.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (fours, others) = (a.chunks_exact(4), b.chunks_exact(4));
    let last: f64 = fours.remainder().iter().zip(others.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in fours.zip(others) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    sums[0] + sums[1] + (sums[2] + sums[3]) + last
}
