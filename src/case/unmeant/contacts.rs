//! Soil that a structure or a wall comes to and that its contacts do not name, and walls along which supports hold the soil.

use crate::case::checked::{Case, Content, Touched, Touching};
use crate::case::layout::{Bounds, bounds, moves};
use crate::geometry::box_around;
use crate::mesh::quality::SAME;
use crate::mesh::{Group, Mesh};
use std::collections::BTreeSet;

/// What shows on the mesh.
pub fn on_mesh(case: &Case, mesh: &Mesh<2>) -> Vec<String> {
    let mut told = BTreeSet::new();
    let mut warnings = Vec::new();
    let rounding = bounds(mesh).map_or(0.0, |[low, high]| SAME * (high[0] - low[0]).max(high[1] - low[1]));
    for contact in &case.contacts {
        let (name, met, meeting) = match &contact.structure {
            Touching::Structure(region) => {
                let name = &case.regions[*region].name;
                (name, on_way(case, mesh, name, rounding), "lies on the way of the structure")
            }
            Touching::Wall(curve) => {
                let Some(group) = mesh.group(curve) else { continue };
                warnings.extend(held_along(case, mesh, curve, group));
                (curve, beside(case, mesh, group), "lies at the wall")
            }
        };
        let named = case.contacts.iter().filter(|other| other.structure == contact.structure);
        let named: BTreeSet<usize> = named.flat_map(|other| soils(&other.on)).collect();
        if named.is_empty() || !told.insert(name.clone()) {
            continue;
        }
        for region in met.difference(&named) {
            let soil = &case.regions[*region];
            let cure = match soil.content {
                Content::Fem { .. } => format!("add a contact with `against: {}`", soil.name),
                _ => "add it to the `soil` of the contact, or leave `soil` out, which means all".to_owned(),
            };
            warnings.push(format!(
                "warning: the soil `{}` {meeting} `{name}`, and no contact of `{name}` names it: it will pass through; {cure}",
                soil.name
            ));
        }
    }
    warnings
}

fn soils(on: &Touched) -> Vec<usize> {
    match on {
        Touched::Soil(soils) => soils.clone(),
        Touched::Body(body) => vec![*body],
    }
}

/// The region of soil that a cell belongs to, of material points or finite elements, as an index into those of the case.
fn soil_of(case: &Case, mesh: &Mesh<2>, c: usize) -> Option<usize> {
    let name = &mesh.regions[usize::from(mesh.cells.region[c])];
    let is_soil = |content: &Content| matches!(content, Content::Mpm { .. } | Content::Fem { .. });
    case.regions.iter().position(|r| r.name == *name && is_soil(&r.content))
}

/// The box (m) around a cell.
fn around(mesh: &Mesh<2>, c: usize) -> Option<Bounds> {
    box_around(mesh.cells.nodes(c).iter().map(|&n| mesh.nodes[n as usize]))
}

/// Whether boxes have an area or a part of a side in common; lengths up to `rounding` (m) count for none.
fn meet(a: &Bounds, b: &Bounds, rounding: f64) -> bool {
    let common = [0, 1].map(|d| a[1][d].min(b[1][d]) - a[0][d].max(b[0][d]));
    common.iter().all(|length| *length >= -rounding) && common.iter().any(|length| *length > rounding)
}

/// The soil that a structure lies in or at, or that the phases move it into, but for that which it shares nodes with.
fn on_way(case: &Case, mesh: &Mesh<2>, name: &str, rounding: f64) -> BTreeSet<usize> {
    let body = mesh.part(|c| mesh.regions[usize::from(mesh.cells.region[c])] == name);
    let Some(all) = bounds(&body) else { return BTreeSet::new() };
    let [low, high] = way(case, name, &body);
    let swept = |[from, to]: Bounds| [[0, 1].map(|d| from[d] + low[d]), [0, 1].map(|d| to[d] + high[d])];
    let cells: Vec<Bounds> = (0..body.cells.len()).filter_map(|c| around(&body, c)).map(swept).collect();
    let all = swept(all);
    let own: BTreeSet<u32> = body.cells.nodes.iter().copied().collect();
    let (mut met, mut joined) = (BTreeSet::new(), BTreeSet::new());
    for c in 0..mesh.cells.len() {
        if mesh.cells.nodes(c).iter().any(|n| own.contains(n)) {
            joined.extend(soil_of(case, mesh, c));
        }
        let Some(soil) = soil_of(case, mesh, c).filter(|soil| !met.contains(soil)) else { continue };
        let Some(cell) = around(mesh, c).filter(|cell| meet(cell, &all, rounding)) else { continue };
        if cells.iter().any(|of_body| meet(&cell, of_body, rounding)) {
            met.insert(soil);
        }
    }
    met.difference(&joined).copied().collect()
}

