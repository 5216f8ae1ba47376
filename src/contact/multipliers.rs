//! What contact nodes carry from step to step.

use std::ops::Range;

/// Share of a multiplier that its neighbours' mean takes the place of in each step.
const EVEN: f64 = 0.5;

/// What the contact nodes of an interface carry from step to step; one entry a contact node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Multipliers {
    /// Pressure and shear (kPa).
    pub pressure: Vec<f64>,
    pub shear: Vec<f64>,
    /// Mean gap and slip (m) of the last step.
    pub gap: Vec<f64>,
    pub slip: Vec<f64>,
    /// How much more (m) the points measure as gap.
    pub offset: Vec<f64>,
    /// Slip (m) of the soil while it touched since the run began, along the boundary with the structure on the left.
    pub slid: Vec<f64>,
    /// Force (kN) on the structure in the last step.
    pub force: Vec<[f64; 3]>,
    /// Whether there was before the contact node, in the last step, what it touches.
    pub faces: Vec<bool>,
    /// The nodes that the system has room to couple: those of contact node `k` are `room[first[k]..first[k + 1]]`.
    pub room: Vec<u32>,
    pub first: Vec<u32>,
}

impl Multipliers {
    /// Those of `contact_nodes` contact nodes that touch nothing yet.
    pub fn new(contact_nodes: usize) -> Self {
        let zero = vec![0.0; contact_nodes];
        Self {
            pressure: zero.clone(),
            shear: zero.clone(),
            gap: zero.clone(),
            slip: zero.clone(),
            offset: zero.clone(),
            slid: zero,
            force: vec![[0.0; 3]; contact_nodes],
            faces: vec![false; contact_nodes],
            room: Vec::new(),
            first: vec![0; contact_nodes + 1],
        }
    }

    /// These with the pressure evened out along the `runs`, where contact nodes and both their neighbours touch. Contact nodes as close as nodes have
    /// more conditions than the soil can meet: waves of pressure that it hardly feels would grow from step to step. What
    /// is taken from a wave here, a gap has to make up for (a stabilised multiplier, Burman & Hansbo 2010).
    pub fn evened(&self, runs: &[(Range<usize>, bool)]) -> Self {
        let mut evened = self.clone();
        for (run, is_loop) in runs {
            let contact_nodes = &self.pressure[run.clone()];
            let beside = |k: usize, by: usize| match k + by {
                at if *is_loop => Some(contact_nodes[at % contact_nodes.len()]),
                at => contact_nodes.get(at).copied(),
            };
            for k in 0..contact_nodes.len() {
                let left = if *is_loop {
                    beside(k, contact_nodes.len() - 1)
                } else {
                    k.checked_sub(1).map(|k| contact_nodes[k])
                };
                let (Some(left), Some(right)) = (left, beside(k, 1)) else { continue };
                if [left, contact_nodes[k], right].iter().all(|&pressure| pressure != 0.0) {
                    evened.pressure[run.start + k] += EVEN * (0.5 * (left + right) - contact_nodes[k]);
                }
            }
        }
        evened
    }

    /// The mean pressure (kPa) of the contact nodes that press.
    pub fn mean_pressure(&self) -> f64 {
        let pressing = self.pressure.iter().filter(|pressure| **pressure > 0.0);
        let (sum, count) = pressing.fold((0.0, 0), |(sum, count), pressure| (sum + pressure, count + 1));
        sum / f64::from(count.max(1))
    }

    /// Whether contact node `k` touched in the last step.
    pub fn touched(&self, k: usize) -> bool {
        self.pressure[k] != 0.0 || self.shear[k] != 0.0
    }

    /// Whether contact node `k` bears tension up to `limit` (kPa): it did not come to that in the last step or, where it did not touch, lies there.
    pub fn bonded(&self, k: usize, limit: f64, lies: bool) -> bool {
        if self.touched(k) { self.pressure[k] > -limit * (1.0 - 1e-6) } else { lies }
    }

    /// The nodes that contact node `k` has room for.
    pub fn room(&self, k: usize) -> &[u32] {
        &self.room[self.first[k] as usize..self.first[k + 1] as usize]
    }
}
