//! Where instances put their parts.

use super::keywords::{Block, entries};
use crate::error::{Error, Result};

/// Where an instance is: moved, then turned about an axis.
#[derive(Default)]
pub struct Shift {
    by: [f64; 3],
    /// Two points on the axis (m), and the angle (rad).
    turn: Option<([f64; 3], [f64; 3], f64)>,
}

impl Shift {
    /// That of the data of an `*INSTANCE`.
    ///
    /// # Errors
    /// Input: other data.
    pub fn of(block: &Block, place: &str) -> Result<Self> {
        let wrong = |line: usize| {
            Error::input(
                format!("{place}, line {line}"),
                "it is no place of an instance",
                "write x, y, z, and below two points and an angle",
            )
        };
        let numbers = |i: usize| -> Result<Vec<f64>> {
            let Some((line, data)) = block.data.get(i) else { return Ok(Vec::new()) };
            entries(data).map(|entry| number(entry).ok_or_else(|| wrong(*line))).collect()
        };
        let by = match numbers(0)?[..] {
            [] => [0.0; 3],
            [x, y] => [x, y, 0.0],
            [x, y, z] => [x, y, z],
            _ => return Err(wrong(block.line)),
        };
        let turn = match numbers(1)?[..] {
            [] => None,
            [a, b, c, d, e, f, angle] if [a, b, c] != [d, e, f] => Some(([a, b, c], [d, e, f], angle.to_radians())),
            _ => return Err(wrong(block.line)),
        };
        Ok(Self { by, turn })
    }

    /// Where it puts a node.
    pub fn put(&self, x: [f64; 3]) -> [f64; 3] {
        let x = [0, 1, 2].map(|d| x[d] + self.by[d]);
        let Some((a, b, angle)) = self.turn else { return x };
        let axis = [0, 1, 2].map(|d| b[d] - a[d]);
        let length = axis.iter().map(|v| v * v).sum::<f64>().sqrt();
        let n = axis.map(|v| v / length);
        let r = [0, 1, 2].map(|d| x[d] - a[d]);
        let along: f64 = (0..3).map(|d| n[d] * r[d]).sum();
        let across = [n[1] * r[2] - n[2] * r[1], n[2] * r[0] - n[0] * r[2], n[0] * r[1] - n[1] * r[0]];
        let (sin, cos) = angle.sin_cos();
        [0, 1, 2].map(|d| a[d] + r[d] * cos + across[d] * sin + n[d] * along * (1.0 - cos))
    }
}

/// A number, perhaps with the `D` of Fortran in its exponent.
pub fn number(text: &str) -> Option<f64> {
    text.replace(['d', 'D'], "e").parse().ok().filter(|value: &f64| value.is_finite())
}
