//! The text of a case file as a tree, with the overrides of the command line, and the messages that point into it.

use super::issue::{Issue, describe};
use super::locate::{At, Path, Step};
use super::start::{self, Start};
use super::yaml::{self, Node};
use crate::error::{Error, plain, shown};
use crate::reading;
use serde_json::{Map, Value};
use std::io::Read;
use std::path::{Path as FilePath, PathBuf};
use std::sync::Arc;

/// A case file that is valid YAML.
#[derive(Clone, Debug)]
pub struct Source {
    file: PathBuf,
    text: String,
    /// The text as a tree with places.
    root: Arc<Node>,
    overrides: Vec<Override>,
    tree: Value,
    /// What the tree leaves out.
    faults: Vec<Issue>,
    /// Entries that the overrides change beyond those that they name, and lines on them for the user.
    lowered: Vec<Path>,
    notes: Vec<String>,
    /// The run that the case goes on from, whose phases are the first ones of the tree.
    start: Option<Start>,
}

/// An entry of the case set on the command line.
#[derive(Clone, Debug)]
struct Override {
    /// As given: `mesh.parameters.h=0.1`.
    argument: String,
    path: Path,
}

impl Source {
    /// Reads `case`, a `case.yaml` or the folder that holds one, and applies the overrides `PATH=VALUE`.
    ///
    /// # Errors
    /// A file that is missing, not text or not YAML, and overrides that fit nowhere: kind input.
    pub fn read(case: &FilePath, overrides: &[String]) -> Result<Self, Error> {
        let file = if case.is_dir() { case.join("case.yaml") } else { case.to_owned() };
        let mut bytes = Vec::new();
        let most = yaml::MOST_BYTES as u64 + 1;
        reading::open(&file).and_then(|f| f.take(most).read_to_end(&mut bytes)).map_err(|e| {
            let remedy = "name a case.yaml, or a folder that holds one";
            Error::input(file.display(), format!("cannot be read: {e}"), remedy)
        })?;
        if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
            return Err(Error::input(file.display(), "the text is in UTF-16", "save the file as UTF-8"));
        }
        if bytes.len() > yaml::MOST_BYTES {
            let problem = format!("the file has more than {} bytes", yaml::MOST_BYTES);
            let remedy = "name a case.yaml; if it is one, thin its tables out";
            return Err(Error::input(file.display(), problem, remedy));
        }
        let text = String::from_utf8(bytes).map_err(|e| {
            let line = e.as_bytes().iter().take(e.utf8_error().valid_up_to()).filter(|&&b| b == b'\n').count() + 1;
            let place = format!("{}:{line}", file.display());
            Error::input(place, "a byte that is not UTF-8 text", "save the file as UTF-8")
        })?;
        Self::parse(file, text, overrides)
    }

    /// As [`Source::read`] for a text at hand; `file` is for messages and as the root of relative paths. A byte
    /// order mark at the beginning is skipped.
    ///
    /// # Errors
    /// As [`Source::read`].
    pub fn parse(file: PathBuf, text: String, overrides: &[String]) -> Result<Self, Error> {
        let text = text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text);
        let root = yaml::parse(&text).map_err(|e| message(&file, &text, e.place, None, &e.problem, e.remedy))?;
        let mut faults = Vec::new();
        let tree = root.to_json(&mut faults);
        if tree.is_null() && faults.is_empty() {
            let remedy = "write a case: `mpm schema` describes it, the folder cases/ has examples";
            return Err(Error::input(file.display(), "the file is empty", remedy));
        }
        let (given, lowered, notes) = (Vec::new(), Vec::new(), Vec::new());
        let mut source = Self { file, text, root, overrides: given, tree, faults, lowered, notes, start: None };
        for argument in overrides {
            source.set(argument)?;
        }
        source.lower_first_steps();
        Ok(source)
    }

    /// Puts the phases of the run that the case goes on from before its own, if it does.
    ///
    /// # Errors
    /// Each entry that the state of that run does not go with; a run that has no such state: kind input.
    pub(super) fn go_on(&mut self) -> Result<(), Vec<Error>> {
        let folder = self.folder().to_owned();
        let start = start::compose(&mut self.tree, &folder)
            .map_err(|issues| issues.iter().map(|issue| self.error(issue)).collect::<Vec<_>>())?;
        if let Some(start) = &start {
            self.faults.iter_mut().for_each(|fault| start::to_whole(&mut fault.path, start.begun));
        }
        self.start = start;
        Ok(())
    }

    /// The run that the case goes on from.
    pub fn start(&self) -> Option<&Start> {
        self.start.as_ref()
    }

    /// A mistake at the place in the file: what is wrong with a phase of another run is told of `start_from`.
    fn in_file(&self, issue: &Issue) -> Issue {
        let Some(start) = &self.start else { return issue.clone() };
        match start::own(&issue.path, start.begun) {
            Some(path) => Issue { path, ..issue.clone() },
            None => {
                let problem = format!("{}: {}", issue.path, issue.problem);
                Issue::new(&Path::default().key(start::KEY), At::Key, problem, &issue.remedy)
            }
        }
    }

    /// Lowers the first step of each phase to the largest step, where the command line sets the largest below it and says nothing of
    /// the first.
    fn lower_first_steps(&mut self) {
        let phases = self.tree.get_mut("phases").and_then(Value::as_array_mut);
        for (i, phase) in phases.into_iter().flatten().enumerate() {
            let step = Path::default().key("phases").index(i).key("step");
            let (first, largest) = (step.key("initial"), step.key("max"));
            let is_set = |path: &Path| self.overrides.iter().any(|given| given.path.contains(path));
            if !is_set(&largest) || is_set(&first) {
                continue;
            }
            let Some(entries) = phase.get_mut("step").and_then(Value::as_object_mut) else { continue };
            let number = |key: &str| entries.get(key).and_then(Value::as_f64);
            let (Some(initial), Some(max)) = (number("initial"), number("max")) else { continue };
            // A largest step that is not positive is a mistake of its own.
            if 0.0 < max && max < initial {
                self.notes.push(format!(
                    "note: {first} is lowered from {initial} s to {max} s, the `max` given on the command line"
                ));
                entries.insert("initial".to_owned(), entries["max"].clone());
                self.lowered.push(first);
            }
        }
    }

    /// Sets the entry `PATH` of the tree to `VALUE` for an argument `PATH=VALUE`.
    fn set(&mut self, argument: &str) -> Result<(), Error> {
        let refuse =
            |problem: String, remedy: &str| Error::input(format!("--set {}", shown(argument)), problem, remedy);
        let example = "write it as --set mesh.parameters.h=0.1";
        let (target, text) = argument.split_once('=').ok_or_else(|| refuse("no `=`".into(), example))?;
        let value = yaml::parse(text).map_err(|e| {
            let column = e.place.map(|(_, column)| format!(" at character {column}")).unwrap_or_default();
            refuse(format!("the value is not YAML{column}: {}", e.problem), "put the value in quotes")
        })?;
        let mut faults = Vec::new();
        let value = value.to_json(&mut faults);
        if let Some(fault) = faults.pop() {
            return Err(refuse(fault.problem, &fault.remedy));
        }
        let mut path = Path::default();
        let mut entry = &mut self.tree;
        for name in target.replace('[', ".").replace(']', "").split('.') {
            if name.is_empty() {
                return Err(refuse("an empty name in the path".into(), example));
            }
            if path.0.len() >= yaml::MOST_LEVELS {
                return Err(refuse(format!("the path is longer than {} names", yaml::MOST_LEVELS), example));
            }
            if entry.is_null() {
                *entry = Value::Object(Map::new());
            }
            let around = if path.0.is_empty() { "the case".to_owned() } else { format!("`{path}`") };
            entry = match entry {
                Value::Object(map) => {
                    path = path.key(name);
                    map.entry(name).or_insert(Value::Null)
                }
                Value::Array(list) => {
                    let choice = match (list.is_empty(), name.parse::<usize>()) {
                        (false, Err(_)) => format!("{}; write {path}[0].{name} for the first", items(list)),
                        _ => items(list),
                    };
                    let index = position(list, name);
                    let item = index.and_then(|i| list.get_mut(i).map(|item| (i, item)));
                    let (index, item) =
                        item.ok_or_else(|| refuse(format!("{around} has no item `{name}`"), &choice))?;
                    path = path.index(index);
                    item
                }
                other => {
                    let problem = format!("{around} is {}, so it has no entry `{name}`", describe(other));
                    return Err(refuse(problem, "set the entry itself, or mend the path"));
                }
            };
        }
        *entry = value;
        self.overrides.push(Override { argument: argument.to_owned(), path });
        Ok(())
    }

    /// The text of the case with the overrides in it, and its comments.
    ///
    /// # Errors
    /// Input: an entry that cannot be changed in the text.
    pub fn rewritten(&self) -> Result<String, Error> {
        let remedy = "set entries below it, or change it in the file";
        let mut text = self.text.clone();
        let given = self.overrides.iter().map(|given| (&given.path, format!("--set {}", shown(&given.argument))));
        for (path, place) in given.chain(self.lowered.iter().map(|path| (path, path.to_string()))) {
            let value = value_at(&self.tree, path);
            let changed = value.ok_or_else(|| "another --set takes it away".to_owned());
            text = changed
                .and_then(|value| yaml::edit::set(&text, path, value))
                .map_err(|problem| Error::input(place, problem, remedy))?;
        }
        let read = yaml::parse(&text).map(|root| root.to_json(&mut Vec::new()));
        if read.as_ref() != Ok(&self.tree) {
            let problem = "the entries cannot be changed in its text";
            return Err(Error::input(self.file.display(), problem, "leave --set out, and change them in the file"));
        }
        Ok(text)
    }

    /// The case file.
    pub fn file(&self) -> &FilePath {
        &self.file
    }

    /// The folder of the case file, which paths in it are relative to.
    pub fn folder(&self) -> &FilePath {
        match self.file.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => FilePath::new("."),
        }
    }

    /// The whole case with its overrides, as one tree with sorted keys; the phases of a run that it goes on from come first.
    pub fn tree(&self) -> &Value {
        &self.tree
    }

    /// Numbers that are not finite, tags and keys that are not names: the tree does without them.
    pub fn faults(&self) -> &[Issue] {
        &self.faults
    }

    /// Lines for the user on what the overrides change beyond the entries that they name.
    pub fn notes(&self) -> &[String] {
        &self.notes
    }

    /// Line and column of a mistake, or of the nearest block around it that the file has.
    pub fn place(&self, issue: &Issue) -> Option<(usize, usize)> {
        self.place_in_file(&self.in_file(issue))
    }

    fn place_in_file(&self, issue: &Issue) -> Option<(usize, usize)> {
        let mut around = issue.path.clone();
        let mut place = self.root.locate(&around, issue.at);
        while place.is_none() && around.0.pop().is_some() {
            place = self.root.locate(&around, At::Key);
        }
        place
    }

    /// The error for a mistake: file, line and column, the line itself and a caret under the place.
    pub fn error(&self, issue: &Issue) -> Error {
        let issue = &self.in_file(issue);
        // An entry set on the command line, or a block that only the command line made.
        let given = self.overrides.iter().rev().find(|given| {
            let made = || issue.path.contains(&given.path) && self.root.locate(&issue.path, issue.at).is_none();
            given.path.contains(&issue.path) || made()
        });
        if let Some(given) = given {
            let place = format!("--set {} ({})", shown(&given.argument), issue.path);
            return Error::input(place, &issue.problem, &issue.remedy);
        }
        message(&self.file, &self.text, self.place_in_file(issue), Some(&issue.path), &issue.problem, &issue.remedy)
    }
}

