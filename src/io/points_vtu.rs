//! `points.vtu`: every material point with its initial state, bit-exact, viewable as it is.
//!
//! A plain `.vtu` whose last line is a comment with the number of points, the names of the regions, what the points were
//! made from and a checksum (XXH64) of all that stands before it: a file that was cut or edited is refused before its numbers
//! are looked at. A checksum does not tell of a forged file, so the numbers are read by a parser that takes only what [`write()`]
//! writes.

mod plain;

use std::path::Path;

use serde::{Deserialize, Serialize};
use twox_hash::XxHash64;

use super::container::{Store, check_finite};
use super::vtu::{self, Encoding, Grid, Topology};
use super::{atomic, columns, hash};
use crate::error::{Error, Result};
use crate::points::Points;
use crate::program;
use crate::reading;
use plain::POSITION;

const AGAIN: &str = "run `mpm seed` again";
const OPEN: &str = "<!-- mpm points ";
const CLOSE: &str = " -->\n";

/// What points were seeded from.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Source {
    /// Hash of `mesh.msh`.
    pub mesh: String,
    /// Hash of the entries of the case that the points depend on.
    pub case: String,
}

/// What `points.vtu` holds.
#[derive(Clone, Debug)]
pub struct Seeded<const D: usize> {
    pub points: Points<D>,
    /// The names that `points.region` stands for.
    pub regions: Vec<String>,
    pub source: Source,
}

/// The last line of the file.
#[derive(Debug, Serialize, Deserialize)]
struct Trailer {
    points: usize,
    dimension: usize,
    regions: Vec<String>,
    program: String,
    source: Source,
    /// XXH64 of everything before this line, begun with that of the entries above.
    checksum: u64,
}

/// Writes the points with the names that `points.region` stands for and the `source` they were seeded from, atomically.
///
/// # Errors
/// `Analysis` when a number is not finite, `Machine` when the file cannot be written.
pub fn write<const D: usize>(path: &Path, points: &Points<D>, regions: &[String], source: &Source) -> Result<()> {
    let arrays = columns::to_arrays(points);
    for array in &arrays {
        check_finite(array, "material point")?;
    }
    let grid = Grid {
        points: columns::padded(&points.position),
        topology: Topology::vertices(points.len()),
        point_data: arrays.into_iter().filter(|a| a.name != POSITION).map(vtu::Array::from).collect(),
        ..Grid::default()
    };
    atomic::write_durable(path, |out| {
        let mut bytes = Vec::new();
        vtu::write_to(&mut bytes, &grid, Encoding::Plain)?;
        let mut trailer = Trailer {
            points: points.len(),
            dimension: D,
            regions: regions.to_vec(),
            program: program::IDENTITY.to_owned(),
            source: source.clone(),
            checksum: 0,
        };
        trailer.checksum = trailer_checksum(&trailer, &bytes);
        // Two hyphens may not stand in a comment.
        let trailer = serde_json::to_string(&trailer)?.replace("--", "-\\u002d");
        out.write_all(&bytes)?;
        write!(out, "{OPEN}{trailer}{CLOSE}")
    })
}

/// Reads the points, the names of their regions and what they were seeded from.
///
/// # Errors
/// `Input` when the file is missing, cut, edited, or not one of [`write()`] with this dimension.
pub fn read<const D: usize>(path: &Path) -> Result<Seeded<D>> {
    let bytes = reading::bytes(path).map_err(|e| atomic::unreadable(path, &e, AGAIN))?;
    let broken = |problem: String| Error::input(path.display(), problem, AGAIN);
    let (xml, trailer) = split_trailer(&bytes)
        .ok_or_else(|| broken("is cut off, edited, or not written by mpm: its last line is not its checksum".into()))?;
    if trailer.checksum != trailer_checksum(&trailer, xml) {
        return Err(broken("was changed after it was written: it does not match its checksum".into()));
    }
    if trailer.dimension != D {
        return Err(broken(format!("holds points in {} dimensions where {D} are expected", trailer.dimension)));
    }
    let arrays = plain::arrays(xml).map_err(broken)?;
    let mut store = Store::new("points.vtu");
    store.set_origin(path.display().to_string(), AGAIN);
    arrays.into_iter().for_each(|array| store.put_array(array));
    let points: Points<D> = columns::take(&mut store, "")?;
    if points.len() != trailer.points {
        return Err(broken(format!("holds {} points where {} are expected", points.len(), trailer.points)));
    }
    let unnamed = points.region.iter().position(|&r| usize::from(r) >= trailer.regions.len());
    if let Some(i) = unnamed {
        return Err(broken(format!("material point {i} is in region {}, which has no name", points.region[i])));
    }
    Ok(Seeded { points, regions: trailer.regions, source: trailer.source })
}

/// The program that a file of points was made by and its source, if its last line can be read: for `mpm info`.
pub fn inspect(bytes: &[u8]) -> Option<(String, Source)> {
    split_trailer(bytes).map(|(_, trailer)| (trailer.program, trailer.source))
}

fn trailer_checksum(trailer: &Trailer, xml: &[u8]) -> u64 {
    let Trailer { points, dimension, regions, program, source: Source { mesh, case }, checksum: _ } = trailer;
    let head = format!("{points} {dimension} {regions:?} {program:?} {mesh} {case}");
    XxHash64::oneshot(hash::bytes(head.as_bytes()), xml)
}

/// The XML and the last line.
fn split_trailer(bytes: &[u8]) -> Option<(&[u8], Trailer)> {
    let end = bytes.strip_suffix(CLOSE.as_bytes())?;
    let start = end.iter().rposition(|&b| b == b'\n')? + 1;
    let trailer = serde_json::from_slice(end[start..].strip_prefix(OPEN.as_bytes())?).ok()?;
    Some((&bytes[..start], trailer))
}

#[cfg(test)]
mod tests;
