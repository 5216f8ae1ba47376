//! Ramping of unbalanced forces in quasi-static phases (docs/theory.md, section 14).
//!
//! Added weight, removed walls, sudden loads and lost strength leave unbalanced forces `R₀` on the nodes as a phase begins, and a grid reset leaves what
//! the new cells resolve otherwise. Step cutting reduces neither. Where the first step of a phase or after a reset fails, from `t₀` on and of the size `Δt₀`,
//! the fraction `1 − (t − t₀)/Δt₀` of them is *held*, that is, balanced by a fictitious force, and released in proportion to the time `t`. Halved steps
//! then carry a part of them each, and from `t₀ + Δt₀` on nothing is held.
//! Phases `auto` do not ramp. A search for failure (`strength_reduction`) releases them in its first step, which takes no time.

use super::scene::Scene;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::mesh::shape::MAX_NODES;

/// The time (s) of a release that never comes.
pub const KEPT: f64 = f64::MAX;

/// Forces that are held.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct UnbalancedRamp<const D: usize> {
    /// `−R₀` (kN) on each node, and then on the unknowns of rigid bodies; empty where nothing is held.
    pub force: Vec<[f64; D]>,
    /// Times (s) in the phase at which all of it was held, and all of it is released, which is infinite where `force` is what is left of it.
    pub from: f64,
    pub until: f64,
}

impl<const D: usize> UnbalancedRamp<D> {
    /// The part (-) that is held at a time (s) of the phase.
    pub fn share(&self, time: f64) -> f64 {
        if self.force.is_empty() { 0.0 } else { (1.0 - (time - self.from) / (self.until - self.from)).max(0.0) }
    }

    /// Whether what is held is never released: what held a boundary that waves leave through.
    pub fn is_kept(&self) -> bool {
        self.until == KEPT
    }

    /// The largest force (kN) on a node.
    pub fn most(&self) -> f64 {
        self.force.iter().flatten().fold(0.0, |most, f| f.abs().max(most))
    }
}

impl<const D: usize> UnbalancedRamp<D> {
    /// Transfers the forces to a reset grid, given the grid `before`, the displacement (m) of its nodes and the cells that are `filled`: a
    /// force at the displaced position of a node is distributed to the nodes around that position by their shape functions, which conserves
    /// resultants and moments. Nodes of finite elements and rigid bodies keep theirs.
    pub fn carry(
        &mut self,
        scene: &Scene<D>,
        (before, displacement): (&Mesh<D>, &[[f64; D]]),
        after: (&Mesh<D>, &Locator<D>),
        filled: &[u32],
    ) {
        if self.force.is_empty() {
            return;
        }
        let mut own = vec![false; self.force.len()];
        let elements = scene.fem.iter().flat_map(|fem| &fem.mesh.cells.nodes);
        elements.for_each(|&n| own[n as usize] = true);
        let moved = |(n, x): (usize, &[f64; D])| {
            let place = std::array::from_fn(|d| x[d] + displacement[n][d]);
            (!own[n]).then_some(place)
        };
        let places: Vec<_> = before.nodes.iter().enumerate().map(moved).collect();
        self.force = spread(&self.force, &places, after, filled);
    }
}

