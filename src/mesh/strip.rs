//! A strip of one layer of eight-node quadrilaterals along an axis: what stands for a wall, a lining or a slab.
//!
//! With 2 × 2 integration points it bends as a beam of its height does, without locking.

use super::shape::CellKind;
use super::{Group, Mesh};
use crate::geometry::{Line, cross, distance, dot, nearest, side, way, winding};

/// The least cosine (-) of half the angle by which an axis turns at a corner.
const SHARPEST: f64 = 0.5;
/// How far (-) a place may be beside the axis, in thicknesses.
const ON_AXIS: f64 = 1e-6;

/// A place on the axis where elements end, and half the thickness across it, to the left (m).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Station {
    at: [f64; 2],
    left: [f64; 2],
}

impl Station {
    /// Places (m) across it: to the right, on the axis, to the left.
    fn across(&self) -> [[f64; 2]; 3] {
        [-1.0, 0.0, 1.0].map(|s| [0, 1].map(|d| self.at[d] + s * self.left[d]))
    }
}

/// A strip along an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Strip {
    /// Those of a ring end before the first one comes again.
    stations: Vec<Station>,
    closed: bool,
}

impl Strip {
    /// The strip along `axis` (m), with elements of a length up to `size` (m) that end at each corner and at `stops`.
    ///
    /// # Errors
    /// The place of a stop beside the axis, or of a corner that is too sharp for the thickness or the elements, with what is wrong.
    pub fn new(
        axis: &[[f64; 2]],
        thickness: f64,
        size: f64,
        stops: &[[f64; 2]],
    ) -> Result<Self, ([f64; 2], &'static str)> {
        let mut corners: Vec<[f64; 2]> = axis.to_vec();
        for stop in stops {
            let near = |c: &[[f64; 2]]| nearest(stop, &[c[0], c[1]]);
            let on = corners.windows(2).position(|c| near(c).1 <= ON_AXIS * thickness);
            let k = on.ok_or((*stop, "lies beside the axis"))?;
            if [k, k + 1].iter().all(|&k| distance(&corners[k], stop) > ON_AXIS * thickness) {
                corners.insert(k + 1, *stop);
            }
        }
        let closed = corners.first() == corners.last();
        let pieces = corners.len() - 1;
        let normal = |k: usize| {
            let (along, length) = (way(&corners[k], &corners[k + 1]), distance(&corners[k], &corners[k + 1]));
            [-along[1] / length, along[0] / length]
        };
        let corner = |before: usize, after: usize| {
            let (a, b) = (normal(before), normal(after));
            let half = 0.5 * thickness / (0.5 * (1.0 + dot(&a, &b))).max(f64::MIN_POSITIVE);
            [0, 1].map(|d| 0.5 * half * (a[d] + b[d]))
        };
        let mut stations = Vec::new();
        for k in 0..pieces {
            let before = if k > 0 { Some(k - 1) } else { closed.then_some(pieces - 1) };
            if let Some(before) = before
                && (0.5 * (1.0 + dot(&normal(before), &normal(k)))).max(0.0).sqrt() < SHARPEST
            {
                return Err((corners[k], "the axis turns too sharply"));
            }
            stations.push(Station { at: corners[k], left: corner(before.unwrap_or(k), k) });
            let least = if pieces == 1 { 2 } else { 1 };
            let count = ((distance(&corners[k], &corners[k + 1]) / size * (1.0 - 1e-9)).ceil() as usize).max(least);
            let left = normal(k).map(|n| 0.5 * thickness * n);
            stations.extend((1..count).map(|i| {
                let share = i as f64 / count as f64;
                Station { at: [0, 1].map(|d| corners[k][d] + share * (corners[k + 1][d] - corners[k][d])), left }
            }));
        }
        if !closed {
            stations.push(Station { at: corners[pieces], left: corner(pieces - 1, pieces - 1) });
        }
        let strip = Self { stations, closed };
        for [a, b] in strip.elements() {
            let ([r, _, l], [s, _, m]) = (a.across(), b.across());
            let turns = |x: [f64; 2], y: [f64; 2], z: [f64; 2]| cross(&way(&x, &y), &way(&y, &z)) > 0.0;
            if !(turns(r, s, m) && turns(s, m, l) && turns(m, l, r) && turns(l, r, s)) {
                return Err((a.at, "the axis turns too sharply for elements of this length and thickness"));
            }
        }
        Ok(strip)
    }

