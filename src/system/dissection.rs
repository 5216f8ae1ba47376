//! A factor by halves, for two threads: the equations but those of a separator fall into two halves that have no entry in
//! common, `A₁` and `A₂`, and each half is a principal submatrix with the separator `S` last,
//!
//! ```text
//! Kᵢ = [Aᵢ  Cᵢ]      its factor ends with one of   Sᵢ = S − Cᵢᵀ Aᵢ⁻¹ Cᵢ,
//!      [Cᵢᵀ S ]
//! ```
//!
//! and `S₁ + S₂ − S` is what both leave of the separator. A principal submatrix of a definite matrix is definite, one of a
//! quasi-definite matrix quasi-definite, and so is what is left. Threads only decide who does a half: the bits are the same.

use super::separator::halve;
use super::supernodes::{backward, forward, supernodes};
use super::whole::{equations, factorize, least_pivot, lower, ordering, out_of_memory, scratch};
use super::{Matrix, Pattern};
use crate::error::Result;
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::{ldlt, llt};
use faer::sparse::linalg::{SupernodalThreshold, cholesky};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, Mat, MatMut, Par, Side};

/// The factor of the symmetric part of the matrices of one pattern.
pub struct Dissection {
    halves: [Half; 2],
    /// The equations of the separator.
    separator: Vec<u32>,
    /// The factor of what the halves leave of it.
    between: Mat<f64>,
    scratch: MemBuffer,
    /// Right-hand side and solution of the separator.
    x: Vec<f64>,
}

/// `Kᵢ`, its factor and its part of a solution.
struct Half {
    /// Its equations in the order that they are eliminated in, the separator last.
    equations: Vec<u32>,
    /// How many are not of the separator.
    own: usize,
    /// The lower triangle in that order.
    column: Vec<u32>,
    row: Vec<u32>,
    values: Vec<f64>,
    /// Where each entry and its mirror stand in the matrix.
    source: Vec<(u32, u32)>,
    symbolic: cholesky::SymbolicCholesky<u32>,
    factor: Vec<f64>,
    scratch: MemBuffer,
    /// `Sᵢ`, the lower triangle, and the end of the factor that it comes from.
    left: Mat<f64>,
    end: Mat<f64>,
    x: Vec<f64>,
    /// Memory of the solution.
    memory: Vec<f64>,
}

impl Dissection {
    /// The halves of a pattern, where they pay; `places` as for [`super::Solver::new`].
    ///
    /// # Errors
    /// A machine error when memory does not suffice.
    pub fn new<const D: usize>(pattern: &Pattern, places: &[[f64; D]]) -> Result<Option<Self>> {
        let Some(parts) = halve(pattern, places) else { return Ok(None) };
        let separator = equations(pattern, &parts.separator);
        let [first, second] = &parts.halves;
        let (first, second) =
            rayon::join(|| Half::new(pattern, first, &separator), || Half::new(pattern, second, &separator));
        let size = separator.len();
        let scratch = MemBuffer::try_new(StackReq::any_of(&[
            llt::factor::cholesky_in_place_scratch::<f64>(size, Par::Seq, Default::default()),
            ldlt::factor::cholesky_in_place_scratch::<f64>(size, Par::Seq, Default::default()),
            llt::solve::solve_in_place_scratch::<f64>(size, 1, Par::Seq),
            ldlt::solve::solve_in_place_scratch::<f64>(size, 1, Par::Seq),
        ]))
        .map_err(out_of_memory)?;
        let (between, x) = (Mat::zeros(size, size), vec![0.0; size]);
        Ok(Some(Self { halves: [first?, second?], separator, between, scratch, x }))
    }

