//! Curves and points of a mesh: from surfaces, sets of line elements and sets of nodes.

use super::model::Model;
use super::regions::Regions;
use std::collections::{BTreeMap, BTreeSet, HashMap, HashSet};

/// A named curve, or named points.
pub struct Group {
    pub name: String,
    /// The nodes of its edges, ends first; of points one each.
    pub facets: Vec<Vec<u32>>,
}

impl Group {
    pub fn dimension(&self) -> usize {
        usize::from(self.facets.first().is_some_and(|facet| facet.len() > 1))
    }
}

/// Edges by their ends, ascending, with the cells that have them and their nodes.
type Edges = HashMap<[u32; 2], Edge>;

struct Edge {
    nodes: Vec<u32>,
    cells: Vec<u32>,
}

/// What to call a set of an instance: by both names where several instances have it.
pub fn called(model: &Model, instance: usize, name: &str, twice: bool) -> String {
    let instance = &model.instances[instance].name;
    if twice && !instance.is_empty() { format!("{instance}.{name}") } else { name.to_owned() }
}

/// All groups; what becomes none is told in the notes of the model.
pub fn of(model: &mut Model, regions: &Regions) -> Vec<Group> {
    let edges = edges(model);
    let mut found: BTreeMap<String, Group> = BTreeMap::new();
    for surface in &model.surfaces {
        let twice = model.surfaces.iter().filter(|other| other.name.eq_ignore_ascii_case(&surface.name)).count() > 1;
        let name = called(model, surface.instance, &surface.name, twice);
        let mut facets = Vec::new();
        for &(e, side) in &surface.sides {
            let element = &model.elements[e as usize];
            let sides = if element.is_cell() { element.kind.facets().1 } else { &[] };
            for (i, facet) in sides.iter().enumerate() {
                let nodes: Vec<u32> = facet.iter().map(|&n| element.nodes[n]).collect();
                let is_free = || edges.get(&ends(&nodes)).is_some_and(|edge| edge.cells.len() == 1);
                if side.map_or_else(is_free, |side| side == i + 1) {
                    facets.push(nodes);
                }
            }
        }
        keep(&mut found, Group { name, facets });
    }
    for ((instance, key), set) in &model.element_sets {
        let lines = set.members.iter().map(|&e| &model.elements[e as usize]).filter(|element| !element.is_cell());
        let facets = lines.map(|line| edge_of(&edges, &line.nodes)).collect();
        let twice = model.element_sets.keys().any(|(other, name)| other != instance && name == key);
        keep(&mut found, Group { name: called(model, *instance, &set.name, twice), facets });
    }
    let mut notes = Vec::new();
    let used: HashSet<u32> = cells(model).flat_map(|(_, element)| element.nodes.iter().copied()).collect();
    let within: HashSet<u32> = edges.values().flat_map(|edge| edge.nodes[2..].iter().copied()).collect();
    for ((instance, key), set) in model.node_sets.iter().filter(|(_, set)| !set.internal) {
        let twice = model.node_sets.keys().any(|(other, name)| other != instance && name == key);
        let name = called(model, *instance, &set.name, twice);
        // Programs write the nodes of regions and of surfaces, too.
        if regions.names.contains(&name) || found.contains_key(&name.to_lowercase()) {
            continue;
        }
        let nodes: BTreeSet<u32> = set.members.iter().copied().filter(|n| used.contains(n)).collect();
        match along(model, regions, &edges, &within, &nodes) {
            Ok(facets) => keep(&mut found, Group { name, facets }),
            Err(Some(stray)) => notes.push(format!(
                "note: the set of nodes `{name}` is left out: {stray} of its {} nodes lie on no edge whose other nodes are in it, beside edges \
                 that are; make sets of whole edges and of single nodes",
                nodes.len()
            )),
            Err(None) => {}
        }
    }
    model.notes.extend(notes);
    found.into_values().collect()
}

