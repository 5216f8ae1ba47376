//! A weak bond between the unknowns of the pressure field in each cell: where a corner sees few points or none, it
//! follows its neighbours, and the pattern and the signs of the pivots are the same everywhere.
//!
//! On the increment of the step, `−ε V/G Σ_a (π_a − π̄)` over the corners and `−ε₀ V/G π₀` for the constant of the
//! cell: a uniform increment is free. The second also settles which part of a uniform pressure the corners have and
//! which the constants, which the strains do not tell. In cells without a point of which the field carries something, a
//! millionth of the first holds a uniform increment, too, which nothing else may.

use super::pressure::{MOST, gather, unknowns};
use super::{Assembly, Frame, Term, Trial};
use crate::error::Result;
use crate::interpolation::integrate;
use crate::kinematics::Kinematics;
use crate::system::Local;
use std::marker::PhantomData;
use std::sync::OnceLock;

/// Bond between the corners of a cell, ε (-).
const CORNERS: f64 = 1e-6;
/// Bond of the constant of a cell, ε₀ (-).
const CONSTANT: f64 = 1e-4;

/// Share of the bond between corners against a uniform increment where nothing is carried.
const IDLE: f64 = 1e-6;

/// The bond in all cells that take part.
pub struct SmoothPressure<K> {
    /// Whether the field carries something of each material by number.
    carries: Vec<bool>,
    /// What a unit of the unknowns stands for (kPa/m), and a shear modulus (kPa).
    unit: f64,
    shear: f64,
    /// Volume of each cell (m³), when first needed: a restored grid keeps its shape.
    volume: Vec<OnceLock<f64>>,
    kinematics: PhantomData<K>,
}

impl<K> SmoothPressure<K> {
    /// `carries[m]` where the field carries something of material `m`, `unit` is that of [`crate::step::Scene`], `shear` the
    /// largest shear modulus (kPa), `cells` those of the mesh.
    pub fn new(carries: Vec<bool>, unit: f64, shear: f64, cells: usize) -> Self {
        Self { carries, unit, shear, volume: (0..cells).map(|_| OnceLock::new()).collect(), kinematics: PhantomData }
    }
}

impl<K> SmoothPressure<K> {
    /// Whether the field carries something of a point of a cell.
    fn is_carried<const D: usize>(&self, frame: &Frame<D>, cell: u32) -> bool {
        let carries = |&p: &u32| self.carries.get(frame.points.model_of(p as usize)).copied().unwrap_or(false);
        frame.interpolation.points_in(cell).iter().any(carries)
    }
}

impl<const D: usize, K: Kinematics<D>> Term<D> for SmoothPressure<K> {
    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let compute = |cell: &u32, local: &mut Local| {
            let carried = self.is_carried(frame, *cell);
            let cell = *cell as usize;
            let kind = frame.mesh.cells.kind[cell];
            let (corners, count) = (kind.corner_count(), unknowns(kind));
            let own = frame.mesh.cells.nodes(cell);
            let now = gather(kind, own, frame.places.constant(cell), trial.pressure);
            let before = gather(kind, own, frame.places.constant(cell), trial.converged_pressure);
            let gained: [f64; MOST] = std::array::from_fn(|a| now[a] - before[a]);
            let volume = || integrate::<D, K>(frame.mesh, cell, |_, _, _| {});
            let volume = if frame.relaxed { volume() } else { *self.volume[cell].get_or_init(volume) };
            let scale = (1.0 - trial.alpha_f) * self.unit * volume / self.shear;
            let share = (1.0 - if carried { 0.0 } else { IDLE }) / corners as f64;
            let mean = share * gained[..corners].iter().sum::<f64>();
            let begin = local.size - count;
            for a in 0..corners {
                local.vector[begin + a] -= scale * CORNERS * (gained[a] - mean);
            }
            for a in corners..count {
                local.vector[begin + a] -= scale * CONSTANT * gained[a];
            }
            if local.matrix.is_empty() {
                return Ok(());
            }
            let scale = scale * self.unit;
            let mut add = |a: usize, b: usize, k: f64| local.matrix[(begin + a) * local.size + begin + b] -= scale * k;
            for a in 0..corners {
                for b in 0..corners {
                    add(a, b, CORNERS * (if a == b { 1.0 } else { 0.0 } - share));
                }
            }
            for a in corners..count {
                add(a, a, CONSTANT);
            }
            Ok(())
        };
        let coupling = |cell: &u32| frame.coupling[*cell as usize] as usize;
        out.scatter(frame.pattern, frame.cells, coupling, compute)
    }
}
