//! The material points: a struct of arrays.

use crate::material::State;
use crate::tensor::{Symmetric, Tensor};

/// All material points of a scene. Every column has one entry a point; `velocity` and `acceleration`
/// are empty in a quasi-static analysis, `plastic_increment` where no term needs it, `memory` where no model does,
/// `pressure` without a pressure field, `pore_pressure` without pore water, `model` where no phase changes a material.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Points<const D: usize> {
    /// Position (m) at the last converged step.
    pub position: Vec<[f64; D]>,
    /// Position (m) at which the point was seeded; depth-dependent parameters are taken here.
    pub origin: Vec<[f64; D]>,
    /// Position (m) that displacements are counted from, as of the last reset; empty before one: from the origin.
    pub reference: Vec<[f64; D]>,
    /// Velocity (m/s).
    pub velocity: Vec<[f64; D]>,
    /// Acceleration (m/s²).
    pub acceleration: Vec<[f64; D]>,
    /// Mass (t), per metre in plane strain, per full turn (2π) in axisymmetry.
    pub mass: Vec<f64>,
    /// Volume (m³) when seeded, per metre in plane strain, per full turn (2π) in axisymmetry.
    pub initial_volume: Vec<f64>,
    /// Deformation gradient (-) since seeding.
    pub deformation: Vec<Tensor>,
    /// Elastic left Cauchy–Green tensor (-).
    pub elastic: Vec<Symmetric>,
    /// Cauchy stress (kPa), tension positive, at the last converged step.
    pub stress: Vec<Symmetric>,
    /// Accumulated equivalent plastic strain (-).
    pub plastic_strain: Vec<f64>,
    /// What the last converged step added to it (-).
    pub plastic_increment: Vec<f64>,
    /// What hardens or softens the model of the point ([`crate::material::State::memory`]).
    pub memory: Vec<f64>,
    /// Kirchhoff mean stress (kPa), tension positive, that the pressure field carries.
    pub pressure: Vec<f64>,
    /// Excess pressure (kPa) of the water in the pores, compression positive, at the last converged step.
    pub pore_pressure: Vec<f64>,
    /// Index into the regions of the mesh.
    pub region: Vec<u16>,
    /// Number of the material among those of a scene: first one a region of the mesh, then one a change of it.
    pub model: Vec<u16>,
    /// The cell that holds the point.
    pub cell: Vec<u32>,
}

impl<const D: usize> Points<D> {
    pub fn len(&self) -> usize {
        self.position.len()
    }

    /// What messages call point `p`.
    pub fn name(&self, p: usize) -> String {
        format!("material point {p} at {:.3?} m", self.position[p])
    }

    /// Displacement (m) of point `p` since seeding or the last reset.
    pub fn displacement(&self, p: usize) -> [f64; D] {
        let from = self.reference.get(p).unwrap_or(&self.origin[p]);
        std::array::from_fn(|d| self.position[p][d] - from[d])
    }

    /// The number of the material of point `p`: that of its region, unless a phase has changed it.
    #[inline]
    pub fn model_of(&self, p: usize) -> usize {
        usize::from(*self.model.get(p).unwrap_or(&self.region[p]))
    }

    /// What the model of point `p` remembers, in a step of which `per_second` (1/s) make a second; 0 at rest.
    #[inline]
    pub fn state(&self, p: usize, per_second: f64) -> State {
        State { plastic_strain: self.plastic_strain[p], memory: self.memory.get(p).copied().unwrap_or(0.0), per_second }
    }

    /// Current volume (m³) of point `p`, by the measure of `initial_volume`.
    pub fn volume(&self, p: usize) -> f64 {
        self.initial_volume[p] * self.deformation[p].determinant()
    }

    /// The points with the given numbers, in that order.
    pub fn select(&self, numbers: &[usize]) -> Self {
        fn pick<T: Clone>(column: &[T], numbers: &[usize]) -> Vec<T> {
            if column.is_empty() { Vec::new() } else { numbers.iter().map(|&p| column[p].clone()).collect() }
        }
        Self {
            position: pick(&self.position, numbers),
            origin: pick(&self.origin, numbers),
            reference: pick(&self.reference, numbers),
            velocity: pick(&self.velocity, numbers),
            acceleration: pick(&self.acceleration, numbers),
            mass: pick(&self.mass, numbers),
            initial_volume: pick(&self.initial_volume, numbers),
            deformation: pick(&self.deformation, numbers),
            elastic: pick(&self.elastic, numbers),
            stress: pick(&self.stress, numbers),
            plastic_strain: pick(&self.plastic_strain, numbers),
            plastic_increment: pick(&self.plastic_increment, numbers),
            memory: pick(&self.memory, numbers),
            pressure: pick(&self.pressure, numbers),
            pore_pressure: pick(&self.pore_pressure, numbers),
            region: pick(&self.region, numbers),
            model: pick(&self.model, numbers),
            cell: pick(&self.cell, numbers),
        }
    }

    pub fn is_empty(&self) -> bool {
        self.position.is_empty()
    }
}
