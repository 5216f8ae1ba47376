//! A case that goes on from the end of a phase of another run (`start_from`).
//!
//! It becomes one case: the phases of that run up to the named one, which are not solved again, and then its own. So all that depends on the
//! phases before (numbers of materials, what is taken away, the loads of the last step) is what it would be in a single run. What the state
//! depends on must be the same in both, and each entry that is not is named.

use super::issue::Issue;
use super::locate::{At, Path, Step};
use super::structure::suggest;
use crate::error::Result;
use crate::io::container::Store;
use crate::io::hash;
use crate::io::phase_state::{self, End};
use crate::program;
use serde_json::{Map, Value, json};
use std::path::{Path as FilePath, PathBuf};

pub const KEY: &str = "start_from";

/// The run that a case goes on from.
#[derive(Clone, Debug)]
pub struct Start {
    /// The file of the state, and its hash.
    pub path: PathBuf,
    pub hash: u64,
    pub end: End,
    /// How many phases come before its own.
    pub begun: usize,
    /// The contacts as the case file has them.
    contacts: Value,
}

impl Start {
    /// The state.
    ///
    /// # Errors
    /// `Input` when the file is damaged or another one by now.
    pub fn read(&self) -> Result<Store> {
        phase_state::read(&self.path, self.hash)
    }

    /// A line for the log.
    pub fn note(&self) -> String {
        format!("the run goes on from the end of phase `{}` of another one, {}", self.end.phase, hash::text(self.hash))
    }
}

/// Entries that do not go into the state of a run; what `start_from` brings is in the others.
const FREE: [&str; 5] = ["title", "mesh", "output", "phases", KEY];
/// Entries of `numerics` that any run may have its own of.
const FREE_NUMERICS: [&str; 4] = ["tolerance", "acceptable_tolerance", "max_iterations", "spectral_radius"];
/// The numbers of a contact.
const NUMBERS: [&str; 4] = ["friction", "adhesion", "adhesion_factor", "tension"];
/// Levels of the water, which phases have.
const LEVELS: [(&str, &str); 2] = [("level", "water_level"), ("phreatic_level", "phreatic_level")];
/// The contacts as the case file of a run has them, among what its states belong to.
const WRITTEN: &str = "contacts as written";
/// Entries that made the points, and have no effect on a run that goes on: they may be left out.
const INITIAL: [&str; 3] = ["initial_stress", "initial_pore_pressure", "initial_velocity"];

const AS_THERE: &str = "make it as it is there, or solve both in one run";

/// What the states at the ends of the own phases of a case belong to, given the hashes of its mesh and its points; `start` is what it goes on
/// from. By number of the phase, none for those of `start`, and for the one before them all (`initial_stress.then`).
pub fn ends(tree: &Value, start: Option<&Start>, [mesh, points]: [u64; 2]) -> Vec<Option<End>> {
    let begun = start.map_or(0, |start| start.begun);
    let phases = tree.get("phases").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
    let end = |(number, phase): (usize, &Value)| {
        (number >= begun).then(|| End {
            phase: phase.get("name").and_then(Value::as_str).unwrap_or_default().to_owned(),
            last: number + 1 == phases.len(),
            case: entries(tree, &phases[..=number], start).to_string(),
            mesh: hash::text(mesh),
            points: hash::text(points),
            program: program::SOURCE.to_owned(),
        })
    };
    let then = tree.get("initial_stress").and_then(|initial| initial.get("then"));
    let before = then.filter(|then| !then.is_null()).map(|_| None);
    before.into_iter().chain(phases.iter().enumerate().map(end)).collect()
}

/// The entries of a case that the state at the end of the last of some `phases` depends on.
fn entries(tree: &Value, phases: &[Value], start: Option<&Start>) -> Value {
    let mut kept: Map<String, Value> = tree.as_object().cloned().unwrap_or_default();
    FREE.iter().for_each(|key| drop(kept.remove(*key)));
    if let Some(numerics) = kept.get_mut("numerics").and_then(Value::as_object_mut) {
        FREE_NUMERICS.iter().for_each(|key| drop(numerics.remove(*key)));
    }
    let mut phases = phases.to_vec();
    for phase in phases.iter_mut().filter_map(Value::as_object_mut) {
        // Conditions name the history, which may be another.
        phase.remove("until");
        for (of_water, of_phase) in LEVELS {
            if let Some(level) = tree.get("water").and_then(|water| water.get(of_water)) {
                phase.entry(of_phase).or_insert_with(|| level.clone());
            }
        }
    }
    let used: Vec<String> = names_of_materials(&kept, &phases).map(str::to_owned).collect();
    if let Some(materials) = kept.get_mut("materials").and_then(Value::as_object_mut) {
        materials.retain(|name, _| used.contains(name));
    }
    let written =
        start.map_or_else(|| tree.get("contacts").cloned().unwrap_or(json!([])), |start| start.contacts.clone());
    kept.insert(WRITTEN.to_owned(), written);
    kept.insert("phases".to_owned(), phases.into());
    kept.into()
}

