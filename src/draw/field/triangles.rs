//! The cells of a grid as triangles, and their edges.

use crate::io::container::Data;
use crate::io::vtu::{Array, Grid};

/// Triangles in the plane, with a value at each corner.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Triangles {
    pub places: Vec<[[f64; 2]; 3]>,
    pub values: Vec<[f64; 3]>,
    pub region: Vec<u16>,
}

/// Where a node of a grid is (m).
pub fn place(grid: &Grid, i: i64) -> [f64; 2] {
    [grid.points[3 * i as usize], grid.points[3 * i as usize + 1]]
}

/// The corners of a cell by VTK's number of its kind, and the order of its nodes around it.
fn corners(kind: u8) -> &'static [usize] {
    match kind {
        5 => &[0, 1, 2],
        9 => &[0, 1, 2, 3],
        22 => &[0, 3, 1, 4, 2, 5],
        23 | 28 => &[0, 4, 1, 5, 2, 6, 3, 7],
        70 => &[0, 4, 5, 1, 6, 7, 2, 9, 8, 3, 11, 10],
        _ => &[],
    }
}

/// The regions of the cells of a grid.
fn regions(grid: &Grid) -> &[u16] {
    match grid.cell_data.iter().find(|a| a.name.starts_with("region ")) {
        Some(Array { data: Data::U16(regions), .. }) => regions,
        _ => &[],
    }
}

/// The cells of a grid with their nodes, kinds and regions.
fn cells(grid: &Grid) -> impl Iterator<Item = (&[i64], u8, u16)> {
    let begin = std::iter::once(0).chain(grid.topology.offsets.iter().copied());
    let nodes = begin.zip(&grid.topology.offsets).map(|(a, &b)| &grid.topology.connectivity[a as usize..b as usize]);
    nodes.zip(&grid.topology.types).zip(regions(grid)).map(|((nodes, kind), region)| (nodes, *kind, *region))
}

/// The cells of some regions as triangles, around their first corner, with values at the nodes.
pub fn triangles(grid: &Grid, values: &[f64], wanted: impl Fn(u16) -> bool) -> Triangles {
    let mut triangles = Triangles::default();
    for (nodes, kind, region) in cells(grid).filter(|(.., region)| wanted(*region)) {
        let order = corners(kind);
        for pair in order.windows(2).skip(1) {
            let corners = [nodes[order[0]], nodes[pair[0]], nodes[pair[1]]];
            triangles.places.push(corners.map(|n| place(grid, n)));
            triangles.values.push(corners.map(|n| values[n as usize]));
            triangles.region.push(region);
        }
    }
    triangles
}

/// The edges of the cells.
pub fn cell_edges(grid: &Grid) -> Vec<[[f64; 2]; 2]> {
    let mut ends = Vec::new();
    for (nodes, kind, _) in cells(grid) {
        let order = corners(kind);
        for (k, &i) in order.iter().enumerate() {
            let (a, b) = (nodes[i], nodes[order[(k + 1) % order.len()]]);
            ends.push([a.min(b), a.max(b)]);
        }
    }
    ends.sort_unstable();
    ends.dedup();
    ends.into_iter().map(|ends| ends.map(|n| place(grid, n))).collect()
}
