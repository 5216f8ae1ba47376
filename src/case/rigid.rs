//! The rigid structures and walls of a case: their nodes in the mesh, and what holds and moves them.

use super::checked::{self, Case, Geometry, Phase};
use super::find::{group, region_index};
use crate::error::{Error, Result};
use crate::kinematics::Kinematics;
use crate::mesh::Mesh;
use crate::points::Points;
use crate::rigid::Body;
use crate::seed::{QUADRATURE, RegionSeed, seed};
use crate::step::{Fixed, Prescribed};
use crate::term::{RigidInertia, RigidPressure, RigidWeight, Term};
use crate::time_value::TimeValue;
use std::collections::HashSet;

/// The rigid structures of a case, and then its walls, by their regions and nodes in the whole `mesh`.
///
/// # Errors
/// Input: a structure without cells, or one that shares nodes with other regions.
pub fn bodies(case: &Case, mesh: &Mesh<2>, walls: Vec<(u16, Vec<u32>)>) -> Result<Vec<Body<2>>> {
    let mut bodies: Vec<Body<2>> = Vec::new();
    // In axisymmetry they only move along the axis.
    let plane = case.geometry == Geometry::PlaneStrain;
    let mut add = |region: u16, nodes: Vec<u32>, points: &Points<2>| {
        let first =
            bodies.last().and_then(|body| body.dofs.numbers().last()).map_or(mesh.nodes.len() as u32, |n| n + 1);
        bodies.push(Body::new(mesh, first, region, nodes, points, plane));
    };
    for region in case.regions.iter().filter(|region| region.content.is_rigid()) {
        let number = region_index(mesh, &region.name)?;
        let part = mesh.part(|c| mesh.cells.region[c] == number);
        let nodes: HashSet<u32> = part.cells.nodes.iter().copied().collect();
        let alone = |c: usize| mesh.cells.region[c] == number || mesh.cells.nodes(c).iter().all(|n| !nodes.contains(n));
        if nodes.is_empty() || !(0..mesh.cells.len()).all(alone) {
            return Err(Error::input(
                format!("region {}", region.name),
                "a rigid structure must have cells, and share no nodes with another region",
                "give it a surface of its own in the .geo, joined to no other",
            ));
        }
        let mut nodes: Vec<u32> = nodes.into_iter().collect();
        nodes.sort_unstable();
        let Some(material) = region.content.material() else { continue };
        let density = case.materials[material].density;
        let filling = RegionSeed { region: number, points_per_cell: QUADRATURE, density };
        add(number, nodes, &seed(&part, !plane, &[filling])?);
    }
    walls.into_iter().for_each(|(region, nodes)| add(region, nodes, &Points::default()));
    Ok(bodies)
}

/// What acts on the rigid structures beside loads on curves, given the part of the mesh with them and the size (m) of its cells.
pub fn terms<K: Kinematics<2>>(
    case: &Case,
    mesh: &Mesh<2>,
    bodies: &[Body<2>],
    dynamic: bool,
    size: f64,
) -> Vec<Box<dyn Term<2>>> {
    let mut terms: Vec<Box<dyn Term<2>>> = Vec::new();
    for (number, body) in bodies.iter().enumerate() {
        if let Some(water) = case.water.as_ref().filter(|water| water.level.is_some()) {
            terms.push(Box::new(RigidPressure::<K>::new(body, number, mesh, water.heads(size))));
        }
        if case.gravity != [0.0; 2] && body.mass > 0.0 {
            let gravity = case.phases.iter().map(|p| p.gravity.clone()).collect();
            terms.push(Box::new(RigidWeight::new(body, gravity)));
        }
        if dynamic {
            terms.push(Box::new(RigidInertia::new(body)));
        }
    }
    terms
}

/// The motion of a body in a component, 0 for x, 1 for y, 2 for the rotation (m, rad); `None` where it does not turn.
fn moved(body: &Body<2>, component: usize, value: &TimeValue) -> Option<Prescribed> {
    let (number, component, unit) = body.dofs.component::<2>(component)?;
    Some(Prescribed { fixed: Fixed { nodes: vec![number], component }, displacement: value.scaled(unit) })
}

/// All motions of a body, held.
pub fn held(body: &Body<2>) -> impl Iterator<Item = Fixed> {
    (0..3).filter_map(|component| Some(moved(body, component, &TimeValue::Constant(0.0))?.fixed))
}

/// What bodies do not do unless a phase prescribes it: walls, which have no mass and no cells, do not move.
fn always_fixed(body: &Body<2>) -> impl Iterator<Item = Fixed> {
    let unused = body.dofs.unused::<2>().map(|(number, component)| Fixed { nodes: vec![number], component });
    unused.chain(held(body).filter(|_| body.is_wall))
}

/// How far from the axis a node on it may be drawn, as a share of the width of the mesh.
const ON_AXIS: f64 = 1e-9;

/// What holds the nodes of a mesh, curve by curve, and rigid bodies.
pub struct Holds<'a> {
    case: &'a Case,
    mesh: &'a Mesh<2>,
    bodies: &'a [Body<2>],
}

impl<'a> Holds<'a> {
    pub fn new(case: &'a Case, mesh: &'a Mesh<2>, bodies: &'a [Body<2>]) -> Self {
        Self { case, mesh, bodies }
    }

