//! LU of a matrix by faer: the last resort.

use super::accuracy::{ACCEPTED, SINGULAR, norm, singular};
use super::whole::out_of_memory;
use super::{Matrix, Pattern};
use crate::error::Result;
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::sparse::linalg::lu;
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par};

/// A symbolic LU, with the full pattern and its values.
pub(super) struct General {
    symbolic: lu::SymbolicLu<u32>,
    numeric: lu::NumericLu<u32, f64>,
    column: Vec<u32>,
    row: Vec<u32>,
    /// Where each entry stands in the stored matrix.
    source: Vec<u32>,
    values: Vec<f64>,
}

impl General {
    /// Analyses `pattern`.
    ///
    /// # Errors
    /// A machine error when memory does not suffice.
    pub fn new(pattern: &Pattern) -> Result<Self> {
        let n = pattern.len();
        let mut entries: Vec<(u32, u32, u32)> = Vec::new();
        for j in 0..n {
            for k in pattern.column[j]..pattern.column[j + 1] {
                let i = pattern.row[k as usize];
                entries.push((j as u32, i, k));
                if pattern.symmetric && i as usize != j {
                    entries.push((i, j as u32, k));
                }
            }
        }
        entries.sort_unstable();
        let mut column = vec![0u32; n + 1];
        for &(j, _, _) in &entries {
            column[j as usize + 1] += 1;
        }
        for j in 0..n {
            column[j + 1] += column[j];
        }
        let row: Vec<u32> = entries.iter().map(|e| e.1).collect();
        let source = entries.iter().map(|e| e.2).collect();
        let symbolic = lu::factorize_symbolic_lu(
            SymbolicSparseColMatRef::new_checked(n, n, &column, None, &row),
            Default::default(),
        )
        .map_err(out_of_memory)?;
        let values = vec![0.0; row.len()];
        Ok(Self { symbolic, numeric: lu::NumericLu::new(), column, row, source, values })
    }
    /// Solves `A x = b`.
    ///
    /// # Errors
    /// An analysis error when the system is singular.
    pub fn solve(&mut self, pattern: &Pattern, matrix: &Matrix, b: &[f64], x: &mut [f64]) -> Result<()> {
        let n = pattern.len();
        for (value, &source) in self.values.iter_mut().zip(&self.source) {
            *value = matrix.values[source as usize];
        }
        let symbolic = SymbolicSparseColMatRef::new_checked(n, n, &self.column, None, &self.row);
        let a = SparseColMatRef::new(symbolic, &self.values);
        let mut scratch = MemBuffer::try_new(StackReq::any_of(&[
            self.symbolic.factorize_numeric_lu_scratch::<f64>(Par::Seq, Default::default()),
            self.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq),
        ]))
        .map_err(out_of_memory)?;
        let stack = MemStack::new(&mut scratch);
        let factor = self
            .symbolic
            .factorize_numeric_lu(&mut self.numeric, a, Par::Seq, stack, Default::default())
            .map_err(|_| singular())?;
        // Loads as large as each diagonal entry move no equation far, unless they meet what nothing holds.
        let mut r = matrix.diagonal(pattern);
        for (i, r) in r.iter_mut().enumerate() {
            *r *= if i % 3 == 1 { -1.0 } else { 1.0 };
        }
        factor.solve_in_place_with_conj(Conj::No, MatMut::from_column_major_slice_mut(&mut r, n, 1), Par::Seq, stack);
        if r.iter().any(|r| r.is_nan() || r.abs() > 1.0 / SINGULAR) {
            return Err(singular());
        }
        r.copy_from_slice(b);
        x.fill(0.0);
        for _ in 0..3 {
            let rhs = MatMut::from_column_major_slice_mut(&mut r, n, 1);
            factor.solve_in_place_with_conj(Conj::No, rhs, Par::Seq, stack);
            for (x, r) in x.iter_mut().zip(&r) {
                *x += r;
            }
            matrix.multiply(pattern, x, &mut r);
            for (r, b) in r.iter_mut().zip(b) {
                *r = b - *r;
            }
            let residual = norm(&r) / norm(b);
            if residual.is_finite() && residual <= ACCEPTED {
                return Ok(());
            }
        }
        Err(singular())
    }
}
