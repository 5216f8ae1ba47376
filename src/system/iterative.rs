//! GMRES (Saad & Schultz 1986), preconditioned from the right: it minimises the true residual, for symmetric
//! systems, saddles and unsymmetric ones alike.

use super::accuracy::{dot, norm};

/// The residual of the recursion at which an iteration ends, over the true residual that is wanted: room for their difference.
const RECURSION: f64 = 0.9;
/// Vectors before a restart.
const RESTART: usize = 40;

/// The iteration, with its memory, which is kept from solve to solve.
#[derive(Default)]
pub struct Gmres {
    /// The orthonormal basis of the Krylov space, and its preconditioned vectors.
    basis: Vec<Vec<f64>>,
    images: Vec<Vec<f64>>,
    /// The columns of the triangle that Givens rotations make of the Hessenberg matrix, the rotations, and the right-hand side.
    triangle: Vec<Vec<f64>>,
    turns: Vec<(f64, f64)>,
    rest: Vec<f64>,
}

impl Gmres {
    /// Solves `A x = b` until the residual is at most `limit`, until `most` products are made, or until a restart reduces the residual by less than
    /// half. Writes the solution to `x` and returns the norm of its residual, which is not finite if the iteration breaks down. `multiply(x, y)` is
    /// `y = A x`; `precondition(r)` replaces `r` by an approximation of `A⁻¹ r`, and that of `b` is what the iteration begins with.
    pub fn solve(
        &mut self,
        multiply: &dyn Fn(&[f64], &mut [f64]),
        precondition: &mut dyn FnMut(&mut [f64]),
        b: &[f64],
        x: &mut [f64],
        (limit, most): (f64, usize),
    ) -> f64 {
        x.copy_from_slice(b);
        precondition(x);
        let (mut products, mut last) = (0, f64::INFINITY);
        loop {
            // The true residual counts, not that of the recursion.
            let residual = vector(&mut self.basis, 0, b.len());
            multiply(x, residual);
            residual.iter_mut().zip(b).for_each(|(r, b)| *r = b - *r);
            let size = norm(residual);
            if size <= limit || !size.is_finite() || products >= most || size > 0.5 * last {
                return size;
            }
            last = size;
            residual.iter_mut().for_each(|r| *r /= size);
            let ends = (RECURSION * limit, (most - products).min(RESTART));
            let Some(count) = self.iterate(multiply, precondition, size, ends) else { return f64::NAN };
            products += count;
            for i in (0..count).rev() {
                let known: f64 = (i + 1..count).map(|j| self.triangle[j][i] * self.rest[j]).sum();
                self.rest[i] = (self.rest[i] - known) / self.triangle[i][i];
            }
            for (image, y) in self.images.iter().zip(&self.rest[..count]) {
                x.iter_mut().zip(image).for_each(|(x, v)| *x += y * v);
            }
        }
    }

    /// Iterates from the first vector of the basis, a residual of norm `size`, until the norm is at most `limit` or `most` products are made. Returns
    /// the number of products, or `None` if the matrix is singular.
    fn iterate(
        &mut self,
        multiply: &dyn Fn(&[f64], &mut [f64]),
        precondition: &mut dyn FnMut(&mut [f64]),
        size: f64,
        (limit, most): (f64, usize),
    ) -> Option<usize> {
        self.turns.clear();
        self.rest.clear();
        self.rest.push(size);
        for k in 0..most {
            let n = self.basis[k].len();
            let image = vector(&mut self.images, k, n);
            image.copy_from_slice(&self.basis[k]);
            precondition(image);
            multiply(image, vector(&mut self.basis, k + 1, n));
            let (before, [next, ..]) = self.basis.split_at_mut(k + 1) else { return None };
            if self.triangle.len() == k {
                self.triangle.push(Vec::with_capacity(RESTART + 1));
            }
            let column = &mut self.triangle[k];
            column.clear();
            for v in before {
                let h = dot(v, next);
                next.iter_mut().zip(v.iter()).for_each(|(n, v)| *n -= h * v);
                column.push(h);
            }
            let length = norm(next);
            for (i, &(c, s)) in self.turns.iter().enumerate() {
                (column[i], column[i + 1]) = (c * column[i] + s * column[i + 1], c * column[i + 1] - s * column[i]);
            }
            let radius = column[k].hypot(length);
            if !radius.is_finite() || radius == 0.0 {
                return None;
            }
            let (c, s) = (column[k] / radius, length / radius);
            column[k] = radius;
            self.turns.push((c, s));
            self.rest.push(-s * self.rest[k]);
            self.rest[k] *= c;
            if self.rest[k + 1].abs() <= limit || length == 0.0 {
                return Some(k + 1);
            }
            next.iter_mut().for_each(|n| *n /= length);
        }
        Some(most)
    }
}

/// Vector `k`, of length `n`, made if it is the next one.
fn vector(all: &mut Vec<Vec<f64>>, k: usize, n: usize) -> &mut Vec<f64> {
    if all.len() == k {
        all.push(Vec::new());
    }
    all[k].resize(n, 0.0);
    &mut all[k]
}

#[cfg(test)]
mod tests {
    use super::Gmres;

    /// An unsymmetric, indefinite matrix, preconditioned by its diagonal; more vectors than a restart has.
    #[test]
    fn the_residual_falls_below_the_limit() {
        let n = 60;
        let entry = |i: usize, j: usize| match (i, j) {
            (i, j) if i == j => {
                if i % 7 == 0 {
                    -3.0
                } else {
                    2.0 + i as f64
                }
            }
            (i, j) if i == j + 1 => 0.5,
            (i, j) if j == i + 1 => -0.8,
            _ => 0.0,
        };
        let multiply = |x: &[f64], y: &mut [f64]| {
            (0..n).for_each(|i| y[i] = (0..n).map(|j| entry(i, j) * x[j]).sum());
        };
        let b: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
        let mut x = vec![0.0; n];
        let mut precondition = |r: &mut [f64]| r.iter_mut().enumerate().for_each(|(i, r)| *r /= entry(i, i));
        let said = Gmres::default().solve(&multiply, &mut precondition, &b, &mut x, (1e-10, 160));
        let mut image = vec![0.0; n];
        multiply(&x, &mut image);
        let residual = image.iter().zip(&b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        assert!(residual <= 1e-10 && (said - residual).abs() < 1e-15, "{residual:e}, {said:e}");
    }

    #[test]
    fn a_singular_system_has_no_solution() {
        let multiply = |x: &[f64], y: &mut [f64]| (y[0], y[1]) = (x[0], 0.0);
        let residual = Gmres::default().solve(&multiply, &mut |_| (), &[1.0, 1.0], &mut [0.0, 0.0], (1e-8, 160));
        assert!(residual.is_nan() || residual > 0.5, "{residual}");
    }
}
