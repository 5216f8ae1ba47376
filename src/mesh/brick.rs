//! Structured meshes of a brick for tests and benches, as [`super::builder`] has of a rectangle: tetrahedra or hexahedra with
//! straight edges, vertices moved off the lattice by a reproducible jitter.

use std::collections::BTreeMap;

use super::builder::signed_unit;
use super::faces::Faces;
use super::shape::CellKind;
use super::{Cells, Group, Mesh};

/// The tetrahedra of a box by its corners in the order of [`CellKind::H27`]: a path along three edges from corner 0 to the
/// opposite one each (Freudenthal 1942). Boxes side by side split the face between them alike.
const TETRAHEDRA: [[usize; 4]; 6] =
    [[0, 1, 2, 6], [0, 2, 3, 6], [0, 3, 7, 6], [0, 7, 4, 6], [0, 4, 5, 6], [0, 5, 1, 6]];

/// The brick `[0, size[0]] × [0, size[1]] × [0, size[2]]` in `count` boxes along each axis, of one hexahedron or six
/// tetrahedra each.
///
/// `jitter` moves every interior vertex by up to that fraction of the spacing in each direction (0.1 keeps the cells well
/// shaped), the same way for the same `seed`. The other nodes lie in the middle of edges, faces and cells. One region
/// `soil`; surface groups `left` and `right` (x), `front` and `back` (y), `bottom` and `top` (z).
///
/// # Panics
/// Where `kind` is not three-dimensional.
pub fn brick(kind: CellKind, size: [f64; 3], count: [usize; 3], jitter: f64, seed: u64) -> Mesh<3> {
    assert_eq!(kind.dimension(), 3, "a brick has solid cells");
    let mut random = seed;
    let vertices = count.map(|n| n + 1);
    let lattice = |n: usize| [n % vertices[0], n / vertices[0] % vertices[1], n / (vertices[0] * vertices[1])];
    let place = |n: usize| {
        let at = lattice(n);
        let moved = [(); 3].map(|()| jitter * signed_unit(&mut random));
        let inside = (0..3).all(|d| at[d] > 0 && at[d] < count[d]);
        [0, 1, 2].map(|d| size[d] * (at[d] as f64 + if inside { moved[d] } else { 0.0 }) / count[d] as f64)
    };
    let nodes = (0..vertices.iter().product()).map(place).collect();
    let mut mesh = Mesh { nodes, cells: Cells::default(), regions: vec!["soil".into()], groups: Vec::new() };
    let mut middles = BTreeMap::new();
    for n in (0..mesh.nodes.len()).filter(|&n| (0..3).all(|d| lattice(n)[d] < count[d])) {
        let [x, y] = [1, vertices[0]];
        let bottom = [n, n + x, n + x + y, n + y];
        let above = vertices[0] * vertices[1];
        let corners: Vec<u32> = bottom.into_iter().chain(bottom.map(|n| n + above)).map(|n| n as u32).collect();
        if kind.is_simplex() {
            TETRAHEDRA
                .iter()
                .for_each(|tetrahedron| add(&mut mesh, kind, &tetrahedron.map(|i| corners[i]), &mut middles));
        } else {
            add(&mut mesh, kind, &corners, &mut middles);
        }
    }
    mesh.groups = groups(&mesh, size);
    mesh
}

