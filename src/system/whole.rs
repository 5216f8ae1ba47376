//! LLᵀ and LDLᵀ factors of symmetric matrices by faer, in one piece, and what those by halves share with them.

use super::supernodes::supernodes;
use super::{Matrix, Pattern};
use crate::error::{Error, Result};
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::linalg::cholesky::ldlt;
use faer::perm::Perm;
use faer::sparse::linalg::{amd, cholesky};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

/// The factor of a matrix in one piece.
pub struct Whole {
    symbolic: cholesky::SymbolicCholesky<u32>,
    values: Vec<f64>,
    scratch: MemBuffer,
    /// Lower triangle of the symmetric part of an unsymmetric system.
    symmetric_part: Option<SymmetricPart>,
}

struct SymmetricPart {
    column: Vec<u32>,
    row: Vec<u32>,
    /// Where the entry and its mirror stand in the full matrix.
    source: Vec<(u32, u32)>,
    values: Vec<f64>,
}

impl Whole {
    /// As [`super::factor::Factor::new`].
    ///
    /// # Errors
    /// As there.
    pub fn new(pattern: &Pattern) -> Result<Self> {
        let symmetric_part = if pattern.symmetric { None } else { Some(SymmetricPart::new(pattern)) };
        let (column, row) = match &symmetric_part {
            None => (&pattern.column, &pattern.row),
            Some(part) => (&part.column, &part.row),
        };
        let blocks = ordering(&pattern.graph_column, &pattern.graph_row)?;
        let equations = equations(pattern, &blocks);
        let mut back = vec![0u32; equations.len()];
        for (new, &old) in equations.iter().enumerate() {
            back[old as usize] = new as u32;
        }
        let order = Perm::new_checked(equations.into_boxed_slice(), back.into_boxed_slice(), pattern.len());
        let symbolic = cholesky::factorize_symbolic_cholesky(
            SymbolicSparseColMatRef::new_checked(pattern.len(), pattern.len(), column, None, row),
            Side::Lower,
            cholesky::SymmetricOrdering::Custom(order.as_ref()),
            Default::default(),
        )
        .map_err(out_of_memory)?;
        let scratch = scratch(&symbolic, 0)?;
        let values = vec![0.0; symbolic.len_val()];
        Ok(Self { symbolic, values, scratch, symmetric_part })
    }

    /// As [`super::factor::Factor::factorize`].
    pub fn factorize(&mut self, pattern: &Pattern, matrix: &Matrix, llt: bool) -> Option<f64> {
        let n = pattern.len();
        let a = match &mut self.symmetric_part {
            None => {
                let symbolic = SymbolicSparseColMatRef::new_checked(n, n, &pattern.column, None, &pattern.row);
                SparseColMatRef::new(symbolic, &matrix.values)
            }
            Some(part) => {
                part.fill(matrix);
                let symbolic = SymbolicSparseColMatRef::new_checked(n, n, &part.column, None, &part.row);
                SparseColMatRef::new(symbolic, &part.values)
            }
        };
        factorize(&self.symbolic, &mut self.values, a, llt, &mut self.scratch)
            .then(|| least_pivot(&self.symbolic, &self.values, a, llt, n))
    }

    /// As [`super::factor::Factor::solve`].
    pub fn solve(&mut self, x: &mut [f64], llt: bool) {
        let stack = MemStack::new(&mut self.scratch);
        let n = x.len();
        let rhs = MatMut::from_column_major_slice_mut(x, n, 1);
        if llt {
            let factor = cholesky::LltRef::<'_, u32, f64>::new(&self.symbolic, &self.values);
            factor.solve_in_place_with_conj(Conj::No, rhs, Par::Seq, stack);
        } else {
            let factor = cholesky::LdltRef::<'_, u32, f64>::new(&self.symbolic, &self.values);
            factor.solve_in_place_with_conj(Conj::No, rhs, Par::Seq, stack);
        }
    }
}

impl SymmetricPart {
    fn new(pattern: &Pattern) -> Self {
        let mut part = Self { column: vec![0], row: Vec::new(), source: Vec::new(), values: Vec::new() };
        for j in 0..pattern.len() {
            for (i, source) in lower(pattern, j) {
                part.row.push(i);
                part.source.push(source);
            }
            part.column.push(part.row.len() as u32);
        }
        part.values = vec![0.0; part.row.len()];
        part
    }

    fn fill(&mut self, matrix: &Matrix) {
        for (value, &(a, b)) in self.values.iter_mut().zip(&self.source) {
            *value = 0.5 * (matrix.values[a as usize] + matrix.values[b as usize]);
        }
    }
}

