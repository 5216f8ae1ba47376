//! The state of a run: all that a checkpoint holds. Everything else follows from it and the scene.

use super::energies::Energies;
use super::ramp::UnbalancedRamp;
use super::scene::Scene;
use crate::contact::Multipliers;
use crate::points::Points;
use crate::quadrature::Weights;
use crate::surface::{MarkerFront, Voids};
use crate::term::Bar;
use crate::time_integration::GeneralisedAlpha;

/// A step between two times of a phase: its loads are those of the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Span {
    /// Number of the phase.
    pub phase: usize,
    /// Times (s) since the phase began.
    pub from: f64,
    pub to: f64,
}

impl Span {
    /// One over its length (1/s); 0 where it has none.
    pub fn rate(self) -> f64 {
        if self.to > self.from { 1.0 / (self.to - self.from) } else { 0.0 }
    }
}

/// The state at the last converged step.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct State<const D: usize> {
    /// Number of the phase, from 0; the number of phases when all are done.
    pub phase: usize,
    /// Time (s) since the run and since the phase began.
    pub time: f64,
    pub phase_time: f64,
    /// Converged steps so far.
    pub step: u64,
    /// Size (s) of the next step that the step control wants.
    pub step_size: f64,
    /// Frames written so far.
    pub frames: u64,
    pub points: Points<D>,
    /// The points of the finite elements, then those of rigid structures, and where they are in their cells; empty
    /// without.
    pub fem: Points<D>,
    pub fem_parametric: Vec<[f64; 3]>,
    /// Coordinates (m) of the nodes at the last grid reset and, after them, of the unknowns of rigid bodies, which begin at the reference point;
    /// empty without finite elements, rigid bodies and curves that phases move, which alone change them.
    pub nodes: Vec<[f64; D]>,
    /// Multipliers and history of the contact nodes of each interface.
    pub multipliers: Vec<Multipliers>,
    /// The free length (m) of each bar.
    pub free_lengths: Vec<f64>,
    /// Whether the velocities and accelerations of the points are those of the motion: false until the first
    /// dynamic step has computed the accelerations from the forces.
    pub moving: bool,
    /// Whether a phase of kind `auto` has been switched to dynamics.
    pub switched_to_dynamics: bool,
    /// Largest kinetic energy (kJ) since the phase began or inertia came in.
    pub peak: f64,
    /// The most energy (kJ) that was in play in the run so far, as kinetic energy and as work from outside.
    pub in_play: f64,
    /// The balance of energy; absent before the run begins.
    pub energies: Option<Energies>,
    /// Mass (t) and volume (m³) that have left through each curve of [`Scene::outflows`]; empty before the first points do.
    pub left: Vec<[f64; 2]>,
    /// Mass (t) and volume (m³) that have entered through each curve of [`Scene::inflows`], and how thick (m) what has come since is; empty before.
    pub entered: Vec<[f64; 3]>,
    /// Force of the supports (kN) in the last step, as [`super::Report::reaction`]; empty before the first one.
    pub reaction: Vec<[f64; D]>,
    /// Where (m) the material points were as the phase, or the part of it without inertia, began; empty where nothing asks how far they
    /// have moved since.
    pub start_position: Vec<[f64; D]>,
    /// The part of the unbalanced force at the start of the phase that is not released yet.
    pub ramp: UnbalancedRamp<D>,
    /// Parametric coordinates of the points in their cells, as of the last restoration.
    pub parametric: Vec<[f64; 3]>,
    /// Displacement (m) since the last restoration of the nodes and, after them, of the unknowns of rigid bodies ([`crate::dofs::RigidDofs`]), as in
    /// all fields of displacements, velocities and forces.
    pub displacement: Vec<[f64; D]>,
    /// The increment (m) of the displacement in the last step, and the size (s) of that step; empty before the first one, zero where
    /// inertia has come in or gone since.
    pub increment: Vec<[f64; D]>,
    pub last_step: f64,
    /// The last step, if it was in equilibrium with its loads without inertia and without flow of water.
    pub balanced: Option<Span>,
    /// The displacement (m) of the nodes as a search for failure began, whose geometry it keeps; empty in other phases.
    pub search_geometry: Vec<[f64; D]>,
    /// The curve of such a search: strengths divided by (-), and how far the soil has moved since it was in equilibrium at the first of these (m).
    pub search_curve: Vec<[f64; 2]>,
    /// Sum (m) of the increments of displacement of the nodes since the run began: at those that [`Scene::traced`] has, of the material that was
    /// there then. At others of a grid that is reset, different material passes a node, and this is the displacement of none of it.
    pub travel: Vec<[f64; D]>,
    /// Its value when a phase last set displacements to zero (`Phase::reset_displacements`), which the history subtracts; empty before that.
    pub uncounted: Vec<[f64; D]>,
    /// The pressure field (kPa, tension positive) by node, at the corners of cells, then the constant of each cell, then
    /// the excess pore pressure (kPa, compression positive) by node, at the corners of cells;
    /// empty without either.
    pub pressure: Vec<f64>,
    /// Velocity (m/s) and acceleration (m/s²) of the nodes; empty in quasi-static analysis.
    pub velocity: Vec<[f64; D]>,
    pub acceleration: Vec<[f64; D]>,
    /// Cells that take part in the solution; empty before the first step.
    pub active: Vec<bool>,
    /// Cells whose faces the system has room for a ghost penalty at; empty where the scene has none.
    pub penalised: Vec<bool>,
    /// What the points weigh, as of the last restoration.
    pub weights: Weights<D>,
    /// The surface of the material, while it is followed.
    pub front: Option<MarkerFront>,
    /// The voids that have opened, while the surface is followed.
    pub voids: Voids,
    /// Restorations so far.
    pub restorations: u64,
}

