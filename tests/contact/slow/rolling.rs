//! A rigid disc that rolls on level ground keeps its velocity, and presses on the ground with its weight.

use crate::support::{rows, run};
use std::f64::consts::PI;

/// On stiff soil of material points, past six contact nodes. The half width of the contact is a twentieth of the distance of these: with the mean gap of
/// each alone the disc rolled like a polygon, and its force was from nothing to 2.8 times the weight.
#[test]
fn stiff_soil_carries_a_disc_that_rolls() {
    let folder = run("tests/data/roll", &[]);
    let weight = 9.81 * PI * 0.25;
    // time, ux, uy, vx, vy, rotation, contact_x, contact_y
    let rows = rows(folder.path());
    let last = rows.last().unwrap();
    let forces: Vec<f64> = rows.iter().filter(|row| row[0] > 0.1).map(|row| row[7] / weight).collect();
    let mean = forces.iter().sum::<f64>() / forces.len() as f64;
    let most = forces.iter().fold(0.0f64, |most, force| most.max((force - 1.0).abs()));
    let turned = -0.5 * last[5] / last[1];
    println!("way {:.5} m, turned {turned:.4}, force {mean:.4}, off by {most:.3} at most", last[1]);
    assert!((last[1] / 0.3 - 1.0).abs() < 1e-3 && (turned - 1.0).abs() < 5e-3, "{last:?}");
    assert!((mean - 1.0).abs() < 0.02 && most < 0.15, "{mean} {most}");
}
