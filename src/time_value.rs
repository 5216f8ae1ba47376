//! A value that varies in time: prescribed displacements, tractions and the factor on gravity.

/// A value in a phase's own time (s).
#[derive(Clone, Debug, PartialEq)]
pub enum TimeValue {
    Constant(f64),
    /// Grows from 0 by this much a second.
    Rate(f64),
    /// Pairs of time and value, times growing: linear between, constant before the first and after the last.
    Table(Vec<[f64; 2]>),
}

impl TimeValue {
    /// The value at time `t` (s) since the beginning of the phase.
    pub fn at(&self, t: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Rate(rate) => rate * t,
            Self::Table(table) => interpolate(table, t),
        }
    }

    /// Whether it is 0 throughout.
    pub fn is_zero(&self) -> bool {
        match self {
            Self::Constant(value) | Self::Rate(value) => *value == 0.0,
            Self::Table(table) => table.iter().all(|[_, value]| *value == 0.0),
        }
    }

    /// This times a factor.
    pub fn scaled(&self, by: f64) -> Self {
        match self {
            Self::Constant(value) => Self::Constant(by * value),
            Self::Rate(rate) => Self::Rate(by * rate),
            Self::Table(table) => Self::Table(table.iter().map(|[t, v]| [*t, by * v]).collect()),
        }
    }

    /// Times (s) at which the slope jumps: a step had better end there.
    pub fn kinks(&self) -> impl Iterator<Item = f64> + '_ {
        let table: &[[f64; 2]] = if let Self::Table(table) = self { table } else { &[] };
        table.iter().map(|&[t, _]| t)
    }
}

/// The value at `t` between the entries of a table, and beyond them that of the nearest.
pub fn interpolate(table: &[[f64; 2]], t: f64) -> f64 {
    let after = table.partition_point(|&[time, _]| time <= t);
    match (after.checked_sub(1).and_then(|i| table.get(i)), table.get(after)) {
        (Some(&[t0, v0]), Some(&[t1, v1])) => v0 + (v1 - v0) * (t - t0) / (t1 - t0),
        (Some(&[_, v]), None) | (None, Some(&[_, v])) => v,
        (None, None) => 0.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_constant_and_a_rate() {
        assert_eq!(TimeValue::Constant(3.0).at(7.0), 3.0);
        assert_eq!(TimeValue::Rate(-2.0).at(1.5), -3.0);
    }

    #[test]
    fn a_table_is_linear_between_and_constant_beyond_its_entries() {
        let table = TimeValue::Table(vec![[1.0, 10.0], [3.0, 20.0], [4.0, 0.0]]);
        for (t, v) in [(0.0, 10.0), (1.0, 10.0), (2.0, 15.0), (3.0, 20.0), (3.5, 10.0), (4.0, 0.0), (9.0, 0.0)] {
            assert_eq!(table.at(t), v, "at {t}");
        }
        assert_eq!(table.kinks().collect::<Vec<_>>(), [1.0, 3.0, 4.0]);
    }
}