/// How far (m) the phases move a structure at least and at most in each direction, by what they prescribe.
fn way(case: &Case, name: &str, body: &Mesh<2>) -> Bounds {
    let (mut at, mut way) = ([0.0f64; 2], [[0.0f64; 2]; 2]);
    for phase in &case.phases {
        let mut ends = [0.0; 2];
        for moved in phase.prescribed.iter().filter(|p| p.component < 2 && moves(name, body, &p.curve)) {
            let d = moved.component;
            let kinks = moved.displacement.kinks().map(|time| time.min(phase.duration));
            for time in kinks.chain([phase.duration]) {
                let place = at[d] + moved.displacement.at(time);
                (way[0][d], way[1][d]) = (way[0][d].min(place), way[1][d].max(place));
            }
            ends[d] = moved.displacement.at(phase.duration);
        }
        at = [0, 1].map(|d| at[d] + ends[d]);
    }
    way
}

/// The soil with a side on a wall at the boundary of the grid. A wall within the grid may have other soil behind it.
fn beside(case: &Case, mesh: &Mesh<2>, wall: &Group) -> BTreeSet<usize> {
    let mut soils = BTreeSet::new();
    for (_, facet) in &wall.facets {
        let has = |c: &usize| facet[..2].iter().all(|n| mesh.cells.corners(*c).contains(n));
        let cells: Vec<usize> = (0..mesh.cells.len()).filter(has).collect();
        if let [cell] = cells[..] {
            soils.extend(soil_of(case, mesh, cell));
        }
    }
    soils
}

