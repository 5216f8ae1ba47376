//! How phases end and what the next one begins with, through the program, where several parts meet.

use crate::support::{self, column, mpm, stage};
use mpm::io::frame::{self, Frame, UNCOUNTED};
use std::fs;
use tempfile::TempDir;

/// Runs a case to its end; returns its folder and log.
fn run(case: &str, settings: &[&str]) -> (TempDir, String) {
    let folder = support::run(case, settings);
    let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
    (folder, log)
}

/// A pressure that ends a phase is that of the entry that is asked for, whatever else is watched before it.
#[test]
fn a_pore_pressure_ends_a_phase() {
    let settings = [
        "output.history=[{name: strip, on: strip, quantities: [uy, contact_y]}, \
            {name: beside, on: beside, quantities: [uy, pore_pressure]}, \
            {name: bottom, on: bottom, quantities: [uy, pore_pressure]}]",
        "phases.wait.until=[{of: bottom, quantity: pore_pressure, below: 0.046}]",
    ];
    let (folder, log) = run("tests/data/strip", &settings);
    let pressure = column(folder.path(), "bottom.pore_pressure [kPa]");
    let (last, before) = (pressure[pressure.len() - 1], &pressure[2..pressure.len() - 1]);
    assert!(last <= 0.046 && before.len() > 3 && before.iter().all(|p| *p > 0.046), "{pressure:?}");
    assert!(log.contains("phase `wait` ends: bottom.pore_pressure [kPa] is"), "{log}");
}

/// A phase that fails, falls and waits for a rest that is farther off than that at which it would go on without inertia.
#[test]
fn a_fall_ends_with_the_rest_that_is_asked_for() {
    let settings = [
        "mesh.parameters.h=2",
        "phases.gravity.analysis=auto",
        "phases.gravity.step={initial: 0.05, min: 0.02, max: 0.05}",
        "phases.gravity.duration=60",
        "phases.gravity.gravity={table: [[0, 0], [1, 1]]}",
        "phases.gravity.until=[{equilibrium: 3.0e-3}]",
        "supports.bottom={ux: 0, uy: 0}",
        "numerics.spectral_radius=0.5",
    ];
    let (folder, log) = run("cases/slump", &settings);
    assert!(log.contains("goes on with inertia from") && !log.contains("is quasi-static again"), "{log}");
    assert!(log.contains("phase `gravity` ends: the kinetic energy is"), "{log}");
    let time = column(folder.path(), "time [s]");
    assert!(time[time.len() - 1] < 60.0, "{time:?}");
}

/// Soil that fails and comes to stand in another shape without inertia is told, once; soil that stands, or is moved, is not.
#[test]
fn a_jump_to_another_equilibrium_is_told() {
    for (analysis, cohesion, driven, jumps) in [
        ("quasi_static", 5, "", true),
        ("auto", 5, "", true),
        ("quasi_static", 50, "", false),
        ("quasi_static", 5, "prescribe: {end: {uy: {rate: 0.1}}}", false),
    ] {
        let phases = format!(
            "phases=[{{name: gravity, analysis: {analysis}, duration: 0.6, step: {{initial: 0.05, min: 0.0001}}, \
              gravity: {{rate: 1}}, {driven}}}]"
        );
        let strength = format!("materials.soil.cohesion={cohesion}");
        let (folder, log) = run("cases/slump", &["mesh.parameters.h=2", &strength, &phases]);
        // Half the height of the block; its points move farther than they do in the mean.
        let moved = column(folder.path(), "block.ux [m]").pop().unwrap();
        assert_eq!(moved > 4.0, cohesion == 5, "{moved}");
        let told = "warning: phase `gravity`: without inertia the soil has moved by";
        assert_eq!(log.matches(told).count(), usize::from(jumps), "{analysis} {cohesion} {driven}: {log}");
    }
}

