//! `mpm info`: what a file was made from, or the files of an output folder.

use super::print::{Outcome, print};
use crate::error::{Error, Result};
use crate::io::provenance::{Program, Record};
use crate::io::run_folder::{BESIDE, STAGE};
use crate::io::{atomic, container, hash, phase_state, points_vtu};
use crate::reading;
use std::fmt::Write;
use std::fs;
use std::io::Read;
use std::path::{Path, PathBuf};

#[derive(clap::Args, Clone)]
pub struct Args {
    /// A file that mpm has written, a folder of such files, or that of a case
    path: PathBuf,
}

const STAGES: [&str; 4] = ["mesh", "seed", STAGE, "export"];

pub fn run(args: &Args) -> Outcome {
    let path = &args.path;
    let found = fs::metadata(path).map_err(|e| atomic::unreadable(path, &e, "name a file or a folder"))?;
    let text = if found.is_dir() { of_folder(path)? } else { of_file(path)? };
    print(&text)
}

/// The records of an output folder, or of the folder `out` in that of a case.
fn of_folder(folder: &Path) -> Result<String> {
    let mut text = String::new();
    for output in [folder.to_owned(), folder.join("out")] {
        for run in [output.clone(), output.join(BESIDE)] {
            for record in STAGES.iter().filter_map(|stage| Record::read(&run, stage)) {
                let _ = writeln!(text, "{}", run.display());
                text.push_str(&describe(&record));
            }
        }
        if !text.is_empty() {
            return Ok(text);
        }
    }
    Err(Error::input(folder.display(), "mpm has written nothing here that tells of itself", "name an output folder"))
}

/// What a file says of itself, and what the record of the stage that wrote it says of it.
fn of_file(path: &Path) -> Result<String> {
    let within = within(path)?;
    let recorded = recorded(path)?;
    if within.is_empty() && recorded.is_none() {
        let problem = "it was not written by mpm, or has been moved away from its output folder";
        return Err(Error::input(path.display(), problem, "name a file in an output folder"));
    }
    let mut text = format!("{}\n", path.display());
    for (name, value) in &within {
        let _ = writeln!(text, "  {name:<10} {value}");
    }
    if let Some((record, name)) = recorded {
        let now = hash::text(hash::file(path, "name a file")?);
        let state = match record.outputs.get(&name) {
            Some(then) if *then == now => "as the stage left it",
            Some(_) => "changed since the stage wrote it",
            None => "of a stage that is not finished",
        };
        let _ = writeln!(text, "  {:<10} {now} ({state})", "hash");
        text.push_str(&describe(&record));
    }
    Ok(text)
}

/// What stands in the file: names and values.
fn within(path: &Path) -> Result<Vec<(String, String)>> {
    let unreadable = |e| atomic::unreadable(path, &e, "name a file");
    let pair = |name: &str, value: &str| (name.to_owned(), value.to_owned());
    let mut head = Vec::new();
    reading::open(path).and_then(|file| file.take(1024).read_to_end(&mut head)).map_err(unreadable)?;
    if let Some((kind, texts)) = container::inspect(path) {
        // What a state at the end of a phase has of its case is for the program.
        let texts = texts.iter().filter(|(name, _)| *name != phase_state::CASE).map(|(name, value)| pair(name, value));
        return Ok(std::iter::once(pair("kind", &kind)).chain(texts).collect());
    }
    if path.extension().is_some_and(|kind| kind == "vtu")
        && let Some((program, source)) = points_vtu::inspect(&reading::bytes(path).map_err(unreadable)?)
    {
        return Ok(vec![pair("program", &program), pair("mesh", &source.mesh), pair("case", &source.case)]);
    }
    // The comment of an exported file.
    let head = String::from_utf8_lossy(&head);
    let comment = head.lines().find_map(|line| line.strip_prefix("<!-- ")?.strip_suffix(" -->"));
    Ok(comment.map(|comment| pair("program", comment)).into_iter().collect())
}

/// The record that names the file as an output, from the folders around it, and the name it has there; for a run that is not
/// finished, which has no list yet, that of the run.
fn recorded(path: &Path) -> Result<Option<(Record, String)>> {
    let path = std::path::absolute(path).map_err(|e| atomic::unreadable(path, &e, "name a file"))?;
    for folder in path.ancestors().skip(1).take(3) {
        let name = path.strip_prefix(folder).unwrap_or(&path).display().to_string();
        for record in STAGES.iter().filter_map(|stage| Record::read(folder, stage)) {
            let of_run =
                ["results/", "history.csv", "energy.csv", "solve.log"].iter().any(|part| name.starts_with(part));
            if record.outputs.contains_key(&name) || !record.finished && record.stage == STAGE && of_run {
                return Ok(Some((record, name)));
            }
        }
    }
    Ok(None)
}

fn describe(record: &Record) -> String {
    let Record { stage, finished, program, inputs, files, sessions, outputs } = record;
    let Program { version, commit, sources, build, gmsh } = program;
    let mut text = String::new();
    let mut line = |name: &str, value: String| {
        let _ = writeln!(text, "  {name:<10} {value}");
    };
    line("stage", format!("{stage}, {}", if *finished { "finished" } else { "not finished" }));
    line("program", format!("mpm {version}, commit {commit}, sources {sources}"));
    line("build", format!("{build}, Gmsh {gmsh}"));
    line("inputs", inputs.clone());
    files.iter().for_each(|(name, hash)| line("", format!("{hash} {name}")));
    for session in sessions {
        line("command", session.command.join(" "));
        let ended = session.ended.as_deref().unwrap_or("not known");
        line("started", format!("{}, ended {ended}", session.started));
        if let Some(reason) = &session.reason {
            line("because", reason.clone());
        }
    }
    if !outputs.is_empty() {
        line("outputs", format!("{} files", outputs.len()));
    }
    text
}
