//! Plates and bars through the program: beams, shells and springs against closed forms, and an anchored wall in soil against its equilibrium.

use crate::support::{column, errors, mpm, run, solve};
use std::f64::consts::FRAC_PI_2;
use std::fs;
use std::path::Path;

const BEAM: &str = "tests/data/beam";
const EI: f64 = 1.0e4;
const LENGTH: f64 = 10.0;
const SIMPLE: &str = "supports={root: {ux: 0, uy: 0}, tip: {uy: 0}}";

fn last(folder: &Path, name: &str) -> f64 {
    *column(folder, name).last().unwrap()
}

fn loads(on: &str, force: &str) -> String {
    format!(
        "phases=[{{name: load, analysis: quasi_static, duration: 1, step: {{initial: 1}}, gravity: 0, tractions: [{{on: {on}, {force}}}]}}]"
    )
}

#[track_caller]
fn close(found: f64, exact: f64, within: f64) {
    assert!((found / exact - 1.0).abs() < within, "{found} for {exact}");
}

/// The columns of `plates.csv` from `along` on, of the last frame.
fn sections(folder: &Path) -> Vec<Vec<f64>> {
    let text = fs::read_to_string(folder.join("plates.csv")).unwrap();
    let rows: Vec<Vec<&str>> = text.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let last = rows.last().unwrap()[0];
    let of_last = rows.iter().filter(|row| row[0] == last);
    of_last.map(|row| row[3..].iter().map(|v| v.parse().unwrap()).collect()).collect()
}

/// Ten elements: the deflection, the moment and the reaction of a cantilever and of a simple beam under a force and under its weight.
#[test]
fn ten_elements_bend_as_bernoulli_has_it() {
    let (p, q, l) = (0.1, 0.1, LENGTH);
    for (supports, load, watched, deflection, moment) in [
        ("title=a", loads("tip", "fy: -0.1"), "tip", -p * l.powi(3) / (3.0 * EI), -p * l),
        ("title=a", "title=b".into(), "tip", -q * l.powi(4) / (8.0 * EI), -q * l * l / 2.0),
        (SIMPLE, loads("middle", "fy: -0.1"), "middle", -p * l.powi(3) / (48.0 * EI), p * l / 4.0),
        (SIMPLE, "title=b".into(), "middle", -5.0 * q * l.powi(4) / (384.0 * EI), q * l * l / 8.0),
    ] {
        let folder = solve(BEAM, &[supports, &load]);
        close(last(folder.path(), &format!("{watched}.uy [m]")), deflection, 1e-3);
        close(last(folder.path(), "beam.bending_moment [kN m/m]"), moment, 1e-3);
        // The deflection alone turns a little of the load along the axis.
        assert!(last(folder.path(), "beam.normal_force [kN/m]").abs() < 2e-3 * q * l);
    }
}

/// A beam upright, to the other side or at any angle bends as one that lies, and the table has its forces along the axis.
#[test]
fn a_beam_bends_alike_however_it_lies() {
    let at = |angle: f64, side: f64| {
        let (c, s) = (angle.cos(), angle.sin());
        let axis = format!("regions.beam.plate.axis=[[0, 0], [{}, {}]]", 10.0 * c, 10.0 * s);
        let points = format!(
            "regions.beam.plate.points={{root: [0, 0], middle: [{}, {}], tip: [{}, {}]}}",
            5.0 * c,
            5.0 * s,
            10.0 * c,
            10.0 * s
        );
        let folder = run(BEAM, &[&axis, &points, &loads("tip", &format!("fx: {}, fy: {}", -side * s, side * c))]);
        let [x, y] = ["tip.ux [m]", "tip.uy [m]"].map(|name| last(folder.path(), name));
        let mut rows = sections(folder.path());
        for row in &mut rows {
            // Q and M of the other side.
            row[6] *= side;
            row[7] *= side;
        }
        ((y * c - x * s) * side, rows)
    };
    let (lies, rows) = at(0.0, 1.0);
    assert_eq!(rows.len(), 20);
    for (row, k) in rows.iter().zip([0, 1, 1, 2, 2, 3]) {
        let s = f64::from(k);
        assert!(
            (row[0] - s).abs() < 1e-9 && (row[7] - (LENGTH - s)).abs() < 2e-3 && (row[6] + 1.0).abs() < 1e-3,
            "{row:?}"
        );
    }
    for (angle, side) in [(0.0, -1.0), (FRAC_PI_2, 1.0), (-FRAC_PI_2, -1.0), (0.5, 1.0)] {
        let (other, turned) = at(angle, side);
        close(other, lies, 1e-6);
        for (row, same) in turned.iter().zip(&rows) {
            // In a finite deflection the force pulls a little along the axis.
            assert!((row[6] - same[6]).abs() < 1e-5 && (row[7] - same[7]).abs() < 1e-4, "{row:?} {same:?}");
        }
    }
}

