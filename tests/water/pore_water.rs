//! Water that flows through the pores of a column that stands or lies, through the program and against closed forms: pressure that is there at
//! first, permeability by direction, and waves.

use crate::analytical::terzaghi::{Layer, degree, isochrone};
use crate::analytical::vibrating_bar::Bar;
use crate::support::{column, solve_text};
use mpm::io::frame::{self, Frame};
use std::f64::consts::{FRAC_PI_2, TAU};
use std::path::Path;
use tempfile::TempDir;

const YOUNG: f64 = 1000.0;
const POISSON: f64 = 0.2;
/// Confined modulus and stiffness `K_w/n` of the water (kPa).
const CONFINED: f64 = YOUNG * (1.0 - POISSON) / ((1.0 + POISSON) * (1.0 - 2.0 * POISSON));
const WATER: f64 = 8000.0;
const UNIT_WEIGHT: f64 = 9.81;
const LOAD: f64 = 0.1;

/// A column of porous soil, 1 m long, that stands or lies, held at one end and free at the other, between smooth walls.
struct Column {
    kind: &'static str,
    upright: bool,
    h: f64,
    density: f64,
    permeability: String,
}

impl Column {
    /// Runs it to the end of its phase, drained at its `free` end, its `sides` or not at all, with `more` entries of the case.
    fn run(&self, drained: &str, more: &str, phase: &str) -> TempDir {
        let (geo, name, size) =
            if self.upright { ("terzaghi", "soil", "width: 0.1, coarse: 1") } else { ("bar", "bar", "depth: 0.1") };
        let [free, base, along] = if self.upright { ["top", "bottom", "uy"] } else { ["free", "fixed", "ux"] };
        let out = |curve: &str| if drained == curve { "pore_pressure: 0" } else { "" };
        let (sides, end) = (out("sides"), out("free"));
        let held = if self.upright {
            format!(
                "bottom: {{ux: 0, uy: 0}}, left: {{ux: 0, {sides}}}, right: {{ux: 0, {sides}}}, top: {{ux: 0, {end}}}"
            )
        } else {
            format!(
                "fixed: {{ux: 0, uy: 0}}, lower: {{uy: 0, {sides}}}, upper: {{uy: 0, {sides}}}, free: {{uy: 0, {end}}}"
            )
        };
        solve_text(&format!(
            "geometry: plane_strain\n\
             mesh: {{geo: GEO/{geo}.geo, parameters: {{{size}, h: {}}}}}\n\
             regions: {{{name}: {{kind: {}, material: clay{}}}}}\n\
             materials: {{clay: {{model: linear_elastic, young: {YOUNG}, poisson: {POISSON}, density: {}, drainage: undrained, \
               porosity: 0.5, water_bulk_modulus: {}{}}}}}\n\
             supports: {{{held}}}\n\
             numerics: {{restore: never, spectral_radius: 1}}\n\
             {more}\
             phases:\n- {{name: only, {phase}}}\n\
             output: {{fields: [pore_pressure, stress], history: [{{name: free, on: {free}, quantities: [{along}]}}, \
               {{name: base, on: {base}, quantities: [pore_pressure]}}]}}\n",
            self.h,
            self.kind,
            if self.kind == "mpm" { ", points_per_cell: 6" } else { "" },
            self.density,
            0.5 * WATER,
            self.permeability,
        ))
    }

    /// The displacement of the free end and the pressure at the base, a row a step.
    fn moved(&self, folder: &Path) -> [Vec<f64>; 2] {
        let along = if self.upright { "free.uy [m]" } else { "free.ux [m]" };
        [along, "base.pore_pressure [kPa]"].map(|name| column(folder, name))
    }

    /// What loads the free end.
    fn load(&self) -> String {
        let (free, along) = if self.upright { ("top", "ty") } else { ("free", "tx") };
        format!("tractions: [{{on: {free}, {along}: -{LOAD}}}]")
    }
}

fn layer(permeability: f64) -> Layer {
    Layer { height: 1.0, modulus: CONFINED, storage: 1.0 / WATER, mobility: permeability / UNIT_WEIGHT, load: LOAD }
}

/// A load that the water bears all of from the beginning: nothing moves at first, and the pressure falls from the given one.
#[test]
fn pressure_that_is_there_at_first_drains_as_that_of_a_load() {
    for kind in ["mpm", "fem"] {
        let column =
            Column { kind, upright: true, h: 0.05, density: 0.0, permeability: ", permeability: 1.0e-7".into() };
        let layer = layer(1e-7);
        let end = layer.time(0.5);
        let phase =
            format!("analysis: consolidation, duration: {end}, step: {{initial: {}}}, {}", end / 200.0, column.load());
        let folder = column.run("free", &format!("initial_pore_pressure: {{soil: {LOAD}}}\n"), &phase);
        let [moved, pressure] = column.moved(folder.path());
        for (row, factor) in [(39, 0.1), (79, 0.2), (199, 0.5)] {
            let settled = -moved[row] / (LOAD / CONFINED * degree(factor)) - 1.0;
            let pressure = pressure[row] / LOAD - isochrone(1.0, factor);
            println!("{kind}, T {factor}: settles {settled:+.1e}, pressure {pressure:+.1e}");
            assert!(settled.abs() < 5e-3 && pressure.abs() < 5e-3, "{kind}, T {factor}");
        }
        // Undrained, all of it stays.
        let still = format!("analysis: quasi_static, duration: 1, step: {{initial: 0.5}}, {}", column.load());
        let folder = column.run("free", &format!("initial_pore_pressure: {{soil: {LOAD}}}\n"), &still);
        let [moved, pressure] = column.moved(folder.path());
        println!("{kind}, undrained: {moved:?} {pressure:?}");
        assert!(moved[1].abs() < 1e-9 * LOAD / CONFINED && (pressure[1] / LOAD - 1.0).abs() < 1e-9);
    }
}

