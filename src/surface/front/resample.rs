//! Markers come and go as the free surface stretches and shrinks.

use super::{Lost, MarkerFront, PER_LENGTH};
use crate::geometry::distance;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::surface::geometry::Geometry;

/// Segments longer than this multiple of the wanted spacing are split.
const LONG: f64 = 1.8;
/// Segments shorter than this are joined.
const SHORT: f64 = 0.4;
/// The cosine of the turn between segments from which on a marker is a corner: it stays, and nothing is rounded there.
const CORNER: f64 = 0.8;
/// The least markers of a loop.
const LEAST: usize = 8;

impl MarkerFront {
    /// Evens out the spacing of the markers on free segments; `wall` says of each segment whether it is none.
    pub(super) fn resample(
        &mut self,
        mesh: &Mesh<2>,
        geometry: &Geometry,
        locator: &Locator<2>,
        wall: &[bool],
    ) -> Result<(), Lost> {
        let sizes = self.sizes(mesh, geometry, locator)?;
        let wanted: Vec<f64> = sizes.iter().map(|size| size / PER_LENGTH as f64).collect();
        let position = Vec::with_capacity(self.position.len() + 16);
        let mut next = Self { position, first: vec![0] };
        for l in 0..self.loops() {
            let range = self.first[l] as usize..self.first[l + 1] as usize;
            resample_loop(&self.position[range.clone()], &wall[range.clone()], &wanted[range], &mut next.position);
            next.first.push(next.position.len() as u32);
        }
        *self = next;
        Ok(())
    }
}

fn resample_loop(x: &[[f64; 2]], wall: &[bool], wanted: &[f64], out: &mut Vec<[f64; 2]>) {
    let count = x.len();
    let (before, after) = (|i: usize| (i + count - 1) % count, |i: usize| (i + 1) % count);
    let smooth = |i: usize| {
        let (a, b, c) = (x[before(i)], x[i], x[after(i)]);
        let dot = (b[0] - a[0]) * (c[0] - b[0]) + (b[1] - a[1]) * (c[1] - b[1]);
        !wall[before(i)] && !wall[i] && dot >= CORNER * distance(&a, &b) * distance(&b, &c)
    };
    let mut left_out = false;
    for i in 0..count {
        let spacing = wanted[i].min(wanted[after(i)]);
        // A marker that is too near to the one before it goes, never two in a row.
        let near = distance(&x[before(i)], &x[i]) < SHORT * spacing;
        left_out = near && !left_out && i > 0 && count > LEAST && smooth(i) && smooth(before(i));
        if !left_out {
            out.push(x[i]);
        }
        let (a, b) = (x[i], x[after(i)]);
        if wall[i] || distance(&a, &b) <= LONG * spacing {
            continue;
        }
        // The middle of the cubic through four markers of like spacing keeps the area of a bend.
        let (p, q) = (x[before(i)], x[after(after(i))]);
        let length = distance(&a, &b);
        let like = |d: f64| d > 0.5 * length && d < 2.0 * length;
        let curved = smooth(i) && smooth(after(i)) && like(distance(&p, &a)) && like(distance(&b, &q));
        out.push([0, 1].map(|d| {
            let middle = 0.5 * (a[d] + b[d]);
            if curved { middle + (a[d] + b[d] - p[d] - q[d]) / 16.0 } else { middle }
        }));
    }
}
