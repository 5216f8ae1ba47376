//! The sparsity pattern of a system assembled from couplings of blocks.

use super::constraints::{Combination, Combinations};

/// Lists of blocks: coupling `k` couples the blocks `blocks[offset[k]..offset[k + 1]]` with each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Connectivity {
    offset: Vec<u32>,
    blocks: Vec<u32>,
    /// The nodes of the couplings where these are combinations of their blocks; empty without linear constraints.
    combinations: Combinations,
}

impl Default for Connectivity {
    fn default() -> Self {
        Self { offset: vec![0], blocks: Vec::new(), combinations: Combinations::default() }
    }
}

impl Connectivity {
    /// Appends a coupling of distinct blocks and returns its number.
    pub fn push(&mut self, blocks: impl IntoIterator<Item = u32>) -> u32 {
        self.blocks.extend(blocks);
        self.offset.push(self.blocks.len() as u32);
        self.offset.len() as u32 - 2
    }

    /// Appends a coupling of nodes that are combinations of blocks, each given by its blocks with their coefficients (-), and returns its
    /// number.
    pub fn push_combined<'a>(&mut self, nodes: impl IntoIterator<Item = &'a [(u32, f64)]>) -> u32 {
        let mut blocks: Vec<u32> = Vec::new();
        let mut place = |block: u32| {
            let found = blocks.iter().position(|&other| other == block);
            found.unwrap_or_else(|| {
                blocks.push(block);
                blocks.len() - 1
            }) as u32
        };
        let rows: Vec<Vec<(u32, f64)>> =
            nodes.into_iter().map(|row| row.iter().map(|&(block, by)| (place(block), by)).collect()).collect();
        self.combinations.push(self.len(), blocks.len(), rows);
        self.push(blocks)
    }

    /// Appends coupling `k` of another connectivity with further blocks behind its own.
    pub fn push_extended(&mut self, other: &Self, k: usize, further: impl IntoIterator<Item = u32>) -> u32 {
        if let Some(combination) = other.combinations.of(k) {
            let rows = combination.rows().map(|row| row.iter().copied());
            self.combinations.push(self.len(), combination.blocks, rows);
        }
        self.push(other.blocks(k).iter().copied().chain(further))
    }

    pub(super) fn combination(&self, k: usize) -> Option<Combination<'_>> {
        self.combinations.of(k)
    }

    pub fn len(&self) -> usize {
        self.offset.len() - 1
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The blocks of coupling `k`.
    pub fn blocks(&self, k: usize) -> &[u32] {
        &self.blocks[self.offset[k] as usize..self.offset[k + 1] as usize]
    }
}

/// A compressed-column pattern: the lower triangle where the system is symmetric, all of it otherwise.
pub struct Pattern {
    /// First equation of each block, and at the end the number of equations.
    pub start: Vec<u32>,
    pub connectivity: Connectivity,
    pub symmetric: bool,
    /// Compressed columns of the scalar matrix, rows ascending.
    pub column: Vec<u32>,
    pub row: Vec<u32>,
    /// Columns of the block graph, both triangles, with the diagonal: what the ordering works on.
    pub(super) graph_column: Vec<u32>,
    pub(super) graph_row: Vec<u32>,
    /// For each coupling and pair (a, b) of its blocks, row-major: the offset of block row `a` in the scalar
    /// columns of block `b`, counted from where the full diagonal block (symmetric) or the column begins.
    pub(super) offset: Vec<u32>,
    /// Where the pairs of each coupling begin in `offset`.
    pub(super) pairs: Vec<u32>,
    /// Equations of the largest coupling, over its nodes or its blocks.
    pub largest_coupling: usize,
}

impl Pattern {
    /// The pattern of `couplings` of blocks with `sizes[b]` equations each. Every block is coupled with itself.
    pub fn new(sizes: &[u8], connectivity: Connectivity, symmetric: bool) -> Self {
        let mut start = Vec::with_capacity(sizes.len() + 1);
        let mut equations = 0;
        for &size in sizes {
            start.push(equations);
            equations += u32::from(size);
        }
        start.push(equations);
        let (graph_column, graph_row) = block_graph(sizes.len(), &connectivity);
        let mut pattern = Self {
            start,
            connectivity,
            symmetric,
            column: vec![0],
            row: Vec::new(),
            graph_column,
            graph_row,
            offset: Vec::new(),
            pairs: vec![0],
            largest_coupling: 0,
        };
        pattern.largest_coupling = (0..pattern.connectivity.len()).map(|k| pattern.largest_size(k)).max().unwrap_or(0);
        pattern.expand();
        pattern.locate_pairs();
        pattern
    }

