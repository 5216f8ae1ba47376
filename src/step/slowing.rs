//! What a grid reset would add to the energy of the motion is taken from it (docs/theory.md, section 4, *Energy of a reset*).

use super::balance::kinetic;
use super::family::interpolate;
use super::grid::Grid;
use super::momentum;
use super::scene::Scene;
use super::state::State;
use crate::error::Result;
use crate::kinematics::Kinematics;

/// Slows the motion of the soil within each of its bodies, whose momentum stays, so that it loses the energy `gained` (kJ): what points carry that no
/// equation has governed, as at the tip of a splash, must not come back as motion (docs/theory.md, section 4, *Energy of a reset*).
///
/// # Errors
/// As [`kinetic`].
pub fn slow<const D: usize, K: Kinematics<D>>(
    scene: &Scene<D>,
    grid: &mut Grid<D>,
    state: &mut State<D>,
    gained: f64,
) -> Result<()> {
    let rigid = momentum::rigid_part::<D, K>(scene, grid, state, &state.velocity);
    let mut within: Vec<[f64; D]> =
        state.velocity.iter().zip(&rigid).map(|(v, rigid)| std::array::from_fn(|d| v[d] - rigid[d])).collect();
    if let Some(fem) = &scene.fem {
        (0..fem.mesh.cells.len()).flat_map(|c| fem.mesh.cells.nodes(c)).for_each(|&n| within[n as usize] = [0.0; D]);
    }
    let with = |part: f64| -> Vec<[f64; D]> {
        state.velocity.iter().zip(&within).map(|(v, w)| std::array::from_fn(|d| v[d] + (part - 1.0) * w[d])).collect()
    };
    let [whole, without, own] = [
        kinetic(scene, grid, state, &state.velocity)?,
        kinetic(scene, grid, state, &with(0.0))?,
        kinetic(scene, grid, state, &within)?,
    ];
    if own <= 0.0 {
        return Ok(());
    }
    // The kinetic energy is a parabola in what is left of the motion.
    let mixed = whole - without - own;
    let left = (mixed * mixed + 4.0 * own * (whole - gained - without)).max(0.0).sqrt();
    let part = ((left - mixed) / (2.0 * own)).clamp(0.0, 1.0);
    let change: Vec<[f64; D]> = within.iter().map(|w| w.map(|w| (part - 1.0) * w)).collect();
    state.velocity = with(part);
    let of_points = interpolate::<D, K>(&grid.family_of_material(scene, state), &change);
    for (velocity, change) in state.points.velocity.iter_mut().zip(of_points) {
        (0..D).for_each(|d| velocity[d] += change[d]);
    }
    Ok(())
}
