//! The one error type of the program: what went wrong, where, and what to do about it.

use std::fmt;

/// Whose turn it is to act. Decides the exit status of the program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// The analysis could not go on; everything until then is kept (exit status 1).
    Analysis,
    /// The input is wrong (exit status 2).
    Input,
    /// Something on the machine is missing: a full disk, an unwritable folder (exit status 3).
    Machine,
    /// The user stopped the program (exit status 130, as shells have it).
    Interrupted,
}

/// An error with the place it concerns, the problem found there and a remedy.
///
/// `place` names a file with its line, or an object (`material point 812 (clay_near)`); `remedy` says
/// what the user can do, and is empty only where nothing can be said.
#[derive(Clone, Debug)]
pub struct Error {
    pub kind: Kind,
    pub place: String,
    pub problem: String,
    pub remedy: String,
}

pub type Result<T> = std::result::Result<T, Error>;

impl Error {
    /// The analysis cannot go on at `place`.
    pub fn analysis(place: impl fmt::Display, problem: impl fmt::Display, remedy: impl fmt::Display) -> Self {
        Self::new(Kind::Analysis, place, problem, remedy)
    }

    /// The input named by `place` is wrong.
    pub fn input(place: impl fmt::Display, problem: impl fmt::Display, remedy: impl fmt::Display) -> Self {
        Self::new(Kind::Input, place, problem, remedy)
    }

    /// The machine lacks what `place` needs.
    pub fn machine(place: impl fmt::Display, problem: impl fmt::Display, remedy: impl fmt::Display) -> Self {
        Self::new(Kind::Machine, place, problem, remedy)
    }

    /// The user stopped the program.
    pub fn interrupted(problem: impl fmt::Display, remedy: impl fmt::Display) -> Self {
        Self::new(Kind::Interrupted, "stopped", problem, remedy)
    }

    fn new(kind: Kind, place: impl fmt::Display, problem: impl fmt::Display, remedy: impl fmt::Display) -> Self {
        Self { kind, place: place.to_string(), problem: problem.to_string(), remedy: remedy.to_string() }
    }

    /// The exit status of the program when it ends with this error.
    pub fn exit_status(&self) -> u8 {
        match self.kind {
            Kind::Analysis => 1,
            Kind::Input => 2,
            Kind::Machine => 3,
            Kind::Interrupted => 130,
        }
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {}", self.place, self.problem)?;
        if !self.remedy.is_empty() {
            write!(f, "; {}", self.remedy)?;
        }
        Ok(())
    }
}

impl std::error::Error for Error {}

impl From<Error> for Vec<Error> {
    fn from(error: Error) -> Self {
        vec![error]
    }
}
