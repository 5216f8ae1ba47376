//! Regions that meet though nothing connects them: neither nodes that they share nor a contact.

use super::checked::{Case, Contact, Content, Touched, Touching};
use super::layout::{Bounds, bounds, gap};
use crate::mesh::Mesh;
use crate::mesh::quality::{SAME, coincident};
use std::collections::{BTreeMap, BTreeSet};

/// Where a region lies, as its cells or its surface in the `.geo` say.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    pub name: String,
    /// The box around it (m).
    pub bounds: Bounds,
    /// Its nodes in the mesh or its curves in the `.geo`, by number, ascending: those that two regions share join them.
    pub parts: Vec<u32>,
}

/// The places of the regions of a mesh that have cells.
pub fn places(mesh: &Mesh<2>) -> Vec<Place> {
    let place = |(region, name): (usize, &String)| {
        let part = mesh.part(|c| usize::from(mesh.cells.region[c]) == region);
        let mut parts = part.cells.nodes.clone();
        parts.sort_unstable();
        parts.dedup();
        Some(Place { name: name.clone(), bounds: bounds(&part)?, parts })
    };
    mesh.regions.iter().enumerate().filter_map(place).collect()
}

/// A warning for each structure within the box around the grid that has no contact and shares nothing with soil: what it meets there does
/// not feel it.
pub fn structures(case: &Case, places: &[Place]) -> Vec<String> {
    let is_structure = |place: &&Place| case.content(&place.name).is_some_and(|content| content.is_structure());
    let is_grid = |place: &&Place| matches!(case.content(&place.name), Some(Content::Mpm { .. } | Content::Buffer));
    let join = |a: Bounds, b: Bounds| [[0, 1].map(|d| a[0][d].min(b[0][d])), [0, 1].map(|d| a[1][d].max(b[1][d]))];
    let grid = places.iter().filter(is_grid).map(|place| place.bounds).reduce(join);
    let Some(grid) = grid.filter(|_| case.regions.iter().any(|r| matches!(r.content, Content::Mpm { .. }))) else {
        return Vec::new();
    };
    let rounding = SAME * (grid[1][0] - grid[0][0]).max(grid[1][1] - grid[0][1]);
    let is_loose = |place: &&Place| {
        let named = case.contacts.iter().any(|contact| names(case, contact).contains(&Some(place.name.as_str())));
        let shares = |other: &Place| place.parts.iter().any(|part| other.parts.binary_search(part).is_ok());
        let joined = places.iter().filter(|other| !is_structure(other)).any(shares);
        let is_there = case.phases.iter().any(|phase| !phase.absent.contains(&place.name));
        !named && !joined && is_there && gap(&place.bounds, &grid) <= rounding
    };
    let warning = |Place { name, .. }: &Place| {
        format!(
            "warning: no contact names the structure `{name}`, which lies where soil is or may come: it passes through the soil; add \
             `{{structure: {name}, soil: …}}` to `contacts`, or let the two share curves in the .geo"
        )
    };
    places.iter().filter(is_structure).filter(is_loose).map(warning).collect()
}

/// The regions that a contact names as a body.
fn names<'a>(case: &'a Case, contact: &Contact) -> [Option<&'a str>; 2] {
    let name = |region: usize| case.regions[region].name.as_str();
    let structure = match contact.structure {
        Touching::Structure(region) => Some(name(region)),
        Touching::Wall(_) => None,
    };
    let other = match contact.on {
        Touched::Body(region) => Some(name(region)),
        Touched::Soil(_) => None,
    };
    [structure, other]
}

/// A note on each two regions, or each one, of which nodes coincide that should be the same node: those of soil, buffer and finite elements,
/// and those of bodies that no contact keeps apart. Along a wall nothing is to be joined.
pub fn nodes(case: &Case, mesh: &Mesh<2>) -> Vec<String> {
    let places = coincident(&mesh.nodes);
    let mut of: BTreeMap<u32, BTreeSet<u16>> = places.iter().flatten().map(|&n| (n, BTreeSet::new())).collect();
    for c in 0..mesh.cells.len() {
        for n in mesh.cells.nodes(c) {
            of.entry(*n).and_modify(|regions| _ = regions.insert(mesh.cells.region[c]));
        }
    }
    let walls = case.contacts.iter().filter_map(|contact| match &contact.structure {
        Touching::Wall(curve) => mesh.group(curve),
        Touching::Structure(_) => None,
    });
    walls.flat_map(|curve| &curve.nodes).for_each(|n| _ = of.remove(n));
    let regions_of = |n: &u32| of.get(n).into_iter().flatten().copied();
    let name = |region: u16| mesh.regions[usize::from(region)].as_str();
    let mut count: BTreeMap<[u16; 2], usize> = BTreeMap::new();
    for same in &places {
        let mut found = BTreeSet::new();
        for (i, a) in same.iter().enumerate() {
            let others = same[i + 1..].iter().flat_map(regions_of);
            let pairs = others.flat_map(|b| regions_of(a).map(move |a| [a.min(b), a.max(b)]));
            found.extend(pairs.filter(|pair| should_hold(case, pair.map(name))));
        }
        found.into_iter().for_each(|pair| *count.entry(pair).or_default() += 1);
    }
    let note = |([a, b], count): ([u16; 2], usize)| {
        let which = if a == b { "others of it".to_owned() } else { format!("those of region `{}`", name(b)) };
        format!(
            "note: {count} nodes of region `{}` lie on {which} without being joined; surfaces that should hold together must share their \
             curves (Coherence; in the .geo)",
            name(a)
        )
    };
    count.into_iter().map(note).collect()
}

