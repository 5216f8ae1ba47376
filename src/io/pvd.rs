//! Collections (`.pvd`): the files of a series with their times, which ParaView opens as one.

use std::path::Path;

use super::{atomic, vtu};
use crate::error::Result;

/// Writes `path` with a file for each time in s; the names are relative to the folder of `path`. The `note` tells what the
/// series was made from.
///
/// # Errors
/// `Machine` when it cannot be written.
pub fn write(path: &Path, files: &[(f64, String)], note: &str) -> Result<()> {
    atomic::write(path, |out| {
        writeln!(out, "<?xml version=\"1.0\"?>")?;
        vtu::comment(out, note)?;
        writeln!(out, "<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">")?;
        writeln!(out, "<Collection>")?;
        for (time, file) in files {
            writeln!(out, "<DataSet timestep=\"{time:?}\" part=\"0\" file=\"{}\"/>", vtu::escaped(file))?;
        }
        writeln!(out, "</Collection>\n</VTKFile>")
    })
}
