//! Soil that leaves and enters the model through curves, through the program: mass to rounding, free fall, the balance of energy, resumed runs, what is
//! refused.

use crate::support::{column, command, errors, mpm, project, rows, said, solve, stage, succeeds};
use std::fs;
use std::path::Path;
use std::time::Duration;

const SPOUT: &str = "tests/data/spout";
/// A jet of sand from the top of the box through its floor.
const JET: [&str; 4] = [
    "materials.clay={model: mohr_coulomb, young: 200, poisson: 0.3, cohesion: 0, friction: 30, density: 1.6}",
    "regions={block: {kind: buffer}, bed: {kind: mpm, material: clay}, feed: {kind: mpm, material: clay}, air: {kind: buffer}}",
    "phases=[{name: flow, analysis: dynamic, duration: 0.8, step: {initial: 0.002, max: 0.004}, inflow: {inlet: {region: feed, velocity: 2}}}]",
    "output={every: 0.1, history: [{name: inlet, on: inlet, quantities: [mass_in, volume_in]}, {name: spout, on: spout, quantities: [mass_out]}, \
     {name: feed, on: feed, quantities: [mass]}, {name: bed, on: bed, quantities: [mass]}]}",
];
const G: f64 = 9.81;
const DENSITY: f64 = 1.6;

fn energy(folder: &Path, name: &str) -> f64 {
    let text = fs::read_to_string(folder.join("energy.csv")).unwrap();
    let at = text.lines().next().unwrap().split(',').position(|head| head.starts_with(name)).unwrap();
    text.lines().last().unwrap().split(',').nth(at).unwrap().parse().unwrap()
}

/// What the method adds or takes, over the work of gravity; the balance adds up.
fn numerical(folder: &Path) -> f64 {
    let text = fs::read_to_string(folder.join("energy.csv")).unwrap();
    let mut lines = text.lines();
    let heads: Vec<&str> = lines.next().unwrap().split(',').collect();
    let (mut most, mut work) = (0.0f64, 0.0f64);
    for line in lines {
        let row: Vec<f64> = line.split(',').map(|value| value.parse().unwrap()).collect();
        let sum = |side: &str| heads.iter().zip(&row).filter(|(h, _)| h.starts_with(side)).map(|(_, v)| v).sum::<f64>();
        let rest = sum("supplied.") - sum("held.") - sum("dissipated.") - sum("numerical.");
        let scale = row[1..].iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        assert!(rest.abs() <= 1e-9 * scale, "t = {}: {rest} of {scale}", row[0]);
        most = most.max(sum("numerical.").abs());
        work = work.max(row[heads.iter().position(|head| head.starts_with("supplied.gravity")).unwrap()]);
    }
    most / work
}

/// The mass (t) of points and of what has left is that of the beginning in every row; the block leaves as a body in free fall, at most a row of points and a
/// step late, and takes the work of gravity with it.
#[test]
fn a_block_falls_out_of_the_model() {
    for set in [&[][..], &["mesh.parameters.quad=1"], &["mesh.order=1"], &["numerics.quadrature=points"]] {
        let folder = solve(SPOUT, set);
        let folder = folder.path();
        let [time, out, block, bed] =
            ["time [s]", "spout.mass_out [t]", "block.mass [t]", "bed.mass [t]"].map(|name| column(folder, name));
        let late = 0.025 + 0.005 * (2.0 * G * 0.8f64).sqrt();
        for k in 0..time.len() {
            let whole = DENSITY * (0.4 * 0.4 + 0.4 * 0.2);
            assert!(((out[k] + block[k] + bed[k]) / whole - 1.0).abs() < 1e-12, "{set:?}, t = {}", time[k]);
            let passed = |late: f64| (0.5 * G * time[k].powi(2) - 0.4 - late).clamp(0.0, 0.4) * 0.4 * DENSITY;
            assert!(
                passed(late) - 1e-9 <= out[k] && out[k] <= passed(-0.025) + 1e-9,
                "{set:?}, t = {}: {} of {}",
                time[k],
                out[k],
                passed(0.0)
            );
        }
        let volume = *column(folder, "spout.volume_out [m3]").last().unwrap();
        assert!((volume / 0.16 - 1.0).abs() < 1e-4, "{set:?}: {volume}");
        let [work, left] = ["supplied.gravity", "supplied.outflow"].map(|name| energy(folder, name));
        println!("{set:?}: work {work:.5}, left {left:.5}, numerical {:.1e}", numerical(folder));
        assert!((left / work + 1.0).abs() < 2e-3 && numerical(folder) < 2e-3, "{set:?}: {work} {left}");
    }
}

