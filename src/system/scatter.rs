//! Assembly of dense coupling matrices and vectors into a system.

use super::{Matrix, Pattern};
use crate::error::Result;
use rayon::prelude::*;
use std::ops::Range;

/// What one coupling contributes: a dense matrix (row-major) and a vector over the equations of its nodes.
pub struct Local<'a> {
    /// Row-major, `size × size`; empty when only the vector is wanted.
    pub matrix: &'a mut [f64],
    pub vector: &'a mut [f64],
    pub size: usize,
}

/// Some equations of a vector.
struct Rows<'a> {
    /// The blocks they belong to.
    blocks: Range<u32>,
    values: &'a mut [f64],
}

impl Rows<'_> {
    /// Adds what the dense vector of coupling `k` has in these equations.
    fn add(&mut self, pattern: &Pattern, k: usize, local: &[f64]) {
        let (first, mut begin) = (pattern.start[self.blocks.start as usize] as usize, 0);
        for &b in pattern.connectivity.blocks(k) {
            let equations = pattern.start[b as usize] as usize..pattern.start[b as usize + 1] as usize;
            let size = equations.len();
            if self.blocks.contains(&b) {
                let own = &mut self.values[equations.start - first..equations.end - first];
                own.iter_mut().zip(&local[begin..]).for_each(|(sum, value)| *sum += value);
            }
            begin += size;
        }
    }
}

/// A vector in groups of equations that end at the blocks `cuts`, ascending.
fn rows_between<'a>(pattern: &Pattern, cuts: &[u32], vector: &'a mut [f64]) -> Vec<Rows<'a>> {
    let (mut rest, mut begin) = (vector, 0);
    let last = pattern.start.len() as u32 - 1;
    let group = |&end: &u32| {
        let own;
        let count = pattern.start[end as usize] - pattern.start[begin as usize];
        (own, rest) = std::mem::take(&mut rest).split_at_mut(count as usize);
        let group = Rows { blocks: begin..end, values: own };
        begin = end;
        group
    };
    cuts.iter().chain([&last]).map(group).collect()
}

/// Blocks to cut at, ascending, so that each of `threads` parts has about as many of those of the `couplings`.
fn share(pattern: &Pattern, connectivity: impl Iterator<Item = usize>, threads: usize) -> Vec<u32> {
    if threads == 1 {
        return Vec::new();
    }
    let mut blocks: Vec<u32> = connectivity.flat_map(|k| pattern.connectivity.blocks(k)).copied().collect();
    blocks.sort_unstable();
    (1..threads).map(|part| blocks.get(part * blocks.len() / threads).copied().unwrap_or(0)).collect()
}

/// Numbers that the results of a batch have about: items are computed side by side before their results are added, in their order, to the system, and
/// as many as stay in a cache until then.
const NUMBERS: usize = 1 << 16;
/// Least number of items of a batch for each thread.
const EACH: usize = 4;

/// Items of a batch, given the numbers that the result of one has at most, and the threads.
fn batch(stride: usize, threads: usize) -> usize {
    (NUMBERS / stride).max(EACH * threads)
}

/// Memory that assembly uses again and again.
#[derive(Default)]
pub struct Workspace {
    buffer: Vec<f64>,
}

