//! A silo by the defaults, lower than that of the case: full, opened, and filled by a column that falls into it.

use crate::mpm::scripts::study;
use crate::support::solve;
use std::fs;
use std::path::Path;

/// The columns of a file of comma-separated numbers whose names begin with these.
fn columns<const N: usize>(path: &Path, names: [&str; N]) -> Vec<[f64; N]> {
    let text = fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let head: Vec<&str> = lines.next().unwrap().split(',').collect();
    let at = names.map(|name| head.iter().position(|other| other.starts_with(name)).unwrap());
    let row = |line: &str| {
        let values: Vec<&str> = line.split(',').collect();
        at.map(|k| values[k].parse().unwrap())
    };
    lines.map(row).collect()
}

/// The least that resets, penalties and nodes that stop at supports dissipate, over the largest work of gravity: negative where they make energy.
fn least_numerical(folder: &Path) -> f64 {
    let names = ["supplied.gravity", "numerical.impact", "numerical.resets", "numerical.penalties"];
    let rows = columns(&folder.join("energy.csv"), names);
    let most = rows.iter().map(|row| row[0]).fold(0.0, f64::max);
    rows.iter().map(|row| row[1..].iter().sum::<f64>()).fold(0.0, f64::min) / most
}

/// The sand (t) above the floor at each time (s).
fn above_floor(folder: &Path) -> Vec<[f64; 2]> {
    let frames = mpm::io::frame::list(&folder.join("results")).unwrap();
    let frame = |path: &Path| {
        let frame = mpm::io::frame::Frame::read(path).unwrap();
        let points = &frame.points;
        let masses = points.columns.iter().find(|column| column.name == "mass").unwrap();
        let above = points.position.iter().zip(&masses.values).filter(|(x, _)| x[1] > 0.0);
        [frame.time, above.map(|(_, mass)| mass).sum()]
    };
    frames.iter().map(|found| frame(&found.path)).collect()
}

/// Before it is opened, floor and wall bear the weight, the floor that of Janssen for the horizontal stress of elastic soil at rest. A slot has the constant
/// 1.04 by Beverloo, and sand in free fall from an arch 0.87.
#[test]
fn a_silo_flows_out_at_a_rate_that_does_not_depend_on_its_height() {
    let settings = ["mesh.parameters={h: 0.1, height: 1, room: 1.5, depth: 0.6}", "phases.empty.duration=0.8"];
    let folder = solve("cases/silo", &settings);
    let names = ["time", "floor.contact_y", "gate.contact_y", "wall.contact_y"];
    let rows = columns(&folder.path().join("history.csv"), names);
    let full = rows.iter().find(|row| row[0] > 1.0 - 1e-9).unwrap();
    let (floor, weight) = (-full[1] - full[2], 1.6 * 9.81 * 0.5);
    let rise: f64 = 0.364 * 0.3 / 0.7 / 0.5;
    let janssen = 0.5 * 1.6 * 9.81 / rise * (1.0 - (-rise).exp());
    println!("floor {floor:.3} kN/m, Janssen {janssen:.3}");
    assert!(((floor - full[3]) / weight - 1.0).abs() < 1e-6, "{full:?}");
    assert!((floor / janssen - 1.0).abs() < 0.02, "{floor} {janssen}");

    let mass = above_floor(folder.path());
    let rate = |from: f64, to: f64| {
        let at = |t: f64| mass.iter().min_by(|a, b| (a[0] - t).abs().total_cmp(&(b[0] - t).abs())).unwrap();
        (at(from)[1] - at(to)[1]) / (to - from)
    };
    let (first, second) = (rate(1.3, 1.5), rate(1.5, 1.8));
    let constants = [first, second].map(|rate| 2.0 * rate / (1.6 * (9.81f64 * 0.3f64.powi(3)).sqrt()));
    study("cases/silo", folder.path(), &settings, "Beverloo: C =");
    println!("constants of Beverloo {constants:.3?}, from nowhere {:.1e}", least_numerical(folder.path()));
    assert!((first / second - 1.0).abs() < 0.1, "{constants:?}");
    assert!(constants.iter().all(|c| (0.87..1.15).contains(c)), "{constants:?}");
    assert!(least_numerical(folder.path()) > -0.01);
}

/// It comes to rest, and floor, gate and wall bear its weight.
#[test]
fn a_column_that_falls_into_a_silo_stays_there() {
    let settings = [
        "mesh.parameters={h: 0.1, lift: 1, column: 0.3, height: 1.2, above: 0.8, depth: 0.3}",
        "phases=[{name: fall, analysis: dynamic, duration: 1, step: {initial: 0.001, max: 0.005}}]",
    ];
    let folder = solve("cases/silo", &settings);
    let names = ["time", "floor.contact_y", "gate.contact_y", "wall.contact_y"];
    let (mut force, mut before) = (0.0, 0.7);
    for [time, floor, gate, wall] in columns(&folder.path().join("history.csv"), names) {
        if time > 0.7 {
            force -= (floor + gate + wall) * (time - before);
            before = time;
        }
    }
    let over = force / (0.3 * 1.6 * 9.81 * 1.2 * 0.3);
    let kinetic = columns(&folder.path().join("energy.csv"), ["supplied.gravity", "held.kinetic"]);
    let [work, rest] = kinetic[kinetic.len() - 1];
    println!("force over weight {over:.4}, kinetic energy {rest:.1e} of {work:.2} kJ");
    println!("from nowhere {:.1e}", least_numerical(folder.path()));
    assert!((over - 1.0).abs() < 0.02 && rest < 1e-3 * work, "{over} {rest}");
    assert!(least_numerical(folder.path()) > -0.01);
    let kept = above_floor(folder.path());
    assert!((kept[kept.len() - 1][1] / (1.6 * 1.2 * 0.3) - 1.0).abs() < 1e-9, "{kept:?}");
}
