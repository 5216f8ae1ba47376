//! The terms of the equations of motion. A scene resolves into a list of them; what it does not use is not
//! in the list.
//!
//! The system solved in each step is `R(u) = 0` with `R = Σ terms`, internal forces positive. A term adds
//! its residual and, when asked, its tangent; the ones that carry history commit it after convergence.

mod bar;
mod body_force;
mod contact;
mod drained_surface;
mod empty_cells;
mod extended;
mod facet_pressure;
mod ghost;
mod ghost_inertia;
mod history;
mod hydrostatic;
mod inertia;
mod internal;
mod mixed;
mod mixed_pressure;
mod pore_stabilisation;
mod pressure;
mod rigid;
mod rigid_pressure;
mod smooth_pressure;
mod smoothed;
mod source;
mod springs;
mod stiffness;
mod surface_traction;
mod traction;
mod virtual_pressure;
mod volume;
mod volume_measure;
mod water;
mod water_levels;

pub use bar::{Bar, Bars, End, Mode};
pub use body_force::BodyForce;
pub use contact::{Contact, answer as contact_answer};
pub use drained_surface::DrainedSurface;
pub use empty_cells::EmptyCells;
pub use facet_pressure::FacetPressure;
pub use ghost::GhostPenalty;
pub use ghost_inertia::{GhostInertia, MASS_PENALTY};
pub use history::{Dissipated, Histories, History, Update};
pub use hydrostatic::{Hydrostatic, Phreatic};
pub use inertia::Inertia;
pub use internal::Internal;
pub use mixed::{Mixed, Ratios};
pub use mixed_pressure::{MixedPressure, excess_pressure};
pub use pore_stabilisation::PoreStabilisation;
pub use pressure::{PressureField, shapes as pressure_shapes};
pub use rigid::{RigidFormulaTraction, RigidInertia, RigidTraction, RigidWeight};
pub use rigid_pressure::RigidPressure;
pub use smooth_pressure::SmoothPressure;
pub use source::{Source, Works};
pub use springs::{Spring, Springs};
pub use surface_traction::{SurfaceLoad, SurfaceTraction};
pub use traction::{Course, FormulaTraction, Formulas, Sample, Traction, samples};
pub use virtual_pressure::VirtualPressure;
pub use water::{PoreWater, Porous, WaterStiffness};
pub use water_levels::WaterLevels;

use crate::contact::Constraint;
use crate::dofs::Places;
use crate::error::Result;
use crate::gravity::Gravity;
use crate::interpolation::{CellPoints, Interpolation, PartlyFilled};
use crate::mesh::Mesh;
use crate::mesh::faces::Face;
use crate::points::Points;
use crate::surface::Piece;
use crate::system::{LinearConstraints, Local, Matrix, Pattern, Workspace, scatter};

/// A face between two cells that takes a ghost penalty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GhostFace {
    /// Its number among the inner faces of the mesh.
    pub face: u32,
    pub between: Face,
    /// Its coupling: the nodes in the order of [`Face::nodes`].
    pub coupling: u32,
}

/// The constraint of a contact node with its place in the system.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedConstraint<const D: usize> {
    /// The number of the interface in the scene.
    pub interface: u32,
    pub condition: Constraint<D>,
    /// Whether it lies on what it faces, and no contact node of the interface presses yet.
    pub initially_closed: bool,
    /// Its coupling, and the place of each node of the constraint among the blocks of that.
    pub coupling: u32,
    pub place: Vec<u32>,
}

impl<const D: usize> PlacedConstraint<D> {
    /// The same with a mean gap alone, however that varies under the contact node.
    pub fn in_the_mean(&self) -> Self {
        Self { condition: Constraint { spots: Vec::new(), ..self.condition.clone() }, ..self.clone() }
    }
}

