//! The structures and walls of a case and what they touch.

use super::changes;
use super::checked::{Case, Contact, Geometry, Region, Touched, Touching};
use super::find::region_index;
use super::wall;
use crate::contact::{Bodies, Boundary, Interface, Laws, Rigid, Sides, SoilSide, Surface};
use crate::error::{Error, Result};
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::rigid::Body;
use std::collections::BTreeMap;
use std::marker::PhantomData;

/// Distance of the contact nodes (-), in the length of an edge of the grid: that of its nodes.
const SPACING: f64 = 0.5;

/// The interfaces of a case, given the grid, the cells beside it and the rigid bodies.
///
/// # Errors
/// Input: a region that the mesh has not, a soil without cells, a wall that [`wall::facets`] refuses.
pub fn interfaces<K: Kinematics<2>>(
    case: &Case,
    grid: &Mesh<2>,
    fem: &Mesh<2>,
    bodies: &[Body<2>],
) -> Result<Vec<Box<dyn Interface<2>>>> {
    let parts = Parts { case, grid, fem, bodies };
    let interface = |contact: &Contact| {
        let interface: Box<dyn Interface<2>> = match &contact.on {
            Touched::Soil(soil) => Box::new(parts.on_soil::<K>(contact, soil)?),
            Touched::Body(body) => Box::new(parts.on_body::<K>(contact, *body)?),
        };
        let rigid = |region: u16| bodies.iter().any(|body| body.region == region);
        let keeps_shape = rigid(interface.sides().structure) || interface.sides().against.is_some_and(rigid);
        Ok(if keeps_shape { Box::new(Rigid::new(interface, bodies, grid.nodes.len())) } else { interface })
    };
    case.contacts.iter().map(interface).collect()
}

/// A line that supports hold the material at: an axis of symmetry, or a side of the domain.
struct Held {
    /// 0 where the line is `x = place`, 1 where it is `y = place` (m).
    component: usize,
    place: f64,
}

impl Held {
    /// Whether a side of a structure lies on the line, with nothing to touch beyond. `size` (m) is what lengths are measured by.
    fn has(&self, a: &[f64; 2], b: &[f64; 2], size: f64) -> bool {
        [a, b].iter().all(|x| (x[self.component] - self.place).abs() < 1e-6 * size)
    }
}

/// The lines of a case across which supports hold the grid, and the axis of axisymmetry.
fn held(case: &Case, grid: &Mesh<2>, size: f64) -> Vec<Held> {
    let mut lines = axis(case);
    for support in &case.supports {
        let facets = grid.group(&support.curve).map_or(&[][..], |group| &group.facets);
        for component in (0..2).filter(|&component| support.fixed[component]) {
            for (_, nodes) in facets.iter().filter(|(_, nodes)| nodes.len() > 1) {
                let [a, b] = [0, 1].map(|i| grid.nodes[nodes[i] as usize]);
                let line = Held { component, place: a[component] };
                if line.has(&a, &b, size) && !lines.iter().any(|line| line.has(&a, &b, size)) {
                    lines.push(line);
                }
            }
        }
    }
    lines
}

/// The axis of axisymmetry, where there is one.
fn axis(case: &Case) -> Vec<Held> {
    if case.geometry == Geometry::Axisymmetric { vec![Held { component: 0, place: 0.0 }] } else { Vec::new() }
}

/// What interfaces are made from.
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

    /// The boundary of a region beside the grid, without what lies on some `lines`, with contact nodes about `spacing` (m) apart.
    fn boundary(&self, region: u16, spacing: f64, lines: &[Held]) -> Result<Surface> {
        let beyond = |nodes: &[u32]| {
            let x = |i: usize| self.fem.nodes[nodes[i] as usize];
            lines.iter().any(|line| line.has(&x(0), &x(1), spacing))
        };
        Surface::new(self.fem, region, spacing, beyond)
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

    /// The law of a contact in each phase.
    fn laws(&self, contact: &Contact) -> Laws {
        let phases = self.case.phases.iter().enumerate();
        let changes = phases.flat_map(|(phase, p)| p.contacts.iter().map(move |change| (phase, change)));
        let own = changes.filter(|(_, change)| contact.name.as_ref() == Some(&change.name));
        own.fold(contact.law.into(), |laws: Laws, (phase, change)| laws.then(phase, change.law))
    }

    /// Whether a contact is a support across a curve.
    fn is_support(&self, contact: &Contact) -> bool {
        let holds = |curve: &String| self.case.supports.iter().any(|s| s.across && s.curve == *curve);
        matches!(&contact.structure, Touching::Wall(curve) if holds(curve))
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
        let models = changes::models(self.case, self.grid)?;
        let edge = size(self.grid, &regions).ok_or_else(|| self.no_cells(contact, "the soil"))?;
        let structure = region_index(self.grid, self.name(&contact.structure))?;
        let surface = match (&contact.structure, self.bodies.iter().find(|body| body.region == structure)) {
            (Touching::Wall(_), Some(body)) => {
                let (kind, facets) = wall::facets(self.grid, body, &regions)?;
                Surface::of(self.grid, kind, facets, SPACING * edge)
            }
            _ => self.boundary(structure, SPACING * edge, &held(self.case, self.grid, SPACING * edge))?,
        };
        let sides = Sides {
            structure,
            against: None,
            soils: regions,
            laws: self.laws(contact),
            is_support: self.is_support(contact),
        };
        Ok(Boundary { sides, surface, models, kinematics: PhantomData })
    }

    /// The contact nodes are as far apart as the coarser of the boundaries that can give way has its nodes. Against a wall they are the body's.
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
        let spacing = SPACING * edge.ok_or_else(|| self.no_cells(contact, "a region"))?;
        let structure = self.region(sides[0])?;
        // The axis of symmetry is no boundary.
        let axis = axis(self.case);
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
            let has_contact_nodes = matches!(contact.structure, Touching::Wall(_));
            let facets = if has_contact_nodes { &surface.facets } else { &other.facets };
            let name = &self.case.regions[body].name;
            let undrained = changes::used(self.case).any(|(r, m)| r.name == *name && m.has_pore_pressure());
            Ok(SoilSide { has_contact_nodes, undrained, behind: self.behind(self.region(body)?, facets) })
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
            sides: Sides {
                structure,
                against: Some(against),
                soils: Vec::new(),
                laws: self.laws(contact),
                is_support: self.is_support(contact),
            },
            surface,
            other,
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
