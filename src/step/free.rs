//! The error message for a singular system: which body is free to move, or else where the soil has no strength.
//!
//! A rigid motion that nothing resists is in the null space of the tangent. Bodies are what shares nodes, rigid
//! structures, and in the end all of the scene together; the motions of each are the displacements in each direction
//! and the rotation about its middle, as far as supports leave them.
//!
//! Where none of them is free, soil can deform without resistance. A system whose diagonal is raised a little has a solution, which is largest
//! there (inverse iteration).

use super::grid::Grid;
use super::scene::Scene;
use super::state::State;
use crate::error::Error;
use crate::interpolation::CellPoints;
use crate::mesh::Mesh;
use crate::mesh::bodies::root;
use crate::rigid::across;
use crate::system::{Matrix, is_singular};
use nalgebra::DMatrix;
use std::collections::{BTreeMap, BTreeSet};

/// A resistance this small (-) is rounding.
const NOTHING: f64 = 1e-9;
/// Parts of a motion of length 1 that differ by less are the same.
const SAME: f64 = 1e-4;
/// The share (-) of its largest entry that the diagonal of a singular system is raised by: more than what counts as rounding.
const RAISED: f64 = 1e-10;
/// Bodies that a message names.
const NAMED: usize = 4;
/// What helps where bodies move freely.
const HOLD: &str =
    "without inertia a body must not move freely: hold it by supports, prescribe it, or lay it on what it touches";

/// The error of a singular system without inertia with the bodies that are free to move in it; another error as it is. `fixed` tells
/// the equations whose displacement is given, `position` where the nodes are (m).
pub fn name<const D: usize>(
    error: Error,
    scene: &Scene<D>,
    state: &State<D>,
    grid: &mut Grid<D>,
    fixed: &[bool],
    position: &dyn Fn(u32) -> [f64; D],
) -> Error {
    if !is_singular(&error) {
        return error;
    }
    let mut free = free_bodies(scene, state, grid, fixed, position);
    if free.is_empty() {
        return match weakest(grid, fixed) {
            Some(n) => without_strength(error, scene, state, grid, (n, position(n))),
            None => Error { remedy: HOLD.to_owned(), ..error },
        };
    }
    let more = free.len().saturating_sub(NAMED);
    free.truncate(NAMED);
    let more = if more > 0 { format!(", and {more} bodies more") } else { String::new() };
    Error { problem: format!("{}: {}{more}", error.problem, free.join(", ")), remedy: HOLD.to_owned(), ..error }
}

/// What is said of each body that can move freely.
fn free_bodies<const D: usize>(
    scene: &Scene<D>,
    state: &State<D>,
    grid: &Grid<D>,
    fixed: &[bool],
    position: &dyn Fn(u32) -> [f64; D],
) -> Vec<String> {
    let diagonal = grid.motion.matrix.diagonal(&grid.motion.pattern);
    let position = |n: u32| grid.dofs.value(n, position);
    let system = System { scene, grid, fixed, diagonal, position: &position };
    let bodies = bodies(scene, state, grid);
    let mut free: Vec<String> = bodies.iter().filter_map(|(name, nodes)| system.told(name, nodes)).collect();
    if free.is_empty() && bodies.len() > 1 {
        let all: Vec<u32> = bodies.values().flatten().copied().collect();
        free.extend(system.told("all of it together", &all));
    }
    free
}

/// The node that moves farthest under loads on a system whose diagonal is raised by the share [`RAISED`] of its largest entry.
fn weakest<const D: usize>(grid: &mut Grid<D>, fixed: &[bool]) -> Option<u32> {
    let (dofs, motion) = (&grid.dofs, &mut grid.motion);
    let (pattern, scale) = (&motion.pattern, motion.matrix.scale(&motion.pattern));
    let mut raised = Matrix { values: motion.matrix.values.clone(), ..Matrix::default() };
    let equations = D * dofs.node.len();
    (0..equations).for_each(|e| raised.add_diagonal(pattern, e, RAISED * scale));
    // Loads of either sign, so that none of the motions is without any.
    let load = |e: usize| if e % 3 == 1 { -scale } else { scale };
    let mut x: Vec<f64> = (0..pattern.len()).map(|e| if fixed[e] || e >= equations { 0.0 } else { load(e) }).collect();
    motion.solver.solve(pattern, &raised, &mut x).ok()?;
    let size = |b: usize| (D * b..D * (b + 1)).map(|e| x[e] * x[e]).sum::<f64>();
    (0..dofs.node.len()).max_by(|&a, &b| size(a).total_cmp(&size(b))).map(|b| dofs.node[b])
}

