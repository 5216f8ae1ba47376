//! The rigid bodies of a run (docs/theory.md, section 13, eq. 31): their nodes and points follow their unknowns.
//!
//! Within a step contact uses the linearised motion of a body. Once the step has converged, its nodes and points are placed by the rotation
//! itself, from their positions when the run began, so that it keeps its shape.

use super::grid::Grid;
use super::scene::Scene;
use super::state::State;
use crate::rigid::Pose;
use crate::system::{Matrix, Pattern};
use crate::tensor::Tensor;

/// The displacement (m) of the unknown `n` of a body since the run began, for a `displacement` since the last grid reset.
fn travel<const D: usize>(state: &State<D>, displacement: &[[f64; D]], n: u32) -> [f64; D] {
    let n = n as usize;
    std::array::from_fn(|d| state.travel[n][d] + displacement[n][d] - state.displacement[n][d])
}

/// Completes the `displacement` at the end of a step by that of the nodes of rigid bodies.
pub fn follow<const D: usize>(scene: &Scene<D>, state: &State<D>, displacement: &mut [[f64; D]]) {
    for body in &scene.bodies {
        let pose = body.pose(|n| travel(state, displacement, n));
        for &n in &body.nodes {
            let n = n as usize;
            let from = state.at_reset(scene, n as u32);
            let to = body.place(&pose, &scene.mesh.nodes[n]);
            displacement[n] = std::array::from_fn(|d| to[d] - from[d]);
        }
    }
}

/// Moves the points of rigid bodies to the pose at the end of a step.
pub fn move_points<const D: usize>(scene: &Scene<D>, state: &mut State<D>, displacement: &[[f64; D]]) {
    for body in &scene.bodies {
        let pose = body.pose(|n| travel(state, displacement, n));
        let rotation = rotation(&pose);
        for p in 0..state.fem.len() {
            if state.fem.region[p] == body.region {
                state.fem.position[p] = body.place(&pose, &state.fem.origin[p]);
                state.fem.deformation[p] = rotation;
            }
        }
    }
}

fn rotation<const D: usize>(pose: &Pose<D>) -> Tensor {
    let mut rotation = Tensor::identity();
    for j in 0..D {
        let unit: [f64; D] = std::array::from_fn(|d| if d == j { 1.0 } else { 0.0 });
        for (i, v) in pose.turn(&unit).iter().enumerate() {
            rotation[(i, j)] = *v;
        }
    }
    rotation
}

fn arm<const D: usize>(centre: &[f64; D], x: &[f64; D]) -> [f64; D] {
    std::array::from_fn(|d| x[d] - centre[d])
}

/// Gives the points of bodies their motion, and the nodes of bodies their velocity.
pub fn motion_to_points<const D: usize>(scene: &Scene<D>, state: &mut State<D>) {
    for body in &scene.bodies {
        let centre = body.centre_after(&state.travel);
        for p in (0..state.fem.len()).filter(|&p| state.fem.region[p] == body.region) {
            let arm = arm(&centre, &state.fem.position[p]);
            state.fem.velocity[p] = body.motion(&arm, &state.velocity);
            state.fem.acceleration[p] = body.motion(&arm, &state.acceleration);
        }
        for &n in &body.nodes {
            let n = n as usize;
            let from = state.at_reset(scene, n as u32);
            let x = std::array::from_fn(|d| from[d] + state.displacement[n][d]);
            state.velocity[n] = body.motion(&arm(&centre, &x), &state.velocity);
        }
    }
}

/// Adds momentum and moment of momentum of the points of bodies, and the same of their accelerations, to the right-hand
/// sides of the nodes, one entry a block.
pub fn momentum<const D: usize>(scene: &Scene<D>, grid: &Grid<D>, state: &State<D>, right: &mut [Vec<[f64; D]>; 2]) {
    for body in &scene.bodies {
        let centre = body.centre_after(&state.travel);
        for p in (0..state.fem.len()).filter(|&p| state.fem.region[p] == body.region) {
            let arm = arm(&centre, &state.fem.position[p]);
            for (right, field) in right.iter_mut().zip([&state.fem.velocity, &state.fem.acceleration]) {
                let share = body.hand_on(&arm, &field[p].map(|v| state.fem.mass[p] * v));
                for (n, share) in body.dofs.numbers().zip(share) {
                    let sum = &mut right[grid.dofs.block[n as usize] as usize];
                    *sum = std::array::from_fn(|d| sum[d] + share[d]);
                }
            }
        }
    }
}

/// Adds mass and inertia of bodies to the mass of the nodes.
pub fn add_mass<const D: usize>(scene: &Scene<D>, block: &[u32], pattern: &Pattern, mass: &mut Matrix) {
    for body in &scene.bodies {
        for (n, value) in body.masses() {
            mass.add_diagonal(pattern, block[n as usize] as usize, value);
        }
    }
}

/// The moment (kN m) about the origin, in the plane, of a `force` (kN) on a node or an unknown of a body after a `displacement` (m) since the last
/// grid reset.
pub fn moment<const D: usize>(
    scene: &Scene<D>,
    state: &State<D>,
    displacement: &[[f64; D]],
    n: u32,
    force: &[f64; D],
) -> f64 {
    const { assert!(D == 2, "moments are numbers in the plane only") };
    if let Some(dofs) = scene.turning(n) {
        return dofs.moment(force);
    }
    let (from, by) = (state.at_reset(scene, n), &displacement[n as usize]);
    let x: [f64; D] = std::array::from_fn(|d| from[d] + by[d]);
    x[0] * force[1] - x[1] * force[0]
}

/// Momentum (t m/s) of the sudden change of velocity of bodies whose motion the step prescribes.
pub fn impulse<const D: usize>(scene: &Scene<D>, state: &State<D>, velocity: &[[f64; D]]) -> [f64; D] {
    let mut impulse = [0.0; D];
    for body in &scene.bodies {
        let n = body.dofs.translation as usize;
        impulse = std::array::from_fn(|d| impulse[d] + body.mass * (velocity[n][d] - state.velocity[n][d]));
    }
    impulse
}
