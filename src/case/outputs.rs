//! What a case asks to be written, in the terms of a run.

use super::changes::{carried, models};
use super::checked::{Case, Field, Geometry, History, On};
use super::find::region_index;
use super::structure::list;
use super::{pores, rigid, water};
use crate::error::{Error, Result};
use crate::io::provenance::Origin;
use crate::io::run_folder::RunFolder;
use crate::mesh::{Group, Mesh};
use crate::run::fields::Field as PointField;
use crate::run::{InternalVariable, Outputs, Quantity, Side, Watch, WatchedOn};
use crate::step::Scene;
use std::collections::{BTreeMap, BTreeSet};

/// The outputs of a case, and the `warnings` that its run begins with.
///
/// # Errors
/// Input: a region that the mesh has not.
pub fn outputs(
    case: &Case,
    scene: &Scene<2>,
    folder: &RunFolder,
    origin: Origin,
    warnings: Vec<String>,
) -> Result<Outputs> {
    let mesh = &scene.mesh;
    let mut fields = Vec::new();
    let mut with_stress = false;
    for field in &case.output.fields {
        match field {
            Field::Displacement => fields.push(PointField::Displacement),
            Field::Velocity => fields.push(PointField::Velocity),
            // Invariants come with the stress.
            Field::Stress | Field::MeanStress | Field::DeviatoricStress => {
                if !std::mem::replace(&mut with_stress, true) {
                    fields.push(PointField::Column("stress"));
                }
            }
            Field::Strain => fields.push(PointField::Strain),
            Field::PlasticStrain => fields.push(PointField::Column("plastic_strain")),
            Field::DeformationGradient => fields.push(PointField::DeformationGradient),
            Field::PorePressure => fields.push(PointField::PorePressure(carried(case, mesh)?)),
            Field::Mass => fields.push(PointField::Column("mass")),
            Field::ShearStrength => fields.push(PointField::ShearStrength(models(case, mesh)?)),
            Field::PlasticPoints => fields.push(PointField::PlasticPoints(models(case, mesh)?)),
            Field::InternalVariables => {
                fields.extend(InternalVariable::all(&models(case, mesh)?).into_iter().map(PointField::Internal));
            }
        }
    }
    let watches = watches(case, scene)?;
    let until = case.phases.iter().map(|phase| phase.until.clone()).collect();
    let surface = if water::needs_surface(case) { Some(water::acting(case, mesh)?) } else { None };
    Ok(Outputs { folder: folder.clone(), ends: Vec::new(), warnings, fields, watches, until, surface, origin })
}

/// What the history of a case is of.
///
/// # Errors
/// Input: a region that the mesh has not; a curve with contact forces that is not one of a structure in contact.
pub fn watches(case: &Case, scene: &Scene<2>) -> Result<Vec<Watch>> {
    let mesh = &scene.mesh;
    let watch = |entry: &History| {
        let on = match &entry.on {
            On::Named(name) => named(case, mesh, scene, name)?,
            On::Place(place) => WatchedOn::Soil(place.clone()),
        };
        let is_named = |name: &String| entry.named() == Some(name);
        let leaves = scene.outflows.iter().position(|outflow| is_named(&outflow.name));
        let enters = scene.inflows.iter().position(|inflow| is_named(&inflow.name));
        let touches = entry.quantities.iter().any(|q| matches!(q, Quantity::Contact(_)));
        let curve = entry.named().and_then(|name| mesh.group(name));
        let on = match curve.filter(|_| touches && !matches!(on, WatchedOn::Body(_))) {
            Some(curve) => WatchedOn::Touched(Box::new(on), side(case, mesh, scene, curve)?),
            None => on,
        };
        let on = match (leaves, enters) {
            (Some(number), _) => WatchedOn::Outflow(Box::new(on), number),
            (None, Some(number)) => WatchedOn::Inflow(Box::new(on), number),
            (None, None) => on,
        };
        Ok(Watch { name: entry.name.clone(), on, quantities: entry.quantities.clone() })
    };
    let watches = case.output.history.iter().map(watch).collect::<Result<Vec<_>>>()?;
    Ok(pores::pressures_at_corners(scene, watches))
}

