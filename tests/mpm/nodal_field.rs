//! A scalar field with a diffusion term of its own, defined in this file only; the library needs no change for it.
//!
//! `c ∂T/∂t = k ∇²T` in the material, by the backward Euler rule on the corners of the cells, with the volumes of the points:
//!
//! ```text
//! R_T = a Σ_p V_p [c (T − T_n) S_a + Δt k ∇T·∇S_a]
//! ```
//!
//! `a` is the unit of the unknowns. Cells without points conduct next to nothing, so that their corners have an equation.

use crate::support::bench::{Bench, constant, quadrature_points};
use mpm::error::Result;
use mpm::interpolation::integrate;
use mpm::kinematics::{Kinematics, PlaneStrain};
use mpm::material::{Elasticity, LinearElastic};
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::CellKind;
use mpm::step::{Controller, Field, Prescribed, Restore, Scene, Simulation, State};
use mpm::system::{Local, scatter};
use mpm::term::{Assembly, Frame, Term, Trial, pressure_shapes};
use mpm::time_value::TimeValue;
use std::f64::consts::PI;
use std::sync::Arc;

/// The share (-) of the conduction that empty cells have.
const EMPTY: f64 = 1e-6;

struct Diffusion {
    capacity: f64,
    conductivity: f64,
    unit: f64,
}

impl Term<2> for Diffusion {
    fn assemble(&self, frame: &Frame<2>, trial: &Trial<2>, out: &mut Assembly) -> Result<()> {
        let dt = if trial.inverse_dt > 0.0 { 1.0 / trial.inverse_dt } else { 0.0 };
        let compute = |&cell: &u32, local: &mut Local| {
            let kind = frame.mesh.cells.kind[cell as usize];
            let corners = &frame.mesh.cells.nodes(cell as usize)[..kind.corner_count()];
            let places: Vec<usize> = corners.iter().map(|&n| frame.places.field(0, n)).collect();
            let now = |a: usize| trial.pressure[places[a]];
            let gained = |a: usize| now(a) - trial.converged_pressure[places[a]];
            let begin = frame.field(0, cell);
            // The functions of the corners are sums of the shape functions of the cell.
            let mut add = |volume: f64, shape: &[f64], gradient: &[[f64; 2]]| {
                let shape = pressure_shapes(kind, shape);
                let slope = [0, 1].map(|d| pressure_shapes(kind, &gradient.iter().map(|g| g[d]).collect::<Vec<_>>()));
                let stored = |a: usize, b: usize| volume * self.capacity * shape[a] * shape[b];
                let flow = |a: usize, b: usize| {
                    volume * dt * self.conductivity * (slope[0][a] * slope[0][b] + slope[1][a] * slope[1][b])
                };
                for a in 0..corners.len() {
                    let sum: f64 = (0..corners.len()).map(|b| stored(a, b) * gained(b) + flow(a, b) * now(b)).sum();
                    local.vector[begin + a] += self.unit * sum;
                    if !local.matrix.is_empty() {
                        for b in 0..corners.len() {
                            let to = (begin + a) * local.size + begin + b;
                            local.matrix[to] += self.unit * self.unit * (stored(a, b) + flow(a, b));
                        }
                    }
                }
            };
            match frame.interpolation.filled.binary_search_by_key(&cell, |cell_points| cell_points.cell) {
                Ok(number) => {
                    for entries in frame.interpolation.entries::<PlaneStrain>(&frame.interpolation.filled[number]) {
                        add(frame.points.volume(entries.point), entries.shape, entries.shape_gradient);
                    }
                }
                Err(_) => {
                    integrate::<2, PlaneStrain>(frame.mesh, cell as usize, |volume, n, gradient| {
                        add(EMPTY * volume, n, gradient);
                    });
                }
            }
            Ok(())
        };
        let coupling = |cell: &u32| frame.coupling[*cell as usize] as usize;
        scatter(frame.pattern, frame.cells, coupling, compute, out.force, out.tangent.as_deref_mut(), out.workspace)
    }
}

