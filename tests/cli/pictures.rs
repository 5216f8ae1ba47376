//! `mpm plot --field`: which frame and field is drawn, what is refused, and that it follows what `mpm export` shows.

use crate::support::{block, in_folder, said};
use std::fs;
use std::path::Path;
use std::process::Output;
use tempfile::TempDir;

fn solved() -> TempDir {
    let folder = block::scene("1", "0.25", "0.25");
    says(&in_folder(folder.path(), &["run", "."]), 0, &[]);
    folder
}

fn says(output: &Output, status: i32, parts: &[&str]) {
    let said = said(output);
    assert_eq!(output.status.code(), Some(status), "{said}");
    parts.iter().for_each(|part| assert!(said.contains(part), "`{part}` is not in: {said}"));
}

/// Width and height of a PNG.
fn size(path: &Path) -> [u32; 2] {
    let bytes = fs::read(path).unwrap();
    assert_eq!(&bytes[..8], b"\x89PNG\r\n\x1a\n");
    [16, 20].map(|at| u32::from_be_bytes(bytes[at..at + 4].try_into().unwrap()))
}

#[test]
fn a_field_is_drawn_at_the_time_that_is_asked_for() {
    let folder = solved();
    let plot = |arguments: &[&str]| in_folder(folder.path(), &[&["plot", "."], arguments].concat());
    says(&plot(&["--field", "stress.yy"]), 0, &["out/stress.yy.png: t = 1 s"]);
    assert_eq!(size(&folder.path().join("out/stress.yy.png"))[0], 1600);
    says(
        &plot(&["--field", "displacement", "--time", "0.6", "--width", "800", "-o", "u.png"]),
        0,
        &["u.png: t = 0.5 s"],
    );
    assert_eq!(size(&folder.path().join("u.png"))[0], 800);
    // As an output folder, from the place where it was solved.
    let from =
        in_folder(folder.path(), &["plot", "out", "--field", "mean_stress", "--frame", "2", "-o", "p.svg", "--mesh"]);
    says(&from, 0, &["p.svg: t = 0.5 s"]);
    let text = fs::read_to_string(folder.path().join("p.svg")).unwrap();
    assert!(text.contains("mean_stress [kPa]") && text.contains("t = 0.5 s") && text.contains("<image "));
    says(
        &plot(&["--field", "stress.yy", "--times", "0.25,1", "-o", "s.png"]),
        0,
        &["s_t0.25.png", "s_t1.png: t = 1 s"],
    );
    assert_eq!(size(&folder.path().join("s_t0.25.png")), size(&folder.path().join("s_t1.png")));
    says(&plot(&["--field", "displacement.y", "--animate", "u.gif", "--width", "400"]), 0, &["u.gif: 5 frames"]);
    assert_eq!(&fs::read(folder.path().join("u.gif")).unwrap()[..6], b"GIF89a");
}

#[test]
fn what_cannot_be_drawn_is_told_with_what_can() {
    let folder = solved();
    for (arguments, parts) in [
        (&["--field", "stress"][..], &["several components", "stress.xx, stress.yy"][..]),
        (&["--field", "stress.rr"], &["no component `rr`"]),
        (&["--field", "velocity"], &["`velocity`", "displacement"]),
        (&["--field", "stress.yy", "--frame", "9"], &["no frame 9", "0 to 4"]),
        (&["--field", "stress.yy", "--range", "1,-1"], &["not above"]),
        (&["--field", "stress.yy", "--window", "0,0,1"], &["3 numbers for 4"]),
        (&["--field", "stress.yy", "--contact"], &["no contact"]),
        (&["--field", "stress.yy", "-o", "s.jpg"], &["SVG or PNG"]),
        (&["--field", "stress.yy", "--plastic-points"], &["no field `plastic_points`", "output.fields"]),
        (&["--field", "stress.yy", "--arrows", "velocity"], &["no field `velocity`"]),
        (&["--field", "stress.yy", "--hide", "rock"], &["no region `rock`", "block"]),
        (&["--field", "stress.yy", "--net", "0"], &["above 0"]),
        (&["--field", "stress.yy", "--x", "time"], &["--x", "for curves of histories"]),
        (&["--field", "stress.yy", "--along", "1,1,1,1"], &["no length"]),
        (&["--field", "stress.yy", "--along", "5,0,5,2"], &["no soil along the line"]),
        (&["--field", "stress", "--along", "0.5,0,0.5,2"], &["no such component", "stress.yy"]),
    ] {
        says(&in_folder(folder.path(), &[&["plot", "."], arguments].concat()), 2, parts);
    }
}

