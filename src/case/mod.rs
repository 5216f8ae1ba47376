//! The case: from `case.yaml` to a checked [`Case`], and every mistake on the way in one go.
//!
//! [`source`] reads the text by way of `yaml` and applies the overrides of the command line, [`structure`] checks its shape
//! against the schema of [`raw`], `check` resolves that into [`checked`] types, [`names`] holds the result
//! against the groups of the mesh.

pub mod at_rest;
mod bars;
mod changes;
mod check;
pub mod checked;
mod contact_interfaces;
mod contacts;
mod controls;
mod curve_loads;
mod drained_surface;
mod drains;
mod earth_pressure;
mod equilibrium;
mod find;
mod histories;
mod incompressible;
mod inflow;
pub mod issue;
pub mod layout;
mod loads;
pub mod locate;
mod materials;
mod mesh;
pub mod names;
mod outflow;
mod outputs;
mod over_depth;
pub mod parts;
mod phases;
mod placed;
pub mod plates;
mod pores;
pub mod raw;
mod records;
mod removed;
mod rigid;
pub mod scene;
pub mod scheme;
mod search;
pub mod seeded;
pub mod seeding;
pub mod source;
mod springs;
mod staged;
pub mod start;
mod stops;
pub mod structure;
#[cfg(test)]
mod tests;
mod ties;
pub mod unconnected;
mod unlikely;
pub mod unmeant;
mod wall;
mod water;
mod weight;
mod yaml;

pub use checked::Case;

use crate::error::{self, Error};
use issue::Issue;
use locate::{At, Step};
use names::Groups;
use raw::Product;
use schemars::generate::SchemaSettings;
use serde_json::{Map, Value};
use serde_path_to_error::Segment;
use source::Source;
use std::collections::HashSet;
use std::path::Path;
use unconnected::Place;

/// A case together with the text it is from.
#[derive(Clone, Debug)]
pub struct Loaded {
    pub source: Source,
    pub case: Case,
}

/// What there is to say of a case without its mesh.
#[derive(Clone, Debug)]
pub struct Review {
    pub mistakes: Vec<Error>,
    /// Lines on what is no mistake.
    pub notes: Vec<String>,
    /// The case, where it has no mistakes.
    pub case: Option<Case>,
}

/// The JSON schema of `case.yaml`.
pub fn schema() -> Value {
    Value::from(SchemaSettings::default().into_generator().into_root_schema_for::<raw::CaseFile>())
}

/// Reads and checks a `case.yaml`, or the one in a folder, with overrides `PATH=VALUE`.
///
/// # Errors
/// Every mistake that shows without the mesh, in the order of the file.
pub fn load(file: &Path, overrides: &[String]) -> Result<Loaded, Vec<Error>> {
    let mut source = Source::read(file, overrides)?;
    source.go_on()?;
    resolved(source)
}

/// As [`load`], of a case whose text has been read.
///
/// # Errors
/// As [`load`].
pub fn resolved(source: Source) -> Result<Loaded, Vec<Error>> {
    match resolve(&source) {
        (Some(case), issues) if issues.is_empty() => Ok(Loaded { source, case }),
        (_, issues) => Err(errors(&source, &issues)),
    }
}

/// Every mistake in a case and, where it can be read at all, in its `.geo`; `groups` has the names of the mesh and where its regions
/// lie.
///
/// # Errors
/// What cannot be read at all.
pub fn review(
    file: &Path,
    overrides: &[String],
    groups: impl FnOnce(&Case) -> Result<(Groups, Vec<Place>), Vec<Error>>,
) -> error::Result<Review> {
    let mut source = Source::read(file, overrides)?;
    let begun = source.go_on();
    let (case, mut issues) = resolve(&source);
    let mut notes = source.notes().to_vec();
    let mesh = locate::Path::default().key("mesh");
    let sound = !issues.iter().any(|issue| mesh.contains(&issue.path));
    if let Some(case) = case.as_ref().filter(|_| sound) {
        match groups(case) {
            Ok((groups, places)) => {
                issues.extend(names::check(case, &groups));
                notes.extend(unconnected::structures(case, &places));
                notes.extend(unmeant::of_case(case, &places));
            }
            Err(e) => {
                let mut mistakes = errors(&source, &issues);
                mistakes.extend(e);
                return Ok(Review { mistakes, notes, case: None });
            }
        }
    }
    if let Err(mut mistakes) = begun {
        // What is said of its own phases alone may be wrong.
        let phases = locate::Path::default().key("phases");
        issues.retain(|issue| !phases.contains(&issue.path));
        mistakes.extend(errors(&source, &issues));
        return Ok(Review { mistakes, notes, case: None });
    }
    let mistakes = errors(&source, &issues);
    Ok(Review { case: case.filter(|_| mistakes.is_empty()), mistakes, notes })
}

