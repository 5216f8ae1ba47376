//! The soil of material points as a body: where it is, cut along its surface, with fields that are continuous over it.
//!
//! Made from what frames hold, which is the places of the points, their displacement, and fields. Where the soil is follows in
//! two ways. A displacement that is fitted to the points tells of each node where the soil there came from, and how deep in the seeded
//! cells that was (`Origin::depth`): where it is smooth that places the surface as the soil moved, sharp edges and all. Where it is
//! not, as where soil has closed behind a structure, the fullness with points decides (`Fullness`). Both are lengths, positive in the
//! soil; their mean by the inverse squares of their errors is a level set at the nodes, linear on the triangles between
//! them, along which the cells are cut. What structures stand in is cut out exactly. Regions are parted in the same way, and a field
//! is recovered from the points of each region alone (`recover`).

mod filling;
mod fullness;
mod origin;
mod parting;
mod polygon;
mod probe;
mod recover;
mod structures;
#[cfg(test)]
mod tests;

use crate::geometry::{Bins, box_around};
use crate::mesh::locate::Locator;
use crate::mesh::{Mesh, cell_size};
use crate::points::Points;
use crate::quadrature::{Around, Held};
use crate::surface::triangles;
use crate::tensor::Tensor;
use fullness::Fullness;
use origin::Origin;
use polygon::{Corner, Polygon, WHOLE, place, positive, without};
use rayon::prelude::*;
use recover::{AtNode, Ground, Nodal, Sizes};
use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::iter::once;

pub use filling::{Fill, Filling};
pub use parting::Parting;
pub use probe::{Probe, Weights};
pub use recover::Values;
pub use structures::Structures;

/// The error (-) of the surface that the fullness gives, in the size of a cell: that of a surface halfway between
/// nodes, with the scatter of points.
const SCATTER: f64 = 0.1;
/// Soil that fills less or more than so many times the room that it was seeded in is no whole any longer: drops, or
/// points of which some were merged.
const LOOSE: f64 = 2.0;
/// A surface nearer to a node than this part (-) of a cell goes through it: less is no more than slivers.
const ON_NODE: f64 = 1e-3;
/// Depths count up to so many times the size of a cell (-): more than the sides of a cell are long.
const FAR: f64 = 2.0;
/// Soil nearer to a structure than this part (-) of a cell lies on it, as it does for the solver
/// (`src/surface/front/conform.rs`).
const ON_STRUCTURE: f64 = 0.15;
/// Places nearer to each other than this part of the size of the body are one.
const SAME: f64 = 1e-9;

/// The grid and what the soil was at first: the same for all frames.
pub struct Soil {
    origin: Origin,
    around: Around,
}

/// The material points of a frame.
#[derive(Clone, Copy)]
pub struct Cloud<'a> {
    /// Where they are (m).
    pub position: &'a [[f64; 2]],
    /// Where they were seeded (m).
    pub origin: &'a [[f64; 2]],
    /// The area (m²) of each in the plane.
    pub area: &'a [f64],
    pub values: Values<'a>,
}

/// Triangles with values at their corners, which no two regions share.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Body {
    /// The corners (m).
    pub places: Vec<[f64; 2]>,
    /// Values at the corners, as many as the points have, one corner after the other.
    pub values: Vec<f64>,
    /// Corners of the triangles, counter-clockwise.
    pub triangles: Vec<[u32; 3]>,
    /// The region of each triangle.
    pub region: Vec<u16>,
}

impl Soil {
    /// The soil on the grid `mesh`, where the regions `seeded` were filled with points.
    pub fn new(mesh: Mesh<2>, seeded: &[bool]) -> Self {
        let around = Around::of(&mesh);
        Self { origin: Origin::new(mesh, seeded), around }
    }

    /// The soil of the regions that still have points, given where these were seeded (m); `None` where all have.
    pub fn left(&self, origins: &[[f64; 2]]) -> Option<Self> {
        let mesh = &self.origin.mesh;
        let mut there = vec![false; mesh.regions.len()];
        let regions =
            origins.iter().filter_map(|x| self.origin.seeded_cell(x)).map(|(c, _)| mesh.cells.region[c as usize]);
        regions.for_each(|region| there[region as usize] = true);
        let goes = (0..mesh.cells.len()).any(|c| self.origin.is_seeded(c) && !there[mesh.cells.region[c] as usize]);
        goes.then(|| Self::new(mesh.clone(), &there))
    }

