//! Loops that cross, or come near each other across a gap, are joined anew: soil closes over a body and on itself, heaps, and comes apart.

use super::{Lost, MarkerFront, PER_LENGTH};
use crate::geometry::{Bins, Line, area, at, crossing, distance, length, nearest, twice_area, winding};
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::surface::geometry::Geometry;

/// A gap between parts of the surface closes where it is narrower than this share of a cell …
const GAP: f64 = 0.2;
/// … if along the loop they are farther apart than this multiple of it and half a cell: the two sides of a wedge of more than 15° are not.
const ALONG: f64 = 5.0;

/// Markers with the one that follows each.
struct Chain {
    position: Vec<[f64; 2]>,
    next: Vec<usize>,
}

impl Chain {
    /// The markers of a front, each followed by the next of its loop.
    fn of(front: &MarkerFront) -> Self {
        let mut next = Vec::with_capacity(front.position.len());
        for l in 0..front.loops() {
            let (first, count) = (front.first[l] as usize, front.markers(l).len());
            next.extend((0..count).map(|i| first + (i + 1) % count));
        }
        Self { position: front.position.clone(), next }
    }

    /// The loops that the markers make now: those that are `kept`, given the number of their first marker, and their markers.
    fn front(&self, kept: impl Fn(usize, &[[f64; 2]]) -> bool) -> MarkerFront {
        let mut front = MarkerFront { position: Vec::with_capacity(self.position.len()), first: vec![0] };
        let mut taken = vec![false; self.next.len()];
        for start in 0..self.next.len() {
            let (from, mut i) = (front.position.len(), start);
            while !taken[i] {
                taken[i] = true;
                front.position.push(self.position[i]);
                i = self.next[i];
            }
            if front.position.len() - from < 3 || !kept(start, &front.position[from..]) {
                front.position.truncate(from);
            } else {
                front.first.push(front.position.len() as u32);
            }
        }
        front
    }
}

impl MarkerFront {
    /// Joins the loops anew where they cross and where gaps have closed, but across structures, which `outlines` bound. What is thinner than the
    /// spacing of the markers goes: crumbs, and the voids that are left of gaps.
    ///
    /// # Errors
    /// When a marker is outside the mesh, or nothing of the front is left.
    pub fn join(
        &mut self,
        mesh: &Mesh<2>,
        geometry: &Geometry,
        locator: &Locator<2>,
        outlines: &[Vec<[f64; 2]>],
    ) -> Result<(), Lost> {
        let loops = self.loops();
        self.uncross();
        self.close(mesh, geometry, locator, outlines)?;
        if self.loops() == 0 && loops > 0 { Err(Lost::Vanished) } else { Ok(()) }
    }

    /// Cuts loops where they cross, and goes on from each end to the other loop there. Of the loops that this makes those bound the material on
    /// whose left it lies once.
    fn uncross(&mut self) {
        let chain = Chain::of(self);
        let segments: Vec<Line<2>> =
            chain.next.iter().zip(&chain.position).map(|(&next, x)| [*x, chain.position[next]]).collect();
        let whole: f64 = segments.iter().map(length).sum();
        let bins = Bins::new(segments.iter().map(|[a, b]| (*a, *b)), whole / segments.len() as f64);
        // On each segment the share of its length at which another one crosses it, and the number of the crossing.
        let mut met: Vec<Vec<(f64, usize)>> = vec![Vec::new(); segments.len()];
        let mut places = Vec::new();
        for (s, segment) in segments.iter().enumerate() {
            let near = bins.beside((segment[0], segment[1])).flatten();
            let mut others: Vec<usize> = near.map(|&t| t as usize).filter(|&t| t > s).collect();
            others.sort_unstable();
            others.dedup();
            for t in others {
                if let Some((along, other)) = crossing(segment, &segments[t]) {
                    met[s].push((along, places.len()));
                    met[t].push((other, places.len()));
                    places.push(at(segment, along));
                }
            }
        }
        if places.is_empty() {
            return;
        }
        // A crossing is a marker on both segments, followed on each by what comes next on the other.
        let mut cut = chain;
        let mut after = vec![[0; 2]; places.len()];
        let mut seen = vec![0; places.len()];
        for (s, on) in met.iter_mut().enumerate() {
            on.sort_by(|a, b| a.0.total_cmp(&b.0));
            let (mut last, end) = (s, cut.next[s]);
            for &(_, crossing) in on.iter() {
                let marker = cut.position.len();
                cut.position.push(places[crossing]);
                cut.next.push(end);
                cut.next[last] = marker;
                after[crossing][seen[crossing]] = marker;
                seen[crossing] += 1;
                last = marker;
            }
        }
        for [a, b] in after {
            cut.next.swap(a, b);
        }
        let lies_once = |_: usize, x: &[[f64; 2]]| {
            let longest = (0..x.len()).max_by(|&i, &j| {
                let length = |i: usize| distance(&x[i], &x[(i + 1) % x.len()]);
                length(i).total_cmp(&length(j))
            });
            let i = longest.unwrap_or(0);
            let (a, b) = (x[i], x[(i + 1) % x.len()]);
            let beside = [0.5 * (a[0] + b[0]) - BESIDE * (b[1] - a[1]), 0.5 * (a[1] + b[1]) + BESIDE * (b[0] - a[0])];
            winding(&segments, &beside) == 1
        };
        *self = cut.front(lies_once);
    }

