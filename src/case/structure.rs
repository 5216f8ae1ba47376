//! The shape of a case against the JSON schema of its structures: unknown and missing keys, wrong types, ranges.
//!
//! Deserialising stops at the first mistake; walking the schema finds all of them, and names are suggested
//! from what the schema knows. It reads the part of JSON Schema that schemars writes for `raw`.

use super::issue::{Issue, MOST_FOUND, describe};
use super::locate::{At, Path};
use crate::error::shown;
use serde_json::{Map, Value};

/// How alike a key is to those of a block that takes any name (-): keys that are more alike to those of another block are meant for it.
const ANY_NAME: f64 = 0.8;

/// Every mistake in the shape of `tree`, up to [`MOST_FOUND`].
pub fn check(schema: &Value, tree: &Value) -> Vec<Issue> {
    let mut walk = Walk { root: schema, issues: Vec::new() };
    walk.value(schema, tree, &Path::default(), "");
    walk.issues
}

/// The name of `known` nearest to `name`, as a question, or the names there are.
pub fn suggest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> String {
    let known: Vec<&str> = known.into_iter().collect();
    match nearest(name, known.iter().copied()) {
        Some(near) => format!("did you mean `{}`?", shown(near)),
        None if known.is_empty() => "there is none to choose from".to_owned(),
        None => format!("choose from {}", list(&known)),
    }
}

/// Names that one not known is compared with, and names that a message lists.
const COMPARED: usize = 1000;
const LISTED: usize = 40;

/// The name most like `name`, if one is.
pub fn nearest<'a>(name: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let name = &*shown(name);
    let likeness = known
        .into_iter()
        .take(COMPARED)
        .map(|k| (strsim::jaro_winkler(name, &shown(k)), k))
        .filter(|&(likeness, _)| likeness > 0.8);
    likeness.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, k)| k)
}

/// Names in backquotes with commas between; of many the first ones.
pub fn list(names: &[&str]) -> String {
    let listed = names.iter().take(LISTED).map(|name| format!("`{}`", shown(name))).collect::<Vec<_>>().join(", ");
    match names.len().saturating_sub(LISTED) {
        0 => listed,
        more => format!("{listed} and {more} more"),
    }
}

struct Walk<'a> {
    root: &'a Value,
    issues: Vec<Issue>,
}

impl<'a> Walk<'a> {
    /// Whether so many mistakes are known that no more are looked for.
    fn is_full(&self) -> bool {
        self.issues.len() >= MOST_FOUND
    }

    fn issue(&mut self, path: &Path, at: At, problem: String, remedy: String) {
        self.issues.push(Issue::new(path, at, problem, remedy));
    }

