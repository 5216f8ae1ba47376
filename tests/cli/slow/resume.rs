//! A run that is killed and continued, or given another number of threads, ends with the same bytes as an
//! undisturbed one: frames, history, log and the exported series.

use crate::support::{Random, errors, stage};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Output};
use std::time::Duration;

/// A case with the entries to override.
struct Case {
    file: &'static str,
    overrides: &'static [&'static str],
}

/// The main job in coarse: dynamic, the grid restored in every step, Tresca, steps that are halved.
const SLOPE: Case =
    Case { file: "cases/seabed_slope", overrides: &["mesh.parameters.h=1.25", "phases[0].duration=3.5"] };

/// Quasi-static, then dynamic, then quasi-static again on a grid that is never restored.
const RELEASE: Case = Case { file: "tests/data/release", overrides: &["mesh.parameters.h=0.2"] };

/// Dilating friction: an unsymmetric system, solved by iteration.
const SAND: Case = Case {
    file: "cases/seabed_slope",
    overrides: &[
        "mesh.parameters.h=1.5",
        "phases[0].duration=0.5",
        "materials.clay={model: mohr_coulomb, young: 5000, poisson: 0.3, cohesion: 1, friction: 25, dilation: 5, \
         density: 1.65}",
    ],
};

/// Finite elements, contact and a grid that follows both.
const PILE: Case = Case {
    file: "cases/pile",
    overrides: &["mesh.parameters.h=0.25", "phases[0].duration=0.16", "phases[0].step.max=0.005", "output.every=0.04"],
};

/// Water that flows through soil, whose strength has a pressure field beside it; dynamic, restored in every step.
const WATER: Case = Case {
    file: "cases/seabed_slope",
    overrides: &[
        "mesh.parameters.h=1.5",
        "phases[0].duration=0.8",
        "phases[0].step.max=0.02",
        "supports.bottom.pore_pressure=0",
        "materials.clay={model: tresca, young: 2000, poisson: 0.3, shear_strength: 2, density: 1.65, \
         drainage: undrained, permeability: 1.0e-5}",
        "output.fields=[stress, pore_pressure]",
    ],
};

/// A rigid structure in contact, dynamic.
const BLOCK: Case = Case {
    file: "cases/incline",
    overrides: &["regions.block.rigid=true", "mesh.parameters.h=0.4", "phases[0].duration=0.6"],
};

/// Soil on a wall that moves, dynamic.
const WALL: Case = Case {
    file: "tests/data/wall",
    overrides: &["phases[0].duration=0.5", "phases[0].prescribe={slope: {ux: {rate: 0.5}, rotation: {rate: 0.1}}}"],
};

/// Bodies that touch, one of them rigid, quasi-static.
const BODIES: Case = Case { file: "cases/hertz", overrides: &["mesh.parameters.h=0.4", "regions.upper.rigid=true"] };

/// A search for failure, and the run-out.
const SAFETY: Case = Case {
    file: "cases/slope_safety",
    overrides: &[
        "mesh.parameters.h=3",
        "phases.safety.step={initial: 0.02, min: 0.005}",
        "phases.failure.duration=0.4",
        "phases.failure.step={initial: 0.01}",
    ],
};

/// Quasi-static, dynamic where there is no equilibrium, and quasi-static again; then, with displacements from zero, up to a
/// condition.
const FALL: Case = Case {
    file: "cases/slump",
    overrides: &[
        "mesh.parameters.h=2",
        "supports.bottom={ux: 0, uy: 0}",
        "numerics.spectral_radius=0.5",
        "phases=[{name: fall, analysis: auto, duration: 6, step: {initial: 0.05, min: 0.02, max: 0.05}, \
         gravity: {table: [[0, 0], [1, 1]]}}, {name: on, analysis: dynamic, duration: 3, step: {initial: 0.05}, gravity: 2, \
         reset_displacements: true, until: [{of: block, quantity: uy, below: -0.1}]}]",
    ],
};

/// A model that remembers, and whose strength depends on the size of the step.
const SOFT: Case = Case {
    file: "tests/data/release",
    overrides: &[
        "mesh.parameters.h=0.2",
        "materials.steel={model: tresca_softening, young: 12000, poisson: 0.3, shear_strength: 75, remoulded: 0.5, \
         ductility: 5, rate: 0.1, reference_rate: 0.01, density: 1}",
    ],
};

