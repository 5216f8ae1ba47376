//! A test stand: the internal force on a small grid of solid cells, with trial states of any size.

use mpm::dofs::Places;
use mpm::error::Result;
use mpm::interpolation::{Interpolation, Mpm};
use mpm::kinematics::{Kinematics, ThreeD};
use mpm::material::{Elasticity, Model, Profile};
use mpm::mesh::Mesh;
use mpm::mesh::locate::Locator;
use mpm::mesh::shape::CellKind;
use mpm::points::Points;
use mpm::seed::{RegionSeed, seed};
use mpm::system::{Connectivity, Matrix, Pattern, Workspace};
use mpm::tensor::{Tensor, symmetric};
use mpm::term::{Assembly, Frame, History, Internal, Term, Trial};
use nalgebra::{DMatrix, Rotation3, Vector3};
use std::sync::Arc;

pub const KINDS: [CellKind; 2] = [CellKind::T10, CellKind::H27];

/// Vectors on the nodes.
pub type Field = Vec<[f64; 3]>;

/// Numbers in [-1, 1), the same for the same seed (SplitMix64).
pub struct Random(pub u64);

impl Random {
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }

    pub fn rotation(&mut self) -> Tensor {
        let axis = Vector3::new(self.next(), self.next(), self.next());
        Rotation3::from_axis_angle(&nalgebra::Unit::new_normalize(axis), 3.0 * self.next()).into_inner()
    }
}

/// Hencky elasticity that grows with depth below z = 1 m.
pub fn elasticity() -> Elasticity {
    Elasticity::new(Profile::growing(1000.0, 100.0, 1.0), 0.3).unwrap()
}

/// Points of a mesh, so many in each cell.
pub fn points(mesh: &Mesh<3>, points_per_cell: u32) -> Points<3> {
    seed(mesh, false, &[RegionSeed { region: 0, points_per_cell, density: Profile::constant(1.0) }]).unwrap()
}

/// `G x` at all nodes.
pub fn linear(mesh: &Mesh<3>, gradient: &Tensor) -> Field {
    mesh.nodes.iter().map(|x| (gradient * Vector3::from(*x)).into()).collect()
}

/// The largest component.
pub fn size(force: &[[f64; 3]]) -> f64 {
    force.iter().flatten().fold(0.0, |a: f64, b| a.max(b.abs()))
}

/// Displacements at the end of a step and at its beginning, and α_f.
#[derive(Clone, Copy)]
pub struct Step<'a> {
    pub trial: &'a [[f64; 3]],
    pub converged: &'a [[f64; 3]],
    pub alpha_f: f64,
}

impl<'a> Step<'a> {
    /// From a grid at rest, without inertia.
    pub fn to(trial: &'a [[f64; 3]], rest: &'a [[f64; 3]]) -> Self {
        Self { trial, converged: rest, alpha_f: 0.0 }
    }
}

/// The internal force of points on a grid whose nodes all take part.
pub struct Stand {
    pub mesh: Mesh<3>,
    pub points: Points<3>,
    pub term: Internal<ThreeD>,
    interpolation: Interpolation<3>,
    pattern: Pattern,
    /// Numbers of all cells, which are those of their couplings, and of all nodes, which are those of their blocks.
    cells: Vec<u32>,
    nodes: Vec<u32>,
}

impl Stand {
    pub fn new(mesh: Mesh<3>, points: Points<3>, model: Arc<dyn Model>, dynamic: bool) -> Self {
        let locator = Locator::new(&mesh);
        let at = |p: usize| locator.locate(&mesh, &points.position[p], Some(points.cell[p])).unwrap();
        let parametric: Vec<[f64; 3]> = (0..points.len())
            .map(|p| {
                let (cell, xi) = at(p);
                assert_eq!(cell, points.cell[p]);
                xi
            })
            .collect();
        let mut interpolation = Interpolation::default();
        interpolation.fill::<ThreeD>(&Mpm, &mesh, &points.cell, &parametric, &vec![true; mesh.cells.len()]);
        interpolation.weigh(&points.initial_volume);
        let mut connectivity = Connectivity::default();
        for c in 0..mesh.cells.len() {
            connectivity.push(mesh.cells.nodes(c).iter().copied());
        }
        // Unsymmetric, so that the whole tangent is seen.
        let pattern = Pattern::new(&vec![3; mesh.nodes.len()], connectivity, false);
        let (cells, nodes) = ((0..mesh.cells.len() as u32).collect(), (0..mesh.nodes.len() as u32).collect());
        let term = Internal::new(vec![Some(model)], dynamic);
        Self { mesh, points, term, interpolation, pattern, cells, nodes }
    }

