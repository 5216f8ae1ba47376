//! What phases do, through the program: the factor of safety against closed forms and a published slope.

use std::fs;
use std::path::Path;
use std::process::Command;
use tempfile::TempDir;

/// Runs a case to its end.
fn run(case: &Path, settings: &[&str]) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    for stage in ["mesh", "seed", "solve"] {
        let mut command = Command::new(env!("CARGO_BIN_EXE_mpm"));
        command.arg(stage).arg(case).arg("-o").arg(folder.path());
        for setting in settings {
            command.args(["--set", setting]);
        }
        let output = command.output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    }
    folder
}

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

fn log(folder: &Path) -> String {
    fs::read_to_string(folder.join("solve.log")).unwrap()
}

/// The last number of each row of the history in the column called `name`.
fn column(folder: &Path, name: &str) -> Vec<f64> {
    let text = fs::read_to_string(folder.join("history.csv")).unwrap();
    let mut lines = text.lines();
    let at = lines.next().unwrap().split(',').position(|column| column == name);
    let at = at.unwrap_or_else(|| panic!("no column {name} in {text}"));
    lines.map(|line| line.split(',').nth(at).unwrap().parse().unwrap()).collect()
}

/// The factor of safety as the log has it: equilibrium and none.
fn bracket(log: &str) -> [f64; 2] {
    let line = log.lines().find(|line| line.starts_with("factor of safety")).unwrap_or_else(|| panic!("{log}"));
    let words: Vec<&str> = line.split(' ').collect();
    [words[3], words[5]].map(|number| number.parse().unwrap_or_else(|_| panic!("{line}")))
}

/// A block between smooth plates, loaded from above; weightless, and half of it.
fn block(material: &str, load: f64) -> TempDir {
    let file = tempfile::tempdir().unwrap();
    let text = format!(
        "geometry: plane_strain\n\
         mesh: {{geo: {}, parameters: {{half_width: 1, height: 1, room: 0, h: 0.5}}}}\n\
         regions: {{block: {{kind: mpm, material: soil, points_per_cell: 12}}}}\n\
         materials: {{soil: {{{material}, young: 1.0e+6, poisson: 0.3, density: 1}}}}\n\
         supports: {{bottom: {{uy: 0}}, axis: {{ux: 0}}}}\n\
         numerics: {{restore: never}}\n\
         phases:\n\
         - {{name: load, analysis: quasi_static, duration: 1, step: {{initial: 1}}, tractions: [{{on: top, ty: {load}}}]}}\n\
         - {{name: safety, analysis: strength_reduction, duration: 2, step: {{initial: 0.05, min: 0.0002}}, \
             tractions: [{{on: top, ty: {load}}}]}}\n\
         - {{name: after, analysis: quasi_static, duration: 1, step: {{initial: 1}}, tractions: [{{on: top, ty: {load}}}]}}\n\
         output: {{history: [{{name: top, on: top, quantities: [uy]}}]}}\n",
        root().join("geo/slump.geo").display()
    );
    fs::write(file.path().join("case.yaml"), text).unwrap();
    run(file.path(), &[])
}

/// The uniaxial strength (kPa) of plane strain by Mohr and Coulomb, with both reduced by `factor`.
fn uniaxial(cohesion: f64, friction: f64, factor: f64) -> f64 {
    let tan = friction.to_radians().tan() / factor;
    2.0 * cohesion / factor * (tan + tan.hypot(1.0))
}

/// The stress is uniform, so that the load is the uniaxial strength at failure; the strain there, of the order of 1e-4, is what the
/// shape of the block and the bracket, 2e-4 to 4e-4 wide, leave as an error.
#[test]
fn a_block_fails_where_its_reduced_strength_is_the_load() {
    let sand = |factor: f64| uniaxial(5.0, 30.0, factor);
    let (mut low, mut high) = (1.0, 2.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        (low, high) = if sand(middle) > 13.0 { (middle, high) } else { (low, middle) };
    }
    for (material, load, exact) in [
        ("model: tresca, shear_strength: 10", -16.0, 20.0 / 16.0),
        ("model: von_mises, yield_stress: 10", -9.0, 20.0 / 3f64.sqrt() / 9.0),
        ("model: mohr_coulomb, cohesion: 5, friction: 30", -13.0, low),
        ("model: mohr_coulomb, cohesion: 5, friction: 30, dilation: 30", -13.0, low),
        ("model: mohr_coulomb, cohesion: 10, friction: 20, tension: 4", 3.0, 4.0 / 3.0),
    ] {
        let folder = block(material, load);
        let [held, failed] = bracket(&log(folder.path()));
        println!("{material}: {held} to {failed}, exact {exact:.4}");
        assert!(failed - held < 5e-4 && held < exact * 1.001 && failed > exact * 0.999, "{material}");
        // The history has the bracket in a row of its own, and the phase after it its strengths back.
        let reduction = column(folder.path(), "strength_reduction [-]");
        let none = column(folder.path(), "no_equilibrium_at [-]");
        let last = none.iter().position(|&f| f > 0.0).unwrap();
        assert!((reduction[last] - held).abs() < 1e-4 && (none[last] - failed).abs() < 1e-4, "{reduction:?} {none:?}");
        assert_eq!(reduction[last + 1..], [1.0], "the phase after the search is one step");
        let time = column(folder.path(), "time [s]");
        assert_eq!(time[last], time[last - 1]);
        assert!((time[last + 1] - time[last] - 1.0).abs() < 1e-12);
    }
}

#[test]
fn what_bears_more_than_asked_is_told_so() {
    let folder = block("model: tresca, shear_strength: 100", -16.0);
    let log = log(folder.path());
    assert!(log.contains("factor of safety above 3.0000 (phase `safety`)"), "{log}");
    assert!(column(folder.path(), "no_equilibrium_at [-]").iter().all(|&f| f == 0.0));
}
