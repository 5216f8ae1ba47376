//! Reads `table.csv` of a sweep, or any other table with headings, whose fields may be texts.
//!
//! The columns of a sweep are `run`, its parameters, `state`, `time [s]`, and for each quantity of the histories its
//! `last`, `min` and `max`. A field is empty where a run has no such value.

use super::table::{Column, bytes, unguarded};
use crate::error::{Error, Result, shown};
use std::ops::Range;
use std::path::{Path, PathBuf};

/// The file in the folder of a sweep.
pub const FILE: &str = "table.csv";

/// The heading of the first column of a sweep, the names of its runs.
pub const RUN: &str = "run";
/// The heading of how its runs ended.
pub const STATE: &str = "state";
/// The state of a run that has reached its end.
pub const FINISHED: &str = "finished";
/// The values of a quantity of a history.
pub const SUMMARIES: [&str; 3] = ["last", "min", "max"];

/// The table at a path: a CSV file, or the table in the folder of a sweep.
pub fn file(path: &Path) -> PathBuf {
    let is_table = path.extension().is_some_and(|kind| kind.eq_ignore_ascii_case("csv")) && !path.is_dir();
    if is_table { path.to_owned() } else { path.join(FILE) }
}

/// Refuses to replace a file that is no table of a sweep: it is somebody else's.
///
/// # Errors
/// `Input` for such a file.
pub fn refuse_others(path: &Path) -> Result<()> {
    if path.symlink_metadata().is_err() || SweepTable::read(path, "").is_ok_and(|table| table.is_sweep()) {
        return Ok(());
    }
    let problem = "it is there already, and not by `mpm sweep`, which would replace it";
    Err(Error::input(path.display(), problem, "move it away, or choose another folder with -o"))
}

/// A value with six significant digits.
pub fn short(value: f64) -> String {
    let rounded = format!("{value:.5e}").parse().unwrap_or(value);
    match value.abs() {
        0.0 => "0".to_owned(),
        1e-3..1e6 => format!("{rounded}"),
        _ => format!("{rounded:e}"),
    }
}

/// A table of texts.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SweepTable {
    /// What messages call it.
    pub name: String,
    /// Names and units; no values. The heading of a parameter of a sweep is its name, whole: it may end as `contacts[0]` does.
    pub columns: Vec<Column>,
    /// A field for each column.
    pub rows: Vec<Vec<String>>,
}

impl SweepTable {
    /// Reads a table.
    ///
    /// # Errors
    /// `Input` when the file is missing or no table, `Machine` when it cannot be read.
    pub fn read(path: &Path, remedy: &str) -> Result<Self> {
        Self::parse(&bytes(path, remedy)?, path.display().to_string())
    }

    fn parse(bytes: &[u8], name: String) -> Result<Self> {
        let no_table = |e: csv::Error| {
            let place = format!("{name}:{}", e.position().map_or(1, csv::Position::line));
            Error::input(place, format!("it is not a table: {e}"), "give each row a field for each heading")
        };
        let mut reader = csv::ReaderBuilder::new().trim(csv::Trim::All).from_reader(bytes);
        let headings = reader.headers().map_err(no_table)?.clone();
        let is_sweep = headings.get(0) == Some(RUN);
        let parameters =
            headings.iter().position(|heading| heading == STATE).filter(|_| is_sweep).map_or(0..0, |end| 1..end);
        let column = |(k, heading): (usize, &str)| match parameters.contains(&k) {
            true => Column { name: unguarded(heading).to_owned(), ..Column::default() },
            false => Column::new(heading),
        };
        let columns = headings.iter().enumerate().map(column).collect();
        let fields = |record: csv::StringRecord| record.iter().map(|field| unguarded(field).to_owned()).collect();
        let rows: csv::Result<Vec<Vec<String>>> = reader.records().map(|record| record.map(fields)).collect();
        Ok(Self { rows: rows.map_err(no_table)?, columns, name: name.clone() })
    }

