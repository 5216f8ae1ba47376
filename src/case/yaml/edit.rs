//! Entries of a YAML text changed in place: comments, order and layout of all else stay.
//!
//! Left out: entries over several lines without brackets, which hold comments of their own, and items of lists that are not there.

use super::{Content, Node, Place, meaning, parse};
use crate::case::locate::{Path, Step};
use serde_json::Value;

/// The text with the entry at `path` set to `value`. One that is not there is added at the end of the block or brackets around it.
///
/// # Errors
/// What stands in the way, in words.
pub fn set(text: &str, path: &Path, value: &Value) -> Result<String, String> {
    let root = parse(text).map_err(|fault| fault.problem)?;
    let mut node = root.as_ref();
    for (depth, step) in path.0.iter().enumerate() {
        node = match (step, &node.content) {
            (Step::Key(key), Content::Block(entries, _)) => match entries.get(key) {
                Some((_, entry)) => entry,
                None => return add(text, node, key, &within(&path.0[depth + 1..], value)?),
            },
            (Step::Index(index), Content::List(items)) => {
                items.get(*index).ok_or_else(|| format!("the list has no item {index}"))?
            }
            _ => return Err("there is no such entry".into()),
        };
    }
    let [start, end] = [node.place, node.end].map(|place| offset(text, place));
    let is_collection = matches!(node.content, Content::Block(..) | Content::List(_));
    if is_collection && !is_in_brackets(text, node) {
        return Err(format!("`{path}` has entries on lines of their own"));
    }
    Ok(format!("{}{}{}", &text[..start], flow(value), &text[end..]))
}

/// The text with an entry more in a block.
fn add(text: &str, block: &Node, key: &str, value: &Value) -> Result<String, String> {
    let entry = format!("{}: {}", word(key), flow(value));
    if is_in_brackets(text, block) {
        let end = offset(text, block.end) - 1;
        let before = text[..end].trim_end();
        let separator = if before.ends_with('{') { "" } else { ", " };
        return Ok(format!("{before}{separator}{entry}{}", &text[end..]));
    }
    // Behind the line of the block's last entry, in line with its first key.
    let Content::Block(entries, _) = &block.content else { return Err("it is no block of entries".into()) };
    let column = entries.values().map(|((_, column), _)| *column).min().unwrap_or(1);
    let (line, _) = last(text, block);
    let end = text.split_inclusive('\n').take(line).map(str::len).sum::<usize>();
    let before = text[..end].trim_end_matches('\n');
    Ok(format!("{before}\n{}{entry}\n{}", " ".repeat(column - 1), &text[end..]))
}

/// The place behind the last character of a node.
fn last(text: &str, node: &Node) -> Place {
    let below: Vec<&Node> = match &node.content {
        Content::Block(entries, _) => entries.values().map(|(_, entry)| entry.as_ref()).collect(),
        Content::List(items) => items.iter().map(AsRef::as_ref).collect(),
        Content::Scalar(_) | Content::Strange(..) => Vec::new(),
    };
    let lines = below.into_iter().map(|entry| last(text, entry)).max();
    lines.filter(|_| !is_in_brackets(text, node)).unwrap_or(node.end)
}

/// Blocks around a value by the keys of `path`.
fn within(path: &[Step], value: &Value) -> Result<Value, String> {
    path.iter().rev().try_fold(value.clone(), |value, step| match step {
        Step::Key(key) => Ok(Value::Object([(key.clone(), value)].into_iter().collect())),
        Step::Index(index) => Err(format!("there is no list with an item {index}")),
    })
}

/// Whether a block or list is written in brackets, on one line or several.
fn is_in_brackets(text: &str, node: &Node) -> bool {
    text[offset(text, node.place)..].starts_with(['{', '['])
}

/// The byte at a place.
fn offset(text: &str, (line, column): Place) -> usize {
    let before: usize = text.split_inclusive('\n').take(line - 1).map(str::len).sum();
    let within = text[before..].char_indices().nth(column - 1).map_or(text.len() - before, |(byte, _)| byte);
    before + within
}

/// A value on one line.
fn flow(value: &Value) -> String {
    match value {
        Value::Array(items) => format!("[{}]", items.iter().map(flow).collect::<Vec<_>>().join(", ")),
        Value::Object(entries) => {
            let entries = entries.iter().map(|(key, value)| format!("{}: {}", word(key), flow(value)));
            format!("{{{}}}", entries.collect::<Vec<_>>().join(", "))
        }
        Value::String(text) => word(text),
        Value::Null | Value::Bool(_) | Value::Number(_) => value.to_string(),
    }
}

