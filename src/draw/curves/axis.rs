//! An axis: where values are on the paper, and its ticks.

use crate::draw::ticks::{Ticks, decades};
use std::ops::RangeInclusive;

/// Where an axis begins and ends on the paper (points), and what it shows: values, or their logarithms to the base ten.
pub struct Axis {
    range: RangeInclusive<f64>,
    paper: [f64; 2],
    wanted: usize,
    log: bool,
}

impl Axis {
    /// An axis that shows `values`, with a little space beyond, from zero on where they come near it; of logarithms those that are positive.
    pub fn around(values: impl Iterator<Item = f64>, paper: [f64; 2], wanted: usize, log: bool) -> Self {
        let finite = values.map(|v| if log { v.log10() } else { v }).filter(|v| v.is_finite());
        let (mut low, mut high) = finite.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), v| (l.min(v), h.max(v)));
        if low > high {
            (low, high) = (0.0, 1.0);
        }
        if low == high {
            (low, high) = if low == 0.0 { (0.0, 1.0) } else { (low - 0.1 * low.abs(), high + 0.1 * low.abs()) };
        }
        let width = high - low;
        let (near, space) = (if log { -1.0 } else { 0.3 * width }, 0.04 * width);
        let low = if (0.0..=near).contains(&low) { 0.0 } else { low - space };
        let high = if (-near..=0.0).contains(&high) { 0.0 } else { high + space };
        Self { range: low..=high, paper, wanted, log }
    }

    /// Where a value is on the paper; not a number where it has no logarithm.
    pub fn place(&self, value: f64) -> f64 {
        let value = if self.log { value.log10() } else { value };
        let (low, high) = (self.range.start(), self.range.end());
        let at = self.paper[0] + (value - low) / (high - low) * (self.paper[1] - self.paper[0]);
        if at.is_finite() { at } else { f64::NAN }
    }

    /// The values of the ticks, with their labels.
    pub fn marks(&self) -> Vec<(f64, String)> {
        if self.log {
            return decades(&self.range);
        }
        let ticks = Ticks::within(&self.range, self.wanted);
        ticks.values.iter().map(|&value| (value, ticks.label(value))).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_values_are_within_the_axis() {
        for log in [false, true] {
            for values in [vec![1e-3, 5.0, 2e4], vec![0.02], vec![7.0, 7.0, 7.1], vec![-3.0, 0.0, f64::NAN, 1.0]] {
                let axis = Axis::around(values.iter().copied(), [300.0, 20.0], 6, log);
                for &value in &values {
                    let at = axis.place(value);
                    let shown = value.is_finite() && (!log || value > 0.0);
                    assert!(if shown { (20.0..=300.0).contains(&at) } else { at.is_nan() }, "{log} {values:?}: {at}");
                }
                assert!(axis.marks().iter().all(|(value, _)| (20.0..=300.0).contains(&axis.place(*value))));
                assert!(!axis.marks().is_empty(), "{log} {values:?}");
            }
        }
    }
}
