//! Soil that comes into regions of the mesh (docs/theory.md, section 14, *Fill*): up to the outline of the region as drawn, and down to the soil
//! that is there, wherever that has moved.

use super::ON_NODE;
use super::origin::Origin;
use crate::kinematics::Kinematics;
use crate::mesh::locate::Locator;
use crate::mesh::{Mesh, cell_size};
use crate::points::Points;
use crate::quadrature::{self, NOWHERE, Placed};
use crate::seed;
use crate::surface::{ActiveBoundary, Behind, Contour, Distance, Geometry, MarkerFront, NO_REGION, Triangles};
use rayon::prelude::*;
use std::marker::PhantomData;

/// A region that is filled.
#[derive(Clone, Copy, Debug)]
pub struct Fill {
    /// Its number in the mesh.
    pub region: u16,
    pub points_per_cell: u32,
}

/// Regions that are filled, one after the other.
pub struct Filling<K> {
    /// The grid in its first shape.
    mesh: Mesh<2>,
    /// Whether each region has soil before.
    there: Vec<bool>,
    fills: Vec<Fill>,
    axisymmetric: bool,
    kinematics: PhantomData<fn() -> K>,
}

impl<K> Filling<K> {
    /// Of regions on the grid `mesh`, where the regions `there` have soil.
    pub fn new(mesh: Mesh<2>, there: Vec<bool>, fills: Vec<Fill>, axisymmetric: bool) -> Self {
        Self { mesh, there, fills, axisymmetric, kinematics: PhantomData }
    }

    /// The level set (m) of a fill at the nodes of the reset grid `mesh`, positive where it may be: in the region, and where the soil that is there has
    /// left room below or beside it, which is where it would have brought the region along. `soil` is the level set of the soil that is there, with the
    /// places of its points and those where they were seeded.
    fn room(&self, region: u16, mesh: &Mesh<2>, soil: &[f64], points: [&[[f64; 2]]; 2]) -> Vec<f64> {
        let is = |other: usize| other == usize::from(region);
        let own: Vec<bool> = (0..self.there.len()).map(is).collect();
        let both: Vec<bool> = self.there.iter().enumerate().map(|(r, there)| *there || is(r)).collect();
        let (drawn, ground) = (Origin::new(self.mesh.clone(), &own), Origin::new(self.mesh.clone(), &both));
        let sizes = node_sizes(mesh);
        let level = |n: usize| {
            let x = &mesh.nodes[n];
            let mut level = drawn.depth(x).0;
            if level <= 0.0 && soil[n] < 0.0 {
                let was_soil = ground.depth(x).0;
                if was_soil > 0.0 {
                    level = level.max(was_soil.min(drawn.depth(&brought(x, points)).0));
                }
            }
            if level.abs() < ON_NODE * sizes[n] { 0.0 } else { level }
        };
        (0..mesh.nodes.len()).into_par_iter().with_min_len(64).map(level).collect()
    }
}

/// Where what is at `x` (m) was at first, if it went with the nearest of the points, given their places now and at first.
fn brought(x: &[f64; 2], [now, first]: [&[[f64; 2]]; 2]) -> [f64; 2] {
    let square = |p: usize| (now[p][0] - x[0]).powi(2) + (now[p][1] - x[1]).powi(2);
    let nearest = (0..now.len()).min_by(|&a, &b| square(a).total_cmp(&square(b)));
    nearest.map_or(*x, |p| [0, 1].map(|d| x[d] + first[p][d] - now[p][d]))
}

/// The largest size (m) of the cells at each node.
fn node_sizes(mesh: &Mesh<2>) -> Vec<f64> {
    let mut sizes = vec![0.0f64; mesh.nodes.len()];
    for c in 0..mesh.cells.len() {
        let size = cell_size(mesh, c);
        mesh.cells.nodes(c).iter().for_each(|&n| sizes[n as usize] = sizes[n as usize].max(size));
    }
    sizes
}

