//! What a run wrote to its history.

use std::fs;
use std::path::Path;

/// A field; NaN where it is empty, as there is no soil to have a value.
fn number(field: &str) -> f64 {
    if field.is_empty() { f64::NAN } else { field.parse().unwrap() }
}

/// The column `name` of `history.csv` in the folder of a run, a number a row.
pub fn column(folder: &Path, name: &str) -> Vec<f64> {
    let text = fs::read_to_string(folder.join("history.csv")).unwrap();
    let mut lines = text.lines();
    let at = lines.next().unwrap().split(',').position(|column| column == name);
    let at = at.unwrap_or_else(|| panic!("no column {name} in {text}"));
    lines.map(|line| number(line.split(',').nth(at).unwrap())).collect()
}

/// The rows of `history.csv` in the folder of a run, without its head.
pub fn rows(folder: &Path) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(folder.join("history.csv")).unwrap();
    text.lines().skip(1).map(|line| line.split(',').map(number).collect()).collect()
}
