//! What phases do, through the program: the factor of safety against closed forms and a published slope.

use crate::support::{column, log, mpm, rows, safety, solve, solve_text, written};
use mpm::io::frame::{self, Frame};
use mpm::io::provenance::Origin;
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A block between smooth plates, loaded from above; weightless, and half of it.
fn block(material: &str, load: f64) -> TempDir {
    solve_text(&format!(
        "geometry: plane_strain\n\
         mesh: {{geo: GEO/slump.geo, parameters: {{half_width: 1, height: 1, room: 0, h: 0.5}}}}\n\
         regions: {{block: {{kind: mpm, material: soil, points_per_cell: 12}}}}\n\
         materials: {{soil: {{{material}, young: 1.0e+6, poisson: 0.3, density: 1}}}}\n\
         supports: {{bottom: {{uy: 0}}, axis: {{ux: 0}}}}\n\
         numerics: {{restore: never}}\n\
         phases:\n\
         - {{name: load, analysis: quasi_static, duration: 1, step: {{initial: 1}}, tractions: [{{on: top, ty: {load}}}]}}\n\
         - {{name: safety, analysis: strength_reduction, duration: 2, step: {{initial: 0.05, min: 0.0002}}, \
             tractions: [{{on: top, ty: {load}}}]}}\n\
         - {{name: after, analysis: quasi_static, duration: 1, step: {{initial: 1}}, tractions: [{{on: top, ty: {load}}}]}}\n\
         output: {{history: [{{name: top, on: top, quantities: [uy]}}]}}\n"
    ))
}

/// The uniaxial strength (kPa) of plane strain by Mohr and Coulomb, with both reduced by `factor`.
fn uniaxial(cohesion: f64, friction: f64, factor: f64) -> f64 {
    let tan = friction.to_radians().tan() / factor;
    2.0 * cohesion / factor * (tan + tan.hypot(1.0))
}

/// The stress is uniform, so that the load is the uniaxial strength at failure; the strain there, of the order of 1e-4, is what the
/// shape of the block and the bracket, 2e-4 to 4e-4 wide, leave as an error.
#[test]
fn a_block_fails_where_its_reduced_strength_is_the_load() {
    let sand = |factor: f64| uniaxial(5.0, 30.0, factor);
    let (mut low, mut high) = (1.0, 2.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        (low, high) = if sand(middle) > 13.0 { (middle, high) } else { (low, middle) };
    }
    for (material, load, exact) in [
        ("model: tresca, shear_strength: 10", -16.0, 20.0 / 16.0),
        ("model: von_mises, yield_stress: 10", -9.0, 20.0 / 3f64.sqrt() / 9.0),
        ("model: mohr_coulomb, cohesion: 5, friction: 30", -13.0, low),
        ("model: mohr_coulomb, cohesion: 5, friction: 30, dilation: 30", -13.0, low),
        ("model: mohr_coulomb, cohesion: 10, friction: 20, tension: 4", 3.0, 4.0 / 3.0),
    ] {
        let folder = block(material, load);
        let [held, failed] = safety(&log(folder.path()));
        println!("{material}: {held} to {failed}, exact {exact:.4}");
        assert!(failed - held < 5e-4 && held < exact * 1.001 && failed > exact * 0.999, "{material}");
        // The history has the bracket in a row of its own, and the phase after it its strengths back.
        let reduction = column(folder.path(), "strength_reduction [-]");
        let none = column(folder.path(), "no_equilibrium_at [-]");
        let last = none.iter().position(|&f| f > 0.0).unwrap();
        assert!((reduction[last] - held).abs() < 1e-4 && (none[last] - failed).abs() < 1e-4, "{reduction:?} {none:?}");
        assert_eq!(reduction[last + 1..], [1.0], "the phase after the search is one step");
        let time = column(folder.path(), "time [s]");
        assert_eq!(time[last], time[last - 1]);
        assert!((time[last + 1] - time[last] - 1.0).abs() < 1e-12);
    }
}

