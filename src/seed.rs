//! Material points in the cells of a mesh; the stress they start with is that of [`k0_stress`].
//!
//! Triangles take 4, 9, 16 or 25 equal points (centroids of the k × k sub-triangles) or the 3, 6, 7 or 12
//! points of a quadrature rule; quadrilaterals k × k points at the centres of equal parametric boxes. In space,
//! tetrahedra take 8 or 64 equal points or the 4, 15 or 24 of a quadrature rule, hexahedra k × k × k points. A
//! point's volume is that of its part of the cell, integrated exactly also in curved cells and, in
//! axisymmetry, with `2πr`: the volumes of a cell sum to its own.

mod parts;
mod rest;
#[cfg(test)]
mod tests;

pub use parts::{QUADRATURE, SECTIONS};
pub use rest::{RegionWeight, k0_stress};

use std::f64::consts::TAU;

use crate::error::{Error, Result};
use crate::material::Profile;
use crate::mesh::shape::{self, CellKind, MAX_NODES};
use crate::mesh::{Mesh, height};
use crate::points::Points;
use crate::tensor::{IDENTITY, Tensor};
use parts::{Part, exact_rule, parts, possible};

/// How one region is filled with points.
#[derive(Clone, Debug, PartialEq)]
pub struct RegionSeed {
    /// Index into [`Mesh::regions`].
    pub region: u16,
    /// Or [`QUADRATURE`], or [`SECTIONS`].
    pub points_per_cell: u32,
    /// Density (t/m³) by the height.
    pub density: Profile,
}

/// Fills the cells of `regions` with points at rest, undeformed and free of stress, in the order of the cells.
///
/// Masses are density at the point × volume, in t; volumes per metre in plane strain and per full turn (2π)
/// in axisymmetry, where `x` is the radius. Velocities and accelerations are left empty.
///
/// # Errors
/// Input: a number of points that the region's cells have no rule for; in axisymmetry, a cell at negative
/// radius; an inverted cell.
pub fn seed<const D: usize>(mesh: &Mesh<D>, axisymmetric: bool, regions: &[RegionSeed]) -> Result<Points<D>> {
    let mut points = Points::default();
    let mut x = Vec::new();
    // Rules by kind and number of points, each made once.
    let mut rules: Vec<(CellKind, u32, Vec<Part>)> = Vec::new();
    for c in 0..mesh.cells.len() {
        let kind = mesh.cells.kind[c];
        let Some(wanted) = regions.iter().find(|r| r.region == mesh.cells.region[c]) else { continue };
        let count = wanted.points_per_cell;
        let known = rules.iter().position(|(k, n, _)| (*k, *n) == (kind, count));
        let known = match known {
            Some(known) => known,
            None => {
                let parts = parts(kind, count).ok_or_else(|| no_rule(mesh, wanted, kind))?;
                rules.push((kind, count, parts));
                rules.len() - 1
            }
        };
        mesh.cell_coordinates(c, &mut x);
        fill(&mut points, kind, &x, &rules[known].2, axisymmetric).map_err(|problem| {
            let region = &mesh.regions[wanted.region as usize];
            let place = format!("cell {c} of region {region}, at {:?}", x[0]);
            Error::input(place, problem, "mend the geometry, or refine the mesh where it is curved")
        })?;
        let new = points.mass.len()..points.len();
        for p in new {
            let density = wanted.density.at(height(&points.position[p]));
            points.mass.push(density * points.initial_volume[p]);
            points.region.push(wanted.region);
            points.cell.push(c as u32);
        }
    }
    let count = points.len();
    points.origin = points.position.clone();
    points.deformation = vec![Tensor::identity(); count];
    points.elastic = vec![IDENTITY; count];
    points.stress = vec![[0.0; 6]; count];
    points.plastic_strain = vec![0.0; count];
    Ok(points)
}

/// A point that a cell is filled with.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Seed<const D: usize> {
    /// Where it is in the cell, parametrically, and in space (m).
    pub xi: [f64; 3],
    pub position: [f64; D],
    /// Volume (m³) of its part of the cell, by the measure of [`seed`].
    pub volume: f64,
}

/// The points of cell `c`; `None` where there is no rule for their number, or the cell has no volume.
pub fn of_cell<const D: usize>(mesh: &Mesh<D>, c: usize, count: u32, axisymmetric: bool) -> Option<Vec<Seed<D>>> {
    let (mut points, mut x) = (Points::default(), Vec::new());
    let parts = parts(mesh.cells.kind[c], count)?;
    mesh.cell_coordinates(c, &mut x);
    fill(&mut points, mesh.cells.kind[c], &x, &parts, axisymmetric).ok()?;
    let places = parts.iter().zip(&points.position).zip(&points.initial_volume);
    Some(places.map(|((part, &position), &volume)| Seed { xi: part.point, position, volume }).collect())
}

/// Appends positions and volumes of the points of one cell.
fn fill<const D: usize>(
    points: &mut Points<D>,
    kind: CellKind,
    x: &[[f64; D]],
    parts: &[Part],
    axisymmetric: bool,
) -> std::result::Result<(), &'static str> {
    let measure = |xi: &[f64; 3]| {
        let (y, determinant) = place(kind, x, xi);
        (determinant * if axisymmetric { TAU * y[0] } else { 1.0 }, determinant)
    };
    let first = points.initial_volume.len();
    for part in parts {
        let mut volume = 0.0;
        for (xi, weight) in &part.quadrature {
            let (measure, determinant) = measure(xi);
            if determinant.is_nan() || determinant <= 0.0 {
                return Err("the cell is inverted");
            }
            volume += weight * measure;
        }
        if volume <= 0.0 {
            return Err("the cell lies at negative radius");
        }
        points.position.push(place(kind, x, &part.point).0);
        points.initial_volume.push(volume);
    }
    // The points of a quadrature rule represent no parts: in a curved cell, or with 2πr, their sum is exact
    // only to the rule's degree.
    let exact: f64 = exact_rule(kind).iter().map(|(xi, weight)| weight * measure(xi).0).sum();
    let sum: f64 = points.initial_volume[first..].iter().sum();
    for volume in &mut points.initial_volume[first..] {
        *volume *= exact / sum;
    }
    Ok(())
}

/// Position and Jacobian determinant at `xi`.
fn place<const D: usize>(kind: CellKind, x: &[[f64; D]], xi: &[f64; 3]) -> ([f64; D], f64) {
    let (mut n, mut grad) = ([0.0; MAX_NODES], [[0.0; D]; MAX_NODES]);
    let determinant = shape::map(kind, x, xi, &mut n, &mut grad);
    let mut y = [0.0; D];
    for (x, n) in x.iter().zip(&n) {
        for d in 0..D {
            y[d] += n * x[d];
        }
    }
    (y, determinant)
}

fn no_rule<const D: usize>(mesh: &Mesh<D>, wanted: &RegionSeed, kind: CellKind) -> Error {
    Error::input(
        format!("region {}, points_per_cell", mesh.regions[wanted.region as usize]),
        format!("{} points are not possible in its {kind:?} cells", wanted.points_per_cell),
        format!("use {}", possible(kind)),
    )
}