fn keep(found: &mut BTreeMap<String, Group>, mut group: Group) {
    if group.facets.is_empty() || group.name.is_empty() {
        return;
    }
    // An edge between two cells of a surface is named by both.
    let mut seen = HashSet::new();
    group.facets.retain(|facet| match facet.len() {
        1 => seen.insert([facet[0]; 2]),
        _ => seen.insert(ends(facet)),
    });
    found.entry(group.name.to_lowercase()).or_insert(group);
}

fn cells(model: &Model) -> impl Iterator<Item = (usize, &super::model::Element)> {
    model.elements.iter().enumerate().filter(|(_, element)| element.is_cell())
}

fn ends(nodes: &[u32]) -> [u32; 2] {
    [nodes[0].min(nodes[1]), nodes[0].max(nodes[1])]
}

fn edges(model: &Model) -> Edges {
    let mut edges = Edges::new();
    for (e, element) in cells(model) {
        for facet in element.kind.facets().1 {
            let nodes: Vec<u32> = facet.iter().map(|&n| element.nodes[n]).collect();
            edges.entry(ends(&nodes)).or_insert_with(|| Edge { nodes, cells: Vec::new() }).cells.push(e as u32);
        }
    }
    edges
}

/// The nodes of a line in the order of the edge of a cell that it is, ends first: programs number the middle one second or last.
fn edge_of(edges: &Edges, line: &[u32]) -> Vec<u32> {
    let is_same = |edge: &&Edge| line.iter().all(|n| edge.nodes.contains(n));
    let ends = [[0, 1], [0, line.len() - 1]].map(|[a, b]| ends(&[line[a], line[b]]));
    let edge = ends.iter().filter_map(|ends| edges.get(ends)).find(is_same);
    edge.map_or_else(|| line.to_vec(), |edge| edge.nodes.clone())
}

/// The edges whose nodes are all in a set, those on boundaries of regions first, and inner ones only where nodes of the set are on no other; or
/// the single nodes of a set without edges. `within` has the nodes in the middle of edges; a set without any stands for the edges between its
/// nodes.
///
/// # Errors
/// How many nodes are left over beside the edges; none where the set is an area.
fn along(
    model: &Model,
    regions: &Regions,
    edges: &Edges,
    within: &HashSet<u32>,
    nodes: &BTreeSet<u32>,
) -> Result<Vec<Vec<u32>>, Option<usize>> {
    let corners_only = !nodes.iter().any(|n| within.contains(n));
    let has = |all: &[u32], corners: usize| {
        all.iter().take(if corners_only { corners } else { all.len() }).all(|n| nodes.contains(n))
    };
    let mut whole: Vec<&Edge> = edges.values().filter(|edge| has(&edge.nodes, 2)).collect();
    whole.sort_unstable_by_key(|edge| ends(&edge.nodes));
    let region = |e: u32| regions.of[e as usize];
    let bounds = |edge: &Edge| edge.cells.len() == 1 || edge.cells.iter().any(|&e| region(e) != region(edge.cells[0]));
    let (outer, inner): (Vec<&Edge>, Vec<&Edge>) = whole.into_iter().partition(|edge| bounds(edge));
    let mut left = nodes.clone();
    outer.iter().flat_map(|edge| &edge.nodes).for_each(|n| _ = left.remove(n));
    let fills = |element: &super::model::Element| {
        has(&element.nodes, element.kind.corner_count()) && element.nodes.iter().any(|n| left.contains(n))
    };
    if !left.is_empty() && cells(model).any(|(_, element)| fills(element)) {
        return Err(None);
    }
    let more: Vec<&Edge> = inner.into_iter().filter(|edge| edge.nodes[..2].iter().any(|n| left.contains(n))).collect();
    more.iter().flat_map(|edge| &edge.nodes).for_each(|n| _ = left.remove(n));
    let facets: Vec<Vec<u32>> = outer.into_iter().chain(more).map(|edge| edge.nodes.clone()).collect();
    match (facets.is_empty(), left.is_empty()) {
        (true, _) => Ok(left.into_iter().map(|n| vec![n]).collect()),
        (false, true) => Ok(facets),
        (false, false) => Err(Some(left.len())),
    }
}