    /// Closes gaps between free parts of the surface that are narrower than a share of a cell.
    fn close(
        &mut self,
        mesh: &Mesh<2>,
        geometry: &Geometry,
        locator: &Locator<2>,
        outlines: &[Vec<[f64; 2]>],
    ) -> Result<(), Lost> {
        let wall = self.walls(mesh, geometry, locator);
        let count = self.position.len();
        // Of each marker the size of the cell, the loop, and the length of the loop up to there.
        let size = self.sizes(mesh, geometry, locator)?;
        let (mut of, mut along, mut lengths) = (vec![0; count], vec![0.0; count], Vec::new());
        for l in 0..self.loops() {
            let (x, first) = (self.markers(l), self.first[l] as usize);
            let mut length = 0.0;
            for i in 0..x.len() {
                (of[first + i], along[first + i]) = (l, length);
                length += distance(&x[i], &x[(i + 1) % x.len()]);
            }
            lengths.push(length);
        }
        let x = &self.position;
        let mut chain = Chain::of(self);
        let mut before = vec![0; count];
        chain.next.iter().enumerate().for_each(|(i, &next)| before[next] = i);
        // Soil against both sides of a thin wall is nothing that meets.
        let on_structure = |x: &[f64; 2], size: f64| {
            let near = |piece: &[[f64; 2]]| nearest(x, &[piece[0], piece[1]]).1 < ON * size;
            outlines.iter().any(|outline| outline.windows(2).any(near))
        };
        let against: Vec<bool> = x.iter().zip(&size).map(|(x, size)| on_structure(x, *size)).collect();
        let free: Vec<usize> = (0..count).filter(|&i| !wall[i] && !wall[before[i]]).collect();
        let greatest = free.iter().map(|&i| size[i]).fold(0.0, f64::max);
        let bins = Bins::new(free.iter().map(|&i| (x[i], x[i])), GAP * greatest);
        let opposite = |i: usize| {
            let facing = |j: usize| {
                let gap = distance(&x[i], &x[j]);
                let apart = (along[i] - along[j]).abs();
                let apart = if of[i] == of[j] { apart.min(lengths[of[i]] - apart) } else { f64::INFINITY };
                // The material is on the left of the surface: a gap is on the right.
                let on_right = twice_area(&[x[before[i]], x[chain.next[i]], x[j]]) < 0.0;
                let parted = against[i] && against[j];
                (!parted && gap < GAP * size[i] && apart > ALONG * gap + 0.5 * size[i] && on_right).then_some((gap, j))
            };
            let near = bins.around(&x[i]).flatten().filter_map(|&k| facing(free[k as usize]));
            near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, j)| j)
        };
        let pairs: Vec<[usize; 2]> = free
            .iter()
            .filter_map(|&i| opposite(i).filter(|&j| i < j && opposite(j) == Some(i)).map(|j| [i, j]))
            .collect();
        for [i, j] in pairs {
            chain.next.swap(i, j);
        }
        let spacing = |first: usize| size[first] / PER_LENGTH as f64;
        *self = chain.front(|first, x| area(x).abs() > spacing(first).powi(2));
        Ok(())
    }
}

/// Markers nearer to a structure than this share of a cell lie on it.
const ON: f64 = 1e-6;

/// How far beside a segment (-), in its length, it is seen what lies there.
const BESIDE: f64 = 1e-6;
