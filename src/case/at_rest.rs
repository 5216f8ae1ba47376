//! The stress of soil at rest, and whether it is in equilibrium.
//!
//! The vertical stress is the weight above, so forces balance vertically. Horizontally they do where the horizontal stress is the same at all
//! places of one height between two supports: under level ground with level layers.

use super::checked::{Case, Content, EarthPressure, Geometry, Region, Support, Touching};
use super::find::{filled, region_index, regions};
use super::layout::{Bounds, bounds};
use super::plates;
use crate::error::Result;
use crate::geometry::Line;
use crate::material::Profile;
use crate::mesh::faces::{BOUNDARY, Faces};
use crate::mesh::quality::SAME;
use crate::mesh::{Mesh, cell_size};
use crate::points::Points;
use crate::seed::{RegionWeight, k0_stress};
use crate::tensor::Symmetric;
use std::collections::{BTreeMap, BTreeSet};

/// Heights at which horizontal stresses are compared.
const HEIGHTS: u32 = 61;
/// Where each lies in its share (-) of the height: few nodes are there.
const SHARE: f64 = 0.437;
/// The part of the largest horizontal stress (-) up to which a difference is none: level ground has rounding.
const LEVEL: f64 = 1e-3;

/// The stress (kPa) of soil at rest at the places of `points`, of which only position and region matter: the effective one where the pores have
/// water.
///
/// # Errors
/// Input: a region that the mesh lacks.
pub(super) fn stress(case: &Case, mesh: &Mesh<2>, k0: &[EarthPressure], points: &Points<2>) -> Result<Vec<Symmetric>> {
    let g = -case.gravity[1];
    let (mut weights, mut of_region) = (Vec::new(), BTreeMap::new());
    let is_there = |region: &Region| !region.content.is_structure() && !case.comes_later(&region.name);
    for (region, material) in filled(case).filter(|(region, _)| is_there(region)) {
        let number = case.materials.iter().position(|other| other.name == material.name);
        let slots = plates::slots(case, mesh, &region.name);
        let (region, unit_weight) = (region_index(mesh, &region.name)?, material.density.scaled(g));
        // What stands in a plate weighs as if it were soil.
        weights.extend(slots.into_iter().chain([region]).map(|region| RegionWeight { region, unit_weight }));
        of_region.extend(number.and_then(|k| k0.get(k)).map(|k0| (region, k0)));
    }
    let k0 = |p: usize| of_region.get(&points.region[p]).map_or(0.0, |k0| k0.at(points.position[p][1]));
    let mut stress = k0_stress(mesh, &weights, k0, points);
    let Some(water) = &case.water else { return Ok(stress) };
    // What stands on the ground presses evenly on what is below it.
    let unit = |w: &RegionWeight| RegionWeight { region: w.region, unit_weight: Profile::constant(1.0) };
    let above = k0_stress(mesh, &weights.iter().map(unit).collect::<Vec<_>>(), |_| 0.0, points);
    let soil = |region: u16| weights.iter().any(|w| w.region == region);
    for (p, stress) in stress.iter_mut().enumerate().filter(|(p, _)| soil(points.region[*p])) {
        let x = points.position[p];
        let pressure = water.at_first(x[1] - above[p][1]);
        stress[..3].iter_mut().for_each(|s| *s -= pressure);
        if let Some(pore_pressure) = water.in_pores_at_first(x) {
            let effective = stress[1] + pore_pressure;
            let sideways = k0(p) * effective;
            *stress = [sideways, effective, sideways, 0.0, 0.0, 0.0];
        }
    }
    Ok(stress)
}

