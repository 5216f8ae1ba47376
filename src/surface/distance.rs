//! The signed distance of the nodes to the free surface of a front.
//!
//! Only free segments count. Where the surface ends at a wall it is continued straight beyond it, so that the level
//! set of a straight surface is linear up to the wall; where soil comes around a corner of the wall, that would be back into the soil, and it
//! goes on within the wall. What is continued counts for nodes alone whose nearest free segment is of the same run: another run may lie between, as on the outside of a toe whose underside is hollow. The sign comes from the nearest segment; far from all
//! of them a node is in the material if a cell around it holds points.

use super::front::MarkerFront;
use super::geometry::Geometry;
use crate::geometry::{Bins, foot, way};
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use rayon::prelude::*;
use std::f64::consts::PI;

/// The distance at the last restoration; its buffers are reused.
#[derive(Clone, Debug, Default)]
pub struct Distance {
    /// Signed distance (m) of the nodes of cells that take part: positive in the material; no more than a few cells.
    pub level_set: Vec<f64>,
    segments: Vec<Segment>,
    /// Per node, whether it belongs to a cell with points and to one that takes part.
    material: Vec<bool>,
    wanted: Vec<bool>,
}

/// A free segment with the normals out of the material at its ends: sums of the unit normals of the two segments there.
#[derive(Clone, Copy, Debug)]
struct Segment {
    from: [f64; 2],
    to: [f64; 2],
    normal: [[f64; 2]; 2],
    /// The number of its run of free segments, and whether it continues that beyond a wall.
    arc: u32,
    beyond: bool,
}

/// More than the diameter of a cell, over its size: cells are not much longer than they are wide.
const DIAMETER: f64 = 1.25;
/// Where ahead of the end of a run, in shares of the reach (-), the outside of the mesh is sought.
const AHEAD: [f64; 5] = [0.2, 0.4, 0.6, 0.8, 1.0];
/// The turns (rad) in which it is sought.
const TURN: f64 = PI / 12.0;
/// What a zero is, as a share of the reach.
const ROUNDING: f64 = 1e-13;

impl Distance {
    /// Measures the nodes of the cells `active`; `cell` is the cell of each point. The markers must be in the mesh.
    pub fn update(
        &mut self,
        mesh: &Mesh<2>,
        geometry: &Geometry,
        locator: &Locator<2>,
        front: &MarkerFront,
        cell: &[u32],
        active: &[bool],
    ) {
        let wall = front.walls(mesh, geometry, locator);
        let reach = self.reach(mesh, locator, front, &wall);
        let inside = |x: &[f64; 2]| locator.locate(mesh, x, None).is_some();
        self.segments.clear();
        let mut count = 0;
        for l in 0..front.loops() {
            let range = front.first[l] as usize..front.first[l + 1] as usize;
            arcs(front.markers(l), &wall[range], reach, &inside, |arc, closed| {
                add_arc(&mut self.segments, arc, count, closed);
                count += 1;
            });
        }
        let bins = Bins::new(self.segments.iter().map(|s| (s.from, s.to)), reach);
        self.mark(mesh, cell, active);
        let (segments, material, wanted) = (&self.segments, &self.material, &self.wanted);
        let measure = |n: usize| {
            let far = if material[n] { reach } else { -reach };
            if !wanted[n] { far } else { nearest(segments, &bins, &mesh.nodes[n], reach).unwrap_or(far) }
        };
        (0..mesh.nodes.len()).into_par_iter().with_min_len(256).map(measure).collect_into_vec(&mut self.level_set);
    }

    /// More than the diameter of every cell that holds a free marker, with the length of the segments in it.
    fn reach(&self, mesh: &Mesh<2>, locator: &Locator<2>, front: &MarkerFront, wall: &[bool]) -> f64 {
        let (mut reach, mut hint) = (0.0f64, None);
        for (x, _) in front.position.iter().zip(wall).filter(|(_, wall)| !**wall) {
            if let Some((c, _)) = locator.locate(mesh, x, hint) {
                reach = reach.max(DIAMETER * crate::mesh::cell_size(mesh, c as usize));
                hint = Some(c);
            }
        }
        // No free marker: every node is far, and any length will do for that.
        if reach > 0.0 { reach } else { 1.0 }
    }

    fn mark(&mut self, mesh: &Mesh<2>, cell: &[u32], active: &[bool]) {
        for marks in [&mut self.material, &mut self.wanted] {
            marks.clear();
            marks.resize(mesh.nodes.len(), false);
        }
        for &c in cell {
            mesh.cells.nodes(c as usize).iter().for_each(|&n| self.material[n as usize] = true);
        }
        for c in (0..mesh.cells.len()).filter(|&c| active[c]) {
            mesh.cells.nodes(c).iter().for_each(|&n| self.wanted[n as usize] = true);
        }
    }
}