/// Soil that settles by half its height because it is compressed has not failed, and what it leaves empty above it is air; elastic or yielding (a
/// confined column yields where its lateral pressure is less than the active one).
#[test]
fn a_column_that_settles_far_has_not_jumped_and_opens_no_void() {
    let case = |material: &str, restore: &str| {
        format!(
            "geometry: plane_strain\nmesh: {{geo: GEO/slump.geo, parameters: {{half_width: 1, height: 5, room: 0, h: 0.5}}}}\n\
             regions: {{block: {{kind: mpm, material: soft}}}}\nmaterials: {{soft: {{{material}, young: 13, poisson: 0.2, unit_weight: 16}}}}\n\
             supports: {{bottom: {{ux: 0, uy: 0}}, axis: {{ux: 0}}, face: {{ux: 0}}}}\ngravity: {{y: -9.81}}\nnumerics: {{restore: {restore}}}\n\
             phases: [{{name: gravity, analysis: quasi_static, duration: 1, step: {{initial: 0.05}}, gravity: {{rate: 1}}}}]\n\
             output: {{fields: [displacement], history: [{{name: top, on: top, quantities: [uy]}}]}}\n"
        )
    };
    for material in ["model: linear_elastic", "model: mohr_coulomb, cohesion: 0.5, friction: 20"] {
        for restore in ["every_step", "{min_quality: 0.5}"] {
            let folder = support::solve_text(&case(material, restore));
            let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
            let settled = column(folder.path(), "top.uy [m]").pop().unwrap();
            assert!(settled < -2.5, "{settled}");
            let mut warnings = log.lines().filter(|line| line.contains("warning"));
            assert!(warnings.all(|line| line.contains("yields under its own weight")), "{material}, {restore}: {log}");
        }
    }
}

/// A phase with inertia that waits for equilibrium has nothing to wait for where it begins in equilibrium, and its loads stay. Where a load
/// comes later, or the soil is out of balance, it goes on.
#[test]
fn a_phase_that_begins_in_equilibrium_ends_with_its_first_step() {
    let steps = |restore: &str, weight: &str, strength: &str| {
        let phases = format!(
            "phases=[{{name: gravity, analysis: quasi_static, duration: 1, step: {{initial: 0.25}}, gravity: {{rate: 1}}}}, \
              {{name: wait, analysis: dynamic, duration: 0.4, step: {{initial: 0.02}}, {weight} {strength} \
              until: [{{equilibrium: 1.0e-3}}]}}]"
        );
        let strong = "materials.soil.cohesion=50";
        let settings = ["mesh.parameters.h=2", "supports.bottom={ux: 0, uy: 0}", strong, restore, &phases];
        let (_, log) = run("cases/slump", &settings);
        assert_eq!(log.contains("phase `wait` ends: it began at rest"), log.matches(" wait t ").count() == 1, "{log}");
        log.matches(" wait t ").count()
    };
    for restore in ["numerics.restore=never", "numerics.restore={min_quality: 0.5}"] {
        assert_eq!(steps(restore, "", ""), 1, "{restore}");
        assert!(steps(restore, "gravity: {table: [[0, 1], [0.3, 1], [0.4, 1.1]]},", "") > 10, "{restore}");
        assert!(steps(restore, "", "strength_reduction: 1.5,") > 10, "{restore}");
    }
}

/// What a motion left, which falls no further, does not keep a phase waiting; nor does soil on which nothing acts.
#[test]
fn a_phase_in_which_nothing_moves_ends() {
    let wait = |before: &str, more: &str| {
        let phases = format!(
            "phases=[{before}{{name: wait, analysis: dynamic, duration: 0.4, step: {{initial: 0.02}}, {more} \
              until: [{{equilibrium: 1.0e-3}}]}}]"
        );
        let strong = "materials.soil.cohesion=50";
        let settings =
            ["mesh.parameters.h=2", "supports.bottom={ux: 0, uy: 0}", strong, "numerics.spectral_radius=1", &phases];
        run("cases/slump", &settings).1
    };
    let before = "{name: gravity, analysis: quasi_static, duration: 1, step: {initial: 0.25}, gravity: {rate: 1}}, \
        {name: stand, analysis: dynamic, duration: 0.1, step: {initial: 0.02}}, ";
    let log = wait(before, "");
    assert!(log.contains("phase `wait` ends: nothing moves") && log.matches(" wait t ").count() == 1, "{log}");
    // Not before a load that is to come.
    assert!(wait(before, "gravity: {table: [[0, 1], [0.3, 1], [0.4, 1.1]]},").matches(" wait t ").count() > 10);
    let log = wait("", "gravity: 0,");
    assert!(log.contains("phase `wait` ends: it began at rest") && log.matches(" wait t ").count() == 1, "{log}");
}

