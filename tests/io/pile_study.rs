//! `cases/pile/study.py` measures noise and ripple that were put in, and none where there is none. Needs the Python
//! environment of the project (`make setup`).

use crate::support::{project, python, succeeds};
use std::fs;
use std::path::Path;

use mpm::io::export::{Regions, export};
use mpm::io::frame::{self, Column, FACES, Frame, LINE, Part, REGION};
use mpm::io::history::History;
use mpm::io::vtu::Encoding;
use mpm::mesh::Mesh;
use mpm::mesh::shape::CellKind;

/// A pile of 1 m that came to 1.4 m, with a pressure of 3 kPa on its base and a shear of 0.5 kPa on its shaft: its load a cubic of the way with a wave of 5 cm on it, `ripple` (-) high, and the stress
/// below it a quadratic function of the place with `noise` (kPa) of alternating sign.
fn write(out: &Path, noise: f64, ripple: f64) {
    let mut mesh =
        Mesh::<2> { nodes: vec![[0., -4.], [1., -4.], [0., 0.]], regions: vec!["clay".into()], ..Mesh::default() };
    mesh.cells.push(CellKind::T3, 0, &[0, 1, 2]);
    let place = |i: usize| [0.05 * (i % 20) as f64 + 0.025, -0.05 * (i / 20) as f64 - 0.025];
    let stress = |i: usize| {
        let [x, y] = place(i);
        -5.0 + 2.0 * y + x * x - 0.3 * y * y
            + 0.1 * x * y
            + if (i % 20 + i / 20).is_multiple_of(2) { noise } else { -noise }
    };
    let all = 0..1600;
    let values = all.clone().flat_map(|i| [0.0, stress(i), 0.0, 0.0, 0.0, 0.0]).collect();
    let stress = Column { name: "stress".into(), unit: "kPa".into(), components: 6, values };
    let points = Part { position: all.map(|i| [place(i)[0], place(i)[1], 0.0]).collect(), columns: vec![stress] };
    let boundary = |depth: f64| {
        let places = (0..=100).map(|i| {
            let way = 0.01 * f64::from(i);
            if i <= 50 { [way, -depth, 0.0] } else { [0.5, way - 0.5 - depth, 0.0] }
        });
        let column = |name: &str, values: Vec<f64>| Column {
            name: name.into(),
            unit: if name.starts_with("contact_") { "kPa" } else { "-" }.into(),
            components: values.len() / 101,
            values,
        };
        // Upwards on the pile: a pressure on its base, a shear stress on its shaft.
        let tractions = (0..=100).flat_map(|i| [0.0, if i <= 50 { 3.0 } else { 0.5 }, 0.0]);
        let columns = vec![
            column(LINE, vec![0.0; 101]),
            column(REGION, vec![0.0; 101]),
            column(FACES, vec![1.0; 101]),
            column("contact_traction", tractions.collect()),
        ];
        Part { position: places.collect(), columns }
    };
    let results = out.join("results");
    frame::prepare(&results, 0).unwrap();
    for (k, time) in [0.0, 0.6, 1.2, 1.4].into_iter().enumerate() {
        let points = points.clone();
        let contact = boundary(time);
        Frame { time, phase: "push".into(), step: k as u64, points, contact, ..Frame::default() }
            .write(&results, k)
            .unwrap();
    }
    let regions = Regions { elements: vec![false], soil: vec![true], ..Regions::default() };
    export(&results, &mesh, &regions, out, &["stress".into()], Encoding::Lz4).unwrap();
    let columns = ["time [s]", "pile.contact_y [kN]", "head.uy [m]"].map(String::from);
    let mut history = History::create(&out.join("history.csv"), &columns).unwrap();
    for d in (0..=1400).map(|i| f64::from(i) * 1e-3) {
        let load = 2.0 + d + 0.3 * d * d - 0.2 * d * d * d;
        history.row(&[d, load * (1.0 + ripple * (std::f64::consts::TAU * d / 0.05).sin()), -d].map(Some)).unwrap();
    }
    fs::write(out.join("run.txt"), "ended after 12.50 s: transfer 1 %\n").unwrap();
}

#[test]
fn noise_and_ripple_are_found_as_they_were_put_in() {
    let folder = tempfile::tempdir().unwrap();
    let [even, uneven] = ["even", "uneven"].map(|name| folder.path().join(name));
    write(&even, 0.0, 0.0);
    write(&uneven, 0.1, 0.02);
    let output = python().arg(project("cases/pile/study.py")).args([&even, &uneven]).output().unwrap();
    succeeds(&output);
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let rows: Vec<Vec<&str>> = text
        .lines()
        .filter(|line| line.starts_with("| even") || line.starts_with("| uneven"))
        .map(|line| line.trim_matches('|').split('|').map(str::trim).collect())
        .collect();
    let [loads, uneven_loads, base, _, stress, uneven_stress] = &rows[..] else { panic!("{text}") };
    // Over the area of the base, π/4 m²; 1.6 m was not reached.
    let load = |d: f64| format!("{:.2}", (2.0 + d + 0.3 * d * d - 0.2 * d * d * d) / (0.25 * std::f64::consts::PI));
    assert_eq!(loads[1..], [&load(0.6), &load(1.2), "-", "0.00%", "1.40 m", "12"]);
    let number = |text: &str| text.split(['%', ' ']).next().and_then(|n| n.parse::<f64>().ok()).unwrap();
    // The wave has a root mean square of 1/√2 of its height; the cubic takes up some of it.
    assert!((number(uneven_loads[4]) - 2.0 / 2f64.sqrt()).abs() < 0.1, "{text}");
    // 3 kPa on the base, 0.5 kPa on the lowest 0.1 m of the shaft, and the mean of both on the piece of 0.01 m at the edge.
    for of_base in &base[1..3] {
        assert!((number(of_base) - 3.0 - (0.5 * 0.09 + 1.75 * 0.01) * 4.0).abs() < 0.006, "{text}");
    }
    assert_eq!(base[3], "-");
    assert_eq!(stress[1..], ["0.000 / 0.000", "0.000 / 0.000", "-"]);
    for noise in uneven_stress[1..3].iter().flat_map(|both| both.split(" / ")) {
        assert!((number(noise) - 0.1).abs() < 0.005, "{text}");
    }
    assert!(even.join("curves.svg").exists());
}
