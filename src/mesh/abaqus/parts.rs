//! Parts and their instances.

use super::keywords::{Block, blocks};
use super::model::{Instance, Model};
use super::place::Shift;
use super::reader::Reader;
use crate::error::Result;
use std::collections::{BTreeMap, HashMap};

/// Nodes, elements and members of all sets for each byte of a file, counted as often as parts and sets are named.
const MOST_MEMBERS: usize = 16;

/// Reads a file, whose parts are taken where their instances put them.
///
/// # Errors
/// Input: as [`super::to_msh`].
pub fn read(text: &str, place: &str) -> Result<Model> {
    let blocks = blocks(text, place)?;
    // The file or assembly itself.
    let model = Model { instances: vec![Instance::default()], ..Model::default() };
    let mut reader = Reader {
        model,
        place,
        shift: Shift::default(),
        left: MOST_MEMBERS * text.len(),
        named: HashMap::new(),
        unknown: BTreeMap::new(),
    };
    let mut parts: BTreeMap<String, Vec<&Block>> = BTreeMap::new();
    let (mut part, mut instance) = (None, 0);
    let placed = blocks.iter().any(|block| block.name == "instance");
    for block in &blocks {
        let named = || block.get("name").unwrap_or_default().to_lowercase();
        match block.name.as_str() {
            "part" if placed => part = Some(named()),
            "part" => instance = reader.instance(block, Shift::default()),
            "end part" => (part, instance) = (None, 0),
            "instance" => {
                let of = block.get("part").unwrap_or_default();
                instance = reader.instance(block, Shift::of(block, place)?);
                let Some(blocks) = parts.get(&of.to_lowercase()) else {
                    return Err(reader.wrong(
                        block.line,
                        format!("there is no part {of:?} before it"),
                        "write the parts first",
                    ));
                };
                blocks.iter().try_for_each(|block| reader.take(block, instance))?;
            }
            "end instance" => {
                instance = 0;
                reader.shift = Shift::default();
            }
            _ => match &part {
                Some(part) => parts.entry(part.clone()).or_default().push(block),
                None => reader.take(block, instance)?,
            },
        }
        if let Some(part) = &part {
            parts.entry(part.clone()).or_default();
        }
    }
    for (kind, count) in reader.unknown {
        reader.model.notes.push(format!("note: {count} elements of type {kind} are left out: mpm takes plane ones"));
    }
    Ok(reader.model)
}
