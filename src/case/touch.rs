//! The structures and walls of a case and what they touch.

use super::changes::{self, by_number};
use super::checked::{Case, Contact, Content, Geometry, Region, Touched, Touching};
use super::scene::region_index;
use super::wall;
use crate::contact::{Bodies, Boundary, Pair, Rigid, Skin, SoilSide, Surface};
use crate::error::{Error, Result};
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::mesh::faces::Faces;
use crate::rigid::Body;
use std::collections::BTreeMap;
use std::marker::PhantomData;

/// Distance of the hats (-), in the length of an edge of the grid: that of its nodes.
const HATS: f64 = 0.5;

/// The pairs of a case, given the grid, the cells beside it and the rigid bodies.
///
/// # Errors
/// Input: a region that the mesh has not, a soil without cells, a wall that [`wall::facets`] refuses.
pub fn pairs<K: Kinematics<2>>(
    case: &Case,
    grid: &Mesh<2>,
    fem: &Mesh<2>,
    bodies: &[Body<2>],
) -> Result<Vec<Box<dyn Pair<2>>>> {
    let parts = Parts { case, grid, fem, bodies };
    let pair = |contact: &Contact| {
        let pair: Box<dyn Pair<2>> = match &contact.on {
            Touched::Soil(soil) => Box::new(parts.on_soil::<K>(contact, soil)?),
            Touched::Body(body) => Box::new(parts.on_body::<K>(contact, *body)?),
        };
        let rigid = |region: u16| bodies.iter().any(|body| body.region == region);
        let keeps_shape = rigid(pair.structure()) || pair.against().is_some_and(rigid);
        Ok(if keeps_shape { Box::new(Rigid::new(pair, bodies, grid.nodes.len())) } else { pair })
    };
    case.contacts.iter().map(pair).collect()
}

/// A straight line along the boundary of the grid, with the grid on its left.
struct Edge {
    /// Out of the grid.
    normal: [f64; 2],
    /// Distance (m) of the line from the origin along the normal.
    distance: f64,
}

impl Edge {
    fn through(a: &[f64; 2], b: &[f64; 2]) -> Self {
        let length = (b[0] - a[0]).hypot(b[1] - a[1]);
        let normal = [(b[1] - a[1]) / length, -(b[0] - a[0]) / length];
        Self { normal, distance: normal[0] * a[0] + normal[1] * a[1] }
    }

    /// Whether a side of a structure, which is on its left, lies on the line: an axis of symmetry or a wall, with nothing to touch
    /// beyond. `size` (m) is what lengths are measured by.
    fn is_along(&self, a: &[f64; 2], b: &[f64; 2], size: f64) -> bool {
        let near = |x: &[f64; 2]| (self.normal[0] * x[0] + self.normal[1] * x[1] - self.distance).abs() < 1e-9 * size;
        let own = Self::through(a, b).normal;
        near(a) && near(b) && own[0] * self.normal[0] + own[1] * self.normal[1] > 0.0
    }
}

/// The lines along which the boundary of a grid runs straight, given a length (m) to tell them apart by.
fn edges(grid: &Mesh<2>, size: f64) -> Vec<Edge> {
    let mut edges: Vec<Edge> = Vec::new();
    for (cell, side) in Faces::of(grid).boundary {
        let nodes = grid.cells.nodes(cell as usize);
        let (_, facets) = grid.cells.kind[cell as usize].facets();
        let [a, b] = [0, 1].map(|i| grid.nodes[nodes[facets[side as usize][i]] as usize]);
        if !edges.iter().any(|edge| edge.is_along(&a, &b, size)) {
            edges.push(Edge::through(&a, &b));
        }
    }
    edges
}

/// What pairs are made from.
struct Parts<'a> {
    case: &'a Case,
    grid: &'a Mesh<2>,
    fem: &'a Mesh<2>,
    bodies: &'a [Body<2>],
}

