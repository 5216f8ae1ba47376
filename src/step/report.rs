//! What a step reports: for the log, the history and the progress.

use super::contact::Resultant;
use super::grid::Grid;
use super::problem::Solution;
use super::scene::Scene;
use super::state::State;
use super::water::Balance;
use crate::points::Points;
use crate::system::Method;
use crate::term::Term;

/// Mass and momentum of the points.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion<const D: usize> {
    /// Mass (t).
    pub mass: f64,
    /// Linear momentum (t m/s).
    pub linear: [f64; D],
    /// Angular momentum (t m²/s) about the origin, in the plane.
    pub angular: f64,
    /// Kinetic energy (kJ).
    pub kinetic: f64,
}

impl<const D: usize> Motion<D> {
    /// That of the material points and the finite elements.
    pub fn of(state: &State<D>) -> Self {
        let mut motion = Self { mass: 0.0, linear: [0.0; D], angular: 0.0, kinetic: 0.0 };
        for points in [&state.points, &state.fem] {
            motion.add(points);
        }
        motion
    }

    fn add(&mut self, points: &Points<D>) {
        const { assert!(D == 2, "angular momentum is a number in the plane only") };
        for (p, &m) in points.mass.iter().enumerate() {
            self.mass += m;
            if let Some(v) = points.velocity.get(p) {
                let x = &points.position[p];
                for d in 0..D {
                    self.linear[d] += m * v[d];
                    self.kinetic += 0.5 * m * v[d] * v[d];
                }
                self.angular += m * (x[0] * v[1] - x[1] * v[0]);
            }
        }
    }
}

/// A converged step.
#[derive(Clone, Debug)]
pub struct Report<const D: usize> {
    /// Size of the step (s).
    pub dt: f64,
    /// Relative residuals, the first before the first iteration.
    pub residuals: Vec<f64>,
    pub method: Method,
    /// Whether the grid was reset before the step.
    pub restored: bool,
    /// Whether the equilibrium after the grid reset was due and was not found.
    pub unbalanced: bool,
    /// Why the step was halved before, each time.
    pub halvings: Vec<String>,
    pub motion: Motion<D>,
    /// Change of linear momentum less the impulse of applied forces and supports (t m/s).
    pub imbalance: [f64; D],
    /// Elastic energy (kJ).
    pub elastic: f64,
    /// Potential energy (kJ) of gravity at its full factor.
    pub potential: f64,
    /// Material points that were strained beyond the range of their model, and took the state of the nearest integration point.
    pub strained: usize,
    /// The resultants of the interfaces in contact.
    pub contacts: Vec<Resultant<D>>,
    /// The volume balance of the pore water; absent without water.
    pub water: Option<Balance>,
    /// Force of the supports and of springs and dashpots (kN) on the nodes, and then on the unknowns of rigid bodies: zero without.
    pub reaction: Vec<[f64; D]>,
}

impl<const D: usize> Report<D> {
    /// `before` is the linear momentum at the beginning of the step, once the supports have stopped their nodes.
    pub fn new(
        scene: &Scene<D>,
        state: &State<D>,
        grid: &Grid<D>,
        dt: f64,
        solution: Solution<D>,
        before: &[f64; D],
    ) -> Self {
        let motion = Motion::of(state);
        let mut reaction = vec![[0.0; D]; scene.displacements()];
        for fixed in scene.fixed(state.phase) {
            for &n in &fixed.nodes {
                if let Some(equation) = grid.dofs.displacement(n, fixed.component) {
                    reaction[n as usize][fixed.component] = solution.residual[equation];
                }
            }
        }
        let held = |d: usize| grid.dofs.forces().map(|(_, n)| reaction[n as usize][d]).sum::<f64>();
        let impulse = |d: usize| dt * (solution.applied[d] + held(d));
        let dynamic = state.dynamic(scene);
        let imbalance = std::array::from_fn(|d| if dynamic { motion.linear[d] - before[d] - impulse(d) } else { 0.0 });
        for spring in &*scene.springs {
            let n = spring.node as usize;
            if grid.dofs.has(spring.node) {
                let rate = if dynamic { 1.0 / dt } else { 0.0 };
                let force = spring.resists(&state.travel[n], &state.increment[n].map(|by| rate * by));
                (0..D).for_each(|d| reaction[n][d] -= force[d]);
            }
        }
        let fall = |(x, m): (&[f64; D], &f64)| -m * (0..D).map(|d| scene.gravity[d] * x[d]).sum::<f64>();
        let energy =
            |terms: &[Box<dyn Term<D>>], points: &Points<D>| terms.iter().map(|t| t.energy(points)).sum::<f64>();
        Self {
            dt,
            residuals: solution.history,
            method: solution.method,
            restored: false,
            unbalanced: false,
            halvings: Vec::new(),
            imbalance,
            elastic: energy(&scene.terms, &state.points)
                + scene.fem.as_ref().map_or(0.0, |fem| energy(&fem.terms, &state.fem)),
            potential: [&state.points, &state.fem].iter().flat_map(|p| p.position.iter().zip(&p.mass)).map(fall).sum(),
            motion,
            strained: 0,
            contacts: Vec::new(),
            water: None,
            reaction,
        }
    }

    /// Newton iterations of the step.
    pub fn iterations(&self) -> usize {
        self.residuals.len() - 1
    }
}
