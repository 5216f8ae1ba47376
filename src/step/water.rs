//! The volume balance of the pore water in a step, for the log: the sum of the first bracket of eq. 36 of docs/theory.md, and the outflow.

use super::drainage;
use super::grid::Grid;
use super::problem::Solution;
use super::scene::Scene;
use super::state::State;
use crate::term::Trial;

/// The water of a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Balance {
    /// What the soil took up (m³, in plane strain per metre), and what left it at drained boundaries.
    pub taken_up: f64,
    pub left: f64,
    /// The sum (m³) of what each point took up or gave, without sign.
    pub exchanged: f64,
}

impl Balance {
    /// The error of the balance over what was exchanged (-).
    pub fn error(&self) -> f64 {
        if self.exchanged > 0.0 { (self.taken_up + self.left) / self.exchanged } else { 0.0 }
    }
}

/// The water in the points of each family over their volume when seeded, but for a constant: `J + n/K_w p`.
pub fn content<const D: usize>(scene: &Scene<D>, state: &State<D>) -> [Vec<f64>; 2] {
    let Some(water) = &scene.water else { return [Vec::new(), Vec::new()] };
    [state.integration(), &state.fem].map(|points| {
        let one = |p: usize| {
            let soil = points.by_material(p, &water.porous);
            soil.map_or(0.0, |soil| {
                points.deformation[p].determinant() + soil.storage(points.seeded_height(p)) * points.pore_pressure[p]
            })
        };
        (0..points.len()).map(one).collect()
    })
}

/// Water (m³) that leaves through surfaces in a step of `dt` (s), whose points are those before it.
pub fn through_surfaces<const D: usize>(
    scene: &Scene<D>,
    grid: &Grid<D>,
    state: &State<D>,
    solution: &Solution<D>,
    dt: f64,
) -> f64 {
    if scene.water.is_none() || !scene.phases[state.phase].flows {
        return 0.0;
    }
    let frame = grid.frame(&scene.mesh, state);
    let at_rest = Trial::at_rest(&solution.displacement, &state.displacement);
    let trial = Trial { pressure: &solution.pressure, flow_time: dt, ..at_rest };
    scene.terms.iter().map(|term| term.outflow(&frame, &trial)).sum()
}

/// The balance of a step, given the content of the points before it and what has left through surfaces; absent without water.
pub fn balance<const D: usize>(
    scene: &Scene<D>,
    grid: &Grid<D>,
    state: &State<D>,
    before: &[Vec<f64>; 2],
    solution: &Solution<D>,
    drained: f64,
) -> Option<Balance> {
    scene.water.as_ref()?;
    let after = content(scene, state);
    let mut balance = Balance { left: drained, ..Balance::default() };
    for (family, (before, after)) in grid.integrated(scene, state).zip(before.iter().zip(&after)) {
        for (&p, weight) in family.interpolation.points.iter().zip(&family.interpolation.weight) {
            let taken_up = weight * (after[p as usize] - before[p as usize]);
            balance.taken_up += taken_up;
            balance.exchanged += taken_up.abs();
        }
    }
    if scene.phases[state.phase].flows {
        let drained_nodes = drainage::nodes(scene, state, grid.integrated(scene, state));
        let unit = scene.pressure_unit.unwrap_or(1.0) * (1.0 - state.alpha_f(scene));
        for (equation, node) in grid.dofs.pores() {
            if drained_nodes.binary_search(&node).is_ok() {
                balance.left += solution.residual[equation] / unit;
            }
        }
    }
    Some(balance)
}