    /// The region in which a point was seeded at `origin` (m).
    pub fn seeded_region(&self, origin: &[f64; 2]) -> Option<u16> {
        self.origin.seeded_cell(origin).map(|(c, _)| self.origin.mesh.cells.region[c as usize])
    }

    /// Where points with these displacements (m) were, when these were counted from a frame whose points were at `places`
    /// (m) and had been seeded at `origins` (m): as far from the origin of the nearest one as from its place.
    pub fn traced(now: &[[f64; 2]], places: &[[f64; 2]], origins: &[[f64; 2]]) -> Vec<[f64; 2]> {
        let Some([low, high]) = box_around(places.iter().copied()) else { return now.to_vec() };
        let side = ((high[0] - low[0]) * (high[1] - low[1]) / places.len() as f64).sqrt();
        let bins = Bins::new(places.iter().map(|x| (*x, *x)), 2.0 * side);
        let square = |a: &[f64; 2], b: &[f64; 2]| (a[0] - b[0]).powi(2) + (a[1] - b[1]).powi(2);
        let trace = |x: &[f64; 2]| {
            let near = bins.around(x).flatten().map(|&k| k as usize);
            let nearest = near.min_by(|&a, &b| square(x, &places[a]).total_cmp(&square(x, &places[b])));
            nearest.map_or(*x, |k| [0, 1].map(|d| origins[k][d] + x[d] - places[k][d]))
        };
        now.par_iter().map(trace).collect()
    }

    /// The body of the soil whose points are in `cloud`, on the grid with its nodes at `nodes` (m), among structures.
    pub fn body(&self, nodes: &[[f64; 2]], cloud: Cloud, structures: (&[[f64; 2]], &[[u32; 3]])) -> Body {
        let mesh = Mesh { nodes: nodes.to_vec(), cells: self.origin.mesh.cells.clone(), ..Mesh::default() };
        let (points, parametric, kept) = self.points(&mesh, cloud);
        if points.position.is_empty() {
            return Body::default();
        }
        let values: Vec<f64> = if kept.len() == cloud.position.len() {
            cloud.values.of.to_vec()
        } else {
            let width = cloud.values.width;
            kept.iter().flat_map(|&p| &cloud.values.of[p * width..(p + 1) * width]).copied().collect()
        };
        let mut regions = points.region.clone();
        regions.sort_unstable();
        regions.dedup();
        let held = Held::new(mesh.cells.len(), &points.cell);
        let filled = (0..mesh.cells.len() as u32).filter(|&c| !held.points(c).is_empty());
        let mut active: Vec<u32> = filled.flat_map(|c| self.around.cells(c).iter().copied().chain([c])).collect();
        active.sort_unstable();
        active.dedup();
        let ground = Ground { mesh: &mesh, points: &points, around: &self.around, held: &held, active: &active };
        let sizes = active.iter().map(|&c| cell_size(&mesh, c as usize));
        let structures = Structures::new(structures.0, structures.1, sizes.fold(0.0, f64::max));
        let fullness = Fullness::of(&mesh, &points, &parametric, &regions, &structures);
        let levels = self.levels(&ground, &regions, &fullness, &structures);
        let fields: Vec<Nodal> = regions
            .iter()
            .map(|&region| {
                let region = (regions.len() > 1).then_some(region);
                Nodal::of(&ground, region, Values { width: cloud.values.width, of: &values })
            })
            .collect();
        let cut = |&c: &u32| self.cut(&mesh, c as usize, (&regions, &levels), &structures);
        let pieces: Vec<Vec<Piece>> = active.par_iter().with_min_len(32).map(cut).collect();
        assemble(&mesh, pieces.into_iter().flatten(), &regions, &fields)
    }

