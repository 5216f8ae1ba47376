//! Where the surface lies against a structure it is the boundary of that: markers near it are taken anew from it.
//!
//! The structure slides along the material, and markers that went with the material would crowd and fold at its edges.

use super::{Lost, MarkerFront, PER_LENGTH};
use crate::geometry::{Bins, distance, nearest, twice_area};
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::surface::geometry::Geometry;

/// Markers lie against a structure that are nearer to it than this share of a cell, but where contact is open.
const NEAR: f64 = 0.15;
/// So do those within it, by less than this share of a cell.
const DEEP: f64 = 1.0;

/// The contact status of a piece of the boundary of a structure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ContactStatus {
    /// Structure and soil exert pressure or shear on each other.
    Closed,
    /// There is a gap.
    Open,
    /// Contact is closed on a part of the piece only.
    Mixed,
}

/// The place of an outline that a marker lies at.
#[derive(Clone, Copy)]
struct Foot {
    outline: usize,
    /// Arc length (m) along it.
    along: f64,
}

/// A polyline with the arc length of its vertices.
struct Outline<'a> {
    x: &'a [[f64; 2]],
    along: Vec<f64>,
    /// The contact status of each piece.
    contact: &'a [ContactStatus],
    closed: bool,
}

impl<'a> Outline<'a> {
    fn new(x: &'a [[f64; 2]], contact: &'a [ContactStatus]) -> Self {
        let mut along = vec![0.0];
        for pair in x.windows(2) {
            along.push(along[along.len() - 1] + distance(&pair[0], &pair[1]));
        }
        let closed = x.len() > 2 && distance(&x[0], &x[x.len() - 1]) < 1e-9 * along[along.len() - 1];
        Self { x, along, contact, closed }
    }

    fn length(&self) -> f64 {
        self.along[self.along.len() - 1]
    }

    /// The place at an arc length.
    fn at(&self, s: f64) -> [f64; 2] {
        let s = if self.closed { s.rem_euclid(self.length()) } else { s.clamp(0.0, self.length()) };
        let i = self.along.partition_point(|&a| a < s).clamp(1, self.x.len() - 1);
        let t = (s - self.along[i - 1]) / (self.along[i] - self.along[i - 1]);
        [0, 1].map(|d| self.x[i - 1][d] + t * (self.x[i][d] - self.x[i - 1][d]))
    }

    /// An arc length, or the end of an open outline within `reach` of it: that is on a wall, and the surface goes up to it.
    fn snap(&self, s: f64, reach: f64) -> f64 {
        match [0.0, self.length()].into_iter().find(|end| (s - end).abs() < reach) {
            Some(end) if !self.closed => end,
            _ => s,
        }
    }

    /// Whether contact is closed from one arc length to a larger one.
    fn is_closed(&self, from: f64, to: f64) -> bool {
        // A closed outline goes on at both ends.
        let turns = if self.closed { -1..=1 } else { 0..=0 };
        let within = |ends: &[f64]| {
            turns.clone().any(|k| {
                let by = f64::from(k) * self.length();
                ends[0] + by < to && ends[1] + by > from
            })
        };
        self.along.windows(2).zip(self.contact).all(|(ends, status)| *status == ContactStatus::Closed || !within(ends))
    }

    /// The way from one arc length to another, the shorter one around a closed outline.
    fn way(&self, from: f64, to: f64) -> f64 {
        let way = to - from;
        if self.closed { way - (way / self.length()).round() * self.length() } else { way }
    }
}

impl MarkerFront {
    /// Takes the markers that lie against `outlines` anew from these, given the contact status of their pieces.
    ///
    /// # Errors
    /// When a marker was outside the mesh, or gets far outside it.
    pub fn conform(
        &mut self,
        mesh: &Mesh<2>,
        geometry: &Geometry,
        locator: &Locator<2>,
        (outlines, contact): (&[Vec<[f64; 2]>], &[Vec<ContactStatus>]),
    ) -> Result<(), Lost> {
        if outlines.is_empty() {
            return Ok(());
        }
        let both = outlines.iter().zip(contact).filter(|(x, _)| x.len() > 1);
        let outlines: Vec<Outline> = both.map(|(x, contact)| Outline::new(x, contact)).collect();
        let pieces: Vec<(usize, usize)> =
            outlines.iter().enumerate().flat_map(|(k, o)| (1..o.x.len()).map(move |i| (k, i))).collect();
        let size = self.sizes(mesh, geometry, locator)?;
        let longest = outlines.iter().flat_map(|o| o.along.windows(2).map(|a| a[1] - a[0])).fold(0.0, f64::max);
        let side = DEEP * size.iter().fold(0.0f64, |a, b| a.max(*b)) + longest;
        let bins = Bins::new(pieces.iter().map(|&(k, i)| (outlines[k].x[i - 1], outlines[k].x[i])), side);
        let mut feet: Vec<Option<Foot>> =
            self.position.iter().zip(&size).map(|(x, h)| foot(&outlines, &pieces, &bins, x, *h)).collect();
        let wall = self.walls(mesh, geometry, locator);
        let mut next = Self { position: Vec::with_capacity(self.position.len() + 16), first: vec![0] };
        for l in 0..self.loops() {
            let range = self.first[l] as usize..self.first[l + 1] as usize;
            pockets(&outlines, &wall[range.clone()], &mut feet[range.clone()]);
            lean_loop(&outlines, &self.position[range.clone()], &feet[range.clone()], &size[range], &mut next.position);
            next.first.push(next.position.len() as u32);
        }
        *self = next;
        self.project_onto_mesh((mesh, locator), geometry)
    }
}

