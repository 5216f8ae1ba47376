//! What the stages share: the output folder, the names of its files, and the stamps by which `mpm run` knows
//! that a stage need not run again.
//!
//! A stamp is a hash (XXH64) of everything that the result of a stage depends on: the program's version, the
//! entries of the case it reads and its input files. It is written when the stage has ended well.

use super::{CaseArgs, StageArgs, note};
use crate::case::{self, Loaded};
use crate::error::{Error, Result};
use crate::io::atomic;
use crate::io::checkpoint::Fingerprint;
use serde_json::{Map, Value};
use std::fs::{self, File};
use std::hash::Hasher;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use twox_hash::XxHash64;

/// A loaded case and its output folder.
pub struct Stage {
    pub loaded: Loaded,
    folder: PathBuf,
}

impl Stage {
    /// Loads the case; writes nothing.
    ///
    /// # Errors
    /// Every mistake of the case.
    pub fn open(args: &StageArgs) -> std::result::Result<Self, Vec<Error>> {
        let CaseArgs { case, overrides } = &args.case;
        use_threads(args.threads)?;
        let loaded = case::load(case, overrides)?;
        let folder = args.output.clone().unwrap_or_else(|| loaded.source.folder().join("out"));
        Ok(Self { loaded, folder })
    }

    /// Makes the output folder, and clears it of what killed processes left half-written.
    ///
    /// # Errors
    /// `Machine` when it cannot be made.
    pub fn prepare(&self) -> Result<()> {
        atomic::prepare_folder(&self.folder)
    }

    pub fn mesh(&self) -> PathBuf {
        self.folder.join("mesh.msh")
    }

    pub fn points(&self) -> PathBuf {
        self.folder.join("points.vtu")
    }

    pub fn history(&self) -> PathBuf {
        self.folder.join("history.csv")
    }

    pub fn results(&self) -> PathBuf {
        self.folder.join("results")
    }

    /// The output folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The entries `keys` of the case, as far as it has them.
    fn entries(&self, keys: &[&str]) -> Map<String, Value> {
        let tree = self.loaded.source.tree();
        keys.iter().filter_map(|&key| tree.get(key).map(|value| (key.to_owned(), value.clone()))).collect()
    }

    /// A hash of the entries `keys` of the case without the step control of the phases and of Newton's method,
    /// and of `files`: what must be the same for a run to continue.
    ///
    /// # Errors
    /// `Input` when a file is missing, `Machine` when it cannot be read.
    pub fn fingerprint(&self, keys: &[&str], files: &[PathBuf]) -> Result<Fingerprint> {
        let mut read = self.entries(keys);
        for phase in read.get_mut("phases").and_then(Value::as_array_mut).into_iter().flatten() {
            phase.as_object_mut().map(|phase| phase.remove("step"));
        }
        read.get_mut("numerics").and_then(Value::as_object_mut).map(|numerics| numerics.remove("max_iterations"));
        let files = hash_files(files, XxHash64::with_seed(0))?;
        let version = env!("CARGO_PKG_VERSION").as_bytes();
        Ok(Fingerprint::of(&[version, Value::Object(read).to_string().as_bytes(), &files.to_le_bytes()]))
    }

    /// The stamp of the stage `name`, which reads the entries `keys` of the case and `files`.
    ///
    /// # Errors
    /// `Input` when a file is missing, `Machine` when it cannot be read.
    pub fn stamp(&self, name: &str, keys: &[&str], files: &[PathBuf]) -> Result<Stamp> {
        let read = self.entries(keys);
        let mut hasher = XxHash64::with_seed(0);
        hasher.write(env!("CARGO_PKG_VERSION").as_bytes());
        hasher.write(Value::Object(read).to_string().as_bytes());
        let hash = format!("{:016x}", hash_files(files, hasher)?);
        Ok(Stamp { file: self.folder.join(format!(".stamp-{name}")), hash })
    }
}

/// Sets the number of threads of the process. The one at hand is one of them: were all work handed to others, steps of
/// milliseconds would spend most of their time waiting to be woken. More threads than cores only wait for each other.
fn use_threads(threads: Option<u16>) -> Result<()> {
    let cores = std::thread::available_parallelism().map_or(usize::MAX, usize::from);
    let wanted = threads.map_or(0, usize::from).min(cores);
    if let Some(threads) = threads.filter(|&threads| usize::from(threads) > cores) {
        note(&format!("note: --threads {threads} is more than the {cores} cores there are: {cores} are used"));
    }
    match (threads, rayon::ThreadPoolBuilder::new().num_threads(wanted).use_current_thread().build_global()) {
        (Some(threads), Err(e)) => {
            let problem = format!("{threads} threads cannot be started: {e}");
            Err(Error::machine("--threads", problem, "ask for fewer"))
        }
        // Where nothing was asked for, the threads that are there already will do.
        _ => Ok(()),
    }
}

/// What a stage's result depends on, as a hash.
pub struct Stamp {
    file: PathBuf,
    hash: String,
}

impl Stamp {
    /// Whether the stage ended well with the same inputs and its `results` are as it left them.
    pub fn is_current(&self, results: &[PathBuf]) -> bool {
        let left = fs::read_to_string(&self.file);
        left.is_ok_and(|left| self.text(results).is_ok_and(|now| now == left))
    }

    /// Takes the stamp away, before a stage that changes its results bit by bit.
    ///
    /// # Errors
    /// `Machine` when it cannot be removed.
    pub fn remove(&self) -> Result<()> {
        atomic::remove(&self.file)
    }

    /// Writes the stamp, when the stage has ended well.
    ///
    /// # Errors
    /// `Machine` when it cannot be written.
    pub fn write(&self, results: &[PathBuf]) -> Result<()> {
        let text = self.text(results)?;
        atomic::write(&self.file, |out| out.write_all(text.as_bytes()))
    }

    fn text(&self, results: &[PathBuf]) -> Result<String> {
        Ok(format!("inputs {}\nresults {:016x}\n", self.hash, hash_files(results, XxHash64::with_seed(0))?))
    }
}

fn hash_files(files: &[PathBuf], mut hasher: XxHash64) -> Result<u64> {
    for file in files {
        hash_file(file, &mut hasher).map_err(|e| atomic::unreadable(file, &e, "run the stage that writes it"))?;
    }
    Ok(hasher.finish())
}

fn hash_file(path: &Path, hasher: &mut XxHash64) -> io::Result<()> {
    let mut file = File::open(path)?;
    let mut block = vec![0; 1 << 16];
    let mut length = 0;
    loop {
        match file.read(&mut block)? {
            0 => break,
            n => {
                hasher.write(&block[..n]);
                length += n as u64;
            }
        }
    }
    // So that the end of one file and the beginning of the next are told apart.
    hasher.write(&length.to_le_bytes());
    Ok(())
}
