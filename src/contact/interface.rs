//! A structure and the soil it touches: the condition of each contact node in a step.

use super::along::{Mark, lines};
use super::constraint::{Constraint, Entry, FADING, add};
use super::cover::covers;
use super::gap::{Facing, Gap, Soil, project_out, raw_gaps};
use super::law::Penalty;
use super::motion::Spot;
use super::multipliers::Multipliers;
use super::place::{Placed, Segments};
use super::sides::Sides;
use super::surface::{Run, Segment, Surface};
use crate::kinematics::Kinematics;
use crate::material::Model;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::mesh::shape::MAX_NODES;
use crate::points::Points;
use crate::surface::{ContactStatus, Cover};
use std::collections::HashSet;
use std::marker::PhantomData;
use std::ops::Range;
use std::sync::Arc;

/// Tangential penalty ε_t (-), in the same.
pub(super) const TANGENTIAL: f64 = 5.0;
/// Both are this part (-) over soil that may yield.
const YIELDING: f64 = 0.1;
/// Pressure over which parting is rounded (-), in the mean pressure of the contact nodes.
const ROUNDING: f64 = 0.1;

/// Overlap (-), in spacings of the points, that a contact node may begin to touch with.
const STILL: f64 = 1e-3;
/// A boundary that turns by less (rad) from one point to the next is flat.
const FLAT: f64 = 0.01;
/// A boundary that turns by more (rad) from one contact node to the next has edges, about which soil slides as about a corner; one that is curved and turns by
/// less is round.
const ROUND: f64 = 0.3;
/// Where soil is looked for from a segment, in spacings of its points.
const AWAY: [f64; 5] = [0.0, 0.05, 0.15, 0.3, 0.6];

/// What a boundary lies on: the grid where it is at the beginning of the step.
pub struct Ground<'a, const D: usize> {
    /// The number of the phase.
    pub phase: usize,
    /// The background grid with its nodes in place, and the way to find places in it.
    pub grid: &'a Mesh<D>,
    pub locator: &'a Locator<D>,
    pub points: &'a Points<D>,
    /// The cell of each point that integrals over the soil are summed over.
    pub integration: &'a [u32],
    /// Which cells take part.
    pub active: &'a [bool],
    /// The surface of the soil, where it is followed: loops of markers with the soil on their left.
    pub surface: &'a [Vec<[f64; D]>],
    /// The points of the finite elements.
    pub elements: &'a Points<D>,
    /// The excess pressure (kPa) of the water in the pores at one of some points, by its number.
    pub excess: &'a dyn Fn(&Points<D>, usize) -> f64,
}

/// What pushing points out of a structure did.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pushed {
    pub points: usize,
    /// The farthest move (m).
    pub most: f64,
}

/// A structure and what it touches.
pub trait Interface<const D: usize>: Send + Sync {
    /// Who is in contact, and by what law.
    fn sides(&self) -> &Sides;

    /// The number of contact nodes.
    fn contact_nodes(&self) -> usize;

    /// The conditions of the contact nodes that face soil; `position` tells where the nodes are.
    fn constraints(
        &self,
        ground: &Ground<D>,
        position: &dyn Fn(u32) -> [f64; D],
        held: &Multipliers,
    ) -> Vec<Constraint<D>>;

    /// The contact nodes of each smooth piece of the boundary.
    fn runs(&self) -> &[Run];

    /// The boundary as polylines with the structure on their left; closed ones end where they begin.
    fn outlines(&self, position: &dyn Fn(u32) -> [f64; D]) -> Vec<Vec<[f64; D]>>;

    /// The contact status of each piece of the outlines at the end of the last step; empty where there are no outlines.
    fn status(&self, _held: &Multipliers) -> Vec<Vec<ContactStatus>> {
        Vec::new()
    }

    /// The boundary as lines with its contact nodes, one a smooth stretch.
    fn lines(&self, position: &dyn Fn(u32) -> [f64; D]) -> Vec<Vec<Mark<D>>>;

    /// What of the boundary lies on soil as a step begins, given its conditions; nothing of one on a body.
    fn covers(&self, _constraints: &[Constraint<D>], _position: &dyn Fn(u32) -> [f64; D]) -> Vec<Cover<D>> {
        Vec::new()
    }

