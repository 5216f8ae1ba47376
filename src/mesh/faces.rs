//! Which cells meet across which sides: the faces between cells and the sides on the boundary of the mesh.

use super::Mesh;

/// Marks a side on the boundary of the mesh where the number of a face or of a cell would stand.
pub const BOUNDARY: u32 = u32::MAX;

/// A face between two cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Face {
    /// The two cells, ascending.
    pub cells: [u32; 2],
    /// The number of the face among the facets of each of the two cells
    /// (in the order of [`CellKind::facets`](super::shape::CellKind::facets)).
    pub sides: [u8; 2],
}

impl Face {
    /// The nodes of both cells, each once: those of the first in its order, then what the second adds.
    pub fn nodes<'a, const D: usize>(&self, mesh: &'a Mesh<D>) -> impl Iterator<Item = u32> + 'a {
        let [first, second] = self.cells.map(|c| mesh.cells.nodes(c as usize));
        first.iter().chain(second.iter().filter(|n| !first.contains(n))).copied()
    }
}

/// The faces of a mesh, from its connectivity alone: they stay what they are when the nodes move.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Faces {
    /// The faces between two cells, ascending by their first cell and its side.
    pub inner: Vec<Face>,
    /// Cell and side of every facet that belongs to a single cell, ascending.
    pub boundary: Vec<(u32, u8)>,
    /// The sides of cell `c` are numbered `first_side[c]..first_side[c + 1]`.
    first_side: Vec<u32>,
    /// The cell across each side; [`BOUNDARY`] at the boundary.
    across: Vec<u32>,
    /// The cells of `across` without the boundary, and where those of each cell begin.
    neighbour: Vec<u32>,
    first_neighbour: Vec<u32>,
}

impl Faces {
    /// The faces of `mesh`. Two facets are one face where they have the same corner nodes.
    pub fn of<const D: usize>(mesh: &Mesh<D>) -> Self {
        let cells = mesh.cells.len();
        let mut faces = Self { first_side: vec![0], first_neighbour: vec![0], ..Self::default() };
        // Corner nodes (two of an edge, up to four of a face of a solid), cell and side.
        let mut facets: Vec<([u32; 4], u32, u8)> = Vec::new();
        for c in 0..cells {
            let nodes = mesh.cells.nodes(c);
            let (kind, of_cell) = mesh.cells.kind[c].facets();
            for (side, facet) in of_cell.iter().enumerate() {
                let mut corners = [u32::MAX; 4];
                for (corner, &i) in corners.iter_mut().zip(&facet[..kind.corner_count()]) {
                    *corner = nodes[i];
                }
                corners.sort_unstable();
                facets.push((corners, c as u32, side as u8));
            }
            faces.first_side.push(facets.len() as u32);
        }
        facets.sort_unstable();
        for same in facets.chunk_by(|a, b| a.0 == b.0) {
            match same {
                &[(_, a, i), (_, b, j)] => faces.inner.push(Face { cells: [a, b], sides: [i, j] }),
                // Cells that overlap have no face between them that anything could be passed through.
                _ => faces.boundary.extend(same.iter().map(|&(_, c, side)| (c, side))),
            }
        }
        faces.inner.sort_unstable_by_key(|face| (face.cells[0], face.sides[0]));
        faces.boundary.sort_unstable();
        faces.across = vec![BOUNDARY; facets.len()];
        for face in &faces.inner {
            for (own, other) in [(0, 1), (1, 0)] {
                let side = faces.first_side[face.cells[own] as usize] + u32::from(face.sides[own]);
                faces.across[side as usize] = face.cells[other];
            }
        }
        for c in 0..cells {
            let sides = faces.first_side[c] as usize..faces.first_side[c + 1] as usize;
            faces.neighbour.extend(faces.across[sides].iter().filter(|&&other| other != BOUNDARY));
            faces.first_neighbour.push(faces.neighbour.len() as u32);
        }
        faces
    }

    /// The cells across the faces of `cell`, in the order of its sides.
    pub fn neighbours(&self, cell: u32) -> &[u32] {
        &self.neighbour[self.first_neighbour[cell as usize] as usize..self.first_neighbour[cell as usize + 1] as usize]
    }

