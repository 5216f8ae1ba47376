//! The energy of steps with inertia: nothing adds to it, elastic or at yield, in flight and as soil lands.

use crate::support::{column, run};
use std::fs;

/// The sums (kJ) of kinetic, elastic and potential energy after each step of the block of `tests/data/drop` with overridden entries, over the first
/// of them.
fn sums(set: &[&str]) -> Vec<f64> {
    let folder = run("tests/data/drop", set);
    let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
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

/// Empty cells between the block and the floor resist what it moves in a step; as stiff as a part of stone they would stop it in the air.
#[test]
fn stone_falls_through_a_gap_of_two_cells_as_all_bodies_do() {
    for y in [0.25, 0.3] {
        let folder = run(
            "tests/data/drop",
            &[
                "materials.clay.young=3.0e+7",
                &format!("mesh.parameters={{h: 0.15, y: {y}}}"),
                "phases=[{name: fall, analysis: dynamic, duration: 0.15, step: {initial: 0.01, max: 0.01}}]",
            ],
        );
        let way = column(folder.path(), "block.uy [m]").pop().unwrap();
        let exact = -9.81 * 0.15 * 0.15 / 2.0;
        println!("from {y} m: {way} m, of {exact} m");
        assert!((way / exact - 1.0).abs() < 1e-4, "from {y} m: {way} m, not {exact} m");
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
