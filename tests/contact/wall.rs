//! Walls: curves that soil and structures slide along, and that move.

use crate::contact::{history, refused};

const WALL: &str = "tests/data/wall";
const BODY: &str = "tests/data/slide";
const GRAVITY: f64 = 9.81;

/// A block of soil slides down a wall with `g (sin θ − tan δ cos θ)`, across a dozen cells …
#[test]
fn a_block_of_soil_slides_down_a_wall() {
    let rows = history(WALL, &[]);
    let (sin, cos) = 20f64.to_radians().sin_cos();
    let row = rows.last().unwrap();
    let way = 0.5 * GRAVITY * (sin - 0.2 * cos) * row[0].powi(2);
    let (along, across) = (row[1] * cos - row[2] * sin, row[1] * sin + row[2] * cos);
    println!("way {along:.6} of {way:.6} m, lifted by {across:.1e} m");
    assert!((along / way - 1.0).abs() < 2e-3 && across.abs() < 0.01 * 0.25, "{along} {way} {across}");
    // What the wall bears, held where it is, on the whole way: a tonne. It has friction all the way.
    let mean = |i: usize| rows.iter().map(|row| row[i]).sum::<f64>() / rows.len() as f64;
    let (x, y) = (mean(7), mean(8));
    let (normal, shear) = (-x * sin - y * cos, x * cos - y * sin);
    println!("normal force {normal:.4} of {:.4}, shear over it {:.5}", GRAVITY * cos, shear / normal);
    assert!((normal / (GRAVITY * cos) - 1.0).abs() < 0.01 && (shear / normal - 0.2).abs() < 1e-3, "{normal} {shear}");
    let balances = |row: &Vec<f64>| (7..9).all(|i| (row[i] + row[i + 2]).abs() < 1e-12 * GRAVITY);
    assert!(rows.iter().all(|row| row[5..7] == [0.0; 2] && balances(row)));
}

/// … and rests on it where friction holds it, once it has settled.
#[test]
fn a_block_of_soil_rests_on_a_wall() {
    let rows = history(WALL, &["contacts[0].friction=0.37", "numerics.spectral_radius=0.5"]);
    let at = |time: f64| rows.iter().find(|row| row[0] > time - 1e-9).unwrap()[1];
    assert!((at(1.0) - at(0.8)).abs() < 1e-6, "{} {}", at(0.8), at(1.0));
}

/// A wall that moves on takes soil along with `tan δ g` until both go at the same speed.
#[test]
fn a_wall_that_moves_takes_soil_along() {
    let belt = ["mesh.parameters.angle=0", "phases[0].prescribe={slope: {ux: {rate: 1}}}", "phases[0].duration=0.8"];
    for row in &history(WALL, &belt) {
        let (t, a) = (row[0], 0.2 * GRAVITY);
        let way = if t < 1.0 / a { 0.5 * a * t * t } else { t - 0.5 / a };
        assert!((row[1] - way).abs() < 5e-4 && (row[5] - t).abs() < 1e-12, "{row:?} {way}");
    }
}

/// A wall that is drawn from under soil, over the side of the grid, goes on holding what is left on it.
#[test]
fn a_wall_that_leaves_the_grid_holds_soil_on_it() {
    let belt = [
        "mesh.parameters.angle=0",
        "phases[0].prescribe={slope: {ux: {rate: -1}}}",
        "phases[0].duration=0.5",
        "gravity.x=2.4525",
    ];
    let rows = history(WALL, &belt);
    let row = rows.last().unwrap();
    let way = 0.5 * (2.4525 - 0.2 * GRAVITY) * row[0].powi(2);
    println!("way {:.6} of {way:.6} m", row[1]);
    assert!((row[1] / way - 1.0).abs() < 0.01 && (row[5] + 0.5).abs() < 1e-12, "{row:?} {way}");
}

