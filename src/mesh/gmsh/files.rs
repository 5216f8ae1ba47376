//! Checks of the files that Gmsh reads and writes.

use crate::error::{Error, Result};
use crate::reading;
use std::io::{Read, Seek, SeekFrom};
use std::path::{Path, PathBuf};

const AGAIN: &str = "make the file again with `mpm mesh`";

/// The path must be that of a file that opens.
///
/// # Errors
/// Input: one that does not.
pub fn check_readable(path: &Path) -> Result<()> {
    reading::open(path).map(drop).map_err(|error| Error::input(path.display(), error, "name a file"))
}

/// The sections an MSH file can end with.
const LAST_SECTIONS: [&str; 9] = [
    "Comments",
    "Elements",
    "Periodic",
    "GhostElements",
    "Parametrizations",
    "NodeData",
    "ElementData",
    "ElementNodeData",
    "InterpolationScheme",
];

/// A mesh file that was cut short does not end with the end of a section.
///
/// # Errors
/// Input: such a file, or one that cannot be read.
pub fn check_complete(path: &Path) -> Result<()> {
    let tail = || -> std::io::Result<Vec<u8>> {
        let mut file = reading::open(path)?;
        let length = file.metadata()?.len();
        file.seek(SeekFrom::Start(length.saturating_sub(64)))?;
        let mut tail = Vec::new();
        file.read_to_end(&mut tail)?;
        Ok(tail)
    };
    let tail = tail().map_err(|error| Error::input(path.display(), error, AGAIN))?;
    let tail = String::from_utf8_lossy(&tail);
    let last = tail.trim_end().lines().last().and_then(|line| line.trim().strip_prefix("$End")).unwrap_or_default();
    if LAST_SECTIONS.contains(&last) {
        Ok(())
    } else {
        Err(Error::input(path.display(), "it is cut short or no MSH file", AGAIN))
    }
}

/// Gmsh gets absolute paths: it reads a leading dash and a relative include in its own way.
pub fn absolute(path: &Path) -> PathBuf {
    std::path::absolute(path).unwrap_or_else(|_| path.to_path_buf())
}