    /// The cell across each side of `cell`, one entry a side; [`BOUNDARY`] at the boundary.
    pub fn across(&self, cell: u32) -> &[u32] {
        &self.across[self.first_side[cell as usize] as usize..self.first_side[cell as usize + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::brick::brick;
    use crate::mesh::builder::rectangle;
    use crate::mesh::shape::CellKind;

    /// Euler: the edges of a plane mesh without holes are its vertices plus its cells less one.
    #[test]
    fn every_edge_of_a_rectangle_is_found_once() {
        for kind in CellKind::ALL.into_iter().filter(|k| k.dimension() == 2) {
            let (nx, ny) = (5, 4);
            let mesh = rectangle(kind, 3.0, 2.0, nx, ny, 0.2, 7);
            let faces = Faces::of(&mesh);
            assert_eq!(
                faces.inner.len() + faces.boundary.len(),
                (nx + 1) * (ny + 1) + mesh.cells.len() - 1,
                "{kind:?}"
            );
            assert_eq!(faces.boundary.len(), 2 * (nx + ny));
            let on_boundary = |&&(c, side): &&(u32, u8)| {
                let nodes = mesh.cells.nodes(c as usize);
                kind.facets().1[side as usize].iter().all(|&i| {
                    let [x, y] = mesh.nodes[nodes[i] as usize];
                    x == 0.0 || x == 3.0 || y == 0.0 || y == 2.0
                })
            };
            assert_eq!(faces.boundary.iter().filter(on_boundary).count(), faces.boundary.len());
        }
    }

    /// The faces of a brick, and those between cells with the same nodes on both sides, the other way round.
    #[test]
    fn every_face_of_a_brick_is_found_once() {
        for kind in CellKind::ALL.into_iter().filter(|k| k.dimension() == 3) {
            let mesh = brick(kind, [3.0, 2.0, 1.0], [4, 3, 2], 0.1, 7);
            let faces = Faces::of(&mesh);
            let boundary = if kind.is_simplex() { 2 * 52 } else { 52 };
            assert_eq!(faces.boundary.len(), boundary);
            assert_eq!(2 * faces.inner.len() + boundary, mesh.cells.len() * kind.facets().1.len());
            for face in &faces.inner {
                let [own, other] = [0, 1].map(|i| {
                    let of_cell = mesh.cells.nodes(face.cells[i] as usize);
                    kind.facets().1[face.sides[i] as usize].iter().map(|&k| of_cell[k]).collect::<Vec<_>>()
                });
                let corners = kind.facets().0.corner_count();
                let turned: Vec<u32> = other[..corners].iter().rev().copied().collect();
                let same = (0..corners).any(|by| (0..corners).all(|k| own[k] == turned[(k + by) % corners]));
                assert!(same, "{kind:?}: {own:?} {other:?}");
                let sorted = |mut nodes: Vec<u32>| {
                    nodes.sort_unstable();
                    nodes
                };
                assert_eq!(sorted(own), sorted(other), "{kind:?}");
                for (i, j) in [(0, 1), (1, 0)] {
                    assert_eq!(faces.across(face.cells[i])[face.sides[i] as usize], face.cells[j]);
                }
            }
        }
    }

    /// Both cells hold all nodes of their face, the second one in the opposite order.
    #[test]
    fn the_two_sides_of_a_face_have_the_same_nodes() {
        for kind in CellKind::ALL.into_iter().filter(|k| k.dimension() == 2) {
            let mesh = rectangle(kind, 3.0, 2.0, 5, 4, 0.2, 7);
            let faces = Faces::of(&mesh);
            for face in &faces.inner {
                let nodes = |i: usize| {
                    let of_cell = mesh.cells.nodes(face.cells[i] as usize);
                    kind.facets().1[face.sides[i] as usize].iter().map(|&k| of_cell[k]).collect::<Vec<_>>()
                };
                let (own, mut other) = (nodes(0), nodes(1));
                let (ends, within) = other.split_at_mut(2);
                ends.reverse();
                within.reverse();
                assert_eq!(own, other, "{kind:?}");
                assert!(face.cells[0] < face.cells[1]);
                for (i, j) in [(0, 1), (1, 0)] {
                    let (cell, side) = (face.cells[i], face.sides[i] as usize);
                    assert_eq!(faces.across(cell)[side], face.cells[j]);
                    assert!(faces.neighbours(cell).contains(&face.cells[j]));
                }
            }
            for &(cell, side) in &faces.boundary {
                assert_eq!(faces.across(cell)[side as usize], BOUNDARY);
            }
            let neighbours: usize = (0..mesh.cells.len()).map(|c| faces.neighbours(c as u32).len()).sum();
            assert_eq!(neighbours, 2 * faces.inner.len());
        }
    }
}
