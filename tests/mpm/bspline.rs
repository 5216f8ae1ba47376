//! Quadratic B-splines on grids of Q9 cells: the functions against the recurrence of Cox and de Boor, the reduced system, and the method with
//! them.

use crate::bench::{Bench, constant, quadrature_points, run};
use crate::layout::{at, lattice, resample, seeded};
use crate::patch::stretch_boundary;
use crate::support::{Random, errors, mpm, rows, run as program_run};
use mpm::analytical::self_weight_column::Column;
use mpm::interpolation::{BSpline, Basis};
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::material::{Elasticity, LinearElastic};
use mpm::mesh::Mesh;
use mpm::mesh::builder::rectangle;
use mpm::mesh::shape::{CellKind, MAX_NODES, map, map_second};
use mpm::step::{Controller, Grid, Limits, Restore, Scene, Simulation, State};
use mpm::system::LinearConstraints;
use mpm::term::{Assembly, GhostInertia, Term, Trial};
use mpm::time_value::TimeValue;
use std::sync::Arc;

fn elastic(young: f64, poisson: f64) -> Arc<LinearElastic> {
    Arc::new(LinearElastic::new(Elasticity::new(constant(young), poisson).unwrap()))
}

/// A rectangle of Q9 cells whose widths grow by `ratio` from one to the next along x, and shrink by it along y.
fn graded(lx: f64, ly: f64, nx: usize, ny: usize, ratio: f64) -> Mesh<2> {
    let mut mesh = rectangle(CellKind::Q9, lx, ly, nx, ny, 0.0, 0);
    let line = |k: f64, count: usize, ratio: f64| {
        // Corners at the sums of a geometric series, middles between them.
        let sum = |k: f64| (0..k as usize).map(|i| ratio.powi(i as i32)).sum::<f64>();
        (sum(k.floor()) + (k - k.floor()) * ratio.powi(k as i32)) / sum(count as f64)
    };
    for x in &mut mesh.nodes {
        let places = [x[0] / lx * nx as f64, x[1] / ly * ny as f64].map(|k| (2.0 * k).round() / 2.0);
        *x = [lx * line(places[0], nx, ratio), ly * line(places[1], ny, 1.0 / ratio)];
    }
    mesh
}

/// The different values of a coordinate of the corners, ascending.
fn knots(mesh: &Mesh<2>, d: usize) -> Vec<f64> {
    let corners = (0..mesh.cells.len()).flat_map(|c| &mesh.cells.nodes(c)[..4]);
    let mut out: Vec<f64> = corners.map(|&n| mesh.nodes[n as usize][d]).collect();
    out.sort_unstable_by(f64::total_cmp);
    out.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    out
}

/// The B-spline `k` of a degree on the knots `t` at `x` by the recurrence of Cox and de Boor, zero over zero being zero.
fn cox_de_boor(t: &[f64], k: usize, degree: usize, x: f64) -> f64 {
    if degree == 0 {
        return f64::from(u8::from(t[k] <= x && x < t[k + 1]));
    }
    let part = |from: usize, by: f64| {
        let length = t[from + degree] - t[from];
        if length > 0.0 { by / length * cox_de_boor(t, from, degree - 1, x) } else { 0.0 }
    };
    part(k, x - t[k]) + part(k + 1, t[k + degree + 1] - x)
}

/// The nodal values of the function of a control.
fn function(constraints: &LinearConstraints, control: u32, nodes: usize) -> Vec<f64> {
    let value = |n: u32| constraints.of_node(n).iter().filter(|(m, _)| *m == control).map(|(_, by)| by).sum();
    (0..nodes as u32).map(value).collect()
}

/// The numbers of the controls: nodes that have a row in the left inverse.
fn controls(constraints: &LinearConstraints, nodes: usize) -> Vec<u32> {
    (0..nodes as u32).filter(|&n| !constraints.of_control(n).is_empty()).collect()
}

