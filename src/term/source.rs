//! Whose work a term does in the balance of energy of a step (docs/theory.md, section 5, *Energy*).

/// Whose work it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Source {
    /// Stress in the material, of all that bears one.
    Stress,
    Gravity,
    /// Tractions and other loads from outside.
    Load,
    /// Water on the boundary and in the pores, but for its excess pressure, which is stress.
    Water,
    Contact,
    /// What stands in for material in cells that hold little of it.
    Penalty,
    Inertia,
}

/// The work (kJ) of the terms along a displacement increment, with the sign of the residual: what goes into stress, inertia, contact and penalties is
/// positive, what loads do negative.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Works([f64; 7]);

impl Works {
    pub fn of(&self, source: Source) -> f64 {
        self.0[source as usize]
    }

    /// Adds the work of the forces (kN) of a term along the increments (m) of the same equations.
    pub fn add(&mut self, source: Source, force: &[f64], increment: &[f64]) {
        self.0[source as usize] += force.iter().zip(increment).map(|(f, u)| f * u).sum::<f64>();
    }

    /// The work of all terms.
    pub fn sum(&self) -> f64 {
        self.0.iter().sum()
    }
}
