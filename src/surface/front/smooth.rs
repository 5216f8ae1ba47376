//! A front along the contour of the points, for one restoration.
//!
//! The contour is rough on the scale of the points and of the nodes between which it is linear. Each free stretch of it takes evenly spaced markers and is smoothed by
//! the flow `ẋ = −∂⁴x/∂s⁴`, which keeps the area that it encloses and, unlike that of second order, takes little of
//! what is longer than two cells; what area is lost all the same comes back by an even offset of the loop.

use super::{MarkerFront, PER_LENGTH};
use crate::geometry::distance;
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::surface::boundary::ActiveBoundary;
use crate::surface::geometry::Geometry;
use std::f64::consts::TAU;

/// The share of the fourth difference that a pass takes: half of what would still be stable, so that every wave decays.
const SHARE: f64 = 1.0 / 16.0;
/// Passes: a tenth is left of waves of a cell, 87 % of those of two, 97 % of three.
const PASSES: usize = 32;
/// No closed loop loses more than about this share of its radius before it comes back by the offset, …
const SHRINKS: f64 = 0.1;
/// … and those of fewer markers, hardly more than two cells across, keep the contour: the distance at its nodes is too coarse for them,
/// and a thrown block of less than two cells would drift from its parabola by half as much again.
const LEAST: usize = 8 * PER_LENGTH;

impl MarkerFront {
    /// The front along `boundary`, smoothed. `None`
    /// where a body is too small for markers. Holes as small are left out.
    pub fn along<K: Kinematics<2>>(mesh: &Mesh<2>, geometry: &Geometry, boundary: &ActiveBoundary) -> Option<Self> {
        let mut front = Self { position: Vec::new(), first: vec![0] };
        for l in 0..boundary.loops() {
            let corners: Vec<[f64; 2]> = boundary.corners(mesh, &mesh.nodes, l).collect();
            let size = |i: usize| geometry.size(mesh, boundary.pieces(l)[i].cell as usize);
            let wall: Vec<bool> = boundary.pieces(l).iter().map(|piece| piece.wall).collect();
            let mut rough = Self { first: vec![0, corners.len() as u32], position: corners };
            let volume = rough.volume::<K>();
            let Some(free) = rough.smoothen(&wall, size) else {
                if volume > 0.0 {
                    return None;
                }
                continue;
            };
            rough.offset::<K>(&free, volume);
            front.position.append(&mut rough.position);
            front.first.push(front.position.len() as u32);
        }
        // Without a loop there is no material, or no end of it.
        (front.loops() > 0).then_some(front)
    }

    /// Replaces the free stretches of a single loop, whose segments are `wall` or not and lie in cells of a `size` (m), by
    /// smooth ones, and says which markers are in their midst. `None` if they are too short for markers.
    pub(super) fn smoothen(&mut self, wall: &[bool], size: impl Fn(usize) -> f64) -> Option<Vec<bool>> {
        let x = std::mem::take(&mut self.position);
        let count = x.len();
        let start = wall.iter().position(|&wall| wall);
        // A closed loop without walls is one stretch; else begin behind a wall.
        let begin = start.map_or(0, |i| i + 1);
        let mut free = Vec::new();
        let mut k = 0;
        while k < count {
            let i = (begin + k) % count;
            if wall[i] {
                self.position.push(x[i]);
                free.push(false);
                k += 1;
                continue;
            }
            let run = (k..count).take_while(|&k| !wall[(begin + k) % count]).count();
            let stretch: Vec<[f64; 2]> = (k..=k + run).map(|k| x[(begin + k) % count]).collect();
            let sizes: Vec<f64> = (k..k + run).map(|k| size((begin + k) % count)).collect();
            let mut markers = evenly(&stretch, &sizes);
            let closed = start.is_none();
            if closed && markers.len() <= LEAST {
                return None;
            }
            smooth(&mut markers, closed);
            // The last one begins what comes next.
            markers.pop();
            free.extend((0..markers.len()).map(|i| closed || i > 0));
            self.position.append(&mut markers);
            k += run;
        }
        self.first = vec![0, self.position.len() as u32];
        Some(free)
    }

