//! What is measured of the soil at places, through the program: at points, in boxes, along lines, over regions, in the history and as tables.

use crate::support::{errors, in_folder, said, solve_text, succeeds, written};
use mpm::io::frame::{self, Frame};
use mpm::io::table::Table;
use std::path::Path;

/// A block of soil at rest, 2 m wide and 4 m high, on its base at y = 0, with `more` about its material; x is the radius in axisymmetry.
fn ground(geometry: &str, more: &str, history: &str) -> String {
    format!(
        "geometry: {geometry}\n\
         mesh: {{geo: GEO/slump.geo, parameters: {{half_width: 2, height: 4, room: 0, h: 0.5, quads: 1}}}}\n\
         regions: {{block: {{kind: mpm, material: soil}}}}\n\
         materials: {{soil: {{model: linear_elastic, young: 1.0e+5, poisson: 0.3, density: 2{more}}}}}\n\
         supports: {{bottom: {{ux: 0, uy: 0}}, axis: {{ux: 0}}, face: {{ux: 0}}}}\n\
         gravity: {{y: -10}}\ninitial_stress: {{k0: 0.5}}\n\
         phases: [{{name: rest, analysis: quasi_static, duration: 1, step: {{initial: 0.5}}}}]\n\
         output: {{fields: [stress, displacement, strain], history: [{history}]}}\n"
    )
}

fn last(folder: &Path, name: &str) -> f64 {
    let table = Table::read(&folder.join("history.csv"), "").unwrap();
    *table.column(name).unwrap().values.last().unwrap()
}

#[test]
fn ground_at_rest_has_the_weight_above() {
    let history = "{name: p, at: [0.7, 1.3], quantities: [stress_yy, stress_xx, mean_stress, uy, strain_xy]}, \
                   {name: top, at: [1.1, 4], quantities: [stress_yy]}, {name: corner, at: [2, 0], quantities: [stress_yy]}, \
                   {name: l, line: [1, 0, 1, 5], quantities: [stress_yy, thickness]}, {name: wall, line: [0, 5, 0, -1], quantities: [thickness]}, \
                   {name: b, box: [-1, 1, 1, 2], quantities: [mass, volume, stress_yy, y_min, y_max]}, \
                   {name: whole, on: block, quantities: [mass, volume, stress_yy, deviatoric_stress]}";
    for (geometry, weight) in [("plane_strain", 1.0), ("axisymmetric", std::f64::consts::PI)] {
        let folder = solve_text(&ground(geometry, "", history));
        let near = |name: &str, exact: f64, tolerance: f64| {
            let found = last(folder.path(), name);
            assert!((found - exact).abs() < tolerance, "{geometry}, {name}: {found} of {exact}");
        };
        near("p.stress_yy [kPa]", -20.0 * 2.7, 1e-6);
        near("p.stress_xx [kPa]", -10.0 * 2.7, 1e-6);
        near("p.mean_stress [kPa]", -40.0 / 3.0 * 2.7, 1e-6);
        near("p.uy [m]", 0.0, 1e-9);
        near("p.strain_xy [-]", 0.0, 1e-9);
        near("top.stress_yy [kPa]", 0.0, 1e-6);
        near("corner.stress_yy [kPa]", -80.0, 1e-6);
        near("l.thickness [m]", 4.0, 1e-6);
        near("wall.thickness [m]", 4.0, 1e-6);
        // Up to one and a half spacings of the points beyond the surface counts as soil.
        near("l.stress_yy [kPa]", -40.0, 1.5);
        // A row of cells: a metre of the plane, the cylinder up to the radius 1 m.
        near("b.mass [t]", 2.0 * weight, 1e-9);
        near("b.volume [m3]", weight, 1e-9);
        near("b.stress_yy [kPa]", -50.0, 0.5);
        near("whole.mass [t]", if weight == 1.0 { 16.0 } else { 32.0 * weight }, 1e-9);
        near("whole.stress_yy [kPa]", -40.0, 1e-6);
        near("whole.deviatoric_stress [kPa]", 20.0, 1e-6);
        let extremes = ["b.y_min [m]", "b.y_max [m]"].map(|name| last(folder.path(), name));
        assert!(1.0 < extremes[0] && extremes[0] < 1.2 && 1.8 < extremes[1] && extremes[1] < 2.0, "{extremes:?}");

        // The same along a line of a frame, and of the points in a box.
        let table = folder.path().join("line.csv");
        let csv = |options: &[&str]| {
            let path = table.display().to_string();
            let output = in_folder(folder.path(), &[&["export", ".", "-o", ".", "--csv", &path], options].concat());
            succeeds(&output);
            (Table::read(&table, "").unwrap(), errors(&output))
        };
        let (along, told) = csv(&["--along", "1.3,-1,1.3,4", "--stations", "11"]);
        let of = |table: &Table, name: &str| table.column(name).unwrap().values.clone();
        assert!(told.contains("of 11 rows are empty"), "{told}");
        assert_eq!(of(&along, "distance [m]"), (0..11).map(|i| 0.5 * f64::from(i)).collect::<Vec<_>>());
        for (y, stress) in of(&along, "y").into_iter().zip(of(&along, "stress.yy [kPa]")) {
            assert!(if y < 0.0 { stress.is_nan() } else { (stress + 20.0 * (4.0 - y)).abs() < 1e-6 }, "{y}: {stress}");
        }
        let (points, told) = csv(&["--window", "-1,1,1,2", "--frame", "0"]);
        assert!(!told.contains("empty") && of(&points, "time").iter().all(|&t| t == 0.0), "{told}");
        for (y, stress) in of(&points, "y").into_iter().zip(of(&points, "mean_stress")) {
            assert!((1.0..2.0).contains(&y) && (stress + 40.0 / 3.0 * (4.0 - y)).abs() < 1e-6, "{y}: {stress}");
        }
        let (both, _) = csv(&["--times", "0,1"]);
        assert_eq!(of(&both, "time").iter().filter(|&&t| t == 1.0).count() * 2, both.rows());
        assert_eq!(of(&both, "strain.xy [-]").len(), both.rows());
    }
}

