//! Where in the YAML text an entry stands.
//!
//! The parser tells the place of an error only, so an entry is found by reading the text once more with
//! a reader that fails on purpose exactly there. That keeps quoting, flow style and anchors right without
//! a second parser.

use serde::Deserialize;
use serde::de::{DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor};
use std::fmt;

/// One step from a block of the case to an entry of it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Step {
    Key(String),
    Index(usize),
}

/// The way from the root of the case to an entry; prints as `phases[0].step.min`.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Path(pub Vec<Step>);

impl Path {
    /// The entry `key` of this block.
    pub fn key(&self, key: &str) -> Self {
        self.with(Step::Key(key.to_owned()))
    }

    /// The item `index` of this list.
    pub fn index(&self, index: usize) -> Self {
        self.with(Step::Index(index))
    }

    fn with(&self, step: Step) -> Self {
        let mut steps = self.0.clone();
        steps.push(step);
        Self(steps)
    }

    /// Whether this is `other` or a block around it.
    pub fn contains(&self, other: &Self) -> bool {
        other.0.starts_with(&self.0)
    }
}

impl fmt::Display for Path {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, step) in self.0.iter().enumerate() {
            match step {
                Step::Key(key) if i == 0 => write!(f, "{key}")?,
                Step::Key(key) => write!(f, ".{key}")?,
                Step::Index(index) => write!(f, "[{index}]")?,
            }
        }
        Ok(())
    }
}

/// Which part of an entry a message is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum At {
    Key,
    Value,
}

/// Line and column (from 1) of the entry at `path` in `text`; `None` if the text has no such entry.
pub fn locate(text: &str, path: &Path, at: At) -> Option<(usize, usize)> {
    let at = if matches!(path.0.last(), Some(Step::Key(_))) { at } else { At::Value };
    let probe = Probe { path: &path.0, at };
    let error = probe.deserialize(serde_yaml::Deserializer::from_str(text)).err()?;
    error.location().map(|place| (place.line(), place.column()))
}

/// Fails at the entry, and nowhere else in a text that was parsed before.
#[derive(Clone, Copy)]
struct Probe<'a> {
    path: &'a [Step],
    at: At,
}

impl<'de> DeserializeSeed<'de> for Probe<'_> {
    type Value = ();

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
        match self.path.split_first() {
            None => deserializer.deserialize_any(Found),
            Some((step, rest)) => deserializer.deserialize_any(Descend { step, rest, at: self.at }),
        }
    }
}

/// Refuses whatever it meets: every method of a visitor does unless it is written.
struct Found;

impl Visitor<'_> for Found {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("nothing")
    }
}

/// Looks for `step` in a block or list.
struct Descend<'a> {
    step: &'a Step,
    rest: &'a [Step],
    at: At,
}

impl<'de> Visitor<'de> for Descend<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("anything")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        let Step::Key(wanted) = self.step else { return skip_map(map) };
        let stop = self.rest.is_empty() && self.at == At::Key;
        while let Some(found) = map.next_key_seed(Key { wanted, stop })? {
            if found {
                map.next_value_seed(Probe { path: self.rest, at: self.at })?;
            } else {
                map.next_value::<IgnoredAny>()?;
            }
        }
        Ok(())
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<(), A::Error> {
        if let Step::Index(index) = *self.step {
            for _ in 0..index {
                seq.next_element::<IgnoredAny>()?;
            }
            seq.next_element_seed(Probe { path: self.rest, at: self.at })?;
        }
        while seq.next_element::<IgnoredAny>()?.is_some() {}
        Ok(())
    }

    fn visit_bool<E: Error>(self, _: bool) -> Result<(), E> {
        Ok(())
    }

    fn visit_i64<E: Error>(self, _: i64) -> Result<(), E> {
        Ok(())
    }

    fn visit_u64<E: Error>(self, _: u64) -> Result<(), E> {
        Ok(())
    }

    fn visit_f64<E: Error>(self, _: f64) -> Result<(), E> {
        Ok(())
    }

    fn visit_str<E: Error>(self, _: &str) -> Result<(), E> {
        Ok(())
    }

    fn visit_unit<E: Error>(self) -> Result<(), E> {
        Ok(())
    }
}

fn skip_map<'de, A: MapAccess<'de>>(mut map: A) -> Result<(), A::Error> {
    while map.next_entry::<IgnoredAny, IgnoredAny>()?.is_some() {}
    Ok(())
}

/// Whether a key is the wanted one; fails there when that is the place looked for.
struct Key<'a> {
    wanted: &'a str,
    stop: bool,
}

impl<'de> DeserializeSeed<'de> for Key<'_> {
    type Value = bool;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<bool, D::Error> {
        if self.stop {
            return deserializer.deserialize_any(self);
        }
        Ok(String::deserialize(deserializer)? == self.wanted)
    }
}

impl Visitor<'_> for Key<'_> {
    type Value = bool;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a key")
    }

    fn visit_str<E: Error>(self, key: &str) -> Result<bool, E> {
        if key == self.wanted { Err(E::custom("found")) } else { Ok(false) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
title: \"a: b\" # materials: none
materials:
  clay: {model: tresca, young: {top: 1, gradient: 2}}
phases:
  - name: one
    table: [[0, 1], [2, 3]]
";

    fn path(text: &str) -> Path {
        text.split('.').fold(Path::default(), |path, step| match step.parse() {
            Ok(index) => path.index(index),
            Err(_) => path.key(step),
        })
    }

    #[test]
    fn keys_and_values_are_found_in_block_and_flow_style() {
        let cases = [
            ("title", At::Key, (1, 1)),
            ("title", At::Value, (1, 8)),
            ("materials.clay", At::Key, (3, 3)),
            ("materials.clay.model", At::Value, (3, 17)),
            ("materials.clay.young.gradient", At::Key, (3, 41)),
            ("phases.0.name", At::Value, (5, 11)),
            ("phases.0.table.1.0", At::Value, (6, 22)),
        ];
        for (at_path, at, place) in cases {
            assert_eq!(locate(TEXT, &path(at_path), at), Some(place), "{at_path}");
        }
    }

    #[test]
    fn what_is_not_there_has_no_place() {
        for missing in ["nothing", "materials.sand", "phases.7", "title.sub", "materials.0"] {
            assert_eq!(locate(TEXT, &path(missing), At::Value), None, "{missing}");
        }
    }

    #[test]
    fn a_path_prints_as_a_user_would_write_it() {
        assert_eq!(path("phases.0.step.min").to_string(), "phases[0].step.min");
    }
}
