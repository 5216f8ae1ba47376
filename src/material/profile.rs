//! A parameter of a model that may vary with depth.

use crate::error::{Error, Result};

/// A parameter that may vary with depth: `max(top + gradient · max(0, datum − y), least)`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Profile {
    /// Value at the height `datum` and above.
    pub top: f64,
    /// Growth per metre below `datum`; below 0 the value falls with depth, as under a crust.
    pub gradient: f64,
    /// Height y (m) at which the growth begins.
    pub datum: f64,
    /// The value falls no further than to this; −∞ where it does not fall.
    pub least: f64,
}

impl Profile {
    pub fn constant(value: f64) -> Self {
        Self::growing(value, 0.0, 0.0)
    }

    /// One that grows by `gradient` a metre below the height `datum` (m).
    pub fn growing(top: f64, gradient: f64, datum: f64) -> Self {
        Self { top, gradient, datum, least: f64::NEG_INFINITY }
    }

    /// This times a factor above 0.
    pub fn scaled(&self, by: f64) -> Self {
        Self { top: by * self.top, gradient: by * self.gradient, least: by * self.least, ..*self }
    }

    /// The value at height `y` (m).
    #[inline]
    pub fn at(&self, y: f64) -> f64 {
        (self.top + self.gradient * (self.datum - y).max(0.0)).max(self.least)
    }

    /// # Errors
    /// Unless the value at height `y` is positive and finite; `name` is the parameter's.
    pub fn positive_at(&self, name: &str, y: f64) -> Result<()> {
        self.require(name, y, "positive", |v| v > 0.0)
    }

    /// # Errors
    /// Unless the value at height `y` is zero or more and finite; `name` is the parameter's.
    pub fn not_negative_at(&self, name: &str, y: f64) -> Result<()> {
        self.require(name, y, "zero or more", |v| v >= 0.0)
    }

    fn require(&self, name: &str, y: f64, range: &str, inside: fn(f64) -> bool) -> Result<()> {
        let value = self.at(y);
        if inside(value) && value.is_finite() && self.gradient.is_finite() && self.datum.is_finite() {
            return Ok(());
        }
        let (problem, remedy) = if self.gradient == 0.0 {
            (format!("{value} is not {range}"), format!("give a value that is {range}"))
        } else {
            (
                format!("{value} at y = {y} is not {range}"),
                "change top, gradient or datum so that it holds over the whole depth".to_string(),
            )
        };
        Err(Error::input(name, problem, remedy))
    }
}
