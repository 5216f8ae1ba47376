//! The solver of linear systems.
//!
//! A symmetric system is tried by Cholesky, then by LDLᵀ, one with a pressure field by LDLᵀ only; an unsymmetric one by GMRES
//! on that factor of its symmetric part; LU is the last resort of both. faer can return a
//! solution that is not finite, or one that does not solve, without an error: every solution is checked.

use super::accuracy::{ACCEPTED, SINGULAR, norm, singular};
use super::factor::Factor;
use super::iterative::Gmres;
use super::lu::General;
use super::{Matrix, Pattern};
use crate::error::{Error, Result};
use crate::profile::{Activity, timed};

/// Relative residual that GMRES aims at with the factor of the matrix: it removes the rounding of the factor.
const REFINED: f64 = 1e-12;
/// Relative residual that it aims at with the factor of the symmetric part or of an earlier matrix.
const AIM: f64 = 1e-9;
/// Most products of GMRES; then LU is used or, with matrix-free parts, the step fails.
const PRODUCTS: usize = 160;
/// Most products with the factor of the matrix, or of an earlier one; then another factor is tried.
const FEW_PRODUCTS: usize = 16;

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
    factor: Factor,
    /// Whether the matrices are definite, if they are symmetric.
    definite: bool,
    /// Symbolic LU with its full pattern, made when first needed.
    general: Option<General>,
    gmres: Gmres,
}

impl Solver {
    /// Analyses `pattern`: an ordering of its block graph and the symbolic factorisation. `places` has where the first
    /// blocks are (m), as many as are anywhere; without, large systems are not factorised by halves.
    ///
    /// # Errors
    /// A machine error when memory does not suffice.
    pub fn new<const D: usize>(pattern: &Pattern, places: &[[f64; D]]) -> Result<Self> {
        let factor = timed(Activity::Analysis, || Factor::new(pattern, places))?;
        Ok(Self { factor, definite: true, general: None, gmres: Gmres::default() })
    }

    /// The solver for saddles: quasi-definite matrices, which have an LDLᵀ factor in any order of the equations
    /// (Vanderbei 1995), but no Cholesky factor.
    pub fn saddle(self) -> Self {
        Self { definite: false, ..self }
    }

    /// Solves `A x = b`, `b` given in `x`.
    ///
    /// # Errors
    /// An analysis error when no method gives a finite solution with a small residual: the system is singular.
    pub fn solve(&mut self, pattern: &Pattern, matrix: &Matrix, x: &mut [f64]) -> Result<Method> {
        self.solve_to(pattern, matrix, AIM, x)
    }

    /// As [`Solver::solve`], where the matrix is not symmetric to the relative residual `tolerance` of the equations that are not taken out.
    ///
    /// # Errors
    /// As there.
    pub fn solve_to(&mut self, pattern: &Pattern, matrix: &Matrix, tolerance: f64, x: &mut [f64]) -> Result<Method> {
        if !matrix.is_finite() || x.iter().any(|v| !v.is_finite()) {
            return Err(Error::analysis("linear system", "a coefficient is not finite", "take smaller steps"));
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
                    && timed(Activity::Solution, || self.iterate(pattern, matrix, llt, (REFINED, FEW_PRODUCTS), &b, x))
                {
                    return Ok(method);
                }
            }
        } else if timed(Activity::Factorisation, || self.factorize(matrix, pattern, self.definite))?
            && timed(Activity::Solution, || self.iterate(pattern, matrix, self.definite, (tolerance, PRODUCTS), &b, x))
        {
            return Ok(Method::Iterative);
        }
        timed(Activity::Factorisation, || match &mut self.general {
            Some(general) => general.solve(pattern, matrix, &b, x),
            none => none.insert(General::new(pattern)?).solve(pattern, matrix, &b, x),
        })?;
        Ok(Method::Lu)
    }

    /// As [`Solver::solve_to`]. If the matrix is not symmetric and much the same as the last one, the factor of that is used again.
    ///
    /// # Errors
    /// As there.
    pub fn solve_near(&mut self, pattern: &Pattern, matrix: &Matrix, tolerance: f64, x: &mut [f64]) -> Result<Method> {
        let b = x.to_vec();
        let ends = (tolerance, FEW_PRODUCTS);
        let found = !pattern.symmetric
            && timed(Activity::Solution, || self.iterate(pattern, matrix, self.definite, ends, &b, x));
        if found {
            return Ok(Method::Iterative);
        }
        x.copy_from_slice(&b);
        self.solve_to(pattern, matrix, tolerance, x)
    }

    /// Solves `A x = b` where the matrix has parts beyond its pattern: by GMRES, to the relative residual `tolerance`,
    /// with the factor of the rest (of its symmetric part) for preconditioner.
    ///
    /// # Errors
    /// An analysis error when the iteration does not converge or the rest is singular.
    pub fn solve_matrix_free(
        &mut self,
        pattern: &Pattern,
        matrix: &Matrix,
        tolerance: f64,
        x: &mut [f64],
    ) -> Result<Method> {
        if !matrix.is_finite() || x.iter().any(|v| !v.is_finite()) {
            return Err(Error::analysis("linear system", "a coefficient is not finite", "take smaller steps"));
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
            let residual = timed(Activity::Solution, || {
                // What is taken out is known, and concerns no other equation.
                let (mut known, mut unknown) = (vec![0.0; b.len()], b);
                for ((known, unknown), fixed) in known.iter_mut().zip(&mut unknown).zip(&matrix.fixed) {
                    if *fixed {
                        std::mem::swap(known, unknown);
                    }
                }
                let Self { factor, gmres, .. } = self;
                let ends = (tolerance * size, PRODUCTS);
                let residual = gmres.solve(&multiply, &mut |r| factor.solve(r, llt), &unknown, x, ends);
                if known.iter().any(|&b| b != 0.0) {
                    self.factor.solve(&mut known, llt);
                    x.iter_mut().zip(&known).for_each(|(x, known)| *x += known);
                }
                residual
            });
            if residual <= tolerance * size {
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
        if b.iter().all(|&v| v == 0.0) || self.iterate(pattern, matrix, true, (REFINED, FEW_PRODUCTS), &b, x) {
            return Ok(());
        }
        Err(singular())
    }

    /// Numeric factorisation, LLᵀ or LDLᵀ; false where it breaks down.
    ///
    /// # Errors
    /// When a pivot is nothing but rounding: the system is singular, though it may have a solution.
    fn factorize(&mut self, matrix: &Matrix, pattern: &Pattern, llt: bool) -> Result<bool> {
        match self.factor.factorize(pattern, matrix, llt) {
            Some(least_pivot) if least_pivot < SINGULAR => Err(singular()),
            found => Ok(found.is_some()),
        }
    }

    /// Solves by GMRES, preconditioned by the factor at hand (LLᵀ if `llt`, or LDLᵀ); false where the residual stays large.
    fn iterate(
        &mut self,
        pattern: &Pattern,
        matrix: &Matrix,
        llt: bool,
        (aim, most): (f64, usize),
        b: &[f64],
        x: &mut [f64],
    ) -> bool {
        let Self { factor, gmres, .. } = self;
        let multiply = |x: &[f64], y: &mut [f64]| matrix.multiply(pattern, x, y);
        let size = if matrix.norm_free(b) > 0.0 { matrix.norm_free(b) } else { norm(b) };
        gmres.solve(&multiply, &mut |r| factor.solve(r, llt), b, x, (aim * size, most)) <= ACCEPTED.max(aim) * size
    }
}