/// One function a control, those of Cox and de Boor with open knots at the grid lines, whatever the spacing and also with a single cell.
#[test]
fn functions_are_those_of_cox_and_de_boor() {
    for (nx, ny, ratio) in [(5, 4, 1.0), (6, 3, 1.3), (1, 2, 0.8), (1, 1, 1.0)] {
        let mesh = graded(3.0, 2.0, nx, ny, ratio);
        let constraints = BSpline.constraints(&mesh).unwrap().unwrap();
        let controls = controls(&constraints, mesh.nodes.len());
        assert_eq!(controls.len(), (nx + 2) * (ny + 2));
        let open = [0, 1].map(|d| {
            let x = knots(&mesh, d);
            let (first, last) = (x[0], x[x.len() - 1]);
            [vec![first; 2], x, vec![last; 2]].concat()
        });
        let mut random = Random(3);
        let mut worst = 0f64;
        for &control in &controls {
            // Its numbers by its Greville abscissae, the means of two knots.
            let number = [0, 1].map(|d| {
                let greville = |k: &usize| 0.5 * (open[d][k + 1] + open[d][k + 2]);
                let near = |k: &usize| (greville(k) - mesh.nodes[control as usize][d]).abs() < 1e-9;
                (0..open[d].len() - 3).find(near).unwrap()
            });
            let values = function(&constraints, control, mesh.nodes.len());
            for c in 0..mesh.cells.len() {
                let nodes = mesh.cells.nodes(c);
                let x: Vec<[f64; 2]> = nodes.iter().map(|&n| mesh.nodes[n as usize]).collect();
                let xi = [0.999 * random.next(), 0.999 * random.next(), 0.0];
                let (mut n, mut gradient) = ([0.0; MAX_NODES], [[0.0; 2]; MAX_NODES]);
                map(CellKind::Q9, &x, &xi, &mut n, &mut gradient);
                let place = [0, 1].map(|d| x.iter().zip(&n).map(|(x, n)| x[d] * n).sum::<f64>());
                let found: f64 = nodes.iter().zip(&n).map(|(&m, n)| values[m as usize] * n).sum();
                let exact: f64 = (0..2).map(|d| cox_de_boor(&open[d], number[d], 2, place[d])).product();
                worst = worst.max((found - exact).abs());
            }
        }
        println!("{nx} × {ny}, ratio {ratio}: {worst:.1e} off Cox–de Boor");
        assert!(worst < 1e-13, "{worst:e}");
    }
}

/// What the field of the controls that a nodal field has is off it, at the nodes.
fn lost(mesh: &Mesh<2>, constraints: &LinearConstraints, field: impl Fn([f64; 2]) -> f64) -> f64 {
    let control =
        |m: u32| constraints.of_control(m).iter().map(|&(n, by)| by * field(mesh.nodes[n as usize])).sum::<f64>();
    let value = |n: u32| constraints.of_node(n).iter().map(|&(m, by)| by * control(m)).sum::<f64>();
    (0..mesh.nodes.len() as u32).map(|n| (value(n) - field(mesh.nodes[n as usize])).abs()).fold(0.0, f64::max)
}

/// The functions sum to one, and constants, linear and biquadratic fields are among them; of a linear field the controls are its values at
/// their nodes.
#[test]
fn quadratic_fields_are_exact() {
    for ratio in [1.0, 1.25] {
        let mesh = graded(3.0, 2.0, 5, 4, ratio);
        let constraints = BSpline.constraints(&mesh).unwrap().unwrap();
        for n in 0..mesh.nodes.len() as u32 {
            let sum: f64 = constraints.of_node(n).iter().map(|(_, by)| by).sum();
            assert!((sum - 1.0).abs() < 1e-14, "{sum}");
            assert!(constraints.of_node(n).iter().all(|(_, by)| *by > 0.0));
            let linear = |x: [f64; 2]| 1.0 + 2.0 * x[0] - 3.0 * x[1];
            let row = constraints.of_control(n);
            let control: f64 = row.iter().map(|&(m, by)| by * linear(mesh.nodes[m as usize])).sum();
            assert!(row.is_empty() || (control - linear(mesh.nodes[n as usize])).abs() < 1e-13);
        }
        for field in [
            |_: [f64; 2]| 1.0,
            |[x, y]: [f64; 2]| 2.0 * x - 3.0 * y,
            |[x, y]: [f64; 2]| x * x - 0.7 * x * y + 1.3 * y * y,
            |[x, y]: [f64; 2]| x * x * y * y - x * y * y,
        ] {
            let lost = lost(&mesh, &constraints, field);
            assert!(lost < 1e-13, "{lost:e}");
        }
    }
}

