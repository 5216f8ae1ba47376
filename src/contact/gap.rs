//! How far the soil is from the segments of a boundary: by the followed surface of the soil, and by its nearest material points.

use super::motion::{PARTS, Spot};
use super::place::{Placed, Segments};
use super::surface::Surface;
use crate::geometry::{Bins, Line, Lines, at, distance, dot, foot, way};
use crate::kinematics::Kinematics;
use crate::points::Points;
use rayon::prelude::*;
use std::ops::Range;

/// Points this many spacings away are no surface that a segment faces.
const REACH: f64 = 2.5;

/// Stretch up to which a point is as wide as its deformation says. Soil that has flowed along the boundary and then turned
/// stretches without end; the points beside such a one have long left, and it is no wider for it.
const WIDEST: f64 = 1.5;

/// Cosine of the angle between the normals of a segment and of the surface of the soil from which on they face each other.
const FACING: f64 = -0.3;

/// A point of soil near a boundary.
#[derive(Clone, Copy, Debug)]
struct Near {
    point: u32,
    segment: u32,
    /// Signed distance (m), negative in the structure, and the half width of the point (m) across the boundary.
    distance: f64,
    half_width: f64,
    spacing: f64,
    normal: [f64; 2],
    /// What is a metre farther out across the boundary was seeded by so much (m) from where the point was.
    farther: [f64; 2],
}

/// What a segment faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gap {
    /// Distance (m) between the segment and the soil, negative where they overlap, by its nearest point.
    pub open: f64,
    /// The nearest point of soil, and the spacing (m) of the points there.
    pub point: u32,
    pub spacing: f64,
}

/// The points of some regions as soil.
#[derive(Clone, Copy)]
pub struct Soil<'a> {
    pub points: &'a Points<2>,
    pub regions: &'a [u16],
    /// Whether each cell has points that integrals are summed over: where it has none, its material points resist nothing. `None` counts all.
    pub integrated: Option<&'a [bool]>,
}

impl Soil<'_> {
    /// Width (m) of point `p` when seeded, as far from the axis as its hoop stretch tells.
    fn width<K: Kinematics<2>>(&self, p: usize) -> f64 {
        let points = self.points;
        (points.initial_volume[p] * points.deformation[p][(2, 2)] / K::measure(&points.position[p])).sqrt()
    }

    /// The points within `REACH` spacings of the segments.
    fn near<K: Kinematics<2>>(&self, segments: &Segments) -> Vec<Near> {
        let points = self.points;
        let resists = |p: usize| self.integrated.is_none_or(|cells| cells[points.cell[p] as usize]);
        let ours = |p: &usize| self.regions.contains(&points.region[*p]) && resists(*p);
        let widest =
            (0..points.len()).into_par_iter().filter(ours).map(|p| self.width::<K>(p)).reduce(|| 0.0, f64::max);
        let longest = segments.0.iter().map(|s| distance(&s.to, &s.from)).fold(0.0, f64::max);
        let side = (1.0 + REACH) * widest + longest;
        let bins = Bins::new(segments.0.iter().map(|s| (s.from, s.to)), side);
        let near = |p| self.nearest::<K>(segments, &bins, p);
        (0..points.len()).into_par_iter().filter(ours).filter_map(near).collect()
    }

    fn nearest<K: Kinematics<2>>(&self, segments: &Segments, bins: &Bins, p: usize) -> Option<Near> {
        let x = &self.points.position[p];
        let mut best: Option<(f64, u32, [f64; 2])> = None;
        for &s in bins.around(x).flatten() {
            let segment = &segments.0[s as usize];
            let line = [segment.from, segment.to];
            let from_foot = way(&at(&line, foot(x, &line).clamp(0.0, 1.0)), x);
            let square = dot(&from_foot, &from_foot);
            // Of two segments that meet nearest to the point the one that faces it more tells the side.
            let face = dot(&from_foot, &segment.normal);
            let closer = best.is_none_or(|(other, s, from)| {
                let n = segments.0[s as usize].normal;
                square < other * (1.0 - 1e-9) || square <= other * (1.0 + 1e-9) && face.abs() > dot(&from, &n).abs()
            });
            if closer {
                best = Some((square, s, from_foot));
            }
        }
        let (square, s, from_foot) = best?;
        let spacing = self.width::<K>(p);
        let segment = &segments.0[s as usize];
        if segment.passes(x) {
            return None;
        }
        let outside = dot(&from_foot, &segment.normal) >= 0.0;
        let distance = if outside { square.sqrt() } else { -square.sqrt() };
        if distance.abs() > (REACH + 1.0) * spacing {
            return None;
        }
        let f = &self.points.deformation[p];
        let n = segment.normal;
        let back = [f[(0, 0)] * n[0] + f[(1, 0)] * n[1], f[(0, 1)] * n[0] + f[(1, 1)] * n[1]];
        let stretch = back[0].hypot(back[1]);
        Some(Near {
            point: p as u32,
            segment: s,
            distance,
            half_width: 0.5 * spacing * stretch.min(WIDEST),
            spacing,
            normal: n,
            farther: back.map(|b| b / (stretch * stretch)),
        })
    }
}

