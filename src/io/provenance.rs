//! What the files of an output folder were made from: a record a stage in `provenance/<stage>.json`, and a short origin
//! within frames, checkpoints and `points.vtu`.
//!
//! A record names the program, the hash of everything that the result depends on, the input files, the command lines with
//! their times, and the hash of every output file. It serves `mpm info`, and as the stamp by which `mpm run` skips a stage.
//! What stands within the files themselves has no times and no command lines: the same inputs give the same bytes.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use super::atomic;
use super::checkpoint::Fingerprint;
use super::hash;
use crate::error::{Error, Result};
use crate::program;
use crate::reading;

/// The folder of the records within an output folder.
pub const FOLDER: &str = "provenance";

/// What a run was made from, for its frames.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Origin {
    /// Everything that the results depend on.
    pub run: Fingerprint,
    /// Hash of `mesh.msh`.
    pub mesh: u64,
}

/// The program that made a file.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Program {
    pub version: String,
    pub commit: String,
    /// Hash of the sources.
    pub sources: String,
    /// Target and profile.
    pub build: String,
    pub gmsh: String,
}

impl Program {
    /// This one.
    pub fn this() -> Self {
        let [version, commit, sources, build, gmsh] =
            [program::VERSION, program::COMMIT, program::SOURCE, program::BUILD, program::GMSH].map(str::to_owned);
        Self { version, commit, sources, build, gmsh }
    }
}

/// A process that worked on the stage; a run that was continued has several.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Session {
    pub command: Vec<String>,
    /// Times in UTC, RFC 3339.
    pub started: String,
    /// Absent where the process was killed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ended: Option<String>,
    /// Why it ended before the stage was finished.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reason: Option<String>,
}

/// The record of a stage.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Record {
    pub stage: String,
    pub finished: bool,
    pub program: Program,
    /// Hash of everything that the result depends on: the program, entries of the case, files.
    pub inputs: String,
    /// The input files with their hashes.
    pub files: BTreeMap<String, String>,
    pub sessions: Vec<Session>,
    /// The output files with their hashes, names relative to the folder of the run; complete once it is finished.
    pub outputs: BTreeMap<String, String>,
}

impl Record {
    /// The record of a stage that begins now, by this process.
    pub fn begin(stage: &str, inputs: u64, files: BTreeMap<String, String>) -> Self {
        let mut record = Self {
            stage: stage.to_owned(),
            finished: false,
            program: Program::this(),
            inputs: hash::text(inputs),
            files,
            sessions: Vec::new(),
            outputs: BTreeMap::new(),
        };
        record.go_on();
        record
    }

    /// A session of this process on a stage that an earlier one began; it is not finished until then.
    pub fn go_on(&mut self) {
        self.finished = false;
        let command = std::env::args_os().map(|word| word.to_string_lossy().into_owned()).collect();
        self.sessions.push(Session { command, started: now(), ended: None, reason: None });
    }

    /// Ends the session before the stage is finished.
    pub fn interrupt(&mut self, reason: &str) {
        if let Some(session) = self.sessions.last_mut() {
            (session.ended, session.reason) = (Some(now()), Some(reason.to_owned()));
        }
    }

    /// Ends the stage, with its outputs in `folder`.
    ///
    /// # Errors
    /// `Machine` when an output cannot be read.
    pub fn finish(&mut self, folder: &Path, outputs: &[PathBuf]) -> Result<()> {
        self.outputs = hashes(folder, outputs)?;
        self.finished = true;
        if let Some(session) = self.sessions.last_mut() {
            session.ended = Some(now());
        }
        Ok(())
    }

    /// Whether the stage was finished with the same inputs and its `outputs` in `folder` are those it left.
    pub fn is_current(&self, inputs: u64, folder: &Path, outputs: &[PathBuf]) -> bool {
        self.finished
            && self.inputs == hash::text(inputs)
            && hashes(folder, outputs).is_ok_and(|outputs| outputs == self.outputs)
    }

