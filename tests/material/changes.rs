//! Materials that change in a phase: what was borne stays, and what comes is borne by the new material; against closed forms.

use crate::support::{column, errors, in_folder, solve_text, written};
use std::fs;
use tempfile::TempDir;

/// A block between smooth plates, free to the side, of one material and then of another; the load grows in the first phase, waits
/// for the first step of the second, doubles, and is taken away in the third.
fn block(kind: &str, [before, after]: [&str; 2], more: &str) -> TempDir {
    let text = format!(
        "geometry: plane_strain\n\
         mesh: {{geo: GEO/slump.geo, parameters: {{half_width: 1, height: 1, room: 0, h: 0.5}}}}\n\
         regions: {{block: {{kind: {kind}, material: before}}}}\n\
         materials: {{before: {{{before}, density: 0}}, after: {{{after}, density: 0}}}}\n\
         supports: {{bottom: {{uy: 0}}, axis: {{ux: 0}}}}\n\
         numerics: {{restore: never, tolerance: 1.0e-10}}\n\
         phases:\n\
         - {{name: load, analysis: quasi_static, duration: 1, step: {{initial: 0.5}}, tractions: [{{on: top, ty: {{rate: -16}}}}]}}\n\
         - {{name: on, analysis: quasi_static, duration: 1, step: {{initial: 0.5}}, materials: {{block: after}}, \
             tractions: [{{on: top, ty: {{table: [[0, -16], [0.5, -16], [1, -32]]}}}}]}}\n\
         - {{name: back, analysis: quasi_static, duration: 1, step: {{initial: 0.5}}, \
             tractions: [{{on: top, ty: {{table: [[0, -32], [1, 0]]}}}}]}}\n\
         output: {{history: [{{name: top, on: top, quantities: [uy]}}{more}]}}\n"
    );
    solve_text(&text)
}

/// Uniform stress: the settlement of each load is that of uniaxial plane strain, `q H (1 − ν²)/E`; undrained with the `E` and ν of the soil as a
/// whole. Strains are of the order of 1e-5, which is the error of the small strains of the closed form.
#[test]
fn later_loads_settle_by_the_stiffness_of_then() {
    let elastic = |young: f64, poisson: f64| format!("model: linear_elastic, young: {young}, poisson: {poisson}");
    let drained = |young: f64, nu: f64| (elastic(young, nu), (1.0 - nu * nu) / young);
    let undrained = |young: f64, more: &str| {
        let whole = young / 1.3 * 1.495;
        (format!("{}, drainage: undrained{more}", elastic(young, 0.3)), (1.0 - 0.495 * 0.495) / whole)
    };
    let softening = |young: f64| {
        let strength = ", remoulded: 0.3, ductility: 10";
        (
            format!("model: tresca_softening, young: {young}, poisson: 0.49, shear_strength: 100{strength}"),
            (1.0 - 0.49 * 0.49) / young,
        )
    };
    for (before, after, watched) in [
        (drained(1e6, 0.3), drained(4e6, 0.3), false),
        (drained(1e6, 0.3), drained(4e6, 0.49), false),
        (drained(4e6, 0.49), drained(1e6, 0.2), false),
        (softening(1e6), drained(5e6, 0.3), false),
        (undrained(1e6, ""), undrained(4e6, ""), false),
        (undrained(1e6, ", permeability: 0"), undrained(4e6, ", permeability: 0"), true),
    ] {
        for kind in ["mpm", "fem"] {
            let more = if watched { ", {name: all, on: block, quantities: [pore_pressure]}" } else { "" };
            let folder = block(kind, [&before.0, &after.0], more);
            let uy = column(folder.path(), "top.uy [m]");
            let expected = [8.0 * before.1, 16.0 * before.1, 16.0 * before.1, 16.0 * (before.1 + after.1)];
            let expected = [&expected[..], &[16.0 * before.1, 16.0 * (before.1 - after.1)]].concat();
            println!("{kind} {} -> {}: {uy:?}", before.0, after.0);
            assert_eq!(uy.len(), expected.len());
            for (u, exact) in uy.iter().zip(&expected) {
                assert!((u / -exact - 1.0).abs() < 1e-4, "{uy:?} {expected:?}");
            }
            // Nothing moves where only the material changes.
            assert!((uy[2] / uy[1] - 1.0).abs() < 1e-9, "{uy:?}");
            if watched {
                let p = column(folder.path(), "all.pore_pressure [kPa]");
                assert!(p[1] > 1.0 && (p[2] / p[1] - 1.0).abs() < 1e-9, "{p:?}");
            }
            let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
            assert!(log.contains("phase on: region `block` is of `after` from here on\n"), "{log}");
        }
    }
}

