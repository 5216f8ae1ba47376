//! Friction of soil with water in its pores: that of the pressure between the grains.

use crate::support::{rows, run};
use std::path::Path;

/// Holds the forces in two columns in the end against each other.
fn shear_over_pressure(name: &str, folder: &Path, columns: [usize; 2], wanted: f64) {
    let last = rows(folder).pop().unwrap();
    let [shear, pressure] = columns.map(|column| last[column]);
    let ratio = (shear / pressure).abs();
    println!("{name}: shear over pressure {ratio:.5} of {wanted:.5}");
    assert!((ratio / wanted - 1.0).abs() < 0.01, "{name}: {last:?}");
}

/// A plate on confined clay that cannot drain at once: the water bears what it is stiffer by than the grains, and of the pressure friction
/// has the grains' part alone, M′/(M′ + K_w/n). Once the water has left it has all.
#[test]
fn friction_takes_the_pressure_of_the_grains() {
    let (young, poisson, undrained) = (1000.0, 0.2, 0.45);
    let bulk = |nu: f64| 2.0 * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu));
    let shear = young / (2.0 * (1.0 + poisson));
    let confined = (bulk(poisson) + 4.0 / 3.0) * shear;
    let share = confined / (confined + (bulk(undrained) - bulk(poisson)) * shear);
    let material = |more: &str| {
        format!(
            "materials.soil={{model: linear_elastic, young: {young}, poisson: {poisson}, density: 0, drainage: undrained, \
             undrained_poisson: {undrained}{more}}}"
        )
    };
    let press = "{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.25}, prescribe: {top: {ux: 0, uy: {rate: -0.002}}}}";
    let slide = |seconds: f64| {
        let [ux, step] = [0.004 / seconds, 0.5 * seconds];
        format!("duration: {seconds}, step: {{initial: {step}}}, prescribe: {{top: {{ux: {{rate: {ux}}}, uy: 0}}}}}}")
    };
    let wait = "{name: wait, analysis: consolidation, duration: 1.0e+5, step: {initial: 1.0e+4}, prescribe: {top: {ux: 0, uy: 0}}}";
    let flowing = material(", permeability: 1.0e-6");
    let held = "supports={bottom: {uy: 0, pore_pressure: 0}, side: {ux: 0}}";
    let first = format!("phases=[{press}, {{name: slide, analysis: quasi_static, {}]", slide(1.0));
    let later = format!("phases=[{press}, {wait}, {{name: slide, analysis: consolidation, {}]", slide(1e5));
    let friction = "contacts[0].friction=0.2";
    for (name, overrides, grains) in [
        ("share of a field", &[&material("")[..], &first, friction][..], share),
        ("field of its own", &[&flowing, &first, friction], share),
        ("drained", &[&flowing, &later, held, friction], 1.0),
    ] {
        shear_over_pressure(name, run("tests/data/plate", overrides).path(), [3, 4], 0.2 * grains);
    }
}

/// Undrained finite elements between two blocks, or on a wall, have excess pressure as points do.
#[test]
fn friction_takes_the_pressure_of_the_grains_of_finite_elements() {
    let (young, poisson, undrained) = (1000.0, 0.2, 0.45);
    let bulk = |nu: f64| 2.0 * (1.0 + nu) / (3.0 * (1.0 - 2.0 * nu));
    let shear = young / (2.0 * (1.0 + poisson));
    let confined = (bulk(poisson) + 4.0 / 3.0) * shear;
    let share = confined / (confined + (bulk(undrained) - bulk(poisson)) * shear);
    let material = |more: &str| {
        format!(
            "materials={{lower: {{model: linear_elastic, young: {young}, poisson: {poisson}, density: 0, drainage: undrained, \
             undrained_poisson: {undrained}{more}}}, upper: {{model: linear_elastic, young: 1.0e+7, poisson: 0, density: 0}}}}"
        )
    };
    let phases = "phases=[{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.25}, \
        prescribe: {top: {ux: 0, uy: {rate: -0.002}}}}, {name: slide, analysis: quasi_static, duration: 1, \
        step: {initial: 0.5}, prescribe: {top: {ux: {rate: 0.004}, uy: 0}}}]";
    let pushed = "phases=[{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.25}, \
        prescribe: {top: {uy: {rate: -0.002}}, bottom: {ux: 0, uy: 0, rotation: 0}}}, {name: slide, analysis: quasi_static, duration: 1, \
        step: {initial: 0.5}, prescribe: {top: {uy: 0}, bottom: {ux: {rate: 0.004}, uy: 0, rotation: 0}}}]";
    let rough = "contacts=[{structure: upper, against: lower, friction: 0.2}]";
    let wall = "contacts=[{structure: upper, against: lower, tension: no_separation}, \
        {wall: bottom, against: lower, friction: 0.2, tension: no_separation}]";
    let (on_floor, on_wall) = ("supports={bottom: {uy: 0}, lower_sides: {ux: 0}}", "supports={sides: {ux: 0}}");
    let on = |what: &str| format!("output.history=[{{name: it, on: {what}, quantities: [contact_x, contact_y]}}]");
    for (name, overrides, grains) in [
        ("share of a field", [&material("")[..], phases, rough, on_floor, &on("upper")], share),
        ("field of its own", [&material(", permeability: 1.0e-6"), phases, rough, on_floor, &on("upper")], share),
        ("on a wall", [&material(""), pushed, wall, on_wall, &on("bottom")], share),
    ] {
        shear_over_pressure(name, run("tests/data/blocks", &overrides).path(), [1, 2], 0.2 * grains);
    }
}

