//! The way of a piece of the boundary through the parametric domain of a cell.

/// A cubic between two places, with its derivatives there: straight where these are its chord. Where a line is straight in space but not in the
/// domain, as in a quadrilateral that is no parallelogram, it follows it to fourth order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Path {
    /// Its ends, parametric.
    pub ends: [[f64; 2]; 2],
    /// The derivatives there by the share of its way.
    pub rates: [[f64; 2]; 2],
}

impl Path {
    /// The straight one.
    pub fn straight(ends: [[f64; 2]; 2]) -> Self {
        let [a, b] = ends;
        Self { ends, rates: [[b[0] - a[0], b[1] - a[1]]; 2] }
    }

    /// The place at the share `t` of its way.
    pub fn at(&self, t: f64) -> [f64; 3] {
        let [x, y] = [0, 1].map(|d| {
            let (chord, [from, to]) = self.parts(d);
            self.ends[0][d] + t * chord + t * (1.0 - t) * ((1.0 - t) * from - t * to)
        });
        [x, y, 0.0]
    }

    /// The derivative there by the share.
    pub fn rate(&self, t: f64) -> [f64; 2] {
        [0, 1].map(|d| {
            let (chord, [from, to]) = self.parts(d);
            chord + (1.0 - 2.0 * t) * ((1.0 - t) * from - t * to) - t * (1.0 - t) * (from + to)
        })
    }

    /// The part of it between two shares of its way; all of it for 0 and 1.
    pub fn part(&self, from: f64, to: f64) -> Self {
        let end = |t: f64| if t == 1.0 { self.ends[1] } else { [self.at(t)[0], self.at(t)[1]] };
        Self { ends: [from, to].map(end), rates: [from, to].map(|t| self.rate(t).map(|rate| (to - from) * rate)) }
    }

    /// Of a component the chord, and what the derivatives at both ends have beyond that.
    fn parts(&self, d: usize) -> (f64, [f64; 2]) {
        let chord = self.ends[1][d] - self.ends[0][d];
        (chord, self.rates.map(|rate| rate[d] - chord))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cubic_is_its_own_path_and_so_are_its_parts() {
        let f = |t: f64| [0.3 + 0.5 * t - 0.2 * t * t + 0.1 * t * t * t, -0.7 + 0.1 * t + 0.4 * t * t];
        let slope = |t: f64| [0.5 - 0.4 * t + 0.3 * t * t, 0.1 + 0.8 * t];
        let path = Path { ends: [f(0.0), f(1.0)], rates: [slope(0.0), slope(1.0)] };
        let part = path.part(0.2, 0.7);
        for k in 0..=10 {
            let t = f64::from(k) / 10.0;
            let s = 0.2 + 0.5 * t;
            for d in 0..2 {
                assert!((path.at(t)[d] - f(t)[d]).abs() < 1e-15 && (path.rate(t)[d] - slope(t)[d]).abs() < 1e-15);
                assert!((part.at(t)[d] - f(s)[d]).abs() < 1e-15 && (part.rate(t)[d] - 0.5 * slope(s)[d]).abs() < 1e-15);
            }
        }
    }
}
