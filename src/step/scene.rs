//! A scene: everything that does not change while it is solved.

use super::change::{Change, Material};
use crate::contact::Interface;
use crate::dofs::{Places, RigidDofs};
use crate::geometry::Line;
use crate::gravity::Gravity;
use crate::interpolation::Basis;
use crate::mesh::Mesh;
use crate::mesh::locate::Locator;
use crate::quadrature::{Parting, Placing, Quadrature};
use crate::rigid::Body;
use crate::system::{LinearConstraints, Rows};
use crate::term::{Bar, MixedPressure, Porous, Spring, Term, WaterLevels};
use crate::time_value::TimeValue;
use std::collections::BTreeMap;
use std::sync::Arc;

/// What a case resolves into. Only [`crate::case`] decides which terms it has.
pub struct Scene<const D: usize> {
    pub mesh: Mesh<D>,
    pub locator: Locator<D>,
    /// The terms of the equations; what the scene does not use is absent.
    pub terms: Vec<Box<dyn Term<D>>>,
    /// The finite elements beside the points, where there are any.
    pub fem: Option<Fem<D>>,
    /// The rigid bodies: their unknowns have numbers after those of the nodes of [`Scene::mesh`].
    pub bodies: Vec<Body<D>>,
    /// Bars between nodes of finite elements, or to places that do not move.
    pub bars: Arc<[Bar<D>]>,
    /// The contact interfaces.
    pub interfaces: Vec<Box<dyn Interface<D>>>,
    /// The levels of the water outside and in the pores, where they differ: for the effective contact pressure (docs/theory.md, eq. 29a).
    pub levels: Option<WaterLevels>,
    /// What the points see of the grid.
    pub basis: &'static dyn Basis<D>,
    /// What the points weigh in integrals.
    pub quadrature: Box<dyn Quadrature<D>>,
    /// What a unit of the pressure unknowns stands for (kPa/m): a shear modulus over the size of a cell, so that all
    /// unknowns are lengths and all equations forces; absent without a pressure field and pore water.
    pub pressure_unit: Option<f64>,
    /// The part of the stress of each material, by number, that the pressure field carries; the part of the pore water causes no friction.
    pub carried: Vec<Option<MixedPressure>>,
    /// The water in the pores, where its pressure is a field of its own.
    pub water: Option<Water>,
    /// Degrees of freedom held at their place in every phase.
    pub supports: Vec<Fixed>,
    /// Those of boundaries with dashpots and no springs, which are held in phases without inertia only.
    pub absorbing: Vec<Fixed>,
    /// Springs and dashpots under nodes.
    pub springs: Arc<[Spring<D>]>,
    /// Pairs of nodes that move alike: the first follows the second.
    pub ties: Vec<[u32; 2]>,
    pub phases: Vec<Phase>,
    /// The soil that each phase removes as it begins.
    pub removals: Vec<Option<Removal<D>>>,
    /// The soil that each phase places as it begins, after that.
    pub placements: Vec<Option<Placement<D>>>,
    /// Curves through which soil leaves the model.
    pub outflows: Vec<Outflow>,
    /// Curves through which soil enters the model.
    pub inflows: Vec<Inflow<D>>,
    /// Time (s) at which the run begins: 0, or less where its first phase comes before those of the user.
    pub begins: f64,
    /// Nodes of the grid for which [`super::State::travel`] is the displacement of the material that is there as the run begins, ascending.
    pub traced: Vec<u32>,
    /// Those of them at whose material forces act.
    pub loaded: Vec<u32>,
    pub numerics: Numerics,
    /// Acceleration of gravity (m/s²), for the energies in the log.
    pub gravity: [f64; D],
    /// The largest (m/s²) that a phase has.
    pub strongest_gravity: f64,
    /// Largest confined modulus λ + 2G (kPa) and density (t/m³) of the scene: rounding is measured by the
    /// first, the spread of the motion over empty nodes by the second.
    pub stiffness_scale: f64,
    pub density_scale: f64,
}

impl<const D: usize> Scene<D> {
    /// The number of nodes of the mesh without those that walls add at its end.
    pub fn mesh_nodes(&self) -> usize {
        let wall = self.bodies.iter().find(|body| body.is_wall);
        wall.map_or(self.mesh.nodes.len(), |body| body.nodes[0] as usize)
    }

    /// How many entries a field of displacements has: one a node of the mesh, then those of rigid bodies ([`RigidDofs`]).
    pub fn displacements(&self) -> usize {
        self.mesh.nodes.len() + self.bodies.iter().flat_map(|body| body.dofs.numbers()).count()
    }

