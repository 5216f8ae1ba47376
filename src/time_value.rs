//! A value that varies in time: prescribed displacements, tractions and the factor on gravity.

use std::sync::Arc;

/// A value in a phase's own time (s).
#[derive(Clone, Debug, PartialEq)]
pub enum TimeValue {
    Constant(f64),
    /// Grows from 0 by this much a second.
    Rate(f64),
    /// Pairs of time and value, times growing: linear between, constant before the first and after the last.
    Table(Vec<[f64; 2]>),
    /// The displacement (m) that a record of acceleration gives.
    Record(Arc<Record>),
}

impl TimeValue {
    /// The value at time `t` (s) since the beginning of the phase.
    pub fn at(&self, t: f64) -> f64 {
        match self {
            Self::Constant(value) => *value,
            Self::Rate(rate) => rate * t,
            Self::Table(table) => interpolate(table, t),
            Self::Record(record) => record.at(t).displacement,
        }
    }

    /// Whether it is 0 throughout.
    pub fn is_zero(&self) -> bool {
        match self {
            Self::Constant(value) | Self::Rate(value) => *value == 0.0,
            Self::Table(table) => table.iter().all(|[_, value]| *value == 0.0),
            Self::Record(record) => record.entries.iter().all(|(_, at)| at.acceleration == 0.0),
        }
    }

    /// This times a factor.
    pub fn scaled(&self, by: f64) -> Self {
        match self {
            Self::Constant(value) => Self::Constant(by * value),
            Self::Rate(rate) => Self::Rate(by * rate),
            Self::Table(table) => Self::Table(table.iter().map(|[t, v]| [*t, by * v]).collect()),
            Self::Record(record) => {
                let of = |&(t, at): &(f64, Motion)| [t, by * at.acceleration];
                Self::Record(Arc::new(Record::new(&record.entries.iter().map(of).collect::<Vec<_>>())))
            }
        }
    }

    /// Times (s) at which the slope jumps: a step had better end there.
    pub fn kinks(&self) -> impl Iterator<Item = f64> + '_ {
        let table: &[[f64; 2]] = if let Self::Table(table) = self { table } else { &[] };
        let record = if let Self::Record(record) = self { &record.entries[..] } else { &[] };
        table.iter().map(|&[t, _]| t).chain(record.iter().map(|&(t, _)| t))
    }

    /// The record whose displacement it is.
    pub fn record(&self) -> Option<&Record> {
        if let Self::Record(record) = self { Some(record) } else { None }
    }
}

/// A motion in one direction.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Motion {
    /// Displacement (m), velocity (m/s) and acceleration (m/s²).
    pub displacement: f64,
    pub velocity: f64,
    pub acceleration: f64,
}

impl Motion {
    /// That after a time `dt` (s) in which the acceleration has gone evenly to `next`.
    fn after(self, dt: f64, next: f64) -> Self {
        let Self { displacement, velocity, acceleration } = self;
        Self {
            displacement: displacement + dt * velocity + dt * dt * (acceleration / 3.0 + next / 6.0),
            velocity: velocity + 0.5 * dt * (acceleration + next),
            acceleration: next,
        }
    }
}

/// A record of acceleration with the motion that it gives, from rest at the time 0: linear between its entries, constant before the first and after the last.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    /// Times (s) from 0 on, with the motion there.
    entries: Vec<(f64, Motion)>,
}

impl Record {
    /// That of pairs of time (s) and acceleration (m/s²), times growing.
    pub fn new(table: &[[f64; 2]]) -> Self {
        let mut entries = vec![(0.0, Motion { acceleration: interpolate(table, 0.0), ..Motion::default() })];
        for &[t, next] in table.iter().filter(|[t, _]| *t > 0.0) {
            let (before, motion) = entries[entries.len() - 1];
            entries.push((t, motion.after(t - before, next)));
        }
        Self { entries }
    }

    /// The motion at the time `t` (s).
    pub fn at(&self, t: f64) -> Motion {
        let after = self.entries.partition_point(|&(time, _)| time <= t).max(1);
        let (begin, motion) = self.entries[after - 1];
        let next = self.entries.get(after).map_or(motion.acceleration, |&(end, at)| {
            motion.acceleration + (at.acceleration - motion.acceleration) * (t - begin) / (end - begin)
        });
        if t > begin { motion.after(t - begin, next) } else { motion }
    }

    /// When it ends (s).
    pub fn end(&self) -> f64 {
        self.entries[self.entries.len() - 1].0
    }

    /// The largest velocity (m/s) at its entries until a time (s).
    pub fn fastest(&self, until: f64) -> f64 {
        let entries = self.entries.iter().filter(|(t, _)| *t <= until);
        entries.map(|(_, at)| at.velocity.abs()).fold(self.at(until).velocity.abs(), f64::max)
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

    /// A triangle of acceleration: the areas under it and under its velocity.
    #[test]
    fn a_record_is_integrated_exactly() {
        let record = Record::new(&[[0.0, 0.0], [1.0, 6.0], [3.0, 0.0]]);
        let (half, peak, end) = (record.at(0.5), record.at(1.0), record.at(3.0));
        assert_eq!(half, Motion { displacement: 0.125, velocity: 0.75, acceleration: 3.0 });
        assert_eq!(peak, Motion { displacement: 1.0, velocity: 3.0, acceleration: 6.0 });
        assert_eq!(end, Motion { displacement: 1.0 + 6.0 + 8.0, velocity: 9.0, acceleration: 0.0 });
        assert_eq!(record.at(4.0).displacement, 15.0 + 9.0);
        assert_eq!((record.end(), record.fastest(1.0), record.fastest(9.0)), (3.0, 3.0, 9.0));
        let late = Record::new(&[[1.0, 2.0]]);
        assert_eq!(late.at(2.0), Motion { displacement: 4.0, velocity: 4.0, acceleration: 2.0 });
        assert_eq!(TimeValue::Record(record.into()).scaled(2.0).at(3.0), 30.0);
    }
}
