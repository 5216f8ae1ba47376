//! Round numbers along an axis.

use std::ops::RangeInclusive;

/// Round numbers within a range, in equal steps of 1, 2 or 5 times a power of ten, some `wanted` of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Ticks {
    pub values: Vec<f64>,
    step: f64,
}

impl Ticks {
    /// Those of a range; a single one where it is a point.
    pub fn within(range: &RangeInclusive<f64>, wanted: usize) -> Self {
        let (low, high) = (*range.start(), *range.end());
        let width = high - low;
        if !(width > 0.0 && width.is_finite()) {
            return Self { values: vec![low], step: low.abs().max(1.0) };
        }
        let rough = width / wanted.max(1) as f64;
        let power = 10f64.powf(rough.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|m| m * power).into_iter().find(|step| *step >= rough * (1.0 - 1e-9));
        let step = step.unwrap_or(10.0 * power);
        // Ends that rounding moved by a hair are ticks too.
        let (first, last) = ((low / step - 1e-9).ceil(), (high / step + 1e-9).floor());
        let count = (last - first) as usize + 1;
        Self { values: (0..count).map(|i| (first + i as f64) * step).collect(), step }
    }

    /// A value as its tick is labelled: as many decimals as tell it from the next, `1.2e6` where numbers are very large or small.
    pub fn label(&self, value: f64) -> String {
        let most = self.values.iter().fold(self.step, |most, v| most.max(v.abs()));
        if !(1e-4..1e6).contains(&most) {
            let text = format!("{value:.3e}");
            let (digits, power) = text.split_once('e').unwrap_or((&text, "0"));
            let digits = digits.trim_end_matches('0').trim_end_matches('.');
            return if value == 0.0 { "0".to_owned() } else { format!("{digits}e{power}").replace('-', "−") };
        }
        let decimals = (-self.step.log10().floor()).max(0.0) as usize;
        let text = format!("{value:.decimals$}");
        let zero = text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.');
        if zero { text.trim_start_matches('-').to_owned() } else { text.replace('-', "−") }
    }
}

/// Values along an axis of logarithms to the base ten, with their labels: powers of ten, and in a short range 2 and 5 times these too; in a shorter one
/// round numbers.
pub fn decades(range: &RangeInclusive<f64>) -> Vec<(f64, String)> {
    /// Labels that have room.
    const MOST: f64 = 9.0;
    let (low, high) = (*range.start(), *range.end());
    if high - low < 0.7 {
        let ticks = Ticks::within(&(10f64.powf(low)..=10f64.powf(high)), 5);
        return ticks.values.iter().filter(|v| **v > 0.0).map(|&v| (v, ticks.label(v))).collect();
    }
    let every = ((high - low) / MOST).ceil().max(1.0) as i32;
    let multiples: &[f64] = if high - low < 3.0 { &[1.0, 2.0, 5.0] } else { &[1.0] };
    let powers = (low.floor() as i32..=high.ceil() as i32).filter(|power| power.rem_euclid(every) == 0);
    let values = powers.flat_map(|power| multiples.iter().map(move |multiple| multiple * 10f64.powi(power)));
    let within = |v: &f64| range.contains(&v.log10());
    let label = |v: f64| {
        let text = if (1e-3..1e5).contains(&v) { format!("{}", (v * 1e9).round() / 1e9) } else { format!("{v:.0e}") };
        text.replace('-', "−")
    };
    values.filter(within).map(|v| (v, label(v))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(low: f64, high: f64) -> Vec<String> {
        let ticks = Ticks::within(&(low..=high), 6);
        ticks.values.iter().map(|&v| ticks.label(v)).collect()
    }

    #[test]
    fn ticks_are_round_and_within_the_range() {
        assert_eq!(labels(0.0, 1.0), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels(-0.13, 0.31), ["−0.1", "0.0", "0.1", "0.2", "0.3"]);
        assert_eq!(labels(-3e-5, 2e-5), ["−3e−5", "−2e−5", "−1e−5", "0", "1e−5", "2e−5"]);
        assert_eq!(labels(2e6, 8e6), ["2e6", "3e6", "4e6", "5e6", "6e6", "7e6", "8e6"]);
        assert_eq!(labels(5.0, 5.0), ["5"]);
        assert_eq!(labels(1000.0, 1000.03)[..2], ["1000.000", "1000.005"]);
    }
}
