//! Inertia of nodes that hold little or no mass, over the faces of cells that are cut or short of points:
//! `10⁻⁴ ρ h² ∫ (h [∂_n a] [∂_n δu] + h³ [∂_nn a] [∂_nn δu])` for each component.
//!
//! It is the penalty that brings the motion of the points to the nodes. Nodes beside a few points have next to no mass,
//! and where these points bear nothing, as soil does that comes apart, nothing else would resist their motion however
//! short the step. An acceleration that is linear over both cells is free of it, so that it exerts neither force nor moment
//! (Sticko & Kreiss 2016 stabilise the mass of cut elements so).

use super::ghost::penalise;
use super::{Assembly, Frame, GhostFace, Role, Term, Trial};
use crate::error::Result;
use crate::interpolation::{Jump, Jumps};
use crate::kinematics::Kinematics;
use std::marker::PhantomData;

/// The share of the mass (-) that the penalty counts with.
pub const MASS_PENALTY: f64 = 1e-4;

/// The inertia of the faces that take a penalty.
pub struct GhostInertia<K> {
    /// `10⁻⁴ ρ` (t/m³).
    density: f64,
    jumps: Jumps,
    kinematics: PhantomData<K>,
}

impl<K> GhostInertia<K> {
    /// `density` is that of the scene (t/m³), `faces` the number of inner faces of the mesh.
    pub fn new(density: f64, faces: usize) -> Self {
        Self { density: MASS_PENALTY * density, jumps: Jumps::new(faces), kinematics: PhantomData }
    }
}

impl<const D: usize, K: Kinematics<D>> Term<D> for GhostInertia<K> {
    fn role(&self) -> Role {
        Role::Inertia
    }

    fn penalises_faces(&self) -> bool {
        true
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let factors = |_: &GhostFace, jump: &Jump, _: f64| {
            let mass = self.density * jump.size * jump.size;
            [mass, mass * trial.acceleration_slope, 0.0]
        };
        penalise::<D, K>(frame, &self.jumps, factors, |n| trial.acceleration[n], out)
    }
}