/// A plate that went through soil while their contact was away is not there again without a word.
#[test]
fn soil_in_a_structure_that_touches_again_is_told() {
    let phases = "phases=[{name: through, analysis: quasi_static, duration: 1, step: {initial: 1}, deactivate: [bearing], \
        prescribe: {top: {ux: 0, uy: -0.8}}}, \
        {name: back, analysis: quasi_static, duration: 1, step: {initial: 1}, activate: [bearing], prescribe: {top: {ux: 0, uy: 0}}}]";
    let contact = "contacts=[{name: bearing, structure: plate, soil: soil}]";
    for rigid in [false, true] {
        let folder = tempfile::tempdir().unwrap();
        let kind = format!("regions.plate.rigid={rigid}");
        let phases = if rigid { phases.replace("top: {", "plate: {rotation: 0, ") } else { phases.to_string() };
        let output = mpm(
            "run",
            "tests/data/plate",
            folder.path(),
            &[&phases, contact, "mesh.parameters={thick: 0.9, air: 1}", &kind],
        );
        let told = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(1), "{told}");
        let words =
            ["contact of `plate`", "phase `back` brings the structure back into soil", "points of `soil` are in it"];
        for words in words {
            assert!(told.contains(words), "{told}");
        }
        let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
        assert!(log.contains("the analysis ends here"), "{log}");
    }
}

/// An associated material whose strength is raised is one still.
#[test]
fn strengths_divided_by_less_than_one_are_those_given() {
    let soil = |cohesion: f64, friction: f64| {
        format!(
            "materials.soil={{model: mohr_coulomb, young: 1000, poisson: 0.3, cohesion: {cohesion}, friction: {friction}, \
             dilation: {friction}, density: 0}}"
        )
    };
    let phases = |reduction: &str| {
        format!(
            "phases=[{{name: press, analysis: quasi_static, duration: 1, step: {{initial: 0.1}}, {reduction}\
             prescribe: {{top: {{ux: 0, uy: {{rate: -0.05}}}}}}}}]"
        )
    };
    let narrow = ["mesh.parameters={plate: 0.8, left: 0.6, edge: 0.05}", "numerics.tolerance=1e-10"];
    let tan = 20f64.to_radians().tan();
    let with = |soil: &str, phases: &str| run("tests/data/plate", &[narrow[0], narrow[1], soil, phases]);
    let (given, given_log) = with(&soil(5.0 / 0.8, (tan / 0.8).atan().to_degrees()), &phases(""));
    let (divided, log) = with(&soil(5.0, 20.0), &phases("strength_reduction: 0.8, "));
    let force = |folder: &TempDir| column(folder.path(), "plate.contact_y [kN]").pop().unwrap();
    let (given, divided) = (force(&given), force(&divided));
    println!("{given} {divided}");
    assert!((divided / given - 1.0).abs() < 1e-7, "{given} {divided}");
    assert_eq!(log.matches("halved").count(), given_log.matches("halved").count(), "{log}");
}

