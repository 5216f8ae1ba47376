//! Warnings among the lines of the log.

use std::collections::HashSet;

/// What a line begins with that the user is told, too, at once and at the end of the run.
pub const WARNING: &str = "warning: ";

/// The warnings of a run so far: one that differs from an earlier one in its numbers alone is not given again.
pub struct Told(HashSet<String>);

impl Told {
    /// Those of the log of a run that goes on.
    pub fn of(log: &str) -> Self {
        Self(log.lines().filter(|line| line.starts_with(WARNING)).map(sense).collect())
    }

    /// Whether a warning is new, which it is no more then.
    pub fn is_new(&mut self, warning: &str) -> bool {
        self.0.insert(sense(warning))
    }
}

/// A text without its numbers; names, which are quoted, are whole.
fn sense(text: &str) -> String {
    let is_of_number = |c: char| c.is_ascii_digit() || matches!(c, '.' | '-' | 'e');
    let parts = text.split('`').enumerate();
    parts.map(|(i, part)| if i % 2 == 0 { part.replace(is_of_number, "") } else { format!("`{part}`") }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_warning_with_other_numbers_is_not_new() {
        let mut told = Told::of("step 1\nwarning: phase `p1`: 3 cells\n");
        assert!(!told.is_new("warning: phase `p1`: -2.5e-3 cells"));
        assert!(told.is_new("warning: phase `p2`: 3 cells") && !told.is_new("warning: phase `p2`: 4 cells"));
    }
}