    /// As [`super::factor::Factor::factorize`].
    pub fn factorize(&mut self, matrix: &Matrix, llt: bool) -> Option<f64> {
        let [first, second] = &mut self.halves;
        let (one, other) = rayon::join(|| first.factorize(matrix, llt), || second.factorize(matrix, llt));
        let pivot = one?.min(other?);
        let size = self.separator.len();
        for j in 0..size {
            for i in j..size {
                self.between[(i, j)] = first.left[(i, j)] + second.left[(i, j)];
            }
        }
        let mut diagonal = vec![0.0; size];
        first.separator_entries(|i, j, value| {
            self.between[(i, j)] -= value;
            if i == j {
                diagonal[i] = value;
            }
        });
        let (factor, stack) = (self.between.as_mut(), MemStack::new(&mut self.scratch));
        let done = if llt {
            llt::factor::cholesky_in_place(factor, Default::default(), Par::Seq, stack, Default::default()).is_ok()
        } else {
            ldlt::factor::cholesky_in_place(factor, Default::default(), Par::Seq, stack, Default::default()).is_ok()
        };
        let relative = |(i, own): (usize, &f64)| {
            let pivot = self.between[(i, i)];
            (if llt { pivot * pivot } else { pivot.abs() }) / own.abs()
        };
        done.then(|| diagonal.iter().enumerate().map(relative).fold(pivot, f64::min))
    }

    /// As [`super::factor::Factor::solve`].
    pub fn solve(&mut self, x: &mut [f64], llt: bool) {
        let [first, second] = &mut self.halves;
        rayon::join(|| first.forward(x, llt), || second.forward(x, llt));
        for (k, &equation) in self.separator.iter().enumerate() {
            self.x[k] = x[equation as usize] + first.x[first.own + k] + second.x[second.own + k];
        }
        let size = self.x.len();
        let rhs = MatMut::from_column_major_slice_mut(&mut self.x, size, 1);
        let (factor, stack) = (self.between.as_ref(), MemStack::new(&mut self.scratch));
        if llt {
            llt::solve::solve_in_place_with_conj(factor, Conj::No, rhs, Par::Seq, stack);
        } else {
            ldlt::solve::solve_in_place_with_conj(factor, factor.diagonal(), Conj::No, rhs, Par::Seq, stack);
        }
        let between = &self.x;
        rayon::join(|| first.backward(between, llt), || second.backward(between, llt));
        for half in [first, second] {
            for (&equation, value) in half.equations.iter().zip(&half.x) {
                x[equation as usize] = *value;
            }
        }
    }
}

impl Half {
    fn new(pattern: &Pattern, blocks: &[u32], separator: &[u32]) -> Result<Self> {
        let mut equations = equations(pattern, &by_degree(pattern, blocks)?);
        let own = equations.len();
        equations.extend(separator);
        let n = equations.len();
        let mut place = vec![u32::MAX; pattern.len()];
        for (new, &old) in equations.iter().enumerate() {
            place[old as usize] = new as u32;
        }
        let mut entries = Vec::new();
        for &j in &equations {
            let of_half = |(i, source): (u32, _)| {
                let (a, b) = (place[i as usize], place[j as usize]);
                (a != u32::MAX).then_some((a.min(b), a.max(b), source))
            };
            entries.extend(lower(pattern, j as usize).filter_map(of_half));
        }
        let (column, order) = by_column(entries.iter().map(|entry| entry.0), n);
        let row: Vec<u32> = order.iter().map(|&k| entries[k as usize].1).collect();
        let source = order.iter().map(|&k| entries[k as usize].2).collect();
        // faer takes the upper triangle here, where it is to keep the order.
        let (upper, order) = by_column(entries.iter().map(|entry| entry.1), n);
        let upper_row: Vec<u32> = order.iter().map(|&k| entries[k as usize].0).collect();
        let symbolic = cholesky::factorize_symbolic_cholesky(
            SymbolicSparseColMatRef::new_unsorted_checked(n, n, &upper, None, &upper_row),
            Side::Upper,
            cholesky::SymmetricOrdering::Identity,
            cholesky::CholeskySymbolicParams {
                supernodal_flop_ratio_threshold: SupernodalThreshold::FORCE_SUPERNODAL,
                ..Default::default()
            },
        )
        .map_err(out_of_memory)?;
        let size = separator.len();
        Ok(Self {
            values: vec![0.0; row.len()],
            factor: vec![0.0; symbolic.len_val()],
            scratch: scratch(&symbolic, size)?,
            left: Mat::zeros(size, size),
            end: Mat::zeros(size, size),
            x: vec![0.0; n],
            memory: vec![0.0; n],
            equations,
            own,
            column,
            row,
            source,
            symbolic,
        })
    }