/// A jet: what enters is ρ v A t in rows, to rounding; once it runs through the model holds its time of fall, and all of it balances.
#[test]
fn a_jet_enters_falls_and_leaves() {
    for (gravity, set) in [(G, "gravity={y: -9.81}"), (0.0, "gravity={y: 0}")] {
        let folder = solve(SPOUT, &[&JET[..], &[set]].concat());
        let folder = folder.path();
        let [time, into, out, feed, bed] =
            ["time [s]", "inlet.mass_in [t]", "spout.mass_out [t]", "feed.mass [t]", "bed.mass [t]"]
                .map(|name| column(folder, name));
        let flow = DENSITY * 2.0 * 0.4;
        for k in 0..time.len() {
            assert!((into[k] - out[k] - feed[k]).abs() < 1e-12, "{set:?}, t = {}", time[k]);
            // A row and a step late.
            assert!(into[k] <= flow * time[k] + 1e-12 && into[k] > flow * (time[k] - 0.0125 - 0.009), "{}", time[k]);
            // A row comes at the beginning of a step, with the flow up to then.
            if k > 0 && into[k] > into[k - 1] {
                assert!((into[k] / (flow * time[k - 1]) - 1.0).abs() < 1e-12, "{set:?}, t = {}", time[k]);
            }
            assert!((bed[k] / bed[0] - 1.0).abs() < 1e-12);
        }
        let through = if gravity == 0.0 { 0.75 } else { ((4.0 + 3.0 * gravity).sqrt() - 2.0) / gravity };
        let held = feed.last().unwrap() / (flow * through);
        let [entered, left, work] =
            ["supplied.inflow", "supplied.outflow", "supplied.gravity"].map(|n| energy(folder, n));
        let exact = 0.5 * into.last().unwrap() * 4.0;
        let kinetic = energy(folder, "held.kinetic");
        println!("{set:?}: held {held:.4} of the jet, left {left:.4}, kinetic {kinetic:.4}, work {work:.4} kJ");
        assert!((held - 1.0).abs() < 0.02, "{set:?}: {held}");
        assert!((entered / exact - 1.0).abs() < 1e-12, "{entered} {exact}");
        let kept = (kinetic - left) / (entered + work);
        assert!((kept - 1.0).abs() < if gravity == 0.0 { 1e-5 } else { 0.01 }, "{set:?}: {kept}");
    }
}

/// About the axis the inlet has the area of its ring, and a table of velocities is integrated exactly.
#[test]
fn what_enters_about_the_axis_has_the_area_of_the_ring() {
    let ring = "phases=[{name: flow, analysis: dynamic, duration: 0.3, step: {initial: 0.002, max: 0.004}, \
                inflow: {inlet: {region: feed, velocity: {table: [[0, 2], [0.2, 3]]}}}}]";
    let folder = solve(SPOUT, &[JET[0], JET[1], ring, JET[3], "geometry=axisymmetric"]);
    let [time, into] = ["time [s]", "inlet.mass_in [t]"].map(|name| column(folder.path(), name));
    let area = std::f64::consts::PI * (0.8f64.powi(2) - 0.4f64.powi(2));
    let way = |t: f64| if t < 0.2 { 2.0 * t + 2.5 * t * t } else { 0.5 + 3.0 * (t - 0.2) };
    for k in (1..time.len()).filter(|&k| into[k] > into[k - 1]) {
        let exact = DENSITY * area * way(time[k - 1]);
        assert!((into[k] / exact - 1.0).abs() < 1e-12, "t = {}: {} of {exact}", time[k], into[k]);
    }
    assert!(into[time.len() - 1] > 0.9 * DENSITY * area * way(0.3));
}

/// A run that is killed goes on bit for bit, in the middle of the flow.
#[test]
fn a_killed_flow_goes_on_as_it_would_have() {
    let whole = solve(SPOUT, &JET);
    let folder = tempfile::tempdir().unwrap();
    for name in ["mesh", "seed"] {
        succeeds(&mpm(name, SPOUT, folder.path(), &JET));
    }
    let mut child = stage("solve", SPOUT, folder.path(), &JET).spawn().unwrap();
    let lines = || fs::read_to_string(folder.path().join("history.csv")).map_or(0, |text| text.lines().count());
    while lines() < 90 && child.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_millis(5));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    let before = lines();
    let mut again = stage("solve", SPOUT, folder.path(), &JET);
    succeeds(&again.arg("--resume").output().unwrap());
    assert!(before < rows(whole.path()).len(), "it was killed before its end");
    for file in ["history.csv", "energy.csv"] {
        let [a, b] = [whole.path(), folder.path()].map(|folder| fs::read_to_string(folder.join(file)).unwrap());
        assert!(a == b, "{file}");
    }
}

