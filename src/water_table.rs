//! The water table in the ground: one height, which may vary in time, or a line.

use crate::time_value::{TimeValue, interpolate};
use std::sync::Arc;

/// The water table in a phase.
#[derive(Clone, Debug, PartialEq)]
pub enum WaterTable {
    /// The height y (m).
    Level(TimeValue),
    Line(WaterLine),
}

/// Places [x, y] (m), x growing: straight between, level beyond the first and the last.
#[derive(Clone, Debug, PartialEq)]
pub struct WaterLine(pub Arc<[[f64; 2]]>);

impl WaterLine {
    /// The height (m) at `x` (m).
    pub fn at(&self, x: f64) -> f64 {
        interpolate(&self.0, x)
    }

    /// Its slope (-) at `x` (m); at a corner that to the right.
    pub fn slope(&self, x: f64) -> f64 {
        let after = self.0.partition_point(|&[corner, _]| corner <= x);
        match (after.checked_sub(1).and_then(|i| self.0.get(i)), self.0.get(after)) {
            (Some([x0, y0]), Some([x1, y1])) => (y1 - y0) / (x1 - x0),
            _ => 0.0,
        }
    }
}

impl WaterTable {
    /// The height (m) at `x` (m) as the phase begins.
    pub fn at_first(&self, x: f64) -> f64 {
        match self {
            Self::Level(level) => level.at(0.0),
            Self::Line(line) => line.at(x),
        }
    }

    /// The greatest height (m) between two `x` (m) as the phase begins.
    pub fn highest_at_first(&self, [from, to]: [f64; 2]) -> f64 {
        let corners = if let Self::Line(line) = self { &line.0[..] } else { &[] };
        let within = corners.iter().filter(|[x, _]| from < *x && *x < to).map(|[_, y]| *y);
        within.chain([from, to].map(|x| self.at_first(x))).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The table that stays what it is as the phase begins.
    #[must_use]
    pub fn held(&self) -> Self {
        match self {
            Self::Level(level) => Self::Level(TimeValue::Constant(level.at(0.0))),
            Self::Line(_) => self.clone(),
        }
    }

    /// The height in time, of one that is level.
    pub fn level(&self) -> Option<&TimeValue> {
        match self {
            Self::Level(level) => Some(level),
            Self::Line(_) => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_straight_between_its_places_and_level_beyond() {
        let line = WaterLine(vec![[1.0, 10.0], [3.0, 20.0], [4.0, 0.0]].into());
        for (x, y, slope) in [(0.0, 10.0, 0.0), (1.0, 10.0, 5.0), (2.0, 15.0, 5.0), (3.5, 10.0, -20.0), (4.0, 0.0, 0.0)]
        {
            assert_eq!((line.at(x), line.slope(x)), (y, slope), "at {x}");
        }
        let table = WaterTable::Line(line);
        assert_eq!(
            [[0.0, 2.0], [2.0, 9.0], [3.5, 9.0]].map(|between| table.highest_at_first(between)),
            [15.0, 20.0, 10.0]
        );
        let level = WaterTable::Level(TimeValue::Table(vec![[0.0, 2.0], [1.0, 5.0]]));
        assert_eq!(
            (level.highest_at_first([0.0, 1.0]), level.held()),
            (2.0, WaterTable::Level(TimeValue::Constant(2.0)))
        );
    }
}
