//! Soil that phases place, through the program: layers against the one-dimensional law, on ground that settles, on clay that fails.

use crate::support::{column, errors, in_folder, mpm, project, said, solve};
use std::f64::consts::PI;
use std::path::Path;

const LIFTS: &str = "tests/data/lifts";
const STRIP: &str = "tests/data/strip_of_fill";
const EMBANKMENT: &str = "docs/examples/embankment";
const PIT: &str = "docs/examples/open_pit";

/// The last value of a column.
fn last(folder: &Path, name: &str) -> f64 {
    *column(folder, name).last().unwrap()
}

/// The volumes (m³) of the fills of a run, by its log.
fn volumes(folder: &Path) -> Vec<f64> {
    let log = std::fs::read_to_string(folder.join("solve.log")).unwrap();
    let of = |line: &str| line.split_once("is filled with ")?.1.split_once(" m³")?.0.parse().ok();
    log.lines().filter_map(of).collect()
}

/// Small strains: each layer moves by the later ones as the confined moduli say, and the base bears the weight that has come.
#[test]
fn layers_in_turn_move_as_the_law_says() {
    // The moduli (kPa) of ground and fill, and how far (m) their layers move by a lift with the weight of 20 kPa.
    let [ground, fill] = [1.2e8, 2.4e8];
    let by = |layers: f64| -20.0 * (2.0 / ground + layers / fill);
    for (cells, turn, error) in [
        (&[][..], 1.0, 2e-6),
        (&["mesh.parameters.quads=0"], 1.0, 2e-6),
        (&["mesh.order=1"], 1.0, 2e-6),
        (&["mesh.order=1", "mesh.parameters.quads=0"], 1.0, 2e-5),
        (&["geometry=axisymmetric"], PI, 2e-6),
    ] {
        let folder = solve(LIFTS, cells);
        let [bottom, of_ground, first, second] =
            ["bottom.reaction_y [kN]", "ground.uy [m]", "lift1.uy [m]", "lift2.uy [m]"]
                .map(|n| column(folder.path(), n));
        for (row, bears) in bottom.iter().enumerate() {
            let exact = turn * (32.0 + 10.0 * (row + 1) as f64);
            assert!((bears / exact - 1.0).abs() < 1e-6, "{cells:?}: {bears} of {exact}");
        }
        let found = [of_ground[1], of_ground[3], of_ground[5], first[3], first[5], second[5], 2.0 * of_ground[0]];
        let exact = [0.5 * by(0.0), 0.5 * by(0.0), 0.5 * by(0.0), by(0.5), by(0.5), by(1.5), 0.5 * by(0.0)];
        for (found, exact) in found.iter().zip(exact) {
            assert!((found / exact - 1.0).abs() < error, "{cells:?}: {found} {exact}");
        }
    }
}

/// All lifts at once settle the ground as one after the other, and as soil that is there as its weight comes.
#[test]
fn lifts_at_once_settle_the_ground_as_in_turn() {
    let step = "analysis: quasi_static, duration: 1, step: {initial: 0.5}";
    let at_once = format!("phases=[{{name: all, {step}, place: [lift1, lift2, lift3]}}]");
    let found = last(solve(LIFTS, &[&at_once]).path(), "top.uy [m]");
    assert!((found / -1e-6 - 1.0).abs() < 2e-6, "{found}");
    let with_gravity = format!("phases=[{{name: all, {step}, gravity: {{rate: 1}}, place: [lift1, lift2, lift3]}}]");
    let found = last(solve(LIFTS, &[&with_gravity, "initial_stress=null"]).path(), "top.uy [m]");
    // Beside the lifts the ground itself: 16 · 2²/2 over its modulus.
    assert!((found / -(1e-6 + 32.0 / 1.2e8) - 1.0).abs() < 2e-6, "{found}");
}

