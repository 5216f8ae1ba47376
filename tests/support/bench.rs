//! Small scenes on structured meshes, built without a case file.

use crate::support::layout::add_point;
use mpm::case::parts::places;
use mpm::gravity::Gravity;
use mpm::interpolation::{Basis, Mpm};
use mpm::kinematics::Kinematics;
use mpm::material::{Model, Profile};
use mpm::mesh::Mesh;
use mpm::mesh::cell_size;
use mpm::mesh::locate::Locator;
use mpm::mesh::shape::{MAX_NODES, map, rule};
use mpm::points::Points;
use mpm::quadrature::{Quadrature, Volumes};
use mpm::step::{
    Controller, Fem, Fixed, Numerics, Phase, Prescribed, Report, Restore, Scene, Simulation, State, StepSize, Stop,
    Water,
};
use mpm::term::{
    BodyForce, EmptyCells, Inertia, Internal, MixedPressure, PoreStabilisation, PoreWater, Porous, PressureField,
    SmoothPressure, Term,
};
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
            add_point(&mut points, place, [density * volume, volume], c as u32);
        }
    }
    points
}

/// A scene under construction.
pub struct Bench {
    pub mesh: Mesh<2>,
    /// Whether each cell of the mesh is a finite element; empty where none is.
    pub elements: Vec<bool>,
    pub model: Arc<dyn Model>,
    /// What a pressure field carries beside the model.
    pub carried: Option<MixedPressure>,
    /// Water in the pores, which flows, and the groups of the mesh where it leaves.
    pub porous: Option<Porous>,
    pub drained: Vec<&'static str>,
    pub density: f64,
    pub gravity: [f64; 2],
    pub gravity_factor: TimeValue,
    pub supports: Vec<Fixed>,
    pub prescribed: Vec<Prescribed>,
    pub extra: Vec<Box<dyn Term<2>>>,
    pub restore: Restore,
    pub scheme: &'static dyn Basis<2>,
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
            elements: Vec::new(),
            model,
            carried: None,
            porous: None,
            drained: Vec::new(),
            density: 1.0,
            gravity: [0.0; 2],
            gravity_factor: TimeValue::Constant(1.0),
            supports: Vec::new(),
            prescribed: Vec::new(),
            extra: Vec::new(),
            restore: Restore::Never,
            scheme: &Mpm,
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

    /// Makes finite elements of the cells whose centre is where `within` says.
    pub fn elements_where(&mut self, within: impl Fn(&[f64; 2]) -> bool) {
        let centre = |c: usize| {
            let corners = &self.mesh.cells.nodes(c)[..self.mesh.cells.kind[c].corner_count()];
            [0, 1].map(|d| corners.iter().map(|&n| self.mesh.nodes[n as usize][d]).sum::<f64>() / corners.len() as f64)
        };
        self.elements = (0..self.mesh.cells.len()).map(|c| within(&centre(c))).collect();
    }

    fn is_element(&self, cell: usize) -> bool {
        self.elements.get(cell).copied().unwrap_or(false)
    }

    /// The mesh without its finite elements.
    pub fn background(&self) -> Mesh<2> {
        self.mesh.part(|c| !self.is_element(c))
    }

    /// The material points and those of the finite elements, numbered with the cells of their part, of all `points`.
    pub fn split(&self, mut points: Points<2>) -> [Points<2>; 2] {
        let (mut count, mut of) = ([0; 2], [Vec::new(), Vec::new()]);
        let number: Vec<u32> = (0..self.mesh.cells.len())
            .map(|c| {
                let count = &mut count[usize::from(self.is_element(c))];
                *count += 1;
                *count - 1
            })
            .collect();
        for (p, cell) in points.cell.iter_mut().enumerate() {
            of[usize::from(self.is_element(*cell as usize))].push(p);
            *cell = number[*cell as usize];
        }
        of.map(|numbers| points.select(&numbers))
    }

