//! The nodes that the points of a cell act on, where these are not those of the cell alone.

use crate::mesh::Mesh;
use crate::mesh::shape::MAX_NODES;

/// Most local functions of a cell: the nodes that its points act on, and what else a scheme forms gradients with.
pub const MAX_FUNCTIONS: usize = 64;

/// Whether so many local functions of a cell are those of other cells, too: each of its points then sees a part of them only.
pub fn reach_beyond_cells(functions: usize) -> bool {
    functions > MAX_NODES
}

/// A list of nodes for each cell that takes part.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Support {
    /// Where the nodes of each cell begin in `node`; one more entry than cells.
    start: Vec<u32>,
    /// The nodes of the cell itself, in its order, then the others.
    node: Vec<u32>,
}

impl Support {
    /// The nodes of each cell in `active` and, behind them, those that `others` gives for it, each node once. A cell that does not take
    /// part has none.
    pub fn new<const D: usize>(mesh: &Mesh<D>, active: &[bool], others: impl Fn(usize, &mut Vec<u32>)) -> Self {
        let mut support = Self { start: vec![0], node: Vec::new() };
        let (mut last, mut found) = (vec![u32::MAX; mesh.nodes.len()], Vec::new());
        for c in 0..mesh.cells.len() {
            if active[c] {
                found.clear();
                others(c, &mut found);
                for &n in mesh.cells.nodes(c).iter().chain(&found) {
                    if std::mem::replace(&mut last[n as usize], c as u32) != c as u32 {
                        support.node.push(n);
                    }
                }
            }
            support.start.push(support.node.len() as u32);
        }
        support
    }

    /// As [`Support::new`], where the others are the nodes of the cells in `active` that share a node with the cell.
    pub fn with_neighbours<const D: usize>(mesh: &Mesh<D>, active: &[bool]) -> Self {
        let around = mesh.cells_at_nodes(|c| active[c]);
        Self::new(mesh, active, |c, nodes| {
            let neighbours = mesh.cells.nodes(c).iter().flat_map(|&n| &around[n as usize]);
            nodes.extend(neighbours.flat_map(|&other| mesh.cells.nodes(other as usize)));
        })
    }

    /// Those of a cell.
    pub fn nodes(&self, cell: u32) -> &[u32] {
        &self.node[self.start[cell as usize] as usize..self.start[cell as usize + 1] as usize]
    }
}
