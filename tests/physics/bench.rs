//! Small scenes on structured meshes, built without a case file.

use mpm::kinematics::Kinematics;
use mpm::material::{Model, Profile};
use mpm::mesh::Mesh;
use mpm::mesh::faces::Faces;
use mpm::mesh::locate::Locator;
use mpm::mesh::shape::{MAX_NODES, map, rule};
use mpm::points::Points;
use mpm::quadrature::{Quadrature, Volumes};
use mpm::stencil::{Scheme, cell_size};
use mpm::step::{
    Controller, Fixed, Limits, Numerics, Phase, Prescribed, Report, Restore, Scene, Simulation, State, Stop,
};
use mpm::tensor::{IDENTITY, Tensor};
use mpm::term::{BodyForce, Carried, EmptyCells, Inertia, Internal, PressureField, SmoothPressure, Term};
use mpm::time_value::TimeValue;
use std::sync::Arc;

/// Points at the quadrature points of every cell, of the density (t/m³).
pub fn quadrature_points<K: Kinematics<2>>(mesh: &Mesh<2>, degree: usize, density: f64) -> Points<2> {
    let mut points = Points::default();
    let (mut n, mut g) = ([0.0; MAX_NODES], [[0.0; 2]; MAX_NODES]);
    for c in 0..mesh.cells.len() {
        let mut x = Vec::new();
        mesh.cell_coordinates(c, &mut x);
        for (xi, weight) in rule(mesh.cells.kind[c], degree) {
            let det = map(mesh.cells.kind[c], &x, &xi, &mut n, &mut g);
            let place: [f64; 2] = std::array::from_fn(|d| x.iter().zip(&n).map(|(x, n)| x[d] * n).sum());
            let volume = weight * det * K::measure(&place);
            points.position.push(place);
            points.origin.push(place);
            points.mass.push(density * volume);
            points.initial_volume.push(volume);
            points.deformation.push(Tensor::identity());
            points.elastic.push(IDENTITY);
            points.stress.push([0.0; 6]);
            points.plastic_strain.push(0.0);
            points.region.push(0);
            points.cell.push(c as u32);
        }
    }
    points
}

/// A scene under construction.
pub struct Bench {
    pub mesh: Mesh<2>,
    pub model: Arc<dyn Model>,
    /// What a pressure field carries beside the model.
    pub carried: Option<Carried>,
    pub density: f64,
    pub gravity: [f64; 2],
    pub gravity_factor: TimeValue,
    pub supports: Vec<Fixed>,
    pub prescribed: Vec<Prescribed>,
    pub extra: Vec<Box<dyn Term<2>>>,
    pub restore: Restore,
    pub scheme: Scheme,
    /// The volumes of the points where none is given.
    pub quadrature: Option<Box<dyn Quadrature<2>>>,
    pub spectral_radius: f64,
    pub dynamic: bool,
    pub duration: f64,
    pub steps: usize,
    /// Halvings allowed: the least step is `duration / steps / 2^halvings`.
    pub halvings: i32,
}

impl Bench {
    pub fn new(mesh: Mesh<2>, model: Arc<dyn Model>) -> Self {
        Self {
            mesh,
            model,
            carried: None,
            density: 1.0,
            gravity: [0.0; 2],
            gravity_factor: TimeValue::Constant(1.0),
            supports: Vec::new(),
            prescribed: Vec::new(),
            extra: Vec::new(),
            restore: Restore::Never,
            scheme: Scheme::Mpm,
            quadrature: None,
            spectral_radius: 1.0,
            dynamic: false,
            duration: 1.0,
            steps: 1,
            halvings: 6,
        }
    }

    /// The nodes of a group of the mesh, held in one direction.
    pub fn on(&self, group: &str, component: usize) -> Fixed {
        Fixed { nodes: self.mesh.group(group).expect("a group of the mesh").nodes.clone(), component }
    }

    pub fn hold(&mut self, group: &str, components: &[usize]) -> &mut Self {
        for &component in components {
            let fixed = self.on(group, component);
            self.supports.push(fixed);
        }
        self
    }

    pub fn scene<K: Kinematics<2>>(self) -> Scene<2> {
        let moduli = self.model.elasticity().at(0.0);
        let stiffness_scale = self.model.young(0.0).max(moduli.shear);
        let models = vec![Some(self.model.clone())];
        let shear = self.model.elasticity().at(0.0).shear;
        let unit = self.carried.is_some().then(|| shear / cell_size(&self.mesh, 0));
        let mut terms: Vec<Box<dyn Term<2>>> = match unit {
            None => vec![Box::new(Internal::<K>::new(models, self.dynamic))],
            Some(unit) => {
                let field = PressureField::<K>::new(vec![self.carried], unit);
                let bond = SmoothPressure::<K>::new(unit, shear, self.mesh.cells.len());
                vec![Box::new(Internal::<K, _>::sharing(models, self.dynamic, field)), Box::new(bond)]
            }
        };
        if self.gravity != [0.0; 2] {
            terms.push(Box::new(BodyForce::<K, 2>::new(self.gravity, vec![self.gravity_factor])));
        }
        if self.restore != Restore::Never {
            terms.push(Box::new(EmptyCells::<K>::new(1e-5 * stiffness_scale, self.mesh.cells.len())));
        }
        if self.dynamic {
            terms.push(Box::new(Inertia::<K>::default()));
        }
        terms.extend(self.extra);
        let step = self.duration / self.steps as f64;
        Scene {
            fem: None,
            pairs: Vec::new(),
            locator: Locator::new(&self.mesh),
            faces: Some(Faces::of(&self.mesh)),
            mesh: self.mesh,
            terms,
            quadrature: self.quadrature.unwrap_or_else(|| Box::new(Volumes::<K>::default())),
            pressure_unit: unit,
            supports: self.supports,
            phases: vec![Phase {
                name: "test".into(),
                dynamic: self.dynamic,
                duration: self.duration,
                first_step: step,
                least_step: step / 2f64.powi(self.halvings),
                largest_step: step,
                prescribed: self.prescribed,
                stops: vec![Stop { time: self.duration, frame: true }],
            }],
            numerics: Numerics {
                scheme: self.scheme,
                restore: self.restore,
                spectral_radius: self.spectral_radius,
                tolerance: 1e-10,
                max_iterations: 25,
            },
            gravity: self.gravity,
            stiffness_scale,
            density_scale: self.density,
        }
    }
}

/// Runs the first phase of a scene to its end, calling `watch` after every step.
pub fn run<K: Kinematics<2>>(
    scene: &Scene<2>,
    mut points: Points<2>,
    mut watch: impl FnMut(&State<2>, &Report<2>),
) -> State<2> {
    let phase = &scene.phases[0];
    if scene.pressure_unit.is_some() {
        points.pressure.resize(points.len(), 0.0);
    }
    let state = State::new(points, scene.mesh.nodes.len(), phase.first_step);
    let mut simulation = Simulation::<2, K>::new(scene, state).unwrap();
    let limits = Limits { least: phase.least_step, largest: phase.largest_step };
    let mut controller = Controller::new(limits, phase.stops.clone(), phase.first_step);
    while controller.next_stop(simulation.state.phase_time).is_some() {
        let report = simulation.advance(&mut controller).unwrap_or_else(|e| panic!("{e}"));
        watch(&simulation.state, &report);
    }
    simulation.state
}

/// A constant parameter.
pub fn constant(value: f64) -> Profile {
    Profile::constant(value)
}
