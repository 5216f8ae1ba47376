//! The scripts of the cases and of `benches` make their tables, from runs on coarse cells; `slow/` has more of them beside what their runs are held to,
//! and `documents.rs` that none is left out.

use crate::support::{self, PROGRAM, project, run};
use std::path::Path;

/// What a script of the repository prints; it succeeds.
fn says(script: &str, arguments: &[&str]) -> String {
    let mut command = support::python();
    command.arg(project(script)).args(arguments).current_dir(project("")).env("MPM", PROGRAM).env("MPLBACKEND", "Agg");
    let output = command.output().unwrap();
    support::succeeds(&output);
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// What a script prints of the output folder of a run.
pub fn of_run(script: &str, folder: &Path, arguments: &[&str]) -> String {
    says(script, &[&[folder.to_str().unwrap()][..], arguments].concat())
}

/// Exports a run of a case that was solved with these settings; the study of the case makes its table of it, with a line that begins so, and its picture.
pub fn study(case: &str, folder: &Path, settings: &[&str], line: &str) {
    support::succeeds(&support::mpm("export", case, folder, settings));
    let picture = folder.join("study.png");
    let text = of_run(&format!("{case}/study.py"), folder, &["-o", picture.to_str().unwrap()]);
    assert!(text.lines().any(|text| text.starts_with(line)), "{case}: {text}");
    assert!(picture.is_file(), "{case}: no picture");
}

/// The numbers of the first line that begins with `start`.
fn numbers(text: &str, start: &str) -> Vec<f64> {
    let line = text.lines().find_map(|line| line.strip_prefix(start)).unwrap_or_else(|| panic!("no `{start}`: {text}"));
    line.split([' ', '|', ',', '(', ')', '%', ';', ':']).filter_map(|word| word.parse().ok()).collect()
}

/// The numbers of the row of a run in a table, which begins with the name of its folder.
fn row(text: &str, folder: &Path) -> Vec<f64> {
    numbers(text, &format!("| {} |", folder.file_name().unwrap().to_str().unwrap()))
}

/// Pushed down by a quarter of its width on cells of a fifth: the load there.
#[test]
fn footing_deep() {
    let out =
        run("cases/footing_deep", &["mesh.parameters.h=0.2", "phases[0].duration=0.25", "phases[0].step.max=0.02"]);
    let text = of_run("cases/footing_deep/study.py", out.path(), &[]);
    assert!((5.8..6.9).contains(&row(&text, out.path())[1]), "{text}");
}

/// The disc presses with its weight while it rolls.
#[test]
fn rolling_disc() {
    let out = run("cases/rolling_disc", &["phases.roll.duration=0.3"]);
    let text = of_run("cases/rolling_disc/study.py", out.path(), &[]);
    assert!((row(&text, out.path())[1] - 1.0).abs() < 0.02, "{text}");
}

/// Limit pressures of cavities, by a series and by integration.
#[test]
fn closed_forms_of_a_cone_in_sand() {
    let text = says("cases/cpt_sand/reference.py", &[]);
    for shape in ["sphere", "cylinder"] {
        let found = numbers(&text, &format!("limit pressure of a {shape}:"));
        assert!((found[0] / found[1] - 1.0).abs() < 3e-3, "{text}");
    }
}

#[test]
fn circles_of_a_bank_that_is_drawn_down() {
    let text = says("cases/drawdown/bishop.py", &[]);
    for (level, factor) in [("0.0", 1.823), ("0.4", 1.407), ("0.7", 1.302), ("1.0", 1.377)] {
        let found = numbers(&text, &format!("| {level} |"))[0];
        assert!((found - factor).abs() < 0.002, "{level}: {text}");
    }
}

/// Cells of B/10 at the edge: a punch bears up to a tenth too much, and contact keeps its pressure smooth.
#[test]
fn punch() {
    let text = says("cases/punch/study.py", &["0.2"]);
    for case in ["punch", "circular_punch"] {
        let over = numbers(&text, &format!("| {case} |"))[2];
        assert!((2.0..12.0).contains(&over), "{text}");
    }
    let out = run("cases/punch", &["mesh.parameters.h=0.2"]);
    let text = of_run("benches/verification/contact_pressure.py", out.path(), &[]);
    let pressure = row(&text, out.path());
    assert!(pressure[1] > 30.0 && pressure[3] < 5.0, "{text}");
}

/// Composite points have half the error of GIMP on the same cells.
#[test]
fn composite_points_in_one_dimension() {
    let text = says("benches/composite/run.py", &["8"]);
    let [gimp, composite] = ["| `cpgimp` |", "| `composite`, exact tangent |"].map(|name| {
        let words = text.lines().find_map(|line| line.strip_prefix(name)).unwrap_or_else(|| panic!("{text}"));
        words.split_whitespace().next().unwrap().parse::<f64>().unwrap()
    });
    assert!(composite < 0.6 * gimp, "{text}");
}

/// An upper bound of a thin strip that moves through clay, (3π + 2) s_u B; where the solver for it is installed, which is no need of the program.
#[test]
fn limit_analysis() {
    if support::python().args(["-c", "import clarabel, scipy"]).output().unwrap().status.success() {
        let text =
            says("benches/verification/limit_analysis.py", &["--body", "0", "0.5", "-0.005", "0", "--size", "0.05"]);
        assert!(text.contains(|c: char| c.is_ascii_digit()), "{text}");
    }
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    #[test]
    fn deep_pipe() {
        let text = says("cases/deep_pipe/study.py", &["0.2"]);
        let loads = numbers(&text, "| 0.2 |");
        assert!((9.1..9.7).contains(&loads[0]), "{text}");
    }

    /// The mean from half a diameter on, and the same load by the script for all bodies.
    #[test]
    fn tbar() {
        let settings = ["mesh.parameters.h=0.25", "phases.push.duration=1", "phases.push.step.max=0.05"];
        let out = run("cases/tbar", &settings);
        let text = of_run("cases/tbar/study.py", out.path(), &[]);
        assert!((3.5..5.0).contains(&row(&text, out.path())[0]), "{text}");
        let text = of_run("benches/verification/loads.py", out.path(), &["--on", "bar", "--at", "0.5", "0.9"]);
        let loads = row(&text, out.path());
        assert!(loads[1] > 5.0 && loads[2] > loads[1], "{text}");
    }

    #[test]
    fn footing_on_sand() {
        let text = says("cases/footing_on_sand/study.py", &["surcharge", "--size", "0.4", "--angles", "20"]);
        assert!((6.4..7.5).contains(&numbers(&text, "| smooth | 20° | 20° |")[0]), "{text}");
    }

    /// Foot and top of the block in motion.
    #[test]
    fn slump() {
        let text = says("cases/slump/study.py", &["2"]);
        assert!(text.contains("quasi-static") && text.contains("in motion: foot at 1"), "{text}");
    }

    /// It fails at 0.8 and stands at 1.1 of what limit equilibrium says; the books of a run close within a percent.
    #[test]
    fn seabed_slope() {
        let text = says("cases/seabed_slope/study.py", &["--sizes", "1.25", "--factors", "0.8", "1.1"]);
        let [fails, stands] = ["  0.80 ", "  1.10 "].map(|factor| numbers(&text, factor)[0]);
        assert!(fails > 1.0 && stands < 0.05, "{text}");
        let out = run("cases/seabed_slope", &["mesh.parameters.h=1.25", "phases.fail.duration=6"]);
        let text = of_run("cases/seabed_slope/balance.py", out.path(), &[]);
        let energy = text.lines().find(|line| line.starts_with("energy")).unwrap_or_else(|| panic!("{text}"));
        let [gravity, plastic, held, numerical] =
            energy.split([' ', '%']).filter_map(|word| word.parse().ok()).collect::<Vec<f64>>()[..]
        else {
            panic!("{text}")
        };
        assert!(((plastic + held) / gravity + numerical / 100.0 - 1.0).abs() < 2e-3 && numerical.abs() < 1.0, "{text}");
        assert!(text.contains("rest: ") && text.contains("noise: "), "{text}");
    }

    /// A smooth pipe in a trench of its own shape, against the formulas for it.
    #[test]
    fn pipeline_limits() {
        let text = says("cases/pipeline/limits.py", &["--quick"]);
        let [down, formula, breakout, envelope] = numbers(&text, "| one strength, no weight | 0 |")[..] else {
            panic!("{text}")
        };
        assert!((down / formula - 1.0).abs() < 0.05 && (breakout / envelope - 1.0).abs() < 0.05, "{text}");
    }

    #[test]
    fn stretch_until_a_reset() {
        let text = says("benches/work_precision/stretch.py", &["--quick"]);
        assert!(numbers(&text, "| 1.3 |")[0] < 1.0, "{text}");
    }
}