/// The first frame shows the profile that is given.
#[test]
fn pressure_that_is_given_by_depth_is_there_at_first() {
    let column = Column { kind: "mpm", upright: true, h: 0.2, density: 0.0, permeability: ", permeability: 0".into() };
    let profile = "initial_pore_pressure: {soil: {top: 0.5, gradient: 2, datum: 0.75}}\n";
    let folder = column.run("", profile, "analysis: quasi_static, duration: 1, step: {initial: 1}");
    let first = Frame::read(&frame::path(&folder.path().join("results"), 0)).unwrap().points;
    let pressure = &first.columns.iter().find(|column| column.name == "pore_pressure").unwrap().values;
    assert!(pressure.len() > 50);
    for (x, p) in first.position.iter().zip(pressure) {
        assert!((p - 0.5 - 2.0 * (0.75 - x[1]).max(0.0)).abs() < 1e-14, "{x:?}: {p}");
    }
}

/// A wave that stands in the column, for two periods of forty steps: the error of its frequency beside that of the trapezoidal rule, and how
/// far the displacement and the pressure, over their amplitudes, are off a wave of the frequency it has.
fn wave(kind: &'static str, h: f64, permeability: &str, drained: &str) -> [f64; 3] {
    let column = Column { kind, upright: false, h, density: 2.0, permeability: permeability.into() };
    let modulus = CONFINED + if drained == "sides" { 0.0 } else { WATER };
    let bar = Bar { modulus, density: 2.0, length: 1.0, velocity: 1e-3, mode: 1 };
    let step = bar.period() / 40.0;
    let own = 2.0 / step * (0.5 * bar.frequency() * step).atan();
    let wave = format!(
        "initial_velocity: {{bar: {{standing_wave: {{component: x, along: x, amplitude: 0.001, wave_number: {FRAC_PI_2}}}}}}}\n"
    );
    let phase = format!("analysis: dynamic, duration: {}, step: {{initial: {step}}}", 80.0 * step);
    let [moved, pressure] = column.moved(column.run(drained, &wave, &phase).path());
    assert_eq!(moved.len(), 80);
    let amplitude = bar.velocity / bar.frequency();
    let strain = amplitude * bar.wave_number();
    let frequency = (2.0 * TAU + (moved[79] / amplitude).asin()) / (80.0 * step);
    let mut out = [frequency / own - 1.0, 0.0, 0.0];
    for (i, (u, p)) in moved.iter().zip(&pressure).enumerate() {
        let swing = (frequency * step * (i + 1) as f64).sin();
        let expected = if drained == "sides" { 0.0 } else { -WATER * strain * swing };
        out[1] = out[1].max((u / amplitude - swing).abs());
        out[2] = out[2].max((p - expected).abs() / (WATER * strain));
    }
    out
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    /// Where the water stays a wave is as fast as soil and water together are stiff, `√((M + K_w/n)/ρ)`, and its pressure is `−K_w/n` times the
    /// strain, both at second order; where water leaves through the sides at once, it is as fast as in soil alone.
    #[test]
    fn waves_are_as_fast_as_soil_and_water_are_stiff() {
        for kind in ["mpm", "fem"] {
            for (permeability, drained) in [(", permeability: 1.0e-12", "free"), (", permeability: 0", "")] {
                let errors = [0.05, 0.025].map(|h| wave(kind, h, permeability, drained));
                let order = (errors[0][0] / errors[1][0]).log2();
                println!("{kind}{permeability}: {errors:.4?}, order {order:.2}");
                assert!(errors[1][0].abs() < 1e-3 && order > 1.8, "{kind}{permeability}: {errors:?}");
                assert!(errors[1][1] < 2e-3 && errors[1][2] < 2e-3, "{kind}{permeability}: {errors:?}");
            }
            let alone = wave(kind, 0.1, ", permeability: {x: 0, y: 1.0e+3}", "sides");
            println!("{kind}, water that leaves at once: {alone:?}");
            assert!(alone[0].abs() < 1e-4 && alone[1] < 1e-3 && alone[2] < 1e-6, "{kind}: {alone:?}");
        }
    }

    /// Two columns that consolidate to T = 0.5, one that stands and one that lies, see each the permeability along it, and not the other one, which is
    /// a hundred times larger or smaller.
    #[test]
    fn water_flows_by_the_permeability_of_its_direction() {
        for kind in ["mpm", "fem"] {
            for upright in [true, false] {
                for across in [1e-5, 1e-9] {
                    let along = 1e-7;
                    let [x, y] = if upright { [across, along] } else { [along, across] };
                    let permeability = format!(", permeability: {{x: {x:e}, y: {y:e}}}");
                    let column = Column { kind, upright, h: 0.05, density: 0.0, permeability };
                    let layer = layer(along);
                    let end = layer.time(0.5);
                    let folder = column.run(
                        "free",
                        "",
                        &format!(
                            "analysis: consolidation, duration: {end}, step: {{initial: {}}}, {}",
                            end / 200.0,
                            column.load()
                        ),
                    );
                    let [moved, pressure] = column.moved(folder.path()).map(|values| values[values.len() - 1]);
                    let moved = -moved / layer.settlement(end) - 1.0;
                    let pressure = (pressure - layer.pressure(1.0, end)) / layer.first_pressure();
                    println!(
                        "{kind}, upright {upright}, {across:e} across: settles {moved:+.1e}, pressure {pressure:+.1e}"
                    );
                    assert!(moved.abs() < 5e-3 && pressure.abs() < 5e-3, "{kind} {upright} {across}");
                }
            }
        }
    }
}