    /// The number of elements.
    fn count(&self) -> usize {
        self.stations.len() - usize::from(!self.closed)
    }

    /// The stations at the ends of each element.
    fn elements(&self) -> impl Iterator<Item = [Station; 2]> {
        (0..self.count()).map(|k| [self.stations[k], self.stations[(k + 1) % self.stations.len()]])
    }

    /// The middles of the elements (m).
    pub fn middles(&self) -> impl Iterator<Item = [f64; 2]> {
        self.elements().map(|[a, b]| [0, 1].map(|d| 0.5 * (a.at[d] + b.at[d])))
    }

    /// Its outline, with the strip on the left of each line; of a ring the two circles.
    pub fn outline(&self) -> Vec<Line<2>> {
        let mut lines = Vec::new();
        for [a, b] in self.elements() {
            let ([r, _, l], [s, _, m]) = (a.across(), b.across());
            lines.extend([[r, s], [m, l]]);
        }
        if let (false, Some(first), Some(last)) = (self.closed, self.stations.first(), self.stations.last()) {
            let ([r, _, l], [s, _, m]) = (first.across(), last.across());
            lines.extend([[l, r], [s, m]]);
        }
        lines
    }

    /// The corners of its outline (m), first the right side along the axis, then the left side back.
    pub fn corners(&self) -> Vec<[f64; 2]> {
        let turns = |k: usize| {
            let n = self.stations.len();
            let is_end = !self.closed && (k == 0 || k + 1 == n);
            let [a, x, b] = [(k + n - 1) % n, k, (k + 1) % n].map(|k| self.stations[k].at);
            let (before, after) = (way(&a, &x), way(&x, &b));
            is_end || cross(&before, &after).abs() > 1e-9 * distance(&a, &x) * distance(&x, &b)
        };
        let kept: Vec<[[f64; 2]; 3]> =
            (0..self.stations.len()).filter(|&k| turns(k)).map(|k| self.stations[k].across()).collect();
        kept.iter().map(|x| x[0]).chain(kept.iter().rev().map(|x| x[2])).collect()
    }

    /// How deep (m) a place is within the strip with the `outline`; negative outside.
    pub fn depth(outline: &[Line<2>], x: &[f64; 2]) -> f64 {
        let to = outline.iter().map(|line| nearest(x, line).1).fold(f64::INFINITY, f64::min);
        let on = outline.iter().any(|line| nearest(x, line).1 == 0.0 && side(line, x) == 0.0);
        if on || winding(outline, x) != 0 { to } else { -to }
    }

