//! Columns of the frames.

use crate::io::frame::Column;

/// A column by its values, `components` of each.
pub(super) fn column(name: &str, unit: &str, components: usize, values: Vec<f64>) -> Column {
    Column { name: name.into(), unit: unit.into(), components, values }
}

/// Vectors as those of space.
pub(super) fn triples<const D: usize>(x: &[[f64; D]]) -> Vec<[f64; 3]> {
    x.iter().map(|x| std::array::from_fn(|d| x.get(d).copied().unwrap_or(0.0))).collect()
}
