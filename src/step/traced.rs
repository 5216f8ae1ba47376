//! The material that was at some nodes of the grid as the run began: a history of a curve or a point asks for its displacement, and forces at points
//! act on it. On a grid that is reset other material comes to these nodes.

use super::scene::Scene;
use super::state::State;
use crate::geometry::box_around;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::mesh::shape::MAX_NODES;

/// How much wider than the box around its nodes, which a curved cell may leave, the cell is looked for (-).
const WIDER: f64 = 0.25;

/// Nodes of a cell with their shares (-) of what is at a place.
pub type Shares = Vec<(u32, f64)>;

/// The increments (m) of the material that was at the nodes of [`Scene::traced`], given the displacement of the nodes at the end of the step, where
/// they are not those of the nodes themselves. Zero where it has left the grid by more than [`WIDER`] of a cell.
pub fn increments<const D: usize>(scene: &Scene<D>, state: &State<D>, now: &[[f64; D]]) -> Vec<(u32, [f64; D])> {
    let traced = apart(scene, state, &scene.traced);
    let increment = |shares: Option<Shares>| {
        let mut moved = [0.0; D];
        for (n, share) in shares.into_iter().flatten() {
            let (now, before) = (&now[n as usize], &state.displacement[n as usize]);
            for d in 0..D {
                moved[d] += share * (now[d] - before[d]);
            }
        }
        moved
    };
    let places = shares(scene, state, &traced, |_| true).into_iter().map(increment);
    traced.iter().copied().zip(places).collect()
}

/// Where the material is that was at the nodes of [`Scene::loaded`], where it is not at these: the nodes of the cell, with their shares; none where
/// it is near no soil. Cells without points bear nothing, and the nearest one with points has what lies in them.
pub fn loaded<const D: usize>(scene: &Scene<D>, state: &State<D>) -> Vec<(u32, Shares)> {
    let loaded = apart(scene, state, &scene.loaded);
    let mut filled = vec![false; scene.mesh.cells.len()];
    state.integration().cell.iter().for_each(|&c| filled[c as usize] = true);
    let found = shares(scene, state, &loaded, |c| filled[c]).into_iter().map(Option::unwrap_or_default);
    loaded.iter().copied().zip(found).collect()
}

/// Those of some nodes that are not where their material is: none until the first reset after that with which the run begins, and none that go
/// with the material.
fn apart<const D: usize>(scene: &Scene<D>, state: &State<D>, nodes: &[u32]) -> Vec<u32> {
    if nodes.is_empty() || state.restorations < 2 {
        return Vec::new();
    }
    let following = scene.following(state.phase);
    nodes.iter().copied().filter(|n| !following[*n as usize]).collect()
}

/// The nodes of the cell, among those `wanted`, in which the material is that was at some nodes, with their shares; `None` where it is farther than
/// [`WIDER`] of a cell from all of these.
fn shares<const D: usize>(
    scene: &Scene<D>,
    state: &State<D>,
    traced: &[u32],
    wanted: impl Fn(usize) -> bool,
) -> Vec<Option<Shares>> {
    const { assert!(D == 2, "the cells around a place are found in the plane only") };
    let places: Vec<[f64; D]> = traced.iter().map(|&n| place(scene, state, n)).collect();
    let plane = |x: &[f64; D]| [x[0], x[1]];
    let Some([low, high]) = box_around(places.iter().map(plane)) else { return Vec::new() };
    let coordinates = state.coordinates(scene);
    let moved = coordinates.iter().zip(&state.displacement).map(|(x, u)| std::array::from_fn(|d| x[d] + u[d]));
    let nodes: Vec<[f64; D]> = moved.collect();
    let meets = |of: &[u32], [low, high]: [&[f64; 2]; 2]| {
        box_around(of.iter().map(|&n| plane(&nodes[n as usize]))).is_some_and(|cell| {
            let by = [0, 1].map(|d| WIDER * (cell[1][d] - cell[0][d]));
            (0..2).all(|d| cell[0][d] - by[d] <= high[d] && low[d] <= cell[1][d] + by[d])
        })
    };
    let at = |of: &[u32], x: &[f64; D]| meets(of, [&plane(x), &plane(x)]);
    let near = |c: usize| {
        let of = scene.mesh.cells.nodes(c);
        wanted(c) && meets(of, [&low, &high]) && places.iter().any(|x| at(of, x))
    };
    let part = scene.mesh.part(near);
    let around = Mesh { nodes: nodes.clone(), ..part };
    if around.cells.is_empty() {
        return vec![None; traced.len()];
    }
    let locator = Locator::new(&around);
    let of = |x: &[f64; D]| {
        // The surface of soil may lie a little beyond the grid: the nearest cell goes on there.
        let beyond = || {
            let cells = (0..around.cells.len()).filter(|&c| at(around.cells.nodes(c), x)).map(|c| c as u32);
            let places = cells.filter_map(|c| Some((c, locator.extend(&around, c, x)?)));
            let depth = |(c, xi): &(u32, [f64; 3])| around.cells.kind[*c as usize].depth(xi).0;
            places.max_by(|a, b| depth(a).total_cmp(&depth(b)))
        };
        let (c, xi) = locator.locate(&around, x, None).or_else(beyond)?;
        let mut share = [0.0; MAX_NODES];
        around.cells.kind[c as usize].values(&xi, &mut share);
        Some(around.cells.nodes(c as usize).iter().copied().zip(share).collect())
    };
    places.iter().map(of).collect()
}

/// Where (m) the material is that was at a node.
fn place<const D: usize>(scene: &Scene<D>, state: &State<D>, n: u32) -> [f64; D] {
    let (from, by) = (scene.mesh.nodes[n as usize], state.travel[n as usize]);
    std::array::from_fn(|d| from[d] + by[d])
}
