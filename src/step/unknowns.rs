//! The unknowns of a step, by node and cell as the state has them.

use super::grid::Grid;
use super::newton::Problem;

/// Displacement of the nodes and, where there is one, the pressure field.
#[derive(Default)]
pub struct Unknowns<const D: usize> {
    /// Displacement of the nodes (m) since the grid was restored.
    pub displacement: Vec<[f64; D]>,
    /// As [`super::State::pressure`] (kPa).
    pub pressure: Vec<f64>,
}

impl<const D: usize> Unknowns<D> {
    pub fn set(&mut self, displacement: &[[f64; D]], pressure: &[f64]) {
        self.displacement.clear();
        self.displacement.extend_from_slice(displacement);
        self.pressure.clear();
        self.pressure.extend_from_slice(pressure);
    }

    pub fn clone_from(&mut self, other: &Self) {
        self.set(&other.displacement, &other.pressure);
    }

    /// Adds `length · δ`, one entry an equation; a full step lands on what is given to the last bit.
    pub fn advance(&mut self, problem: &Problem<D>, grid: &Grid<D>, delta: &[f64], length: f64) {
        let (of_nodes, of_pressure) = delta.split_at(D * grid.node.len());
        for (e, delta) in of_nodes.iter().enumerate() {
            let (n, d) = (grid.node[e / D] as usize, e % D);
            match problem.given[e] {
                Some(increment) if length == 1.0 => self.displacement[n][d] = problem.converged[n][d] + increment,
                _ => self.displacement[n][d] += length * delta,
            }
        }
        let unit = problem.scene.pressure_unit.unwrap_or(0.0);
        let given = problem.given[of_nodes.len()..].iter();
        for ((delta, &unknown), given) in of_pressure.iter().zip(&grid.carrier).zip(given) {
            let unknown = unknown as usize;
            match given {
                Some(increment) if length == 1.0 => self.pressure[unknown] = problem.pressure[unknown] + increment,
                _ => self.pressure[unknown] += length * unit * delta,
            }
        }
    }
}
