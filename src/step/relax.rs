//! The shape of the grid at a reset where finite elements share nodes with it, or a curve of it is moved (docs/theory.md, eq. 27; its reference 1,
//! §2.7). These nodes keep the positions to which the material has brought them; the other nodes follow, less and less with the distance.
//!
//! Springs along the edges of the cells join their corners, with a stiffness of one over the square of the length of the edge. Their
//! loads are the displacements of those nodes from the first shape of the grid. Other nodes on the boundary of the mesh move along it only.

use super::scene::Scene;
use super::state::State;
use crate::error::{Error, Result};
use crate::mesh::Mesh;
use crate::mesh::faces::Faces;
use crate::mesh::locate::Locator;
use crate::mesh::quality;
use crate::system::{Connectivity, Matrix, Pattern, Solver};

/// Least fraction (-) of its first quality that a cell may have on the relaxed grid.
const LEAST: f64 = 0.1;

/// A grid whose nodes have moved.
pub struct Relaxed<const D: usize> {
    pub mesh: Mesh<D>,
    pub locator: Locator<D>,
}

/// The mesh at the last reset and the way to find places in it: that of the scene, where its nodes have not moved.
pub fn mesh<'a, const D: usize>(scene: &'a Scene<D>, relaxed: Option<&'a Relaxed<D>>) -> (&'a Mesh<D>, &'a Locator<D>) {
    relaxed.map_or((&scene.mesh, &scene.locator), |relaxed| (&relaxed.mesh, &relaxed.locator))
}

/// Moves the nodes of the grid in `state` to where the relaxed grid has them. `None` where that is their first position.
///
/// # Errors
/// An analysis error when nodes that follow the material moved so far that a cell of the grid is folded.
pub fn relax<const D: usize>(scene: &Scene<D>, state: &mut State<D>) -> Result<Option<Relaxed<D>>> {
    let first = &scene.mesh;
    let following = scene.following(state.phase);
    if !following.contains(&true) {
        if !state.nodes.is_empty() {
            // Those of a curve may have followed in the phase before.
            first.cells.nodes.iter().for_each(|&n| state.nodes[n as usize] = first.nodes[n as usize]);
        }
        return Ok(None);
    }
    let way = |n: usize| -> [f64; D] { std::array::from_fn(|d| state.nodes[n][d] - first.nodes[n][d]) };
    let corners = Corners::of(first);
    let held = corners.held(first, &following);
    let mut moved = vec![[0.0; D]; first.nodes.len()];
    let pattern = Pattern::new(&vec![1; corners.node.len()], corners.edges(first), true);
    let places: Vec<_> = corners.node.iter().map(|&n| first.nodes[n as usize]).collect();
    let mut solver = Solver::new(&pattern, &places)?;
    for d in 0..D {
        let fixed: Vec<bool> = held.iter().map(|held| held[d]).collect();
        let given: Vec<f64> =
            corners.node.iter().map(|&n| if following[n as usize] { way(n as usize)[d] } else { 0.0 }).collect();
        let mut springs = corners.springs(first, &pattern);
        let mut x = vec![0.0; pattern.len()];
        let scale = springs.scale(&pattern);
        springs.constrain(&pattern, &fixed, &given, scale, &mut x);
        solver.solve(&pattern, &springs, &mut x)?;
        for (&n, x) in corners.node.iter().zip(&x) {
            moved[n as usize][d] = *x;
        }
    }
    for c in 0..first.cells.len() {
        let nodes = first.cells.nodes(c);
        let count = first.cells.kind[c].corner_count();
        for (i, &n) in nodes.iter().enumerate().skip(count) {
            let ends: Vec<u32> =
                if i < 2 * count { vec![nodes[i - count], nodes[(i + 1) % count]] } else { nodes[..count].to_vec() };
            moved[n as usize] =
                std::array::from_fn(|d| ends.iter().map(|&e| moved[e as usize][d]).sum::<f64>() / ends.len() as f64);
        }
    }
    for &n in &first.cells.nodes {
        let n = n as usize;
        if !following[n] {
            state.nodes[n] = std::array::from_fn(|d| first.nodes[n][d] + moved[n][d]);
        }
    }
    let relaxed = at(scene, state);
    relaxed.iter().try_for_each(|relaxed| check(first, &relaxed.mesh))?;
    Ok(relaxed)
}

/// The relaxed grid of a state; `None` where its nodes have their first positions.
pub fn at<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Option<Relaxed<D>> {
    let moved = |&n: &u32| state.nodes[n as usize] != scene.mesh.nodes[n as usize];
    if state.nodes.is_empty() || !scene.mesh.cells.nodes.iter().any(moved) {
        return None;
    }
    let mesh = Mesh { nodes: state.coordinates(scene).to_vec(), ..scene.mesh.clone() };
    let locator = scene.locator.moved(&mesh);
    Some(Relaxed { mesh, locator })
}

