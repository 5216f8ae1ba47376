//! YAML text as a tree in which each entry knows its place.
//!
//! The text is read event by event, so that limits hold before time or memory is spent: on its size, on how deep
//! blocks and lists are nested, and on how many entries there are with those that aliases repeat. What a plain scalar
//! means (nothing, a truth value, a number or text) is what `serde_yaml` reads it as. An alias shares the tree of its
//! anchor. Left out: several documents in a file, and merge keys (`<<` is a key).

pub mod edit;

use super::issue::{Issue, MOST_FOUND};
use super::locate::{At, Path, Step};
use saphyr_parser::{Event, Marker, Parser, ScalarStyle};
use serde_json::{Map, Number, Value};
use std::borrow::Cow;
use std::collections::{BTreeMap, HashMap};
use std::sync::Arc;

/// Bytes of a text: a table of 100 000 rows has half as many.
pub const MOST_BYTES: usize = 4 << 20;
/// Levels of blocks and lists within each other: a case has ten.
pub const MOST_LEVELS: usize = 64;
/// Entries and items with those that aliases repeat: a table of 100 000 rows has 300 000.
pub const MOST_ENTRIES: usize = 1_000_000;

/// Keys of a block, and items of a list that are no rows of a table. They are compared with each other.
pub const MOST_NAMED: usize = 10_000;

/// Characters of a key: every message below repeats it.
pub const MOST_OF_KEY: usize = 200;
/// Bytes of a text that count as one entry: aliases repeat texts, too.
const TEXT: usize = 32;

/// Line and column, from 1.
pub type Place = (usize, usize);

/// An entry and what is below it.
#[derive(Debug)]
pub struct Node {
    place: Place,
    /// Behind the last character of a scalar, or behind the bracket that closes a block or list; without brackets it says nothing.
    end: Place,
    content: Content,
    /// Entries and items from here downwards, those behind aliases counted each time.
    entries: usize,
    /// Levels from here downwards.
    levels: usize,
}

#[derive(Debug)]
enum Content {
    Scalar(Value),
    List(Vec<Arc<Node>>),
    /// By key, with the place of the key; and whether there are keys that are not names.
    Block(BTreeMap<String, (Place, Arc<Node>)>, bool),
    /// What a case does not have, with the remedy.
    Strange(String, &'static str),
}

/// Where reading ended, and why.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    pub place: Option<Place>,
    pub problem: String,
    pub remedy: &'static str,
}

/// The one entry that may have several lines.
const TITLE: &str = "title";

const MEND: &str = "mend the YAML there: check quotes, brackets, colons and indentation";

/// Reads a text.
///
/// # Errors
/// What is not YAML, what is beyond the limits, control characters, a key that a block has twice.
pub fn parse(text: &str) -> Result<Arc<Node>, Fault> {
    if text.len() > MOST_BYTES {
        let problem = format!("it has {} bytes, more than {MOST_BYTES}", text.len());
        return Err(Fault { place: None, problem, remedy: "shorten it: tables need no more rows than the steps take" });
    }
    check_characters(text)?;
    let mut reader = Reader::default();
    for event in Parser::new_from_str(text) {
        let (event, span) = event.map_err(|e| match place(e.marker()) {
            // Brackets that the parser has read ahead.
            place if e.info().contains("recursion limit") => too_deep(place),
            // The parser tells where the text before the tab begins.
            place if e.info().contains("tab") => fault(next_tab(text, place).unwrap_or(place), e.info(), MEND),
            place => fault(place, e.info(), MEND),
        })?;
        reader.take(event, place(&span.start), place(&span.end))?;
    }
    Ok(reader.root.unwrap_or_else(|| Node::scalar([(1, 1); 2], Value::Null)))
}

fn place(mark: &Marker) -> Place {
    (mark.line(), mark.col() + 1)
}

/// The first tab in the lines from that of `from` on.
fn next_tab(text: &str, from: Place) -> Option<Place> {
    let mut lines = text.lines().enumerate().skip(from.0.saturating_sub(1));
    lines.find_map(|(i, line)| Some((i + 1, line.chars().position(|c| c == '\t')? + 1)))
}

/// Text has no control characters but tabs and line breaks; a zero byte would end it unseen.
fn check_characters(text: &str) -> Result<(), Fault> {
    for (i, line) in text.split('\n').enumerate() {
        let control = |c: char| c.is_control() && !matches!(c, '\t' | '\r' | '\u{85}');
        if let Some((column, c)) = line.chars().enumerate().find(|&(_, c)| control(c)) {
            let problem = format!("there is a control character, U+{:04X}", u32::from(c));
            let remedy = "take it out, and save the file as plain UTF-8 text";
            return Err(Fault { place: Some((i + 1, column + 1)), problem, remedy });
        }
    }
    Ok(())
}

impl Node {
    fn scalar([place, end]: [Place; 2], value: Value) -> Arc<Self> {
        let entries = 1 + value.as_str().map_or(0, str::len) / TEXT;
        Arc::new(Self { place, end, content: Content::Scalar(value), entries, levels: 0 })
    }

