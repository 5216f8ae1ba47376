//! What a picture of the scene shows: which colours regions have, and which curves something acts on.

use crate::case::Case;
use crate::case::checked::{Content, Touching};
use crate::draw::scene::{Acted, Scene, Shown};
use crate::draw::{RGBColor, colour};
use crate::mesh::Mesh;

/// Colours of soil by its material, light enough for the lines of the mesh.
const SOILS: [RGBColor; 5] = [
    RGBColor(222, 203, 164),
    RGBColor(196, 178, 146),
    RGBColor(214, 190, 178),
    RGBColor(190, 200, 160),
    RGBColor(230, 215, 190),
];
/// Structures, and cells that hold nothing.
const STRUCTURE: RGBColor = RGBColor(150, 160, 172);
const BUFFER: RGBColor = RGBColor(240, 246, 250);

/// The scene of a case on its mesh.
pub fn shown<'a>(case: &Case, mesh: &'a Mesh<2>) -> Scene<'a> {
    let regions = mesh.regions.iter().map(|name| region(case, name)).collect();
    let mut curves: Vec<Acted> = Vec::new();
    for (name, what) in acting(case) {
        let Some(group) = mesh.group(&name) else { continue };
        match curves.iter_mut().find(|curve| curve.group.name == name) {
            Some(curve) => curve.name = format!("{}, {what}", curve.name),
            None => curves.push(Acted { group, name: format!("{name}: {what}"), colour: colour(curves.len()) }),
        }
    }
    Scene { mesh, regions, curves }
}

fn region(case: &Case, name: &str) -> Shown {
    let content = case.content(name);
    let material = content.and_then(|content| content.material());
    let of = material.map_or_else(String::new, |material| format!(" of {}", case.materials[material].name));
    let soil = SOILS[material.unwrap_or(0) % SOILS.len()];
    let (colour, kind) = match content {
        Some(Content::Mpm { .. }) => (soil, "material points"),
        Some(Content::Fem { .. }) => (soil, "finite elements"),
        Some(Content::Structure { rigid: true, .. }) => (STRUCTURE, "a rigid structure"),
        Some(Content::Structure { .. }) => (STRUCTURE, "a structure"),
        Some(Content::Buffer) | None => (BUFFER, "buffer"),
    };
    let in_front = content.is_some_and(|content| content.is_structure());
    Shown { name: format!("{name}: {kind}{of}"), colour, in_front }
}

/// The curves that something acts on, with what that is, each thing once.
fn acting(case: &Case) -> Vec<(String, String)> {
    let mut acting: Vec<(String, String)> = Vec::new();
    let mut add = |name: &str, what: String| {
        if !acting.iter().any(|(other, told)| other == name && *told == what) {
            acting.push((name.to_owned(), what));
        }
    };
    for support in &case.supports {
        let fixed: Vec<&str> =
            ["ux", "uy"].into_iter().zip(support.fixed).filter(|(_, f)| *f).map(|(name, _)| name).collect();
        if !fixed.is_empty() {
            add(&support.curve, format!("{} = 0", fixed.join(" = ")));
        }
        if support.across {
            add(&support.curve, "un = 0".to_owned());
        }
        if support.absorbing {
            add(&support.curve, "absorbing".to_owned());
        }
        if support.springs.is_some() {
            add(&support.curve, "springs".to_owned());
        }
        if support.dashpots.is_some() {
            add(&support.curve, "dashpots".to_owned());
        }
        if let Some(other) = &support.tied {
            add(&support.curve, format!("tied to {other}"));
        }
        if support.outflow {
            add(&support.curve, "outflow".to_owned());
        }
        if support.drained {
            add(&support.curve, "drained".to_owned());
        }
    }
    for contact in &case.contacts {
        if let Touching::Wall(curve) = &contact.structure
            && !case.supports.iter().any(|support| support.across && support.curve == *curve)
        {
            add(curve, "a wall".to_owned());
        }
    }
    for phase in &case.phases {
        for prescribed in &phase.prescribed {
            add(&prescribed.curve, "moved".to_owned());
        }
        for inflow in &phase.inflows {
            add(&inflow.curve, "inflow".to_owned());
        }
        for traction in &phase.tractions {
            add(&traction.curve, "loaded".to_owned());
        }
    }
    acting
}