/// Finite elements have water in their pores up to a level, too. The block slides off by 3 % of its length, where nothing presses.
#[test]
fn friction_takes_the_grains_share_of_finite_elements_between_two_levels() {
    let phases = "phases=[{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.25}, \
        prescribe: {top: {ux: 0, uy: {rate: -0.02}}}}, {name: slide, analysis: quasi_static, duration: 1, \
        step: {initial: 0.25}, prescribe: {top: {ux: {rate: 0.06}, uy: 0}}}]";
    for (outside, inside) in [(1.0, 1.0), (1.0, 1.5), (3.0, 1.0)] {
        let water = format!("water={{level: {outside}, phreatic_level: {inside}, unit_weight: 10}}");
        let rows = rows(
            run(
                "tests/data/blocks",
                &[
                    "materials.upper={model: linear_elastic, young: 1.0e+7, poisson: 0, density: 0}",
                    "contacts=[{structure: upper, against: lower, friction: 0.2}]",
                    "supports={bottom: {uy: 0}, lower_sides: {ux: 0}}",
                    &water,
                    phases,
                ],
            )
            .path(),
        );
        let last = rows.last().unwrap();
        let ratio = -last[1] / (0.2 * (last[2] - 1.94 * 10.0 * (inside - outside)));
        println!(
            "levels of {outside} m outside and {inside} m inside: shear over what the grains bear times tan δ {ratio:.4}"
        );
        assert!((ratio - 1.0).abs() < 0.01, "{last:?}");
    }
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    /// A heavy plate in a pool on soil with water in its pores: as the pool falls or the table in the pores does, friction has what the grains
    /// bear, the weight with the water on top of the plate less the pressure of the pores. The levels are those of the end of a step.
    #[test]
    fn friction_takes_the_grains_share_between_two_levels() {
        // 60 kPa of the plate, 0.3 m thick, in water up to 3 m.
        let (weight, friction) = (60.0, 0.2);
        let press = "{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.5}, \
        prescribe: {plate: {ux: 0, rotation: 0, uy: {rate: -4.5e-4}}}}";
        let rest = "{name: rest, analysis: quasi_static, duration: 1, step: {initial: 0.5}, prescribe: {plate: {ux: 0, rotation: 0}}}";
        let slid = |levels: &str| {
            let slide = format!(
                "{{name: slide, analysis: quasi_static, duration: 1, step: {{initial: 0.25}}, {levels}, \
             prescribe: {{plate: {{ux: {{rate: 0.004}}, rotation: 0}}}}}}"
            );
            run(
                "tests/data/plate",
                &[
                    "regions.plate.rigid=true",
                    "materials.plate.density=20",
                    "materials.soil={model: linear_elastic, young: 1.0e+5, poisson: 0.3, density: 2}",
                    "gravity={y: -10}",
                    "initial_stress={k0: 0.43}",
                    "water={level: 3, phreatic_level: 3, unit_weight: 10}",
                    &format!("contacts[0].friction={friction}"),
                    &format!("phases=[{press}, {rest}, {slide}]"),
                ],
            )
        };
        let falls = "{table: [[0, 3], [1, 1]]}";
        let (steady, at_once) = ((|_| 3.0) as fn(f64) -> f64, (|_| 1.0) as fn(f64) -> f64);
        let falling: fn(f64) -> f64 = |time| 3.0 - 2.0 * time;
        for (name, levels, outside, inside) in [
            ("both as they were", "water_level: 3".into(), steady, steady),
            ("pool drawn down at once", "water_level: 1".into(), at_once, steady),
            ("pool drawn down", format!("water_level: {falls}"), falling, steady),
            ("pores drawn down at once", "phreatic_level: 1".into(), steady, at_once),
            ("pores drawn down", format!("phreatic_level: {falls}"), steady, falling),
        ] {
            let rows = rows(slid(&levels).path());
            let sliding: Vec<&Vec<f64>> = rows.iter().filter(|row| row[0] > 2.0 + 1e-9).collect();
            let off = sliding.iter().map(|row| {
                let (outside, inside) = (outside(row[0] - 2.0), inside(row[0] - 2.0));
                let grains = weight + 10.0 * (outside - 0.3) - 10.0 * inside;
                let contact = weight - 3.0;
                [-row[3] / (2.0 * friction * grains) - 1.0, row[4] / (2.0 * contact) - 1.0]
            });
            let off: Vec<[f64; 2]> = off.collect();
            println!("{name}: shear and pressure off by {off:.4?}");
            assert!(off.len() >= 4 && off.iter().flatten().all(|off| off.abs() < 5e-4), "{name}: {off:?}");
        }
        // A table that says the same, so that the levels are compared in each step.
        let text = |levels: &str| std::fs::read_to_string(slid(levels).path().join("history.csv")).unwrap();
        assert_eq!(text("water_level: 3"), text("water_level: {table: [[0, 3], [1, 3]]}"));
    }
}