/// The error for a mistake in `text` of `file`, with its line and a caret under the place.
fn message(
    file: &FilePath,
    text: &str,
    place: Option<yaml::Place>,
    path: Option<&Path>,
    problem: &str,
    remedy: &str,
) -> Error {
    let file = file.display();
    let path = path.filter(|path| !path.0.is_empty()).map(|path| format!(" ({path})")).unwrap_or_default();
    let Some((line, column)) = place else {
        return Error::input(format!("{file}{path}"), problem, remedy);
    };
    let error = Error::input(format!("{file}:{line}:{column}{path}"), problem, remedy);
    match text.lines().nth(line.saturating_sub(1)) {
        Some(text) if !text.trim().is_empty() => error.with_excerpt(excerpt(text, line, column)),
        _ => error,
    }
}

/// Characters of a line that are shown before the place of a mistake, and behind it.
const AROUND: usize = 60;

/// A line with a caret under its `column`; of a long one what is around it.
fn excerpt(text: &str, line: usize, column: usize) -> String {
    let first = (column - 1).saturating_sub(AROUND);
    let before: String = text.chars().take(column - 1).skip(first).collect();
    let behind: String = text.chars().skip(column - 1).take(AROUND).collect();
    let cut = |cut: bool| if cut { "…" } else { "" };
    let (start, end) = (cut(first > 0), cut(text.chars().nth(column - 1 + AROUND).is_some()));
    let (before, behind) = (plain(&before), plain(&behind));
    let margin = " ".repeat(line.to_string().len());
    let blank = " ".repeat(start.chars().count() + before.chars().count());
    format!("\n {line} | {start}{before}{behind}{end}\n {margin} | {blank}^")
}

/// The entry of a tree at `path`.
fn value_at<'a>(tree: &'a Value, path: &Path) -> Option<&'a Value> {
    path.0.iter().try_fold(tree, |value, step| match step {
        Step::Key(key) => value.get(key),
        Step::Index(index) => value.get(index),
    })
}

/// The item a name means: its number, or the value of its `name`.
fn position(list: &[Value], name: &str) -> Option<usize> {
    match name.parse() {
        Ok(index) => Some(index),
        Err(_) => list.iter().position(|item| item.get("name").and_then(Value::as_str) == Some(name)),
    }
}

/// What of a list there is to choose from: the numbers of its items, and their names.
fn items(list: &[Value]) -> String {
    let names: Vec<&str> = list.iter().filter_map(|item| item.get("name").and_then(Value::as_str)).collect();
    match (list.len(), names.is_empty()) {
        (0, _) => "it is empty: write the whole list, or add the item to the case file".to_owned(),
        (count, true) => format!("it has the items 0 to {}", count - 1),
        (count, false) => format!("it has the items 0 to {}, by name {}", count - 1, names.join(", ")),
    }
}