    /// Where (m) entry `n` of a field of displacements begins: a node of the mesh, or the reference point of a rigid body.
    pub fn origin(&self, n: u32) -> [f64; D] {
        self.body_of(n).map_or_else(|| self.mesh.nodes[n as usize], |body| body.centre)
    }

    /// The rigid body that entry `n` of a field of displacements is an unknown of.
    pub fn body_of(&self, n: u32) -> Option<&Body<D>> {
        self.bodies.iter().find(|body| body.dofs.numbers().any(|own| own == n))
    }

    /// The unknowns of the rigid body whose rotation entry `n` of a field of displacements is.
    pub fn turning(&self, n: u32) -> Option<&RigidDofs> {
        self.bodies.iter().map(|body| &body.dofs).find(|dofs| dofs.rotation == Some(n))
    }

    /// The displacements of the nodes as combinations of those of controls (`E` of eq. 2c), where the scheme has such, or nodes are tied.
    pub fn constraints(&self) -> Option<LinearConstraints> {
        if self.ties.is_empty() {
            return self.basis.constraints(&self.mesh).map(|constraints| constraints.extended(self.displacements()));
        }
        let followed: BTreeMap<u32, u32> = self.ties.iter().map(|&[follows, followed]| (follows, followed)).collect();
        let (mut nodes, mut controls) = (Rows::default(), Rows::default());
        for n in 0..self.displacements() as u32 {
            let control = followed.get(&n);
            nodes.push([(*control.unwrap_or(&n), 1.0)]);
            controls.push(control.is_none().then_some((n, 1.0)));
        }
        Some(LinearConstraints::new(nodes, controls))
    }

    /// Whether a pressure field carries a share of the stress.
    pub fn has_pressure_field(&self) -> bool {
        self.pressure_unit.is_some() && self.water.as_ref().is_none_or(|water| !water.alone)
    }

    /// Where the pressures of the cells of the grid and of the finite elements stand in [`super::State::pressure`].
    pub fn places(&self) -> [Places; 2] {
        Places::of(
            self.mesh.nodes.len(),
            self.mesh.cells.len(),
            self.fem.as_ref().map_or(0, |fem| fem.mesh.cells.len()),
        )
    }

    /// Where displacements are given in a phase: supports, prescribed displacements, and structures that the phase leaves out.
    pub fn fixed(&self, phase: usize) -> impl Iterator<Item = &Fixed> {
        let Phase { prescribed, held, .. } = &self.phases[phase];
        self.supports.iter().chain(prescribed.iter().map(|p| &p.fixed)).chain(held)
    }

    /// Whether a phase moves curves of the mesh.
    pub fn moves_curves(&self) -> bool {
        self.phases.iter().any(|phase| phase.moving(self.mesh.nodes.len()).next().is_some())
    }

    /// Whether each node of the grid goes with the material through grid resets in a phase: those that finite elements share, and those of curves
    /// that phases move, until the last phase that prescribes any of their components. A scheme that wants the first shape of the grid has none.
    pub fn following(&self, phase: usize) -> Vec<bool> {
        let count = self.mesh.nodes.len();
        let mut following = vec![false; count];
        for &n in self.fem.iter().flat_map(|fem| &fem.mesh.cells.nodes) {
            following[n as usize] = true;
        }
        if !self.basis.wants_first_shape() {
            let yet = self.phases.iter().skip(phase).flat_map(|phase| &phase.prescribed);
            let mut held = vec![false; count];
            yet.flat_map(|p| &p.fixed.nodes).filter(|n| (**n as usize) < count).for_each(|&n| held[n as usize] = true);
            let moving = self.phases.iter().flat_map(|phase| phase.moving(count)).flat_map(|p| &p.fixed.nodes);
            moving.for_each(|&n| following[n as usize] |= held[n as usize]);
        }
        let mut of_grid = vec![false; count];
        self.mesh.cells.nodes.iter().for_each(|&n| of_grid[n as usize] = true);
        following.iter_mut().zip(of_grid).for_each(|(following, of_grid)| *following &= of_grid);
        following
    }

    /// Whether inertia may come in.
    pub fn dynamic(&self) -> bool {
        self.phases.iter().any(|phase| phase.dynamic || phase.auto)
    }

    /// Whether a material of it has friction.
    pub fn has_friction(&self) -> bool {
        self.terms.iter().any(|term| term.has_friction())
    }

    /// Whether soil with friction follows prescribed displacements in a phase, under loads that do not change.
    pub fn follows(&self, phase: usize) -> bool {
        let phase = &self.phases[phase];
        phase.moves() && !phase.loads_change && self.has_friction()
    }

