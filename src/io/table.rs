//! Tables of numbers in CSV: `history.csv` read again, and values to compare with.

use super::atomic;
use crate::error::{Error, Result, shown};
use crate::reading;
use std::borrow::Cow;
use std::path::Path;

/// A column: its name and unit from the heading `head.uy [m]`, and its numbers, NaN where a field is empty.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Column {
    pub name: String,
    /// Empty where the heading has none.
    pub unit: String,
    pub values: Vec<f64>,
}

/// A text as a field: an apostrophe before what a spreadsheet would take for a formula. A number is none.
pub fn guarded(text: &str) -> Cow<'_, str> {
    if is_formula(text.trim_start_matches(GUARD)) { Cow::Owned(format!("{GUARD}{text}")) } else { Cow::Borrowed(text) }
}

/// The text of a field that [`guarded`] made.
pub fn unguarded(field: &str) -> &str {
    let is_guarded = |rest: &&str| is_formula(rest.trim_start_matches(GUARD));
    field.strip_prefix(GUARD).filter(is_guarded).unwrap_or(field)
}

const GUARD: char = '\'';

fn is_formula(text: &str) -> bool {
    text.starts_with(['=', '+', '-', '@', '\t', '\r']) && text.parse::<f64>().is_err()
}

impl Column {
    pub(super) fn new(heading: &str) -> Self {
        let heading = unguarded(heading.trim());
        let split = heading.strip_suffix(']').and_then(|rest| rest.rsplit_once('['));
        let (name, unit) = split.map_or((heading, ""), |(name, unit)| (name.trim_end(), unit.trim()));
        Self { name: name.to_owned(), unit: unit.to_owned(), values: Vec::new() }
    }

    /// Its heading in the file.
    pub fn heading(&self) -> String {
        if self.unit.is_empty() { self.name.clone() } else { format!("{} [{}]", self.name, self.unit) }
    }
}

/// The bytes of a file that is to be a table.
///
/// # Errors
/// `Input` when the file is missing or too large, `Machine` when it cannot be read.
pub(super) fn bytes(path: &Path, remedy: &str) -> Result<Vec<u8>> {
    reading::bytes(path).map_err(|e| atomic::unreadable(path, &e, remedy))
}

/// Writes a table of numbers; a field without one is empty.
///
/// # Errors
/// `Machine` when the file cannot be written.
pub fn write(path: &Path, headings: &[String], rows: &[Vec<Option<f64>>]) -> Result<()> {
    let number = |v: &Option<f64>| v.map_or_else(String::new, |v| format!("{v:?}"));
    atomic::write(path, |out| {
        writeln!(out, "{}", headings.join(","))?;
        rows.iter().try_for_each(|row| writeln!(out, "{}", row.iter().map(number).collect::<Vec<_>>().join(",")))
    })
}

/// Columns of one length.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Table {
    pub columns: Vec<Column>,
}

impl Table {
    /// Reads a table with a heading. A last line without an end is one that a run is writing, and is left out if it is not whole.
    ///
    /// # Errors
    /// `Input` naming the line that is not numbers or has another number of them, or when the file is missing; `Machine` when it
    /// cannot be read.
    pub fn read(path: &Path, remedy: &str) -> Result<Self> {
        Self::parse(&bytes(path, remedy)?, path)
    }