/// A structure slides down a wall as soil does, and rests on it as that does; elastic, rigid, or rigid and free to turn.
#[test]
fn a_structure_slides_down_a_wall() {
    let (sin, cos) = 20f64.to_radians().sin_cos();
    let rigid = ["regions.body.rigid=true", "supports={body: {rotation: 0}}"];
    for overrides in [&[][..], &rigid, &rigid[..1]] {
        let rows = history(BODY, overrides);
        let row = rows.last().unwrap();
        let way = 0.5 * GRAVITY * (sin - 0.2 * cos) * row[0].powi(2);
        let (along, across) = (row[1] * cos - row[2] * sin, row[1] * sin + row[2] * cos);
        println!("way {along:.6} of {way:.6} m, lifted by {across:.1e} m");
        assert!((along / way - 1.0).abs() < 1e-3 && across.abs() < 1e-3, "{overrides:?}: {along} {way} {across}");
        // What the wall bears, held where it is.
        assert!(rows.iter().all(|row| row[5..7] == [0.0; 2] && (7..9).all(|i| row[i] == -row[i - 4])), "{overrides:?}");
        let (normal, shear) = (-row[7] * sin - row[8] * cos, row[7] * cos - row[8] * sin);
        assert!(
            (normal / (GRAVITY * cos) - 1.0).abs() < 1e-3 && (shear / normal - 0.2).abs() < 1e-6,
            "{normal} {shear}"
        );
        let mut settled = vec!["contacts[0].friction=0.37", "numerics.spectral_radius=0.5"];
        settled.extend(overrides);
        let rows = history(BODY, &settled);
        let at = |time: f64| rows.iter().find(|row| row[0] > time - 1e-9).unwrap()[1];
        assert!((at(1.0) - at(0.8)).abs() < 1e-6, "{overrides:?}: {} {}", at(0.8), at(1.0));
    }
}

/// A wall that moves takes it along until both go at the same speed.
#[test]
fn a_wall_that_moves_takes_a_structure_along() {
    let belt = ["mesh.parameters.angle=0", "phases[0].prescribe={slope: {ux: {rate: 1}}}", "phases[0].duration=0.8"];
    for row in &history(BODY, &belt) {
        let (t, a) = (row[0], 0.2 * GRAVITY);
        let way = if t < 1.0 / a { 0.5 * a * t * t } else { t - 0.5 / a };
        assert!((row[1] - way).abs() < 5e-4 && (row[5] - t).abs() < 1e-12, "{row:?} {way}");
    }
}

#[test]
fn walls_that_cannot_be_are_told() {
    let refused = |overrides: &[&str], words: &[&str]| refused(WALL, overrides, words);
    refused(&["contacts=[{wall: slop, soil: soil}]"], &["no physical curve `slop`", "did you mean `slope`?"]);
    refused(&["contacts=[{soil: soil}]"], &["contacts[0]", "no structure", "wall: …"]);
    refused(&["contacts=[{wall: slope, structure: soil, soil: soil}]"], &["both a structure and a wall"]);
    refused(&["contacts=[{wall: slope, against: soil}]"], &["of kind mpm, not structure or fem"]);
    // Without soil there is nothing that a contact could mean by all of it.
    super::refused(BODY, &["contacts=[{wall: slope}]"], &["contacts[0]", "nothing that is touched"]);
    let both = "regions={soil: {kind: mpm, material: rock}, air: {kind: mpm, material: rock}}";
    refused(
        &[both, "output.history=[]", "contacts=[{wall: side, soil: [soil, air]}]"],
        &["the wall `side`", "both of its sides"],
    );
}

/// A column that settles by a tenth between smooth walls on a grid that is never reset: each wall bears `ν/(1 − ν)` of the load over the height
/// that is left, also beside the soil that was at the top as it begins.
#[test]
fn walls_hold_soil_that_settles_on_a_grid_that_is_never_reset() {
    let press = "phases=[{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.05}, \
        prescribe: {plate: {ux: 0, uy: 0, rotation: 0}}, tractions: [{on: top, ty: {rate: -8000}}]}]";
    let rows = history(
        "tests/data/pressed_column",
        &[
            "supports={bottom: {uy: 0}}",
            "contacts=[{wall: left, soil: soil}, {wall: right, soil: soil}]",
            "numerics.restore=never",
            press,
            "output.history=[{name: soil, on: soil, quantities: [uy]}, {name: left, on: left, quantities: [contact_x]}]",
        ],
    );
    let modulus = 45000.0 * 0.64 / (1.36 * 0.28);
    // Hencky's elasticity: the Cauchy stress is M ln λ/λ.
    let mut stretch: f64 = 0.9;
    (0..50).for_each(|_| stretch = (-8000.0 * stretch / modulus).exp());
    let force = -0.36 / 0.64 * 8000.0 * 1.2 * stretch;
    let [_, settled, left] = rows.last().unwrap()[..] else { panic!("columns of the history") };
    println!("left wall {left:.1} of {force:.1} kN, mean settlement {settled:.5} of {:.5} m", 0.6 * (stretch - 1.0));
    assert!((left / force - 1.0).abs() < 0.005, "{left} kN, not {force} kN");
    assert!((settled / (0.6 * (stretch - 1.0)) - 1.0).abs() < 0.01, "{settled} m");
}