/// Gradients have no jump across cells whatever the controls, second derivatives normal to the edge have: what the ghost penalty sees.
#[test]
fn gradients_are_continuous_across_cells() {
    let mesh = graded(3.0, 2.0, 5, 4, 1.2);
    let constraints = BSpline.constraints(&mesh).unwrap().unwrap();
    let mut random = Random(7);
    let control: Vec<f64> = mesh.nodes.iter().map(|_| random.next()).collect();
    let value = |n: u32| constraints.of_node(n).iter().map(|&(m, by)| by * control[m as usize]).sum::<f64>();
    let (mut kink, mut bend) = (0f64, 0f64);
    for face in &mpm::mesh::faces::Faces::of(&mesh).inner {
        let [a, b] = face.cells.map(|c| mesh.cells.nodes(c as usize));
        let shared: Vec<u32> = a.iter().filter(|n| b.contains(n)).copied().collect();
        let normal = usize::from((mesh.nodes[shared[0] as usize][0] - mesh.nodes[shared[1] as usize][0]).abs() > 1e-9);
        for &node in &shared {
            let sides = [a, b].map(|nodes| {
                let x: Vec<[f64; 2]> = nodes.iter().map(|&n| mesh.nodes[n as usize]).collect();
                let own = nodes.iter().position(|&n| n == node).unwrap();
                let xi = CellKind::Q9.node_coordinates()[own];
                let (mut g, mut s) = ([[0.0; 2]; MAX_NODES], [[[0.0; 2]; 2]; MAX_NODES]);
                map_second(CellKind::Q9, &x, &xi, &mut g, &mut s);
                nodes.iter().zip(g.iter().zip(&s)).fold([0.0; 3], |[x, y, nn], (&n, (g, s))| {
                    let u = value(n);
                    [x + u * g[0], y + u * g[1], nn + u * s[normal][normal]]
                })
            });
            let jump = |i: usize| (sides[0][i] - sides[1][i]).abs();
            kink = kink.max(jump(0)).max(jump(1));
            bend = bend.max(jump(2));
        }
    }
    println!("jump of the gradient {kink:.1e}, of the second derivative {bend:.1e}");
    assert!(kink < 1e-11 && bend > 1.0, "{kink:e} {bend:e}");
}

/// Boundary displacements of a uniform strain give it everywhere, on graded grids too.
#[test]
fn the_linear_patch_is_exact() {
    fn error<K: Kinematics<2>>(gradient: [[f64; 2]; 2], ratio: f64, restored: bool) -> f64 {
        let mut mesh = graded(2.0, 1.5, 4, 3, ratio);
        if !K::HOOP {
            mesh.nodes.iter_mut().for_each(|x| x[0] += 3.0);
        }
        let mut bench = Bench::new(mesh, elastic(1000.0, 0.3));
        bench.scheme = &BSpline;
        bench.restore = if restored { Restore::EveryStep } else { Restore::Never };
        bench.steps = if restored { 1 } else { 2 };
        stretch_boundary(&mut bench, gradient);
        let points = quadrature_points::<K>(&bench.mesh, 4, 1.0);
        let scene = bench.scene::<K>();
        let state = run::<K>(&scene, points, |_, report| assert!(report.iterations() <= 8));
        let hoop = if K::HOOP { gradient[0][0] } else { 0.0 };
        let off = |f: &mpm::tensor::Tensor| {
            let in_plane = (0..2).flat_map(|i| (0..2).map(move |j| (i, j)));
            let each = in_plane.map(|(i, j)| (f[(i, j)] - f64::from(u8::from(i == j)) - gradient[i][j]).abs());
            each.fold((f[(2, 2)] - 1.0 - hoop).abs(), f64::max)
        };
        state.points.deformation.iter().map(off).fold(0.0, f64::max)
    }
    for ratio in [1.0, 1.3] {
        for restored in [false, true] {
            for gradient in [[[1e-3, 2e-3], [-1e-3, 3e-3]], [[-0.2, 0.1], [0.05, -0.15]]] {
                let e = error::<PlaneStrain>(gradient, ratio, restored);
                assert!(e < 1e-10, "ratio {ratio}, restored {restored}: {e:e}");
            }
            let e = error::<Axisymmetric>([[-0.1, 0.0], [0.0, -0.15]], ratio, restored);
            assert!(e < 1e-10, "ratio {ratio}, restored {restored}, axisymmetry: {e:e}");
        }
    }
}

