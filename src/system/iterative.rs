//! GMRES (Saad & Schultz 1986), preconditioned from the right: what it lessens is the true residual, for symmetric
//! systems, saddles and unsymmetric ones alike. Its vectors cost little beside products that run over all cells.

use super::accuracy::dot;

/// Vectors before a restart.
const RESTART: usize = 40;
/// Products in all.
const MOST: usize = 160;

/// Writes to `x` a solution of `A x = b` with a residual of at most `limit`; the number of products, or `None`
/// where they do not suffice. `multiply(x, y)` is `y = A x`, `precondition(r)` turns `r` into about `A⁻¹ r`.
pub fn gmres(
    multiply: &dyn Fn(&[f64], &mut [f64]),
    precondition: &mut dyn FnMut(&mut [f64]),
    b: &[f64],
    x: &mut [f64],
    limit: f64,
) -> Option<usize> {
    let (mut products, mut r) = (0, b.to_vec());
    let (mut basis, mut images): (Vec<Vec<f64>>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
    x.fill(0.0);
    loop {
        let size = dot(&r, &r).sqrt();
        if !size.is_finite() {
            return None;
        }
        if size <= limit {
            return Some(products);
        }
        if products >= MOST {
            return None;
        }
        basis.clear();
        images.clear();
        basis.push(r.iter().map(|r| r / size).collect());
        // The columns of the triangle that Givens rotations make of the Hessenberg matrix.
        let (mut triangle, mut turns): (Vec<Vec<f64>>, Vec<(f64, f64)>) = (Vec::new(), Vec::new());
        let mut rest = vec![size];
        for k in 0..RESTART {
            let mut image = basis[k].clone();
            precondition(&mut image);
            let mut next = vec![0.0; b.len()];
            multiply(&image, &mut next);
            products += 1;
            images.push(image);
            let mut column: Vec<f64> = Vec::with_capacity(k + 2);
            for v in &basis {
                let h = dot(v, &next);
                next.iter_mut().zip(v).for_each(|(n, v)| *n -= h * v);
                column.push(h);
            }
            let length = dot(&next, &next).sqrt();
            for (i, &(c, s)) in turns.iter().enumerate() {
                (column[i], column[i + 1]) = (c * column[i] + s * column[i + 1], c * column[i + 1] - s * column[i]);
            }
            let radius = column[k].hypot(length);
            if !radius.is_finite() || radius == 0.0 {
                return None;
            }
            let (c, s) = (column[k] / radius, length / radius);
            column[k] = radius;
            turns.push((c, s));
            triangle.push(column);
            rest.push(-s * rest[k]);
            rest[k] *= c;
            if rest[k + 1].abs() <= 0.9 * limit || products >= MOST || length == 0.0 {
                break;
            }
            next.iter_mut().for_each(|n| *n /= length);
            basis.push(next);
        }
        for i in (0..triangle.len()).rev() {
            let known: f64 = (i + 1..triangle.len()).map(|j| triangle[j][i] * rest[j]).sum();
            rest[i] = (rest[i] - known) / triangle[i][i];
        }
        for (image, y) in images.iter().zip(&rest) {
            x.iter_mut().zip(image).for_each(|(x, v)| *x += y * v);
        }
        multiply(x, &mut r);
        products += 1;
        r.iter_mut().zip(b).for_each(|(r, b)| *r = b - *r);
    }
}

#[cfg(test)]
mod tests {
    use super::gmres;

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
        let products = gmres(&multiply, &mut precondition, &b, &mut x, 1e-10).unwrap();
        let mut image = vec![0.0; n];
        multiply(&x, &mut image);
        let residual = image.iter().zip(&b).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        assert!(residual <= 1e-10, "{residual:e} after {products} products");
    }

    #[test]
    fn a_singular_system_has_no_solution() {
        let multiply = |x: &[f64], y: &mut [f64]| (y[0], y[1]) = (x[0], 0.0);
        assert_eq!(gmres(&multiply, &mut |_| (), &[1.0, 1.0], &mut [0.0, 0.0], 1e-8), None);
    }
}
