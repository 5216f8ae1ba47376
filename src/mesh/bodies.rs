//! Which cells of a set hang together.

use super::Mesh;

/// Bodies: the parts of a set of cells of which none shares a node with another.
pub struct Bodies<'a, const D: usize> {
    mesh: &'a Mesh<D>,
    without: &'a [u32],
    /// By node; `u32::MAX` for nodes of no cell of the set.
    of_node: Vec<u32>,
    count: usize,
}

impl<'a, const D: usize> Bodies<'a, D> {
    /// Those of `cells`, which may be named more than once, but for the cells in `without`, ascending.
    pub fn of(mesh: &'a Mesh<D>, cells: impl Iterator<Item = u32>, without: &'a [u32]) -> Self {
        let mut parent: Vec<u32> = vec![u32::MAX; mesh.nodes.len()];
        let mut last = u32::MAX;
        for c in cells {
            if c == std::mem::replace(&mut last, c) || without.binary_search(&c).is_ok() {
                continue;
            }
            let nodes = mesh.cells.nodes(c as usize);
            for &n in nodes {
                if parent[n as usize] == u32::MAX {
                    parent[n as usize] = n;
                }
                let (root, other) = (root(&mut parent, nodes[0]), root(&mut parent, n));
                parent[other as usize] = root;
            }
        }
        let mut of_node = vec![u32::MAX; mesh.nodes.len()];
        let mut count = 0;
        for n in 0..of_node.len() {
            if parent[n] != u32::MAX {
                let root = root(&mut parent, n as u32) as usize;
                if of_node[root] == u32::MAX {
                    of_node[root] = count;
                    count += 1;
                }
                of_node[n] = of_node[root];
            }
        }
        Self { mesh, without, of_node, count: count as usize }
    }

    /// How many there are.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The number of the body of a node, if it is of one.
    pub fn of_node(&self, n: usize) -> Option<usize> {
        (self.of_node[n] != u32::MAX).then(|| self.of_node[n] as usize)
    }

    /// The number of the body of a cell; none for those that are left out.
    pub fn of_cell(&self, cell: u32) -> Option<usize> {
        let node = self.mesh.cells.nodes(cell as usize)[0] as usize;
        self.without.binary_search(&cell).is_err().then(|| self.of_node(node)).flatten()
    }
}

/// The root of `n` where each number leads to another of the same set or, a root, to itself; shortens the way there.
pub fn root(parent: &mut [u32], mut n: u32) -> u32 {
    while parent[n as usize] != n {
        let above = parent[n as usize];
        parent[n as usize] = parent[above as usize];
        n = above;
    }
    n
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::builder::rectangle;
    use crate::mesh::shape::CellKind;

    #[test]
    fn cells_that_share_a_node_are_one_body() {
        // Columns of cells 0 … 4; the cell at (i, j) is number 5 j + i.
        let mesh = rectangle(CellKind::Q9, 5.0, 3.0, 5, 3, 0.0, 1);
        for (cells, bodies) in [
            (&[0u32, 1, 5][..], &[0usize, 0, 0][..]),
            (&[0, 6, 12], &[0, 0, 0]),
            (&[4, 0, 9, 5, 0], &[1, 0, 1, 0, 0]),
            (&[0, 2, 4, 1], &[0, 0, 1, 0]),
        ] {
            let found = Bodies::of(&mesh, cells.iter().copied(), &[]);
            let same =
                |i: usize, j: usize| (found.of_cell(cells[i]) == found.of_cell(cells[j])) == (bodies[i] == bodies[j]);
            assert!((0..cells.len()).all(|i| (0..cells.len()).all(|j| same(i, j))), "{cells:?}");
            assert_eq!(found.count(), 1 + bodies.iter().max().unwrap());
        }
        let parted = Bodies::of(&mesh, 0..5, &[2]);
        assert_eq!((parted.count(), parted.of_cell(2)), (2, None));
        assert!(parted.of_cell(1).is_some() && parted.of_cell(1) != parted.of_cell(3));
        assert_eq!(Bodies::of(&mesh, std::iter::empty(), &[]).count(), 0);
    }
}