/// A warning where supports hold all nodes of a side of the wall across it.
fn held_along(case: &Case, mesh: &Mesh<2>, name: &str, wall: &Group) -> Option<String> {
    let held = |d: usize| -> BTreeSet<u32> {
        let supports = case.supports.iter().filter(|s| s.fixed[d] && s.curve != name);
        supports.filter_map(|s| mesh.group(&s.curve)).flat_map(|group| group.nodes.iter().copied()).collect()
    };
    let held = [held(0), held(1)];
    let is_held = |(_, facet): &&(_, Vec<u32>)| {
        let [a, b] = [0, 1].map(|i| mesh.nodes[facet[i] as usize]);
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        // Across a side along an axis, or one at a slant, which both components cross.
        let crossed = |d: usize| (b[1 - d] - a[1 - d]).abs() > 1e-9 * length;
        (0..2).all(|d| !crossed(d) || facet.iter().all(|n| held[d].contains(n)))
    };
    let place = wall.facets.iter().find(is_held).map(|(_, facet)| mesh.nodes[facet[0] as usize])?;
    Some(format!(
        "warning: supports hold the soil along the wall `{name}`, near {place:.3?} m: it neither slides nor parts there, and the contact does \
         nothing; take that curve out of `supports`"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{resolve, source::Source};
    use crate::mesh::builder::rectangle;
    use crate::mesh::shape::CellKind;
    use std::path::PathBuf;

    /// What is told of clay 1 m thick on 1 m of sand, 4 m wide, and a footing on it that goes down by `way` (m).
    fn told(contacts: &str, supports: &str, way: f64) -> Vec<String> {
        told_of("mpm", contacts, supports, way)
    }

    /// The same with soil of another kind.
    fn told_of(kind: &str, contacts: &str, supports: &str, way: f64) -> Vec<String> {
        let text = format!(
            "geometry: plane_strain\nmesh: {{geo: Cargo.toml}}\nregions: {{clay: {{kind: {kind}, material: soil}}, sand: {{kind: {kind}, material: soil}}, \
             footing: {{kind: structure, material: soil, rigid: true}}}}\n\
             materials: {{soil: {{model: linear_elastic, young: 1, poisson: 0, density: 1}}}}\ncontacts: {contacts}\n{supports}\n\
             phases: [{{name: push, analysis: quasi_static, duration: 1, step: {{initial: 1}}, prescribe: {{footing: {{ux: 0, uy: {{rate: -{way}}}}}}}}}]\n"
        );
        let source = Source::parse(PathBuf::from("case.yaml"), text, &[]).unwrap();
        let (case, issues) = resolve(&source);
        assert!(issues.is_empty(), "{issues:?}");
        let mut mesh = rectangle(CellKind::T6, 4.0, 2.0, 8, 4, 0.0, 0);
        for c in 0..mesh.cells.len() {
            mesh.cells.region[c] = u16::from(mesh.centre(c)[1] < 1.0);
        }
        let body = rectangle(CellKind::T6, 1.0, 0.5, 2, 1, 0.0, 0);
        let first = mesh.nodes.len() as u32;
        mesh.nodes.extend(body.nodes.iter().map(|x| [x[0] + 1.0, x[1] + 2.0]));
        for c in 0..body.cells.len() {
            let nodes: Vec<u32> = body.cells.nodes(c).iter().map(|n| n + first).collect();
            mesh.cells.push(CellKind::T6, 2, &nodes);
        }
        mesh.regions = ["clay", "sand", "footing"].map(String::from).to_vec();
        let floor = Group { name: "floor".into(), ..mesh.group("bottom").unwrap().clone() };
        mesh.groups.push(floor);
        on_mesh(&case.unwrap(), &mesh)
    }

    #[test]
    fn soil_on_the_way_of_a_structure_that_no_contact_names_is_told() {
        for contacts in ["[{structure: footing}]", "[{structure: footing, soil: [clay, sand]}]"] {
            assert!(told(contacts, "", 1.5).is_empty(), "{contacts}");
        }
        let clay = "[{structure: footing, soil: clay}]";
        assert!(told(clay, "", 0.5).is_empty());
        for way in [1.0, 1.5] {
            let [sand] = told(clay, "", way).try_into().unwrap();
            assert!(sand.contains("the soil `sand` lies on the way of the structure `footing`"), "{sand}");
        }
        assert!(told("[{structure: footing, soil: clay}, {structure: footing, soil: sand}]", "", 1.5).is_empty());
        // Finite elements that the footing stands on are named, or passed through.
        assert!(told_of("fem", "[{structure: footing, against: clay}]", "", 0.5).is_empty());
        let [clay] = told_of("fem", "[{structure: footing, against: sand}]", "", 0.5).try_into().unwrap();
        assert!(clay.contains("the soil `clay` lies on the way") && clay.contains("`against: clay`"), "{clay}");
    }

    #[test]
    fn soil_at_a_wall_and_supports_along_it_are_told() {
        let footing = "{structure: footing}";
        assert!(told(&format!("[{footing}, {{wall: bottom, soil: sand}}]"), "", 0.5).is_empty());
        let [clay] = told(&format!("[{footing}, {{wall: left, soil: sand}}]"), "", 0.5).try_into().unwrap();
        assert!(clay.contains("the soil `clay` lies at the wall `left`"), "{clay}");
        let bottom = format!("[{footing}, {{wall: bottom}}]");
        assert!(told(&bottom, "supports: {left: {ux: 0}}", 0.5).is_empty());
        // A support of a wall's own name is one of the wall.
        assert!(told(&bottom, "supports: {left: {ux: 0}, bottom: {uy: 0}}", 0.5).is_empty());
        let floor = |held: &str| {
            told(&format!("[{footing}, {{wall: floor}}]"), &format!("supports: {{bottom: {{{held}}}}}"), 0.5)
        };
        assert!(floor("ux: 0").is_empty());
        let [held] = floor("uy: 0").try_into().unwrap();
        assert!(held.contains("supports hold the soil along the wall `floor`"), "{held}");
    }
}