/// What displacements are not counted from after a reset goes to the frames, for the nodes of structures.
#[test]
fn a_reset_is_told_to_the_frames() {
    let phases = "phases=[{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.5}, \
        prescribe: {top: {ux: 0, uy: {rate: -0.01}}}}, \
        {name: hold, analysis: quasi_static, duration: 1, step: {initial: 1}, reset_displacements: true, \
        prescribe: {top: {ux: 0, uy: 0}}}]";
    let (folder, _) = run("tests/data/plate", &[phases]);
    let uncounted = |frame: usize| {
        let frame = Frame::read(&frame::path(&folder.path().join("results"), frame)).unwrap();
        frame.grid.columns.into_iter().find(|column| column.name == UNCOUNTED)
    };
    assert!(uncounted(1).is_none(), "nothing is reset before the second phase");
    let least = uncounted(2).unwrap().values.chunks_exact(3).map(|u| u[1]).fold(0.0, f64::min);
    assert!((least + 0.01).abs() < 1e-4, "{least}");
}

/// A run that fails where it wrote a frame last, and fails again when it is resumed, writes no frame twice.
#[test]
fn a_failure_that_is_repeated_writes_no_other_frame() {
    let settings = [
        "mesh.parameters={plate: 0.8, left: 0.6, edge: 0.05}",
        "materials.soil={model: tresca, young: 1000, poisson: 0.49, shear_strength: 10, density: 0}",
        "phases=[{name: load, analysis: quasi_static, duration: 1, step: {initial: 0.1, min: 0.06}, \
          tractions: [{on: top, ty: {rate: -200}}], prescribe: {top: {ux: 0}}}]",
        "output.every=0.1",
    ];
    let folder = tempfile::tempdir().unwrap();
    let frames = || fs::read_dir(folder.path().join("results")).unwrap().count();
    for stage in ["mesh", "seed"] {
        assert!(mpm(stage, "tests/data/plate", folder.path(), &settings).status.success());
    }
    assert_eq!(mpm("solve", "tests/data/plate", folder.path(), &settings).status.code(), Some(1));
    let first = frames();
    let mut again = stage("solve", "tests/data/plate", folder.path(), &settings);
    assert_eq!(again.arg("--resume").output().unwrap().status.code(), Some(1));
    assert!(first > 2, "{first}");
    assert_eq!(frames(), first);
}

/// Sand without cohesion whose elastic lateral pressure is less than the active one, between walls with friction, yields everywhere from the first
/// step on, and its first tangent is singular. What the floor and the walls bear is its weight.
#[test]
fn sand_without_cohesion_fills_a_bin_from_the_first_step() {
    let case = "geometry: plane_strain\nmesh: {geo: GEO/slump.geo, parameters: {half_width: 5, height: 19.8, room: 0, h: 0.833}}\n\
        regions: {block: {kind: mpm, material: sand}}\n\
        materials: {sand: {model: mohr_coulomb, young: 24900, poisson: 0.21, cohesion: 0, friction: 35, unit_weight: 16}}\n\
        contacts: [{wall: axis, soil: block, friction: 0.2}, {wall: face, soil: block, friction: 0.2}]\n\
        supports: {bottom: {uy: 0}}\ngravity: {y: -9.81}\n\
        phases: [{name: fill, analysis: quasi_static, duration: 1, step: {initial: 0.1}, gravity: {rate: 1}}]\n\
        output: {history: [{name: floor, on: bottom, quantities: [reaction_y]}, {name: left, on: axis, quantities: [contact_y]}, {name: right, on: face, quantities: [contact_y]}]}\n";
    let folder = support::solve_text(case);
    let last = |name: &str| column(folder.path(), name).pop().unwrap().abs();
    let [floor, left, right] = ["floor.reaction_y [kN]", "left.contact_y [kN]", "right.contact_y [kN]"].map(last);
    let weight = 5.0 * 19.8 * 16.0;
    assert!(((floor + left + right) / weight - 1.0).abs() < 1e-6, "{floor}, {left}, {right}");
    // Janssen (1895) with the active pressure; the principal stresses turn beside the walls, which he neglects.
    let (share, active): (f64, f64) = (0.2, (27.5f64.to_radians().tan()).powi(2));
    let length = 5.0 / (2.0 * share * active);
    let janssen = weight - 5.0 * 16.0 * length * (1.0 - (-19.8 / length).exp());
    assert!(((left + right) / janssen - 1.0).abs() < 0.04, "{left} and {right} of {janssen}");
}
