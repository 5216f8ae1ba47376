//! Structured meshes of a rectangle for tests and benches, which need no Gmsh: alternating diagonals or
//! quadrilaterals, straight edges, vertices moved off the lattice by a reproducible jitter.

use std::collections::BTreeMap;

use super::shape::CellKind;
use super::{Cells, Group, Mesh};

/// The rectangle `[0, lx] × [0, ly]` in `nx × ny` boxes of one quadrilateral or two triangles each.
///
/// `jitter` moves every interior vertex by up to that fraction of the spacing in each direction (0.2 keeps
/// the cells well shaped), the same way for the same `seed`. Nodes of sides lie at equal distances, so every
/// edge is straight. One region `soil`; curve groups `left`, `right`, `bottom` and `top`, each with its
/// facets ordered counter-clockwise around the rectangle.
///
/// # Panics
/// Where `kind` is not two-dimensional.
pub fn rectangle(kind: CellKind, lx: f64, ly: f64, nx: usize, ny: usize, jitter: f64, seed: u64) -> Mesh<2> {
    assert_eq!(kind.dimension(), 2, "a rectangle has plane cells");
    let mut random = seed;
    let mut nodes = Vec::with_capacity((nx + 1) * (ny + 1));
    for j in 0..=ny {
        for i in 0..=nx {
            let (dx, dy) = (jitter * signed_unit(&mut random), jitter * signed_unit(&mut random));
            let inside = i > 0 && i < nx && j > 0 && j < ny;
            let (dx, dy) = if inside { (dx, dy) } else { (0.0, 0.0) };
            nodes.push([lx * (i as f64 + dx) / nx as f64, ly * (j as f64 + dy) / ny as f64]);
        }
    }
    let mut mesh = Mesh { nodes, cells: Cells::default(), regions: vec!["soil".into()], groups: Vec::new() };
    let vertex = |i: usize, j: usize| (j * (nx + 1) + i) as u32;
    let mut middles = BTreeMap::new();
    for j in 0..ny {
        for i in 0..nx {
            let [a, b, c, d] = [vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1), vertex(i, j + 1)];
            if !kind.is_simplex() {
                add(&mut mesh, kind, &[a, b, c, d], &mut middles);
            } else if (i + j).is_multiple_of(2) {
                add(&mut mesh, kind, &[a, b, c], &mut middles);
                add(&mut mesh, kind, &[a, c, d], &mut middles);
            } else {
                add(&mut mesh, kind, &[a, b, d], &mut middles);
                add(&mut mesh, kind, &[b, c, d], &mut middles);
            }
        }
    }
    let sides: [(&str, Vec<u32>); 4] = [
        ("left", (0..=ny).rev().map(|j| vertex(0, j)).collect()),
        ("right", (0..=ny).map(|j| vertex(nx, j)).collect()),
        ("bottom", (0..=nx).map(|i| vertex(i, 0)).collect()),
        ("top", (0..=nx).rev().map(|i| vertex(i, ny)).collect()),
    ];
    let facet = kind.facets().0;
    mesh.groups = sides
        .into_iter()
        .map(|(name, line)| {
            let nodes = |pair: &[u32]| pair.iter().copied().chain(of_side(&middles, pair[0], pair[1])).collect();
            Group::of(name, 1, line.windows(2).map(|pair| (facet, nodes(pair))).collect())
        })
        .collect();
    mesh
}

/// The nodes within each side, by its ends with the lower number first, from there on.
type Sides = BTreeMap<(u32, u32), Vec<u32>>;

/// The nodes within a side, from `a` to `b`.
fn of_side(sides: &Sides, a: u32, b: u32) -> Vec<u32> {
    let mut within = sides.get(&(a.min(b), a.max(b))).cloned().unwrap_or_default();
    if a > b {
        within.reverse();
    }
    within
}

/// Appends a cell with straight edges over `corners`, making or reusing the nodes within its sides.
fn add(mesh: &mut Mesh<2>, kind: CellKind, corners: &[u32], sides: &mut Sides) {
    let mut cell = corners.to_vec();
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        let (low, high) = (a.min(b), a.max(b));
        let nodes = &mut mesh.nodes;
        sides.entry((low, high)).or_insert_with(|| {
            let (p, q) = (nodes[low as usize], nodes[high as usize]);
            let parts = kind.order() as f64;
            let place = |k: usize| [0, 1].map(|d| ((parts - k as f64) * p[d] + k as f64 * q[d]) / parts);
            let first = nodes.len() as u32;
            nodes.extend((1..kind.order()).map(place));
            (first..nodes.len() as u32).collect()
        });
        cell.extend(of_side(sides, a, b));
    }
    if kind == CellKind::Q9 {
        let centre = [0, 1].map(|d| 0.25 * corners.iter().map(|&n| mesh.nodes[n as usize][d]).sum::<f64>());
        cell.push(mesh.nodes.len() as u32);
        mesh.nodes.push(centre);
    }
    if kind == CellKind::Q16 {
        for i in 0..4 {
            let at = |k: usize, d: usize| mesh.nodes[corners[(i + k) % 4] as usize][d];
            let place = [0, 1].map(|d| (4.0 * at(0, d) + 2.0 * (at(1, d) + at(3, d)) + at(2, d)) / 9.0);
            cell.push(mesh.nodes.len() as u32);
            mesh.nodes.push(place);
        }
    }
    mesh.cells.push(kind, 0, &cell);
}

/// The next number in `[-1, 1)` of the SplitMix64 sequence (Steele, Lea & Flood 2014).
pub fn signed_unit(state: &mut u64) -> f64 {
    *state = state.wrapping_add(0x9E37_79B9_7F4A_7C15);
    let mut z = *state;
    z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
    ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::shape::{self, MAX_NODES};

    #[test]
    fn every_kind_covers_the_rectangle_and_names_its_sides() {
        for kind in CellKind::ALL.into_iter().filter(|k| k.dimension() == 2) {
            let mesh = rectangle(kind, 3.0, 2.0, 5, 4, 0.2, 7);
            let (mut n, mut grad, mut x) = ([0.0; MAX_NODES], [[0.0; 2]; MAX_NODES], Vec::new());
            let mut area = 0.0;
            for c in 0..mesh.cells.len() {
                mesh.cell_coordinates(c, &mut x);
                for (xi, w) in shape::rule(kind, 4) {
                    let det = shape::map(kind, &x, &xi, &mut n, &mut grad);
                    assert!(det > 0.0);
                    area += w * det;
                }
            }
            assert!((area - 6.0).abs() < 1e-13, "{kind:?} {area}");
            for (name, count, axis, value) in
                [("left", 4, 0, 0.0), ("right", 4, 0, 3.0), ("bottom", 5, 1, 0.0), ("top", 5, 1, 2.0)]
            {
                let group = mesh.group(name).unwrap();
                assert_eq!(group.facets.len(), count);
                assert_eq!(group.nodes.len(), kind.order() * count + 1);
                assert!(group.nodes.iter().all(|&n| mesh.nodes[n as usize][axis] == value));
            }
        }
    }
}
