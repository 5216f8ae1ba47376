//! Anchors, struts and springs: bars between two nodes of finite elements, or a node and a place that does not move (docs/theory.md, section 3, *Bars*).
//!
//! A bar pulls with `k (ℓ − ℓ₀)`, where `ℓ` is how far its ends are apart, as far as it yields neither in tension nor in compression. It is all elastic in
//! a step: what it yields by is taken into its free length `ℓ₀` after that ([`Bar::yielded`]), and the force of the step is limited already.

use super::{Assembly, Frame, Role, Source, Term, Trial};
use crate::error::Result;
use crate::system::Local;
use std::sync::Arc;

/// An end of a bar.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End<const D: usize> {
    Node(u32),
    /// A place (m) that does not move.
    Fixed([f64; D]),
}

/// What a bar does in a phase.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Mode {
    #[default]
    Absent,
    /// It is tensioned: it has this force (kN, tension positive), whatever its ends do.
    Tensioned(f64),
    Elastic,
}

/// A bar.
#[derive(Clone, Debug, PartialEq)]
pub struct Bar<const D: usize> {
    pub ends: [End<D>; 2],
    /// Force for an elongation (kN/m).
    pub stiffness: f64,
    /// The largest force (kN) in compression, as a negative number, and in tension.
    pub limits: [f64; 2],
    /// By phase.
    pub modes: Vec<Mode>,
}

impl<const D: usize> Bar<D> {
    /// Its mode in a phase.
    pub fn mode(&self, phase: usize) -> Mode {
        self.modes.get(phase).copied().unwrap_or_default()
    }

    /// The nodes at its ends.
    pub fn nodes(&self) -> impl Iterator<Item = u32> {
        self.ends.iter().filter_map(|end| match end {
            End::Node(n) => Some(*n),
            End::Fixed(_) => None,
        })
    }

    /// Its length (m) and the direction from its first end to its second, given where (m) nodes are.
    pub fn line(&self, at: impl Fn(u32) -> [f64; D]) -> (f64, [f64; D]) {
        let [a, b] = self.ends.map(|end| match end {
            End::Node(n) => at(n),
            End::Fixed(x) => x,
        });
        let way: [f64; D] = std::array::from_fn(|d| b[d] - a[d]);
        let length = way.iter().map(|w| w * w).sum::<f64>().sqrt();
        (length, way.map(|w| w / length))
    }

    /// The force (kN, tension positive) at a length (m) in a phase, and its derivative (kN/m), given the free length.
    pub fn force(&self, phase: usize, free: f64, length: f64) -> (f64, f64) {
        match self.mode(phase) {
            Mode::Absent => (0.0, 0.0),
            Mode::Tensioned(force) => (force, 0.0),
            Mode::Elastic => {
                let force = self.stiffness * (length - free);
                let [low, high] = self.limits;
                if force < low || force > high { (force.clamp(low, high), 0.0) } else { (force, self.stiffness) }
            }
        }
    }

    /// Its free length (m) after a step in which it was elastic to this length, given that before.
    pub fn yielded(&self, phase: usize, free: f64, length: f64) -> f64 {
        let (force, slope) = self.force(phase, free, length);
        if self.mode(phase) == Mode::Elastic && slope == 0.0 { length - force / self.stiffness } else { free }
    }

    /// Its free length (m) as a phase begins, at this length, given that before.
    pub fn begun(&self, phase: usize, free: f64, length: f64) -> f64 {
        let before = phase.checked_sub(1).map(|before| self.mode(before)).unwrap_or_default();
        match (before, self.mode(phase)) {
            (Mode::Tensioned(force), Mode::Elastic) => length - force / self.stiffness,
            (Mode::Absent, Mode::Elastic) => length,
            _ => free,
        }
    }
}

/// The force of bars on the finite elements.
pub struct Bars<const D: usize>(pub Arc<[Bar<D>]>);

impl<const D: usize> Term<D> for Bars<D> {
    fn role(&self) -> Role {
        Role::Restoring
    }

    fn source(&self) -> Source {
        Source::Load
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let active: Vec<usize> = (0..self.0.len()).filter(|&i| self.0[i].mode(trial.phase) != Mode::Absent).collect();
        let at = |n: u32| -> [f64; D] {
            std::array::from_fn(|d| frame.mesh.nodes[n as usize][d] + trial.between[n as usize][d])
        };
        let compute = |&i: &usize, local: &mut Local| {
            let bar = &self.0[i];
            let (length, n) = bar.line(at);
            let (force, slope) = bar.force(trial.phase, frame.free_lengths[i], length);
            let signs: Vec<f64> = bar
                .ends
                .iter()
                .zip([-1.0, 1.0])
                .filter(|(end, _)| matches!(end, End::Node(_)))
                .map(|(_, s)| s)
                .collect();
            for (k, sign) in signs.iter().enumerate() {
                for d in 0..D {
                    local.vector[k * D + d] += sign * force * n[d];
                    if local.matrix.is_empty() {
                        continue;
                    }
                    for (l, other) in signs.iter().enumerate() {
                        for e in 0..D {
                            let along = n[d] * n[e];
                            let across = f64::from(u8::from(d == e)) - along;
                            let stiffness = slope * along + force / length * across;
                            let entry = (k * D + d) * local.size + l * D + e;
                            local.matrix[entry] += (1.0 - trial.alpha_f) * sign * other * stiffness;
                        }
                    }
                }
            }
            Ok(())
        };
        out.scatter(frame.pattern, &active, |&i| frame.bars[i] as usize, compute)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bar() -> Bar<2> {
        let modes = vec![Mode::Absent, Mode::Tensioned(30.0), Mode::Elastic, Mode::Elastic];
        Bar { ends: [End::Node(0), End::Fixed([3.0, 4.0])], stiffness: 100.0, limits: [-10.0, 50.0], modes }
    }

    #[test]
    fn a_bar_is_tensioned_then_elastic_and_yields_at_its_limits() {
        let bar = bar();
        assert_eq!(bar.line(|_| [0.0, 0.0]), (5.0, [0.6, 0.8]));
        assert_eq!([0, 1, 2].map(|phase| bar.force(phase, 5.0, 5.1).0), [0.0, 30.0, 100.0 * (5.1 - 5.0)]);
        // The force that it was tensioned to is that which it begins with.
        let free = bar.begun(2, 0.0, 5.0);
        assert!((bar.force(2, free, 5.0).0 - 30.0).abs() < 1e-12);
        assert_eq!(bar.begun(3, free, 7.0), free);
        assert_eq!(bar.force(2, free, 6.0), (50.0, 0.0));
        let free = bar.yielded(2, free, 6.0);
        assert!((bar.force(2, free, 6.0).0 - 50.0).abs() < 1e-12);
        assert!((bar.force(2, free, 5.9).0 - 40.0).abs() < 1e-12);
        assert_eq!(bar.force(2, free, 5.0), (-10.0, 0.0));
    }
}
