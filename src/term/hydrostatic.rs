//! A pressure on boundaries that is uniform or grows with depth, and varies in time: that of water below its level,
//! or a load.
//!
//! `p = a + γ ⟨y₀ − y⟩`. Where it begins to grow it is rounded over a band, `⟨s⟩ = (s + b)²/4b` for `|s| < b`: the mean
//! of the sharp function over a window 2b high. Its gradient is continuous, so that the force on points that pass the
//! water level is, and its integral over a height is that of the sharp one. At the level itself it is `γ b/4`, so integrals that are cut there
//! whatever moves have the sharp one.

use crate::time_value::TimeValue;

/// A pressure (kPa, compression positive) in a phase's own time.
#[derive(Clone, Debug, PartialEq)]
pub struct Hydrostatic {
    /// At the datum and above (kPa).
    pub top: TimeValue,
    /// Growth (kPa/m) below the datum.
    pub gradient: TimeValue,
    /// Height y (m) at which the growth begins.
    pub datum: TimeValue,
    /// Half the height (m) over which it does, above zero.
    pub band: f64,
}

/// A pressure at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Momentary {
    pub top: f64,
    pub gradient: f64,
    pub datum: f64,
    pub band: f64,
}

impl Hydrostatic {
    /// The pressure at time `t` (s).
    pub fn at(&self, t: f64) -> Momentary {
        let Self { top, gradient, datum, band } = self;
        Momentary { top: top.at(t), gradient: gradient.at(t), datum: datum.at(t), band: *band }
    }
}

impl Momentary {
    /// The pressure (kPa) at height `y` (m), with its first and second derivative by `y`.
    pub fn at(&self, y: f64) -> [f64; 3] {
        let (depth, b) = (self.datum - y, self.band);
        if depth >= b {
            [self.top + self.gradient * depth, -self.gradient, 0.0]
        } else if depth <= -b {
            [self.top, 0.0, 0.0]
        } else {
            let share = 0.5 * (depth + b) / b;
            [self.top + self.gradient * b * share * share, -self.gradient * share, 0.5 * self.gradient / b]
        }
    }

    /// The sharp one, for integrals that are cut at its [`Momentary::breaks`]: what lies at the level has none of it.
    #[must_use]
    pub fn sharp(self) -> Self {
        Self { band: 0.0, ..self }
    }

    /// The heights (m) between which it is a polynomial of degree 2 at most.
    pub fn breaks(&self) -> [f64; 2] {
        [self.datum - self.band, self.datum + self.band]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_sharp_one_is_nothing_from_its_level_on() {
        let p = Momentary { top: 3.0, gradient: 9.81, datum: 2.0, band: 0.25 };
        assert!(p.at(2.0)[0] > 3.5);
        assert_eq!(p.sharp().at(2.0)[0], 3.0);
        assert_eq!(p.sharp().at(2.01), [3.0, 0.0, 0.0]);
        assert_eq!(p.sharp().at(1.0), p.at(1.0));
    }

    #[test]
    fn the_rounding_keeps_slopes_and_the_integral() {
        let p = Momentary { top: 3.0, gradient: 9.81, datum: 2.0, band: 0.25 };
        assert_eq!(p.at(2.5), [3.0, 0.0, 0.0]);
        assert_eq!(p.at(1.0), [3.0 + 9.81, -9.81, 0.0]);
        let h = 1e-6;
        for y in [1.74, 1.76, 1.9, 2.1, 2.24, 2.26] {
            let [_, slope, second] = p.at(y);
            let difference = |k: usize| (p.at(y + h)[k] - p.at(y - h)[k]) / (2.0 * h);
            assert!((slope - difference(0)).abs() < 1e-7 && (second - difference(1)).abs() < 1e-7, "{y}");
        }
        // Over its height, the window has the force of the sharp function, but for b²/6 of its slope.
        let n = 20_000;
        let sum = (0..n).map(|k| p.at(1.0 + 2.0 * (f64::from(k) + 0.5) / f64::from(n))[1]).sum::<f64>();
        assert!((2.0 * sum / f64::from(n) + 9.81).abs() < 1e-8);
    }
}