/// Appends a cell over `corners`, making or reusing the nodes between them.
fn add(mesh: &mut Mesh<3>, kind: CellKind, corners: &[u32], middles: &mut BTreeMap<Vec<u32>, u32>) {
    let places = kind.node_coordinates();
    let mut cell = corners.to_vec();
    for place in &places[corners.len()..] {
        // The corners of the edge, face or cell that it is the middle of: those with its coordinates where it has the
        // extreme ones; of a tetrahedron, the ends of its edge.
        let belongs = |corner: &[f64; 3]| {
            if kind.is_simplex() {
                let other = [0, 1, 2].map(|d| 2.0 * place[d] - corner[d]);
                places[..4].contains(&other)
            } else {
                (0..3).all(|d| place[d] == 0.0 || place[d] == corner[d])
            }
        };
        let around: Vec<u32> = corners.iter().zip(places).filter(|(_, x)| belongs(x)).map(|(&n, _)| n).collect();
        let mut key = around.clone();
        key.sort_unstable();
        let nodes = &mut mesh.nodes;
        cell.push(*middles.entry(key).or_insert_with(|| {
            nodes.push(middle(&around.iter().map(|&n| nodes[n as usize]).collect::<Vec<_>>()));
            nodes.len() as u32 - 1
        }));
    }
    mesh.cells.push(kind, 0, &cell);
}

/// The mean of points, by repeated averaging of pairs, which keeps equal coordinates exactly.
fn middle(places: &[[f64; 3]]) -> [f64; 3] {
    if let [place] = places {
        return *place;
    }
    let (a, b) = places.split_at(places.len() / 2);
    let [a, b] = [a, b].map(middle);
    [0, 1, 2].map(|d| 0.5 * (a[d] + b[d]))
}

/// The six sides.
fn groups(mesh: &Mesh<3>, size: [f64; 3]) -> Vec<Group> {
    let facets = |&(cell, side): &(u32, u8)| {
        let (kind, of_cell) = mesh.cells.kind[cell as usize].facets();
        let nodes = mesh.cells.nodes(cell as usize);
        (kind, of_cell[side as usize].iter().map(|&i| nodes[i]).collect::<Vec<u32>>())
    };
    let boundary: Vec<_> = Faces::of(mesh).boundary.iter().map(facets).collect();
    let side = |(name, axis, at): (&str, usize, f64)| {
        let lies = |n: &u32| mesh.nodes[*n as usize][axis] == at;
        Group::of(name, 2, boundary.iter().filter(|(_, nodes)| nodes.iter().all(lies)).cloned().collect())
    };
    let [x, y, z] = size;
    let sides =
        [("left", 0, 0.0), ("right", 0, x), ("front", 1, 0.0), ("back", 1, y), ("bottom", 2, 0.0), ("top", 2, z)];
    sides.map(side).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shape::{self, MAX_NODES};

    #[test]
    fn every_kind_fills_the_brick_and_names_its_sides() {
        for kind in CellKind::ALL.into_iter().filter(|k| k.dimension() == 3) {
            let (size, count) = ([3.0, 2.0, 1.0], [4, 3, 2]);
            let mesh = brick(kind, size, count, 0.1, 7);
            let (mut n, mut grad, mut x) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES], Vec::new());
            let mut volume = 0.0;
            for c in 0..mesh.cells.len() {
                mesh.cell_coordinates(c, &mut x);
                for (xi, w) in shape::rule(kind, 5) {
                    let determinant = shape::map(kind, &x, &xi, &mut n, &mut grad);
                    assert!(determinant > 0.0);
                    volume += w * determinant;
                }
            }
            assert!((volume - 6.0).abs() < 1e-13, "{kind:?} {volume}");
            let boxes: usize = count.iter().product();
            let each = if kind.is_simplex() { 2 } else { 1 };
            assert_eq!(mesh.cells.len(), boxes * if kind.is_simplex() { 6 } else { 1 });
            for (names, axis) in [(["left", "right"], 0), (["front", "back"], 1), (["bottom", "top"], 2)] {
                let across: [usize; 2] = [count[(axis + 1) % 3], count[(axis + 2) % 3]];
                for (name, at) in names.into_iter().zip([0.0, size[axis]]) {
                    let group = mesh.group(name).unwrap();
                    assert_eq!(group.facets.len(), each * across[0] * across[1]);
                    assert_eq!(group.nodes.len(), (2 * across[0] + 1) * (2 * across[1] + 1));
                    assert!(group.nodes.iter().all(|&n| mesh.nodes[n as usize][axis] == at));
                }
            }
        }
    }
}
