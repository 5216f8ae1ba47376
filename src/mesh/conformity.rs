//! That the cells of a plane mesh fit together: neighbours share whole edges, groups name edges of cells, and no cells
//! lie on one another.
//!
//! The cells must already be valid each by itself and counter-clockwise ([`super::quality`]). Where inner edges are
//! used once in each direction, cells can only lie on one another where a boundary edge lies on another cell: there
//! it is looked for, at the nodes of the boundary and the centres of its cells. Regions that share no edge may lie on
//! one another: a structure does on the grid.

use super::Mesh;
use super::locate::Locator;
use super::quality::place_of;
use super::shape::{CellKind, MAX_NODES};
use crate::error::{Error, Result};
use std::path::Path;

const REMEDY: &str = "mend the geometry there, or make the mesh again";

/// A node this deep in a cell (least barycentric coordinate, half the distance to a side of a square) is not on its
/// edge: curved edges that only touch differ by less.
const DEEP: f64 = 0.1;

/// An edge of a cell.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Edge {
    /// Its ends, ascending.
    ends: [u32; 2],
    cell: u32,
    side: u8,
    /// Whether the cell has the lower end first.
    ascending: bool,
    /// The node in its middle; [`NONE`] on an edge of first order.
    middle: u32,
}

const NONE: u32 = u32::MAX;

/// What a node is to its cells.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Role {
    Unused,
    Corner,
    /// In the middle of the edge between these.
    Middle([u32; 2]),
    Centre,
}

/// Checks `mesh`, read from `file`.
///
/// # Errors
/// Input: the first cells or groups that do not fit.
pub fn check(mesh: &Mesh<2>, file: &Path) -> Result<()> {
    check_roles(mesh, file)?;
    let edges = edges(mesh);
    let mut joined: Vec<u16> = (0..=u16::MAX).take(mesh.regions.len()).collect();
    let mut boundary = Vec::new();
    for same in edges.chunk_by(|a, b| a.ends == b.ends) {
        let wrong = |problem: &str| Error::input(place_of(mesh, same[0].cell as usize, file), problem, REMEDY);
        match same {
            [edge] => boundary.push(*edge),
            [a, b] if a.middle != b.middle => {
                return Err(wrong("it and its neighbour have different nodes on an edge"));
            }
            [a, b] if a.ascending == b.ascending => return Err(wrong("it and its neighbour lie on one another")),
            [a, b] => join(&mut joined, mesh.cells.region[a.cell as usize], mesh.cells.region[b.cell as usize]),
            _ => return Err(wrong("more than two cells share one of its edges")),
        }
    }
    check_groups(mesh, &edges, file)?;
    let joined: Vec<u16> = (0..joined.len()).map(|region| root(&mut joined, region as u16)).collect();
    check_overlap(mesh, &boundary, &joined, file)
}

/// A node is a corner of all its cells, or in the middle of one edge, or in the middle of one cell.
fn check_roles(mesh: &Mesh<2>, file: &Path) -> Result<()> {
    let mut roles = vec![Role::Unused; mesh.nodes.len()];
    for c in 0..mesh.cells.len() {
        let (kind, nodes) = (mesh.cells.kind[c], mesh.cells.nodes(c));
        let corners = kind.corner_count();
        for (i, &node) in nodes.iter().enumerate() {
            let role = match i {
                _ if i < corners => Role::Corner,
                _ if i < 2 * corners => Role::Middle(ascending(nodes[i - corners], nodes[(i - corners + 1) % corners])),
                _ => Role::Centre,
            };
            let known = &mut roles[node as usize];
            if *known != Role::Unused && (*known != role || role == Role::Centre) {
                let [x, y] = mesh.nodes[node as usize];
                let problem = format!("its node at ({x:.6}, {y:.6}) lies otherwise in another cell");
                return Err(Error::input(place_of(mesh, c, file), problem, REMEDY));
            }
            *known = role;
        }
    }
    Ok(())
}

