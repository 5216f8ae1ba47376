//! What faer's own threads gain in the numeric factorisation: `LLᵀ`, `LDLᵀ` and `LU` of a matrix with the pattern of the
//! large block of `benches/block` (128 × 100 squares of two six-node triangles, two unknowns a node), in the order that
//! the program gives them. The values are made up: diagonally dominant, for `LDLᵀ` with a tenth of the signs turned.
//!
//! ```text
//! cargo run --release --locked --manifest-path benches/factor/Cargo.toml --target-dir target/factor
//! ```

use faer::dyn_stack::{MemBuffer, MemStack, StackReq};
use faer::perm::Perm;
use faer::sparse::linalg::{amd, cholesky, lu};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};
use std::time::Instant;

const SQUARES: (usize, usize) = (128, 100);
/// Factorisations of each kind, of which the least time and the median are printed.
const REPEATS: usize = 7;
/// What faer is told, and the threads that the pool has.
const WAYS: [(&str, usize, usize); 4] =
    [("sequential", 0, 1), ("2 parts, 2 threads", 2, 2), ("2 parts, 1 thread", 2, 1), ("3 parts, 2 threads", 3, 2)];

/// A sparse matrix by columns.
#[derive(Default)]
struct Columns {
    column: Vec<u32>,
    row: Vec<u32>,
    values: Vec<f64>,
}

impl Columns {
    fn pattern(&self) -> SymbolicSparseColMatRef<'_, u32> {
        let n = self.column.len() - 1;
        SymbolicSparseColMatRef::new_checked(n, n, &self.column, None, &self.row)
    }

    fn matrix(&self) -> SparseColMatRef<'_, u32, f64> {
        SparseColMatRef::new(self.pattern(), &self.values)
    }
}

fn main() {
    let near = neighbours();
    let (saddle, definite, general) = (lower(&near, true), lower(&near, false), full(&near));
    println!("{} unknowns; least and median of {REPEATS} factorisations", 2 * near.len());
    let order = ordering(&near);
    let symbolic = cholesky::factorize_symbolic_cholesky(
        definite.pattern(),
        Side::Lower,
        cholesky::SymmetricOrdering::Custom(order.as_ref()),
        Default::default(),
    )
    .unwrap();
    compare("LLᵀ", |par, x| {
        let mut memory = MemBuffer::new(StackReq::any_of(&[
            symbolic.factorize_numeric_llt_scratch::<f64>(par, Default::default()),
            symbolic.solve_in_place_scratch::<f64>(1, par),
        ]));
        let (mut values, stack) = (vec![0.0; symbolic.len_val()], MemStack::new(&mut memory));
        let (start, a) = (Instant::now(), definite.matrix());
        let (side, regular, settings) = (Side::Lower, Default::default(), Default::default());
        let factor = symbolic.factorize_numeric_llt(&mut values, a, side, regular, par, stack, settings).unwrap();
        let time = start.elapsed().as_secs_f64();
        factor.solve_in_place_with_conj(Conj::No, x, par, stack);
        time
    });
    compare("LDLᵀ", |par, x| {
        let mut memory = MemBuffer::new(StackReq::any_of(&[
            symbolic.factorize_numeric_ldlt_scratch::<f64>(par, Default::default()),
            symbolic.solve_in_place_scratch::<f64>(1, par),
        ]));
        let (mut values, stack) = (vec![0.0; symbolic.len_val()], MemStack::new(&mut memory));
        let (start, a) = (Instant::now(), saddle.matrix());
        let (side, regular, settings) = (Side::Lower, Default::default(), Default::default());
        let factor = symbolic.factorize_numeric_ldlt(&mut values, a, side, regular, par, stack, settings).unwrap();
        let time = start.elapsed().as_secs_f64();
        factor.solve_in_place_with_conj(Conj::No, x, par, stack);
        time
    });
    let symbolic = lu::factorize_symbolic_lu(general.pattern(), Default::default()).unwrap();
    compare("LU", |par, x| {
        let mut memory = MemBuffer::new(StackReq::any_of(&[
            symbolic.factorize_numeric_lu_scratch::<f64>(par, Default::default()),
            symbolic.solve_in_place_scratch::<f64>(1, par),
        ]));
        let (mut numeric, stack) = (lu::NumericLu::new(), MemStack::new(&mut memory));
        let start = Instant::now();
        let factor =
            symbolic.factorize_numeric_lu(&mut numeric, general.matrix(), par, stack, Default::default()).unwrap();
        let time = start.elapsed().as_secs_f64();
        factor.solve_in_place_with_conj(Conj::No, x, par, stack);
        time
    });
}

