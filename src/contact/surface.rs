//! The boundary of a structure, its segments and its contact nodes: what does not change as it moves.

use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::mesh::faces::Faces;
use crate::mesh::shape::{CellKind, MAX_NODES, rule};

/// Contact nodes in order along a smooth piece of the boundary, and whether the last is beside the first.
pub type Run = (std::ops::Range<usize>, bool);

/// Segments per contact node.
const SEGMENTS: f64 = 5.0;
/// Cosine of the angle (40°) by which the boundary turns at a corner where pressure and normal may jump.
const CORNER: f64 = 0.766;

/// A part of a facet over which contact is integrated by its middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    pub facet: u32,
    /// Where it begins and ends on the facet, in [-1, 1].
    pub from: f64,
    pub to: f64,
    /// The two contact nodes over it and their values at its middle.
    pub contact_nodes: [(u32, f64); 2],
}

/// The boundary of a structure.
#[derive(Clone, Debug)]
pub struct Surface {
    /// The kind of the facets, and their nodes: ends, then the middle. The structure is on their left.
    pub kind: CellKind,
    pub facets: Vec<Vec<u32>>,
    /// In order along the boundary, piece after piece.
    pub segments: Vec<Segment>,
    /// Pieces: smooth stretches of the boundary, by their segments.
    pub pieces: Vec<std::ops::Range<usize>>,
    /// Pieces that follow each other without a gap, by their segments.
    pub chains: Vec<std::ops::Range<usize>>,
    pub contact_nodes: usize,
    /// Contact nodes of each piece, and whether the last is beside the first.
    pub runs: Vec<Run>,
    /// Length (m) between contact nodes.
    pub spacing: f64,
}

impl Surface {
    /// The boundary of the cells of `mesh` in `region`, without facets that `skip` is true for, given their nodes;
    /// contact nodes are about `spacing` (m) apart.
    ///
    /// # Errors
    /// Input: a region without boundary.
    pub fn new(mesh: &Mesh<2>, region: u16, spacing: f64, skip: impl Fn(&[u32]) -> bool) -> Result<Self> {
        let cells = mesh.part(|c| mesh.cells.region[c] == region);
        let mut facets: Vec<Vec<u32>> = Vec::new();
        let mut kind = CellKind::Line3;
        for (cell, side) in Faces::of(&cells).boundary {
            let (line, local) = cells.cells.kind[cell as usize].facets();
            let nodes = cells.cells.nodes(cell as usize);
            let facet: Vec<u32> = local[side as usize].iter().map(|&i| nodes[i]).collect();
            if !skip(&facet) {
                kind = line;
                facets.push(facet);
            }
        }
        if facets.is_empty() {
            let name = mesh.regions.get(region as usize).map_or("", String::as_str);
            return Err(Error::input(
                format!("region {name}"),
                "it has no boundary that contact could act on",
                "give the structure a mesh of its own, not joined to the grid",
            ));
        }
        Ok(Self::of(mesh, kind, facets, spacing))
    }

    /// The boundary that `facets` of one kind are, given their nodes, with the structure on their left.
    pub fn of(mesh: &Mesh<2>, kind: CellKind, facets: Vec<Vec<u32>>, spacing: f64) -> Self {
        let mut surface = Self {
            kind,
            facets: Vec::new(),
            segments: Vec::new(),
            pieces: Vec::new(),
            chains: Vec::new(),
            contact_nodes: 0,
            runs: Vec::new(),
            spacing,
        };
        for chain in chains(facets) {
            surface.add_chain(mesh, chain);
        }
        surface
    }