    /// The schema behind a `$ref`.
    fn resolve(&self, schema: &'a Value) -> &'a Value {
        let name = schema.get("$ref").and_then(Value::as_str).and_then(|r| r.strip_prefix('#'));
        name.and_then(|pointer| self.root.pointer(pointer)).unwrap_or(schema)
    }

    fn value(&mut self, outer: &'a Value, value: &Value, path: &Path, around: &str) {
        if self.is_full() {
            return;
        }
        let schema = self.resolve(outer);
        // The description beside a `$ref` is about the entry, the one behind it about the type.
        let help = first_sentence(outer).or_else(|| first_sentence(schema)).unwrap_or(around.to_owned());
        if let Some(branches) = schema.get("anyOf").and_then(Value::as_array) {
            return self.any_of(branches, value, path, &help);
        }
        if let Some(known) = choices(schema) {
            if !value.is_null() || !accepts(schema, value) {
                self.choice(&known, value, path, &help);
            }
            return;
        }
        if !accepts(schema, value) {
            let problem = format!("is {}, but must be {}", describe(value), kind(schema));
            return self.issue(path, At::Value, problem, help);
        }
        match value {
            Value::Object(map) => self.object(schema, map, path, &help),
            Value::Array(items) => self.array(schema, items, path, &help),
            Value::Number(number) => self.range(schema, number.as_f64().unwrap_or(f64::NAN), path, &help),
            _ => {}
        }
    }

    fn any_of(&mut self, branches: &'a [Value], value: &Value, path: &Path, help: &str) {
        let branches = self.alternatives(branches);
        let fitting = branches.iter().copied().filter(|branch| accepts(branch, value));
        // Of several blocks the one whose keys are most like the ones given.
        match fitting.max_by(|a, b| self.likeness(a, value).total_cmp(&self.likeness(b, value))) {
            Some(branch) => self.value(branch, value, path, help),
            None => {
                let kinds = branches.iter().map(|branch| kind(branch)).filter(|kind| kind != "nothing");
                let kinds = kinds.collect::<Vec<_>>().join(" or ");
                self.issue(path, At::Value, format!("is {}, but must be {kinds}", describe(value)), help.to_owned());
            }
        }
    }

    /// The branches, those of branches that branch themselves in their place.
    fn alternatives(&self, branches: &'a [Value]) -> Vec<&'a Value> {
        let branches = branches.iter().map(|branch| self.resolve(branch));
        let of = |branch: &'a Value| match branch.get("anyOf").and_then(Value::as_array) {
            Some(own) => self.alternatives(own),
            None => vec![branch],
        };
        branches.flat_map(of).collect()
    }

    fn likeness(&self, branch: &'a Value, value: &Value) -> f64 {
        let (branch, Some(map)) = (self.resolve(branch), value.as_object()) else { return 0.0 };
        if branch.get("additionalProperties").is_some_and(Value::is_object) {
            return ANY_NAME * map.len() as f64;
        }
        let Some(properties) = branch.get("properties").and_then(Value::as_object) else { return 0.0 };
        let best = |key: &String| properties.keys().map(|k| strsim::jaro_winkler(&shown(key), k)).fold(0.0, f64::max);
        // Of a block with many keys the first ones tell.
        map.keys().take(properties.len()).map(best).sum()
    }

    fn choice(&mut self, known: &[&Value], value: &Value, path: &Path, help: &str) {
        if known.contains(&value) {
            return;
        }
        let names: Vec<String> = known.iter().map(|k| k.as_str().map_or(k.to_string(), str::to_owned)).collect();
        let names = names.iter().map(String::as_str);
        let remedy = match value.as_str() {
            Some(text) => suggest(text, names),
            None => format!("choose from {}", list(&names.collect::<Vec<_>>())),
        };
        self.issue(path, At::Value, format!("is {}, which is not known here", describe(value)), join(&remedy, help));
    }

    fn object(&mut self, schema: &'a Value, map: &Map<String, Value>, path: &Path, help: &str) {
        let none = Map::new();
        let properties = schema.get("properties").and_then(Value::as_object);
        let additional = schema.get("additionalProperties");
        for (key, value) in map {
            if self.is_full() {
                return;
            }
            let entry = path.key(key);
            match (properties.and_then(|p| p.get(key)), additional) {
                (Some(property), _) => self.value(property, value, &entry, help),
                (None, Some(Value::Object(_))) => {
                    if let Some(property) = additional {
                        self.value(property, value, &entry, help);
                    }
                }
                (None, _) => {
                    let known = || properties.unwrap_or(&none).keys().map(String::as_str);
                    let remedy = suggest(key, known());
                    let issue = Issue::new(&entry, At::Key, format!("unknown key `{}`", shown(key)), remedy);
                    let meant = nearest(key, known()).map(str::to_owned);
                    self.issues.push(Issue { unknown: true, meant, ..issue });
                }
            }
        }
        let strange = |key: &&String| properties.is_none_or(|p| !p.contains_key(*key));
        let required = schema.get("required").and_then(Value::as_array).into_iter().flatten();
        for name in required.filter_map(Value::as_str).filter(|&name| !map.contains_key(name)) {
            // A key that is nearly this one has been reported.
            if map.keys().filter(strange).any(|key| nearest(key, [name]).is_some()) {
                continue;
            }
            let help = properties.and_then(|p| p.get(name)).and_then(first_sentence).unwrap_or_default();
            self.issue(path, At::Key, format!("`{name}` is missing"), format!("add `{name}: …`: {help}"));
        }
        if schema.get("minProperties").and_then(Value::as_u64).is_some_and(|least| (map.len() as u64) < least) {
            let help = first_sentence(schema).unwrap_or_default();
            self.issue(path, At::Key, "has no entries".into(), join("add one", &help));
        }
    }

    fn array(&mut self, schema: &'a Value, items: &[Value], path: &Path, help: &str) {
        let bound = |name| schema.get(name).and_then(Value::as_u64);
        let (least, most) = (bound("minItems").unwrap_or(0), bound("maxItems").unwrap_or(u64::MAX));
        let count = items.len() as u64;
        if count < least || count > most {
            let wanted = if least == most { least.to_string() } else { format!("at least {least}") };
            self.issue(path, At::Value, format!("has {count} items, but must have {wanted}"), help.to_owned());
        }
        if let Some(schema) = schema.get("items") {
            for (i, item) in items.iter().enumerate() {
                self.value(schema, item, &path.index(i), help);
            }
        }
    }

    fn range(&mut self, schema: &Value, number: f64, path: &Path, help: &str) {
        let bound = |name| schema.get(name).and_then(Value::as_f64);
        let wrong = [
            bound("minimum").filter(|&b| number < b).map(|b| format!("at least {b}")),
            bound("exclusiveMinimum").filter(|&b| number <= b).map(|b| format!("above {b}")),
            bound("maximum").filter(|&b| number > b).map(|b| format!("at most {b}")),
            bound("exclusiveMaximum").filter(|&b| number >= b).map(|b| format!("below {b}")),
        ];
        if let Some(wanted) = wrong.into_iter().flatten().next() {
            self.issue(path, At::Value, format!("is {number}, but must be {wanted}"), help.to_owned());
        }
    }
}

/// The values of an enumeration, however schemars writes it.
fn choices(schema: &Value) -> Option<Vec<&Value>> {
    if let Some(values) = schema.get("enum").and_then(Value::as_array) {
        return Some(values.iter().collect());
    }
    schema.get("oneOf").and_then(Value::as_array)?.iter().map(|branch| branch.get("const")).collect()
}

/// The JSON types a schema allows.
fn types(schema: &Value) -> Vec<&str> {
    match schema.get("type") {
        Some(Value::String(one)) => vec![one],
        Some(Value::Array(several)) => several.iter().filter_map(Value::as_str).collect(),
        _ if choices(schema).is_some() => vec!["string"],
        _ => Vec::new(),
    }
}

/// Whether the type of a value fits.
fn accepts(schema: &Value, value: &Value) -> bool {
    let types = types(schema);
    let fits = |name: &&str| match *name {
        "null" => value.is_null(),
        "boolean" => value.is_boolean(),
        "integer" => value.is_i64() || value.is_u64(),
        "number" => value.is_number(),
        "string" => value.is_string(),
        "array" => value.is_array(),
        "object" => value.is_object(),
        _ => false,
    };
    types.is_empty() || types.iter().any(fits)
}

/// What a schema wants, in words.
fn kind(schema: &Value) -> String {
    let words = types(schema).into_iter().filter(|&name| name != "null").map(|name| match name {
        "boolean" => "true or false".to_owned(),
        "integer" => "a whole number".to_owned(),
        "number" => "a number".to_owned(),
        "string" => match choices(schema) {
            Some(known) => list(&known.iter().filter_map(|k| k.as_str()).collect::<Vec<_>>()).replace(", ", " or "),
            None => "text".to_owned(),
        },
        "array" => "a list".to_owned(),
        _ => match schema.get("properties").and_then(Value::as_object) {
            Some(known) => format!("{{{}}}", known.keys().map(String::as_str).collect::<Vec<_>>().join(", ")),
            None => "a block of entries".to_owned(),
        },
    });
    let words = words.collect::<Vec<_>>().join(" or ");
    if words.is_empty() { "nothing".to_owned() } else { words }
}

/// The first sentence of a description.
fn first_sentence(schema: &Value) -> Option<String> {
    let text = schema.get("description")?.as_str()?;
    let end = text.find(". ").unwrap_or(text.len());
    Some(text[..end].trim_end_matches('.').replace('\n', " "))
}

fn join(remedy: &str, help: &str) -> String {
    if help.is_empty() { remedy.to_owned() } else { format!("{remedy} ({help})") }
}