    /// Moves the `free` markers of a single loop along their normals so that it encloses `volume` (m³).
    pub(super) fn offset<K: Kinematics<2>>(&mut self, free: &[bool], volume: f64) {
        let x = self.position.clone();
        let count = x.len();
        // The chord between the neighbours of a marker is as long as the two halves of its segments.
        let chord = |i: usize| {
            let (a, b) = (x[(i + count - 1) % count], x[(i + 1) % count]);
            [b[0] - a[0], b[1] - a[1]]
        };
        let swept = |i: usize| 0.5 * chord(i)[0].hypot(chord(i)[1]) * K::measure(&x[i]);
        let surface: f64 = (0..count).filter(|&i| free[i]).map(swept).sum();
        if surface <= 0.0 {
            return;
        }
        let by = (volume - self.volume::<K>()) / surface;
        for i in (0..count).filter(|&i| free[i]) {
            let [dx, dy] = chord(i);
            let length = dx.hypot(dy).max(f64::MIN_POSITIVE);
            self.position[i] = [x[i][0] + by * dy / length, x[i][1] - by * dx / length];
        }
    }
}

/// Places along a polyline, its ends among them, `PER_LENGTH` to the size (m) of the cell that a segment is in.
fn evenly(x: &[[f64; 2]], sizes: &[f64]) -> Vec<[f64; 2]> {
    let mut along = vec![0.0];
    for (i, size) in sizes.iter().enumerate() {
        along.push(along[i] + distance(&x[i], &x[i + 1]) * PER_LENGTH as f64 / size);
    }
    let whole = along[sizes.len()];
    let intervals = whole.round().max(1.0);
    let at = |k: usize| {
        let s = whole * k as f64 / intervals;
        let i = along.partition_point(|&a| a <= s).clamp(1, sizes.len());
        let t = (s - along[i - 1]) / (along[i] - along[i - 1]).max(f64::MIN_POSITIVE);
        [0, 1].map(|d| x[i - 1][d] + t * (x[i][d] - x[i - 1][d]))
    };
    let mut markers: Vec<_> = (0..intervals as usize).map(at).collect();
    markers.push(x[x.len() - 1]);
    markers
}

/// Smooths a stretch of markers, the last of which is the first if it is `closed`; the ends of an open one stay, and it goes on
/// beyond them as if turned by 180°.
fn smooth(x: &mut [[f64; 2]], closed: bool) {
    let last = x.len() - 1;
    // The longest wave has this many markers; of it `e^(−SHARE passes (2π/n)⁴)` is left.
    let longest = if closed { last } else { 2 * last } as f64;
    let passes = PASSES.min((SHRINKS / SHARE * (longest / TAU).powi(4)) as usize);
    if last < 2 {
        return;
    }
    let mut second = vec![[0.0; 2]; last + 1];
    for _ in 0..passes {
        let between = |a: &[f64; 2], b: &[f64; 2], c: &[f64; 2]| [0, 1].map(|d| a[d] - 2.0 * b[d] + c[d]);
        for i in 1..last {
            second[i] = between(&x[i - 1], &x[i], &x[i + 1]);
        }
        let ends = if closed { between(&x[last - 1], &x[0], &x[1]) } else { [0.0; 2] };
        (second[0], second[last]) = (ends, ends);
        for i in 1..last {
            let fourth = between(&second[i - 1], &second[i], &second[i + 1]);
            (0..2).for_each(|d| x[i][d] -= SHARE * fourth[d]);
        }
        if closed {
            let fourth = between(&second[last - 1], &second[0], &second[1]);
            (0..2).for_each(|d| x[0][d] -= SHARE * fourth[d]);
            x[last] = x[0];
        }
    }
}
