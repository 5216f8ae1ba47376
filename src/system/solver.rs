//! The sparse direct solver: the only file that names faer.
//!
//! A symmetric system is tried by Cholesky, then by LDLᵀ, one with a pressure field by LDLᵀ only; an unsymmetric one by BiCGSTAB (van der Vorst
//! 1992) on that factor of its symmetric part; LU is the last resort of both. faer can return a
//! solution that is not finite, or one that does not solve, without an error: every solution is checked.

use super::iterative::gmres;
use super::{Matrix, Pattern};
use crate::error::{Error, Result};
use crate::profile::{Activity, timed};
use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::perm::Perm;
use faer::sparse::linalg::{amd, cholesky, lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

/// Relative residual beyond which a solution is refused.
const ACCEPTED: f64 = 1e-8;
/// A pivot this small beside the diagonal entry it began as is rounding. A body free to move leaves at most
/// 1e-14; all the cases of the repository, and ν = 0.499999, more than 1e-6.
const SINGULAR: f64 = 1e-12;
/// Relative residual that refinement and iteration aim at.
const AIM: f64 = 1e-12;
/// Iterations of BiCGSTAB before LU is taken.
const ITERATIONS: usize = 40;

/// How a solution was found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    Cholesky,
    Ldlt,
    Iterative,
    Lu,
}

/// A solver for the matrices of one pattern.
pub struct Solver {
    symbolic: cholesky::SymbolicCholesky<u32>,
    values: Vec<f64>,
    scratch: MemBuffer,
    /// Whether the matrices are definite, if they are symmetric.
    definite: bool,
    /// Lower triangle of the symmetric part of an unsymmetric system.
    symmetric_part: Option<SymmetricPart>,
    /// Symbolic LU with its full pattern, made when first needed.
    general: Option<General>,
    work: Vec<Vec<f64>>,
}

struct SymmetricPart {
    column: Vec<u32>,
    row: Vec<u32>,
    /// Where the entry and its mirror stand in the full matrix.
    source: Vec<(u32, u32)>,
    values: Vec<f64>,
}

struct General {
    symbolic: lu::SymbolicLu<u32>,
    numeric: lu::NumericLu<u32, f64>,
    column: Vec<u32>,
    row: Vec<u32>,
    /// Where each entry stands in the stored matrix.
    source: Vec<u32>,
    values: Vec<f64>,
}

impl Solver {
    /// Analyses `pattern`: a minimum-degree ordering of its block graph and the symbolic factorisation.
    ///
    /// # Errors
    /// A machine error when memory does not suffice.
    pub fn new(pattern: &Pattern) -> Result<Self> {
        timed(Activity::Analysis, || Self::analyse(pattern))
    }

