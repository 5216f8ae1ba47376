//! The motion with which a step with inertia begins: that of the nodes, stopped or pushed where their displacement is prescribed
//! (docs/theory.md, section 4).

use super::driven::{self, Ends};
use super::family::Family;
use super::grid::Grid;
use super::mass::{Carrier, Mass};
use super::rigid;
use super::scene::Scene;
use super::state::State;
use crate::error::Result;
use crate::interpolation::MAX_FUNCTIONS;
use crate::kinematics::Kinematics;
use crate::time_value::Motion;

/// What a field lacks at the active nodes of what is `wanted` there, one entry an equation, zero at others, by component.
fn lacks<const D: usize>(grid: &Grid<D>, wanted: &[Option<f64>], field: &[[f64; D]]) -> [Vec<f64>; D] {
    let now: Vec<[f64; D]> = grid.dofs.node.iter().map(|&n| grid.dofs.value(n, |m| field[m as usize])).collect();
    std::array::from_fn(|d| {
        let lacks = |(b, now): (usize, &[f64; D])| wanted[b * D + d].map_or(0.0, |wanted| wanted - now[d]);
        now.iter().enumerate().map(lacks).collect()
    })
}

/// Adds to a field what is given at the active nodes, by component.
fn change<const D: usize>(grid: &Grid<D>, by: &[Vec<f64>; D], field: &mut [[f64; D]]) {
    let mut change = vec![[0.0; D]; field.len()];
    by.iter().enumerate().for_each(|(d, by)| grid.dofs.write(by, d, &mut change));
    add(field, &change);
}

/// What of a velocity (-) is rounding.
const ROUNDING: f64 = 1e-12;

/// Velocity (m/s) and acceleration (m/s²) of the nodes at the beginning of a step.
pub struct Start<const D: usize> {
    pub velocity: Vec<[f64; D]>,
    pub acceleration: Vec<[f64; D]>,
    /// What the weight of contact gives to motions of frequencies that the step does not resolve (kN, one entry an equation; docs/theory.md, eq. 6b);
    /// empty where there is none.
    pub unresolved: Vec<f64>,
    /// The motion at the end of the step where nodes are driven.
    pub driven: Ends,
}

impl<const D: usize> Start<D> {
    /// The motion in `state`. Nodes whose displacement is prescribed move at the constant speed of the step instead, those driven by a record of
    /// acceleration as that has it. Their sudden
    /// change of velocity (an impact, a kink of a table) is part of the increment that [`motion_to_points`](super::transfer::motion_to_points) gives to the points.
    ///
    /// It is an impulse on these nodes alone: the momentum of all others stays, and as nodes share mass their velocities do not. So what is stopped
    /// loses energy, the more the larger the mass; were the others left to move as before, it might gain some.
    ///
    /// # Errors
    /// As [`Mass::assemble`].
    pub fn of<K: Kinematics<D>>(
        scene: &Scene<D>,
        grid: &mut Grid<D>,
        state: &State<D>,
        given: &[Option<f64>],
        dt: f64,
    ) -> Result<Self> {
        let (velocity, acceleration) = (state.velocity.clone(), state.acceleration.clone());
        let (begins, driven) = driven::motion(scene, state, grid, dt);
        let mut start = Self { velocity, acceleration, unresolved: Vec::new(), driven };
        let wanted = |of_steady: f64, of_driven: fn(&Motion) -> f64| {
            let mut wanted: Vec<Option<f64>> = given.iter().map(|given| given.map(|by| by * of_steady)).collect();
            begins.iter().for_each(|(equation, motion)| wanted[*equation] = Some(of_driven(motion)));
            wanted
        };
        let halt = lacks(grid, &wanted(0.0, |motion| motion.acceleration), &start.acceleration);
        change(grid, &halt, &mut start.acceleration);
        let mut jump = lacks(grid, &wanted(1.0 / dt, |motion| motion.velocity), &start.velocity);
        let largest = start.velocity.iter().flatten().fold(0.0, |most: f64, v| most.max(v.abs()));
        if jump.iter().flatten().any(|by| by.abs() > ROUNDING * largest) {
            let mut mass = Mass::assemble::<D, K>(scene, grid, state, Carrier::IntegrationPoints)?;
            for (d, jump) in jump.iter_mut().enumerate() {
                let fixed: Vec<bool> = (0..jump.len()).map(|b| given[b * D + d].is_some()).collect();
                let by = std::mem::replace(jump, vec![0.0; fixed.len()]);
                mass.solve_given(&fixed, &by, jump)?;
            }
        }
        change(grid, &jump, &mut start.velocity);
        Ok(start)
    }

    /// Momentum (t m/s) of that sudden change, summed over the nodes.
    pub fn impulse<K: Kinematics<D>>(&self, scene: &Scene<D>, grid: &Grid<D>, state: &State<D>) -> [f64; D] {
        let mut impulse = rigid::impulse(scene, state, &self.velocity);
        for Family { mesh, interpolation, points, .. } in grid.integrated(scene, state) {
            for cell_points in &interpolation.filled {
                let nodes = interpolation.nodes(mesh, cell_points.cell);
                let mut jump = [[0.0; D]; MAX_FUNCTIONS];
                for (jump, &n) in jump.iter_mut().zip(nodes) {
                    let (now, before) = (&self.velocity[n as usize], &state.velocity[n as usize]);
                    *jump = std::array::from_fn(|d| now[d] - before[d]);
                }
                if jump.iter().flatten().all(|&v| v == 0.0) {
                    continue;
                }
                for entries in interpolation.entries::<K>(cell_points) {
                    for (n, jump) in entries.value.iter().zip(&jump) {
                        for d in 0..D {
                            impulse[d] += points.mass[entries.point] * n * jump[d];
                        }
                    }
                }
            }
        }
        impulse
    }
}

pub(super) fn add<const D: usize>(to: &mut [[f64; D]], increment: &[[f64; D]]) {
    for (to, by) in to.iter_mut().zip(increment) {
        for d in 0..D {
            to[d] += by[d];
        }
    }
}
