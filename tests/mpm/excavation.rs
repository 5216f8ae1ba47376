//! Soil that phases remove, through the program: against the same ground without it from the start, and stage by stage.

use crate::support::{column, log, python, run, safety, solve, succeeds};
use std::f64::consts::PI;

const PIT: &str = "docs/examples/open_pit";
/// What is left of the ground (kN/m).
const WEIGHT: f64 = 18.0 * (8.0 * 4.0 - 3.0 * 2.0);

/// The force on the base (kN/m) and the heave of the floor of the pit (m) at the end.
fn end(set: &[&str]) -> [f64; 2] {
    let folder = solve(PIT, set);
    ["bottom.reaction_y [kN]", "floor.uy [m]"].map(|name| *column(folder.path(), name).last().unwrap())
}

/// Elastic ground: what is left bears its own weight, the stages do not matter, and the pit is as one that was there as gravity came on, but for the
/// heave by what was dug.
#[test]
fn elastic_ground_remembers_no_stages() {
    let elastic = "materials.clay={model: linear_elastic, young: 1.0e+6, poisson: 0.3, unit_weight: 18}";
    let gravity = "{name: gravity, analysis: quasi_static, duration: 1, step: {initial: 1}, gravity: {rate: 1}}";
    let phases = |dig: &str| format!("phases=[{gravity}{dig}]");
    let step = "analysis: quasi_static, duration: 1, step: {initial: 0.5}";
    let stages = phases(&format!(", {{name: a, {step}, remove: [lift1]}}, {{name: b, {step}, remove: [lift2]}}"));
    let once = phases(&format!(", {{name: a, {step}, remove: [lift1, lift2]}}"));
    let (never, none) = (phases(""), "initial_stress=null");
    let [stages, once] = [&stages, &once].map(|phases| end(&[elastic, none, phases]));
    let buffers = ["regions.lift1={kind: buffer}", "regions.lift2={kind: buffer}"];
    let never = end(&[elastic, none, &never, buffers[0], buffers[1]]);
    for found in [stages, once, never] {
        assert!((found[0] / WEIGHT - 1.0).abs() < 1e-9, "{found:?}");
    }
    assert!((stages[1] / once[1] - 1.0).abs() < 2e-3, "{stages:?} {once:?}");
    assert!((once[1] / never[1] - 1.0).abs() < 0.01, "{once:?} {never:?}");
}

/// A shaft about the axis: the ring that is left bears its own weight, in cells of either order.
#[test]
fn a_shaft_leaves_the_weight_of_the_ring() {
    let elastic = "materials.clay={model: linear_elastic, young: 1.0e+5, poisson: 0.3, unit_weight: 18}";
    let weight = 18.0 * PI * (64.0 * 4.0 - 9.0 * 2.0);
    for order in ["mesh.order=1", "mesh.order=2"] {
        let [bears, heave] = end(&["geometry=axisymmetric", elastic, order]);
        assert!((bears / weight - 1.0).abs() < 1e-9 && heave > 0.0, "{order}: {bears} of {weight}, {heave}");
    }
}

/// A cut in clay falls at γH/s_u = 3.7765 (limit analysis: 3.763 to 3.815), dug in four lifts and at once.
#[test]
fn a_cut_in_clay_falls_at_its_height() {
    let phases = "phases=[{name: dig, analysis: quasi_static, duration: 1, step: {initial: 0.25, min: 0.01}, remove: [lift1, lift2, lift3, lift4]}, \
                  {name: safety, analysis: strength_reduction, duration: 1, step: {initial: 0.1, min: 0.005}}]";
    let [stages, once] = [&[][..], &[phases]].map(|set| safety(&log(solve("tests/data/dug_cut", set).path())));
    let [held, failed] = stages.map(|factor| factor * 18.0 * 5.0 / 30.0);
    println!("{held} to {failed}");
    assert!(failed / held < 1.01 && (0.5 * (held + failed) / 3.7765 - 1.0).abs() < 0.03, "{held} to {failed}");
    assert!(stages.iter().zip(once).all(|(stages, once)| (stages / once - 1.0).abs() < 0.005), "{stages:?} {once:?}");
}

/// The exported soil is what is left of it, frame by frame.
#[test]
fn the_soil_that_is_shown_has_the_pit() {
    let folder = run(PIT, &[]);
    let script =
        "import pyvista, sys\nfor n in range(3):\n  print(pyvista.read(f'{sys.argv[1]}/vtu/soil_{n:06}.vtu').area)";
    let output = python().args(["-c", script]).arg(folder.path()).output().unwrap();
    succeeds(&output);
    let areas: Vec<f64> = String::from_utf8_lossy(&output.stdout).lines().map(|line| line.parse().unwrap()).collect();
    for (area, exact) in areas.iter().zip([32.0, 29.0, 26.0]) {
        assert!((area / exact - 1.0).abs() < 0.01, "{areas:?}");
    }
}
