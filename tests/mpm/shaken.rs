//! A site shaken at its base by a record of acceleration, with sides that move alike: the exact response of a column.

use crate::support::{column, errors, in_folder, project, said, solve};
use std::f64::consts::PI;
use std::path::Path;

const COLUMN: &str = "tests/data/shaken_column";
/// Height (m) of the column and speed (m/s) of its waves of shear.
const HEIGHT: f64 = 10.0;
const SPEED: f64 = 100.0;

/// Ricker's wavelet of 2 Hz and 0.1 m/s² until 1.3 s.
fn wavelet() -> Vec<[f64; 2]> {
    let value = |t: f64| {
        let square = (PI * 2.0 * (t - 0.6)).powi(2);
        0.1 * (1.0 - 2.0 * square) * (-square).exp()
    };
    (0..=130).map(|i| 0.01 * f64::from(i)).map(|t| [t, value(t)]).collect()
}

/// The displacement that a record gives from rest, entry by entry.
fn displacement(record: &[[f64; 2]], t: f64) -> f64 {
    let (mut u, mut v) = (0.0, 0.0);
    for pair in record.windows(2) {
        let ([t0, a0], [t1, a1]) = (pair[0], pair[1]);
        let dt = (t - t0).clamp(0.0, t1 - t0);
        let a = a0 + (a1 - a0) * dt / (t1 - t0);
        u += v * dt + dt * dt * (a0 / 3.0 + a / 6.0);
        v += 0.5 * dt * (a0 + a);
        if t <= t1 {
            break;
        }
    }
    if t > 0.0 { u } else { 0.0 }
}

/// d'Alembert's solution at the free top: the wave that goes up comes back from the base with the other sign.
fn top(record: &[[f64; 2]], t: f64) -> f64 {
    let arrives = |k: i32| t - f64::from(2 * k + 1) * HEIGHT / SPEED;
    (0..)
        .take_while(|&k| arrives(k) > 0.0)
        .map(|k| 2.0 * f64::from(1 - 2 * (k % 2)) * displacement(record, arrives(k)))
        .sum()
}

fn shaken(record: &[[f64; 2]], step: f64, set: &[&str]) -> tempfile::TempDir {
    let prescribe = format!("phases[0].prescribe={{base: {{uy: 0, ax: {{table: {record:?}}}}}}}");
    let [step, duration] = [format!("phases[0].step.initial={step}"), "phases[0].duration=1.3".into()];
    solve(COLUMN, &[&[prescribe.as_str(), &step, &duration][..], set].concat())
}

/// The largest difference over the largest value.
fn off(found: &[f64], exact: &[f64]) -> f64 {
    let most = exact.iter().fold(0.0, |most: f64, u| most.max(u.abs()));
    found.iter().zip(exact).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) / most
}

fn history(folder: &Path, record: &[[f64; 2]]) -> (Vec<f64>, Vec<f64>) {
    let exact = column(folder, "time [s]").iter().map(|&t| top(record, t)).collect();
    (column(folder, "top.ux [m]"), exact)
}

/// Base motion: exact column response. Linear elastic soil, 10 rows of Q9 and half as many; the error falls with the square of cell and step.
#[test]
fn base_motion_gives_the_exact_column_response() {
    let record = wavelet();
    let errors = [("2", 0.01), ("1", 0.005)].map(|(h, step)| {
        let (size, width) = (format!("mesh.parameters.h={h}"), format!("mesh.parameters.width={h}"));
        let folder = shaken(&record, step, &[&size, &width]);
        // The base has the motion of the record, whatever the step.
        let base = column(folder.path(), "base.ux [m]");
        let exact: Vec<f64> = column(folder.path(), "time [s]").iter().map(|&t| displacement(&record, t)).collect();
        assert!(off(&base, &exact) < 1e-12);
        let (found, exact) = history(folder.path(), &record);
        off(&found, &exact)
    });
    assert!(errors[1] < 0.005 && (3.6..4.4).contains(&(errors[0] / errors[1])), "{errors:?}");
}