/// A warning where the stress at rest of a case is not in equilibrium, with the size of what is out of balance.
///
/// # Errors
/// As `stress`.
pub fn imbalance(case: &Case, mesh: &Mesh<2>) -> Result<Option<String>> {
    let Some(k0) = case.k0.as_ref().filter(|_| !case.equilibrium) else { return Ok(None) };
    let ground = Ground::new(case, mesh);
    let lines = ground.lines();
    let mut points = Points::default();
    for span in lines.iter().flatten().flatten() {
        points.position.push(span.place());
        points.region.push(mesh.cells.region[span.cell]);
    }
    let stress = stress(case, mesh, k0, &points)?;
    let outside = |y: f64| case.water.as_ref().map_or(0.0, |water| water.at_first(y));
    let in_pores = |x| case.water.as_ref().and_then(|water| water.in_pores_at_first(x)).unwrap_or(0.0);
    let mut next = stress.iter().zip(&points.position).map(|(s, x)| (in_pores(*x) - s[0], *x));
    let mut worst: Option<[(f64, [f64; 2]); 2]> = None;
    let (mut largest, mut force) = (0.0, 0.0);
    for line in &lines {
        let mut of_line: f64 = 0.0;
        for stretch in line {
            let mut values: Vec<(f64, [f64; 2])> = next.by_ref().take(stretch.len()).collect();
            largest = values.iter().map(|(value, _)| value.abs()).fold(largest, f64::max);
            values.retain(|(_, x)| !ground.is_under_structure(x));
            values.extend(ground.free_ends(stretch).map(|x| (outside(x[1]), x)));
            let by_value = |a: &&(f64, [f64; 2]), b: &&(f64, [f64; 2])| a.0.total_cmp(&b.0);
            let (Some(least), Some(most)) = (values.iter().min_by(by_value), values.iter().max_by(by_value)) else {
                continue;
            };
            of_line = of_line.max(most.0 - least.0);
            if worst.is_none_or(|[most, least]| most.0 - least.0 < of_line) {
                worst = Some([*most, *least]);
            }
        }
        force += of_line * ground.spacing;
    }
    let found = worst.filter(|[most, least]| most.0 - least.0 > LEVEL * largest);
    // In a quasi-static phase the water of undrained soil would bear the weight.
    let undrained = filled(case).any(|(_, material)| material.has_pore_pressure());
    let cure = if undrained {
        "take `initial_stress` out and load gravity in a first consolidation phase"
    } else {
        "add `then: equilibrium` to `initial_stress`, or take it out and load gravity in a first quasi_static phase"
    };
    Ok(found.map(|[most, least]| {
        format!(
            "warning: the soil does not begin in equilibrium: `initial_stress` has horizontal stresses of {:.3} kPa at x = {:.2} m and {:.3} kPa \
             at x = {:.2} m, both at y = {:.2} m, which need to be the same; over all heights {:.3} kN/m are unbalanced, and the soil moves in the \
             first step; where ground or layers are not level, {cure}",
            most.0, most.1[0], least.0, least.1[0], most.1[1], force
        )
    }))
}

/// The part of a horizontal line in a cell of soil.
struct Span {
    cell: usize,
    y: f64,
    /// `x` (m) at its ends, from left to right, and the facets of the cell there.
    ends: [f64; 2],
    facets: [usize; 2],
}

impl Span {
    fn place(&self) -> [f64; 2] {
        [0.5 * (self.ends[0] + self.ends[1]), self.y]
    }
}

/// The soil of a case as it begins, seen along horizontal lines.
struct Ground<'a> {
    mesh: &'a Mesh<2>,
    faces: Faces,
    soil: Vec<bool>,
    buffer: Vec<bool>,
    /// The boxes around the structures.
    structures: Vec<Bounds>,
    /// The nodes of curves that take a horizontal stress.
    held: BTreeSet<u32>,
    /// Whether the soil is one about the axis x = 0.
    round: bool,
    /// The lowest place (m), and how far the lines are apart.
    lowest: f64,
    spacing: f64,
    rounding: f64,
}

impl<'a> Ground<'a> {
    fn new(case: &Case, mesh: &'a Mesh<2>) -> Self {
        let mut soil = regions(case, mesh, |c| matches!(c, Content::Mpm { .. } | Content::Fem { .. }));
        let mut buffer = regions(case, mesh, |content| matches!(content, Content::Buffer));
        for (r, _) in mesh.regions.iter().enumerate().filter(|(_, name)| case.comes_later(name)) {
            (soil[r], buffer[r]) = (false, true);
        }
        let is_structure = regions(case, mesh, Content::is_structure);
        let of_structure = |r: usize| bounds(&mesh.part(|c| usize::from(mesh.cells.region[c]) == r));
        let structures = (0..is_structure.len()).filter(|&r| is_structure[r]).filter_map(of_structure).collect();
        let [low, high] = bounds(&mesh.part(|c| soil[usize::from(mesh.cells.region[c])])).unwrap_or_default();
        let walls = case.contacts.iter().filter_map(|contact| match &contact.structure {
            Touching::Wall(curve) => Some(curve),
            Touching::Structure(_) => None,
        });
        let bears = |s: &&Support| s.fixed[0] || s.absorbing || s.dashpots.is_some() || s.tied.is_some();
        let supports = case.supports.iter().filter(bears).flat_map(|s| std::iter::once(&s.curve).chain(&s.tied));
        let first = || case.phases.first().into_iter();
        let moved = first().flat_map(|phase| &phase.prescribed).filter(|moved| moved.component == 0);
        let loaded =
            first().flat_map(|phase| &phase.tractions).filter(|load| load.force.is_none()).map(|load| &load.curve);
        let curves = walls.chain(supports).chain(moved.map(|moved| &moved.curve)).chain(loaded);
        let held = curves.filter_map(|curve| mesh.group(curve)).flat_map(|group| group.nodes.iter().copied()).collect();
        Self {
            mesh,
            faces: Faces::of(mesh),
            soil,
            buffer,
            structures,
            held,
            round: case.geometry == Geometry::Axisymmetric,
            lowest: low[1],
            spacing: (high[1] - low[1]) / f64::from(HEIGHTS),
            rounding: SAME * (high[0] - low[0]).max(high[1] - low[1]),
        }
    }

