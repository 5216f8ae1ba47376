//! A test stand: one term on a small grid, with trial states of any size.

use crate::support::Random;
use crate::support::layout::add_point;
use mpm::dofs::Dof;
use mpm::error::Result;
use mpm::interpolation::{Basis, Mpm};
use mpm::kinematics::Kinematics;
use mpm::material::LinearElastic;
use mpm::material::{Elasticity, Profile};
use mpm::mesh::Mesh;
use mpm::mesh::builder::rectangle;
use mpm::mesh::locate::Locator;
use mpm::mesh::shape::{CellKind, MAX_NODES};
use mpm::points::Points;
use mpm::quadrature::Volumes;
use mpm::step::{Grid, Numerics, Phase, Restore, Scene, Simulation, State, StepSize, Stop, Water};
use mpm::system::{Matrix, Workspace};
use mpm::tensor::{Tensor, full, symmetric};
use mpm::term::{Assembly, Frame, Frozen, GhostFace, Term, Trial};
use std::marker::PhantomData;
use std::sync::Arc;

pub const KINDS: [CellKind; 5] = [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q8, CellKind::Q9];

/// Those whose gradients may be smoothed between cells.
pub const SMOOTHED: [CellKind; 4] = [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q9];

/// `∂a/∂u` (1/s²).
const SLOPE: f64 = 170.0;
/// Uniform part of the acceleration (m/s²).
const ACCELERATION: [f64; 2] = [1.3, -0.7];

/// Vectors on the nodes.
pub type Field = Vec<[f64; 2]>;

/// The mesh of all stands: `[2, 4] × [0, 1.5]` m, away from the axis.
pub fn mesh(kind: CellKind) -> Mesh<2> {
    let mut mesh = rectangle(kind, 2.0, 1.5, 2, 2, 0.2, 5);
    for x in &mut mesh.nodes {
        x[0] += 2.0;
    }
    mesh
}

/// Three points anywhere in each cell in which `filled` holds, given the cell's number.
pub fn points(mesh: &Mesh<2>, filled: impl Fn(usize) -> bool) -> Points<2> {
    let mut random = Random(11);
    let mut points = Points::default();
    for c in (0..mesh.cells.len()).filter(|&c| filled(c)) {
        let kind = mesh.cells.kind[c];
        for _ in 0..3 {
            let (a, b) = (0.9 * random.next(), 0.9 * random.next());
            let xi = if kind.is_simplex() {
                let (a, b) = (0.5 + 0.5 * a, 0.5 + 0.5 * b);
                [a * (1.0 - b), b, 0.0]
            } else {
                [a, b, 0.0]
            };
            let mut n = [0.0; MAX_NODES];
            kind.values(&xi, &mut n);
            let mut x = [0.0; 2];
            for (n, &node) in n.iter().zip(mesh.cells.nodes(c)) {
                for (x, y) in x.iter_mut().zip(mesh.nodes[node as usize]) {
                    *x += n * y;
                }
            }
            let (mass, volume) = (0.3 + 0.1 * random.next(), 0.1 + 0.05 * random.next());
            add_point(&mut points, x, [mass, volume], c as u32);
        }
    }
    points
}

/// Makes the system unsymmetric, so that the whole tangent of another term is seen.
struct Unsymmetric;

impl Term<2> for Unsymmetric {
    fn assemble(&self, _: &Frame<2>, _: &Trial<2>, _: &mut Assembly) -> Result<()> {
        Ok(())
    }

    fn symmetric(&self) -> bool {
        false
    }
}

/// A term on a grid. The first term of the scene is the one tested.
pub struct Stand<K> {
    pub scene: Scene<2>,
    pub state: State<2>,
    /// α_f of the trial states.
    pub alpha_f: f64,
    /// Time (s) that water flows for in them.
    pub flow_time: f64,
    /// Whether contact nodes that touched before are held together in them.
    pub held: bool,
    /// The pressure field of the trial states, in the unknowns of the state, and the one before.
    pub pressure: Vec<f64>,
    pub converged_pressure: Vec<f64>,
    pub grid: Grid<2>,
    kinematics: PhantomData<K>,
}

