//! The surface as closed polylines of markers that move with the grid.
//!
//! They begin as the exact boundary of the cells that are filled with points and remember it, where the contour of the
//! points forgets within a step what is smaller than their spacing. Loops run with the material on their left:
//! counter-clockwise around a body, clockwise around a hole. What of them lies on the boundary of the mesh is wall, the
//! rest free surface; which is which is seen anew from the places of the markers, so that the places are all the state
//! there is. Markers on a wall slide along it because the displacement of the grid does.
//!
//! Loops that cross or come near each other are joined anew ([`MarkerFront::join`]). Where the cells that are filled at first hold another volume than the
//! points, and where a marker leaves the mesh, the [`super::Contour`] takes over, smoothed anew at every restoration ([`MarkerFront::along`]). It leaves
//! out slip along curved walls, which no support can ask for.

mod conform;
mod join;
mod resample;
mod seed;
mod smooth;

pub use conform::ContactStatus;

use super::geometry::Geometry;
use crate::geometry::distance;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::faces::BOUNDARY;
use crate::mesh::locate::Locator;
use crate::mesh::shape::MAX_NODES;
use crate::mesh::side::Side;
use std::f64::consts::PI;
use std::fmt;

/// Markers per length of a cell along the free surface.
const PER_LENGTH: usize = 6;

/// How far across the boundary of the mesh a marker may get (-), in the diagonal of the cell there: an empty cell between soil and a wall
/// is squeezed to nothing as the soil closes.
const FARTHEST: f64 = 0.5;

/// Where along a segment it is seen whether it lies on the boundary of the mesh (-). Two places, for at a node the cell that is found may touch
/// the boundary in that node alone.
const ALONG: [f64; 2] = [0.4618, 0.5431];
/// Depth (parametric) within a cell up to which a place is on its straight side: rounding.
const ON_STRAIGHT_SIDE: f64 = 1e-7;
/// The same of a curved side: the rise of a chord between two markers.
const ON_CURVED_SIDE: f64 = 1e-2;

/// The loops of markers at the last restoration: part of the state of a run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MarkerFront {
    /// Places (m) of the markers, loop after loop.
    pub position: Vec<[f64; 2]>,
    /// Loop `l` has the markers `first[l]..first[l + 1]`.
    pub first: Vec<u32>,
}

/// Why a front is not followed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Lost {
    /// A marker left the mesh at this place (m).
    Outside([f64; 2]),
    /// Where it began it enclosed another volume (m³) than the points have: it is not their surface.
    Volume { enclosed: f64, points: f64 },
    /// Every loop of it was thinner than the spacing of its markers.
    Vanished,
}

impl fmt::Display for Lost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Outside(place) => write!(f, "it left the mesh at {place:.4?} m"),
            Self::Volume { enclosed, points } => {
                write!(f, "at first it enclosed {enclosed:.6} m³ where the points have {points:.6} m³")
            }
            Self::Vanished => write!(f, "it became thinner than the spacing of its markers"),
        }
    }
}

impl MarkerFront {
    /// The number of loops.
    pub fn loops(&self) -> usize {
        self.first.len().saturating_sub(1)
    }

    /// The markers of a loop; the last one is followed by the first.
    pub fn markers(&self, l: usize) -> &[[f64; 2]] {
        &self.position[self.first[l] as usize..self.first[l + 1] as usize]
    }

    /// The volume (m³, per metre or full turn) that the loops enclose.
    pub fn volume<K: Kinematics<2>>(&self) -> f64 {
        let mut volume = 0.0;
        for l in 0..self.loops() {
            let markers = self.markers(l);
            // About a marker, or cancellation eats the digits of a small body far from the origin.
            let origin = markers.first().map_or(0.0, |x| x[1]);
            for (i, a) in markers.iter().enumerate() {
                let b = markers[(i + 1) % markers.len()];
                if K::HOOP {
                    volume += PI / 3.0 * (b[1] - a[1]) * (a[0] * a[0] + a[0] * b[0] + b[0] * b[0]);
                } else {
                    volume -= 0.5 * (b[0] - a[0]) * (a[1] + b[1] - 2.0 * origin);
                }
            }
        }
        volume
    }

    /// The area (m², per metre or full turn) of the free surface, and the mean size (m) of the cells along it; zeros
    /// without one.
    pub fn surface<K: Kinematics<2>>(&self, mesh: &Mesh<2>, geometry: &Geometry, locator: &Locator<2>) -> (f64, f64) {
        let wall = self.walls(mesh, geometry, locator);
        let (mut area, mut sizes, mut hint) = (0.0, 0.0, None);
        for l in 0..self.loops() {
            let (x, first) = (self.markers(l), self.first[l] as usize);
            for i in (0..x.len()).filter(|i| !wall[first + i]) {
                let (a, b) = (x[i], x[(i + 1) % x.len()]);
                let Some((cell, _)) = locator.locate(mesh, &a, hint) else { continue };
                let part = distance(&a, &b) * K::measure(&[0, 1].map(|d| 0.5 * (a[d] + b[d])));
                area += part;
                sizes += part * geometry.size(mesh, cell as usize);
                hint = Some(cell);
            }
        }
        if area > 0.0 { (area, sizes / area) } else { (0.0, 0.0) }
    }

