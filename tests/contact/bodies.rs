//! Bodies that touch bodies.

use crate::contact::{history, refused};
use crate::support::{rows, run};
use mpm::io::frame::Frame;

const BLOCKS: &str = "tests/data/blocks";

/// `λ` at which a confined column of Hencky's elasticity bears the pressure `q`: `−M ln λ / λ = q`.
fn stretch(q: f64, young: f64, poisson: f64) -> f64 {
    let modulus = young * (1.0 - poisson) / ((1.0 + poisson) * (1.0 - 2.0 * poisson));
    bisect(0.5, 1.0, |stretch| -modulus * stretch.ln() / stretch > q)
}

/// Where `is_left` ends to hold.
fn bisect(mut left: f64, mut right: f64, is_left: impl Fn(f64) -> bool) -> f64 {
    for _ in 0..60 {
        let middle = 0.5 * (left + right);
        if is_left(middle) {
            left = middle;
        } else {
            right = middle;
        }
    }
    left
}

/// Two confined blocks of different stiffness, one on the other, are strained evenly, whatever their meshes.
#[test]
fn blocks_pressed_together_hand_on_a_uniform_pressure() {
    let folder = run(BLOCKS, &[]);
    let shorter = |q: f64| 2.0 - stretch(q, 1000.0, 0.3) - stretch(q, 3000.0, 0.2);
    let pressure = bisect(0.0, 1000.0, |q| shorter(q) < 0.1);
    let row = rows(folder.path()).pop().unwrap();
    assert!((row[2] / (2.0 * pressure) - 1.0).abs() < 1e-3, "{row:?} {pressure}");
    assert!(row[4] == -row[2] && (row[6] + row[2]).abs() < 1e-7 * row[2], "{row:?}");
    let frame = Frame::read(&folder.path().join("results/frame-000001.mpmf")).unwrap();
    let stress = frame.elements.columns.iter().find(|c| c.name == "stress").unwrap();
    let off = stress.values.chunks_exact(6).map(|sigma| (sigma[1] / (-0.5 * row[2]) - 1.0).abs()).fold(0.0, f64::max);
    println!("pressure {:.4} of {pressure:.4} kPa, uniform to {off:.1e}", 0.5 * row[2]);
    assert!(off < 1e-3, "{off}");
}

/// A pressure that is even over both has no moment about the centroid of either, though it has one about the origin.
#[test]
fn each_side_has_the_moment_about_its_own_centroid() {
    let history_of = "output.history=[{name: upper, on: upper, quantities: [contact_y, contact_moment]}, {name: lower, on: \
        lower, quantities: [contact_y, contact_moment]}]";
    let upper = ["regions.upper.rigid=true", "supports={bottom: {uy: 0}, lower_sides: {ux: 0}, upper: {ux: 0}}"];
    for overrides in [&[history_of][..], &[history_of, upper[0], upper[1]]] {
        let row = history(BLOCKS, overrides).pop().unwrap();
        println!("moments {:.1e} and {:.1e} kN m of {:.1} kN", row[2], row[4], row[1]);
        assert!(row[1] > 10.0 && row[3] == -row[1], "{row:?}");
        assert!(row[2].abs() < 1e-6 * row[1] && row[4].abs() < 1e-6 * row[1], "{row:?}");
    }
}

#[test]
fn bodies_that_cannot_touch_are_told() {
    let refused = |contact: &str, words: &[&str]| refused(BLOCKS, &[&format!("contacts=[{contact}]")], words);
    refused("{structure: upper, against: upper}", &["does not touch itself"]);
    refused("{structure: upper, against: uper}", &["no region `uper`", "of kind structure or fem", "did you mean"]);
    refused("{structure: upper, against: lower, soil: lower}", &["both soil and a body"]);
    refused("{structure: upper, against: lower, adhesion_factor: 0.5}", &["share of the strength of soil"]);
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    /// Either side may have the contact nodes, and either may be rigid.
    #[test]
    fn the_sides_of_a_contact_may_change_places() {
        let force = |overrides: &[&str]| history(BLOCKS, overrides).pop().unwrap()[2];
        let both = "regions={lower: {kind: structure, material: lower}, upper: {kind: structure, material: upper}}";
        let swapped = force(&[both, "contacts=[{structure: lower, against: upper}]"]);
        assert!((swapped / force(&[both]) - 1.0).abs() < 1e-3, "{swapped}");
        let rigid =
            force(&["regions.upper.rigid=true", "supports={bottom: {uy: 0}, lower_sides: {ux: 0}, upper: {ux: 0}}"]);
        let lower = "regions={lower: {kind: structure, material: lower, rigid: true}, upper: {kind: structure, \
        material: lower}}";
        let turned = force(&[lower, "supports={bottom: {ux: 0, uy: 0}, upper_sides: {ux: 0}}"]);
        let modulus = 1000.0 * 0.7 / (1.3 * 0.4);
        let exact = -2.0 * modulus * 0.9f64.ln() / 0.9;
        assert!((rigid / exact - 1.0).abs() < 1e-3 && (turned / exact - 1.0).abs() < 1e-3, "{rigid} {turned} {exact}");
    }
}