    /// The stretches of soil along each line, from left to right.
    fn lines(&self) -> Vec<Vec<Vec<Span>>> {
        let mut spans: Vec<Vec<Span>> = (0..HEIGHTS).map(|_| Vec::new()).collect();
        for cell in (0..self.mesh.cells.len()).filter(|&c| self.soil[usize::from(self.mesh.cells.region[c])]) {
            let heights = self.mesh.cells.nodes(cell).iter().map(|&n| self.mesh.nodes[n as usize][1] - self.lowest);
            let (low, high) = heights.fold((f64::INFINITY, f64::NEG_INFINITY), |(l, h), y| (l.min(y), h.max(y)));
            let [first, last] =
                [low, high].map(|y| (y / self.spacing - SHARE).ceil().clamp(0.0, f64::from(HEIGHTS)) as u32);
            for line in first..last {
                self.cross(cell, self.lowest + (f64::from(line) + SHARE) * self.spacing, &mut spans[line as usize]);
            }
        }
        let stretches = |mut spans: Vec<Span>| {
            spans.sort_by(|a, b| a.ends[0].total_cmp(&b.ends[0]));
            let mut stretches: Vec<Vec<Span>> = Vec::new();
            for span in spans {
                match stretches.last_mut() {
                    Some(stretch) if stretch.last().is_some_and(|s| span.ends[0] - s.ends[1] <= self.rounding) => {
                        stretch.push(span);
                    }
                    _ => stretches.push(vec![span]),
                }
            }
            stretches
        };
        spans.into_iter().map(stretches).collect()
    }

    /// Adds the parts of the line at the height `y` (m) in a cell, whose edges are taken as straight from node to node.
    fn cross(&self, cell: usize, y: f64, spans: &mut Vec<Span>) {
        let mut met: Vec<(f64, usize)> = Vec::new();
        for (number, facet) in self.mesh.cells.kind[cell].facets().1.iter().enumerate() {
            let x = |i: &usize| self.mesh.nodes[self.mesh.cells.nodes(cell)[*i] as usize];
            let way: Vec<[f64; 2]> = facet[..1].iter().chain(&facet[2..]).chain(&facet[1..2]).map(x).collect();
            for pair in way.windows(2).filter(|pair| (pair[0][1] <= y) != (pair[1][1] <= y)) {
                // From the lower end on, whichever cell it is seen from.
                let [a, b]: Line<2> = if pair[0][1] < pair[1][1] { [pair[0], pair[1]] } else { [pair[1], pair[0]] };
                met.push((a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]), number));
            }
        }
        met.sort_by(|a, b| a.0.total_cmp(&b.0));
        let pairs = met.chunks_exact(2);
        spans.extend(pairs.map(|m| Span { cell, y, ends: [m[0].0, m[1].0], facets: [m[0].1, m[1].1] }));
    }

    /// Whether a place is under a structure, whose weight is not in the stress at rest.
    fn is_under_structure(&self, x: &[f64; 2]) -> bool {
        self.structures.iter().any(|[low, high]| low[0] < x[0] && x[0] < high[0] && x[1] < high[1])
    }

    /// The ends of a stretch that nothing supports.
    fn free_ends(&self, stretch: &[Span]) -> impl Iterator<Item = [f64; 2]> {
        let ends = [stretch.first().map(|span| (span, 0)), stretch.last().map(|span| (span, 1))];
        ends.into_iter()
            .flatten()
            .filter(|(span, end)| self.is_free(span, *end))
            .map(|(span, end)| [span.ends[end], span.y])
    }

    fn is_free(&self, span: &Span, end: usize) -> bool {
        let size = cell_size(self.mesh, span.cell);
        let at_structure = self.structures.iter().any(|[low, high]| {
            let near = |d: usize, x: f64| low[d] - size < x && x < high[d] + size;
            near(0, span.ends[end]) && near(1, span.y)
        });
        let facet = self.mesh.cells.kind[span.cell].facets().1[span.facets[end]];
        let beyond = self.faces.across(span.cell as u32)[span.facets[end]];
        let on_curve = facet[..2].iter().all(|&i| self.held.contains(&self.mesh.cells.nodes(span.cell)[i]));
        let on_axis = self.round && span.ends[end].abs() <= self.rounding;
        let ends = beyond == BOUNDARY || self.buffer[usize::from(self.mesh.cells.region[beyond as usize])];
        ends && !on_curve && !on_axis && !at_structure
    }
}

#[cfg(test)]
mod tests;
