//! The active boundary (reference 1 of docs/theory.md, §2.5): where the material ends, as closed, oriented polylines.
//!
//! They are the zero of a level set that is linear on the triangles between the nodes of a cell (see `straight.rs`): the surface that cells are cut
//! along, so that integrals over the part inside and over the boundary agree. Each piece lies within one cell. Loops run with the material on their left:
//! counter-clockwise around a body, clockwise around a hole. Where the material lies against the boundary of the mesh
//! the loop runs along that, in pieces that are *wall* and not free surface.

use super::front::MarkerFront;
use super::geometry::Geometry;
use super::loops::loops;
use super::path::Path;
use super::split::triangles;
use super::straight::Triangles;
use crate::geometry::way;
use crate::mesh::Mesh;
use crate::mesh::faces::BOUNDARY;
use crate::mesh::shape::MAX_NODES;

/// The region of a piece that no point is near: there is nothing that could bear a load.
pub const NO_REGION: u16 = u16::MAX;

/// A piece of the boundary: a straight line in one of the triangles of its cell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Piece {
    pub cell: u32,
    pub path: Path,
    /// Whether it lies on the boundary of the mesh.
    pub wall: bool,
    /// The region of the material behind it.
    pub region: u16,
    /// The cell whose points stand for the material behind it, and its path in the parametric domain of that, continued
    /// beyond the cell where it is another one: there the cell of the piece is a sliver without points.
    pub host: u32,
    pub in_host: Path,
}

/// What is behind a piece.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Behind {
    pub region: u16,
    /// The cell whose points stand for it.
    pub host: u32,
}

/// The loops of the boundary, on the grid as last restored.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ActiveBoundary {
    /// The pieces, loop after loop; each begins where the one before ends.
    pub pieces: Vec<Piece>,
    /// Loop `l` has the pieces `first[l]..first[l + 1]`.
    pub first: Vec<u32>,
}

/// A place on the boundary: a node that is on it or within the material at a wall, or between two nodes.
type Vertex = [u32; 2];

impl ActiveBoundary {
    /// The boundary of where `level_set` (one value a node) is positive, over the cells `active`. `behind` tells
    /// what material is near a place of a cell.
    pub fn of(
        mesh: &Mesh<2>,
        geometry: &Geometry,
        level_set: &[f64],
        active: &[bool],
        mut behind: impl FnMut(u32, &[f64; 2]) -> Behind,
    ) -> Self {
        let mut found: Vec<(Vertex, Vertex, Piece)> = Vec::new();
        for c in (0..mesh.cells.len()).filter(|&c| active[c]) {
            add_cell(mesh, geometry, level_set, c, &mut found);
        }
        let mut boundary = Self { pieces: Vec::with_capacity(found.len()), first: vec![0] };
        let ends: Vec<[Vertex; 2]> = found.iter().map(|(from, to, _)| [*from, *to]).collect();
        for of_loop in loops(&ends, |number| direction(mesh, &found[number].2)) {
            for number in of_loop {
                let mut piece = found[number].2;
                let Behind { region, host } = behind(piece.cell, &position(mesh, &piece, 0.5));
                piece.region = region;
                if host != piece.cell {
                    let ends = [0.0, 1.0].map(|t| continued(mesh, host as usize, &position(mesh, &piece, t)));
                    if let [Some(a), Some(b)] = ends {
                        let x = mesh.coordinates(host as usize);
                        let triangles = Triangles::of(mesh.cells.kind[host as usize], &x);
                        (piece.host, piece.in_host) = (host, path(&triangles, [a, b], &direction(mesh, &piece)));
                    }
                }
                boundary.pieces.push(piece);
            }
            boundary.first.push(boundary.pieces.len() as u32);
        }
        boundary
    }

    /// The number of loops.
    pub fn loops(&self) -> usize {
        self.first.len().saturating_sub(1)
    }

    /// The pieces of a loop.
    pub fn pieces(&self, l: usize) -> &[Piece] {
        &self.pieces[self.first[l] as usize..self.first[l + 1] as usize]
    }