/// Forces at the nodes of a grid with points in the cells `filled` that are equivalent to others at `places` (m), which are near the
/// nodes of their numbers; those without a place stay at their nodes.
fn spread<const D: usize>(
    force: &[[f64; D]],
    places: &[Option<[f64; D]>],
    (mesh, locator): (&Mesh<D>, &Locator<D>),
    filled: &[u32],
) -> Vec<[f64; D]> {
    let mut holds = vec![false; mesh.cells.len()];
    filled.iter().for_each(|&c| holds[c as usize] = true);
    let mut beside = vec![None; force.len()];
    for c in (0..mesh.cells.len()).filter(|&c| holds[c]) {
        mesh.cells.nodes(c).iter().for_each(|&n| beside[n as usize] = Some(c as u32));
    }
    let nearest = |x: &[f64; D]| {
        let apart = |y: &[f64; D]| x.iter().zip(y).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        let held = mesh.nodes.iter().zip(&beside).filter_map(|(y, cell)| Some((apart(y), (*cell)?)));
        held.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, cell)| cell)
    };
    let mut out = vec![[0.0; D]; force.len()];
    let (mut values, mut hint) = ([0.0; MAX_NODES], None);
    for (n, f) in force.iter().enumerate().filter(|(_, f)| f.iter().any(|f| *f != 0.0)) {
        let mut add = |n: usize, share: f64| (0..D).for_each(|d| out[n][d] += share * f[d]);
        // The nodes of an empty cell have no stiffness: the nearest cell with points is extended to there.
        let found = places.get(n).copied().flatten().and_then(|x| match locator.locate(mesh, &x, hint) {
            Some((c, xi)) if holds[c as usize] => Some((c, xi)),
            _ => nearest(&x).and_then(|c| Some((c, locator.extend(mesh, c, &x)?))),
        });
        let Some((c, xi)) = found else {
            add(n, 1.0);
            continue;
        };
        hint = Some(c);
        mesh.cells.kind[c as usize].values(&xi, &mut values);
        mesh.cells.nodes(c as usize).iter().zip(&values).for_each(|(&m, value)| add(m as usize, *value));
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::builder::rectangle;
    use crate::mesh::shape::CellKind;

    /// All is held as the ramp begins, half of it half way, and nothing at its end and after it.
    #[test]
    fn what_is_held_is_released_in_proportion_to_the_time() {
        let ramp = UnbalancedRamp { force: vec![[1.0, 0.0]], from: 2.0, until: 2.5 };
        assert_eq!([2.0, 2.25, 2.5, 3.0].map(|time| ramp.share(time)), [1.0, 0.5, 0.0, 0.0]);
        let kept = UnbalancedRamp { until: f64::INFINITY, ..ramp };
        assert_eq!(kept.share(9.0), 1.0);
    }

    /// Forces in soil that has moved, some of it out of the filled cells, have the resultant and the moment that they had where they were,
    /// act on nodes of filled cells alone, and are hardly larger; what has no place of its own stays.
    #[test]
    fn resultants_and_moments_are_kept() {
        type At = fn(&[f64; 2]) -> bool;
        // Where forces are, where the filled cells, and how far the soil has moved: a little, and by more than a cell.
        let ways: [(At, At, [f64; 2]); 2] =
            [(|x| x[1] < 2.01, |x| x[1] < 2.01, [0.2, 0.25]), (|x| x[0] < 2.01, |x| x[0] > 1.99, [1.7, 0.05])];
        for kind in [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q9] {
            let mesh = rectangle(kind, 4.0, 4.0, 4, 4, 0.0, 0);
            let locator = Locator::new(&mesh);
            for (loaded, filled, way) in ways {
                let within = |c: usize| mesh.cells.nodes(c).iter().all(|&n| filled(&mesh.nodes[n as usize]));
                let cells: Vec<u32> = (0..mesh.cells.len()).filter(|&c| within(c)).map(|c| c as u32).collect();
                let force = |x: &[f64; 2]| if loaded(x) { [(3.0 * x[0]).sin(), 1.0 + x[1]] } else { [0.0; 2] };
                let force: Vec<[f64; 2]> = mesh.nodes.iter().map(force).collect();
                let moved = |x: &[f64; 2]| [0, 1].map(|d| 0.95 * x[d] + way[d]);
                let stays = |n: usize| n == 0 && filled(&mesh.nodes[0]);
                let place = |(n, x): (usize, &[f64; 2])| (!stays(n)).then_some(moved(x));
                let places: Vec<_> = mesh.nodes.iter().enumerate().map(place).collect();
                let out = spread(&force, &places, (&mesh, &locator), &cells);
                let sums = |force: &[[f64; 2]], at: &dyn Fn(usize) -> [f64; 2]| {
                    force
                        .iter()
                        .enumerate()
                        .fold([0.0; 3], |[x, y, m], (n, f)| [x + f[0], y + f[1], m + at(n)[0] * f[1] - at(n)[1] * f[0]])
                };
                let before = sums(&force, &|n| places[n].unwrap_or(mesh.nodes[n]));
                let after = sums(&out, &|n| mesh.nodes[n]);
                assert!(before.iter().zip(&after).all(|(a, b)| (a - b).abs() < 1e-9), "{kind:?}: {before:?} {after:?}");
                assert!(mesh.nodes.iter().zip(&out).all(|(x, f)| filled(x) || *f == [0.0; 2]), "{kind:?}");
                let most = |force: &[[f64; 2]]| force.iter().flatten().fold(0.0, |most: f64, f| most.max(f.abs()));
                assert!(most(&out) < 4.0 * most(&force), "{kind:?}: {} {}", most(&out), most(&force));
            }
        }
    }
}
