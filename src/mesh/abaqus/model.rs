//! Nodes, elements, sets and sections of an input file, with the parts where their instances put them.

use super::keywords::{Block, blocks};
use super::place::Shift;
use super::reader::Reader;
use crate::error::Result;
use crate::mesh::shape::CellKind;
use std::collections::{BTreeMap, BTreeSet, HashMap};

/// An element that is a cell or a line.
pub struct Element {
    pub kind: CellKind,
    /// Indices into [`Model::nodes`].
    pub nodes: Vec<u32>,
    /// Its number in the file, for messages.
    pub number: u64,
    pub instance: usize,
    /// The name, in small letters, of the set that it is in from the beginning.
    pub own: Option<String>,
}

impl Element {
    pub fn is_cell(&self) -> bool {
        self.kind.dimension() == 2
    }
}

/// What has numbers of its own: an instance, the assembly, or a file without them.
#[derive(Default)]
pub struct Instance {
    /// Its name; empty for the assembly and for a file without.
    pub name: String,
    pub nodes: BTreeMap<u64, u32>,
    pub elements: BTreeMap<u64, u32>,
}

/// A set of nodes or of elements, as indices.
#[derive(Default)]
pub struct Set {
    /// As the file has it first.
    pub name: String,
    pub members: BTreeSet<u32>,
    pub internal: bool,
    /// Whether it is one of `*NSET` or `*ELSET`.
    pub listed: bool,
}

/// The sides of cells that a `*SURFACE` has.
pub struct Surface {
    pub name: String,
    pub instance: usize,
    /// Elements with the number of their side, from 1 on; all free sides without one.
    pub sides: Vec<(u32, Option<usize>)>,
}

/// A section: what a set of elements is of.
pub struct Section {
    pub line: usize,
    pub instance: usize,
    /// The set, in small letters.
    pub set: String,
    pub material: String,
}

/// By instance and name in small letters.
pub type Sets = BTreeMap<(usize, String), Set>;

/// All that a file has.
#[derive(Default)]
pub struct Model {
    /// Where they are (m).
    pub nodes: Vec<[f64; 3]>,
    pub elements: Vec<Element>,
    pub instances: Vec<Instance>,
    pub node_sets: Sets,
    pub element_sets: Sets,
    pub surfaces: Vec<Surface>,
    pub sections: Vec<Section>,
    /// Lines for the user on what is left out.
    pub notes: Vec<String>,
}

/// Nodes, elements and members of all sets for each byte of a file, counted as often as parts and sets are named.
const MOST_MEMBERS: usize = 16;

impl Model {
    /// # Errors
    /// Input: as [`super::to_msh`].
    pub fn of(text: &str, place: &str) -> Result<Self> {
        let blocks = blocks(text, place)?;
        // The file or assembly itself.
        let model = Self { instances: vec![Instance::default()], ..Self::default() };
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
            reader
                .model
                .notes
                .push(format!("note: {count} elements of type {kind} are left out: mpm takes plane ones"));
        }
        Ok(reader.model)
    }
}
