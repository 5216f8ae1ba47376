//! Structures that slide, on plane and inclined soil and into it: forces against closed forms.

use crate::support::{rows, run};

/// Presses the plate down by 5 cm and slides it by `way` (m): how much its shear is off `limit` (kPa) times the length on soil
/// in the second half of the way (-).
fn slide(limit: f64, way: f64, overrides: &[&str]) -> Vec<f64> {
    let phases = format!(
        "phases=[{{name: press, analysis: quasi_static, duration: 1, step: {{initial: 0.2}}, \
        prescribe: {{top: {{ux: 0, uy: {{rate: -0.05}}}}}}}}, {{name: slide, analysis: quasi_static, duration: 1, \
        step: {{initial: 0.1}}, prescribe: {{top: {{ux: {{rate: {way}}}, uy: 0}}}}}}]"
    );
    let mut all = overrides.to_vec();
    all.push(&phases);
    let folder = run("tests/data/plate", &all);
    let rows = rows(folder.path());
    rows.iter().filter(|row| row[0] > 1.45).map(|row| -row[3] / (limit * (2.0 - row[1])) - 1.0).collect()
}

/// Where a plate slides, its shear is the limit over the length L that is on soil: `∫τ = α s_u L` on clay, `c_a L` on elastic
/// soil. It slides off one end of the soil by what it comes to lie beyond the other, less than a contact node.
#[test]
fn a_plate_that_slides_is_held_by_adhesion() {
    let clay = "materials.soil={model: tresca, young: 1000, poisson: 0.3, shear_strength: 30, density: 0}";
    let bonded = "contacts[0].tension=no_separation";
    for (limit, way, overrides) in [
        (3.0, 0.01, &[clay, "contacts[0].adhesion_factor=0.1"][..]),
        (3.0, 0.01, &[clay, "contacts[0].adhesion_factor=0.1", "contacts[0].adhesion=50"]),
        (2.0, 0.01, &["contacts[0].adhesion=2"]),
        (2.0, 0.06, &["contacts[0].adhesion=2", bonded]),
        (3.0, 0.06, &[clay, "contacts[0].adhesion_factor=0.1", bonded]),
    ] {
        let off = slide(limit, way, overrides);
        println!("{overrides:?}: shear off by {off:.4?}");
        assert!(off.len() >= 5 && off.iter().all(|off| off.abs() < 0.01), "{overrides:?}: {off:?}");
    }
}

/// On a longer way, where it may part from the soil, too.
#[test]
fn a_plate_that_slides_on_is_held_by_adhesion() {
    let off = slide(2.0, 0.06, &["contacts[0].adhesion=2"]);
    println!("shear off by {off:.4?}");
    assert!(off.len() >= 5 && off.iter().all(|off| off.abs() < 0.01), "{off:?}");
}

/// A plate that slides along soil it is pressed into keeps its normal force to one per cent while it crosses five cells, and
/// nothing holds it back: it is smooth and the soil elastic.
fn keeps_its_normal_force(depth: f64, rate: f64, left: f64, overrides: &[&str]) {
    let phases = format!(
        "phases=[{{name: press, analysis: quasi_static, duration: 1, step: {{initial: 0.2}}, \
        prescribe: {{top: {{ux: 0, uy: {{rate: -{depth}}}}}}}}}, {{name: slide, analysis: quasi_static, duration: 1, \
        step: {{initial: 0.01}}, prescribe: {{top: {{ux: {{rate: {rate}}}, uy: 0}}}}}}]"
    );
    let mesh = format!("mesh.parameters={{width: 8, plate: 1, left: {left}, edge: 0.1, depth: 1.5, h: 0.2, hp: 0.12}}");
    let folder = run("tests/data/plate", &[&[phases.as_str(), mesh.as_str()], overrides].concat());
    let rows = rows(folder.path());
    let pressed = rows.iter().rfind(|row| row[0] < 1.0 + 1e-9).unwrap()[4];
    let sliding = || rows.iter().filter(|row| row[0] > 1.0 + 1e-9);
    let off: Vec<f64> = sliding().map(|row| row[4] / pressed - 1.0).collect();
    let drag = sliding().map(|row| (row[3] / row[4]).abs()).fold(0.0, f64::max);
    let ends = [off.iter().copied().fold(0.0, f64::min), off.iter().copied().fold(0.0, f64::max)];
    println!("normal force {:+.4} to {:+.4} of that before, held back by at most {drag:.1e} of it", ends[0], ends[1]);
    // On the round edges the normal turns with soil that follows them only in part.
    assert!(off.len() >= 100 && drag < 3e-3 && ends.iter().all(|end| end.abs() < 0.01), "{ends:?} {drag}");
}

