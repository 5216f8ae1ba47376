//! A pressure on the whole boundary of the material, as the work it does in the material (reference 1 of docs/theory.md, §2.5): by the theorem of
//! Gauss, `−∮ p N_I n dS = −∫ (p ∇N_I + N_I ∇p) dV`, so that
//!
//! `R_I = Σ_p w_p J_p (p ∇_x N_I + N_I ∇p)` at the places of the points in the trial state.
//!
//! The weights are those of the internal force: material with the stress `−p 1` and the weight `∇p` is in balance to
//! rounding wherever its points lie and however jagged its surface. Where regions of the material meet, and where it
//! meets finite elements with the same pressure on them, it cancels; on a wall it presses on the support.
//! A pressure in space alone has a potential, and the tangent is symmetric.
//!
//! In cells where the pressure bends, the points integrate its growth as a polynomial, which it is not. Where the surface is
//! known within the cells the growth is summed there over places of its own ([`layered`]), with the volume of the points.
//!
//! Water in the pores has the pressure `u` in space inside of the material, whose models answer for the effective stress `σ + u 1`: it takes
//! `u ∇_x N_I` away, and where it is the water outside nothing is left but the buoyancy `N_I ∇p`. Its volume is that of the soil and not
//! kept, so that the tangent is not symmetric.

mod layered;
mod place;

use self::layered::Layered;
use self::place::{Acting, Place, inside_out, invert};
use super::extended::{Kept, scatter_functions};
use super::hydrostatic::{Hydrostatic, Momentary, Phreatic};
use super::{Assembly, Frame, Role, Source, Term, Trial};
use crate::error::Result;
use crate::interpolation::{CellPoints, MAX_FUNCTIONS};
use crate::kinematics::{Gradient, Kinematics};
use crate::mesh;
use crate::system::Local;
use std::marker::PhantomData;

/// A pressure on the boundary of all material points.
pub struct VirtualPressure<K> {
    /// What acts from outside in each phase.
    heads: Vec<Option<Hydrostatic>>,
    /// What acts in the pores in each phase, and whether each material by number has such pores; both empty without.
    inside: Vec<Option<Phreatic>>,
    porous: Vec<bool>,
    /// Whether the cells are full of material, as finite elements are.
    full: bool,
    kinematics: PhantomData<K>,
}

impl<K> VirtualPressure<K> {
    /// `heads[i]` acts in phase `i`.
    pub fn new(heads: Vec<Option<Hydrostatic>>) -> Self {
        Self { heads, inside: Vec::new(), porous: Vec::new(), full: false, kinematics: PhantomData }
    }

    /// With water in the pores: `inside[i]` in phase `i`, in material `m` ([`crate::points::Points::model_of`]) where `porous[m]`.
    pub fn with_pores(self, inside: Vec<Option<Phreatic>>, porous: Vec<bool>) -> Self {
        Self { inside, porous, ..self }
    }

    /// In cells that are full of material.
    pub fn in_full_cells(self) -> Self {
        Self { full: true, ..self }
    }
}

impl<K> VirtualPressure<K> {
    fn porous_at<const D: usize>(&self, frame: &Frame<D>, point: usize) -> bool {
        self.porous.get(frame.points.model_of(point)).copied().unwrap_or(false)
    }
}

impl<const D: usize, K: Kinematics<D>> Term<D> for VirtualPressure<K> {
    fn source(&self) -> Source {
        Source::Water
    }

    fn role(&self) -> Role {
        Role::External
    }

    fn symmetric(&self) -> bool {
        self.inside.iter().all(Option::is_none)
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let outside = self.heads.get(trial.phase).and_then(Option::as_ref).map(|head| head.at(trial.time));
        let inside = self.inside.get(trial.phase).and_then(Option::as_ref).map(|head| head.at(trial.time));
        if outside.is_none() && inside.is_none() {
            return Ok(());
        }
        let acting = Acting { outside, inside };
        let compute = |cell_points: &CellPoints, local: &mut Local, _: &mut [f64]| {
            let now = frame.interpolation.gather(frame.mesh, cell_points, trial.between);
            let before = frame.interpolation.gather(frame.mesh, cell_points, trial.converged);
            let nodes = frame.interpolation.nodes(frame.mesh, cell_points.cell);
            let by_points =
                match Layered::of::<K>(self.full, |p| self.porous_at(frame, p), frame, trial, cell_points, acting) {
                    Ok(layered) => {
                        layered.add::<K>(trial, &now, local)?;
                        acting.map(|head| Momentary { gradient: 0.0, ..head })
                    }
                    Err(acting) => acting,
                };
            for entries in frame.interpolation.entries::<K>(cell_points) {
                let place = |node: u32| [&frame.mesh.nodes, trial.between].map(|of| &of[node as usize]);
                let sum =
                    |of: &dyn Fn(u32) -> f64| entries.value.iter().zip(nodes).map(|(n, &node)| n * of(node)).sum();
                let x = sum(&|node| place(node).iter().map(|x| x[0]).sum());
                let y = sum(&|node| place(node).iter().map(|x| mesh::height(x)).sum());
                let porous = self.porous_at(frame, entries.point);
                let Some(pressures) = by_points.on(porous).at([x, y]) else { continue };
                let [deformed, known] = [&now, &before].map(|u| entries.deformation::<K>(u));
                let count = entries.functions();
                let mut gradient = [Gradient { g: [0.0; D], hoop: 0.0 }; MAX_FUNCTIONS];
                (0..count).for_each(|i| gradient[i] = entries.gradient(i));
                let (inverse, determinant) = invert(&deformed)
                    .map_err(|determinant| inside_out(frame.points.name(entries.point), determinant))?;
                let ratio = determinant / known.determinant();
                let volume = entries.weight * ratio * frame.points.deformation[entries.point].determinant();
                let mut place = Place {
                    value: entries.value,
                    gradient: &gradient[..count],
                    inverse,
                    strained: None,
                    volume,
                    pressures,
                };
                let strains: Vec<_>;
                if entries.strains_apart() {
                    strains = (0..count).map(|i| entries.strain_gradient(i)).collect();
                    let of_forces = entries.deformation_of_forces::<K>(&now);
                    place.inverse = invert(&of_forces)
                        .map_err(|determinant| inside_out(frame.points.name(entries.point), determinant))?
                        .0;
                    place.strained = Some((&strains, inverse));
                }
                place.add::<K>(1.0 - trial.alpha_f, local);
            }
            Ok(())
        };
        scatter_functions(frame, Kept::Matrix, compute, out)
    }
}
