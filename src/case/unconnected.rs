//! Regions that meet though nothing connects them: neither nodes that they share nor a contact.

use super::checked::{Case, Contact, Content, Touched, Touching};
use super::layout::{Bounds, bounds, gap};
use crate::mesh::Mesh;
use crate::mesh::quality::SAME;

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
    let content = |place: &Place| case.regions.iter().find(|region| region.name == place.name).map(|r| &r.content);
    let is_structure = |place: &&Place| content(place).is_some_and(Content::is_structure);
    let is_grid = |place: &&Place| matches!(content(place), Some(Content::Mpm { .. } | Content::Buffer));
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