/// Runs all ways in turn and prints wall and processor time, and whose solution has the bits of whose.
/// `run(par, x)` factorises and solves in place; it gives the seconds of the former.
fn compare(name: &str, run: impl Fn(Par, MatMut<'_, f64>) -> f64 + Sync) {
    let n = 2 * (2 * SQUARES.0 + 1) * (2 * SQUARES.1 + 1);
    let mut found: [(Vec<f64>, Vec<f64>); 4] = Default::default();
    let mut solutions: Vec<Vec<f64>> = Vec::new();
    for repeat in 0..REPEATS {
        for (k, &(_, parts, threads)) in WAYS.iter().enumerate() {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let par = if parts == 0 { Par::Seq } else { Par::rayon(parts) };
            let mut x: Vec<f64> = (0..n).map(|i| (i as f64).sin()).collect();
            let before = processor();
            found[k].0.push(pool.install(|| run(par, MatMut::from_column_major_slice_mut(&mut x, n, 1))));
            found[k].1.push(processor() - before);
            if repeat == 0 {
                solutions.push(x);
            } else {
                assert!(solutions[k] == x, "{name}: the bits change from run to run");
            }
        }
    }
    for (k, (way, ..)) in WAYS.iter().enumerate() {
        let (times, processor) = &mut found[k];
        times.sort_by(f64::total_cmp);
        processor.sort_by(f64::total_cmp);
        let same = (0..k).find(|&other| solutions[other] == solutions[k]).map_or("its own", |other| WAYS[other].0);
        println!(
            "{name:5} {way:18} {:.3} {:.3} s, with solution {:.2} s of processors; bits: {same}",
            times[0],
            times[REPEATS / 2],
            processor[REPEATS / 2]
        );
    }
}

/// Processor time of all threads so far [s], in hundredths.
fn processor() -> f64 {
    let text = std::fs::read_to_string("/proc/self/stat").unwrap();
    let fields: Vec<&str> = text.rsplit(')').next().unwrap().split_whitespace().collect();
    (fields[11].parse::<f64>().unwrap() + fields[12].parse::<f64>().unwrap()) / 100.0
}

/// The nodes that share a cell with each node, itself among them, ascending.
fn neighbours() -> Vec<Vec<u32>> {
    let wide = 2 * SQUARES.0 + 1;
    let mut near = vec![Vec::new(); wide * (2 * SQUARES.1 + 1)];
    for (i, j) in (0..SQUARES.1).flat_map(|j| (0..SQUARES.0).map(move |i| (2 * i, 2 * j))) {
        let node = |a: usize, b: usize| ((j + b) * wide + i + a) as u32;
        for cell in [[(0, 0), (2, 0), (0, 2), (1, 0), (1, 1), (0, 1)], [(2, 2), (0, 2), (2, 0), (1, 2), (1, 1), (2, 1)]]
        {
            let cell = cell.map(|(a, b)| node(a, b));
            cell.iter().for_each(|&node| near[node as usize].extend(cell));
        }
    }
    for list in &mut near {
        list.sort_unstable();
        list.dedup();
    }
    near
}

/// The equations coupled with equation `j`.
fn rows(near: &[Vec<u32>], j: usize) -> impl Iterator<Item = usize> {
    near[j / 2].iter().flat_map(|&node| [2 * node as usize, 2 * node as usize + 1])
}

fn entry(near: &[Vec<u32>], i: usize, j: usize) -> f64 {
    let beside = |i: usize, j: usize| 0.4 + 0.3 * ((7 * i.min(j) + 3 * i.max(j)) % 11) as f64 / 11.0;
    if i == j { 0.01 + rows(near, j).filter(|&i| i != j).map(|i| beside(i, j)).sum::<f64>() } else { -beside(i, j) }
}

fn lower(near: &[Vec<u32>], saddle: bool) -> Columns {
    let mut matrix = Columns { column: vec![0], ..Columns::default() };
    for j in 0..2 * near.len() {
        for i in rows(near, j).filter(|&i| i >= j) {
            let turned = saddle && i == j && j % 10 == 9;
            matrix.row.push(i as u32);
            matrix.values.push(entry(near, i, j) * if turned { -1.0 } else { 1.0 });
        }
        matrix.column.push(matrix.row.len() as u32);
    }
    matrix
}

/// One in a hundred unsymmetric.
fn full(near: &[Vec<u32>]) -> Columns {
    let mut matrix = Columns { column: vec![0], ..Columns::default() };
    for j in 0..2 * near.len() {
        for i in rows(near, j) {
            matrix.row.push(i as u32);
            matrix.values.push(entry(near, i, j) * (1.0 + 0.01 * i.cmp(&j) as i32 as f64));
        }
        matrix.column.push(matrix.row.len() as u32);
    }
    matrix
}

/// The minimum-degree ordering of the nodes, written out for their equations, as `src/system/factor.rs` has it for a factor in one piece.
fn ordering(near: &[Vec<u32>]) -> Perm<u32> {
    let (mut column, mut row) = (vec![0], Vec::new());
    for (node, list) in near.iter().enumerate() {
        row.extend(list.iter().filter(|&&other| other as usize != node));
        column.push(row.len() as u32);
    }
    let nodes = near.len();
    let (mut forward, mut inverse) = (vec![0u32; nodes], vec![0u32; nodes]);
    let mut memory = MemBuffer::new(amd::order_maybe_unsorted_scratch::<u32>(nodes, row.len()));
    let graph = SymbolicSparseColMatRef::new_checked(nodes, nodes, &column, None, &row);
    amd::order_maybe_unsorted(&mut forward, &mut inverse, graph, Default::default(), MemStack::new(&mut memory))
        .unwrap();
    let equations: Vec<u32> = forward.iter().flat_map(|&node| [2 * node, 2 * node + 1]).collect();
    let mut back = vec![0; equations.len()];
    equations.iter().enumerate().for_each(|(new, &old)| back[old as usize] = new as u32);
    Perm::new_checked(equations.into_boxed_slice(), back.into_boxed_slice(), 2 * nodes)
}