/// Undrained soil between smooth walls carries a sudden load by its water, as if that had all of the stiffness: q K_w/(K_w + K + 4/3 G).
#[test]
fn the_water_carries_a_sudden_load() {
    let history = "{name: p, at: [1, 2], quantities: [pore_pressure]}, {name: b, box: [0, 1, 2, 3], quantities: [pore_pressure]}, \
                   {name: all, on: block, quantities: [pore_pressure, strain_yy, volume]}, {name: top, on: top, quantities: [uy]}";
    let text = ground("plane_strain", ", drainage: undrained", history)
        .replace("step: {initial: 0.5}", "step: {initial: 0.5}, tractions: [{surface: all, pressure: {rate: 50}}]");
    let folder = solve_text(&text);
    let [p, b, all] = ["p", "b", "all"].map(|name| last(folder.path(), &format!("{name}.pore_pressure [kPa]")));
    assert!((p - b).abs() < 1e-6 && (p - all).abs() < 1e-6, "{p} {b} {all}");
    // K_w brings Poisson's ratio to 0.495.
    let shear = 1e5 / 2.6;
    let (skeleton, whole) = (1e5 / 1.2, 2.0 * shear * 1.495 / 0.03);
    let exact = 50.0 * (whole - skeleton) / (whole + 4.0 / 3.0 * shear);
    assert!((p / exact - 1.0).abs() < 1e-3, "{p} of {exact}");
    let [strain, moved, volume] =
        ["all.strain_yy [-]", "top.uy [m]", "all.volume [m3]"].map(|n| last(folder.path(), n));
    assert!((strain - (1.0 + moved / 4.0).ln()).abs() < 1e-9, "{strain} {moved}");
    assert!((volume - 2.0 * (4.0 + moved)).abs() < 1e-9, "{volume} {moved}");
}

