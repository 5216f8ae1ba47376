//! Files that grow by a line a step: `history.csv`, `energy.csv` (numbers) and `solve.log` (text).
//!
//! A line is with the operating system when the call returns, so that a kill loses none. A checkpoint
//! has the [`Mark`] of each file: how many lines there were, and their hash. [`History::resume`] and [`Log::resume`] cut
//! what came after, and refuse a file whose earlier lines are not those that were written.

use std::fs::{File, OpenOptions};
use std::hash::Hasher;
use std::io::Write;
use std::path::{Path, PathBuf};

use twox_hash::XxHash64;

use super::atomic;
use super::table::guarded;
use crate::error::{Error, Result};
use crate::reading;

const AGAIN: &str = "start the analysis afresh, with --fresh in place of --resume";

/// How much of a file a checkpoint knows.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Mark {
    /// Whole lines, the header of a table included.
    pub lines: u64,
    /// Hash of their bytes (XXH64).
    pub hash: u64,
}

/// A text file that grows by whole lines.
#[derive(Debug)]
pub struct Log {
    file: File,
    path: PathBuf,
    lines: u64,
    hasher: XxHash64,
}

impl Log {
    /// An empty file, replacing an earlier one.
    ///
    /// # Errors
    /// `Machine` when it cannot be written.
    pub fn create(path: &Path) -> Result<Self> {
        atomic::remove(path)?;
        let file = File::create_new(path).map_err(|e| atomic::unwritable(path, &e))?;
        Ok(Self { file, path: path.to_path_buf(), lines: 0, hasher: XxHash64::with_seed(0) })
    }

    /// Opens a file to continue after what the `mark` of a checkpoint knows of it; later lines are cut.
    ///
    /// # Errors
    /// `Input` when it is missing, a link, shorter, or was changed since; `Machine` when it cannot be written.
    pub fn resume(path: &Path, mark: Mark) -> Result<Self> {
        let Mark { lines, hash } = mark;
        atomic::refuse_link(path)?;
        let bytes = reading::bytes(path).map_err(|e| atomic::unreadable(path, &e, AGAIN))?;
        let ends = bytes.iter().enumerate().filter(|&(_, &b)| b == b'\n').map(|(i, _)| i + 1);
        // The length of the first `lines` lines; the one before the first is empty.
        let length = match lines {
            0 => Some(0),
            _ => usize::try_from(lines - 1).ok().and_then(|n| ends.clone().nth(n)),
        };
        let Some(length) = length else {
            let problem = format!("has {} whole lines where the checkpoint knows {lines}", ends.count());
            return Err(Error::input(path.display(), problem, AGAIN));
        };
        let mut hasher = XxHash64::with_seed(0);
        hasher.write(&bytes[..length]);
        if hasher.finish() != hash {
            let problem = format!("its first {lines} lines were changed after they were written");
            return Err(Error::input(path.display(), problem, AGAIN));
        }
        let file = OpenOptions::new().append(true).open(path).map_err(|e| atomic::unwritable(path, &e))?;
        file.set_len(length as u64).map_err(|e| atomic::unwritable(path, &e))?;
        Ok(Self { file, path: path.to_path_buf(), lines, hasher })
    }

    /// Appends a line.
    ///
    /// # Errors
    /// `Machine` when it cannot be written.
    pub fn line(&mut self, text: &str) -> Result<()> {
        // One call, so that a kill cannot come in between.
        let whole = format!("{}\n", text.replace('\n', " "));
        self.file.write_all(whole.as_bytes()).map_err(|e| atomic::unwritable(&self.path, &e))?;
        self.hasher.write(whole.as_bytes());
        self.lines += 1;
        Ok(())
    }

    /// What there is of the file, for a checkpoint.
    pub fn mark(&self) -> Mark {
        Mark { lines: self.lines, hash: self.hasher.finish() }
    }
}

/// A table of numbers in CSV whose header names the quantities with their units, `head.uy (m)`.
#[derive(Debug)]
pub struct History {
    log: Log,
    columns: Vec<String>,
    /// The last row; empty without one.
    last: Vec<Option<f64>>,
}

impl History {
    /// A file with only the header, replacing an earlier one.
    ///
    /// # Errors
    /// `Machine` when it cannot be written.
    pub fn create(path: &Path, columns: &[String]) -> Result<Self> {
        let mut log = Log::create(path)?;
        log.line(&header(columns))?;
        Ok(Self { log, columns: columns.to_vec(), last: Vec::new() })
    }

    /// Opens a file to continue after what the `mark` of a checkpoint knows of it; later rows are cut.
    ///
    /// # Errors
    /// `Input` when it is missing, a link, shorter, has another header, or was changed since; `Machine` when it cannot be
    /// written.
    pub fn resume(path: &Path, columns: &[String], mark: Mark) -> Result<Self> {
        let rows = mark.lines.saturating_sub(1);
        let text = reading::bytes(path).map_err(|e| atomic::unreadable(path, &e, AGAIN))?;
        let first = text.split(|&b| b == b'\n').next().unwrap_or_default();
        if first != header(columns).as_bytes() {
            let problem = format!("has the columns `{}` of another run", String::from_utf8_lossy(first));
            return Err(Error::input(format!("{}:1", path.display()), problem, AGAIN));
        }
        let last = text.split(|&b| b == b'\n').nth(usize::try_from(rows).unwrap_or(usize::MAX)).filter(|_| rows > 0);
        let last = String::from_utf8_lossy(last.unwrap_or_default()).into_owned();
        let last = last.split(',').map(|number| number.parse().ok()).collect();
        Ok(Self { log: Log::resume(path, mark)?, columns: columns.to_vec(), last })
    }

    /// Appends a row, a number a column, or an empty field where there is none.
    ///
    /// # Errors
    /// `Analysis` naming the column whose number is not finite, `Machine` when the row cannot be written.
    pub fn row(&mut self, numbers: &[Option<f64>]) -> Result<()> {
        debug_assert_eq!(numbers.len(), self.columns.len());
        if let Some((i, Some(v))) = numbers.iter().enumerate().find(|(_, v)| v.is_some_and(|v| !v.is_finite())) {
            return Err(Error::analysis(
                format!("{}: column `{}`", self.log.path.display(), self.columns[i]),
                format!("the value is {v}: it was not written"),
                "what was written before is kept; reduce the steps or refine the mesh",
            ));
        }
        // As many digits as tell the number from all others.
        let fields: Vec<String> = numbers.iter().map(|v| v.map_or_else(String::new, |v| format!("{v:?}"))).collect();
        self.log.line(&fields.join(","))?;
        self.last = numbers.to_vec();
        Ok(())
    }

    /// Appends the last row again with another number in the column called `name`; nothing without a row or the column.
    ///
    /// # Errors
    /// As [`History::row`].
    pub fn again(&mut self, name: &str, number: f64) -> Result<()> {
        let mut row = self.last.clone();
        match self.columns.iter().position(|column| column == name).and_then(|i| row.get_mut(i)) {
            Some(place) => *place = Some(number),
            None => return Ok(()),
        }
        self.row(&row)
    }

    /// What there is of the file, for a checkpoint.
    pub fn mark(&self) -> Mark {
        self.log.mark()
    }
}

fn header(columns: &[String]) -> String {
    let quoted = |name: &String| {
        let name = guarded(name);
        if name.contains([',', '"', '\n']) { format!("\"{}\"", name.replace('"', "\"\"")) } else { name.into_owned() }
    };
    columns.iter().map(quoted).collect::<Vec<_>>().join(",").replace('\n', " ")
}

#[cfg(test)]
mod tests;
