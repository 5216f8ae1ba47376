//! The mesh: nodes, cells of any mixture of kinds, and the named groups of the `.geo`.

pub mod abaqus;
pub mod bodies;
pub mod brick;
pub mod builder;
pub mod conformity;
pub mod faces;
pub mod given;
pub mod gmsh;
pub mod locate;
pub mod msh;
pub mod quality;
pub mod sections;
pub mod shape;
pub mod side;
pub mod strip;

pub use bodies::Bodies;

use crate::geometry::box_around;
use shape::{CellKind, MAX_NODES};

/// A mesh in `D` dimensions. Lengths in m.
#[derive(Clone, Debug, Default)]
pub struct Mesh<const D: usize> {
    /// Node coordinates (m).
    pub nodes: Vec<[f64; D]>,
    /// Cells of dimension `D`, each in exactly one region.
    pub cells: Cells,
    /// Names of the physical groups of dimension `D`; `cells.region` points here.
    pub regions: Vec<String>,
    /// Named groups of lower dimension: curves (and surfaces in 3D), and points.
    pub groups: Vec<Group>,
}

/// Cells in flat arrays; cell `c` has the nodes `nodes[offset[c]..offset[c + 1]]` in Gmsh's order.
#[derive(Clone, Debug)]
pub struct Cells {
    pub kind: Vec<CellKind>,
    /// Index into [`Mesh::regions`].
    pub region: Vec<u16>,
    pub offset: Vec<u32>,
    pub nodes: Vec<u32>,
}

/// A named physical curve, surface (3D) or point: its facets and the nodes on it.
#[derive(Clone, Debug)]
pub struct Group {
    pub name: String,
    /// 0 for a point, 1 for a curve, 2 for a surface bounding a solid.
    pub dimension: usize,
    /// Facets in Gmsh's node order; a point group has `Point1` facets.
    pub facets: Vec<(CellKind, Vec<u32>)>,
    /// The nodes of the facets, sorted, each once.
    pub nodes: Vec<u32>,
}

impl Group {
    /// A group of facets.
    pub fn of(name: impl Into<String>, dimension: usize, facets: Vec<(CellKind, Vec<u32>)>) -> Self {
        let mut nodes: Vec<u32> = facets.iter().flat_map(|(_, nodes)| nodes.iter().copied()).collect();
        nodes.sort_unstable();
        nodes.dedup();
        Self { name: name.into(), dimension, facets, nodes }
    }
}

impl Default for Cells {
    fn default() -> Self {
        Self { kind: Vec::new(), region: Vec::new(), offset: vec![0], nodes: Vec::new() }
    }
}

impl Cells {
    /// Appends a cell.
    pub fn push(&mut self, kind: CellKind, region: u16, nodes: &[u32]) {
        debug_assert_eq!(kind.node_count(), nodes.len());
        self.kind.push(kind);
        self.region.push(region);
        self.nodes.extend_from_slice(nodes);
        self.offset.push(self.nodes.len() as u32);
    }

    pub fn len(&self) -> usize {
        self.kind.len()
    }

    pub fn is_empty(&self) -> bool {
        self.kind.is_empty()
    }

    /// The node numbers of cell `c`.
    pub fn nodes(&self, c: usize) -> &[u32] {
        &self.nodes[self.offset[c] as usize..self.offset[c + 1] as usize]
    }

    /// Those of its corners.
    pub fn corners(&self, c: usize) -> &[u32] {
        &self.nodes(c)[..self.kind[c].corner_count()]
    }
}

impl<const D: usize> Mesh<D> {
    /// The group called `name`, if the mesh has one.
    pub fn group(&self, name: &str) -> Option<&Group> {
        self.groups.iter().find(|g| g.name == name)
    }

    /// The mesh with only those of its cells that `keep` is true for, given their number; all nodes and groups stay.
    pub fn part(&self, keep: impl Fn(usize) -> bool) -> Self {
        let mut cells = Cells::default();
        for c in (0..self.cells.len()).filter(|&c| keep(c)) {
            cells.push(self.cells.kind[c], self.cells.region[c], self.cells.nodes(c));
        }
        Self { cells, nodes: self.nodes.clone(), regions: self.regions.clone(), groups: self.groups.clone() }
    }

    /// The mean place (m) of the corners of cell `c`.
    pub fn centre(&self, c: usize) -> [f64; D] {
        let corners = self.cells.corners(c);
        let sum = |d| corners.iter().map(|&n| self.nodes[n as usize][d]).sum::<f64>();
        std::array::from_fn(|d| sum(d) / corners.len() as f64)
    }

    /// The cells at each node, ascending, of those that `counts` is true for.
    pub fn cells_at_nodes(&self, counts: impl Fn(usize) -> bool) -> Vec<Vec<u32>> {
        let mut at = vec![Vec::new(); self.nodes.len()];
        for c in (0..self.cells.len()).filter(|&c| counts(c)) {
            self.cells.nodes(c).iter().for_each(|&n| at[n as usize].push(c as u32));
        }
        at
    }

    /// The coordinates of the nodes of cell `c`, in the cell's order, and zeros behind them.
    pub fn coordinates(&self, c: usize) -> [[f64; D]; MAX_NODES] {
        let mut x = [[0.0; D]; MAX_NODES];
        for (x, &n) in x.iter_mut().zip(self.cells.nodes(c)) {
            *x = self.nodes[n as usize];
        }
        x
    }

    /// The coordinates of the nodes of cell `c`, in the cell's order, into `out` (cleared first).
    pub fn cell_coordinates(&self, c: usize, out: &mut Vec<[f64; D]>) {
        out.clear();
        out.extend(self.cells.nodes(c).iter().map(|&n| self.nodes[n as usize]));
    }
}

/// How high (m) a place lies: its last coordinate, y in the plane and z in space. Gravity acts against it.
#[inline]
pub const fn height<const D: usize>(x: &[f64; D]) -> f64 {
    x[D - 1]
}

/// The diagonal of the box around a cell's nodes (m).
pub fn cell_size<const D: usize>(mesh: &Mesh<D>, cell: usize) -> f64 {
    let nodes = mesh.cells.nodes(cell).iter().map(|&n| mesh.nodes[n as usize]);
    box_around(nodes).map_or(0.0, |[low, high]| (0..D).map(|d| (high[d] - low[d]).powi(2)).sum::<f64>().sqrt())
}