/// Clay whose strength varies at random, so soft in places that points are split; dynamic, restored in every step.
const RANDOM: Case = Case {
    file: "cases/seabed_slope",
    overrides: &[
        "mesh.parameters.h=1.25",
        "phases[0].duration=2",
        "phases[0].step.max=0.05",
        "materials.clay.random_strength={coefficient_of_variation: 0.5, horizontal_scale: 4, vertical_scale: 1, seed: 7}",
        "output.fields=[stress, shear_strength]",
    ],
};

/// Water that falls, and a load on a part of the surface, on a grid that is restored now and then.
const POOL: Case = Case {
    file: "cases/submerged_slope",
    overrides: &[
        "mesh.parameters.h=1.25",
        "phases[1].duration=2",
        "phases[1].step={initial: 0.05}",
        "phases[1].water_level={table: [[0, 5.5], [2, 3]]}",
        "phases[1].tractions=[{surface: soil, ty: -5, shear: 1, where: {x: [-12, -6]}}]",
    ],
};

/// Soil that becomes stiffer, brittle and light, with a pressure field beside it before and none after, and softer again; dynamic in between.
const CHANGE: Case = Case {
    file: "cases/seabed_slope",
    overrides: &[
        "mesh.parameters.h=1.5",
        "materials={clay: {model: tresca, young: 2000, poisson: 0.49, shear_strength: 8, density: 1.65}, \
         brittle: {model: tresca_softening, young: 4000, poisson: 0.3, shear_strength: 8, remoulded: 0.2, ductility: 1, \
         density: 1.5}}",
        "numerics.restore={min_quality: 0.5}",
        "phases=[{name: load, analysis: quasi_static, duration: 1, step: {initial: 0.1}, gravity: {rate: 1}}, \
         {name: move, analysis: dynamic, duration: 1, step: {initial: 0.05}, materials: {soil: brittle}}, \
         {name: rest, analysis: dynamic, duration: 0.5, step: {initial: 0.05}, materials: {soil: clay}}]",
    ],
};

/// Soil whose points have domains, their corners moving with a grid that is restored now and then; contact, dynamic.
const DOMAINS: Case = Case {
    file: "tests/data/quads",
    overrides: &[
        "numerics.gradient=cpdi2",
        "numerics.restore={min_quality: 0.5, max_stretch: 1.05}",
        "phases[0].analysis=dynamic",
        "phases[0].step={initial: 0.02}",
        "materials.soil.density=1",
        "materials.plate.density=1",
        "gravity={y: -10}",
    ],
};

/// A pool that falls faster than the water in the pores, and a search for failure.
const LEVELS: Case = Case {
    file: "cases/drawdown",
    overrides: &[
        "mesh.parameters.h=3",
        "water={level: 7, phreatic_level: 8}",
        "phases.drawdown.water_level={table: [[0, 10], [1, 7]]}",
        "phases.drawdown.phreatic_level={table: [[0, 10], [1, 8]]}",
        "phases.safety.step={initial: 0.01, min: 0.005}",
    ],
};

/// A plate laid on clay whose unbalanced force is ramped: few iterations a step, so that the ramp takes several steps.
const LAID: Case = Case {
    file: "tests/data/plate",
    overrides: &[
        "mesh.parameters={plate: 0.8, left: 0.6, edge: 0.05}",
        "materials.soil={model: tresca, young: 1000, poisson: 0.49, shear_strength: 10, density: 0}",
        "phases=[{name: load, analysis: quasi_static, duration: 1, step: {initial: 0.02, max: 0.02}, \
         tractions: [{on: top, ty: -44}], prescribe: {top: {ux: 0}}}]",
        "numerics.max_iterations=6",
    ],
};

/// Grains that come apart: the inertia of nodes that hold next to no mass.
const GRAINS: Case = Case {
    file: "cases/sand_column",
    overrides: &["mesh.parameters.h=0.025", "phases.collapse.duration=0.2", "output.every=0.1"],
};

/// Soft soil that flows apart, whose material points are split on the way.
const FLOW: Case = Case {
    file: "cases/slump",
    overrides: &[
        "mesh.parameters.h=2",
        "mesh.parameters.room=32",
        "materials.soil={model: tresca, young: 1000, poisson: 0.49, shear_strength: 3, density: 1}",
        "phases=[{name: flow, analysis: dynamic, duration: 2.5, step: {initial: 0.05}, gravity: 1}]",
    ],
};

/// Water that leaves a surface beside a strip that covers a part of it.
const STRIP: Case = Case { file: "tests/data/strip", overrides: &["phases.wait.step.initial=40"] };

