//! The example of a silo that is filled through an inlet, rests and is emptied through an outlet, with coarse cells.

use crate::support::{column, solve};
use std::path::Path;

/// The height (m) of sand that fills the silo evenly: twice that of its centroid, in the last frame of the phase `rest`.
fn height(folder: &Path) -> f64 {
    let frames = mpm::io::frame::list(&folder.join("results")).unwrap();
    let mut all = frames.iter().map(|found| mpm::io::frame::Frame::read(&found.path).unwrap());
    let rest = all.rfind(|frame| frame.phase == "rest").unwrap();
    let masses = &rest.points.columns.iter().find(|column| column.name == "mass").unwrap().values;
    let moment: f64 = rest.points.position.iter().zip(masses).map(|(x, mass)| x[1] * mass).sum();
    2.0 * moment / masses.iter().sum::<f64>()
}

/// At rest floor, gate and wall bear the weight; floor and gate that of Janssen, and the vertical stress is his over the height, for the earth pressure of
/// elastic soil at rest, which lies between those of Rankine and Jaky. The mass of the sand, with what has left, is what was there and what came, in every row.
#[test]
fn sand_that_entered_lies_in_a_silo_as_janssen_has_it_and_leaves() {
    let folder = solve(
        "docs/examples/filled_silo",
        &[
            "mesh.parameters={h: 0.125, slot: 0.125, inlet: 0.125, height: 1.2, layer: 0.125}",
            "phases.fill.duration=0.6",
            "phases.fill.inflow.inlet.velocity=2",
            "phases.empty.duration=0.3",
        ],
    );
    let of = |name: &str| column(folder.path(), name);
    let time = of("time [s]");
    let [bed, feed, into, out] = ["bed.mass [t]", "feed.mass [t]", "inlet.mass_in [t]", "gate.mass_out [t]"].map(of);
    for k in 0..time.len() {
        let whole = 1.6 * 0.25 * 0.125 + into[k];
        assert!(((bed[k] + feed[k] + out[k]) / whole - 1.0).abs() < 1e-12, "t = {}", time[k]);
    }
    assert!(*out.last().unwrap() > 0.01, "{out:?}");

    let rest = time.iter().rposition(|&t| t < 2.4 + 1e-9).unwrap();
    let [gate, floor, wall] =
        ["gate.contact_y [kN]", "floor.contact_y [kN]", "wall.contact_y [kN]"].map(|n| -of(n)[rest]);
    let weight = 9.81 * (bed[rest] + feed[rest]);
    assert!(((gate + floor + wall) / weight - 1.0).abs() < 1e-3, "{gate} {floor} {wall} of {weight}");

    let height = height(folder.path());
    let (unit_weight, rise) = (weight / 0.25 / height, 2.0 * 0.364 * (0.3 / 0.7) / 0.5);
    let janssen = |y: f64| unit_weight / rise * (1.0 - (-rise * (height - y)).exp());
    let over = (gate + floor) / (0.25 * janssen(0.0));
    let profile = [("low", 0.15), ("middle", 0.3), ("high", 0.45)]
        .map(|(name, y)| -of(&format!("{name}.stress_yy [kPa]"))[rest] / janssen(y));
    println!(
        "height {height:.3} m, wall {:.3} of the weight, floor {over:.3}, stress {profile:.3?} of Janssen's",
        wall / weight
    );
    assert!((over - 1.0).abs() < 0.1, "{over}");
    assert!(profile.iter().all(|part| (part - 1.0).abs() < 0.15), "{profile:?}");
}
