//! Forces at points, through the program: Flamant's and Boussinesq's solutions, and force and moment on rigid bodies.

use crate::support::{column, in_folder, mpm, said, succeeds};
use mpm::io::frame::{self, Frame};
use std::f64::consts::{PI, TAU};
use std::fs;
use tempfile::TempDir;

/// A quarter of a disc of 1 m around the point of the load, below y = 0; the last of its axis holds it.
const GEO: &str = r#"Point(1) = {0, 0, 0, 0.01};  Point(2) = {1, 0, 0, 0.05};  Point(3) = {0, -1, 0, 0.05};  Point(4) = {0, -0.9, 0, 0.05};
Line(1) = {1, 2};  Circle(2) = {2, 1, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};  Plane Surface(1) = {1};
Physical Surface("soil") = {1};
Physical Curve("arc") = {2};  Physical Curve("axis") = {3, 4};  Physical Curve("foot") = {3};  Physical Point("P") = {1};
"#;

fn written(geo: &str, case: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("scene.geo"), geo).unwrap();
    fs::write(folder.path().join("case.yaml"), case).unwrap();
    folder
}

fn solved(geo: &str, case: &str) -> TempDir {
    let folder = written(geo, case);
    for stage in ["mesh", "seed", "solve"] {
        succeeds(&mpm(stage, folder.path(), folder.path(), &[]));
    }
    folder
}

/// The largest error of the radial stress between 0.25 m and 0.75 m from the load, over the largest stress at that distance, where the exact one is
/// `factor` times the cosine of the angle from the axis over the distance to the `power`. The pressure on the arc, which grows with depth, is that
/// of the solution.
fn error_of(geometry: &str, kind: &str, poisson: f64, force: f64, factor: f64, power: i32) -> [f64; 2] {
    let folder = solved(
        GEO,
        &format!(
            "geometry: {geometry}\nmesh: {{geo: scene.geo}}\nregions: {{soil: {{kind: {kind}, material: rock}}}}\n\
             materials: {{rock: {{model: linear_elastic, young: 1.0e+7, poisson: {poisson}, density: 0}}}}\n\
             supports: {{axis: {{ux: 0}}, foot: {{uy: 0}}}}\nnumerics: {{restore: never}}\n\
             phases: [{{name: load, analysis: quasi_static, duration: 1, step: {{initial: 1}}, tractions: [\
               {{on: P, fy: {{rate: -{force}}}}}, {{on: arc, pressure: {{top: 0, gradient: {factor}}}}}]}}]\n\
             output: {{history: [{{name: foot, on: foot, quantities: [reaction_y]}}]}}\n"
        ),
    );
    let frame = Frame::read(&frame::path(&folder.path().join("results"), 1)).unwrap();
    let part = if kind == "mpm" { &frame.points } else { &frame.elements };
    let stress = &part.columns.iter().find(|column| column.name == "stress").unwrap().values;
    let mut largest = 0.0f64;
    for (x, s) in part.position.iter().zip(stress.chunks(6)) {
        let r = x[0].hypot(x[1]);
        // The foot is held along a tenth of the axis.
        if (0.25..0.75).contains(&r) {
            let [nx, ny] = [x[0] / r, x[1] / r];
            let radial = nx * nx * s[0] + ny * ny * s[1] + 2.0 * nx * ny * s[3];
            let exact = factor * ny / r.powi(power);
            largest = largest.max((radial - exact).abs() * r.powi(power) / factor);
        }
    }
    [largest, column(folder.path(), "foot.reaction_y [kN]")[0] / force]
}

/// Half of a load P on the symmetric half: σ_r = −2 P cos θ / (π r), whatever Poisson's ratio.
#[test]
fn a_line_load_has_the_stress_of_flamant() {
    for kind in ["mpm", "fem"] {
        let [error, reaction] = error_of("plane_strain", kind, 0.3, 10.0, 2.0 * 20.0 / PI, 1);
        println!("{kind}: {error:.2e} {reaction:.2e}");
        assert!(error < 0.02 && reaction.abs() < 1e-3, "{kind}: {error} {reaction}");
    }
}

