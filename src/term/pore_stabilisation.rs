//! A weak bond between the pore pressures of each cell: where a corner sees few points or none, it follows its neighbours.
//!
//! On the increment of the step, `−ε V/G Σ_a (Δp_a − Δp̄)` over the corners: a uniform increment is free. In cells without a point that
//! has water a millionth of that holds a uniform one, too, which nothing else may.

use super::{Assembly, Frame, Porous, Term, Trial};
use crate::error::Result;
use crate::interpolation::integrate;
use crate::kinematics::Kinematics;
use crate::system::Local;
use std::marker::PhantomData;
use std::sync::OnceLock;

/// ε (-).
const BOND: f64 = 1e-6;
/// Share of it against a uniform increment where there is no water.
const DRY: f64 = 1e-6;

/// The bond in all cells that take part.
pub struct PoreStabilisation<K> {
    /// The porous soil of each material by number; `None` without water.
    porous: Vec<Option<Porous>>,
    /// What a unit of the unknowns stands for (kPa/m), and a shear modulus (kPa).
    unit: f64,
    shear: f64,
    /// Volume of each cell (m³), when first needed.
    volume: Vec<OnceLock<f64>>,
    kinematics: PhantomData<K>,
}

impl<K> PoreStabilisation<K> {
    /// `unit` is that of [`crate::step::Scene`], `shear` the largest shear modulus (kPa), `cells` those of the mesh.
    pub fn new(porous: Vec<Option<Porous>>, unit: f64, shear: f64, cells: usize) -> Self {
        Self { porous, unit, shear, volume: (0..cells).map(|_| OnceLock::new()).collect(), kinematics: PhantomData }
    }

    fn has_water<const D: usize>(&self, frame: &Frame<D>, cell: u32) -> bool {
        let has = |&p: &u32| frame.points.by_material(p as usize, &self.porous).is_some();
        frame.interpolation.points_in(cell).iter().any(has)
    }
}

impl<const D: usize, K: Kinematics<D>> Term<D> for PoreStabilisation<K> {
    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let compute = |cell: &u32, local: &mut Local| {
            let with = self.has_water(frame, *cell);
            let cell = *cell as usize;
            let nodes = frame.mesh.cells.nodes(cell);
            let corners = frame.mesh.cells.kind[cell].corner_count();
            let gained = |a: usize| {
                let unknown = frame.places.pore(nodes[a]);
                trial.pressure[unknown] - trial.converged_pressure[unknown]
            };
            let share = (1.0 - if with { 0.0 } else { DRY }) / corners as f64;
            let mean = share * (0..corners).map(gained).sum::<f64>();
            let volume = || integrate::<D, K>(frame.mesh, cell, |_, _, _| {});
            let volume = if frame.relaxed { volume() } else { *self.volume[cell].get_or_init(volume) };
            let scale = BOND * (1.0 - trial.alpha_f) * self.unit * volume / self.shear;
            let begin = D * frame.interpolation.nodes(frame.mesh, cell as u32).len();
            for a in 0..corners {
                local.vector[begin + a] -= scale * (gained(a) - mean);
            }
            if local.matrix.is_empty() {
                return Ok(());
            }
            for a in 0..corners {
                for b in 0..corners {
                    let own = if a == b { 1.0 } else { 0.0 };
                    local.matrix[(begin + a) * local.size + begin + b] -= scale * self.unit * (own - share);
                }
            }
            Ok(())
        };
        let coupling = |cell: &u32| frame.coupling[*cell as usize] as usize;
        out.scatter(frame.pattern, frame.cells, coupling, compute)
    }
}
