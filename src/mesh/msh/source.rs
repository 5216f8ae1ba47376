//! The numbers and sections of an MSH file, from text or from binary data, with the place of what is wrong.

use crate::error::{Error, Result};
use std::str;

pub const AGAIN: &str = "make the file again with `mpm mesh`";

/// How the numbers of a file are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Text,
    Binary { big_endian: bool },
}

/// The bytes of a file and how far they are read.
pub struct Source<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Where the word or line that was read last begins.
    last: usize,
    form: Form,
    /// The file as the user named it.
    place: &'a str,
    /// The section at hand, with its `$`; empty outside of all.
    section: String,
}

impl<'a> Source<'a> {
    pub fn new(bytes: &'a [u8], place: &'a str) -> Self {
        Self { bytes, at: 0, last: 0, form: Form::Text, place, section: String::new() }
    }

    /// An error at the present place: the line of a text, the section of a binary file.
    pub fn wrong(&self, problem: impl std::fmt::Display) -> Error {
        self.wrong_but(problem, AGAIN)
    }

    /// As [`Self::wrong`] with a remedy of its own.
    pub fn wrong_but(&self, problem: impl std::fmt::Display, remedy: &str) -> Error {
        match self.at == self.bytes.len() {
            // What is wrong may be the first half of what was right.
            true => self.error(format!("it is cut short or damaged: {problem}"), remedy),
            false => self.error(problem, remedy),
        }
    }

    fn cut_short(&self) -> Error {
        match self.section.as_str() {
            "" => self.error("it is cut short", AGAIN),
            section => self.error(format!("it is cut short in its section {section}"), AGAIN),
        }
    }

    fn error(&self, problem: impl std::fmt::Display, remedy: &str) -> Error {
        let place = match self.form {
            Form::Text => {
                format!("{}, line {}", self.place, 1 + self.bytes[..self.last].iter().filter(|&&c| c == b'\n').count())
            }
            Form::Binary { .. } if self.section.is_empty() => self.place.to_owned(),
            Form::Binary { .. } => format!("{}, section {}", self.place, self.section),
        };
        Error::input(place, problem, remedy)
    }

    /// Passes white space.
    fn skip_space(&mut self) {
        self.at += self.bytes[self.at..].iter().take_while(|c| c.is_ascii_whitespace()).count();
        self.last = self.at;
    }