/// A tube under pressure within it: p r around it, at the face that the pressure acts on.
#[test]
fn a_tube_bears_pressure_by_its_hoop_force() {
    let tube = "regions.beam.plate={axis: [[5, -2], [5, 2]], EA: 3.0e+6, EI: 1.0e+4, size: 0.4}";
    let history = "output.history=[{name: side, on: beam_left, quantities: [ux]}]";
    let phases = loads("beam_left", "pressure: 30");
    let folder = run(
        BEAM,
        &[
            "geometry=axisymmetric",
            tube,
            history,
            "gravity={}",
            "supports={beam_start: {uy: 0}}",
            &phases.replace("gravity: 0, ", ""),
        ],
    );
    let force = 30.0 * 4.9;
    for row in sections(folder.path()) {
        close(row[8], force, 1e-3);
    }
    close(last(folder.path(), "side.ux [m]"), force * 5.0 / 3.0e6, 0.02);
}

/// A long beam on many springs: Winkler's foundation under a force, w = P λ/2k and M = P/4λ. Its shear adds 1.5 % to the deflection.
#[test]
fn a_beam_on_springs_is_one_on_an_elastic_foundation() {
    let (spacing, count) = (0.2, 50);
    let lambda: f64 = 1.2;
    let k = 4.0 * EI * lambda.powi(4);
    let place = |i: usize| spacing * i as f64;
    let points: Vec<String> = (0..=count).map(|i| format!("p{i}: [{}, 0]", place(i))).collect();
    let bars: Vec<String> = (0..=count)
        .map(|i| {
            let half = if i % count == 0 { 0.5 } else { 1.0 };
            format!("b{i}: {{from: p{i}, to: [{}, -1], EA: {}, length: 1}}", place(i), k * spacing * half)
        })
        .collect();
    let plate = format!("regions.beam.plate.points={{{}}}", points.join(", "));
    let bars = format!("bars={{{}}}", bars.join(", "));
    let history = "output.history=[{name: middle, on: p25, quantities: [uy]}, {name: beam, on: beam, quantities: [bending_moment]}, {name: spring, on: b25, quantities: [force]}]";
    let set =
        [&plate, "regions.beam.plate.size=0.1", &bars, history, "supports={p0: {ux: 0}}", &loads("p25", "fy: -10")];
    let folder = solve(BEAM, &set);
    let exact = -10.0 * lambda / (2.0 * k);
    close(last(folder.path(), "middle.uy [m]"), exact, 0.02);
    close(last(folder.path(), "spring.force [kN]"), exact * k * spacing, 0.02);
    close(last(folder.path(), "beam.bending_moment [kN m/m]"), 10.0 / (4.0 * lambda), 0.02);
}

/// A tie at the tip of a cantilever: it has its prestress as it is tensioned, is a spring from then on, yields, and is gone where it is deactivated.
#[test]
fn a_bar_is_tensioned_yields_and_goes() {
    let step = "analysis: quasi_static, duration: 1, step: {initial: 0.5}, gravity: 0";
    let down = |force: f64| format!("tractions: [{{on: tip, fy: {force}}}]");
    let phases = format!(
        "phases=[{{name: tension, {step}}}, {{name: load, {step}, {}}}, {{name: more, {step}, {}}}, {{name: back, {step}, {}}}, {{name: free, {step}, {}, deactivate: [tie]}}]",
        down(-1.0),
        down(-6.0),
        down(-4.0),
        down(-4.0)
    );
    let bars = "bars={tie: {from: tip, to: [10, 3], EA: 300, prestress: 0.5, tension_limit: 4}}";
    let history = "output.history=[{name: tip, on: tip, quantities: [uy]}, {name: tie, on: tie, quantities: [force]}]";
    let folder = solve(BEAM, &[bars, &phases, history]);
    let [u, force] = ["tip.uy [m]", "tie.force [kN]"].map(|name| column(folder.path(), name));
    // Two steps a phase: the stiffnesses of the beam and of the tie.
    let (beam, tie) = (3.0 * EI / LENGTH.powi(3), 100.0);
    for (k, pull) in [(1, 0.5), (3, 0.5 + tie / (beam + tie)), (5, 4.0), (7, 4.0 - 2.0 * tie / (beam + tie)), (9, 0.0)]
    {
        assert!((force[k] - pull).abs() < 2e-3, "{k}: {} for {pull}, {force:?}", force[k]);
    }
    for (k, load) in [(1, 0.0), (3, -1.0), (5, -6.0), (7, -4.0), (9, -4.0)] {
        assert!((beam * u[k] - (load + force[k])).abs() < 5e-3, "{k}: {u:?} {force:?}");
    }
}

