//! A blade pushed through clay by the defaults, on coarser cells than those of the case and not as far.

use crate::mpm::scripts::study;
use crate::support::{column, solve};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// The area (m²) of the soil above its first surface in the last frame.
fn heap(folder: &Path) -> f64 {
    let frames = mpm::io::frame::list(&folder.join("results")).unwrap();
    let frame = mpm::io::frame::Frame::read(&frames.last().unwrap().path).unwrap();
    let masses = frame.points.columns.iter().find(|column| column.name == "mass").unwrap();
    let above = frame.points.position.iter().zip(&masses.values).filter(|(x, _)| x[1] > 0.0);
    above.map(|(_, mass)| mass * 9.81 / 18.0).sum()
}

/// Cells of a quarter of the depth.
const COARSE: [&str; 4] = [
    "mesh.parameters={h: 0.125, length: 2}",
    "phases.push.duration=0.2",
    "phases.push.step.max=0.02",
    "output.every=0.2",
];

/// The first 0.2 m.
fn push(others: &[&str]) -> TempDir {
    solve("cases/shovel", &[&COARSE, others].concat())
}

/// On such cells the force is 30 % above that of the wedge under the heap, 13.6 kN/m after 0.1 m: of first order, with cells half as large it is a half
/// of that. What is pushed away is in the heap.
#[test]
fn a_blade_pushes_a_heap_of_clay() {
    let folder = push(&[]);
    let [way, blade] = ["blade.ux [m]", "blade.contact_x [kN]"].map(|name| column(folder.path(), name));
    let near: Vec<usize> = (0..way.len()).filter(|&k| (way[k] - 0.1).abs() < 0.03).collect();
    let force = -near.iter().map(|&k| blade[k]).sum::<f64>() / near.len() as f64;
    let moved = heap(folder.path()) / (0.5 * way.last().unwrap());
    study("cases/shovel", folder.path(), &COARSE, "| 0.20 |");
    println!("force {force:.2} kN/m, heap over what was pushed {moved:.3}");
    assert!((1.0..1.4).contains(&(force / 13.6)), "{force}");
    assert!((moved - 1.0).abs() < 0.1, "{moved}");
    let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
    assert!(!log.contains("halved"), "{log}");
}

/// In dry sand the force is that of a wedge with friction on its plane, `W tan(θ + φ)`: that of Rankine on level ground, 6.75 kN/m, and 9.7 kN/m with the
/// heap after 0.2 m. On such cells it is more, as in clay.
#[test]
fn a_blade_pushes_a_heap_of_dry_sand() {
    let sand =
        "materials.clay={model: mohr_coulomb, young: 10000, poisson: 0.3, cohesion: 0, friction: 30, unit_weight: 18}";
    let folder = push(&[sand]);
    let [way, blade] = ["blade.ux [m]", "blade.contact_x [kN]"].map(|name| column(folder.path(), name));
    let at = |reached: f64| -blade[way.iter().position(|&u| u > reached).unwrap()];
    let [first, last] = [at(5e-3) / 6.75, at(0.19) / 9.7];
    println!("force over that of the wedge: {first:.2} after 5 mm, {last:.2} after 0.2 m");
    assert!((1.0..1.4).contains(&first) && (1.0..1.6).contains(&last), "{first} {last}");
    let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
    let steps = log.lines().filter(|line| line.starts_with("step ")).count();
    assert!(steps < 60 && log.matches("halved:").count() < 6, "{log}");
}