    /// A front with a marker at each corner.
    pub fn front(&self, mesh: &Mesh<2>) -> MarkerFront {
        let mut front = MarkerFront { position: Vec::new(), first: vec![0] };
        for l in 0..self.loops() {
            front.position.extend(self.corners(mesh, &mesh.nodes, l));
            front.first.push(front.position.len() as u32);
        }
        front
    }

    /// The corners (m) of a loop, one where each piece begins, on a grid with its nodes at `nodes`.
    pub fn corners<'a>(&'a self, mesh: &'a Mesh<2>, nodes: &'a [[f64; 2]], l: usize) -> impl Iterator<Item = [f64; 2]> {
        self.pieces(l).iter().map(move |piece| place(mesh, nodes, piece, 0.0))
    }
}

/// The place (m) on a piece at the share `t` of its way, on a grid with its nodes at `nodes`.
pub fn place<const D: usize>(mesh: &Mesh<D>, nodes: &[[f64; D]], piece: &Piece, t: f64) -> [f64; D] {
    const { assert!(D == 2, "pieces are lines in plane cells") };
    let xi = piece.path.at(t);
    let mut n = [0.0; MAX_NODES];
    mesh.cells.kind[piece.cell as usize].values(&xi, &mut n);
    let mut x = [0.0; D];
    for (n, &node) in n.iter().zip(mesh.cells.nodes(piece.cell as usize)) {
        for d in 0..D {
            x[d] += n * nodes[node as usize][d];
        }
    }
    x
}

fn position(mesh: &Mesh<2>, piece: &Piece, t: f64) -> [f64; 2] {
    place(mesh, &mesh.nodes, piece, t)
}

fn direction(mesh: &Mesh<2>, piece: &Piece) -> [f64; 2] {
    way(&position(mesh, piece, 0.0), &position(mesh, piece, 1.0))
}

impl Piece {
    /// The part of it between two shares of its way; all of it for 0 and 1.
    pub fn part(&self, from: f64, to: f64) -> Self {
        Self { path: self.path.part(from, to), in_host: self.in_host.part(from, to), ..*self }
    }
}

/// The path between two places of a cell that are `way` (m) apart: straight in its triangles.
fn path(triangles: &Triangles, ends: [[f64; 2]; 2], way: &[f64; 2]) -> Path {
    let [first, last] = ends.map(|xi| triangles.change(&xi, way));
    first.zip(last).map_or_else(|| Path::straight(ends), |(first, last)| Path { ends, rates: [first, last] })
}

/// The parametric coordinates of the place `x` (m) by the map of cell `c`, continued beyond it; `None` where it has no
/// inverse there.
fn continued(mesh: &Mesh<2>, c: usize, x: &[f64; 2]) -> Option<[f64; 2]> {
    let (kind, nodes) = (mesh.cells.kind[c], mesh.cells.nodes(c));
    let (mut n, mut slopes) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
    let mut xi = if kind.is_simplex() { [1.0 / 3.0, 1.0 / 3.0, 0.0] } else { [0.0; 3] };
    for _ in 0..INVERSIONS {
        kind.values(&xi, &mut n);
        kind.derivatives(&xi, &mut slopes);
        let (mut missing, mut by) = (*x, [[0.0; 2]; 2]);
        for (i, &node) in nodes.iter().enumerate() {
            let place = &mesh.nodes[node as usize];
            for d in 0..2 {
                missing[d] -= n[i] * place[d];
                for e in 0..2 {
                    by[d][e] += slopes[i][e] * place[d];
                }
            }
        }
        let determinant = by[0][0] * by[1][1] - by[0][1] * by[1][0];
        let step = [
            (by[1][1] * missing[0] - by[0][1] * missing[1]) / determinant,
            (by[0][0] * missing[1] - by[1][0] * missing[0]) / determinant,
        ];
        (xi[0], xi[1]) = (xi[0] + step[0], xi[1] + step[1]);
        if !(xi[0].abs() < FARTHEST && xi[1].abs() < FARTHEST) {
            return None;
        }
        if step[0].abs() + step[1].abs() < 1e-12 {
            return Some([xi[0], xi[1]]);
        }
    }
    None
}

