//! The sections of an MSH 4.1 file that make a mesh: names, entities, nodes, elements.
//!
//! Each is checked as far as it can be by itself: its numbers are whole, its counts are right, its tags are there once
//! and those it refers to are there.

use super::source::Source;
use crate::error::Result;
use crate::mesh::shape::{CellKind, MAX_NODES};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// What the sections hold.
#[derive(Default)]
pub struct Sections {
    /// Bytes of the whole file.
    pub length: usize,
    /// Names of physical groups by dimension and number.
    pub names: BTreeMap<(usize, u32), String>,
    /// The numbers of the physical groups of each entity, ascending, by dimension and tag.
    pub entities: [BTreeMap<i32, Vec<u32>>; 4],
    pub nodes: Nodes,
    pub blocks: Vec<Block>,
}

/// The nodes, ascending by their tags.
#[derive(Default)]
pub struct Nodes {
    pub tags: Vec<u64>,
    /// Coordinates (m).
    pub x: Vec<[f64; 3]>,
}

/// Elements of one kind of one entity.
pub struct Block {
    pub dimension: usize,
    pub entity: i32,
    pub kind: CellKind,
    /// Gmsh's number of the kind, by which it orders the elements of an entity.
    pub number: i32,
    /// The nodes of each element, as indices into [`Nodes`].
    pub nodes: Vec<u32>,
}

impl Nodes {
    fn find(&self, tag: u64) -> Option<u32> {
        // Tags mostly count up without a gap.
        let hint = tag.checked_sub(*self.tags.first()?).and_then(|i| usize::try_from(i).ok());
        let index = match hint.filter(|&i| self.tags.get(i) == Some(&tag)) {
            Some(index) => index,
            None => self.tags.binary_search(&tag).ok()?,
        };
        u32::try_from(index).ok()
    }
}

/// Reads the heart of `$PhysicalNames`, which is text in a binary file too.
///
/// # Errors
/// Input: a dimension that there is none of, or a group named twice.
pub fn names(source: &mut Source) -> Result<BTreeMap<(usize, u32), String>> {
    let mut names = BTreeMap::new();
    for _ in 0..source.text_int()? {
        let (dimension, number) = (source.text_int()?, source.text_int()?);
        let dimension = checked_dimension(source, dimension)?;
        // Names of MED are filled up with blanks.
        let name = source.quoted()?.trim_end().to_owned();
        if names.insert((dimension, number.unsigned_abs()), name).is_some() {
            return Err(source.wrong(format!("physical group {number} of dimension {dimension} has two names")));
        }
    }
    Ok(names)
}

/// Reads the heart of `$Entities`: tags with their physical groups; boxes and boundaries are passed.
///
/// # Errors
/// Input: a tag that is there twice.
pub fn entities(source: &mut Source) -> Result<[BTreeMap<i32, Vec<u32>>; 4]> {
    let mut entities: [BTreeMap<i32, Vec<u32>>; 4] = Default::default();
    // Of an entity at least its tag and its place, or its box, and the numbers of its groups and of what bounds it.
    let mut counts = [0; 4];
    for (dimension, count) in counts.iter_mut().enumerate() {
        *count = source.count("entities", 1, if dimension == 0 { 4 } else { 8 })?;
    }
    for (dimension, (of_dimension, count)) in entities.iter_mut().zip(counts).enumerate() {
        for _ in 0..count {
            let tag = source.int()?;
            for _ in 0..if dimension == 0 { 3 } else { 6 } {
                source.real()?;
            }
            let mut groups = Vec::new();
            for _ in 0..source.count("physical groups", 1, 0)? {
                // A negative number tells that the entity is turned round in the group.
                groups.push(source.int()?.unsigned_abs());
            }
            groups.sort_unstable();
            groups.dedup();
            if dimension > 0 {
                for _ in 0..source.count("boundaries", 1, 0)? {
                    source.int()?;
                }
            }
            match of_dimension.entry(tag) {
                Entry::Vacant(place) => place.insert(groups),
                Entry::Occupied(_) => {
                    return Err(source.wrong(format!("entity {tag} of dimension {dimension} is there twice")));
                }
            };
        }
    }
    Ok(entities)
}