impl<const D: usize> State<D> {
    /// The state before the first step, given how many entries a field of displacements has ([`Scene::displacements`]).
    pub fn new(points: Points<D>, displacements: usize, first_step: f64) -> Self {
        let displacement = vec![[0.0; D]; displacements];
        Self { points, step_size: first_step, travel: displacement.clone(), displacement, ..Self::default() }
    }

    /// Where (m) entry `n` of a field of displacements was at the last grid reset: a node, or an unknown of a rigid body.
    pub fn at_reset(&self, scene: &Scene<D>, n: u32) -> [f64; D] {
        self.nodes.get(n as usize).copied().unwrap_or_else(|| scene.origin(n))
    }

    /// Coordinates (m) of the nodes of the mesh at the last grid reset.
    pub fn coordinates<'a>(&'a self, scene: &'a Scene<D>) -> &'a [[f64; D]] {
        if self.nodes.is_empty() { &scene.mesh.nodes } else { &self.nodes[..scene.mesh.nodes.len()] }
    }

    /// The points that integrals are summed over: those of the cells, or the material points themselves.
    pub fn integration(&self) -> &Points<D> {
        self.weights.samples.as_ref().map_or(&self.points, |samples| &samples.points)
    }

    /// The points that integrals are summed over, to be changed.
    pub fn integration_mut(&mut self) -> &mut Points<D> {
        self.weights.samples.as_mut().map_or(&mut self.points, |samples| &mut samples.points)
    }

    /// The displacement (m) whose geometry the equations are written on, where that is held.
    pub fn geometry(&self) -> Option<&[[f64; D]]> {
        (!self.search_geometry.is_empty()).then_some(&self.search_geometry)
    }

    /// Whether the step in hand has inertia.
    pub fn dynamic(&self, scene: &Scene<D>) -> bool {
        self.switched_to_dynamics || scene.phases.get(self.phase).is_some_and(|phase| phase.dynamic)
    }

    /// Weight `α_f` of the beginning of the step in hand, 0 without inertia.
    pub fn alpha_f(&self, scene: &Scene<D>) -> f64 {
        if self.dynamic(scene) { GeneralisedAlpha::new(scene.numerics.spectral_radius, 1.0).alpha_f } else { 0.0 }
    }

    /// Begins the next phase where this one ended.
    pub fn next_phase(&mut self, scene: &Scene<D>) {
        let moved = self.dynamic(scene);
        self.phase += 1;
        self.begin_bars(scene);
        self.phase_time = 0.0;
        (self.switched_to_dynamics, self.peak) = (false, 0.0);
        if !(moved && self.ramp.is_kept() && scene.phases.get(self.phase).is_some_and(|next| next.dynamic)) {
            self.ramp = UnbalancedRamp::default();
        }
        // Less than a row of the inflows that end does not enter.
        for (entered, inflow) in self.entered.iter_mut().zip(&scene.inflows) {
            entered[2] *= f64::from(u8::from(matches!(inflow.phases.get(self.phase), Some(Some(_)))));
        }
        self.start_position.clear();
        self.search_geometry.clear();
        self.search_curve.clear();
        if moved && !self.dynamic(scene) {
            self.rest();
        }
        if let Some(next) = scene.phases.get(self.phase) {
            for change in &next.changes {
                change.apply(&mut self.points);
                if let Some(samples) = &mut self.weights.samples {
                    change.apply(&mut samples.points);
                }
                change.apply(&mut self.fem);
            }
            self.step_size = next.step.initial;
            if next.reset_displacements {
                self.uncounted.clone_from(&self.travel);
                for points in [&mut self.points, &mut self.fem] {
                    points.reference.clone_from(&points.position);
                }
            }
        }
    }

    /// How far (m) the ends of a bar are apart.
    fn length_of(&self, scene: &Scene<D>, bar: &Bar<D>) -> f64 {
        let at = |n: u32| {
            let (x, u) = (self.at_reset(scene, n), &self.displacement[n as usize]);
            std::array::from_fn(|d| x[d] + u[d])
        };
        bar.line(at).0
    }

    /// The free lengths of bars as the phase in hand begins.
    pub fn begin_bars(&mut self, scene: &Scene<D>) {
        self.free_lengths.resize(scene.bars.len(), 0.0);
        for (i, bar) in scene.bars.iter().enumerate() {
            self.free_lengths[i] = bar.begun(self.phase, self.free_lengths[i], self.length_of(scene, bar));
        }
    }

    /// The free lengths of bars after a converged step.
    pub fn commit_bars(&mut self, scene: &Scene<D>) {
        for (i, bar) in scene.bars.iter().enumerate() {
            self.free_lengths[i] = bar.yielded(self.phase, self.free_lengths[i], self.length_of(scene, bar));
        }
    }

    /// The force (kN, tension positive) of a bar by its number.
    pub fn force_of_bar(&self, scene: &Scene<D>, number: usize) -> f64 {
        let bar = &scene.bars[number];
        bar.force(self.phase, self.free_lengths[number], self.length_of(scene, bar)).0
    }

    /// Forgets the motion, at the end of a dynamic phase before a quasi-static one.
    pub fn rest(&mut self) {
        self.moving = false;
        for points in [&mut self.points, &mut self.fem] {
            points.velocity.clear();
            points.acceleration.clear();
        }
        self.velocity.clear();
        self.acceleration.clear();
        self.increment.fill([0.0; D]);
    }
}