    pub fn scene<K: Kinematics<2>>(self) -> Scene<2> {
        let whole = self.gravity;
        let gravity = || vec![Gravity::Scaled { whole, factor: self.gravity_factor.clone() }];
        let elements = self.mesh.part(|c| self.is_element(c));
        let background = self.background();
        let fem = (!elements.cells.is_empty()).then(|| {
            let models = vec![Some(self.model.clone())];
            let mut terms: Vec<Box<dyn Term<2>>> = match &self.porous {
                None => vec![Box::new(Internal::<K>::new(models, self.dynamic))],
                Some(porous) => {
                    // As below.
                    let unit = self.model.elasticity().at(0.0).shear / cell_size(&self.mesh, 0);
                    let water = PoreWater::<K>::new(vec![Some(porous.clone())], unit);
                    vec![Box::new(Internal::<K, _>::sharing(models, self.dynamic, water))]
                }
            };
            if self.gravity != [0.0; 2] {
                terms.push(Box::new(BodyForce::<K, 2>::new(gravity())));
            }
            if self.dynamic {
                terms.push(Box::new(Inertia::<K>::default()));
            }
            Fem {
                with_pressure: vec![false; elements.cells.len()],
                with_water: vec![self.porous.is_some(); elements.cells.len()],
                rigid: vec![false],
                mesh: elements,
                terms,
            }
        });
        let moduli = self.model.elasticity().at(0.0);
        let stiffness_scale = self.model.young(0.0).max(moduli.shear);
        let models = vec![Some(self.model.clone())];
        let shear = self.model.elasticity().at(0.0).shear;
        let unit = (self.carried.is_some() || self.porous.is_some()).then(|| shear / cell_size(&self.mesh, 0));
        let of_unit = unit.unwrap_or(0.0);
        let water = self.porous.is_some().then(|| {
            let mut drained: Vec<u32> =
                self.drained.iter().flat_map(|name| self.mesh.group(name).unwrap().nodes.clone()).collect();
            drained.sort_unstable();
            Water { porous: vec![self.porous.clone()], alone: self.carried.is_none(), drained, drains: Vec::new() }
        });
        let cells = background.cells.len();
        let field = || PressureField::<K>::new(vec![self.carried.clone()], of_unit);
        let of_water = || PoreWater::<K>::new(vec![self.porous.clone()], of_unit);
        let internal = |models: Vec<Option<Arc<dyn Model>>>| -> Box<dyn Term<2>> {
            match (self.carried.is_some(), self.porous.is_some()) {
                (false, false) => Box::new(Internal::<K>::new(models, self.dynamic)),
                (true, false) => Box::new(Internal::<K, _>::sharing(models, self.dynamic, field())),
                (false, true) => Box::new(Internal::<K, _>::sharing(models, self.dynamic, of_water())),
                (true, true) => Box::new(Internal::<K, _>::sharing(models, self.dynamic, (field(), of_water()))),
            }
        };
        let mut terms = vec![internal(models)];
        if self.carried.is_some() {
            terms.push(Box::new(SmoothPressure::<K>::new(vec![true], of_unit, shear, cells)));
        }
        if self.porous.is_some() {
            terms.push(Box::new(PoreStabilisation::<K>::new(vec![self.porous.clone()], of_unit, shear, cells)));
        }
        if self.gravity != [0.0; 2] {
            terms.push(Box::new(BodyForce::<K, 2>::new(gravity())));
        }
        if self.restore != Restore::Never {
            terms.push(Box::new(EmptyCells::<K>::new(1e-5 * stiffness_scale, background.cells.len())));
        }
        if self.dynamic {
            terms.push(Box::new(Inertia::<K>::default()));
        }
        terms.extend(self.extra);
        let step = self.duration / self.steps as f64;
        Scene {
            fem,
            bodies: Vec::new(),
            bars: Vec::new().into(),
            interfaces: Vec::new(),
            levels: None,
            locator: Locator::new(&background),
            mesh: background,
            terms,
            quadrature: self.quadrature.unwrap_or_else(|| Box::new(Volumes::<K>::default())),
            pressure_unit: unit,
            carried: Vec::new(),
            water,
            supports: self.supports,
            traced: Vec::new(),
            removals: Vec::new(),
            placements: Vec::new(),
            outflows: Vec::new(),
            inflows: Vec::new(),
            absorbing: Vec::new(),
            springs: Vec::new().into(),
            ties: Vec::new(),
            loaded: Vec::new(),
            begins: 0.0,
            phases: vec![Phase {
                name: "test".into(),
                dynamic: self.dynamic,
                auto: false,
                flows: self.porous.is_some(),
                duration: self.duration,
                step: StepSize { initial: step, min: step / 2f64.powi(self.halvings), max: step },
                prescribed: self.prescribed,
                reduction: None,
                loads_change: false,
                by_formula: false,
                search: None,
                held: Vec::new(),
                apart: Vec::new(),
                changes: Vec::new(),
                reset_displacements: false,
                stops: vec![Stop { time: self.duration, frame: true }],
            }],
            basis: self.scheme,
            numerics: Numerics {
                restore: self.restore,
                spectral_radius: self.spectral_radius,
                tolerance: 1e-10,
                acceptable_tolerance: 0.0,
                max_iterations: 25,
            },
            gravity: self.gravity,
            strongest_gravity: self.gravity[0].hypot(self.gravity[1]),
            stiffness_scale,
            density_scale: self.density,
        }
    }
}

/// Runs the first phase of a scene to its end, calling `watch` after every step.
pub fn run<K: Kinematics<2>>(
    scene: &Scene<2>,
    points: Points<2>,
    watch: impl FnMut(&State<2>, &Report<2>),
) -> State<2> {
    run_parts::<K>(scene, [points, Points::default()], watch)
}

/// As [`run`], given the material points and those of the finite elements.
pub fn run_parts<K: Kinematics<2>>(
    scene: &Scene<2>,
    [mut points, mut fem]: [Points<2>; 2],
    mut watch: impl FnMut(&State<2>, &Report<2>),
) -> State<2> {
    let phase = &scene.phases[0];
    if scene.pressure_unit.is_some() {
        points.pressure.resize(points.len(), 0.0);
    }
    if scene.water.is_some() {
        points.pore_pressure.resize(points.len(), 0.0);
        fem.pore_pressure.resize(fem.len(), 0.0);
    }
    let fem_parametric = scene.fem.as_ref().map_or_else(Vec::new, |part| places(&part.mesh, &fem).unwrap());
    let first = State::new(points, scene.mesh.nodes.len(), phase.step.initial);
    let state = State { fem, fem_parametric, ..first };
    let mut simulation = Simulation::<2, K>::new(scene, state).unwrap();
    let mut controller = Controller::new(phase.step, phase.stops.clone(), phase.step.initial);
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
