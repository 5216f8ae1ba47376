//! Pressure on the boundary of the material as virtual stress: water on bodies of any shape with points anywhere.

use crate::support::Random;
use crate::support::bench::{Bench, constant, quadrature_points};
use crate::support::layout::{at, lattice, resample, resample_bounded, seeded};
use mpm::case::parts::places;
use mpm::kinematics::{Axisymmetric, Kinematics, PlaneStrain};
use mpm::material::spatial::elastic_from_stress;
use mpm::material::{Elasticity, LinearElastic, Model};
use mpm::mesh::Mesh;
use mpm::mesh::builder::rectangle;
use mpm::mesh::locate::Locator;
use mpm::mesh::shape::CellKind;
use mpm::points::Points;
use mpm::step::{Controller, Grid, Restore, Scene, Simulation, State, StepSize};
use mpm::surface::Geometry;
use mpm::system::Workspace;
use mpm::term::{Assembly, FacetPressure, Hydrostatic, Term, Trial, VirtualPressure};
use mpm::time_value::TimeValue;
use std::sync::Arc;

const WATER: f64 = 9.81;
/// Cells over a length of 2 m.
const CELLS: usize = 16;

fn elastic() -> Arc<LinearElastic> {
    Arc::new(LinearElastic::new(Elasticity::new(constant(1000.0), 0.3).unwrap()))
}

/// Water over cells of which `cells` make 2 m.
fn water(level: f64, cells: usize) -> Hydrostatic {
    let constant = TimeValue::Constant;
    Hydrostatic {
        top: constant(0.0),
        gradient: constant(WATER),
        datum: constant(level),
        band: 0.25 * 2.0 / cells as f64,
    }
}

fn head(level: f64) -> Hydrostatic {
    water(level, CELLS)
}

fn slope(x: &[f64; 2]) -> bool {
    x[0] > 0.3 && x[1] < 1.6 - 0.7 * x[0] && x[1] > 0.2
}

fn disk(x: &[f64; 2]) -> bool {
    (x[0] - 1.0).hypot(x[1] - 1.0) < 0.6
}

/// Teeth a little larger than a cell, a hole, and a drop beside it.
fn jagged(x: &[f64; 2]) -> bool {
    let teeth = x[1] < 1.2 + 0.2 * (9.0 * x[0]).fract() && x[1] > 0.3 && x[0] > 0.3 && x[0] < 1.7;
    teeth && (x[0] - 0.8).hypot(x[1] - 0.8) > 0.2 || (x[0] - 1.0).hypot(x[1] - 1.75) < 0.1
}

/// Places (m) with areas (m²).
type Places = Vec<([f64; 2], f64)>;

/// Points in a shape, 16 a square cell: in rows, anywhere, and sheared.
fn layouts(inside: fn(&[f64; 2]) -> bool, cells: usize) -> Vec<(&'static str, Places)> {
    let spacing = 0.5 / cells as f64;
    let n = (2.0 / spacing) as usize;
    let row = |k: usize| ([k % n, k / n].map(|i| (i as f64 + 0.5) * spacing), spacing * spacing);
    let rows: Vec<_> = (0..n * n).map(row).collect();
    let random = lattice(2.0, 2.0, spacing, &mut Random(3));
    let sheared = rows.iter().map(|&([x, y], a)| ([(x + 1.37 * y) % 2.0, y], a)).collect();
    let shapes = [("rows", rows.clone()), ("random", random), ("sheared", sheared)];
    shapes.map(|(name, points)| (name, points.into_iter().filter(|(x, _)| inside(x)).collect())).into()
}

/// The points of the cells whose centres are in a shape.
fn full_cells(mesh: &Mesh<2>, inside: fn(&[f64; 2]) -> bool) -> Places {
    let (locator, frames) = (Locator::new(mesh), Geometry::new::<PlaneStrain>(mesh).frame);
    let of_cell = |x: &[f64; 2]| locator.locate(mesh, x, None).is_some_and(|(c, _)| inside(&frames[c as usize].centre));
    seeded(mesh, 16).into_iter().filter(|(x, _)| of_cell(x)).collect()
}

/// Gives the points the stress of water at rest with the given level.
fn float(points: &mut Points<2>, level: f64) {
    let model = elastic();
    for p in 0..points.len() {
        let pressure = WATER * (level - points.position[p][1]);
        points.stress[p] = [-pressure, -pressure, -pressure, 0.0, 0.0, 0.0];
        points.elastic[p] = elastic_from_stress(model.as_ref() as &dyn Model, points.origin[p][1], &points.stress[p]);
    }
}