/// Lifts that come on clay with water, which consolidates between them.
const LIFTS: Case = Case {
    file: "docs/examples/embankment",
    overrides: &[
        "mesh.parameters.h=1",
        "phases[0].step.initial=0.1",
        "phases[2].step.initial=0.1",
        "phases[4].step.initial=0.1",
    ],
};

/// A pit that is dug, and refilled with other soil.
const PIT: Case = Case {
    file: "docs/examples/open_pit",
    overrides: &[
        "mesh.parameters.h=0.5",
        "materials.fill={model: linear_elastic, young: 20000, poisson: 0.3, unit_weight: 20}",
        "phases=[{name: dig, analysis: quasi_static, duration: 1, step: {initial: 0.05, min: 0.01}, remove: [lift1, lift2]}, \
         {name: fill, analysis: quasi_static, duration: 1, step: {initial: 0.05, min: 0.01}, place: {lift1: fill, lift2: clay}}]",
    ],
};

/// A plate on clay that hardens: pressed in, let go until that bears its weight, taken away, and laid down again. The kills fall in every phase.
const STAGES: Case = Case {
    file: "tests/data/plate",
    overrides: &[
        "mesh.parameters={plate: 0.8, left: 0.6, edge: 0.05}",
        "materials.soil={model: cam_clay, swelling: 0.02, compression: 0.1, poisson: 0.3, critical_slope: 1, \
         preconsolidation: 40, reference_pressure: 10, unit_weight: 8}",
        "materials.plate.density=5",
        "gravity={y: -10}",
        "initial_stress={k0: 0.6}",
        "numerics.restore=every_step",
        "output.every=0.5",
        "phases=[{name: press, analysis: quasi_static, duration: 1, step: {initial: 0.0625}, \
         prescribe: {top: {ux: 0, uy: {rate: -0.03}}}}, \
         {name: release, analysis: quasi_static, duration: 1, step: {initial: 0.125}, prescribe: {top: {ux: 0}}}, \
         {name: without, analysis: quasi_static, duration: 0.5, step: {initial: 0.125}, deactivate: [plate]}, \
         {name: again, analysis: quasi_static, duration: 2, step: {initial: 0.125}, activate: [plate], \
         prescribe: {top: {ux: 0}}}]",
    ],
};

fn mpm(verb: &str, case: &Case, folder: &Path, more: &[&str]) -> Command {
    let mut command = stage(verb, case.file, folder, case.overrides);
    command.args(more);
    command
}

fn ends(mut command: Command, status: i32) -> Output {
    let output = command.output().unwrap();
    let said = errors(&output);
    assert_eq!(output.status.code(), Some(status), "{command:?}: {said}");
    output
}

/// A folder with mesh and points.
fn seeded(case: &Case) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    ends(mpm("mesh", case, folder.path(), &[]), 0);
    ends(mpm("seed", case, folder.path(), &[]), 0);
    folder
}

/// A new folder with the mesh and the points of another one.
fn copy(seeded: &Path) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for name in ["mesh.msh", "points.vtu"] {
        fs::copy(seeded.join(name), folder.path().join(name)).unwrap();
    }
    folder
}

/// Everything that a killed run has left in `from`.
fn copy_all(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let copy = to.join(path.file_name().unwrap());
        if path.is_dir() {
            copy_all(&path, &copy);
        } else {
            fs::copy(&path, copy).unwrap();
        }
    }
}

/// Every file that a finished run and its export leave for the user, with its bytes.
fn results(case: &Case, folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    ends(mpm("export", case, folder, &[]), 0);
    let mut files = Vec::new();
    for part in ["", "results", "vtu"] {
        for entry in fs::read_dir(folder.join(part)).unwrap() {
            let path = entry.unwrap().path();
            let hidden = path.file_name().is_some_and(|name| name.as_encoded_bytes().starts_with(b"."));
            if path.is_file() && !hidden {
                files.push((path.strip_prefix(folder).unwrap().to_owned(), fs::read(&path).unwrap()));
            }
        }
    }
    files.sort();
    files
}

fn assert_same(a: &[(PathBuf, Vec<u8>)], b: &[(PathBuf, Vec<u8>)]) {
    let names = |files: &[(PathBuf, Vec<u8>)]| files.iter().map(|f| f.0.clone()).collect::<Vec<_>>();
    assert_eq!(names(a), names(b));
    for ending in ["mpmf", "vtu", "pvd", "csv", "log"] {
        assert!(names(a).iter().any(|n| n.extension().is_some_and(|e| e == ending)), "no .{ending}");
    }
    for ((name, a), (_, b)) in a.iter().zip(b) {
        assert!(a == b, "{} differs", name.display());
    }
}