#[test]
fn what_is_drawn_over_a_field_and_along_a_line() {
    let folder = solved();
    let plot = |arguments: &[&str]| in_folder(folder.path(), &[&["plot", "."], arguments].concat());
    let over = ["--arrows", "displacement", "--crosses", "--contours", "--net", "0.1", "--title", "A block"];
    says(&plot(&[&["--field", "stress.yy", "-o", "o.svg"], &over[..]].concat()), 0, &["o.svg: t = 1 s"]);
    let text = fs::read_to_string(folder.path().join("o.svg")).unwrap();
    for said in ["A block, phase load, t = 1 s", "displacement 0.0", "compression "] {
        assert!(text.contains(said), "{said}");
    }
    // Along a vertical line the height is the vertical axis, and a time is a curve.
    let along =
        ["--field", "stress.yy", "--along", "0.5,-1,0.5,2", "--times", "0.5,1", "--label", "half", "--label", "all"];
    says(&plot(&along), 0, &["stress.yy_along.svg", "of 202 places along the line have no soil"]);
    let text = fs::read_to_string(folder.path().join("out/stress.yy_along.svg")).unwrap();
    for said in ["y [m]", "stress.yy [kPa]", "half", "from (0.5, −1) m to (0.5, 2) m"] {
        assert!(text.contains(said), "{said}: {text}");
    }
    let along = ["--field", "displacement", "--along", "0,1,1,1", "--stations", "5", "-o", "u.svg"];
    says(&plot(&along), 0, &["u.svg"]);
    assert!(fs::read_to_string(folder.path().join("u.svg")).unwrap().contains("displacement [m]"));
}

#[test]
fn results_of_another_mesh_are_not_drawn_and_an_unfinished_run_when_asked_for() {
    let folder = solved();
    let plot =
        |arguments: &[&str]| in_folder(folder.path(), &[&["plot", ".", "--field", "stress.yy"], arguments].concat());
    says(&plot(&["--unfinished"]), 2, &["no run that was not finished"]);
    let failing = ["--set", "numerics.max_iterations=1", "--set", "phases.load.step={initial: 1, min: 1}"];
    says(&in_folder(folder.path(), &[&["run", "."], &failing[..]].concat()), 1, &[]);
    says(&plot(&[]), 0, &["t = 1 s"]);
    says(&plot(&["--unfinished"]), 0, &["t = 0 s"]);
    says(&in_folder(folder.path(), &["mesh", ".", "--set", "mesh.parameters.h=0.5"]), 0, &[]);
    says(&plot(&[]), 2, &["another mesh.msh", "mpm solve"]);
}

#[test]
fn the_soil_is_a_series_unless_the_displacement_is_not_in_the_output() {
    let folder = solved();
    let (series, file) = (folder.path().join("out/soil.pvd"), folder.path().join("out/vtu/soil_000004.vtu"));
    assert_eq!(fs::read_to_string(&series).unwrap().matches("<DataSet ").count(), 5);
    let header = String::from_utf8_lossy(&fs::read(&file).unwrap()).into_owned();
    for name in [
        "region [-]",
        "material [-]",
        "stress [kPa]",
        "mean_stress [kPa]",
        "deviatoric_stress [kPa]",
        "displacement [m]",
    ] {
        assert!(header.contains(&format!("Name=\"{name}\"")), "{name}");
    }
    let stress = ["--set", "output.fields=[stress]"];
    says(&in_folder(folder.path(), &[&["run", "."], &stress[..]].concat()), 0, &["no soil.pvd", "`displacement`"]);
    assert!(!series.exists() && !file.exists());
    let plot = in_folder(folder.path(), &[&["plot", "out", "--field", "stress.yy"][..]].concat());
    says(&plot, 2, &["`displacement`"]);
}