/// The relative residual of a body of the density of water, in water, that has its stress.
fn unbalanced<K: Kinematics<2> + 'static>(places: &[([f64; 2], f64)], resampled: bool) -> f64 {
    let mut bench = Bench::new(rectangle(CellKind::T6, 2.0, 2.0, CELLS, CELLS, 0.2, 4), elastic());
    (bench.gravity, bench.density, bench.restore) = ([0.0, -10.0], 0.1 * WATER, Restore::EveryStep);
    if resampled {
        resample::<K>(&mut bench);
    }
    bench.extra.push(Box::new(VirtualPressure::<K>::new(vec![Some(head(3.0))])));
    let mut points = at::<K>(&bench.mesh, places, bench.density);
    float(&mut points, 3.0);
    let scene = bench.scene::<K>();
    let mut simulation = Simulation::<2, K>::new(&scene, State::new(points, scene.mesh.nodes.len(), 1.0)).unwrap();
    let mut controller =
        Controller::new(StepSize { initial: 1.0, min: 1.0, max: 1.0 }, scene.phases[0].stops.clone(), 1.0);
    simulation.advance(&mut controller).map_or_else(
        |e| {
            println!("{e}");
            f64::NAN
        },
        |r| r.residuals[0],
    )
}

#[test]
fn water_at_rest_is_in_balance_with_any_shape_and_any_points() {
    for (shape, inside) in [("slope", slope as fn(&[f64; 2]) -> bool), ("disk", disk), ("jagged", jagged)] {
        for (layout, places) in layouts(inside, CELLS) {
            for resampled in [true, false] {
                let plane = unbalanced::<PlaneStrain>(&places, resampled);
                let ring = unbalanced::<Axisymmetric>(&places, resampled);
                println!("{shape}, {layout}, resampled {resampled}: {plane:.1e}, axisymmetric {ring:.1e}");
                assert!(plane < 1e-10 && ring < 1e-10, "{shape}, {layout}, resampled {resampled}");
            }
        }
    }
}

/// The sum of the forces (kN) that a term exerts on the scene at rest, and their moment about the origin (kNm).
fn resultant(scene: &Scene<2>, grid: &Grid<2>, state: &State<2>, term: &dyn Term<2>) -> [f64; 3] {
    let frame = grid.frame(&scene.mesh, state);
    let at_rest = vec![[0.0; 2]; scene.mesh.nodes.len()];
    let mut force = vec![0.0; frame.pattern.len()];
    let mut workspace = Workspace::default();
    let mut out = Assembly { force: &mut force, tangent: None, workspace: &mut workspace };
    term.assemble(&frame, &Trial::at_rest(&at_rest, &at_rest), &mut out).unwrap();
    let mut sum = [0.0; 3];
    for (force, &n) in force.chunks_exact(2).zip(&grid.dofs.node) {
        let x = scene.mesh.nodes[n as usize];
        let parts = [force[0], force[1], x[0] * force[1] - x[1] * force[0]];
        sum.iter_mut().zip(parts).for_each(|(sum, part)| *sum -= part);
    }
    sum
}

/// The area of what of closed polylines is below a level, and its moment by x: `−∮ min(y, level) [1, x] dx`.
fn below(lines: &[Vec<[f64; 2]>], level: f64) -> [f64; 2] {
    let mut sums = [0.0; 2];
    for x in lines {
        for (i, a) in x.iter().enumerate() {
            let b = x[(i + 1) % x.len()];
            let t = ((level - a[1]) / (b[1] - a[1])).clamp(0.0, 1.0);
            let t = if t.is_nan() { 0.5 } else { t };
            for [from, to] in [[0.0, t], [t, 1.0]] {
                // Simpson's rule, exact for this.
                for (share, weight) in [(from, 1.0), (0.5 * (from + to), 4.0), (to, 1.0)] {
                    let [x, y] = [0, 1].map(|d| a[d] + share * (b[d] - a[d]));
                    let dx = (b[0] - a[0]) * (to - from) * weight / 6.0;
                    sums[0] -= level.min(y) * dx;
                    sums[1] -= level.min(y) * x * dx;
                }
            }
        }
    }
    sums
}