/// A column that settles under its weight, which is doubled once it is stiffer, on a grid that is restored in every step, by both kinds of
/// weights: confined, `½ ρ g H²/M` for each. The strain, 1e-4, is the error of the closed form; that of the column restored in each step is
/// less.
#[test]
fn a_column_on_a_restored_grid_goes_on_by_its_new_stiffness() {
    for (poisson, quadrature) in [(0.3, "resampled"), (0.47, "resampled"), (0.3, "points")] {
        let confined = |young: f64| young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
        let text = format!(
            "geometry: plane_strain\n\
             mesh: {{geo: GEO/slump.geo, parameters: {{half_width: 0.5, height: 2, room: 0, h: 0.25}}}}\n\
             regions: {{block: {{kind: mpm, material: soft}}}}\n\
             materials:\n  soft: {{model: linear_elastic, young: 1.0e+5, poisson: {poisson}, density: 1}}\n\
             \x20 hard: {{model: linear_elastic, young: 5.0e+5, poisson: {poisson}, density: 1}}\n\
             supports: {{bottom: {{uy: 0}}, axis: {{ux: 0}}, face: {{ux: 0}}}}\n\
             gravity: {{y: -10}}\n\
             numerics: {{restore: every_step, quadrature: {quadrature}}}\n\
             phases:\n\
             - {{name: load, analysis: quasi_static, duration: 1, step: {{initial: 0.25}}, gravity: {{rate: 1}}}}\n\
             - {{name: on, analysis: quasi_static, duration: 1, step: {{initial: 0.25}}, materials: {{block: hard}}, \
                 gravity: {{table: [[0, 1], [0.25, 1], [1, 2]]}}}}\n\
             output: {{history: [{{name: top, on: top, quantities: [uy]}}]}}\n"
        );
        let folder = solve_text(&text);
        let uy = column(folder.path(), "top.uy [m]");
        let exact = |young: f64| -0.5 * 10.0 * 4.0 / confined(young);
        println!("{uy:?} {} {}", exact(1e5), exact(5e5));
        assert!((uy[3] / exact(1e5) - 1.0).abs() < 3e-3, "{uy:?}");
        assert!(((uy[4] - uy[3]) / uy[3]).abs() < 1e-6, "{uy:?}");
        assert!(((uy[7] - uy[4]) / exact(5e5) - 1.0).abs() < 3e-3, "{uy:?}");
    }
}

/// Whose stress a model answers for, and where the pressure of the water is, does not change with a material.
#[test]
fn another_drainage_is_refused() {
    let text = |before: &str, after: &str| {
        let material = |more: &str| format!("{{model: linear_elastic, young: 1, poisson: 0.3, density: 1{more}}}");
        format!(
            "geometry: plane_strain\n\
             mesh: {{geo: GEO/slump.geo, parameters: {{room: 0, h: 0.5}}}}\n\
             regions: {{block: {{kind: mpm, material: before}}}}\n\
             materials: {{before: {}, after: {}}}\n\
             phases:\n\
             - {{name: load, analysis: quasi_static, duration: 1, step: {{initial: 1}}}}\n\
             - {{name: on, analysis: quasi_static, duration: 1, step: {{initial: 1}}, materials: {{block: after}}}}\n",
            material(before),
            material(after)
        )
    };
    let (drained, share, own) = ("", ", drainage: undrained", ", drainage: undrained, permeability: 1.0e-6");
    for (before, after) in [(drained, share), (share, own), (own, drained)] {
        let folder = written(&text(before, after));
        let output = in_folder(folder.path(), &["check", "."]);
        let said = errors(&output);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains("case.yaml:7") && said.contains("(phases[1].materials.block)"), "{said}");
        assert!(said.contains("choose a material with the same drainage"), "{said}");
        assert_eq!(said.matches("error: ").count(), 1, "{said}");
    }
}

/// A stress that the new material does not bear falls to what it does, at the strain that there is, and the log tells of it.
#[test]
fn a_stress_beyond_the_new_strength_falls_to_it() {
    let text = "geometry: plane_strain\n\
        mesh: {geo: GEO/slump.geo, parameters: {half_width: 1, height: 1, room: 0, h: 0.5}}\n\
        regions: {block: {kind: mpm, material: strong}}\n\
        materials:\n  strong: {model: tresca, young: 1.0e+5, poisson: 0.49, shear_strength: 100, density: 1}\n\
        \x20 weak: {model: tresca, young: 1.0e+5, poisson: 0.49, shear_strength: 10, density: 3}\n\
        supports: {bottom: {uy: 0}, axis: {ux: 0}}\n\
        numerics: {restore: never}\n\
        phases:\n\
        - {name: press, analysis: quasi_static, duration: 1, step: {initial: 0.5}, prescribe: {top: {uy: {rate: -5.0e-4}}}}\n\
        - {name: weaken, analysis: quasi_static, duration: 1, step: {initial: 1}, materials: {block: weak}, prescribe: {top: {uy: 0}}}\n\
        output: {history: [{name: top, on: top, quantities: [reaction_y]}]}\n";
    let folder = solve_text(text);
    let force = column(folder.path(), "top.reaction_y [kN]");
    let elastic = -5e-4 * 1e5 / (1.0 - 0.49 * 0.49);
    assert!((force[1] / elastic - 1.0).abs() < 1e-3 && (force[2] / -20.0 - 1.0).abs() < 1e-3, "{force:?}");
    let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
    assert!(
        log.contains("is of `weak` from here on; the stress of 224 of its 224 points is more than that bears"),
        "{log}"
    );
    // Its mass is that of the new density.
    let mass: Vec<&str> = log.lines().filter_map(|l| l.split(" mass ").nth(1)?.split(' ').next()).collect();
    assert_eq!(mass[1..], ["1.000000000000e0", "1.000000000000e0", "3.000000000000e0"], "{log}");
}
