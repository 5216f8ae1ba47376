//! Lines in the plane that are seen along rays.

use super::{Bins, Line, cross, dot, way};

/// How far beyond the ends of a line (-) a ray still meets it, so that none passes between two that join.
const BESIDE: f64 = 1e-9;

/// Where a ray meets a line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The number of the line.
    pub line: usize,
    /// The share (-) of it.
    pub share: f64,
    /// How far (m) along the ray, negative behind its start.
    pub distance: f64,
}

/// Lines, by place.
#[derive(Clone, Debug, Default)]
pub struct Lines {
    pub lines: Vec<Line<2>>,
    bins: Bins,
}

impl Lines {
    /// Lines of which those nearer to a place than `reach` (m) are to be found.
    pub fn new(lines: Vec<Line<2>>, reach: f64) -> Self {
        let bins = Bins::new(lines.iter().map(|[a, b]| (*a, *b)), reach);
        Self { lines, bins }
    }

    /// The numbers of those near a place; one may come several times.
    pub fn near<'a>(&'a self, x: &[f64; 2]) -> impl Iterator<Item = usize> + use<'a> {
        self.bins.around(x).flatten().map(|&line| line as usize)
    }

    /// Where the straight line through `x` (m) along the unit vector `n` meets lines near `x`, of those that `faces` is true for.
    pub fn hits(&self, x: [f64; 2], n: [f64; 2], mut faces: impl FnMut(usize) -> bool) -> impl Iterator<Item = Hit> {
        self.near(&x).filter(move |&line| faces(line)).filter_map(move |line| {
            let [a, b] = &self.lines[line];
            let (along, to) = (way(a, b), way(&x, a));
            // x + t n = a + share along
            let share = cross(&to, &n) / cross(&n, &along);
            let place = [0, 1].map(|d| to[d] + share * along[d]);
            (-BESIDE..=1.0 + BESIDE).contains(&share).then(|| Hit { line, share, distance: dot(&place, &n) })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_ray_meets_what_is_before_and_behind_it() {
        let lines =
            Lines::new(vec![[[0.0, 1.0], [2.0, 1.0]], [[2.0, -0.5], [0.0, -0.5]], [[3.0, 0.0], [4.0, 0.0]]], 2.0);
        let mut hits: Vec<Hit> = lines.hits([0.5, 0.0], [0.0, 1.0], |_| true).collect();
        hits.sort_by_key(|hit| hit.line);
        hits.dedup();
        let expected = [Hit { line: 0, share: 0.25, distance: 1.0 }, Hit { line: 1, share: 0.75, distance: -0.5 }];
        assert_eq!(hits, expected);
        assert!(lines.hits([0.5, 0.0], [0.0, 1.0], |line| line == 2).next().is_none());
    }
}
