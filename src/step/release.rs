//! What is out of balance as a quasi-static phase begins, released little by little where it cannot be at once.
//!
//! Weights that come, walls that go, loads that are there at once and strength that is lost leave forces `R₀` on the nodes, and no step
//! is so small that they are less. Where the first step fails they are held, and released in proportion to the time until
//! that step would have ended: steps that are halved then have less to bear. From there on nothing is left of them. Phases that look for
//! failure, or hand it to dynamics, hold nothing.

use super::balance::static_force;
use super::grid::Grid;
use super::newton::Problem;
use super::scene::Scene;
use super::state::State;
use crate::error::Result;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::mesh::shape::MAX_NODES;
use crate::rigid::Body;

/// Share of the largest term from which on it is worth holding what is out of balance: a grid that was restored leaves less.
const WORTH: f64 = 1e-3;

/// Forces that are held.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Release<const D: usize> {
    /// The negative of what is out of balance at each node (kN) as the phase begins; empty where nothing is held.
    pub force: Vec<[f64; D]>,
    /// Time (s) in the phase at which all of it is released.
    pub until: f64,
}

impl<const D: usize> Release<D> {
    /// The part (-) that is held at a time (s) of the phase.
    pub fn share(&self, time: f64) -> f64 {
        if self.force.is_empty() { 0.0 } else { (1.0 - time / self.until).max(0.0) }
    }

    /// The largest force (kN) on a node.
    pub fn most(&self) -> f64 {
        self.force.iter().flatten().fold(0.0, |most, f| f.abs().max(most))
    }
}

/// Holds what is out of balance, if anything is, after a first step of the size `dt` (s) that failed.
///
/// # Errors
/// When the state is inadmissible on the restored grid.
pub fn hold<const D: usize>(scene: &Scene<D>, grid: &mut Grid<D>, state: &mut State<D>, dt: f64) -> Result<()> {
    let phase = &scene.phases[state.phase];
    let looks_for_failure = phase.auto || phase.search.is_some();
    if looks_for_failure || state.dynamic(scene) || state.phase_time > 0.0 || !state.release.force.is_empty() {
        return Ok(());
    }
    let now = static_force(&Problem { to: dt, ..Problem::at_rest(scene, state) }, grid)?;
    let mut by_node = vec![[0.0; D]; scene.mesh.nodes.len()];
    for (f, &n) in now.force.chunks_exact(D).zip(&grid.node) {
        by_node[n as usize] = std::array::from_fn(|d| -f[d]);
    }
    for fixed in scene.fixed(state.phase) {
        fixed.nodes.iter().for_each(|&n| by_node[n as usize][fixed.component] = 0.0);
    }
    let size = by_node.iter().flatten().map(|f| f * f).sum::<f64>().sqrt();
    if size <= WORTH * now.scale {
        return Ok(());
    }
    state.release = Release { force: by_node, until: dt };
    Ok(())
}

/// Takes the forces that are held to a restored grid, given that `before`: those at its nodes, which have moved with the soil, go to the
/// nodes around where they are, so that resultants stay. Finite elements and bodies keep theirs.
pub fn carry<const D: usize>(
    scene: &Scene<D>,
    before: &Mesh<D>,
    (after, locator): (&Mesh<D>, &Locator<D>),
    state: &mut State<D>,
) {
    if state.release.force.is_empty() {
        return;
    }
    let mut own = vec![false; state.release.force.len()];
    let elements = scene.fem.iter().flat_map(|fem| &fem.mesh.cells.nodes);
    let bodies = scene.bodies.iter().flat_map(Body::carriers);
    elements.copied().chain(bodies).for_each(|n| own[n as usize] = true);
    let mut holds = vec![false; after.cells.len()];
    state.points.cell.iter().for_each(|&c| holds[c as usize] = true);
    let mut beside = vec![None; state.release.force.len()];
    for c in (0..after.cells.len()).filter(|&c| holds[c]) {
        after.cells.nodes(c).iter().for_each(|&n| beside[n as usize] = Some(c as u32));
    }
    let mut force = vec![[0.0; D]; state.release.force.len()];
    let (mut values, mut hint) = ([0.0; MAX_NODES], None);
    for (n, f) in state.release.force.iter().enumerate().filter(|(_, f)| f.iter().any(|f| *f != 0.0)) {
        let mut add = |n: usize, share: f64| (0..D).for_each(|d| force[n][d] += share * f[d]);
        let moved = |x: &[f64; D]| std::array::from_fn(|d| x[d] + state.displacement[n][d]);
        let place = before.nodes.get(n).filter(|_| !own[n]).map(moved);
        // The nodes of an empty cell would give way: a cell with points beside the node goes on to there.
        let found = place.and_then(|x| match locator.locate(after, &x, hint) {
            Some((c, xi)) if holds[c as usize] => Some((c, xi)),
            _ => beside[n].and_then(|c| Some((c, locator.extend(after, c, &x)?))),
        });
        let Some((c, xi)) = found else {
            add(n, 1.0);
            continue;
        };
        hint = Some(c);
        after.cells.kind[c as usize].values(&xi, &mut values);
        after.cells.nodes(c as usize).iter().zip(&values).for_each(|(&m, value)| add(m as usize, *value));
    }
    state.release.force = force;
}