/// A wall in sand, dug in two lifts, with an anchor: earth pressure, anchor and weight are in equilibrium, and so are the forces in its sections.
#[test]
fn an_anchored_wall_is_in_equilibrium() {
    let folder = run("tests/data/dug_wall", &[]);
    let of = |name: &str| column(folder.path(), name);
    let (anchor, time) = (of("anchor.force [kN]"), of("time [s]"));
    for (force, t) in anchor.iter().zip(&time) {
        let expected = if *t <= 1.0 {
            0.0..=0.0
        } else if *t <= 2.0 {
            20.0..=20.0
        } else {
            20.0..=200.0
        };
        assert!(expected.contains(force), "{force} at {t}");
    }
    let last_force = *anchor.last().unwrap();
    assert!(last_force > 21.0, "{anchor:?}");
    let x = of("wall.contact_x [kN]");
    let y = of("wall.contact_y [kN]");
    for (d, whole) in [("x", &x), ("y", &y)] {
        let parts: f64 = ["left", "right", "start", "end"]
            .iter()
            .map(|side| *of(&format!("{side}.contact_{d} [kN]")).last().unwrap())
            .sum();
        close(parts, *whole.last().unwrap(), 1e-6);
    }
    assert!(*of("left.contact_x [kN]").last().unwrap() < -20.0 && *of("end.contact_y [kN]").last().unwrap() > 5.0);
    let (dx, dy) = (6.0f64, -3.0);
    let along = [dx, dy].map(|d| d / dx.hypot(dy));
    let weight = 9.0 * 6.0;
    let scale = 18.0 * 36.0 / 6.0;
    let end = [x.last().unwrap() + last_force * along[0], y.last().unwrap() + last_force * along[1] - weight];
    assert!(end.iter().all(|e| e.abs() < 0.01 * scale), "{end:?} of {scale}");
    // The sections: no forces at the head, the anchor as a step, and M as the integral of Q but for the friction at the sides.
    let rows = sections(folder.path());
    let step = rows.windows(2).find(|w| w[0][0] == w[1][0] && (w[0][0] - 1.0).abs() < 1e-9).unwrap();
    close((step[1][6] - step[0][6]).abs(), last_force * along[0], 0.03);
    assert!(rows[0][7].abs() < 0.02 * last(folder.path(), "wall.bending_moment [kN m/m]").abs());
}

/// A wall whose place the mesh does not follow is refused with the corners to draw.
#[test]
fn a_wall_needs_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let output = mpm("mesh", "tests/data/dug_wall", folder.path(), &["regions.wall.plate.EI=6.0e+4"]);
    assert!(!output.status.success());
    let said = errors(&output);
    assert!(said.contains("0.3873 m thick") && said.contains("[3.8064, 0.0000]"), "{said}");
}

/// Cells that reach from one side of a wall to the other are warned of.
#[test]
fn coarse_cells_in_the_place_of_a_wall_are_told() {
    let folder = tempfile::tempdir().unwrap();
    for (h, told) in [("0.25", false), ("0.6", true)] {
        let output = mpm("mesh", "tests/data/dug_wall", folder.path(), &[&format!("mesh.parameters.h={h}")]);
        let said = errors(&output);
        assert!(
            output.status.success() && said.contains("soil on both of its sides holds together") == told,
            "{h}: {said}"
        );
    }
}
