//! Local functions of a cell that reach beyond its own nodes.
//!
//! A scheme that smooths gradients forms them at a point from the cell's own nodes and from fields it has
//! averaged around the cell. The points see those as further local functions with a gradient and no value;
//! each is a fixed combination of nodes: `u_f = Σ_I T_fI u_I`, the same for every displacement component.

use super::support::MAX_FUNCTIONS;

/// The functions of each cell and the nodes they are made of.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Extension {
    /// Where the nodes of each cell begin in `node`; one more entry than cells.
    pub(super) node_start: Vec<u32>,
    /// The cell's own nodes, then the others.
    pub(super) node: Vec<u32>,
    /// Where the rows of each cell begin in `combination`; one more entry than cells.
    pub(super) row_start: Vec<u32>,
    /// `T`, row-major: a row for each function beyond the cell's own nodes, a column for each node.
    pub(super) combination: Vec<f64>,
    /// The same in factors, a tenth of the work: where the smoothing nodes of each cell begin in `share`, the weight
    /// of the cell in the mean at each of them, and likewise the gradients of its shape functions there, node by node.
    pub(super) share_start: Vec<u32>,
    pub(super) share: Vec<f64>,
    pub(super) gradient_start: Vec<u32>,
    pub(super) gradient: Vec<f64>,
    /// Nodes of the mesh.
    pub(super) node_count: usize,
}

impl Extension {
    /// The nodes a cell acts on, its own first.
    pub fn nodes(&self, cell: u32) -> &[u32] {
        &self.node[self.node_start[cell as usize] as usize..self.node_start[cell as usize + 1] as usize]
    }

    /// The rows of `T` of a cell, one for each function beyond its own nodes.
    pub fn rows(&self, cell: u32) -> &[f64] {
        &self.combination[self.row_start[cell as usize] as usize..self.row_start[cell as usize + 1] as usize]
    }

    /// Writes the coefficients of the functions of a cell with `own` nodes for a field on the nodes, where there are zeros.
    pub fn gather<const D: usize>(
        &self,
        cell: u32,
        own: usize,
        field: &[[f64; D]],
        local: &mut [[f64; D]; MAX_FUNCTIONS],
    ) {
        let nodes = self.nodes(cell);
        // Nothing has moved at the beginning of a step on a restored grid.
        if nodes.iter().all(|&n| field[n as usize] == [0.0; D]) {
            return;
        }
        for (local, &n) in local.iter_mut().zip(&nodes[..own]) {
            *local = field[n as usize];
        }
        // Four rows at once: the field is fetched a quarter as often, and the sums do not wait for each other.
        let count = nodes.len();
        for (local, rows) in local[own..].chunks_mut(4).zip(self.rows(cell).chunks(4 * count)) {
            if let ([l0, l1, l2, l3], true) = (&mut *local, rows.len() == 4 * count) {
                let (r0, rest) = rows.split_at(count);
                let (r1, rest) = rest.split_at(count);
                let (r2, r3) = rest.split_at(count);
                for ((((&n, t0), t1), t2), t3) in nodes.iter().zip(r0).zip(r1).zip(r2).zip(r3) {
                    let u = &field[n as usize];
                    for d in 0..D {
                        l0[d] += t0 * u[d];
                        l1[d] += t1 * u[d];
                        l2[d] += t2 * u[d];
                        l3[d] += t3 * u[d];
                    }
                }
                continue;
            }
            for (local, row) in local.iter_mut().zip(rows.chunks_exact(count)) {
                for (t, &n) in row.iter().zip(nodes) {
                    for (local, u) in local.iter_mut().zip(&field[n as usize]) {
                        *local += t * u;
                    }
                }
            }
        }
    }

    /// The gradients of a cell at its smoothing nodes for the values `own` of its nodes: for each of them, and each
    /// direction, the components.
    pub fn own_gradients<const D: usize>(&self, cell: u32, own: &[f64], gradients: &mut [f64]) {
        for (to, shapes) in gradients.chunks_exact_mut(D * D).zip(self.gradient(cell).chunks_exact(own.len())) {
            for (u, g) in own.chunks_exact(D).zip(shapes.chunks_exact(D)) {
                for j in 0..D {
                    for c in 0..D {
                        to[j * D + c] += u[c] * g[j];
                    }
                }
            }
        }
    }

    /// Writes the smoothed gradients at the nodes, from those of the cells with points.
    pub fn means<'a, const D: usize>(&self, gradients: impl Iterator<Item = (u32, &'a [f64])>, means: &mut Vec<f64>) {
        means.clear();
        means.resize(self.node_count * D * D, 0.0);
        for (cell, gradients) in gradients {
            let corners = self.nodes(cell).iter().zip(self.share(cell));
            for (from, (&n, share)) in gradients.chunks_exact(D * D).zip(corners) {
                let to = &mut means[n as usize * D * D..(n as usize + 1) * D * D];
                to.iter_mut().zip(from).for_each(|(to, from)| *to += share * from);
            }
        }
    }

    /// What a cell is to add to its gradients: `means` less its own ones, which are in `gradients`.
    pub fn less_own<const D: usize>(&self, cell: u32, means: &[f64], gradients: &mut [f64]) {
        for (own, &n) in gradients.chunks_exact_mut(D * D).zip(self.nodes(cell)) {
            own.iter_mut().zip(&means[n as usize * D * D..]).for_each(|(own, mean)| *own = mean - *own);
        }
    }

    /// Writes the sum at each node of the forces on its functions in all cells.
    pub fn sum<'a, const D: usize>(&self, forces: impl Iterator<Item = (u32, &'a [f64])>, sums: &mut Vec<f64>) {
        sums.clear();
        sums.resize(self.node_count * D * D, 0.0);
        for (cell, forces) in forces {
            for (from, &n) in forces.chunks_exact(D * D).zip(self.nodes(cell)) {
                let to = &mut sums[n as usize * D * D..(n as usize + 1) * D * D];
                to.iter_mut().zip(from).for_each(|(to, from)| *to += from);
            }
        }
    }

    /// Adds to the nodes of a cell what the functions of all cells exert on them through its gradients: `sums` at its
    /// share, less the `forces` on its own functions. The sum over the cells is `Tᵀ f`.
    pub fn pass_on<const D: usize>(&self, cell: u32, sums: &[f64], forces: &[f64], own: &mut [f64]) {
        let corners = self.nodes(cell).iter().zip(self.share(cell));
        let shapes = self.gradient(cell).chunks_exact(own.len());
        for ((force, (&n, share)), shapes) in forces.chunks_exact(D * D).zip(corners).zip(shapes) {
            let sum = &sums[n as usize * D * D..(n as usize + 1) * D * D];
            for (to, g) in own.chunks_exact_mut(D).zip(shapes.chunks_exact(D)) {
                for j in 0..D {
                    for c in 0..D {
                        to[c] += (share * sum[j * D + c] - force[j * D + c]) * g[j];
                    }
                }
            }
        }
    }

    /// The weights of a cell in the means at its smoothing nodes.
    fn share(&self, cell: u32) -> &[f64] {
        &self.share[self.share_start[cell as usize] as usize..self.share_start[cell as usize + 1] as usize]
    }

    /// The gradients of its shape functions there.
    fn gradient(&self, cell: u32) -> &[f64] {
        &self.gradient[self.gradient_start[cell as usize] as usize..self.gradient_start[cell as usize + 1] as usize]
    }
}
