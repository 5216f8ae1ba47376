//! Reads plane meshes from input files of Abaqus, as Abaqus/CAE, Gmsh and others write them.
//!
//! Parts are placed by their instances (*Abaqus Keywords Guide*, `*INSTANCE`), so that numbers of nodes and elements count within one
//! instance only. The regions are those of the sections; where there are none, the sets of elements. Surfaces, sets of nodes and sets of
//! line elements become curves, single nodes points.

mod curves;
mod keywords;
mod model;
mod parts;
mod place;
mod reader;
mod regions;
#[cfg(test)]
mod tests;
mod types;
mod write;

use crate::error::{Error, Result};
use crate::reading;
use std::path::Path;

/// Reads the file `path` and gives it as the text of an MSH 4.1 file, with notes on what is left out.
///
/// # Errors
/// Input: a file that is none of Abaqus or that makes its mesh by keywords such as `*ELGEN`; nodes and elements that are there twice or not
/// at all; elements that are not plane, or whose region is not clear.
pub fn to_msh(path: &Path) -> Result<(String, Vec<String>)> {
    let place = path.display().to_string();
    let bytes = reading::bytes(path).map_err(|error| Error::input(&place, error, "check the path"))?;
    parse(&bytes, &place)
}

/// As [`to_msh`], from the bytes of the file called `place`.
///
/// # Errors
/// As [`to_msh`].
pub fn parse(bytes: &[u8], place: &str) -> Result<(String, Vec<String>)> {
    // Names may be in any encoding.
    let text = String::from_utf8_lossy(bytes);
    let model = parts::read(&text, place)?;
    if !model.elements.iter().any(|element| element.is_cell()) {
        return Err(Error::input(
            place,
            "it has no plane elements",
            "export the mesh of a plane or axisymmetric model",
        ));
    }
    let regions = regions::of(&model, place)?;
    let (groups, notes) = curves::of(&model, &regions);
    Ok((write::msh(&model, &regions, &groups), model.notes.into_iter().chain(notes).collect()))
}
