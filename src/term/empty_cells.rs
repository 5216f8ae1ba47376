//! A soft linear stiffness in empty and partly empty cells, so that nodes without material points neither
//! make the system singular nor change its pattern (reference 1 of docs/theory.md, §2.4; Coombs 2023 uses the same kind of penalty).
//!
//! `ε E (1 − fill) ∫ (∇ˢN_I : ∇ˢ + τ ∇ᵃN_I : ∇ᵃ)(u_α − u_n)`: linear elasticity with Poisson's ratio zero on the increment of
//! the step. It is free of stress at the beginning of every step, and of order `ε` in its end.
//!
//! What moves through empty cells is braked by it. With inertia the soil resists a step with `E` or with its mass, by `ρ h²` times the derivative of the
//! acceleration by the displacement, whichever is less, and this counts for `E`: else stone would fall through stiff air.
//!
//! The small resistance `τ` to rotation is for single points that fly: their mass holds the cells around them, but where
//! their stress is at the apex of the yield surface, nothing else resists a rotation about them.

use super::{Assembly, Frame, Source, Term, Trial};
use crate::error::Result;
use crate::interpolation::{PartlyFilled, integrate};
use crate::kinematics::Kinematics;
use crate::mesh::{Mesh, cell_size};
use crate::system::Local;
use std::marker::PhantomData;
use std::sync::OnceLock;

/// τ (-): no moment that counts, and a million times what the solver takes for rounding.
const TRACE: f64 = 1e-6;

/// The soft stiffness of the cells that are not full.
pub struct EmptyCells<K> {
    /// `ε E` (kPa) and `ε ρ` (t/m³).
    stiffness: f64,
    density: f64,
    /// `∫ ∇ˢN_I : ∇ˢN_J + τ ∇ᵃN_I : ∇ᵃN_J` of each cell, row-major, made when a cell is first not full: a restored grid keeps
    /// its shape, so that it holds for the whole run, unless finite elements move it.
    unit: Vec<OnceLock<Box<[f64]>>>,
    kinematics: PhantomData<K>,
}

impl<K> EmptyCells<K> {
    /// `stiffness` is that of an empty cell without inertia (kPa), `cells` the number of cells of the mesh.
    pub fn new(stiffness: f64, cells: usize) -> Self {
        Self { stiffness, density: 0.0, unit: (0..cells).map(|_| OnceLock::new()).collect(), kinematics: PhantomData }
    }

    /// With the density (t/m³) of an empty cell in steps with inertia.
    #[must_use]
    pub fn of_density(self, density: f64) -> Self {
        Self { density, ..self }
    }

    /// The stiffness (kPa) of an empty cell of `size` (m) whose acceleration has the derivative `slope` (1/s²) by the displacement.
    fn of_cell(&self, size: f64, slope: f64) -> f64 {
        let inertia = self.density * size * size * slope;
        if inertia > 0.0 { self.stiffness.min(inertia) } else { self.stiffness }
    }
}

/// `∫ ∇ˢN_a e_i : ∇ˢN_b e_k = ½ ∫ (δ_ik g_a·g_b + g_a,k g_b,i)`, row (a, i), column (b, k); the antisymmetric parts have the
/// other sign between the two.
fn unit_stiffness<const D: usize, K: Kinematics<D>>(mesh: &Mesh<D>, cell: usize) -> Box<[f64]> {
    let size = D * mesh.cells.nodes(cell).len();
    let mut unit = vec![0.0; size * size];
    integrate::<D, K>(mesh, cell, |weight, _, g| {
        for a in 0..g.len() {
            for b in 0..g.len() {
                let dot: f64 = (0..D).map(|d| g[a][d] * g[b][d]).sum();
                for i in 0..D {
                    for k in 0..D {
                        let (isotropic, crossed) = (if i == k { dot } else { 0.0 }, g[a][k] * g[b][i]);
                        unit[(a * D + i) * size + b * D + k] +=
                            0.5 * weight * ((1.0 + TRACE) * isotropic + (1.0 - TRACE) * crossed);
                    }
                }
            }
        }
    });
    unit.into_boxed_slice()
}

impl<const D: usize, K: Kinematics<D>> Term<D> for EmptyCells<K> {
    fn source(&self) -> Source {
        Source::Penalty
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let compute = |partly_filled: &PartlyFilled, local: &mut Local| {
            let cell = partly_filled.cell as usize;
            let fresh = frame.relaxed.then(|| unit_stiffness::<D, K>(frame.mesh, cell));
            let unit = fresh
                .as_ref()
                .unwrap_or_else(|| self.unit[cell].get_or_init(|| unit_stiffness::<D, K>(frame.mesh, cell)));
            let of_cell = self.of_cell(cell_size(frame.mesh, cell), trial.acceleration_slope);
            let stiffness = of_cell * partly_filled.emptiness;
            let size = D * frame.mesh.cells.nodes(cell).len();
            for (row, force) in unit.chunks_exact(size).zip(local.vector.iter_mut()) {
                for (columns, &n) in row.chunks_exact(D).zip(frame.mesh.cells.nodes(cell)) {
                    let (u, before) = (&trial.between[n as usize], &trial.converged[n as usize]);
                    for k in 0..D {
                        *force += stiffness * columns[k] * (u[k] - before[k]);
                    }
                }
            }
            for (entries, unit) in local.matrix.chunks_exact_mut(local.size).zip(unit.chunks_exact(size)) {
                for (entry, unit) in entries.iter_mut().zip(unit) {
                    *entry = (1.0 - trial.alpha_f) * stiffness * unit;
                }
            }
            Ok(())
        };
        out.scatter(
            frame.pattern,
            frame.partly_filled,
            |partly_filled| frame.coupling[partly_filled.cell as usize] as usize,
            compute,
        )
    }
}
