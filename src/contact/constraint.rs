//! The condition of a contact node in a step.

use super::law::Penalty;
use super::motion::{Motion, Spot};

/// Gap over which adhesion fades (-), in the spacing of the contact nodes.
pub(super) const FADING: f64 = 0.05;

/// The condition of a contact node: its mean gap and slip in the step. The slip is linear in the displacements since its beginning, and so is the
/// gap of a boundary that is flat. Soil that flows along a curved boundary turns with it: of what moves by `a` along the boundary the normal
/// turns by `κ a`, and a way along the first normal would take it `½ κ a²` farther away.
#[derive(Clone, Debug, PartialEq)]
pub struct Constraint<const D: usize> {
    pub contact_node: u32,
    /// Area (m²) under the contact node where there is soil.
    pub area: f64,
    /// Mean gap (m) at the beginning of the step.
    pub gap: f64,
    /// Its mean place [x, y] (m) where there are pores that water may stand in.
    pub wet: Option<[f64; 2]>,
    /// The nodes of the structure, `own` of them that bear the force on it, then those of the grid.
    pub nodes: Vec<u32>,
    pub own: usize,
    /// Derivatives of gap and slip (-) by the displacement of the nodes.
    pub by_normal: Vec<[f64; D]>,
    pub by_tangent: Vec<[f64; D]>,
    /// Curvature κ (1/m) of the boundary, positive where the structure is convex, and the derivatives of the way `a` of the soil along it,
    /// seen from the structure without its rotation.
    pub curvature: f64,
    pub by_arc: Vec<[f64; D]>,
    /// How the gap varies under the contact node as the step begins; empty where only its mean counts.
    pub spots: Vec<Spot>,
    /// Whether with inertia the gap counts half a step ahead: that to material points on a restored grid, whose velocities are mapped, does not.
    pub looks_ahead: bool,
    pub penalty: Penalty,
}

impl<const D: usize> Constraint<D> {
    /// Whether the two lie on each other as the step begins, pressed or not.
    pub fn lies(&self) -> bool {
        self.gap < self.penalty.fading
    }

    /// What it comes to after the nodes moved by `increment` (m), given by node.
    pub fn measure(&self, increment: impl Fn(u32) -> [f64; D]) -> Motion {
        let (mut gap, mut slip, mut arc) = (self.gap, 0.0, 0.0);
        for (k, &n) in self.nodes.iter().enumerate() {
            let u = increment(n);
            for d in 0..D {
                gap += self.by_normal[k][d] * u[d];
                slip += self.by_tangent[k][d] * u[d];
                arc += self.by_arc[k][d] * u[d];
            }
        }
        let turn = self.curvature * arc;
        Motion { gap: gap + 0.5 * turn * arc, slip, turn, ..Motion::default() }
    }

    /// The motion with what the nodes move by `ahead` (m) after it.
    pub fn ahead(&self, mut motion: Motion, ahead: &[[f64; D]]) -> Motion {
        for (k, &n) in self.nodes.iter().enumerate() {
            let normal = self.normal(k, motion.turn);
            for (d, u) in ahead[n as usize].iter().enumerate() {
                motion.ahead += normal[d] * u;
                motion.ahead_turn += self.curvature * self.by_arc[k][d] * u;
            }
        }
        motion
    }

    /// Begins where a `motion` led to.
    pub fn go_on(&mut self, motion: Motion) {
        self.gap = motion.gap;
        for k in 0..self.nodes.len() {
            self.by_normal[k] = self.normal(k, motion.turn);
        }
        self.spots.iter_mut().for_each(|spot| spot.open += motion.turn * spot.along);
    }

    /// The derivative (-) of the gap by the displacement of node `k` of the constraint, where the normal has turned by `turn` (rad).
    pub fn normal(&self, k: usize, turn: f64) -> [f64; D] {
        std::array::from_fn(|d| self.by_normal[k][d] + turn * self.by_arc[k][d])
    }
}

/// A node, and the derivatives of gap, slip and maybe the way along the boundary by its displacement.
pub type Entry<const D: usize, const N: usize> = (u32, [[f64; D]; N]);

/// Adds to the entry of a node.
pub fn add<const D: usize, const N: usize>(entries: &mut Vec<Entry<D, N>>, node: u32, more: &[[f64; D]; N]) {
    match entries.iter_mut().find(|(n, _)| *n == node) {
        Some((_, by)) => by.iter_mut().flatten().zip(more.iter().flatten()).for_each(|(by, more)| *by += more),
        None => entries.push((node, *more)),
    }
}
