//! The balance of energy where a rigid body is prescribed to move from one moment to the next.

use crate::support::run;
use std::f64::consts::PI;
use std::fs;

/// A disc of the mass m that is pushed at 1 m/s from the first step on along smooth ground: half of m v², which is the work done, is lost in the jerk. None of it is
/// energy from nowhere.
#[test]
fn what_sets_a_body_in_motion_supplies_its_energy() {
    let settings = [
        "initial_velocity.disc={velocity: {x: 0}}",
        "contacts[0].friction=0",
        "phases=[{name: push, analysis: dynamic, duration: 0.05, step: {initial: 0.01}, \
        prescribe: {disc: {ux: {rate: 1}, uy: 0, rotation: 0}}}]",
    ];
    let folder = run("tests/data/roll", &settings);
    let text = fs::read_to_string(folder.path().join("energy.csv")).unwrap();
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().unwrap().split(',').collect();
    let last: Vec<f64> = lines.last().unwrap().split(',').map(|v| v.parse().unwrap()).collect();
    let of = |name: &str| last[head.iter().position(|column| column.starts_with(name)).unwrap()];
    let half = 0.5 * PI * 0.25;
    let found = ["supplied.supports", "held.kinetic", "numerical.impact"].map(of);
    println!("{found:?}, half of m v² {half}");
    let [supplied, kinetic, impact] = found.map(|energy| energy / half);
    assert!((supplied - 2.0).abs() < 0.01 && (kinetic - 1.0).abs() < 0.01 && (impact - 1.0).abs() < 0.01, "{found:?}");
    let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
    assert!(!log.contains("from nowhere"), "{log}");
}