/// What stays fixed while a step is solved.
pub struct Frame<'a, const D: usize> {
    /// The grid as last restored: the reference configuration.
    pub mesh: &'a Mesh<D>,
    /// Where (m) the nodes were at the last grid reset and, after them, the unknowns of rigid bodies; empty before the first.
    pub reset: &'a [[f64; D]],
    /// Whether the nodes of `mesh` are not at their first positions, so that integrals kept for these are invalid.
    pub relaxed: bool,
    pub interpolation: &'a Interpolation<D>,
    /// Cells that take part and are not full of points.
    pub partly_filled: &'a [PartlyFilled],
    /// Faces beside cells that cannot stand alone; empty where the scene has no such penalty.
    pub ghost: &'a [GhostFace],
    /// The contact nodes that face something; empty where the scene has no contact.
    pub constraints: &'a [PlacedConstraint<D>],
    /// The nodes at whose material of the first state forces act, where this is not at them any more: the nodes of its cell with their shares (-).
    pub loaded: &'a [(u32, Vec<(u32, f64)>)],
    /// The pieces of the boundary of the material; empty where the scene has no use for them.
    pub boundary: &'a [Piece],
    /// The parts of these that no structure covers as the step begins.
    pub open: &'a [Piece],
    /// The level set that cells are cut along, one value a node, positive in the material; empty where the scene has no use for
    /// it, or the points weigh their volumes.
    pub level_set: &'a [f64],
    /// The cells that take part, ascending; of finite elements those with unknowns of pressure.
    pub cells: &'a [u32],
    /// Where the pressures of its cells stand in [`Trial::pressure`].
    pub places: Places,
    /// The points at the last converged step.
    pub points: &'a Points<D>,
    /// What integrals are summed over, where `points` are others.
    pub integration: Option<(&'a Interpolation<D>, &'a Points<D>)>,
    /// One block a node that takes part, one coupling a cell that does. With pore water, one more block for each corner,
    /// which follow in a coupling, and with a pressure field one for each corner and each cell with a constant of its
    /// own; they are the last ones of a coupling.
    pub pattern: &'a Pattern,
    /// The coupling of each cell; `u32::MAX` for cells left out.
    pub coupling: &'a [u32],
    /// The block of each node and each unknown of rigid bodies; `u32::MAX` for nodes left out.
    pub block: &'a [u32],
    /// The values of the nodes as combinations of those of controls (`E` of eq. 2c); `block` then has the blocks of the controls. Absent where each node
    /// has equations of its own.
    pub linear_constraints: Option<&'a LinearConstraints>,
    /// How far (m) the nodes have gone since the run began, as [`crate::step::State::travel`].
    pub travel: &'a [[f64; D]],
    /// The coupling of each rigid body.
    pub bodies: &'a [u32],
    /// The coupling of each bar, and its free length (m).
    pub bars: &'a [u32],
    pub free_lengths: &'a [f64],
}

/// Whether the contact status is frozen: contact nodes that were in compression in the step before, or are initially closed, are closed then, whether
/// they press or pull.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Frozen {
    #[default]
    Not,
    /// Contact nodes that are initially closed slide without friction.
    Smooth,
    /// Contact nodes that are initially closed stick where there is friction.
    Stuck,
}

/// A trial state of the step.
#[derive(Clone, Copy)]
pub struct Trial<'a, const D: usize> {
    /// Displacement of the nodes (m) since the grid was last restored, at the end of the step.
    pub displacement: &'a [[f64; D]],
    /// `(1 − α_f) u + α_f u_n` (m): where loads are taken in the generalised-α method; `u` without inertia.
    pub between: &'a [[f64; D]],
    /// α_f of the generalised-α method (-); zero in quasi-static analysis.
    pub alpha_f: f64,
    /// The displacement at the last converged step.
    pub converged: &'a [[f64; D]],
    /// The displacement (m) on whose geometry forces act and strains are taken, linear in what follows it; `None` where the geometry follows
    /// the trial state.
    pub geometry: Option<&'a [[f64; D]]>,
    /// The pressures (kPa) at the end of the step, as in the state; empty without a field of them.
    pub pressure: &'a [f64],
    /// That at the last converged step, or what the points carry to a restored grid.
    pub converged_pressure: &'a [f64],
    /// Time (s) that water flows through the pores for: the step, or zero in a phase without flow.
    pub flow_time: f64,
    /// Acceleration of the nodes (m/s²) weighted by α_m; empty without inertia.
    pub acceleration: &'a [[f64; D]],
    /// Its derivative by the displacement at the end of the step (1/s²).
    pub acceleration_slope: f64,
    /// What the force of contact with soil counts for in the residual (-): [`crate::time_integration::GeneralisedAlpha::impulse`], 1 without inertia.
    pub contact_weight: f64,
    /// How far the nodes go in half a step after its end (m), as fast as they are then; empty without inertia.
    pub ahead: &'a [[f64; D]],
    /// Its derivative by the displacement at the end of the step (-).
    pub ahead_slope: f64,
    /// Number of the phase, from 0.
    pub phase: usize,
    /// Time (s) since the phase began, between the ends of the step as `between` is.
    pub time: f64,
    /// What strengths are divided by (-) at the end of the step.
    pub reduction: f64,
    /// Whether contact nodes that were in compression in the step before, or are initially closed, are closed here.
    pub frozen: Frozen,
    /// One over the size of the step (1/s), for strength that depends on the rate of strain.
    pub inverse_dt: f64,
    /// As [`crate::material::State::stiffening`].
    pub stiffening: f64,
}

