//! Contact between two bodies: the boundary of one and, seen from it along its normal, that of the other.
//!
//! Segments, contact nodes and their conditions are those of the first. Segments are cut where a facet of the other boundary ends
//! across them, and have two points of Gauss's rule between cuts: then a uniform pressure is handed on exactly between straight
//! boundaries, whatever their meshes. What is across a point is a place on a facet of the other boundary, found where
//! the two are at the beginning of the step: gap and slip are those of the displacements there, interpolated by its
//! shape functions.

use super::along::{Mark, lines};
use super::constraint::{Constraint, Entry, FADING, add};
use super::interface::{Ground, Interface, Pushed, TANGENTIAL};
use super::law::Penalty;
use super::motion::{PARTS, Spot};
use super::multipliers::Multipliers;
use super::place::{Placed, Segments};
use super::sides::Sides;
use super::surface::{Run, Segment, Surface};
use crate::geometry::{Hit, Lines, distance, dot, foot, way};
use crate::kinematics::Kinematics;
use crate::mesh::shape::MAX_NODES;
use crate::points::Points;
use std::collections::BTreeMap;
use std::marker::PhantomData;

/// How far (-) across a segment the other boundary is looked for, in distances of the contact nodes.
const REACH: f64 = 2.5;
/// Cosine of the angle between the two normals from which on the boundaries face each other.
const FACING: f64 = -0.3;
/// Iterations for the place on a curved facet, which begin on its chord.
const ITERATIONS: usize = 4;

/// The boundary of a structure on that of another body.
pub struct Bodies<K> {
    pub sides: Sides,
    /// The boundary with the contact nodes, and the other one.
    pub surface: Surface,
    pub other: Surface,
    /// Where one of the two is soil, which has pores.
    pub soil: Option<SoilSide>,
    /// Young's modulus (kPa) of the softer one.
    pub young: f64,
    pub kinematics: PhantomData<K>,
}

/// The side of a contact of bodies that is soil.
pub struct SoilSide {
    /// Whether it is the one with the contact nodes.
    pub has_contact_nodes: bool,
    /// Whether its pores ever hold an excess pressure.
    pub undrained: bool,
    /// The finite element behind each facet of its boundary.
    pub behind: Vec<u32>,
}

impl SoilSide {
    /// The points of the elements behind the boundary.
    fn points(&self, elements: &Points<2>) -> BTreeMap<u32, Vec<usize>> {
        let mut points: BTreeMap<u32, Vec<usize>> = self.behind.iter().map(|&cell| (cell, Vec::new())).collect();
        for (p, cell) in elements.cell.iter().enumerate() {
            if let Some(of_cell) = points.get_mut(cell) {
                of_cell.push(p);
            }
        }
        points
    }
}

/// Places of Gauss's rule of two points in [0, 1].
const GAUSS: [f64; 2] = [0.211_324_865_405_187_1, 0.788_675_134_594_812_9];

/// A point of the boundary with the contact nodes.
struct Point {
    x: [f64; 2],
    /// Unit normal out of the structure.
    normal: [f64; 2],
    /// The area (m²) that it stands for, and its arc length (m) from the middle of the segment.
    area: f64,
    along: f64,
    /// Shape functions of the facet.
    value: [f64; 3],
}

/// What is across a point: a facet of the other boundary, its shape functions and unit normal there, and the gap (m).
struct Across {
    facet: u32,
    value: [f64; 3],
    normal: [f64; 2],
    gap: f64,
}

impl<K: Kinematics<2>> Bodies<K> {
    /// Where a segment is to be cut, as shares of it, ascending from 0 to 1.
    fn cuts(&self, from: &Placed, lines: &Lines, position: &dyn Fn(u32) -> [f64; 2]) -> Vec<f64> {
        let mut cuts = vec![0.0, 1.0];
        for s in lines.near(&from.middle) {
            for &end in &self.other.facets[self.other.segments[s].facet as usize][..2] {
                let to = position(end);
                let share = foot(&to, &[from.from, from.to]);
                let away = dot(&way(&from.from, &to), &from.normal);
                if share > 1e-6 && share < 1.0 - 1e-6 && away.abs() <= REACH * self.surface.spacing {
                    cuts.push(share);
                }
            }
        }
        cuts.sort_by(f64::total_cmp);
        cuts.dedup_by(|a, b| *a - *b < 1e-6);
        cuts
    }