    fn strange([place, end]: [Place; 2], problem: String, remedy: &'static str) -> Arc<Self> {
        Arc::new(Self { place, end, content: Content::Strange(problem, remedy), entries: 1, levels: 0 })
    }

    /// Whether it is a text, a block or nothing: what lists have few of.
    fn is_named(&self) -> bool {
        matches!(
            self.content,
            Content::Scalar(Value::String(_) | Value::Null) | Content::Block(..) | Content::Strange(..)
        )
    }

    /// Line and column of the entry at `path`; `None` without such an entry.
    pub fn locate(&self, path: &Path, at: At) -> Option<Place> {
        let (mut key, mut node) = (None, self);
        for step in &path.0 {
            (key, node) = match (step, &node.content) {
                (Step::Key(name), Content::Block(entries, _)) => {
                    entries.get(name).map(|(key, entry)| (Some(*key), entry.as_ref()))?
                }
                (Step::Index(index), Content::List(items)) => (None, items.get(*index)?.as_ref()),
                _ => return None,
            };
        }
        Some(key.filter(|_| at == At::Key).unwrap_or(node.place))
    }

    /// The tree without what a case never needs: tags, keys that are not names, numbers that are not finite,
    /// control characters. Each is left out, and a fault.
    pub fn to_json(&self, faults: &mut Vec<Issue>) -> Value {
        self.value(&mut Path::default(), faults)
    }

    fn value(&self, path: &mut Path, faults: &mut Vec<Issue>) -> Value {
        let mut refuse = |at: At, problem: &str, remedy: &str| {
            if faults.len() < MOST_FOUND {
                faults.push(Issue::new(path, at, problem, remedy));
            }
            Value::Null
        };
        match &self.content {
            Content::Scalar(Value::String(text)) if text.contains('\n') && *path != Path::default().key(TITLE) => {
                refuse(At::Value, "the text has a line break", "write it on one line")
            }
            Content::Scalar(value) => value.clone(),
            Content::Strange(problem, remedy) => refuse(At::Value, problem, remedy),
            Content::List(items) => {
                let items = items.iter().enumerate();
                items.map(|(i, item)| item.below(Step::Index(i), path, faults)).collect()
            }
            Content::Block(entries, strange) => {
                if *strange {
                    refuse(At::Key, "a key that is not a name", "put the key in quotes, on one line");
                }
                let entry = |(key, (_, entry)): (&String, &(Place, Arc<Self>))| {
                    (key.clone(), entry.below(Step::Key(key.clone()), path, faults))
                };
                Value::Object(entries.iter().map(entry).collect::<Map<_, _>>())
            }
        }
    }

    /// As [`Node::value`], one step further down.
    fn below(&self, step: Step, path: &mut Path, faults: &mut Vec<Issue>) -> Value {
        path.0.push(step);
        let value = self.value(path, faults);
        path.0.pop();
        value
    }
}

/// A block or list whose end has not come.
struct Open {
    place: Place,
    anchor: usize,
    /// Why the case cannot have it.
    tag: Option<String>,
    content: Content,
    /// The key whose value comes next; the inner `None` for one that is not a name.
    key: Option<Option<(String, Place)>>,
    entries: usize,
    levels: usize,
}

#[derive(Default)]
struct Reader {
    open: Vec<Open>,
    anchors: HashMap<usize, Arc<Node>>,
    root: Option<Arc<Node>>,
    documents: usize,
}

impl Reader {
    /// Takes an event that stands from `place` to `end`.
    fn take(&mut self, event: Event, place: Place, end: Place) -> Result<(), Fault> {
        match event {
            Event::DocumentStart(_) => {
                self.documents += 1;
                if self.documents > 1 {
                    let remedy = "keep one, and take the line `---` before the other out";
                    return Err(fault(place, "there is more than one document", remedy));
                }
            }
            Event::Alias(anchor) => {
                let Some(node) = self.anchors.get(&anchor).cloned() else {
                    return Err(fault(place, "the alias stands within what it names", "write the entry out"));
                };
                self.add(node, place)?;
            }
            Event::Scalar(text, style, anchor, tag) => {
                let node = match tag {
                    Some(tag) => tagged([place, end], &tag.to_string()),
                    None => scalar([place, end], text, style),
                };
                self.end(node, place, anchor)?;
            }
            Event::SequenceStart(anchor, tag) => {
                self.begin(place, anchor, tag.map(|tag| tag.to_string()), Content::List(Vec::new()))?;
            }
            Event::MappingStart(anchor, tag) => {
                let content = Content::Block(BTreeMap::new(), false);
                self.begin(place, anchor, tag.map(|tag| tag.to_string()), content)?;
            }
            Event::SequenceEnd | Event::MappingEnd => {
                // The bracket itself: the parser ends it behind the blanks and the comment that follow.
                let end = (place.0, place.1 + 1);
                if let Some(Open { place, anchor, tag, content, entries, levels, .. }) = self.open.pop() {
                    let node = match tag {
                        Some(tag) => tagged([place, end], &tag),
                        None => Arc::new(Node { place, end, content, entries, levels: levels + 1 }),
                    };
                    self.end(node, place, anchor)?;
                }
            }
            Event::Nothing | Event::StreamStart | Event::StreamEnd | Event::DocumentEnd => {}
        }
        Ok(())
    }