    /// Appends its nodes and elements to a mesh, as the region of this number, and groups for its sides, ends and `points` (m), by name; `curves`
    /// are those of the right and the left side, of the start and of the end.
    pub fn append(&self, mesh: &mut Mesh<2>, region: u16, curves: &[String], points: &[(String, [f64; 2])]) {
        let mut new = |x: [f64; 2]| {
            mesh.nodes.push(x);
            (mesh.nodes.len() - 1) as u32
        };
        let stations: Vec<[u32; 3]> = self.stations.iter().map(|station| station.across().map(&mut new)).collect();
        let middle = |a: [f64; 2], b: [f64; 2]| [0, 1].map(|d| 0.5 * (a[d] + b[d]));
        let sides: Vec<[u32; 2]> =
            self.elements().map(|[a, b]| [0, 2].map(|side| new(middle(a.across()[side], b.across()[side])))).collect();
        let mut facets: [Vec<(CellKind, Vec<u32>)>; 4] = Default::default();
        for (k, [right, left]) in sides.into_iter().enumerate() {
            let ([r, c, l], [s, d, m]) = (stations[k], stations[(k + 1) % stations.len()]);
            mesh.cells.push(CellKind::Q8, region, &[r, s, m, l, right, d, left, c]);
            facets[0].push((CellKind::Line3, vec![r, s, right]));
            facets[1].push((CellKind::Line3, vec![m, l, left]));
        }
        for (end, station) in [stations.first(), stations.last()].into_iter().enumerate() {
            facets[2 + end].extend(station.map(|[r, c, l]| (CellKind::Line3, vec![*r, *l, *c])));
        }
        mesh.groups.extend(curves.iter().zip(facets).map(|(name, facets)| Group::of(name.as_str(), 1, facets)));
        let axis: Vec<u32> = stations.iter().map(|nodes| nodes[1]).collect();
        for (name, x) in points {
            let apart = |n: &u32| distance(&mesh.nodes[*n as usize], x);
            let node = axis.iter().copied().min_by(|a, b| apart(a).total_cmp(&apart(b)));
            let facet = node.map(|n| (CellKind::Point1, vec![n])).into_iter().collect();
            mesh.groups.push(Group::of(name.as_str(), 0, facet));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    /// The area of the cells.
    fn area(mesh: &Mesh<2>) -> f64 {
        let of = |c: usize| crate::geometry::area(&mesh.coordinates(c)[..4]);
        (0..mesh.cells.len()).map(of).sum()
    }

    #[test]
    fn a_strip_has_its_area_its_outline_and_its_groups() {
        let axis = [[0.0, 0.0], [0.0, -3.0], [2.0, -3.0]];
        let strip = Strip::new(&axis, 0.2, 0.5, &[[0.0, -1.1]]).unwrap();
        let mut mesh = Mesh::default();
        let curves = ["right", "left", "start", "end"].map(String::from);
        strip.append(&mut mesh, 0, &curves, &[("strut".into(), [0.0, -1.1])]);
        assert_eq!(mesh.cells.len(), 3 + 4 + 4);
        assert!((area(&mesh) - 0.2 * 5.0).abs() < 1e-12, "{}", area(&mesh));
        assert_eq!(mesh.nodes[mesh.group("strut").unwrap().nodes[0] as usize], [0.0, -1.1]);
        let outline = strip.outline();
        for (x, depth) in [([0.0, -1.0], 0.1), ([0.05, -2.0], 0.05), ([0.3, -1.0], -0.2), ([1.0, -3.1], 0.0)] {
            assert!((Strip::depth(&outline, &x) - depth).abs() < 1e-12, "{x:?} {}", Strip::depth(&outline, &x));
        }
        // Going down, the right side is to the west.
        assert_eq!(strip.corners().len(), 6);
        assert_eq!(strip.corners()[0], [-0.1, 0.0]);
        assert!(mesh.group("left").unwrap().nodes.iter().all(|&n| mesh.nodes[n as usize][0] > 0.09));
    }

    #[test]
    fn a_ring_closes() {
        let mut axis: Vec<[f64; 2]> = (0..40).map(|k| TAU * f64::from(k) / 40.0).map(|a| [a.cos(), a.sin()]).collect();
        axis.push(axis[0]);
        let strip = Strip::new(&axis, 0.1, 1.0, &[]).unwrap();
        let mut mesh = Mesh::default();
        strip.append(&mut mesh, 0, &["right", "left"].map(String::from), &[]);
        assert_eq!((mesh.cells.len(), mesh.nodes.len()), (40, 40 * 5));
        let polygon = 0.5 * 40.0 * (TAU / 40.0).sin() / (TAU / 80.0).cos().powi(2);
        assert!((area(&mesh) / (polygon * (1.05f64.powi(2) - 0.95f64.powi(2))) - 1.0).abs() < 0.01);
        assert!(Strip::depth(&strip.outline(), &[0.0, 0.0]) < 0.0);
        assert!(Strip::depth(&strip.outline(), &[1.0, 0.0]) > 0.0);
    }

    #[test]
    fn what_cannot_be_a_strip_is_refused() {
        let straight = [[0.0, 0.0], [1.0, 0.0]];
        assert!(Strip::new(&straight, 0.1, 1.0, &[[0.5, 0.1]]).is_err());
        assert!(Strip::new(&[[0.0, 0.0], [1.0, 0.0], [0.0, 0.1]], 0.1, 1.0, &[]).is_err());
        assert!(Strip::new(&[[0.0, 0.0], [1.0, 0.0], [1.0, 0.04], [0.0, 0.04]], 0.1, 1.0, &[]).is_err());
    }
}