/// Soil that fills the model up to the inlet, and soil that has all gone, end the analysis with what to do.
#[test]
fn what_cannot_go_on_says_why() {
    let folder = tempfile::tempdir().unwrap();
    let blocked = [
        JET[0],
        JET[1],
        "phases=[{name: flow, analysis: dynamic, duration: 1, step: {initial: 0.002, max: 0.004}, inflow: {inlet: {region: feed, velocity: 2}}}]",
        JET[3],
        "gravity={y: 9.81}",
    ];
    let all = ["regions.bed={kind: buffer}", "output.history=[]"];
    for (name, set, parts) in [
        ("blocked", &blocked[..], ["inflow `inlet`", "is in the way of what enters", "mass_in"]),
        ("all", &all, ["outflow `spout`", "all soil has left the model", "mass_out"]),
    ] {
        let output = mpm("run", SPOUT, &folder.path().join(name), set);
        assert_eq!(output.status.code(), Some(1), "{name}: {}", said(&output));
        parts.iter().for_each(|part| assert!(errors(&output).contains(part), "{name}: {}", errors(&output)));
    }
}

/// A wall of its curve, or one that is prescribed, keeps the outflow closed until the next phase.
#[test]
fn a_gate_opens_with_its_phase() {
    let fall = "{name: fall, analysis: dynamic, duration: 0.35, step: {initial: 0.002, max: 0.005}";
    let pour = "{name: pour, analysis: dynamic, duration: 0.6, step: {initial: 0.002, max: 0.005}";
    let wall = ["contacts=[{wall: spout}]".to_owned(), format!("phases=[{fall}}}, {pour}, deactivate: [spout]}}]")];
    let held =
        ["contacts=[]".to_owned(), format!("phases=[{fall}, prescribe: {{spout: {{ux: 0, uy: 0}}}}}}, {pour}}}]")];
    for set in [wall, held] {
        let set: Vec<&str> = set.iter().map(String::as_str).collect();
        let folder = solve(SPOUT, &set);
        let [time, out, block] =
            ["time [s]", "spout.mass_out [t]", "block.mass [t]"].map(|name| column(folder.path(), name));
        for k in 0..time.len() {
            assert!(time[k] > 0.35 + 1e-9 || out[k] == 0.0, "{set:?}, t = {}: {}", time[k], out[k]);
            assert!(((out[k] + block[k]) / 0.256 - 1.0).abs() < 1e-12);
        }
        assert!(*out.last().unwrap() > 0.25, "{set:?}");
    }
}

#[test]
fn flows_that_cannot_be_are_refused() {
    let phase = |more: &str| {
        format!("phases=[{{name: fall, analysis: dynamic, duration: 0.5, step: {{initial: 0.002}}, {more}}}]")
    };
    let inflow = |text: &str| phase(&format!("inflow: {{inlet: {{{text}}}}}"));
    let feed = "regions.feed={kind: mpm, material: clay}";
    let good = inflow("region: feed, velocity: 1");
    let (wrong, backwards) = (inflow("region: air, velocity: 1"), inflow("region: feed, velocity: -1"));
    let block = inflow("region: block, velocity: 1");
    let still = "phases=[{name: fall, analysis: quasi_static, duration: 1, step: {initial: 1}}]";
    let slow = good.replace("dynamic", "quasi_static");
    let moved = phase("prescribe: {spout: {uy: {rate: 1}}}");
    let shut = phase("prescribe: {spout: {ux: 0, uy: 0}}");
    let in_mesh = phase("inflow: {inside: {region: feed, velocity: 1}}");
    for (set, part) in [
        (vec!["supports.spout={outflow: true, uy: 0}"], "a curve that holds"),
        (vec!["supports.inside={outflow: true}"], "not on the boundary of the mesh"),
        (vec![still], "has the curve open"),
        (vec![&moved], "moves the curve"),
        (vec![&shut], "every phase prescribes the curve"),
        (vec!["numerics.restore=never"], "takes its boundary along"),
        (vec!["numerics.gradient=gimp"], "not available yet"),
        (vec!["water={level: 0}"], "with water"),
        (vec!["output.history=[{name: a, on: floor, quantities: [mass_out]}]"], "through which soil leaves"),
        (vec!["output.history=[{name: a, on: spout, quantities: [mass_in]}]"], "through which soil enters"),
        (vec![feed, &wrong], "not of kind mpm"),
        (vec![feed, &backwards], "a velocity above 0"),
        (vec!["regions.feed={kind: mpm, material: clay}", &block], "is beside `feed`"),
        (vec![feed, &slow], "has no inertia"),
        (vec![feed, &good, "supports.inlet={uy: 0}"], "a free curve"),
        (vec![feed, &good, "numerics.quadrature=points"], "needs the surface"),
        (vec![feed, &in_mesh], "not on the boundary of the mesh"),
    ] {
        let mut check = command(&project("."), &["check", SPOUT]);
        let output = check.args(set.iter().flat_map(|entry| ["--set", entry])).output().unwrap();
        assert!(!output.status.success(), "{set:?}: {}", said(&output));
        assert!(errors(&output).contains(part), "{set:?}: {}", errors(&output));
    }
}
