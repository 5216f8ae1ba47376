//! The levels of the water outside and in the pores, where they are not the same: what of the pressure between a structure and soil is
//! that of the water in the pores.
//!
//! The water outside presses on both, also where they touch, and contact exerts what they bear beyond it. So the whole pressure there is
//! `p + p_out`, and of it the pores have `u` and the grains the rest, `p − (u − p_out)`, whichever of the levels is the higher one.

use super::hydrostatic::{Hydrostatic, Phreatic};

/// The pressures by phase.
#[derive(Clone, Debug, PartialEq)]
pub struct WaterLevels {
    outside: Vec<Option<Hydrostatic>>,
    inside: Vec<Option<Phreatic>>,
}

impl WaterLevels {
    /// `outside[i]` and `inside[i]`, in the pores, act in phase `i`; either is empty where there is no such water.
    pub fn new(outside: Vec<Option<Hydrostatic>>, inside: Vec<Option<Phreatic>>) -> Self {
        Self { outside, inside }
    }

    /// `u − p_out` (kPa) in a phase at the time `t` (s) since it began and the place `[x, y]` (m).
    pub fn beyond(&self, phase: usize, t: f64, [x, y]: [f64; 2]) -> f64 {
        let inside = self.inside.get(phase).and_then(Option::as_ref).map_or(0.0, |head| head.at(t).at(x, y)[0]);
        let outside = self.outside.get(phase).and_then(Option::as_ref).map_or(0.0, |head| head.at(t).at(y)[0]);
        inside - outside
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::time_value::TimeValue;

    /// Below both levels it is their distance, between them the pressure of the higher one, and above nothing.
    #[test]
    fn only_the_distance_of_the_levels_counts() {
        let below = |datum: f64| {
            let [top, gradient, datum] = [0.0, 10.0, datum].map(TimeValue::Constant);
            vec![Some(Hydrostatic { top, gradient, datum, band: 0.1 })]
        };
        let at = |outside, inside: Vec<Option<Hydrostatic>>, y| {
            let inside = inside.into_iter().map(|head| head.map(Phreatic::from)).collect();
            WaterLevels::new(outside, inside).beyond(0, 0.0, [7.0, y])
        };
        assert!((at(below(1.0), below(3.0), -2.0) - 20.0).abs() < 1e-12);
        assert!((at(below(3.0), below(1.0), -2.0) + 20.0).abs() < 1e-12);
        assert!((at(below(1.0), below(3.0), 2.0) - 10.0).abs() < 1e-12);
        assert!((at(Vec::new(), below(3.0), 2.0) - 10.0).abs() < 1e-12);
        assert_eq!([at(below(1.0), below(3.0), 4.0), at(below(3.0), below(3.0), 1.0)], [0.0; 2]);
    }
}