    fn analyse(pattern: &Pattern) -> Result<Self> {
        let lower;
        let symmetric_part = if pattern.symmetric { None } else { Some(SymmetricPart::new(pattern)) };
        let (column, row) = match &symmetric_part {
            None => (&pattern.column, &pattern.row),
            Some(part) => {
                lower = (&part.column, &part.row);
                lower
            }
        };
        let order = ordering(pattern)?;
        let symbolic = cholesky::factorize_symbolic_cholesky(
            SymbolicSparseColMatRef::new_checked(pattern.len(), pattern.len(), column, None, row),
            Side::Lower,
            cholesky::SymmetricOrdering::Custom(order.as_ref()),
            Default::default(),
        )
        .map_err(out_of_memory)?;
        let scratch = MemBuffer::try_new(StackReq::any_of(&[
            symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default()),
            symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Default::default()),
            symbolic.solve_in_place_scratch::<f64>(1, Par::Seq),
        ]))
        .map_err(out_of_memory)?;
        let values = vec![0.0; symbolic.len_val()];
        let definite = true;
        Ok(Self { symbolic, values, scratch, definite, symmetric_part, general: None, work: Vec::new() })
    }

    /// The solver for saddles: quasi-definite matrices, which have an LDLᵀ factor in any order of the equations
    /// (Vanderbei 1995), but no Cholesky factor.
    pub fn saddle(self) -> Self {
        Self { definite: false, ..self }
    }

    /// Nonzeros of the Cholesky factor.
    pub fn fill(&self) -> usize {
        self.symbolic.len_val()
    }

    /// Solves `A x = b`, `b` given in `x`.
    ///
    /// # Errors
    /// An analysis error when no method gives a finite solution with a small residual: the system is singular.
    pub fn solve(&mut self, pattern: &Pattern, matrix: &Matrix, x: &mut [f64]) -> Result<Method> {
        if x.iter().chain(&matrix.values).any(|v| !v.is_finite()) {
            return Err(Error::analysis("linear system", "a coefficient is not finite", "the step is too large"));
        }
        let b = x.to_vec();
        if b.iter().all(|&v| v == 0.0) {
            return Ok(Method::Cholesky);
        }
        if pattern.symmetric {
            for (llt, method) in [(true, Method::Cholesky), (false, Method::Ldlt)] {
                if llt && !self.definite {
                    continue;
                }
                if timed(Activity::Factorisation, || self.factorize(matrix, pattern, llt))?
                    && timed(Activity::Solution, || self.refine(pattern, matrix, &b, x, llt))
                {
                    return Ok(method);
                }
            }
        } else if timed(Activity::Factorisation, || self.factorize(matrix, pattern, self.definite))?
            && timed(Activity::Solution, || self.iterate(pattern, matrix, &b, x))
        {
            return Ok(Method::Iterative);
        }
        timed(Activity::Factorisation, || self.solve_lu(pattern, matrix, &b, x))?;
        Ok(Method::Lu)
    }

    /// Solves `A x = b` where the matrix has parts beyond its pattern: by GMRES, to the relative residual `tolerance`,
    /// with the factor of the rest (of its symmetric part) for preconditioner.
    ///
    /// # Errors
    /// An analysis error when the iteration does not converge or the rest is singular.
    pub fn solve_beyond(
        &mut self,
        pattern: &Pattern,
        matrix: &Matrix,
        tolerance: f64,
        x: &mut [f64],
    ) -> Result<Method> {
        if x.iter().chain(&matrix.values).any(|v| !v.is_finite()) {
            return Err(Error::analysis("linear system", "a coefficient is not finite", "the step is too large"));
        }
        let b = x.to_vec();
        let size = if matrix.norm_free(&b) > 0.0 { matrix.norm_free(&b) } else { norm(&b) };
        if size == 0.0 {
            return Ok(Method::Iterative);
        }
        for llt in [true, false] {
            if (llt && !self.definite) || !timed(Activity::Factorisation, || self.factorize(matrix, pattern, llt))? {
                continue;
            }
            let multiply = |x: &[f64], y: &mut [f64]| matrix.multiply(pattern, x, y);
            let products = timed(Activity::Solution, || {
                self.back_substitute(x, llt);
                gmres(&multiply, &mut |r| self.back_substitute(r, llt), &b, x, tolerance * size)
            });
            if products.is_some() {
                return Ok(Method::Iterative);
            }
            break;
        }
        Err(Error::analysis(
            "linear solver",
            "the iteration for smoothed gradients does not converge",
            "take smaller steps (step.min), or plain gradients (gradient: mpm)",
        ))
    }

    /// Solves with the factor of the last successful Cholesky factorisation of this solver.
    ///
    /// # Errors
    /// An analysis error when the solution does not pass the check.
    pub fn solve_again(&mut self, pattern: &Pattern, matrix: &Matrix, x: &mut [f64]) -> Result<()> {
        if x.iter().all(|&v| v == 0.0) {
            return Ok(());
        }
        let b = x.to_vec();
        // Beside a zero right-hand side no residual is small.
        if b.iter().all(|&v| v == 0.0) || self.refine(pattern, matrix, &b, x, true) {
            return Ok(());
        }
        Err(singular())
    }

    /// Numeric factorisation, LLᵀ or LDLᵀ; false where it breaks down.
    ///
    /// # Errors
    /// When a pivot is nothing but rounding: the system is singular, though it may have a solution.
    fn factorize(&mut self, matrix: &Matrix, pattern: &Pattern, llt: bool) -> Result<bool> {
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
        let stack = MemStack::new(&mut self.scratch);
        let done = if llt {
            self.symbolic
                .factorize_numeric_llt(
                    &mut self.values,
                    a,
                    Side::Lower,
                    Default::default(),
                    Par::Seq,
                    stack,
                    Default::default(),
                )
                .is_ok()
        } else {
            self.symbolic
                .factorize_numeric_ldlt(
                    &mut self.values,
                    a,
                    Side::Lower,
                    Default::default(),
                    Par::Seq,
                    stack,
                    Default::default(),
                )
                .is_ok()
        };
        if !done {
            return Ok(false);
        }
        if least_pivot(&self.symbolic, &self.values, a, llt) < SINGULAR { Err(singular()) } else { Ok(true) }
    }

    /// Applies the factor in place.
    fn back_substitute(&mut self, x: &mut [f64], llt: bool) {
        let stack = MemStack::new(&mut self.scratch);
        let n = x.len();
        let rhs = MatMut::from_column_major_slice_mut(x, n, 1);
        if llt {
            cholesky::LltRef::<'_, u32, f64>::new(&self.symbolic, &self.values).solve_in_place_with_conj(
                Conj::No,
                rhs,
                Par::Seq,
                stack,
            );
        } else {
            cholesky::LdltRef::<'_, u32, f64>::new(&self.symbolic, &self.values).solve_in_place_with_conj(
                Conj::No,
                rhs,
                Par::Seq,
                stack,
            );
        }
    }

    /// Solves with the factor at hand and refines; false where the residual stays large.
    fn refine(&mut self, pattern: &Pattern, matrix: &Matrix, b: &[f64], x: &mut [f64], llt: bool) -> bool {
        x.copy_from_slice(b);
        self.back_substitute(x, llt);
        let size = norm(b);
        let mut r = vec![0.0; b.len()];
        let mut last = f64::INFINITY;
        for _ in 0..4 {
            matrix.multiply(pattern, x, &mut r);
            for (r, b) in r.iter_mut().zip(b) {
                *r = b - *r;
            }
            let now = norm(&r) / size;
            if !now.is_finite() {
                return false;
            }
            if now <= AIM || now > 0.5 * last {
                return now <= ACCEPTED || last <= ACCEPTED;
            }
            last = now;
            self.back_substitute(&mut r, llt);
            for (x, r) in x.iter_mut().zip(&r) {
                *x += r;
            }
        }
        last <= ACCEPTED
    }

    /// BiCGSTAB preconditioned by the factor of the symmetric part.
    fn iterate(&mut self, pattern: &Pattern, matrix: &Matrix, b: &[f64], x: &mut [f64]) -> bool {
        let n = b.len();
        let mut work = std::mem::take(&mut self.work);
        work.resize(7, Vec::new());
        for w in &mut work {
            w.clear();
            w.resize(n, 0.0);
        }
        let converged = self.bicgstab(pattern, matrix, b, x, &mut work);
        self.work = work;
        converged
    }

    fn bicgstab(
        &mut self,
        pattern: &Pattern,
        matrix: &Matrix,
        b: &[f64],
        x: &mut [f64],
        work: &mut [Vec<f64>],
    ) -> bool {
        let [r, shadow, p, v, s, t, y] = work else { return false };
        x.copy_from_slice(b);
        self.back_substitute(x, self.definite);
        matrix.multiply(pattern, x, r);
        for (r, b) in r.iter_mut().zip(b) {
            *r = b - *r;
        }
        shadow.copy_from_slice(r);
        p.copy_from_slice(r);
        let size = norm(b);
        let mut rho = dot(shadow, r);
        for _ in 0..ITERATIONS {
            if norm(r) <= AIM * size {
                return true;
            }
            y.copy_from_slice(p);
            self.back_substitute(y, self.definite);
            matrix.multiply(pattern, y, v);
            let alpha = rho / dot(shadow, v);
            for i in 0..x.len() {
                x[i] += alpha * y[i];
                s[i] = r[i] - alpha * v[i];
            }
            y.copy_from_slice(s);
            self.back_substitute(y, self.definite);
            matrix.multiply(pattern, y, t);
            let omega = dot(t, s) / dot(t, t);
            if !omega.is_finite() {
                r.copy_from_slice(s);
                break;
            }
            for i in 0..x.len() {
                x[i] += omega * y[i];
                r[i] = s[i] - omega * t[i];
            }
            let next = dot(shadow, r);
            let beta = next / rho * alpha / omega;
            rho = next;
            if !beta.is_finite() {
                break;
            }
            for i in 0..x.len() {
                p[i] = r[i] + beta * (p[i] - omega * v[i]);
            }
        }
        // What counts is the true residual, not the recursive one.
        matrix.multiply(pattern, x, t);
        let residual = t.iter().zip(b).map(|(t, b)| (b - t).powi(2)).sum::<f64>().sqrt();
        residual.is_finite() && residual <= ACCEPTED * size
    }

    fn solve_lu(&mut self, pattern: &Pattern, matrix: &Matrix, b: &[f64], x: &mut [f64]) -> Result<()> {
        let general = match &mut self.general {
            Some(general) => general,
            none => none.insert(General::new(pattern)?),
        };
        let n = pattern.len();
        for (value, &source) in general.values.iter_mut().zip(&general.source) {
            *value = matrix.values[source as usize];
        }
        let symbolic = SymbolicSparseColMatRef::new_checked(n, n, &general.column, None, &general.row);
        let a = SparseColMatRef::new(symbolic, &general.values);
        let mut scratch = MemBuffer::try_new(StackReq::any_of(&[
            general.symbolic.factorize_numeric_lu_scratch::<f64>(Par::Seq, Default::default()),
            general.symbolic.solve_in_place_scratch::<f64>(1, Par::Seq),
        ]))
        .map_err(out_of_memory)?;
        let stack = MemStack::new(&mut scratch);
        let factor = general
            .symbolic
            .factorize_numeric_lu(&mut general.numeric, a, Par::Seq, stack, Default::default())
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

impl SymmetricPart {
    fn new(pattern: &Pattern) -> Self {
        let mut part = Self { column: vec![0], row: Vec::new(), source: Vec::new(), values: Vec::new() };
        for j in 0..pattern.len() {
            for k in pattern.column[j]..pattern.column[j + 1] {
                let i = pattern.row[k as usize];
                if i as usize >= j {
                    // The pattern is structurally symmetric with ascending rows: the mirror exists.
                    let column = pattern.column[i as usize] as usize..pattern.column[i as usize + 1] as usize;
                    let place = pattern.row[column.clone()].partition_point(|&row| (row as usize) < j);
                    part.row.push(i);
                    part.source.push((k, (column.start + place) as u32));
                }
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

impl General {
    fn new(pattern: &Pattern) -> Result<Self> {
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
}

/// Minimum-degree ordering of the blocks, written out for their equations.
fn ordering(pattern: &Pattern) -> Result<Perm<u32>> {
    let blocks = pattern.start.len() - 1;
    let (mut forward, mut inverse) = (vec![0u32; blocks], vec![0u32; blocks]);
    let mut scratch = MemBuffer::try_new(amd::order_maybe_unsorted_scratch::<u32>(blocks, pattern.graph_row.len()))
        .map_err(out_of_memory)?;
    let graph = SymbolicSparseColMatRef::new_checked(blocks, blocks, &pattern.graph_column, None, &pattern.graph_row);
    amd::order_maybe_unsorted(&mut forward, &mut inverse, graph, Default::default(), MemStack::new(&mut scratch))
        .map_err(out_of_memory)?;
    let mut equations = Vec::with_capacity(pattern.len());
    for &b in &forward {
        equations.extend(pattern.start[b as usize]..pattern.start[b as usize + 1]);
    }
    let mut back = vec![0u32; equations.len()];
    for (new, &old) in equations.iter().enumerate() {
        back[old as usize] = new as u32;
    }
    Ok(Perm::new_checked(equations.into_boxed_slice(), back.into_boxed_slice(), pattern.len()))
}

fn out_of_memory<E: std::fmt::Debug>(error: E) -> Error {
    Error::machine("linear solver", format!("not enough memory ({error:?})"), "coarsen the mesh")
}

/// The least pivot of a factor, relative to the diagonal entry it began as: about the rounding unit where the
/// equations before it already determine its own.
fn least_pivot(
    symbolic: &cholesky::SymbolicCholesky<u32>,
    values: &[f64],
    a: SparseColMatRef<'_, u32, f64>,
    llt: bool,
) -> f64 {
    let n = symbolic.nrows();
    let mut pivot = vec![0.0; n];
    match symbolic.raw() {
        cholesky::SymbolicCholeskyRaw::Simplicial(s) => {
            for (pivot, &first) in pivot.iter_mut().zip(s.col_ptr()) {
                *pivot = values[first as usize];
            }
        }
        cholesky::SymbolicCholeskyRaw::Supernodal(s) => {
            for k in 0..s.n_supernodes() {
                let (begin, end) = (s.supernode_begin()[k] as usize, s.supernode_end()[k] as usize);
                let first = s.col_ptr_for_val()[k] as usize;
                let rows = end - begin + s.supernode(k).pattern().len();
                for i in begin..end {
                    pivot[i] = values[first + (i - begin) * (rows + 1)];
                }
            }
        }
    }
    let order = symbolic.perm().map(|p| p.arrays().0);
    let mut least = f64::INFINITY;
    for (i, &pivot) in pivot.iter().enumerate() {
        let j = order.map_or(i, |order| order[i] as usize);
        let column = a.col_range(j);
        let own = column.clone().find(|&k| a.row_idx()[k] as usize == j).map_or(0.0, |k| a.val()[k]);
        let pivot = if llt { pivot * pivot } else { pivot.abs() };
        least = least.min(pivot / own.abs());
    }
    least
}

fn singular() -> Error {
    Error::analysis(
        "linear solver",
        "the system is singular",
        "check that every body is held by supports; in quasi-static analysis a body must not move freely",
    )
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn norm(a: &[f64]) -> f64 {
    dot(a, a).sqrt()
}