    fn frame(&self) -> Frame<'_, 3> {
        Frame {
            mesh: &self.mesh,
            reset: &[],
            relaxed: false,
            interpolation: &self.interpolation,
            partly_filled: &[],
            ghost: &[],
            constraints: &[],
            loaded: &[],
            boundary: &[],
            open: &[],
            level_set: &[],
            cells: &self.cells,
            places: Places::of(self.mesh.nodes.len(), self.mesh.cells.len(), 0)[0],
            points: &self.points,
            integration: None,
            pattern: &self.pattern,
            coupling: &self.cells,
            block: &self.nodes,
            linear_constraints: None,
            travel: &[],
            bodies: &[],
            bars: &[],
            free_lengths: &[],
        }
    }

    /// A linear field with noise of the size `noise` (m).
    pub fn field(&self, gradient: &Tensor, noise: f64, seed: u64) -> Field {
        let mut random = Random(seed);
        linear(&self.mesh, gradient).iter().map(|u| u.map(|u| u + noise * random.next())).collect()
    }

    /// Gives each point the elastic state that the step takes to the left Cauchy–Green tensor `target(point)`.
    pub fn aim(&mut self, step: Step, mut target: impl FnMut(usize) -> Tensor) {
        for cell_points in &self.interpolation.filled {
            let nodes = self.mesh.cells.nodes(cell_points.cell as usize);
            for entries in self.interpolation.entries::<ThreeD>(cell_points) {
                let (mut now, mut before) = (Tensor::identity(), Tensor::identity());
                for (i, &n) in nodes.iter().enumerate() {
                    ThreeD::deform(&mut now, &step.trial[n as usize], &entries.gradient(i));
                    ThreeD::deform(&mut before, &step.converged[n as usize], &entries.gradient(i));
                }
                let back = before * now.try_inverse().unwrap();
                self.points.elastic[entries.point] = symmetric(&(back * target(entries.point) * back.transpose()));
            }
        }
    }

    /// The residual, and the tangent where wanted.
    pub fn evaluate(&self, step: Step, tangent: bool) -> Result<(Field, Option<DMatrix<f64>>)> {
        let equations = self.pattern.len();
        let (mut force, mut matrix) = (vec![0.0; equations], Matrix::new(&self.pattern));
        let mut workspace = Workspace::default();
        let mut out =
            Assembly { force: &mut force, tangent: tangent.then_some(&mut matrix), workspace: &mut workspace };
        let trial = Trial { alpha_f: step.alpha_f, ..Trial::at_rest(step.trial, step.converged) };
        self.term.assemble(&self.frame(), &trial, &mut out)?;
        let dense = tangent.then(|| {
            let mut dense = DMatrix::zeros(equations, equations);
            for j in 0..equations {
                let mut unit = vec![0.0; equations];
                unit[j] = 1.0;
                matrix.multiply(&self.pattern, &unit, dense.column_mut(j).as_mut_slice());
            }
            dense
        });
        Ok((force.chunks_exact(3).map(|f| [f[0], f[1], f[2]]).collect(), dense))
    }

    pub fn force(&self, step: Step) -> Field {
        self.evaluate(step, false).unwrap().0
    }

    /// What the points come to.
    pub fn commit(&self, step: Step) -> Vec<History> {
        let trial = Trial { alpha_f: step.alpha_f, ..Trial::at_rest(step.trial, step.converged) };
        self.term.commit(&self.frame(), &trial).unwrap().0.into_iter().flat_map(|list| list.points).collect()
    }

    /// Largest difference of the tangent from the central difference of the residual, relative to its largest entry.
    pub fn tangent_error(&self, step: Step) -> f64 {
        const H: f64 = 1e-6;
        let tangent = self.evaluate(step, true).unwrap().1.unwrap();
        let mut error = 0f64;
        for j in 0..tangent.ncols() {
            let at = |h: f64| {
                let mut trial = step.trial.to_vec();
                trial[j / 3][j % 3] += h;
                self.force(Step { trial: &trial, ..step })
            };
            let (plus, minus) = (at(H), at(-H));
            for (i, (a, b)) in plus.as_flattened().iter().zip(minus.as_flattened()).enumerate() {
                error = error.max((tangent[(i, j)] - (a - b) / (2.0 * H)).abs());
            }
        }
        error / tangent.amax()
    }
}