/// Reads the heart of `$Nodes`.
///
/// # Errors
/// Input: a coordinate that is not finite, a tag that is there twice, and counts that are wrong.
pub fn nodes(source: &mut Source) -> Result<Nodes> {
    let blocks = source.count("blocks of nodes", 3, 1)?;
    let total = source.count("nodes", 0, 4)?;
    let _bounds_of_tags = (source.size()?, source.size()?);
    let mut nodes = Nodes { tags: Vec::with_capacity(total), x: Vec::with_capacity(total) };
    for _ in 0..blocks {
        let dimension = source.int()?;
        let dimension = checked_dimension(source, dimension)?;
        let _entity = source.int()?;
        let parameters = match source.int()? {
            0 => 0,
            1 => dimension,
            other => return Err(source.wrong(format!("{other} stands where 0 or 1 should be: parametric or not"))),
        };
        let count = source.count("nodes", 0, 4 + parameters)?;
        for _ in 0..count {
            nodes.tags.push(source.size()?);
        }
        for _ in 0..count {
            let x = [source.real()?, source.real()?, source.real()?];
            if !x.iter().all(|v| v.is_finite()) {
                return Err(source.wrong("a coordinate is not a finite number"));
            }
            nodes.x.push(x);
            for _ in 0..parameters {
                source.real()?;
            }
        }
    }
    if nodes.tags.len() != total {
        return Err(source.wrong(format!("{} nodes instead of {total}", nodes.tags.len())));
    }
    if !nodes.tags.is_sorted() {
        let mut order: Vec<usize> = (0..total).collect();
        order.sort_unstable_by_key(|&i| nodes.tags[i]);
        nodes.tags.sort_unstable();
        nodes.x = order.into_iter().map(|i| nodes.x[i]).collect();
    }
    match nodes.tags.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(source.wrong(format!("node {} is there twice", pair[0]))),
        None => Ok(nodes),
    }
}

/// Reads the heart of `$Elements`, which come after the `nodes`.
///
/// # Errors
/// Input: elements of a type that there are no cells for, nodes that are not there, a node twice in an element, and
/// counts that are wrong.
pub fn elements(source: &mut Source, nodes: &Nodes) -> Result<Vec<Block>> {
    let mut blocks = Vec::new();
    let count = source.count("blocks of elements", 3, 1)?;
    let total = source.count("elements", 0, 2)?;
    let _bounds_of_tags = (source.size()?, source.size()?);
    let mut read = 0;
    for _ in 0..count {
        let (dimension, entity, number) = (source.int()?, source.int()?, source.int()?);
        let dimension = checked_dimension(source, dimension)?;
        let Some(kind) = kind_of(number) else {
            return Err(source.wrong_but(
                format!("elements of Gmsh's type {number}"),
                "mesh it in two dimensions with cells of order 1 or 2, or with quadrilaterals alone (`Recombine Surface`) of order 3",
            ));
        };
        if kind.dimension() != dimension {
            return Err(source.wrong(format!("{kind:?} elements of an entity of dimension {dimension}")));
        }
        let each = kind.node_count();
        let count = source.count("elements", 0, 1 + each)?;
        let mut of_block = Vec::with_capacity(count * each);
        let mut element = [0; MAX_NODES];
        let element = &mut element[..each];
        for _ in 0..count {
            let tag = source.size()?;
            for i in 0..each {
                let node = source.size()?;
                element[i] = match nodes.find(node) {
                    Some(index) if element[..i].contains(&index) => {
                        return Err(source.wrong(format!("element {tag} has node {node} twice")));
                    }
                    Some(index) => index,
                    None => return Err(source.wrong(format!("element {tag} has node {node}, which is not there"))),
                };
            }
            of_block.extend_from_slice(element);
        }
        read += count;
        blocks.push(Block { dimension, entity, kind, number, nodes: of_block });
    }
    if read != total {
        return Err(source.wrong(format!("{read} elements instead of {total}")));
    }
    Ok(blocks)
}

/// The kind of cell of a Gmsh element type.
fn kind_of(number: i32) -> Option<CellKind> {
    Some(match number {
        15 => CellKind::Point1,
        1 => CellKind::Line2,
        8 => CellKind::Line3,
        26 => CellKind::Line4,
        2 => CellKind::T3,
        9 => CellKind::T6,
        3 => CellKind::Q4,
        16 => CellKind::Q8,
        10 => CellKind::Q9,
        36 => CellKind::Q16,
        _ => return None,
    })
}

fn checked_dimension(source: &Source, dimension: i32) -> Result<usize> {
    match usize::try_from(dimension) {
        Ok(dimension @ 0..=3) => Ok(dimension),
        _ => Err(source.wrong(format!("there is no dimension {dimension}"))),
    }
}