/// The points of a cell that lie in the room and outside the soil, with the volumes of their parts of the cell.
fn free_points(mesh: &Mesh<2>, c: usize, points: &[seed::Seed<2>], [soil, whole]: [&[f64]; 2]) -> Vec<([f64; 2], f64)> {
    let x = mesh.coordinates(c);
    let triangles = Triangles::of(mesh.cells.kind[c], &x);
    let nodes = mesh.cells.nodes(c);
    let is_free = |xi: &[f64; 3]| {
        let (triangle, l) = triangles.barycentric(xi);
        let at = |level: &[f64]| -> f64 { triangle.iter().zip(l).map(|(&i, l)| l * level[nodes[i] as usize]).sum() };
        at(soil) < 0.0 && at(whole) > 0.0
    };
    points.iter().filter(|point| is_free(&point.xi)).map(|point| (point.position, point.volume)).collect()
}

impl<K: Kinematics<2>> quadrature::Placing<2> for Filling<K> {
    fn place(
        &self,
        (mesh, locator): (&Mesh<2>, &Locator<2>),
        (points, parametric): (&Points<2>, &[[f64; 3]]),
        front: &mut Option<MarkerFront>,
    ) -> Vec<Placed<2>> {
        let geometry = Geometry::new::<K>(mesh);
        let active = vec![true; mesh.cells.len()];
        let mut level = match front {
            Some(front) => {
                let mut distance = Distance::default();
                distance.update(mesh, &geometry, locator, front, &points.cell, &active);
                distance.level_set
            }
            None => {
                let mut contour = Contour::default();
                contour.update::<K>(mesh, &geometry, points, parametric, &active);
                contour.level_set
            }
        };
        let [mut now, mut first] = [points.position.clone(), points.origin.clone()];
        let mut all = Vec::new();
        for &Fill { region, points_per_cell } in &self.fills {
            let room = self.room(region, mesh, &level, [&now, &first]);
            let whole: Vec<f64> = level.iter().zip(&room).map(|(soil, room)| soil.max(*room)).collect();
            let filled = |c: usize, level: &[f64]| {
                let values: Vec<f64> = mesh.cells.nodes(c).iter().map(|&n| level[n as usize]).collect();
                geometry.filled::<K>(mesh, c, &values)
            };
            let mut placed = Placed { region, ..Placed::default() };
            // Volumes that are too thin for a point of their own, by their cells.
            let mut thin = Vec::new();
            for c in 0..mesh.cells.len() {
                let (before, after) = (filled(c, &level), filled(c, &whole));
                let volume = (after - before).max(0.0);
                if mesh.cells.region[c] == region {
                    placed.drawn += geometry.volume(c);
                } else {
                    placed.beside += volume;
                }
                if volume <= NOWHERE * geometry.volume(c) {
                    continue;
                }
                placed.volume += volume;
                let seeds = seed::of_cell(mesh, c, points_per_cell, self.axisymmetric).unwrap_or_default();
                let found = free_points(mesh, c, &seeds, [&level, &whole]);
                let sum: f64 = found.iter().map(|(_, volume)| volume).sum();
                if found.is_empty() {
                    thin.push((geometry.frame[c].centre, volume));
                }
                for (x, part) in found {
                    placed.position.push(x);
                    placed.volumes.push(volume * part / sum);
                    placed.cell.push(c as u32);
                }
            }
            for (x, volume) in thin {
                let square = |p: usize| (placed.position[p][0] - x[0]).powi(2) + (placed.position[p][1] - x[1]).powi(2);
                let nearest = (0..placed.position.len()).min_by(|&a, &b| square(a).total_cmp(&square(b)));
                if let Some(p) = nearest {
                    placed.volumes[p] += volume;
                }
            }
            if !placed.position.is_empty() {
                now.extend(&placed.position);
                first.extend(&placed.position);
                level = whole;
            }
            all.push(placed);
        }
        if front.is_some() && all.iter().any(|placed| !placed.position.is_empty()) {
            let nothing = |host: u32, _: &[f64; 2]| Behind { region: NO_REGION, host };
            let boundary = ActiveBoundary::of(mesh, &geometry, &level, &active, nothing);
            *front = Some(boundary.front(mesh));
        }
        all
    }
}