    /// The size (m) of the cell at each marker.
    fn sizes(&self, mesh: &Mesh<2>, geometry: &Geometry, locator: &Locator<2>) -> Result<Vec<f64>, Lost> {
        let mut hint = None;
        let size = |x: &[f64; 2]| {
            let (cell, _) = locator.locate(mesh, x, hint).ok_or(Lost::Outside(*x))?;
            hint = Some(cell);
            Ok(geometry.size(mesh, cell as usize))
        };
        self.position.iter().map(size).collect()
    }

    /// Moves the markers with the `displacement` (m) of the nodes since the grid was restored to `before`, and evens out
    /// their spacing on the grid that is restored now, with its `geometry`.
    ///
    /// # Errors
    /// When a marker was outside the mesh, or gets far outside it: the front is of no use then.
    pub fn advance(
        &mut self,
        before: (&Mesh<2>, &Locator<2>),
        (mesh, locator): (&Mesh<2>, &Locator<2>),
        geometry: &Geometry,
        displacement: &[[f64; 2]],
    ) -> Result<(), Lost> {
        let (mut n, mut hint) = ([0.0; MAX_NODES], None);
        for x in &mut self.position {
            let (c, xi) = before.1.locate(before.0, x, hint).ok_or(Lost::Outside(*x))?;
            before.0.cells.kind[c as usize].values(&xi, &mut n);
            for (&node, n) in before.0.cells.nodes(c as usize).iter().zip(&n) {
                for d in 0..2 {
                    x[d] += n * displacement[node as usize][d];
                }
            }
            hint = Some(c);
        }
        self.project_onto_mesh((mesh, locator), geometry)?;
        let wall = self.walls(mesh, geometry, locator);
        self.resample(mesh, geometry, locator, &wall)?;
        self.project_onto_mesh((mesh, locator), geometry)
    }

    /// Puts markers that got a little across the boundary of the mesh back onto it.
    ///
    /// # Errors
    /// When one got farther.
    fn project_onto_mesh(&mut self, (mesh, locator): (&Mesh<2>, &Locator<2>), geometry: &Geometry) -> Result<(), Lost> {
        let mut hint = None;
        for x in &mut self.position {
            if let Some((cell, _)) = locator.locate(mesh, x, hint) {
                hint = Some(cell);
                continue;
            }
            let near = geometry.faces.boundary.iter().filter_map(|&side| Side::of(mesh, side).nearest(x, FARTHEST));
            let (place, _) = near.min_by(|a, b| a.1.total_cmp(&b.1)).ok_or(Lost::Outside(*x))?;
            *x = place;
        }
        Ok(())
    }

    /// Whether the segment from each marker to the next one lies on the boundary of the mesh.
    pub fn walls(&self, mesh: &Mesh<2>, geometry: &Geometry, locator: &Locator<2>) -> Vec<bool> {
        let mut wall = Vec::with_capacity(self.position.len());
        let mut hint = None;
        for l in 0..self.loops() {
            let markers = self.markers(l);
            for (i, a) in markers.iter().enumerate() {
                let b = markers[(i + 1) % markers.len()];
                wall.push(ALONG.into_iter().any(|t| {
                    let x = [0, 1].map(|d| a[d] + t * (b[d] - a[d]));
                    // The chord of a curved wall may run outside the mesh.
                    let Some((c, xi)) = locator.locate(mesh, &x, hint) else { return true };
                    hint = Some(c);
                    on_boundary(mesh, geometry, c as usize, &xi)
                }));
            }
        }
        wall
    }
}

/// Whether the place `xi` in cell `c` is on a side of it that bounds the mesh: to rounding where the cell is straight,
/// within the rise of a chord where it is curved.
fn on_boundary(mesh: &Mesh<2>, geometry: &Geometry, c: usize, xi: &[f64; 3]) -> bool {
    let across = geometry.faces.across(c as u32);
    let reach = if geometry.straight[c] { ON_STRAIGHT_SIDE } else { ON_CURVED_SIDE };
    let depth = |side: usize| match (mesh.cells.kind[c].is_simplex(), side) {
        (true, 0) => xi[1],
        (true, 1) => 1.0 - xi[0] - xi[1],
        (true, _) => xi[0],
        (false, 0) => 1.0 + xi[1],
        (false, 1) => 1.0 - xi[0],
        (false, 2) => 1.0 - xi[1],
        (false, _) => 1.0 + xi[0],
    };
    across.iter().enumerate().any(|(side, &other)| other == BOUNDARY && depth(side) <= reach)
}

#[cfg(test)]
mod tests;
