//! A cone that is some way deep in a chamber under a surcharge, through the program: `cases/cpt_sand` on coarse cells in a small chamber.

use crate::support::{column, solve};
use std::f64::consts::PI;
use std::fs;

/// The radius of the cone (m).
const RADIUS: f64 = 0.018;
const CHAMBER: &str = "mesh.parameters={h: 0.012, deep: 0.108, way: 0.108, beneath: 0.2, width: 0.36}";

/// The force at the tip over its area, on average over the last half radius of three (kPa), and the number of halved steps.
fn resistance(settings: &[&str]) -> (f64, usize) {
    let folder = solve("cases/cpt_sand", &[&[CHAMBER, "phases.push.duration=3"][..], settings].concat());
    let time = column(folder.path(), "time [s]");
    let force = column(folder.path(), "tip.contact_y [kN]");
    let last: Vec<f64> = time.iter().zip(&force).filter(|(time, _)| **time > 3.5).map(|(_, force)| *force).collect();
    let halvings = fs::read_to_string(folder.path().join("solve.log")).unwrap().matches("halved").count();
    (last.iter().sum::<f64>() / last.len() as f64 / (PI * RADIUS.powi(2)), halvings)
}

/// Sand that does not dilate flows around the cone in steps of 0.08 R, and none of them is halved. The resistance still rises here: it is between the
/// limit pressure of a sphere, 733 kPa, and the 2990 kPa of the steady state (`cases/cpt_sand`).
#[test]
fn a_cone_in_sand_under_a_surcharge_goes_on_without_halved_steps() {
    let (resistance, halvings) = resistance(&[]);
    println!("{resistance:.0} kPa, {halvings} halved steps");
    assert!(halvings <= 2, "{halvings}");
    assert!((733.0..2990.0).contains(&resistance), "{resistance} kPa");
}

/// `N_c` of Teh & Houlsby (1991) is 11.97; cells of 2/3 R are 13 % above it.
#[test]
fn the_same_cone_in_clay_has_its_factor() {
    let (resistance, halvings) = resistance(&[
        "materials.sand={model: tresca, young: 12500, poisson: 0.49, shear_strength: 25, density: 0}",
        "contacts[0]={structure: tip, soil: sand, adhesion_factor: 0.5}",
        "phases.surcharge.prescribe={tip: {uy: {rate: -0.0002}}, sleeve: {uy: {rate: -0.0002}}}",
    ]);
    let factor = (resistance - 100.0) / 25.0;
    println!("N_c {factor:.2}, {halvings} halved steps");
    assert!(halvings <= 2, "{halvings}");
    assert!((0.95 * 11.97..1.2 * 11.97).contains(&factor), "{factor}");
}
