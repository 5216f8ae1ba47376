//! The state at the end of each phase of a run, `phases/00-install.mpms`, which another run may begin with.
//!
//! What the state holds is the caller's business ([`Store`]). What it belongs to stands in the head of the file ([`End`]).

use std::fs;
use std::hash::Hasher;
use std::path::{Path, PathBuf};

use twox_hash::XxHash64;

use super::container::Store;
use super::{atomic, hash};
use crate::error::{Error, Result};
use crate::points::Points;
use crate::program;

/// The folder within that of a run.
pub const FOLDER: &str = "phases";
/// The entry of the case in the head of a file.
pub const CASE: &str = "case";
const KIND: &str = "phase";
const AGAIN: &str = "solve that run again";

/// The end of a phase, and what its state belongs to.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct End {
    /// The name of the phase, and whether it is the last one of the run.
    pub phase: String,
    pub last: bool,
    /// The entries of the case that the state depends on, with the phases up to this one, as JSON.
    pub case: String,
    /// The hash of `mesh.msh`, and that of where and how large the material points were when seeded.
    pub mesh: String,
    pub points: String,
    /// The hash of the sources of the program that solved it.
    pub program: String,
}

/// The hash of where and how large points are when seeded, whatever their material.
pub fn hash_of<const D: usize>(points: &Points<D>) -> u64 {
    let mut hasher = XxHash64::with_seed(0);
    for (p, x) in points.position.iter().enumerate() {
        x.iter().chain([&points.initial_volume[p]]).for_each(|value| hasher.write(&value.to_le_bytes()));
        hasher.write(&points.region[p].to_le_bytes());
    }
    hasher.finish()
}

/// Writes the state at the end of phase `number`.
///
/// # Errors
/// `Analysis` when a number is not finite, `Machine` when it cannot be written.
pub fn save(folder: &Path, number: usize, end: &End, mut store: Store) -> Result<()> {
    let End { phase, last, case, mesh, points, program } = end;
    for (name, text) in [("phase", phase), (CASE, case), ("mesh", mesh), ("points", points), ("sources", program)] {
        store.put_text(name, text);
    }
    store.put_text("last", last.to_string());
    store.put_text("program", program::IDENTITY);
    store.write(&folder.join(name(number, phase)), true).map(drop)
}

/// An empty store to fill for [`save`].
pub fn store() -> Store {
    Store::new(KIND)
}

/// The name of a file: what a file system may not bear of the name of a phase is left out of it.
fn name(number: usize, phase: &str) -> String {
    let plain = |c: char| if c.is_ascii_alphanumeric() || "-_".contains(c) { c } else { '_' };
    let plain: String = phase.chars().take(80).map(plain).collect();
    format!("{number:02}-{plain}.mpms")
}

/// Whether a name is one of those that `name` gives; a copy of a state under another name is its owner's.
pub fn is_name(name: &str) -> bool {
    let number = name.strip_suffix(".mpms").and_then(|name| name.split_once('-')).map(|(number, _)| number);
    number.is_some_and(|number| number.len() >= 2 && number.bytes().all(|digit| digit.is_ascii_digit()))
}

/// The states in a folder with what they belong to, in the order of their phases; none where there is no folder.
///
/// # Errors
/// `Input` for a file that is damaged, `Machine` for one that cannot be read.
pub fn list(folder: &Path) -> Result<Vec<(PathBuf, End)>> {
    let mut paths = paths(folder)?;
    paths.sort();
    let read = |path: PathBuf| {
        let contents = Store::peek(&path, KIND, AGAIN)?;
        let text = |name: &str| {
            let missing = || Error::input(path.display(), format!("text `{name}` is missing"), AGAIN);
            contents.texts.get(name).cloned().ok_or_else(missing)
        };
        let end = End {
            phase: text("phase")?,
            last: text("last")? == "true",
            case: text(CASE)?,
            mesh: text("mesh")?,
            points: text("points")?,
            program: text("sources")?,
        };
        Ok((path, end))
    };
    paths.into_iter().map(read).collect()
}

fn paths(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries = match fs::read_dir(folder) {
        Ok(entries) => entries,
        Err(e) if e.kind() == std::io::ErrorKind::NotFound => return Ok(Vec::new()),
        Err(e) => return Err(atomic::unreadable(folder, &e, AGAIN)),
    };
    let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
    Ok(paths.filter(|path| path.file_name().and_then(|name| name.to_str()).is_some_and(is_name)).collect())
}

/// Reads a state, if it is the one of that hash.
///
/// # Errors
/// `Input` when it is damaged or another one.
pub fn read(path: &Path, hash: u64) -> Result<Store> {
    if hash::file(path, AGAIN)? != hash {
        return Err(Error::input(path.display(), "it was changed while it was read", "start the command again"));
    }
    Store::read(path, KIND, AGAIN)
}

/// Makes the folder at the start of a run, without states of an earlier one: where the run takes the place of that, none of them stays.
///
/// # Errors
/// `Machine` when one cannot be removed, or the folder not be made.
pub fn begin(folder: &Path) -> Result<()> {
    atomic::prepare_folder(folder)?;
    paths(folder)?.iter().try_for_each(|path| atomic::remove(path))
}
