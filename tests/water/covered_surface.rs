//! The surface of soil that drains, beside structures that cover it: against a closed form and a curve that is drained where none does.

use crate::analytical::terzaghi::Layer;
use crate::support::{self, column};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// Runs the strip of `tests/data` with overrides.
fn run(overrides: &[&str]) -> TempDir {
    support::run("tests/data/strip", overrides)
}

/// The water (m³) that left the soil of a run, and the part of it that the soil does not hold less (-).
fn balance(folder: &Path) -> (f64, f64) {
    let log = fs::read_to_string(folder.join("solve.log")).unwrap();
    let (mut all, mut missing) = (0.0, 0.0);
    for line in log.lines().filter_map(|line| line.split_once(" water taken up ")) {
        let words: Vec<&str> = line.1.split(' ').collect();
        let [taken_up, left] = [0, 2].map(|i| words[i].parse::<f64>().unwrap());
        (all, missing) = (all + left, missing + taken_up + left);
    }
    assert!(all > 0.0, "{log}");
    (all, missing / all)
}

/// The soil of the strip as a layer that drains at one end.
const LAYER: Layer = Layer { height: 1.0, modulus: 1000.0 / 0.9, storage: 5e-5, mobility: 9.3195e-7 / 9.81, load: 0.1 };

/// A plate over all of a layer that drains at its base: nothing leaves above, so that the layer is Terzaghi's upside down. How far pressure
/// beneath the plate, in the first one, and settlement are off, with more overrides.
fn plate_over_all(h: f64, more: &[&str]) -> [f64; 2] {
    // Pressed as far as its load does while nothing flows.
    let first = (LAYER.load - LAYER.first_pressure()) / LAYER.modulus;
    let press = format!("phases.press.prescribe.strip.uy={{rate: {}}}", -first * LAYER.height);
    let held = "supports={bottom: {ux: 0, uy: 0, pore_pressure: 0}, side: {ux: 0}}";
    let parameters = format!("mesh.parameters={{width: 0.4, strip: 0.4, node: 0.2, hs: 0.13, h: {h}}}");
    let folder = run(&[&[parameters.as_str(), &press, held, "phases.wait.step.initial=10"], more].concat());
    let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
    assert!(log.contains("phase `wait`: no free surface of soil"), "{log}");
    let [top, settled] = ["beneath.pore_pressure [kPa]", "strip.uy [m]"].map(|name| column(folder.path(), name));
    let time = column(folder.path(), "time [s]");
    let (mut off, mut off_settlement) = (0.0f64, 0.0f64);
    for ((t, p), u) in time.iter().zip(&top).zip(&settled).filter(|((t, ..), _)| **t > 101.0) {
        off = off.max((p - LAYER.pressure(LAYER.height, t - 1.0)).abs() / LAYER.first_pressure());
        off_settlement = off_settlement.max((u / -LAYER.settlement(t - 1.0) - 1.0).abs());
    }
    println!("h = {h} {more:?}: pressure beneath the plate off by {off:.1e} p₀, settlement by {off_settlement:.1e}");
    [off, off_settlement]
}

/// The same about an axis.
#[test]
fn a_round_plate_over_all_of_a_layer_keeps_it_from_draining() {
    let [pressure, settlement] = plate_over_all(0.1, &["geometry=axisymmetric"]);
    assert!(pressure < 1e-3 && settlement < 1e-2, "{pressure} {settlement}");
}

/// One that lies above the soil covers it while the gap is a twentieth of the distance of its contact nodes, 2.5 mm here, and no longer.
#[test]
fn a_plate_that_has_parted_lets_the_surface_drain() {
    let pressed = "phases=[{name: wait, analysis: consolidation, duration: 1000, step: {initial: 10}, \
        tractions: [{surface: all, pressure: 0.1}], prescribe: {strip: {ux: 0, uy: 0, rotation: 0}}}]";
    for (gap, drains) in [(1e-3, false), (5e-3, true)] {
        let parameters = format!("mesh.parameters={{width: 0.4, strip: 0.4, node: 0.2, gap: {gap}}}");
        let bottom = column(run(&[&parameters, pressed]).path(), "bottom.pore_pressure [kPa]");
        let last = bottom[bottom.len() - 1] / LAYER.first_pressure();
        let wanted = if drains { LAYER.pressure(LAYER.height, 1000.0) / LAYER.first_pressure() } else { 1.0 };
        println!("gap of {gap} m: {last:.5} of p₀ at the base, {wanted:.5} wanted");
        assert!((last - wanted).abs() < 5e-3, "{bottom:?}");
    }
}

/// Under a large load the strip sinks in while water leaves beside it.
#[test]
fn water_is_kept_beside_a_strip() {
    for restore in ["every_step", "{min_quality: 0.5}"] {
        let folder = run(&[
            "phases.press.prescribe.strip.uy={rate: -5.0e-4}",
            "phases.wait.tractions=[{on: top, tx: 0, ty: {table: [[0, -10], [1000, -100]]}}]",
            &format!("numerics={{restore: {restore}, tolerance: 1.0e-10}}"),
        ]);
        let (settled, (left, imbalance)) = (column(folder.path(), "strip.uy [m]"), balance(folder.path()));
        let settled = settled[settled.len() - 1];
        println!("{restore}: settled by {settled:.4} m, {left:.4} m³ left, imbalance {imbalance:.1e}");
        assert!(settled < -0.02 && imbalance.abs() < 1e-10, "{imbalance}");
    }
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    /// A strip over half of the surface, beside one on a grid that is never restored, whose curve beside the strip is drained. There the strip
    /// ends where cells do; here there, too, or within one.
    #[test]
    fn a_strip_over_half_of_the_surface_leaves_the_other_half() {
        let held = "supports={bottom: {ux: 0, uy: 0}, side: {ux: 0}, beside: {pore_pressure: 0}}";
        let parameters = |h: f64, node: f64| format!("mesh.parameters={{h: {h}, hs: {h}, node: {node}}}");
        let long = "phases.wait.step.initial=100";
        let mut before = [f64::INFINITY; 2];
        for (h, most) in [(0.1, 1.2e-2), (0.05, 7e-3)] {
            let along_curve = run(&["drained_surface=null", "numerics.restore=never", held, &parameters(h, 1.0), long]);
            let off = [1.0, 0.87].map(|node| {
                let folder = run(&[&parameters(h, node), long]);
                let off = ["soil.pore_pressure [kPa]", "bottom.pore_pressure [kPa]"].map(|name| {
                    let [wanted, found] = [&along_curve, &folder].map(|folder| column(folder.path(), name));
                    let most = |a: f64, b: f64| a.max(b.abs());
                    let apart = wanted.iter().zip(&found).skip(2).map(|(wanted, found)| found - wanted);
                    apart.fold(0.0, most) / wanted.iter().copied().fold(0.0, most)
                });
                println!(
                    "h = {h}, corner at {node}: pressure in the mean off by {:.5}, at the base by {:.5}",
                    off[0], off[1]
                );
                off[0].max(off[1])
            });
            assert!(off.iter().zip(&before).all(|(off, before)| *off < most && off < before), "{off:?} {before:?}");
            before = off;
        }
    }

    #[test]
    fn a_plate_over_all_of_a_layer_keeps_it_from_draining() {
        for h in [0.1, 0.05] {
            let [pressure, settlement] = plate_over_all(h, &[]);
            assert!(pressure < 1e-3 && settlement < 1e-2, "{pressure} {settlement}");
        }
    }
}