    /// The first of the `outputs` in `folder` that is missing, new or another than the stage left, if it is finished.
    ///
    /// # Errors
    /// `Machine` when one cannot be read.
    pub fn changed(&self, folder: &Path, outputs: &[PathBuf]) -> Result<Option<String>> {
        if !self.finished {
            return Ok(None);
        }
        let there = hashes(folder, outputs)?;
        let names = self.outputs.keys().chain(there.keys());
        Ok(names.into_iter().find(|&name| there.get(name) != self.outputs.get(name)).cloned())
    }

    /// Writes the record of its stage in `folder`.
    ///
    /// # Errors
    /// `Machine` when it cannot be written.
    pub fn write(&self, folder: &Path) -> Result<()> {
        let path = path(folder, &self.stage);
        atomic::prepare_folder(&folder.join(FOLDER))?;
        let text = serde_json::to_string_pretty(self)
            .map_err(|e| Error::analysis(path.display(), e, "report this as a mistake of mpm"))?;
        atomic::write(&path, |out| writeln!(out, "{text}"))
    }

    /// Does what writes the files of its stage. Where the stage has no record yet, this one is written before, so that files which a kill leaves count
    /// as the program's own, and removed if that fails.
    ///
    /// # Errors
    /// As [`Record::write`], and those of `work`.
    pub fn around<T>(&self, folder: &Path, work: impl FnOnce() -> Result<T>) -> Result<T> {
        let path = path(folder, &self.stage);
        let is_first = !path.exists();
        if is_first {
            self.write(folder)?;
        }
        work().inspect_err(|_| {
            if is_first {
                // What cannot be removed is harmless.
                let _ = fs::remove_file(&path);
                let _ = fs::remove_dir(folder.join(FOLDER));
            }
        })
    }

    /// The record of a stage in `folder`; one that is missing or damaged counts for none.
    pub fn read(folder: &Path, stage: &str) -> Option<Self> {
        serde_json::from_slice(&reading::bytes(&path(folder, stage)).ok()?).ok()
    }
}

/// The file of the record of a stage.
pub fn path(folder: &Path, stage: &str) -> PathBuf {
    folder.join(FOLDER).join(format!("{stage}.json"))
}

/// Refuses to replace `files` that are there where `stage` has left no record in `folder`: they are somebody else's.
///
/// # Errors
/// `Input` naming the first of them.
pub fn refuse_others(folder: &Path, stage: &str, files: impl IntoIterator<Item = PathBuf>) -> Result<()> {
    if path(folder, stage).is_file() {
        return Ok(());
    }
    let there = |file: &PathBuf| file.symlink_metadata().is_ok();
    files.into_iter().find(there).map_or(Ok(()), |file| {
        let problem = format!("it is there already, and not by `mpm {stage}`, which would replace it");
        Err(Error::input(file.display(), problem, "move it away, or choose another folder with -o"))
    })
}

/// The hashes of files by their names relative to `folder`.
fn hashes(folder: &Path, files: &[PathBuf]) -> Result<BTreeMap<String, String>> {
    let hashes = hash::files(files, "run the stage that writes it")?;
    let name = |path: &PathBuf| path.strip_prefix(folder).unwrap_or(path).display().to_string();
    Ok(files.iter().zip(hashes).map(|(path, hash)| (name(path), hash::text(hash))).collect())
}

/// The time in UTC, RFC 3339.
pub fn now() -> String {
    rfc3339(SystemTime::now())
}

/// RFC 3339 has years of four digits; a clock may be set to none of them, or to before 1970.
fn rfc3339(time: SystemTime) -> String {
    const LAST: u64 = 253_402_300_799;
    match time.duration_since(UNIX_EPOCH) {
        Ok(since) if since.as_secs() <= LAST => humantime::format_rfc3339_seconds(time).to_string(),
        Ok(_) => "after the year 9999, by the clock".to_owned(),
        Err(_) => "before the year 1970, by the clock".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    #[test]
    fn any_clock_has_a_text() {
        let at = |seconds: u64| rfc3339(UNIX_EPOCH + Duration::from_secs(seconds));
        assert_eq!(at(0), "1970-01-01T00:00:00Z");
        assert_eq!(at(253_402_300_799), "9999-12-31T23:59:59Z");
        assert_eq!(at(253_402_300_800), "after the year 9999, by the clock");
        assert_eq!(rfc3339(UNIX_EPOCH - Duration::from_secs(1)), "before the year 1970, by the clock");
    }
}