/// The gap of each segment by the points within a spacing of it along the boundary; `None` where there is no point or it is farther than `REACH` spacings.
pub fn raw_gaps<K: Kinematics<2>>(surface: &Surface, segments: &Segments, soil: &Soil) -> Vec<Option<Gap>> {
    let mut near = soil.near::<K>(segments);
    near.sort_unstable_by_key(|n| (n.segment, n.point));
    let mut gaps: Vec<Option<Gap>> = vec![None; segments.0.len()];
    let length = |piece: &Range<usize>| segments.0[piece.clone()].iter().map(|s| distance(&s.from, &s.to)).sum::<f64>();
    let lengths: Vec<f64> = surface.pieces.iter().map(length).collect();
    for near in &near {
        let own = near.segment as usize;
        let Some(number) = surface.pieces.iter().position(|piece| piece.contains(&own)) else { continue };
        let open = near.distance - near.half_width;
        if open > REACH * near.spacing {
            continue;
        }
        let mut offer = |s: usize| {
            if gaps[s].is_none_or(|gap| open < gap.open) {
                gaps[s] = Some(Gap { open, point: near.point, spacing: near.spacing });
            }
        };
        offer(own);
        let (piece, is_loop) = (&surface.pieces[number], surface.runs[number].1);
        let (place, count) = (own - piece.start, piece.len());
        for ahead in [true, false] {
            for k in 1..count {
                let at = if ahead { place + k } else { place + count - k };
                let beyond_end = ahead == (at >= count);
                let s = piece.start + at % count;
                let way = (segments.0[s].along - segments.0[own].along).abs();
                let away = if beyond_end { lengths[number] - way } else { way };
                if beyond_end && !is_loop || away > near.spacing {
                    break;
                }
                offer(s);
            }
        }
    }
    gaps
}

/// The cosine of the turn between two pieces of the surface below which there is a corner.
const CORNER: f64 = 0.8;

/// The surface of the soil, to be seen from segments.
pub struct Facing {
    pieces: Lines,
    /// The mean curvature (1/m) of the surface at the ends of each piece, positive where the soil is convex.
    curvature: Vec<f64>,
}

impl Facing {
    /// That of loops of markers, to be seen by soil whose points are up to `spacing` (m) apart.
    pub fn new(loops: &[Vec<[f64; 2]>], spacing: f64) -> Self {
        let pieces: Vec<Line<2>> =
            loops.iter().flat_map(|x| (0..x.len()).map(|i| [x[i], x[(i + 1) % x.len()]])).collect();
        let curved = |x: &Vec<[f64; 2]>| {
            let count = x.len();
            let way = |i: usize| [0, 1].map(|d| x[(i + 1) % count][d] - x[i % count][d]);
            let at = |i: usize| {
                let ([a, b], [c, d]) = (way(i + count - 1), way(i));
                let (sine, cosine, lengths) = (a * d - b * c, a * c + b * d, [a.hypot(b), c.hypot(d)]);
                // A corner bends nothing.
                let smooth = cosine > CORNER * lengths[0] * lengths[1];
                if smooth { 2.0 * sine.atan2(cosine) / (lengths[0] + lengths[1]) } else { 0.0 }
            };
            (0..count).map(|i| 0.5 * (at(i) + at(i + 1))).collect::<Vec<_>>()
        };
        let curvature = loops.iter().flat_map(curved).collect();
        Self { pieces: Lines::new(pieces, REACH * spacing), curvature }
    }