/// On the axis of symmetry the force is that of the whole turn; nearly without change of volume σ_R = −3 P cos θ / (2 π R²).
#[test]
fn a_point_load_has_the_stress_of_boussinesq() {
    let [error, reaction] = error_of("axisymmetric", "mpm", 0.4999, 10.0, 3.0 * 10.0 / TAU, 2);
    println!("{error:.2e} {reaction:.2e}");
    assert!(error < 0.02 && reaction.abs() < 1e-3, "{error} {reaction}");
}

const BLOCK: &str = r#"Point(1) = {1, 0, 0, 0.5};  Point(2) = {2, 0, 0, 0.5};  Point(3) = {2, 1, 0, 0.5};  Point(4) = {1, 1, 0, 0.5};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};  Plane Surface(1) = {1};
Physical Surface("block") = {1};  Physical Curve("bottom") = {1};  Physical Curve("top") = {3};  Physical Point("P") = {3};  Physical Point("Q") = {1};
Point(5) = {-3, -3, 0, 2};  Point(6) = {6, -3, 0, 2};  Point(7) = {6, 6, 0, 2};  Point(8) = {-3, 6, 0, 2};
Line(5) = {5, 6};  Line(6) = {6, 7};  Line(7) = {7, 8};  Line(8) = {8, 5};
Curve Loop(2) = {5, 6, 7, 8};  Plane Surface(2) = {2};  Physical Surface("air") = {2};
"#;

fn block(kind: &str, entries: &str, loads: &str) -> String {
    format!(
        "geometry: plane_strain\nmesh: {{geo: scene.geo}}\nregions: {{block: {{{kind}, material: rock}}, air: {{kind: buffer}}}}\n\
         materials: {{rock: {{model: linear_elastic, young: 1.0e+9, poisson: 0.3, density: 0}}}}\n\
         {entries}\nphases: [{{name: load, analysis: quasi_static, duration: 1, step: {{initial: 0.25}}, {loads}}}]\n"
    )
}

/// The force at a corner keeps its direction as the body turns, its moment follows the corner; a structure that deforms hands on all of it.
#[test]
fn structures_bear_the_force_and_its_moment() {
    let history = "output: {history: [{name: b, on: block, quantities: [reaction_x, reaction_y, reaction_moment]}]}";
    let names = ["b.reaction_x [kN]", "b.reaction_y [kN]", "b.reaction_moment [kN m]"];
    let load = "tractions: [{on: P, fx: 3, fy: {table: [[0, 0], [1, -4]]}}, {on: Q, fx: 1}]";
    for (turn, moment) in [
        // (½, ½) × (3, −4) and (−½, −½) × (1, 0).
        ("0", -0.5 * 4.0 - 0.5 * 3.0 + 0.5),
        // A quarter of a turn takes the corners to (−½, ½) and (½, −½).
        ("{rate: 1.5707963267948966}", 0.5 * 4.0 - 0.5 * 3.0 + 0.5),
    ] {
        let prescribe = format!("{load}, prescribe: {{block: {{ux: 0, uy: 0, rotation: {turn}}}}}");
        let folder = solved(BLOCK, &block("kind: structure, rigid: true", history, &prescribe));
        let found = names.map(|name| *column(folder.path(), name).last().unwrap());
        let exact = [-4.0, 4.0, -moment];
        assert!((0..3).all(|d| (found[d] - exact[d]).abs() < 1e-12), "{turn}: {found:?} of {exact:?}");
    }
    let held = "supports: {bottom: {ux: 0, uy: 0}}\noutput: {history: [{name: b, on: bottom, quantities: [reaction_x, reaction_y]}]}";
    let folder = solved(BLOCK, &block("kind: structure", held, "tractions: [{on: P, fx: 3, fy: -4}]"));
    let found = ["x", "y"].map(|axis| *column(folder.path(), &format!("b.reaction_{axis} [kN]")).last().unwrap());
    assert!((found[0] + 3.0).abs() < 1e-6 && (found[1] - 4.0).abs() < 1e-6, "{found:?}");
}

