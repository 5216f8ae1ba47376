//! The energy of steps with inertia: nothing adds to it, elastic or at yield, in flight and as soil lands.

use crate::support::{mpm, run, succeeds};
use std::fs;
use std::path::Path;

/// The sums (kJ) of kinetic, elastic and potential energy after each step of the block of `tests/data/drop` with overridden entries, over the first
/// of them.
fn sums(set: &[&str]) -> Vec<f64> {
    logged(run("tests/data/drop", set).path())
}

/// The same of a run by its folder.
fn logged(folder: &Path) -> Vec<f64> {
    let log = fs::read_to_string(folder.join("solve.log")).unwrap();
    let number = |line: &str, name: &str| {
        let mut words = line.split_whitespace().skip_while(|word| *word != name);
        words.nth(1).map_or(0.0, |value| value.parse::<f64>().unwrap())
    };
    let steps = log.lines().filter(|line| line.starts_with("step "));
    let sums: Vec<f64> =
        steps.map(|line| ["kinetic", "elastic", "potential"].map(|name| number(line, name)).iter().sum()).collect();
    sums.iter().map(|sum| sum / sums[0]).collect()
}

fn most(sums: &[f64]) -> f64 {
    sums.iter().copied().fold(0.0, f64::max)
}

/// A block in full cells that swings in itself by strains of some percent, in steps of several times that of Courant; the energies of the log, of the
/// material points, are those of the equations here.
fn flies(poisson: f64, radius: f64) -> Vec<f64> {
    sums(&[
        "supports={}",
        "gravity={y: 0}",
        &format!("materials.clay={{model: linear_elastic, young: 2000, poisson: {poisson}, density: 1.6}}"),
        "initial_velocity={block: {standing_wave: {component: y, along: y, amplitude: 3, wave_number: 12}}}",
        &format!("numerics={{restore: never, quadrature: points, spectral_radius: {radius}}}"),
        "phases=[{name: fly, analysis: dynamic, duration: 0.1, step: {initial: 0.0005, max: 0.0005}}]",
        "output.history=[]",
    ])
}

/// Without a pressure field the work of a step is what it stores, to rounding; with one the energy is kept to third order in the step.
#[test]
fn an_elastic_block_keeps_its_energy_in_flight() {
    for (poisson, within) in [(0.3, 1e-7), (0.49, 5e-3), (0.499, 3e-2)] {
        let sums = flies(poisson, 1.0);
        let (most, last) = (most(&sums), sums[sums.len() - 1]);
        assert!(most < 1.0 + within && (last - 1.0).abs() < within, "ν = {poisson}: {most} {last}");
    }
}

#[test]
fn damping_takes_energy_and_gives_none() {
    for poisson in [0.3, 0.49] {
        let sums = flies(poisson, 0.6);
        let (most, last) = (most(&sums), sums[sums.len() - 1]);
        assert!(most < 1.0 + 5e-3 && last < 0.99, "ν = {poisson}: {most} {last}");
    }
}

/// A block of soft clay above a wall, on coarse triangles of first order.
const SPLASH_GEO: &str = r#"h = 0.27;
Point(1) = {0, 0.79, 0, h}; Point(2) = {0.5824, 0.79, 0, h}; Point(3) = {0.5824, 1.59, 0, h}; Point(4) = {0, 1.59, 0, h};
Point(5) = {1.4924, 0.79, 0, h}; Point(6) = {1.4924, 1.59, 0, h}; Point(7) = {2.0748, 0.79, 0, h}; Point(8) = {2.0748, 1.59, 0, h};
Point(9) = {0, 0, 0, h}; Point(10) = {2.0748, 0, 0, h};
Line(1) = {1, 2}; Line(2) = {2, 3}; Line(3) = {3, 4}; Line(4) = {1, 4}; Line(5) = {2, 5}; Line(6) = {5, 6}; Line(7) = {3, 6};
Line(8) = {5, 7}; Line(9) = {7, 8}; Line(10) = {6, 8}; Line(11) = {9, 10}; Line(12) = {7, 10}; Line(13) = {1, 9};
Curve Loop(1) = {1, 2, 3, -4}; Curve Loop(2) = {5, 6, -7, -2}; Curve Loop(3) = {8, 9, -10, -6}; Curve Loop(4) = {11, -12, -8, -5, -1, 13};
Plane Surface(1) = {1}; Plane Surface(2) = {2}; Plane Surface(3) = {3}; Plane Surface(4) = {4};
Physical Surface("air") = {1, 3, 4}; Physical Surface("block") = {2}; Physical Curve("floor") = {11}; Physical Curve("sides") = {4, 9, 12, 13};
"#;
const SPLASH: &str = "geometry: plane_strain\n\
mesh: {geo: m.geo, order: 1}\n\
regions: {block: {kind: mpm, material: clay}, air: {kind: buffer}}\n\
materials: {clay: {model: tresca, young: 2800, poisson: 0.49, density: 2.1, shear_strength: 5}}\n\
supports: {sides: {ux: 0}}\n\
contacts: [{wall: floor, soil: block, friction: 0}]\n\
gravity: {y: -9.81}\n\
phases: [{name: fall, analysis: dynamic, duration: 0.562, step: {initial: 0.01}}]\n\
output: {fields: [displacement]}\n";

/// Its toes are thinner than a cell: the surface leaves them out, and they have mass all the same.
#[test]
fn clay_that_splashes_along_a_wall_gains_no_energy() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out");
    fs::write(folder.path().join("m.geo"), SPLASH_GEO).unwrap();
    fs::write(folder.path().join("case.yaml"), SPLASH).unwrap();
    succeeds(&mpm("run", folder.path(), &out, &[]));
    let sums = logged(&out);
    assert!(most(&sums) < 1.001, "{sums:?}");
    let text = fs::read_to_string(out.join("energy.csv")).unwrap();
    let rows: Vec<Vec<&str>> = text.lines().map(|line| line.split(',').collect()).collect();
    let side = |row: &[&str], side: &str| -> f64 {
        let of = rows[0].iter().zip(row).filter(|(name, _)| name.starts_with(side));
        of.map(|(_, value)| value.parse::<f64>().unwrap()).sum()
    };
    let most = rows[1..].iter().map(|row| side(row, "supplied")).fold(0.0, f64::max);
    for row in &rows[1..] {
        let (held, supplied) = (side(row, "held"), side(row, "supplied"));
        assert!(most > 12.0 && held < supplied + 1e-9 * most, "{held} {supplied}");
    }
}

mod slow {
    use super::*;

    /// On a support and on a wall, by the default damping and steps.
    #[test]
    fn a_block_that_lands_gains_no_energy() {
        let wall = ["supports={left: {ux: 0}, right: {ux: 0}}", "contacts=[{wall: floor, friction: 0.3}]"];
        let elastic = "materials.clay={model: linear_elastic, young: 2000, poisson: 0.49, density: 1.6}";
        let clay = "materials.clay={model: tresca, young: 2000, poisson: 0.49, shear_strength: 4, density: 1.6}";
        for (material, on, rest) in [(elastic, &[][..], 0.4), (elastic, &wall, 0.4), (clay, &[], 0.0)] {
            let set = ["mesh.parameters.y=0.8", "numerics={}", "phases.fall.duration=0.6", material];
            let sums = sums(&[&set[..], on].concat());
            let (most, last) = (most(&sums), sums[sums.len() - 1]);
            assert!(most < 1.0 + 1e-3 && last > rest, "{material} {on:?}: {most} {last}");
        }
    }
}