/// A search that begins with its load out of balance finds the factor where there is equilibrium to begin with. Where there is none
/// it says so, and no factor: what it finds with a part of the load is none.
#[test]
fn a_search_begins_with_all_of_its_load() {
    let search = |load: f64| {
        let file = written(&format!(
            "geometry: plane_strain\n\
             mesh: {{geo: GEO/slump.geo, parameters: {{half_width: 1, height: 1, room: 0, h: 0.5}}}}\n\
             regions: {{block: {{kind: mpm, material: soil, points_per_cell: 12}}}}\n\
             materials: {{soil: {{model: tresca, shear_strength: 10, young: 1.0e+6, poisson: 0.3, density: 1}}}}\n\
             supports: {{bottom: {{uy: 0}}, axis: {{ux: 0}}}}\n\
             numerics: {{restore: never}}\n\
             phases:\n\
             - {{name: safety, analysis: strength_reduction, duration: 1, step: {{initial: 0.05, min: 0.0002}}, \
                 tractions: [{{on: top, ty: {load}}}]}}\n"
        ));
        let folder = tempfile::tempdir().unwrap();
        let output = mpm("run", file.path(), folder.path(), &[]);
        (output.status.success(), log(folder.path()))
    };
    let (done, found) = search(-17.0);
    let [held, failed] = safety(&found);
    let exact = 20.0 / 17.0;
    assert!(done && held < 1.001 * exact && failed > 0.999 * exact, "{found}");
    let (done, found) = search(-20.5);
    assert!(!done && !found.contains("factor of safety"), "{found}");
}

/// What an unloading leaves out of balance is not taken for failure: the search begins in equilibrium under its own load. By less load in its first
/// step it would move farther than soil may by the few per mille that the strength falls in it.
#[test]
fn a_search_after_unloading_finds_the_factor_of_what_is_left() {
    let load = |name: &str, load: f64| {
        format!(
            "- {{name: {name}, analysis: quasi_static, duration: 1, step: {{initial: 0.5}}, tractions: [{{on: top, ty: {load}}}]}}\n"
        )
    };
    let folder = solve_text(&format!(
        "geometry: plane_strain\n\
         mesh: {{geo: GEO/slump.geo, parameters: {{half_width: 1, height: 1, room: 0, h: 0.5}}}}\n\
         regions: {{block: {{kind: mpm, material: soil, points_per_cell: 12}}}}\n\
         materials: {{soil: {{model: tresca, shear_strength: 10, young: 1.0e+4, poisson: 0.3, density: 1}}}}\n\
         supports: {{bottom: {{uy: 0}}, axis: {{ux: 0}}}}\n\
         numerics: {{restore: never}}\n\
         phases:\n{}\
         - {{name: safety, analysis: strength_reduction, duration: 1, step: {{initial: 0.1, min: 0.001}}, \
             strength_reduction: {{table: [[0, 1], [1, 1.45]]}}, tractions: [{{on: top, ty: -14}}]}}\n\
         output: {{history: [{{name: top, on: top, quantities: [uy]}}]}}\n",
        load("load", -18.0)
    ));
    let [held, failed] = safety(&log(folder.path()));
    let exact = 20.0 / 14.0;
    println!("{held} to {failed}, exact {exact:.4}");
    assert!(failed - held < 1e-3 && held < exact * 1.002 && failed > exact * 0.998, "{held} to {failed}");
}

