//! The case: from `case.yaml` to a checked [`Case`], and every mistake on the way in one go.
//!
//! [`source`] reads the text and applies the overrides of the command line, [`structure`] checks its shape
//! against the schema of [`raw`], [`check`] resolves that into [`checked`] types, [`names`] holds the result
//! against the groups of the mesh.

pub mod check;
pub mod checked;
pub mod locate;
mod materials;
pub mod names;
pub mod raw;
pub mod source;
pub mod structure;

pub use checked::Case;

use crate::error::Error;
use source::{Issue, Source};
use std::path::Path;

/// A case together with the text it is from.
#[derive(Clone, Debug)]
pub struct Loaded {
    pub source: Source,
    pub case: Case,
}

/// Reads and checks a `case.yaml`, or the one in a folder, with overrides `PATH=VALUE`.
///
/// # Errors
/// Every mistake that shows without the mesh, in the order of the file.
pub fn load(file: &Path, overrides: &[String]) -> Result<Loaded, Vec<Error>> {
    let source = Source::read(file, overrides).map_err(|e| vec![e])?;
    let case = resolve(&source).map_err(|issues| errors(&source, issues))?;
    Ok(Loaded { source, case })
}

impl Loaded {
    /// Holds the names in the case against the groups of its mesh.
    ///
    /// # Errors
    /// Every name that the mesh lacks, and every surface that the case leaves out.
    pub fn check_names(&self, groups: &names::Groups) -> Result<(), Vec<Error>> {
        let issues = names::check(&self.case, groups);
        if issues.is_empty() { Ok(()) } else { Err(errors(&self.source, issues)) }
    }
}

/// The JSON schema of `case.yaml`.
pub fn schema() -> serde_json::Value {
    schemars::schema_for!(raw::CaseFile).into()
}

fn resolve(source: &Source) -> Result<Case, Vec<Issue>> {
    let issues = structure::check(&schema(), source.tree());
    if !issues.is_empty() {
        return Err(issues);
    }
    let file = serde_path_to_error::deserialize(source.tree()).map_err(|e| {
        let steps = e.path().iter().filter_map(|segment| match segment {
            serde_path_to_error::Segment::Seq { index } => Some(locate::Step::Index(*index)),
            serde_path_to_error::Segment::Map { key } => Some(locate::Step::Key(key.clone())),
            _ => None,
        });
        let path = locate::Path(steps.collect());
        let remedy = "compare with `mpm schema`".to_owned();
        vec![Issue { path, at: locate::At::Value, problem: e.inner().to_string(), remedy }]
    })?;
    check::check(&file, source.folder())
}

/// The errors of mistakes, in the order of the file.
fn errors(source: &Source, issues: Vec<Issue>) -> Vec<Error> {
    let mut errors: Vec<_> = issues.iter().map(|issue| (source.place(issue), source.error(issue))).collect();
    errors.sort_by_key(|(place, _)| *place);
    errors.into_iter().map(|(_, error)| error).collect()
}