    /// Distance (m) from the middle of a segment along its normal to a surface that faces it, within `REACH` spacings,
    /// negative where the soil overlaps the structure.
    pub fn distance(&self, segment: &Placed, spacing: f64) -> Option<f64> {
        let n = segment.normal;
        // The soil is on the left of its surface: its normal out of the soil is to face the segment.
        let facing = |piece: usize| {
            let [a, b] = &self.pieces.lines[piece];
            let (along, length) = (way(a, b), distance(a, b));
            (along[1] * n[0] - along[0] * n[1], length)
        };
        let mut best: Option<f64> = None;
        let faces = |piece: usize| {
            let (facing, length) = facing(piece);
            facing <= FACING * length
        };
        for hit in self.pieces.hits(segment.middle, n, faces) {
            // The surface bulges between its markers; what it bulges by goes against the normal, nearly.
            let (facing, length) = facing(hit.line);
            let bulge = 0.5 * self.curvature[hit.line] * hit.share * (1.0 - hit.share) * length * facing;
            let t = hit.distance + bulge;
            if t.abs() <= REACH * spacing && best.is_none_or(|best| t.abs() < best.abs()) {
                best = Some(t);
            }
        }
        best
    }

    /// How the distance from a segment to the surface that faces it varies along it: nothing of what is farther than `reach` (m).
    pub fn along(&self, segment: &Placed, spacing: f64, reach: f64) -> Vec<Spot> {
        let (way, length) = (way(&segment.from, &segment.to), distance(&segment.from, &segment.to));
        let spot = |part: f64| {
            // Between its ends the segment bulges.
            let bulge = 0.5 * segment.curvature * length * length * part * (1.0 - part);
            let middle = [0, 1].map(|d| segment.from[d] + part * way[d] + bulge * segment.normal[d]);
            let open = self.distance(&Placed { middle, ..*segment }, spacing).filter(|open| *open < reach)?;
            let share = segment.area / PARTS.len() as f64;
            Some(Spot { share, along: segment.along + (part - 0.5) * length, open })
        };
        PARTS.into_iter().filter_map(spot).collect()
    }
}

