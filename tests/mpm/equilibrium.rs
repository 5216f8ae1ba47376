//! An initial stress that is brought into equilibrium before the first phase, through the program.

use crate::support::{column, errors, in_folder, mpm, project, said, solve, solve_text, succeeds, written};
use mpm::io::frame::{self, Frame};
use std::fs;
use std::path::Path;

const LAYERS: &str = "tests/data/dipping_layers";

/// The largest displacement (m) of the points in a frame, and its time (s).
fn moved(folder: &Path, number: usize) -> (f64, f64) {
    let read = Frame::read(&frame::path(&folder.join("results"), number)).unwrap();
    let points = [&read.points, &read.elements].into_iter().flat_map(|part| &part.columns);
    let fields = points.filter(|column| column.name == frame::DISPLACEMENT);
    (fields.flat_map(|column| &column.values).map(|u| u.abs()).fold(0.0, f64::max), read.time)
}

/// Layers that dip: the base bears the weight, displacements are 0 after it, and nothing moves in the phase that follows. Without it the soil
/// moves as far in that phase.
#[test]
fn dipping_layers_begin_in_equilibrium() {
    for kind in ["mpm", "fem"] {
        let kinds = ["sand", "peat"].map(|region| format!("regions.{region}.kind={kind}"));
        let kinds = kinds.each_ref().map(String::as_str);
        let folder = solve(LAYERS, &kinds);
        let [time, up, reaction] =
            ["time [s]", "top.uy [m]", "bottom.reaction_y [kN]"].map(|name| column(folder.path(), name));
        println!("{kind}: {time:?} {up:?} {reaction:?}");
        // Frames come with the first phase, not with the one before it.
        assert_eq!(time, [0.0, 0.5, 1.0, 1.5, 2.0]);
        let weight = 10.0 * 10.0 * (20.0 + 12.0);
        assert!(reaction.iter().all(|force| (force / weight - 1.0).abs() < 1e-8), "{reaction:?}");
        assert!(up[1..].iter().all(|u| u.abs() < 1e-8), "{up:?}");
        for (number, at) in [(0, -1.0), (2, 0.5), (5, 2.0)] {
            let (most, time) = moved(folder.path(), number);
            assert!(time == at && most < 3e-8, "{kind}: frame {number} at {time} s: {most}");
        }
        assert!(moved(folder.path(), 1).0 > 1e-4);

        let before = solve(LAYERS, &[&kinds[..], &["initial_stress.then="]].concat());
        let most = moved(before.path(), 1).0;
        println!("{kind}: {most} m without");
        assert!((most / moved(folder.path(), 1).0 - 1.0).abs() < 1e-6, "{most}");
    }
}

/// A slope of soil that yields here and there, with water in it that falls in the first phase.
#[test]
fn a_slope_begins_in_equilibrium() {
    let folder = solve_text(
        "geometry: plane_strain\n\
         mesh: {geo: GEO/seabed_slope.geo, parameters: {height: 10, angle: 26.565051177, base: 5, crest: 12, plain: 20, h: 3}}\n\
         regions: {soil: {kind: mpm, material: soil, points_per_cell: 16}, water: {kind: buffer}}\n\
         materials: {soil: {model: mohr_coulomb, young: 1.0e+5, poisson: 0.3, cohesion: 5, friction: 30, unit_weight: 20}}\n\
         supports: {bottom: {ux: 0, uy: 0}, back: {ux: 0}, end: {ux: 0}}\n\
         gravity: {y: -9.81}\n\
         initial_stress: {k0: 0.7, then: equilibrium}\n\
         water: {level: 3, phreatic_level: 3}\n\
         phases:\n\
         - {name: rest, analysis: quasi_static, duration: 1, step: {initial: 0.5}, water_level: {table: [[0, 4], [0.5, 4], [1, 3]]}, \
             phreatic_level: {table: [[0, 4], [0.5, 4], [1, 3]]}}\n\
         output: {history: [{name: soil, on: soil, quantities: [ux, uy]}]}\n",
    );
    let [ux, uy] = ["soil.ux [m]", "soil.uy [m]"].map(|name| column(folder.path(), name));
    println!("{ux:?} {uy:?}");
    let last = ux.len() - 1;
    // The level falls in the last step alone.
    assert!(ux[last - 1].abs() < 1e-8 && uy[last - 1].abs() < 1e-8, "{ux:?} {uy:?}");
    assert!(uy[last] < -1e-5, "{uy:?}");
}

/// Another run may go on from the end of a phase.
#[test]
fn runs_go_on_after_it() {
    let text = |more: &str, phases: &str| {
        fs::read_to_string(Path::new(LAYERS).join("case.yaml"))
            .unwrap()
            .replace("geo: layers.geo", &format!("geo: {}/{LAYERS}/layers.geo", env!("CARGO_MANIFEST_DIR")))
            .replace("initial_stress", &format!("{more}initial_stress"))
            .replace("  - {name: rest, analysis: quasi_static, duration: 2, step: {initial: 1}}\n", phases)
    };
    let phase = |name: &str| {
        format!(
            "  - {{name: {name}, analysis: quasi_static, duration: 1, step: {{initial: 1}}, tractions: [{{surface: all, ty: {{table: [[0, 0], [1, -1]]}}}}]}}\n"
        )
    };
    let folder = written(&text("", &(phase("first") + &phase("second"))));
    for (name, more, phases) in [
        ("whole", "", phase("first") + &phase("second")),
        ("a", "", phase("first")),
        ("b", "start_from: {run: a}\n", phase("second")),
    ] {
        fs::write(folder.path().join("case.yaml"), text(more, &phases)).unwrap();
        succeeds(&mpm("run", folder.path(), &folder.path().join(name), &[]));
    }
    let last = |name: &str| column(&folder.path().join(name), "top.uy [m]").pop().unwrap();
    assert_eq!(last("whole"), last("b"));
    assert!(last("b") < -1e-4);
    let of = |name: &str| column(&folder.path().join(name), "time [s]");
    assert_eq!((of("b")[0], of("b").pop()), (1.5, Some(2.0)));
}

/// What would not be what the user wants.
#[test]
fn what_does_not_go_with_it_is_refused() {
    let layers = project(LAYERS);
    for (set, found) in [
        ("phases[0].name=equilibrium", "a phase of that name"),
        ("initial_pore_pressure={peat: 3}", "without the load that balances this pressure"),
        ("initial_velocity={peat: {velocity: {x: 1}}}", "leaves the soil at rest"),
        ("initial_stress.then=rest", "equilibrium"),
    ] {
        let output = in_folder(&layers, &["check", ".", "--set", set]);
        assert!(!output.status.success() && errors(&output).contains(found), "{set}: {}", said(&output));
    }
    let checked = |set: &str| said(&in_folder(&layers, &["check", ".", "--set", set]));
    assert!(!checked("title=Layers").contains("begin in equilibrium"), "{}", checked("title=Layers"));
    let undrained = checked("materials.peat.drainage=undrained");
    assert!(undrained.contains("deforms `peat` undrained"), "{undrained}");
}