/// The materials that regions begin with and phases change them to.
fn names_of_materials<'a>(kept: &'a Map<String, Value>, phases: &'a [Value]) -> impl Iterator<Item = &'a str> {
    let regions = kept.get("regions").and_then(Value::as_object).into_iter().flat_map(Map::values);
    let begun = regions.filter_map(|region| region.get("material"));
    let of_phase = |phase: &'a Value| ["materials", "place"].into_iter().filter_map(|key| phase.get(key)?.as_object());
    let changes = phases.iter().flat_map(of_phase).flat_map(Map::values);
    begun.chain(changes).filter_map(Value::as_str)
}

/// Makes the case in `tree`, whose file is in `folder`, one that begins with the phases of the run that it goes on from, if it does.
///
/// # Errors
/// Each entry that the state of that run does not go with; a run that has no such state.
pub fn compose(tree: &mut Value, folder: &FilePath) -> std::result::Result<Option<Start>, Vec<Issue>> {
    // What has another shape is told by the schema.
    let Some(run) = tree.get(KEY).and_then(|start| start.get("run")).and_then(Value::as_str) else { return Ok(None) };
    let phase = tree[KEY].get("phase").and_then(Value::as_str);
    let (path, end) = find(&folder.join(run), phase).map_err(|issue| vec![issue])?;
    let entry = Path::default().key(KEY).key("run");
    let unreadable = |problem: String| Issue::new(&entry, At::Value, problem, "solve that run again");
    if end.program != program::SOURCE {
        let problem = format!("the run of {} was solved by another build of mpm", path.display());
        return Err(vec![unreadable(problem)]);
    }
    let file = hash::file(&path, "solve that run again").map_err(|e| vec![unreadable(e.to_string())])?;
    let Ok(Value::Object(other)) = serde_json::from_str::<Value>(&end.case) else {
        return Err(vec![unreadable(format!("{} is damaged", path.display()))]);
    };
    let Value::Object(own) = tree else { return Ok(None) };
    let contacts = own.get("contacts").cloned().unwrap_or(json!([]));
    let issues = differences(own, &other);
    if !issues.is_empty() {
        return Err(issues);
    }
    for key in INITIAL {
        if let Some(initial) = other.get(key) {
            own.insert(key.to_owned(), initial.clone());
        }
    }
    let mut begun = other.get("phases").and_then(Value::as_array).cloned().unwrap_or_default();
    let count = begun.len();
    merge_contacts(own, &other, &mut begun);
    // What is no list is told by the schema.
    if let Some(phases) = own.get_mut("phases").and_then(Value::as_array_mut) {
        begun.append(phases);
        *phases = begun;
    }
    Ok(Some(Start { path, hash: file, end, begun: count, contacts }))
}

/// The state at the end of a phase, of the last one without a name, in an output folder, or the folder of its case.
fn find(folder: &FilePath, phase: Option<&str>) -> std::result::Result<(PathBuf, End), Issue> {
    let start = Path::default().key(KEY);
    let of_run = |problem: String, remedy: &str| Issue::new(&start.key("run"), At::Value, problem, remedy);
    let mut states = Vec::new();
    for output in [folder.to_owned(), folder.join("out")] {
        states = phase_state::list(&output.join(phase_state::FOLDER))
            .map_err(|e| of_run(format!("{}: {}", e.place, e.problem), &e.remedy))?;
        if !states.is_empty() {
            break;
        }
    }
    let names: Vec<String> = states.iter().map(|(_, end)| end.phase.clone()).collect();
    if names.is_empty() {
        let problem = format!("{} has no state at the end of a phase", folder.display());
        let remedy = "name the output folder of a run, relative to the case file, and solve it first";
        return Err(of_run(problem, remedy));
    }
    let wanted = |end: &End| phase.map_or(end.last, |phase| end.phase == phase);
    let found = states.into_iter().find(|(_, end)| wanted(end));
    found.ok_or_else(|| match phase {
        Some(phase) => {
            let problem = format!("the run in {} has no end of a phase `{phase}`", folder.display());
            Issue::new(&start.key("phase"), At::Value, problem, suggest(phase, names.iter().map(String::as_str)))
        }
        None => {
            let problem = format!("the run in {} did not come to the end of its last phase", folder.display());
            let remedy =
                format!("continue it with `--resume`, or name a `phase` that it has ended: {}", names.join(", "));
            Issue::new(&start, At::Key, problem, remedy)
        }
    })
}