    /// The points of a segment at `places` in [0, 1], of equal weight, between its cuts.
    fn points(
        &self,
        segment: &Segment,
        cuts: &[f64],
        places: &[f64],
        position: &dyn Fn(u32) -> [f64; 2],
    ) -> Vec<Point> {
        let facet = &self.surface.facets[segment.facet as usize];
        let point = |share: f64, part: f64| {
            let xi = segment.from + share * (segment.to - segment.from);
            let (x, tangent, value) = at(&self.surface, facet, xi, position);
            let length = tangent[0].hypot(tangent[1]);
            Point {
                x,
                normal: [tangent[1] / length, -tangent[0] / length],
                area: part * (segment.to - segment.from) * length * K::measure(&x),
                along: (share - 0.5) * (segment.to - segment.from) * length,
                value,
            }
        };
        let part = 1.0 / places.len() as f64;
        let between = |cut: &[f64]| -> Vec<_> {
            let (from, whole) = (cut[0], cut[1] - cut[0]);
            places.iter().map(|place| (from + place * whole, whole)).collect()
        };
        cuts.windows(2).flat_map(between).map(|(share, whole)| point(share, part * whole)).collect()
    }

    /// What a point sees along its normal.
    fn across(
        &self,
        from: &Point,
        other: &Segments,
        lines: &Lines,
        position: &dyn Fn(u32) -> [f64; 2],
    ) -> Option<Across> {
        let (x, n) = (from.x, from.normal);
        let faces = |s: usize| dot(&other.0[s].normal, &n) <= FACING;
        let hits = lines.hits(x, n, faces).filter(|hit| hit.distance.abs() <= REACH * self.surface.spacing);
        let Hit { line: s, share, .. } = hits.min_by(|a, b| a.distance.abs().total_cmp(&b.distance.abs()))?;
        let segment = &self.other.segments[s];
        let facet = &self.other.facets[segment.facet as usize];
        let mut xi = segment.from + share * (segment.to - segment.from);
        let (mut value, mut away, mut way) = ([0.0; 3], [0.0; 2], [0.0; 2]);
        for _ in 0..ITERATIONS {
            let (y, tangent, values) = at(&self.other, facet, xi, position);
            (away, value, way) = ([y[0] - x[0], y[1] - x[1]], values, tangent);
            // Along the normal there is nothing across it.
            let off = away[1] * n[0] - away[0] * n[1];
            xi = (xi - off / (tangent[1] * n[0] - tangent[0] * n[1])).clamp(-1.0, 1.0);
        }
        let length = way[0].hypot(way[1]);
        let normal = [way[1] / length, -way[0] / length];
        Some(Across { facet: segment.facet, value, normal, gap: away[0] * n[0] + away[1] * n[1] })
    }
}

/// The place on a facet at `xi`, its derivative, and the shape functions there.
fn at(surface: &Surface, facet: &[u32], xi: f64, position: &dyn Fn(u32) -> [f64; 2]) -> ([f64; 2], [f64; 2], [f64; 3]) {
    let (mut value, mut slope) = ([0.0; MAX_NODES], [[0.0; 3]; MAX_NODES]);
    surface.kind.values(&[xi, 0.0, 0.0], &mut value);
    surface.kind.derivatives(&[xi, 0.0, 0.0], &mut slope);
    let (mut x, mut tangent, mut values) = ([0.0; 2], [0.0; 2], [0.0; 3]);
    for (i, &node) in facet.iter().enumerate() {
        let y = position(node);
        values[i] = value[i];
        for d in 0..2 {
            x[d] += value[i] * y[d];
            tangent[d] += slope[i][0] * y[d];
        }
    }
    (x, tangent, values)
}

/// What is summed up under a contact node: on both sides.
#[derive(Clone, Default)]
struct Sum {
    area: f64,
    gap: f64,
    /// Excess pressure of the pore water, and place, times the area.
    water: f64,
    place: [f64; 2],
    /// Of the parts: area, arc length along the boundary, and gap (m).
    spots: Vec<Spot>,
    sides: [Vec<Entry<2, 2>>; 2],
}

impl<K: Kinematics<2>> Interface<2> for Bodies<K> {
    fn sides(&self) -> &Sides {
        &self.sides
    }

    fn contact_nodes(&self) -> usize {
        self.surface.contact_nodes
    }

    fn runs(&self) -> &[Run] {
        &self.surface.runs
    }

