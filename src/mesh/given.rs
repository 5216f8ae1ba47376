//! Meshes that are given in place of a `.geo`: which are read, and how.

use super::{abaqus, msh};
use crate::error::{Error, Result};
use crate::reading;
use std::path::Path;

/// The ends of the names of files that are read.
pub const ENDS: [&str; 3] = [".msh", ".inp", ".med"];

/// Whether a file is read, by the end of its name.
pub fn is_read(file: &Path) -> bool {
    ENDS.iter().any(|end| ends(file, end))
}

/// Whether a file is one of Abaqus, which Gmsh has nothing to do with.
pub fn is_abaqus(file: &Path) -> bool {
    ends(file, ".inp")
}

fn ends(file: &Path, end: &str) -> bool {
    file.extension().is_some_and(|own| own.eq_ignore_ascii_case(&end[1..]))
}

/// A mesh as the content of an MSH 4.1 file, with notes on what is left out; `None` where Gmsh has to convert it, a `.med` or a `.msh` of another
/// version.
///
/// # Errors
/// Input: a file that cannot be read, or as [`abaqus::to_msh`].
pub fn read(file: &Path) -> Result<Option<(Vec<u8>, Vec<String>)>> {
    if is_abaqus(file) {
        return abaqus::to_msh(file).map(|(text, notes)| Some((text.into_bytes(), notes)));
    }
    if ends(file, ".med") {
        return Ok(None);
    }
    let bytes = reading::bytes(file).map_err(|error| Error::input(file.display(), error, "check the path"))?;
    Ok(msh::is_of_version(&bytes).then_some((bytes, Vec::new())))
}
