//! The material points a case starts with: the regions filled, at rest or moving, with their stress.

use super::checked::{Case, Content, EarthPressure, Geometry};
use super::find::region_index;
use super::over_depth::check_over_depth;
use super::{at_rest, changes, layout};
use crate::error::{Error, Result};
use crate::material::{State, is_beyond_yield, odd_poisson, on_poisson, spatial};
use crate::mesh::Mesh;
use crate::points::Points;
use crate::seed::{QUADRATURE, RegionSeed, SECTIONS, seed};

/// Fills the regions of `case` in `mesh`, whose groups its names have been held against.
///
/// # Errors
/// Input: a number of points that the cells of a region have no rule for, cells at a negative radius.
pub fn points(case: &Case, mesh: &Mesh<2>) -> Result<Points<2>> {
    let filled = filled(case, mesh)?;
    layout::check(case, mesh)?;
    layout::check_seeding(case, mesh)?;
    for f in &filled {
        check_over_depth(mesh, f.seed.region, &case.regions[f.index], &case.materials[f.material])?;
    }
    let seeds: Vec<_> = filled.iter().map(|f| f.seed.clone()).collect();
    let mut points = seed(mesh, case.geometry == Geometry::Axisymmetric, &seeds)?;
    if let Some(k0) = &case.k0 {
        rest(case, mesh, &filled, k0, &mut points)?;
    }
    if !case.initial_pore_pressure.is_empty() {
        points.pore_pressure = vec![0.0; points.len()];
        for f in &filled {
            let Some((_, excess)) = case.initial_pore_pressure.iter().find(|(r, _)| *r == f.index) else { continue };
            for p in (0..points.len()).filter(|&p| points.region[p] == f.seed.region) {
                points.pore_pressure[p] = excess.at(points.position[p][1]);
            }
        }
    }
    if !case.initial_velocity.is_empty() {
        let mut velocity_of = vec![None; mesh.regions.len()];
        for f in &filled {
            velocity_of[f.seed.region as usize] = case.initial_velocity.iter().find(|v| v.region == f.index);
        }
        let places = points.position.iter().zip(&points.region);
        points.velocity = places.map(|(x, &r)| velocity_of[r as usize].map_or([0.0; 2], |v| v.at(x))).collect();
    }
    points.vary(&changes::random_strengths(case, mesh)?);
    check_random_strength(case, mesh, &points)?;
    Ok(points)
}

/// A line on each region whose initial stress is more than its material bears, and on each that has a Poisson's ratio which no soil has.
///
/// # Errors
/// Input: a region that the mesh lacks.
pub fn notes(case: &Case, mesh: &Mesh<2>, points: &Points<2>) -> Result<Vec<String>> {
    let mut notes = Vec::new();
    for Filled { index, material, seed } in filled(case, mesh)? {
        let material = &case.materials[material];
        let region = &case.regions[index].name;
        let of: Vec<usize> = (0..points.len()).filter(|&p| points.region[p] == seed.region).collect();
        // At rest the axes are the principal ones, and nothing has deformed yet.
        let stress = |p: usize| [0, 1, 2].map(|k| points.stress[p][k]);
        let height = |p: usize| points.seeded_height(p);
        let told = |found: &[usize]| {
            let [x, y] = points.origin[*found.first()?];
            Some(format!("{} of its {} points, such as that at [{x:.4}, {y:.4}] m", found.len(), of.len()))
        };
        let at_first = |p: usize| State { strength: points.strength_of(p), ..State::default() };
        let beyond = |&p: &usize| is_beyond_yield(material.model.as_ref(), height(p), &points.stress[p], &at_first(p));
        let beyond: Vec<usize> = of.iter().copied().filter(beyond).collect();
        if let Some(told) = told(&beyond) {
            notes.push(format!(
                "region `{region}`: the initial stress of {told}, is more than `{}` bears, and is reduced to it in the first step; another `k0` or \
                 more strength leaves them at rest",
                material.name
            ));
        }
        let poisson = |&p: &usize| odd_poisson(material.model.as_ref(), height(p), &stress(p));
        let strays: Vec<usize> = of.iter().copied().filter(|p| poisson(p).is_some()).collect();
        if let Some((told, ratio)) = told(&strays).zip(strays.first().and_then(poisson)) {
            notes.push(format!(
                "region `{region}`: Poisson's ratio of {told}, at the stress that they begin with {}",
                on_poisson(ratio)
            ));
        }
    }
    Ok(notes)
}