    /// Number of equations.
    pub fn len(&self) -> usize {
        self.column.len() - 1
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of equations of coupling `k`.
    pub fn coupling_size(&self, k: usize) -> usize {
        let size = |b: u32| self.start[b as usize + 1] - self.start[b as usize];
        self.connectivity.blocks(k).iter().map(|&b| size(b) as usize).sum()
    }

    /// Number of equations that a term writes for coupling `k`: those of its nodes, where linear constraints make them combinations of its
    /// blocks, else those of its blocks.
    pub fn local_size(&self, k: usize) -> usize {
        let size = self.coupling_size(k);
        self.connectivity.combination(k).map_or(size, |of| size + of.nodes * self.width(k) - of.blocks * self.width(k))
    }

    /// Number of equations that the results of coupling `k` need room for, as written and as reduced to its blocks.
    pub(super) fn largest_size(&self, k: usize) -> usize {
        self.coupling_size(k).max(self.local_size(k))
    }

    /// Equations of the first block of coupling `k`, and of all that are combined.
    fn width(&self, k: usize) -> usize {
        self.connectivity.blocks(k).first().map_or(0, |&b| self.start[b as usize + 1] - self.start[b as usize]) as usize
    }

    /// Turns what a term has written for coupling `k` into what its blocks have of it, in place; the matrix may be absent, or the vector.
    pub(super) fn reduce(&self, k: usize, vector: &mut [f64], matrix: &mut [f64]) {
        if let Some(of) = self.connectivity.combination(k) {
            let width = self.width(k);
            of.reduce(width, self.coupling_size(k) - of.blocks * width, vector, matrix);
        }
    }

    /// A row-major matrix over the first nodes of coupling `k` as one over its first blocks: over all that its nodes are combinations of,
    /// where there are linear constraints.
    pub fn over_blocks(&self, k: usize, mut matrix: Vec<f64>) -> Vec<f64> {
        if let Some(of) = self.connectivity.combination(k) {
            let width = self.width(k);
            let reduced = of.blocks * width;
            matrix.resize(matrix.len().max(reduced * reduced), 0.0);
            of.reduce(width, 0, &mut [], &mut matrix);
            matrix.truncate(reduced * reduced);
        }
        matrix
    }

    /// The blocks that block `b` is coupled with, ascending, itself among them.
    pub(super) fn neighbours(&self, b: usize) -> &[u32] {
        &self.graph_row[self.graph_column[b] as usize..self.graph_column[b + 1] as usize]
    }

    /// Writes the scalar columns.
    fn expand(&mut self) {
        for b in 0..self.start.len() - 1 {
            for j in self.start[b]..self.start[b + 1] {
                for k in self.graph_column[b]..self.graph_column[b + 1] {
                    let n = self.graph_row[k as usize] as usize;
                    let rows = self.start[n]..self.start[n + 1];
                    self.row.extend(rows.filter(|&i| !self.symmetric || i >= j));
                }
                self.column.push(self.row.len() as u32);
            }
        }
    }

    /// Finds where each pair of blocks of each coupling goes.
    fn locate_pairs(&mut self) {
        // position[n]: offset of block n in the columns of the block b at hand.
        let blocks = self.start.len() - 1;
        let mut by_block: Vec<Vec<(u32, u32)>> = vec![Vec::new(); blocks];
        for k in 0..self.connectivity.len() {
            let count = self.connectivity.blocks(k).len();
            for (slot, &b) in self.connectivity.blocks(k).iter().enumerate() {
                by_block[b as usize].push((k as u32, slot as u32));
            }
            self.pairs.push(self.pairs[k] + (count * count) as u32);
        }
        self.offset = vec![u32::MAX; self.pairs[self.connectivity.len()] as usize];
        let mut position = vec![0u32; blocks];
        for (b, uses) in by_block.iter().enumerate() {
            let mut next = 0;
            for &n in self.neighbours(b) {
                if !self.symmetric || n as usize >= b {
                    position[n as usize] = next;
                    next += self.start[n as usize + 1] - self.start[n as usize];
                }
            }
            for &(k, slot) in uses {
                let members = self.connectivity.blocks(k as usize);
                for (a, &n) in members.iter().enumerate() {
                    if !self.symmetric || n as usize >= b {
                        let pair = self.pairs[k as usize] as usize + a * members.len() + slot as usize;
                        self.offset[pair] = position[n as usize];
                    }
                }
            }
        }
    }
}

/// Compressed columns of the block graph: both triangles and the diagonal, rows ascending.
fn block_graph(blocks: usize, connectivity: &Connectivity) -> (Vec<u32>, Vec<u32>) {
    let mut of_block: Vec<Vec<u32>> = vec![Vec::new(); blocks];
    for k in 0..connectivity.len() {
        for &b in connectivity.blocks(k) {
            of_block[b as usize].push(k as u32);
        }
    }
    let (mut column, mut row) = (vec![0], Vec::new());
    let mut seen = vec![u32::MAX; blocks];
    for (b, own) in of_block.iter().enumerate() {
        let first = row.len();
        seen[b] = b as u32;
        row.push(b as u32);
        for &k in own {
            for &n in connectivity.blocks(k as usize) {
                if seen[n as usize] != b as u32 {
                    seen[n as usize] = b as u32;
                    row.push(n);
                }
            }
        }
        row[first..].sort_unstable();
        column.push(row.len() as u32);
    }
    (column, row)
}
