//! The folder of a run, and how a new run takes the place of an earlier one.
//!
//! An output folder holds the results of one run. A run that starts where there are results already writes into the folder
//! `unfinished` beside them, and takes their place when it is finished, or where they are unfinished too and it has
//! converged at least one step. Until then they stay as they are.
//!
//! The folder may be anybody's, and somebody may keep notes beside results. Only files with the names of a run are removed or replaced;
//! `history.csv`, `energy.csv` and `solve.log` are names that others give, too: they are those of a run where its record is, which is written before
//! them and removed after them.
//!
//! The exchange is a few renames. A marker is written before the first and removed after the last one: an exchange that a
//! kill interrupts is completed by the next process.

use std::path::{Path, PathBuf};

use super::checkpoint::{self, Checkpoints};
use super::provenance::{self, Record};
use super::{atomic, export, frame, phase_state};
use crate::error::Result;

/// The name of the stage that writes runs, in its record.
pub const STAGE: &str = "solve";
/// The folder of a run beside earlier results.
pub const BESIDE: &str = "unfinished";
/// The marker of an exchange, and where the earlier results go meanwhile.
const MARKER: &str = ".exchange";
const REPLACED: &str = ".replaced";
/// Whether a name is one of those that a run gives.
type IsName = fn(&str) -> bool;
/// What a run consists of: its folders, with the names of what it has in them, and files.
const FOLDERS: [(&str, IsName); 3] =
    [("results", frame::is_name), ("checkpoints", checkpoint::is_name), (phase_state::FOLDER, phase_state::is_name)];
const FILES: [&str; 3] = ["history.csv", ENERGY, "solve.log"];
/// The balance of energy.
const ENERGY: &str = "energy.csv";

/// The folder that a run writes into.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RunFolder {
    path: PathBuf,
}

/// How far the run in a folder has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Standing {
    /// No step has converged: there is nothing to lose.
    Nothing,
    Unfinished,
    Finished,
}

impl RunFolder {
    pub fn new(path: impl Into<PathBuf>) -> Self {
        Self { path: path.into() }
    }

    pub fn path(&self) -> &Path {
        &self.path
    }

    pub fn results(&self) -> PathBuf {
        self.path.join("results")
    }

    pub fn checkpoints(&self) -> PathBuf {
        self.path.join("checkpoints")
    }

    /// The states at the ends of its phases.
    pub fn phases(&self) -> PathBuf {
        self.path.join(phase_state::FOLDER)
    }

    pub fn history(&self) -> PathBuf {
        self.path.join("history.csv")
    }

    /// The balance of energy.
    pub fn energy(&self) -> PathBuf {
        self.path.join(ENERGY)
    }

    pub fn log(&self) -> PathBuf {
        self.path.join("solve.log")
    }

    /// The record of the run.
    pub fn record(&self) -> Option<Record> {
        Record::read(&self.path, STAGE)
    }

    /// How far the run has come. Results count also where somebody has removed the checkpoints.
    ///
    /// # Errors
    /// `Machine` when the folder cannot be read.
    pub fn standing(&self) -> Result<Standing> {
        if self.has_frames() && self.record().is_some_and(|record| record.finished) {
            return Ok(Standing::Finished);
        }
        // The first frame is of the initial state.
        let converged = self.has_checkpoints()? || frame::path(&self.results(), 1).exists();
        Ok(if converged { Standing::Unfinished } else { Standing::Nothing })
    }

    /// Whether there is a checkpoint to continue from.
    ///
    /// # Errors
    /// `Machine` when the folder cannot be read.
    pub fn has_checkpoints(&self) -> Result<bool> {
        Checkpoints::exist(&self.checkpoints())
    }

    /// Whether there is at least one frame to show.
    pub fn has_frames(&self) -> bool {
        frame::path(&self.results(), 0).exists()
    }

    /// The files of a run that is finished: frames, history, energies and log.
    ///
    /// # Errors
    /// `Machine` when the folder cannot be read.
    pub fn outputs(&self) -> Result<Vec<PathBuf>> {
        let mut files = frame::paths(&self.results())?;
        files.extend([self.history(), self.energy(), self.log()].into_iter().filter(|path| path.exists()));
        Ok(files)
    }

    /// The first of these that is not as the run left it, if it is finished.
    ///
    /// # Errors
    /// `Machine` when one cannot be read.
    pub fn changed(&self) -> Result<Option<PathBuf>> {
        let Some(record) = self.record() else { return Ok(None) };
        Ok(record.changed(&self.path, &self.outputs()?)?.map(|name| self.path.join(name)))
    }

    /// Refuses links in place of what is written in place or emptied.
    fn refuse_links(&self) -> Result<()> {
        atomic::refuse_link(&self.path)?;
        parts().chain([provenance::FOLDER]).try_for_each(|part| atomic::refuse_link(&self.path.join(part)))
    }

    /// Removes what the run has written.
    fn remove(&self) -> Result<()> {
        for (name, is_own) in FOLDERS {
            atomic::clear_folder(&self.path.join(name), is_own)?;
        }
        FILES.iter().try_for_each(|name| atomic::remove(&self.path.join(name)))?;
        atomic::remove(&provenance::path(&self.path, STAGE))
    }
}

