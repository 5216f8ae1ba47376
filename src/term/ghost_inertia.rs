//! Inertia of nodes that hold little or no mass, over the faces of cells that are cut or poor in points:
//! `10⁻⁴ ρ h² ∫ (h [∂_n a] [∂_n δu] + h³ [∂_nn a] [∂_nn δu])` for each component.
//!
//! It is the penalty that brings the motion of the points to the nodes. Nodes beside a few points have next to no mass,
//! and where these points bear nothing, as soil does that comes apart, nothing else would resist their motion however
//! short the step. An acceleration that is linear over both cells is free of it, so that it exerts neither force nor moment
//! (Sticko & Kreiss 2016 stabilise the mass of cut elements so).

use super::{Assembly, Frame, GhostFace, Role, Term, Trial};
use crate::error::Result;
use crate::kinematics::Kinematics;
use crate::stencil::{Jump, Jumps};
use crate::system::{Local, scatter};
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
        let compute = |ghost: &GhostFace, local: &mut Local| {
            let fresh = frame.relaxed.then(|| Jump::of::<D, K>(frame.mesh, &ghost.between));
            let jump = fresh.as_ref().unwrap_or_else(|| self.jumps.of::<D, K>(frame.mesh, &ghost.between, ghost.face));
            let (form, mass) = (&jump.form, self.density * jump.size * jump.size);
            let count = local.size / D;
            for (b, n) in ghost.between.nodes(frame.mesh).enumerate() {
                let acceleration = &trial.acceleration[n as usize];
                for a in 0..count {
                    for k in 0..D {
                        local.vector[a * D + k] += mass * form[a * count + b] * acceleration[k];
                    }
                }
            }
            if local.matrix.is_empty() {
                return Ok(());
            }
            let slope = mass * trial.acceleration_slope;
            for (a, row) in form.chunks_exact(count).enumerate() {
                for (b, form) in row.iter().enumerate() {
                    for k in 0..D {
                        local.matrix[(a * D + k) * local.size + b * D + k] = slope * form;
                    }
                }
            }
            Ok(())
        };
        scatter(
            frame.pattern,
            frame.ghost,
            |ghost| ghost.clique as usize,
            compute,
            out.force,
            out.tangent.as_deref_mut(),
            out.workspace,
        )
    }
}
