//! A limit load with quadratic B-splines: they err more at the edge of a structure than the shape functions of the same cells, and as much as
//! those of as many unknowns.

use crate::support::{rows, run};

/// The load (-) of half a rough strip on Tresca soil that is compressible, over that of Prandtl, with `fine` times ten cells over the whole width.
fn load(gradient: &str, fine: usize, depth: f64) -> f64 {
    let mesh = format!(
        "mesh.parameters={{width: 3, nx: {}, ny: {}, na: {}, plate: 0.5, hp: {}}}",
        30 * fine,
        12 * fine,
        4 * fine,
        0.05 / fine as f64
    );
    let phases = format!(
        "phases=[{{name: press, analysis: quasi_static, duration: 1, step: {{initial: 0.1}}, \
        prescribe: {{plate: {{ux: 0, rotation: 0, uy: {{rate: -{depth}}}}}}}}}]"
    );
    let folder = run(
        "tests/data/lattice",
        &[
            &format!("numerics.gradient={gradient}"),
            &mesh,
            "regions.plate.rigid=true",
            "materials.soil={model: tresca, young: 500, poisson: 0.3, shear_strength: 1, density: 0}",
            "supports.bottom={ux: 0, uy: 0}",
            "contacts[0].adhesion_factor=1",
            "output.history=[{name: plate, on: plate, quantities: [uy, contact_y]}]",
            &phases,
        ],
    );
    let load = rows(folder.path()).last().unwrap()[2] / (0.5 * (2.0 + std::f64::consts::PI));
    println!("{gradient}, {} cells over the width: {load:.3}", 10 * fine);
    load
}

#[test]
fn a_strip_on_splines_bears_too_much() {
    let [plain, fine_plain] = [1, 2].map(|fine| load("mpm", fine, 0.03));
    let [splines, fine_splines] = [1, 2].map(|fine| load("bspline", fine, 0.03));
    assert!(1.0 < fine_splines && fine_splines < splines && splines < 1.25, "{splines} {fine_splines}");
    // Of the same cells; and of cells of half the size, which have as many unknowns.
    assert!(plain < splines && fine_plain < fine_splines && fine_splines < 1.01 * plain, "{plain} {fine_plain}");
}