impl Parts<'_> {
    fn region(&self, index: usize) -> Result<u16> {
        region_index(self.grid, &self.case.regions[index].name)
    }

    fn name<'a>(&'a self, touching: &'a Touching) -> &'a str {
        match touching {
            Touching::Structure(index) => &self.case.regions[*index].name,
            Touching::Wall(curve) => curve,
        }
    }

    /// The boundary of a region beside the grid, without what lies along some `edges`, with hats about `spacing` (m) apart.
    fn boundary(&self, region: u16, spacing: f64, edges: &[Edge]) -> Result<Surface> {
        let beyond = |nodes: &[u32]| {
            let x = |i: usize| self.fem.nodes[nodes[i] as usize];
            edges.iter().any(|edge| edge.is_along(&x(0), &x(1), spacing))
        };
        Surface::new(self.fem, region, spacing, beyond)
    }

    /// The surface that all soil of material points begins with. Where it is joined to finite elements there is none.
    fn skin(&self) -> Result<Skin> {
        let filled = |(_, region): &(usize, &Region)| matches!(region.content, Content::Mpm { .. });
        let regions = self.case.regions.iter().enumerate().filter(filled).map(|(index, _)| self.region(index));
        let regions = regions.collect::<Result<Vec<u16>>>()?;
        let mut joined = vec![false; self.grid.nodes.len()];
        self.fem.cells.nodes.iter().for_each(|&n| joined[n as usize] = true);
        Ok(Skin::new(self.grid, &regions, |facet| facet.iter().all(|&n| joined[n as usize])))
    }

    /// The cell beside the grid that has each of the facets of the boundary of a region.
    fn behind(&self, region: u16, facets: &[Vec<u32>]) -> Vec<u32> {
        let ends = |facet: &[u32]| [facet[0].min(facet[1]), facet[0].max(facet[1])];
        let mut cell_of = BTreeMap::new();
        for c in (0..self.fem.cells.len()).filter(|&c| self.fem.cells.region[c] == region) {
            let (_, sides) = self.fem.cells.kind[c].facets();
            for side in sides {
                cell_of.insert(ends(&[0, 1].map(|i| self.fem.cells.nodes(c)[side[i]])), c as u32);
            }
        }
        facets.iter().map(|facet| cell_of[&ends(facet)]).collect()
    }

    fn no_cells(&self, contact: &Contact, what: &str) -> Error {
        Error::input(
            format!("contact of `{}`", self.name(&contact.structure)),
            format!("{what} that it names has no cells"),
            "run `mpm mesh` again",
        )
    }

    fn on_soil<K: Kinematics<2>>(&self, contact: &Contact, soil: &[usize]) -> Result<Boundary<K>> {
        let regions = soil.iter().map(|&region| self.region(region)).collect::<Result<Vec<u16>>>()?;
        let models = by_number(self.case, self.grid, |material| Some(material.model.clone()))?;
        let edge = size(self.grid, &regions).ok_or_else(|| self.no_cells(contact, "the soil"))?;
        let structure = region_index(self.grid, self.name(&contact.structure))?;
        let surface = match (&contact.structure, self.bodies.iter().find(|body| body.region == structure)) {
            (Touching::Wall(_), Some(body)) => {
                let (kind, facets) = wall::facets(self.grid, body, &regions)?;
                Surface::of(self.grid, kind, facets, HATS * edge)
            }
            _ => self.boundary(structure, HATS * edge, &edges(self.grid, HATS * edge))?,
        };
        let skin = self.skin()?;
        Ok(Boundary { structure, surface, law: contact.law, regions, models, skin, kinematics: PhantomData })
    }

    /// The hats are as far apart as the coarser of the boundaries that can give way has its nodes. Against a wall they are the body's.
    fn on_body<K: Kinematics<2>>(&self, contact: &Contact, body: usize) -> Result<Bodies<K>> {
        let sides = match &contact.structure {
            Touching::Structure(structure) => vec![*structure, body],
            Touching::Wall(_) => vec![body],
        };
        let soft = sides.iter().filter(|&&region| !self.case.regions[region].content.is_rigid());
        let soft: Vec<usize> = if soft.clone().next().is_some() { soft.copied().collect() } else { sides.to_vec() };
        let edges = soft.iter().map(|&region| Ok(size(self.fem, &[self.region(region)?])));
        let edges = edges.collect::<Result<Option<Vec<f64>>>>()?;
        let edge = edges.and_then(|edges| edges.into_iter().reduce(f64::max));
        let spacing = HATS * edge.ok_or_else(|| self.no_cells(contact, "a region"))?;
        let structure = self.region(sides[0])?;
        // The axis of symmetry is no boundary.
        let axis = Edge { normal: [-1.0, 0.0], distance: 0.0 };
        let axis = if self.case.geometry == Geometry::Axisymmetric { vec![axis] } else { Vec::new() };
        let surface = self.boundary(structure, spacing, &axis)?;
        let (against, other) = match &contact.structure {
            Touching::Structure(_) => {
                let against = self.region(body)?;
                (against, self.boundary(against, spacing, &axis)?)
            }
            Touching::Wall(curve) => {
                let wall = region_index(self.grid, curve)?;
                let wall = self.bodies.iter().find(|body| body.region == wall);
                let wall = wall.ok_or_else(|| self.no_cells(contact, "the wall"))?;
                let (kind, facets) = wall::facets(self.fem, wall, &[structure])?;
                (wall.region, Surface::of(self.fem, kind, facets, spacing))
            }
        };
        let is_soil = self.case.regions[body].content.is_soil_of_elements();
        let soil = is_soil.then(|| {
            let has_hats = matches!(contact.structure, Touching::Wall(_));
            let facets = if has_hats { &surface.facets } else { &other.facets };
            let name = &self.case.regions[body].name;
            let undrained = changes::used(self.case).any(|(r, m)| r.name == *name && m.has_pore_pressure());
            Ok(SoilSide { has_hats, undrained, behind: self.behind(self.region(body)?, facets) })
        });
        let (mut height, mut count) = (0.0, 0.0);
        for &n in surface.facets.iter().flatten() {
            (height, count) = (height + self.fem.nodes[n as usize][1], count + 1.0);
        }
        // The softest that a phase makes them.
        let is_soft = |region: &Region| soft.iter().any(|&index| self.case.regions[index].name == region.name);
        let young = changes::used(self.case).filter(|(region, _)| is_soft(region));
        let young = young.map(|(_, material)| material.model.young(height / count));
        Ok(Bodies {
            structure,
            against,
            surface,
            other,
            law: contact.law,
            soil: soil.transpose()?,
            young: young.fold(f64::INFINITY, f64::min),
            kinematics: PhantomData,
        })
    }
}

/// The length (m) of the finest edges of the cells in some regions: nine of ten are longer.
fn size(mesh: &Mesh<2>, regions: &[u16]) -> Option<f64> {
    let mut edges = Vec::new();
    for c in (0..mesh.cells.len()).filter(|&c| regions.contains(&mesh.cells.region[c])) {
        let nodes = mesh.cells.nodes(c);
        let corners = mesh.cells.kind[c].corner_count();
        for i in 0..corners {
            let [a, b] = [nodes[i], nodes[(i + 1) % corners]].map(|n| mesh.nodes[n as usize]);
            edges.push((b[0] - a[0]).hypot(b[1] - a[1]));
        }
    }
    edges.sort_by(f64::total_cmp);
    edges.get(edges.len() / 10).copied()
}
