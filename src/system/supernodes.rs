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
/// off these. `memory` is for as many numbers as there are equations.
pub fn forward<'a>(
    supernodes: impl Iterator<Item = Supernode<'a>>,
    count: usize,
    x: &mut [f64],
    memory: &mut [f64],
    llt: bool,
) {
    for node in supernodes {
        // The equations of the columns, and what these add to the rows below, side by side as in a column.
        let (top, below) = memory[..node.columns.len() + node.rows.len()].split_at_mut(node.columns.len());
        top.copy_from_slice(&x[node.columns.clone()]);
        below.fill(0.0);
        for j in node.columns.start..node.columns.end.min(count) {
            let (k, column) = (j - node.columns.start, node.column(j));
            if llt {
                memory[k] /= column[k];
            }
            let value = memory[k];
            memory[k + 1..].iter_mut().zip(&column[k + 1..]).for_each(|(sum, l)| *sum -= l * value);
        }
        let (top, below) = memory.split_at(node.columns.len());
        x[node.columns].copy_from_slice(top);
        for (&i, below) in node.rows.iter().zip(below) {
            x[i as usize] += below;
        }
    }
}

/// Solves with the upper triangle for the first `count` equations, in place, the others being known. The `supernodes` come
/// in reverse order, `memory` as in [`forward`].
pub fn backward<'a>(
    supernodes: impl Iterator<Item = Supernode<'a>>,
    count: usize,
    x: &mut [f64],
    memory: &mut [f64],
    llt: bool,
) {
    for node in supernodes {
        let (top, below) = memory[..node.columns.len() + node.rows.len()].split_at_mut(node.columns.len());
        top.copy_from_slice(&x[node.columns.clone()]);
        below.iter_mut().zip(node.rows).for_each(|(below, &i)| *below = x[i as usize]);
        for j in (node.columns.start..node.columns.end.min(count)).rev() {
            let (k, column) = (j - node.columns.start, node.column(j));
            let known = product(&column[k + 1..], &memory[k + 1..]);
            memory[k] = if llt { (memory[k] - known) / column[k] } else { memory[k] / column[k] - known };
        }
        x[node.columns.clone()].copy_from_slice(&memory[..node.columns.len()]);
    }
}

/// `a · b`, `b` at least as long, in as many sums side by side as a register holds.
fn product(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 8];
    let (a, b) = (a.chunks_exact(8), b[..a.len()].chunks_exact(8));
    let rest = a.remainder().iter().zip(b.remainder());
    rest.zip(&mut sums).for_each(|((a, b), sum)| *sum = a * b);
    for (a, b) in a.zip(b) {
        for k in 0..8 {
            sums[k] += a[k] * b[k];
        }
    }
    sums.iter().sum()
}
