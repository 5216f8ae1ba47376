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

/// Numbers that the results of a batch have about: while those of one are added to the system, those of the next are computed, and
/// both stay in a cache until then.
const NUMBERS: usize = 1 << 16;
/// Least number of items of a batch for each thread.
const EACH: usize = 4;

/// Items of a batch, given the numbers that the result of one has at most, and the threads.
fn batch(stride: usize, threads: usize) -> usize {
    (NUMBERS / stride).max(EACH * threads)
}

/// Memory that assembly uses again and again: the results of two batches.
#[derive(Default)]
pub struct Workspace {
    buffers: [Vec<f64>; 2],
}

/// Computes the contributions of `items` (each with its coupling) in parallel and adds them to `vector` and,
/// where wanted, to `matrix`. One batch is added while the next is computed. The order of the additions is that of `items`, so the sums do
/// not depend on the number of threads.
///
/// # Errors
/// The error of the first item that fails; the sums are then incomplete.
pub fn scatter<I: Sync>(
    pattern: &Pattern,
    items: &[I],
    coupling: impl Fn(&I) -> usize + Sync,
    compute: impl Fn(&I, &mut Local) -> Result<()> + Sync,
    vector: &mut [f64],
    matrix: Option<&mut Matrix>,
    workspace: &mut Workspace,
) -> Result<()> {
    let coupling = |i: usize| coupling(&items[i]);
    let compute = |i: usize, local: &mut Local| compute(&items[i], local);
    let numbered = Numbered { count: items.len(), coupling: &coupling, compute: &compute };
    scatter_numbered(pattern, numbered, vector, matrix, workspace)
}

/// Items by their numbers: what they are is known to their functions alone, so that [`scatter_numbered`] is compiled once.
struct Numbered<'a> {
    count: usize,
    coupling: &'a (dyn Fn(usize) -> usize + Sync),
    compute: &'a (dyn Fn(usize, &mut Local) -> Result<()> + Sync),
}

fn scatter_numbered(
    pattern: &Pattern,
    Numbered { count, coupling, compute }: Numbered,
    vector: &mut [f64],
    mut matrix: Option<&mut Matrix>,
    workspace: &mut Workspace,
) -> Result<()> {
    let largest = (0..count).map(|i| pattern.largest_size(coupling(i))).max().unwrap_or(0);
    let squared = if matrix.is_some() { largest * largest } else { 0 };
    let stride = largest + squared;
    if stride == 0 {
        return Ok(());
    }
    let at_once = batch(stride, rayon::current_num_threads());
    for buffer in &mut workspace.buffers {
        let needed = stride * count.min(at_once);
        if buffer.len() < needed {
            buffer.resize(needed, 0.0);
        }
    }
    let run = |i: usize, slot: &mut [f64]| {
        let k = coupling(i);
        let (size, most) = (pattern.local_size(k), pattern.largest_size(k));
        let (vector, matrix) = slot.split_at_mut(largest);
        let (vector, matrix) = (&mut vector[..most], &mut matrix[..(most * most).min(squared)]);
        vector.fill(0.0);
        matrix.fill(0.0);
        let square = (size * size).min(matrix.len());
        compute(i, &mut Local { matrix: &mut matrix[..square], vector: &mut vector[..size], size })?;
        pattern.reduce(k, vector, matrix);
        Ok(())
    };
    let results = |batch: Range<usize>, buffer: &mut [f64]| {
        let pairs = batch.clone().into_par_iter().zip(buffer.par_chunks_mut(stride));
        if pairs.try_for_each(|(i, slot)| run(i, slot).map_err(|_| ())).is_err() {
            // Threads may fail in any order: run again one by one for the error of the first item.
            return batch.zip(buffer.chunks_mut(stride)).try_for_each(|(i, slot)| run(i, slot));
        }
        Ok(())
    };
    let mut add = |batch: Range<usize>, buffer: &[f64]| {
        for (i, slot) in batch.zip(buffer.chunks(stride)) {
            let k = coupling(i);
            add_vector(pattern, k, slot, vector);
            if let Some(matrix) = &mut matrix {
                matrix.add(pattern, k, &slot[largest..], pattern.coupling_size(k));
            }
        }
    };
    let [one, other] = &mut workspace.buffers;
    let (mut done, mut next) = (one, other);
    let mut before = 0..0;
    for start in (0..count).step_by(at_once) {
        let batch = start..count.min(start + at_once);
        let (_, found) = rayon::join(|| add(before, done), || results(batch.clone(), next));
        found?;
        std::mem::swap(&mut done, &mut next);
        before = batch;
    }
    add(before, done);
    Ok(())
}

/// Adds what the dense vector of coupling `k` has.
fn add_vector(pattern: &Pattern, k: usize, local: &[f64], vector: &mut [f64]) {
    let mut rest = local;
    for &b in pattern.connectivity.blocks(k) {
        let equations = pattern.start[b as usize] as usize..pattern.start[b as usize + 1] as usize;
        let (own, after) = rest.split_at(equations.len());
        vector[equations].iter_mut().zip(own).for_each(|(sum, value)| *sum += value);
        rest = after;
    }
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