/// The place of the outlines nearest to a marker at `x` in a cell of size `h`, if the marker lies there.
fn foot(outlines: &[Outline], pieces: &[(usize, usize)], bins: &Bins, x: &[f64; 2], h: f64) -> Option<Foot> {
    let mut best: Option<(f64, f64, Option<Foot>)> = None;
    for &piece in bins.around(x).flatten() {
        let (outline, i) = pieces[piece as usize];
        let (a, b) = (outlines[outline].x[i - 1], outlines[outline].x[i]);
        let (share, away) = nearest(x, &[a, b]);
        // The structure is on the left.
        let left = twice_area(&[a, b, *x]) / distance(&a, &b).max(f64::MIN_POSITIVE);
        // Of two pieces whose corner is nearest the one that faces the marker more tells the side.
        let closer = best.as_ref().is_none_or(|(least, other, _)| {
            away < least * (1.0 - 1e-9) || away <= least * (1.0 + 1e-9) && left.abs() > other.abs()
        });
        if closer {
            let along = outlines[outline].along[i - 1] + share * distance(&a, &b);
            // A gap is as wide as it is, however narrow.
            let near = if outlines[outline].contact[i - 1] == ContactStatus::Open { 0.0 } else { NEAR * h };
            let lies = away <= if left > 0.0 { DEEP * h } else { near };
            best = Some((away, left, lies.then_some(Foot { outline, along })));
        }
    }
    best?.2
}

/// Moves onto the structure the markers of voids along which contact is closed: contact bears there, and the cells of the void would not.
fn pockets(outlines: &[Outline], wall: &[bool], feet: &mut [Option<Foot>]) {
    let count = feet.len();
    let Some(begin) = (0..count).find(|&i| feet[i].is_some()) else { return };
    let mut last = begin;
    for i in begin + 1..=begin + count {
        let Some(to) = feet[i % count] else { continue };
        let from = feet[last % count].unwrap_or(to);
        let outline = &outlines[from.outline];
        let free = last + 1..i;
        last = i;
        if from.outline == to.outline && !free.is_empty() && !free.clone().any(|k| wall[k % count]) {
            let way = outline.way(from.along, to.along);
            if way < 0.0 && outline.is_closed(from.along + way, from.along) {
                free.for_each(|k| feet[k % count] = Some(from));
            }
        }
    }
}

/// Appends the markers of a loop, those of each run against an outline taken from it.
fn lean_loop(outlines: &[Outline], x: &[[f64; 2]], feet: &[Option<Foot>], size: &[f64], out: &mut Vec<[f64; 2]>) {
    let count = x.len();
    let lying = |i: usize| feet[i % count];
    let on = |i: usize| lying(i).map(|foot| foot.outline);
    // Begin where no run goes on.
    let Some(begin) = (0..count).find(|&i| on(i).is_none() || on(i) != on(i + count - 1)) else {
        // Soil lies all around a structure. A loop that only runs along the structure and back encloses nothing, and goes.
        let Some(Foot { outline, along: start }) = lying(0) else { return };
        let (outline, along) = (&outlines[outline], |i: usize| lying(i).map_or(start, |foot| foot.along));
        let way: f64 = (0..count).map(|i| outline.way(along(i), along(i + 1))).sum();
        if way.abs() > 0.5 * outline.length() {
            let size = size.iter().copied().fold(f64::INFINITY, f64::min);
            let markers = (outline.length() * PER_LENGTH as f64 / size).ceil();
            out.extend((0..markers as usize).map(|k| outline.at(start - outline.length() * k as f64 / markers)));
        }
        return;
    };
    let mut i = begin;
    while i < begin + count {
        let Some(Foot { outline, along }) = lying(i) else {
            out.push(x[i % count]);
            i += 1;
            continue;
        };
        let outline = &outlines[outline];
        let spacing = size[i % count] / PER_LENGTH as f64;
        let along = outline.snap(along, 0.5 * spacing);
        let (mut way, mut last) = (0.0, along);
        let mut end = i + 1;
        while end < begin + count && on(end) == on(i) {
            if let Some(foot) = lying(end) {
                let along = outline.snap(foot.along, 0.5 * spacing);
                way += outline.way(last, along);
                last = along;
            }
            end += 1;
        }
        let markers = (way.abs() / spacing).ceil();
        // The material is on the left of its surface, as the structure is of its own: they run against each other.
        let way = way.min(0.0);
        let markers = if way == 0.0 { 0.0 } else { markers };
        out.extend((0..=markers as usize).map(|k| outline.at(along + way * k as f64 / markers.max(1.0))));
        i = end;
    }
}