    /// The number of the column called `name`, with its unit or without.
    pub fn position(&self, name: &str) -> Option<usize> {
        let name = name.trim();
        self.columns.iter().position(|column| column.name == name || column.heading() == name)
    }

    /// Whether it is the table of a sweep.
    pub fn is_sweep(&self) -> bool {
        self.position(RUN) == Some(0) && self.position(STATE).is_some()
    }

    /// The columns of the parameters of a sweep; none of another table.
    pub fn parameters(&self) -> Range<usize> {
        match self.position(STATE) {
            Some(end) if self.is_sweep() => 1..end,
            _ => 0..0,
        }
    }

    /// Rows of runs that have not reached their end; none of a table that is not of a sweep.
    pub fn unfinished(&self) -> usize {
        let state = self.position(STATE).filter(|_| self.is_sweep());
        state.map_or(0, |state| self.rows.iter().filter(|row| row[state] != FINISHED).count())
    }

    /// The numbers of a column, nothing where a field is empty; `nan` and `inf` are numbers.
    ///
    /// # Errors
    /// `Input` naming the first field that is no number.
    pub fn numbers(&self, column: usize) -> Result<Vec<Option<f64>>> {
        let number = |(row, fields): (usize, &Vec<String>)| match fields[column].as_str() {
            "" => Ok(None),
            text => text.parse().map(Some).map_err(|_| {
                let heading = self.columns[column].heading();
                let problem =
                    format!("the column `{heading}` is not numeric: its row {} has `{}`", row + 1, shown(text));
                Error::input(&self.name, problem, "choose a column of numbers; `--list` says which are")
            }),
        };
        self.rows.iter().enumerate().map(number).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: &str = "run,seed,model,state,time [s],a.uy last [m]\n\
        x,1,tresca,finished,1.0,-2.5\ny,2,\"a, b\",ended early: step,0.5,\n";

    #[test]
    fn columns_of_a_sweep_are_told_apart() {
        let table = SweepTable::parse(TABLE.as_bytes(), "t.csv".into()).unwrap();
        assert_eq!((table.parameters(), table.unfinished()), (1..3, 1));
        assert_eq!(table.position("a.uy last"), table.position("a.uy last [m]"));
        assert_eq!(table.numbers(1).unwrap(), [Some(1.0), Some(2.0)]);
        assert_eq!(table.numbers(5).unwrap(), [Some(-2.5), None]);
        let said = table.numbers(2).unwrap_err().to_string();
        assert!(said.contains("t.csv: the column `model` is not numeric: its row 1 has `tresca`"), "{said}");
    }

    #[test]
    fn headings_of_parameters_are_whole() {
        let table = SweepTable::parse(b"run,c.a[0],c.a[1],state[2],state,F last [kN]\n", "t.csv".into()).unwrap();
        assert_eq!((table.is_sweep(), table.parameters()), (true, 1..4));
        assert_eq!(["c.a[0]", "c.a[1]", "c.a"].map(|name| table.position(name)), [Some(1), Some(2), None]);
        assert_eq!((table.columns[2].unit.as_str(), table.columns[5].unit.as_str()), ("", "kN"));
    }

    #[test]
    fn values_have_six_digits() {
        let said = [0.0, -0.0, 9.5, -1e-7, 1.0 / 3.0, 123_456.7, 9_999_999.0, 2e-3 / 3.0, f64::NAN].map(short);
        assert_eq!(said, ["0", "0", "9.5", "-1e-7", "0.333333", "123457", "1e7", "6.66667e-4", "NaN"]);
    }

    #[test]
    fn another_table_has_no_parameters_and_a_torn_one_is_refused() {
        let table = SweepTable::parse(b"x,state\n1,2\n", "t.csv".into()).unwrap();
        assert_eq!((table.parameters(), table.unfinished()), (0..0, 0));
        let said = SweepTable::parse(b"x,y\n1,2\n3\n", "t.csv".into()).unwrap_err().to_string();
        assert!(said.contains("t.csv:3"), "{said}");
    }
}
