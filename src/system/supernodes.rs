//! A factor of faer by its supernodes, and the triangular solutions with its first equations only.

use faer::sparse::linalg::cholesky;
use std::ops::Range;

/// Columns of a factor that share their rows: `rows` is those after the last of `columns`.
pub struct Supernode<'a> {
    pub columns: Range<usize>,
    pub rows: &'a [u32],
    /// Column-major, the upper triangle among the columns included.
    values: &'a [f64],
}

impl<'a> Supernode<'a> {
    /// Column `j` from the row of the first column on.
    pub fn column(&self, j: usize) -> &'a [f64] {
        let rows = self.columns.len() + self.rows.len();
        &self.values[(j - self.columns.start) * rows..][..rows]
    }
}

/// The supernodes of a factor, in order; none of a simplicial one.
pub fn supernodes<'a>(
    symbolic: &'a cholesky::SymbolicCholesky<u32>,
    factor: &'a [f64],
) -> impl DoubleEndedIterator<Item = Supernode<'a>> {
    let supernodal = match symbolic.raw() {
        cholesky::SymbolicCholeskyRaw::Supernodal(supernodal) => Some(supernodal),
        cholesky::SymbolicCholeskyRaw::Simplicial(_) => None,
    };
    supernodal.into_iter().flat_map(move |s| {
        (0..s.n_supernodes()).map(move |k| Supernode {
            columns: s.supernode_begin()[k] as usize..s.supernode_end()[k] as usize,
            rows: s.supernode(k).pattern(),
            values: &factor[s.col_ptr_for_val()[k] as usize..s.col_ptr_for_val()[k + 1] as usize],
        })
    })
}

/// Solves with the lower triangle for the first `count` equations, in place; what they have to do with the others is taken
/// off these. `beyond` is memory for as many numbers as there are equations.
pub fn forward<'a>(
    supernodes: impl Iterator<Item = Supernode<'a>>,
    count: usize,
    x: &mut [f64],
    beyond: &mut [f64],
    llt: bool,
) {
    for node in supernodes {
        let beyond = &mut beyond[..node.rows.len()];
        beyond.fill(0.0);
        for j in node.columns.start..node.columns.end.min(count) {
            let (among, below) = node.column(j).split_at(node.columns.len());
            let (diagonal, among) = among[j - node.columns.start..].split_at(1);
            if llt {
                x[j] /= diagonal[0];
            }
            let value = x[j];
            x[j + 1..].iter_mut().zip(among).for_each(|(x, l)| *x -= l * value);
            beyond.iter_mut().zip(below).for_each(|(beyond, l)| *beyond -= l * value);
        }
        for (&i, beyond) in node.rows.iter().zip(beyond) {
            x[i as usize] += *beyond;
        }
    }
}

/// Solves with the upper triangle for the first `count` equations, in place, the others being known. The `supernodes` come
/// in reverse order, `beyond` as in [`forward`].
pub fn backward<'a>(
    supernodes: impl Iterator<Item = Supernode<'a>>,
    count: usize,
    x: &mut [f64],
    beyond: &mut [f64],
    llt: bool,
) {
    for node in supernodes {
        let beyond = &mut beyond[..node.rows.len()];
        for (beyond, &i) in beyond.iter_mut().zip(node.rows) {
            *beyond = x[i as usize];
        }
        for j in (node.columns.start..node.columns.end.min(count)).rev() {
            let (among, below) = node.column(j).split_at(node.columns.len());
            let (diagonal, among) = among[j - node.columns.start..].split_at(1);
            let known = product(among, &x[j + 1..]) + product(below, beyond);
            x[j] = if llt { (x[j] - known) / diagonal[0] } else { x[j] / diagonal[0] - known };
        }
    }
}

/// `a · b`, `b` at least as long, in as many sums side by side as a register holds.
fn product(a: &[f64], b: &[f64]) -> f64 {
    let b = &b[..a.len()];
    let mut sums = [0.0; 8];
    let (a, b) = (a.chunks_exact(8), b.chunks_exact(8));
    let rest: f64 = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a.zip(b) {
        for k in 0..8 {
            sums[k] += a[k] * b[k];
        }
    }
    sums.iter().sum::<f64>() + rest
}
