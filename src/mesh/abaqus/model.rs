//! Nodes, elements, sets and sections of an input file, with the parts where their instances put them.

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

/// How many times each name is there.
pub fn count(names: impl Iterator<Item = String>) -> HashMap<String, usize> {
    let mut count = HashMap::new();
    names.for_each(|name| *count.entry(name).or_default() += 1);
    count
}

/// What to call a set of an instance: by both names where several instances have it.
pub fn called(model: &Model, instance: usize, name: &str, twice: bool) -> String {
    let instance = &model.instances[instance].name;
    if twice && !instance.is_empty() { format!("{instance}.{name}") } else { name.to_owned() }
}
