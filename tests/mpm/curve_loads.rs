//! Loads on curves, through the program: what a block that is loaded at its side hands on to what holds it, by size and moment.

use crate::support::{column, in_folder, mpm, said, succeeds};
use std::fs;
use tempfile::TempDir;

/// A square metre of two halves, beside it air, and a curve within it.
const GEO: &str = r#"DefineConstant[ x = {0, Name "Parameters/x"} ];
SetFactory("OpenCASCADE");  Mesh.MeshSizeMax = 0.3;
Rectangle(1) = {x, 0, 0, 0.5, 1};  Rectangle(2) = {x + 0.5, 0, 0, 0.5, 1};  Coherence;
Physical Surface("block") = {1, 2};
Physical Curve("bottom") = Curve In BoundingBox {x - 0.1, -0.1, -1, x + 1.1, 0.1, 1};
Physical Curve("top") = Curve In BoundingBox {x - 0.1, 0.9, -1, x + 1.1, 1.1, 1};
Physical Curve("inner") = Curve In BoundingBox {x - 0.1, -0.1, -1, x + 0.1, 1.1, 1};
Physical Curve("middle") = Curve In BoundingBox {x + 0.4, -0.1, -1, x + 0.6, 1.1, 1};
Physical Curve("face") = Curve In BoundingBox {x + 0.9, -0.1, -1, x + 1.1, 1.1, 1};
Rectangle(3) = {-3, -3, 0, 9, 9};
Physical Surface("air") = {3};
"#;

/// A case of that block, 1 m from the origin, and its folder.
fn written(geometry: &str, kind: &str, entries: &str) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    let text = format!(
        "geometry: {geometry}\nmesh: {{geo: block.geo, parameters: {{x: 1}}}}\n\
         regions: {{block: {{kind: {kind}, material: rock}}, air: {{kind: buffer}}}}\n\
         materials: {{rock: {{model: linear_elastic, young: 1.0e+7, poisson: 0.3, density: 0}}}}\n{entries}\n"
    );
    // A structure lies over the grid; what is a part of the mesh lies beside it.
    let beside = GEO.replace("{-3, -3, 0, 9, 9}", "{4, 0, 0, 1, 1}");
    let geo = if kind.starts_with("structure") { GEO } else { &beside };
    fs::write(folder.path().join("block.geo"), geo).unwrap();
    fs::write(folder.path().join("case.yaml"), text).unwrap();
    folder
}

fn solve(geometry: &str, kind: &str, entries: &str) -> TempDir {
    let folder = written(geometry, kind, entries);
    for stage in ["mesh", "seed", "solve"] {
        succeeds(&mpm(stage, folder.path(), folder.path(), &[]));
    }
    folder
}

fn last<const N: usize>(folder: &TempDir, names: [&str; N]) -> [f64; N] {
    names.map(|name| *column(folder.path(), name).last().unwrap())
}

const PHASE: &str =
    "phases: [{name: load, analysis: quasi_static, duration: 1, step: {initial: 1}, tractions: [LOAD]}]";

/// Force and moment about the middle of the block, of the support of a rigid block.
fn of_rigid(load: &str) -> [f64; 3] {
    let entries = format!(
        "supports: {{block: {{ux: 0, uy: 0, rotation: 0}}}}\n{}\n\
         output: {{history: [{{name: b, on: block, quantities: [reaction_x, reaction_y, reaction_moment]}}]}}",
        PHASE.replace("LOAD", load)
    );
    let folder = solve("plane_strain", "structure, rigid: true", &entries);
    last(&folder, ["b.reaction_x [kN]", "b.reaction_y [kN]", "b.reaction_moment [kN m]"])
}

