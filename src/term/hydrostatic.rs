//! A pressure on boundaries that is uniform or grows with depth, and varies in time: that of water below its level,
//! or a load.
//!
//! `p = a + γ ⟨y₀ − y⟩`. Where it begins to grow it is rounded over a band, `⟨s⟩ = (s + b)²/4b` for `|s| < b`: the mean
//! of the sharp function over a window 2b high. Its gradient is continuous, so that the force on points that pass the
//! water level is, and its integral over a height is that of the sharp one. At the level itself it is `γ b/4`, so integrals that are cut there
//! whatever moves have the sharp one.

use crate::time_value::TimeValue;
use crate::water_table::WaterLine;

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

/// The pressure of the water in the pores, hydrostatic along each vertical below a table that may be inclined.
#[derive(Clone, Debug, PartialEq)]
pub struct Phreatic {
    /// That by the height above the line, where there is one.
    head: Hydrostatic,
    line: Option<WaterLine>,
}

impl From<Hydrostatic> for Phreatic {
    fn from(head: Hydrostatic) -> Self {
        Self { head, line: None }
    }
}

impl Phreatic {
    /// That below a line, given the pressure by the height above it.
    pub fn under(line: WaterLine, head: Hydrostatic) -> Self {
        Self { head, line: Some(line) }
    }

    /// The pressure at time `t` (s).
    pub fn at(&self, t: f64) -> MomentaryPhreatic<'_> {
        MomentaryPhreatic { head: self.head.at(t), line: self.line.as_ref() }
    }
}

/// That pressure at one moment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MomentaryPhreatic<'a> {
    /// The pressure by [`MomentaryPhreatic::height`], and the line where the table is one.
    pub head: Momentary,
    pub line: Option<&'a WaterLine>,
}

impl MomentaryPhreatic<'_> {
    /// Whether the table is a line.
    pub fn is_inclined(&self) -> bool {
        self.line.is_some()
    }

    /// The height (m) of a place that the pressure goes by: that above the line, or above y = 0 without one.
    pub fn height(&self, x: f64, y: f64) -> f64 {
        self.line.map_or(y, |line| y - line.at(x))
    }

    /// The pressure (kPa) at a place (m), with its derivatives by `x` and by `y`.
    pub fn at(&self, x: f64, y: f64) -> [f64; 3] {
        let [p, by_y, _] = self.head.at(self.height(x, y));
        [p, self.line.map_or(0.0, |line| -by_y * line.slope(x)), by_y]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn water_in_the_pores_goes_by_the_depth_below_the_line() {
        let [top, gradient, zero] = [0.0, 10.0, 0.0].map(TimeValue::Constant);
        let line = WaterLine(vec![[0.0, 2.0], [10.0, 4.0]].into());
        let head = Hydrostatic { top, gradient, datum: zero, band: 0.1 };
        let phreatic = Phreatic::under(line, head.clone());
        let at = |x, y| phreatic.at(0.0).at(x, y);
        assert!((at(5.0, 1.0)[0] - 20.0).abs() < 1e-12 && at(5.0, 3.2) == [0.0; 3]);
        assert!((at(-5.0, 1.0)[0] - 10.0).abs() < 1e-12 && at(15.0, 1.0) == [30.0, 0.0, -10.0]);
        let h = 1e-6;
        for (x, y) in [(3.0, 1.0), (3.0, 2.62)] {
            let [_, by_x, by_y] = at(x, y);
            let difference =
                [at(x + h, y)[0] - at(x - h, y)[0], at(x, y + h)[0] - at(x, y - h)[0]].map(|d| 0.5 * d / h);
            assert!((by_x - difference[0]).abs() < 1e-6 && (by_y - difference[1]).abs() < 1e-6, "{x} {y}");
        }
        let [p, _, by_y] = Phreatic::from(head.clone()).at(0.0).at(3.0, -1.0);
        assert_eq!([p, by_y], [0, 1].map(|k| head.at(0.0).at(-1.0)[k]));
    }

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
