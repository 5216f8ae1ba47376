//! Curves of soil through grid resets: a curve that is moved keeps its soil, and the history of a curve is that of the soil that was there.

use crate::support::{column, errors, mpm, said, succeeds};
use std::fs;
use std::path::Path;
use std::process::Output;
use tempfile::TempDir;

/// Height of the soil (m), and its width.
const SIDE: f64 = 2.0;
/// Constrained modulus (kPa) at E = 1000 kPa and ν = 0.25.
const MODULUS: f64 = 1200.0;

/// A square of elastic soil beneath air as wide as said, with `phases`, in an oedometer where the air is as wide.
fn scene(wide: f64, phases: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let geo = format!(
        "SetFactory(\"OpenCASCADE\");\nMesh.MeshSizeMax = 0.5;\nRectangle(1) = {{0, 0, 0, 2, 2}};\nRectangle(2) = {{0, 2, 0, {wide}, 0.5}};\n\
         Rectangle(3) = {{0, 0, 0, {wide}, 2.5}};\nBooleanFragments{{ Surface{{3}}; Delete; }}{{ Surface{{1, 2}}; Delete; }}\n\
         soil() = Surface In BoundingBox {{-0.1, -0.1, -1, 2.1, 2.1, 1}};\nall() = Surface{{:}};\nall() -= soil();\n\
         Physical Surface(\"soil\") = soil();\nPhysical Surface(\"air\") = all();\n\
         Physical Curve(\"bottom\") = Curve In BoundingBox {{-1, -0.1, -1, 9, 0.1, 1}};\n\
         Physical Curve(\"top\") = Curve In BoundingBox {{-1, 1.9, -1, 9, 2.1, 1}};\n\
         Physical Curve(\"side\") = Curve In BoundingBox {{-0.1, -1, -1, 0.1, 9, 1}};\n\
         Physical Curve(\"other\") = Curve In BoundingBox {{1.9, -0.1, -1, 2.1, 2.1, 1}};\n"
    );
    let case = format!(
        "geometry: plane_strain\nmesh: {{geo: m.geo}}\nregions: {{soil: {{kind: mpm, material: soil}}, air: {{kind: buffer}}}}\n\
         materials: {{soil: {{model: linear_elastic, young: 1000, poisson: 0.25, density: 1}}}}\n\
         supports: {{bottom: {{uy: 0}}, side: {{ux: 0}}}}\nphases: [{phases}]\noutput: {{history: [\
         {{name: top, on: top, quantities: [uy, reaction_y]}}, {{name: bottom, on: bottom, quantities: [reaction_y]}}, \
         {{name: soil, on: soil, quantities: [uy]}}]}}\n"
    );
    fs::write(folder.path().join("m.geo"), geo).unwrap();
    fs::write(folder.path().join("case.yaml"), case).unwrap();
    folder
}

const HELD: &str = "supports={bottom: {uy: 0}, side: {ux: 0}, other: {ux: 0}}";

fn run(folder: &Path, set: &[&str]) -> Output {
    let output = mpm("run", folder, &folder.join("out"), set);
    succeeds(&output);
    output
}

fn resets(folder: &Path) -> usize {
    fs::read_to_string(folder.join("out/solve.log"))
        .unwrap()
        .lines()
        .filter(|l| l.ends_with(" restored") || l.contains(" restored "))
        .count()
}

/// The force on the soil in an oedometer: logarithmic strain, with the Kirchhoff stress M ln λ over the volume λ.
fn force(settlement: f64) -> f64 {
    let stretch = 1.0 + settlement / SIDE;
    SIDE * MODULUS * stretch.ln() / stretch
}

