//! Forces on functions that reach beyond the nodes of a cell, and their stiffness.
//!
//! The matrix takes what a cell's own nodes have among themselves. The rest is kept cell by cell, as small
//! matrices over its functions or by its points, and known by its products: expanded to the nodes around it would fill
//! the system.

use super::smoothed::{self, Layout};
use super::{Assembly, Frame, scatter_cells};
use crate::error::Result;
use crate::interpolation::{CellPoints, Extension};
use crate::system::{Local, MatrixFree};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use std::cell::RefCell;
use std::sync::{Arc, Mutex, PoisonError};

/// How the stiffness over the functions of a cell is kept.
#[derive(Clone, Copy)]
pub enum Kept {
    /// As a matrix over all functions.
    Matrix,
    /// By its points. The matrix still has what the nodes of the cell have among themselves, and what further unknowns
    /// have.
    Points(fn(&CellPoints) -> Layout),
}

/// What one cell has over its functions and unknowns of its own at the end.
#[derive(Clone, Copy)]
struct Sizes {
    cell: u32,
    /// Equations of the nodes of the cell, of all functions, and of those and the other unknowns.
    own: usize,
    functions: usize,
    all: usize,
    /// What its points keep, if they keep the stiffness.
    layout: Option<Layout>,
    points: usize,
}

impl Sizes {
    /// Functions that are not of nodes, and unknowns that are not of functions.
    fn beside(&self) -> usize {
        self.functions - self.own
    }

    fn extra(&self) -> usize {
        self.all - self.functions
    }

    /// Equations of the cell.
    fn coupling(&self) -> usize {
        self.all - self.beside()
    }

    /// Where an equation of the cell stands among all.
    fn index(&self, i: usize) -> usize {
        if i < self.own { i } else { i + self.beside() }
    }

    /// Numbers kept: a matrix over all, or over the equations of the cell, then the rows and columns of the
    /// other unknowns, then what the points keep.
    fn kept(&self) -> usize {
        match &self.layout {
            None => self.all * self.all,
            Some(layout) => self.before_points() + layout.kept(self.points),
        }
    }

    fn before_points(&self) -> usize {
        self.coupling() * self.coupling() + 2 * self.beside() * self.extra()
    }
}

/// The stiffness over the functions of all cells but that among the nodes of a cell.
struct Rest<const D: usize> {
    extension: Arc<Extension>,
    sizes: Vec<Sizes>,
    /// What is kept of each cell, and where it begins.
    stiffness: Vec<f64>,
    start: Vec<usize>,
    /// The equations of the couplings: `width` a cell.
    equation: Vec<u32>,
    width: usize,
    /// Memory of the products.
    work: Mutex<Work>,
}

#[derive(Default)]
struct Work {
    field: Vec<f64>,
    force: Vec<f64>,
    at_nodes: Vec<f64>,
}

thread_local! {
    /// The matrix of a cell before what is needed of it is kept.
    static SCRATCH: RefCell<Vec<f64>> = RefCell::default();
}

