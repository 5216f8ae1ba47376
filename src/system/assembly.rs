//! The matrix of a system.

use super::Pattern;
use rayon::prelude::*;
use std::ops::Range;

/// Groups of columns that are worked on side by side, whatever the threads.
const COLUMNS: usize = 4;
/// Entries that are worth a task of their own.
const MANY: usize = 1 << 17;

/// The values of a matrix with a given [`Pattern`], and what else belongs to it.
#[derive(Default)]
pub struct Matrix {
    pub values: Vec<f64>,
    /// Summands that the pattern has no room for, known by their products only. The direct solver cannot have them.
    pub matrix_free: Vec<Box<dyn MatrixFree>>,
    /// Memory of such summands that are spent, for the next ones.
    pub spare: Vec<Vec<f64>>,
    /// The equations taken out; empty before [`Matrix::constrain`].
    pub(crate) fixed: Vec<bool>,
}

/// A matrix known by its products.
pub trait MatrixFree: Send + Sync {
    /// `y += A x`.
    fn add_product(&self, x: &[f64], y: &mut [f64]);

    /// Gives back the memory of a summand that is spent.
    fn into_memory(self: Box<Self>) -> Vec<f64>;
}

impl Matrix {
    pub fn new(pattern: &Pattern) -> Self {
        Self { values: vec![0.0; pattern.row.len()], ..Self::default() }
    }

    pub fn clear(&mut self) {
        self.values.par_chunks_mut(MANY).for_each(|values| values.fill(0.0));
        self.spare.extend(self.matrix_free.drain(..).map(|summand| summand.into_memory()));
        self.fixed.clear();
    }

    /// Adds the dense matrix of coupling `k`. Of a symmetric system only the lower triangle is read. Rows without entries are left out: terms may act
    /// on few of the nodes that a scheme couples.
    pub fn add(&mut self, pattern: &Pattern, k: usize, local: &[f64], size: usize) {
        let blocks = pattern.connectivity.blocks(k);
        let first_pair = pattern.pairs[k] as usize;
        let width_of = |b: u32| (pattern.start[b as usize + 1] - pattern.start[b as usize]) as usize;
        let mut rest = local;
        for (a, &ra) in blocks.iter().enumerate() {
            let height = width_of(ra);
            let (rows, below) = rest.split_at(height * size);
            rest = below;
            if rows.iter().all(|&value| value == 0.0) {
                continue;
            }
            let mut column = 0;
            for (b, &cb) in blocks.iter().enumerate() {
                let (width, from) = (width_of(cb), column);
                column += width;
                if pattern.symmetric && ra < cb {
                    continue;
                }
                let offset = pattern.offset[first_pair + a * blocks.len() + b] as usize;
                for j in 0..width {
                    let begin = pattern.column[pattern.start[cb as usize] as usize + j] as usize;
                    // In the lower triangle column j of the diagonal block has lost its first j rows.
                    let (skip, lost) = match (pattern.symmetric, ra == cb) {
                        (true, true) => (j, j),
                        (true, false) => (0, j),
                        _ => (0, 0),
                    };
                    for i in skip..height {
                        self.values[begin + offset + i - lost] += rows[i * size + from + j];
                    }
                }
            }
        }
    }

    /// Adds to the diagonal entry of equation `e`.
    pub fn add_diagonal(&mut self, pattern: &Pattern, e: usize, value: f64) {
        self.values[diagonal_place(pattern, e)] += value;
    }

    /// Adds `value(i, j)` to the diagonal block of `width` equations from `first` on, given the row and the column within it.
    pub fn add_block(&mut self, pattern: &Pattern, first: usize, width: usize, value: impl Fn(usize, usize) -> f64) {
        for j in 0..width {
            let diagonal = diagonal_place(pattern, first + j);
            // Of a symmetric system only the lower triangle is kept.
            for i in if pattern.symmetric { j } else { 0 }..width {
                self.values[diagonal + i - j] += value(i, j);
            }
        }
    }

