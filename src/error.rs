//! The one error type of the program: what went wrong, where, and what to do about it.

use std::borrow::Cow;
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
/// what the user can do, and is empty only where nothing can be said. They may hold names from files: what such
/// names could do to a terminal is escaped when the error is printed ([`plain`]).
#[derive(Clone, Debug)]
pub struct Error {
    pub kind: Kind,
    pub place: String,
    pub problem: String,
    pub remedy: String,
    /// Lines of the file with the place marked, printed below as they are; plain text.
    pub excerpt: String,
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
        let [place, problem, remedy] = [place.to_string(), problem.to_string(), remedy.to_string()];
        Self { kind, place, problem, remedy, excerpt: String::new() }
    }

    /// The error with lines of the file below it.
    pub fn with_excerpt(self, excerpt: String) -> Self {
        Self { excerpt, ..self }
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
        write!(f, "{}: {}", plain(&self.place), plain(&self.problem))?;
        if !self.remedy.is_empty() {
            write!(f, "; {}", plain(&self.remedy))?;
        }
        f.write_str(&self.excerpt)
    }
}

impl std::error::Error for Error {}

impl From<Error> for Vec<Error> {
    fn from(error: Error) -> Self {
        vec![error]
    }
}

/// Whether a terminal would obey a character and not show it: control characters, and those that turn the
/// direction of writing (Unicode Standard Annex 9) or break lines.
fn is_obeyed(c: char) -> bool {
    let turns = matches!(c, '\u{61c}' | '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}');
    c.is_control() || turns || matches!(c, '\u{2028}' | '\u{2029}')
}

/// A text with the characters escaped that a terminal would obey; all others, of any language, stay.
pub fn plain(text: &str) -> Cow<'_, str> {
    escaped(text, is_obeyed)
}

/// As [`plain`] for a text of several lines.
pub fn plain_lines(text: &str) -> Cow<'_, str> {
    escaped(text, |c| c != '\n' && c != '\t' && is_obeyed(c))
}

fn escaped(text: &str, escape: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.chars().any(&escape) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        match escape(c) {
            true => escaped.extend(c.escape_default()),
            false => escaped.push(c),
        }
    }
    Cow::Owned(escaped)
}

/// Characters of a name or text of the input that a message repeats.
const SHOWN: usize = 80;

/// A name or text of the input as a message repeats it: the beginning of a long one.
pub fn shown(text: &str) -> Cow<'_, str> {
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => {
            let mut begun = text[..end].to_owned();
            begun.push('…');
            Cow::Owned(begun)
        }
        None => Cow::Borrowed(text),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_cannot_lead_a_terminal_and_stay_readable() {
        let error =
            Error::input("Gründung 土\u{1b}[2J", "`a\nerror: all is well`\u{9b}1m", "see \u{202e}txt\r\u{2028}");
        let said = error.to_string();
        assert_eq!(said, "Gründung 土\\u{1b}[2J: `a\\nerror: all is well`\\u{9b}1m; see \\u{202e}txt\\r\\u{2028}");
        assert_eq!(plain_lines("a\tb\nc\u{7}"), "a\tb\nc\\u{7}");
        assert_eq!(error.with_excerpt("\n 1 | a".into()).to_string(), said + "\n 1 | a");
    }

    #[test]
    fn long_names_are_cut() {
        assert_eq!(shown("clay"), "clay");
        assert_eq!(shown(&"土".repeat(1000)).chars().count(), SHOWN + 1);
    }
}