    /// The supports of all phases.
    ///
    /// # Errors
    /// Input: a name that the mesh has not; what [`Holds::check`] finds.
    pub fn supports(&self) -> Result<Vec<Fixed>> {
        let given = self.supported();
        self.check("supports", &given)?;
        let mut supports: Vec<Fixed> = self.bodies.iter().flat_map(always_fixed).chain(self.axis()).collect();
        for entry in &given {
            supports.extend(self.resolve(entry)?.into_iter().map(|p| p.fixed));
        }
        Ok(supports)
    }

    /// The axis of axisymmetry, which stays where it is: material that left it would leave a hole.
    fn axis(&self) -> Option<Fixed> {
        let widest = self.mesh.nodes.iter().map(|x| x[0]).fold(0.0, f64::max);
        let of_body = |n: &u32| self.bodies.iter().any(|body| body.nodes.binary_search(n).is_ok());
        let on_axis = |n: &u32| self.mesh.nodes[*n as usize][0] <= ON_AXIS * widest && !of_body(n);
        let nodes = || (0..self.mesh.nodes.len() as u32).filter(on_axis).collect();
        (self.case.geometry == Geometry::Axisymmetric).then(|| Fixed { nodes: nodes(), component: 0 })
    }

    /// What is prescribed in a phase.
    ///
    /// # Errors
    /// As [`Holds::supports`].
    pub fn prescribed(&self, phase: &Phase) -> Result<Vec<Prescribed>> {
        let mut prescribed = Vec::new();
        for entry in &phase.prescribed {
            prescribed.extend(self.resolve(entry)?);
        }
        let all: Vec<_> = phase.prescribed.iter().cloned().chain(self.supported()).collect();
        self.check(&format!("phase {}", phase.name), &all)?;
        Ok(prescribed)
    }

    /// The supports as displacements of zero.
    fn supported(&self) -> Vec<checked::Prescribed> {
        let mut given = Vec::new();
        for support in &self.case.supports {
            let held = [support.fixed[0], support.fixed[1], support.rotation];
            for component in (0..3).filter(|&c| held[c]) {
                let displacement = TimeValue::Constant(0.0);
                given.push(checked::Prescribed { curve: support.curve.clone(), component, displacement });
            }
        }
        given
    }

    /// The body that an entry names, or that has all of a curve.
    fn body(&self, name: &str) -> Option<&'a Body<2>> {
        self.bodies.iter().find(|body| body_of(self.mesh, body, name))
    }

    /// The nodes that an entry moves. All of a curve moves alike: a body that has it does not turn.
    fn resolve(&self, given: &checked::Prescribed) -> Result<Vec<Prescribed>> {
        let Some(body) = self.body(&given.curve) else {
            let nodes = group(self.mesh, &given.curve)?.nodes.clone();
            if self.bodies.iter().any(|body| nodes.iter().any(|n| body.nodes.binary_search(n).is_ok())) {
                return Err(Error::input(
                    format!("the curve `{}`", given.curve),
                    "some of it belongs to a rigid structure and some does not",
                    "make two curves of it in the .geo",
                ));
            }
            let fixed = Fixed { nodes, component: given.component };
            return Ok(vec![Prescribed { fixed, displacement: given.displacement.clone() }]);
        };
        let does_not_turn = given.component != 2 && !is_region(self.mesh, body, &given.curve);
        let still = does_not_turn.then(|| moved(body, 2, &TimeValue::Constant(0.0))).flatten();
        Ok(moved(body, given.component, &given.displacement).into_iter().chain(still).collect())
    }

    /// # Errors
    /// Input: two entries that move a rigid body differently, a rotation that its curves rule out, one of a body
    /// that cannot turn, or a way off the axis.
    fn check(&self, place: &str, given: &[checked::Prescribed]) -> Result<()> {
        let still = TimeValue::Constant(0.0);
        for (i, entry) in given.iter().enumerate() {
            let Some(body) = self.body(&entry.curve) else { continue };
            let problem = |problem: String| {
                Err(Error::input(place, problem, "prescribe the motion of a rigid structure once, by its name"))
            };
            let cannot = body.dofs.rotation.is_none() && entry.component != 1 && entry.displacement != still;
            if cannot {
                return problem(format!("`{}` moves along the axis of symmetry only", entry.curve));
            }
            let same = |other: &&checked::Prescribed| self.body(&other.curve) == Some(body);
            for other in given[..i].iter().filter(same) {
                let directions = ["x", "y", "rotation"];
                if other.component == entry.component && other.displacement != entry.displacement {
                    let direction = directions[entry.component];
                    return problem(format!(
                        "`{}` and `{}` move the same rigid structure differently ({direction})",
                        other.curve, entry.curve
                    ));
                }
            }
            let turns = |e: &&checked::Prescribed| same(e) && e.component == 2 && e.displacement != still;
            if entry.component < 2
                && !is_region(self.mesh, body, &entry.curve)
                && let Some(turns) = given.iter().find(turns)
            {
                return problem(format!(
                    "the curve `{}` of a rigid structure moves alike all along, which rules out the rotation of `{}`",
                    entry.curve, turns.curve
                ));
            }
        }
        Ok(())
    }
}

/// Whether `name` is that of the region of a body.
pub fn is_region(mesh: &Mesh<2>, body: &Body<2>, name: &str) -> bool {
    mesh.regions.get(body.region as usize).is_some_and(|region| region == name)
}

/// Whether `name` is that of a body or of a curve or point that belongs to it.
pub fn body_of(mesh: &Mesh<2>, body: &Body<2>, name: &str) -> bool {
    is_region(mesh, body, name)
        || mesh.group(name).is_some_and(|g| g.nodes.iter().all(|n| body.nodes.binary_search(n).is_ok()))
}