/// A column of soft clay that falls: the toe and the heights are those of its points, the place that it leaves becomes empty, with one warning, and a point
/// that goes with the soil stays in it.
#[test]
fn a_toe_is_that_of_the_points_and_what_the_soil_leaves_is_empty() {
    let history = "{name: toe, on: block, quantities: [x_max, y_max]}, {name: beside, box: [1, -1, 9, 9], quantities: [x_max, mass, x_min]}, \
                   {name: crest, at: [0.9, 1.9], quantities: [uy, stress_yy]}, \
                   {name: soil, at: [0.9, 1.9], follow: true, quantities: [uy, ux]}, {name: h, line: [0, -1, 0, 3], quantities: [thickness]}, \
                   {name: far, line: [1.5, 0, 1.5, 3], quantities: [thickness]}";
    let text = format!(
        "geometry: plane_strain\n\
         mesh: {{geo: GEO/slump.geo, parameters: {{half_width: 1, height: 2, room: 2, h: 0.25, quads: 1}}}}\n\
         regions: {{block: {{kind: mpm, material: clay}}, room: {{kind: buffer}}}}\n\
         materials: {{clay: {{model: tresca, young: 1000, poisson: 0.45, shear_strength: 3, density: 2}}}}\n\
         supports: {{bottom: {{ux: 0, uy: 0}}, axis: {{ux: 0}}, end: {{ux: 0}}}}\ngravity: {{y: -10}}\n\
         numerics: {{spectral_radius: 0.6}}\n\
         phases: [{{name: fall, analysis: dynamic, duration: 0.8, step: {{initial: 0.02}}}}]\noutput: {{history: [{history}]}}\n"
    );
    let folder = written(&text);
    for stage in ["mesh", "seed"] {
        succeeds(&in_folder(folder.path(), &[stage, ".", "-o", "."]));
    }
    let output = in_folder(folder.path(), &["solve", ".", "-o", "."]);
    succeeds(&output);
    let said = said(&output);
    assert_eq!(said.matches("the history `crest` has empty fields").count(), 1, "{said}");
    assert!(said.contains("`beside` has empty fields") && !said.contains("`soil` has empty"), "{said}");
    let last = |name: &str| last(folder.path(), name);
    let points = Frame::read(&frame::path(&folder.path().join("results"), 1)).unwrap().points.position;
    let most = |d: usize| points.iter().map(|x| x[d]).fold(f64::NEG_INFINITY, f64::max);
    assert_eq!([last("toe.x_max [m]"), last("beside.x_max [m]"), last("toe.y_max [m]")], [most(0), most(0), most(1)]);
    assert!(most(0) > 1.5, "{}", most(0));
    let beside = points.iter().filter(|x| x[0] >= 1.0).map(|x| x[0]).fold(f64::INFINITY, f64::min);
    assert_eq!(last("beside.x_min [m]"), beside);
    let (height, far) = (last("h.thickness [m]"), last("far.thickness [m]"));
    let near_axis = points.iter().filter(|x| x[0] < 0.15).map(|x| x[1]).fold(0.0, f64::max);
    assert!((height - near_axis).abs() < 0.1 && height < 1.9, "{height} {near_axis}");
    assert!(far < height, "{far} {height}");
    let table = Table::read(&folder.path().join("history.csv"), "").unwrap();
    let crest = &table.column("crest.stress_yy").unwrap().values;
    assert!(crest[0].is_finite() && crest.last().unwrap().is_nan(), "{crest:?}");
    let [x, y] = [last("soil.ux [m]"), last("soil.uy [m]")];
    assert!(x > 0.1 && y < -0.1, "{x} {y}");
    // A table of a place that has no soil is refused, one that has less of it says how much.
    let nothing = ["export", ".", "-o", ".", "--csv", "t.csv", "--along", "2.9,1.9,2.8,1.9"];
    let output = in_folder(folder.path(), &nothing);
    assert!(
        errors(&output).contains("there is no soil at that place and time") && !folder.path().join("t.csv").exists()
    );
}

#[test]
fn entries_that_cannot_be_meant_are_refused() {
    for (entry, told) in [
        ("{name: a, quantities: [uy]}", "give one of `on`, `at`, `box` and `line`"),
        ("{name: a, on: block, at: [1, 1], quantities: [uy]}", "give one of `on`, `at`, `box` and `line`"),
        ("{name: a, on: block, follow: true, quantities: [uy]}", "only the soil at a point is followed"),
        ("{name: a, box: [1, 1, 0, 2], quantities: [mass]}", "[left, bottom, right, top]"),
        ("{name: a, line: [1, 1, 1, 1], quantities: [uy]}", "the line has no length"),
        ("{name: a, at: [1, 1], quantities: [reaction_y]}", "a place in the soil has no force"),
        ("{name: a, at: [1, 1], quantities: [mass]}", "that of many points"),
        ("{name: a, box: [0, 0, 1, 1], quantities: [thickness]}", "only a line has it"),
        ("{name: a, on: block, quantities: [thickness]}", "only a line has it"),
        ("{name: a, on: top, quantities: [stress_yy]}", "only soil and regions that deform have it"),
        ("{name: a, at: [1, 1], quantities: [pore_pressure]}", "no material is undrained"),
    ] {
        let folder = written(&ground("plane_strain", "", entry));
        let output = in_folder(folder.path(), &["check", "."]);
        assert!(!output.status.success() && said(&output).contains(told), "{entry}: {}", said(&output));
    }
    for (entry, told) in [
        ("{name: a, at: [9, 1], quantities: [uy]}", "the history `a` stays empty: [9.0, 1.0] m lies outside the grid"),
        ("{name: a, at: [9, 1], follow: true, quantities: [uy]}", "no soil of `kind: mpm` is seeded at"),
        ("{name: a, box: [5, 1, 6, 2], quantities: [x_max]}", "its place lies outside the grid"),
    ] {
        let folder = written(&ground("plane_strain", "", entry));
        let output = in_folder(folder.path(), &["check", "."]);
        assert!(output.status.success() && said(&output).contains(told), "{entry}: {}", said(&output));
    }
}