/// The entries that must be the same and are not.
fn differences(own: &Map<String, Value>, other: &Map<String, Value>) -> Vec<Issue> {
    let mut issues = Vec::new();
    let mut keys: Vec<&String> = own.keys().chain(other.keys()).collect();
    keys.sort();
    keys.dedup();
    for key in keys {
        let path = Path::default().key(key);
        let [mine, theirs] = [own.get(key), other.get(key)];
        let difference = match key.as_str() {
            key if FREE.contains(&key) || key == WRITTEN => None,
            key if INITIAL.contains(&key) && mine.is_none() => None,
            "contacts" => contacts_differ(mine, theirs, &path),
            "materials" => {
                // Further ones are for phases to come.
                let materials = theirs.and_then(Value::as_object).into_iter().flatten();
                let mut differ = materials
                    .filter_map(|(name, value)| differ(mine.and_then(|m| m.get(name)), Some(value), &path.key(name)));
                differ.next()
            }
            "numerics" => differ(without(mine, &FREE_NUMERICS).as_ref(), theirs, &path),
            "water" => {
                let here = |value: Option<&Value>| {
                    let mut value = value.cloned();
                    for (level, _) in LEVELS {
                        if let Some(level) = value.as_mut().and_then(|value| value.get_mut(level)) {
                            *level = Value::Bool(true);
                        }
                    }
                    value
                };
                differ(here(mine).as_ref(), here(theirs).as_ref(), &path)
            }
            _ => differ(mine, theirs, &path),
        };
        let remedy = match key.as_str() {
            "materials" => "make it as it is there, and give the region another material by `materials` of a phase",
            "supports" => {
                "make it as it is there; what is to be held or freed later is prescribed in phases, not supported"
            }
            "gravity" => "make it as it is there; phases have a factor on it, or components of their own",
            _ => AS_THERE,
        };
        issues.extend(difference.map(|(path, how)| {
            let problem = format!("{how} in the run that `{KEY}` names, and must be the same");
            Issue::new(&path, At::Value, problem, remedy)
        }));
    }
    issues
}

/// An entry without some keys; `None` where nothing is left.
fn without(value: Option<&Value>, keys: &[&str]) -> Option<Value> {
    let mut value = value.cloned()?;
    if let Some(entries) = value.as_object_mut() {
        entries.retain(|key, _| !keys.contains(&key.as_str()));
    }
    Some(value)
}

/// Whether two values mean the same: an empty or missing block are alike, and numbers however they are written.
fn same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Number(a), Value::Number(b)) => a.as_f64() == b.as_f64(),
        (Value::Array(a), Value::Array(b)) => a.len() == b.len() && a.iter().zip(b).all(|(a, b)| same(a, b)),
        _ => a == b,
    }
}

/// The first place in which two entries differ, and how the other one is.
fn differ(own: Option<&Value>, other: Option<&Value>, path: &Path) -> Option<(Path, String)> {
    let empty = |value: &&Value| !(value.is_null() || value.as_object().is_some_and(Map::is_empty));
    match (own.filter(empty), other.filter(empty)) {
        (None, None) => None,
        (Some(Value::Object(own)), Some(Value::Object(other))) => {
            let mut keys: Vec<&String> = own.keys().chain(other.keys()).collect();
            keys.sort();
            keys.into_iter().find_map(|key| differ(own.get(key), other.get(key), &path.key(key)))
        }
        (Some(a), Some(b)) if same(a, b) => None,
        (_, Some(other)) => Some((path.clone(), format!("it is {other}"))),
        (Some(_), None) => Some((path.clone(), "it is not given".to_owned())),
    }
}