/// What the soil moves by is of the search alone, and grows as the strengths fall; the log has the same curve.
#[test]
fn the_curve_of_a_search_is_in_the_history_and_in_the_log() {
    let settings = ["mesh.parameters.h=2.5", "phases.safety.step.min=0.02", "phases.failure.duration=0.02"];
    let folder = solve("cases/slope_safety", &settings);
    let [factor, moved] = ["strength_reduction [-]", "soil_moved [m]"].map(|name| column(folder.path(), name));
    let search: Vec<usize> = (1..moved.len()).filter(|&i| moved[i] > 0.0).collect();
    let (first, last) = (search[0], *search.last().unwrap());
    assert_eq!([factor[first - 1], moved[first - 1]], [1.0, 0.0], "it begins in equilibrium at the first factor");
    assert!(search.windows(2).all(|w| moved[w[1]] >= moved[w[0]] && factor[w[1]] >= factor[w[0]]), "{moved:?}");
    assert!(last + 1 < moved.len() && moved[last + 1] == 0.0, "not in the phase after it");
    let log = log(folder.path());
    let curve =
        log.lines().find(|line| line.starts_with("factors of phase `safety`")).unwrap_or_else(|| panic!("{log}"));
    assert!(curve.contains(&format!("{:.4} {:.3e}", factor[last], moved[last])), "{curve}");
}

#[test]
fn what_bears_more_than_asked_is_told_so() {
    let folder = block("model: tresca, shear_strength: 100", -16.0);
    let log = log(folder.path());
    assert!(log.contains("factor of safety above 3.0000 (phase `safety`)"), "{log}");
    assert!(column(folder.path(), "no_equilibrium_at [-]").iter().all(|&f| f == 0.0));
}

/// The published factor of the slope is 1.4; the search is 0.02 wide on this mesh of 2 m, which errs by 4 % more than the fine
/// ones (README).
#[test]
fn a_coarse_slope_has_its_published_factor_of_safety() {
    let settings = ["mesh.parameters.h=2", "phases.safety.step.min=0.01", "phases.failure.duration=0.02"];
    let folder = solve("cases/slope_safety", &settings);
    let [held, failed] = safety(&log(folder.path()));
    println!("{held} to {failed}");
    assert!(failed - held < 0.021 && held > 1.4 * 0.97 && held < 1.4 * 1.05, "{held} to {failed}");
}

/// An elastic beam that swings: the same in one phase as in two, to the last bit.
#[test]
fn a_phase_that_ends_changes_nothing() {
    let phase = |name: &str, duration: f64, more: &str| {
        format!("{{name: {name}, analysis: dynamic, duration: {duration}, step: {{initial: 0.03125}}{more}}}")
    };
    let bend = "{name: bend, analysis: quasi_static, duration: 1, step: {initial: 0.25}, prescribe: {tip: {uy: {rate: -0.3}}}}";
    let history = |phases: &str| {
        let phases = format!("phases=[{bend}, {phases}]");
        let folder = solve("tests/data/release", &["mesh.parameters.h=0.5", "output.every=1", &phases]);
        fs::read_to_string(folder.path().join("history.csv")).unwrap()
    };
    let one = history(&phase("swing", 1.0, ""));
    let two = history(&format!("{}, {}", phase("swing", 0.5, ""), phase("on", 0.5, "")));
    assert_eq!(one, two);
    assert_eq!(one.lines().count(), 1 + 4 + 32);
    // A reset changes what is told from then on, and nothing else.
    let reset = history(&format!("{}, {}", phase("swing", 0.5, ""), phase("on", 0.5, ", reset_displacements: true")));
    let numbers = |line: &str| line.split(',').map(|n| n.parse().unwrap()).collect::<Vec<f64>>();
    let (one, reset): (Vec<_>, Vec<_>) = (one.lines().collect(), reset.lines().collect());
    assert_eq!(one[..21], reset[..21]);
    let at_reset = numbers(one[20]);
    for (a, b) in one[21..].iter().zip(&reset[21..]) {
        let (a, b) = (numbers(a), numbers(b));
        for column in [1, 2] {
            assert!((a[column] - at_reset[column] - b[column]).abs() < 1e-14, "{a:?} {b:?}");
        }
        assert_eq!(a[3..], b[3..]);
    }
}

/// What a run showed, but for the names of its phases and its origin.
fn frames(folder: &Path) -> Vec<Frame> {
    let results = folder.join("results");
    let count = fs::read_dir(&results).unwrap().count();
    let shown = |frame| Frame { phase: String::new(), origin: Origin::default(), ..frame };
    let read = |i| shown(Frame::read(&frame::path(&results, i)).unwrap());
    (0..count).map(read).collect()
}