    /// Factorises `Kᵢ`: the least pivot of the own equations, and `Sᵢ`.
    fn factorize(&mut self, matrix: &Matrix, llt: bool) -> Option<f64> {
        for (value, &(a, b)) in self.values.iter_mut().zip(&self.source) {
            *value = 0.5 * (matrix.values[a as usize] + matrix.values[b as usize]);
        }
        let n = self.equations.len();
        let pattern = SymbolicSparseColMatRef::new_unsorted_checked(n, n, &self.column, None, &self.row);
        let a = SparseColMatRef::new(pattern, &self.values);
        if !factorize(&self.symbolic, &mut self.factor, a, llt, &mut self.scratch) {
            return None;
        }
        let pivot = least_pivot(&self.symbolic, &self.factor, a, llt, self.own);
        self.end.fill(0.0);
        for node in supernodes(&self.symbolic, &self.factor) {
            for j in node.columns.start.max(self.own)..node.columns.end {
                let column = node.column(j);
                for i in j..node.columns.end {
                    self.end[(i - self.own, j - self.own)] = column[i - node.columns.start];
                }
                for (&i, &value) in node.rows.iter().zip(&column[node.columns.len()..]) {
                    self.end[(i as usize - self.own, j - self.own)] = value;
                }
            }
        }
        let (end, stack) = (self.end.as_ref(), MemStack::new(&mut self.scratch));
        if llt {
            llt::reconstruct::reconstruct(self.left.as_mut(), end, Par::Seq, stack);
        } else {
            ldlt::reconstruct::reconstruct(self.left.as_mut(), end, end.diagonal(), Par::Seq, stack);
        }
        Some(pivot)
    }

    /// Calls `each(i, j, value)` for the entries of the lower triangle of `S`.
    fn separator_entries(&self, mut each: impl FnMut(usize, usize, f64)) {
        for j in self.own..self.equations.len() {
            for k in self.column[j] as usize..self.column[j + 1] as usize {
                each(self.row[k] as usize - self.own, j - self.own, self.values[k]);
            }
        }
    }

    /// Solves for the own equations with the lower triangle; behind them comes what they add to the separator.
    fn forward(&mut self, b: &[f64], llt: bool) {
        let (own, separator) = self.x.split_at_mut(self.own);
        own.iter_mut().zip(&self.equations).for_each(|(x, &equation)| *x = b[equation as usize]);
        separator.fill(0.0);
        forward(supernodes(&self.symbolic, &self.factor), self.own, &mut self.x, &mut self.memory, llt);
    }

    /// Solves for the own equations with the upper triangle, the separator's known.
    fn backward(&mut self, separator: &[f64], llt: bool) {
        self.x[self.own..].copy_from_slice(separator);
        backward(supernodes(&self.symbolic, &self.factor).rev(), self.own, &mut self.x, &mut self.memory, llt);
    }
}

/// Where each of `n` columns begins among entries that are sorted by their columns, and which entries these are.
fn by_column(columns: impl Iterator<Item = u32> + Clone, n: usize) -> (Vec<u32>, Vec<u32>) {
    let mut begin = vec![0; n + 1];
    columns.clone().for_each(|j| begin[j as usize + 1] += 1);
    (0..n).for_each(|j| begin[j + 1] += begin[j]);
    let (mut next, mut order) = (begin.clone(), vec![0; begin[n] as usize]);
    for (k, j) in columns.enumerate() {
        order[next[j as usize] as usize] = k as u32;
        next[j as usize] += 1;
    }
    (begin, order)
}

/// Minimum-degree ordering of some blocks, as if there were no others.
fn by_degree(pattern: &Pattern, blocks: &[u32]) -> Result<Vec<u32>> {
    let mut place = vec![u32::MAX; pattern.start.len() - 1];
    for (k, &block) in blocks.iter().enumerate() {
        place[block as usize] = k as u32;
    }
    let (mut column, mut row) = (vec![0], Vec::new());
    for &block in blocks {
        row.extend(pattern.neighbours(block as usize).iter().map(|&n| place[n as usize]).filter(|&n| n != u32::MAX));
        column.push(row.len() as u32);
    }
    Ok(ordering(&column, &row)?.iter().map(|&k| blocks[k as usize]).collect())
}

#[cfg(test)]
impl Dissection {
    /// Nonzeros of the factor.
    pub fn fill(&self) -> usize {
        let size = self.separator.len();
        self.halves.iter().map(|half| half.symbolic.len_val()).sum::<usize>() + size * (size + 1) / 2
    }
}