fn scene(kind: CellKind, cells: usize, steps: usize, prepare: impl Fn(&mut Bench)) -> (Scene<2>, State<2>) {
    let mesh = rectangle(kind, 0.25, 1.0, 2, cells, 0.0, 0);
    let elasticity = Elasticity::new(constant(1000.0), 0.3).unwrap();
    let mut bench = Bench::new(mesh, Arc::new(LinearElastic::new(elasticity)));
    (bench.restore, bench.steps) = (Restore::EveryStep, steps);
    prepare(&mut bench);
    let unit = 10.0;
    bench.extra = vec![Box::new(Diffusion { capacity: 2.0, conductivity: 0.5, unit })];
    let points = quadrature_points::<PlaneStrain>(&bench.mesh, 4, 1.0);
    let mut scene = bench.scene::<PlaneStrain>();
    scene.fields.push(Field { unit, given: Vec::new() });
    let first = scene.phases[0].step.initial;
    let state = State::new(points, scene.mesh.nodes.len(), first);
    (scene, state)
}

fn run<K: Kinematics<2>>(scene: &Scene<2>, state: State<2>) -> State<2> {
    let phase = &scene.phases[0];
    let mut simulation = Simulation::<2, K>::new(scene, state).unwrap();
    let mut controller = Controller::new(phase.step, phase.stops.clone(), phase.step.initial);
    while controller.next_stop(simulation.state.phase_time).is_some() {
        simulation.advance(&mut controller).unwrap_or_else(|e| panic!("{e}"));
    }
    simulation.state
}

/// The largest error at the points of a column whose top is warmed to one at once, beside the series of Terzaghi's equation.
fn error(kind: CellKind, cells: usize, steps: usize) -> f64 {
    let (mut scene, state) = scene(kind, cells, steps, |bench| {
        bench.gravity = [0.0, -0.01];
        bench.hold("left", &[0]).hold("right", &[0]).hold("bottom", &[0, 1]);
    });
    let mut top = scene.mesh.group("top").unwrap().nodes.clone();
    top.sort_unstable();
    scene.fields[0].given.push((top, TimeValue::Constant(1.0)));
    let state = run::<PlaneStrain>(&scene, state);
    let diffusivity = 0.25 * scene.phases[0].duration;
    let exact = |y: f64| {
        let term =
            |m: f64| 4.0 / (PI * m) * (0.5 * PI * m * (1.0 - y)).sin() * (-(0.5 * PI * m).powi(2) * diffusivity).exp();
        1.0 - (0..200).map(|k| term(f64::from(2 * k + 1))).sum::<f64>()
    };
    let field = &state.points.fields;
    let off = |(x, value): (&[f64; 2], &f64)| (value - exact(x[1])).abs();
    state.points.position.iter().zip(field).map(off).fold(0.0, f64::max)
}

/// The error falls with the size of the steps and of the cells, as far as the first of each allow.
#[test]
fn a_field_diffuses_as_the_series_says() {
    for kind in [CellKind::T3, CellKind::T6, CellKind::Q4, CellKind::Q9] {
        let [coarse, fine] = [(4, 20), (8, 80)].map(|(cells, steps)| error(kind, cells, steps));
        assert!(coarse < 0.03 && fine < 0.4 * coarse, "{kind:?}: {coarse:.1e} {fine:.1e}");
    }
}

/// Without conduction the points carry the field along, unchanged, through the grid.
#[test]
fn a_field_goes_with_the_material() {
    for kind in [CellKind::T6, CellKind::Q9] {
        let (mut scene, mut state) = scene(kind, 12, 20, |bench| {
            let all: Vec<u32> = (0..bench.mesh.nodes.len() as u32).collect();
            for (component, rate) in [(0, 0.0), (1, 0.37)] {
                let fixed = mpm::step::Fixed { nodes: all.clone(), component };
                bench.prescribed.push(Prescribed { fixed, displacement: TimeValue::Rate(rate) });
            }
        });
        scene.terms.pop();
        scene.terms.push(Box::new(Diffusion { capacity: 2.0, conductivity: 0.0, unit: 10.0 }));
        let below: Vec<usize> = (0..state.points.len()).filter(|&p| state.points.position[p][1] < 0.5).collect();
        state.points = state.points.select(&below);
        let value = |x: &[f64; 2]| 3.0 - 2.0 * x[0] + (9.0 * x[1]).sin();
        state.points.fields = state.points.position.iter().map(value).collect();
        let expected = state.points.fields.clone();
        let state = run::<PlaneStrain>(&scene, state);
        assert!(state.points.position.iter().all(|x| x[1] > 0.37));
        let apart = state.points.fields.iter().zip(&expected).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-10, "{kind:?}: {apart:.1e}");
    }
}