    /// The matrix in `count` groups of columns with about as many entries each.
    fn columns(&mut self, pattern: &Pattern, count: usize) -> Vec<Columns<'_>> {
        let blocks = pattern.start.len() - 1;
        let first = |block: usize| pattern.column[pattern.start[block] as usize] as usize;
        let (total, mut values, mut begin) = (self.values.len(), &mut self.values[..], 0);
        let group = |number: usize| {
            let mut end = begin;
            while end < blocks && (number == count || first(end) < number * total / count) {
                end += 1;
            }
            let own;
            (own, values) = std::mem::take(&mut values).split_at_mut(first(end) - first(begin));
            let group = Columns { blocks: begin as u32..end as u32, first: first(begin), values: own };
            begin = end;
            group
        };
        (1..=count).map(group).collect()
    }

    /// Takes the equations marked in `fixed` out of the system: their rows and columns vanish but for a
    /// diagonal entry `scale`. Their known solution `known` moves to the right-hand side.
    pub fn constrain(&mut self, pattern: &Pattern, fixed: &[bool], known: &[f64], scale: f64, rhs: &mut [f64]) {
        if !self.matrix_free.is_empty() {
            let held: Vec<f64> = known.iter().zip(fixed).map(|(u, fixed)| if *fixed { *u } else { 0.0 }).collect();
            if held.iter().any(|&u| u != 0.0) {
                let mut force = vec![0.0; held.len()];
                self.matrix_free.iter().for_each(|summand| summand.add_product(&held, &mut force));
                rhs.iter_mut().zip(&force).for_each(|(rhs, f)| *rhs -= f);
            }
            self.fixed = fixed.to_vec();
        }
        // The columns that are taken out concern other right-hand sides; the rows in the lower triangle only their own.
        for j in (0..pattern.len()).filter(|&j| fixed[j] && known[j] != 0.0) {
            for k in pattern.column[j] as usize..pattern.column[j + 1] as usize {
                let i = pattern.row[k] as usize;
                if !fixed[i] {
                    rhs[i] -= self.values[k] * known[j];
                }
            }
        }
        let mut groups = self.columns(pattern, COLUMNS);
        let mut right = &mut rhs[..];
        let groups: Vec<_> = groups
            .iter_mut()
            .map(|group| {
                let equations = group.equations(pattern);
                let own;
                (own, right) = std::mem::take(&mut right).split_at_mut(equations.len());
                (equations, own, group)
            })
            .collect();
        groups.into_par_iter().for_each(|(equations, right, group)| {
            for (j, right) in equations.zip(right) {
                for k in pattern.column[j] as usize..pattern.column[j + 1] as usize {
                    let (i, value) = (pattern.row[k] as usize, &mut group.values[k - group.first]);
                    if fixed[i] || fixed[j] {
                        if pattern.symmetric && !fixed[j] {
                            *right -= *value * known[i];
                        }
                        *value = if i == j { scale } else { 0.0 };
                    }
                }
            }
        });
        for (i, rhs) in rhs.iter_mut().enumerate() {
            if fixed[i] {
                *rhs = scale * known[i];
            }
        }
    }

    /// `y = A x`.
    pub fn multiply(&self, pattern: &Pattern, x: &[f64], y: &mut [f64]) {
        let equations = pattern.len();
        // Groups of columns side by side, each into a vector of its own: as many whatever the threads.
        let count = if self.values.len() < MANY { 1 } else { COLUMNS };
        let mut others = vec![0.0; (count - 1) * equations];
        let mut parts: Vec<&mut [f64]> = others.chunks_exact_mut(equations.max(1)).collect();
        parts.push(&mut *y);
        let products = |(group, y): (usize, &mut [f64])| {
            y.fill(0.0);
            for j in group * equations / count..(group + 1) * equations / count {
                let column = pattern.column[j] as usize..pattern.column[j + 1] as usize;
                let mut own = 0.0;
                for (&i, value) in pattern.row[column.clone()].iter().zip(&self.values[column]) {
                    let i = i as usize;
                    y[i] += value * x[j];
                    if pattern.symmetric && i != j {
                        own += value * x[i];
                    }
                }
                y[j] += own;
            }
        };
        parts.into_par_iter().enumerate().for_each(products);
        for other in others.chunks_exact(equations.max(1)) {
            y.iter_mut().zip(other).for_each(|(y, other)| *y += other);
        }
        if self.matrix_free.is_empty() {
            return;
        }
        let fixed = |i: usize| self.fixed.get(i).is_some_and(|fixed| *fixed);
        let free: Vec<f64> = x.iter().enumerate().map(|(i, x)| if fixed(i) { 0.0 } else { *x }).collect();
        let mut force = vec![0.0; y.len()];
        self.matrix_free.iter().for_each(|summand| summand.add_product(&free, &mut force));
        y.iter_mut().zip(&force).enumerate().filter(|(i, _)| !fixed(*i)).for_each(|(_, (y, f))| *y += f);
    }

    /// The norm of the entries of `x` that belong to equations not taken out.
    pub fn norm_free(&self, x: &[f64]) -> f64 {
        let fixed = self.fixed.iter().copied().chain(std::iter::repeat(false));
        x.iter().zip(fixed).map(|(x, fixed)| if fixed { 0.0 } else { x * x }).sum::<f64>().sqrt()
    }

    /// The diagonal.
    pub fn diagonal(&self, pattern: &Pattern) -> Vec<f64> {
        (0..pattern.len()).map(|e| self.values[diagonal_place(pattern, e)]).collect()
    }

    /// Makes the `wanted` of the first equations stiffer by a share of their diagonal.
    pub fn dampen(&mut self, pattern: &Pattern, wanted: &[bool], share: f64) {
        for e in (0..wanted.len()).filter(|&e| wanted[e]) {
            self.values[diagonal_place(pattern, e)] *= 1.0 + share;
        }
    }

    /// Whether every value is a number.
    pub fn is_finite(&self) -> bool {
        self.values.par_chunks(MANY).all(|values| values.iter().all(|v| v.is_finite()))
    }

    /// The largest diagonal entry, at least the smallest positive number.
    pub fn scale(&self, pattern: &Pattern) -> f64 {
        self.diagonal(pattern).iter().fold(f64::MIN_POSITIVE, |scale, d| scale.max(d.abs()))
    }
}

/// Where the diagonal entry of equation `e` stands among the values.
fn diagonal_place(pattern: &Pattern, e: usize) -> usize {
    let column = pattern.column[e] as usize..pattern.column[e + 1] as usize;
    column.start + pattern.row[column].partition_point(|&row| (row as usize) < e)
}

/// Some columns of a matrix.
struct Columns<'a> {
    /// The blocks they belong to.
    pub blocks: Range<u32>,
    /// Where their values begin in the matrix.
    pub first: usize,
    pub values: &'a mut [f64],
}

impl Columns<'_> {
    /// The equations they belong to.
    pub fn equations(&self, pattern: &Pattern) -> Range<usize> {
        pattern.start[self.blocks.start as usize] as usize..pattern.start[self.blocks.end as usize] as usize
    }
}
