//! The limit loads of smooth footings on Tresca soil, through the program: Prandtl's 2 + π for the strip,
//! 5.689 for the circle; and those of rough ones, which many points in nearly incompressible cells must not lock.
//! Tolerance: 4 % on the documented mesh, falling with h, 2 % where cells of B/8 are finer at the singular edge. The settlement at which the
//! load is read is that of the cases, B/500 of a soil with E = 10⁴ s_u. The same for rigid punches in contact with the soil, whose
//! sharp edges lie anywhere in its cells, and for a rigid pipe deep in it.

use crate::analytical::limit_load;
use crate::support::solve;
use std::f64::consts::PI;
use std::path::Path;

fn error(case: &str, h: f64, exact: f64) -> f64 {
    error_with(case, h, exact, &[])
}

/// Reaction at the end over the limit load, less 1, with more entries of the case set.
fn error_with(case: &str, h: f64, exact: f64, set: &[&str]) -> f64 {
    error_and_log(case, h, exact, set).0
}

/// The same with the log of the run.
fn error_and_log(case: &str, h: f64, exact: f64, set: &[&str]) -> (f64, String) {
    let size = format!("mesh.parameters.h={h}");
    let out = solve(Path::new("cases").join(case), &[&[size.as_str()], set].concat());
    let read = |name: &str| std::fs::read_to_string(out.path().join(name)).unwrap();
    let reaction: f64 = read("history.csv").lines().last().unwrap().split(',').nth(2).unwrap().parse().unwrap();
    let error = -reaction / exact - 1.0;
    println!("{case}, h = {h} {set:?}: {:+.2} %", 100.0 * error);
    (error, read("solve.log"))
}

#[test]
fn strip() {
    let exact = 100.0 * (2.0 + PI);
    let errors = [0.1, 0.05].map(|h| error("strip_footing", h, exact));
    assert!(errors[1].abs() < 0.04 && errors[1] < 0.75 * errors[0], "{errors:?}");
}

/// The number after a word in each line of a log.
fn numbers(log: &str, word: &str) -> Vec<f64> {
    let after = |line: &str| line.split(' ').skip_while(|w| *w != word).nth(1).and_then(|n| n.parse().ok());
    log.lines().filter_map(after).collect()
}

/// Punches of cells of B/20 and B/40 at the edge, twice that below, within 3 %, with no step that Newton's method finds hard.
fn punch(case: &str, factor: f64, exact: f64) {
    let factor = format!("contacts[0].adhesion_factor={factor}");
    let errors = [0.1, 0.05].map(|h| {
        let (error, log) = error_and_log(case, h, exact, &[&factor]);
        let (iterations, steps) = (numbers(&log, "iterations"), numbers(&log, "dt"));
        let [most, shortest] =
            [iterations.iter().copied().fold(0.0, f64::max), steps.iter().copied().fold(1.0, f64::min)];
        println!("{} steps of at least {shortest} s and at most {most} iterations", steps.len());
        assert!(steps.len() >= 20 && most <= 25.0 && shortest >= 0.01, "{most} {shortest}");
        error
    });
    assert!(errors.iter().all(|e| e.abs() < 0.03) && errors[1] < 0.75 * errors[0], "{errors:?}");
}

const ROUGH: &str = "supports.footing={ux: 0}";
const MANY: &str = "regions.soil.points_per_cell=16";
const STRIP: f64 = 100.0 * (2.0 + PI);

#[test]
fn a_rough_strip_converges() {
    let grid = [MANY, ROUGH, "materials.clay.poisson=0.4999", "mesh.parameters.under=1", "mesh.parameters.coarse=4"];
    let errors = [0.25, 0.125].map(|h| error_with("strip_footing", h, STRIP, &grid));
    assert!(errors[1].abs() < 0.04 && errors[1] < 0.6 * errors[0], "{errors:?}");
}

/// Skeleton and water together are as stiff as the total stress: Poisson's ratios 0.3 and 0.495 of the same G.
#[test]
fn undrained_is_total_stress() {
    let total = error_with("strip_footing", 0.1, STRIP, &[MANY, ROUGH, "materials.clay.poisson=0.495"]);
    let young = format!("materials.clay.young={}", 1e6 * 1.3 / 1.495);
    let set = [MANY, ROUGH, "materials.clay.poisson=0.3", &young, "materials.clay.drainage=undrained"];
    let undrained = error_with("strip_footing", 0.1, STRIP, &set);
    assert!((undrained - total).abs() < 0.001, "{undrained} against {total}");
}