/// A grid of which points fill a corner, with all terms that a restored dynamic scene has.
fn partly_filled<K: Kinematics<2> + 'static>() -> (Scene<2>, State<2>, Grid<2>) {
    let mesh = graded(4.0, 4.0, 7, 7, 1.1);
    let mut bench = Bench::new(mesh, elastic(1000.0, 0.3));
    bench.scheme = &BSpline;
    bench.gravity = [0.0, -10.0];
    bench.dynamic = true;
    bench.restore = Restore::EveryStep;
    resample::<K>(&mut bench);
    let faces = mpm::mesh::faces::Faces::of(&bench.mesh).inner.len();
    bench.extra.push(Box::new(GhostInertia::<K>::new(1.0, faces)));
    let mut places = lattice(1.3, 1.1, 0.13, &mut Random(5));
    places.iter_mut().for_each(|(x, _)| *x = [x[0] + 0.07, x[1] + 0.05]);
    let points = at::<K>(&bench.mesh, &places, 1.0);
    let scene = bench.scene::<K>();
    let simulation = Simulation::<2, K>::new(&scene, State::new(points, scene.mesh.nodes.len(), 1.0)).unwrap();
    let state = simulation.state;
    let grid = Grid::new::<K>(&scene, &state).unwrap();
    (scene, state, grid)
}

/// Residual and tangent of all terms of a scene in the unknowns of the system.
fn assembled(
    (scene, state, grid): (&Scene<2>, &State<2>, &Grid<2>),
    control: &[f64],
    matrix: Option<&mut mpm::system::Matrix>,
) -> Vec<f64> {
    let mut displacement = vec![[0.0; 2]; scene.mesh.nodes.len()];
    for d in 0..2 {
        let values: Vec<f64> = control.iter().skip(d).step_by(2).copied().collect();
        grid.dofs.write(&values, d, &mut displacement);
    }
    const SLOPE: f64 = 170.0;
    let acceleration: Vec<[f64; 2]> = displacement.iter().map(|u| u.map(|u| SLOPE * u)).collect();
    let trial = Trial {
        acceleration: &acceleration,
        acceleration_slope: SLOPE,
        ..Trial::at_rest(&displacement, &state.displacement)
    };
    let mut force = vec![0.0; grid.motion.pattern.len()];
    let mut workspace = mpm::system::Workspace::default();
    let frame = grid.frame(&scene.mesh, state);
    let mut tangent = matrix;
    for term in &scene.terms {
        let mut out = Assembly { force: &mut force, tangent: tangent.as_deref_mut(), workspace: &mut workspace };
        Term::assemble(term.as_ref(), &frame, &trial, &mut out).unwrap();
    }
    force
}

/// The tangent over the controls is the derivative of the residual over them, and the residual does the work of the nodal forces.
#[test]
fn the_reduced_tangent_is_that_of_the_reduced_residual() {
    fn check<K: Kinematics<2> + 'static>() {
        let (scene, state, grid) = partly_filled::<K>();
        let nodes: std::collections::BTreeSet<u32> =
            grid.cells.iter().flat_map(|&c| scene.mesh.cells.nodes(c as usize)).copied().collect();
        assert!(grid.dofs.node.len() < nodes.len() / 2, "{} controls of {} nodes", grid.dofs.node.len(), nodes.len());
        assert!(grid.cells.len() < scene.mesh.cells.len() && !grid.ghost.is_empty());
        let count = grid.motion.pattern.len();
        let mut random = Random(9);
        let control: Vec<f64> = (0..count).map(|_| 0.01 * random.next()).collect();
        let way: Vec<f64> = (0..count).map(|_| random.next()).collect();
        let mut matrix = mpm::system::Matrix::new(&grid.motion.pattern);
        let of = (&scene, &state, &grid);
        let force = assembled(of, &control, Some(&mut matrix));
        let mut slope = vec![0.0; count];
        matrix.multiply(&grid.motion.pattern, &way, &mut slope);
        let step = 1e-6;
        let moved = |by: f64| -> Vec<f64> { control.iter().zip(&way).map(|(c, w)| c + by * w).collect() };
        let [after, before] = [step, -step].map(|by| assembled(of, &moved(by), None));
        let size = slope.iter().map(|s| s * s).sum::<f64>().sqrt();
        let differ = (0..count).map(|i| ((after[i] - before[i]) / (2.0 * step) - slope[i]).powi(2)).sum::<f64>().sqrt();
        println!("tangent off by {:.1e}, {} equations", differ / size, force.len());
        assert!(differ < 1e-7 * size, "{differ:e} of {size:e}");
    }
    check::<PlaneStrain>();
    check::<Axisymmetric>();
}

