//! Curves that waves leave through: dashpots in phases with inertia, supports in others.

use super::checked::{Case, Content, Phase};
use super::find::{filled, group, region_index};
use crate::error::{Error, Result};
use crate::kinematics::Kinematics;
use crate::mesh::quality::SAME;
use crate::mesh::{Group, Mesh, height};
use crate::step::Fixed;
use crate::term::{Absorbing, Course, samples};
use std::collections::BTreeMap;

/// The curves that absorb, with what of their displacement is held in all phases.
fn curves(case: &Case) -> impl Iterator<Item = (&str, [bool; 2])> {
    case.supports.iter().filter(|support| support.absorbing).map(|support| (support.curve.as_str(), support.fixed))
}

/// The components in which curves are free in phases with inertia, and held in others.
///
/// # Errors
/// Input: a curve that the mesh lacks.
pub fn components(case: &Case, mesh: &Mesh<2>) -> Result<Vec<Fixed>> {
    let mut fixed = Vec::new();
    for (name, held) in curves(case) {
        let nodes = &group(mesh, name)?.nodes;
        fixed.extend((0..2).filter(|&d| !held[d]).map(|component| Fixed { nodes: nodes.clone(), component }));
    }
    Ok(fixed)
}

/// What of them is held in a phase.
///
/// # Errors
/// As [`components`].
pub fn held(case: &Case, mesh: &Mesh<2>, phase: &Phase) -> Result<Vec<Fixed>> {
    if phase.analysis.has_inertia() { Ok(Vec::new()) } else { components(case, mesh) }
}

/// The dashpots of all curves; `None` without any.
///
/// # Errors
/// Input: a curve that is inclined, or does not bound soil.
pub fn term<K: Kinematics<2>>(case: &Case, meshes: [&Mesh<2>; 2]) -> Result<Option<Absorbing<2>>> {
    let mut dampers: BTreeMap<u32, [f64; 2]> = BTreeMap::new();
    for (name, held) in curves(case) {
        let (curve, mut acts) = (group(meshes[0], name)?, false);
        for facet in &curve.facets {
            let resists = impedance(case, meshes, name, facet)?;
            if resists == [0.0; 2] {
                continue;
            }
            acts = true;
            let single = Group { facets: vec![facet.clone()], ..curve.clone() };
            for (n, share) in samples::<K, 2>(meshes[0], &single, &Course::Uniform).into_iter().flat_map(|s| s.shares) {
                let damper = dampers.entry(n).or_default();
                (0..2).filter(|&d| !held[d]).for_each(|d| damper[d] += share * resists[d]);
            }
        }
        if !acts {
            let problem = "no soil is beside the curve";
            return Err(Error::input(
                format!("supports.{name}.absorbing"),
                problem,
                "take it out, or name a boundary of soil",
            ));
        }
    }
    let phases = case.phases.iter().map(|phase| phase.analysis.has_inertia()).collect();
    Ok((!dampers.is_empty()).then(|| Absorbing::new(dampers.into_iter().collect(), phases)))
}

/// What the soil beside a facet resists a velocity (kPa s/m) by component: ρ c_p across it, ρ c_s along it.
fn impedance(
    case: &Case,
    meshes: [&Mesh<2>; 2],
    curve: &str,
    (_, nodes): &(crate::mesh::shape::CellKind, Vec<u32>),
) -> Result<[f64; 2]> {
    let place = || format!("supports.{curve}.absorbing");
    let [a, b] = [nodes[0], nodes[1]].map(|n| meshes[0].nodes[n as usize]);
    let way = [(b[0] - a[0]).abs(), (b[1] - a[1]).abs()];
    let Some(across) = (0..2).find(|&d| way[d] <= SAME * way[1 - d]) else {
        let problem = "the curve is inclined, and dashpots act across and along level and vertical curves";
        return Err(Error::input(place(), problem, "draw a level or vertical boundary there"));
    };
    let has = |mesh: &Mesh<2>, c: usize| {
        let of = mesh.cells.nodes(c);
        of.contains(&nodes[0]) && of.contains(&nodes[1])
    };
    let beside = |mesh: &Mesh<2>| -> Vec<u16> {
        (0..mesh.cells.len()).filter(|&c| has(mesh, c)).map(|c| mesh.cells.region[c]).collect()
    };
    let regions = if std::ptr::eq(meshes[0], meshes[1]) { beside(meshes[0]) } else { meshes.map(beside).concat() };
    let is_empty = |r: u16| case.content(&meshes[0].regions[usize::from(r)]) == Some(Content::Buffer);
    if regions.len() == 1 && is_empty(regions[0]) {
        // The side of the air above soil.
        return Ok([0.0; 2]);
    }
    let material = filled(case).find(|(region, _)| {
        let number = region_index(meshes[0], &region.name).ok();
        matches!(region.content, Content::Mpm { .. } | Content::Fem { .. }) && number.is_some_and(|n| regions == [n])
    });
    let Some((_, material)) = material else {
        let problem = format!("at [{:.3}, {:.3}] m it is not the boundary of soil", a[0], a[1]);
        return Err(Error::input(
            place(),
            problem,
            "let only curves absorb that have soil on one side and nothing on the other",
        ));
    };
    let y = f64::midpoint(height(&a), height(&b));
    let (density, moduli) = (material.density.at(y), material.model.elasticity().at(y));
    let mut resists = [(density * moduli.shear).sqrt(); 2];
    resists[across] = (density * (moduli.lambda + 2.0 * moduli.shear)).sqrt();
    Ok(resists)
}
