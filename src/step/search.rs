//! The search for the factor that strengths may be divided by until there is no equilibrium (docs/theory.md, section 9, *Strength reduction*).
//!
//! It is one of small displacements: forces act and strains are taken on the geometry of the beginning of the phase. Soil that fails has no
//! equilibrium then. Where the geometry follows, it may slide into a flatter shape that stands, at each factor another one. The grid is
//! not reset; the points move as the displacements say.

use super::ramp::UnbalancedRamp;
use super::unbalanced;
use super::{Controller, Lagrange, Report, Simulation, Solution};
use crate::error::{Error, Kind, Result};
use crate::kinematics::Kinematics;

/// The factor at the kink of a curve of displacements (m) over factors, where its first and its last tangent cross; `None` where it does not rise
/// more than `sudden` times (-) as fast at its end as in the mean.
pub fn kink(curve: &[[f64; 2]], sudden: f64) -> Option<f64> {
    let [first, second, .., before, last] = curve else { return None };
    let slope = |a: &[f64; 2], b: &[f64; 2]| (b[1] - a[1]) / (b[0] - a[0]);
    let (begin, end) = (slope(first, second), slope(before, last));
    let bends = end > begin && end > sudden * slope(first, last);
    bends.then(|| last[0] - (last[1] - first[1] - begin * (last[0] - first[0])) / (end - begin))
}

impl<const D: usize, K: Kinematics<D>> Simulation<'_, D, K> {
    /// Whether the next step is the first of a search.
    pub(super) fn begins_search(&self) -> bool {
        self.state.search_curve.is_empty() && self.scene.phases[self.state.phase].search.is_some()
    }

    /// The first step of a search: equilibrium under its loads with the strengths that it begins with, which takes no time. What is out of balance
    /// is released in parts where it cannot be at once.
    ///
    /// # Errors
    /// Analysis: there is no such equilibrium.
    pub(super) fn begin_search(&mut self, controller: &Controller) -> Result<Report<D>> {
        self.initialise(true)?;
        self.state.search_geometry.clone_from(&self.state.displacement);
        let (mut held, mut part, mut halvings) = (1.0, 1.0, Vec::new());
        let mut all: Option<Vec<[f64; D]>> = None;
        loop {
            self.initialise(false)?;
            let next: f64 = held - part;
            self.state.ramp = match &all {
                Some(force) if next > 0.0 => {
                    let share = |f: &[f64; D]| f.map(|f| next * f);
                    UnbalancedRamp { force: force.iter().map(share).collect(), from: 0.0, until: f64::INFINITY }
                }
                _ => UnbalancedRamp::default(),
            };
            match self.lagrange(0.0, None).and_then(|found| self.complete(0.0, found)) {
                Ok(complete) => {
                    let report = self.convect(0.0, complete);
                    // What the soil moved by here says nothing on the next step.
                    self.state.increment.fill([0.0; D]);
                    held = next;
                    if held <= 0.0 {
                        let factor = self.scene.phases[self.state.phase].reduction_at(0.0);
                        self.state.search_curve.push([factor, 0.0]);
                        return Ok(Report { halvings, ..report });
                    }
                }
                Err(error) if error.kind == Kind::Analysis => {
                    if all.is_none() {
                        all = unbalanced::to_hold(
                            self.scene,
                            &mut self.grid,
                            &self.state,
                            (0.0, self.scene.numerics.tolerance),
                        )?;
                    }
                    part *= 0.5;
                    if all.is_none() || part < controller.finest() {
                        return Err(self.unstable(held, &error));
                    }
                    halvings.push(format!("{}: {}", error.place, error.problem));
                }
                Err(error) => return Err(error),
            }
        }
    }

    fn unstable(&self, held: f64, error: &Error) -> Error {
        let factor = self.scene.phases[self.state.phase].reduction_at(0.0);
        let released = 100.0 * (1.0 - held);
        Error::analysis(
            "strength reduction",
            format!(
                "no equilibrium is found with the strengths divided by {factor}, at which the search begins ({released:.0} % of what is out of balance \
                 is released): {} {}",
                error.place, error.problem
            ),
            "if the soil fails at that, let the search begin with a smaller factor, such as `strength_reduction: {table: [[0, 0.5], [1, 1.5]]}`",
        )
    }

    /// Adds a step of `dt` (s) that has its solution to the curve of a search.
    pub(super) fn note_search(&mut self, dt: f64, solution: &Solution<D>) {
        let phase = &self.scene.phases[self.state.phase];
        let Some(&[_, before]) = self.state.search_curve.last() else { return };
        let factor = phase.reduction_at(self.state.phase_time + dt);
        let moved = self.moved(solution);
        self.state.search_curve.push([factor, before + moved]);
    }

    /// In a search: rejects an equilibrium that is reached only after a large displacement, as failure would be.
    pub(super) fn stands(&self, dt: f64, found: Lagrange<D>) -> Result<Lagrange<D>> {
        let phase = &self.scene.phases[self.state.phase];
        let Some(search) = &phase.search else { return Ok(found) };
        let from = self.state.phase_time;
        let more = phase.reduction_at(from + dt) - phase.reduction_at(from);
        let moved = self.moved(&found.1);
        if more <= 0.0 || moved <= search.farthest * more {
            return Ok(found);
        }
        Err(Error::analysis(
            "strength reduction",
            format!("there is equilibrium only after the soil has moved by {moved:.3e} m"),
            "the largest factor with equilibrium is the result",
        ))
    }

    /// The largest displacement (m) of soil in a step of a search.
    fn moved(&self, solution: &Solution<D>) -> f64 {
        let elements = self.scene.phases[self.state.phase].search.iter().flat_map(|search| &search.elements);
        let filled = self.grid.interpolations.integration.filled.iter();
        let nodes = filled.flat_map(|cell_points| self.scene.mesh.cells.nodes(cell_points.cell as usize));
        let squared = |&n: &u32| {
            let (now, before) = (&solution.displacement[n as usize], &self.state.displacement[n as usize]);
            now.iter().zip(before).map(|(now, before)| (now - before).powi(2)).sum::<f64>()
        };
        nodes.chain(elements).map(squared).fold(0.0, f64::max).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::kink;

    /// The tangents of a curve that goes by 0.1 m per unit up to 1.5, and by 20 beyond, cross there; a straight curve has no kink, nor has one that
    /// bends slowly.
    #[test]
    fn a_kink_is_where_the_tangents_cross() {
        let bent = |f: f64| if f < 1.5 { 0.1 * (f - 1.0) } else { 0.05 + 20.0 * (f - 1.5) };
        let curve = |of: &dyn Fn(f64) -> f64| [1.0, 1.2, 1.4, 1.5, 1.51, 1.52].map(|f| [f, of(f)]);
        assert!((kink(&curve(&bent), 10.0).unwrap() - 1.5).abs() < 1e-12);
        assert_eq!(kink(&curve(&|f| 0.5 * (f - 1.0)), 1.01), None);
        assert_eq!(kink(&curve(&|f| (f - 1.0f64).powi(3)), 10.0), None);
        assert_eq!(kink(&[[1.0, 0.0]], 1.0), None);
    }
}