fn values<'a>(frame: &'a Frame, name: &str) -> &'a [f64] {
    &frame.points.columns.iter().find(|column| column.name == name).unwrap().values
}

fn size(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>().sqrt()
}

/// What has found equilibrium without inertia stays there with it, and the other way round.
#[test]
fn a_change_of_analysis_keeps_the_equilibrium() {
    let load = "tractions: [{on: upper, ty: -2}]";
    let phases = format!(
        "phases=[{{name: load, analysis: quasi_static, duration: 1, step: {{initial: 0.5}}, {load}}}, \
         {{name: wait, analysis: dynamic, duration: 1, step: {{initial: 0.25}}, {load}}}, \
         {{name: rest, analysis: quasi_static, duration: 1, step: {{initial: 1}}, {load}}}]"
    );
    let folder = solve("tests/data/release", &["mesh.parameters.h=0.5", "numerics.tolerance=1e-12", &phases]);
    let moved = column(folder.path(), "tip.uy [m]");
    let loaded = moved[1];
    assert!(loaded < -1e-3);
    for u in &moved[2..] {
        assert!((u / loaded - 1.0).abs() < 1e-9, "{moved:?}");
    }
    assert!(column(folder.path(), "tip.vy [m/s]").iter().all(|v| v.abs() < 1e-9 * loaded.abs()));
}

/// The load of a phase that ends early stays at what it was when its condition was met.
#[test]
fn a_phase_ends_when_its_condition_is_met() {
    let phases = "phases=[{name: bend, analysis: quasi_static, duration: 1, step: {initial: 0.0625}, \
        prescribe: {tip: {uy: {rate: -0.3}}}, until: [{of: tip, quantity: uy, below: -0.1}]}, \
        {name: swing, analysis: dynamic, duration: 40, step: {initial: 0.05, max: 0.2}, until: [{equilibrium: 1.0e-3}]}]";
    let settings = ["mesh.parameters.h=0.5", "output.every=100", "numerics.spectral_radius=0", phases];
    let folder = solve("tests/data/release", &settings);
    let log = log(folder.path());
    assert!(log.contains("phase `bend` ends: tip.uy [m] is -1.125"), "{log}");
    assert!(log.contains("phase `swing` ends: the kinetic energy is"), "{log}");
    let time = column(folder.path(), "time [s]");
    assert_eq!(time[5], 0.375);
    assert!(time[6] > 0.375 && time[time.len() - 1] < 40.0, "{time:?}");
    let frames = fs::read_dir(folder.path().join("results")).unwrap().count();
    assert_eq!(frames, 3, "the first one, and one at the end of each phase");
}

/// A structure that is taken away touches nothing, and does again once it is back.
#[test]
fn what_is_deactivated_carries_nothing() {
    let press = "prescribe: {top: {uy: {rate: -0.002}}}";
    let phases = format!(
        "phases=[{{name: press, analysis: quasi_static, duration: 1, step: {{initial: 0.5}}, {press}}}, \
         {{name: without, analysis: quasi_static, duration: 1, step: {{initial: 1}}, deactivate: [upper]}}, \
         {{name: back, analysis: quasi_static, duration: 1, step: {{initial: 1}}, activate: [upper], prescribe: {{top: {{uy: 0}}}}}}]"
    );
    let folder = solve("tests/data/blocks", &[&phases]);
    let force = column(folder.path(), "lower.contact_y [kN]");
    assert_eq!(force.len(), 4);
    assert!(force[1] < -1e-3 && force[2] == 0.0, "{force:?}");
    assert!((force[3] / force[1] - 1.0).abs() < 1e-2, "{force:?}");
}

/// The force (kN) of confined soil, 1 m deep and 2 m wide, on a plate that is `depth` (m) in it, by Hencky's law: `M ln λ / λ`.
fn pressed(depth: f64) -> f64 {
    let (modulus, stretch) = (1000.0 * 0.7 / (1.3 * 0.4), 1.0 - depth);
    -2.0 * modulus * stretch.ln() / stretch
}