fn of_bottom(geometry: &str, kind: &str, load: &str) -> [f64; 2] {
    let numerics = if kind == "mpm" { "numerics: {restore: never}\n" } else { "" };
    let entries = format!(
        "supports: {{bottom: {{ux: 0, uy: 0}}}}\n{numerics}{}\n\
         output: {{history: [{{name: b, on: bottom, quantities: [reaction_x, reaction_y]}}]}}",
        PHASE.replace("LOAD", load)
    );
    last(&solve(geometry, kind, &entries), ["b.reaction_x [kN]", "b.reaction_y [kN]"])
}

/// On the side, on finite elements, structures and material points whose grid moves with them: what grows below a height within a cell is integrated
/// exactly, and so is its moment.
#[test]
fn profiles_on_a_side_have_their_force_and_moment() {
    // 1 + 10 ⟨0.9 − y⟩ pushes to the left; 2 − 4 ⟨0.7 − y⟩ pulls to the right.
    for (load, force, moment) in [
        ("{on: face, pressure: {top: 1, gradient: 10, datum: 0.9}}", [-5.05, 0.0], -0.81),
        ("{on: face, pressure: {top: 2, gradient: 20, datum: 0.9}, factor: {rate: 0.5}}", [-5.05, 0.0], -0.81),
        ("{on: face, tx: {top: 2, gradient: -4, datum: 0.7}}", [1.02, 0.0], -0.98 / 3.75),
        ("{on: face, ty: {top: 2, gradient: -4, datum: 0.7}}", [0.0, 1.02], 0.51),
        ("{on: face, tx: {along: y, values: [[0, -0.8], [0.7, 2], [9, 2]]}}", [1.02, 0.0], -0.98 / 3.75),
        ("{on: face, ty: {along: y, values: [[0, -0.4], [0.7, 1]]}, factor: {rate: 2}}", [0.0, 1.02], 0.51),
        ("{on: face, tx: \"2*t - 12*y^2*sin(pi*t/2)\"}", [-2.0, 0.0], 1.0),
        ("{on: top, pressure: {rate: 4}, tx: 3}", [3.0, -4.0], -1.5),
    ] {
        let rigid = of_rigid(load);
        // ∫ (y − 1/2) p of the pressure: 10 (0.9³/6 − 0.9²/4).
        let moment =
            if load.contains("pressure: {top") { 10.0 * (0.9f64.powi(3) / 6.0 - 0.9f64.powi(2) / 4.0) } else { moment };
        println!("{load}: {rigid:?}");
        for (found, exact) in rigid.iter().zip([force[0], force[1], moment]) {
            assert!((found + exact).abs() < 1e-12, "{load}: {rigid:?} of {force:?} {moment}");
        }
        for kind in ["fem", "structure", "mpm"] {
            let found = of_bottom("plane_strain", kind, load);
            assert!((0..2).all(|d| (found[d] + force[d]).abs() < 1e-5), "{load}, {kind}: {found:?}");
        }
    }
    // Over a turn the face at the radius 2 m has 4π m of each metre.
    let found = of_bottom("axisymmetric", "mpm", "{on: face, ty: {top: 2, gradient: -4, datum: 0.7}}")[1];
    assert!((found / (2.0 * std::f64::consts::TAU) + 1.02).abs() < 1e-6, "{found}");
}

/// Lamé: a ring from 1 m to 2 m under a pressure inside and another outside, between smooth plates.
#[test]
fn a_thick_cylinder_widens_as_lame_says() {
    let entries = format!(
        "supports: {{bottom: {{uy: 0}}, top: {{uy: 0}}}}\nnumerics: {{restore: never}}\n{}\n\
         output: {{history: [{{name: inner, on: inner, quantities: [ux]}}]}}",
        PHASE.replace("LOAD", "{on: inner, pressure: 100}, {on: face, pressure: {top: 20, gradient: 0}}")
    );
    let found = last(&solve("axisymmetric", "mpm", &entries), ["inner.ux [m]"])[0];
    let (inside, outside, ratio) = (100.0, 20.0, 0.3);
    let [a, b] = [(inside - 4.0 * outside) / 3.0, 4.0 * (inside - outside) / 3.0];
    let exact = (1.0 + ratio) / 1.0e7 * (a * (1.0 - 2.0 * ratio) + b);
    println!("{found:e} of {exact:e}");
    // Cells of 0.3 m.
    assert!((found / exact - 1.0).abs() < 3e-3, "{found:e} of {exact:e}");
}

