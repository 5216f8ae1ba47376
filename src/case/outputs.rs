//! What a case asks to be written, in the terms of a run.

use super::changes::{carried, models};
use super::checked::{Case, Field, History};
use super::find::region_index;
use super::{pores, rigid, water};
use crate::error::Result;
use crate::io::provenance::Origin;
use crate::io::run_folder::RunFolder;
use crate::mesh::Mesh;
use crate::run::fields::Field as PointField;
use crate::run::{InternalVariable, Outputs, Quantity, Watch, WatchedOn};
use crate::step::Scene;
use std::collections::BTreeSet;

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
            Field::PlasticStrain => fields.push(PointField::Column("plastic_strain")),
            Field::DeformationGradient => fields.push(PointField::DeformationGradient),
            Field::PorePressure => fields.push(PointField::PorePressure(carried(case, mesh)?)),
            Field::Mass => fields.push(PointField::Column("mass")),
            Field::ShearStrength => fields.push(PointField::ShearStrength(models(case, mesh)?)),
            Field::InternalVariables => {
                fields.extend(InternalVariable::all(&models(case, mesh)?).into_iter().map(PointField::Internal));
            }
        }
    }
    let watch = |entry: &History| {
        let body = scene.bodies.iter().position(|body| rigid::body_of(mesh, body, &entry.on));
        let on = match (mesh.group(&entry.on), body) {
            (_, Some(body)) if rigid::is_region(mesh, &scene.bodies[body], &entry.on) => WatchedOn::Body(body),
            (Some(group), None) => WatchedOn::Nodes(group.nodes.clone()),
            (Some(group), Some(body)) => WatchedOn::Side(group.nodes.clone(), body),
            (None, _) => WatchedOn::Region(region_index(mesh, &entry.on)?),
        };
        Ok(Watch { name: entry.name.clone(), on, quantities: entry.quantities.clone() })
    };
    let watches = case.output.history.iter().map(watch).collect::<Result<Vec<_>>>()?;
    let watches = pores::pressures_at_corners(scene, watches);
    let until = case.phases.iter().map(|phase| phase.until.clone()).collect();
    let surface = if water::needs_surface(case) { Some(water::acting(case, mesh)?) } else { None };
    Ok(Outputs { folder: folder.clone(), ends: Vec::new(), warnings, fields, watches, until, surface, origin })
}

/// The nodes of the grid `mesh`, and of none of the finite elements, whose displacement the history has.
pub fn traced(case: &Case, mesh: &Mesh<2>, fem: Option<&Mesh<2>>) -> Vec<u32> {
    let moves = |entry: &&History| entry.quantities.iter().any(|q| matches!(q, Quantity::Displacement(_)));
    let groups = case.output.history.iter().filter(moves).filter_map(|entry| mesh.group(&entry.on));
    let watched: BTreeSet<u32> = groups.flat_map(|group| group.nodes.iter().copied()).collect();
    if watched.is_empty() {
        return Vec::new();
    }
    let of = |mesh: &Mesh<2>| -> BTreeSet<u32> { mesh.cells.nodes.iter().copied().collect() };
    let (grid, elements) = (of(mesh), fem.map(of).unwrap_or_default());
    watched.into_iter().filter(|n| grid.contains(n) && !elements.contains(n)).collect()
}