/// The edges of all cells, those with the same ends together.
fn edges(mesh: &Mesh<2>) -> Vec<Edge> {
    let mut edges = Vec::new();
    for c in 0..mesh.cells.len() {
        let nodes = mesh.cells.nodes(c);
        for (side, facet) in mesh.cells.kind[c].facets().1.iter().enumerate() {
            let [a, b] = [nodes[facet[0]], nodes[facet[1]]];
            let middle = facet.get(2).map_or(NONE, |&i| nodes[i]);
            edges.push(Edge { ends: ascending(a, b), cell: c as u32, side: side as u8, ascending: a < b, middle });
        }
    }
    edges.sort_unstable();
    edges
}

/// Every facet of a curve is an edge of a cell, and no facet is in its group twice.
fn check_groups(mesh: &Mesh<2>, edges: &[Edge], file: &Path) -> Result<()> {
    let mut seen = Vec::new();
    for group in &mesh.groups {
        let wrong = |problem: &str| {
            let place = format!("{}, physical group {}", file.display(), group.name);
            Error::input(place, problem, REMEDY)
        };
        seen.clear();
        for (kind, nodes) in &group.facets {
            let key = match (kind, nodes.as_slice()) {
                (CellKind::Line2 | CellKind::Line3, &[a, b, ref middle @ ..]) => {
                    let ends = ascending(a, b);
                    let first = edges.partition_point(|edge| edge.ends < ends);
                    let middle = middle.first().copied().unwrap_or(NONE);
                    if edges.get(first).is_none_or(|edge| edge.ends != ends || edge.middle != middle) {
                        let [x, y] = mesh.nodes[a as usize];
                        return Err(wrong(&format!("its part at ({x:.6}, {y:.6}) is no edge of a cell")));
                    }
                    ends
                }
                (_, nodes) => [nodes.first().copied().unwrap_or(NONE), NONE],
            };
            seen.push(key);
        }
        seen.sort_unstable();
        if seen.windows(2).any(|pair| pair[0] == pair[1]) {
            return Err(wrong("it has a part twice"));
        }
    }
    Ok(())
}

/// No node of the `boundary` and no centre of a cell there lies deep in another cell of the same or a joined region.
fn check_overlap(mesh: &Mesh<2>, boundary: &[Edge], joined: &[u16], file: &Path) -> Result<()> {
    let part = |c: u32| joined[usize::from(mesh.cells.region[c as usize])];
    let locator = Locator::new(mesh);
    let mut n = [0.0; MAX_NODES];
    for edge in boundary {
        let (kind, nodes) = (mesh.cells.kind[edge.cell as usize], mesh.cells.nodes(edge.cell as usize));
        kind.values(&kind.centre(), &mut n);
        let centre = [0, 1].map(|d| nodes.iter().zip(&n).map(|(&node, n)| n * mesh.nodes[node as usize][d]).sum());
        let of_edge = kind.facets().1[usize::from(edge.side)].iter().map(|&i| mesh.nodes[nodes[i] as usize]);
        for x in of_edge.chain([centre]) {
            let mut holders = locator.holders(mesh, &x, DEEP).filter(|&c| c != edge.cell);
            if let Some(other) = holders.find(|&c| part(c) == part(edge.cell)) {
                let problem = format!(
                    "it lies on the cell of region {} that holds ({:.6}, {:.6})",
                    { &mesh.regions[usize::from(mesh.cells.region[other as usize])] },
                    x[0],
                    x[1]
                );
                return Err(Error::input(place_of(mesh, edge.cell as usize, file), problem, REMEDY));
            }
        }
    }
    Ok(())
}

fn ascending(a: u32, b: u32) -> [u32; 2] {
    [a.min(b), a.max(b)]
}

/// Notes in `joined` that two regions share an edge.
fn join(joined: &mut [u16], a: u16, b: u16) {
    let (a, b) = (root(joined, a), root(joined, b));
    joined[usize::from(a.max(b))] = a.min(b);
}

/// The lowest of the regions that `region` is joined to.
fn root(joined: &mut [u16], mut region: u16) -> u16 {
    while joined[usize::from(region)] != region {
        // Halves the way for the next who asks.
        joined[usize::from(region)] = joined[usize::from(joined[usize::from(region)])];
        region = joined[usize::from(region)];
    }
    region
}