/// The buoyancy of bodies at many levels and its moment, as that of a force a metre away, against the weight of the water that they
/// displace, over all of it: the largest errors of both, afloat, of bodies of full cells and of bodies cut anyhow; and that of
/// the buoyancy of bodies sunk by the volume of their points.
fn archimedes(inside: fn(&[f64; 2]) -> bool, levels: [f64; 2], cells: usize) -> [f64; 5] {
    let mut worst = [0f64; 5];
    let mesh = rectangle(CellKind::T6, 2.0, 2.0, cells, cells, 0.2, 4);
    let mut all = layouts(inside, cells);
    all.push(("full cells", full_cells(&mesh, inside)));
    for (layout, places) in all {
        let mut bench = Bench::new(mesh.clone(), elastic());
        bench.restore = Restore::EveryStep;
        resample_bounded::<PlaneStrain>(&mut bench);
        let points = at::<PlaneStrain>(&bench.mesh, &places, 1.0);
        let volume: f64 = points.initial_volume.iter().sum();
        let scene = bench.scene::<PlaneStrain>();
        let first = State::new(points, scene.mesh.nodes.len(), 1.0);
        let state = Simulation::<2, PlaneStrain>::new(&scene, first).unwrap().state;
        let grid = Grid::new::<PlaneStrain>(&scene, &state).unwrap();
        let boundary = &state.weights.boundary;
        let lines: Vec<Vec<_>> =
            (0..boundary.loops()).map(|l| boundary.corners(&scene.mesh, &scene.mesh.nodes, l).collect()).collect();
        let cells_outside = &state.weights.samples.as_ref().unwrap().outside;
        let outside: Vec<usize> =
            (0..state.points.len()).filter(|&p| cells_outside.contains(&state.points.cell[p])).collect();
        let buoyancy = |level: f64| {
            let term = VirtualPressure::<PlaneStrain>::new(vec![Some(water(level, cells))]);
            resultant(&scene, &grid, &state, &term)
        };
        let mut error = [0f64; 3];
        for k in 0..=40 {
            let level = levels[0] + (levels[1] - levels[0]) * f64::from(k) / 40.0;
            let [x, y, moment] = buoyancy(level).map(|sum| sum / WATER);
            let [mut area, mut area_by_x] = below(&lines, level);
            for p in outside.iter().filter(|&&p| state.points.position[p][1] < level) {
                area += state.points.initial_volume[*p];
                area_by_x += state.points.initial_volume[*p] * state.points.position[*p][0];
            }
            error[0] = error[0].max(x.abs().max((y - area).abs()) / volume);
            error[1] = error[1].max((moment - area_by_x).abs() / volume);
        }
        error[2] = (buoyancy(3.0)[1] / (WATER * volume) - 1.0).abs();
        println!("{layout}: afloat {:.1e}, moment {:.1e}, sunk {:.1e}", error[0], error[1], error[2]);
        let afloat = 2 * usize::from(layout != "full cells");
        for (i, error) in [afloat, afloat + 1, 4].into_iter().zip(error) {
            worst[i] = worst[i].max(error);
        }
    }
    worst
}

#[test]
fn archimedes_holds_for_bodies_afloat_and_sunk() {
    let block = |x: &[f64; 2]| x[0] > 0.5 && x[0] < 1.5 && x[1] > 0.5 && x[1] < 1.25;
    // Not where a level face is within the band.
    for (name, inside, levels, cells, wanted) in [
        ("block", block as fn(&[f64; 2]) -> bool, [0.6, 1.15], 16, [5e-6, 5e-6, 5e-6, 5e-6, 1e-8]),
        ("block", block, [0.6, 1.15], 48, [1e-6, 1e-6, 1e-6, 1e-6, 1e-9]),
        ("disk", disk, [0.6, 1.7], 16, [5e-6, 5e-6, 5e-6, 5e-6, 1e-9]),
        ("disk", disk, [0.6, 1.7], 48, [1e-6, 1e-6, 1e-6, 1e-6, 1e-9]),
    ] {
        println!("{name}, {cells} cells");
        let error = archimedes(inside, levels, cells);
        assert!((0..5).all(|i| error[i] < wanted[i]), "{name}, {cells} cells: {error:?}");
    }
}

/// Where points and finite elements meet, what either takes of the pressure cancels.
#[test]
fn water_does_not_act_where_points_meet_finite_elements() {
    for kind in [CellKind::T6, CellKind::T3, CellKind::Q9] {
        let mut bench = Bench::new(rectangle(kind, 1.0, 1.0, 6, 6, 0.2, 4), elastic());
        (bench.gravity, bench.density, bench.restore) = ([0.0, -10.0], 0.1 * WATER, Restore::EveryStep);
        bench.elements_where(|x| x[1] < 0.2 + 0.5 * x[0]);
        resample::<PlaneStrain>(&mut bench);
        bench.extra.push(Box::new(VirtualPressure::<PlaneStrain>::new(vec![Some(head(3.0))])));
        bench.hold("bottom", &[0, 1]);
        let mut parts = bench.split(quadrature_points::<PlaneStrain>(&bench.mesh, 4, bench.density));
        parts.iter_mut().for_each(|points| float(points, 3.0));
        let mut scene = bench.scene::<PlaneStrain>();
        let fem = scene.fem.as_mut().unwrap();
        let term = FacetPressure::<PlaneStrain>::new(&fem.mesh, |_| true, vec![Some(head(3.0))]);
        fem.terms.push(Box::new(term));
        let [points, elements] = parts;
        let fem_parametric = places(&scene.fem.as_ref().unwrap().mesh, &elements).unwrap();
        let first = State::new(points, scene.mesh.nodes.len(), 1.0);
        let state = State { fem: elements, fem_parametric, ..first };
        let mut simulation = Simulation::<2, PlaneStrain>::new(&scene, state).unwrap();
        let mut controller =
            Controller::new(StepSize { initial: 1.0, min: 1.0, max: 1.0 }, scene.phases[0].stops.clone(), 1.0);
        let residual = simulation.advance(&mut controller).unwrap().residuals[0];
        println!("{kind:?}: {residual:.1e}");
        assert!(residual < 1e-10, "{kind:?}: {residual:.1e}");
    }
}
