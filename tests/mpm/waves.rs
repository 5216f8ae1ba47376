//! Waves that leave a model through dashpots: against the exact response of a column.

use crate::support::{column, errors, in_folder, project, solve};
use std::f64::consts::PI;
use std::path::Path;

const COLUMN: &str = "tests/data/wave_column";

fn last(folder: &Path, name: &str) -> f64 {
    *column(folder, name).last().unwrap()
}

/// The part of the energy of the pulse that is left in the end.
fn left(folder: &Path) -> f64 {
    let text = std::fs::read_to_string(folder.join("energy.csv")).unwrap();
    let mut rows = text.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let names = rows.next().unwrap();
    let rows: Vec<Vec<f64>> = rows.map(|row| row.iter().map(|v| v.parse().unwrap()).collect()).collect();
    let of = |name: &str| names.iter().position(|n| n.starts_with(name)).unwrap();
    let held = |row: &[f64]| row[of("held.kinetic")] + row[of("held.stored")] - rows[0][of("held.stored")];
    let most = rows.iter().map(|row| held(row)).fold(0.0, f64::max);
    held(rows.last().unwrap()) / most
}

/// A pulse of shear, or of pressure on a grid that is reset, moves the column by its impulse over ρ c, and leaves.
#[test]
fn a_pulse_leaves_through_the_base() {
    let reset = [
        "numerics.restore=every_step",
        "supports={bottom: {absorbing: true}, sides: {ux: 0}}",
        "phases[0].tractions=[{surface: all, ty: {table: [[0, 0], [0.025, -10], [0.05, 0]]}}]",
    ];
    for (set, names, exact) in [
        (&[][..], ["top.ux [m]", "bottom.ux [m]"], 10.0 * 0.2 / PI / 200.0),
        (&["mesh.order=1", "mesh.parameters.h=0.25"], ["top.ux [m]", "bottom.ux [m]"], 10.0 * 0.2 / PI / 200.0),
        (&reset, ["top.uy [m]", "bottom.uy [m]"], -0.25 / (2.0 * 6e4f64).sqrt()),
    ] {
        let folder = solve(COLUMN, set);
        for name in names {
            let moved = last(folder.path(), name);
            assert!((moved / exact - 1.0).abs() < 1e-3, "{set:?}: {name} {moved} of {exact}");
        }
        assert!(left(folder.path()) < 1e-3, "{set:?}: {}", left(folder.path()));
    }
}

/// Sides beside soil and air absorb along the soil alone: a pulse of pressure in a column without supports at its sides spreads, and leaves.
#[test]
fn sides_may_go_on_beside_air() {
    let set = ["supports={bottom: {absorbing: true}, sides: {absorbing: true}}", "phases[0].duration=0.6"];
    let folder = solve(COLUMN, &set);
    assert!(left(folder.path()) < 0.05, "{}", left(folder.path()));
}

/// On a held base the same pulse comes back.
#[test]
fn a_held_base_sends_the_pulse_back() {
    let folder = solve(COLUMN, &["supports.bottom={ux: 0, uy: 0}"]);
    assert!(left(folder.path()) > 0.9, "{}", left(folder.path()));
}

/// Soil with weight stays on the base as that becomes one of dashpots, and a pulse of pressure leaves it.
#[test]
fn a_base_of_dashpots_bears_the_weight() {
    let still = "{name: still, analysis: dynamic, duration: 0.1, step: {initial: 0.005}}";
    let pulse = "{name: pulse, analysis: dynamic, duration: 0.3, step: {initial: 0.001}, tractions: [{on: top, ty: \"-10*sin(pi*t/0.05)*step(0.05 - t)\"}]}";
    let rest = "{name: rest, analysis: quasi_static, duration: 1, step: {initial: 0.5}}";
    for first in [&format!("{rest}, {still}"), still] {
        let phases = format!("phases=[{first}, {pulse}]");
        let set = [
            phases.as_str(),
            "supports={bottom: {absorbing: true}, sides: {ux: 0}}",
            "gravity={y: -9.81}",
            "initial_stress={k0: 0.333333333333}",
            "materials.soil.young=1.0e+6",
        ];
        let folder = solve(COLUMN, &set);
        let [time, top] = ["time [s]", "top.uy [m]"].map(|name| column(folder.path(), name));
        let begins = time.iter().position(|t| *t > time.last().unwrap() - 0.3).unwrap();
        let (moved, exact) = (top.last().unwrap() - top[begins - 1], -10.0 * 0.1 / PI / (2.0 * 0.6e6 * 2.0f64).sqrt());
        assert!(top[begins - 1].abs() < 1e-6 * exact.abs(), "{first}: {} {exact}", top[begins - 1]);
        assert!((moved / exact - 1.0).abs() < 1e-3, "{first}: {moved} of {exact}");
    }
}

#[test]
fn dashpots_that_cannot_act_are_refused() {
    for (set, says) in [
        (&["phases[0].analysis=quasi_static"][..], "no phase has waves"),
        (&["phases[0].analysis=auto"], "an `auto` phase cannot tell"),
        (&["supports.bottom={ux: 0, uy: 0, absorbing: true}"], "a curve that is held does not absorb"),
        (&["phases[0].prescribe={bottom: {ux: 0}}"], "prescribes the displacement of `bottom`"),
        (&["supports.top={absorbing: true}"], "it is not the boundary of soil"),
    ] {
        let set: Vec<&str> = set.iter().flat_map(|entry| ["--set", entry]).collect();
        let output = errors(&in_folder(&project(""), &[&["check", COLUMN][..], &set].concat()));
        assert!(output.contains(says), "{set:?}: {output}");
    }
}