/// A text without quotes where it is a name and means nothing else.
fn word(text: &str) -> String {
    let is_name = text.starts_with(char::is_alphabetic) && text.chars().all(|c| c.is_alphanumeric() || c == '_');
    if is_name && meaning(text).is_some_and(|value| value == text) {
        return text.to_owned();
    }
    Value::from(text).to_string()
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    const TEXT: &str = "\
# A case
title: Füße            # a title
clay: {young: 1.0e+5,  # kPa
       poisson: 0.49}
steps:
  - name: one          # the first
    step: {initial: 0.1}
    table: [[0, 1], [2, 3]]
  - name: two
output:
  every: 0.1           # s

  # the end
";

    fn path(text: &str) -> Path {
        text.split('.').fold(Path::default(), |path, step| match step.parse() {
            Ok(index) => path.index(index),
            Err(_) => path.key(step),
        })
    }

    fn tree(text: &str) -> Value {
        parse(text).unwrap().to_json(&mut Vec::new())
    }

    #[test]
    fn an_entry_is_changed_where_it_stands() {
        for (at, value, old, new) in [
            ("title", json!("Ü: # 1"), "Füße            # a", "\"Ü: # 1\"            # a"),
            ("title", json!("null"), "Füße  ", "\"null\"  "),
            ("clay.young", json!(1e-6), "1.0e+5,  # kPa", "1e-6,  # kPa"),
            ("clay.poisson", json!({"top": 1, "gradient": 2.5}), "0.49}", "{gradient: 2.5, top: 1}}"),
            ("clay", json!({"young": 5}), "{young: 1.0e+5,  # kPa\n       poisson: 0.49}", "{young: 5}"),
            ("steps.0.name", json!("three"), "one          #", "three          #"),
            ("steps.0.table.1.0", json!(-7), "[2, 3]", "[-7, 3]"),
            ("steps.1.name", json!(true), "two", "true"),
            ("output.every", json!(2), "0.1           # s", "2           # s"),
        ] {
            let changed = set(TEXT, &path(at), &value).unwrap();
            assert_eq!(changed, TEXT.replacen(old, new, 1), "{at}");
            assert_ne!(changed, TEXT, "{at}");
            let pointer = format!("/{}", at.replace('.', "/"));
            assert_eq!(tree(&changed).pointer(&pointer), Some(&value), "{at}");
        }
    }

    #[test]
    fn an_entry_that_is_not_there_is_added_behind_the_others() {
        for (at, value, old, new) in [
            ("clay.density", json!(1.8), "0.49}", "0.49, density: 1.8}"),
            ("steps.0.step.min", json!(0.01), "0.1}\n", "0.1, min: 0.01}\n"),
            ("steps.0.until", json!([{"a": 1}]), "[2, 3]]\n", "[2, 3]]\n    until: [{a: 1}]\n"),
            ("steps.1.a.b", json!("c"), "two\n", "two\n    a: {b: c}\n"),
            ("output.more", json!(1), "# s\n", "# s\n  more: 1\n"),
            (
                "numerics.restore",
                json!("never"),
                "0.1           # s\n",
                "0.1           # s\nnumerics: {restore: never}\n",
            ),
        ] {
            let changed = set(TEXT, &path(at), &value).unwrap();
            assert_eq!(changed, TEXT.replacen(old, new, 1), "{at}");
            let pointer = format!("/{}", at.replace('.', "/"));
            assert_eq!(tree(&changed).pointer(&pointer), Some(&value), "{at}");
        }
        assert_eq!(set("a: {}", &path("a.b"), &json!(1)).unwrap(), "a: {b: 1}");
        assert_eq!(set("a: 1", &path("b"), &json!(1)).unwrap(), "a: 1\nb: 1\n");
    }

    #[test]
    fn what_has_lines_of_its_own_is_left_alone() {
        for at in ["steps", "steps.0", "output"] {
            let problem = set(TEXT, &path(at), &json!({})).unwrap_err();
            assert!(problem.contains("lines of their own"), "{problem}");
        }
        assert!(set(TEXT, &path("steps.7.name"), &json!(1)).is_err());
        assert!(set(TEXT, &path("title.name"), &json!(1)).is_err());
    }
}
