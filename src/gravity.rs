//! The acceleration of gravity in a phase: that of the case times a factor in time, or components of its own, as a pseudo-static analysis has
//! them for an earthquake.

use crate::time_value::TimeValue;

/// The acceleration of gravity (m/s²) in a phase's own time.
#[derive(Clone, Debug, PartialEq)]
pub enum Gravity<const D: usize> {
    /// That of the case (m/s²), times a factor (-).
    Scaled { whole: [f64; D], factor: TimeValue },
    /// By component (m/s²).
    Components([TimeValue; D]),
}

impl<const D: usize> Gravity<D> {
    /// The acceleration at time `t` (s) since the beginning of the phase.
    pub fn at(&self, t: f64) -> [f64; D] {
        match self {
            Self::Scaled { whole, factor } => {
                let factor = factor.at(t);
                whole.map(|g| factor * g)
            }
            Self::Components(components) => std::array::from_fn(|d| components[d].at(t)),
        }
    }

    /// A component (m/s²) in time.
    pub fn component(&self, d: usize) -> TimeValue {
        match self {
            Self::Scaled { whole, factor } => factor.scaled(whole[d]),
            Self::Components(components) => components[d].clone(),
        }
    }

    /// What of it varies in time: the factor, or the components.
    pub fn values(&self) -> &[TimeValue] {
        match self {
            Self::Scaled { factor, .. } => std::slice::from_ref(factor),
            Self::Components(components) => components,
        }
    }

    /// The accelerations at the times between which it is linear, in a phase of the given duration (s).
    pub fn extremes(&self, duration: f64) -> impl Iterator<Item = [f64; D]> {
        let kinks = self.values().iter().flat_map(TimeValue::kinks).filter(move |&t| 0.0 < t && t < duration);
        kinks.chain([0.0, duration]).map(|t| self.at(t))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_factor_scales_all_of_it_and_components_vary_alone() {
        let scaled = Gravity::Scaled { whole: [1.0, -10.0], factor: TimeValue::Rate(0.5) };
        assert_eq!(scaled.at(3.0), [1.5, -15.0]);
        assert_eq!(scaled.component(1).at(3.0), -15.0);
        let table = TimeValue::Table(vec![[0.0, 0.0], [1.0, 2.0], [2.0, -1.0]]);
        let components = Gravity::Components([table, TimeValue::Constant(-10.0)]);
        assert_eq!(components.at(0.5), [1.0, -10.0]);
        let across: Vec<f64> = components.extremes(1.5).map(|g| g[0]).collect();
        assert_eq!(across, [2.0, 0.0, 0.5]);
    }
}
