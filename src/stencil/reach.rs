//! Local functions of a cell that reach beyond its own nodes.
//!
//! A scheme that smooths gradients forms them at a point from the cell's own nodes and from fields it has
//! averaged around the cell. The points see those as further local functions with a gradient and no value;
//! each is a fixed combination of nodes: `u_f = Σ_I T_fI u_I`, the same for every displacement component.

use crate::mesh::shape::MAX_NODES;

/// The functions of each cell and the nodes they are made of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reach {
    /// Where the nodes of each cell begin in `node`; one more entry than cells.
    pub(super) node_start: Vec<u32>,
    /// The cell's own nodes, then the others.
    pub(super) node: Vec<u32>,
    /// Where the rows of each cell begin in `combination`; one more entry than cells.
    pub(super) row_start: Vec<u32>,
    /// `T`, row-major: a row for each function beyond the cell's own nodes, a column for each node.
    pub(super) combination: Vec<f64>,
}

impl Reach {
    /// The nodes a cell acts on, its own first.
    pub fn nodes(&self, cell: u32) -> &[u32] {
        &self.node[self.node_start[cell as usize] as usize..self.node_start[cell as usize + 1] as usize]
    }

    /// The rows of `T` of a cell: one for each function beyond its own nodes.
    pub fn rows(&self, cell: u32) -> std::slice::ChunksExact<'_, f64> {
        let range = self.row_start[cell as usize] as usize..self.row_start[cell as usize + 1] as usize;
        self.combination[range].chunks_exact(self.nodes(cell).len().max(1))
    }

    /// Coefficients of the functions of a cell with `own` nodes for a field on the nodes.
    pub fn gather<const D: usize>(&self, cell: u32, own: usize, field: &[[f64; D]]) -> [[f64; D]; MAX_NODES] {
        let mut local = [[0.0; D]; MAX_NODES];
        let nodes = self.nodes(cell);
        for (local, &n) in local.iter_mut().zip(&nodes[..own]) {
            *local = field[n as usize];
        }
        for (local, row) in local[own..].iter_mut().zip(self.rows(cell)) {
            for (t, &n) in row.iter().zip(nodes) {
                for (local, u) in local.iter_mut().zip(&field[n as usize]) {
                    *local += t * u;
                }
            }
        }
        local
    }

    /// Adds what is assembled over the functions of a cell with `own` nodes to the nodes: `Tᵀ f` and `Tᵀ k T`.
    ///
    /// `vector` and `matrix` (row-major, empty where not wanted) have `components` entries a function, and
    /// `extra` entries at the end that stand for themselves; so have `to_vector` and `to_matrix`, by nodes.
    #[expect(clippy::too_many_arguments, reason = "two systems and what maps one to the other")]
    pub fn expand(
        &self,
        cell: u32,
        own: usize,
        components: usize,
        extra: usize,
        vector: &[f64],
        matrix: &[f64],
        to_vector: &mut [f64],
        to_matrix: &mut [f64],
    ) {
        let nodes = self.nodes(cell).len();
        let rows: Vec<&[f64]> = self.rows(cell).collect();
        let (small, large) = ((own + rows.len()) * components + extra, nodes * components + extra);
        spread(own, nodes, components, extra, &rows, vector, 1, to_vector);
        if matrix.is_empty() {
            return;
        }
        // Rows first: `Tᵀ k`, then the columns of each row.
        let mut half = vec![0.0; large * small];
        spread(own, nodes, components, extra, &rows, matrix, small, &mut half);
        for (row, to) in half.chunks_exact(small).zip(to_matrix.chunks_exact_mut(large)) {
            spread(own, nodes, components, extra, &rows, row, 1, to);
        }
    }
}

/// Adds `Tᵀ a` to `to`; both have `width` numbers an equation.
#[expect(clippy::too_many_arguments, reason = "two lists and what maps one to the other")]
fn spread(
    own: usize,
    nodes: usize,
    components: usize,
    extra: usize,
    rows: &[&[f64]],
    a: &[f64],
    width: usize,
    to: &mut [f64],
) {
    let mut add = |from: usize, into: usize, t: f64| {
        let (source, target) = (&a[from * width..(from + 1) * width], &mut to[into * width..(into + 1) * width]);
        for (target, source) in target.iter_mut().zip(source) {
            *target += t * source;
        }
    };
    for e in 0..own * components {
        add(e, e, 1.0);
    }
    for (f, row) in rows.iter().enumerate() {
        for (n, &t) in row.iter().enumerate().filter(|(_, t)| **t != 0.0) {
            for c in 0..components {
                add((own + f) * components + c, n * components + c, t);
            }
        }
    }
    for e in 0..extra {
        add((own + rows.len()) * components + e, nodes * components + e, 1.0);
    }
}