    fn parse(bytes: &[u8], path: &Path) -> Result<Self> {
        let wrong = |line: u64, problem: String| {
            Error::input(format!("{}:{line}", path.display()), problem, "give each row a number for each heading")
        };
        let mut reader = csv::ReaderBuilder::new().flexible(true).trim(csv::Trim::All).from_reader(bytes);
        let heading = reader.headers().map_err(|e| wrong(1, format!("it is not a table: {e}")))?;
        let mut columns: Vec<Column> = heading.iter().map(Column::new).collect();
        let mut row = Vec::with_capacity(columns.len());
        for record in reader.records() {
            let record =
                record.map_err(|e| wrong(e.position().map_or(0, csv::Position::line), format!("is no row: {e}")))?;
            let line = record.position().map_or(0, csv::Position::line);
            row.clear();
            let number = |field: &str| if field.is_empty() { Some(f64::NAN) } else { field.parse().ok() };
            row.extend(record.iter().map_while(number));
            let is_in_hand = || bytes.last() != Some(&b'\n') && reader_is_at_end(bytes, &record);
            let is_whole = row.len() == columns.len() && record.len() == columns.len();
            if (!is_whole || record.iter().any(str::is_empty)) && is_in_hand() {
                break;
            }
            if !is_whole {
                let problem = match record.get(row.len()) {
                    Some(text) if row.len() < columns.len() => format!("`{}` is no number", shown(text)),
                    _ => format!("has {} numbers for {} headings", record.len(), columns.len()),
                };
                return Err(wrong(line, problem));
            }
            columns.iter_mut().zip(&row).for_each(|(column, value)| column.values.push(*value));
        }
        Ok(Self { columns })
    }

    /// Rows.
    pub fn rows(&self) -> usize {
        self.columns.first().map_or(0, |column| column.values.len())
    }

    /// The column called `name`, with its unit or without.
    pub fn column(&self, name: &str) -> Option<&Column> {
        let name = name.trim();
        self.columns.iter().find(|column| column.name == name || column.heading() == name)
    }
}

/// Whether a row is the last one of the bytes.
fn reader_is_at_end(bytes: &[u8], record: &csv::StringRecord) -> bool {
    let start = record.position().map_or(0, csv::Position::byte);
    usize::try_from(start).is_ok_and(|start| !bytes[start.min(bytes.len())..].trim_ascii_start().contains(&b'\n'))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(text: &str) -> Result<Table> {
        Table::parse(text.as_bytes(), Path::new("h.csv"))
    }

    #[test]
    fn columns_have_names_units_and_numbers() {
        let table = parse("time [s],head.uy [m],\"a, b\"\n0,1e-3,-2\n0.5, 2.0 ,3\n").unwrap();
        let [time, uy, other] = &table.columns[..] else { panic!("{table:?}") };
        assert_eq!((time.name.as_str(), time.unit.as_str(), &time.values[..]), ("time", "s", &[0.0, 0.5][..]));
        assert_eq!((uy.heading().as_str(), &uy.values[..]), ("head.uy [m]", &[1e-3, 2.0][..]));
        assert_eq!((other.heading().as_str(), &other.values[..]), ("a, b", &[-2.0, 3.0][..]));
        assert_eq!(table.column("head.uy"), table.column("head.uy [m]"));
        assert_eq!(table.column("uy"), None);
    }

    #[test]
    fn no_text_is_a_formula_and_all_come_back() {
        let formulas = ["=1+1", "+A1", "-2+cmd|' /C calc'!A0", "@SUM(A1)", "'=1", "''-x"];
        for text in formulas {
            let field = guarded(text);
            assert!(field.starts_with('\''), "{field}");
            assert_eq!(unguarded(&field), text);
        }
        for text in ["-0.3", "+1e-3", "-inf", "head", "'head'", "", "a=b"] {
            assert_eq!((&*guarded(text), unguarded(text)), (text, text));
        }
        assert_eq!(parse("'=head.uy [m],time [s]\n1,2\n").unwrap().columns[0].name, "=head.uy");
    }

    #[test]
    fn a_row_that_is_being_written_is_left_out_and_no_other() {
        assert_eq!(parse("a,b\n1,2\n3").unwrap().rows(), 1);
        assert_eq!(parse("a,b\n1,2\n3,4").unwrap().rows(), 2);
        assert_eq!(parse("a,b\n").unwrap().rows(), 0);
        let said = |text| parse(text).unwrap_err().to_string();
        assert!(said("a,b\n1,2\n3\n").contains("h.csv:3: has 1 numbers for 2 headings"), "{}", said("a,b\n1,2\n3\n"));
        assert!(said("a,b\n1,x\n3,4\n").contains("h.csv:2: `x` is no number"));
        assert!(said("a,b\n1,2,3\n3,4\n").contains("h.csv:2: has 3 numbers for 2 headings"));
    }
}