    /// Moves points of the soil out of the structure.
    fn project_out(&self, points: &mut Points<D>, position: &dyn Fn(u32) -> [f64; D]) -> Pushed;
}

/// The boundary of a structure on material points.
pub struct Boundary<K> {
    pub sides: Sides,
    pub surface: Surface,
    /// The model of each material by number ([`Points::model_of`]).
    pub models: Vec<Option<Arc<dyn Model>>>,
    pub kinematics: PhantomData<K>,
}

impl<K: Kinematics<2>> Boundary<K> {
    /// The gap (m) of a contact node at the beginning of a step.
    ///
    /// - An open contact node, also one that keeps its tension in the gap, may begin to touch, not to overlap.
    /// - A closed contact node goes on with the gap of the step before: a jump of the measure would strain the soil. As soil slides past, its gap becomes
    ///   that measured now, by the part of the contact node over which the soil is another.
    /// - On a curved boundary soil that slides turns as well, and the gap that it had is not that which it has. There it becomes that measured now at
    ///   once, but changes by no more than the slip.
    fn begin(&self, measured: &Measured, held: &Multipliers, contact_node: usize) -> f64 {
        let Measured { before, now, spacing, curvature } = *measured;
        let slip = held.slip[contact_node];
        if held.apart[contact_node] {
            now.max(-STILL * spacing)
        } else if is_curved(curvature, spacing) {
            now.clamp(before - slip, before + slip)
        } else {
            before + (slip / self.surface.spacing).min(1.0) * (now - before)
        }
    }

    /// Whether soil like that at `point` may yield.
    fn yields(&self, points: &Points<2>, point: usize) -> bool {
        points.by_material(point, &self.models).is_some_and(|model| model.yields())
    }

    /// Penalties and multipliers of a contact node over soil like that at `point`, without its strength and water.
    fn penalty(&self, points: &Points<2>, point: usize, contact_node: usize, held: &Multipliers) -> Penalty {
        let y = points.seeded_height(point);
        let model = points.by_material(point, &self.models);
        let yields = self.yields(points, point);
        let share = if yields { YIELDING } else { 1.0 };
        let stiffness = share * model.map_or(0.0, |m| m.young(y)) / self.surface.spacing;
        Penalty {
            pressure: held.pressure[contact_node],
            shear: held.shear[contact_node],
            normal: self.sides.penalty() * stiffness,
            tangential: TANGENTIAL * stiffness,
            rounding: if yields { ROUNDING * held.mean_pressure() } else { 0.0 },
            fading: FADING * self.surface.spacing,
            bonded: true,
            strength: 0.0,
            water: 0.0,
        }
    }
}

/// Whether a boundary of a curvature (1/m) is not flat, where the points are so far (m) apart.
fn is_curved(curvature: f64, spacing: f64) -> bool {
    (curvature * spacing).abs() > FLAT
}

/// The shear strength (kPa) of the soil at a point as the step begins.
fn strength(models: &[Option<Arc<dyn Model>>], points: &Points<2>, p: usize) -> f64 {
    points.by_material(p, models).map_or(0.0, |m| m.shear_strength(points.seeded_height(p), &points.state(p, 0.0)))
}

impl Ground<'_, 2> {
    /// The nearest cell along the normal of a segment that has integration points, and where in it (parametric) the middle of the segment is: outside it where
    /// its functions are extended to the segment. The nodes of an empty cell would give way in place of the soil; beyond the cells that take part there
    /// is no soil to face, as above that on a grid that is never reset.
    fn find(&self, segment: &Placed, spacing: f64, point: u32, integrated: &[bool]) -> Option<(u32, [f64; 3])> {
        let hint = Some(self.points.cell[point as usize]);
        let at = |away: &f64| {
            let x = [0, 1].map(|d| segment.middle[d] + away * spacing * segment.normal[d]);
            self.locator.locate(self.grid, &x, hint)
        };
        let (cell, xi) =
            AWAY.iter().filter_map(at).find(|(cell, _)| integrated[*cell as usize]).or_else(|| at(&0.0))?;
        if !self.active[cell as usize] {
            return None;
        }
        Some((cell, self.locator.extend(self.grid, cell, &segment.middle).unwrap_or(xi)))
    }
}