    fn begin(&mut self, place: Place, anchor: usize, tag: Option<String>, content: Content) -> Result<(), Fault> {
        if self.open.len() >= MOST_LEVELS {
            return Err(too_deep(place));
        }
        self.open.push(Open { place, anchor, tag, content, key: None, entries: 1, levels: 0 });
        Ok(())
    }

    /// A whole entry, which aliases may name from now on.
    fn end(&mut self, node: Arc<Node>, place: Place, anchor: usize) -> Result<(), Fault> {
        if anchor != 0 {
            self.anchors.insert(anchor, node.clone());
        }
        self.add(node, place)
    }

    /// Adds an entry, which stands at `place`, to the block or list that is open.
    fn add(&mut self, node: Arc<Node>, place: Place) -> Result<(), Fault> {
        if self.open.len() + node.levels > MOST_LEVELS {
            return Err(too_deep(place));
        }
        let Some(open) = self.open.last_mut() else {
            self.root = Some(node);
            return Ok(());
        };
        open.entries += node.entries;
        open.levels = open.levels.max(node.levels);
        if open.entries > MOST_ENTRIES {
            let problem = format!("there are more than {MOST_ENTRIES} entries, those that aliases repeat among them");
            return Err(fault(place, &problem, "write fewer: no case needs as many"));
        }
        match &mut open.content {
            Content::List(items) => {
                if items.len() >= MOST_NAMED && node.is_named() {
                    return Err(too_many(place, "list", "items"));
                }
                items.push(node);
            }
            Content::Block(entries, strange) => match open.key.take() {
                None => {
                    let name = match &node.content {
                        Content::Scalar(Value::String(name)) if !name.contains('\n') => Some(name.clone()),
                        _ => None,
                    };
                    if let Some(name) = name.as_ref().filter(|name| entries.contains_key(*name)) {
                        let problem = format!("the key `{name}` is a duplicate");
                        return Err(fault(place, &problem, "keep one of the two entries"));
                    }
                    if name.as_ref().is_some_and(|name| name.chars().nth(MOST_OF_KEY).is_some()) {
                        let problem = format!("the key has more than {MOST_OF_KEY} characters");
                        return Err(fault(place, &problem, "choose a shorter name"));
                    }
                    if entries.len() >= MOST_NAMED {
                        return Err(too_many(place, "block", "keys"));
                    }
                    *strange |= name.is_none();
                    open.key = Some(name.map(|name| (name, place)));
                }
                Some(None) => {}
                Some(Some((name, key))) => {
                    entries.insert(name, (key, node));
                }
            },
            Content::Scalar(_) | Content::Strange(..) => {}
        }
        Ok(())
    }
}

fn fault(place: Place, problem: &str, remedy: &'static str) -> Fault {
    Fault { place: Some(place), problem: problem.to_owned(), remedy }
}

fn too_deep(place: Place) -> Fault {
    let problem = format!("blocks and lists are nested deeper than {MOST_LEVELS} levels");
    fault(place, &problem, "take brackets or indentation out: a case has about ten levels")
}

fn too_many(place: Place, of: &str, what: &str) -> Fault {
    fault(place, &format!("the {of} has more than {MOST_NAMED} {what}"), "write fewer: no case needs as many")
}

fn tagged(place: [Place; 2], tag: &str) -> Arc<Node> {
    Node::strange(place, format!("a YAML tag {tag}"), "write the entry without a tag")
}

fn scalar(place: [Place; 2], text: Cow<str>, style: ScalarStyle) -> Arc<Node> {
    if style != ScalarStyle::Plain {
        return match text.chars().find(|&c| c.is_control() && !matches!(c, '\n' | '\t')) {
            Some(c) => {
                let problem = format!("the text has a control character, U+{:04X}", u32::from(c));
                Node::strange(place, problem, "take it out")
            }
            None => Node::scalar(place, text.into()),
        };
    }
    match meaning(&text) {
        Some(value) => Node::scalar(place, value),
        None => Node::strange(place, format!("{text} is not a finite number"), "write a number"),
    }
}

/// What a plain scalar means: nothing, a truth value, a number or text. `None` for a number that is not finite.
fn meaning(text: &str) -> Option<Value> {
    use serde_yaml::Value as Yaml;
    // As an item of a list, where no text means the end of a document.
    let item = serde_yaml::from_str::<Vec<Yaml>>(&format!("- {text}")).ok().and_then(|items| items.into_iter().next());
    Some(match item {
        Some(Yaml::Null) => Value::Null,
        Some(Yaml::Bool(truth)) => truth.into(),
        Some(Yaml::Number(number)) => match (number.as_i64(), number.as_u64(), number.as_f64()) {
            (Some(whole), _, _) => whole.into(),
            (_, Some(whole), _) => whole.into(),
            (_, _, Some(real)) => Number::from_f64(real)?.into(),
            _ => text.into(),
        },
        _ => text.into(),
    })
}

#[cfg(test)]
mod tests;
