//! A mesh as the text of an MSH 4.1 file: a group is an entity, and all nodes are with the first region.

use super::curves::Group;
use super::model::Model;
use super::regions::Regions;
use crate::mesh::shape::CellKind;
use std::collections::BTreeMap;
use std::fmt::Write;

/// The nodes of the elements of each group, by its dimension and number and by Gmsh's number of their type.
type Blocks<'a> = BTreeMap<(usize, usize, i32), Vec<&'a [u32]>>;

pub fn msh(model: &Model, regions: &Regions, groups: &[Group]) -> String {
    let mut blocks = Blocks::new();
    let mut names = Vec::new();
    let mut counts = [0; 3];
    for group in groups {
        let dimension = group.dimension();
        counts[dimension] += 1;
        names.push((dimension, counts[dimension], group.name.as_str()));
        for facet in &group.facets {
            blocks.entry((dimension, counts[dimension], type_of_edge(facet.len()))).or_default().push(facet);
        }
    }
    names.sort_unstable();
    for (region, name) in regions.names.iter().enumerate() {
        names.push((2, region + 1, name));
    }
    counts[2] = regions.names.len();
    for (element, region) in model.elements.iter().zip(&regions.of) {
        let Some(region) = region else { continue };
        blocks.entry((2, region + 1, type_of_cell(element.kind))).or_default().push(&element.nodes);
    }
    let mut used = vec![false; model.nodes.len()];
    blocks.values().flatten().copied().flatten().for_each(|&n| used[n as usize] = true);
    let used: Vec<usize> = (0..used.len()).filter(|&n| used[n]).collect();
    let mut text = String::from("$MeshFormat\n4.1 0 8\n$EndMeshFormat\n");
    // Writing to a text cannot fail.
    let _ = written(&mut text, model, &names, counts, &used, &blocks);
    text
}

fn written(
    text: &mut String,
    model: &Model,
    names: &[(usize, usize, &str)],
    counts: [usize; 3],
    used: &[usize],
    blocks: &Blocks,
) -> std::fmt::Result {
    writeln!(text, "$PhysicalNames\n{}", names.len())?;
    for (dimension, number, name) in names {
        let name: String = name.chars().filter(|c| *c != '"' && !c.is_control()).collect();
        writeln!(text, "{dimension} {number} \"{name}\"")?;
    }
    writeln!(text, "$EndPhysicalNames\n$Entities\n{} {} {} 0", counts[0], counts[1], counts[2])?;
    for (dimension, count) in counts.into_iter().enumerate() {
        for number in 1..=count {
            // Boxes and boundaries are for Gmsh alone.
            let rest = if dimension == 0 { "0 0 0" } else { "0 0 0 0 0 0" };
            writeln!(text, "{number} {rest} 1 {number}{}", if dimension == 0 { "" } else { " 0" })?;
        }
    }
    writeln!(text, "$EndEntities\n$Nodes\n1 {0} 1 {1}\n2 1 0 {0}", used.len(), model.nodes.len())?;
    used.iter().try_for_each(|n| writeln!(text, "{}", n + 1))?;
    for &n in used {
        let [x, y, z] = model.nodes[n];
        writeln!(text, "{x} {y} {z}")?;
    }
    let total: usize = blocks.values().map(Vec::len).sum();
    writeln!(text, "$EndNodes\n$Elements\n{} {total} 1 {total}", blocks.len())?;
    let mut tag = 0;
    for ((dimension, number, kind), elements) in blocks {
        writeln!(text, "{dimension} {number} {kind} {}", elements.len())?;
        for element in elements {
            tag += 1;
            write!(text, "{tag}")?;
            element.iter().try_for_each(|n| write!(text, " {}", n + 1))?;
            writeln!(text)?;
        }
    }
    writeln!(text, "$EndElements")
}

fn type_of_edge(nodes: usize) -> i32 {
    match nodes {
        1 => 15,
        2 => 1,
        _ => 8,
    }
}

fn type_of_cell(kind: CellKind) -> i32 {
    match kind {
        CellKind::T3 => 2,
        CellKind::Q4 => 3,
        CellKind::T6 => 9,
        CellKind::Q8 => 16,
        _ => 10,
    }
}