    fn constraints(
        &self,
        ground: &Ground<2>,
        position: &dyn Fn(u32) -> [f64; 2],
        held: &Multipliers,
    ) -> Vec<Constraint<2>> {
        let segments = Segments::new::<K>(&self.surface, position);
        let other = Segments::new::<K>(&self.other, position);
        let longest = other.0.iter().map(|s| distance(&s.to, &s.from)).fold(0.0, f64::max);
        let lines =
            Lines::new(other.0.iter().map(|s| [s.from, s.to]).collect(), REACH * self.surface.spacing + longest);
        let mut sums = vec![Sum::default(); self.surface.contact_nodes];
        let loops = segments.loops(&self.surface);
        // Nothing else depends on it.
        let wet = self.soil.as_ref().filter(|soil| soil.undrained && self.sides.laws.at(ground.phase).friction > 0.0);
        let wet = wet.map(|soil| (soil, soil.points(ground.elements)));
        for (segment, placed) in self.surface.segments.iter().zip(&segments.0) {
            let own = &self.surface.facets[segment.facet as usize];
            let cuts = self.cuts(placed, &lines, position);
            let mut nearest = f64::INFINITY;
            for point in self.points(segment, &cuts, &GAUSS, position) {
                let Some(across) = self.across(&point, &other, &lines, position) else { continue };
                let facets = [(own, point.value, -1.0), (&self.other.facets[across.facet as usize], across.value, 1.0)];
                let water = wet.as_ref().map_or(0.0, |(soil, points)| {
                    let (facet, away) =
                        if soil.has_contact_nodes { (segment.facet, 0.0) } else { (across.facet, across.gap) };
                    let x = [0, 1].map(|d| point.x[d] + away * point.normal[d]);
                    let apart = |p: &usize| {
                        let to = &ground.elements.position[*p];
                        (to[0] - x[0]).hypot(to[1] - x[1])
                    };
                    let behind = points[&soil.behind[facet as usize]].iter();
                    let nearest = behind.min_by(|p, q| apart(p).total_cmp(&apart(q)));
                    nearest.map_or(0.0, |&p| (ground.excess)(ground.elements, p))
                });
                let n = point.normal;
                let t = [-n[1], n[0]];
                // Along the normal of the structure the distance to the other body changes by what goes along the normal of that.
                let slant = across.normal[0] * n[0] + across.normal[1] * n[1];
                let normal = across.normal.map(|m| m / slant);
                nearest = nearest.min(across.gap);
                for (contact_node, share) in segment.contact_nodes {
                    let weight = share * point.area;
                    let sum = &mut sums[contact_node as usize];
                    sum.area += weight;
                    sum.gap += weight * across.gap;
                    sum.water += weight * water;
                    sum.place = [0, 1].map(|d| sum.place[d] + weight * point.x[d]);
                    for (side, (facet, values, sign)) in sum.sides.iter_mut().zip(&facets) {
                        for (&node, value) in facet.iter().zip(values) {
                            let by = sign * weight * value;
                            add(side, node, &[normal, t].map(|along| along.map(|a| by * a)));
                        }
                    }
                }
            }
            if nearest < self.surface.spacing {
                for point in self.points(segment, &cuts, &PARTS, position) {
                    let Some(across) = self.across(&point, &other, &lines, position) else { continue };
                    for (contact_node, share) in segment.contact_nodes {
                        let spot =
                            Spot { share: share * point.area, along: placed.along + point.along, open: across.gap };
                        sums[contact_node as usize].spots.push(spot);
                    }
                }
            }
        }
        let stiffness = self.young / self.surface.spacing;
        let constraint = |(contact_node, sum): (usize, Sum)| {
            let area = (sum.area > 0.0).then_some(sum.area)?;
            let entries = || sum.sides.iter().flatten();
            let by = |k: usize| entries().map(|(_, by)| by[k].map(|by| by / area)).collect();
            Some(Constraint {
                contact_node: contact_node as u32,
                area,
                gap: sum.gap / area,
                wet: self.soil.as_ref().map(|_| sum.place.map(|x| x / area)),
                own: sum.sides[0].len(),
                nodes: entries().map(|e| e.0).collect(),
                by_normal: by(0),
                by_tangent: by(1),
                curvature: 0.0,
                by_arc: entries().map(|_| [0.0; 2]).collect(),
                looks_ahead: !sum.spots.is_empty(),
                spots: Spot::about_mean(&sum.spots, loops[contact_node]),
                penalty: Penalty {
                    pressure: held.pressure[contact_node],
                    shear: held.shear[contact_node],
                    normal: self.sides.penalty() * stiffness,
                    tangential: TANGENTIAL * stiffness,
                    rounding: 0.0,
                    fading: FADING * self.surface.spacing,
                    bonded: held.bonded(
                        contact_node,
                        self.sides.laws.at(ground.phase),
                        sum.gap / area < FADING * self.surface.spacing,
                    ),
                    strength: f64::INFINITY,
                    water: sum.water / area,
                },
            })
        };
        sums.into_iter().enumerate().filter_map(constraint).collect()
    }

    fn outlines(&self, _: &dyn Fn(u32) -> [f64; 2]) -> Vec<Vec<[f64; 2]>> {
        Vec::new()
    }

    fn lines(&self, position: &dyn Fn(u32) -> [f64; 2]) -> Vec<Vec<Mark<2>>> {
        lines::<K>(&self.surface, &Segments::new::<K>(&self.surface, position))
    }

    fn project_out(&self, _: &mut Points<2>, _: &dyn Fn(u32) -> [f64; 2]) -> Pushed {
        Pushed::default()
    }
}