    /// Adds a chain of facets, cut at its corners.
    fn add_chain(&mut self, mesh: &Mesh<2>, mut chain: Vec<Vec<u32>>) {
        let closed = chain.first().map(|f| f[0]) == chain.last().map(|f| f[1]);
        let corner = |a: &[u32], b: &[u32]| {
            let (s, t) = (direction(mesh, self.kind, a, 1.0), direction(mesh, self.kind, b, -1.0));
            s[0] * t[0] + s[1] * t[1] < CORNER
        };
        let count = chain.len();
        let corners: Vec<usize> = (0..count).filter(|&i| corner(&chain[(i + count - 1) % count], &chain[i])).collect();
        let smooth_loop = closed && corners.is_empty();
        let mut cuts: Vec<usize> = Vec::new();
        if closed {
            let first = corners.first().copied().unwrap_or(0);
            chain.rotate_left(first);
            cuts.extend(corners.iter().map(|c| c - first).filter(|&c| c > 0));
        } else {
            cuts.extend(corners.into_iter().filter(|&c| c > 0));
        }
        cuts.push(count);
        let first_segment = self.segments.len();
        let mut begin = 0;
        for end in cuts {
            self.add_piece(mesh, &chain[begin..end], smooth_loop);
            begin = end;
        }
        self.chains.push(first_segment..self.segments.len());
    }

    /// Adds a smooth stretch with its contact nodes; those of a loop have no end.
    fn add_piece(&mut self, mesh: &Mesh<2>, facets: &[Vec<u32>], is_loop: bool) {
        let lengths: Vec<f64> = facets.iter().map(|f| length(mesh, self.kind, f)).collect();
        let whole: f64 = lengths.iter().sum();
        let least = if is_loop { 3.0 } else { 1.0 };
        let intervals = (whole / self.spacing).round().max(least);
        let first_segment = self.segments.len();
        let mut along = 0.0;
        for (nodes, length) in facets.iter().zip(&lengths) {
            let parts = (SEGMENTS * length / (whole / intervals)).ceil().max(1.0) as usize;
            let facet = self.facets.len() as u32;
            for k in 0..parts {
                let [from, to] = [k, k + 1].map(|k| 2.0 * k as f64 / parts as f64 - 1.0);
                let at = (along + length * 0.25 * (from + to + 2.0)) / whole * intervals;
                let left = at.floor().min(intervals - 1.0);
                let right = if is_loop && left + 1.0 == intervals { 0 } else { left as u32 + 1 };
                let contact_node = |k: u32| self.contact_nodes as u32 + k;
                let contact_nodes = [(contact_node(left as u32), 1.0 - (at - left)), (contact_node(right), at - left)];
                self.segments.push(Segment { facet, from, to, contact_nodes });
            }
            self.facets.push(nodes.clone());
            along += length;
        }
        let first = self.contact_nodes;
        self.contact_nodes += intervals as usize + usize::from(!is_loop);
        self.runs.push((first..self.contact_nodes, is_loop));
        self.pieces.push(first_segment..self.segments.len());
    }
}

/// Facets joined end to end: open chains first from where they begin, then loops.
fn chains(mut facets: Vec<Vec<u32>>) -> Vec<Vec<Vec<u32>>> {
    let mut chains = Vec::new();
    while !facets.is_empty() {
        let begins = |i: &usize| facets.iter().all(|other| other[1] != facets[*i][0]);
        let first = (0..facets.len()).find(begins).unwrap_or(0);
        let mut chain = vec![facets.swap_remove(first)];
        while let Some(next) = facets.iter().position(|f| chain.last().is_some_and(|last| f[0] == last[1])) {
            chain.push(facets.swap_remove(next));
        }
        chains.push(chain);
    }
    chains
}

/// Unit direction of a facet at `xi`.
fn direction(mesh: &Mesh<2>, kind: CellKind, facet: &[u32], xi: f64) -> [f64; 2] {
    let t = derivative(mesh, kind, facet, xi);
    let size = t[0].hypot(t[1]);
    [t[0] / size, t[1] / size]
}

fn derivative(mesh: &Mesh<2>, kind: CellKind, facet: &[u32], xi: f64) -> [f64; 2] {
    let mut dn = [[0.0; 3]; MAX_NODES];
    kind.derivatives(&[xi, 0.0, 0.0], &mut dn);
    let mut t = [0.0; 2];
    for (&n, dn) in facet.iter().zip(&dn) {
        for d in 0..2 {
            t[d] += dn[0] * mesh.nodes[n as usize][d];
        }
    }
    t
}

fn length(mesh: &Mesh<2>, kind: CellKind, facet: &[u32]) -> f64 {
    let at = |(xi, weight): ([f64; 3], f64)| {
        let t = derivative(mesh, kind, facet, xi[0]);
        weight * t[0].hypot(t[1])
    };
    rule(kind, 5).into_iter().map(at).sum()
}
