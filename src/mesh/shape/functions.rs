//! What a file of this folder gives for its kind of cell.

/// Upper bound of the nodes of a cell, for buffers on the stack (27: a quadratic brick).
pub const MAX_NODES: usize = 27;

/// One kind of cell.
pub trait Shape {
    const NODES: usize;
    const DIMENSION: usize;
    /// Shape functions at `xi` (the first `DIMENSION` entries count) into `n[..NODES]`.
    fn values(xi: &[f64; 3], n: &mut [f64]);
    /// Their derivatives with respect to `xi` into `dn[..NODES]`.
    fn derivatives(xi: &[f64; 3], dn: &mut [[f64; 3]]);
}

/// The Jacobian `∂x/∂ξ` of a cell with nodes at `x`, given the derivatives of its shape functions, one entry a node.
pub fn jacobian<'a, const D: usize>(
    x: impl IntoIterator<Item = &'a [f64; D]>,
    derivatives: &[[f64; 3]],
) -> [[f64; D]; D] {
    let mut jacobian = [[0.0; D]; D];
    for (x, dn) in x.into_iter().zip(derivatives) {
        for i in 0..D {
            for j in 0..D {
                jacobian[i][j] += x[i] * dn[j];
            }
        }
    }
    jacobian
}

/// Inverse and determinant of a small matrix (`D` ≤ 3).
pub fn invert<const D: usize>(a: &[[f64; D]; D]) -> ([[f64; D]; D], f64) {
    let mut inverse = [[0.0; D]; D];
    let determinant;
    match D {
        1 => {
            determinant = a[0][0];
            inverse[0][0] = 1.0 / a[0][0];
        }
        2 => {
            determinant = a[0][0] * a[1][1] - a[0][1] * a[1][0];
            let r = 1.0 / determinant;
            inverse[0][0] = a[1][1] * r;
            inverse[0][1] = -a[0][1] * r;
            inverse[1][0] = -a[1][0] * r;
            inverse[1][1] = a[0][0] * r;
        }
        _ => {
            let cofactor = |i: usize, j: usize| {
                let (r, s) = ((i + 1) % 3, (i + 2) % 3);
                let (p, q) = ((j + 1) % 3, (j + 2) % 3);
                a[r][p] * a[s][q] - a[r][q] * a[s][p]
            };
            determinant = (0..3).map(|j| a[0][j] * cofactor(0, j)).sum();
            let r = 1.0 / determinant;
            for i in 0..3 {
                for j in 0..3 {
                    inverse[i][j] = cofactor(j, i) * r;
                }
            }
        }
    }
    (inverse, determinant)
}