/// The runs of an output folder: its results, and the run beside them.
#[derive(Clone, Debug)]
pub struct Runs {
    pub main: RunFolder,
    pub beside: RunFolder,
}

impl Runs {
    /// The runs in an output folder, as they are.
    pub fn of(folder: &Path) -> Self {
        Self { main: RunFolder::new(folder), beside: RunFolder::new(folder.join(BESIDE)) }
    }

    /// Completes an exchange that was interrupted, and refuses links. The caller holds the lock of the folder.
    ///
    /// # Errors
    /// `Input` for a link in place of a file or folder of a run, `Machine` when something cannot be renamed or removed.
    pub fn prepare(&self) -> Result<()> {
        for run in [&self.main, &self.beside, &self.replaced()] {
            run.refuse_links()?;
        }
        if self.marker().exists() { self.exchange() } else { self.discard_replaced() }
    }

    /// The folder of the run that was not finished, if there is one with a converged step.
    ///
    /// # Errors
    /// `Machine` when a folder cannot be read.
    pub fn unfinished(&self) -> Result<Option<&RunFolder>> {
        for run in [&self.beside, &self.main] {
            if run.standing()? == Standing::Unfinished {
                return Ok(Some(run));
            }
        }
        Ok(None)
    }

    /// The run whose history is shown: that in the main folder, or where there is none, or `unfinished` is asked for, the one beside.
    pub fn with_history(&self, unfinished: bool) -> Option<RunFolder> {
        let candidates = if unfinished { [&self.beside, &self.main] } else { [&self.main, &self.beside] };
        candidates.into_iter().find(|run| run.history().is_file()).cloned()
    }

    /// A folder without a run for a new one: beside the results, where there are any.
    ///
    /// # Errors
    /// `Input` for a file of others that the new run would replace; `Machine` when what is left of another run cannot be removed.
    pub fn start(&self) -> Result<&RunFolder> {
        for run in [&self.main, &self.beside] {
            provenance::refuse_others(&run.path, STAGE, FILES.map(|name| run.path.join(name)))?;
        }
        if self.main.standing()? == Standing::Nothing {
            self.main.remove()?;
            return Ok(&self.main);
        }
        self.discard_beside()?;
        atomic::prepare_folder(&self.beside.path)?;
        Ok(&self.beside)
    }

    /// Puts a run that ended into its place: whether it is in the main folder then.
    ///
    /// # Errors
    /// `Machine` when something cannot be renamed or removed.
    pub fn settle(&self, run: &RunFolder) -> Result<bool> {
        if *run == self.main {
            return Ok(true);
        }
        let (new, old) = (run.standing()?, self.main.standing()?);
        let better = match new {
            Standing::Finished => true,
            Standing::Unfinished => old != Standing::Finished,
            Standing::Nothing => false,
        };
        if better {
            atomic::write_durable(&self.marker(), |out| {
                out.write_all(b"unfinished/ takes the place of the results\n")
            })?;
            self.exchange()?;
        }
        Ok(better)
    }

    /// Moves every part of the run beside to the main folder, as far as that has not been done yet.
    fn exchange(&self) -> Result<()> {
        parts().try_for_each(|part| self.exchange_part(part))?;
        // The record goes last: with it the results are finished.
        self.exchange_part(&format!("{}/{STAGE}.json", provenance::FOLDER))?;
        self.discard_beside()?;
        atomic::remove(&self.marker())?;
        self.discard_replaced()
    }

    fn exchange_part(&self, part: &str) -> Result<()> {
        let [new, old, aside] = [&self.beside, &self.main, &self.replaced()].map(|run| run.path.join(part));
        if !new.exists() {
            return Ok(());
        }
        for path in [&old, &aside] {
            if let Some(folder) = path.parent() {
                atomic::prepare_folder(folder)?;
            }
        }
        if old.exists() {
            atomic::rename(&old, &aside)?;
        }
        atomic::rename(&new, &old)
    }

    fn marker(&self) -> PathBuf {
        self.main.path.join(MARKER)
    }

    fn replaced(&self) -> RunFolder {
        RunFolder::new(self.main.path.join(REPLACED))
    }

    /// Removes the run beside the results, with what was exported of it.
    fn discard_beside(&self) -> Result<()> {
        let folder = &self.beside.path;
        export::remove(folder)?;
        self.beside.remove()?;
        atomic::remove_empty(&folder.join(provenance::FOLDER))?;
        atomic::remove_empty(folder)
    }

    /// Removes the run that another one took the place of, once what others keep in its folders is back there.
    fn discard_replaced(&self) -> Result<()> {
        let replaced = self.replaced();
        for (name, is_own) in FOLDERS {
            atomic::move_others(&replaced.path.join(name), &self.main.path.join(name), is_own)?;
        }
        replaced.remove()?;
        atomic::remove_empty(&replaced.path.join(provenance::FOLDER))?;
        atomic::remove_empty(&replaced.path)
    }
}

/// The folders and files of a run, without its record.
fn parts() -> impl Iterator<Item = &'static str> {
    FOLDERS.map(|(name, _)| name).into_iter().chain(FILES)
}

#[cfg(test)]
mod tests;