impl<K: Kinematics<2>> Stand<K> {
    /// `whole` asks for the whole tangent, also of a symmetric term.
    pub fn new(mesh: Mesh<2>, points: Points<2>, term: Box<dyn Term<2>>, restored: bool, whole: bool) -> Self {
        Self::with(&Mpm, mesh, points, term, restored, whole, None)
    }

    /// As [`Stand::new`], with a pressure field of the given unit (kPa/m).
    pub fn with_pressure(
        mesh: Mesh<2>,
        points: Points<2>,
        term: Box<dyn Term<2>>,
        restored: bool,
        whole: bool,
        pressure_unit: Option<f64>,
    ) -> Self {
        Self::with(&Mpm, mesh, points, term, restored, whole, pressure_unit)
    }

    /// As [`Stand::with_pressure`], with gradients of another scheme.
    pub fn with(
        scheme: &'static dyn Basis<2>,
        mesh: Mesh<2>,
        points: Points<2>,
        term: Box<dyn Term<2>>,
        restored: bool,
        whole: bool,
        pressure_unit: Option<f64>,
    ) -> Self {
        Self::with_water(scheme, mesh, points, term, restored, whole, pressure_unit, None)
    }

    /// As [`Stand::with`], with water in the pores.
    #[expect(clippy::too_many_arguments, reason = "what a stand is made of")]
    pub fn with_water(
        scheme: &'static dyn Basis<2>,
        mesh: Mesh<2>,
        points: Points<2>,
        term: Box<dyn Term<2>>,
        restored: bool,
        whole: bool,
        pressure_unit: Option<f64>,
        water: Option<Water>,
    ) -> Self {
        let mut terms = vec![term];
        if whole {
            terms.push(Box::new(Unsymmetric));
        }
        let phase = Phase {
            name: "test".into(),
            dynamic: true,
            auto: false,
            flows: false,
            duration: 1.0,
            step: StepSize { initial: 1.0, min: 1.0, max: 1.0 },
            prescribed: Vec::new(),
            reduction: None,
            loads_change: false,
            by_formula: false,
            search: None,
            held: Vec::new(),
            apart: Vec::new(),
            changes: Vec::new(),
            reset_displacements: false,
            stops: vec![Stop { time: 1.0, frame: true }],
        };
        let scene = Scene {
            fem: None,
            bodies: Vec::new(),
            bars: Vec::new().into(),
            interfaces: Vec::new(),
            levels: None,
            locator: Locator::new(&mesh),
            mesh,
            terms,
            quadrature: Box::new(Volumes::<K>::default()),
            pressure_unit,
            carried: Vec::new(),
            water,
            supports: Vec::new(),
            traced: Vec::new(),
            loaded: Vec::new(),
            begins: 0.0,
            phases: vec![phase.clone(), phase],
            removals: Vec::new(),
            placements: Vec::new(),
            outflows: Vec::new(),
            inflows: Vec::new(),
            absorbing: Vec::new(),
            springs: Vec::new().into(),
            ties: Vec::new(),
            basis: scheme,
            numerics: Numerics {
                restore: if restored { Restore::EveryStep } else { Restore::Never },
                spectral_radius: 1.0,
                tolerance: 1e-10,
                acceptable_tolerance: 0.0,
                max_iterations: 25,
            },
            gravity: [0.0; 2],
            strongest_gravity: 0.0,
            stiffness_scale: 1.0,
            density_scale: 1.0,
        };
        let state = State::new(points, scene.mesh.nodes.len(), 1.0);
        let state = Simulation::<2, K>::new(&scene, state).unwrap().state;
        let grid = Grid::new::<K>(&scene, &state).unwrap();
        assert_eq!(grid.dofs.node.len(), scene.mesh.nodes.len(), "all nodes take part, in order");
        Self {
            scene,
            alpha_f: 0.0,
            flow_time: 0.0,
            held: false,
            converged_pressure: state.pressure.clone(),
            pressure: state.pressure.clone(),
            grid,
            state,
            kinematics: PhantomData,
        }
    }

