//! Warnings of voids that open within soil.

use crate::support::{errors, mpm, succeeds};

/// The log of a run of the block with a groove with overrides, what it said on standard error, and on standard output.
fn run(overrides: &[&str]) -> [String; 3] {
    let folder = tempfile::tempdir().unwrap();
    let output = mpm("run", "tests/data/groove", folder.path(), overrides);
    succeeds(&output);
    let log = std::fs::read_to_string(folder.path().join("solve.log")).unwrap();
    [log, errors(&output), String::from_utf8_lossy(&output.stdout).into_owned()]
}

/// What opens under a plate that parts from the soil as it is pulled has a line in the log, and no warning; nothing opens under one that cannot.
#[test]
fn what_opens_under_a_plate_that_parts_is_in_the_log() {
    for (tension, opens) in [("{limit: 3}", true), ("no_separation", false)] {
        let folder = tempfile::tempdir().unwrap();
        let tension = format!("contacts[0].tension={tension}");
        let overrides = ["mesh.parameters.h=0.1", "phases.pull.duration=0.12", tension.as_str()];
        let output = mpm("run", "cases/plate_anchor", folder.path(), &overrides);
        succeeds(&output);
        let log = std::fs::read_to_string(folder.path().join("solve.log")).unwrap();
        let told: Vec<&str> = log.lines().filter(|line| line.contains("void")).collect();
        println!("{tension}: {told:#?}");
        assert_eq!(!told.is_empty(), opens, "{told:#?}");
        let is_right = |line: &&str| {
            line.starts_with("phase `pull`: ") && line.contains("at `plate`, which has parted from the soil")
        };
        assert!(told.iter().all(is_right) && !errors(&output).contains("void"), "{told:#?}");
    }
}

/// A slab that falls onto a block closes the groove of 0.8 m by 0.5 m in it: a void that is reported once, on the console and in the log. Without the
/// groove there is none.
#[test]
fn a_groove_that_soil_closes_over_is_reported_once() {
    let told = "warning: phase `fall`: a void has opened within the soil";
    for (overrides, count) in [(&[][..], 1), (&["regions.groove={kind: mpm, material: soil}"][..], 0)] {
        let [log, said, summary] = run(overrides);
        assert_eq!(log.matches("void").count(), count, "{overrides:?}: {log}");
        assert_eq!(said.matches(told).count(), count, "{overrides:?}: {said}");
        assert!(!summary.contains(told), "{overrides:?}: {summary}");
        if let Some(line) = log.lines().find(|line| line.contains(told)) {
            let area: f64 = line.split(" m, of ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap();
            println!("{line}");
            assert!((area / 0.4 - 1.0).abs() < 0.15, "{line}");
            assert!(line.contains("at [1.0") || line.contains("at [0.9"), "{line}");
        }
    }
}