#[test]
fn a_curve_that_is_moved_keeps_its_soil_through_grid_resets() {
    let press = "{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.05}, prescribe: {top: {uy: {rate: -0.8}}}}";
    let folder = scene(2.0, press);
    for restore in ["{min_quality: 0.5}", "every_step", "never"] {
        run(folder.path(), &[HELD, &format!("numerics.restore={restore}")]);
        assert!(restore != "{min_quality: 0.5}" || resets(folder.path()) > 0);
        let out = folder.path().join("out");
        let way = column(&out, "top.uy [m]");
        let [top, bottom] = ["top", "bottom"].map(|on| column(&out, &format!("{on}.reaction_y [kN]")));
        assert!((way[way.len() - 1] + 0.8).abs() < 1e-12);
        for ((way, top), bottom) in way.iter().zip(top).zip(bottom) {
            let expected = force(*way);
            assert!((top / expected - 1.0).abs() < 1e-6 && (bottom + top).abs() < 1e-5, "{restore}: {top} {expected}");
        }
        let soil = column(&out, "soil.uy [m]");
        assert!((soil[soil.len() - 1] + 0.4).abs() < 1e-6, "{restore}: {soil:?}");
    }
}

/// Pressed, held, let go and pulled, and moved with inertia: the same as on a grid that is never reset.
#[test]
fn a_moved_curve_may_be_held_and_let_go() {
    let phases = "{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.1}, prescribe: {top: {uy: {rate: -0.7}}}}, \
        {name: hold, analysis: quasi_static, duration: 1, step: {initial: 1}, prescribe: {top: {uy: 0}}}, \
        {name: free, analysis: quasi_static, duration: 1, step: {initial: 0.1}}, \
        {name: pull, analysis: quasi_static, duration: 1, step: {initial: 0.1}, prescribe: {top: {uy: {rate: 0.3}}}}, \
        {name: wave, analysis: dynamic, duration: 0.2, step: {initial: 0.02}, prescribe: {top: {uy: {table: [[0, 0], [0.2, -0.4]]}}}}";
    let folder = scene(2.0, phases);
    let solved = |restore: &str| {
        run(folder.path(), &[HELD, &format!("numerics.restore={restore}")]);
        let out = folder.path().join("out");
        ["time [s]", "top.uy [m]", "top.reaction_y [kN]", "bottom.reaction_y [kN]", "soil.uy [m]"]
            .map(|name| column(&out, name))
    };
    let never = solved("never");
    let [time, way, force, bottom, soil] = solved("{min_quality: 0.5}");
    assert!(resets(folder.path()) > 1);
    for (k, time) in time.iter().enumerate() {
        let other = never[0].iter().position(|t| (t - time).abs() < 1e-9).unwrap();
        let near = |value: f64, of: usize, scale: f64| (value - never[of][other]).abs() < 1e-5 * scale;
        assert!(near(way[k], 1, 1.0) && near(soil[k], 4, 1.0), "{time}: {} {}", way[k], soil[k]);
        assert!(near(force[k], 2, 1000.0) && near(bottom[k], 3, 1000.0), "{time}: {} {}", force[k], bottom[k]);
    }
}

/// A curve that is wider than the soil moves as a whole, so the grid beside the soil is not folded.
#[test]
fn a_curve_wider_than_the_soil_is_moved_as_a_whole() {
    let press = "{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.05}, prescribe: {top: {uy: {rate: -0.8}}}}";
    let folder = scene(6.0, press);
    run(folder.path(), &[]);
    assert!(resets(folder.path()) > 0);
    let (way, top) =
        (column(&folder.path().join("out"), "top.uy [m]"), column(&folder.path().join("out"), "top.reaction_y [kN]"));
    // Free to the side, between smooth ends: E' = E/(1 − ν²) and the width grows by λ^(−ν/(1−ν)).
    let stretch: f64 = 0.6;
    let expected = SIDE * 1000.0 / (1.0 - 0.0625) * stretch.ln() / stretch;
    assert!((way[way.len() - 1] + 0.8).abs() < 1e-12);
    assert!((top[top.len() - 1] / expected - 1.0).abs() < 0.02, "{} {expected}", top[top.len() - 1]);
}

