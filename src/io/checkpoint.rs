//! Checkpoints: what a run that was cut short continues from.
//!
//! The last two are kept, `step-000000456.mpmc`; the newest that is whole is taken. What a checkpoint holds is
//! the caller's business ([`Store`]); that it belongs to the same case, mesh and points is checked here.

use std::fmt;
use std::path::{Path, PathBuf};

use twox_hash::XxHash64;

use super::container::Store;
use super::{atomic, hash};
use crate::error::{Error, Result};
use crate::program;

const KIND: &str = "checkpoint";
const KEPT: usize = 2;
const AGAIN: &str = "start the analysis afresh, without --resume";

const NAME: [&str; 2] = ["step-", ".mpmc"];

/// Whether a name is that of a checkpoint.
pub fn is_name(name: &str) -> bool {
    atomic::number::<u64>(name, NAME[0], NAME[1]).is_some()
}

/// A number that tells whether a checkpoint belongs to a case: a hash (XXH64) of everything that the result
/// depends on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Fingerprint(u64);

impl From<u64> for Fingerprint {
    fn from(hash: u64) -> Self {
        Self(hash)
    }
}

impl fmt::Display for Fingerprint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&hash::text(self.0))
    }
}

impl Fingerprint {
    /// The fingerprint of several parts (the resolved case, the mesh, the points) in this order.
    pub fn of(parts: &[&[u8]]) -> Self {
        // The length goes in too, so that what moves from one part to the next is noticed.
        Self(parts.iter().fold(0, |seed, part| XxHash64::oneshot(seed ^ part.len() as u64, part)))
    }
}

/// The checkpoints of a run, in a folder of their own.
#[derive(Clone, Debug)]
pub struct Checkpoints {
    folder: PathBuf,
    fingerprint: Fingerprint,
}

/// A checkpoint that was read.
#[derive(Debug)]
pub struct Loaded {
    pub step: u64,
    pub store: Store,
    /// What is wrong with newer checkpoints that were passed over.
    pub warnings: Vec<String>,
}

impl Checkpoints {
    pub fn new(folder: impl Into<PathBuf>, fingerprint: Fingerprint) -> Self {
        Self { folder: folder.into(), fingerprint }
    }

    /// An empty store to fill for [`Checkpoints::save`].
    pub fn store() -> Store {
        Store::new(KIND)
    }

    /// Writes the checkpoint of `step`, then removes all but the last two.
    ///
    /// # Errors
    /// `Analysis` when a number is not finite, `Machine` when it cannot be written; earlier ones stay.
    pub fn save(&self, step: u64, mut store: Store) -> Result<()> {
        atomic::prepare_folder(&self.folder)?;
        store.put("checkpoint.fingerprint", 1, vec![self.fingerprint.0]);
        // Renamed, not waited for: a kill loses nothing, and a step of milliseconds must not wait for the disk.
        store.put_text("program", program::IDENTITY);
        store.write(&self.path(step), false)?;
        // Newer ones are of a run whose later part is being done again.
        let mut steps = self.steps()?;
        steps.retain(|&s| s <= step);
        for &old in steps.iter().rev().skip(KEPT) {
            atomic::remove(&self.path(old))?;
        }
        Ok(())
    }

    /// The newest checkpoint that is whole; `None` when there is none at all.
    ///
    /// # Errors
    /// `Input` when it belongs to another case, or when none of those there can be read.
    pub fn latest(&self) -> Result<Option<Loaded>> {
        let mut warnings = Vec::new();
        for step in self.steps()?.into_iter().rev() {
            let path = self.path(step);
            match Store::read(&path, KIND, AGAIN).and_then(|mut store| {
                let fingerprint = store.take::<u64>("checkpoint.fingerprint", 1)?;
                Ok((store, fingerprint))
            }) {
                Ok((_, fingerprint)) if fingerprint != [self.fingerprint.0] => {
                    return Err(Error::input(
                        path.display(),
                        "this checkpoint belongs to another case, mesh or set of points, or was made by another build of mpm",
                        "undo the change, or start the analysis afresh, without --resume",
                    ));
                }
                Ok((store, _)) => return Ok(Some(Loaded { step, store, warnings })),
                Err(e) => warnings.push(format!("{}: {}", e.place, e.problem)),
            }
        }
        if warnings.is_empty() {
            return Ok(None);
        }
        Err(Error::input(self.folder.display(), format!("no checkpoint can be read: {}", warnings.join("; ")), AGAIN))
    }

    /// Whether the run can be continued: its newest whole checkpoint belongs to this case.
    pub fn can_resume(&self) -> bool {
        matches!(self.latest(), Ok(Some(_)))
    }

    /// Whether there is any checkpoint in a folder.
    ///
    /// # Errors
    /// `Machine` when it cannot be read.
    pub fn exist(folder: &Path) -> Result<bool> {
        Ok(!Self::new(folder, Fingerprint::default()).steps()?.is_empty())
    }

    /// Removes every checkpoint, at the start of a fresh run.
    ///
    /// # Errors
    /// `Machine` when one cannot be removed.
    pub fn clear(&self) -> Result<()> {
        self.steps()?.into_iter().try_for_each(|step| atomic::remove(&self.path(step)))
    }

    fn path(&self, step: u64) -> PathBuf {
        self.folder.join(format!("{}{step:09}{}", NAME[0], NAME[1]))
    }

    /// The steps that have a checkpoint, in order.
    fn steps(&self) -> Result<Vec<u64>> {
        match atomic::numbered(&self.folder, NAME[0], NAME[1]) {
            Err(e) if e.kind() == std::io::ErrorKind::NotFound => Ok(Vec::new()),
            steps => steps.map_err(|e| atomic::unreadable(&self.folder, &e, AGAIN)),
        }
    }
}

#[cfg(test)]
pub(super) mod tests;