/// The name that a contact without one gets.
fn unnamed(i: usize) -> String {
    format!("contacts[{i}]")
}

/// Contacts may differ in their numbers, and give names to what has none.
fn contacts_differ(own: Option<&Value>, other: Option<&Value>, path: &Path) -> Option<(Path, String)> {
    let [mine, theirs] = [own, other].map(|list| list.and_then(Value::as_array).cloned().unwrap_or_default());
    if mine.len() != theirs.len() {
        return Some((path.clone(), format!("there are {} contacts", theirs.len())));
    }
    let mut pairs = mine.iter().zip(&theirs).enumerate();
    pairs.find_map(|(i, (mine, theirs))| {
        let mut free = NUMBERS.to_vec();
        if theirs.get("name").is_none_or(|name| *name == unnamed(i).as_str()) {
            free.push("name");
        }
        differ(without(Some(mine), &free).as_ref(), without(Some(theirs), &free).as_ref(), &path.index(i))
    })
}

/// Takes the contacts of the run, and lets what the case file says otherwise than the file of that run come with its first phase.
fn merge_contacts(own: &mut Map<String, Value>, other: &Map<String, Value>, begun: &mut [Value]) {
    let list = |of: &Map<String, Value>, key: &str| of.get(key).and_then(Value::as_array).cloned().unwrap_or_default();
    let (mine, written) = (list(own, "contacts"), list(other, WRITTEN));
    let mut contacts = list(other, "contacts");
    let mut changes = Map::new();
    for (i, contact) in contacts.iter_mut().enumerate() {
        let (Some(mine), Some(contact)) = (mine.get(i), contact.as_object_mut()) else { continue };
        let before = contact.get("name").and_then(Value::as_str).map(str::to_owned);
        let name = mine.get("name").and_then(Value::as_str).map(str::to_owned);
        let name = name.or_else(|| before.clone()).unwrap_or_else(|| unnamed(i));
        contact.insert("name".to_owned(), name.clone().into());
        for phase in begun.iter_mut() {
            let of_phase = phase.get_mut("contacts").and_then(Value::as_object_mut);
            if let (Some(changes), Some(before)) = (of_phase, &before)
                && let Some(change) = changes.remove(before)
            {
                changes.insert(name.clone(), change);
            }
        }
        let mut change = Map::new();
        for key in NUMBERS {
            let [now, then] = [Some(mine), written.get(i)].map(|of| of.and_then(|of| of.get(key)));
            if differ(now, then, &Path::default()).is_some() {
                let default = match key {
                    "tension" => json!("cut_off"),
                    "adhesion_factor" => json!("none"),
                    _ => json!(0),
                };
                change.insert(key.to_owned(), now.cloned().unwrap_or(default));
            }
        }
        if !change.is_empty() {
            changes.insert(name, change.into());
        }
    }
    if own.contains_key("contacts") || !contacts.is_empty() {
        own.insert("contacts".to_owned(), contacts.into());
    }
    let first = own.get_mut("phases").and_then(|phases| phases.get_mut(0)).and_then(Value::as_object_mut);
    if let (Some(first), false) = (first, changes.is_empty()) {
        let given = first.entry("contacts").or_insert_with(|| json!({}));
        let Some(given) = given.as_object_mut() else { return };
        for (name, change) in changes {
            let given = given.entry(name).or_insert_with(|| json!({}));
            if let (Some(given), Some(change)) = (given.as_object_mut(), change.as_object()) {
                for (key, value) in change {
                    given.entry(key.clone()).or_insert_with(|| value.clone());
                }
            }
        }
    }
}

/// The entry of the case file that one of the whole case is; `None` for one of the phases before.
pub fn own(path: &Path, begun: usize) -> Option<Path> {
    let mut path = path.clone();
    if let [Step::Key(key), Step::Index(index), ..] = &mut path.0[..]
        && *key == "phases"
    {
        *index = index.checked_sub(begun)?;
    }
    Some(path)
}

/// Makes of the path of an entry of the case file that in the whole case.
pub fn to_whole(path: &mut Path, begun: usize) {
    if let [Step::Key(key), Step::Index(index), ..] = &mut path.0[..]
        && *key == "phases"
    {
        *index += begun;
    }
}