/// The case if it can be read at all, and its mistakes; only without any is it a sound one.
fn resolve(source: &Source) -> (Option<Case>, Vec<Issue>) {
    let mut issues = source.faults().to_vec();
    let faulty: HashSet<&[Step]> = source.faults().iter().map(|fault| fault.path.0.as_slice()).collect();
    let left_out = |issue: &Issue| (0..=issue.path.0.len()).any(|end| faulty.contains(&issue.path.0[..end]));
    let mut shape = structure::check(&schema(), source.tree());
    shape.retain(|issue| !left_out(issue));
    issues.extend(shape);
    // With the unknown keys mended or left out the rest may be read all the same, and have more to say.
    let mut tree = source.tree().clone();
    issues.iter().filter(|issue| issue.unknown).for_each(|issue| mend(&mut tree, issue));
    match read(&tree) {
        Ok(file) => {
            let (case, more) = check::check(&file, source.folder());
            issues.extend(more);
            (Some(case), issues)
        }
        // The walk along the schema has mostly said already, and better, what cannot be read.
        Err(issue) => {
            if issues.is_empty() {
                issues.push(issue);
            }
            (None, issues)
        }
    }
}

/// What is written in `tree`.
///
/// # Errors
/// The first entry that does not fit.
fn read(tree: &Value) -> Result<raw::CaseFile, Issue> {
    serde_path_to_error::deserialize(tree).map_err(|e| {
        let steps = e.path().iter().filter_map(|segment| match segment {
            Segment::Seq { index } => Some(Step::Index(*index)),
            Segment::Map { key } => Some(Step::Key(key.clone())),
            _ => None,
        });
        let path = locate::Path(steps.collect());
        Issue::new(&path, At::Value, e.inner().to_string(), "compare with `mpm schema`")
    })
}

impl Loaded {
    /// Holds the names in the case against the groups of its mesh.
    ///
    /// # Errors
    /// Every name that the mesh lacks, and every surface that the case leaves out.
    pub fn check_names(&self, groups: &Groups) -> Result<(), Vec<Error>> {
        let issues = names::check(&self.case, groups);
        if issues.is_empty() { Ok(()) } else { Err(errors(&self.source, &issues)) }
    }

    /// The entries that shape a product of the stages themselves, as far as the case has them: when they change, it is stale.
    pub fn shaping(&self, product: Product) -> Map<String, Value> {
        let mut keys: Vec<&str> =
            raw::SHAPES.into_iter().filter(|(_, shapes)| shapes.contains(&product)).map(|(key, _)| key).collect();
        let comes = self.case.phases.iter().any(|phase| phase.coming().next().is_some());
        if product == Product::Points && (self.case.water.is_some() || comes) {
            // The soil begins under the water of the first phase, and without the weight of what comes later.
            keys.push("phases");
        }
        let tree = self.source.tree();
        keys.into_iter().filter_map(|key| Some((key.to_owned(), tree.get(key)?.clone()))).collect()
    }
}

/// Gives the entry of an unknown key the name that was meant, or takes it out of the tree.
fn mend(tree: &mut Value, issue: &Issue) {
    let Some((Step::Key(unknown), around)) = issue.path.0.split_last() else { return };
    let around = around.iter().try_fold(tree, |block, step| match step {
        Step::Key(key) => block.get_mut(key),
        Step::Index(index) => block.get_mut(index),
    });
    let Some(block) = around.and_then(Value::as_object_mut) else { return };
    if let (Some(value), Some(meant)) = (block.remove(unknown), &issue.meant) {
        block.entry(meant).or_insert(value);
    }
}

/// Mistakes that are told one by one.
const TOLD: usize = 50;

/// The errors of the first mistakes in the order of the file, and how many more there are.
fn errors(source: &Source, issues: &[Issue]) -> Vec<Error> {
    let mut placed: Vec<_> = issues.iter().map(|issue| (source.place(issue), issue)).collect();
    placed.sort_by_key(|(place, _)| *place);
    let mut errors: Vec<Error> = placed.iter().take(TOLD).map(|(_, issue)| source.error(issue)).collect();
    let more = issues.len().saturating_sub(TOLD);
    if more > 0 {
        let least = if issues.len() >= issue::MOST_FOUND { "at least " } else { "" };
        let problem = format!("there are {least}{more} more mistakes");
        errors.push(Error::input(source.file().display(), problem, "correct these first, and check again"));
    }
    errors
}