/// How deep (m) that is where the force is `force` (kN).
fn depth(force: f64) -> f64 {
    let (mut low, mut high) = (0.0, 0.5);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        (low, high) = if pressed(middle) < force { (middle, high) } else { (low, middle) };
    }
    low
}

/// What a plate on soil does in phases, of which the last entries are given: a phase of equal steps each.
fn plate(phases: &[(f64, &str)], settings: &[&str]) -> TempDir {
    let phase = |(i, (step, more)): (usize, &(f64, &str))| {
        format!("{{name: phase {i}, analysis: quasi_static, duration: 1, step: {{initial: {step}}}, {more}}}")
    };
    let all: Vec<String> = phases.iter().enumerate().map(phase).collect();
    let phases = format!("phases=[{}]", all.join(", "));
    let history = "output.history=[{name: plate, on: plate, quantities: [uy, contact_y]}, \
        {name: top, on: top, quantities: [reaction_y]}, {name: soil, on: soil, quantities: [uy]}]";
    solve("tests/data/plate", &[&[phases.as_str(), history], settings].concat())
}

/// A displacement that a phase begins with acts once, in its first step, on soil that yields too: as much as if it came at a rate.
#[test]
fn a_displacement_at_the_beginning_of_a_phase_acts_once() {
    let clay = "materials.soil={model: tresca, young: 1000, poisson: 0.3, shear_strength: 10, density: 0}";
    let press = |how: &str| {
        let [first, second] = [(0.125, "{rate: -0.02}"), (1.0, how)]
            .map(|(step, how)| (step, format!("prescribe: {{top: {{ux: 0, uy: {how}}}}}")));
        let folder = plate(&[(first.0, &first.1), (second.0, &second.1)], &[clay, "numerics.restore=every_step"]);
        rows(folder.path()).last().unwrap().clone()
    };
    let (at_once, at_a_rate) = (press("-0.005"), press("{rate: -0.005}"));
    println!("{at_once:?} {at_a_rate:?}");
    assert!(at_a_rate[2] > 1.0);
    assert_eq!(at_once, at_a_rate);
}

fn near(found: f64, exact: f64, part: f64) -> bool {
    (found / exact - 1.0).abs() < part
}

/// The first step that comes to the force ends the phase, and the next one goes on from there.
#[test]
fn a_phase_ends_when_its_force_is_reached() {
    let down = "prescribe: {top: {ux: 0, uy: {rate: -0.08}}}";
    let folder = plate(
        &[
            (0.0625, &format!("{down}, until: [{{of: plate, quantity: contact_y, above: 100}}]")),
            (1.0, "prescribe: {top: {ux: 0, uy: 0}}"),
            (0.0625, &format!("{down}, until: [{{of: top, quantity: reaction_y, below: -200}}]")),
        ],
        &[],
    );
    let [time, force, held] =
        ["time [s]", "plate.contact_y [kN]", "top.reaction_y [kN]"].map(|name| column(folder.path(), name));
    // Steps of half a centimetre, the eighth and the fourteenth of which are the first ones beyond.
    assert!(pressed(0.035) < 99.5 && pressed(0.04) > 101.0 && pressed(0.065) < 198.0 && pressed(0.07) > 202.0);
    let expected = (1..=8).map(|k| (k as f64 * 0.0625, k)).chain([(1.5, 8)]);
    let expected: Vec<_> = expected.chain((9..=14).map(|k| (1.5 + (k - 8) as f64 * 0.0625, k))).collect();
    assert_eq!(time, expected.iter().map(|row| row.0).collect::<Vec<_>>());
    for ((force, held), (_, k)) in force.iter().zip(&held).zip(expected) {
        println!("{force:.3} kN of {:.3} kN", pressed(0.005 * k as f64));
        assert!(near(*force, pressed(0.005 * k as f64), 2.5e-3) && near(*held, -force, 1e-8), "{force} {held}");
    }
    let log = log(folder.path());
    assert!(log.contains("phase `phase 0` ends: plate.contact_y [kN] is 1.144"), "{log}");
    assert!(log.contains("phase `phase 2` ends: top.reaction_y [kN] is -2.100"), "{log}");
}