/// A block slides down with `g (sin θ − tan δ cos θ)` where that is positive …
#[test]
fn a_block_slides_down_an_incline() {
    let folder = run("cases/incline", &["phases[0].duration=0.6"]);
    let (sin, cos) = 20f64.to_radians().sin_cos();
    let way = 0.5 * 9.81 * (sin - 0.2 * cos) * 0.6f64.powi(2);
    let rows = rows(folder.path());
    let row = rows.last().unwrap();
    let (along, across) = (row[1] * cos - row[2] * sin, row[1] * sin + row[2] * cos);
    println!("way {along:.5} of {way:.5} m, lifted by {across:.5} m");
    assert!((along / way - 1.0).abs() < 0.01, "{along} {way}");
    // Cells are 0.25 m wide.
    assert!(across.abs() < 0.001 * 0.25, "{across}");
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    /// A plate that slides over clay under 45 % of its bearing capacity, two cells far, is held by half the strength along its length.
    #[test]
    fn a_loaded_plate_slides_over_clay() {
        let load = 0.45 * (2.0 + std::f64::consts::PI);
        let phases = format!(
            "phases=[{{name: press, analysis: quasi_static, duration: 1, step: {{initial: 0.25}}, \
        prescribe: {{plate: {{ux: 0, rotation: 0, uy: {{rate: -0.0055}}}}}}}}, \
        {{name: slide, analysis: quasi_static, duration: 0.4, step: {{initial: 0.002, max: 0.02}}, \
        tractions: [{{on: top, tx: 0, ty: {}}}], prescribe: {{plate: {{ux: {{rate: 1}}, rotation: 0}}}}}}]",
            -load
        );
        let folder = run(
            "tests/data/plate",
            &[
                "mesh.parameters={width: 10, plate: 2, left: 3.7, depth: 4, h: 0.2, hp: 0.2}",
                "regions.plate.rigid=true",
                "contacts[0].adhesion_factor=0.5",
                "materials.soil={model: tresca, young: 500, poisson: 0.49, shear_strength: 1, density: 0}",
                "supports.bottom={ux: 0, uy: 0}",
                &phases,
            ],
        );
        let rows = rows(folder.path());
        // It sticks in the first step.
        let sliding: Vec<&Vec<f64>> = rows.iter().filter(|row| row[0] > 1.004).collect();
        let shear: Vec<f64> = sliding.iter().map(|row| -row[3] / (0.5 * 2.0)).collect();
        let mean = shear.iter().sum::<f64>() / shear.len() as f64;
        let ripple = (shear.iter().map(|s| (s / mean - 1.0).powi(2)).sum::<f64>() / shear.len() as f64).sqrt();
        let log = std::fs::read_to_string(folder.path().join("solve.log")).unwrap();
        let after = |line: &str| line.split(' ').skip_while(|w| *w != "iterations").nth(1).and_then(|n| n.parse().ok());
        let iterations: Vec<usize> = log.lines().filter_map(after).collect();
        let most = iterations.iter().copied().max().unwrap();
        println!("shear over α s_u L {shear:.3?}, ripple {ripple:.4}, iterations {iterations:?}");
        assert!(
            shear.len() >= 20
                && iterations.len() == rows.len()
                && shear.iter().all(|s| (s - 1.0).abs() < 0.03)
                && ripple < 0.02,
            "{shear:?}"
        );
        assert!(most <= 10 && sliding.iter().all(|row| (row[4] / (2.0 * load) - 1.0).abs() < 1e-6), "{iterations:?}");
    }

    #[test]
    fn a_plate_that_slides_keeps_its_normal_force() {
        keeps_its_normal_force(0.02, 1.0, 2.5, &[]);
    }

    /// The other way on another soil.
    #[test]
    fn a_plate_that_slides_back_keeps_its_normal_force() {
        keeps_its_normal_force(0.015, -1.0, 4.5, &["materials.soil.poisson=0.1", "materials.soil.young=20000"]);
    }

    /// The head of a pile bears what the soil exerts on it, and in the first centimetres that is the limit load of a circular
    /// footing, between smooth (5.69 s_u) and rough (6.05 s_u), with what it gains with depth and errs by in coarse cells.
    #[test]
    fn a_pile_finds_its_bearing_capacity() {
        let folder = run("cases/pile", &["phases.push.duration=0.1"]);
        let rows = rows(folder.path());
        for row in &rows {
            assert!((row[2] + row[4]).abs() < 1e-6 * row[2].abs().max(1e-3), "{row:?}");
        }
        let pressure = rows.last().unwrap()[2] / (std::f64::consts::PI * 0.5f64.powi(2)) / 0.5;
        assert!((5.69..1.1 * 6.05).contains(&pressure), "{pressure}");
    }

    /// … and rests where it is not, once it has settled.
    #[test]
    fn a_block_rests_on_an_incline() {
        let overrides = ["contacts[0].friction=0.37", "numerics.spectral_radius=0.5", "phases[0].duration=0.8"];
        let folder = run("cases/incline", &overrides);
        let rows = rows(folder.path());
        let at = |time: f64| rows.iter().find(|row| row[0] > time - 1e-9).unwrap()[1];
        let free = 0.5 * 9.81 * 20f64.to_radians().sin() * 0.8f64.powi(2);
        assert!((at(0.8) - at(0.6)).abs() < 1e-6 * free, "{} {}", at(0.6), at(0.8));
    }
}