    /// The rest of the line, without its end and the space around it.
    fn line(&mut self) -> &'a [u8] {
        self.last = self.at;
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(|&c| c == b'\n').unwrap_or(rest.len());
        self.at += (length + 1).min(rest.len());
        rest[..length].trim_ascii()
    }

    /// Opens the next section: its name without the `$`, and the position where its heading begins; `None` at the end.
    ///
    /// # Errors
    /// Input: text outside of the sections.
    pub fn open(&mut self) -> Result<Option<(&'a str, usize)>> {
        self.section.clear();
        self.skip_space();
        let start = self.at;
        if start == self.bytes.len() {
            return Ok(None);
        }
        let line = self.line();
        let name = line.strip_prefix(b"$").and_then(|name| str::from_utf8(name).ok());
        match name.filter(|name| name.starts_with(|c: char| c.is_ascii_uppercase()) && !name.starts_with("End")) {
            Some(name) => {
                self.section = format!("${name}");
                Ok(Some((name, start)))
            }
            None => Err(self.wrong(format!("{} is no section of a mesh file", shown(line)))),
        }
    }

    /// Closes the section at hand, of which everything must have been read.
    ///
    /// # Errors
    /// Input: more in it, or the end of the file.
    pub fn close(&mut self) -> Result<()> {
        self.skip_space();
        if self.at == self.bytes.len() {
            return Err(self.cut_short());
        }
        let line = self.line();
        if line.strip_prefix(b"$End") == self.section.as_bytes().strip_prefix(b"$") {
            return Ok(());
        }
        Err(self.wrong(format!("{} stands where {} should end", shown(line), self.section)))
    }

    /// Passes the section at hand unread, and returns what is in it.
    ///
    /// # Errors
    /// Input: it has no end.
    pub fn skip(&mut self) -> Result<&'a [u8]> {
        let end = format!("$End{}", self.section.strip_prefix('$').unwrap_or_default());
        let rest = &self.bytes[self.at..];
        let dollars = rest.iter().enumerate().filter(|(_, c)| **c == b'$').map(|(i, _)| i);
        match dollars.into_iter().find(|&i| rest[i..].starts_with(end.as_bytes())) {
            Some(length) => {
                self.at += length;
                self.close()?;
                Ok(&rest[..length])
            }
            None => Err(self.cut_short()),
        }
    }

    /// Reads the heart of `$MeshFormat`, after which numbers are read in the form that it names.
    ///
    /// # Errors
    /// Input: another version than 4.1, or numbers of another size than eight bytes.
    pub fn format(&mut self) -> Result<()> {
        let version = self.token()?;
        if version != "4.1" {
            return Err(self.wrong_but(
                format!("it is of MSH version {}, and meshes are read in version 4.1", shown(version.as_bytes())),
                "make the file again with `mpm mesh`, or save it from Gmsh with Mesh.MshFileVersion = 4.1",
            ));
        }
        let (binary, size) = (self.int()?, self.int()?);
        if !matches!(binary, 0 | 1) || size != 8 {
            return Err(self.wrong(format!("a file of type {binary} with data size {size}, not 0 or 1 with 8")));
        }
        if binary == 1 {
            self.line();
            let Some(one) = self.bytes[self.at..].first_chunk::<4>() else { return Err(self.cut_short()) };
            let big_endian = match *one {
                [1, 0, 0, 0] => false,
                [0, 0, 0, 1] => true,
                _ => return Err(self.wrong("the number that tells the order of its bytes is not one")),
            };
            self.at += 4;
            self.form = Form::Binary { big_endian };
        }
        Ok(())
    }

    /// The next word of text.
    ///
    /// # Errors
    /// Input: the end of the file, or bytes that are no text.
    fn token(&mut self) -> Result<&'a str> {
        self.skip_space();
        let rest = &self.bytes[self.at..];
        let length = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        if length == 0 {
            return Err(self.cut_short());
        }
        let token = str::from_utf8(&rest[..length]).map_err(|_| self.wrong("it has bytes that are no text"))?;
        self.at += length;
        Ok(token)
    }

    /// The next word of text as a number.
    fn parsed<T: str::FromStr>(&mut self, what: &str) -> Result<T> {
        let token = self.token()?;
        token.parse().map_err(|_| self.wrong(format!("{} stands where {what} should be", shown(token.as_bytes()))))
    }

    /// The next bytes of a binary file, the least significant first.
    fn little_endian<const N: usize>(&mut self, big_endian: bool) -> Result<[u8; N]> {
        let mut bytes = *self.bytes[self.at..].first_chunk::<N>().ok_or_else(|| self.cut_short())?;
        self.at += N;
        if big_endian {
            bytes.reverse();
        }
        Ok(bytes)
    }

    /// A whole number, which may be negative.
    ///
    /// # Errors
    /// Input: something else, or the end of the file.
    pub fn int(&mut self) -> Result<i32> {
        match self.form {
            Form::Text => self.parsed("a whole number"),
            Form::Binary { big_endian } => Ok(i32::from_le_bytes(self.little_endian(big_endian)?)),
        }
    }

    /// A tag or a count.
    ///
    /// # Errors
    /// As [`Self::int`].
    pub fn size(&mut self) -> Result<u64> {
        match self.form {
            Form::Text => self.parsed("a whole number that is not negative"),
            Form::Binary { big_endian } => Ok(u64::from_le_bytes(self.little_endian(big_endian)?)),
        }
    }

    /// A number.
    ///
    /// # Errors
    /// As [`Self::int`].
    pub fn real(&mut self) -> Result<f64> {
        match self.form {
            Form::Text => self.parsed("a number"),
            Form::Binary { big_endian } => Ok(f64::from_le_bytes(self.little_endian(big_endian)?)),
        }
    }

    /// How many things follow, each of at least `ints` whole numbers and `others` tags, counts and coordinates. The
    /// file has room for so many: what it says alone never makes the program ask for memory.
    ///
    /// # Errors
    /// Input: more than the rest of the file can hold.
    pub fn count(&mut self, what: &str, ints: usize, others: usize) -> Result<usize> {
        let count = self.size()?;
        // In text, each number has a digit and a space before it.
        let each = match self.form {
            Form::Text => 2 * (ints + others),
            Form::Binary { .. } => 4 * ints + 8 * others,
        };
        let room = (self.bytes.len() - self.at) / each;
        match usize::try_from(count) {
            Ok(count) if count <= room => Ok(count),
            _ => Err(self.error(format!("it is cut short or damaged: it has no room for {count} {what}"), AGAIN)),
        }
    }

    /// The number of a line of text.
    ///
    /// # Errors
    /// As [`Self::int`].
    pub fn text_int(&mut self) -> Result<i32> {
        self.parsed("a whole number")
    }

    /// The name in double quotes that ends a line of text.
    ///
    /// # Errors
    /// Input: no quotes, or bytes that are no text.
    pub fn quoted(&mut self) -> Result<&'a str> {
        let line = self.line();
        if self.at == self.bytes.len() {
            return Err(self.cut_short());
        }
        let name = line.strip_prefix(b"\"").and_then(|rest| rest.strip_suffix(b"\""));
        match name.and_then(|name| str::from_utf8(name).ok()) {
            Some(name) if !name.contains('"') => Ok(name),
            _ => Err(self.wrong(format!("{} is no name in double quotes", shown(line)))),
        }
    }
}

/// The beginning of what stands in a file, fit for a message.
fn shown(text: &[u8]) -> String {
    let text = String::from_utf8_lossy(text);
    let mut start: String = text.chars().take(40).collect();
    if start.len() < text.len() {
        start.push('…');
    }
    format!("{start:?}")
}