/// The undrained strength of soil that does not dilate, in plane strain from K₀ = 1, is `c cos φ + p′ sin φ`: Mohr–Coulomb soil under its weight
/// bears what Tresca soil of that strength does. Tolerance: 2 %, 0.1 % without friction.
#[test]
fn undrained_mohr_coulomb_is_tresca() {
    for (cohesion, friction, tolerance) in [(100.0, 0.0, 0.001), (20.0, 25.0, 0.02), (5.0, 35.0, 0.02)] {
        let (sin, cos) = f64::to_radians(friction).sin_cos();
        let (top, gradient) = (cohesion * cos, 9.81 * sin);
        let [coulomb, tresca] = [
            format!("mohr_coulomb, cohesion: {cohesion}, friction: {friction}"),
            format!("tresca, shear_strength: {{top: {top}, gradient: {gradient}, datum: 0}}"),
        ]
        .map(|model| {
            let clay = format!(
                "materials.clay={{model: {model}, young: {}, poisson: 0.3, density: 1, drainage: undrained, undrained_poisson: 0.4999}}",
                8667.0 * top
            );
            let weight = ["gravity={x: 0, y: -9.81}", "initial_stress={k0: 1}"];
            error_with("strip_footing", 0.1, top * (2.0 + PI), &[MANY, ROUGH, &clay, weight[0], weight[1]])
        });
        let beyond = (1.0 + coulomb) / (1.0 + tresca) - 1.0;
        println!("c {cohesion} kPa, φ {friction}°: {:+.2} % of Tresca", 100.0 * beyond);
        assert!(beyond.abs() < tolerance, "{cohesion} {friction}: {beyond}");
    }
}

/// What takes more than some seconds; `make test-quick` leaves it out.
mod slow {
    use super::*;

    #[test]
    fn rigid_circles_by_contact() {
        punch("circular_punch", 0.0, 5.689 * 100.0 * PI);
        punch("circular_punch", 1.0, 6.05 * 100.0 * PI);
    }

    #[test]
    fn rigid_strips_by_contact() {
        punch("punch", 0.0, STRIP);
        punch("punch", 1.0, STRIP);
    }

    /// A rigid pipe deep in clay, smooth, rough and between, within 3 % of Randolph & Houlsby with five cells over its diameter, 2 %
    /// with ten. No gap opens behind it.
    #[test]
    fn a_deep_pipe() {
        for factor in [0.0, 0.3, 1.0] {
            let exact = 0.5 * 10.0 * limit_load::deep_pipe(factor);
            let set = format!("contacts[0].adhesion_factor={factor}");
            let errors = [0.2, 0.1].map(|h| {
                let (error, log) = error_and_log("deep_pipe", h, exact, &[&set]);
                let most = numbers(&log, "iterations").into_iter().fold(0.0, f64::max);
                assert!(most <= 30.0 && !log.contains("halved"), "{most}");
                error
            });
            assert!(errors.iter().all(|e| *e > 0.0) && errors[0] < 0.03 && errors[1] < 0.02, "{errors:?}");
            assert!(errors[1] < 0.8 * errors[0], "{errors:?}");
        }
    }

    #[test]
    fn circle() {
        let exact = 5.689 * 100.0 * PI;
        let errors = [0.1, 0.05, 0.025].map(|h| error("circular_footing", h, exact));
        // Of first order at the edge, over two halvings.
        assert!(errors[2].abs() < 0.04 && errors[1] < 0.75 * errors[0] && errors[2] < 0.5 * errors[0], "{errors:?}");
    }

    /// Cells of B/8 in the mechanism, finer at the edge.
    #[test]
    fn many_points_do_not_lock_with_the_pressure_field() {
        let graded = [MANY, ROUGH, "mesh.parameters.under=4", "mesh.parameters.coarse=20"];
        let at = |more: &[&str]| error_with("strip_footing", 0.03, STRIP, &[&graded, more].concat());
        let points = |more: &str| at(&["materials.clay.poisson=0.4999", "numerics.quadrature=points", more]);
        let (field, plain) = (points("numerics.pressure=field"), points("numerics.pressure=none"));
        assert!(field.abs() < 0.02 && plain > field + 0.02, "{field} against {plain} without the field");
        let [nearly, more] = ["0.49", "0.4999"].map(|poisson| at(&[&format!("materials.clay.poisson={poisson}")]));
        assert!(nearly.abs() < 0.015 && (more - nearly).abs() < 0.001, "{nearly} {more}");
    }
}
