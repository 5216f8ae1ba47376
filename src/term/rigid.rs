//! What acts on rigid bodies: their weight, their inertia and dead tractions on their boundary.
//!
//! The reference point is the centroid, so that `m a` and `J α` are uncoupled and the weight has no moment. A dead
//! traction keeps its direction: its moment `Σ (R r) × f` turns with the body.

use super::traction::{Formulas, Sample};
use super::{Assembly, Frame, Role, Source, Term, Trial};
use crate::error::Result;
use crate::gravity::Gravity;
use crate::rigid::Body;
use crate::time_value::TimeValue;

/// Adds a force (kN) to the equations of the unknown `n` of a body.
fn add<const D: usize>(frame: &Frame<D>, n: u32, force: &[f64; D], out: &mut Assembly) {
    let first = frame.pattern.start[frame.block[n as usize] as usize] as usize;
    for (entry, force) in out.force[first..].iter_mut().zip(force) {
        *entry += force;
    }
}

/// Gravity on a body.
pub struct RigidWeight<const D: usize> {
    translation: u32,
    /// Mass (t).
    mass: f64,
    /// That of each phase.
    gravity: Vec<Gravity<D>>,
}

impl<const D: usize> RigidWeight<D> {
    /// `gravity[i]` acts in phase `i`.
    pub fn new(body: &Body<D>, gravity: Vec<Gravity<D>>) -> Self {
        Self { translation: body.dofs.translation, mass: body.mass, gravity }
    }
}

impl<const D: usize> Term<D> for RigidWeight<D> {
    fn source(&self) -> Source {
        Source::Gravity
    }

    fn role(&self) -> Role {
        Role::External
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        let gravity = self.gravity[trial.phase].at(trial.time);
        add(frame, self.translation, &gravity.map(|g| -self.mass * g), out);
        Ok(())
    }
}

/// Inertia of a body.
pub struct RigidInertia {
    /// The unknowns with what resists their acceleration (t).
    masses: Vec<(u32, f64)>,
}

impl RigidInertia {
    pub fn new<const D: usize>(body: &Body<D>) -> Self {
        Self { masses: body.masses().collect() }
    }
}

impl<const D: usize> Term<D> for RigidInertia {
    fn role(&self) -> Role {
        Role::Inertia
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        for &(n, mass) in &self.masses {
            add(frame, n, &trial.acceleration[n as usize].map(|a| mass * a), out);
            let first = frame.pattern.start[frame.block[n as usize] as usize] as usize;
            for e in first..first + D {
                if let Some(tangent) = &mut out.tangent {
                    tangent.add_diagonal(frame.pattern, e, mass * trial.acceleration_slope);
                }
            }
        }
        Ok(())
    }
}

/// A dead traction on a curve of a body.
pub struct RigidTraction<const D: usize> {
    body: Body<D>,
    phase: usize,
    /// Traction components (kPa) in time.
    value: [TimeValue; D],
    /// Area (m²) of the curve, and its first moment (m³) about the reference point when the run began.
    area: f64,
    moment: [f64; D],
}

impl<const D: usize> RigidTraction<D> {
    /// The traction `value` in `phase` on nodes at `position` (m), each with its share (m²) of the area.
    pub fn new(
        body: &Body<D>,
        position: &[[f64; D]],
        shares: &[(u32, f64)],
        phase: usize,
        value: [TimeValue; D],
    ) -> Self {
        let mut moment = [0.0; D];
        for &(n, area) in shares {
            let x = &position[n as usize];
            moment = std::array::from_fn(|d| moment[d] + area * (x[d] - body.centre[d]));
        }
        Self { body: body.clone(), phase, value, area: shares.iter().map(|(_, a)| a).sum(), moment }
    }
}

impl<const D: usize> Term<D> for RigidTraction<D> {
    fn role(&self) -> Role {
        Role::External
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        if trial.phase != self.phase {
            return Ok(());
        }
        let t: [f64; D] = std::array::from_fn(|d| self.value[d].at(trial.time));
        add(frame, self.body.dofs.translation, &t.map(|t| -self.area * t), out);
        let Some(rotation) = self.body.dofs.rotation else { return Ok(()) };
        let arm = self.body.pose_since(frame.reset, trial.between).turn(&self.moment);
        let [_, moment] = self.body.hand_on(&arm, &t);
        add(frame, rotation, &moment.map(|m| -m), out);
        if let Some(tangent) = &mut out.tangent {
            let against: f64 = arm.iter().zip(&t).map(|(r, t)| r * t).sum();
            let first = frame.pattern.start[frame.block[rotation as usize] as usize] as usize;
            let slope = (1.0 - trial.alpha_f) * against / self.body.dofs.arm.powi(2);
            tangent.add_diagonal(frame.pattern, first, slope);
        }
        Ok(())
    }
}

/// A dead traction on a curve of a body that is a formula of the place as the run began, and the time.
pub struct RigidFormulaTraction<const D: usize> {
    body: Body<D>,
    phase: usize,
    formulas: Formulas,
    /// Places (m) on the curve, each with its share (m²) of the area.
    places: Vec<([f64; D], f64)>,
}

impl<const D: usize> RigidFormulaTraction<D> {
    /// Of `formulas` at the places of a rule, in `phase`.
    pub fn new(body: &Body<D>, samples: &[Sample<D>], phase: usize, formulas: Formulas) -> Self {
        let place = |sample: &Sample<D>| (sample.place, sample.shares.iter().map(|(_, share)| share).sum());
        Self { body: body.clone(), phase, formulas, places: samples.iter().map(place).collect() }
    }
}

impl<const D: usize> Term<D> for RigidFormulaTraction<D> {
    fn role(&self) -> Role {
        Role::External
    }

    fn assemble(&self, frame: &Frame<D>, trial: &Trial<D>, out: &mut Assembly) -> Result<()> {
        if trial.phase != self.phase {
            return Ok(());
        }
        let pose = self.body.pose_since(frame.reset, trial.between);
        for (place, area) in &self.places {
            let force = self.formulas.at(place, trial.time)?.map(|t| area * t);
            add(frame, self.body.dofs.translation, &force.map(|f| -f), out);
            let Some(rotation) = self.body.dofs.rotation else { continue };
            let arm = pose.turn(&std::array::from_fn(|d| place[d] - self.body.centre[d]));
            let [_, moment] = self.body.hand_on(&arm, &force);
            add(frame, rotation, &moment.map(|m| -m), out);
            if let Some(tangent) = &mut out.tangent {
                let against: f64 = arm.iter().zip(&force).map(|(r, f)| r * f).sum();
                let first = frame.pattern.start[frame.block[rotation as usize] as usize] as usize;
                tangent.add_diagonal(
                    frame.pattern,
                    first,
                    (1.0 - trial.alpha_f) * against / self.body.dofs.arm.powi(2),
                );
            }
        }
        Ok(())
    }
}
