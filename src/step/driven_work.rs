//! The work of inertia at nodes that a record of acceleration moves (docs/theory.md, section 5, *Base motion*).

use super::balance::inertia;
use super::driven;
use super::grid::Grid;
use super::problem::Solution;
use super::scene::Scene;
use super::start::Start;
use super::state::State;
use super::transfer::end_motion;
use crate::dofs::Dof;
use crate::error::Result;
use crate::time_integration::GeneralisedAlpha;
use crate::time_value::Motion;

/// The work (kJ) of inertia at driven nodes along the way on which the trapezoidal rule keeps the balance of energy, less that along their displacement: a
/// record that is linear in the step has another displacement.
///
/// # Errors
/// As [`inertia`].
pub fn by_record<const D: usize>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &State<D>,
    (solution, start): (&Solution<D>, &Start<D>),
    dt: f64,
) -> Result<f64> {
    if start.driven.is_empty() {
        return Ok(0.0);
    }
    let integration = GeneralisedAlpha::new(scene.numerics.spectral_radius, dt);
    let ends = solution.displacement.iter().zip(&state.displacement).enumerate();
    let acceleration: Vec<[f64; D]> = ends
        .map(|(n, (now, before))| {
            std::array::from_fn(|d| {
                let [end, _] = end_motion(&integration, (start, &[]), (n, d), now[d] - before[d]);
                integration.weighted(start.acceleration[n][d], end)
            })
        })
        .collect();
    let force = inertia(scene, grid, state, &acceleration)?;
    let more = |(equation, from): &(usize, Motion)| match grid.dofs.dof(*equation) {
        Dof::Pressure(_) => 0.0,
        Dof::Displacement { node, component } => {
            let to = start.driven[&(node as u32, component)];
            let way = to.displacement - from.displacement;
            force[*equation] * (0.5 * dt * (from.velocity + to.velocity) - way)
        }
    };
    Ok(driven::motion(scene, state, grid, dt).0.iter().map(more).sum())
}