impl<'a, const D: usize> Trial<'a, D> {
    /// A state of displacements alone, without inertia and pressures.
    pub fn at_rest(displacement: &'a [[f64; D]], converged: &'a [[f64; D]]) -> Self {
        Self {
            displacement,
            between: displacement,
            alpha_f: 0.0,
            converged,
            geometry: None,
            pressure: &[],
            converged_pressure: &[],
            flow_time: 0.0,
            acceleration: &[],
            acceleration_slope: 0.0,
            contact_weight: 1.0,
            ahead: &[],
            ahead_slope: 0.0,
            phase: 0,
            time: 0.0,
            reduction: 1.0,
            frozen: Frozen::Not,
            inverse_dt: 0.0,
            stiffening: 0.0,
        }
    }
}

/// Where a term adds its residual and tangent.
pub struct Assembly<'a> {
    /// One entry an equation (kN).
    pub force: &'a mut [f64],
    /// Present when the tangent is wanted.
    pub tangent: Option<&'a mut Matrix>,
    pub workspace: &'a mut Workspace,
}

impl Assembly<'_> {
    /// Adds what `compute` makes of each of some `items`, given the coupling of each.
    ///
    /// # Errors
    /// The error of the first item that fails.
    pub fn scatter<I: Sync>(
        &mut self,
        pattern: &Pattern,
        items: &[I],
        coupling: impl Fn(&I) -> usize + Sync,
        compute: impl Fn(&I, &mut Local) -> Result<()> + Sync,
    ) -> Result<()> {
        scatter(pattern, items, coupling, compute, self.force, self.tangent.as_deref_mut(), self.workspace)
    }
}

/// Adds what `compute` makes of each cell over the nodes of its cell.
///
/// # Errors
/// The error of the first cell that fails.
pub fn scatter_cells<const D: usize>(
    frame: &Frame<D>,
    compute: impl Fn(&CellPoints, &mut Local) -> Result<()> + Sync,
    out: &mut Assembly,
) -> Result<()> {
    let coupling = |cell_points: &CellPoints| frame.coupling[cell_points.cell as usize] as usize;
    out.scatter(frame.pattern, &frame.interpolation.filled, coupling, compute)
}

/// What kind of force a term is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// In balance with itself: its sum over all nodes vanishes.
    Internal,
    /// Applied from outside.
    External,
    /// The same, of what gives way: it follows the trial state where the geometry of loads is held.
    Restoring,
    /// Inertia, absent from quasi-static phases.
    Inertia,
}

/// One term of the equations.
pub trait Term<const D: usize>: Send + Sync {
    /// Adds the residual, and the tangent where wanted, at a trial state.
    ///
    /// # Errors
    /// When the trial state is inadmissible (an inverted material point): the caller takes a smaller step.
    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()>;

    /// Whether the tangent is symmetric in every state.
    fn symmetric(&self) -> bool {
        true
    }

    /// What the converged trial state makes of the points, if it changes them. Points that integrals are not summed over may
    /// have no answer to it: they are left out.
    fn commit(&self, _frame: &Frame<D>, _trial: &Trial<D>) -> Option<Update> {
        None
    }

    /// What kind of force the term is.
    fn role(&self) -> Role {
        Role::Internal
    }

    /// Whose work it does.
    fn source(&self) -> Source {
        match self.role() {
            Role::Internal => Source::Stress,
            Role::External | Role::Restoring => Source::Load,
            Role::Inertia => Source::Inertia,
        }
    }

    /// Gravity in a phase, if the term is its.
    fn gravity(&self, _phase: usize) -> Option<&Gravity<D>> {
        None
    }

    /// A message for the log if a load of the term acts on no material as a phase begins.
    fn idle_load(&self, _frame: &Frame<D>, _displacement: &[[f64; D]], _phase: usize) -> Option<String> {
        None
    }

    /// Water (m³) that leaves the soil through it in the step to a converged state.
    fn outflow(&self, _frame: &Frame<D>, _trial: &Trial<D>) -> f64 {
        0.0
    }

    /// Whether a material of the term can yield.
    fn yields(&self) -> bool {
        false
    }

    /// Whether a material of it has friction ([`crate::material::Model::has_friction`]).
    fn has_friction(&self) -> bool {
        false
    }

    /// Whether the term couples cells across the faces of [`Frame::ghost`].
    fn penalises_faces(&self) -> bool {
        false
    }

    /// Whether the term needs [`Frame::open`].
    fn sees_open_boundary(&self) -> bool {
        false
    }

    /// Stored energy (kJ) of the points in their converged state.
    fn energy(&self, _points: &Points<D>) -> f64 {
        0.0
    }
}