/// A region with points: its index in the case, its material and how it is seeded.
struct Filled {
    index: usize,
    material: usize,
    seed: RegionSeed,
}

fn filled(case: &Case, mesh: &Mesh<2>) -> Result<Vec<Filled>> {
    let mut filled = Vec::new();
    for (index, region) in case.regions.iter().enumerate() {
        let (material, points_per_cell) = match region.content {
            Content::Mpm { material, points_per_cell } => (material, points_per_cell as u32),
            Content::Structure { material, .. } if case.plates.iter().any(|plate| plate.region == index) => {
                (material, SECTIONS)
            }
            Content::Fem { material } | Content::Structure { material, .. } => (material, QUADRATURE),
            Content::Buffer => continue,
        };
        let place = mesh.regions.iter().position(|name| *name == region.name).ok_or_else(|| {
            let place = format!("region {}", region.name);
            Error::input(place, "the mesh has no physical surface of this name", "mesh the case again: `mpm mesh`")
        })?;
        let density = case.materials[material].density;
        let seed = RegionSeed { region: place as u16, points_per_cell, density };
        filled.push(Filled { index, material, seed });
    }
    Ok(filled)
}

/// Checks the materials whose strength varies at random, with the strength of each point: conditions on two parameters may not hold everywhere.
fn check_random_strength(case: &Case, mesh: &Mesh<2>, points: &Points<2>) -> Result<()> {
    for (region, material) in changes::used(case) {
        let (Some(field), index) = (&material.random_strength, region_index(mesh, &region.name)?) else { continue };
        for p in (0..points.len()).filter(|&p| points.region[p] == index) {
            let ([x, y], strength) = (points.origin[p], field.factor(&points.origin[p]));
            if !strength.is_normal() {
                return Err(Error::input(
                    format!("material `{}`", material.name),
                    format!("its random strength is {strength} of the mean at [{x:.4}, {y:.4}] m"),
                    "check the coefficient of variation and the scales of `random_strength`",
                ));
            }
            material.model.reduced(1.0 / strength).check(points.seeded_height(p)).map_err(|e| Error {
                place: format!(
                    "material `{}` in region `{}` at [{x:.4}, {y:.4}] m, where its random strength is {strength:.3} of the mean: {}",
                    material.name, region.name, e.place
                ),
                ..e
            })?;
        }
    }
    Ok(())
}

/// Gives the points the stress of soil at rest, with the elastic strain that carries it; their shape stays
/// the one they are seeded with, so that Kirchhoff and Cauchy stress are the same.
fn rest(case: &Case, mesh: &Mesh<2>, filled: &[Filled], k0: &[EarthPressure], points: &mut Points<2>) -> Result<()> {
    points.stress = at_rest::stress(case, mesh, k0, points)?;
    let is_there = |f: &&Filled| {
        let region = &case.regions[f.index];
        !region.content.is_structure() && !case.comes_later(&region.name)
    };
    for Filled { material, seed, .. } in filled.iter().filter(is_there) {
        let model = &*case.materials[*material].model;
        for p in (0..points.len()).filter(|&p| points.region[p] == seed.region) {
            points.elastic[p] = spatial::elastic_from_stress(model, points.seeded_height(p), &points.stress[p]);
            if !points.elastic[p].iter().all(|b| b.is_finite()) || points.elastic[p][..3].iter().any(|b| *b <= 0.0) {
                let [x, y] = points.position[p];
                return Err(Error::input(
                    "initial_stress.k0",
                    format!(
                        "with k0 = {:e} the soil at [{x:.4}, {y:.4}] m begins with {:.3e} kPa sideways, more than `{}` \
                         can be strained to",
                        points.stress[p][0] / points.stress[p][1],
                        -points.stress[p][0],
                        case.materials[*material].name
                    ),
                    "give the k0 of soil, mostly 0.3 to 3, and check `young` and the density",
                ));
            }
        }
    }
    Ok(())
}
