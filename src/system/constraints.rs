//! Linear constraints: nodal values that are combinations of fewer control values (master–slave elimination, multi-point constraints).
//!
//! `u = E c`, with a row of `E` for each node. A term writes residual `r` and tangent `K` of a coupling in nodal values as it always does;
//! the system takes `Eᵀ r` and `Eᵀ K E`, so that its unknowns are the control values alone. Functions `N` of the nodes become the functions
//! `Eᵀ N` of the controls: with the right `E`, splines from the shape functions of the cells (extraction: Borden, Scott, Evans & Hughes 2011).
//!
//! A control has the number of a node, and a left inverse `P`, `P E = 1`, gives its value from nodal values. The value of the node of that
//! number is in general another one.

use std::cell::RefCell;

/// Lists of numbers with coefficients.
#[derive(Clone, Debug, PartialEq)]
pub struct Rows {
    start: Vec<u32>,
    entries: Vec<(u32, f64)>,
}

impl Default for Rows {
    fn default() -> Self {
        Self { start: vec![0], entries: Vec::new() }
    }
}

impl Rows {
    pub fn push(&mut self, entries: impl IntoIterator<Item = (u32, f64)>) {
        self.entries.extend(entries);
        self.start.push(self.entries.len() as u32);
    }

    pub fn len(&self) -> usize {
        self.start.len() - 1
    }

    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    pub fn row(&self, i: usize) -> &[(u32, f64)] {
        &self.entries[self.start[i] as usize..self.start[i + 1] as usize]
    }
}

/// Nodal values as combinations of control values.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearConstraints {
    nodes: Rows,
    controls: Rows,
}

impl LinearConstraints {
    /// The value of each node as a combination of control values (`E`), and the value of each control as one of nodal values (`P`), one row
    /// a node; empty in the latter where a node is no control. A node without constraints is a control of its own.
    ///
    /// # Panics
    /// Where there are not as many rows of one as of the other.
    pub fn new(nodes: Rows, controls: Rows) -> Self {
        assert_eq!(nodes.len(), controls.len(), "a row of both for each node");
        Self { nodes, controls }
    }

    /// These with further nodes, up to a number of them in all, that are controls of their own.
    pub fn extended(mut self, count: usize) -> Self {
        for n in self.nodes.len()..count {
            [&mut self.nodes, &mut self.controls].into_iter().for_each(|rows| rows.push([(n as u32, 1.0)]));
        }
        self
    }

    /// The controls of a node with their coefficients (-).
    pub fn of_node(&self, node: u32) -> &[(u32, f64)] {
        self.nodes.row(node as usize)
    }

    /// The nodes that give the value of a control, with their coefficients (-); none where the node is no control.
    pub fn of_control(&self, node: u32) -> &[(u32, f64)] {
        self.controls.row(node as usize)
    }

    /// The first of some nodes that controls among them do not move at all: a value given at these nodes would be lost there.
    pub fn unheld(&self, nodes: &[u32]) -> Option<u32> {
        let given: std::collections::BTreeSet<u32> = nodes.iter().copied().collect();
        nodes.iter().copied().find(|&n| self.of_node(n).iter().all(|(control, _)| !given.contains(control)))
    }
}

/// The nodes of couplings as combinations of the blocks of these.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Combinations {
    /// Where the rows of each coupling begin, and how many of its blocks they combine: its first ones. Later blocks follow the nodes as
    /// they are. A coupling without rows has its blocks for nodes.
    first: Vec<u32>,
    combined: Vec<u32>,
    /// For each node of a coupling, places in its list of blocks.
    rows: Rows,
}

/// Those of one coupling.
#[derive(Clone, Copy)]
pub(super) struct Combination<'a> {
    rows: &'a Rows,
    first: usize,
    /// How many nodes are combinations, and of how many blocks.
    pub nodes: usize,
    pub blocks: usize,
}

impl Combinations {
    /// Notes the rows of coupling `k`, whose first `combined` blocks they combine. Couplings before it without an entry have none.
    pub(super) fn push<R: IntoIterator<Item = (u32, f64)>>(
        &mut self,
        k: usize,
        combined: usize,
        rows: impl IntoIterator<Item = R>,
    ) {
        self.first.resize(k + 1, self.rows.len() as u32);
        self.combined.resize(k, 0);
        self.combined.push(combined as u32);
        rows.into_iter().for_each(|row| self.rows.push(row));
    }

    /// Those of coupling `k`; `None` where its blocks are its nodes.
    pub(super) fn of(&self, k: usize) -> Option<Combination<'_>> {
        let blocks = *self.combined.get(k)? as usize;
        let first = self.first[k] as usize;
        let end = self.first.get(k + 1).map_or(self.rows.len(), |&end| end as usize);
        (end > first).then_some(Combination { rows: &self.rows, first, nodes: end - first, blocks })
    }
}

impl<'a> Combination<'a> {
    pub(super) fn rows(self) -> impl Iterator<Item = &'a [(u32, f64)]> {
        (self.first..self.first + self.nodes).map(move |row| self.rows.row(row))
    }

    /// `out += Eᵀ local` for rows of `length` numbers, `width` of them a node or block; `rest` rows follow the nodes.
    fn add_to(self, local: &[f64], width: usize, length: usize, rest: usize, out: &mut [f64]) {
        let stride = width * length;
        for (from, row) in local.chunks_exact(stride).zip(self.rows()) {
            for &(block, coefficient) in row {
                let to = &mut out[block as usize * stride..][..stride];
                to.iter_mut().zip(from).for_each(|(to, from)| *to += coefficient * from);
            }
        }
        let (from, to) = (self.nodes * stride, self.blocks * stride);
        out[to..to + rest * length].copy_from_slice(&local[from..from + rest * length]);
    }

    /// Turns the vector and the row-major matrix of a coupling in nodal values into those in the values of its blocks, in place: `Eᵀ r` and
    /// `Eᵀ K E`. Nodes have `width` equations each, and `rest` equations follow them. The matrix may be absent.
    pub(super) fn reduce(self, width: usize, rest: usize, vector: &mut [f64], matrix: &mut [f64]) {
        let (local, reduced) = (self.nodes * width + rest, self.blocks * width + rest);
        SCRATCH.with_borrow_mut(|[sum, turned]| {
            if !vector.is_empty() {
                self.add_to(&vector[..local], width, 1, rest, zeros(sum, reduced));
                vector[..reduced].copy_from_slice(sum);
            }
            if matrix.is_empty() {
                return;
            }
            self.add_to(&matrix[..local * local], width, local, rest, zeros(sum, reduced * local));
            turned.clear();
            turned.extend((0..local * reduced).map(|i| sum[(i % reduced) * local + i / reduced]));
            self.add_to(turned, width, reduced, rest, zeros(sum, reduced * reduced));
            for (i, to) in matrix[..reduced * reduced].iter_mut().enumerate() {
                *to = sum[(i % reduced) * reduced + i / reduced];
            }
        });
    }
}

thread_local! {
    /// Memory of each thread that reductions use again and again.
    static SCRATCH: RefCell<[Vec<f64>; 2]> = const { RefCell::new([Vec::new(), Vec::new()]) };
}

/// A buffer of so many zeros.
fn zeros(buffer: &mut Vec<f64>, length: usize) -> &mut [f64] {
    buffer.clear();
    buffer.resize(length, 0.0);
    buffer
}