/// Computes the contributions of `items` (each with its coupling) in parallel and adds them to `vector` and,
/// where wanted, to `matrix`. The order of the additions is that of `items`, so the sums do not depend on
/// the number of threads.
///
/// # Errors
/// The error of the first item that fails; the sums are then incomplete.
pub fn scatter<I: Sync>(
    pattern: &Pattern,
    items: &[I],
    coupling: impl Fn(&I) -> usize + Sync,
    compute: impl Fn(&I, &mut Local) -> Result<()> + Sync,
    vector: &mut [f64],
    mut matrix: Option<&mut Matrix>,
    workspace: &mut Workspace,
) -> Result<()> {
    let largest = pattern.largest_coupling;
    let matrix_stride = if matrix.is_some() { largest * largest } else { 0 };
    let stride = largest + matrix_stride;
    if stride == 0 {
        return Ok(());
    }
    let threads = rayon::current_num_threads();
    let at_once = batch(stride, threads);
    let needed = stride * items.len().min(at_once);
    if workspace.buffer.len() < needed {
        workspace.buffer.resize(needed, 0.0);
    }
    let run = |item: &I, slot: &mut [f64]| {
        let k = coupling(item);
        let size = pattern.local_size(k);
        slot.fill(0.0);
        let (vector, rest) = slot.split_at_mut(largest);
        let matrix = if matrix_stride > 0 { &mut rest[..size * size] } else { &mut rest[..0] };
        compute(item, &mut Local { matrix, vector: &mut vector[..size], size })?;
        pattern.reduce(k, vector, rest);
        Ok(())
    };
    for batch in items.chunks(at_once) {
        let slots = &mut workspace.buffer[..stride * batch.len()];
        let pairs = batch.par_iter().zip(slots.par_chunks_mut(stride));
        if pairs.try_for_each(|(item, slot)| run(item, slot).map_err(|_| ())).is_err() {
            // Threads may fail in any order: run again one by one for the error of the first item.
            for (item, slot) in batch.iter().zip(slots.chunks_mut(stride)) {
                run(item, slot)?;
            }
        }
        // Each thread adds to equations of its own, so that every entry sees the items in their order.
        let cuts = share(pattern, batch.iter().map(&coupling), threads);
        let columns: Vec<_> = match &mut matrix {
            Some(matrix) => matrix.columns_between(pattern, &cuts).into_iter().map(Some).collect(),
            None => (0..=cuts.len()).map(|_| None).collect(),
        };
        rows_between(pattern, &cuts, vector).into_par_iter().zip(columns).for_each(|(mut rows, mut columns)| {
            for (item, slot) in batch.iter().zip(slots.chunks(stride)) {
                let k = coupling(item);
                rows.add(pattern, k, slot);
                if let Some(columns) = &mut columns {
                    columns.add(pattern, k, &slot[largest..], pattern.coupling_size(k));
                }
            }
        });
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::Connectivity;
    use super::*;

    #[test]
    fn batches_of_large_couplings_are_small() {
        assert_eq!(batch(64, 2), NUMBERS / 64);
        assert_eq!(batch(NUMBERS / 10, 2), 10);
        assert_eq!(batch(NUMBERS, 2), 2 * EACH);
    }

    /// More items than a batch takes, which see half of their coupling: the sums are those of one after the other, to the last bit.
    #[test]
    fn sums_are_those_of_the_items_in_their_order() {
        for symmetric in [true, false] {
            let mut connectivity = Connectivity::default();
            connectivity.push(0..60);
            connectivity.push((30..90).rev());
            let pattern = Pattern::new(&[2; 90], connectivity, symmetric);
            let items: Vec<usize> = (0..40).collect();
            let entry =
                |item: usize, i: usize| if (i + item).is_multiple_of(2) { ((i + 7 * item) as f64).sin() } else { 0.0 };
            let compute = |item: &usize, local: &mut Local| {
                for i in 0..local.size {
                    local.vector[i] = entry(*item, i);
                    for j in 0..local.size {
                        local.matrix[i * local.size + j] = entry(*item, i) * entry(*item, j);
                    }
                }
                Ok(())
            };
            let (mut matrix, mut vector) = (Matrix::new(&pattern), vec![0.0; pattern.len()]);
            assert!(batch(pattern.largest_coupling.pow(2), rayon::current_num_threads()) < items.len());
            scatter(&pattern, &items, |k| k % 2, compute, &mut vector, Some(&mut matrix), &mut Workspace::default())
                .unwrap();
            let (mut dense, mut sum) = (vec![vec![0.0; pattern.len()]; pattern.len()], vec![0.0; pattern.len()]);
            for &item in &items {
                let equations: Vec<usize> = pattern
                    .connectivity
                    .blocks(item % 2)
                    .iter()
                    .flat_map(|&b| [2 * b as usize, 2 * b as usize + 1])
                    .collect();
                for (a, &i) in equations.iter().enumerate() {
                    sum[i] += entry(item, a);
                    for (b, &j) in equations.iter().enumerate() {
                        dense[i][j] += entry(item, a) * entry(item, b);
                    }
                }
            }
            assert_eq!(vector, sum);
            for j in 0..pattern.len() {
                for k in pattern.column[j] as usize..pattern.column[j + 1] as usize {
                    assert_eq!(matrix.values[k], dense[pattern.row[k] as usize][j]);
                }
            }
        }
    }
}
