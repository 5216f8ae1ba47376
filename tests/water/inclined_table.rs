//! A water table that is a line: against that of one height, the closed form of the infinite slope, and its mirror image, through the program.

use crate::support::{column, errors, in_folder, project, said, solve};
use mpm::io::frame::{self, Frame};
use std::path::Path;

const SLOPE: &str = "tests/data/long_slope";
/// As the files have them.
const TAN: f64 = 0.25;
const DEEP: f64 = 4.0;
const LENGTH: f64 = 48.0;
const WEIGHT: f64 = 20.0;
const WATER: f64 = 10.0;

/// The place (m) and the stress (kPa) of each point of the last frame of a run.
fn stresses(folder: &Path) -> Vec<([f64; 2], [f64; 4])> {
    let results = folder.join("results");
    let last = frame::list(&results).unwrap().len() - 1;
    let read = Frame::read(&frame::path(&results, last)).unwrap();
    [&read.points, &read.elements]
        .into_iter()
        .flat_map(|part| {
            let stress = part.numbers("stress", 6).unwrap_or(&[]).chunks_exact(6);
            part.position.iter().zip(stress).map(|(x, s)| ([x[0], x[1]], [s[0], s[1], s[2], s[3]])).collect::<Vec<_>>()
        })
        .collect()
}

/// Far from the ends of ground along a slope, all depends on the depth `z` below the surface alone. So a plane along the slope bears the weight above it,
/// vertically, `γ z cos β` for each area; and of that the water has `γ_w` times the vertical depth below its table, at right angles to the plane. The ends
/// have lost their effect there but for a thousandth.
#[test]
fn a_plane_along_a_long_slope_bears_the_weight_above_it() {
    for kind in ["mpm", "fem"] {
        for depth in [-0.5, 1.5, 2.0] {
            let line = format!(
                "water.phreatic_level={{line: [[0, {}], [{LENGTH}, {}]]}}",
                DEEP - depth,
                DEEP - depth + LENGTH * TAN
            );
            let folder = solve(SLOPE, &[&format!("regions.soil.kind={kind}"), &line]);
            let cos = 1.0 / TAN.hypot(1.0);
            let normal = [-TAN * cos, cos];
            let mut off: [f64; 2] = [0.0; 2];
            for (x, s) in stresses(folder.path()).iter().filter(|(x, _)| (x[0] - 0.5 * LENGTH).abs() < 2.0) {
                let z = DEEP + TAN * x[0] - x[1];
                let pore = WATER * (z - depth).max(0.0);
                let acts = [s[0] * normal[0] + s[3] * normal[1], s[3] * normal[0] + s[1] * normal[1]];
                let borne = [0, 1].map(|d| acts[d] - pore * normal[d]);
                off[0] = off[0].max(borne[0].abs());
                off[1] = off[1].max((borne[1] + WEIGHT * z * cos).abs());
            }
            let off = off.map(|off| off / (WEIGHT * DEEP));
            println!("{kind}, table {depth} m below the surface: off by {off:?} of the weight");
            assert!(off.iter().all(|off| *off < 0.01), "{kind} {depth}: {off:?}");
            let (borne, weight) =
                (column(folder.path(), "base.reaction_y [kN]").pop().unwrap(), WEIGHT * DEEP * LENGTH);
            assert!((borne / weight - 1.0).abs() < 1e-8, "{kind} {depth}: {borne}, not {weight}");
        }
    }
}

/// A slope that rises to the left, with the line turned round, is the same scene seen in a mirror.
#[test]
fn the_mirror_image_is_the_same() {
    let ends = ["soil.ux [m]", "soil.uy [m]", "base.reaction_y [kN]", "sides.reaction_x [kN]"];
    let of = |set: &[&str]| {
        let folder = solve(SLOPE, set);
        ends.map(|name| column(folder.path(), name)[0])
    };
    let line = |places: &str| format!("water.phreatic_level={{line: {places}}}");
    let right = of(&[&line("[[0, 2.5], [20, 6], [48, 14.5]]")]);
    let left = of(&["mesh.parameters={tan: -0.25}", &line("[[0, 2.5], [28, -6], [48, -9.5]]")]);
    println!("{right:?}\n{left:?}");
    // The second is the first, 12 m lower and with x from the other end.
    let size = right[1].abs();
    assert!((right[0] + left[0]).abs() < 1e-6 * size && (right[1] - left[1]).abs() < 1e-6 * size, "{right:?} {left:?}");
    assert!(
        (right[2] / left[2] - 1.0).abs() < 1e-8 && (right[3] + left[3]).abs() < 1e-6 * right[2],
        "{right:?} {left:?}"
    );
}

/// A line of one height is that height.
#[test]
fn a_level_line_is_a_level() {
    for more in [&[][..], &["water.level=3"], &["regions.soil.kind=fem"]] {
        let of = |level: &str| {
            let level = format!("water.phreatic_level={level}");
            let folder = solve(SLOPE, &[&[level.as_str()], more].concat());
            ["soil.ux [m]", "soil.uy [m]", "base.reaction_y [kN]"].map(|name| column(folder.path(), name))
        };
        let [level, line] = ["6.3", "{line: [[3, 6.3], [20, 6.3], [31, 6.3]]}"].map(of);
        println!("{more:?}: {level:?} {line:?}");
        for (level, line) in level.iter().flatten().zip(line.iter().flatten()) {
            assert!((level - line).abs() <= 1e-10 * level.abs().max(1e-3), "{more:?}: {level} {line}");
        }
    }
}

/// What cannot be inclined, and lines that are none.
#[test]
fn what_makes_no_sense_is_refused() {
    let slope = project(SLOPE);
    for (set, found) in [
        ("water.level={line: [[0, 1], [2, 3]]}", "the surface of water outside of the soil is level"),
        ("phases[0].water_level={line: [[0, 1], [2, 3]]}", "there is no water with a `level`"),
        ("water.phreatic_level={line: [[0, 1], [0, 3]]}", "x = 0 m does not come after 0 m"),
        ("water.phreatic_level={line: [[0, 1]]}", "must have at least 2"),
        ("phases[0].phreatic_level={line: [[2, 1], [0, 3]]}", "x = 0 m does not come after 2 m"),
    ] {
        let output = in_folder(&slope, &["check", ".", "--set", set]);
        assert!(!output.status.success() && errors(&output).contains(found), "{set}: {}", said(&output));
    }
    let undrained = said(&in_folder(&slope, &["check", ".", "--set", "materials.soil.drainage=undrained"]));
    assert!(undrained.contains("above the `phreatic_level` at y = 14.5 m"), "{undrained}");
}