    /// Whether the phases that have begun, given the one in hand and the time (s) in it, have removed soil of each region or placed some.
    pub fn touched(&self, phase: usize, time: f64) -> Vec<bool> {
        let begun = phase + usize::from(time > 0.0);
        let mut touched = vec![false; self.mesh.regions.len()];
        for removal in self.removals.iter().take(begun).flatten() {
            touched.iter_mut().zip(&removal.regions).for_each(|(touched, goes)| *touched |= goes);
        }
        let placed = self.placements.iter().take(begun).flatten().flat_map(|placement| &placement.soils);
        placed.for_each(|soil| touched[usize::from(soil.region)] = true);
        touched
    }

    /// The interfaces that are active in a phase, with their numbers.
    pub fn touching(&self, phase: usize) -> impl Iterator<Item = (usize, &dyn Interface<D>)> {
        let apart = self.phases.get(phase).map_or(&[][..], |phase| &phase.apart);
        let all = self.interfaces.iter().map(|interface| interface.as_ref()).enumerate();
        all.filter(move |(number, _)| !apart.contains(number))
    }
}

/// Water in the pores.
#[derive(Clone, Debug, Default)]
pub struct Water {
    /// The porous soil of each material by number; `None` without water.
    pub porous: Vec<Option<Porous>>,
    /// Whether no pressure field carries a share of the stress beside it.
    pub alone: bool,
    /// Whether each material, by number, is drained soil, which takes the water of the soil beside it.
    pub drains: Vec<bool>,
    /// Nodes of drained curves, ascending: without excess pressure where water flows.
    pub drained: Vec<u32>,
}

/// Finite elements: structures, and regions of soil that share nodes with the grid. They keep their points, at the
/// places of a quadrature rule, and go on from the shape they have (updated Lagrangian).
pub struct Fem<const D: usize> {
    /// Their cells, those of rigid bodies among them; the nodes are those of [`Scene::mesh`], by number.
    pub mesh: Mesh<D>,
    /// Whether each region of the mesh is a rigid body, and no finite elements.
    pub rigid: Vec<bool>,
    /// Whether each cell has unknowns of a pressure field.
    pub with_pressure: Vec<bool>,
    /// Whether each cell has water in its pores.
    pub with_water: Vec<bool>,
    /// Their terms, as [`Scene::terms`].
    pub terms: Vec<Box<dyn Term<D>>>,
}

impl<const D: usize> Fem<D> {
    /// The cells that are finite elements.
    pub fn deforming(&self) -> impl Iterator<Item = usize> {
        (0..self.mesh.cells.len()).filter(|&c| !self.rigid[self.mesh.cells.region[c] as usize])
    }
}

/// Nodes, or unknowns of rigid bodies, held in one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Fixed {
    pub nodes: Vec<u32>,
    pub component: usize,
}

/// Nodes, or unknowns of rigid bodies, moved in one direction.
#[derive(Clone, Debug, PartialEq)]
pub struct Prescribed {
    pub fixed: Fixed,
    /// Displacement (m) since the beginning of the phase.
    pub displacement: TimeValue,
}

/// A phase of the analysis.
#[derive(Clone, Debug)]
pub struct Phase {
    pub name: String,
    /// With inertia; quasi-static otherwise.
    pub dynamic: bool,
    /// Quasi-static, but switched to dynamics by a step that finds no equilibrium, and back to quasi-static at rest.
    pub auto: bool,
    /// Whether water flows through the pores.
    pub flows: bool,
    /// Duration (s).
    pub duration: f64,
    pub step: StepSize,
    pub prescribed: Vec<Prescribed>,
    /// Whether loads, gravity, water levels or strengths change during it.
    pub loads_change: bool,
    /// Whether a load is a formula in time, and not linear between the stops.
    pub by_formula: bool,
    /// What strengths are divided by (-); absent where they are as given.
    pub reduction: Option<TimeValue>,
    /// Present where the phase looks for the reduction of strength that leaves no equilibrium.
    pub search: Option<Search>,
    /// Nodes of structures that the phase leaves out: they do not move.
    pub held: Vec<Fixed>,
    /// The interfaces that are not active, by number.
    pub apart: Vec<usize>,
    /// The materials that regions take as it begins; none in the first phase.
    pub changes: Vec<Change>,
    /// Whether the output counts displacements from the beginning of the phase (not a grid reset).
    pub reset_displacements: bool,
    /// Times (s) in the phase at which a step must end: outputs, kinks of tables, the end.
    pub stops: Vec<Stop>,
}

impl Phase {
    /// What strengths are divided by (-) at a time (s) since the phase began.
    pub fn reduction_at(&self, time: f64) -> f64 {
        self.reduction.as_ref().map_or(1.0, |factor| factor.at(time))
    }