/// A pressure turns with the side that it acts on; a traction does not.
#[test]
fn a_pressure_follows_its_curve() {
    let turned = |load: &str| {
        let entries = format!(
            "phases: [{{name: turn, analysis: quasi_static, duration: 1, step: {{initial: 0.25}}, tractions: [{load}], \
             prescribe: {{block: {{ux: 0, uy: 0, rotation: {{rate: 1.5707963267948966}}}}}}}}]\n\
             output: {{history: [{{name: b, on: block, quantities: [reaction_x, reaction_y, reaction_moment]}}]}}"
        );
        let folder = solve("plane_strain", "structure, rigid: true", &entries);
        last(&folder, ["b.reaction_x [kN]", "b.reaction_y [kN]", "b.reaction_moment [kN m]"])
    };
    // The face has become the top: pushed down at the middle, and its traction to the right acts half a metre above that.
    for (load, exact) in [("{on: face, pressure: 3}", [0.0, 3.0, 0.0]), ("{on: face, tx: 3}", [-3.0, 0.0, 1.5])] {
        let found = turned(load);
        println!("{load}: {found:?}");
        assert!((0..3).all(|d| (found[d] - exact[d]).abs() < 1e-12), "{load}: {found:?}");
    }
}

#[test]
fn loads_on_curves_that_do_nothing_or_have_two_sides_are_told() {
    for (supports, load, told) in [
        (
            "bottom: {ux: 0, uy: 0}",
            "{on: middle, pressure: 3}",
            "on both sides of the curve, and a pressure acts on one; load a curve on the boundary",
        ),
        (
            "bottom: {uy: 0}, inner: {ux: 0}",
            "{on: inner, pressure: 3}",
            "the pressure on `inner` does nothing to the soil",
        ),
        (
            "bottom: {uy: 0}",
            "{on: face, shear: 3}",
            "a load on a curve does not have this; give `pressure`, `tx` and `ty`",
        ),
        ("bottom: {uy: 0}", "{on: face, pressure: 3, factor: 2}", "a factor is for a load that varies with depth"),
        ("bottom: {uy: 0}", "{on: face, tx: {top: 1, gradient: -1, least: 0}}", "a traction has no least value"),
        ("bottom: {uy: 0}", "{on: face, pressure: {top: 1, gradient: -1}}", "gradient"),
        ("bottom: {uy: 0}", "{on: face, pressure: \"2*y\"}", "a pressure varies in time or with depth alone"),
        (
            "bottom: {uy: 0}",
            "{on: face, tx: \"2*z\"}",
            "the formula has a mistake: it names `z`; known are x, y, t, pi",
        ),
        ("bottom: {uy: 0}", "{on: face, tx: \"ln(y - 2)\"}", "its value at"),
        (
            "bottom: {uy: 0}",
            "{on: face, tx: {along: y, values: [[1, 2], [0, 3]]}}",
            "the coordinate 0 does not come after 1",
        ),
        (
            "bottom: {uy: 0}",
            "{surface: all, tx: {top: 1, gradient: -1}}",
            "a traction in a fixed direction does not vary from place to place",
        ),
    ] {
        let entries =
            format!("supports: {{{supports}}}\nnumerics: {{restore: never}}\n{}", PHASE.replace("LOAD", load));
        let folder = written("plane_strain", "mpm", &entries);
        let said = said(&in_folder(folder.path(), &["check", "."]));
        assert!(said.contains(told), "{load}: {said}");
    }
}