/// The gap (m) of a contact node.
struct Measured {
    /// That at the end of the step before.
    before: f64,
    /// That to the followed surface of the soil, or without one to its nearest points.
    now: f64,
    /// Spacing (m) of the points.
    spacing: f64,
    /// Curvature (1/m) of the boundary.
    curvature: f64,
}

/// What is summed up under a contact node.
#[derive(Default)]
struct Sum {
    area: f64,
    open: f64,
    curvature: f64,
    /// Area that faces the surface of the soil, and its distance from there times the area.
    facing: f64,
    distance: f64,
    spacing: f64,
    /// Shear strength of the soil, excess pressure of the pore water, and place, times the area.
    strength: f64,
    water: f64,
    place: [f64; 2],
    point: u32,
    entries: Vec<Entry<2, 2>>,
    /// Of its parts, where it was apart: area, arc length along the boundary, and gap (m).
    spots: Vec<Spot>,
}

impl<K: Kinematics<2>> Interface<2> for Boundary<K> {
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
        let law = self.sides.laws.at(ground.phase);
        let segments = Segments::new::<K>(&self.surface, position);
        let mut integrated = vec![false; ground.grid.cells.len()];
        ground.integration.iter().for_each(|&c| integrated[c as usize] = true);
        let soil = Soil { points: ground.points, regions: &self.sides.soils, integrated: Some(&integrated) };
        let gaps = raw_gaps::<K>(&self.surface, &segments, &soil);
        let widest = gaps.iter().flatten().map(|gap| gap.spacing).fold(0.0, f64::max);
        let (surface, smooth) = (Facing::new(ground.surface, widest), held.smooth_gaps(&self.surface.runs));
        let structure: HashSet<u32> = self.surface.facets.iter().flatten().copied().collect();
        let mut sums: Vec<Option<Sum>> = (0..self.surface.contact_nodes).map(|_| None).collect();
        // Soil that a boundary pulls stretches without end, and its points leave: its surface tells that it is there still.
        let nearest = |s: usize| {
            let chain = self.surface.chains.iter().find(|chain| chain.contains(&s))?;
            let known = |at: &usize| gaps[*at].map(|gap| (at.abs_diff(s), gap));
            chain.clone().filter_map(|at| known(&at)).min_by_key(|(away, _)| *away).map(|(_, gap)| gap)
        };
        let by_surface = |s: usize| {
            let beside = nearest(s)?;
            let open = surface.distance(&segments.0[s], beside.spacing)?;
            Some(Gap { open, ..beside })
        };
        for (s, (segment, placed)) in self.surface.segments.iter().zip(&segments.0).enumerate() {
            let Some(Gap { open, point, spacing }) = gaps[s].or_else(|| by_surface(s)) else { continue };
            let Some((cell, xi)) = ground.find(placed, spacing, point, &integrated) else { continue };
            let across = surface.distance(placed, spacing);
            // Nothing else depends on them.
            let water = if law.friction > 0.0 { (ground.excess)(ground.points, point as usize) } else { 0.0 };
            let strength =
                if law.factor.is_some() { strength(&self.models, ground.points, point as usize) } else { 0.0 };
            let mut value = [0.0; MAX_NODES];
            ground.grid.cells.kind[cell as usize].values(&xi, &mut value);
            let soil = ground.grid.cells.nodes(cell as usize);
            let structure = &self.surface.facets[segment.facet as usize];
            let n = placed.normal;
            let t = [-n[1], n[0]];
            let apart = segment.contact_nodes.map(|(contact_node, _)| held.apart[contact_node as usize]);
            let round = is_curved(placed.curvature, spacing) && (placed.curvature * self.surface.spacing).abs() < ROUND;
            let pointwise = round && apart.contains(&true) && !self.yields(ground.points, point as usize);
            let spots = if pointwise { surface.along(placed, spacing, self.surface.spacing) } else { Vec::new() };
            for (contact_node, share) in segment.contact_nodes {
                let weight = share * placed.area;
                let sum = sums[contact_node as usize].get_or_insert_with(|| Sum { point, ..Sum::default() });
                sum.area += weight;
                sum.open += weight * open;
                sum.curvature += weight * placed.curvature;
                if let Some(distance) = across {
                    sum.facing += weight;
                    sum.distance += weight * distance;
                }
                sum.spacing += weight * spacing;
                // Elastic soil has no limit, and no share of it is a number.
                if weight > 0.0 {
                    sum.strength += weight * strength;
                }
                sum.water += weight * water;
                sum.place = [0, 1].map(|d| sum.place[d] + weight * placed.middle[d]);
                if pointwise && held.apart[contact_node as usize] {
                    sum.spots.extend(spots.iter().map(|spot| Spot { share: share * spot.share, ..*spot }));
                }
                for (&node, n_s) in structure.iter().zip(&placed.value) {
                    add(&mut sum.entries, node, &[n, t].map(|along| along.map(|a| -weight * n_s * a)));
                }
                for (&node, n_c) in soil.iter().zip(&value) {
                    add(&mut sum.entries, node, &[n, t].map(|along| along.map(|a| weight * n_c * a)));
                }
            }
        }
        let loops = segments.loops(&self.surface);
        let constraint = |(contact_node, sum): (usize, Option<Sum>)| {
            let Sum { area, open, curvature, facing, distance, spacing, strength, water, place, point, .. } =
                *sum.as_ref().filter(|sum| sum.area > 0.0)?;
            let Sum { mut entries, spots, .. } = sum?;
            let spacing = spacing / area;
            let curvature = curvature / area;
            let now = if facing > 0.0 { distance / facing } else { open / area };
            let gaps = if self.yields(ground.points, point as usize) { &smooth } else { &held.gap };
            let measured = Measured { before: gaps[contact_node], now, spacing, curvature };
            let gap = self.begin(&measured, held, contact_node);
            entries.sort_by_key(|(n, _)| (!structure.contains(n), *n));
            let by = |k: usize| entries.iter().map(|(_, by)| by[k].map(|by| by / area)).collect();
            Some(Constraint {
                contact_node: contact_node as u32,
                area,
                gap,
                wet: Some(place.map(|x| x / area)),
                own: entries.iter().filter(|(n, _)| structure.contains(n)).count(),
                nodes: entries.iter().map(|e| e.0).collect(),
                by_normal: by(0),
                by_tangent: by(1),
                curvature,
                by_arc: by(1),
                spots: Spot::about_mean(&spots, loops[contact_node]),
                looks_ahead: false,
                penalty: Penalty {
                    bonded: held.bonded(contact_node, law, gap < FADING * self.surface.spacing),
                    strength: strength / area,
                    water: water / area,
                    ..self.penalty(ground.points, point as usize, contact_node, held)
                },
            })
        };
        sums.into_iter().enumerate().filter_map(constraint).collect()
    }

    fn outlines(&self, position: &dyn Fn(u32) -> [f64; 2]) -> Vec<Vec<[f64; 2]>> {
        let segments = Segments::new::<K>(&self.surface, position);
        let outline = |chain: &Range<usize>| {
            let segments = &segments.0[chain.clone()];
            segments.iter().map(|s| s.from).chain(segments.last().map(|s| s.to)).collect()
        };
        self.surface.chains.iter().map(outline).collect()
    }

    fn status(&self, held: &Multipliers) -> Vec<Vec<ContactStatus>> {
        let all = |s: &Segment, is: &dyn Fn(usize) -> bool| s.contact_nodes.iter().all(|(k, _)| is(*k as usize));
        let status = |s: &Segment| {
            if all(s, &|k| held.apart[k]) {
                ContactStatus::Open
            } else if all(s, &|k| held.touched(k)) {
                ContactStatus::Closed
            } else {
                ContactStatus::Mixed
            }
        };
        let of_chain = |chain: &Range<usize>| self.surface.segments[chain.clone()].iter().map(status).collect();
        self.surface.chains.iter().map(of_chain).collect()
    }

    fn lines(&self, position: &dyn Fn(u32) -> [f64; 2]) -> Vec<Vec<Mark<2>>> {
        lines::<K>(&self.surface, &Segments::new::<K>(&self.surface, position))
    }

    fn covers(&self, constraints: &[Constraint<2>], position: &dyn Fn(u32) -> [f64; 2]) -> Vec<Cover<2>> {
        covers(&self.surface, &Segments::new::<K>(&self.surface, position), constraints)
    }

    fn project_out(&self, points: &mut Points<2>, position: &dyn Fn(u32) -> [f64; 2]) -> Pushed {
        let segments = Segments::new::<K>(&self.surface, position);
        let (points, most) = project_out::<K>(&segments, points, &self.sides.soils);
        Pushed { points, most }
    }
}
