//! A strip along a side of the mesh that soil fills as it enters the model.

use super::NOWHERE;
use crate::geometry::{Line, distance, foot};

/// A strip of even thickness along a straight line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Strip<const D: usize> {
    /// The line (m), and the unit normal into the mesh.
    pub ends: Line<D>,
    pub inward: [f64; D],
    /// Whether the strip ends at each end of the line; elsewhere a wall bounds it.
    pub open: [bool; 2],
    /// Its thickness (m).
    pub thickness: f64,
}

impl<const D: usize> Strip<D> {
    /// How far (m) within the strip a place is, negative outside.
    pub fn level(&self, x: &[f64; D]) -> f64 {
        let length = distance(&self.ends[0], &self.ends[1]);
        let depth: f64 = (0..D).map(|d| (x[d] - self.ends[0][d]) * self.inward[d]).sum();
        let along = length * foot(x, &self.ends);
        let within = |open: bool, side: f64| if open || side < -NOWHERE.sqrt() * length { side } else { f64::INFINITY };
        let behind = if depth < -NOWHERE.sqrt() * length { depth } else { f64::INFINITY };
        let level = within(self.open[0], along)
            .min(within(self.open[1], length - along))
            .min(behind)
            .min(self.thickness - depth);
        if level.abs() < NOWHERE.sqrt() * length { 0.0 } else { level }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_level_is_the_distance_to_the_rim() {
        let strip = Strip { ends: [[1.0, 2.0], [3.0, 2.0]], inward: [0.0, -1.0], open: [true, false], thickness: 0.2 };
        for (x, level) in [
            ([2.0, 2.0], 0.2),
            ([2.0, 1.7], -0.1),
            ([1.05, 1.95], 0.05),
            ([0.9, 1.9], -0.1),
            ([3.0, 1.9], 0.1),
            ([1.0, 1.9], 0.0),
            ([2.0, 2.5], -0.5),
        ] {
            assert!((strip.level(&x) - level).abs() < 1e-12, "{x:?}: {}", strip.level(&x));
        }
    }
}