    /// Times (s) since the phase began; between them all prescribed values, and loads that are no formulas, are linear in time.
    pub fn times(&self) -> impl Iterator<Item = f64> {
        std::iter::once(0.0).chain(self.stops.iter().map(|stop| stop.time))
    }

    /// Whether it prescribes a displacement that is not zero throughout.
    pub fn moves(&self) -> bool {
        self.moving(usize::MAX).next().is_some()
    }

    /// The displacements that it prescribes and that are not zero throughout, of entries below `end` of a field of displacements.
    fn moving(&self, end: usize) -> impl Iterator<Item = &Prescribed> {
        let moves = |p: &Prescribed| self.times().any(|time| p.displacement.at(time) != 0.0);
        self.prescribed.iter().filter(move |p| p.fixed.nodes.iter().all(|&n| (n as usize) < end) && moves(p))
    }
}

/// The soil that a phase removes.
pub struct Removal<const D: usize> {
    /// Whether each region goes.
    pub regions: Vec<bool>,
    /// Where the rest ends.
    pub parting: Box<dyn Parting<D>>,
}

/// The soil that a phase places.
pub struct Placement<const D: usize> {
    /// The soil of each region that is filled.
    pub soils: Vec<Soil>,
    /// Where it comes to be, region by region.
    pub placing: Box<dyn Placing<D>>,
}

/// Soil of a region.
#[derive(Clone, Debug)]
pub struct Soil {
    /// Index into the regions of the mesh.
    pub region: u16,
    /// The number of its material among those of the scene ([`crate::points::Points::model_of`]).
    pub number: u16,
    pub material: Material,
}

/// A curve through which soil leaves the model.
#[derive(Clone, Debug, PartialEq)]
pub struct Outflow {
    pub name: String,
    /// Its sides on the boundary of the mesh, by cell and number of the side.
    pub sides: Vec<(u32, u8)>,
    /// Whether it is open in each phase.
    pub open: Vec<bool>,
}

/// A curve through which soil enters the model.
#[derive(Clone, Debug)]
pub struct Inflow<const D: usize> {
    pub name: String,
    /// The curve, which is straight.
    pub ends: Line<D>,
    /// The unit normal into the mesh.
    pub inward: [f64; D],
    /// Whether there is room beside each end, and not a wall along the flow.
    pub open: [bool; 2],
    /// How far (m) points are apart, and how many of them a row has.
    pub spacing: f64,
    pub row: usize,
    /// The acceleration of gravity in each phase.
    pub gravity: Vec<Gravity<D>>,
    /// The soil that enters and its velocity (m/s) across the curve in each phase.
    pub phases: Vec<Option<(Soil, TimeValue)>>,
}

/// How far soil may move without inertia (-), over its height: farther counts as failure in a strength reduction, and gives a warning
/// otherwise.
pub const FARTHEST: f64 = 0.5;

/// What counts as equilibrium while strengths are reduced to failure.
#[derive(Clone, Debug, PartialEq)]
pub struct Search {
    /// The largest displacement (m) of soil for an increase of the factor by one: soil that fails may find equilibrium again in another
    /// shape, and that counts as failure.
    pub farthest: f64,
    /// The nodes of soil that is finite elements; those of soil with material points follow from the grid.
    pub elements: Vec<u32>,
}

/// Sizes of the steps (s) of a phase, `min ≤ initial ≤ max`: the first, the least and the largest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepSize {
    pub initial: f64,
    pub min: f64,
    pub max: f64,
}

/// A time at which a step ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Stop {
    /// Time (s) since the beginning of the phase.
    pub time: f64,
    /// Whether a frame is written there.
    pub frame: bool,
}

/// When the grid is reset: its nodes go back to their first positions (docs/theory.md, section 4).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Restore {
    EveryStep,
    /// When a cell with points is distorted beyond a limit or Newton's iteration fails (reference 1 of docs/theory.md, §2.8).
    Quality {
        /// Least quality of a cell relative to its first one (-).
        least: f64,
        /// Largest ratio of an edge to its length at the last reset, or of that length to it (-).
        stretch: f64,
    },
    /// Updated Lagrangian: the grid moves with the material.
    Never,
}

/// Settings of the numerical method.
#[derive(Clone, Debug, PartialEq)]
pub struct Numerics {
    /// When the grid goes back to its first shape.
    pub restore: Restore,
    /// ρ∞ (-) of the generalised-α method.
    pub spectral_radius: f64,
    /// Relative residual (-) at which Newton's iteration ends.
    pub tolerance: f64,
    /// Relative residual (-) that is accepted where soil with friction follows prescribed displacements and no iteration comes closer.
    pub acceptable_tolerance: f64,
    /// Iterations after which a step is halved.
    pub max_iterations: usize,
}