/// What the curve has moved is what the soil that was there has, also when the grid has been reset beneath it.
#[test]
fn the_history_of_a_curve_is_that_of_its_soil() {
    let load = "{name: load, analysis: quasi_static, duration: 1, step: {initial: 0.1}, tractions: [{surface: all, ty: {rate: -800}}]}";
    let folder = scene(2.0, load);
    for restore in ["{min_quality: 0.5}", "every_step"] {
        run(folder.path(), &[HELD, &format!("numerics.restore={restore}")]);
        let out = folder.path().join("out");
        let (top, soil) = (column(&out, "top.uy [m]"), column(&out, "soil.uy [m]"));
        assert!(top[top.len() - 1] < -0.6, "{top:?}");
        for (top, soil) in top.iter().zip(soil) {
            assert!((top - 2.0 * soil).abs() < 1e-5, "{restore}: {top} {soil}");
        }
    }
}

#[test]
fn schemes_that_keep_the_grid_refuse_to_move_a_curve_of_it() {
    let press = "{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.1}, prescribe: {top: {uy: {rate: -0.4}}}}";
    let folder = scene(2.0, press);
    let geo = "SetFactory(\"OpenCASCADE\");\nRectangle(1) = {0, 0, 0, 2, 2};\nTransfinite Curve{:} = 5;\nTransfinite Surface{:};\n\
        Recombine Surface{:};\nPhysical Surface(\"soil\") = {1};\nPhysical Curve(\"bottom\") = {1};\nPhysical Curve(\"top\") = {3};\n\
        Physical Curve(\"side\") = {4};\n";
    fs::write(folder.path().join("m.geo"), geo).unwrap();
    let set = ["regions={soil: {kind: mpm, material: soil}}", "numerics.gradient=bspline"];
    let output = mpm("run", folder.path(), &folder.path().join("out"), &set);
    let text = errors(&output);
    assert_eq!(output.status.code(), Some(2), "{text}");
    for words in ["the curve `top` that phase `press` moves", "needs a grid that keeps its shape", "rigid structure"] {
        assert!(text.contains(words), "{words:?}: {text}");
    }
    run(folder.path(), &[set[0], set[1], "numerics.restore=never"]);
}

/// What acts in one place, and soil that leaves it, is told at that moment.
#[test]
fn a_load_and_a_held_curve_that_soil_leaves_are_told() {
    let load = "{name: load, analysis: quasi_static, duration: 1, step: {initial: 0.1}, tractions: [{surface: all, ty: {rate: -800}BOX}]}";
    for (within, supports, words) in [
        (
            ", where: {y: [1.7, 2.1]}",
            "top: {}",
            "the load on the surface in y from 1.7 to 2.1 m acts on 0.000 m of it, and acted on 2.000 m",
        ),
        ("", "top: {ux: 0}", "soil has left the curve near"),
    ] {
        let folder = scene(2.0, &load.replace("BOX", within));
        let supports = match supports {
            "top: {}" => HELD.to_owned(),
            top => HELD.replace("}}", &format!("}}, {top}}}")),
        };
        let text = said(&run(folder.path(), &[&supports]));
        let told: Vec<&str> = text.lines().filter(|line| line.contains(words)).collect();
        // At that moment, once.
        assert_eq!(told.len(), 1, "{text}");
        assert!(told.iter().all(|line| line.starts_with("warning: phase `load`: ")), "{text}");
    }
}

/// A traction is one per area: where the surface becomes longer there is more of it, which is told.
#[test]
fn a_load_on_a_surface_that_grows_is_told() {
    let pull = "{name: pull, analysis: quasi_static, duration: 1, step: {initial: 0.1}, prescribe: {other: {ux: {rate: 0.8}}}, \
        tractions: [{surface: all, LOAD, where: {y: [1.9, 2.2]}}]}";
    for (load, tells) in [("ty: -1", true), ("pressure: 1", false)] {
        let folder = scene(4.0, &pull.replace("LOAD", load));
        let text = said(&run(folder.path(), &["materials.soil.poisson=0"]));
        let told: Vec<&str> = text.lines().filter(|line| line.contains("acts there, too")).collect();
        assert_eq!(!told.is_empty(), tells, "{load}: {text}");
    }
}
