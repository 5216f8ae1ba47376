//! Fast flow, impact and passive pressure by the defaults, on cells that are coarser than those of the cases.

use crate::mpm::scripts::study;
use crate::support::{project, solve};
use std::f64::consts::PI;
use std::fs;
use std::path::Path;

/// The columns of these names of a file of comma-separated numbers, whose names have their units behind them; numbers that are absent are left out.
fn columns<const N: usize>(path: &Path, names: [&str; N]) -> [Vec<f64>; N] {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().unwrap().split(',').map(|name| name.split(" [").next().unwrap()).collect();
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    names.map(|name| {
        let at = head.iter().position(|other| *other == name).unwrap_or_else(|| panic!("{name} of {head:?}"));
        rows.iter().filter_map(|row| row[at].parse().ok()).collect()
    })
}

/// The deposit and the failure line of the experiment, but for its last 4 cm, which are thinner than a tenth of a cell.
#[test]
fn a_column_of_bars_has_the_deposit_of_the_experiment() {
    let settings = ["mesh.parameters.h=0.025", "phases.collapse.step.max=0.004", "phases.collapse.duration=0.4"];
    let folder = solve("cases/bui_column", &settings);
    let frames = mpm::io::frame::list(&folder.path().join("results")).unwrap();
    let end = mpm::io::frame::Frame::read(&frames[frames.len() - 1].path).unwrap();
    let place = &end.points.position;
    let [x, y] = columns(&project("cases/bui_column/experiment.csv"), ["surface_x", "surface_y"]);
    let mut squares = Vec::new();
    for (x, y) in x.iter().zip(&y).filter(|(x, _)| **x < 400.0) {
        let near = place.iter().filter(|at| (1000.0 * at[0] - x).abs() < 8.0);
        let height = near.map(|at| 1000.0 * at[1]).fold(0.0, f64::max);
        squares.push((height - y).powi(2));
    }
    let mean = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
    println!("the surface is {mean:.1} mm off, r.m.s.");
    study("cases/bui_column", folder.path(), &settings, "| run | surface");
    assert!(squares.len() == 20 && mean < 4.0, "{mean} mm");
}

/// Impulse and energy are those of the cone; its depth is that by the resistance to the slow cone of `cases/cone`, which is 0.105 m.
#[test]
fn a_falling_cone_goes_as_deep_as_its_energy() {
    let settings = [
        "mesh.parameters={radius: 0.05, way: 0.15, beneath: 0.1, width: 0.15, air: 0.06, h: 0.025, coarse: 3}",
        "initial_velocity.cone.velocity.y=-2",
        "phases.fall.duration=0.08",
        "phases.fall.step.max=0.002",
    ];
    let folder = solve("cases/free_fall_cone", &settings);
    let names = ["time", "cone.uy", "cone.vy", "cone.contact_y"];
    let [time, way, speed, force] = columns(&folder.path().join("history.csv"), names);
    let tip = 0.05 * 3f64.sqrt();
    let mass = 3.5 * PI * 0.05f64.powi(2) * (0.21 - 2.0 / 3.0 * tip);
    let (mut impulse, mut work, mut before) = (0.0, 0.0, (0.0, 0.0));
    let mut deepest = 0.0f64;
    for k in 0..time.len() {
        impulse += (force[k] - mass * 9.81) * (time[k] - before.0);
        work -= force[k] * (way[k] - before.1);
        before = (time[k], way[k]);
        deepest = deepest.max(-way[k]);
        let energy = mass * (0.5 * (4.0 - speed[k].powi(2)) - 9.81 * way[k]);
        assert!((work - energy).abs() < 1e-3 * mass * 2.0, "{} s: work {work}, energy {energy}", time[k]);
    }
    let change = mass * (speed[speed.len() - 1] + 2.0);
    study("cases/free_fall_cone", folder.path(), &settings, "| bearing alone |");
    println!("depth {deepest:.4} m, impulse over change of momentum {:.6}", impulse / change);
    assert!((impulse / change - 1.0).abs() < 1e-3, "{impulse} {change}");
    assert!((deepest / 0.105 - 1.0).abs() < 0.05, "{deepest} m");
}

/// The impulse on the pipe is the momentum that the slide loses, and the force is between that of a flow with a cavity behind the pipe and that of a closed one.
#[test]
fn a_slide_pushes_the_pipe_by_the_momentum_that_it_loses() {
    let settings =
        ["mesh.parameters={h: 0.35, length: 5, ahead: 0.1}", "phases.hit.duration=0.1", "phases.hit.step.max=0.006"];
    let folder = solve("cases/slide_on_pipe", &settings);
    let names = ["time", "pipe.contact_x", "slide.vx"];
    let [time, force, speed] = columns(&folder.path().join("history.csv"), names);
    let (mut impulse, mut steady, mut before) = (0.0, [0.0, 0.0], 0.0);
    for k in 0..time.len() {
        impulse += force[k] * (time[k] - before);
        if time[k] > 0.045 {
            steady = [steady[0] + force[k] * (time[k] - before), steady[1] + time[k] - before];
        }
        before = time[k];
    }
    let lost = 1.5 * 5.0 * 4.0 * (8.0 - speed[speed.len() - 1]);
    let mean = steady[0] / steady[1];
    study("cases/slide_on_pipe", folder.path(), &settings, "cavity: 0.5");
    println!("impulse over loss of momentum {:.6}, force {mean:.1} kN/m", impulse / lost);
    assert!((impulse / lost - 1.0).abs() < 1e-3, "{impulse} {lost}");
    assert!((48.0..78.0).contains(&mean), "{mean} kN/m");
}

/// Between the forces of Davis and of Rankine, for cells of a quarter of the height.
#[test]
fn a_wall_has_the_passive_force_of_sand_without_dilation() {
    for (cohesion, davis, rankine) in [(0.0, 377.0, 432.0), (5.0, 433.0, 501.3)] {
        let settings = ["mesh.parameters.h=1", &format!("materials.sand.cohesion={cohesion}")];
        let folder = solve("cases/passive_wall", &settings);
        let [force] = columns(&folder.path().join("history.csv"), ["wall.contact_x"]);
        let force = -force[force.len() - 1];
        println!("c = {cohesion} kPa: {force:.1} kN/m, {davis} to {rankine}");
        // The wall closes on stress at rest: the energy that its first step creates is little of what it does in the phase.
        let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
        assert!(!log.contains("from nowhere"), "{log}");
        assert!(force > davis && force < 1.03 * rankine, "{force}");
    }
}
