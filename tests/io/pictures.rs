//! The scripts in `paraview/` draw a series without a display; `tests/mpm/cases.rs` has those of its cases. Needs the Python environment of the project
//! (`make setup`).

use crate::support::{self, project};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Output;

use mpm::io::export::{Regions, export};
use mpm::io::frame::{self, Column, Frame, Part};
use mpm::io::history::History;
use mpm::io::provenance::Origin;
use mpm::io::vtu::Encoding;
use mpm::mesh::Mesh;
use mpm::mesh::shape::CellKind;

fn python(script: &str, arguments: &[&Path]) -> Output {
    support::python().arg(project(script)).args(arguments).env_remove("DISPLAY").output().unwrap()
}

fn draw(script: &str, out: &Path) -> PathBuf {
    let picture = out.join("picture.png");
    let output = python(script, &[out]);
    assert!(output.status.success() && picture.exists(), "{script}: {}", String::from_utf8_lossy(&output.stderr));
    let check = python("tests/readers/check_picture.py", &[&picture]);
    assert!(check.status.success(), "{script}: {}", String::from_utf8_lossy(&check.stderr));
    picture
}

/// A block that leans over in time, on a grid of Q8 cells.
fn leaning_block(out: &Path, width: f64, height: f64) {
    let nx = (40.0 * (width / height).sqrt()).round() as usize;
    let ny = 1600 / nx;
    let start = |i: usize| [width * ((i % nx) as f64 + 0.5) / nx as f64, height * ((i / nx) as f64 + 0.5) / ny as f64];
    let mut mesh = Mesh::<2> { regions: vec!["soil".to_string()], ..Mesh::default() };
    for c in 0..6 {
        let first = mesh.nodes.len() as u32;
        for xi in CellKind::Q8.node_coordinates() {
            mesh.nodes.push([width * (f64::from(c) + 0.5 + 0.5 * xi[0]) / 4.0, height * (0.5 + 0.5 * xi[1])]);
        }
        mesh.cells.push(CellKind::Q8, 0, &(first..first + 8).collect::<Vec<_>>());
    }
    frame::prepare(&out.join("results"), 0).unwrap();
    for k in 0..6 {
        let lean = 0.06 * k as f64;
        let column = |name: &str, unit: &str, components, values| Column {
            name: name.to_string(),
            unit: unit.to_string(),
            components,
            values,
        };
        let all = 0..nx * ny;
        let points = Part {
            position: all.clone().map(|i| [start(i)[0] + lean * start(i)[1], start(i)[1], 0.0]).collect(),
            columns: vec![
                column("displacement", "m", 3, all.clone().flat_map(|i| [lean * start(i)[1], 0.0, 0.0]).collect()),
                column(frame::VOLUME, "m3", 1, vec![width * height / (nx * ny) as f64; nx * ny]),
                column("plastic_strain", "-", 1, all.clone().map(|i| lean * start(i)[1] / height).collect()),
                column("stress", "kPa", 6, all.flat_map(|i| [0.0, -10.0 * start(i)[1], 0.0, 0.0, 0.0, 0.0]).collect()),
            ],
        };
        let frame = Frame {
            time: k as f64 * 0.5,
            phase: "fall".to_string(),
            step: k,
            origin: Origin::default(),
            points,
            grid: Part::default(),
            elements: Part::default(),
            contact: Part::default(),
            surface: Part::default(),
        };
        frame.write(&out.join("results"), k as usize).unwrap();
    }
    let fields = ["displacement", "plastic_strain", "stress"].map(String::from);
    let regions = Regions { elements: vec![false], soil: vec![true], ..Regions::default() };
    export(&out.join("results"), &mesh, &regions, out, &fields, Encoding::Lz4).unwrap();
}

#[test]
fn a_series_is_drawn_without_a_display() {
    let out = tempfile::tempdir().unwrap();
    leaning_block(out.path(), 40.0, 6.0);
    let picture = draw("paraview/seabed_slope.py", out.path());
    assert_eq!(fs::read_dir(out.path()).unwrap().filter(|e| is_png(&e.as_ref().unwrap().path())).count(), 1);
    if let Some(keep) = std::env::var_os("MPM_KEEP_PICTURES") {
        fs::copy(picture, Path::new(&keep).join("seabed_slope.png")).unwrap();
    }
}

/// The soil of the same block as a body, by the script for any case.
#[test]
fn the_soil_of_any_case_is_drawn_as_a_body() {
    let out = tempfile::tempdir().unwrap();
    leaning_block(out.path(), 40.0, 6.0);
    let view = |arguments: &[&str]| {
        let script =
            support::python().arg(project("paraview/view.py")).arg(out.path()).args(arguments).output().unwrap();
        (script.status.code(), String::from_utf8_lossy(&script.stderr).into_owned())
    };
    let picture = out.path().join("view.png");
    assert_eq!(view(&["--field", "stress.yy", "--mesh"]).0, Some(0));
    let check = python("tests/readers/check_picture.py", &[&picture]);
    assert!(check.status.success(), "{}", String::from_utf8_lossy(&check.stderr));
    let (code, text) = view(&["--field", "velocity"]);
    assert!(code == Some(2) && text.contains("it has displacement [m], plastic_strain [-], stress [kPa]"), "{text}");
    if let Some(keep) = std::env::var_os("MPM_KEEP_PICTURES") {
        fs::copy(picture, Path::new(&keep).join("view.png")).unwrap();
    }
}

fn is_png(path: &Path) -> bool {
    path.extension().is_some_and(|e| e == "png")
}

#[test]
fn the_settlement_curve_is_drawn() {
    let out = tempfile::tempdir().unwrap();
    let columns = ["time [s]", "footing.uy [m]", "footing.reaction_y [kN/m]"].map(String::from);
    let mut history = History::create(&out.path().join("history.csv"), &columns).unwrap();
    for i in 0..50 {
        let t = f64::from(i) / 50.0;
        history.row(&[t, -0.1 * t, -5.14 * (1.0 - (-8.0 * t).exp())].map(Some)).unwrap();
    }
    let picture = draw("paraview/strip_footing.py", out.path());
    if let Some(keep) = std::env::var_os("MPM_KEEP_PICTURES") {
        fs::copy(picture, Path::new(&keep).join("strip_footing.png")).unwrap();
    }
}

#[test]
fn a_missing_series_is_one_message() {
    let out = tempfile::tempdir().unwrap();
    let output = python("paraview/seabed_slope.py", &[out.path()]);
    assert_eq!(output.status.code(), Some(2));
    let text = String::from_utf8_lossy(&output.stderr).into_owned();
    assert!(text.contains("points.pvd") && text.contains("mpm export") && text.lines().count() == 1, "{text}");
}