/// On ground that settles by parts of a cell lifts fill what it leaves, whatever the cells: the base bears all that has come.
#[test]
fn lifts_fill_what_the_ground_leaves() {
    let soft = ["materials.clay.young=300", "materials.fill.young=600"];
    let mut all = Vec::new();
    for cells in [&[][..], &["mesh.parameters.quads=0"]] {
        let folder = solve(LIFTS, &[&soft[..], cells].concat());
        let (volumes, bears) = (volumes(folder.path()), last(folder.path(), "bottom.reaction_y [kN]"));
        let weight = 32.0 + 20.0 * volumes.iter().sum::<f64>();
        assert!((bears / weight - 1.0).abs() < 1e-6, "{cells:?}: {bears} of {weight}");
        assert!((volumes[0] - 1.0).abs() < 1e-9 && volumes[1] > 1.1 && volumes[2] > 1.1, "{volumes:?}");
        all.push(volumes);
    }
    assert!((all[0][1] - all[1][1]).abs() < 1e-5 && (all[0][2] - all[1][2]).abs() < 0.01, "{all:?}");
}

/// A strip of fill sinks three times as far as by elasticity at the load of Prandtl.
#[test]
fn a_strip_of_fill_fails_at_the_load_of_prandtl() {
    let folder = solve(STRIP, &[]);
    let [bears, settles] = ["bottom.reaction_y [kN]", "ground.uy [m]"].map(|name| column(folder.path(), name));
    // The pressure of the fill: its half is 1 m wide, on 4 m of clay 2 m deep.
    let pressure: Vec<f64> = bears.iter().map(|bears| bears - 128.0).collect();
    let elastic = settles[0] / pressure[0];
    let fails = (0..pressure.len()).find(|&i| settles[i] < 3.0 * elastic * pressure[i]).unwrap();
    let capacity = 5.0 * (2.0 + PI);
    assert!((0.95 * capacity..1.05 * capacity).contains(&pressure[fails]), "{} of {capacity}", pressure[fails]);
}

/// The clay under an embankment takes each lift undrained and consolidates between them; the mirrored embankment does the same.
#[test]
fn lifts_consolidate() {
    let mut ends = Vec::new();
    for side in ["mesh.parameters.side=1", "mesh.parameters.side=-1"] {
        let folder = solve(EMBANKMENT, &[side]);
        let [time, water] = ["time [s]", "clay.pore_pressure [kPa]"].map(|name| column(folder.path(), name));
        let at = |end: f64| water[time.iter().position(|t| (t - end).abs() < 1e-9).unwrap()];
        let of_phases = [1.0, 11.0, 12.0, 22.0, 23.0].map(at);
        let [first, rested, second, again, third] = of_phases;
        assert!(first > 5.0 && rested < 0.8 * first, "{of_phases:?}");
        assert!(second > rested + 5.0 && again < 0.8 * second && third > again + 3.0, "{of_phases:?}");
        let weight = 16.0 * 48.0 + 19.0 * volumes(folder.path()).iter().sum::<f64>();
        let bears = last(folder.path(), "bottom.reaction_y [kN]");
        assert!((bears / weight - 1.0).abs() < 1e-6, "{bears} of {weight}");
        ends.push(last(folder.path(), "ground.uy [m]"));
    }
    assert!((ends[0] / ends[1] - 1.0).abs() < 1e-4, "{ends:?}");
}