/// Names the soil beside a node that nothing holds in place.
fn without_strength<const D: usize>(
    error: Error,
    scene: &Scene<D>,
    state: &State<D>,
    grid: &Grid<D>,
    (n, place): (u32, [f64; D]),
) -> Error {
    let holds = |c: &&CellPoints| scene.mesh.cells.nodes(c.cell as usize).contains(&n);
    let cell = grid.interpolations.integration.filled.iter().find(holds);
    let region = cell.map(|c| state.integration().region[grid.interpolations.integration.points(c)[0] as usize]);
    let name = region.and_then(|region| scene.mesh.regions.get(region as usize)).map_or("a part of it", String::as_str);
    Error {
        problem: format!("{}: the soil (`{name}`) has no strength at {place:.3?} m", error.problem),
        remedy: "soil without cohesion bears nothing where it is without stress: give it a little cohesion, or begin with an initial stress"
            .to_owned(),
        ..error
    }
}

/// The nodes with unknowns of each body, by what it is called.
fn bodies<const D: usize>(scene: &Scene<D>, state: &State<D>, grid: &Grid<D>) -> BTreeMap<String, Vec<u32>> {
    // Each node points to one of the same body with a lower number, or to itself.
    let mut to: Vec<u32> = (0..scene.displacements() as u32).collect();
    let deforming = || scene.fem.iter().flat_map(|fem| fem.deforming().map(|c| (&fem.mesh, c)));
    let cells = || grid.cells.iter().map(|&c| (&scene.mesh, c as usize)).chain(deforming());
    let nodes = |(mesh, c): (&'_ Mesh<D>, usize)| -> Vec<u32> {
        let nodes = mesh.cells.nodes(c);
        let controls = grid.dofs.constraints.iter().flat_map(|all| nodes.iter().flat_map(|&n| all.of_node(n)));
        nodes.iter().chain(controls.map(|(control, _)| control)).copied().collect()
    };
    for cell in cells() {
        let nodes = nodes(cell);
        let least = nodes.iter().map(|&n| root(&mut to, n)).min().unwrap_or(0);
        for n in nodes {
            let old = root(&mut to, n);
            to[old as usize] = least;
        }
    }
    let filled: BTreeSet<u16> = state.points.region.iter().chain(&state.fem.region).copied().collect();
    let mut regions: BTreeMap<u32, BTreeSet<&str>> = BTreeMap::new();
    for (mesh, c) in cells().filter(|(mesh, c)| filled.contains(&mesh.cells.region[*c])) {
        let body = root(&mut to, mesh.cells.nodes(c)[0]);
        regions.entry(body).or_default().insert(&mesh.regions[mesh.cells.region[c] as usize]);
    }
    let mut bodies: BTreeMap<String, Vec<u32>> = BTreeMap::new();
    for &n in &grid.dofs.node {
        let name = match (scene.body_of(n), regions.get(&root(&mut to, n))) {
            (Some(body), _) => scene.mesh.regions.get(body.region as usize).map(|name| format!("`{name}`")),
            (None, Some(names)) => {
                let names: Vec<String> = names.iter().map(|name| format!("`{name}`")).collect();
                Some(names.join(" with "))
            }
            (None, None) => None,
        };
        bodies.entry(name.unwrap_or_else(|| "a part without material".to_owned())).or_default().push(n);
    }
    bodies
}

/// The system with what its equations are of.
struct System<'a, const D: usize> {
    scene: &'a Scene<D>,
    grid: &'a Grid<D>,
    fixed: &'a [bool],
    diagonal: Vec<f64>,
    position: &'a dyn Fn(u32) -> [f64; D],
}