/// Calls `action(markers, closed)` for every run of free segments of a loop; a run that ends at a wall is continued beyond it at both ends, farther
/// than `reach` (m), given what is `inside` the mesh.
fn arcs(
    x: &[[f64; 2]],
    wall: &[bool],
    reach: f64,
    inside: &dyn Fn(&[f64; 2]) -> bool,
    mut action: impl FnMut(&[[f64; 2]], bool),
) {
    let count = x.len();
    let Some(start) = wall.iter().position(|&wall| wall) else {
        action(x, true);
        return;
    };
    let mut arc: Vec<[f64; 2]> = Vec::new();
    // Once around, from the end of a wall segment to the end of the same one.
    for k in 1..=count {
        let i = (start + k) % count;
        if !wall[i] {
            arc.push(x[i]);
        } else if !arc.is_empty() {
            arc.push(x[i]);
            let first = beyond_end([&arc[1], &arc[0]], 1.0, reach, inside);
            let last = beyond_end([&arc[arc.len() - 2], &x[i]], -1.0, reach, inside);
            arc.insert(0, first);
            arc.push(last);
            action(&arc, false);
            arc.clear();
        }
    }
}

/// A place beyond the end `b` of a run that comes from `a` and goes on along a wall, farther than `reach` (m): straight on, or, where that is back
/// `inside` the mesh, as around a corner of the wall, in the middle of what is outside it there. The wall is on the left of a way onward of the
/// run where `side` is 1, on the right of it where it is −1.
fn beyond_end([a, b]: [&[f64; 2]; 2], side: f64, reach: f64, inside: &dyn Fn(&[f64; 2]) -> bool) -> [f64; 2] {
    let d = way(a, b);
    let ahead = |turn: usize, by: f64| {
        let (sin, cos) = (side * turn as f64 * TURN).sin_cos();
        let stretch = by / d[0].hypot(d[1]).max(f64::MIN_POSITIVE);
        [b[0] + stretch * (cos * d[0] - sin * d[1]), b[1] + stretch * (sin * d[0] + cos * d[1])]
    };
    let is_inside = |&turn: &usize| AHEAD.iter().any(|share| inside(&ahead(turn, share * reach)));
    let turns = (PI / TURN) as usize;
    let first = (0..turns).find(|turn| !is_inside(turn)).unwrap_or(0);
    let last = (first..turns).find(is_inside).unwrap_or(turns);
    ahead(if first == 0 { 0 } else { (first + last) / 2 }, 2.0 * reach)
}

/// Adds run `arc`; the first and the last segment of one that is not `closed` are those beyond walls.
fn add_arc(segments: &mut Vec<Segment>, x: &[[f64; 2]], arc: u32, closed: bool) {
    let first = segments.len();
    let ends = x.windows(2).map(|w| (w[0], w[1])).chain(closed.then(|| (x[x.len() - 1], x[0])));
    segments.extend(ends.enumerate().filter(|(_, (a, b))| a != b).map(|(i, (from, to))| {
        let [dx, dy] = [to[0] - from[0], to[1] - from[1]];
        let length = dx.hypot(dy);
        let beyond = !closed && (i == 0 || i + 2 == x.len());
        Segment { from, to, normal: [[dy / length, -dx / length]; 2], arc, beyond }
    }));
    let count = segments.len() - first;
    let own: Vec<[f64; 2]> = segments[first..].iter().map(|s| s.normal[0]).collect();
    for i in 0..count {
        let sum = |j: usize| [own[i][0] + own[j][0], own[i][1] + own[j][1]];
        if i > 0 || closed {
            segments[first + i].normal[0] = sum((i + count - 1) % count);
        }
        if i + 1 < count || closed {
            segments[first + i].normal[1] = sum((i + 1) % count);
        }
    }
}

/// The signed distance of `x` to the run of the nearest free segment, continued beyond walls, if that segment is within reach.
fn nearest(segments: &[Segment], bins: &Bins, x: &[f64; 2], reach: f64) -> Option<f64> {
    let around = || bins.around(x).flatten().map(|&number| &segments[number as usize]);
    // The nearest free segment, and the nearest one of all.
    let mut free = (reach * reach, None);
    let mut all = (f64::INFINITY, 0.0, None);
    for s in around() {
        let (square, height) = s.height(x);
        if !s.beyond && square < free.0 {
            free = (square, Some(s.arc));
        }
        if square < all.0 {
            all = (square, height, Some(s.arc));
        }
    }
    let arc = free.1?;
    if all.2 != Some(arc) {
        all = (f64::INFINITY, 0.0, None);
        for s in around().filter(|s| s.arc == arc) {
            let (square, height) = s.height(x);
            if square < all.0 {
                all = (square, height, Some(arc));
            }
        }
    }
    let (least, height, _) = all;
    let distance = least.sqrt();
    Some(if distance <= ROUNDING * reach { 0.0 } else { -distance.copysign(height) })
}

impl Segment {
    /// The square of the distance (m) of `x`, and a number with the sign of its height above the surface.
    fn height(&self, x: &[f64; 2]) -> (f64, f64) {
        let (d, r) = (way(&self.from, &self.to), way(&self.from, x));
        let t = foot(x, &[self.from, self.to]);
        let foot = [0, 1].map(|k| r[k] - t.clamp(0.0, 1.0) * d[k]);
        let height = if t <= 0.0 {
            foot[0] * self.normal[0][0] + foot[1] * self.normal[0][1]
        } else if t >= 1.0 {
            foot[0] * self.normal[1][0] + foot[1] * self.normal[1][1]
        } else {
            foot[0] * d[1] - foot[1] * d[0]
        };
        (foot[0] * foot[0] + foot[1] * foot[1], height)
    }
}

#[cfg(test)]
mod tests;