/// The rows of column `j` of the lower triangle, and where the entry and its mirror stand in the matrix.
pub(super) fn lower(pattern: &Pattern, j: usize) -> impl Iterator<Item = (u32, (u32, u32))> {
    let below = move |&k: &u32| pattern.row[k as usize] as usize >= j;
    (pattern.column[j]..pattern.column[j + 1]).filter(below).map(move |k| {
        let i = pattern.row[k as usize];
        if pattern.symmetric {
            return (i, (k, k));
        }
        // The pattern is structurally symmetric with ascending rows: the mirror exists.
        let column = pattern.column[i as usize] as usize..pattern.column[i as usize + 1] as usize;
        let place = pattern.row[column.clone()].partition_point(|&row| (row as usize) < j);
        (i, (k, (column.start + place) as u32))
    })
}

/// Minimum-degree ordering of a graph given by its columns.
pub(super) fn ordering(column: &[u32], row: &[u32]) -> Result<Vec<u32>> {
    let nodes = column.len() - 1;
    let (mut forward, mut inverse) = (vec![0u32; nodes], vec![0u32; nodes]);
    let mut scratch =
        MemBuffer::try_new(amd::order_maybe_unsorted_scratch::<u32>(nodes, row.len())).map_err(out_of_memory)?;
    let graph = SymbolicSparseColMatRef::new_checked(nodes, nodes, column, None, row);
    amd::order_maybe_unsorted(&mut forward, &mut inverse, graph, Default::default(), MemStack::new(&mut scratch))
        .map_err(out_of_memory)?;
    Ok(forward)
}

/// The equations of blocks, in their order.
pub(super) fn equations(pattern: &Pattern, blocks: &[u32]) -> Vec<u32> {
    blocks.iter().flat_map(|&b| pattern.start[b as usize]..pattern.start[b as usize + 1]).collect()
}

/// Memory to factorise and solve in, and to put the end of the factor, of `end` equations, together again.
pub(super) fn scratch(symbolic: &cholesky::SymbolicCholesky<u32>, end: usize) -> Result<MemBuffer> {
    MemBuffer::try_new(StackReq::any_of(&[
        symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()),
        symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Default::default()),
        symbolic.solve_in_place_scratch::<f64>(1, Par::Seq),
        ldlt::reconstruct::reconstruct_scratch::<f64>(end, Par::Seq),
    ]))
    .map_err(out_of_memory)
}

/// Writes the factor of `a`, a lower triangle; false where it breaks down.
pub(super) fn factorize(
    symbolic: &cholesky::SymbolicCholesky<u32>,
    values: &mut [f64],
    a: SparseColMatRef<'_, u32, f64>,
    llt: bool,
    scratch: &mut MemBuffer,
) -> bool {
    let (side, regular, stack) = (Side::Lower, Default::default(), MemStack::new(scratch));
    if llt {
        symbolic.factorize_numeric_llt(values, a, side, regular, Par::Seq, stack, Default::default()).is_ok()
    } else {
        let regular = Default::default();
        symbolic.factorize_numeric_ldlt(values, a, side, regular, Par::Seq, stack, Default::default()).is_ok()
    }
}

pub(super) fn out_of_memory<E: std::fmt::Debug>(error: E) -> Error {
    Error::machine("linear solver", format!("not enough memory ({error:?})"), "coarsen the mesh")
}

/// The least of the first `count` pivots of a factor, relative to the diagonal entry it began as.
pub(super) fn least_pivot(
    symbolic: &cholesky::SymbolicCholesky<u32>,
    values: &[f64],
    a: SparseColMatRef<'_, u32, f64>,
    llt: bool,
    count: usize,
) -> f64 {
    let mut pivot = vec![0.0; symbolic.nrows()];
    if let cholesky::SymbolicCholeskyRaw::Simplicial(s) = symbolic.raw() {
        for (pivot, &first) in pivot.iter_mut().zip(s.col_ptr()) {
            *pivot = values[first as usize];
        }
    }
    for node in supernodes(symbolic, values) {
        for i in node.columns.clone() {
            pivot[i] = node.column(i)[i - node.columns.start];
        }
    }
    let order = symbolic.perm().map(|p| p.arrays().0);
    let mut least = f64::INFINITY;
    for (i, &pivot) in pivot[..count].iter().enumerate() {
        let j = order.map_or(i, |order| order[i] as usize);
        let column = a.col_range(j);
        let own = column.clone().find(|&k| a.row_idx()[k] as usize == j).map_or(0.0, |k| a.val()[k]);
        let pivot = if llt { pivot * pivot } else { pivot.abs() };
        least = least.min(pivot / own.abs());
    }
    least
}

#[cfg(test)]
impl Whole {
    /// Nonzeros of the factor.
    pub fn fill(&self) -> usize {
        self.symbolic.len_val()
    }
}
