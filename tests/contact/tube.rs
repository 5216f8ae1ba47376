//! A structure off the axis: an open tube in soil that it touches inside and out.

use crate::contact::history;
use std::f64::consts::TAU;

/// Pulled up, it is held by α s_u on both of its sides, rigid or not, and by nothing else.
#[test]
fn an_open_tube_is_held_inside_and_out() {
    let exact = 0.1 * 30.0 * TAU * (0.5 + 0.6) * 1.0;
    let rigid = [
        "regions.tube.rigid=true",
        "phases[0].prescribe={tube: {uy: {rate: 0.005}}}",
        "output.history=[{name: tube, on: tube, quantities: [ux, uy, contact_x, contact_y, reaction_y]}]",
    ];
    for overrides in [&[][..], &rigid] {
        let rows = history("tests/data/tube", overrides);
        for row in rows.iter().filter(|row| row[0] > 0.15) {
            assert!((row[4] / -exact - 1.0).abs() < 0.01, "{} of {exact} kN at {} s", row[4], row[0]);
            assert!((row[5] / row[4] + 1.0).abs() < 1e-6, "{row:?}");
        }
        let row = rows.last().unwrap();
        println!("{:.3} of {exact:.3} kN, its radius grows by {:.1e} m", -row[4], row[1]);
        assert!(rows.len() == 10 && row[1].abs() < 1e-5, "{row:?}");
    }
}