    /// The points that are in the grid, with the region that each was seeded in, and their numbers in the cloud.
    fn points(&self, mesh: &Mesh<2>, cloud: Cloud) -> (Points<2>, Vec<[f64; 3]>, Vec<usize>) {
        let locator = Locator::new(mesh);
        let find = |p: usize| {
            let (seeded, leads) = self.origin.seeded_cell(&cloud.origin[p])?;
            let (cell, xi) = locator.locate(mesh, &cloud.position[p], Some(seeded))?;
            Some((p, seeded, leads, cell, xi))
        };
        let found: Vec<_> = (0..cloud.position.len()).into_par_iter().filter_map(find).collect();
        let mut points = Points::default();
        let (mut parametric, mut kept) = (Vec::with_capacity(found.len()), Vec::with_capacity(found.len()));
        for (p, seeded, leads, cell, xi) in found {
            let (x, first) = (cloud.position[p], if leads { cloud.origin[p] } else { [f64::NAN; 2] });
            points.position.push(x);
            points.cell.push(cell);
            points.region.push(self.origin.mesh.cells.region[seeded as usize]);
            points.origin.push(first);
            points.initial_volume.push(cloud.area[p]);
            points.deformation.push(Tensor::identity());
            parametric.push(xi);
            kept.push(p);
        }
        (points, parametric, kept)
    }

    /// The level sets at the nodes: of the soil, and where there are several of each region in it.
    fn levels(&self, ground: &Ground, regions: &[u16], fullness: &Fullness, structures: &Structures) -> LevelSets {
        let Ground { mesh, points, .. } = *ground;
        let of: Vec<f64> = points.origin.iter().flatten().copied().collect();
        let origins = Nodal::of(ground, None, Values { width: 2, of: &of });
        let sizes = Sizes::new(ground);
        let level = |n: usize| {
            let h = sizes.of(n);
            if h == 0.0 {
                return (f64::NEG_INFINITY, Vec::new(), [f64::INFINITY; 2]);
            }
            let by_fullness = (fullness.value[n] - 0.5) * h;
            let part = |k: usize| if regions.len() > 1 { (fullness.part[k][n] - 0.5) * h } else { 0.0 };
            let mut of_regions: Vec<f64> = (0..fullness.part.len()).map(part).collect();
            let (mut level, mut origin) = (by_fullness, [f64::INFINITY; 2]);
            if let Some(AtNode { value, residual, gradient }) = origins.at(n as u32) {
                let first = [value[0], value[1]];
                origin = first;
                let [a, b] = [gradient[0], gradient[1]];
                let ratio = (a[0] * b[1] - a[1] * b[0]).abs();
                let whole = (1.0 / LOOSE..LOOSE).contains(&ratio);
                let error = if whole { residual / ratio.sqrt() } else { f64::INFINITY };
                let weight = 1.0 / (1.0 + (error / (SCATTER * h)).powi(2));
                if weight > 0.0 {
                    let (depth, by) = self.origin.depth(&first);
                    // How fast the depth grows along the way that it does so now.
                    let slope = (a[0] * by[0] + b[0] * by[1]).hypot(a[1] * by[0] + b[1] * by[1]);
                    let depth = (if slope > 0.0 { depth / slope } else { depth }).clamp(-FAR * h, FAR * h);
                    level = weight * depth + (1.0 - weight) * by_fullness;
                    for (level, &region) in of_regions.iter_mut().zip(regions) {
                        let depth = self.origin.depth_in(region, &first).clamp(-FAR * h, FAR * h);
                        *level = weight * depth + (1.0 - weight) * *level;
                    }
                }
            }
            // Less and less up to as far beside it: a free surface beyond stays where it is.
            level += (ON_STRUCTURE * h + structures.depth(&mesh.nodes[n])).clamp(0.0, ON_STRUCTURE * h);
            if level.abs() < ON_NODE * h {
                level = 0.0;
            }
            (level, of_regions, origin)
        };
        let all: Vec<LevelsAtNode> = (0..mesh.nodes.len()).into_par_iter().with_min_len(256).map(level).collect();
        let of_region =
            |k: usize| all.iter().map(|(_, of, _)| of.get(k).copied().unwrap_or(f64::NEG_INFINITY)).collect();
        LevelSets {
            soil: all.iter().map(|(soil, ..)| *soil).collect(),
            of_regions: (0..fullness.part.len()).map(of_region).collect(),
            first: all.iter().map(|(.., first)| *first).collect(),
        }
    }