/// Steps of which the history tells: a row that ends a search for failure repeats the time of the step before it.
fn rows(folder: &Path) -> u64 {
    let history = fs::read_to_string(folder.join("history.csv")).unwrap_or_default();
    let whole = history.rfind('\n').map_or("", |end| &history[..end]);
    let mut times: Vec<&str> = whole.lines().skip(1).filter_map(|row| row.split(',').next()).collect();
    times.dedup();
    times.len() as u64
}

/// The step of the newest checkpoint.
fn newest(folder: &Path) -> u64 {
    let Ok(entries) = fs::read_dir(folder.join("checkpoints")) else { return 0 };
    let step = |name: &str| name.strip_prefix("step-")?.strip_suffix(".mpmc")?.parse().ok();
    entries.filter_map(|e| step(e.unwrap().file_name().to_str()?)).max().unwrap_or(0)
}

/// Waits until the history tells of `step`.
fn reach(child: &mut Child, folder: &Path, step: u64) {
    while rows(folder) < step {
        assert!(child.try_wait().unwrap().is_none(), "the run ended by itself before step {step}");
        std::thread::sleep(Duration::from_micros(100));
    }
}

/// Runs that are killed have three threads, the undisturbed ones have one: so the number of threads changes no bit, either.
const RESUMED: [&str; 3] = ["--resume", "--threads", "3"];

/// Continues a run in a copy of `folder` and kills it somewhere in the step after `step`, or in the next one.
///
/// A run that came to its end before the signal is continued once more, from the same state: on a busy machine this
/// test may sleep longer than the rest of the run takes.
fn kill_after(case: &Case, folder: &Path, step: u64, random: &mut Random) -> tempfile::TempDir {
    for _ in 0..20 {
        let killed = tempfile::tempdir().unwrap();
        copy_all(folder, killed.path());
        let mut child = mpm("solve", case, killed.path(), &RESUMED).spawn().unwrap();
        reach(&mut child, killed.path(), step);
        std::thread::sleep(Duration::from_micros(random.below(20_000)));
        child.kill().unwrap();
        if !child.wait().unwrap().success() {
            return killed;
        }
    }
    panic!("the run always ended by itself after step {step}");
}

/// Kills a run five times and continues it to the end.
fn kill_five_times(case: &Case, undisturbed: &Path, seed: u64) -> tempfile::TempDir {
    let steps = rows(undisturbed);
    assert!(steps >= 30, "{steps} steps leave no room for five kills");
    let mut killed = copy(undisturbed);
    let mut random = Random(seed);
    // The last moments are left out: a run that ends by itself cannot be killed.
    let mut moments: Vec<u64> = (0..5).map(|_| 1 + random.below(3 * steps / 4)).collect();
    // One while what a phase begins with is released.
    moments[0] = 2;
    moments.sort_unstable();
    println!("killed after steps {moments:?} of {steps}");
    for moment in moments {
        let before = newest(killed.path());
        killed = kill_after(case, killed.path(), moment, &mut random);
        let (told, kept) = (rows(killed.path()), newest(killed.path()));
        assert!(kept + 1 >= told, "the history tells of {told} steps, the checkpoint is of step {kept}");
        assert!(kept >= before && kept + 1 >= moment, "killed after step {moment}, went back to {kept}");
    }
    ends(mpm("solve", case, killed.path(), &RESUMED), 0);
    killed
}

/// A run that is killed five times, in three threads, ends as an undisturbed one in one thread.
fn survives_kills(case: &Case, seed: u64) -> tempfile::TempDir {
    let undisturbed = seeded(case);
    ends(mpm("solve", case, undisturbed.path(), &["--threads", "1"]), 0);
    let expected = results(case, undisturbed.path());
    let killed = kill_five_times(case, undisturbed.path(), seed);
    assert_same(&expected, &results(case, killed.path()));
    undisturbed
}

#[test]
fn a_restored_dynamic_run_killed_five_times_ends_the_same() {
    survives_kills(&SLOPE, 1);
}

#[test]
fn a_run_of_three_phases_killed_five_times_ends_the_same() {
    survives_kills(&RELEASE, 2);
}

#[test]
fn a_run_with_finite_elements_and_contact_killed_five_times_ends_the_same() {
    survives_kills(&PILE, 3);
}