#[test]
fn forces_that_have_no_place_are_told() {
    let held = "supports: {bottom: {ux: 0, uy: 0}}";
    for (load, told) in [
        ("{on: P, ty: -10}", "`P` is a physical point, and a traction acts on a curve; give `fx` and `fy`"),
        ("{on: top, fy: -10}", "`top` is a physical curve, and a force acts at a point; give `tx` and `ty` (kPa)"),
        ("{on: R, fy: -10}", "has no physical point `R`"),
        ("{on: P, fy: -10, pressure: 3}", "a force at a point does not have this"),
        ("{surface: all, fy: -10}", "a force acts at a point; name a physical point with `on`"),
        ("{on: Q, fx: 1}", "`fx` at `Q` does nothing: the point is held or moved in that direction"),
        ("{on: P, fx: 1}, {on: P, fx: 1}", "the load on `P` is given twice"),
        ("{on: P, fx: {table: [[0, 0], [2, 5]]}}", "the table of `fx` at `P` goes to 2 s"),
    ] {
        let folder = written(BLOCK, &block("kind: structure", held, &format!("tractions: [{load}]")));
        let said = said(&in_folder(folder.path(), &["check", "."]));
        assert!(said.contains(told), "{load}: {said}");
    }
    let away = BLOCK.replace("Physical Point(\"Q\") = {1}", "Physical Point(\"Q\") = {5}");
    let folder = written(&away, &block("kind: structure", held, "tractions: [{on: Q, fy: -1}]"));
    let said = said(&in_folder(folder.path(), &["check", "."]));
    assert!(said.contains("there is no soil and no structure at the point"), "{said}");
}

/// A bar of soil that bends under a force at its end: on a grid that is reset the force stays with the soil, within it and at its surface.
#[test]
fn a_force_follows_the_soil_through_grid_resets() {
    let geo = r#"Point(1) = {0, 0, 0, 0.25};  Point(2) = {4, 0, 0, 0.25};  Point(3) = {4, 0.5, 0, 0.25};  Point(4) = {4, 1, 0, 0.25};  Point(5) = {0, 1, 0, 0.25};
Point(6) = {0, -3, 0, 0.25};  Point(7) = {5, -3, 0, 0.25};  Point(8) = {5, 1.5, 0, 0.25};  Point(9) = {0, 1.5, 0, 0.25};
Line(1) = {1, 2};  Line(2) = {2, 3};  Line(3) = {3, 4};  Line(4) = {4, 5};  Line(5) = {5, 1};
Line(6) = {1, 6};  Line(7) = {6, 7};  Line(8) = {7, 8};  Line(9) = {8, 9};  Line(10) = {9, 5};
Curve Loop(1) = {1, 2, 3, 4, 5};  Plane Surface(1) = {1};
Curve Loop(2) = {6, 7, 8, 9, 10, -4, -3, -2, -1};  Plane Surface(2) = {2};
Physical Surface("bar") = {1};  Physical Surface("air") = {2};  Physical Curve("end") = {5};  Physical Point("P") = {3};  Physical Point("Q") = {4};
"#;
    let run = |restore: &str, point: &str| {
        let case = format!(
            "geometry: plane_strain\nmesh: {{geo: scene.geo}}\nregions: {{bar: {{kind: mpm, material: rock}}, air: {{kind: buffer}}}}\n\
             materials: {{rock: {{model: linear_elastic, young: 1000, poisson: 0.2, density: 0}}}}\n\
             supports: {{end: {{ux: 0, uy: 0}}}}\nnumerics: {{restore: {restore}}}\n\
             phases: [{{name: load, analysis: quasi_static, duration: 1, step: {{initial: 0.1}}, tractions: [{{on: {point}, fy: {{rate: -4}}}}]}}]\n\
             output: {{history: [{{name: p, on: {point}, quantities: [ux, uy]}}, {{name: end, on: end, quantities: [reaction_x, reaction_y]}}]}}\n"
        );
        let folder = solved(geo, &case);
        ["p.ux [m]", "p.uy [m]", "end.reaction_x [kN]", "end.reaction_y [kN]"]
            .map(|name| *column(folder.path(), name).last().unwrap())
    };
    for point in ["P", "Q"] {
        let [moving, reset] = ["never", "every_step"].map(|restore| run(restore, point));
        println!("{point}: {moving:?} {reset:?}");
        assert!(moving[1] < -0.5, "{moving:?}");
        assert!((0..2).all(|d| (reset[d] - moving[d]).abs() < 0.03 * moving[1].abs()), "{moving:?} {reset:?}");
        assert!(reset[2].abs() < 1e-4 && (reset[3] - 4.0).abs() < 1e-4, "{reset:?}");
    }
}