/// Without its contact a plate is in the soil or beyond it and feels nothing, nor does the soil; with it again it bears by its depth.
#[test]
fn a_contact_is_taken_away_by_its_name() {
    let down = |way: f64| format!("prescribe: {{top: {{ux: 0, uy: {{rate: {way}}}}}}}");
    let folder = plate(
        &[
            (0.25, &down(-0.05)),
            (0.25, &format!("deactivate: [base], {}", down(0.06))),
            (0.125, &format!("activate: [base], {}", down(-0.08))),
        ],
        &["contacts=[{name: base, structure: plate, soil: soil}]"],
    );
    let [uy, force, held, soil] = ["plate.uy [m]", "plate.contact_y [kN]", "top.reaction_y [kN]", "soil.uy [m]"]
        .map(|name| column(folder.path(), name));
    println!("{uy:?} {force:?} {held:?} {soil:?}");
    for i in [1, 2, 3, 10, 11, 12, 13, 14, 15] {
        println!("{} m: {:+.1e}", uy[i], force[i] / pressed(-uy[i]) - 1.0);
        assert!(near(force[i], pressed(-uy[i]), 2e-3), "{} {}", force[i], pressed(-uy[i]));
    }
    // What the equilibrium of the step before it left out of balance, at most a hundred millionth of the forces, may be found here.
    assert!(force[8].abs() < 1e-9 * force[3], "it is back where it just touches");
    assert!(uy[4] < -0.03, "it is in the soil");
    for i in 4..8 {
        assert!(force[i] == 0.0 && held[i].abs() < 1e-7 && soil[i].abs() < 1e-8, "{force:?} {held:?} {soil:?}");
    }
}

/// A plate of 60 kN, rigid and not: pressed in, let go to where its weight is borne, moved on from there, taken away, and laid down again.
#[test]
fn a_structure_is_held_and_free_and_held_again_and_taken_away() {
    let down = "prescribe: {top: {ux: 0, uy: {table: [[0, 0], [1, -0.03]]}}}";
    let free = "prescribe: {top: {ux: 0}}";
    let phases = [
        (0.25, "prescribe: {top: {ux: 0, uy: {rate: -0.08}}}"),
        (0.25, free),
        (0.25, down),
        (0.25, free),
        (0.5, "deactivate: [plate]"),
        (0.25, &format!("activate: [plate], {free}")),
    ];
    for rigid in [true, false] {
        let rigid = format!("regions.plate.rigid={rigid}");
        let folder = plate(&phases, &[&rigid, "materials.plate.density=10", "gravity={y: -10}"]);
        let [uy, force, held, soil] = ["plate.uy [m]", "plate.contact_y [kN]", "top.reaction_y [kN]", "soil.uy [m]"]
            .map(|name| column(folder.path(), name));
        // Held, at depths that it is given.
        for i in [1, 2, 3, 8, 9, 10, 11] {
            println!("{rigid}, {} m: {:+.1e}", uy[i], force[i] / pressed(-uy[i]) - 1.0);
            assert!(near(force[i], pressed(-uy[i]), 2e-3) && near(held[i], 60.0 - force[i], 1e-6), "{i}: {force:?}");
        }
        // Free, from above and from below: the soil bears its weight, as deep as that presses it.
        for i in [7, 15] {
            println!("{rigid}, free: {:+.1e} of {:.5} m", -uy[i] / depth(60.0) - 1.0, depth(60.0));
            assert!(near(uy[i], -depth(60.0), 1e-4), "{uy:?}");
        }
        for i in [4, 5, 6, 7, 12, 13, 14, 15, 18, 19, 20, 21] {
            assert!(near(force[i], 60.0, 1e-9) && held[i].abs() < 1e-9, "{i}: {force:?} {held:?}");
        }
        // Away it stays where it was, and the soil comes back to where that began; laid down again it presses the soil as before.
        for i in [16, 17] {
            assert!(uy[i] == uy[15] && force[i] == 0.0 && soil[i].abs() < 1e-11, "{uy:?} {force:?} {soil:?}");
        }
        println!("{rigid}, again: {:+.1e}", soil[21] / soil[15] - 1.0);
        assert!(near(soil[21], soil[15], 2e-3), "{soil:?}");
    }
}