/// A curve as a part of the boundary of a structure that touches something.
///
/// # Errors
/// Input: a curve of no such structure.
fn side(case: &Case, mesh: &Mesh<2>, scene: &Scene<2>, curve: &Group) -> Result<Side> {
    let of_curve = |region: &u16| {
        let is_of = |n: &u32| {
            let cells = |of: &Mesh<2>| {
                (0..of.cells.len()).any(|c| of.cells.region[c] == *region && of.cells.nodes(c).contains(n))
            };
            scene.fem.as_ref().is_some_and(|fem| cells(&fem.mesh))
        };
        curve.nodes.iter().all(is_of)
    };
    let mut structures = scene.interfaces.iter().map(|interface| interface.sides().structure);
    let region = structures.find(of_curve).ok_or_else(|| {
        let names: Vec<&str> = scene
            .interfaces
            .iter()
            .map(|interface| mesh.regions[interface.sides().structure as usize].as_str())
            .collect();
        Error::input(
            format!("output.history: `{}`", curve.name),
            "the curve is not on the boundary of a structure that a contact names under `structure`",
            format!("name a curve of {}, or the structure as a whole", list(&names)),
        )
    })?;
    let facets: Vec<Vec<u32>> = curve.facets.iter().map(|(_, nodes)| nodes.clone()).collect();
    let ends = |facet: &[u32]| [facet[0].min(facet[1]), facet[0].max(facet[1])];
    let of_curve: BTreeSet<[u32; 2]> = facets.iter().map(|facet| ends(facet)).collect();
    // Facets of two cells of the structure are within it.
    let mut rest: BTreeMap<[u32; 2], Option<Vec<u32>>> = BTreeMap::new();
    let cells = scene.fem.iter().map(|fem| &fem.mesh.cells);
    for (cells, c) in cells.flat_map(|cells| (0..cells.len()).map(move |c| (cells, c))) {
        for facet in cells.kind[c].facets().1.iter().filter(|_| cells.region[c] == region) {
            let nodes: Vec<u32> = facet.iter().map(|&i| cells.nodes(c)[i]).collect();
            rest.entry(ends(&nodes)).and_modify(|facet| *facet = None).or_insert(Some(nodes));
        }
    }
    rest.retain(|ends, _| !of_curve.contains(ends));
    let rest = rest.into_values().flatten().collect();
    Ok(Side { region, facets, rest, turned: case.geometry == Geometry::Axisymmetric })
}

/// What is watched of a curve, a point, a region or a rigid structure.
fn named(case: &Case, mesh: &Mesh<2>, scene: &Scene<2>, name: &str) -> Result<WatchedOn> {
    let body = scene.bodies.iter().position(|body| rigid::body_of(mesh, body, name));
    Ok(match (mesh.group(name), body) {
        (_, Some(body)) if rigid::is_region(mesh, &scene.bodies[body], name) => WatchedOn::Body(body),
        (Some(group), None) => WatchedOn::Nodes(group.nodes.clone()),
        (Some(group), Some(body)) => WatchedOn::Side(group.nodes.clone(), body),
        (None, _) if case.plate(name).is_some() => {
            WatchedOn::Plate(region_index(mesh, name)?, case.geometry == Geometry::Axisymmetric)
        }
        (None, _) => match case.bars.iter().position(|bar| bar.name == name) {
            Some(bar) => WatchedOn::Bar(bar),
            None => WatchedOn::Region(region_index(mesh, name)?),
        },
    })
}

/// The nodes of the grid `mesh`, and of none of the finite elements, whose displacement the history has.
pub fn traced(case: &Case, mesh: &Mesh<2>, fem: Option<&Mesh<2>>) -> Vec<u32> {
    let moves = |entry: &&History| entry.quantities.iter().any(|q| matches!(q, Quantity::Displacement(_)));
    let groups = case.output.history.iter().filter(moves).filter_map(|entry| mesh.group(entry.named()?));
    let watched: BTreeSet<u32> = groups.flat_map(|group| group.nodes.iter().copied()).collect();
    if watched.is_empty() {
        return Vec::new();
    }
    let of = |mesh: &Mesh<2>| -> BTreeSet<u32> { mesh.cells.nodes.iter().copied().collect() };
    let (grid, elements) = (of(mesh), fem.map(of).unwrap_or_default());
    watched.into_iter().filter(|n| grid.contains(n) && !elements.contains(n)).collect()
}
