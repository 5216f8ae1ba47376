//! What phases do, through the program: the factor of safety against closed forms and a published slope.

mod history;

use history::column;
use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// Runs a case to its end.
fn run(case: &Path, settings: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for stage in ["mesh", "seed", "solve"] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_mpm"));
        command.arg(stage).arg(case).arg("-o").arg(folder.path());
        for setting in settings {
            command.args(["--set", setting]);
        }
        let output = command.output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    folder
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn log(folder: &Path) -> String {
    fs::read_to_string(folder.join("solve.log")).unwrap()
}

/// The factor of safety as the log has it: equilibrium and none.
fn bracket(log: &str) -> [f64; 2] {
    let line = log.lines().find(|line| line.starts_with("factor of safety")).unwrap_or_else(|| panic!("{log}"));
    let words: Vec<&str> = line.split(' ').collect();
    [words[3], words[5]].map(|number| number.parse().unwrap_or_else(|_| panic!("{line}")))
}

/// A block between smooth plates, loaded from above; weightless, and half of it.
fn block(material: &str, load: f64) -> TempDir {
    let file = tempfile::tempdir().unwrap();
    let text = format!(
        "geometry: plane_strain\n\
         mesh: {{geo: {}, parameters: {{half_width: 1, height: 1, room: 0, h: 0.5}}}}\n\
         regions: {{block: {{kind: mpm, material: soil, points_per_cell: 12}}}}\n\
         materials: {{soil: {{{material}, young: 1.0e+6, poisson: 0.3, density: 1}}}}\n\
         supports: {{bottom: {{uy: 0}}, axis: {{ux: 0}}}}\n\
         numerics: {{restore: never}}\n\
         phases:\n\
         - {{name: load, analysis: quasi_static, duration: 1, step: {{initial: 1}}, tractions: [{{on: top, ty: {load}}}]}}\n\
         - {{name: safety, analysis: strength_reduction, duration: 2, step: {{initial: 0.05, min: 0.0002}}, \
             tractions: [{{on: top, ty: {load}}}]}}\n\
         - {{name: after, analysis: quasi_static, duration: 1, step: {{initial: 1}}, tractions: [{{on: top, ty: {load}}}]}}\n\
         output: {{history: [{{name: top, on: top, quantities: [uy]}}]}}\n",
        root().join("geo/slump.geo").display()
    );
    fs::write(file.path().join("case.yaml"), text).unwrap();
    run(file.path(), &[])
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
        let [held, failed] = bracket(&log(folder.path()));
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
        let file = tempfile::tempdir().unwrap();
        let text = format!(
            "geometry: plane_strain\n\
             mesh: {{geo: {}, parameters: {{half_width: 1, height: 1, room: 0, h: 0.5}}}}\n\
             regions: {{block: {{kind: mpm, material: soil, points_per_cell: 12}}}}\n\
             materials: {{soil: {{model: tresca, shear_strength: 10, young: 1.0e+6, poisson: 0.3, density: 1}}}}\n\
             supports: {{bottom: {{uy: 0}}, axis: {{ux: 0}}}}\n\
             numerics: {{restore: never}}\n\
             phases:\n\
             - {{name: safety, analysis: strength_reduction, duration: 1, step: {{initial: 0.05, min: 0.0002}}, \
                 tractions: [{{on: top, ty: {load}}}]}}\n",
            root().join("geo/slump.geo").display()
        );
        fs::write(file.path().join("case.yaml"), text).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let mut command = Command::new(env!("CARGO_BIN_EXE_mpm"));
        let output = command.arg("run").arg(file.path()).arg("-o").arg(folder.path()).output().unwrap();
        (output.status.success(), log(folder.path()))
    };
    let (done, found) = search(-17.0);
    let [held, failed] = bracket(&found);
    let exact = 20.0 / 17.0;
    assert!(done && held < 1.001 * exact && failed > 0.999 * exact, "{found}");
    let (done, found) = search(-20.5);
    assert!(!done && !found.contains("factor of safety"), "{found}");
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
    let folder = run(&root().join("cases/slope_safety"), &settings);
    let [held, failed] = bracket(&log(folder.path()));
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
    let case = root().join("tests/data/release");
    let history = |phases: &str| {
        let phases = format!("phases=[{bend}, {phases}]");
        let folder = run(&case, &["mesh.parameters.h=0.5", "output.every=1", &phases]);
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

/// What has found equilibrium without inertia stays there with it, and the other way round.
#[test]
fn a_change_of_analysis_keeps_the_equilibrium() {
    let load = "tractions: [{on: upper, ty: -2}]";
    let phases = format!(
        "phases=[{{name: load, analysis: quasi_static, duration: 1, step: {{initial: 0.5}}, {load}}}, \
         {{name: wait, analysis: dynamic, duration: 1, step: {{initial: 0.25}}, {load}}}, \
         {{name: rest, analysis: quasi_static, duration: 1, step: {{initial: 1}}, {load}}}]"
    );
    let folder =
        run(&root().join("tests/data/release"), &["mesh.parameters.h=0.5", "numerics.tolerance=1e-12", &phases]);
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
    let folder = run(&root().join("tests/data/release"), &settings);
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
    let folder = run(&root().join("tests/data/blocks"), &[&phases]);
    let force = column(folder.path(), "lower.contact_y [kN]");
    assert_eq!(force.len(), 4);
    assert!(force[1] < -1e-3 && force[2] == 0.0, "{force:?}");
    assert!((force[3] / force[1] - 1.0).abs() < 1e-2, "{force:?}");
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
    let folder = run(&root().join("cases/slump"), &settings);
    let log = log(folder.path());
    let falls =
        log.lines().position(|line| line.contains("goes on with inertia from")).unwrap_or_else(|| panic!("{log}"));
    let rests =
        log.lines().position(|line| line.contains("is quasi-static again from")).unwrap_or_else(|| panic!("{log}"));
    assert!(0 < falls && falls < rests, "{log}");
    let moved = column(folder.path(), "block.uy [m]");
    assert!(moved[moved.len() - 1] < -0.5, "{moved:?}");
}