/// Moves points that are in the structure, or nearer to it than half their half width, out to there. Each then stands for the
/// soil that is there. Returns how many and the farthest move (m).
pub fn project_out<K: Kinematics<2>>(segments: &Segments, points: &mut Points<2>, regions: &[u16]) -> (usize, f64) {
    let near = Soil { points, regions, integrated: None }.near::<K>(segments);
    let (mut count, mut most) = (0, 0.0f64);
    for near in near {
        let by = 0.5 * near.half_width - near.distance;
        if by > 0.0 {
            count += 1;
            most = most.max(by);
            let p = near.point as usize;
            for d in 0..2 {
                points.position[p][d] += by * near.normal[d];
                points.origin[p][d] += by * near.farther[d];
            }
        }
    }
    (count, most)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kinematics::PlaneStrain;
    use crate::tensor::Tensor;

    /// Soil around a round structure touches it all along: between the markers of its surface as much as at them.
    #[test]
    fn a_surface_is_curved_between_its_markers() {
        let (radius, count) = (0.5, 24);
        let at = |t: f64| [radius * t.cos(), radius * t.sin()];
        let angle = |i: f64| -std::f64::consts::TAU * i / f64::from(count);
        // A hole in the soil: clockwise.
        let facing = Facing::new(&[(0..count).map(|i| at(angle(f64::from(i)))).collect()], 0.1);
        let sagitta = radius * (1.0 - (0.5 * angle(1.0)).cos());
        for i in 0..100 {
            let x = at(angle(0.237 * f64::from(i)));
            let placed = Placed {
                from: x,
                to: x,
                middle: x,
                normal: x.map(|x| x / radius),
                area: 1.0,
                curvature: 1.0 / radius,
                along: 0.0,
                ends: [false; 2],
                value: [0.0; 3],
            };
            let gap = facing.distance(&placed, 0.1).unwrap();
            assert!(gap.abs() < 0.01 * sagitta, "{i}: {gap} of {sagitta}");
        }
        // Straight pieces stay straight up to a corner.
        let loops = [vec![[0.0, 0.0], [0.0, -1.0], [1.0, -1.0], [1.0, 0.0], [0.9, 0.0], [0.8, 0.0]]];
        let facing = Facing::new(&loops, 0.1);
        let normal = [0.0, -1.0];
        let placed = Placed {
            from: [0.95, 0.0],
            to: [0.95, 0.0],
            middle: [0.95, 0.0],
            normal,
            area: 1.0,
            curvature: 0.0,
            along: 0.0,
            ends: [false; 2],
            value: [0.0; 3],
        };
        assert_eq!(facing.distance(&placed, 0.1), Some(0.0));
    }

    /// A round segment over level ground is lowest where it touches.
    #[test]
    fn parts_of_a_round_segment_have_their_own_gaps() {
        let (radius, half) = (0.5f64, 0.01f64);
        let at = |x: f64| [x, radius - (radius * radius - x * x).sqrt()];
        let placed = Placed {
            from: at(-half),
            to: at(half),
            middle: at(0.0),
            normal: [0.0, -1.0],
            area: 2.0 * half,
            curvature: 1.0 / radius,
            along: 0.3,
            ends: [false; 2],
            value: [0.0; 3],
        };
        let facing = Facing::new(&[vec![[-1.0, -1.0], [1.0, -1.0], [1.0, 0.0], [-1.0, 0.0]]], 0.1);
        let spots = facing.along(&placed, 0.1, 0.1);
        assert_eq!(spots.len(), PARTS.len());
        for spot in &spots {
            let gap = at(spot.along - 0.3)[1];
            assert!(
                (spot.open - gap).abs() < 1e-3 * half * half / radius && spot.share == 0.5 * half,
                "{spot:?} {gap}"
            );
        }
        assert!(facing.along(&placed, 0.1, -1.0).is_empty());
    }

    /// A point below a flat boundary that faces up is moved to where a quarter of its width is above it, at most one and a half times that however
    /// it was sheared before the boundary came.
    #[test]
    fn sheared_points_are_pushed_no_farther_than_their_width() {
        let placed = Placed {
            from: [-0.1, 0.0],
            to: [0.1, 0.0],
            middle: [0.0, 0.0],
            normal: [0.0, 1.0],
            area: 0.2,
            curvature: 0.0,
            along: 0.1,
            ends: [false; 2],
            value: [0.0; 3],
        };
        let sheared = Tensor::new(1.0, 0.0, 0.0, 40.0, 1.0, 0.0, 0.0, 0.0, 1.0);
        for (deformation, to) in [(Tensor::identity(), 0.025), (sheared, 0.0375)] {
            let mut points = Points {
                position: vec![[0.0, -0.005]],
                origin: vec![[0.0, -0.005]],
                initial_volume: vec![0.01],
                deformation: vec![deformation],
                region: vec![0],
                ..Points::default()
            };
            let (count, most) = project_out::<PlaneStrain>(&Segments(vec![placed]), &mut points, &[0]);
            assert_eq!(count, 1);
            assert!((points.position[0][1] - to).abs() < 1e-15 && (most - to - 0.005).abs() < 1e-15, "{points:?}");
            // What it stands for has moved as far along the normal.
            let [x, y] = [0, 1].map(|d| points.origin[0][d] - [0.0, -0.005][d]);
            let moved = deformation * nalgebra::Vector3::new(x, y, 0.0);
            assert!(moved.y > 0.0 && (x.hypot(y) - most / deformation.row(1).norm()).abs() < 1e-15, "{points:?}");
        }
    }

    /// A crumb, a point in a cell that integrals leave out, is no soil.
    #[test]
    fn points_that_resist_nothing_are_not_near() {
        let placed = Placed {
            from: [-0.1, 0.0],
            to: [0.3, 0.0],
            middle: [0.1, 0.0],
            normal: [0.0, 1.0],
            area: 0.4,
            curvature: 0.0,
            along: 0.2,
            ends: [false; 2],
            value: [0.0; 3],
        };
        let points = Points {
            position: vec![[0.0, 0.05], [0.2, 0.05]],
            origin: vec![[0.0, 0.05], [0.2, 0.05]],
            initial_volume: vec![0.01; 2],
            deformation: vec![Tensor::identity(); 2],
            region: vec![0; 2],
            cell: vec![0, 1],
            ..Points::default()
        };
        let near = |integrated| {
            let near = Soil { points: &points, regions: &[0], integrated }.near::<PlaneStrain>(&Segments(vec![placed]));
            near.iter().map(|near| near.point).collect::<Vec<_>>()
        };
        assert_eq!(near(None), [0, 1]);
        assert_eq!(near(Some(&[true, false])), [0]);
    }
}