/// # Errors
/// Names the first cell that is folded.
fn check<const D: usize>(first: &Mesh<D>, mesh: &Mesh<D>) -> Result<()> {
    const { assert!(D == 2, "the quality of cells is known in the plane only") };
    let quality = |mesh: &Mesh<D>, c: usize| {
        let corners = mesh.cells.corners(c);
        let x: Vec<[f64; 2]> = corners.iter().map(|&n| [0, 1].map(|d| mesh.nodes[n as usize][d])).collect();
        quality::quality(&x)
    };
    match (0..mesh.cells.len()).find(|&c| quality(mesh, c) < LEAST * quality(first, c)) {
        None => Ok(()),
        Some(c) => Err(Error::analysis(
            format!("grid cell {c} near {:.4?} m", mesh.nodes[mesh.cells.nodes(c)[0] as usize]),
            "finite elements that share nodes with the grid, or a prescribed curve of it, moved so far that it is folded",
            "make more of the soil `kind: mpm`; for a curve, enlarge the buffer before it, or move a rigid structure with a contact",
        )),
    }
}

/// The corners of the cells of a grid, numbered.
struct Corners {
    node: Vec<u32>,
    number: Vec<u32>,
}

impl Corners {
    fn of<const D: usize>(mesh: &Mesh<D>) -> Self {
        let mut number = vec![u32::MAX; mesh.nodes.len()];
        let mut node = Vec::new();
        for c in 0..mesh.cells.len() {
            for &n in mesh.cells.corners(c) {
                if number[n as usize] == u32::MAX {
                    number[n as usize] = node.len() as u32;
                    node.push(n);
                }
            }
        }
        Self { node, number }
    }

    /// The ends of the edges of each cell in turn.
    fn ends<const D: usize>(mesh: &Mesh<D>) -> impl Iterator<Item = [u32; 2]> {
        const { assert!(D == 2, "the corners of a cell follow each other along its edges in the plane only") };
        (0..mesh.cells.len()).flat_map(|c| {
            let (nodes, count) = (mesh.cells.nodes(c), mesh.cells.kind[c].corner_count());
            (0..count).map(move |i| [nodes[i], nodes[(i + 1) % count]])
        })
    }

    fn edges<const D: usize>(&self, mesh: &Mesh<D>) -> Connectivity {
        let mut connectivity = Connectivity::default();
        for ends in Self::ends(mesh) {
            connectivity.push(ends.map(|n| self.number[n as usize]));
        }
        connectivity
    }

    fn springs<const D: usize>(&self, mesh: &Mesh<D>, pattern: &Pattern) -> Matrix {
        let mut matrix = Matrix::new(pattern);
        for (k, [a, b]) in Self::ends(mesh).enumerate() {
            let (a, b) = (&mesh.nodes[a as usize], &mesh.nodes[b as usize]);
            let stiffness = 1.0 / (0..D).map(|d| (a[d] - b[d]).powi(2)).sum::<f64>();
            matrix.add(pattern, k, &[stiffness, -stiffness, -stiffness, stiffness], 2);
        }
        matrix
    }

    /// Which components of each corner are prescribed: all at nodes that follow the material; on the rest of the boundary the normal one of sides along an axis,
    /// and both on other sides.
    fn held<const D: usize>(&self, mesh: &Mesh<D>, following: &[bool]) -> Vec<[bool; D]> {
        const { assert!(D == 2, "sides are lines in the plane only") };
        let mut held: Vec<[bool; D]> = self.node.iter().map(|&n| [following[n as usize]; D]).collect();
        for (cell, side) in Faces::of(mesh).boundary {
            let nodes = mesh.cells.nodes(cell as usize);
            let facet = mesh.cells.kind[cell as usize].facets().1[side as usize];
            let ends = [nodes[facet[0]], nodes[facet[1]]];
            if facet.iter().all(|&i| following[nodes[i] as usize]) {
                continue;
            }
            let [a, b] = ends.map(|n| &mesh.nodes[n as usize]);
            let length = (0..D).map(|d| (a[d] - b[d]).powi(2)).sum::<f64>().sqrt();
            let along = (0..D).find(|&d| (a[d] - b[d]).abs() > (1.0 - 1e-9) * length);
            for n in ends {
                for d in (0..D).filter(|d| Some(*d) != along) {
                    held[self.number[n as usize] as usize][d] = true;
                }
            }
        }
        held
    }
}
