//! The limit loads of smooth footings on Tresca soil, through the program: Prandtl's 2 + π for the strip,
//! 5.689 for the circle. Tolerance: 4 % on the documented mesh, falling with h. The settlement at which the
//! load is read is that of the cases, B/500 of a soil with E = 10⁴ s_u.

use std::f64::consts::PI;
use std::path::Path;
use std::process::Command;

/// Reaction at the end over the limit load, less 1.
fn error(case: &str, h: f64, exact: f64) -> f64 {
    let out = tempfile::tempdir().unwrap();
    let case = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases").join(case);
    for stage in ["mesh", "seed", "solve"] {
        let result = Command::new(env!("CARGO_BIN_EXE_mpm"))
            .arg(stage)
            .arg(&case)
            .arg("-o")
            .arg(out.path())
            .arg("--set")
            .arg(format!("mesh.parameters.h={h}"))
            .output()
            .unwrap();
        assert!(result.status.success(), "{}", String::from_utf8_lossy(&result.stderr));
    }
    let history = std::fs::read_to_string(out.path().join("history.csv")).unwrap();
    let reaction: f64 = history.lines().last().unwrap().split(',').nth(2).unwrap().parse().unwrap();
    let error = -reaction / exact - 1.0;
    println!("{}, h = {h}: {:+.2} %", case.display(), 100.0 * error);
    error
}

#[test]
fn strip() {
    let exact = 100.0 * (2.0 + PI);
    let errors = [0.1, 0.05].map(|h| error("strip_footing", h, exact));
    assert!(errors[1].abs() < 0.04 && errors[1] < 0.75 * errors[0], "{errors:?}");
}

#[test]
fn circle() {
    let exact = 5.689 * 100.0 * PI;
    let errors = [0.1, 0.05, 0.025].map(|h| error("circular_footing", h, exact));
    assert!(errors[2].abs() < 0.04 && errors[1] < 0.75 * errors[0] && errors[2] < 0.75 * errors[1], "{errors:?}");
}
