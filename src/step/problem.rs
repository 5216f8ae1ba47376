//! A step as an equation, and its solution.

use super::driven::Ends;
use super::grid::Grid;
use super::scene::Scene;
use super::start::Start;
use super::state::{Span, State};
use super::unknowns::Unknowns;
use crate::dofs::Dof;
use crate::system::Method;
use crate::term::Works;
use crate::time_integration::GeneralisedAlpha;

/// What is to be solved.
pub struct Problem<'a, const D: usize> {
    pub scene: &'a Scene<D>,
    pub state: &'a State<D>,
    /// Displacement (m) of the nodes that the iteration begins with, if not the converged one.
    pub predictor: Option<&'a [[f64; D]]>,
    /// Velocity (m/s) and acceleration (m/s²) of the nodes as the step begins; empty without inertia.
    pub velocity: &'a [[f64; D]],
    pub acceleration: &'a [[f64; D]],
    /// As [`Start::unresolved`].
    pub unresolved: &'a [f64],
    /// As [`Start::driven`]; absent without inertia.
    pub driven: Option<&'a Ends>,
    pub phase: usize,
    /// Time (s) in the phase at the beginning and the end of the step.
    pub from: f64,
    pub to: f64,
    /// Increment (m, kPa) of the displacements and pore pressures that are given, `None` where free. One entry an equation.
    pub given: &'a [Option<f64>],
    /// Present in dynamic analysis.
    pub integration: Option<GeneralisedAlpha>,
    /// Time (s) that water flows for.
    pub flow_time: f64,
}

impl<'a, const D: usize> Problem<'a, D> {
    /// A problem at the last converged state, without prescribed increments and inertia.
    pub fn at_rest(scene: &'a Scene<D>, state: &'a State<D>) -> Self {
        Self {
            scene,
            state,
            predictor: None,
            velocity: &[],
            acceleration: &[],
            unresolved: &[],
            driven: None,
            phase: state.phase,
            from: state.phase_time,
            to: state.phase_time,
            given: &[],
            integration: None,
            flow_time: 0.0,
        }
    }

    /// That of a step of `dt` (s) from the last converged state, with inertia where it begins with the motion `start`.
    pub fn step(
        scene: &'a Scene<D>,
        state: &'a State<D>,
        start: Option<&'a Start<D>>,
        given: &'a [Option<f64>],
        dt: f64,
    ) -> Self {
        let (velocity, acceleration, unresolved): (&[_], &[_], &[_]) =
            start.map_or((&[], &[], &[]), |s| (&s.velocity, &s.acceleration, &s.unresolved));
        Self {
            velocity,
            acceleration,
            unresolved,
            driven: start.map(|start| &start.driven),
            to: state.phase_time + dt,
            given,
            integration: start.map(|_| GeneralisedAlpha::new(scene.numerics.spectral_radius, dt)),
            flow_time: if scene.phases[state.phase].flows { dt } else { 0.0 },
            ..Self::at_rest(scene, state)
        }
    }

    /// The step in time.
    pub fn span(&self) -> Span {
        Span { phase: self.phase, from: self.from, to: self.to }
    }

    /// The displacement (m) of the nodes at the last converged step.
    pub fn converged(&self) -> &'a [[f64; D]] {
        &self.state.displacement
    }

    /// Sets the unknowns to a displacement (m) of the nodes and the converged pressures. Under linear constraints it is the field of the same
    /// controls.
    pub fn begin(&self, grid: &Grid<D>, at: &mut Unknowns<D>, displacement: &[[f64; D]]) {
        at.set(displacement, &self.state.pressure);
        if grid.dofs.constraints.is_none() {
            return;
        }
        let increment = |n: u32| {
            let (now, before) = (&displacement[n as usize], &self.converged()[n as usize]);
            std::array::from_fn(|d| now[d] - before[d])
        };
        at.controls.extend(grid.dofs.node.iter().flat_map(|&n| grid.dofs.value(n, increment)));
        self.follow(grid, at);
    }

    /// The displacements of the nodes from the increments of the controls.
    fn follow(&self, grid: &Grid<D>, at: &mut Unknowns<D>) {
        let mut increment = vec![0.0; grid.dofs.node.len()];
        for d in 0..D {
            increment.iter_mut().zip(at.controls[d..].iter().step_by(D)).for_each(|(to, c)| *to = *c);
            grid.dofs.write(&increment, d, &mut at.displacement);
        }
        for (n, (u, converged)) in (0u32..).zip(at.displacement.iter_mut().zip(self.converged())) {
            if grid.dofs.moves(n) {
                (0..D).for_each(|d| u[d] += converged[d]);
            }
        }
    }

    /// What is left to the prescribed displacements and pressures, in the unit of the unknowns, one entry for each equation.
    pub fn gaps(&self, grid: &Grid<D>, at: &Unknowns<D>, out: &mut Vec<f64>) {
        let gap = |(equation, given): (usize, &Option<f64>)| {
            given.map_or(0.0, |increment| match (grid.dofs.dof(equation), at.controls.get(equation)) {
                (Dof::Displacement { .. }, Some(control)) => increment - control,
                (Dof::Displacement { node, component }, None) => {
                    self.converged()[node][component] + increment - at.displacement[node][component]
                }
                (Dof::Pressure(place), _) => {
                    (self.state.pressure[place] + increment - at.pressure[place])
                        / self.scene.pressure_unit.unwrap_or(1.0)
                }
            })
        };
        out.clear();
        out.extend(self.given.iter().enumerate().map(gap));
    }

    /// Adds `length · δ`, one entry an equation, to the unknowns; a full step reaches the prescribed values to the last bit.
    pub fn advance(&self, grid: &Grid<D>, at: &mut Unknowns<D>, delta: &[f64], length: f64) {
        let constrained = grid.dofs.constraints.is_some();
        for (equation, (delta, given)) in delta.iter().zip(self.given).enumerate() {
            let (value, converged, scale) = match grid.dofs.dof(equation) {
                Dof::Displacement { .. } if constrained => (&mut at.controls[equation], 0.0, 1.0),
                Dof::Displacement { node, component } => {
                    (&mut at.displacement[node][component], self.converged()[node][component], 1.0)
                }
                Dof::Pressure(place) => {
                    (&mut at.pressure[place], self.state.pressure[place], self.scene.pressure_unit.unwrap_or(1.0))
                }
            };
            match given {
                Some(increment) if length == 1.0 => *value = converged + increment,
                _ => *value += length * scale * delta,
            }
        }
        if constrained {
            self.follow(grid, at);
        }
    }
}

/// A converged step.
pub struct Solution<const D: usize> {
    /// Displacement of the nodes (m) since the last grid reset.
    pub displacement: Vec<[f64; D]>,
    /// The pressure field (kPa); empty without one.
    pub pressure: Vec<f64>,
    /// Residual (kN), one entry an equation: zero where free, the force of the support where given.
    pub residual: Vec<f64>,
    /// Relative residuals, the first before the first iteration.
    pub history: Vec<f64>,
    /// Whether soil with friction followed prescribed displacements: residuals are in proportion to the step, and a smaller one is as hard.
    pub follows: bool,
    /// Resultant (kN) of the applied forces, weighted in time as the step does.
    pub applied: [f64; D],
    /// The work of the terms along the displacement of the step.
    pub work: Works,
    pub method: Method,
}