/// Newton steps to find parametric coordinates.
const INVERSIONS: usize = 20;
/// How large these may be: a neighbour is not farther away.
const FARTHEST: f64 = 10.0;

/// Whether a cell lies within the material: what is zero in it counts as inside, for a surface through its nodes cuts
/// nothing off it.
fn is_full(mesh: &Mesh<2>, level_set: &[f64], c: usize) -> bool {
    let values = || mesh.cells.nodes(c).iter().map(|&n| level_set[n as usize]);
    values().all(|v| v >= 0.0) && values().any(|v| v > 0.0)
}

/// Appends the pieces in a cell.
fn add_cell(mesh: &Mesh<2>, geometry: &Geometry, level_set: &[f64], c: usize, out: &mut Vec<(Vertex, Vertex, Piece)>) {
    let (kind, nodes) = (mesh.cells.kind[c], mesh.cells.nodes(c));
    let value = |i: usize| level_set[nodes[i] as usize];
    if nodes.iter().all(|&n| level_set[n as usize] <= 0.0) {
        return;
    }
    let x = mesh.coordinates(c);
    let split = Triangles::of(kind, &x);
    let mut add = |from: (Vertex, [f64; 2]), to: (Vertex, [f64; 2]), wall: bool| {
        if from.0 != to.0 {
            let (cell, straight) = (c as u32, Path::straight([from.1, to.1]));
            let mut piece = Piece { cell, path: straight, wall, region: NO_REGION, host: cell, in_host: straight };
            piece.path = path(&split, straight.ends, &direction(mesh, &piece));
            piece.in_host = piece.path;
            out.push((from.0, to.0, piece));
        }
    };
    let at = |i: usize| ([nodes[i]; 2], [0, 1].map(|d| kind.node_coordinates()[i][d]));
    // Where the level set vanishes between a node within and one that is not.
    let between = |i: usize, j: usize| crossing(&split, nodes, [i, j], [value(i), value(j)]);
    let full = is_full(mesh, level_set, c);
    for triangle in triangles(kind).iter().filter(|_| !full) {
        let inside = triangle.map(|i| value(i) > 0.0);
        match inside.iter().filter(|&&inside| inside).count() {
            1 => {
                let k = inside.iter().position(|&inside| inside).unwrap_or(0);
                let [i, j, l] = [triangle[k], triangle[(k + 1) % 3], triangle[(k + 2) % 3]];
                add(between(i, j), between(i, l), false);
            }
            2 => {
                let k = inside.iter().position(|&inside| !inside).unwrap_or(0);
                let [l, i, j] = [triangle[k], triangle[(k + 1) % 3], triangle[(k + 2) % 3]];
                add(between(j, l), between(i, l), false);
            }
            _ => {}
        }
    }
    let (_, facets) = kind.facets();
    for (facet, &other) in facets.iter().zip(geometry.faces.across(c as u32)) {
        let wall = other == BOUNDARY;
        // Between cells only what is zero may bound a full one.
        if !wall && (!full || is_full(mesh, level_set, other as usize)) {
            continue;
        }
        let halves: &[[usize; 2]] = match **facet {
            [a, b, middle] => &[[a, middle], [middle, b]],
            [a, b] => &[[a, b]],
            _ => &[],
        };
        for &[i, j] in halves {
            match (value(i) > 0.0, value(j) > 0.0) {
                (false, false) if full => add(at(i), at(j), wall),
                _ if !wall => {}
                (true, true) => add(at(i), at(j), true),
                (true, false) => add(at(i), between(i, j), true),
                (false, true) => add(between(j, i), at(j), true),
                (false, false) => {}
            }
        }
    }
}

/// The vertex between two nodes of a cell, the first of them within the material, and its parametric place. It is
/// the same seen from either cell at an edge.
fn crossing(split: &Triangles, nodes: &[u32], [i, j]: [usize; 2], [a, b]: [f64; 2]) -> (Vertex, [f64; 2]) {
    let at = split.between([i, j], a / (a - b));
    // A node where the level set is zero is on the boundary itself.
    let vertex = if b == 0.0 { [nodes[j]; 2] } else { [nodes[i].min(nodes[j]), nodes[i].max(nodes[j])] };
    (vertex, at)
}