#[test]
fn a_run_with_a_rigid_structure_killed_five_times_ends_the_same() {
    survives_kills(&BLOCK, 4);
}

#[test]
fn a_run_with_a_wall_that_moves_killed_five_times_ends_the_same() {
    survives_kills(&WALL, 5);
}

#[test]
fn a_search_for_failure_killed_five_times_ends_the_same() {
    survives_kills(&SAFETY, 6);
}

#[test]
fn a_fall_between_equilibria_killed_five_times_ends_the_same() {
    survives_kills(&FALL, 7);
}

#[test]
fn a_run_with_softening_soil_killed_five_times_ends_the_same() {
    survives_kills(&SOFT, 8);
}

#[test]
fn a_run_whose_strength_varies_at_random_killed_five_times_ends_the_same() {
    survives_kills(&RANDOM, 12);
}

#[test]
fn a_run_with_loads_on_the_surface_killed_five_times_ends_the_same() {
    survives_kills(&POOL, 6);
}

#[test]
fn a_run_with_water_in_the_pores_killed_five_times_ends_the_same() {
    survives_kills(&WATER, 6);
}

#[test]
fn a_run_whose_material_changes_killed_five_times_ends_the_same() {
    survives_kills(&CHANGE, 9);
}

#[test]
fn a_run_with_two_water_levels_killed_five_times_ends_the_same() {
    survives_kills(&LEVELS, 23);
}

#[test]
fn points_with_domains_killed_five_times_end_the_same() {
    survives_kills(&DOMAINS, 47);
}

#[test]
fn a_surface_that_drains_beside_a_strip_killed_five_times_ends_the_same() {
    survives_kills(&STRIP, 12);
}

#[test]
fn a_load_released_bit_by_bit_killed_five_times_ends_the_same() {
    let undisturbed = survives_kills(&LAID, 33);
    let log = fs::read_to_string(undisturbed.path().join("solve.log")).unwrap();
    assert!(log.matches("held back").count() >= 2, "{log}");
}

#[test]
fn runs_whose_soil_comes_and_goes_survive_kills() {
    survives_kills(&LIFTS, 12);
    survives_kills(&PIT, 13);
}

#[test]
fn stages_of_a_structure_on_clay_killed_five_times_end_the_same() {
    survives_kills(&STAGES, 11);
}

#[test]
fn grains_that_come_apart_killed_five_times_end_the_same() {
    survives_kills(&GRAINS, 29);
}

#[test]
fn soil_whose_points_are_split_killed_five_times_ends_the_same() {
    let folder = survives_kills(&FLOW, 14);
    let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
    let split = log.lines().filter_map(|line| line.split(" split ").nth(1)?.split(' ').next()?.parse::<u32>().ok());
    assert!(split.sum::<u32>() >= 2, "{log}");
}

/// The two cases that no other test kills; the tests that kill a run vary the number of threads, too.
#[test]
fn the_number_of_threads_changes_no_bit() {
    for case in [SAND, BODIES] {
        let one = seeded(&case);
        let three = copy(one.path());
        ends(mpm("solve", &case, one.path(), &["--threads", "1"]), 0);
        ends(mpm("solve", &case, three.path(), &["--threads", "3"]), 0);
        assert_same(&results(&case, one.path()), &results(&case, three.path()));
    }
}

#[test]
fn ctrl_c_loses_nothing_and_the_run_continues() {
    let undisturbed = seeded(&SLOPE);
    ends(mpm("solve", &SLOPE, undisturbed.path(), &[]), 0);
    let expected = results(&SLOPE, undisturbed.path());

    let stopped = copy(undisturbed.path());
    let folder = stopped.path();
    let mut child = mpm("solve", &SLOPE, folder, &[]).spawn().unwrap();
    reach(&mut child, folder, 5);
    let signal = Command::new("sh").args(["-c", &format!("kill -INT {}", child.id())]).status().unwrap();
    assert!(signal.success());
    let output = child.wait_with_output().unwrap();
    let said = errors(&output);
    assert_eq!(output.status.code(), Some(130), "{said}");
    assert!(said.contains("--resume"), "{said}");
    assert_eq!(newest(folder), rows(folder), "the step in hand is finished and kept");
    assert!(rows(folder) < rows(undisturbed.path()));
    // What there is can be looked at.
    ends(mpm("export", &SLOPE, folder, &[]), 0);
    ends(mpm("solve", &SLOPE, folder, &["--resume"]), 0);
    assert_same(&expected, &results(&SLOPE, folder));
}
