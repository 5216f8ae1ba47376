//! A blade pushed through clay by the defaults, on coarser cells than those of the case and not as far.

use crate::support::{column, solve};
use std::fs;
use std::path::Path;

/// The area (m²) of the soil above its first surface in the last frame.
fn heap(folder: &Path) -> f64 {
    let frames = mpm::io::frame::list(&folder.join("results")).unwrap();
    let frame = mpm::io::frame::Frame::read(&frames.last().unwrap().path).unwrap();
    let masses = frame.points.columns.iter().find(|column| column.name == "mass").unwrap();
    let above = frame.points.position.iter().zip(&masses.values).filter(|(x, _)| x[1] > 0.0);
    above.map(|(_, mass)| mass * 9.81 / 18.0).sum()
}

/// On cells of a quarter of the depth the force is 30 % above that of the wedge under the heap, 13.6 kN/m after 0.1 m: of first order, with cells half as
/// large it is a half of that. What is pushed away is in the heap.
#[test]
fn a_blade_pushes_a_heap_of_clay() {
    let settings = [
        "mesh.parameters={h: 0.125, length: 2}",
        "phases.push.duration=0.2",
        "phases.push.step.max=0.02",
        "output.every=0.2",
    ];
    let folder = solve("cases/shovel", &settings);
    let [way, blade] = ["blade.ux [m]", "blade.contact_x [kN]"].map(|name| column(folder.path(), name));
    let near: Vec<usize> = (0..way.len()).filter(|&k| (way[k] - 0.1).abs() < 0.03).collect();
    let force = -near.iter().map(|&k| blade[k]).sum::<f64>() / near.len() as f64;
    let moved = heap(folder.path()) / (0.5 * way.last().unwrap());
    println!("force {force:.2} kN/m, heap over what was pushed {moved:.3}");
    assert!((1.0..1.4).contains(&(force / 13.6)), "{force}");
    assert!((moved - 1.0).abs() < 0.1, "{moved}");
    let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
    assert!(!log.contains("halved"), "{log}");
}