/// Mean error of the vertical stress, over `ρ g H`, in a column 50 m high of which the weight is four times the modulus, on a grid that is
/// restored in each of 40 steps.
fn column(cells: usize, each: u32, resampled: bool, restore: Restore) -> f64 {
    const HEIGHT: f64 = 50.0;
    const YOUNG: f64 = 10.0;
    const GRAVITY: f64 = 10.0;
    let h = HEIGHT / cells as f64;
    let density = 4.0 * YOUNG / (GRAVITY * HEIGHT);
    let mut bench = Bench::new(rectangle(CellKind::Q9, h, HEIGHT, 1, cells, 0.0, 0), elastic(YOUNG, 0.0));
    bench.scheme = &BSpline;
    bench.density = density;
    bench.gravity = [0.0, -GRAVITY];
    bench.gravity_factor = TimeValue::Rate(1.0);
    bench.restore = restore;
    bench.steps = 40;
    if resampled {
        resample::<PlaneStrain>(&mut bench);
    }
    bench.hold("left", &[0]).hold("right", &[0]).hold("bottom", &[1]);
    let points = at::<PlaneStrain>(&bench.mesh, &seeded(&bench.mesh, each), density);
    let scene = bench.scene::<PlaneStrain>();
    let mut iterations = 0;
    let p = run::<PlaneStrain>(&scene, points, |_, report| iterations += report.iterations()).points;
    let exact = Column { height: HEIGHT, unit_weight: density * GRAVITY, modulus: YOUNG };
    let volume: f64 = p.initial_volume.iter().sum();
    let one = |i: usize| p.initial_volume[i] * (p.stress[i][1] - exact.stress(HEIGHT - p.origin[i][1])).abs();
    let error = (0..p.len()).map(one).sum::<f64>() / (volume * density * GRAVITY * HEIGHT);
    println!(
        "{cells} cells, {each} points a cell, resampled {resampled}, {restore:?}: {error:.2e}, {iterations} iterations"
    );
    error
}

#[test]
fn the_column_converges_at_second_order_with_resampled_quadrature() {
    let errors = [8, 16, 32, 64].map(|cells| column(cells, 16, true, Restore::EveryStep));
    let order = (errors[0] / errors[3]).log2() / 3.0;
    println!("order {order:.2}");
    assert!(errors[2] <= 4e-5 && order >= 2.0, "{errors:?}");
}

/// The points by their volumes leave the error of their weights: a few thousandths, where plain gradients leave a tenth.
#[test]
fn the_column_errs_by_thousandths_with_volumes() {
    for cells in [8, 16, 32, 64] {
        let error = column(cells, 16, false, Restore::EveryStep);
        assert!((1e-3..3e-3).contains(&error), "{cells} cells: {error:e}");
    }
}

/// A block thrown through a grid restored in every step flies its parabola, keeps its momentum and stays free of stress.
#[test]
fn a_thrown_block_flies_its_parabola() {
    let mut bench = Bench::new(rectangle(CellKind::Q9, 8.0, 8.0, 8, 8, 0.0, 3), elastic(1e4, 0.3));
    bench.scheme = &BSpline;
    bench.gravity = [0.0, -10.0];
    bench.dynamic = true;
    bench.restore = Restore::EveryStep;
    bench.steps = 100;
    bench.duration = 0.9;
    resample::<PlaneStrain>(&mut bench);
    let mut places = lattice(1.6, 1.9, 0.15, &mut Random(8));
    places.iter_mut().for_each(|(x, _)| *x = [x[0] + 1.0, x[1] + 1.7]);
    let mut points = at::<PlaneStrain>(&bench.mesh, &places, 1.0);
    points.velocity = vec![[4.0, 7.0]; points.len()];
    let mass: f64 = points.mass.iter().sum();
    let scene = bench.scene::<PlaneStrain>();
    let mut worst = [0f64; 3];
    run::<PlaneStrain>(&scene, points, |state, report| {
        let (t, p) = (state.time, &state.points);
        let off = |i: usize| {
            let [x, y] = [0, 1].map(|d| p.position[i][d] - p.origin[i][d]);
            (x - 4.0 * t).hypot(y - 7.0 * t + 5.0 * t * t)
        };
        worst[0] = (0..p.len()).map(off).fold(worst[0], f64::max);
        let [x, y] = report.motion.linear.map(|v| v / mass);
        worst[1] = worst[1].max((x - 4.0).hypot(y - 7.0 + 10.0 * t));
        worst[2] = p.stress.iter().flatten().fold(worst[2], |a, s| a.max(s.abs()));
    });
    println!("thrown: {:.1e} m off, velocity {:.1e} m/s, stress {:.1e} kPa", worst[0], worst[1], worst[2]);
    assert!(worst[0] < 1e-9 && worst[1] < 1e-10 && worst[2] < 1e-7, "{worst:?}");
}

