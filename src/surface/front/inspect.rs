//! Whether a front still holds.

use super::{Front, distance};
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::surface::bins::Bins;
use crate::surface::geometry::Geometry;
use crate::surface::split::twice_area;
use std::fmt;

/// Parts of the surface nearer than this share of a cell touch …
const TOUCH: f64 = 0.2;
/// … if along the loop they are farther apart than this multiple of their distance and half a cell: the two sides of
/// a wedge of more than 15° do not.
const ALONG: f64 = 5.0;
/// Segments so many places apart or less must not cross: what is farther apart touches before it does.
const NEAR: usize = 8;
/// The volume of points and front may differ by this share of a cell's length times the free surface.
const OFFSET: f64 = 0.05;

/// Why a front holds no longer.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Fault {
    /// A marker left the mesh.
    Outside { place: [f64; 2] },
    /// The surface crosses itself.
    Fold { place: [f64; 2] },
    /// Two parts of the surface met.
    Touch { place: [f64; 2] },
    /// The front encloses another volume (m³) than the points have.
    Volume { enclosed: f64, points: f64 },
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Outside { place } => write!(f, "it left the mesh at {place:.4?} m"),
            Self::Fold { place } => write!(f, "it crosses itself at {place:.4?} m"),
            Self::Touch { place } => write!(f, "it touches itself at {place:.4?} m"),
            Self::Volume { enclosed, points } => {
                write!(f, "it encloses {enclosed:.6} m³ where the points have {points:.6} m³")
            }
        }
    }
}

impl Front {
    /// Says whether the front still is the surface of points of the volume `points` (m³) together.
    ///
    /// # Errors
    /// The first fault found: a crossing, a touch, a volume that is off by more than a twentieth of a cell along the
    /// free surface.
    pub fn inspect<K: Kinematics<2>>(
        &self,
        mesh: &Mesh<2>,
        geometry: &Geometry,
        locator: &Locator<2>,
        points: f64,
    ) -> Result<(), Fault> {
        let wall = self.walls(mesh, geometry, locator);
        // Free markers: place, loop, length of the loop up to there; the greatest size of a cell among them.
        let (mut markers, mut lengths) = (Vec::new(), Vec::new());
        let (mut size, mut swept, mut hint) = (0.0f64, 0.0, None);
        for l in 0..self.loops() {
            let (x, first) = (self.markers(l), self.first[l] as usize);
            let mut along = 0.0;
            for i in 0..x.len() {
                let (b, c) = (x[i], x[(i + 1) % x.len()]);
                let length = distance(&b, &c);
                if !wall[first + i] {
                    let (cell, _) = locator.locate(mesh, &b, hint).ok_or(Fault::Outside { place: b })?;
                    let h = geometry.size(mesh, cell as usize);
                    hint = Some(cell);
                    size = size.max(h);
                    swept += h * length * K::measure(&[0, 1].map(|d| 0.5 * (b[d] + c[d])));
                    markers.push((b, l, along, h));
                    if (2..=NEAR.min(x.len() - 2)).any(|k| {
                        let other = (i + k) % x.len();
                        !wall[first + other] && cross(&b, &c, &x[other], &x[(other + 1) % x.len()])
                    }) {
                        return Err(Fault::Fold { place: b });
                    }
                }
                along += length;
            }
            lengths.push(along);
        }
        let enclosed = self.volume::<K>();
        // Where no surface is free, the points may fill their box a little more or less than all.
        if (enclosed - points).abs() > OFFSET * swept && !markers.is_empty() {
            return Err(Fault::Volume { enclosed, points });
        }
        let bins = Bins::new(markers.iter().map(|m| (m.0, m.0)), TOUCH * size);
        for (i, (x, l, along, h)) in markers.iter().enumerate() {
            let touches = |&j: &u32| {
                let (y, m, other, _) = &markers[j as usize];
                let gap = distance(x, y);
                let apart = (along - other).abs();
                let apart = if l == m { apart.min(lengths[*l] - apart) } else { f64::INFINITY };
                (j as usize) < i && gap < TOUCH * h && apart > ALONG * gap + 0.5 * h
            };
            if bins.around(x).any(|bin| bin.iter().any(touches)) {
                return Err(Fault::Touch { place: *x });
            }
        }
        Ok(())
    }
}

/// Whether the segments from `a` to `b` and from `c` to `d` cross.
fn cross(a: &[f64; 2], b: &[f64; 2], c: &[f64; 2], d: &[f64; 2]) -> bool {
    let apart = |p: &[f64; 2], q: &[f64; 2], r: &[f64; 2], s: &[f64; 2]| {
        (twice_area(&[*p, *q, *r]) > 0.0) == (twice_area(&[*p, *q, *s]) > 0.0)
    };
    !apart(a, b, c, d) && !apart(c, d, a, b)
}
