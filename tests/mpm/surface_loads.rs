//! Loads on the surface of soil, through the program: what a block that is loaded at its side hands on to the ground, by sign and size.

use crate::support::{column, solve_text};

/// The force (kN/m, or kN over a turn) of the ground on a stiff square metre of soil that stands on it, and whose right side alone is free.
fn reaction(geometry: &str, load: &str) -> [f64; 2] {
    let folder = solve_text(&format!(
        "geometry: {geometry}\n\
         mesh: {{geo: GEO/slump.geo, parameters: {{half_width: 1, height: 1, room: 0.5, h: 0.125}}}}\n\
         regions: {{block: {{kind: mpm, material: rock}}, room: {{kind: buffer}}}}\n\
         materials: {{rock: {{model: linear_elastic, young: 1.0e+7, poisson: 0.2, density: 0}}}}\n\
         supports: {{bottom: {{ux: 0, uy: 0}}}}\n\
         numerics: {{restore: every_step}}\n\
         phases: [{{name: load, analysis: quasi_static, duration: 1, step: {{initial: 1}}, tractions: [{{surface: block, {load}}}]}}]\n\
         output: {{history: [{{name: bottom, on: bottom, quantities: [reaction_x, reaction_y]}}]}}\n"
    ));
    ["bottom.reaction_x [kN]", "bottom.reaction_y [kN]"].map(|name| column(folder.path(), name)[0])
}

/// At the side, 1 m high: pressure pushes it to the left, shear goes up, where the soil is on the left, and tractions go where they point; over as
/// much of the side as is in the box. The ground bears the opposite.
#[test]
fn loads_on_a_side_have_their_sign_and_size() {
    let part = "where: {y: [0.3, 0.8]}";
    for (load, [x, y]) in [
        ("shear: 2".to_owned(), [0.0, 2.0]),
        (format!("shear: {{rate: 2}}, {part}"), [0.0, 1.0]),
        (format!("shear: -2, {part}"), [0.0, -1.0]),
        (format!("pressure: 4, {part}"), [-2.0, 0.0]),
        ("tx: -3, ty: {table: [[0, 0], [1, 5]]}".to_owned(), [-3.0, 5.0]),
        (format!("tx: -3, ty: 5, {part}"), [-1.5, 2.5]),
        ("tx: -3, ty: 5, where: {x: [0.9, 1.1], y: [0.9, 2]}".to_owned(), [-0.3, 0.5]),
        (format!("tx: -3, shear: 1, pressure: 4, {part}"), [-3.5, 0.5]),
        // Twice 2 kPa at 0.8 m to 7 kPa at 0.3 m.
        (format!("pressure: {{top: 1, gradient: 10, datum: 0.9}}, factor: {{rate: 2}}, {part}"), [-4.5, 0.0]),
        // Elsewhere there is no free surface.
        ("tx: -3, ty: 5, where: {x: [0.2, 0.8]}".to_owned(), [0.0, 0.0]),
    ] {
        let found = reaction("plane_strain", &load);
        println!("{load}: {found:?} of {:?}", [-x, -y]);
        assert!((found[0] + x).abs() < 1e-4 && (found[1] + y).abs() < 1e-4, "{load}: {found:?}");
    }
    // Over a turn what goes up acts on 2π m of each metre.
    let found = reaction("axisymmetric", &format!("shear: 2, ty: 3, {part}"))[1] / std::f64::consts::TAU;
    println!("of a turn: {found}");
    assert!((found + 2.5).abs() < 1e-4, "{found}");
}