/// Finite elements and numerical damping, whose rule has another displacement for the same acceleration.
#[test]
fn base_motion_is_exact_with_numerical_damping_and_in_finite_elements() {
    let record = wavelet();
    let set = ["numerics.spectral_radius=0.8", "numerics.restore=every_step", "regions.soil.kind=fem"];
    let folder = shaken(&record, 0.005, &set);
    let (found, exact) = history(folder.path(), &record);
    assert!(off(&found, &exact) < 0.006, "{}", off(&found, &exact));
    let base = column(folder.path(), "base.vx [m/s]");
    // The wavelet gives no velocity in the end.
    assert!(base.last().unwrap().abs() < 1e-4 * base.iter().fold(0.0, |most: f64, v| most.max(v.abs())));
}

/// With tied sides a wide column responds as a narrow one, and its base has so much more force.
#[test]
fn a_wide_column_with_tied_sides_responds_as_a_narrow_one() {
    let record = wavelet();
    let [narrow, wide] = ["1", "4"].map(|width| {
        let width = format!("mesh.parameters.width={width}");
        shaken(&record, 0.01, &[&width, "gravity={y: -10}", "initial_stress={k0: 0.5}"])
    });
    let of = |folder: &tempfile::TempDir, name: &str| column(folder.path(), name);
    assert!(off(&of(&wide, "top.ux [m]"), &of(&narrow, "top.ux [m]")) < 1e-9);
    let force: Vec<f64> = of(&narrow, "base.reaction_x [kN]").iter().map(|f| 4.0 * f).collect();
    assert!(off(&of(&wide, "base.reaction_x [kN]"), &force) < 1e-9);
}

/// The energy that the base gives is that which the column holds.
#[test]
fn the_base_gives_the_energy_of_the_column() {
    let folder = shaken(&wavelet(), 0.01, &[]);
    let text = std::fs::read_to_string(folder.path().join("energy.csv")).unwrap();
    let names: Vec<&str> = text.lines().next().unwrap().split(',').collect();
    let of = |row: &str, name: &str| -> f64 {
        row.split(',').nth(names.iter().position(|n| n.starts_with(name)).unwrap()).unwrap().parse().unwrap()
    };
    for row in text.lines().skip(1) {
        let held = of(row, "held.kinetic") + of(row, "held.stored");
        assert!((of(row, "supplied.supports") - held).abs() < 1e-9, "{row}");
    }
}

#[test]
fn ties_and_records_that_cannot_be_are_refused() {
    for (set, says) in [
        (
            &["mesh.parameters.slope=0.3"][..],
            "the node of `left` at [0.000000, 0.000000] m has no node of `right` at its height",
        ),
        (&["numerics.restore=every_step"], "the grid does not move with the material"),
        (&["supports.left.tied=sides"], "sides"),
        (&["supports.left.tied=left"], "`left` is tied to itself"),
        (&["supports.right={tied: left}"], "tie one of the two sides to the other, once"),
        (&["supports.left={tied: right, uy: 0}"], "is tied to one of the opposite side"),
        (&["phases[0].prescribe.base.ux=0"], "`ux` is prescribed as well"),
        (&["phases[0].analysis=quasi_static"], "accelerations are prescribed in dynamic phases"),
    ] {
        let set: Vec<&str> = set.iter().flat_map(|entry| ["--set", entry]).collect();
        let output = errors(&in_folder(&project(""), &[&["check", COLUMN][..], &set].concat()));
        assert!(output.contains(says), "{set:?}: {output}");
    }
    let drifts = said(&in_folder(&project(""), &["check", COLUMN]));
    assert!(drifts.contains("`ax` of `base` leaves a velocity of 2.000e-2 m/s"), "{drifts}");
    let long = ["check", COLUMN, "--set", "phases[0].duration=0.5"];
    let output = said(&in_folder(&project(""), &long));
    assert!(output.contains("`ax` of `base` goes to 0.8 s, and the phase ends at 0.5 s"), "{output}");
}
