//! Soil that is held across curves of any direction, through the program.

use crate::support::{column, errors, in_folder, project, said, solve};
use mpm::io::frame::{self, Frame};

/// Sizes of cells (m), two of which the ends of the contacts spoil: where the soil ends along a wall.
const SPOILT: f64 = 2.0 * 0.25;

const BLOCK: &str = "tests/data/rollers";
/// As the files have them: length, height (m), unit weight (kN/m³) and angle (degrees).
const LENGTH: f64 = 3.0;
const HEIGHT: f64 = 1.0;
const WEIGHT: f64 = 18.0;
const ANGLE: f64 = 20.0;

/// What the block does, by its own axes (along the incline and across): the mean displacement (m), the forces of the base and of the end (kN), and how far the
/// stress is off that of the closed form (kPa) but for where the soil ends along the curves, given the angle (degrees) that the scene is turned by, with gravity, and whether it is mirrored.
fn block(turned: f64, mirrored: bool, more: &[&str]) -> ([[f64; 2]; 3], f64) {
    let (sin, cos) = turned.to_radians().sin_cos();
    let side = if mirrored { -1.0 } else { 1.0 };
    let folder = solve(
        BLOCK,
        &[
            &[
                format!("mesh.parameters={{angle: {}, mirrored: {}}}", ANGLE + turned, u8::from(mirrored)).as_str(),
                &format!("gravity={{x: {}, y: {}}}", side * 9.81 * sin, -9.81 * cos),
            ],
            more,
        ]
        .concat(),
    );
    let (s, c) = (ANGLE + turned).to_radians().sin_cos();
    let [along, across] = [[side * c, s], [-side * s, c]];
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    let seen = |x: [f64; 2]| [dot(x, along), dot(x, across)];
    let of = |on: &str, what: &str, unit: &str| {
        seen(["x", "y"].map(|d| column(folder.path(), &format!("{on}.{what}{d} [{unit}]")).pop().unwrap()))
    };
    let results = folder.path().join("results");
    let last = frame::list(&results).unwrap().len() - 1;
    let read = Frame::read(&frame::path(&results, last)).unwrap();
    let (s, c) = ANGLE.to_radians().sin_cos();
    let mut off = 0.0f64;
    for part in [&read.points, &read.elements] {
        let stress = part.numbers("stress", 6).unwrap_or(&[]).chunks_exact(6);
        for (x, stress) in part.position.iter().zip(stress) {
            let [a, b] = seen([x[0], x[1]]);
            let apart = [[0.0, HEIGHT], [LENGTH, 0.0]].map(|[c, d]| (a - c).hypot(b - d));
            if apart.iter().any(|apart| *apart < SPOILT) {
                continue;
            }
            let on = |n: [f64; 2]| seen([dot([stress[0], stress[3]], n), dot([stress[3], stress[1]], n)]);
            let ([aa, ab], [_, bb]) = (on(along), on(across));
            let exact = [-WEIGHT * s * (LENGTH - a), 0.0, -WEIGHT * c * (HEIGHT - b)];
            off = [aa, ab, bb].iter().zip(exact).map(|(is, exact)| (is - exact).abs()).fold(off, f64::max);
        }
    }
    ([of("soil", "u", "m"), of("base", "reaction_", "kN"), of("end", "reaction_", "kN")], off)
}

/// With ν = 0 the block is strained along both of its axes by what is above: `σ_a = −γ sin β (L − a)`, `σ_b = −γ cos β (H − b)` and no shear, which
/// cells of second order represent but for finite strains, of the order of 1e-4.
#[test]
fn a_block_on_an_incline_bears_its_weight_along_both_axes() {
    let (sin, cos) = ANGLE.to_radians().sin_cos();
    let weight = WEIGHT * LENGTH * HEIGHT;
    for kind in ["mpm", "fem"] {
        let kind = format!("regions.soil.kind={kind}");
        let ([moved, base, end], off) = block(0.0, false, &[&kind]);
        println!("{kind}: {moved:?} {base:?} {end:?}, stress off by {off:.1e} kPa");
        assert!(base[0].abs() < 1e-6 * weight && (base[1] / (weight * cos) - 1.0).abs() < 1e-6, "{base:?}");
        assert!((end[0] / (weight * sin) - 1.0).abs() < 1e-6 && end[1].abs() < 1e-6 * weight, "{end:?}");
        assert!(off < 0.01 * WEIGHT, "{off}");
        // The mean of γ sin β (L a − a²/2)/E over the length, and of the same across.
        let way = |sine: f64, size: f64| -WEIGHT * sine * size * size / 3.0 / 5e5;
        let exact = [way(sin, LENGTH), way(cos, HEIGHT)];
        assert!((0..2).all(|d| (moved[d] / exact[d] - 1.0).abs() < 2e-3), "{moved:?}, not {exact:?}");
    }
}

#[test]
fn the_scene_turned_and_mirrored_is_the_same() {
    let (first, _) = block(0.0, false, &[]);
    for (turned, mirrored) in [(37.0, false), (0.0, true), (-20.0, false), (155.0, true)] {
        let (other, off) = block(turned, mirrored, &[]);
        println!("turned by {turned}, mirrored {mirrored}: {other:?}, off by {off:.1e} kPa");
        assert!(off < 0.01 * WEIGHT, "{turned} {mirrored}: {off}");
        for (k, size) in [first[0][0].abs(), 50.0, 50.0].into_iter().enumerate() {
            let differ = (0..2).map(|d| (first[k][d] - other[k][d]).abs()).fold(0.0, f64::max);
            assert!(differ < 1e-3 * size, "{turned} {mirrored}: {first:?} {other:?}");
        }
    }
}

/// Along a level base and an upright end they hold as `uy: 0` and `ux: 0` do, also a load that pulls.
#[test]
fn rollers_along_the_axes_are_supports_of_a_component() {
    let history = "output.history=[{name: soil, on: soil, quantities: [ux, uy]}, {name: base, on: base, quantities: [reaction_x, reaction_y]}, \
        {name: end, on: end, quantities: [reaction_x, reaction_y]}]";
    let run = |supports: &str| block(-ANGLE, false, &[supports, "gravity={y: 9.81}", history]).0;
    let [un, plain] =
        ["{base: {un: 0}, end: {un: 0}}", "{base: {uy: 0}, end: {ux: 0}}"].map(|held| run(&format!("supports={held}")));
    println!("{un:?} {plain:?}");
    assert!(un[0][1] > 0.0 && (un[0][1] / plain[0][1] - 1.0).abs() < 1e-3, "{un:?} {plain:?}");
    assert!((un[1][1] / plain[1][1] - 1.0).abs() < 1e-6 && un[1][1] < 0.0, "{un:?} {plain:?}");
}

#[test]
fn what_does_not_go_with_it_is_refused() {
    let folder = project(BLOCK);
    for (set, found) in [
        ("supports.base={un: 0, ux: 0}", "holds the soil across the curve alone"),
        ("supports.base={un: 1}", "a support does not move"),
        ("supports.soil={un: 0}", "a region has no direction"),
        ("supports.bse={un: 0}", "physical curve `bse`"),
        ("supports.base={}", "nothing is held"),
        ("contacts=[{wall: base}]", "is a wall of `contacts`, too"),
        ("phases[0].prescribe={base: {ux: 0}}", "has `un: 0` under `supports`"),
        ("mesh.order=3", "first and second order only"),
    ] {
        let output = in_folder(&folder, &["check", ".", "--set", set]);
        assert!(!output.status.success() && errors(&output).contains(found), "{set}: {}", said(&output));
    }
}
