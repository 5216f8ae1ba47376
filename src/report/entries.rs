//! The entries of a case as tables, with the units that its schema tells.

use super::html::Html;
use serde_json::{Map, Value};

/// What the schema knows of an entry: the definition of its kind.
pub struct Kinds<'a> {
    schema: &'a Value,
}

/// The units of entries, as descriptions have them in brackets.
const UNITS: [&str; 14] =
    ["-", "m", "s", "kN", "kPa", "kN/m³", "t/m³", "m/s", "m/s²", "1/s", "degrees", "rad/m", "kPa/m", "°"];

impl<'a> Kinds<'a> {
    pub fn of(schema: &'a Value) -> Self {
        Self { schema }
    }

    fn property(&self, kind: &str, key: &str) -> Option<&'a Value> {
        self.schema.get("$defs")?.get(kind)?.get("properties")?.get(key)
    }

    /// An entry with its unit, as a heading.
    fn heading(&self, kind: &str, key: &str) -> String {
        let name = key.replace('_', " ");
        let description = self.property(kind, key).and_then(|p| p.get("description")).and_then(Value::as_str);
        match description.and_then(unit) {
            Some(unit) if unit != "-" => format!("{name} [{unit}]"),
            _ => name,
        }
    }

    /// What an entry is if the case does not say.
    fn default(&self, kind: &str, key: &str) -> Option<&'a Value> {
        self.property(kind, key)?.get("default")
    }

    /// A row for each of some named entries, a column for each key that one of them has.
    pub fn rows(&self, kind: &str, first: &str, entries: &[(String, &Value)]) -> Html {
        let keys = keys(entries);
        let headings = std::iter::once(first.to_owned()).chain(keys.iter().map(|key| self.heading(kind, key)));
        let row = |(name, entry): &(String, &Value)| {
            let values = keys.iter().map(|key| entry.get(key).map_or_else(String::new, plain));
            std::iter::once(name.clone()).chain(values).collect()
        };
        Html::table(&headings.collect::<Vec<_>>(), &entries.iter().map(row).collect::<Vec<_>>())
    }

    /// As [`Kinds::rows`] with rows and columns exchanged, for entries of many keys.
    pub fn columns(&self, kind: &str, first: &str, entries: &[(String, &Value)]) -> Html {
        let headings: Vec<String> =
            std::iter::once(first.to_owned()).chain(entries.iter().map(|(name, _)| name.clone())).collect();
        let row = |key: &String| {
            let values = entries.iter().map(|(_, entry)| entry.get(key).map_or_else(String::new, plain));
            std::iter::once(self.heading(kind, key)).chain(values).collect()
        };
        Html::table(&headings, &keys(entries).iter().map(row).collect::<Vec<_>>())
    }

    /// The keys of an entry that are not what they are without it, with what that is.
    pub fn changed(&self, kind: &str, entry: &Value) -> Html {
        let entry = entry.as_object().into_iter().flatten();
        let changed = entry.filter(|(key, value)| self.default(kind, key).is_none_or(|default| !same(default, value)));
        let row = |(key, value): (&String, &Value)| {
            let default = self.default(kind, key).filter(|default| !default.is_null());
            vec![self.heading(kind, key), plain(value), default.map_or_else(|| "by the case".to_owned(), plain)]
        };
        let rows: Vec<_> = changed.map(row).collect();
        match rows.is_empty() {
            true => Html::of("p", "All as by default."),
            false => Html::table(&["entry", "value", "default"].map(str::to_owned), &rows),
        }
    }
}

/// The entries of a block by name: those of a map, or of a list by what `name` says of each.
pub fn entries(block: Option<&Value>, name: impl Fn(usize, &Value) -> String) -> Vec<(String, &Value)> {
    match block {
        Some(Value::Object(map)) => map.iter().map(|(key, value)| (key.clone(), value)).collect(),
        Some(Value::Array(list)) => list.iter().enumerate().map(|(i, value)| (name(i, value), value)).collect(),
        _ => Vec::new(),
    }
}

/// The keys of entries but their names, in the order in which they come.
fn keys(entries: &[(String, &Value)]) -> Vec<String> {
    let mut keys: Vec<String> = Vec::new();
    for key in entries.iter().filter_map(|(_, entry)| entry.as_object()).flat_map(Map::keys) {
        if key != "name" && !keys.contains(key) {
            keys.push(key.clone());
        }
    }
    keys
}

/// A value as a reader writes it: `gradient 3.6, top 2.3`.
pub fn plain(value: &Value) -> String {
    match value {
        Value::Null => String::new(),
        Value::Bool(yes) => (if *yes { "yes" } else { "no" }).to_owned(),
        Value::String(text) => text.clone(),
        Value::Number(number) => {
            let number = number.as_f64().unwrap_or(f64::NAN);
            let is_far = number != 0.0 && !(1e-4..1e6).contains(&number.abs());
            (if is_far { format!("{number:e}") } else { number.to_string() }).replace('-', "−")
        }
        Value::Array(items) => items.iter().map(inner).collect::<Vec<_>>().join(", "),
        Value::Object(map) => map
            .iter()
            .map(|(key, value)| format!("{} {}", key.replace('_', " "), inner(value)))
            .collect::<Vec<_>>()
            .join(", "),
    }
}

/// A value within another.
fn inner(value: &Value) -> String {
    match value {
        Value::Array(_) | Value::Object(_) => format!("({})", plain(value)),
        value => plain(value),
    }
}

/// Whether two values are the same; `1` is `1.0`.
fn same(a: &Value, b: &Value) -> bool {
    match (a.as_f64(), b.as_f64()) {
        (Some(a), Some(b)) => a == b,
        _ => a == b,
    }
}

/// The unit in a description: the first in brackets of either kind.
fn unit(description: &str) -> Option<&str> {
    description.split(['[', '(']).skip(1).find_map(|rest| {
        let inner = rest.split([']', ')']).next()?;
        UNITS.contains(&inner).then_some(inner)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn values_read_like_the_case() {
        assert_eq!(plain(&json!({"top": 2.3, "gradient": -3.6})), "gradient −3.6, top 2.3");
        assert_eq!(plain(&json!([{"on": "a", "x": 1}, true])), "(on a, x 1), yes");
        assert_eq!(unit("cohesion c [kPa] of mohr_coulomb."), Some("kPa"));
        assert_eq!(unit("Fields (all of them) at a time (s)."), Some("s"));
        assert_eq!(unit("The name."), None);
    }

    #[test]
    fn only_what_differs_from_the_default_is_told() {
        let schema = json!({"$defs": {"Numerics": {"properties": {"tolerance": {"default": 1e-8}, "restore": {"default": {"min_quality": 0.5}}}}}});
        let kinds = Kinds::of(&schema);
        let same = kinds.changed("Numerics", &json!({"tolerance": 1e-8, "restore": {"min_quality": 0.5}}));
        assert_eq!(same, Html::of("p", "All as by default."));
        let other = kinds.changed("Numerics", &json!({"tolerance": 1e-6}));
        let rows = [["tolerance", "1e−6", "1e−8"].map(str::to_owned).to_vec()];
        assert_eq!(other, Html::table(&["entry", "value", "default"].map(str::to_owned), &rows));
    }
}
