//! The structures that stand in the soil, as triangles.

use super::origin::Outline;
use crate::geometry::{Bins, Line, box_around, side};
use std::collections::BTreeMap;

/// Triangles of structures where they are now, and their outline.
#[derive(Clone, Debug, Default)]
pub struct Structures {
    triangles: Vec<[[f64; 2]; 3]>,
    bins: Bins,
    low: [f64; 2],
    high: [f64; 2],
    outline: Outline,
}

impl Structures {
    /// Those of counter-clockwise triangles between places (m) by number; distances count up to `reach` (m).
    pub fn new(places: &[[f64; 2]], corners: &[[u32; 3]], reach: f64) -> Self {
        let triangles: Vec<[[f64; 2]; 3]> = corners.iter().map(|t| t.map(|i| places[i as usize])).collect();
        let none = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        let [low, high] = box_around(triangles.iter().flatten().copied()).unwrap_or(none);
        let boxes: Vec<_> = triangles.iter().map(bounds).collect();
        // A side that one triangle alone has is on the outline.
        let mut sides: BTreeMap<[u32; 2], (u32, Line<2>)> = BTreeMap::new();
        for t in corners {
            for i in 0..3 {
                let (a, b) = (t[i], t[(i + 1) % 3]);
                let side = sides.entry([a.min(b), a.max(b)]);
                side.or_insert((0, [places[a as usize], places[b as usize]])).0 += 1;
            }
        }
        let lines = sides.into_values().filter(|(count, _)| *count == 1).map(|(_, line)| line).collect();
        let widths = boxes.iter().map(|(a, b)| (b[0] - a[0]).max(b[1] - a[1]));
        let width = widths.fold(f64::MIN_POSITIVE, f64::max);
        Self {
            bins: Bins::new(boxes.iter().copied(), width),
            triangles,
            low,
            high,
            outline: Outline::new(lines, reach),
        }
    }

    /// Whether the box of a triangle touches that of all structures.
    pub fn touch(&self, x: &[[f64; 2]; 3]) -> bool {
        let (low, high) = bounds(x);
        (0..2).all(|d| low[d] <= self.high[d] && high[d] >= self.low[d])
    }

    /// The triangles whose boxes touch that of one.
    pub fn near(&self, x: &[[f64; 2]; 3]) -> impl Iterator<Item = &[[f64; 2]; 3]> {
        let (low, high) = bounds(x);
        let mut found: Vec<u32> = Vec::new();
        if self.touch(x) {
            let at = |x: [f64; 2]| [0, 1].map(|d| x[d].clamp(self.low[d], self.high[d]));
            found.extend(self.bins.beside((at(low), at(high))).flatten());
            found.sort_unstable();
            found.dedup();
        }
        found.into_iter().map(|k| &self.triangles[k as usize]).filter(move |other| {
            let (a, b) = bounds(other);
            (0..2).all(|d| a[d] <= high[d] && b[d] >= low[d])
        })
    }

    /// How deep (m) in structures a place is, negative outside; no more than the reach.
    pub fn depth(&self, x: &[f64; 2]) -> f64 {
        if self.triangles.is_empty() {
            return f64::NEG_INFINITY;
        }
        let holds = |t: &&[[f64; 2]; 3]| (0..3).all(|i| side(&[t[i], t[(i + 1) % 3]], x) >= 0.0);
        let (distance, _) = self.outline.distance(x);
        if self.near(&[*x; 3]).any(|t| holds(&t)) { distance } else { -distance }
    }
}

fn bounds(x: &[[f64; 2]; 3]) -> ([f64; 2], [f64; 2]) {
    let of = |pick: fn(f64, f64) -> f64| [0, 1].map(|d| pick(pick(x[0][d], x[1][d]), x[2][d]));
    (of(f64::min), of(f64::max))
}
