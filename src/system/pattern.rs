//! The sparsity pattern of a system assembled from couplings of blocks.

/// Lists of blocks: coupling `k` couples the blocks `blocks[offset[k]..offset[k + 1]]` with each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Connectivity {
    offset: Vec<u32>,
    blocks: Vec<u32>,
}

impl Default for Connectivity {
    fn default() -> Self {
        Self { offset: vec![0], blocks: Vec::new() }
    }
}

impl Connectivity {
    /// Appends a coupling of distinct blocks and returns its number.
    pub fn push(&mut self, blocks: impl IntoIterator<Item = u32>) -> u32 {
        self.blocks.extend(blocks);
        self.offset.push(self.blocks.len() as u32);
        self.offset.len() as u32 - 2
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
    /// Equations of the largest coupling.
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
        pattern.largest_coupling = (0..pattern.connectivity.len()).map(|k| pattern.coupling_size(k)).max().unwrap_or(0);
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
