//! That the cells of a plane mesh fit together: neighbours share whole edges, groups name edges of cells, and no cells
//! lie on one another.
//!
//! The cells must already be valid each by itself and counter-clockwise ([`super::quality`]). Where inner edges are
//! used once in each direction, cells can only lie on one another where a boundary edge lies on another cell: there
//! it is looked for, at the nodes of the boundary and the centres of its cells. Regions that share no edge may lie on
//! one another: a structure does on the grid.

use super::Mesh;
use super::bodies::root;
use super::locate::Locator;
use super::shape::{CellKind, MAX_NODES};
use crate::error::{Error, Result};
use std::path::Path;

const REMEDY: &str = "mend the geometry there, or make the mesh again";

/// An edge of a cell.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Edge {
    /// Its ends, ascending.
    ends: [u32; 2],
    cell: u32,
    side: u8,
    /// Whether the cell has the lower end first.
    ascending: bool,
    /// The nodes within it, from the lower end on; [`NONE`] where there are fewer.
    within: [u32; 2],
}

const NONE: u32 = u32::MAX;

/// What a node is to its cells.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Role {
    Unused,
    Corner,
    /// Within the edge between these, in this place from the lower one on.
    Within([u32; 2], usize),
    Centre,
}

/// Checks `mesh`, read from `file`.
///
/// # Errors
/// Input: the first cells or groups that do not fit.
pub fn check(mesh: &Mesh<2>, file: &Path) -> Result<()> {
    check_roles(mesh, file)?;
    let edges = edges(mesh);
    let mut joined: Vec<u32> = (0..mesh.regions.len() as u32).collect();
    let mut boundary = Vec::new();
    for same in edges.chunk_by(|a, b| a.ends == b.ends) {
        let wrong = |problem: &str| Error::input(place_of(mesh, same[0].cell as usize, file), problem, REMEDY);
        match same {
            [edge] => boundary.push(*edge),
            [a, b] if a.within != b.within => {
                return Err(wrong("it and its neighbour have different nodes on an edge"));
            }
            [a, b] if a.ascending == b.ascending => {
                let region = &mesh.regions[usize::from(mesh.cells.region[b.cell as usize])];
                return Err(wrong(&format!("it and its neighbour of region {region} lie on one another")));
            }
            [a, b] => join(&mut joined, [a, b].map(|edge| mesh.cells.region[edge.cell as usize])),
            _ => return Err(wrong("more than two cells share one of its edges")),
        }
    }
    check_groups(mesh, &edges, file)?;
    let joined: Vec<u32> = (0..joined.len() as u32).map(|region| root(&mut joined, region)).collect();
    check_overlap(mesh, &boundary, &joined, file)
}