impl<const D: usize> System<'_, D> {
    /// How the body of `nodes` can move freely, in words; `None` where it cannot.
    fn told(&self, name: &str, nodes: &[u32]) -> Option<String> {
        const { assert!(D == 2, "there is one rotation in the plane only") };
        let middle: [f64; D] =
            std::array::from_fn(|d| nodes.iter().map(|&n| (self.position)(n)[d]).sum::<f64>() / nodes.len() as f64);
        let arm = |n: u32| -> [f64; D] { std::array::from_fn(|d| (self.position)(n)[d] - middle[d]) };
        // The farthest that turns, so that all motions are of one size.
        let arms = nodes.iter().filter_map(|&n| self.scene.body_of(n)).map(|body| body.dofs.arm);
        let length = |n: &u32| arm(*n).iter().map(|v| v * v).sum::<f64>().sqrt();
        let size = nodes.iter().map(length).chain(arms).fold(f64::MIN_POSITIVE, f64::max);
        let mut resistance = Vec::new();
        for d in 0..D {
            resistance.extend(self.resistance(nodes, &|_| std::array::from_fn(|i| f64::from(u8::from(i == d))), 0.0));
            resistance.push(0.0);
        }
        resistance.extend(self.resistance(nodes, &|n| across(&arm(n)).map(|v| v / size), 1.0 / size));
        // A rigid body in axisymmetry does not turn.
        let turns = |&n: &u32| self.scene.body_of(n).is_none_or(|body| body.dofs.rotation.is_some());
        resistance.push(if nodes.iter().all(turns) { 0.0 } else { 1.0 });
        let rows = resistance.len() / (D + 1);
        let resistance = DMatrix::from_vec(rows, D + 1, resistance);
        let decomposed = resistance.qr().r().svd(false, true);
        let directions = decomposed.v_t?;
        let free = (0..D + 1).filter(|&k| decomposed.singular_values[k] <= NOTHING);
        let mut free: Vec<Vec<f64>> = free.map(|k| directions.row(k).iter().copied().collect()).collect();
        let mut ways = Vec::new();
        for d in 0..D {
            // A direction is free where it lies within the free motions; these go on without it.
            let shares: Vec<f64> = free.iter().map(|motion| motion[d]).collect();
            if (shares.iter().map(|s| s * s).sum::<f64>() - 1.0).abs() < SAME {
                ways.push(format!("in {}", ["x", "y", "z"][d]));
                free.iter_mut().for_each(|motion| motion[d] = 0.0);
            }
        }
        let largest = |k: usize| free.iter().max_by(|a, b| a[k].abs().total_cmp(&b[k].abs()));
        let turning = largest(D).filter(|motion| motion[D].abs() > SAME);
        if let Some(motion) = turning {
            let about = [middle[0] - size * motion[1] / motion[D], middle[1] + size * motion[0] / motion[D]];
            let anywhere = ways.len() == D;
            ways.push(if anywhere {
                "to turn".to_owned()
            } else {
                format!("to turn about [{:.4}, {:.4}] m", about[0], about[1])
            });
        } else if ways.is_empty()
            && let Some(motion) = free.first()
        {
            ways.push(format!("along [{:.4}, {:.4}]", motion[0], motion[1]));
        }
        let last = ways.pop()?;
        let ways = if ways.is_empty() { last } else { format!("{} and {last}", ways.join(", ")) };
        Some(format!("{name} is free {ways}"))
    }

    /// What resists a motion of `nodes` with a `rotation` (per unit of the motion) of rigid bodies: what the motion is
    /// where displacements are given, and the forces it meets, beside the stiffest equation. One entry an equation.
    fn resistance(&self, nodes: &[u32], motion: &dyn Fn(u32) -> [f64; D], rotation: f64) -> Vec<f64> {
        let (pattern, matrix) = (&self.grid.motion.pattern, &self.grid.motion.matrix);
        let mut v = vec![0.0; pattern.len()];
        let mut given = vec![0.0; pattern.len()];
        let mut stiffest = f64::MIN_POSITIVE;
        for &n in nodes {
            let block = self.grid.dofs.block[n as usize] as usize;
            let motion = self.scene.turning(n).map_or_else(|| motion(n), |dofs| dofs.arc(rotation));
            for (d, motion) in motion.into_iter().enumerate() {
                let e = block * D + d;
                if self.fixed[e] {
                    given[e] = motion;
                } else {
                    v[e] = motion;
                    stiffest = stiffest.max(self.diagonal[e].abs());
                }
            }
        }
        let mut force = vec![0.0; v.len()];
        matrix.multiply(pattern, &v, &mut force);
        for ((given, force), fixed) in given.iter_mut().zip(&force).zip(self.fixed) {
            if !fixed {
                *given = force / stiffest;
            }
        }
        given
    }
}