/// A block that cannot bear its weight: without inertia as long as it stands, with it while it falls, and without again.
#[test]
fn failure_is_handed_to_dynamics_and_back() {
    let settings = [
        "mesh.parameters.h=2",
        "phases.gravity.analysis=auto",
        "phases.gravity.step={initial: 0.05, min: 0.02, max: 0.05}",
        "phases.gravity.duration=12",
        "phases.gravity.gravity={table: [[0, 0], [1, 1]]}",
        "supports.bottom={ux: 0, uy: 0}",
        "numerics.spectral_radius=0.5",
    ];
    let folder = solve("cases/slump", &settings);
    let log = log(folder.path());
    let falls =
        log.lines().position(|line| line.contains("goes on with inertia from")).unwrap_or_else(|| panic!("{log}"));
    let rests =
        log.lines().position(|line| line.contains("is quasi-static again from")).unwrap_or_else(|| panic!("{log}"));
    assert!(0 < falls && falls < rests, "{log}");
    let moved = column(folder.path(), "block.uy [m]");
    assert!(moved[moved.len() - 1] < -0.5, "{moved:?}");
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    /// The same of soil that flows and crosses cells: with inertia, along a plate, and with water in its pores beneath a strip. A reset changes the
    /// displacements alone, those of points apart that are pushed out of the plate, and then stand for soil from elsewhere. Rates are sums of few powers of two, so that what is prescribed comes to the same bits from either beginning.
    #[test]
    fn a_phase_that_ends_changes_nothing_in_soil_that_yields() {
        let clay = "model: tresca, young: 1000, poisson: 0.3, shear_strength: 20, density: 0";
        let pores = "drainage: undrained, permeability: 9.0e-7, porosity: 0.5, water_bulk_modulus: 1.0e+4";
        let porous = format!(
            "materials.clay={{model: tresca, young: 1000, poisson: 0.2, shear_strength: 2, density: 0, {pores}}}"
        );
        let soil = format!("materials.soil={{{clay}}}");
        let press = |what: &str| {
            format!(
                "{{name: press, analysis: quasi_static, duration: 1, step: {{initial: 0.25}}, prescribe: {what}}}, "
            )
        };
        let scenes = [
            (
                "cases/slump",
                vec!["mesh.parameters.h=2", "supports.bottom={ux: 0, uy: 0}", "output.every=0.5"],
                String::new(),
                (2.0, "analysis: dynamic, step: {initial: 0.03125}"),
            ),
            (
                "tests/data/plate",
                vec![
                    &soil,
                    "mesh.parameters={plate: 0.8, left: 0.6, edge: 0.05}",
                    "contacts=[{structure: plate, soil: soil, adhesion_factor: 0.5}]",
                    "output.every=0.5",
                ],
                press("{top: {ux: 0, uy: {rate: -0.0625}}}"),
                (1.0, "analysis: quasi_static, step: {initial: 0.0625}, prescribe: {top: {ux: {rate: 0.125}, uy: 0}}"),
            ),
            (
                "tests/data/strip",
                vec![&porous, "output.every=256"],
                press("{strip: {ux: 0, rotation: 0, uy: {rate: -0.0078125}}}"),
                (
                    512.0,
                    "analysis: consolidation, step: {initial: 64}, \
                 prescribe: {strip: {rotation: 0, ux: {rate: 7.62939453125e-6}, uy: {rate: -7.62939453125e-6}}}",
                ),
            ),
        ];
        for (case, settings, before, (duration, what)) in scenes {
            let shown = |parts: &[(f64, &str)]| {
                let phase = |(i, (part, more)): (usize, &(f64, &str))| {
                    format!("{{name: on {i}, duration: {}, {what}{more}}}", part * duration)
                };
                let all: Vec<String> = parts.iter().enumerate().map(phase).collect();
                let phases = format!("phases=[{before}{}]", all.join(", "));
                let more = [
                    "numerics.restore=every_step",
                    "output.fields=[displacement, stress, plastic_strain, mass]",
                    &phases,
                ];
                let folder = solve(case, &[&settings[..], &more].concat());
                (frames(folder.path()), fs::read_to_string(folder.path().join("history.csv")).unwrap())
            };
            let (one, history) = shown(&[(1.0, "")]);
            let last = &one[one.len() - 1];
            let yields = values(last, "plastic_strain").iter().filter(|strain| **strain > 1e-3).count();
            println!("{case}: {yields} of {} points yielded, in {} steps", last.points.position.len(), last.step);
            assert!(yields > last.points.position.len() / 20 && last.step >= 12, "{case}: {yields}");
            let (two, again) = shown(&[(0.5, ""), (0.5, "")]);
            assert!(one == two && history == again, "{case}");

            let (reset, _) = shown(&[(0.5, ""), (0.5, ", reset_displacements: true")]);
            let middle = one.iter().position(|frame| frame.time >= last.time - 0.5 * duration).unwrap();
            assert_eq!(one[..=middle], reset[..=middle], "{case}");
            let [before, mass] = ["displacement", "mass"].map(|name| values(&one[middle], name));
            let mut off = 0f64;
            for (one, reset) in one.iter().zip(&reset).skip(middle + 1) {
                assert_eq!(one.points.position, reset.points.position, "{case}");
                for name in ["stress", "plastic_strain", "mass"] {
                    assert_eq!(values(one, name), values(reset, name), "{case}");
                }
                // Halves of a point that was split since then have been displaced since then as it has been, but not since the seeding.
                let whole: Vec<bool> = values(one, "mass").iter().zip(mass).map(|(now, then)| now == then).collect();
                assert!(whole.iter().filter(|whole| **whole).count() > mass.len() * 9 / 10, "{case}");
                let deep = one.points.position.iter().zip(whole);
                let deep = deep.flat_map(|(x, whole)| [whole && (x[1] < -0.3 || case != "tests/data/plate"); 3]);
                let [one, reset] = [one, reset].map(|frame| values(frame, "displacement"));
                assert!(size(reset) < 0.9 * size(one), "{case}");
                let error = one.iter().zip(before).zip(reset).map(|((a, b), c)| (a - b - c).abs());
                off = error.zip(deep).filter(|(_, deep)| *deep).map(|(error, _)| error).fold(off, f64::max);
            }
            println!("displacements are off by {off:.1e} m");
            assert!(off < 1e-14, "{case}: {off:e}");
        }
    }
}

/// Where the points of a cell do not see all linear motions, as the single one of a triangle of first order, the first acceleration once divided what was
/// left of Newton's tolerance by next to no mass.
#[test]
fn a_block_at_rest_stays_at_rest_as_inertia_comes_in() {
    for lattice in ["mesh.parameters.alternate=0", "mesh.parameters.alternate=1"] {
        for restore in ["every_step", "{min_quality: 0.5}"] {
            let settings = [lattice, &format!("numerics.restore={restore}")];
            let log = log(solve("tests/data/rest", &settings).path());
            let words: Vec<&str> = log.split_whitespace().collect();
            let most = |name: &str| {
                let values = words.windows(2).filter(|pair| pair[0] == name).filter_map(|pair| pair[1].parse().ok());
                values.fold(0.0, f64::max)
            };
            let (kinetic, elastic) = (most("kinetic"), most("elastic"));
            assert!(
                kinetic > 0.0 && kinetic < 0.01 * elastic,
                "{settings:?}: {kinetic:.1e} kJ beside {elastic:.1e} kJ"
            );
        }
    }
}
