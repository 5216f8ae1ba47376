//! Curves and points of a mesh: from surfaces, sets of line elements and sets of nodes.

use super::model::{Element, Model, called, count};
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

/// Edges by their ends, ascending.
type Edges = HashMap<[u32; 2], Edge>;

struct Edge {
    nodes: Vec<u32>,
    /// The cells that have it.
    cells: Vec<u32>,
}

/// What meets where.
struct Meeting<'a> {
    model: &'a Model,
    regions: &'a Regions,
    edges: Edges,
    /// The cells at each node.
    cells: HashMap<u32, Vec<u32>>,
    /// The nodes in the middle of edges.
    within: HashSet<u32>,
}

/// All groups, and notes on sets of nodes that become none.
pub fn of(model: &Model, regions: &Regions) -> (Vec<Group>, Vec<String>) {
    let meeting = Meeting::of(model, regions);
    let edges = &meeting.edges;
    let mut found: BTreeMap<String, Group> = BTreeMap::new();
    let times = count(model.surfaces.iter().map(|surface| surface.name.to_lowercase()));
    for surface in &model.surfaces {
        let name = called(model, surface.instance, &surface.name, times[&surface.name.to_lowercase()] > 1);
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
    let times = count(model.element_sets.keys().map(|(_, name)| name.clone()));
    for ((instance, key), set) in &model.element_sets {
        let lines = set.members.iter().map(|&e| &model.elements[e as usize]).filter(|element| !element.is_cell());
        let facets = lines.map(|line| edge_of(edges, &line.nodes)).collect();
        keep(&mut found, Group { name: called(model, *instance, &set.name, times[key] > 1), facets });
    }
    let of_regions: HashSet<&String> = regions.names.iter().collect();
    let times = count(model.node_sets.keys().map(|(_, name)| name.clone()));
    let mut notes = Vec::new();
    for ((instance, key), set) in model.node_sets.iter().filter(|(_, set)| !set.internal) {
        let name = called(model, *instance, &set.name, times[key] > 1);
        let nodes: BTreeSet<u32> = set.members.iter().copied().filter(|n| meeting.cells.contains_key(n)).collect();
        // Programs write the nodes of regions and of surfaces, too.
        if of_regions.contains(&name) {
            continue;
        }
        if let Some(group) = found.get(&name.to_lowercase()) {
            let of = |some: usize| {
                group.facets.iter().flat_map(move |facet| facet.iter().take(some).copied()).collect::<BTreeSet<_>>()
            };
            if nodes != of(3) && nodes != of(2) {
                notes.push(format!("note: the set of nodes `{name}` is left out: a curve has the same name and other nodes; rename one of them"));
            }
            continue;
        }
        match meeting.along(&nodes) {
            Ok(facets) => keep(&mut found, Group { name, facets }),
            Err(Some(stray)) => notes.push(format!(
                "note: the set of nodes `{name}` is left out: {stray} of its {} nodes lie on no edge whose other nodes are in it, beside edges \
                 that are; make sets of whole edges and of single nodes",
                nodes.len()
            )),
            Err(None) => {}
        }
    }
    (found.into_values().collect(), notes)
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

fn cells(model: &Model) -> impl Iterator<Item = (usize, &Element)> {
    model.elements.iter().enumerate().filter(|(_, element)| element.is_cell())
}

fn ends(nodes: &[u32]) -> [u32; 2] {
    [nodes[0].min(nodes[1]), nodes[0].max(nodes[1])]
}

/// The nodes of a line in the order of the edge of a cell that it is, ends first: programs number the middle one second or last.
fn edge_of(edges: &Edges, line: &[u32]) -> Vec<u32> {
    let is_same = |edge: &&Edge| line.iter().all(|n| edge.nodes.contains(n));
    let ends = [[0, 1], [0, line.len() - 1]].map(|[a, b]| ends(&[line[a], line[b]]));
    let edge = ends.iter().filter_map(|ends| edges.get(ends)).find(is_same);
    edge.map_or_else(|| line.to_vec(), |edge| edge.nodes.clone())
}

impl<'a> Meeting<'a> {
    fn of(model: &'a Model, regions: &'a Regions) -> Self {
        let (mut edges, mut at) = (Edges::new(), HashMap::<u32, Vec<u32>>::new());
        for (e, element) in cells(model) {
            for facet in element.kind.facets().1 {
                let nodes: Vec<u32> = facet.iter().map(|&n| element.nodes[n]).collect();
                edges.entry(ends(&nodes)).or_insert_with(|| Edge { nodes, cells: Vec::new() }).cells.push(e as u32);
            }
            element.nodes.iter().for_each(|&n| at.entry(n).or_default().push(e as u32));
        }
        let within = edges.values().flat_map(|edge| edge.nodes[2..].iter().copied()).collect();
        Self { model, regions, edges, cells: at, within }
    }

    /// The edges whose nodes are all in a set, those on boundaries of regions first, and inner ones only where nodes of the set are on no
    /// other; or the single nodes of a set without edges. A set without any node within an edge stands for the edges between its nodes.
    ///
    /// # Errors
    /// How many nodes are left over beside the edges; none where the set is an area.
    fn along(&self, nodes: &BTreeSet<u32>) -> Result<Vec<Vec<u32>>, Option<usize>> {
        let corners_only = !nodes.iter().any(|n| self.within.contains(n));
        let has = |all: &[u32], corners: usize| {
            all.iter().take(if corners_only { corners } else { all.len() }).all(|n| nodes.contains(n))
        };
        let near: BTreeSet<u32> = nodes.iter().flat_map(|n| &self.cells[n]).copied().collect();
        let near: Vec<&Element> = near.into_iter().map(|e| &self.model.elements[e as usize]).collect();
        let of_cell = |element: &&Element| {
            let facets = element.kind.facets().1.iter();
            facets.map(|facet| ends(&[element.nodes[facet[0]], element.nodes[facet[1]]])).collect::<Vec<_>>()
        };
        let keys: BTreeSet<[u32; 2]> = near.iter().flat_map(of_cell).collect();
        let whole = keys.iter().map(|key| &self.edges[key]).filter(|edge| has(&edge.nodes, 2));
        let region = |e: u32| self.regions.of[e as usize];
        let bounds =
            |edge: &Edge| edge.cells.len() == 1 || edge.cells.iter().any(|&e| region(e) != region(edge.cells[0]));
        let (outer, inner): (Vec<&Edge>, Vec<&Edge>) = whole.partition(|edge| bounds(edge));
        let mut left = nodes.clone();
        outer.iter().flat_map(|edge| &edge.nodes).for_each(|n| _ = left.remove(n));
        let fills = |element: &&Element| {
            has(&element.nodes, element.kind.corner_count()) && element.nodes.iter().any(|n| left.contains(n))
        };
        if near.iter().any(fills) {
            return Err(None);
        }
        let more: Vec<&Edge> =
            inner.into_iter().filter(|edge| edge.nodes[..2].iter().any(|n| left.contains(n))).collect();
        more.iter().flat_map(|edge| &edge.nodes).for_each(|n| _ = left.remove(n));
        let facets: Vec<Vec<u32>> = outer.into_iter().chain(more).map(|edge| edge.nodes.clone()).collect();
        match (facets.is_empty(), left.is_empty()) {
            (true, _) => Ok(left.into_iter().map(|n| vec![n]).collect()),
            (false, true) => Ok(facets),
            (false, false) => Err(Some(left.len())),
        }
    }
}
