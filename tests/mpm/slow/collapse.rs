//! The collapse of a column without cohesion through the program, on cells of a quarter of its height.

use crate::support::solve;
use mpm::io::frame::{self, Frame};
use std::fs;

/// Width and height of the column (m), its density (t/m³).
const WIDTH: f64 = 0.1;
const HEIGHT: f64 = 0.1;
const DENSITY: f64 = 16.0 / 9.81;

/// What follows `name` in a line of the log.
fn after(line: &str, name: &str) -> f64 {
    let mut words = line.split_whitespace().skip_while(|word| *word != name).skip(1);
    words.next().unwrap_or_else(|| panic!("no {name} in {line}")).parse().unwrap()
}

#[test]
fn a_column_without_cohesion_runs_out_and_comes_to_rest() {
    let folder = solve("cases/sand_column", &["mesh.parameters.h=0.025"]);
    let log = fs::read_to_string(folder.path().join("solve.log")).unwrap();
    let steps: Vec<&str> =
        log.lines().filter(|line| line.starts_with("step ") && line.contains(" collapse ")).collect();
    let energy = |line: &str| after(line, "potential") + after(line, "kinetic");

    // Mass: that of the drawing, in every step.
    let mass = DENSITY * WIDTH * HEIGHT;
    assert!(steps.iter().all(|line| (after(line, "mass") / mass - 1.0).abs() < 1e-12));

    // Friction takes energy, and restoration makes no more of it than noise. What the sand stores is a thousandth of the rest, and is left out: single
    // points that are squeezed for a step store more than the forces know of.
    let peak = steps.iter().map(|line| after(line, "kinetic")).fold(0.0, f64::max);
    let (mut least, mut made) = (f64::INFINITY, 0.0f64);
    for line in &steps {
        made = made.max((energy(line) - least) / peak);
        least = least.min(energy(line));
    }
    let rest = after(steps[steps.len() - 1], "kinetic") / peak;
    println!("kinetic energy {rest:.2e} of its peak {peak:.2e} kJ, {made:.1e} of it made");
    assert!(rest < 1e-4 && made < 0.002);

    // The toe has 99.5 % of the sand behind it; the README has 1.5 to 1.8 widths.
    let frames = frame::list(&folder.path().join("results")).unwrap();
    let end = Frame::read(&frames[frames.len() - 1].path).unwrap();
    let of_point = &end.points.columns.iter().find(|column| column.name == "mass").unwrap().values;
    let mut sand: Vec<(f64, f64)> = end.points.position.iter().map(|x| x[0]).zip(of_point.iter().copied()).collect();
    sand.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut behind = 0.0;
    let toe = sand.iter().find(|(_, mass_of_point)| {
        behind += mass_of_point;
        behind >= 0.995 * mass
    });
    let run_out = toe.unwrap().0 / WIDTH - 1.0;
    let wall = end.points.position.iter().filter(|x| x[0] < 0.02).map(|x| x[1]).fold(0.0, f64::max);
    println!("run-out {run_out:.2} widths, {wall:.3} m high at the wall");
    assert!((1.3..1.7).contains(&run_out), "{run_out}");
    assert!((0.8 * HEIGHT..HEIGHT).contains(&wall), "{wall}");
}