/// Whether regions that meet are to hold together.
fn should_hold(case: &Case, [a, b]: [&str; 2]) -> bool {
    let is = |name: &str, kind: fn(&Content) -> bool| case.content(name).as_ref().is_some_and(kind);
    if a == b || ![a, b].iter().any(|name| is(name, Content::is_structure)) {
        return true;
    }
    let touch = case.contacts.iter().any(|contact| {
        let named = names(case, contact);
        named == [Some(a), Some(b)] || named == [Some(b), Some(a)]
    });
    let together = case.phases.iter().any(|phase| ![a, b].iter().any(|name| phase.absent.iter().any(|x| x == name)));
    is(a, Content::is_fem) && is(b, Content::is_fem) && !touch && together
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{resolve, source::Source};
    use crate::mesh::builder::rectangle;
    use crate::mesh::shape::CellKind;
    use std::path::PathBuf;

    /// Two regions, `left` and `right`, each with nodes of its own along the curve `middle` between them, and the notes on them.
    fn told(left: &str, right: &str, contacts: &str, deactivated: &str) -> Vec<String> {
        let text = format!(
            "geometry: plane_strain\nmesh: {{geo: Cargo.toml}}\nregions: {{left: {left}, right: {right}}}\n\
             materials: {{clay: {{model: linear_elastic, young: 1, poisson: 0, density: 1}}}}\ncontacts: {contacts}\n\
             phases: [{{name: a, analysis: quasi_static, duration: 1, step: {{initial: 1}}, deactivate: {deactivated}}}]\n"
        );
        let source = Source::parse(PathBuf::from("case.yaml"), text, &[]).unwrap();
        let (case, issues) = resolve(&source);
        assert!(issues.is_empty(), "{issues:?}");
        let mut mesh = rectangle(CellKind::T6, 1.0, 1.0, 2, 1, 0.0, 0);
        // Two corners and a mid-side.
        let shared: Vec<u32> = (0..mesh.nodes.len() as u32).filter(|&n| mesh.nodes[n as usize][0] == 0.5).collect();
        let first = mesh.cells.offset[2] as usize;
        for &old in &shared {
            let new = mesh.nodes.len() as u32;
            mesh.nodes.push(mesh.nodes[old as usize]);
            mesh.cells.nodes[first..].iter_mut().filter(|n| **n == old).for_each(|n| *n = new);
        }
        mesh.groups.truncate(1);
        (mesh.groups[0].name, mesh.groups[0].nodes) = ("middle".into(), shared);
        mesh.regions = vec!["left".into(), "right".into()];
        mesh.cells.region[2..].fill(1);
        nodes(&case.unwrap(), &mesh)
    }

    #[test]
    fn nodes_that_should_be_one_are_noted_and_no_others() {
        let [soil, elements, structure] = ["mpm", "fem", "structure"].map(|k| format!("{{kind: {k}, material: clay}}"));
        let (buffer, none) = ("{kind: buffer}", "[]");
        let [note] = told(&soil, buffer, none, none).try_into().unwrap();
        assert!(note.contains("note: 3 nodes of region `left` lie on those of region `right`"), "{note}");
        for (left, right, contacts, deactivated, notes) in [
            (&*soil, &*elements, none, none, 1),
            (&elements, &elements, none, none, 1),
            (&soil, &soil, "[{wall: middle, soil: left}]", none, 0),
            (&structure, &soil, "[{structure: left, soil: right}]", none, 0),
            (&structure, buffer, none, none, 0),
            (&structure, &elements, none, none, 1),
            (&structure, &elements, "[{structure: left, against: right}]", none, 0),
            (&structure, &structure, none, none, 1),
            (&structure, &structure, "[{structure: right, against: left}]", none, 0),
            (&structure, &structure, none, "[right]", 0),
        ] {
            let told = told(left, right, contacts, deactivated);
            assert_eq!(told.len(), notes, "{left} {right} {contacts} {deactivated}: {told:?}");
        }
    }
}