    /// The parts of the body in a cell.
    fn cut(
        &self,
        mesh: &Mesh<2>,
        c: usize,
        (regions, levels): (&[u16], &LevelSets),
        structures: &Structures,
    ) -> Vec<Piece> {
        let mut pieces = Vec::new();
        let nodes = mesh.cells.nodes(c);
        for triangle in triangles(mesh.cells.kind[c]) {
            let nodes = triangle.map(|i| nodes[i]);
            let first = || [0, 1].map(|d| nodes.iter().map(|&n| levels.first[n as usize][d]).sum::<f64>() / 3.0);
            // Whether the soil is on this side of a surface that runs along the sides, the origin tells.
            let level = nodes.map(|n| levels.soil[n as usize]);
            if level == [0.0; 3] && self.origin.depth(&first()).0 <= 0.0 {
                continue;
            }
            let soil = positive(&WHOLE, &level);
            if soil.is_empty() {
                continue;
            }
            let x = nodes.map(|n| mesh.nodes[n as usize]);
            for k in 0..regions.len() {
                let mut part = soil.clone();
                for other in (0..levels.of_regions.len()).filter(|&other| other != k) {
                    let difference =
                        nodes.map(|n| levels.of_regions[k][n as usize] - levels.of_regions[other][n as usize]);
                    let is_other = difference == [0.0; 3] && self.origin.depth_in(regions[k], &first()) <= 0.0;
                    part = if is_other { Polygon::new() } else { positive(&part, &difference) };
                }
                if !part.is_empty() {
                    let left = without(part, &x, structures.near(&x));
                    pieces.extend(left.into_iter().map(|polygon| Piece { nodes, region: k, polygon }));
                }
            }
        }
        pieces
    }
}

/// Level sets (m) at the nodes.
struct LevelSets {
    soil: Vec<f64>,
    /// Of each region; empty where there is but one.
    of_regions: Vec<Vec<f64>>,
    /// Where the soil there was seeded (m).
    first: Vec<[f64; 2]>,
}

/// The levels (m) of the soil and of its regions at a node, and where the soil there was seeded (m).
type LevelsAtNode = (f64, Vec<f64>, [f64; 2]);

/// A part of the body in a triangle between nodes.
struct Piece {
    nodes: [u32; 3],
    /// The number of its region among those that there are.
    region: usize,
    polygon: Polygon,
}

/// The pieces as triangles whose corners are shared.
fn assemble(mesh: &Mesh<2>, pieces: impl Iterator<Item = Piece>, regions: &[u16], fields: &[Nodal]) -> Body {
    let [low, high] = box_around(mesh.nodes.iter().copied()).unwrap_or_default();
    let unit = SAME * (high[0] - low[0]).max(high[1] - low[1]);
    let mut body = Body::default();
    let mut numbers: HashMap<(usize, [i64; 2]), u32> = HashMap::new();
    for Piece { nodes, region, polygon } in pieces {
        let x = nodes.map(|n| mesh.nodes[n as usize]);
        // A piece far from all points of its region belongs to a region whose points are near; where there is none it is left out.
        let known = |region: &usize| polygon.iter().all(|corner| fields[*region].is_known(&nodes, corner));
        let Some(region) = once(region).chain(0..fields.len()).find(known) else { continue };
        let mut number = |corner: &Corner| {
            let at = place(corner, &x);
            match numbers.entry((region, at.map(|v| (v / unit).round() as i64))) {
                Entry::Occupied(entry) => *entry.get(),
                Entry::Vacant(entry) => {
                    body.places.push(at);
                    fields[region].between(&nodes, corner, &mut body.values);
                    *entry.insert(body.places.len() as u32 - 1)
                }
            }
        };
        let corners: Vec<u32> = polygon.iter().map(&mut number).collect();
        for i in 1..corners.len() - 1 {
            let triangle = [corners[0], corners[i], corners[i + 1]];
            if triangle[0] != triangle[1] && triangle[1] != triangle[2] && triangle[2] != triangle[0] {
                body.triangles.push(triangle);
                body.region.push(regions[region]);
            }
        }
    }
    body
}
