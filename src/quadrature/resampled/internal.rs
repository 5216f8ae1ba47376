//! The internal variables of a cell, fitted to those of the material points.

use super::fit::{Coefficients, Fit};
use crate::material::{Variable, VariableKind};
use crate::points::Points;

/// The internal variables as linear functions over a cell that stay within what the points have: scalars within their range, tensors, whose components depend on
/// the axes, below their largest norm.
pub struct Internal<'a> {
    fit: &'a Fit,
    variables: &'a [Variable],
    /// Of each number.
    coefficients: Vec<Coefficients<1>>,
    /// Of each variable.
    range: Vec<[f64; 2]>,
}

impl<'a> Internal<'a> {
    pub fn new(points: &Points<2>, fit: &'a Fit, variables: &'a [Variable]) -> Self {
        let coefficients = (0..points.internal_count()).map(|k| fit.coefficients_of(|p| points.internal_of(p)[k]));
        let coefficients = coefficients.collect();
        let mut first = 0;
        let range = |variable: &Variable| {
            let numbers = first..first + variable.components();
            first = numbers.end;
            fit.points.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], &p| {
                let own = &points.internal_of(p as usize)[numbers.clone()];
                let size = match variable.kind {
                    VariableKind::Scalar => own[0],
                    VariableKind::Tensor => norm(own),
                };
                [low.min(size), high.max(size)]
            })
        };
        let range = if points.internal.is_empty() { Vec::new() } else { variables.iter().map(range).collect() };
        Self { fit, variables, coefficients, range }
    }

    /// Adds those at a place (m) to `out`.
    pub fn add_at(&self, x: &[f64; 2], out: &mut Vec<f64>) {
        let begin = out.len();
        out.extend(self.coefficients.iter().map(|c| self.fit.at(c, x)[0]));
        let mut left = &mut out[begin..];
        for (variable, &[low, high]) in self.variables.iter().zip(&self.range) {
            let (own, rest) = left.split_at_mut(variable.components());
            match variable.kind {
                VariableKind::Scalar => own[0] = own[0].clamp(low, high),
                VariableKind::Tensor => {
                    let size = norm(own);
                    if size > high {
                        own.iter_mut().for_each(|value| *value *= high / size);
                    }
                }
            }
            left = rest;
        }
    }
}

fn norm(tensor: &[f64]) -> f64 {
    let (normal, shear) = tensor.split_at(3);
    let square = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
    (square(normal) + 2.0 * square(shear)).sqrt()
}