    pub fn term(&self) -> &dyn Term<2> {
        self.scene.terms[0].as_ref()
    }

    pub fn ghost_faces(&self) -> &[GhostFace] {
        &self.grid.ghost
    }

    /// What the term sees.
    pub fn frame(&self) -> Frame<'_, 2> {
        self.grid.frame(&self.scene.mesh, &self.state)
    }

    pub fn partly_filled_cells(&self) -> usize {
        self.state.weights.partly_filled.len()
    }

    /// A field given by the place of a node, with noise of the size `noise` (m).
    pub fn field(&self, noise: f64, seed: u64, at: impl Fn([f64; 2]) -> [f64; 2]) -> Field {
        let mut random = Random(seed);
        self.scene.mesh.nodes.iter().map(|&x| at(x).map(|u| u + noise * random.next())).collect()
    }

    /// Gives each point the elastic state that the trial takes to the left Cauchy–Green tensor
    /// `target(point)`.
    pub fn aim(&mut self, trial: &[[f64; 2]], converged: &[[f64; 2]], mut target: impl FnMut(usize) -> Tensor) {
        for cell_points in &self.grid.interpolations.integration.filled {
            let nodes = self.scene.mesh.cells.nodes(cell_points.cell as usize);
            for entries in self.grid.interpolations.integration.entries::<K>(cell_points) {
                let (mut now, mut before) = (Tensor::identity(), Tensor::identity());
                for (i, &n) in nodes.iter().enumerate() {
                    K::deform(&mut now, &trial[n as usize], &entries.gradient(i));
                    K::deform(&mut before, &converged[n as usize], &entries.gradient(i));
                }
                let back = before * now.try_inverse().unwrap();
                let b = symmetric(&(back * target(entries.point) * back.transpose()));
                self.state.points.elastic[entries.point] = b;
                assert!((full(&b) - full(&b).transpose()).norm() == 0.0);
            }
        }
    }

    /// Displacements between the ends of the step.
    pub fn between(&self, trial: &[[f64; 2]], converged: &[[f64; 2]]) -> Field {
        let blend = |(u, c): (&[f64; 2], &[f64; 2])| [0, 1].map(|d| (1.0 - self.alpha_f) * u[d] + self.alpha_f * c[d]);
        trial.iter().zip(converged).map(blend).collect()
    }

    /// The residual in phase `phase` at the time 0.5 s, and the tangent by columns where wanted.
    pub fn evaluate(
        &self,
        trial: &[[f64; 2]],
        converged: &[[f64; 2]],
        phase: usize,
        tangent: bool,
    ) -> (Field, Vec<Vec<f64>>) {
        let (force, columns) = self.system(trial, &self.pressure, converged, phase, tangent);
        (force[..2 * trial.len()].chunks_exact(2).map(|f| [f[0], f[1]]).collect(), columns)
    }

    /// As [`Stand::evaluate`], with the equations of the pressure field `pressure` at the end.
    pub fn system(
        &self,
        trial: &[[f64; 2]],
        pressure: &[f64],
        converged: &[[f64; 2]],
        phase: usize,
        tangent: bool,
    ) -> (Vec<f64>, Vec<Vec<f64>>) {
        let frame = self.frame();
        let acceleration: Field = trial
            .iter()
            .zip(converged)
            .map(|(u, c)| std::array::from_fn(|d| ACCELERATION[d] + SLOPE * (u[d] - c[d])))
            .collect();
        let between = self.between(trial, converged);
        let trial = Trial {
            displacement: trial,
            between: &between,
            alpha_f: self.alpha_f,
            converged,
            geometry: self.state.geometry(),
            pressure,
            converged_pressure: &self.converged_pressure,
            flow_time: self.flow_time,
            acceleration: &acceleration,
            acceleration_slope: SLOPE,
            contact_weight: 1.0,
            ahead: &[],
            ahead_slope: 0.0,
            phase,
            time: 0.5,
            reduction: 1.0,
            frozen: if self.held { Frozen::Stuck } else { Frozen::Not },
            inverse_dt: 0.0,
            stiffening: 0.0,
        };
        let mut force = vec![0.0; frame.pattern.len()];
        let mut matrix = Matrix::new(frame.pattern);
        let mut workspace = Workspace::default();
        let mut out =
            Assembly { force: &mut force, tangent: tangent.then_some(&mut matrix), workspace: &mut workspace };
        self.term().assemble(&frame, &trial, &mut out).unwrap();
        let columns = if tangent { 0..force.len() } else { 0..0 };
        let columns = columns.map(|j| {
            let (mut unit, mut column) = (vec![0.0; force.len()], vec![0.0; force.len()]);
            unit[j] = 1.0;
            matrix.multiply(frame.pattern, &unit, &mut column);
            column
        });
        let columns = columns.collect();
        (force, columns)
    }

    /// The water (m³) that the term says leaves through it.
    pub fn outflow(&self, trial: &[[f64; 2]], converged: &[[f64; 2]]) -> f64 {
        let at_rest = Trial::at_rest(trial, converged);
        let trial = Trial { pressure: &self.pressure, flow_time: self.flow_time, ..at_rest };
        self.term().outflow(&self.frame(), &trial)
    }

    /// Largest difference of the tangent from the central difference of the residual, relative to its largest
    /// entry (to 1 where it vanishes).
    pub fn tangent_error(&self, trial: &[[f64; 2]], converged: &[[f64; 2]]) -> f64 {
        const H: f64 = 1e-6;
        let (_, tangent) = self.evaluate(trial, converged, 0, true);
        let unit = self.scene.pressure_unit.unwrap_or(0.0);
        let mut error = 0f64;
        for (j, column) in tangent.iter().enumerate() {
            let at = |h: f64| {
                let (mut u, mut pressure) = (trial.to_vec(), self.pressure.clone());
                match self.grid.dofs.dof(j) {
                    Dof::Displacement { node, component } => u[node][component] += h,
                    Dof::Pressure(place) => pressure[place] += h * unit,
                }
                self.system(&u, &pressure, converged, 0, false).0
            };
            let (plus, minus) = (at(H), at(-H));
            for (i, entry) in column.iter().enumerate() {
                let difference = (plus[i] - minus[i]) / (2.0 * H);
                error = error.max((entry - difference).abs());
            }
        }
        error / largest(&tangent)
    }

    /// Largest difference of the tangent from its transpose, relative to its largest entry.
    pub fn asymmetry(&self, trial: &[[f64; 2]], converged: &[[f64; 2]]) -> f64 {
        let (_, k) = self.evaluate(trial, converged, 0, true);
        let interfaces = (0..k.len()).flat_map(|i| (0..i).map(move |j| (i, j)));
        interfaces.map(|(i, j)| (k[i][j] - k[j][i]).abs()).fold(0.0, f64::max) / largest(&k)
    }
}

fn largest(tangent: &[Vec<f64>]) -> f64 {
    let largest = tangent.iter().flatten().fold(0f64, |a, b| a.max(b.abs()));
    if largest > 0.0 { largest } else { 1.0 }
}

/// Sum of the forces.
pub fn resultant(force: &[[f64; 2]]) -> [f64; 2] {
    [0, 1].map(|d| force.iter().map(|f| f[d]).sum())
}

/// The largest component.
pub fn size(force: &[[f64; 2]]) -> f64 {
    force.iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()))
}

/// Hencky elasticity, for terms that need a model beside them.
pub fn elasticity() -> Elasticity {
    // Growing with depth, as soils do.
    Elasticity::new(Profile::growing(1000.0, 100.0, 1.0), 0.3).unwrap()
}

pub fn elastic() -> Arc<LinearElastic> {
    Arc::new(LinearElastic::new(elasticity()))
}
