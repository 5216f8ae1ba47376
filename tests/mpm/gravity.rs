//! Gravity by component, through the program: a horizontal acceleration on soil, as in pseudo-static analyses.

use crate::support::{column, in_folder, said, solve_text, written};
use mpm::io::frame::{self, Frame};
use std::path::Path;

/// A strip of rock, 2 m wide and 4 m high, of 2 t/m³ on a rough floor, whose sides have what `sides` says.
fn strip(sides: &str, phases: &str) -> String {
    format!(
        "geometry: plane_strain\n\
         mesh: {{geo: GEO/slump.geo, parameters: {{half_width: 2, height: 4, room: 0, h: 0.5, quads: 1}}}}\n\
         regions: {{block: {{kind: mpm, material: rock}}}}\n\
         materials: {{rock: {{model: linear_elastic, young: 1.0e+7, poisson: 0, density: 2}}}}\n\
         supports: {{bottom: {{ux: 0, uy: 0}}{sides}}}\ngravity: {{y: -10}}\nnumerics: {{restore: never}}\nphases: [{phases}]\n\
         output: {{history: [{{name: bottom, on: bottom, quantities: [reaction_x, reaction_y]}}]}}\n"
    )
}

fn phase(name: &str, gravity: &str) -> String {
    format!("{{name: {name}, analysis: quasi_static, duration: 1, step: {{initial: 0.5}}, gravity: {gravity}}}")
}

fn reaction(folder: &Path) -> [f64; 2] {
    ["x", "y"].map(|axis| *column(folder, &format!("bottom.reaction_{axis} [kN]")).last().unwrap())
}

/// Between sides on which nothing moves up or down, the strip is a part of a layer without ends: τ_xy = a ρ z at the depth z, and nothing else.
#[test]
fn a_layer_that_is_accelerated_has_the_shear_of_the_soil_above() {
    let folder = solve_text(&strip(", axis: {uy: 0}, face: {uy: 0}", &phase("quake", "{x: {rate: 3}, y: 0}")));
    let points = Frame::read(&frame::path(&folder.path().join("results"), 1)).unwrap().points;
    let stress = points.columns.iter().find(|column| column.name == "stress").unwrap();
    for (x, stress) in points.position.iter().zip(stress.values.chunks(6)) {
        let shear = 3.0 * 2.0 * (4.0 - x[1]);
        // Displacements of 5e-6 of the height, to which the shape changes.
        let error = (stress[3] - shear).abs().max(stress[..3].iter().fold(0.0, |e: f64, s| e.max(s.abs())));
        assert!(error < 1e-3, "{x:?}: {stress:?} of {shear}");
    }
    let [x, _] = reaction(folder.path());
    assert!((x + 48.0).abs() < 1e-3, "{x}");
}

/// A strip with free sides: the floor bears all of its weight and of the horizontal force, in one phase, in two, by tables and from the other side.
#[test]
fn phases_that_split_an_acceleration_give_the_same() {
    let weight = phase("weight", "{rate: 1}");
    let of = |phases: String| reaction(solve_text(&strip("", &phases)).path());
    let one = of(format!("{weight}, {}", phase("quake", "{x: {rate: 2}}")));
    let two = [phase("half", "{x: {rate: 1}}"), phase("rest", "{x: {table: [[0, 1], [1, 2]]}, y: -10}")];
    let two = of(format!("{weight}, {}", two.join(", ")));
    let mirrored = of(format!("{weight}, {}", phase("quake", "{x: {rate: -2}, y: -10}")));
    println!("{one:?} {two:?} {mirrored:?}");
    for (d, exact) in [-32.0, 160.0].into_iter().enumerate() {
        assert!((one[d] - exact).abs() < 1e-5, "{one:?}");
        assert!((two[d] - one[d]).abs() < 1e-5, "{two:?}");
        assert!((mirrored[d] - [-one[0], one[1]][d]).abs() < 1e-5, "{mirrored:?}");
    }
    // A phase that says nothing goes back to the gravity of the case.
    let after = of(format!("{}, {}", phase("quake", "{x: 2}"), phase("after", "1")));
    assert!(after[0].abs() < 1e-5 && (after[1] - 160.0).abs() < 1e-5, "{after:?}");
}

#[test]
fn components_that_cannot_be_meant_are_refused() {
    for (gravity, told) in [
        (
            "{x: 1, y: 1}",
            ["`y` is an acceleration in m/s²", "comes to 1, against the -10 of the case", "write `y: -10`"],
        ),
        ("{y: {table: [[0, -10], [1, 5]]}}", ["`y` is an acceleration in m/s²", "comes to 5", "`gravity: 1`"]),
        ("{}", ["gravity", "gravity has no component", "add `x: …` or `y: …`"]),
        ("{z: 1}", ["z", "gravity", "`x`"]),
    ] {
        let folder = written(&strip("", &phase("quake", gravity)));
        let output = in_folder(folder.path(), &["check", "."]);
        let said = said(&output);
        assert!(!output.status.success() && told.iter().all(|told| said.contains(told)), "{gravity}: {said}");
    }
    let folder = written(&strip("", &phase("quake", "{x: 1}")).replace("gravity: {y: -10}\n", ""));
    let told = said(&in_folder(folder.path(), &["check", "."]));
    assert!(told.contains("the case has no gravity that a phase could change"), "{told}");
}