/// Adds what `compute` makes of each cell over its functions. Its last argument is for what the points keep: empty
/// where no tangent is wanted, or no point keeps anything.
///
/// # Errors
/// The error of the first cell that fails.
pub fn scatter_functions<const D: usize>(
    frame: &Frame<D>,
    kept: Kept,
    compute: impl Fn(&CellPoints, &mut Local, &mut [f64]) -> Result<()> + Sync,
    out: &mut Assembly,
) -> Result<()> {
    let Some(extension) = &frame.interpolation.extension else {
        return scatter_cells(frame, |cell_points, local| compute(cell_points, local, &mut []), out);
    };
    let filled = &frame.interpolation.filled;
    let sizes: Vec<Sizes> = filled
        .iter()
        .map(|cell_points| {
            let [own, functions] = [cell_points.node_count, cell_points.function_count].map(|n| D * n as usize);
            let extra = frame.pattern.coupling_size(frame.coupling[cell_points.cell as usize] as usize) - own;
            let layout = match kept {
                Kept::Matrix => None,
                Kept::Points(layout) => Some(layout(cell_points)),
            };
            let points = cell_points.point_count as usize;
            Sizes { cell: cell_points.cell, own, functions, all: functions + extra, layout, points }
        })
        .collect();
    let most = most(&sizes);
    let wanted = out.tangent.is_some();
    let mut start = vec![0];
    if wanted {
        start.extend(sizes.iter().scan(0, |sum, s| {
            *sum += s.kept();
            Some(*sum)
        }));
    } else {
        start.resize(sizes.len() + 1, 0);
    }
    let mut force = vec![0.0; most * filled.len()];
    // As large as all else of a step together: taken over from the last tangent.
    let mut stiffness = out.tangent.as_deref_mut().and_then(|tangent| tangent.spare.pop()).unwrap_or_default();
    stiffness.resize(start[sizes.len()], 0.0);
    let mut slices: Vec<&mut [f64]> = Vec::with_capacity(sizes.len());
    let mut left = &mut stiffness[..];
    for range in start.windows(2) {
        let own;
        (own, left) = std::mem::take(&mut left).split_at_mut(range[1] - range[0]);
        slices.push(own);
    }
    let slots = force.par_chunks_mut(most).zip(slices.par_iter_mut()).zip(filled.par_iter().zip(&sizes));
    let failed = slots.map(|((vector, kept), (cell_points, s))| {
        let (size, vector) = (s.all, &mut vector[..s.all]);
        if s.layout.is_none() || !wanted {
            kept.fill(0.0);
            return compute(cell_points, &mut Local { matrix: kept, vector, size }, &mut []).err();
        }
        let (kept, points) = kept.split_at_mut(s.before_points());
        points.fill(0.0);
        SCRATCH.with_borrow_mut(|matrix| {
            matrix.clear();
            matrix.resize(size * size, 0.0);
            let result = compute(cell_points, &mut Local { matrix, vector, size }, points);
            keep_matrix(s, matrix, kept);
            result.err()
        })
    });
    if let Some(error) = failed.find_first(Option::is_some).flatten() {
        return Err(error);
    }
    // The functions pass their forces on to the nodes of the cells they are averages of.
    let mut sums = Vec::new();
    let functions = sizes.iter().zip(force.chunks_exact(most)).map(|(s, f)| (s.cell, &f[s.own..s.functions]));
    extension.sum::<D>(functions, &mut sums);
    force.par_chunks_mut(most).zip(&sizes).for_each(|(force, s)| {
        let (own, rest) = force.split_at_mut(s.own);
        extension.pass_on::<D>(s.cell, &sums, &rest[..s.beside()], own);
    });
    let place = |cell: u32| filled.partition_point(|cell_points| cell_points.cell < cell);
    let copy = |cell_points: &CellPoints, local: &mut Local| {
        let k = place(cell_points.cell);
        let (s, from) = (sizes[k], &force[k * most..]);
        for i in 0..local.size {
            local.vector[i] = from[s.index(i)];
        }
        if !local.matrix.is_empty() {
            let from = &stiffness[start[k]..];
            if s.layout.is_some() {
                local.matrix.copy_from_slice(&from[..local.size * local.size]);
                return Ok(());
            }
            for i in 0..local.size {
                for j in 0..local.size {
                    local.matrix[i * local.size + j] = from[s.index(i) * s.all + s.index(j)];
                }
            }
        }
        Ok(())
    };
    scatter_cells(frame, copy, out)?;
    if let Some(tangent) = out.tangent.as_deref_mut() {
        let width = frame.pattern.largest_coupling;
        let mut equation = vec![0; width * filled.len()];
        for (cell_points, to) in filled.iter().zip(equation.chunks_exact_mut(width)) {
            let blocks = frame.pattern.connectivity.blocks(frame.coupling[cell_points.cell as usize] as usize);
            let all = blocks.iter().flat_map(|&b| frame.pattern.start[b as usize]..frame.pattern.start[b as usize + 1]);
            to.iter_mut().zip(all).for_each(|(to, e)| *to = e);
        }
        let (extension, work) = (extension.clone(), Mutex::default());
        tangent.matrix_free.push(Box::new(Rest::<D> { extension, sizes, stiffness, start, equation, width, work }));
    }
    Ok(())
}

/// The most equations of a cell, at least one.
fn most(sizes: &[Sizes]) -> usize {
    sizes.iter().map(|s| s.all).max().unwrap_or(0).max(1)
}

