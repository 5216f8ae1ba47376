//! What material meets as it moves: nothing passes a support, another body or the end of the mesh where it is held.

use crate::support::{column, errors, mpm, succeeds};
use std::fs;
use tempfile::TempDir;

/// How far (m) a block of 0.4 m falls freely within the time of the case.
const FREELY: f64 = -0.5 * 9.81 * 0.25;

/// Runs the block that falls, with entries overridden, to its end; returns its folder and log.
#[track_caller]
fn fall(set: &[&str]) -> (TempDir, String) {
    let folder = tempfile::tempdir().unwrap();
    succeeds(&mpm("run", "tests/data/drop", folder.path(), set));
    let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
    (folder, log)
}

/// Fails unless the middle of the block of `fall` has stayed higher than half of its height, squeezed by a third, above what is at `depth` (m)
/// beneath it.
#[track_caller]
fn lands(set: &[&str], depth: f64) -> String {
    let (folder, log) = fall(set);
    let lowest = column(folder.path(), "block.uy [m]").into_iter().fold(0.0, f64::min);
    assert!(lowest < 0.9 * -depth && lowest > -depth - 0.14, "{set:?}: {lowest} of {depth}, {FREELY} freely");
    log
}

/// A body that falls without distorting takes its grid along, on which no support acts until it is reset.
#[test]
fn a_block_lands_on_a_support() {
    for (order, quad, y) in [(1, 0, 0.55), (1, 1, 0.8), (2, 0, 0.8), (2, 1, 0.2)] {
        let mesh = [format!("mesh.order={order}"), format!("mesh.parameters={{quad: {quad}, y: {y}}}")];
        lands(&[&mesh[0], &mesh[1]], y);
    }
    // Along a slant, on to the side.
    let (folder, _) = fall(&["gravity.x=10"]);
    let farthest = column(folder.path(), "block.ux [m]").into_iter().fold(0.0, f64::max);
    assert!(farthest > 0.3 && farthest < 1.4 + 0.14, "{farthest}");
}

#[test]
fn a_block_lands_on_other_soil() {
    let bed = "regions={block: {kind: mpm, material: clay}, bed: {kind: mpm, material: clay}, air: {kind: buffer}}";
    lands(&["mesh.parameters={y: 0.9, bed: 0.3}", bed], 0.6);
}

/// Steps that would end beneath the floor are repeated with half their size.
#[test]
fn a_step_across_a_support_is_halved() {
    let steps = "phases.fall.step={initial: 0.05, max: 0.05}";
    for restore in ["every_step", "{min_quality: 0.5}"] {
        let log = lands(&[steps, "mesh.parameters.y=0.4", &format!("numerics.restore={restore}")], 0.4);
        assert!(log.contains("halved: material point"), "{restore}: {log}");
        assert!(log.contains("across a side that is held at ["), "{restore}: {log}");
    }
}

/// On a grid that is never reset no step size helps.
#[test]
fn what_passes_a_support_on_a_grid_that_is_never_reset_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let output = mpm("run", "tests/data/drop", folder.path(), &["numerics.restore=never"]);
    let said = errors(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    for part in ["material point", "(block)", "across a side that is held at [", "numerics.restore"] {
        assert!(said.contains(part), "`{part}` is not in: {said}");
    }
}

/// A body that leaves the mesh takes its grid along, too.
#[test]
fn what_leaves_the_mesh_is_told() {
    let folder = tempfile::tempdir().unwrap();
    let output = mpm("run", "tests/data/drop", folder.path(), &["supports={left: {ux: 0}}"]);
    let said = errors(&output);
    assert_eq!(output.status.code(), Some(0), "{said}");
    assert_eq!(said.matches("soil of region `block` has left the mesh near").count(), 1, "{said}");
}