/// A node is a corner of all its cells, or in one place within one edge, or within one cell.
fn check_roles(mesh: &Mesh<2>, file: &Path) -> Result<()> {
    let mut roles = vec![Role::Unused; mesh.nodes.len()];
    for c in 0..mesh.cells.len() {
        let (kind, nodes) = (mesh.cells.kind[c], mesh.cells.nodes(c));
        let corners = kind.corner_count();
        for (i, &node) in nodes.iter().enumerate() {
            let role = match i {
                _ if i < corners => Role::Corner,
                _ if i < kind.order() * corners => {
                    let (side, place) = ((i - corners) / (kind.order() - 1), (i - corners) % (kind.order() - 1));
                    let [a, b] = [nodes[side], nodes[(side + 1) % corners]];
                    Role::Within(ascending(a, b), if a < b { place } else { kind.order() - 2 - place })
                }
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
            let within = within(a < b, facet[2..].iter().map(|&i| nodes[i]));
            edges.push(Edge { ends: ascending(a, b), cell: c as u32, side: side as u8, ascending: a < b, within });
        }
    }
    edges.sort_unstable();
    edges
}

/// The nodes within an edge from its lower end on, given those from its first end on, and whether that is the lower one.
fn within(ascending: bool, nodes: impl Iterator<Item = u32>) -> [u32; 2] {
    let mut within = [NONE; 2];
    let count = within.iter_mut().zip(nodes).map(|(within, node)| *within = node).count();
    if !ascending {
        within[..count].reverse();
    }
    within
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
                (CellKind::Line2 | CellKind::Line3 | CellKind::Line4, &[a, b, ref middle @ ..]) => {
                    let ends = ascending(a, b);
                    let first = edges.partition_point(|edge| edge.ends < ends);
                    let within = within(a < b, middle.iter().copied());
                    if edges.get(first).is_none_or(|edge| edge.ends != ends || edge.within != within) {
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
fn check_overlap(mesh: &Mesh<2>, boundary: &[Edge], joined: &[u32], file: &Path) -> Result<()> {
    let part = |c: u32| joined[usize::from(mesh.cells.region[c as usize])];
    let locator = Locator::new(mesh);
    let mut n = [0.0; MAX_NODES];
    for edge in boundary {
        let (kind, nodes) = (mesh.cells.kind[edge.cell as usize], mesh.cells.nodes(edge.cell as usize));
        kind.values(&kind.centre(), &mut n);
        let centre = [0, 1].map(|d| nodes.iter().zip(&n).map(|(&node, n)| n * mesh.nodes[node as usize][d]).sum());
        let of_edge = kind.facets().1[usize::from(edge.side)].iter().map(|&i| mesh.nodes[nodes[i] as usize]);
        for x in of_edge.chain([centre]) {
            let mut holders = locator.holders(mesh, &x).filter(|&c| c != edge.cell);
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
fn join(joined: &mut [u32], regions: [u16; 2]) {
    let [a, b] = regions.map(|region| root(joined, u32::from(region)));
    joined[a.max(b) as usize] = a.min(b);
}

/// The name of cell `c` in a message.
pub fn place_of(mesh: &Mesh<2>, c: usize, file: &Path) -> String {
    let (region, [x, y]) = (&mesh.regions[usize::from(mesh.cells.region[c])], mesh.centre(c));
    format!("{}, cell {c} of region {region} near ({x:.6}, {y:.6})", file.display())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::builder::rectangle;
    use crate::mesh::{Group, quality};

    const KINDS: [CellKind; 6] = [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q8, CellKind::Q9, CellKind::Q16];

    fn refused(mesh: &Mesh<2>) -> String {
        check(mesh, Path::new("out/mesh.msh")).unwrap_err().to_string()
    }

    /// Adds the cells of another mesh, moved, with nodes of their own and in `region`.
    fn add(mesh: &mut Mesh<2>, other: &Mesh<2>, by: [f64; 2], region: u16) {
        let first = mesh.nodes.len() as u32;
        mesh.nodes.extend(other.nodes.iter().map(|x| [x[0] + by[0], x[1] + by[1]]));
        for c in 0..other.cells.len() {
            let nodes: Vec<u32> = other.cells.nodes(c).iter().map(|n| n + first).collect();
            mesh.cells.push(other.cells.kind[c], region, &nodes);
        }
    }

    #[test]
    fn a_region_must_not_lie_on_itself_nor_on_one_it_is_joined_to() {
        for kind in KINDS {
            let part = rectangle(kind, 3.0, 2.0, 6, 4, 0.1, 3);
            let file = Path::new("mesh.msh");
            for (by, apart) in [
                ([3.0, 0.0], true),
                ([2.0, 3.0], true),
                ([0.0, 0.0], false),
                ([2.7, 0.0], false),
                ([2.7, 1.8], false),
                ([-0.3, -0.9], false),
            ] {
                let mut mesh = part.clone();
                mesh.regions.push("pile".into());
                add(&mut mesh, &part, by, 0);
                assert_eq!(quality::check(&mesh, file).is_ok(), apart, "{kind:?} {by:?}");
                // A structure may lie on the grid, unless the two share an edge.
                mesh.cells.region[part.cells.len()..].fill(1);
                assert!(quality::check(&mesh, file).is_ok(), "{kind:?} {by:?}");
                mesh.cells.region[0] = 1;
                assert_eq!(quality::check(&mesh, file).is_ok(), apart, "{kind:?} {by:?}");
            }
            // One much larger than the other, and wholly inside it.
            let mut mesh = rectangle(kind, 30.0, 20.0, 2, 1, 0.0, 0);
            add(&mut mesh, &part, [4.0, 5.0], 0);
            assert!(refused(&mesh).contains("lies on"), "{kind:?}");
        }
    }

    #[test]
    fn edges_that_do_not_fit_are_refused() {
        for kind in KINDS {
            let whole = rectangle(kind, 3.0, 2.0, 3, 2, 0.0, 0);
            check(&whole, Path::new("mesh.msh")).unwrap();
            // The same cell again.
            let mut mesh = whole.clone();
            let nodes = whole.cells.nodes(0).to_vec();
            mesh.cells.push(kind, 0, &nodes);
            let message = refused(&mesh);
            assert!(message.starts_with("out/mesh.msh, cell ") && message.contains(REMEDY), "{message}");
            // A cell on the inner side of the boundary: two cells use an edge in the same direction.
            if kind.order() == 1 {
                let mut mesh = whole.clone();
                mesh.nodes.push([0.5, 0.1]);
                mesh.cells.push(CellKind::T3, 0, &[0, 1, mesh.nodes.len() as u32 - 1]);
                assert!(refused(&mesh).contains("lie on one another"));
                // The third cell at an inner edge.
                let mut mesh = whole.clone();
                mesh.nodes.push([9.0, 1.0]);
                mesh.cells.push(CellKind::T3, 0, &[1, 5, mesh.nodes.len() as u32 - 1]);
                assert!(refused(&mesh).contains("more than two cells"), "{}", refused(&mesh));
                continue;
            }
            // The jump of a derivative over such a face looked for a node that the second cell does not have.
            let mut mesh = whole.clone();
            let [c, i] = (0..whole.cells.len())
                .flat_map(|c| (0..whole.cells.nodes(c).len()).map(move |i| [c, i]))
                .find(|&[c, i]| {
                    let node = whole.cells.nodes(c)[i];
                    i >= kind.corner_count() && whole.cells.nodes.iter().filter(|&&n| n == node).count() == 2
                })
                .unwrap();
            let at = mesh.cells.offset[c] as usize + i;
            mesh.nodes.push(mesh.nodes[mesh.cells.nodes[at] as usize]);
            mesh.cells.nodes[at] = mesh.nodes.len() as u32 - 1;
            assert!(refused(&mesh).contains("different nodes on an edge"), "{kind:?}");
            // A corner as a middle node, and a middle node of two edges.
            for other in [mesh.cells.nodes[0], mesh.cells.nodes[kind.corner_count()]] {
                let mut mesh = whole.clone();
                mesh.cells.nodes[at] = other;
                assert!(refused(&mesh).contains("lies otherwise in another cell"), "{kind:?}");
            }
        }
    }

    #[test]
    fn groups_name_edges_of_cells_once() {
        for kind in KINDS {
            let whole = rectangle(kind, 3.0, 2.0, 3, 2, 0.0, 0);
            let mut mesh = whole.clone();
            let again = mesh.groups[2].facets[0].clone();
            mesh.groups[2].facets.push(again);
            assert!(refused(&mesh).contains("out/mesh.msh, physical group bottom: it has a part twice"));
            let mut mesh = whole.clone();
            mesh.groups[2].facets[0].1[1] = 2;
            assert!(refused(&mesh).contains("is no edge of a cell"), "{kind:?}");
            let point =
                |nodes: &[u32]| Group::of("corner", 0, nodes.iter().map(|&n| (CellKind::Point1, vec![n])).collect());
            let mut mesh = whole.clone();
            mesh.groups.push(point(&[0, 1]));
            check(&mesh, Path::new("mesh.msh")).unwrap();
            mesh.groups.push(point(&[1, 1]));
            assert!(refused(&mesh).contains("group corner: it has a part twice"));
        }
    }

    /// A node in the wrong place is a cell of no shape, wherever it lies.
    #[test]
    fn a_node_far_from_its_mesh_is_refused() {
        for kind in KINDS {
            let whole = rectangle(kind, 3.0, 2.0, 3, 2, 0.0, 0);
            for node in 0..whole.nodes.len() {
                for x in [[4e9, 0.0], [4e9, 4e9], [-4e9, 1.0], [1.0, -4e9], [1e300, 0.0], [0.0, -1e160]] {
                    let mut mesh = whole.clone();
                    mesh.nodes[node] = x;
                    assert!(quality::check(&mesh, Path::new("mesh.msh")).is_err(), "{kind:?} node {node} at {x:?}");
                }
            }
        }
    }
}