/// Keeps of the matrix of a cell what its points do not: that over the equations of the cell, and for each other
/// unknown its row and its column over the functions beside them.
fn keep_matrix(s: &Sizes, matrix: &[f64], kept: &mut [f64]) {
    let coupling = s.coupling();
    let (square, cross) = kept.split_at_mut(coupling * coupling);
    for (i, row) in square.chunks_exact_mut(coupling).enumerate() {
        let from = &matrix[s.index(i) * s.all..][..s.all];
        let (own, extra) = row.split_at_mut(s.own);
        own.copy_from_slice(&from[..s.own]);
        extra.copy_from_slice(&from[s.functions..]);
    }
    for (e, cross) in (s.functions..s.all).zip(cross.chunks_exact_mut(2 * s.beside().max(1))) {
        let (row, column) = cross.split_at_mut(s.beside());
        row.copy_from_slice(&matrix[e * s.all + s.own..][..s.beside()]);
        for (i, to) in (s.own..s.functions).zip(column) {
            *to = matrix[i * s.all + e];
        }
    }
}

impl<const D: usize> Rest<D> {
    /// The products of a cell with the values `field`, without those that the matrix of the system has.
    fn product(&self, k: usize, field: &[f64], force: &mut [f64]) {
        let (s, kept) = (&self.sizes[k], &self.stiffness[self.start[k]..self.start[k + 1]]);
        let Some(layout) = s.layout else {
            Arch::new().dispatch(Products { sizes: s, stiffness: kept, field, force });
            return;
        };
        let (matrix, points) = kept.split_at(s.before_points());
        let (own, rest) = field.split_at(s.own);
        let (beside, extra) = rest.split_at(s.beside());
        let (force, force_rest) = force.split_at_mut(s.own);
        let (force_beside, force_extra) = force_rest.split_at_mut(s.beside());
        let products = smoothed::Products::<D> { layout, points, own, beside, force, force_beside };
        Arch::new().dispatch(products);
        let cross = matrix[s.coupling() * s.coupling()..].chunks_exact(2 * s.beside().max(1));
        for ((cross, value), to) in cross.zip(extra).zip(force_extra) {
            let (row, column) = cross.split_at(s.beside());
            *to = row.iter().zip(beside).map(|(a, x)| a * x).sum();
            force_beside.iter_mut().zip(column).for_each(|(f, a)| *f += a * value);
        }
    }
}

impl<const D: usize> MatrixFree for Rest<D> {
    fn into_memory(self: Box<Self>) -> Vec<f64> {
        self.stiffness
    }

    fn add_product(&self, x: &[f64], y: &mut [f64]) {
        let most = most(&self.sizes);
        let mut work = self.work.lock().unwrap_or_else(PoisonError::into_inner);
        let Work { field, force, at_nodes } = &mut *work;
        field.resize(most * self.sizes.len(), 0.0);
        force.resize(most * self.sizes.len(), 0.0);
        let filled = || self.sizes.par_iter().zip(self.equation.par_chunks_exact(self.width));
        // Own values, the gradients of the cell at its nodes, and other unknowns.
        field.par_chunks_mut(most).zip(filled()).for_each(|(field, (s, equation))| {
            for i in 0..s.coupling() {
                field[s.index(i)] = x[equation[i] as usize];
            }
            let (own, rest) = field.split_at_mut(s.own);
            let gradients = &mut rest[..s.beside()];
            gradients.fill(0.0);
            self.extension.own_gradients::<D>(s.cell, own, gradients);
        });
        let slices = self.sizes.iter().zip(field.chunks_exact(most)).map(|(s, f)| (s.cell, &f[s.own..s.functions]));
        self.extension.means::<D>(slices, at_nodes);
        let means = &at_nodes[..];
        force.par_chunks_mut(most).zip(field.par_chunks_mut(most)).enumerate().for_each(|(k, (force, field))| {
            let s = &self.sizes[k];
            self.extension.less_own::<D>(s.cell, means, &mut field[s.own..s.functions]);
            self.product(k, field, force);
        });
        let slices = self.sizes.iter().zip(force.chunks_exact(most)).map(|(s, f)| (s.cell, &f[s.own..s.functions]));
        self.extension.sum::<D>(slices, at_nodes);
        let sums = &at_nodes[..];
        force.par_chunks_mut(most).zip(&self.sizes).for_each(|(force, s)| {
            let (own, rest) = force.split_at_mut(s.own);
            self.extension.pass_on::<D>(s.cell, sums, &rest[..s.beside()], own);
        });
        let filled = self.sizes.iter().zip(self.equation.chunks_exact(self.width));
        for (force, (s, equation)) in force.chunks_exact(most).zip(filled) {
            for i in 0..s.coupling() {
                y[equation[i] as usize] += force[s.index(i)];
            }
        }
    }
}

/// The products of the rows of a cell's matrix with its functions, without those that the matrix of the system has.
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