/// A pit that is dug and refilled, and its fill replaced in one phase: the base bears what is there.
#[test]
fn a_pit_is_filled_again() {
    let fill = "materials.fill={model: linear_elastic, young: 20000, poisson: 0.3, unit_weight: 20}";
    let step = "analysis: quasi_static, duration: 1, step: {initial: 0.5, min: 0.01}";
    let phases = format!(
        "phases=[{{name: dig, {step}, remove: [lift1]}}, {{name: fill, {step}, place: {{lift1: fill}}}}, \
         {{name: replace, {step}, remove: [lift1], place: {{lift1: clay}}}}]"
    );
    let folder = solve(
        PIT,
        &[fill, &phases, "materials.clay={model: linear_elastic, young: 10000, poisson: 0.3, unit_weight: 18}"],
    );
    let bears = column(folder.path(), "bottom.reaction_y [kN]");
    let [filled, again] = volumes(folder.path()).try_into().unwrap();
    for (row, weight) in [(1, 522.0), (3, 522.0 + 20.0 * filled), (5, 522.0 + 18.0 * again)] {
        assert!((bears[row] / weight - 1.0).abs() < 1e-6, "{row}: {} of {weight}", bears[row]);
    }
    assert!((filled / 3.0 - 1.0).abs() < 0.02 && (again / 3.0 - 1.0).abs() < 0.02, "{filled} {again}");
}

/// New soil in a phase with inertia falls freely until the waves from the ground, 24 m/s fast, reach it.
#[test]
fn new_soil_in_motion_is_at_rest_first() {
    let dynamic = "analysis: dynamic, duration: 0.05, step: {initial: 0.0025}";
    let phases = format!(
        "phases=[{{name: before, {dynamic}}}, {{name: fill, {dynamic}, place: [lift1, lift2, lift3], reset_displacements: true}}]"
    );
    for restore in ["numerics.restore=every_step", "numerics.restore={min_quality: 0.5}"] {
        let folder = solve(LIFTS, &[&phases, "materials.clay.young=1000", "materials.fill.young=1000", restore]);
        let (falls, exact) = (last(folder.path(), "lift3.uy [m]"), -0.5 * 9.81 * 0.05 * 0.05);
        assert!((falls / exact - 1.0).abs() < 0.01, "{restore}: {falls} of {exact}");
        assert!(last(folder.path(), "lift1.uy [m]") > 0.9 * exact, "{restore}");
    }
}

#[test]
fn what_cannot_be_placed_is_told() {
    let step = "analysis: quasi_static, duration: 1, step: {initial: 0.5}";
    for (phases, says) in [
        ("place: [ground, lift1, lift2, lift3]", "no soil is there as the run begins"),
        ("place: [lift2, lift1, lift1]", "`lift1` is there already"),
        ("place: [lift9]", "there is no region `lift9` of soil"),
        ("place: [air]", "`air` is not of kind mpm"),
        ("place: {lift1: clay}", "the first phase begins with the materials of `regions`"),
        ("place: {lift1: sand}", "there is no material `sand`"),
    ] {
        let set = format!("phases=[{{name: a, {step}, {phases}}}]");
        let output = errors(&in_folder(&project(""), &["check", LIFTS, "--set", &set]));
        assert!(output.contains(says), "{phases}: {output}");
    }
    for (set, says) in [
        (["numerics.restore=never", "mesh.order=2"], "a grid that is never reset takes no new soil"),
        (["numerics.quadrature=points", "mesh.order=2"], "which `quadrature: points` does not follow"),
        (["numerics.gradient=bspline", "mesh.order=3"], "which is not followed on cells of third order"),
    ] {
        let output = errors(&in_folder(&project(""), &["check", LIFTS, "--set", set[0], "--set", set[1]]));
        assert!(output.contains(says), "{set:?}: {output}");
    }
}

/// A lift that comes before the one below it hangs in the air.
#[test]
fn a_lift_in_the_air_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let phase = |name: &str, place: &str| {
        format!("{{name: {name}, analysis: dynamic, duration: 0.01, step: {{initial: 0.01}}, place: {place}}}")
    };
    for (first, second, told) in
        [("[lift1]", "[lift2, lift3]", 0), ("[lift3]", "[lift1, lift2]", 1), ("[lift2, lift3]", "[lift1]", 1)]
    {
        let set = format!("phases=[{}, {}]", phase("a", first), phase("b", second));
        let output = mpm("run", LIFTS, &folder.path().join(first), &[&set]);
        let said = said(&output);
        assert_eq!(said.matches("is placed on nothing").count(), told, "{first}: {said}");
    }
}
