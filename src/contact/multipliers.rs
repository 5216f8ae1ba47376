//! What contact nodes carry from step to step.

use super::law::{Answer, Law};
use super::surface::Run;

/// Share of a multiplier that its neighbours' mean takes the place of in each step.
const EVEN: f64 = 0.5;
/// A sixteenth of the fourth difference. Subtracted, it removes an oscillation from contact node to contact node, and leaves a cubic as it is.
const FOURTH: [f64; 5] = [1.0 / 16.0, -0.25, 0.375, -0.25, 1.0 / 16.0];

/// What the contact nodes of an interface carry from step to step; one entry a contact node.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Multipliers {
    /// Pressure and shear (kPa).
    pub pressure: Vec<f64>,
    pub shear: Vec<f64>,
    /// Mean gap (m) at the end of the last step, and how far (m) the soil slid along it in that step.
    pub gap: Vec<f64>,
    pub slip: Vec<f64>,
    /// Slip (m) of the soil while it touched since the run began, along the boundary with the structure on the left.
    pub slid: Vec<f64>,
    /// Force (kN) on the structure in the last step.
    pub force: Vec<[f64; 3]>,
    /// Whether there was before the contact node, in the last step, what it touches.
    pub faces: Vec<bool>,
    /// Whether it is apart from the soil: see [`Multipliers::is_apart`].
    pub apart: Vec<bool>,
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
            slid: zero,
            force: vec![[0.0; 3]; contact_nodes],
            faces: vec![false; contact_nodes],
            apart: vec![true; contact_nodes],
            room: Vec::new(),
            first: vec![0; contact_nodes + 1],
        }
    }

    /// These with oscillations of the pressure smoothed along the `runs`, where a contact node and both its neighbours are closed. Contact nodes as close
    /// as the nodes of the grid are more conditions than the soil can satisfy: oscillations of the pressure, to which the soil hardly responds, would
    /// grow from step to step. The pressure that is removed is replaced by that of a gap (a stabilised multiplier, Burman & Hansbo 2010).
    pub fn evened(&self, runs: &[Run]) -> Self {
        let mut evened = self.clone();
        for run in runs {
            for k in 0..run.0.len() as isize {
                let Some([left, at, right]) = self.in_a_row(run, [k - 1, k, k + 1], |pressure| pressure != 0.0) else {
                    continue;
                };
                let mean = 0.5 * (self.pressure[left] + self.pressure[right]);
                evened.pressure[at] += EVEN * (mean - self.pressure[at]);
            }
        }
        evened
    }

    /// The gaps (m) without oscillations from one contact node to the next, where five in a row are in compression. It is meant for soil that yields, which
    /// renews these oscillations in every step: by the penalty they would remain in the pressure. In tension soil may open. It has no stiffness
    /// then, and the gap would drift.
    pub fn smooth_gaps(&self, runs: &[Run]) -> Vec<f64> {
        let mut gap = self.gap.clone();
        for run in runs {
            for k in 0..run.0.len() as isize {
                let places = [k - 2, k - 1, k, k + 1, k + 2];
                let Some(window) = self.in_a_row(run, places, |pressure| pressure > 0.0) else { continue };
                gap[window[2]] -= window.iter().zip(FOURTH).map(|(&at, share)| share * self.gap[at]).sum::<f64>();
            }
        }
        gap
    }

    /// The contact nodes at these places of a run, if the pressure (kPa) of all `counts`.
    fn in_a_row<const N: usize>(
        &self,
        (run, is_loop): &Run,
        places: [isize; N],
        counts: fn(f64) -> bool,
    ) -> Option<[usize; N]> {
        let count = run.len() as isize;
        let nodes = places.map(|k| run.start + k.rem_euclid(count) as usize);
        let inside = *is_loop || places.iter().all(|k| (0..count).contains(k));
        (inside && nodes.iter().all(|&at| counts(self.pressure[at]))).then_some(nodes)
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

    /// Whether contact node `k` is apart from the soil: there is a gap and it bears nothing, given the answer of its mean gap, or vapour in a gap of
    /// `wide` (m) or more. A part of its area may bear all the same.
    pub fn is_apart(&self, k: usize, law: &Law, mean: &Answer, wide: f64) -> bool {
        self.gap[k] > 0.0 && mean.pressure == 0.0 && mean.shear == 0.0 || law.sealed && self.gap[k] >= wide
    }

    /// Whether contact node `k` bears the tension of the `law`: it did not come to its limit in the last step, or keeps it in the gap; or, where it did
    /// not touch, lies there.
    pub fn bonded(&self, k: usize, law: &Law, lies: bool) -> bool {
        if self.touched(k) { law.sealed || self.pressure[k] > -law.tension * (1.0 - 1e-6) } else { lies }
    }

    /// The nodes that contact node `k` has room for.
    pub fn room(&self, k: usize) -> &[u32] {
        &self.room[self.first[k] as usize..self.first[k + 1] as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An oscillation from contact node to contact node is removed from pressure and gap, inside a run and around a loop, but not beside a contact node
    /// in tension. A gap that is cubic along a run stays.
    #[test]
    fn waves_are_evened_out() {
        let count = 12;
        let wave = |k: usize| if k.is_multiple_of(2) { 1.0 } else { -1.0 };
        let waves = Multipliers {
            pressure: (0..count).map(|k| 10.0 + wave(k)).collect(),
            gap: (0..count).map(wave).collect(),
            ..Multipliers::new(count)
        };
        let run = |is_loop| [(0..count, is_loop)];
        for is_loop in [false, true] {
            let (even, gap) = (waves.evened(&run(is_loop)), waves.smooth_gaps(&run(is_loop)));
            let inner = |ends: usize| if is_loop { 0..count } else { ends..count - ends };
            assert!(inner(1).all(|k| (even.pressure[k] - 10.0).abs() < 1e-14), "{even:?}");
            assert!(inner(2).all(|k| gap[k].abs() < 1e-14), "{gap:?}");
            assert_eq!(even.gap, waves.gap);
        }
        let mut open = waves.clone();
        open.pressure[6] = -1.0;
        let gap = open.smooth_gaps(&run(false));
        let changed: Vec<usize> = (0..count).filter(|&k| gap[k] != waves.gap[k]).collect();
        assert_eq!(changed, [2, 3, 9], "{gap:?}");
        let cubic: Vec<f64> = (0..count).map(|k| (k as f64 - 2.5).powi(3)).collect();
        let smooth = Multipliers { gap: cubic.clone(), ..waves }.smooth_gaps(&run(false));
        assert!(smooth.iter().zip(&cubic).all(|(a, b)| (a - b).abs() < 1e-11), "{smooth:?}");
    }
}
