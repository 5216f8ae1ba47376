//! What the stages share: the output folder with its lock, the names of its files, and what a result depends on.
//!
//! A stage is current when its record (`io::provenance`) was made from the same inputs, by the same program, and its outputs
//! are as it left them: `mpm run` skips it then.

use super::args::{CaseArgs, StageArgs};
use super::print::note;
use crate::case::raw::Product;
use crate::case::{self, Loaded};
use crate::error::{Error, Result};
use crate::io::checkpoint::Fingerprint;
use crate::io::lock::Lock;
use crate::io::provenance::Record;
use crate::io::run_folder::Runs;
use crate::io::{atomic, hash};
use crate::program;
use serde_json::Value;
use std::cell::OnceCell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// The file of the points as seeded.
pub const POINTS: &str = "points.vtu";

/// A loaded case and its output folder.
pub struct Stage {
    pub loaded: Loaded,
    folder: PathBuf,
    lock: OnceCell<Lock>,
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
        loaded.source.notes().iter().for_each(|text| note(text));
        let folder = args.output.clone().unwrap_or_else(|| loaded.source.folder().join("out"));
        // A slash at its end would lead through a link.
        let folder: PathBuf = folder.components().collect();
        if loaded.source.start().is_some_and(|start| is_of_run(&start.path, &folder)) {
            let problem = "the output folder is that of the run that the case goes on from, which would be lost";
            return Err(vec![Error::input(folder.display(), problem, "name another one with `-o`")]);
        }
        Ok(Self { loaded, folder, lock: OnceCell::new() })
    }

    /// Takes the lock of the output folder if there is one, and puts it in order; once it is there, before anything in it is
    /// read.
    ///
    /// # Errors
    /// `Machine` naming the process that works there; `Input` for links in it; what [`Runs::prepare`] gives.
    pub fn lock(&self) -> Result<()> {
        atomic::refuse_link(&self.folder)?;
        if self.lock.get().is_some() || !self.folder.is_dir() {
            return Ok(());
        }
        // Nobody else can have set it: it is not shared between threads.
        let _ = self.lock.set(Lock::take(&self.folder)?);
        self.runs().prepare()
    }

    /// Makes the output folder, locks it, and clears it of what killed processes left half-written.
    ///
    /// # Errors
    /// `Machine` when it cannot be made, and as [`Stage::lock`].
    pub fn prepare(&self) -> Result<()> {
        atomic::refuse_link(&self.folder)?;
        atomic::prepare_folder(&self.folder)?;
        self.lock()
    }

    /// The runs in the output folder.
    pub fn runs(&self) -> Runs {
        Runs::of(&self.folder)
    }

    pub fn mesh(&self) -> PathBuf {
        self.folder.join("mesh.msh")
    }

    pub fn points(&self) -> PathBuf {
        self.folder.join(POINTS)
    }

    /// The output folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The hash of the entries of the case that shape a product.
    pub fn hash_of(&self, product: Product) -> u64 {
        hash::bytes(Value::Object(self.loaded.shaping(product)).to_string().as_bytes())
    }

    /// A hash of the program, of the entries of the case that shape its results without the step control of the phases and of Newton's
    /// method, and of `files`: what must be the same for a run to continue.
    ///
    /// # Errors
    /// `Input` when a file is missing, `Machine` when it cannot be read.
    pub fn fingerprint(&self, files: &[PathBuf]) -> Result<Fingerprint> {
        let mut read = self.loaded.shaping(Product::Results);
        for phase in read.get_mut("phases").and_then(Value::as_array_mut).into_iter().flatten() {
            phase.as_object_mut().map(|phase| phase.remove("step"));
        }
        read.get_mut("numerics").and_then(Value::as_object_mut).map(|numerics| numerics.remove("max_iterations"));
        let files: Vec<u8> = hash::files(files, MISSING)?.into_iter().flat_map(u64::to_le_bytes).collect();
        Ok(Fingerprint::of(&[program::SOURCE.as_bytes(), Value::Object(read).to_string().as_bytes(), &files]))
    }

    /// What the stage `name` depends on, which makes a product of the case and of `files`.
    ///
    /// # Errors
    /// `Input` when a file is missing, `Machine` when it cannot be read.
    pub fn inputs(&self, name: &'static str, product: Product, files: &[PathBuf]) -> Result<Inputs> {
        let hashes: Vec<String> = hash::files(files, MISSING)?.into_iter().map(hash::text).collect();
        let case = Value::Object(self.loaded.shaping(product)).to_string();
        let all = [program::SOURCE, program::GMSH, &case, &hashes.join(" ")].join("\n");
        let files = files.iter().map(|path| path.display().to_string()).zip(hashes).collect();
        Ok(Inputs { stage: name, hash: hash::bytes(all.as_bytes()), files })
    }
}

/// Whether the state at the end of a phase is that of a run in an output folder.
fn is_of_run(state: &Path, folder: &Path) -> bool {
    match (state.canonicalize(), folder.canonicalize()) {
        // In the folder of such states in that of the run.
        (Ok(state), Ok(folder)) => state.ancestors().nth(2) == Some(&folder),
        _ => false,
    }
}

const MISSING: &str = "run the stage that writes it, or `mpm run` for all";

/// What the result of a stage depends on.
pub struct Inputs {
    stage: &'static str,
    hash: u64,
    files: BTreeMap<String, String>,
}

impl Inputs {
    /// Whether the stage was finished with these inputs in `folder`, and its `outputs` are as it left them.
    pub fn are_current(&self, folder: &Path, outputs: &[PathBuf]) -> bool {
        Record::read(folder, self.stage).is_some_and(|record| record.is_current(self.hash, folder, outputs))
    }

    /// The record of the stage, which begins now.
    pub fn begin(&self) -> Record {
        Record::begin(self.stage, self.hash, self.files.clone())
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