/// A block that falls on a floor: a run that goes on from the state of a step ends in the same state to the last bit.
#[test]
fn a_restart_changes_no_bit() {
    for restore in [Restore::EveryStep, Restore::Quality { least: 0.5, stretch: 1.3 }] {
        let mut bench = Bench::new(rectangle(CellKind::Q9, 3.0, 3.0, 6, 6, 0.0, 3), elastic(100.0, 0.3));
        bench.scheme = &BSpline;
        bench.gravity = [0.0, -10.0];
        bench.dynamic = true;
        bench.restore = restore;
        bench.steps = 10;
        bench.duration = 0.2;
        resample::<PlaneStrain>(&mut bench);
        bench.hold("bottom", &[0, 1]);
        let mut places = lattice(1.2, 1.3, 0.12, &mut Random(8));
        places.iter_mut().for_each(|(x, _)| x[0] += 0.8);
        let mut points = at::<PlaneStrain>(&bench.mesh, &places, 1.0);
        points.velocity = vec![[0.5, -1.0]; points.len()];
        let scene = bench.scene::<PlaneStrain>();
        let phase = &scene.phases[0];
        let limits = || Limits { least: phase.least_step, largest: phase.largest_step };
        let advance = |state: State<2>, to: u64| {
            let mut controller = Controller::new(limits(), phase.stops.clone(), phase.first_step);
            let mut simulation = Simulation::<2, PlaneStrain>::new(&scene, state).unwrap();
            while simulation.state.step < to {
                simulation.advance(&mut controller).unwrap();
            }
            simulation.state
        };
        let first = State::new(points, scene.mesh.nodes.len(), phase.first_step);
        let whole = advance(first.clone(), 10);
        let halves = advance(advance(first, 5), 10);
        assert!(whole.points.stress.iter().flatten().any(|s| s.abs() > 1.0));
        assert!(whole == halves, "{restore:?}");
    }
}

/// A plate as wide as the soil presses it down by a tenth: the load is `M ln λ/λ` on its width, and the bottom gives the reaction to it.
#[test]
fn a_plate_presses_soil_down() {
    let modulus = 1000.0 * 0.7 / (1.3 * 0.4);
    let exact = 2.0 * modulus * 0.9f64.ln() / 0.9;
    for (ratio, restore) in [("1", "every_step"), ("1.3", "every_step"), ("1.3", "{min_quality: 0.5}"), ("1", "never")] {
        let parameters = format!("mesh.parameters.ratio={ratio}");
        let folder = program_run("tests/data/lattice", &[&parameters, &format!("numerics.restore={restore}")]);
        let rows = rows(folder.path());
        let [pressed, reaction] = [4, 6].map(|column| rows.last().unwrap()[column]);
        println!("ratio {ratio}, {restore}: contact {pressed:.3}, reaction {reaction:.3}, exact {:.3} kN", -exact);
        assert!((pressed / -exact - 1.0).abs() < 2e-3, "{pressed} {exact}");
        assert!((reaction / pressed - 1.0).abs() < 1e-4, "{reaction} {pressed}");
    }
}

/// What splines cannot have is refused, with what to do about it.
#[test]
fn what_cannot_work_is_refused() {
    let undrained = "materials.soil={model: linear_elastic, young: 1000, poisson: 0.3, density: 0, drainage: undrained}";
    let porous = "materials.soil={model: linear_elastic, young: 1000, poisson: 0.3, density: 0, drainage: undrained, \
                  permeability: 1.0e-6, porosity: 0.4, water_bulk_modulus: 2.0e6}";
    for (overrides, words) in [
        (&["mesh.parameters.quads=0"][..], &["rectangular grid of Q9 cells", "T6", "Recombine Surface"][..]),
        (&[undrained], &["pressure field", "gradient: mpm"]),
        (&["materials.soil.poisson=0.48"], &["pressure field", "pressure: none"]),
        (&["numerics.pressure=field"], &["pressure field"]),
        (&[porous], &["pore pressure", "gradient: mpm"]),
        (&["supports.surface={uy: 0}"], &["within the grid", "on the boundary of the grid"]),
        (&["regions.soil.kind=fem", "contacts=[]"], &["share nodes with the grid", "gradient: mpm"]),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let output = mpm("run", "tests/data/lattice", folder.path(), overrides);
        let said = errors(&output);
        assert_eq!(output.status.code(), Some(2), "{overrides:?}: {said}");
        assert!(words.iter().all(|word| said.contains(word)), "{overrides:?}: {said}");
    }
}
